//! [`FineTranslations`]: the translations of a scene that f32 can't represent.
//!
//! A scene's poses have f64 translations, its trajectories f32 ones. A body that still has its
//! first f32 translation has not moved, and its position is the f64 translation of its pose, to the
//! last bit. The position of any other body is its f32 translation.

use sdop::bodies::Bodies;
use sdop::bodies::contract::{ContractError, check_pose};
use sdop::volume::Shape;

/// How far f32 may move a body of a scene that is studied in f32, as a share of its ball's radius.
const MOST_ROUNDING_SHARE: f64 = 1.0 / 1024.0;

/// The f64 translations of the bodies that rounding to f32 would move, sorted by body.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FineTranslations(Vec<(usize, [f64; 3])>);

impl FineTranslations {
    /// Adds a body's translation, if f32 doesn't hold it, and returns the nearest f32.
    pub(super) fn add(&mut self, body: usize, translation: [f64; 3]) -> [f32; 3] {
        let rounded = rounded(translation);
        if rounded.map(f64::from) != translation {
            self.0.push((body, translation));
        }
        rounded
    }

    /// Whether f32 holds all.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The first that f32 doesn't hold, in f64 and in the nearest f32.
    #[must_use]
    pub fn first(&self) -> Option<([f64; 3], [f32; 3])> {
        self.0.first().map(|&(_, t)| (t, rounded(t)))
    }

    /// All translations in f64, if f32 doesn't hold some of them.
    #[must_use]
    pub fn of(&self, bodies: &Bodies) -> Option<Vec<[f64; 3]>> {
        let has_not_moved = |&&(body, start): &&(usize, [f64; 3])| {
            bodies.translation[body].map(f32::to_bits) == rounded(start).map(f32::to_bits)
        };
        let mut all: Option<Vec<[f64; 3]>> = None;
        for &(body, start) in self.0.iter().filter(has_not_moved) {
            let widened = || bodies.translation.iter().map(|t| t.map(f64::from));
            all.get_or_insert_with(|| widened().collect())[body] = start;
        }
        all
    }

    /// Checks the translations against the contract.
    pub(super) fn check(&self, bodies: &Bodies) -> Result<(), ContractError> {
        let mut all = self.0.iter();
        all.try_for_each(|(body, t)| check_pose(*body, &bodies.rotation[*body], t))
    }

    /// The first body that f32 moves too far for a study in f32, and how far it moves along an
    /// axis.
    pub(super) fn coarse(&self, bodies: &Bodies, shapes: &[Shape]) -> Option<(usize, f64)> {
        let moved = self.0.iter().map(|&(body, t)| {
            let near = rounded(t).map(f64::from);
            let far = |far: f64, axis: usize| far.max((near[axis] - t[axis]).abs());
            (body, (0..3).fold(0.0, far))
        });
        let radius = |body: usize| f64::from(shapes[bodies.shape[body] as usize].ball.radius);
        moved.into_iter().find(|&(body, moved)| moved > MOST_ROUNDING_SHARE * radius(body))
    }
}

/// The nearest f32.
fn rounded(translation: [f64; 3]) -> [f32; 3] {
    translation.map(|x| x as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bodies that move are where f32 says.
    #[test]
    fn moved_bodies_use_f32_positions() {
        let mut fine = FineTranslations::default();
        let mut bodies = Bodies::default();
        for (body, t) in [[0.5, 1.0, 2.0], [0.1, 1.0e9 + 0.5, -0.0]].into_iter().enumerate() {
            bodies.push(0, true, [0.0, 0.0, 0.0, 1.0_f32], fine.add(body, t));
        }
        assert_eq!(bodies.translation[1], [0.1_f32, 1.0e9, -0.0]);
        let exact = [[0.5, 1.0, 2.0], [0.1, 1.0e9 + 0.5, 0.0]];
        assert_eq!(fine.of(&bodies), Some(exact.to_vec()));
        bodies.translation[0][2] = 3.0;
        assert_eq!(fine.of(&bodies).map(|all| all[0]), Some([0.5, 1.0, 3.0]));
        bodies.translation[1][0] = 0.25;
        assert_eq!(fine.of(&bodies), None, "it has moved");
    }

    #[test]
    fn f32_translations_are_not_kept() {
        let mut fine = FineTranslations::default();
        assert_eq!(fine.add(0, [1.5, -1.0e9, 0.0]), [1.5, -1.0e9, 0.0]);
        assert!(fine.is_empty());
    }
}
