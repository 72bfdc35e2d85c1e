//! [`Policy`]: when a list pays, and with which skin. It is decided by counts of frames and pairs
//! and by the bodies' drift, so that no choice depends on the machine.
//!
//! A skin is σ radii: each body's own, or one length for all in [typical radii](super::motion). If
//! small bodies move as fast as large ones, a skin in own radii is soon used up, and one length
//! lasts longer. The largest drift at the end of a list shows how long another skin would have
//! lasted: σ/v frames and one more. A wider skin needs fewer lists, each with (1 + σ)³ times the
//! pairs and as many more candidates.

use super::motion::{LargestDrift, SizeSummary};
use crate::rounding::skin::Skin;

/// The skins to choose from, in radii.
const SKINS: [f64; 8] = [0.0625, 0.125, 0.1875, 0.25, 0.3125, 0.375, 0.5, 0.75];

/// The largest factor by which a skin may multiply the candidates, that of 0.375 radii: with more,
/// the frame that builds a list takes more than 1.3 times the grid's frame. For long boxes, a skin
/// that is wide for the boxes enlarges their balls little.
const MOST_CANDIDATE_GROWTH: f64 = 2.6;

/// The index of the first skin, before anything is known of the motion.
const INITIAL_SKIN_INDEX: usize = 3;

/// Costs in AVX2 instructions, including naming the pairs but not the update. They are linear fits
/// to counts of frames of 4,000 uniform spheres with 2 to 18 candidates each.
///
/// The cost of the grid's frame per body and per candidate.
const GRID_BODY_COST: f64 = 240.0;
const GRID_CANDIDATE_COST: f64 = 9.5;
/// The additional cost, per body, of a frame that builds a list compared with one that follows it.
const LIST_BODY_COST: f64 = 260.0;
const LIST_CANDIDATE_COST: f64 = 11.0;
/// The cost of a frame that follows a list, per body and per pair.
const FRAME_BODY_COST: f64 = 35.0;
const FRAME_PAIR_COST: f64 = 14.0;

/// A list is built only if it is expected to take at most this fraction of the grid's time.
const MOST_GRID_SHARE: f64 = 0.8;

/// The fraction of the present cost below which skins switch between own and typical radii. If all
/// bodies have one size, both are the same.
const MOST_SWITCH_COST_RATIO: f64 = 0.9;

/// Grid frames between two attempts to build a list: at first, and at most ([`MOST_PAUSE_FRAMES`]).
const INITIAL_PAUSE_FRAMES: u32 = 16;
const MOST_PAUSE_FRAMES: u32 = 256;

/// The radii in which a skin is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum RadiusKind {
    Own,
    Typical,
}

/// What is known of the motion.
#[derive(Clone, Debug)]
pub struct Policy {
    radii: RadiusKind,
    skin: usize,
    /// The sizes of the present list's bodies.
    sizes: SizeSummary,
    /// Whether lists are made of long boxes.
    is_by_boxes: bool,
    /// Frames that have used the present list.
    served: u32,
    /// Grid frames until the next attempt.
    wait: u32,
    /// How many grid frames follow the next failure.
    pause: u32,
}

impl Default for Policy {
    fn default() -> Self {
        Self {
            radii: RadiusKind::Own,
            skin: INITIAL_SKIN_INDEX,
            sizes: SizeSummary::new(0.0, 0.0),
            is_by_boxes: false,
            served: 0,
            // In the first frame bodies are placed, and no list is built.
            wait: 1,
            pause: INITIAL_PAUSE_FRAMES,
        }
    }
}

/// Facts about a list that has become invalid.
#[derive(Clone, Copy, Debug)]
pub struct EndedList {
    /// Its number of pairs.
    pub pairs: usize,
    /// The number of candidates from which it was built.
    pub candidates: u64,
    /// Bodies.
    pub bodies: usize,
    /// How far the bodies had drifted.
    pub motion: LargestDrift,
    /// Their sizes.
    pub sizes: SizeSummary,
}

impl Policy {
    /// The skin of the present list.
    pub fn skin(&self) -> Skin {
        let share = SKINS[self.skin];
        match self.radii {
            RadiusKind::Own => Skin::share(share as f32),
            RadiusKind::Typical => Skin::length((share * self.sizes.typical) as f32),
        }
    }

    /// The factor by which the present skin multiplies the pairs.
    pub fn wider(&self) -> f64 {
        wider(SKINS[self.skin])
    }

    /// The factor by which the present skin multiplies the candidates.
    pub fn more_candidates(&self) -> f64 {
        self.candidates(SKINS[self.skin])
    }

    /// The factor by which a skin multiplies the candidates.
    fn candidates(&self, skin: f64) -> f64 {
        wider(skin * self.sizes.of_balls)
    }

    /// The skins to choose from.
    fn skins(&self) -> &'static [f64] {
        let few = |&skin: &f64| self.candidates(skin) <= MOST_CANDIDATE_GROWTH;
        &SKINS[..SKINS.partition_point(few)]
    }

    fn widest_skin(&self) -> usize {
        self.skins().len() - 1
    }

    /// Whether lists are made of long boxes.
    pub fn is_by_boxes(&self) -> bool {
        self.is_by_boxes
    }

    /// Sets whether lists are built from long boxes or from balls.
    pub fn turn_to(&mut self, by_boxes: bool, sizes: impl Fn() -> SizeSummary) {
        if by_boxes == self.is_by_boxes {
            return;
        }
        (self.is_by_boxes, self.sizes) = (by_boxes, sizes());
        if self.knows_a_length() {
            (self.radii, self.skin) = (RadiusKind::Typical, INITIAL_SKIN_INDEX);
        }
        self.skin = self.skin.min(self.widest_skin());
    }

    /// Whether long boxes have one length as their skin, because it is not proportional to their
    /// longest sides.
    fn knows_a_length(&self) -> bool {
        self.is_by_boxes && self.sizes.typical > 0.0
    }

    /// The factor by which a list with the widest skin has more pairs than the present one.
    pub fn widest(&self) -> f64 {
        wider(SKINS[self.widest_skin()]) / self.wider()
    }

    /// The skin of the list to build in this frame, if one is to be built.
    pub fn next(&mut self) -> Option<Skin> {
        if self.wait > 0 {
            self.wait -= 1;
            return None;
        }
        self.served = 1;
        Some(self.skin())
    }

    /// Counts a frame that has followed the list.
    pub fn followed(&mut self) {
        self.served += 1;
    }

    /// The list has become invalid.
    pub fn ended(&mut self, list: &EndedList) {
        let [own, typical] = self.speeds(list.motion);
        // Per body, without a skin.
        let each = |number: f64, wider| number / list.bodies.max(1) as f64 / wider;
        let pairs = each(list.pairs as f64, self.wider());
        let candidates = each(list.candidates as f64, self.more_candidates());
        self.sizes = list.sizes;
        let mut best = (f64::INFINITY, self.radii, 0);
        for (radii, speed) in [(RadiusKind::Own, own), (RadiusKind::Typical, typical)] {
            if radii == RadiusKind::Own && self.knows_a_length() {
                continue;
            }
            for (index, &skin) in self.skins().iter().enumerate() {
                let frames = (skin / speed).floor() + 1.0;
                let make =
                    LIST_BODY_COST + LIST_CANDIDATE_COST * candidates * self.candidates(skin);
                let cost = make / frames + FRAME_BODY_COST + FRAME_PAIR_COST * pairs * wider(skin);
                let penalty = if radii == self.radii { 1.0 } else { 1.0 / MOST_SWITCH_COST_RATIO };
                if cost * penalty < best.0 {
                    best = (cost * penalty, radii, index);
                }
            }
        }
        (self.radii, self.skin) = (best.1, best.2);
        if best.0 < MOST_GRID_SHARE * (GRID_BODY_COST + GRID_CANDIDATE_COST * candidates) {
            self.pause = INITIAL_PAUSE_FRAMES;
        } else {
            // If a list served only one frame, the widest skin gives the most information.
            self.skin = self.widest_skin();
            self.give_up();
        }
    }

    /// The fastest body's drift per frame, in own and in typical radii.
    fn speeds(&self, LargestDrift { own, typical }: LargestDrift) -> [f64; 2] {
        let served = f64::from(self.served);
        let (skin, drift) = match self.radii {
            RadiusKind::Own => (SKINS[self.skin], own),
            RadiusKind::Typical => (SKINS[self.skin], typical),
        };
        // A body that moves steadily has drifted by at most two skins when it leaves its skin.
        // Beyond that it has jumped, and its drift says nothing about other bodies.
        if self.served > 1 && drift > 2.0 * skin {
            let speed = skin / (served - 0.5);
            return match self.radii {
                RadiusKind::Own => [speed, f64::INFINITY],
                RadiusKind::Typical => [f64::INFINITY, speed],
            };
        }
        [own / served, typical / served]
    }

    /// The list was dropped because the set of bodies changed.
    pub fn interrupted(&mut self) {
        // If bodies come and go in every frame, no list pays.
        if self.served < 2 {
            self.give_up();
        }
    }

    /// The search for the list exceeded its limits.
    pub fn overflowed(&mut self) {
        let radii = if self.knows_a_length() { RadiusKind::Typical } else { RadiusKind::Own };
        (self.radii, self.skin) = (radii, 0);
        self.give_up();
    }

    fn give_up(&mut self) {
        self.wait = self.pause;
        self.pause = MOST_PAUSE_FRAMES.min(2 * self.pause);
    }
}

/// The factor by which a skin of `radii` radii multiplies the pairs.
fn wider(radii: f64) -> f64 {
    (1.0 + radii).powi(3)
}

#[cfg(test)]
mod tests;
