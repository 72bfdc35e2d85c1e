//! Every pair of interest of every frame, with its flags.

use super::{ShownRun, ShownStrategy};
use sdop::culler::CullError;

/// The spheres of the pair overlap.
const SPHERES: u8 = 1;
/// The meshes meet, in exact arithmetic.
const MEETS: u8 = 2;
/// The first strategy reports it; the next bit is the second strategy's.
const REPORTED: u8 = 4;

/// The pairs of all frames, one frame after the other.
#[derive(Debug, Default, PartialEq)]
pub struct Pairs {
    /// The first pair of each frame, and the number of all.
    pub starts: Vec<usize>,
    /// Sorted within a frame.
    pub pairs: Vec<[u32; 2]>,
    /// The flags of each pair.
    pub flags: Vec<u8>,
}

impl Pairs {
    /// Joins the pairs of spheres, truth and strategies.
    ///
    /// # Errors
    /// Never for a record that was read: the sphere strategy needs no settings.
    pub fn join(show: &ShownRun, culled: &[ShownStrategy]) -> Result<Self, CullError> {
        let spheres = show.spheres()?;
        let mut joined = Self::default();
        for (at, frame) in show.frames.iter().enumerate() {
            let mut all: Vec<([u32; 2], u8)> = Vec::new();
            let mut list =
                |pairs: &[[u32; 2]], flag: u8| all.extend(pairs.iter().map(|&pair| (pair, flag)));
            list(&spheres.pairs[at], SPHERES);
            list(frame.meets.as_deref().unwrap_or_default(), MEETS);
            for (side, culled) in culled.iter().enumerate() {
                list(&culled.pairs[at], REPORTED << side);
            }
            all.sort_unstable();
            joined.starts.push(joined.pairs.len());
            for same in all.chunk_by(|a, b| a.0 == b.0) {
                joined.pairs.push(same[0].0);
                joined.flags.push(same.iter().fold(0, |flags, (_, flag)| flags | flag));
            }
        }
        joined.starts.push(joined.pairs.len());
        Ok(joined)
    }
}
