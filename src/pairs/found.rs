//! The partners of some bodies, as a search finds them and tests thin them out.

/// Bodies that have changed, and the partners that were found for each.
#[derive(Clone, Debug, Default)]
pub struct FoundPartners {
    /// The bodies. The first `present` of them exist; the others are gone, and have no partners.
    pub bodies: Vec<u32>,
    pub present: usize,
    /// The partners of all bodies in one list, and the end of each body's part.
    pub partners: Vec<u32>,
    pub ends: Vec<usize>,
}

impl FoundPartners {
    /// The bodies that exist.
    pub fn present(&self) -> &[u32] {
        &self.bodies[..self.present]
    }

    /// Each body and its partners.
    pub fn iter(&self) -> impl Iterator<Item = (u32, &[u32])> {
        let starts = [0].into_iter().chain(self.ends.iter().copied());
        let parts = starts.zip(&self.ends).map(|(start, &end)| &self.partners[start..end]);
        self.bodies.iter().copied().zip(parts)
    }

    /// Keeps partners in their order. `is_kept` gets the body's number, the partner's number in the
    /// list, and the partner.
    #[inline(always)]
    pub fn retain(&mut self, mut is_kept: impl FnMut(usize, usize, u32) -> bool) {
        let (mut start, mut kept) = (0, 0);
        for (number, end) in self.ends.iter_mut().enumerate() {
            for at in std::mem::replace(&mut start, *end)..*end {
                if is_kept(number, at, self.partners[at]) {
                    self.partners[kept] = self.partners[at];
                    kept += 1;
                }
            }
            *end = kept;
        }
        self.partners.truncate(kept);
    }
}
