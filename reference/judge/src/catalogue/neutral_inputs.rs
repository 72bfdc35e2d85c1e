//! Cases of a claim as cases of another that is the same with an additional input: the input says
//! nothing new, or the last frames come again after a restored state.

use crate::case::{Case, Frame};
use crate::claim::Claim;
use crate::contestant::{BodyPart, Filter};

/// The case judged by a claim that is based on its own.
pub(super) fn judged_by(claim: Claim, mut case: Case) -> Case {
    case.claim = claim;
    case.claims.insert(0, claim);
    for frame in &mut case.frames {
        let count = frame.bodies.len();
        match claim {
            Claim::Filter => {
                frame.filter =
                    Some(Filter { groups: vec![[1, u32::MAX]; count], excluded: Vec::new() });
            }
            Claim::Margin => frame.margins = Some(vec![0.0; count]),
            Claim::Periodic => frame.periods = Some([None; 3]),
            Claim::Parts => frame.parts = Some((0..count).map(|i| one_part(frame, i)).collect()),
            _ => {}
        }
    }
    if claim == Claim::Restore {
        replay_half(&mut case.frames);
    }
    case
}

/// No part, or one where the body is.
fn one_part(frame: &Frame, i: usize) -> Vec<BodyPart> {
    let pose = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0];
    let part = BodyPart { shape: frame.bodies.shape[i], pose };
    if i % 4 == 1 { vec![part] } else { Vec::new() }
}

/// Saves the state after the middle frame, and has the frames after that again.
fn replay_half(frames: &mut Vec<Frame>) {
    let middle = frames.len().saturating_sub(1) / 2;
    let mut again = frames.iter().skip(middle + 1).cloned().collect::<Vec<_>>();
    if let Some(first) = again.first_mut() {
        first.restore = true;
        frames[middle].save = true;
        frames.append(&mut again);
    }
}
