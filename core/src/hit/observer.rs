//! Observers of traversal. Rendering is [`Unobserved`], which is compiled away.

use crate::accel::PrimitiveId;

/// An observer of the intersection tests of a single ray.
// The traversal that renders pictures has an observer as a parameter, so that explanations and the cost map show its
// real tests, not those of a second implementation.
pub trait Observer {
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

/// A traversal's observer, or [`Unobserved`].
// Two types implement this, so that each traversal is compiled twice only: with one copy for each observer, a third of
// the kernels' code was that of observed rays.
pub(super) trait Observation {
    /// Whether tests are reported; if not, their data are not computed.
    const ENABLED: bool;

    /// Reports the test of a node, as [`Observer::node_tested`].
    fn node_tested(&mut self);

    /// Reports the test of a primitive, as [`Observer::primitive_tested`].
    fn primitive_tested(&mut self, test: PrimitiveTest);
}

/// The observation of a ray that has no observer.
pub(super) struct Unobserved;

impl Observation for Unobserved {
    const ENABLED: bool = false;

    #[inline(always)]
    fn node_tested(&mut self) {}

    #[inline(always)]
    fn primitive_tested(&mut self, _: PrimitiveTest) {}
}

impl Observation for &mut dyn Observer {
    const ENABLED: bool = true;

    #[inline(always)]
    fn node_tested(&mut self) {
        (**self).node_tested();
    }

    #[inline(always)]
    fn primitive_tested(&mut self, test: PrimitiveTest) {
        (**self).primitive_tested(test);
    }
}

/// An observer that counts the tests of primitives and of tree nodes.
// A node counts as one test, because its up to eight boxes are tested at once.
#[derive(Default)]
pub struct TestCount(pub u64);

impl Observer for TestCount {
    fn node_tested(&mut self) {
        self.0 += 1;
    }

    fn primitive_tested(&mut self, _: PrimitiveTest) {
        self.0 += 1;
    }
}
