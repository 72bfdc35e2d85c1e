//! The sphere test: a pair is rejected iff d² > s², where s = R_i + R_j with R from
//! [`inflate_radius`].
//!
//! d² is the sum of the squares of coordinate differences. Expanding the square would cancel far
//! from the origin.
//!
//! [`inflate_radius`]: crate::rounding::sphere::inflate_radius

use crate::broad_phase::{BallTest, SlotBodies};
use crate::rounding::sphere;
use crate::simd::Lanes;

/// The sphere test on the finder's balls.
#[derive(Clone, Copy, Debug)]
pub struct Spheres<'a>(pub SlotBodies<'a>);

impl BallTest for Spheres<'_> {
    #[inline(always)]
    fn slots(&self) -> SlotBodies<'_> {
        self.0
    }

    #[inline(always)]
    fn apart<L: Lanes>(&self, l: L, between: [L::F; 3], [mine, theirs]: [L::F; 2]) -> L::M {
        sphere::apart(l, between, mine + theirs)
    }
}
