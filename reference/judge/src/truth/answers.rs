//! The exact answers about one frame: every pair that is not static–static, judged by every
//! predicate, bit by bit.

use sdop_reference as reference;

use reference::exact::world::Extents;
use reference::exact::{Decision, Tally, meeting, ordop, sphere, world};

use super::reference_shapes::{self, InvalidInput, Shapes};
use sdop::bodies::Bodies;
use sdop::rounding::{U, up};
use sdop::settings::{CullSettings, Interest, Overlap, Strategy};
use sdop::volume::DirectionSet;

/// A question about a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Predicate {
    /// Do the bounding spheres overlap?
    Sphere,
    /// Do the or-DOPs overlap, as far as the test's axes tell?
    OrDop(Overlap),
    /// Do the world-aligned boxes overlap?
    Aabb,
    /// Do the world-aligned k-DOPs overlap?
    KDop,
    /// Do the oriented boxes overlap?
    Obb,
    /// Do the meshes intersect?
    Mesh,
}

impl Predicate {
    /// Every predicate.
    pub const ALL: [Self; 8] = [
        Self::Sphere,
        Self::OrDop(Overlap::OneSided),
        Self::OrDop(Overlap::TwoSided),
        Self::OrDop(Overlap::Full),
        Self::Aabb,
        Self::KDop,
        Self::Obb,
        Self::Mesh,
    ];

    /// What tables call it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Sphere => "sphere",
            Self::OrDop(Overlap::OneSided) => "or-dop one-sided",
            Self::OrDop(Overlap::TwoSided) => "or-dop two-sided",
            Self::OrDop(Overlap::Full) => "or-dop full",
            Self::Aabb => "aabb",
            Self::KDop => "k-dop",
            Self::Obb => "obb",
            Self::Mesh => "mesh",
        }
    }

    fn index(self) -> usize {
        match self {
            Self::Sphere => 0,
            Self::OrDop(Overlap::OneSided) => 1,
            Self::OrDop(Overlap::TwoSided) => 2,
            Self::OrDop(Overlap::Full) => 3,
            Self::Aabb => 4,
            Self::KDop => 5,
            Self::Obb => 6,
            Self::Mesh => 7,
        }
    }
}

/// Answers about the pairs of one frame.
#[derive(Clone, Debug, Default)]
pub struct Answers {
    /// The pairs i < j that are not static–static, sorted.
    pub pairs: Vec<[u32; 2]>,
    pub(super) answers: [Vec<bool>; Predicate::ALL.len()],
    pub(super) tallies: [Tally; Predicate::ALL.len()],
}

impl Answers {
    /// Judges all pairs of a frame by the given predicates. `k` is the set of the world-aligned
    /// k-DOP.
    ///
    /// # Errors
    /// A pose outside the contract.
    pub fn judge(
        shapes: &Shapes,
        bodies: &Bodies,
        k: DirectionSet,
        predicates: &[Predicate],
    ) -> Result<Self, InvalidInput> {
        let judged = shapes.bodies(bodies)?;
        let pairs: Vec<[u32; 2]> =
            reference::broad_phase::all_pairs(&bodies.dynamic).map(|(i, j)| [i, j]).collect();
        let mut all = Self { pairs, ..Self::default() };
        for &predicate in predicates {
            all.ask(&judged, k, predicate);
        }
        Ok(all)
    }

    fn ask(&mut self, bodies: &[reference::Body<'_>], k: DirectionSet, predicate: Predicate) {
        let extents = |directions| -> Vec<Extents<'_>> {
            let directions = reference_shapes::directions(directions);
            bodies.iter().map(|body| Extents::new(body, directions)).collect()
        };
        let fitted = match predicate {
            Predicate::Aabb => extents(DirectionSet::K6),
            Predicate::KDop => extents(k),
            _ => Vec::new(),
        };
        let mut tally = Tally::default();
        let decide = |&[i, j]: &[u32; 2]| {
            let (i, j) = (i as usize, j as usize);
            let (a, b) = (&bodies[i], &bodies[j]);
            let decision = match predicate {
                Predicate::Sphere => sphere::overlap(a, b),
                Predicate::OrDop(test) => ordop::overlap(a, b, reference_shapes::overlap(test)),
                Predicate::Aabb | Predicate::KDop => world::overlap_extents(&fitted[i], &fitted[j]),
                Predicate::Obb => ordop::overlap_obb(a, b),
                Predicate::Mesh => mesh(a, b),
            };
            tally.count(decision.path);
            decision.value
        };
        self.answers[predicate.index()] = self.pairs.iter().map(decide).collect();
        self.tallies[predicate.index()] = tally;
    }

    /// One answer per pair; empty for a predicate that was not evaluated.
    #[must_use]
    pub fn of(&self, predicate: Predicate) -> &[bool] {
        &self.answers[predicate.index()]
    }

    /// Which stage of the reference decided.
    #[must_use]
    pub fn tally(&self, predicate: Predicate) -> Tally {
        self.tallies[predicate.index()]
    }

    /// Whether a strategy must report the pair number `n`: its predicate on the exact, uninflated
    /// volumes.
    ///
    /// For `s-dop-time-critical` this is the refined answer; what its budget leaves untested comes
    /// on top.
    #[must_use]
    pub fn required(
        &self,
        strategy: Strategy,
        overlap: Overlap,
        interest: &[u32],
        n: usize,
    ) -> bool {
        let looked_at = self.pairs[n].iter().any(|body| interest.contains(body));
        reports(strategy, overlap, looked_at, |predicate| self.of(predicate)[n])
    }
}

/// Whether the rounding margins explain the report of a pair: volumes wider by them overlap
/// exactly. World-aligned volumes are larger than necessary only by their rounding.
///
/// # Errors
/// A pose outside the contract.
pub fn explained_by_margins(
    shapes: &Shapes,
    bodies: &Bodies,
    settings: &CullSettings,
    [i, j]: [u32; 2],
) -> Result<bool, InvalidInput> {
    let (a, b) = (shapes.widened_body(bodies, i)?, shapes.widened_body(bodies, j)?);
    let looked_at = match &settings.interest {
        Some(Interest::Bodies(list)) => list.contains(&i) || list.contains(&j),
        _ => false,
    };
    Ok(reports(settings.strategy, settings.overlap, looked_at, |predicate| match predicate {
        Predicate::Sphere => {
            let (ball_a, ball_b) = (world_ball(&a), world_ball(&b));
            sphere::overlap_balls((&ball_a, &a.pose), (&ball_b, &b.pose)).value
        }
        Predicate::OrDop(test) => ordop::overlap(&a, &b, reference_shapes::overlap(test)).value,
        Predicate::Obb => ordop::overlap_obb(&a, &b).value,
        Predicate::Aabb | Predicate::KDop | Predicate::Mesh => true,
    }))
}

/// The widened ball; a centre off the body's origin is rounded in world coordinates, which adds up
/// to √3 ulps of them.
fn world_ball(body: &reference::Body<'_>) -> reference::Ball {
    let ball = body.shape.ball;
    if ball.centre == [0.0; 3] {
        return ball;
    }
    let size = |v: [f64; 3]| v.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let world = size(body.pose.translation()) + 2.0 * size(ball.centre.map(f64::from));
    reference::Ball { radius: up(f64::from(ball.radius) + 4.0 * U * world), ..ball }
}

/// The strategies as predicates: which volumes must overlap.
fn reports(
    strategy: Strategy,
    overlap: Overlap,
    of_interest: bool,
    is: impl Fn(Predicate) -> bool,
) -> bool {
    match strategy {
        Strategy::None => false,
        Strategy::Sphere => is(Predicate::Sphere),
        Strategy::OrDop => is(Predicate::OrDop(overlap)),
        Strategy::SDopSequential | Strategy::SDopBatch | Strategy::SDopTimeCritical => {
            is(Predicate::Sphere) && is(Predicate::OrDop(overlap))
        }
        Strategy::SDopObjectOfInterest => {
            is(Predicate::Sphere) && (!of_interest || is(Predicate::OrDop(overlap)))
        }
        Strategy::Aabb => is(Predicate::Aabb),
        Strategy::KDop => is(Predicate::KDop),
        Strategy::Obb => is(Predicate::Obb),
    }
}

/// Whether two meshes meet.
fn mesh(a: &reference::Body<'_>, b: &reference::Body<'_>) -> Decision<bool> {
    let meeting = meeting::overlap(a, b);
    Decision { value: meeting.meets, path: meeting.path }
}
