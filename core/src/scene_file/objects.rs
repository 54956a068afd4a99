//! Reading of objects and materials from the syntax tree.

use super::{MaterialUse, NamedMaterial, WrittenObject};
use crate::finish::WrittenFinish;
use crate::material::WrittenMaterial;
use crate::scene_text::{Body, SyntaxNode, Value, quoted};
use crate::shape::{WrittenPlacement, WrittenShape};
use crate::written::{NodeReader, Spanned, description, values};
use std::collections::HashSet;

impl NodeReader<'_> {
    pub(super) fn objects(&mut self, node: &SyntaxNode<'_>) -> Option<Vec<WrittenObject>> {
        let items = self.list(node, "a list of objects [Sphere(...), ...]")?;
        Some(self.read_all(items, Self::object))
    }

    fn object(&mut self, node: &SyntaxNode<'_>) -> Option<WrittenObject> {
        const FORM: &str = "an object, such as Sphere(center: ..., radius: ...)";
        let name = self.group_name(node, "an object", FORM, WrittenShape::NAMES)?;
        let (shape, fields) = WrittenShape::read(name, self, node)?;
        let placement = WrittenPlacement::read(self, &fields).map(Box::new);
        let material = self.optional(&fields, "material", NodeReader::material_use);
        let finish = self.optional(&fields, "finish", |reader, node| {
            Some(Spanned { value: WrittenFinish::read(reader, node)?, span: node.span })
        });
        let opacity = self.optional(&fields, "opacity", NodeReader::number);
        Some(WrittenObject { shape, span: node.head(), placement, material, finish, opacity })
    }

    fn material_use(&mut self, node: &SyntaxNode<'_>) -> Option<Spanned<MaterialUse>> {
        let value = match &node.value {
            Value::String(name) => MaterialUse::Named(name.clone()),
            _ => MaterialUse::Inline(self.material(node)?),
        };
        Some(Spanned { value, span: node.span })
    }

    /// Reads the entries of the field `materials`.
    ///
    /// Returns `false` if a name may be missing because its entry has a fault.
    pub(super) fn collect_all_named_materials(
        &mut self,
        node: &SyntaxNode<'_>,
        named: &mut Vec<NamedMaterial>,
    ) -> bool {
        let Value::Map(entries) = &node.value else {
            // `materials: []` and `()` mean no materials, as an empty map does.
            let is_empty = values(node).is_some_and(<[_]>::is_empty);
            if !is_empty {
                self.fault(node.head(), || {
                    let found = description(node);
                    format!("expected named materials {{\"name\": Diffuse(...), ...}}, found {found}")
                });
            }
            return is_empty;
        };
        let mut complete = true;
        let mut names = HashSet::new();
        for (key, value) in entries {
            // The material is read even if its name is a duplicate, so that its faults are found.
            let material = self.material(value);
            match self.material_name(key) {
                Some(name) if names.insert(name) => named.push(NamedMaterial { name: name.into(), material }),
                Some(name) => self.fault(key.span, || format!("duplicate material {}", quoted(name))),
                None => complete = false,
            }
        }
        complete
    }

    /// Returns the name of a material.
    ///
    /// A word without quotes is reported as a fault, and returned as well.
    fn material_name<'n>(&mut self, key: &'n SyntaxNode<'n>) -> Option<&'n str> {
        match &key.value {
            Value::String(name) => return Some(name),
            Value::Group(group) if group.body == Body::Nothing => {
                let name = group.name?.text;
                self.fault(key.span, || format!("the name of a material is written in quotes: {}", quoted(name)));
                return Some(name);
            }
            _ => self.mismatch(key, "the name of a material in quotes"),
        }
        None
    }

    fn material(&mut self, node: &SyntaxNode<'_>) -> Option<WrittenMaterial> {
        const FORM: &str = "a material, such as Diffuse(\"red\"), or the name of one";
        let name = self.group_name(node, "a material", FORM, WrittenMaterial::NAMES)?;
        WrittenMaterial::read(name, self, node)
    }
}
