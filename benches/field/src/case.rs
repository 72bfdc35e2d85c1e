//! The cases of a comparison: a scene, what changes in it or is asked of it, and how many frames.

use std::fmt::{self, Display, Formatter};
use std::sync::Arc;

use sdop_bench::roster::{OnlyCase, Workload};
use sdop_bench::scene::Scene;
use sdop_judge::Claim;
use serde::Serialize;

use crate::entry::Entry;
use crate::frame::Frame;
use crate::movers::{Motion, MoverCourse};
use crate::questions::{Question, Questions};
use crate::scenes::{Course, Order, Spread};

/// A scene and what is done with it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Case {
    /// What is compared.
    pub workload: Workload,
    /// How bodies are spread.
    pub spread: Spread,
    /// In which order they are numbered.
    pub order: Order,
    /// How many there are.
    pub bodies: usize,
    /// Threads that each engine may use.
    pub threads: usize,
    /// The number of bodies that move per frame.
    pub movers: usize,
    /// Which ones move, if not all do.
    pub motion: Option<Motion>,
    /// Whether engines of meshes take part in place of those of boxes.
    pub meshes: bool,
    /// What is asked, and how often.
    pub question: Option<Question>,
    /// Questions per frame.
    pub questions: usize,
    /// Frames in which engines are alone: pairs are checked and memory is counted.
    pub checked: usize,
    /// Frames before the clock counts, those included: trees age, caches and buffers fill.
    pub warm_up: usize,
    /// Frames that are timed.
    pub timed: usize,
    /// Frames that one engine does before it is the next one's turn.
    pub turn: usize,
}

/// A case with more movers than this is timed for fewer frames.
const MOVERS_OF_ALL_FRAMES: usize = 300_000;

impl Case {
    /// All boxes move.
    pub fn boxes(spread: Spread, order: Order, bodies: usize, threads: usize) -> Self {
        let [warm_up, timed, turn, checked] = match bodies {
            0..=10_000 => [300, 200, 20, 20],
            10_001..=100_000 => [60, 60, 10, 4],
            _ => [20, 20, 4, 3],
        };
        Self {
            workload: Workload::Boxes,
            spread,
            order,
            bodies,
            threads,
            movers: bodies,
            motion: None,
            meshes: false,
            question: None,
            questions: 0,
            checked,
            warm_up,
            timed,
            turn,
        }
    }

    /// Few boxes, or meshes, move.
    pub fn movers(bodies: usize, movers: usize, motion: Motion, meshes: bool) -> Self {
        let most = if bodies > 100_000 { 60 } else { 300 };
        let timed = (MOVERS_OF_ALL_FRAMES / movers.max(1)).clamp(30, most);
        Self {
            workload: Workload::Movers,
            movers,
            motion: Some(motion),
            meshes,
            checked: 2,
            warm_up: 20,
            timed,
            turn: if timed > 60 { 20 } else { 10 },
            ..Self::boxes(Spread::Uniform, Order::Random, bodies, 1)
        }
    }

    /// Boxes that rest are asked so many questions, so many times.
    pub fn queries(
        bodies: usize,
        threads: usize,
        question: Question,
        questions: usize,
        timed: usize,
    ) -> Self {
        Self {
            workload: Workload::Queries,
            movers: 0,
            question: Some(question),
            questions,
            checked: 1,
            warm_up: 1,
            timed,
            turn: 1,
            ..Self::boxes(Spread::Uniform, Order::Random, bodies, threads)
        }
    }

    /// Questions per frame; a frame without questions counts as one.
    pub fn questions_asked(&self) -> usize {
        match self.question {
            None | Some(Question::Sets) => 1,
            Some(_) => self.questions,
        }
    }

    /// Whether an engine takes part.
    pub fn has(&self, entry: &Entry) -> bool {
        let (row, timed) = (entry.row, &entry.row.timed);
        let is_replacement = self.motion == Some(Motion::Replaced);
        let fits = match timed.only {
            Some(OnlyCase::Replacement) => is_replacement,
            Some(OnlyCase::ReadPairs) => {
                self.motion == Some(Motion::Same) && self.movers * 100 == self.bodies
            }
            Some(OnlyCase::Meshes) => true,
            None => !is_replacement,
        };
        fits && row.can.contains(&self.workload)
            && (timed.threads || self.threads == 1)
            && (self.workload != Workload::Movers || self.meshes == (row.claim == Claim::Mesh))
            && (self.spread != Spread::Long || row.claim == Claim::Aabb)
            && timed.most_bodies.is_none_or(|most| self.bodies <= most)
            && self
                .question
                .is_none_or(|question| !timed.lacks.iter().any(|it| it == question.name()))
    }
}

impl Display for Case {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { spread, order, bodies, threads, movers, .. } = self;
        let plural = if *threads == 1 { "" } else { "s" };
        match (self.motion, self.question) {
            (Some(motion), _) => {
                let what = if self.meshes { "meshes" } else { "boxes" };
                write!(f, "{bodies} {what}, {movers} movers, {}", motion.name())
            }
            (_, Some(question)) => {
                write!(f, "{bodies} boxes, {threads} thread{plural}, question {}", question.name())
            }
            _ => write!(f, "{bodies} boxes, {spread:?}, {order:?} order, {threads} thread{plural}"),
        }
    }
}

/// The frames of a case.
pub enum Frames {
    /// All bodies move; how many frames there were.
    All(Box<Course>, Frame, usize),
    /// Few do.
    Few(Box<MoverCourse>),
    /// The same questions in each frame.
    Asked(Box<Course>, Frame),
}

impl Frames {
    /// Those of a case, before the first one.
    pub fn new(case: &Case) -> miette::Result<Self> {
        if let Some(motion) = case.motion {
            let course = MoverCourse::new(case.bodies, case.movers, motion)?;
            return Ok(Self::Few(Box::new(course)));
        }
        let mut course = Course::new(case.spread, case.bodies, case.order, case.warm_up)?;
        let mut first = Frame::default();
        course.next_frame(&mut first)?;
        let Some(question) = case.question else {
            return Ok(Self::All(Box::new(course), first, 0));
        };
        let questions = Questions::new(std::mem::take(&mut first.boxes), case.questions);
        first.question = Some((question, Arc::new(questions)));
        Ok(Self::Asked(Box::new(course), first))
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        match self {
            Self::All(course, ..) | Self::Asked(course, _) => &course.scene,
            Self::Few(course) => &course.scene,
        }
    }

    /// All bodies after the last frame, or before the first one.
    pub fn present(&self) -> &Frame {
        match self {
            Self::All(_, present, _) | Self::Asked(_, present) => present,
            Self::Few(course) => &course.present,
        }
    }

    /// The next frame. The first one of bodies that all move is the scene as placed.
    pub fn next_frame(&mut self) -> miette::Result<Frame> {
        let mut frame = Frame::default();
        match self {
            Self::All(course, present, count) => {
                if *count > 0 {
                    course.next_frame(present)?;
                }
                *count += 1;
                frame.clone_from(present);
            }
            Self::Few(course) => course.next_frame(&mut frame),
            Self::Asked(_, present) => frame.question.clone_from(&present.question),
        }
        Ok(frame)
    }
}
