//! `auto`: picks the finder that suits a scene.
//!
//! The finder is picked once, before the first frame, from the number and sizes of the bodies, so
//! that counters do not depend on the machine. Measured on one thread at 1.5 sphere partners per
//! body:
//!
//! - The grid is faster than all pairs from 64 bodies of one size on (both take 1.2 µs there)
//!   and, with a level per size, from about 100 bodies with radii 1 : 1000 on.
//! - The sweep took 1.4 to 9 times as long as the grid for 16 to 10,000 bodies in cubes, planes,
//!   lines and clusters, with one giant and with radii 1 : 1000. It is never picked.
//! - Neighbour lists took 0.42 to 0.66 of the grid's time for spheres of 10,000 bodies in a cube,
//!   a plane, clusters and with mixed radii, and up to 6 % more where bodies move too fast
//!   (Intel, AVX-512, runs in turns). They leave frames in which they don't pay to the grid, also
//!   decided by counts.

use super::Volume;
use crate::settings::Finder;

/// The most bodies for all pairs.
const MOST_FOR_ALL_PAIRS: usize = 64;

/// The most bodies for all pairs if radii span more than [`LEAST_LEVEL_RATIO`].
const MOST_MIXED_FOR_ALL_PAIRS: usize = 96;

/// The ratio of largest to smallest radius from which on the grid has levels.
const LEAST_LEVEL_RATIO: f32 = 16.0;

/// The facts of a scene by which a finder is picked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Population {
    /// Number of bodies.
    pub bodies: usize,
    /// Smallest and largest radius.
    pub radii: [f32; 2],
    /// Whether the first volume test is cheaper than finding candidates. It is for balls and slabs,
    /// but not for or-DOPs, which `all-pairs` would test for every pair.
    pub cheap_test: bool,
    /// The volume that balls stand for.
    pub volume: Volume,
}

impl Population {
    /// The finder for this scene; never [`Finder::Auto`].
    #[must_use]
    pub fn finder(&self) -> Finder {
        let [smallest, widest] = self.radii;
        let few = if widest > LEAST_LEVEL_RATIO * smallest {
            MOST_MIXED_FOR_ALL_PAIRS
        } else {
            MOST_FOR_ALL_PAIRS
        };
        if !self.cheap_test {
            Finder::Grid
        } else if self.bodies <= few {
            Finder::AllPairs
        } else {
            Finder::Neighbours
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Few bodies go to all pairs many to lists and dear tests to the grid.
    #[test]
    fn auto_picks_by_count_and_cost() {
        let pick = |bodies, widest, cheap_test| {
            let radii = [2.0, 2.0_f32 * widest];
            Population { bodies, radii, cheap_test, volume: Volume::Ball }.finder()
        };
        assert_eq!(pick(0, 1.0, true), Finder::AllPairs);
        assert_eq!(pick(64, 16.0, true), Finder::AllPairs);
        assert_eq!(pick(65, 16.0, true), Finder::Neighbours);
        assert_eq!(pick(96, 17.0, true), Finder::AllPairs);
        assert_eq!(pick(97, 17.0, true), Finder::Neighbours);
        assert_eq!(pick(2, 1.0, false), Finder::Grid);
    }
}
