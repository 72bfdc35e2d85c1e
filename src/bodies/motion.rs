//! Whether a body moves.

/// Whether a body moves, rests or never moves. Pairs of two fixed bodies are never reported; all
/// other pairs are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Motion {
    /// It moves, or may move at any time.
    #[default]
    Dynamic,
    /// It does not move at present, for example because it is asleep. Its pairs stay, also those
    /// with other resting and with fixed bodies. Waking it neither begins nor ends a pair.
    Resting,
    /// It never moves, like scenery.
    Fixed,
}

impl Motion {
    /// The motion of a body that is dynamic or fixed, and, unless fixed, at rest or not.
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
