//! Margin classes: each margin is rounded up to a class, and a shape with a class is one model of
//! the culler, so that many bodies need few models.
//!
//! There are eight classes per octave, so a margin is rounded up by at most an eighth. Without a
//! margin, rounding errors of local translations share one class as long as they are below 2⁻¹² of
//! the shape.

use crate::bodies::contract::{ContractError, refuse};
use crate::rounding::{LIMIT, exp2};

/// Errors of placement up to this share of a shape's size are rounded up to it.
const SHARED_ERROR_RATIO: f64 = exp2(-12);

/// Up to this number of classes, unused ones are kept.
const MOST_UNSWEPT_CLASSES: usize = 64;

/// The models of each shape in each used class.
#[derive(Clone, Debug, Default)]
pub(super) struct Margins {
    /// By the number of a shape among the models: its classes, sorted, and the model of each.
    classes: Vec<Vec<(u32, u32)>>,
    /// The number of all classes.
    len: usize,
    /// Number of models in use at the last [`Self::sweep`].
    in_use: usize,
}

impl Margins {
    /// The model for a shape of size `reach` and with the number `shape` among the models, with a
    /// margin, placed with an error of at most `moved`. `grow` makes a new one.
    pub fn model(
        &mut self,
        shape: u32,
        reach: f32,
        margin: f32,
        moved: f64,
        grow: impl FnOnce(u32, f32) -> u32,
    ) -> u32 {
        if margin == 0.0 && moved == 0.0 {
            return shape; // the shape itself is a model, of its own number
        }
        let moved =
            if moved > 0.0 { moved.max(SHARED_ERROR_RATIO * f64::from(reach)) } else { 0.0 };
        let class = class_of(f64::from(margin) + moved);
        let number = shape as usize;
        if self.classes.len() <= number {
            self.classes.resize(number + 1, Vec::new());
        }
        let classes = &mut self.classes[number];
        match classes.binary_search_by_key(&class, |&(class, _)| class) {
            Ok(at) => classes[at].1,
            Err(at) => {
                let grown = grow(shape, f32::from_bits(class));
                classes.insert(at, (class, grown));
                self.len += 1;
                grown
            }
        }
    }

    /// Removes the models grown from a shape's, by `remove`.
    pub fn remove(&mut self, shape: u32, mut remove: impl FnMut(u32)) {
        if let Some(classes) = self.classes.get_mut(shape as usize) {
            let classes = std::mem::take(classes);
            self.len -= classes.len();
            classes.iter().for_each(|&(_, grown)| remove(grown));
        }
    }

    /// Whether more models may be unused than were in use at the last sweep.
    pub fn are_many(&self) -> bool {
        self.len > MOST_UNSWEPT_CLASSES + 2 * self.in_use
    }

    /// Removes the models that are not in use.
    pub fn sweep(&mut self, used: &[bool], mut remove: impl FnMut(u32)) {
        for classes in &mut self.classes {
            classes.retain(|&(_, grown)| {
                let is_used = used[grown as usize];
                if !is_used {
                    remove(grown);
                }
                is_used
            });
            classes.shrink_to_fit();
        }
        self.len = self.classes.iter().map(Vec::len).sum();
        self.in_use = self.len;
    }

    /// Frees the memory of removed models.
    pub fn shrink_to_fit(&mut self) {
        while self.classes.pop_if(|classes| classes.is_empty()).is_some() {}
        self.classes.shrink_to_fit();
    }
}

/// Checks the margin of a body whose shape has the size `reach`.
pub(super) fn check_margin(body: usize, reach: f32, margin: f32) -> Result<(), ContractError> {
    let grown = f64::from(reach) + 1.25 * f64::from(margin);
    if margin >= 0.0 && grown <= f64::from(LIMIT) {
        return Ok(());
    }
    let hint = "a length of 0 or more; with it the shape is at most 2^60 in size";
    refuse(body, "margin", format!("{margin}"), hint)
}

/// The bits of the smallest class above `margin` > 0: an f32 with three significant bits after the
/// first, so that exponent and bits form one integer that counts the classes.
fn class_of(margin: f64) -> u32 {
    const STEP: u32 = 1 << 20;
    let above = crate::rounding::up(margin).to_bits();
    above.next_multiple_of(STEP)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A class is above the margin by an eighth at most.
    #[test]
    fn class_is_within_an_eighth() {
        for margin in [1.0, 1.0e-3, 0.124_999_99, 7.5, 1.0e12, 3.0e-30] {
            let class = f64::from(f32::from_bits(class_of(margin)));
            assert!(margin < class && class <= margin * 1.1251, "{margin} {class}");
        }
        // Subnormal margins share the lowest classes.
        assert!(f32::from_bits(class_of(1.0e-44)) >= 1.0e-44);
    }

    /// Equal classes share a model and none needs none.
    #[test]
    fn equal_classes_share_a_model() {
        let mut margins = Margins::default();
        let mut made = Vec::new();
        let mut model = |margin: f32, moved: f64| {
            margins.model(3, 1.0, margin, moved, |shape, margin| {
                made.push((shape, margin));
                100 + made.len() as u32
            })
        };
        assert_eq!(model(0.0, 0.0), 3);
        assert_eq!(model(0.50, 0.0), 101);
        assert_eq!(model(0.51, 0.0), 101);
        assert_eq!(model(0.0, 1.0e-9), 102);
        assert_eq!(model(0.0, 1.0e-7), 102, "below 2⁻¹² of the size");
        assert_eq!(model(0.0, 1.0e-2), 103);
        assert_eq!(made[0], (3, 0.5625));
        // A larger shape has one class for its errors up to a larger error.
        let mut model =
            |moved: f64| margins.model(4, 64.0, 0.0, moved, |_, _| moved.to_bits() as u32);
        assert_eq!(model(1.0e-2), model(1.0e-3));
        assert_ne!(model(1.0e-2), model(3.0e-2));
    }

    /// A margin is within the limit with its shape.
    #[test]
    fn margin_limit_includes_shape() {
        // 2⁶⁰ − 1.25·2⁴⁰ is an f32.
        let margin = 2f32.powi(40);
        let reach = (f64::from(LIMIT) - 1.25 * f64::from(margin)) as f32;
        assert!(check_margin(0, reach, margin).is_ok());
        assert!(check_margin(0, reach, margin.next_up()).is_err());
        assert!(check_margin(0, reach.next_up(), margin).is_err());
        assert!(check_margin(0, 1.0, 0.0).is_ok() && check_margin(0, 1.0, -1.0).is_err());
    }
}
