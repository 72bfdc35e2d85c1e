//! Collision groups: which bodies may collide at all.

/// Bits of the groups that a body is in, and of those that it collides with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Groups {
    /// The groups that the body is in.
    pub member: u32,
    /// The groups that it collides with.
    pub mask: u32,
}

impl Groups {
    /// In all groups, colliding with all.
    pub const ALL: Self = Self {
        member: u32::MAX,
        mask: u32::MAX,
    };

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
