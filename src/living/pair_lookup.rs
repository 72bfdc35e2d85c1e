//! A look-up of whether a pair was reported, for engines that call back pair by pair.

use super::{BodyId, LivingSet, VolumeSource};

/// The pairs of one cull, ordered by the slot of their first body.
///
/// ```
/// use sdop::living::PairLookup;
/// # use sdop::{Aabb, BoxWorld};
/// # let mut world = BoxWorld::new();
/// # let at = |x: f32| Aabb::new([x, 0.0, 0.0], [x + 1.0, 1.0, 1.0]);
/// let [a, b, c] = [world.insert(at(0.0))?, world.insert(at(0.5))?, world.insert(at(9.0))?];
/// world.cull()?;
/// let mut lookup = PairLookup::default();
/// lookup.refill(&world);
/// assert!(lookup.contains(b, a) && !lookup.contains(a, c));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct PairLookup {
    /// The start of the pairs of each range of first slots, with one more entry than ranges.
    starts: Vec<usize>,
    /// The number of slots in a range, as a power of two.
    range_bits: u32,
    pairs: Vec<[BodyId; 2]>,
}

impl PairLookup {
    /// Replaces its pairs by those of the world's last cull.
    pub fn refill<V: VolumeSource>(&mut self, world: &LivingSet<V>) {
        self.pairs.clear();
        self.pairs.extend(world.pairs());
        // About one range per body, whatever the slots.
        let last = self.pairs.last().map_or(0, |[first, _]| first.slot());
        self.range_bits = (last / world.len().max(1)).checked_ilog2().map_or(0, |bits| bits + 1);
        self.starts.clear();
        self.starts.resize((last >> self.range_bits) + 2, 0);
        for [first, _] in &self.pairs {
            self.starts[(first.slot() >> self.range_bits) + 1] += 1;
        }
        let mut end = 0;
        for start in &mut self.starts {
            end += *start;
            *start = end;
        }
    }

    /// Whether the pair was reported, in either order. A body that was removed before that cull is
    /// in no pair.
    #[must_use]
    pub fn contains(&self, a: BodyId, b: BodyId) -> bool {
        let pair = if a.slot <= b.slot { [a, b] } else { [b, a] };
        let range = pair[0].slot() >> self.range_bits;
        match self.starts.get(range..range + 2) {
            Some(&[start, end]) => self.pairs[start..end].contains(&pair),
            _ => false,
        }
    }
}
