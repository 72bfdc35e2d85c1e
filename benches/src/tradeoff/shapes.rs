//! P(or-DOP hit | sphere hit): the share of pairs that each volume doesn't separate when two
//! bodies' spheres overlap, by Monte Carlo.
//!
//! Two copies of a shape are turned at random, the second's ball centre is uniform in the ball of
//! twice the radius around the first's: exactly the sphere hits of a uniform scene. For convex
//! bodies the share that meets is the mean Minkowski volume (2V + SM/2π, M the mean width integral)
//! over that of two balls, 32πR³/3, which gives known answers.

use serde::{Deserialize, Serialize};

use super::TradeoffError;
use super::truth::ExactJudge;
use crate::hull_test::{HullGraph, PosedHull, may_touch};
use crate::measure::estimate::Estimate;
use crate::random::Stream;
use crate::tightness::Size;
use sdop::bodies::Bodies;
use sdop::mesh::shapes::ProceduralShape;
use sdop::overlap::ordop::PosedOrDops;
use sdop::pairs::PairList;
use sdop::rounding::pose::{rotate, rotation};
use sdop::settings::{Axes, DirectionSet, Overlap};
use sdop::simd::Tier;
use sdop::volume::{Hull, OrDop, Origin, Shape, ShapeSpec};

/// The seed of the draws; scenes count their seeds from 1.
const SEED: u64 = 0x5a3e_7000_0000_0000;
/// The largest distance of drawn pairs whose spheres don't overlap, in sums of radii: an 18-DOP of
/// a ball reaches 1.23 radii.
const MOST_DISTANCE: f32 = 1.3;
/// Batches of pairs, each an observation of the intervals.
const BATCHES: usize = 8;

/// The share of pairs that one kind of or-DOP doesn't separate.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Survival {
    /// Half-spaces.
    pub k: usize,
    /// Axes.
    pub axes: Axes,
    /// Overlap test.
    pub overlap: Overlap,
    /// Survivors per sphere hit.
    pub share: Estimate,
}

/// The shares of pairs that one shape's volumes don't separate.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ShapeSurvival {
    /// The mesh.
    pub shape: String,
    /// Every volume's size.
    pub sizes: Vec<Size>,
    /// Every k, axes and overlap test.
    pub ordops: Vec<Survival>,
    /// Pairs of 18-DOPs (principal axes, `full`) that overlap although their spheres don't, per
    /// pair whose spheres do too.
    pub outside: f64,
    /// Convex hulls that meet, per sphere hit.
    pub hull: Estimate,
    /// Meshes that meet, per sphere hit; exact.
    pub mesh: Estimate,
}

/// Random pairs of shapes: body 2n with body 2n + 1.
#[derive(Clone, Debug)]
pub struct Crowd {
    /// The bodies.
    pub bodies: Bodies,
}

impl Crowd {
    /// `pairs` pairs of shapes drawn from `shapes`. The second's ball centre is uniform in the ball
    /// of `stretch` times both radii about the first's: at 1 these are exactly the pairs whose
    /// spheres overlap.
    #[must_use]
    pub fn new(shapes: &[Shape], stretch: f32, pairs: u32, stream: u64) -> Self {
        let mut draws = Stream::new(SEED, stream);
        let mut bodies = Bodies::default();
        for _ in 0..pairs {
            let [a, b] = [(); 2].map(|()| draws.index(shapes.len() as u32));
            let reach = shapes[a as usize].ball.radius + shapes[b as usize].ball.radius;
            let centre = draws.ball(stretch * reach);
            for (shape, centre) in [(a, [0.0; 3]), (b, centre)] {
                let q = draws.rotation();
                let ball = shapes[shape as usize].ball.centre;
                // The drawn position is that of the ball's centre, independent of the body's
                // origin.
                let offset = rotate(&rotation(q), ball);
                let t = [0, 1, 2].map(|axis| (f64::from(centre[axis]) - offset[axis]) as f32);
                bodies.push(shape, true, q, t);
            }
        }
        Self { bodies }
    }

    /// Its pairs.
    pub fn pairs(&self) -> impl ExactSizeIterator<Item = [u32; 2]> + '_ {
        (0..self.bodies.len() as u32 / 2).map(|pair| [2 * pair, 2 * pair + 1])
    }

    /// The pairs whose or-DOPs overlap. Each shape has one, and all have the same directions.
    #[must_use]
    pub fn ordop_hits(
        &self,
        shapes: &[Shape],
        ordops: &[OrDop],
        overlap: Overlap,
        tier: Tier,
    ) -> PairList {
        let posed = PosedOrDops::new(shapes.iter().zip(ordops), &self.bodies, tier);
        let (first, second): (Vec<u32>, Vec<u32>) = self.pairs().map(|[i, j]| (i, j)).unzip();
        let mut out = PairList::default();
        posed.columns(overlap).test_pairs(tier, &first, &second, &mut out);
        out
    }

    /// Number of pairs whose hulls meet.
    #[must_use]
    pub fn hull_hits(&self, shapes: &[Shape]) -> usize {
        let graphs: Vec<_> = shapes.iter().map(HullGraph::new).collect();
        let posed = |body| PosedHull::of(&graphs, &self.bodies, body as usize);
        self.pairs().filter(|&[i, j]| may_touch(&posed(i), &posed(j))).count()
    }
}

/// Shapes for comparison: two boxes with known answers, and the procedural ones.
///
/// # Errors
/// Never: the library accepts these sizes.
pub fn builtin() -> Result<Vec<Shape>, TradeoffError> {
    let boxes = [("cube", 1.0), ("box 1:1:2", 2.0)].map(|(name, z)| {
        let sizes = [("x", 1.0), ("y", 1.0), ("z", z)];
        (name, ProceduralShape::from_name("box", &sizes))
    });
    let others = ProceduralShape::NAMES
        .iter()
        .filter(|name| **name != "box")
        .map(|name| (*name, ProceduralShape::from_name(name, &[])));
    boxes
        .into_iter()
        .chain(others)
        .map(|(name, form)| {
            let mut mesh = form.and_then(|form| form.build())?;
            name.clone_into(&mut mesh.name);
            let spec = ShapeSpec { origin: Origin::Ball, ..ShapeSpec::default() };
            Ok(Shape::build(&mesh, &spec)?)
        })
        .collect()
}

/// Measures a shape with `pairs` pairs in total; meshes are judged exactly on a tenth of them.
///
/// # Errors
/// The reference rejects a mesh.
pub fn survival(shape: &Shape, pairs: u32, tier: Tier) -> Result<ShapeSurvival, TradeoffError> {
    let shape = std::slice::from_ref(shape);
    let each = pairs.div_ceil(BATCHES as u32).max(1);
    let crowds: Vec<Crowd> =
        (0..BATCHES as u64).map(|batch| Crowd::new(shape, 1.0, each, batch)).collect();
    let mut ordops = Vec::new();
    for &k in DirectionSet::ALL {
        for &axes in Axes::ALL {
            let ordop = [shape[0].ordop_along(axes, k)];
            for &overlap in Overlap::ALL {
                ordops.push(Survival {
                    k: k.k(),
                    axes,
                    overlap,
                    share: share(&crowds, |crowd| {
                        crowd.ordop_hits(shape, &ordop, overlap, tier).len()
                    }),
                });
            }
        }
    }
    let judge = ExactJudge::new(shape)?;
    let few: Vec<Crowd> =
        (0..BATCHES as u64).map(|batch| Crowd::new(shape, 1.0, each.div_ceil(10), batch)).collect();
    let meeting = few
        .iter()
        .map(|crowd| judge.count(&crowd.bodies, crowd.pairs()))
        .collect::<Result<Vec<_>, _>>()?;
    let mut meeting = meeting.into_iter();
    Ok(ShapeSurvival {
        shape: shape[0].name.clone(),
        sizes: Size::of_all(&shape[0], &Hull::of(&shape[0].vertices)),
        ordops,
        outside: outside(shape, pairs, tier),
        hull: share(&crowds, |crowd| crowd.hull_hits(shape)),
        mesh: share(&few, |_| meeting.next().unwrap_or_default()),
    })
}

/// 18-DOP hits outside of the spheres' hits, per hit inside, of `pairs` pairs up to
/// [`MOST_DISTANCE`] times as far apart as radii sum to.
#[must_use]
pub fn outside(shape: &[Shape], pairs: u32, tier: Tier) -> f64 {
    let ordop = [shape[0].ordop_along(Axes::Principal, DirectionSet::K18)];
    let reach = 2.0 * f64::from(shape[0].ball.radius);
    let crowd = Crowd::new(shape, MOST_DISTANCE, pairs, BATCHES as u64);
    let centre = |body: u32| {
        let ball = shape[0].ball.centre;
        let body = body as usize;
        let offset = rotate(&rotation(crowd.bodies.rotation[body]), ball);
        [0, 1, 2].map(|axis| f64::from(crowd.bodies.translation[body][axis]) + offset[axis])
    };
    let found = crowd.ordop_hits(shape, &ordop, Overlap::Full, tier);
    let far = |&[i, j]: &[u32; 2]| {
        let (a, b) = (centre(i), centre(j));
        let squared: f64 = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum();
        squared > reach * reach
    };
    let beyond = found.iter().filter(far).count();
    beyond as f64 / (found.len() - beyond) as f64
}

/// The share of hits over equally large crowds.
pub fn share(crowds: &[Crowd], mut hits: impl FnMut(&Crowd) -> usize) -> Estimate {
    let share = |crowd: &Crowd| hits(crowd) as f64 / crowd.pairs().len() as f64;
    Estimate::of(&crowds.iter().map(share).collect::<Vec<_>>())
}
