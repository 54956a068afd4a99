//! Observers of traversal. Rendering uses [`NoObserver`], which is compiled away.

use crate::accel::PrimitiveId;

/// An observer of the intersection tests of a single ray.
// The traversal that renders pictures has an observer as a parameter, so that explanations and the cost map show its
// real tests, not those of a second implementation.
pub trait Observer {
    /// Whether tests are reported; if not, their data are not computed.
    const ENABLED: bool = true;

    /// Records that the ray was tested against the boxes of a BVH node, up to eight.
    fn node_tested(&mut self);

    /// Records that the ray was tested against a primitive.
    fn primitive_tested(&mut self, test: PrimitiveTest);
}

/// A ray's intersection test against a primitive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrimitiveTest {
    /// The index of the object in [`Scene::objects`](crate::scene::Scene::objects).
    pub object: u32,
    /// The index of the tested [primitive](crate::shape::Shape::primitive) in the object's shape.
    pub primitive: u32,
    /// The ray's first crossing of the primitive within the interval; it may lie beyond the closest
    /// hit.
    pub t: Option<f32>,
}

impl PrimitiveTest {
    pub(super) fn from_crossing(PrimitiveId { object, index }: PrimitiveId, t: Option<f32>) -> Self {
        Self { object, primitive: index, t }
    }
}

/// An observer that ignores all tests.
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
