//! The cache that holds the data of a frame. It follows from the number of bodies, and is part of a
//! price's regime.

use crate::measure::machine::caches;
use sdop::choice::choices;

/// Approximate bytes per body that a frame reads or writes: the pose (28), the ball in its place
/// and in its slot (32), two names (8) and the or-DOP's row (64). It is the same for every volume,
/// so that all strategies of a scene have one level.
const BYTES_PER_BODY: usize = 132;
/// The sizes of the levels if the system doesn't report them: 32 kB, 1 MB and 32 MB.
const USUAL_BYTES: [usize; 3] = [32 << 10, 1 << 20, 32 << 20];

choices! {
    /// The smallest cache that holds the data of a frame.
    CacheLevel, "cache level", {
        /// The first level.
        L1 = "L1",
        /// The second level.
        L2 = "L2",
        /// The third level.
        L3 = "L3",
        /// No cache.
        Memory = "memory",
    }
}

impl CacheLevel {
    /// The level of this number of bodies on this machine.
    #[must_use]
    pub fn of(bodies: usize) -> Self {
        Self::among(bodies, cache_bytes())
    }

    fn among(bodies: usize, caches: [usize; 3]) -> Self {
        let holds = |level: &&Self| bodies <= level.most_bodies(caches);
        Self::ALL.iter().find(holds).copied().unwrap_or(Self::Memory)
    }

    /// The fewest and the most bodies of this level on this machine.
    #[must_use]
    pub fn bodies(self) -> [usize; 2] {
        let (caches, place) = (cache_bytes(), self as usize);
        let below = Self::ALL[..place].last();
        let fewest = below.map_or(0, |level| level.most_bodies(caches)) + 1;
        [fewest, self.most_bodies(caches).max(fewest)]
    }

    fn most_bodies(self, caches: [usize; 3]) -> usize {
        let bytes = caches.get(self as usize);
        bytes.map_or(usize::MAX, |bytes| bytes / BYTES_PER_BODY)
    }
}

/// The sizes of the three levels, from the first on.
fn cache_bytes() -> [usize; 3] {
    let mut found = USUAL_BYTES;
    for (level, size) in caches() {
        let place = level.checked_sub(1).and_then(|place| found.get_mut(place));
        if let (Some(place), Some(bytes)) = (place, bytes(&size)) {
            *place = bytes;
        }
    }
    found
}

/// A size as Linux writes it: "1024K".
fn bytes(text: &str) -> Option<usize> {
    let (number, unit) = match text.strip_suffix('K') {
        Some(number) => (number, 1 << 10),
        None => (text.strip_suffix('M')?, 1 << 20),
    };
    Some(number.parse::<usize>().ok()? * unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A level ends where its cache is full.
    #[test]
    fn level_ends_with_its_cache() {
        let caches = [132 * 10, 132 * 100, 132 * 1000];
        for (bodies, level) in [
            (0, CacheLevel::L1),
            (10, CacheLevel::L1),
            (11, CacheLevel::L2),
            (100, CacheLevel::L2),
            (101, CacheLevel::L3),
            (1000, CacheLevel::L3),
            (1001, CacheLevel::Memory),
        ] {
            assert_eq!(CacheLevel::among(bodies, caches), level, "{bodies}");
        }
    }

    /// The levels of this machine follow one another.
    #[test]
    fn levels_of_this_machine_ascend() {
        let mut next = 1;
        for &level in CacheLevel::ALL {
            let [fewest, most] = level.bodies();
            assert_eq!(fewest, next);
            assert_eq!([fewest, most].map(CacheLevel::of), [level; 2]);
            next = most.saturating_add(1);
        }
    }

    /// Sizes are read as linux writes them.
    #[test]
    fn linux_sizes_are_read() {
        assert_eq!(bytes("32K"), Some(32 << 10));
        assert_eq!(bytes("8M"), Some(8 << 20));
        assert_eq!(bytes("K"), None);
        assert_eq!(bytes("12"), None);
    }
}
