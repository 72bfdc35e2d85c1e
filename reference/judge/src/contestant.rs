//! A culler under measurement or judgement, ours or anyone's: bodies in, pairs out.

use sdop::bodies::Bodies;

/// A box on the world axes: the lower corner x, y, z, then the upper one.
pub type WorldBox = [f32; 6];

/// What stands in a comparison. It is made for a scene (its shapes and first bodies), then sees
/// frame after frame: bodies, or whatever else all that are compared take, such as boxes alone.
pub trait Contestant<Frame: ?Sized = Bodies> {
    /// Finds the pairs of the frame. This alone is timed: from poses to a complete answer in the
    /// contestant's own memory.
    fn frame(&mut self, bodies: &Frame);

    /// Books what the frame changed, for cullers that say only that. Not timed.
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
        }
    };
}
pass_on!(Box<C>,);
pass_on!(&'a mut C, 'a);
