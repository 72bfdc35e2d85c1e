//! When a list pays, and with which skin: by counts of frames and pairs and by how far bodies got, so that no choice depends on
//! the machine.
//!
//! A skin is so many radii σ: of each body's own, or the same length for all, in [typical radii](super::motion). Where the small
//! move as fast as the wide, their own radii are soon used up, and a length lasts. The body that got farthest by the end of a list
//! tells how long another list would have lasted: σ/v frames and one more. A wider skin makes fewer lists, each of (1 + σ)³ as
//! many pairs, from as many more candidates.

use super::motion::Motion;
use crate::rounding::skin::Skin;

/// Skins to choose from, in radii. With wider ones than these the frame that makes a list takes more than 1.3 of the grid's.
const SKINS: [f64; 6] = [0.0625, 0.125, 0.1875, 0.25, 0.3125, 0.375];

/// The first one, before anything is known of the motion.
const FIRST: usize = 3;

/// Costs in instructions of AVX2 (10,000 uniform bodies, spheres): to sort a body; to look at a candidate, in a frame of the
/// grid and in one that makes a list; to follow a list, a body and a pair.
const SORT: f64 = 160.0;
const SEARCH: f64 = 25.0;
const MAKE: f64 = 13.0;
const FOLLOW: f64 = 35.0;
const PAIR: f64 = 25.0;

/// A list must promise to take at most this share of the grid's time: where it hardly pays, it may as well cost.
const WORTH: f64 = 0.8;

/// By how much skins by other radii must be cheaper than those at hand: where all bodies have one size both are the same.
const WORTH_CHANGING: f64 = 0.9;

/// Frames of the grid between two attempts: at first, and at most.
const PAUSE: u32 = 16;
const LONGEST_PAUSE: u32 = 256;

/// Whose radii a skin is measured in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Radii {
    Own,
    Typical,
}

/// What is known of the motion.
#[derive(Clone, Debug)]
pub struct Policy {
    radii: Radii,
    skin: usize,
    /// The typical radius.
    typical: f64,
    /// Frames that the present list has served.
    served: u32,
    /// Frames of the grid to come.
    wait: u32,
    /// How many there will be after the next failure.
    pause: u32,
}

impl Default for Policy {
    fn default() -> Self {
        Self {
            radii: Radii::Own,
            skin: FIRST,
            typical: 0.0,
            served: 0,
            // The first frame places bodies and isn't searched.
            wait: 1,
            pause: PAUSE,
        }
    }
}

/// What is known of a list that can't be followed any longer.
#[derive(Clone, Copy, Debug)]
pub struct Ended {
    /// Its pairs.
    pub pairs: usize,
    /// The candidates that it was made of.
    pub candidates: u64,
    /// Bodies.
    pub bodies: usize,
    /// How far they got.
    pub motion: Motion,
    /// The typical radius.
    pub typical: f64,
}

impl Policy {
    /// The skin of the list at hand.
    pub fn skin(&self) -> Skin {
        let share = SKINS[self.skin];
        match self.radii {
            Radii::Own => Skin::share(share as f32),
            Radii::Typical => Skin::length((share * self.typical) as f32),
        }
    }

    /// How many times the pairs and candidates of a list without a skin the one at hand has.
    pub fn wider(&self) -> f64 {
        wider(self.skin)
    }

    /// How many times the pairs of the list at hand one with the widest skin has.
    pub fn widest(&self) -> f64 {
        wider(SKINS.len() - 1) / self.wider()
    }

    /// The skin of a list to be made in this frame, if it is to be made.
    pub fn next(&mut self) -> Option<Skin> {
        if self.wait > 0 {
            self.wait -= 1;
            return None;
        }
        self.served = 1;
        Some(self.skin())
    }

    /// The list has served another frame.
    pub fn followed(&mut self) {
        self.served += 1;
    }

    /// The list can't be followed any longer.
    pub fn ended(&mut self, list: &Ended) {
        let [own, typical] = self.speeds(list.motion);
        // A body's, if there were no skin.
        let [pairs, candidates] = [list.pairs as f64, list.candidates as f64]
            .map(|number| number / list.bodies.max(1) as f64 / self.wider());
        let mut best = (f64::INFINITY, self.radii, 0);
        for (radii, speed) in [(Radii::Own, own), (Radii::Typical, typical)] {
            for (index, skin) in SKINS.into_iter().enumerate() {
                let frames = (skin / speed).floor() + 1.0;
                let make = SORT + MAKE * candidates * wider(index);
                let cost = make / frames + FOLLOW + PAIR * pairs * wider(index);
                let penalty = if radii == self.radii { 1.0 } else { 1.0 / WORTH_CHANGING };
                if cost * penalty < best.0 {
                    best = (cost * penalty, radii, index);
                }
            }
        }
        (self.radii, self.skin, self.typical) = (best.1, best.2, list.typical);
        if best.0 < WORTH * (SORT + SEARCH * candidates) {
            self.pause = PAUSE;
        } else {
            // Of a list that served one frame alone the widest skin tells most.
            self.skin = SKINS.len() - 1;
            self.give_up();
        }
    }

    /// How many radii the fastest body moves in a frame, own ones and typical ones.
    fn speeds(&self, Motion { own, common }: Motion) -> [f64; 2] {
        let served = f64::from(self.served);
        let (skin, drift) = match self.radii {
            Radii::Own => (SKINS[self.skin], own),
            Radii::Typical => (SKINS[self.skin], common),
        };
        // A body that has just used up its skin is within two of them, if it goes straight on. Beyond, it has jumped, and tells
        // nothing of the others.
        if self.served > 1 && drift > 2.0 * skin {
            let speed = skin / (served - 0.5);
            return match self.radii {
                Radii::Own => [speed, f64::INFINITY],
                Radii::Typical => [f64::INFINITY, speed],
            };
        }
        [own / served, common / served]
    }

    /// The list was of other bodies.
    pub fn interrupted(&mut self) {
        // Where bodies come and go in every frame, no list is worth its making.
        if self.served < 2 {
            self.give_up();
        }
    }

    /// The list would have had too many pairs.
    pub fn overflowed(&mut self) {
        (self.radii, self.skin) = (Radii::Own, 0);
        self.give_up();
    }

    fn give_up(&mut self) {
        self.wait = self.pause;
        self.pause = LONGEST_PAUSE.min(2 * self.pause);
    }
}

/// How many times the pairs a skin brings.
fn wider(skin: usize) -> f64 {
    (1.0 + SKINS[skin]).powi(3)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What 2000 frames come to in which the fastest body moves by `speed` radii each, where a list without a skin has `each`
    /// pairs a body: lists made, frames that one served, and the last one's skin.
    fn frames(speed: f64, each: f64) -> (u32, u32, f32) {
        let (mut policy, mut drift) = (Policy::default(), None);
        let (mut made, mut served) = (0, 0);
        for _ in 0..2000 {
            if let Some(drift) = &mut drift {
                *drift += speed;
                if *drift < f64::from(policy.skin()) {
                    policy.followed();
                    served += 1;
                    continue;
                }
                let wider = f64::from(1.0 + policy.skin()).powi(3);
                let pairs = 1000.0 * each * wider;
                policy.ended(pairs as usize, (6.0 * pairs) as u64, 1000);
            }
            drift = policy.next().map(|_| 0.0);
            if drift.is_some() {
                (made, served) = (made + 1, served + 1);
            }
        }
        (made, served, policy.skin())
    }

    #[test]
    fn slow_bodies_are_followed_and_fast_ones_searched_for() {
        let mut widest = 0.0;
        for speed in [0.0, 0.001, 0.01, 0.03, 0.1] {
            let (made, served, skin) = frames(speed, 0.75);
            assert!(served >= 1990, "{speed}: {served}");
            assert!(
                f64::from(made) <= 2000.0 * speed / 0.06 + 2.0,
                "{speed}: {made}"
            );
            assert!(speed == 0.0 || skin >= widest, "{speed}: {skin}");
            widest = if speed == 0.0 { 0.0 } else { skin };
        }
        for speed in [1.0, 100.0] {
            let (made, served, _) = frames(speed, 0.75);
            assert!(made < 20 && served == made, "{speed}: {made}, {served}");
        }
    }

    #[test]
    fn a_list_that_was_too_long_is_tried_again_seldom() {
        let mut policy = Policy::default();
        let made = (0..4000).filter(|_| {
            let made = policy.next().is_some();
            if made {
                policy.overflowed();
            }
            made
        });
        assert!((12..24).contains(&made.count()));
    }

    /// Of a million bodies whose list with this skin served so many frames: the skin of the next one, up to so many pairs and
    /// with a pair more, each with so many candidates. No skin is the grid's frames.
    #[test]
    fn the_next_skin_is_the_cheapest_to_the_pair() {
        for (skin, served, candidates, pairs, next) in [
            (3, 2, 6, 2_049_862, [Some(5), Some(2)]),
            (3, 3, 4, 5_873_068, [Some(4), Some(1)]),
            (0, 2, 5, 551_140, [Some(5), Some(3)]),
            (3, 10, 6, 727_566, [Some(4), Some(3)]),
            (3, 30, 6, 13_828_056, [Some(1), Some(0)]),
            (5, 100, 10, 756_009, [Some(2), Some(1)]),
            (2, 5, 0, 2_493_326, [Some(1), None]),
            (3, 2, 3, 1_997_515, [Some(5), None]),
            (4, 2, 1, 707_861, [Some(3), None]),
            (0, 1, 3, 4_640_293, [Some(1), None]),
        ] {
            for (more, next) in (0..).zip(next) {
                let mut policy = Policy {
                    skin,
                    served,
                    wait: 0,
                    pause: PAUSE,
                };
                let pairs = pairs + more;
                policy.ended(pairs, candidates * pairs as u64, 1_000_000);
                let found = policy
                    .next()
                    .map(|found| SKINS.iter().position(|&skin| skin == found));
                assert_eq!(found, next.map(Some), "{skin}, {served}: {pairs}");
            }
        }
    }
}
