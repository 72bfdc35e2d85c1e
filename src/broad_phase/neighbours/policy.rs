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

/// Costs in instructions of AVX2, what it takes to name pairs included: lines through the counts of frames of 4,000 uniform spheres
/// with 2 to 18 candidates each, update excepted.
///
/// The grid's frame, a body and a candidate.
const SORT: f64 = 240.0;
const SEARCH: f64 = 9.5;
/// What a frame that makes a list takes beyond one that follows it.
const MAKE: f64 = 260.0;
const COLLECT: f64 = 11.0;
/// A frame of a list, a body and a pair.
const FOLLOW: f64 = 35.0;
const PAIR: f64 = 14.0;

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
                let make = MAKE + COLLECT * candidates * wider(index);
                let cost = make / frames + FOLLOW + PAIR * pairs * wider(index);
                let penalty = if radii == self.radii {
                    1.0
                } else {
                    1.0 / WORTH_CHANGING
                };
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
    fn speeds(&self, Motion { own, typical }: Motion) -> [f64; 2] {
        let served = f64::from(self.served);
        let (skin, drift) = match self.radii {
            Radii::Own => (SKINS[self.skin], own),
            Radii::Typical => (SKINS[self.skin], typical),
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
        [own / served, typical / served]
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

    impl Policy {
        /// That makes its first list with a skin of so many radii, all of this size.
        pub(in super::super) fn of_typical(typical: f64) -> Self {
            Self {
                radii: Radii::Typical,
                typical,
                ..Self::default()
            }
        }
    }

    /// A list of a million bodies that ended.
    fn list(pairs: usize, candidates: u64, [own, typical]: [f64; 2]) -> Ended {
        Ended {
            pairs,
            candidates,
            bodies: 1_000_000,
            motion: Motion { own, typical },
            typical: 2.0,
        }
    }

    /// What 2000 frames come to in which the fastest body moves by so many radii each, its own or typical ones, where a list
    /// without a skin has 0.75 pairs a body: lists made, frames that one served, and the policy by then.
    fn frames(speeds: [f64; 2]) -> (u32, u32, Policy) {
        let (mut policy, mut since) = (Policy::default(), None);
        let (mut made, mut served) = (0, 0);
        for _ in 0..2000 {
            if let Some(since) = &mut since {
                *since += 1;
                let drifts = speeds.map(|speed| speed * f64::from(*since));
                let [own, typical] = drifts;
                let drift = if policy.radii == Radii::Own {
                    own
                } else {
                    typical
                };
                if drift < SKINS[policy.skin] {
                    policy.followed();
                    served += 1;
                    continue;
                }
                let pairs = 750_000.0 * policy.wider();
                policy.ended(&list(pairs as usize, (6.0 * pairs) as u64, drifts));
            }
            since = policy.next().map(|_| 0);
            if since.is_some() {
                (made, served) = (made + 1, served + 1);
            }
        }
        (made, served, policy)
    }

    #[test]
    fn slow_bodies_are_followed_and_fast_ones_searched_for() {
        let mut before = 0;
        for speed in [0.0, 0.001, 0.01, 0.03, 0.1] {
            let (made, served, _) = frames([speed; 2]);
            assert!(served >= 1990, "{speed}: {served}");
            assert!(
                f64::from(made) <= 2000.0 * speed / 0.06 + 2.0,
                "{speed}: {made}"
            );
            assert!(made >= before, "{speed}: {made}, and {before} when slower");
            before = made;
        }
        for speed in [1.0, 100.0] {
            let (made, served, _) = frames([speed; 2]);
            assert!(made < 20 && served == made, "{speed}: {made}, {served}");
        }
    }

    #[test]
    fn skins_are_measured_by_the_radii_that_last_longer() {
        for (speeds, radii) in [
            ([0.4, 0.05], Radii::Typical),
            ([5.0, 0.05], Radii::Typical),
            ([0.05, 0.4], Radii::Own),
            ([0.05, 0.0499], Radii::Own),
        ] {
            let (made, served, policy) = frames(speeds);
            assert_eq!(policy.radii, radii, "{speeds:?}");
            assert!(served >= 1990 && made < 500, "{speeds:?}: {served}, {made}");
        }
    }

    #[test]
    fn a_skin_is_a_share_or_a_length_and_brings_its_cube_of_pairs() {
        let of = |radii, skin| Policy {
            radii,
            skin,
            typical: 3.0,
            ..Policy::default()
        };
        assert_eq!(of(Radii::Own, 1).skin(), Skin::share(0.125));
        assert_eq!(of(Radii::Typical, 1).skin(), Skin::length(0.375));
        assert_eq!(Policy::default().skin(), Skin::share(0.25));
        for radii in [Radii::Own, Radii::Typical] {
            let policy = of(radii, 1);
            assert_eq!(policy.wider(), 1.125 * 1.125 * 1.125);
            let widest = 1.375f64 / 1.125;
            assert!((policy.widest() - widest * widest * widest).abs() < 1e-12);
        }
    }

    /// Within two skins a body has gone straight on; beyond, it has jumped, unless the list served no frame but its own.
    #[test]
    fn one_that_jumps_tells_nothing_of_the_others() {
        let never = f64::INFINITY;
        for (radii, served, drifts, speeds) in [
            (Radii::Own, 4, [0.5, 3.0], [0.125, 0.75]),
            (Radii::Own, 4, [0.51, 3.0], [0.25 / 3.5, never]),
            (Radii::Typical, 4, [3.0, 0.5], [0.75, 0.125]),
            (Radii::Typical, 2, [3.0, 0.51], [never, 0.25 / 1.5]),
            (Radii::Own, 1, [9.0, 0.1], [9.0, 0.1]),
            (Radii::Typical, 1, [0.1, 9.0], [0.1, 9.0]),
        ] {
            let policy = Policy {
                radii,
                served,
                ..Policy::default()
            };
            let [own, typical] = drifts;
            assert_eq!(policy.speeds(Motion { own, typical }), speeds);
        }
    }

    #[test]
    fn a_list_that_was_too_long_is_tried_again_seldom() {
        let mut policy = Policy::of_typical(1.0);
        let made = (0..4000).filter(|_| {
            let made = policy.next().is_some();
            if made {
                policy.overflowed();
                assert_eq!((policy.radii, policy.skin), (Radii::Own, 0));
            }
            made
        });
        assert!((12..24).contains(&made.count()));
    }

    /// Of a million bodies whose list with this skin served so many frames, until one was so far from its place: the skin of the
    /// next one, up to so many pairs and with a pair more, each with so many candidates. No skin is the grid's frames.
    #[test]
    fn the_next_skin_is_the_cheapest_to_the_pair() {
        const FAR: f64 = f64::INFINITY;
        let own = |skin| Some((Radii::Own, skin));
        let typical = |skin| Some((Radii::Typical, skin));
        for (at, served, drifts, candidates, pairs, next) in [
            (own(3), 2, [0.3, FAR], 6, 3_837_626, [own(4), None]),
            (own(3), 3, [0.26, FAR], 4, 6_009_424, [own(5), own(2)]),
            (own(0), 2, [0.1, FAR], 5, 18_812_129, [own(3), None]),
            (own(3), 10, [0.27, FAR], 6, 2_195_551, [own(4), own(3)]),
            (own(2), 5, [0.2, FAR], 0, 7_728_640, [own(1), None]),
            (own(3), 2, [0.4, FAR], 3, 1_434_156, [own(3), None]),
            (own(4), 2, [0.33, FAR], 1, 4_149_165, [own(5), None]),
            (own(3), 3, [9.0, 0.1], 6, 7_692_074, [own(4), None]),
            (
                typical(5),
                100,
                [FAR, 0.376],
                10,
                2_458_240,
                [typical(2), typical(1)],
            ),
            (
                typical(1),
                2,
                [0.02, 0.251],
                6,
                1_661_698,
                [typical(5), typical(3)],
            ),
            (
                own(3),
                1,
                [0.4, 0.05],
                6,
                1_862_170,
                [typical(5), typical(4)],
            ),
            (own(3), 3, [0.3, 0.25], 8, 658_971, [typical(5), own(4)]),
            (own(3), 3, [0.3, 0.25], 8, 6_635_479, [own(4), typical(3)]),
        ] {
            let (radii, skin) = at.expect("a list has a skin");
            for (more, next) in (0..).zip(next) {
                let mut policy = Policy {
                    radii,
                    skin,
                    typical: 1.0,
                    served,
                    wait: 0,
                    pause: PAUSE,
                };
                let pairs = pairs + more;
                policy.ended(&list(pairs, candidates * pairs as u64, drifts));
                let found = policy.next().map(|_| (policy.radii, policy.skin));
                assert_eq!(found, next, "{at:?}, {served}: {pairs}");
                assert_eq!(policy.typical, 2.0);
            }
        }
    }
}
