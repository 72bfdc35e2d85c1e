//! The smallest case that a culler still fails: frames, bodies, triangles and digits are removed
//! for as long as it misses a pair.

mod digits;

use std::collections::BTreeSet;
use std::time::{Duration, Instant};

use super::case::{Case, Frame};
use super::claim::Claim;
use super::score::{Miss, judge_answers};
use super::subject::Subject;
use super::witness::Witness;
use sdop::mesh::TriangleMesh;
use sdop::volume::{Origin, Shape, ShapeSpec};

/// The name of a counter-example's files, and of the case in them.
pub const STEM: &str = "missed-pair";

/// A small case that shows a missed pair.
#[derive(Clone, Debug)]
pub struct SmallestCase {
    /// The name of the case from which it was reduced.
    pub from: String,
    /// The case, under a new name.
    pub case: Case,
    /// The reported pairs, frame by frame, sorted.
    pub pairs: Vec<Vec<[u32; 2]>>,
    /// What is missed.
    pub miss: Miss,
    /// Why it should not be.
    pub witness: Option<Witness>,
}

/// Makes a case that a subject fails smaller, for so long at most. `None` when it doesn't fail
/// again.
pub fn shrink(subject: &dyn Subject, case: &Case, time: Duration) -> Option<SmallestCase> {
    shrink_while(case, time, &|case| {
        let answers = subject.answer(case).ok()?;
        let judged = judge_answers(case, &answers).ok()?;
        Some((judged.miss?, judged.lists))
    })
}

/// Groups of which a case is reduced.
const GROUPS_REDUCED: usize = 3;

/// Makes some of the cases that a subject fails smaller, for so long at most: one of each group, of
/// the groups that are reduced fastest, which have the fewest pairs. Returns the one with the
/// shortest numbers.
pub fn shrink_some(subject: &dyn Subject, cases: &[&Case], time: Duration) -> Option<SmallestCase> {
    let mut cases = cases.to_vec();
    cases.sort_by_key(|case| case.pairs());
    let mut groups = BTreeSet::new();
    cases.retain(|case| groups.insert(case.group()));
    let until = Instant::now() + time;
    let mut found: Option<SmallestCase> = None;
    for case in cases.into_iter().take(GROUPS_REDUCED) {
        let left = until.saturating_duration_since(Instant::now());
        if found.is_some() && left < time / 2 {
            break;
        }
        let smaller = shrink(subject, case, left);
        let digits =
            |one: &Option<SmallestCase>| one.as_ref().map_or(u32::MAX, |it| it.case.digits());
        if digits(&smaller) < digits(&found) {
            found = smaller;
        }
    }
    found
}

/// Pairs by frame, sorted.
pub type Lists = Vec<Vec<[u32; 2]>>;

/// Returns what a culler misses in a case, and its pairs frame by frame; `None` if it misses none.
pub type FailureCheck<'a> = &'a dyn Fn(&Case) -> Option<(Miss, Lists)>;

/// Makes a case smaller while something is wrong with it, for so long at most.
pub fn shrink_while(case: &Case, time: Duration, wrong: FailureCheck<'_>) -> Option<SmallestCase> {
    let (miss, pairs) = wrong(case)?;
    let mut search =
        Search { wrong, deadline: Instant::now() + time, miss, case: case.clone(), pairs };
    search.fewer_frames();
    search.fewer_bodies();
    search.fewer_parts();
    search.fewer_shapes();
    search.fewer_triangles();
    search.fewer_periods();
    search.fewer_digits();
    let from = case.name.clone();
    let Search { mut case, pairs, miss, .. } = search;
    // Other bodies than in the case of that name; a replayed counter-example has its own name
    // already.
    if !from.starts_with(STEM) {
        case.name = format!("{STEM}/{from}");
    }
    let witness = Witness::of(&case, miss);
    Some(SmallestCase { from, case, pairs, miss, witness })
}

struct Search<'a> {
    wrong: FailureCheck<'a>,
    deadline: Instant,
    case: Case,
    pairs: Vec<Vec<[u32; 2]>>,
    miss: Miss,
}

impl Search<'_> {
    fn is_over(&self) -> bool {
        Instant::now() > self.deadline
    }

    /// Takes over a case if something is wrong with it.
    fn try_case(&mut self, case: Case) -> bool {
        if self.is_over() {
            return false;
        }
        let Some((miss, pairs)) = (self.wrong)(&case) else {
            return false;
        };
        (self.case, self.miss, self.pairs) = (case, miss, pairs);
        true
    }

    /// Keeps only the frame of the miss, or removes as many others as possible.
    fn fewer_frames(&mut self) {
        let with = |case: &Case, kept: &[usize]| Case {
            frames: kept
                .iter()
                .map(|&n| Frame { was: None, restore: false, ..case.frames[n].clone() })
                .collect(),
            ..case.clone()
        };
        let alone = with(&self.case, &[self.miss.frame]);
        if self.case.frames.len() == 1 || self.try_case(alone) {
            return;
        }
        self.case.frames.truncate(self.miss.frame + 1);
        self.pairs.truncate(self.miss.frame + 1);
        // Its frames are a chain.
        if self.case.has_history() {
            return;
        }
        let mut chunk = self.case.frames.len().div_ceil(2);
        while chunk > 0 {
            let mut start = 0;
            while start < self.case.frames.len() && !self.is_over() {
                let all = 0..self.case.frames.len();
                let kept: Vec<usize> =
                    all.filter(|n| !(start..start + chunk).contains(n)).collect();
                if kept.is_empty() || !self.try_case(with(&self.case, &kept)) {
                    start += chunk;
                }
            }
            chunk /= 2;
        }
    }

    /// Keeps only the pair, or removes as many other bodies as possible, half of them at a time.
    fn fewer_bodies(&mut self) {
        let count = self.case.frames[0].bodies.len();
        let is_same = |frame: &Frame| frame.keeps_numbers() && frame.bodies.len() == count;
        if !self.case.frames.iter().all(is_same) {
            return;
        }
        let pair = self.miss.pair.map(|body| body as usize);
        let alone = self.case.picked(&pair);
        if self.try_case(alone) {
            return;
        }
        let bodies = |search: &Self| search.case.frames[0].bodies.len();
        let mut chunk = bodies(self).div_ceil(2);
        while chunk > 0 {
            let mut start = 0;
            while start < bodies(self) && !self.is_over() {
                let kept: Vec<usize> =
                    (0..bodies(self)).filter(|i| !(start..start + chunk).contains(i)).collect();
                let smaller = self.case.picked(&kept);
                if kept.len() < 2 || !self.try_case(smaller) {
                    start += chunk;
                }
            }
            chunk /= 2;
        }
    }

    /// Without parts of bodies, one at a time, in all frames.
    fn fewer_parts(&mut self) {
        let bodies = self.case.frames[0].bodies.len();
        for body in 0..bodies {
            let most = |case: &Case| {
                let parts = case.frames.iter().flat_map(|frame| &frame.parts);
                parts.filter_map(|all| all.get(body)).map(Vec::len).max().unwrap_or(0)
            };
            let mut part = 0;
            while part < most(&self.case) && !self.is_over() {
                if !without_part(&self.case, body, part).is_some_and(|case| self.try_case(case)) {
                    part += 1;
                }
            }
        }
    }

    /// Removes shapes that no body uses.
    fn fewer_shapes(&mut self) {
        let mut case = self.case.clone();
        let used: BTreeSet<u32> = shapes_of(&mut case.frames).map(|shape| *shape).collect();
        let kept: Vec<u32> =
            (0..case.shapes.len() as u32).filter(|shape| used.contains(shape)).collect();
        case.shapes = kept.iter().map(|&shape| self.case.shapes[shape as usize].clone()).collect();
        for shape in shapes_of(&mut case.frames) {
            *shape = kept.iter().position(|kept| kept == shape).unwrap_or(0) as u32;
        }
        if kept.len() < self.case.shapes.len() {
            self.try_case(case);
        }
    }

    /// Without triangles, one at a time, for claims about meshes. Volumes are built anew around
    /// what is left.
    fn fewer_triangles(&mut self) {
        if !matches!(self.case.claim, Claim::Hull | Claim::Mesh | Claim::Parts) {
            return;
        }
        for shape in 0..self.case.shapes.len() {
            let mut t = 0;
            while t < self.case.shapes[shape].triangles.len() && !self.is_over() {
                let smaller = without_triangle(&self.case, shape, t);
                if !smaller.is_some_and(|case| self.try_case(case)) {
                    t += 1;
                }
            }
        }
    }
}

/// Fits the boxes of a frame again; `None` if a part's pose is no longer exact.
fn refit(case: &mut Case, frame: usize) -> Option<()> {
    case.frames[frame].refit(&case.shapes).ok()
}

/// The shape numbers of all bodies and parts.
fn shapes_of(frames: &mut [Frame]) -> impl Iterator<Item = &mut u32> {
    frames.iter_mut().flat_map(|frame| {
        let parts = frame.parts.iter_mut().flatten().flatten();
        let parts = parts.map(|part| &mut part.shape);
        frame.bodies.shape.iter_mut().chain(parts)
    })
}

/// The case in which a body has one part less; `None` if it would have none in some frame.
fn without_part(case: &Case, body: usize, part: usize) -> Option<Case> {
    let mut smaller = case.clone();
    for frame in &mut smaller.frames {
        let own = frame.parts.as_mut()?.get_mut(body)?;
        if part < own.len() {
            own.remove(part);
        }
        frame.bodies.shape[body] = own.first()?.shape;
        frame.refit(&case.shapes).ok()?;
    }
    Some(smaller)
}

/// The case with one triangle of a shape less, and without the vertices that then belong to none.
fn without_triangle(case: &Case, shape: usize, triangle: usize) -> Option<Case> {
    let old = &case.shapes[shape];
    let mut triangles = old.triangles.clone();
    if triangles.len() < 2 {
        return None;
    }
    triangles.remove(triangle);
    let mut vertices: Vec<[f32; 3]> = Vec::new();
    let mut number = vec![None; old.vertices.len()];
    for corner in triangles.iter_mut().flatten() {
        let vertex = *corner as usize;
        *corner = *number[vertex].get_or_insert_with(|| {
            vertices.push(old.vertices[vertex]);
            vertices.len() as u32 - 1
        });
    }
    let mesh = TriangleMesh::new(old.name.clone(), vertices, triangles).ok()?;
    let mut smaller = case.clone();
    smaller.shapes[shape] = rebuilt(&mesh, old)?;
    for frame in 0..smaller.frames.len() {
        refit(&mut smaller, frame)?;
    }
    Some(smaller)
}

/// A mesh's shape in the body frame that it is in, with the directions and the basis of another.
fn rebuilt(mesh: &TriangleMesh, like: &Shape) -> Option<Shape> {
    let spec = ShapeSpec {
        origin: Origin::File,
        directions: like.ordop.directions,
        ..ShapeSpec::default()
    };
    Shape::build(mesh, &spec).ok()
}
