//! Whether a body moves.

/// What a body may do. Pairs of two fixed bodies are never reported; all others are, whatever the
/// two do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Motion {
    /// It moves, or may at any time.
    #[default]
    Dynamic,
    /// It lies still for the time being: asleep, say. Its pairs stay, also those with others at
    /// rest and with fixed ones, and waking it changes none.
    Resting,
    /// It is scenery.
    Fixed,
}

impl Motion {
    /// Of a body that is dynamic or fixed, and, unless fixed, at rest or not.
    pub(crate) const fn of(is_dynamic: bool, is_resting: bool) -> Self {
        match (is_dynamic, is_resting) {
            (false, _) => Self::Fixed,
            (true, true) => Self::Resting,
            (true, false) => Self::Dynamic,
        }
    }

    /// Whether pairs with a fixed body are reported.
    #[must_use]
    pub const fn is_dynamic(self) -> bool {
        !matches!(self, Self::Fixed)
    }
}
