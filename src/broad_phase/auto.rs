//! `auto`: which finder suits a scene.
//!
//! Picked once, before the first frame, by numbers of the scene alone, so that counters depend on
//! no machine. Measured on one thread at 1.5 sphere partners per body: the grid passes all pairs at
//! 64 bodies of one size (both 1.2 µs) and, with a level for each size, at about 100 of radii 1
//! : 1000. The sweep stayed behind the grid at every number of bodies from 16 to 10,000, in cubes,
//! planes, lines and clusters, with one giant and with radii 1 : 1000 (1.4 to 9 times), so it is
//! there to be compared with and never picked. Neighbour lists leave the frames in which they don't
//! pay to the grid, by counts as well: frames of spheres took 0.42 to 0.66 of the grid's time on
//! 10,000 bodies in a cube, a plane, clusters and with mixed radii, and up to 6 % more where bodies
//! move too fast (an Intel with AVX-512, runs in turns).

use super::Volume;
use crate::settings::Finder;

/// The most bodies for all pairs.
const FEW: usize = 64;

/// The same where radii span more than [`MANY_SIZES`].
const FEW_OF_MANY_SIZES: usize = 96;

/// Widest over smallest radius at which the grid has levels.
const MANY_SIZES: f32 = 16.0;

/// What of a scene decides which finder suits it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Population {
    /// Number of bodies.
    pub bodies: usize,
    /// Smallest and widest ball.
    pub radii: [f32; 2],
    /// Whether the first volume test is cheaper than looking for candidates: balls and slabs are,
    /// or-DOPs aren't, and all pairs would hand every pair to them.
    pub cheap_test: bool,
    /// What balls stand for.
    pub volume: Volume,
}

impl Population {
    /// The finder that suits it; never [`Finder::Auto`].
    #[must_use]
    pub fn finder(&self) -> Finder {
        let [smallest, widest] = self.radii;
        let few = if widest > MANY_SIZES * smallest {
            FEW_OF_MANY_SIZES
        } else {
            FEW
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

    #[test]
    fn few_bodies_go_to_all_pairs_many_to_lists_and_dear_tests_to_the_grid() {
        let pick = |bodies, widest, cheap_test| {
            let radii = [2.0, 2.0_f32 * widest];
            Population {
                bodies,
                radii,
                cheap_test,
                volume: Volume::Ball,
            }
            .finder()
        };
        assert_eq!(pick(0, 1.0, true), Finder::AllPairs);
        assert_eq!(pick(64, 16.0, true), Finder::AllPairs);
        assert_eq!(pick(65, 16.0, true), Finder::Neighbours);
        assert_eq!(pick(96, 17.0, true), Finder::AllPairs);
        assert_eq!(pick(97, 17.0, true), Finder::Neighbours);
        assert_eq!(pick(2, 1.0, false), Finder::Grid);
    }
}
