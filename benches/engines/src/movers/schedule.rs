//! The cases of the table, and how many frames each has.

use std::fmt::{self, Display, Formatter};

use serde::Serialize;

use super::Args;
use super::course::Motion;
use crate::entry::Work;
use crate::incremental::{MoverEntry, Only};

/// A case with more movers than this is timed for fewer frames.
const MOVERS_OF_ALL_FRAMES: usize = 300_000;

/// Bodies of which some move.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct MoverCase {
    /// All bodies.
    pub bodies: usize,
    /// Those that move in a frame.
    pub movers: usize,
    /// Which ones move.
    pub motion: Motion,
    /// Meshes, or boxes.
    pub meshes: bool,
    /// Frames before the clock counts.
    pub warm_up: usize,
    /// Frames that are timed.
    pub timed: usize,
    /// Frames that one engine does before it is the next one's turn.
    pub turn: usize,
}

impl MoverCase {
    /// With as many frames as such a case gets.
    pub fn new(bodies: usize, movers: usize, motion: Motion, meshes: bool) -> Self {
        let most = if bodies > 100_000 { 60 } else { 300 };
        let timed = (MOVERS_OF_ALL_FRAMES / movers.max(1)).clamp(30, most);
        Self {
            bodies,
            movers,
            motion,
            meshes,
            warm_up: 20,
            timed,
            turn: if timed > 60 { 20 } else { 10 },
        }
    }

    /// Whether an engine takes part.
    pub fn has(&self, entry: &MoverEntry) -> bool {
        let is_replacement = self.motion == Motion::Replaced;
        match entry.only {
            _ if self.meshes != (entry.work == Work::SDop) => false,
            _ if self.bodies > entry.most_bodies => false,
            Some(Only::Replacement) => is_replacement,
            Some(Only::ReadPairs) => {
                self.motion == Motion::Same && self.movers * 100 == self.bodies
            }
            Some(Only::Meshes) => true,
            None => !is_replacement,
        }
    }

    /// The frames of each turn: two of one frame, by which answers are checked, then whole ones.
    pub fn turns(&self) -> Vec<usize> {
        let mut turns = vec![1, 1];
        let mut left = self.warm_up + self.timed - 2;
        while left > 0 {
            let next = if left > self.timed { left - self.timed } else { self.turn.min(left) };
            turns.push(next);
            left -= next;
        }
        turns
    }
}

impl Display for MoverCase {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let what = if self.meshes { "meshes" } else { "boxes" };
        let (motion, movers) = (self.motion.name(), self.movers);
        write!(f, "{} {what}, {movers} movers, {motion}", self.bodies)
    }
}

/// All cases in order.
pub fn cases(args: &Args) -> Vec<MoverCase> {
    if args.quick {
        return quick_cases();
    }
    let mut cases = Vec::new();
    for &bodies in &args.sizes {
        for share in shares(args, bodies) {
            let movers = (bodies * share / 1000).max(1);
            for motion in motions(args, bodies, share) {
                cases.push(MoverCase::new(bodies, movers, motion, false));
            }
        }
        if args.motions.is_none() {
            cases.extend(further_cases(bodies));
        }
    }
    cases
}

/// Movers in thousandths: fewer cases with a million bodies, which take long to build.
fn shares(args: &Args, bodies: usize) -> Vec<usize> {
    match &args.shares {
        Some(shares) => shares.clone(),
        None if bodies > 100_000 => vec![1, 10, 1000],
        None => vec![1, 10, 50, 200, 1000],
    }
}

/// The motions of a share: with all moving there is one.
fn motions(args: &Args, bodies: usize, share: usize) -> Vec<Motion> {
    match &args.motions {
        Some(motions) => motions.clone(),
        None if share == 1000 || (bodies > 100_000 && share > 1) => vec![Motion::Same],
        None if share == 10 && bodies == 100_000 => {
            vec![Motion::Same, Motion::Fresh, Motion::Wave, Motion::Teleport]
        }
        None => vec![Motion::Same, Motion::Fresh],
    }
}

/// Cases beyond the shares.
fn further_cases(bodies: usize) -> Vec<MoverCase> {
    match bodies {
        100_000 => vec![
            MoverCase::new(bodies, 10, Motion::Same, false),
            MoverCase {
                timed: 60,
                turn: 20,
                ..MoverCase::new(bodies, bodies, Motion::Waking, false)
            },
            MoverCase::new(bodies, 1, Motion::Replaced, false),
            MoverCase::new(bodies, 100, Motion::Same, true),
            MoverCase::new(bodies, 100, Motion::Fresh, true),
        ],
        1_000_000 => vec![MoverCase {
            timed: 300,
            turn: 20,
            ..MoverCase::new(bodies, 1, Motion::Replaced, false)
        }],
        _ => Vec::new(),
    }
}

/// A few frames of each kind.
fn quick_cases() -> Vec<MoverCase> {
    let case = |movers, motion, meshes| MoverCase {
        timed: 20,
        turn: 10,
        ..MoverCase::new(10_000, movers, motion, meshes)
    };
    vec![
        case(100, Motion::Same, false),
        case(1000, Motion::Fresh, false),
        case(10_000, Motion::Waking, false),
        case(100, Motion::Teleport, false),
        case(1, Motion::Replaced, false),
        case(100, Motion::Fresh, true),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Turns have all frames, and none has both timed and other ones.
    #[test]
    fn turns_split_at_the_first_timed_frame() {
        for movers in [1, 1000, 100_000] {
            let case = MoverCase::new(100_000, movers, Motion::Same, false);
            let turns = case.turns();
            assert_eq!(turns[..2], [1, 1]);
            assert_eq!(turns[..3].iter().sum::<usize>(), case.warm_up);
            assert_eq!(turns.iter().sum::<usize>(), case.warm_up + case.timed);
        }
    }
}
