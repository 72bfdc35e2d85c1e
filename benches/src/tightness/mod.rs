//! The size of every volume compared with that of the convex hull, the smallest convex volume.

mod polytope;

pub use polytope::{PolytopeVolume, mean_world_aligned_volume};

use serde::{Deserialize, Serialize};

use sdop::volume::{Axes, DirectionSet, Hull, OrDop, Shape};

/// Random rotations over which the volumes that are re-fitted each frame are averaged.
pub const TURNS: u32 = 64;

/// The size of one bounding volume.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Size {
    /// The volume: `sphere`, `aabb`, `k-dop-18`, `obb`, `or-dop-18-principal` …
    pub name: String,
    /// Cubic units of length; of world-aligned volumes the mean over 64 rotations.
    pub volume: f64,
    /// The same over the hull's; absent for a flat mesh, whose hull has no volume.
    pub over_hull: Option<f64>,
}

impl Size {
    /// Every volume of a shape, the sphere first.
    #[must_use]
    pub fn of_all(shape: &Shape, hull: &Hull) -> Vec<Self> {
        let hull_volume = hull.volume(&shape.vertices);
        let size = |name: String, volume: f64| Self {
            name,
            volume: volume + 0.0, // no −0
            over_hull: (hull_volume > 0.0).then(|| volume / hull_volume),
        };
        let corners: Vec<_> = hull.vertices.iter().map(|&v| shape.vertices[v as usize]).collect();
        let mut sizes = vec![size("sphere".to_owned(), shape.ball.volume())];
        for &directions in DirectionSet::ALL {
            let name = match directions {
                DirectionSet::K6 => "aabb".to_owned(),
                _ => format!("k-dop-{directions}"),
            };
            let volume = mean_world_aligned_volume(&corners, directions, TURNS);
            sizes.push(size(name, volume));
        }
        sizes.push(size("obb".to_owned(), shape.obb(hull).volume()));
        for &axes in Axes::ALL {
            let basis = axes.basis(&shape.vertices);
            for &directions in DirectionSet::ALL {
                let ordop = OrDop::build(&corners, basis, directions);
                let name = format!("or-dop-{directions}-{axes}");
                sizes.push(size(name, ordop.volume()));
            }
        }
        sizes
    }
}
