//! Engines that are asked: ours and parry3d's tree.

use parry3d::bounding_volume::Aabb;
use parry3d::math::Vector;
use parry3d::partitioning::{Bvh, BvhBuildStrategy, BvhNode};
use parry3d::query::{PointQuery as _, Ray, RayCast as _};
use rayon::prelude::*;
use sdop::query::{Answers, LineHit};
use sdop::{BodyId, BoxWorld, Line, QueryIndex, QueryVolume};
use sdop_bench::remedy::OrReport as _;

use super::questions::{Question, Questions, RADIUS, Segment};
use crate::boxes::{Slabs, lower, upper};
use crate::parry::aabb;
use crate::threads::Threads;

/// An engine that holds the boxes of some questions.
pub trait Asked {
    /// Answers every question of a kind into the engine's memory: one after the other on the
    /// caller's thread, or all together on several. This is timed.
    fn ask(&mut self, question: Question);

    /// The answers, sorted.
    fn answers(&self) -> Vec<Vec<u32>>;
}

/// Answers each question, on all threads if there are several.
pub fn each<Q: Sync, A: Send>(
    threads: &Threads,
    questions: &[Q],
    answer: impl Fn(&Q) -> A + Sync + Send,
) -> Vec<A> {
    if threads.several() {
        threads.run(|| questions.par_iter().with_min_len(32).map(answer).collect())
    } else {
        questions.iter().map(answer).collect()
    }
}

/// An index of a world.
pub struct Ours {
    index: QueryIndex,
    halves: [QueryIndex; 2],
    is_batch: bool,
    probes: Vec<QueryVolume<'static>>,
    balls: Vec<QueryVolume<'static>>,
    lines: Vec<Line>,
    found: OurAnswers,
}

/// Answers as our calls return them.
enum OurAnswers {
    Bodies(Vec<Vec<BodyId>>),
    Hits(Vec<Vec<LineHit>>),
    ManyBodies(Answers<BodyId>),
    ManyHits(Answers<LineHit>),
    Pairs(Vec<[BodyId; 2]>),
}

impl Ours {
    pub fn new(questions: &Questions, threads: usize) -> miette::Result<Self> {
        let index = |boxes: &[Slabs]| -> miette::Result<QueryIndex> {
            let mut world = BoxWorld::new();
            for slabs in boxes {
                let aabb = sdop::Aabb::new(lower(slabs), upper(slabs));
                world.insert(aabb).or_report()?;
            }
            let mut index = QueryIndex::with_threads(threads).or_report()?;
            index.update(&world);
            Ok(index)
        };
        let [even, odd] = questions.halves();
        let line = |[from, to]: &Segment| Line::Segment {
            from: from.map(f64::from),
            to: to.map(f64::from),
        };
        let ball = |centre: &[f32; 3]| QueryVolume::Ball {
            centre: centre.map(f64::from),
            radius: f64::from(RADIUS),
        };
        let probe = |slabs: &Slabs| QueryVolume::Box {
            min: lower(slabs).map(f64::from),
            max: upper(slabs).map(f64::from),
        };
        Ok(Self {
            index: index(&questions.boxes)?,
            halves: [index(&even)?, index(&odd)?],
            is_batch: threads > 1,
            probes: questions.probes.iter().map(probe).collect(),
            balls: questions.centres.iter().map(ball).collect(),
            lines: questions.segments.iter().map(line).collect(),
            found: OurAnswers::Pairs(Vec::new()),
        })
    }

    fn answer(&self, question: Question) -> Result<OurAnswers, sdop::query::QueryError> {
        let (index, lines) = (&self.index, &self.lines);
        let volumes = match question {
            Question::Ball => &self.balls,
            _ => &self.probes,
        };
        Ok(match (question, self.is_batch) {
            (Question::Sets, _) => {
                let [even, odd] = &self.halves;
                OurAnswers::Pairs(even.pairs_with(odd)?)
            }
            (Question::Box | Question::Ball, true) => {
                OurAnswers::ManyBodies(index.touching_all(volumes)?)
            }
            (Question::Along, true) => OurAnswers::ManyHits(index.along_all(lines)?),
            (Question::First, true) => OurAnswers::ManyHits(index.first_all(lines)?),
            (Question::Box | Question::Ball, false) => {
                let found = volumes.iter().map(|volume| index.touching(volume));
                OurAnswers::Bodies(found.collect::<Result<_, _>>()?)
            }
            (Question::Along, false) => {
                let found = lines.iter().map(|line| index.along(line));
                OurAnswers::Hits(found.collect::<Result<_, _>>()?)
            }
            (Question::First, false) => {
                let first = |line| Ok(index.first(line)?.into_iter().collect());
                OurAnswers::Hits(lines.iter().map(first).collect::<Result<_, _>>()?)
            }
        })
    }
}

impl Asked for Ours {
    fn ask(&mut self, question: Question) {
        match self.answer(question) {
            Ok(found) => self.found = found,
            Err(error) => panic!("{error}"),
        }
    }

    fn answers(&self) -> Vec<Vec<u32>> {
        let number = |id: &BodyId| id.slot() as u32;
        let bodies = |ids: &[BodyId]| ids.iter().map(number).collect::<Vec<_>>();
        let of_hits = |hits: &[LineHit]| {
            let mut met: Vec<_> = hits.iter().map(|hit| number(&hit.body)).collect();
            met.sort_unstable();
            met
        };
        match &self.found {
            OurAnswers::Bodies(found) => found.iter().map(|ids| bodies(ids)).collect(),
            OurAnswers::ManyBodies(found) => found.iter().map(bodies).collect(),
            OurAnswers::Hits(found) => found.iter().map(|hits| of_hits(hits)).collect(),
            OurAnswers::ManyHits(found) => found.iter().map(of_hits).collect(),
            OurAnswers::Pairs(found) => {
                let pairs = found.iter().map(|pair| pair.each_ref().map(number));
                let mut partners = vec![Vec::new(); self.halves[0].len()];
                pairs.for_each(|[even, odd]| partners[even as usize].push(2 * odd + 1));
                partners
            }
        }
    }
}

/// A tree built at once.
pub struct Parry {
    boxes: Vec<Aabb>,
    tree: Bvh,
    halves: [Bvh; 2],
    probes: Vec<Aabb>,
    centres: Vec<Vector>,
    rays: Vec<Ray>,
    threads: Threads,
    found: Vec<Vec<u32>>,
    pairs: Vec<(u32, u32)>,
}

impl Parry {
    pub fn new(questions: &Questions, threads: usize) -> miette::Result<Self> {
        let boxes: Vec<Aabb> = questions.boxes.iter().map(aabb).collect();
        let build = |boxes: &[Aabb]| Bvh::from_leaves(BvhBuildStrategy::Binned, boxes);
        let half = |half: Vec<Slabs>| build(&half.iter().map(aabb).collect::<Vec<_>>());
        Ok(Self {
            tree: build(&boxes),
            boxes,
            halves: questions.halves().map(half),
            probes: questions.probes.iter().map(aabb).collect(),
            centres: questions.centres.iter().map(|&centre| Vector::from_array(centre)).collect(),
            rays: questions.segments.iter().map(ray).collect(),
            threads: Threads::new(threads)?,
            found: Vec::new(),
            pairs: Vec::new(),
        })
    }

    fn meets_ball(&self, centre: Vector) -> Vec<u32> {
        let is_near = |node: &BvhNode| node.aabb().distance_to_local_point(centre, true) <= RADIUS;
        self.tree.leaves(is_near).collect()
    }

    fn along(&self, ray: &Ray) -> Vec<u32> {
        let is_met = |node: &BvhNode| node.aabb().intersects_local_ray(ray, 1.0);
        self.tree.leaves(is_met).collect()
    }

    fn first(&self, ray: &Ray) -> Vec<u32> {
        let at = |leaf: u32, last: f32| self.boxes[leaf as usize].cast_local_ray(ray, last, true);
        let first = self.tree.cast_ray(ray, 1.0, at);
        first.into_iter().map(|(leaf, _)| leaf).collect()
    }
}

impl Asked for Parry {
    fn ask(&mut self, question: Question) {
        let threads = &self.threads;
        self.pairs.clear();
        self.found = match question {
            Question::Box => {
                each(threads, &self.probes, |probe| self.tree.intersect_aabb(probe).collect())
            }
            Question::Ball => each(threads, &self.centres, |&centre| self.meets_ball(centre)),
            Question::Along => each(threads, &self.rays, |ray| self.along(ray)),
            Question::First => each(threads, &self.rays, |ray| self.first(ray)),
            Question::Sets if threads.several() => {
                let [_, odd] = &self.halves;
                let even: Vec<&Aabb> = self.boxes.iter().step_by(2).collect();
                each(threads, &even, |aabb| {
                    odd.intersect_aabb(aabb).map(|place| 2 * place + 1).collect()
                })
            }
            Question::Sets => {
                let [even, odd] = &self.halves;
                let pairs =
                    even.leaf_pairs(odd, |one: &BvhNode, other: &BvhNode| one.intersects(other));
                self.pairs.extend(pairs);
                Vec::new()
            }
        };
    }

    fn answers(&self) -> Vec<Vec<u32>> {
        let mut answers = self.found.clone();
        if answers.is_empty() {
            answers = vec![Vec::new(); self.boxes.len().div_ceil(2)];
            let pairs = self.pairs.iter();
            pairs.for_each(|&(even, odd)| answers[even as usize].push(2 * odd + 1));
        }
        answers.iter_mut().for_each(|bodies| bodies.sort_unstable());
        answers
    }
}

/// The segment as a ray of length 1.
pub fn ray([from, to]: &Segment) -> Ray {
    let [from, to] = [from, to].map(|end| Vector::from_array(*end));
    Ray::new(from, to - from)
}
