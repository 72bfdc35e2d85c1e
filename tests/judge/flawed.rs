//! A culler that knows the exact answers to every claim, with one flaw.

use std::collections::HashMap;
use std::sync::Mutex;

use sdop::rounding::pose::{rotation, transform};
use sdop::settings::Overlap;
use sdop_judge::answer::{Answer, StopReason};
use sdop_judge::ours::answers::Predicate;
use sdop_judge::ours::naive::naive_overlap;
use sdop_judge::ours::reference_shapes::Shapes;
use sdop_judge::truth::{Truth, boxes_meet, boxes_near, images};
use sdop_judge::{Bodies, BodyPart, Case, Claim, Frame, Subject, WorldBox};

/// What is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flaw {
    /// Nothing: the control.
    None,
    /// Answers with the list of the frame before.
    FrameBefore,
    /// Of the first frame.
    FirstFrame,
    /// Of the last frame.
    LastFrame,
    /// Reports only what was so in the frame before, too.
    BothFrames,
    /// Reports nothing from the frame of this number on.
    EmptyAfter(usize),
    /// Adds a new body one frame too late.
    LateNew,
    /// Keeps the verdict of a pair while one of its bodies sleeps.
    OneAsleep,
    /// Loses the pairs of a body in the frame in which it wakes.
    LostOnWaking,
    /// Keeps a list of boxes that are nearer than a skin, and makes it anew as this says.
    List(Renewal),
    /// Leaves out the pairs of boxes without a volume.
    Points,
    /// Numbers bodies with 16 bits.
    Bits16,
    /// Holds so many pairs.
    Room(usize),
    /// Reads an input in the first frame only.
    Once(Input),
    /// Doesn't notice that bodies get other numbers.
    SameBodies,
    /// Keeps what it knows of a body whose pose stays.
    SamePose,
    /// Keeps what a number had in the first frame, whosever it is.
    SameNumber,
    /// Keeps what it knows of a static body.
    Static,
    /// Takes over a body's move only when the body has moved in two frames.
    FirstMove,
    /// Takes over what differs from what it saw last, which is not in its snapshot.
    Unsaved,
    /// Tests a volume in f32 without a margin.
    Naive(Volume),
    /// Takes touching for apart.
    Strict,
    /// Takes the upper ends of boxes for outside.
    HalfOpen,
    /// Answers with the first answers to a case of the same group.
    ByGroup,
    /// To a frame with the same pose of the first body.
    ByFirstPose,
    /// To a frame with as many bodies.
    ByCount,
    /// Asks the mask of the first body alone.
    OneMask,
    /// Knows eight groups.
    EightGroups,
    /// Knows no excluded pairs.
    NothingExcluded,
    /// Also reports pairs that are near the body of the lower number.
    Grown,
    /// The same of bodies with successive numbers alone, which stay so backwards.
    GrownNeighbours,
    /// Leaves margins to a later test.
    NoMargin,
    /// Takes the larger margin in place of both.
    LargerMargin,
    /// Moves ends by a sum of margins that is rounded first.
    RoundedMargins,
    /// Leaves out the rotation of a part in its body.
    OwnRotation,
    /// Tests the first part of a body alone.
    FirstPart,
    /// Adds the offset of a part without turning it with the body.
    UnturnedOffset,
    /// Forgets the offsets of parts once the pose of their body has changed.
    LostOffset,
    /// Keeps the rotation that a body had at first.
    FirstRotation,
    /// Compares boxes where they are given.
    NoImages,
    /// Knows the period of the first axis alone.
    FirstAxis,
    /// Compares with images one period away, and doesn't wrap positions.
    NextImages,
    /// Wraps positions by a product with the period that f64 rounds.
    RoundedProduct,
    /// Compares two boxes in the image in which they were nearest in the first frame.
    FormerImage,
}

/// What a frame brings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Input {
    Poses,
    Filter,
    Margins,
    Parts,
    Periods,
}

/// When a list is made anew.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Renewal {
    /// When a body has moved by more than half of the skin since the list was made: in time.
    HalfSkin,
    /// By more than the skin.
    Skin,
    /// By more than half of the skin since the frame before.
    FrameToFrame,
    /// Every eighth frame.
    Eighth,
}

/// What can be tested in f32.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Volume {
    /// The shape's ball, or the ball around a given box.
    Ball,
    /// The box around the posed vertices, or a given one by its centre and half size.
    Box,
    OrDop,
    Hull,
    Mesh,
}

pub type Lists = Vec<Vec<[u32; 2]>>;

/// A culler with a flaw; what it remembers of other cases.
pub struct Flawed {
    pub flaw: Flaw,
    seen: Mutex<HashMap<String, Lists>>,
}

impl Flawed {
    pub fn new(flaw: Flaw) -> Self {
        Self { flaw, seen: Mutex::default() }
    }

    fn lists(&self, case: &Case) -> Lists {
        let flaw = self.flaw;
        match flaw {
            Flaw::None => return exact(case),
            Flaw::ByGroup | Flaw::ByFirstPose | Flaw::ByCount => return self.remembered(case),
            Flaw::Grown | Flaw::GrownNeighbours => return grown(flaw, case),
            Flaw::List(renewal) => return listed(renewal, case),
            _ => {}
        }
        if let Some(lists) = of_other_frames(flaw, case) {
            return lists;
        }
        if let Some(known) = with_other_input(flaw, case) {
            return exact(&known);
        }
        let shapes = Shapes::new(case.shapes.clone()).unwrap();
        let truth = Truth::new(case.claim, &case.shapes).unwrap();
        let mut lists = exact(case);
        for (frame, list) in case.frames.iter().zip(&mut lists) {
            let frames = [&case.frames[0], frame];
            list.retain(|&pair| is_seen(flaw, case, frames, pair, (&shapes, &truth)));
        }
        lists
    }

    /// Answers by something that doesn't determine them.
    fn remembered(&self, case: &Case) -> Lists {
        let mut seen = self.seen.lock().unwrap();
        if self.flaw == Flaw::ByGroup {
            let known = seen.entry(case.group().to_owned()).or_insert_with(|| exact(case));
            let mut lists = known.clone();
            lists.resize(case.frames.len(), Vec::new());
            return lists;
        }
        let lists = case.frames.iter().zip(exact(case)).map(|(frame, list)| {
            let key = match self.flaw {
                Flaw::ByCount => frame.bodies.len().to_string(),
                _ => format!(
                    "{:?}",
                    (frame.bodies.rotation.first(), frame.bodies.translation.first())
                ),
            };
            seen.entry(format!("{}{key}", case.name)).or_insert_with(|| vec![list])[0].clone()
        });
        lists.collect()
    }
}

impl Subject for Flawed {
    fn answer(&self, case: &Case) -> Result<Vec<Answer>, StopReason> {
        if case.frames.is_empty() {
            return Ok(Vec::new()); // so small are the scenes that shrinking tries
        }
        let frames = case.frames.iter().zip(self.lists(case));
        let answer = |(frame, mut pairs): (&Frame, Vec<[u32; 2]>)| {
            // Pairs of bodies that the frame doesn't have would be noticed at once.
            pairs.retain(|pair| (pair[1] as usize) < frame.bodies.len());
            Answer { pairs, ns: None }
        };
        Ok(frames.map(answer).collect())
    }
}

/// The right answers.
pub fn exact(case: &Case) -> Lists {
    let truth = Truth::new(case.claim, &case.shapes).unwrap();
    case.frames.iter().map(|frame| truth.pairs(frame).unwrap()).collect()
}

/// Right answers to other frames, or a part of them; `None` for other flaws.
fn of_other_frames(flaw: Flaw, case: &Case) -> Option<Lists> {
    let frame_of: fn(usize, usize) -> usize = match flaw {
        Flaw::FrameBefore => |n, _| n.saturating_sub(1),
        Flaw::FirstFrame => |_, _| 0,
        Flaw::LastFrame => |_, last| last,
        Flaw::BothFrames
        | Flaw::EmptyAfter(_)
        | Flaw::LateNew
        | Flaw::OneAsleep
        | Flaw::LostOnWaking
        | Flaw::Points
        | Flaw::Bits16
        | Flaw::Room(_) => |n, _| n,
        _ => return None,
    };
    let right = exact(case);
    let mut lists: Lists = Vec::new();
    let mut moved_before = Vec::new();
    for (n, frame) in case.frames.iter().enumerate() {
        let before = &case.frames[n.saturating_sub(1)];
        let bodies = 0..frame.bodies.len();
        let moved: Vec<bool> = bodies.map(|i| n == 0 || has_moved(before, frame, i)).collect();
        let is_new = |body: u32| n > 0 && former(frame, body as usize).is_none();
        let wakes =
            |body: u32| moved[body as usize] && moved_before.get(body as usize) == Some(&false);
        let is_point = |body: u32| {
            let [x0, y0, z0, x1, y1, z1] = frame.boxes[body as usize];
            x0 == x1 || y0 == y1 || z0 == z1
        };
        let mut list = right[frame_of(n, right.len() - 1)].clone();
        match flaw {
            Flaw::BothFrames => list.retain(|pair| right[n.saturating_sub(1)].contains(pair)),
            Flaw::EmptyAfter(last) if n >= last => list.clear(),
            Flaw::LateNew => list.retain(|pair| !pair.iter().any(|&body| is_new(body))),
            Flaw::OneAsleep if n > 0 => {
                let both = |pair: &[u32; 2]| pair.iter().all(|&body| moved[body as usize]);
                list.retain(|pair| both(pair) || lists[n - 1].contains(pair));
            }
            Flaw::LostOnWaking => list.retain(|pair| !pair.iter().any(|&body| wakes(body))),
            Flaw::Points => list.retain(|pair| !pair.iter().any(|&body| is_point(body))),
            Flaw::Bits16 => list.retain(|pair| pair[1] <= u32::from(u16::MAX)),
            Flaw::Room(room) => list.truncate(room),
            _ => {}
        }
        lists.push(list);
        moved_before = moved;
    }
    Some(lists)
}

/// The number that a body had in the frame before.
fn former(frame: &Frame, body: usize) -> Option<usize> {
    frame.was.as_ref().map_or(Some(body), |was| was[body].map(|number| number as usize))
}

fn has_moved(before: &Frame, frame: &Frame, body: usize) -> bool {
    let pose = |frame: &Frame, i: usize| {
        (frame.bodies.rotation[i], frame.bodies.translation[i], frame.boxes[i].map(f32::to_bits))
    };
    let former = former(frame, body).filter(|&f| f < before.bodies.len());
    former.is_none_or(|former| pose(before, former) != pose(frame, body))
}

/// The case as a culler knows it that reads some of its input wrongly; `None` for other flaws.
fn with_other_input(flaw: Flaw, case: &Case) -> Option<Case> {
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

/// The lists of boxes that were nearer than a skin when the list was made.
fn listed(renewal: Renewal, case: &Case) -> Lists {
    const SKIN: f32 = 1.5;
    let (mut lists, mut known, mut age): (Lists, Vec<WorldBox>, usize) =
        (Vec::new(), Vec::new(), 0);
    for Frame { boxes, bodies, .. } in &case.frames {
        let moved = boxes.iter().flatten().zip(known.iter().flatten());
        let moved = moved.fold(0.0, |most: f32, (x, y)| most.max((x - y).abs()));
        let is_old = match renewal {
            Renewal::HalfSkin | Renewal::FrameToFrame => moved >= 0.49 * SKIN,
            Renewal::Skin => moved >= 0.98 * SKIN,
            Renewal::Eighth => age == 8,
        };
        age = if is_old || known.is_empty() { 0 } else { age + 1 };
        let mut list = lists.last().cloned().unwrap_or_default();
        if age == 0 {
            let all = (0..boxes.len()).flat_map(|j| (0..j).map(move |i| [i, j]));
            let moves = |&[i, j]: &[usize; 2]| bodies.dynamic[i] || bodies.dynamic[j];
            let near = |&[i, j]: &[usize; 2]| boxes_near(&boxes[i], &boxes[j], [SKIN, 0.0]);
            let near = all.filter(moves).filter(near);
            list = near.map(|pair| pair.map(|body| body as u32)).collect();
        }
        if age == 0 || renewal == Renewal::FrameToFrame {
            known.clone_from(boxes);
        }
        lists.push(list);
    }
    lists
}

/// The right answers, and pairs that the box of the lower number would meet if it were larger.
fn grown(flaw: Flaw, case: &Case) -> Lists {
    let with_near = |(frame, mut list): (&Frame, Vec<[u32; 2]>)| {
        for (j, b) in frame.boxes.iter().enumerate() {
            for (i, a) in frame.boxes[..j].iter().enumerate() {
                let [x0, y0, z0, x1, y1, z1] = *a;
                let moves = frame.bodies.dynamic[i] || frame.bodies.dynamic[j];
                let may_grow = flaw == Flaw::Grown || i + 1 == j;
                if moves && may_grow && boxes_meet(&[x0, y0, z0, x1 + 0.5, y1 + 0.5, z1 + 0.5], b) {
                    list.push([i as u32, j as u32]);
                }
            }
        }
        list.sort_unstable();
        list.dedup();
        list
    };
    case.frames.iter().zip(exact(case)).map(with_near).collect()
}

/// Whether a culler with a flawed test reports a pair that must be reported.
fn is_seen(
    flaw: Flaw,
    case: &Case,
    [first, frame]: [&Frame; 2],
    pair: [u32; 2],
    (shapes, truth): (&Shapes, &Truth),
) -> bool {
    let at = pair.map(|body| body as usize);
    let [a, b] = at.map(|i| &frame.boxes[i]);
    let is_of_boxes = case.claim.is_of_boxes();
    match flaw {
        Flaw::Strict if !is_of_boxes => {
            let mut alone = frame.picked(&at);
            for axis in 0..3 {
                let [from, to] = [a, b].map(|ends| ends[axis] / 2.0 + ends[axis + 3] / 2.0);
                let t = &mut alone.bodies.translation[1][axis];
                *t = if to > from {
                    t.next_up()
                } else if to < from {
                    t.next_down()
                } else {
                    *t
                };
            }
            truth.pair(&alone, [0, 1]).unwrap()
        }
        Flaw::Strict | Flaw::HalfOpen => {
            let mut alone = frame.picked(&at);
            for ends in &mut alone.boxes {
                for axis in 0..3 {
                    if ends[axis] == ends[axis + 3] {
                        continue;
                    }
                    ends[axis + 3] = ends[axis + 3].next_down();
                    if flaw == Flaw::Strict && ends[axis] < ends[axis + 3] {
                        ends[axis] = ends[axis].next_up();
                    }
                }
            }
            truth.pair(&alone, [0, 1]).unwrap()
        }
        // Boxes that don't meet as given have a margin between them or are images.
        Flaw::Naive(volume) if is_of_boxes => !boxes_meet(a, b) || naive_boxes(volume, a, b),
        Flaw::Naive(volume) => {
            let has_parts = |i: usize| frame.parts.as_ref().is_some_and(|p| !p[i].is_empty());
            if at.into_iter().any(has_parts) {
                return true; // other flaws are about parts
            }
            let bodies = &frame.bodies;
            match volume {
                Volume::Ball if case.claim == Claim::Sphere => {
                    naive_overlap(shapes, bodies, pair, Predicate::Sphere)
                }
                Volume::Ball => balls_meet(case, bodies, at),
                Volume::Box => naive_overlap(shapes, bodies, pair, Predicate::Aabb),
                Volume::OrDop => {
                    naive_overlap(shapes, bodies, pair, Predicate::OrDop(Overlap::TwoSided))
                }
                Volume::Hull => convex_meet(at.map(|i| hull(case, frame, i))),
                Volume::Mesh => {
                    let [of_a, of_b] = at.map(|i| triangles(case, frame, i));
                    of_a.iter().any(|a| of_b.iter().any(|b| convex_meet([a.clone(), b.clone()])))
                }
            }
        }
        Flaw::LargerMargin | Flaw::RoundedMargins => {
            let Some(margins) = &frame.margins else { return true };
            let [p, q] = at.map(|i| margins[i]);
            if flaw == Flaw::LargerMargin {
                return boxes_near(a, b, [p.max(q), 0.0]);
            }
            let apart =
                |a: &WorldBox, b: &WorldBox| (0..3).any(|axis| b[axis] > a[axis + 3] + (p + q));
            !apart(a, b) && !apart(b, a)
        }
        _ => {
            let Some(periods) = frame.periods else { return true };
            let starts = at.map(|i| first.boxes.get(i).unwrap_or(&frame.boxes[i]));
            match flaw {
                Flaw::NextImages => {
                    images(a, b, periods).iter().flatten().all(|n| (-1..=1).contains(n))
                }
                _ => (0..3).all(|axis| meet_along(flaw, [a, b], starts, axis, periods[axis])),
            }
        }
    }
}

fn interval(ends: &WorldBox, axis: usize) -> [f64; 2] {
    [ends[axis], ends[axis + 3]].map(f64::from)
}

/// Whether two boxes meet along an axis, by a flawed search of the image.
fn meet_along(
    flaw: Flaw,
    boxes: [&WorldBox; 2],
    starts: [&WorldBox; 2],
    axis: usize,
    period: Option<f64>,
) -> bool {
    let [a, b] = boxes.map(|ends| interval(ends, axis));
    let overlap = |a: [f64; 2], b: [f64; 2], by: f64| a[0] <= b[1] + by && b[0] + by <= a[1];
    let Some(period) = period else {
        return overlap(a, b, 0.0);
    };
    if flaw == Flaw::FormerImage {
        let [a0, b0] = starts.map(|ends| interval(ends, axis)[0]);
        return overlap(a, b, ((a0 - b0) / period).round() * period);
    }
    let wrapped = |ends: [f64; 2]| ends.map(|end| end - (ends[0] / period).round() * period);
    let (a, b) = (wrapped(a), wrapped(b));
    [-period, 0.0, period].into_iter().any(|by| overlap(a, b, by))
}

/// Balls around boxes, or centres and half sizes, in f32.
fn naive_boxes(volume: Volume, a: &WorldBox, b: &WorldBox) -> bool {
    let centre = |ends: &WorldBox, axis: usize| 0.5 * (ends[axis] + ends[axis + 3]);
    let half = |ends: &WorldBox, axis: usize| 0.5 * (ends[axis + 3] - ends[axis]);
    let d = [0, 1, 2].map(|axis| centre(b, axis) - centre(a, axis));
    if volume == Volume::Box {
        return (0..3).all(|axis| d[axis].abs() <= half(a, axis) + half(b, axis));
    }
    let square = |v: [f32; 3]| v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    let radius = |ends| square([0, 1, 2].map(|axis| half(ends, axis))).sqrt();
    square(d).sqrt() <= radius(a) + radius(b)
}

type Vector = [f32; 3];

/// Balls about the bodies' origins, around their vertices, in f32.
fn balls_meet(case: &Case, bodies: &Bodies, at: [usize; 2]) -> bool {
    let square = |[x, y, z]: Vector| x * x + y * y + z * z;
    let radius = |i: usize| {
        let vertices = case.shapes[bodies.shape[i] as usize].vertices.iter();
        vertices.fold(0.0, |m: f32, v| m.max(square(*v).sqrt()))
    };
    let [a, b] = at.map(|i| bodies.translation[i]);
    let reach = radius(at[0]) + radius(at[1]);
    square([0, 1, 2].map(|n| b[n] - a[n])) <= reach * reach
}

/// The corners of a convex piece, and of each of its faces.
#[derive(Clone)]
struct Piece {
    corners: Vec<Vector>,
    faces: Vec<[Vector; 3]>,
}

/// A body's triangles in f32.
fn triangles(case: &Case, frame: &Frame, i: usize) -> Vec<Piece> {
    let shape = &case.shapes[frame.bodies.shape[i] as usize];
    let turn = rotation(frame.bodies.rotation[i]);
    let place = |v: u32| {
        let at = transform(&turn, shape.vertices[v as usize], [0.0; 3]);
        [0, 1, 2].map(|axis| at[axis] as f32 + frame.bodies.translation[i][axis])
    };
    let piece = |corners: &[u32; 3]| {
        let face = corners.map(place);
        Piece { corners: face.to_vec(), faces: vec![face] }
    };
    shape.triangles.iter().map(piece).collect()
}

/// A body's convex hull, if its mesh is convex.
fn hull(case: &Case, frame: &Frame, i: usize) -> Piece {
    let all = triangles(case, frame, i);
    let corners = all.iter().flat_map(|piece| piece.corners.clone()).collect();
    Piece { corners, faces: all.into_iter().flat_map(|piece| piece.faces).collect() }
}

/// Whether no normal of a face and no cross product of edges separates two convex pieces, in f32.
fn convex_meet(pieces: [Piece; 2]) -> bool {
    let minus = |a: Vector, b: Vector| [0, 1, 2].map(|n| a[n] - b[n]);
    let cross = |a: Vector, b: Vector| {
        [0, 1, 2].map(|n| {
            let (m, o) = ((n + 1) % 3, (n + 2) % 3);
            a[m] * b[o] - a[o] * b[m]
        })
    };
    let range = |piece: &Piece, axis: Vector| {
        let along = piece.corners.iter().map(|v| axis[0] * v[0] + axis[1] * v[1] + axis[2] * v[2]);
        along.fold([f32::INFINITY, f32::NEG_INFINITY], |[lo, hi], x| [lo.min(x), hi.max(x)])
    };
    let parts = |axis: Vector| {
        let [[a, b], [c, d]] = [0, 1].map(|n| range(&pieces[n], axis));
        b < c || d < a
    };
    let edges = |piece: &Piece| -> Vec<Vector> {
        let of = |[a, b, c]: &[Vector; 3]| [minus(*b, *a), minus(*c, *b), minus(*a, *c)];
        piece.faces.iter().flat_map(of).collect()
    };
    let normal = |[a, b, c]: &[Vector; 3]| cross(minus(*b, *a), minus(*c, *a));
    let [of_a, of_b] = [0, 1].map(|n| edges(&pieces[n]));
    let mut normals = pieces.iter().flat_map(|piece| piece.faces.iter().map(normal));
    !normals.any(parts) && !of_a.iter().any(|a| of_b.iter().any(|b| parts(cross(*a, *b))))
}
