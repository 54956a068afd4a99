//! The plain material, which has the same reflectance everywhere.

use super::{Reflecting, channels};
use crate::checks::{self, SceneFault};
use crate::color::LinearRgb;
use crate::lanes::Number;
use crate::scene_text::{Body, SyntaxNode, Value};
use crate::written::{Fields, InSceneFile, NodeReader, Validator, WrittenColor, group_of_values};

/// A material with the same reflectance everywhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Diffuse {
    reflectance: LinearRgb,
}

impl Diffuse {
    /// The material in [`Material::DEFAULT`](super::Material::DEFAULT): a light grey.
    pub(super) const DEFAULT: Self = Self { reflectance: super::Material::DEFAULT_REFLECTANCE };

    /// Returns a material with this reflectance.
    ///
    /// # Errors
    /// If a channel is not within 0 and 1.
    #[doc(hidden)]
    pub fn new(reflectance: LinearRgb) -> Result<Self, SceneFault> {
        Ok(Self { reflectance: checks::checked_color("reflectance", reflectance, checks::reflectance)? })
    }
}

impl Reflecting for Diffuse {
    #[inline(always)]
    fn reflectance<N: Number>(&self, _: [N; 2], _: [N; 2]) -> [N; 3] {
        channels(self.reflectance)
    }

    fn described(&self, name: fn(LinearRgb) -> &'static str) -> String {
        name(self.reflectance).to_owned()
    }

    fn check(&reflectance: &Option<WrittenColor>, validator: &mut Validator<'_>) -> Option<Self> {
        Some(Self { reflectance: validator.reflectance(reflectance?)? })
    }
}

impl InSceneFile for Diffuse {
    /// The reflectance as written.
    type Written = Option<WrittenColor>;

    const NAME: &'static str = "Diffuse";
    const OWNER: &'static str = "Diffuse";
    const FORM: &'static str = "Diffuse(\"#rrggbb\")";
    const FIELDS: &'static [&'static str] = &["reflectance"];
    const SUMMARY: &'static str = "One colour; Diffuse(\"red\") is the short form.";
    const MEANINGS: &'static [&'static str] = &["the colour"];

    fn read(reader: &mut NodeReader<'_>, fields: &Fields<'_>) -> Option<WrittenColor> {
        reader.required(fields, "reflectance", NodeReader::color)
    }

    /// Reads `Diffuse(colour)` or `Diffuse(reflectance: colour)`.
    fn read_node(reader: &mut NodeReader<'_>, node: &SyntaxNode<'_>) -> Option<Option<WrittenColor>> {
        if let Value::Group(group) = &node.value
            && let Body::Values(values) = &group.body
        {
            let [color] = &values[..] else {
                reader.fault(node.span, || {
                    let found = group_of_values(values, "");
                    format!("expected one colour, as in Diffuse(\"#rrggbb\") or Diffuse((r, g, b)), found {found}")
                });
                return None;
            };
            return Some(reader.color(color));
        }
        let fields = reader.fields(node, Self::OWNER, Self::FORM, Self::FIELDS)?;
        Some(Self::read(reader, &fields))
    }
}
