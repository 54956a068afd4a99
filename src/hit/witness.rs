//! Who watches a ray on its way: nobody, usually, and that costs nothing.

use crate::accel::PartId;

/// Who is told what a ray is tested against, by the same code that traces pictures.
pub trait Witness {
    /// Whether anybody is there. What is only for him to know is not worked out otherwise.
    const IS_THERE: bool = true;

    /// The ray was tested against the boxes of a node: up to eight.
    fn boxes(&mut self);

    /// The ray was tested against a part of an object.
    fn part(&mut self, test: Test);
}

/// A ray's test against a part of an object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Test {
    /// Which of the scene's objects, by its place in [`Scene::objects`](crate::scene::Scene::objects).
    pub object: u32,
    /// Which of its shape's [parts](crate::shape::Shape::part).
    pub part: u32,
    /// Where the ray first crosses it, from the start of the interval on; `None`: nowhere there.
    pub t: Option<f32>,
}

impl Test {
    pub(super) fn of(PartId { object, part }: PartId, t: Option<f32>) -> Self {
        Self { object, part, t }
    }
}

/// The usual witness.
pub(super) struct Nobody;

impl Witness for Nobody {
    const IS_THERE: bool = false;

    #[inline(always)]
    fn boxes(&mut self) {}

    #[inline(always)]
    fn part(&mut self, _: Test) {}
}

impl<W: Witness> Witness for &mut W {
    const IS_THERE: bool = W::IS_THERE;

    #[inline(always)]
    fn boxes(&mut self) {
        W::boxes(self);
    }

    #[inline(always)]
    fn part(&mut self, test: Test) {
        W::part(self, test);
    }
}
