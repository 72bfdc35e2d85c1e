//! Histories of compounds: bodies of several shapes in a world, and the pairs of their parts that a
//! culler finds which follows the world. Truth is exact, for the composed poses of parts.
//!
//! Two rules say which pairs of parts are required. Parts whose meshes meet are required under
//! every strategy, if their bodies may collide. Parts that are no farther apart than the margins of
//! their bodies, as far as balls and the normals of slabs show, are required where a newly built
//! world reports the bodies. No pairs of parts are allowed but those of bodies that such a world
//! reports, with balls that are hardly farther apart than the margins. The same holds for the pairs
//! of bodies with a pair of parts.
//!
//! A compound's world has the default overlap test: the test is the world's, and the histories of
//! meshes judge all of them. The strategy that reports nothing has no parts to report.

use std::collections::HashMap;

use sdop_reference::wide::{balls_overlap, meet, slabs_overlap};
use sdop_reference::{Shape as JudgedShape, WidePose};

use super::draw::MARGINS;
use super::judge::{Life, Truth};
use super::robots::Robots;
use super::state::{NumberedPair, Pairs, State, in_order};
use super::worlds::CompoundWorld;
use super::{History, HistoryError, WorldKind};
use crate::configuration::coverage::ListLedger;
use crate::configuration::cullers::{culler, finder};
use crate::configuration::{Mode, rows};
use crate::truth::reference_shapes::{InvalidInput, Shapes, grown};
use sdop::rounding::down;
use sdop::settings::{CullSettings, Overlap};
use sdop::simd::Tier;
use sdop::volume::{Axes, DirectionSet};
use sdop::world::{Body, World};
use sdop::{Groups, Motion};

/// Balls that are farther apart than this, in f64, certainly do not touch.
const NEAR: f64 = 1.0e-4;

/// A history of compounds by every strategy that has a mode: `modes(n)` are those of row number `n`
/// of [`rows`].
///
/// # Errors
/// Settings that a world refuses, poses outside the contract.
pub fn judge_compounds(
    robots: &Robots,
    history: &History<Body>,
    variant: (DirectionSet, Axes),
    modes: impl Fn(usize) -> Vec<Mode>,
) -> Result<ListLedger, HistoryError> {
    let states = State::all(history)?;
    let grown = GrownParts::new(&robots.shapes)?;
    let mut exact = ExactParts::new(robots, &grown);
    let near: Vec<Vec<NearParts>> = states.iter().map(|state| exact.near(state)).collect();
    let mut ledger = ListLedger::default();
    for (number, way) in rows(variant).into_iter().enumerate() {
        if !way.strategy.scheme().culls() || way.overlap != Overlap::TwoSided {
            continue;
        }
        let mut truths: HashMap<&str, Truth> = HashMap::new();
        for (number, mode) in modes(number).into_iter().enumerate() {
            let plain = match mode.tier {
                Tier::SCALAR_FLUSH => mode.tier,
                _ => Tier::SCALAR,
            };
            if !truths.contains_key(plain.name()) {
                truths.insert(plain.name(), truth(robots, &states, &near, &way, plain)?);
            }
            let make = |turn| {
                let way = CullSettings { pairs: finder(number + turn), ..way.clone() };
                world(robots, &way, mode)
            };
            let life = Life::new(make, history, &states)?;
            let kind = WorldKind::Compounds(way.strategy);
            life.live(kind, mode, &truths[plain.name()], &mut ledger)?;
        }
    }
    Ok(ledger)
}

fn world(robots: &Robots, way: &CullSettings, mode: Mode) -> Result<CompoundWorld, HistoryError> {
    Ok(CompoundWorld {
        world: World::with(robots.world_shapes(), &culler(way, mode))?,
        parts: robots.part_culler(),
    })
}

/// What a way must and may report after each frame.
fn truth(
    robots: &Robots,
    states: &[State<Body>],
    near: &[Vec<NearParts>],
    way: &CullSettings,
    tier: Tier,
) -> Result<Truth, HistoryError> {
    let mode = Mode::plain(tier);
    let mut truth = Truth {
        required: Vec::new(),
        fresh: Vec::new(),
        may_lack: false,
        allowed: Some(Vec::new()),
    };
    for (state, near) in states.iter().zip(near) {
        truth.fresh.push(state.fresh(world(robots, way, mode)?)?);
        let bodies = state.fresh(world(robots, way, mode)?.world)?;
        let is_listed = |parts: &NearParts| {
            let pair = NumberedPair::of(parts.pair.bodies);
            bodies.binary_search(&pair).is_ok()
        };
        let required = near.iter().filter(|parts| parts.meet || parts.touch && is_listed(parts));
        truth.required.push(with_bodies(required));
        let allowed = near.iter().filter(|parts| is_listed(parts));
        truth.allowed.iter_mut().for_each(|lists| lists.push(with_bodies(allowed.clone())));
    }
    Ok(truth)
}

/// Pairs of parts, and the pairs of their bodies.
fn with_bodies<'a>(parts: impl Iterator<Item = &'a NearParts>) -> Pairs {
    let both = parts.flat_map(|parts| [NumberedPair::of(parts.pair.bodies), parts.pair]);
    let mut pairs = in_order(both);
    pairs.dedup();
    pairs
}

/// Two parts with balls that nearly touch or more, of bodies that may collide.
#[derive(Clone, Copy, Debug)]
struct NearParts {
    pair: NumberedPair,
    /// Whether neither balls nor normals of slabs show them farther apart than both margins.
    touch: bool,
    /// Whether their meshes meet.
    meet: bool,
}

/// The shapes of parts, grown by the sums of two margins, rounded inward.
struct GrownParts(Vec<JudgedShape>);

impl GrownParts {
    fn new(shapes: &Shapes) -> Result<Self, InvalidInput> {
        let sums = MARGINS.map(|one| MARGINS.map(|other| f64::from(one) + f64::from(other)));
        let sums = sums.as_flattened().iter().map(|&sum| down(sum));
        let all = shapes.built.iter();
        let all = all.flat_map(|shape| sums.clone().map(move |margin| grown(shape, margin)));
        Ok(Self(all.collect::<Result<_, _>>()?))
    }

    /// A shape, grown by two margins, which are numbered.
    fn of(&self, shape: usize, margins: [usize; 2]) -> &JudgedShape {
        let [one, other] = margins;
        &self.0[(shape * MARGINS.len() + one) * MARGINS.len() + other]
    }
}

/// A part at its exact pose.
#[derive(Clone, Copy)]
struct PosedPart {
    shape: usize,
    pose: WidePose,
    /// The number of its body's margin.
    margin: usize,
}

/// The exact answers about parts. Those of bodies that have not changed are kept.
struct ExactParts<'a> {
    robots: &'a Robots,
    grown: &'a GrownParts,
    /// By the numbers of two bodies, which are compared by [`places`].
    known: HashMap<[usize; 2], ([Body; 2], Vec<NearParts>)>,
}

impl<'a> ExactParts<'a> {
    fn new(robots: &'a Robots, grown: &'a GrownParts) -> Self {
        Self { robots, grown, known: HashMap::new() }
    }

    /// The parts that are near each other after a frame.
    fn near(&mut self, state: &State<Body>) -> Vec<NearParts> {
        let (numbers, parts) = state.parts(|body| body.groups);
        let bodies: Vec<Body> = state.present().map(|(_, body)| body).collect();
        let posed: Vec<_> = bodies.iter().map(|body| self.posed(body)).collect();
        let mut near = Vec::new();
        let mut known = std::mem::take(&mut self.known);
        for j in 0..bodies.len() {
            for i in 0..j {
                let pair = [i, j];
                let are_fixed = pair.iter().all(|&at| !bodies[at].motion.is_dynamic());
                if are_fixed || parts(pair.map(|at| at as u32)) {
                    continue;
                }
                let of = pair.map(|at| places(&bodies[at]));
                let numbers = pair.map(|at| numbers[at]);
                let former = known.remove(&numbers).filter(|(bodies, _)| *bodies == of);
                let found = former.map_or_else(
                    || self.near_parts(numbers, pair.map(|at| posed[at].as_slice())),
                    |(_, found)| found,
                );
                near.extend_from_slice(&found);
                self.known.insert(numbers, (of, found));
            }
        }
        near
    }

    /// The parts of a body.
    fn posed(&self, body: &Body) -> Vec<PosedPart> {
        let margin = MARGINS.iter().position(|&known| known == body.margin);
        let parts = 0..self.robots.parts[body.shape as usize].len();
        let posed = parts.map(|part| {
            let (shape, pose) = self.robots.posed(body, part);
            PosedPart { shape, pose, margin: margin.unwrap_or(0) }
        });
        posed.collect()
    }

    /// The near parts of two bodies. Two bodies of one part each are tested by the world alone.
    fn near_parts(&self, numbers: [usize; 2], [a, b]: [&[PosedPart]; 2]) -> Vec<NearParts> {
        let are_single = a.len() == 1 && b.len() == 1;
        let mut near = Vec::new();
        for (i, one) in (0..).zip(a) {
            for (j, other) in (0..).zip(b) {
                let margins = [one.margin, other.margin];
                let grown = [one, other].map(|part| self.grown.of(part.shape, margins));
                let plain = [one, other].map(|part| self.grown.of(part.shape, [0; 2]));
                let [first, second] = [(plain[0], &one.pose), (plain[1], &other.pose)];
                let [wide, other_wide] = [(grown[0], &one.pose), (grown[1], &other.pose)];
                if !are_single && distance(wide, second) > NEAR {
                    continue;
                }
                near.push(NearParts {
                    pair: NumberedPair::new(numbers.map(|n| n as u32), Some([i, j]), [0; 3]),
                    touch: balls_overlap(wide, second).value
                        && slabs_overlap(wide, second).value
                        && slabs_overlap(other_wide, first).value,
                    meet: meet(first, second).meets,
                });
            }
        }
        near
    }
}

/// What the answers about a body depend on.
fn places(body: &Body) -> Body {
    Body { motion: Motion::Dynamic, groups: Groups::ALL, ..*body }
}

/// The distance of two balls in f64, below zero where they overlap.
fn distance(a: (&JudgedShape, &WidePose), b: (&JudgedShape, &WidePose)) -> f64 {
    let [one, other] = [a, b].map(|(shape, pose)| pose.point(&shape.ball.centre.map(f64::from)));
    let apart = [0, 1, 2].map(|axis| one[axis] - other[axis]);
    let square: f64 = apart.iter().map(|x| x * x).sum();
    square.sqrt() - f64::from(a.0.ball.radius) - f64::from(b.0.ball.radius)
}

#[cfg(test)]
mod tests;
