//! Cases as a culler with a flaw takes them.

use super::*;

/// The case as a culler knows it that reads some of its input wrongly; `None` for other flaws.
pub(super) fn with_other_input(flaw: Flaw, case: &Case) -> Option<Case> {
    let mut known = case.clone();
    let first = case.frames[0].clone();
    let mut saved: Option<Frame> = None;
    for n in 0..known.frames.len() {
        let mut before = known.frames[n.saturating_sub(1)].clone();
        let given_before = &case.frames[n.saturating_sub(1)];
        if known.frames[n].restore {
            before = saved.clone().unwrap_or(before);
        }
        let frame = &mut known.frames[n];
        let given = &case.frames[n];
        let count = frame.bodies.len();
        let shared = count.min(first.bodies.len());
        match flaw {
            Flaw::Once(Input::Filter) => frame.filter.clone_from(&first.filter),
            Flaw::Once(Input::Margins) => frame.margins.clone_from(&first.margins),
            Flaw::Once(Input::Periods) => frame.periods = first.periods,
            Flaw::SameBodies => {
                let (bodies, first) = (&mut frame.bodies, &first.bodies);
                bodies.shape[..shared].copy_from_slice(&first.shape[..shared]);
                bodies.dynamic[..shared].copy_from_slice(&first.dynamic[..shared]);
                // Who takes the boxes by former numbers has those of other bodies.
                frame.boxes[..shared].rotate_right(usize::from(frame.was.is_some()));
            }
            Flaw::Once(Input::Poses) => {
                let (bodies, first_bodies) = (&mut frame.bodies, &first.bodies);
                bodies.rotation[..shared].copy_from_slice(&first_bodies.rotation[..shared]);
                bodies.translation[..shared].copy_from_slice(&first_bodies.translation[..shared]);
                frame.boxes[..shared].copy_from_slice(&first.boxes[..shared]);
            }
            Flaw::SameNumber => (0..shared).for_each(|i| keep(frame, i, &first, i)),
            Flaw::Once(Input::Parts) => {
                let parts = frame.parts.as_mut()?;
                parts[..shared].clone_from_slice(&first.parts.as_ref()?[..shared]);
            }
            Flaw::SamePose | Flaw::Static | Flaw::FirstMove | Flaw::Unsaved if n > 0 => {
                for i in 0..count {
                    let Some(at) = former(given, i).filter(|&at| at < before.bodies.len()) else {
                        continue;
                    };
                    let pose = |frame: &Frame, i: usize| {
                        (frame.bodies.rotation[i], frame.bodies.translation[i])
                    };
                    let keeps = match flaw {
                        Flaw::SamePose => {
                            at < given_before.bodies.len()
                                && pose(given_before, at) == pose(given, i)
                        }
                        Flaw::Static => !given.bodies.dynamic[i],
                        Flaw::FirstMove => {
                            n > 1
                                && at < given_before.bodies.len()
                                && !has_moved(&case.frames[n - 2], given_before, at)
                        }
                        _ => {
                            at < given_before.bodies.len()
                                && (given_before.boxes[at], pose(given_before, at))
                                    == (given.boxes[i], pose(given, i))
                        }
                    };
                    if keeps {
                        keep(frame, i, &before, at);
                    }
                }
            }
            Flaw::SamePose | Flaw::Static | Flaw::FirstMove | Flaw::Unsaved => {}
            Flaw::OneMask | Flaw::EightGroups | Flaw::NothingExcluded => {
                let filter = frame.filter.as_mut()?;
                other_filter(flaw, &mut filter.groups, &mut filter.excluded);
            }
            Flaw::NoMargin => frame.margins = None,
            Flaw::NoImages => frame.periods = None,
            Flaw::FirstAxis => frame.periods = frame.periods.map(|p| [p[0], None, None]),
            Flaw::OwnRotation | Flaw::FirstPart | Flaw::UnturnedOffset | Flaw::LostOffset => {
                for i in 0..count {
                    let has_moved = i < shared && pose_of(&first, i) != pose_of(given, i);
                    let rotation = frame.bodies.rotation[i];
                    other_parts(flaw, &mut frame.parts.as_mut()?[i], rotation, has_moved);
                }
            }
            Flaw::FirstRotation => {
                let first = &first.bodies.rotation[..shared];
                frame.bodies.rotation[..shared].copy_from_slice(first);
            }
            _ => return None,
        }
        if frame.save {
            saved = Some(frame.clone());
        }
    }
    Some(known)
}

fn pose_of(frame: &Frame, i: usize) -> ([f32; 4], [f32; 3]) {
    (frame.bodies.rotation[i], frame.bodies.translation[i])
}

/// Gives a body what another frame has for one.
fn keep(frame: &mut Frame, i: usize, from: &Frame, at: usize) {
    frame.boxes[i] = from.boxes[at];
    frame.bodies.shape[i] = from.bodies.shape[at];
    frame.bodies.rotation[i] = from.bodies.rotation[at];
    frame.bodies.translation[i] = from.bodies.translation[at];
    if let (Some(parts), Some(from)) = (&mut frame.parts, &from.parts) {
        parts[i].clone_from(&from[at]);
    }
}

fn other_filter(flaw: Flaw, groups: &mut [[u32; 2]], excluded: &mut Vec<[u32; 2]>) {
    match flaw {
        Flaw::NothingExcluded => excluded.clear(),
        Flaw::EightGroups => groups.iter_mut().flatten().for_each(|bits| *bits &= 255),
        // What the second body meets is not asked for.
        _ => {
            let asked = groups.to_vec();
            for (j, b) in asked.iter().enumerate() {
                let is_parted = |a: &[u32; 2]| a[1] & b[0] == 0;
                excluded
                    .extend((0..j).filter(|&i| is_parted(&asked[i])).map(|i| [i as u32, j as u32]));
            }
            excluded.sort_unstable();
            excluded.dedup();
            groups.fill([1, 1]);
        }
    }
}

fn other_parts(flaw: Flaw, parts: &mut Vec<BodyPart>, of_body: [f32; 4], has_moved: bool) {
    if flaw == Flaw::FirstPart {
        parts.truncate(1);
    }
    for part in parts {
        let [x, y, z, w, tx, ty, tz] = part.pose;
        part.pose = match flaw {
            Flaw::OwnRotation => [0.0, 0.0, 0.0, 1.0, tx, ty, tz],
            Flaw::UnturnedOffset => {
                // Quarter turns: the inverse maps whole numbers to whole numbers.
                let back = rotation(of_body).map(|row| row.map(f64::round));
                let t = [tx, ty, tz].map(f64::from);
                let [tx, ty, tz] =
                    [0, 1, 2].map(|n| (0..3).map(|m| back[m][n] * t[m]).sum::<f64>() as f32);
                [x, y, z, w, tx, ty, tz]
            }
            Flaw::LostOffset if has_moved => [x, y, z, w, 0.0, 0.0, 0.0],
            _ => part.pose,
        };
    }
}
