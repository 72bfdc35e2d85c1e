//! Collision groups: which bodies may collide at all.

/// Which groups a body is in, and which it collides with: one bit per group.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)] // as `sdop.h` has it
pub struct Groups {
    /// The groups that the body is in.
    pub member: u32,
    /// The groups that it collides with.
    pub mask: u32,
}

impl Groups {
    /// In all groups, and collides with all: the default.
    pub const ALL: Self = Self::of(u32::MAX);

    /// In these groups, and collides with them. Made by a call, [`Self::ALL`] is a constant that
    /// cbindgen leaves to its configuration: what it writes for a literal isn't C++.
    const fn of(bits: u32) -> Self {
        Self { member: bits, mask: bits }
    }

    /// Whether a body collides with no other, whatever that is in.
    pub(crate) const fn collide_with_none(self) -> bool {
        self.member == 0 || self.mask == 0
    }

    /// Whether each of two bodies is in a group that the other collides with.
    #[inline(always)]
    #[must_use]
    pub const fn collide(self, other: Self) -> bool {
        (self.member & other.mask != 0) & (other.member & self.mask != 0)
    }
}

impl Default for Groups {
    fn default() -> Self {
        Self::ALL
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bodies collide when each is in a group that the other collides with.
    #[test]
    fn groups_must_collide_mutually() {
        for (member, mask) in [(0b01, 0b10), (0b10, 0b01), (0b01, 0b01)] {
            let one = Groups { member, mask };
            for other in (0..16).map(|bits| Groups { member: bits & 3, mask: bits >> 2 }) {
                let sees =
                    |a: Groups, b: Groups| (0..2).any(|i| a.mask >> i & b.member >> i & 1 == 1);
                let expected = sees(one, other) && sees(other, one);
                assert_eq!(one.collide(other), expected, "{one:?} and {other:?}");
                assert_eq!(other.collide(one), expected, "{other:?} and {one:?}");
            }
        }
        assert!(Groups::ALL.collide(Groups::default()));
    }
}
