//! A culler that is measured or judged, ours or anyone's: bodies in, pairs out.

use serde::{Deserialize, Serialize};

use sdop::bodies::Bodies;

/// A box on the world axes: the lower corner x, y, z, then the upper one.
pub type WorldBox = [f32; 6];

/// Which pairs of a frame must not be reported.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Filter {
    /// For each body, the groups that it is in, and those that it meets, one bit per group.
    pub groups: Vec<[u32; 2]>,
    /// Pairs i < j, sorted.
    pub excluded: Vec<[u32; 2]>,
}

impl Filter {
    /// Whether two bodies i < j are parted: one of them is in no group that the other meets, or
    /// they are excluded.
    #[must_use]
    pub fn parts(&self, pair: [u32; 2]) -> bool {
        let [[in_a, of_a], [in_b, of_b]] = pair.map(|body| self.groups[body as usize]);
        in_a & of_b == 0 || in_b & of_a == 0 || self.excluded.binary_search(&pair).is_ok()
    }
}

/// A part of a body: a shape with a pose in the frame of the body.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BodyPart {
    /// Index into the shapes.
    pub shape: u32,
    /// Quaternion x, y, z, w of any non-zero norm, then the translation.
    pub pose: [f32; 7],
}

impl BodyPart {
    /// The quaternion and the translation.
    #[must_use]
    pub fn rotation_and_translation(&self) -> ([f32; 4], [f64; 3]) {
        let [x, y, z, w, tx, ty, tz] = self.pose;
        ([x, y, z, w], [tx, ty, tz].map(f64::from))
    }
}

/// A culler in a comparison. It is built for a scene (its shapes and first bodies) and then gets
/// frame after frame: bodies, or another input that all compared cullers use, such as boxes.
pub trait Contestant<Frame: ?Sized = Bodies> {
    /// Finds the pairs of the frame. This alone is timed: from poses to a complete answer in the
    /// contestant's own memory.
    fn frame(&mut self, bodies: &Frame);

    /// Applies the frame's changes, for cullers that report only changes. Not timed.
    fn settle(&mut self) {}

    /// The pairs i < j of the last frame, not both static, each once, in any order. Not timed.
    fn pairs(&self) -> Vec<[u32; 2]>;

    /// The boxes of the coming frame's bodies, for cullers of given boxes. Others compute what they
    /// need from the poses.
    fn boxes(&mut self, boxes: &[WorldBox]) {
        let _ = boxes;
    }

    /// Takes over another set of bodies before the coming frame: `was[i]` is the former number of
    /// body i, `None` for a new one, and former numbers that are not named are gone. False when the
    /// set can't change.
    fn change(&mut self, bodies: &Frame, was: &[Option<u32>]) -> bool {
        let _ = (bodies, was);
        false
    }

    /// Takes over a filter for the coming frames. False when it has none.
    fn filter(&mut self, filter: &Filter) -> bool {
        let _ = filter;
        false
    }

    /// Takes over each body's margin for the coming frames. False when it has none.
    fn margins(&mut self, margins: &[f32]) -> bool {
        let _ = margins;
        false
    }

    /// Takes over the parts of each body for the coming frames; a body with an empty list is its
    /// shape alone. Returns false if its bodies are single shapes.
    fn body_parts(&mut self, parts: &[Vec<BodyPart>]) -> bool {
        let _ = parts;
        false
    }

    /// Takes over the period of each axis that has one, for the coming frames. Returns false if its
    /// space can't repeat.
    fn periods(&mut self, periods: [Option<f64>; 3]) -> bool {
        let _ = periods;
        false
    }

    /// Saves its state after the last frame, and drops a state that was saved before. Returns false
    /// if it can't.
    fn save(&mut self) -> bool {
        false
    }

    /// Goes back to the state that was kept. False when it can't.
    fn restore(&mut self) -> bool {
        false
    }
}

/// What owns or borrows a contestant is one.
macro_rules! pass_on {
    ($pointer:ty, $($lifetime:lifetime)?) => {
        impl<$($lifetime,)? Frame: ?Sized, C: Contestant<Frame> + ?Sized> Contestant<Frame> for $pointer {
            fn frame(&mut self, bodies: &Frame) {
                (**self).frame(bodies);
            }

            fn settle(&mut self) {
                (**self).settle();
            }

            fn pairs(&self) -> Vec<[u32; 2]> {
                (**self).pairs()
            }

            fn boxes(&mut self, boxes: &[WorldBox]) {
                (**self).boxes(boxes);
            }

            fn change(&mut self, bodies: &Frame, was: &[Option<u32>]) -> bool {
                (**self).change(bodies, was)
            }

            fn filter(&mut self, filter: &Filter) -> bool {
                (**self).filter(filter)
            }

            fn margins(&mut self, margins: &[f32]) -> bool {
                (**self).margins(margins)
            }

            fn body_parts(&mut self, parts: &[Vec<BodyPart>]) -> bool {
                (**self).body_parts(parts)
            }

            fn periods(&mut self, periods: [Option<f64>; 3]) -> bool {
                (**self).periods(periods)
            }

            fn save(&mut self) -> bool {
                (**self).save()
            }

            fn restore(&mut self) -> bool {
                (**self).restore()
            }
        }
    };
}
pass_on!(Box<C>,);
pass_on!(&'a mut C, 'a);
