//! Who watches a ray on its way: nobody, usually, and that costs nothing.

use crate::accel::PrimitiveId;

/// Who is told what a ray is tested against, by the same code that traces pictures.
pub trait Observer {
    /// Whether anybody is there. What is only for him to know is not worked out otherwise.
    const ENABLED: bool = true;

    /// The ray was tested against the boxes of a node: up to eight.
    fn node_tested(&mut self);

    /// The ray was tested against a part of an object.
    fn primitive_tested(&mut self, test: PrimitiveTest);
}

/// A ray's test against a part of an object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrimitiveTest {
    /// Which of the scene's objects, by its place in [`Scene::objects`](crate::scene::Scene::objects).
    pub object: u32,
    /// Which of its shape's [parts](crate::shape::Shape::primitive).
    pub primitive: u32,
    /// Where the ray first crosses it, from the start of the interval on; `None`: nowhere there.
    pub t: Option<f32>,
}

impl PrimitiveTest {
    pub(super) fn of(PrimitiveId { object, index }: PrimitiveId, t: Option<f32>) -> Self {
        Self { object, primitive: index, t }
    }
}

/// The usual observer.
pub(super) struct NoObserver;

impl Observer for NoObserver {
    const ENABLED: bool = false;

    #[inline(always)]
    fn node_tested(&mut self) {}

    #[inline(always)]
    fn primitive_tested(&mut self, _: PrimitiveTest) {}
}

impl<W: Observer> Observer for &mut W {
    const ENABLED: bool = W::ENABLED;

    #[inline(always)]
    fn node_tested(&mut self) {
        W::node_tested(self);
    }

    #[inline(always)]
    fn primitive_tested(&mut self, test: PrimitiveTest) {
        W::primitive_tested(self, test);
    }
}
