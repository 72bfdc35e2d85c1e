//! A culler that knows the exact answers to every claim, with one flaw.

mod inputs;
mod pairs;

use std::collections::HashMap;
use std::sync::Mutex;

use inputs::with_other_input;
use pairs::{grown, is_seen, listed};
use sdop::rounding::pose::{rotation, transform};
use sdop::settings::Overlap;
use sdop_judge::answer::{Answer, StopReason};
use sdop_judge::truth::answers::Predicate;
use sdop_judge::truth::naive::naive_overlap;
use sdop_judge::truth::reference_shapes::Shapes;
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

    /// The lists of a case to which these are the right ones.
    fn lists(&self, case: &Case, right: &Lists) -> Lists {
        let flaw = self.flaw;
        match flaw {
            Flaw::None => return right.clone(),
            Flaw::ByGroup | Flaw::ByFirstPose | Flaw::ByCount => {
                return self.remembered(case, right);
            }
            Flaw::Grown | Flaw::GrownNeighbours => return grown(flaw, case),
            Flaw::List(renewal) => return listed(renewal, case),
            _ => {}
        }
        if let Some(lists) = of_other_frames(flaw, case, right) {
            return lists;
        }
        if let Some(known) = with_other_input(flaw, case) {
            return exact(&known);
        }
        let shapes = Shapes::new(case.shapes.clone()).unwrap();
        let truth = Truth::new(case.claim, &case.shapes).unwrap();
        let mut lists = right.clone();
        for (frame, list) in case.frames.iter().zip(&mut lists) {
            let frames = [&case.frames[0], frame];
            list.retain(|&pair| is_seen(flaw, case, frames, pair, (&shapes, &truth)));
        }
        lists
    }

    /// Answers by something that doesn't determine them.
    fn remembered(&self, case: &Case, right: &Lists) -> Lists {
        let mut seen = self.seen.lock().unwrap();
        if self.flaw == Flaw::ByGroup {
            let known = seen.entry(case.group().to_owned()).or_insert_with(|| right.clone());
            let mut lists = known.clone();
            lists.resize(case.frames.len(), Vec::new());
            return lists;
        }
        let lists = case.frames.iter().zip(right.clone()).map(|(frame, list)| {
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
        Knowing(self, case, &exact(case)).answer(case)
    }
}

/// A flawed culler that is told the right answers to a case.
pub struct Knowing<'a>(pub &'a Flawed, pub &'a Case, pub &'a Lists);

impl Subject for Knowing<'_> {
    fn answer(&self, case: &Case) -> Result<Vec<Answer>, StopReason> {
        let Self(flawed, known, right) = *self;
        if !std::ptr::eq(case, known) {
            return flawed.answer(case);
        }
        if case.frames.is_empty() {
            return Ok(Vec::new()); // so small are the scenes that shrinking tries
        }
        let frames = case.frames.iter().zip(flawed.lists(case, right));
        let answer = |(frame, mut pairs): (&Frame, Vec<[u32; 2]>)| {
            // Pairs of bodies that the frame doesn't have would be noticed at once.
            pairs.retain(|pair| (pair[1] as usize) < frame.bodies.len());
            Answer { pairs, ..Answer::default() }
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
fn of_other_frames(flaw: Flaw, case: &Case, right: &Lists) -> Option<Lists> {
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
