//! Periodic axes against exact truth: each pair of which an image meets is reported once.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod borders;
mod boxes;
mod misuse;
mod queries;

use sdop::periodic::{PeriodicBox, PeriodicBoxes, PeriodicPair};
use sdop::world::PeriodicWorld;
use sdop::{Body, BodyId, Groups, Motion};

use sdop_judge::draw::random::Random;

const UNTURNED: [f32; 4] = [0.0, 0.0, 0.0, 1.0];

/// The periods of each set of axes, with these lengths.
fn subsets(lengths: [f64; 3]) -> impl Iterator<Item = [Option<f64>; 3]> {
    (0..8).map(move |axes| [0, 1, 2].map(|axis| (axes >> axis & 1 == 1).then_some(lengths[axis])))
}

/// A double in [0, 1) with all of its bits.
fn unit(random: &mut Random) -> f64 {
    f64::from(random.unit()) + f64::from(random.unit()) / f64::from(1 << 24)
}

fn groups(random: &mut Random) -> Groups {
    let only = |member, mask| Groups { member, mask };
    [Groups::ALL, Groups::ALL, only(1, 2), only(2, 3)][random.below(4)]
}

fn motion(random: &mut Random) -> Motion {
    [Motion::Dynamic, Motion::Resting, Motion::Fixed][random.below(3)]
}
