//! Where seeded bodies start: uniform in the box, in clusters, or in a slice across it.

use super::file::Placement;
use crate::number::Positive;
use crate::random::Stream;

/// Places the sphere centres of one group.
pub(super) struct Placer {
    placement: Placement,
    half: f32,
    clusters: Vec<[f32; 3]>,
}

impl Placer {
    /// A placer for `count` spheres of radius up to `widest` in the box with walls at ±`half`;
    /// `draws` are the group's own.
    ///
    /// # Errors
    /// Clusters or a slice that don't fit: the problem and what would fit.
    pub(super) fn new(
        placement: Placement,
        count: usize,
        half: f32,
        widest: f32,
        draws: &mut Stream,
    ) -> Result<Self, (String, String)> {
        let side = 2.0 * half;
        let room = half - widest;
        let mut clusters = Vec::new();
        match placement {
            Placement::Uniform => {}
            Placement::Clusters { number, radius: Positive(radius) } => {
                // A u32 fits into the usize of every machine that holds such a scene.
                let number = number.get() as usize;
                if number > count {
                    let problem = format!("{number} clusters of {count} bodies");
                    return Err((problem, "a cluster has one body at least".to_owned()));
                }
                if radius > room {
                    let problem =
                        format!("clusters of radius {radius} don't fit into a box of side {side}");
                    return Err((problem, format!("the radius can be up to {room}")));
                }
                // Whole clusters inside of the walls, spheres included.
                clusters.extend((0..number).map(|_| point(draws, [room - radius; 3])));
            }
            Placement::Plane { thickness: Positive(thickness) } => {
                if thickness > 2.0 * room {
                    let problem = format!(
                        "a slice of thickness {thickness} doesn't fit into a box of side {side}"
                    );
                    return Err((problem, format!("the thickness can be up to {}", 2.0 * room)));
                }
            }
        }
        Ok(Self { placement, half, clusters })
    }

    /// The centre of a sphere with these draws: wholly inside of the box.
    pub(super) fn centre(&self, radius: f32, draws: &mut Stream) -> [f32; 3] {
        let limit = self.half - radius;
        match self.placement {
            Placement::Uniform => point(draws, [limit; 3]),
            Placement::Plane { thickness: Positive(thickness) } => {
                point(draws, [limit, limit, 0.5 * thickness])
            }
            Placement::Clusters { radius: Positive(spread), .. } => {
                // A u32 counted them, and there is one at least.
                let cluster = self.clusters[draws.index(self.clusters.len() as u32) as usize];
                let offset = draws.ball(spread);
                // Rounding may carry a centre an ulp beyond.
                [0, 1, 2].map(|axis| (cluster[axis] + offset[axis]).clamp(-limit, limit))
            }
        }
    }
}

/// A point uniform in the box of half sides `half` about the origin.
fn point(draws: &mut Stream, half: [f32; 3]) -> [f32; 3] {
    half.map(|h| draws.between(-h, h))
}
