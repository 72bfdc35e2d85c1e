//! S-DOP for an object of interest (paper, section 4c): pairs with a body of interest are refined, the rest is left to
//! the spheres.

use super::{Stage, sequential};

pub(super) fn cull(stage: &mut Stage<'_>) {
    sequential::flow(stage, Some(stage.interest));
}
