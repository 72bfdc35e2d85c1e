//! When a list pays, and with which skin: by counts of frames and pairs and by how far bodies got,
//! so that no choice depends on the machine.
//!
//! A skin is so many radii σ: of each body's own, or the same length for all, in [typical
//! radii](super::motion). Where the small move as fast as the wide, their own radii are soon used
//! up, and a length lasts. The body that got farthest by the end of a list tells how long another
//! list would have lasted: σ/v frames and one more. A wider skin makes fewer lists, each of (1 +
//! σ)³ as many pairs, from as many more candidates.

use super::motion::{Motion, Sizes};
use crate::rounding::skin::Skin;

/// Skins to choose from, in radii.
const SKINS: [f64; 8] = [0.0625, 0.125, 0.1875, 0.25, 0.3125, 0.375, 0.5, 0.75];

/// How many times the candidates a skin may bring at most, what 0.375 radii bring: beyond, the
/// frame that makes a list takes more than 1.3 of the grid's. The balls about long boxes grow
/// little by what is wide for the boxes.
const GREATEST_GROWTH: f64 = 2.6;

/// The first one, before anything is known of the motion.
const FIRST: usize = 3;

/// Costs in instructions of AVX2, what it takes to name pairs included: lines through the counts of
/// frames of 4,000 uniform spheres with 2 to 18 candidates each, update excepted.
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

/// A list must promise to take at most this share of the grid's time: where it hardly pays, it may
/// as well cost.
const WORTH: f64 = 0.8;

/// By how much skins by other radii must be cheaper than those at hand: where all bodies have one
/// size both are the same.
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
    /// Of the bodies of the list at hand.
    sizes: Sizes,
    /// Whether lists are made of long boxes.
    is_by_boxes: bool,
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
            sizes: Sizes::new(0.0, 0.0),
            is_by_boxes: false,
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
    /// Their sizes.
    pub sizes: Sizes,
}

impl Policy {
    /// The skin of the list at hand.
    pub fn skin(&self) -> Skin {
        let share = SKINS[self.skin];
        match self.radii {
            Radii::Own => Skin::share(share as f32),
            Radii::Typical => Skin::length((share * self.sizes.typical) as f32),
        }
    }

    /// How many times the pairs of a list without a skin the one at hand has.
    pub fn wider(&self) -> f64 {
        wider(SKINS[self.skin])
    }

    /// How many times its candidates.
    pub fn more_candidates(&self) -> f64 {
        self.candidates(SKINS[self.skin])
    }

    /// How many times the candidates a skin brings.
    fn candidates(&self, skin: f64) -> f64 {
        wider(skin * self.sizes.of_balls)
    }

    /// The skins to choose from.
    fn skins(&self) -> &'static [f64] {
        let few = |&skin: &f64| self.candidates(skin) <= GREATEST_GROWTH;
        &SKINS[..SKINS.partition_point(few)]
    }

    fn widest_skin(&self) -> usize {
        self.skins().len() - 1
    }

    /// Whether lists are made of long boxes.
    pub fn is_by_boxes(&self) -> bool {
        self.is_by_boxes
    }

    /// From now on, lists are made of balls, or of long boxes.
    pub fn turn_to(&mut self, by_boxes: bool, sizes: impl Fn() -> Sizes) {
        if by_boxes == self.is_by_boxes {
            return;
        }
        (self.is_by_boxes, self.sizes) = (by_boxes, sizes());
        if self.knows_a_length() {
            (self.radii, self.skin) = (Radii::Typical, FIRST);
        }
        self.skin = self.skin.min(self.widest_skin());
    }

    /// Whether the skin of long boxes is one length for all, which the longest side of each is no
    /// measure of.
    fn knows_a_length(&self) -> bool {
        self.is_by_boxes && self.sizes.typical > 0.0
    }

    /// How many times the pairs of the list at hand one with the widest skin has.
    pub fn widest(&self) -> f64 {
        wider(SKINS[self.widest_skin()]) / self.wider()
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
        let each = |number: f64, wider| number / list.bodies.max(1) as f64 / wider;
        let pairs = each(list.pairs as f64, self.wider());
        let candidates = each(list.candidates as f64, self.more_candidates());
        self.sizes = list.sizes;
        let mut best = (f64::INFINITY, self.radii, 0);
        for (radii, speed) in [(Radii::Own, own), (Radii::Typical, typical)] {
            if radii == Radii::Own && self.knows_a_length() {
                continue;
            }
            for (index, &skin) in self.skins().iter().enumerate() {
                let frames = (skin / speed).floor() + 1.0;
                let make = MAKE + COLLECT * candidates * self.candidates(skin);
                let cost = make / frames + FOLLOW + PAIR * pairs * wider(skin);
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
        (self.radii, self.skin) = (best.1, best.2);
        if best.0 < WORTH * (SORT + SEARCH * candidates) {
            self.pause = PAUSE;
        } else {
            // Of a list that served one frame alone the widest skin tells most.
            self.skin = self.widest_skin();
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
        // A body that has just used up its skin is within two of them, if it goes straight on.
        // Beyond, it has jumped, and tells nothing of the others.
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
        let radii = if self.knows_a_length() {
            Radii::Typical
        } else {
            Radii::Own
        };
        (self.radii, self.skin) = (radii, 0);
        self.give_up();
    }

    fn give_up(&mut self) {
        self.wait = self.pause;
        self.pause = LONGEST_PAUSE.min(2 * self.pause);
    }
}

/// How many times the pairs so many radii bring.
fn wider(radii: f64) -> f64 {
    (1.0 + radii).powi(3)
}

#[cfg(test)]
mod tests;
