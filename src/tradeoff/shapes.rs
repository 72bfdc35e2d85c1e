//! P(or-DOP hit | sphere hit): what each volume lets through when two bodies' spheres overlap, by Monte Carlo.
//!
//! Two copies of a shape are turned at random, the second's ball centre is uniform in the ball of twice the radius around
//! the first's: exactly the sphere hits of a uniform scene. For convex bodies the share that meets is the mean
//! Minkowski volume (2V + SM/2π, M the mean width integral) over that of two balls, 32πR³/3, which makes known answers.

use serde::{Deserialize, Serialize};

use super::TradeoffError;
use super::estimate::Estimate;
use super::gjk::{HullGraph, PosedHull, may_touch};
use super::truth::Judge;
use crate::mesh::shapes::ProceduralShape;
use crate::overlap::ordop::{OrDopColumns, SlabTables};
use crate::pairs::PairList;
use crate::places::Places;
use crate::rounding::pose::{rotate, rotation};
use crate::scene::bodies::Bodies;
use crate::scene::random::Stream;
use crate::scene::settings::{Axes, DirectionSet, Overlap};
use crate::simd::Level;
use crate::update::{OrDopRows, ShapeFrame};
use crate::volume::{Basis, Hull, OrDop, Shape, ShapeSpec};

/// Where the draws start; scenes count their seeds from 1.
const SEED: u64 = 0x5a3e_7000_0000_0000;
/// Batches of pairs, each an observation of the intervals.
const BATCHES: usize = 8;

/// What is let through with one kind of or-DOP.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Survival {
    /// Half-spaces.
    pub k: usize,
    /// Axes.
    pub axes: String,
    /// Overlap test.
    pub overlap: String,
    /// Survivors per sphere hit.
    pub share: Estimate,
}

/// What one shape's volumes let through.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ShapeSurvival {
    /// The mesh.
    pub shape: String,
    /// Every k, axes and overlap test.
    pub ordops: Vec<Survival>,
    /// Convex hulls that meet, per sphere hit.
    pub hull: Estimate,
    /// Meshes that meet, per sphere hit; exact.
    pub mesh: Estimate,
}

/// Pairs of a shape with itself: body 2n with body 2n + 1.
#[derive(Clone, Debug)]
pub struct Crowd {
    /// The bodies.
    pub bodies: Bodies,
}

impl Crowd {
    /// `pairs` pairs, the second's ball centre uniform in a ball of `radius` about the first's.
    #[must_use]
    pub fn new(shape: &Shape, radius: f32, pairs: u32, stream: u64) -> Self {
        let mut draws = Stream::new(SEED, stream);
        let mut bodies = Bodies::default();
        for body in 0..2 * pairs {
            let q = draws.rotation();
            // The ball's centre is put where it is drawn, whatever the body's origin.
            let offset = rotate(&rotation(q), shape.ball.centre.to_array());
            let centre = if body % 2 == 0 {
                [0.0; 3]
            } else {
                draws.ball(radius)
            };
            let t = [0, 1, 2].map(|axis| (f64::from(centre[axis]) - offset[axis]) as f32);
            bodies.shape.push(0);
            bodies.dynamic.push(true);
            bodies.rotation.push(q);
            bodies.translation.push(t);
            bodies.velocity.push([0.0; 3]);
            bodies.spin.push([0.0; 3]);
        }
        Self { bodies }
    }

    /// Its pairs.
    pub fn pairs(&self) -> impl ExactSizeIterator<Item = [u32; 2]> + '_ {
        (0..self.bodies.len() as u32 / 2).map(|pair| [2 * pair, 2 * pair + 1])
    }

    /// The pairs whose or-DOPs overlap.
    #[must_use]
    pub fn ordop_hits(
        &self,
        shape: &Shape,
        ordop: &OrDop,
        overlap: Overlap,
        level: Level,
    ) -> PairList {
        let frames = [ShapeFrame::new(shape, &ordop.basis)];
        let places = Places::as_given(&self.bodies);
        let mut rows = OrDopRows::new(places.len());
        rows.update(&frames, &self.bodies, &places, 0..places.len(), 1);
        let tables = SlabTables::new(ordop.directions, [(shape, ordop)]);
        let columns = OrDopColumns {
            rows: &rows.rows,
            shape: &places.shape,
            tables: &tables,
            overlap,
        };
        let (first, second): (Vec<u32>, Vec<u32>) = self.pairs().map(|[i, j]| (i, j)).unzip();
        let mut out = PairList::default();
        columns.test_pairs(level, &first, &second, &mut out);
        out
    }

    /// How many pairs' hulls meet.
    #[must_use]
    pub fn hull_hits(&self, shape: &Shape) -> usize {
        let graphs = [HullGraph::new(shape)];
        let posed = |body| PosedHull::of(&graphs, &self.bodies, body as usize);
        self.pairs()
            .filter(|&[i, j]| may_touch(&posed(i), &posed(j)))
            .count()
    }
}

/// Shapes of known form to compare with: two boxes whose answer is known, and the procedural ones.
///
/// # Errors
/// None: the sizes are the library's own.
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
            Ok(Shape::build(&mesh, &ShapeSpec::default())?)
        })
        .collect()
}

/// The or-DOP of a shape with other directions and axes.
#[must_use]
pub fn ordop_of(shape: &Shape, k: DirectionSet, axes: Axes) -> OrDop {
    let basis = match axes {
        Axes::Principal => Basis::principal(&Hull::of(&shape.vertices), &shape.vertices),
        Axes::Model => Basis::MODEL,
    };
    OrDop::build(&shape.vertices, basis, k)
}

/// Measures a shape by `pairs` pairs in all; meshes are judged exactly on the first tenth of each batch.
///
/// # Errors
/// A mesh that the reference refuses.
pub fn survival(shape: &Shape, pairs: u32, level: Level) -> Result<ShapeSurvival, TradeoffError> {
    let each = pairs.div_ceil(BATCHES as u32).max(1);
    let crowds: Vec<Crowd> = (0..BATCHES as u64)
        .map(|batch| Crowd::new(shape, 2.0 * shape.ball.radius, each, batch))
        .collect();
    let share = |hits: &dyn Fn(&Crowd) -> usize| {
        let shares: Vec<f64> = crowds
            .iter()
            .map(|crowd| hits(crowd) as f64 / f64::from(each))
            .collect();
        Estimate::of(&shares)
    };
    let mut ordops = Vec::new();
    for &k in DirectionSet::ALL {
        for &axes in Axes::ALL {
            let ordop = ordop_of(shape, k, axes);
            for &overlap in Overlap::ALL {
                ordops.push(Survival {
                    k: k.k(),
                    axes: axes.to_string(),
                    overlap: overlap.to_string(),
                    share: share(&|crowd| crowd.ordop_hits(shape, &ordop, overlap, level).len()),
                });
            }
        }
    }
    Ok(ShapeSurvival {
        shape: shape.name.clone(),
        ordops,
        hull: share(&|crowd| crowd.hull_hits(shape)),
        mesh: mesh_share(shape, each.div_ceil(10))?,
    })
}

/// The share of pairs whose meshes meet, batch by batch.
fn mesh_share(shape: &Shape, pairs: u32) -> Result<Estimate, TradeoffError> {
    let judge = Judge::new(std::slice::from_ref(shape))?;
    let mut shares = Vec::new();
    for batch in 0..BATCHES as u64 {
        let crowd = Crowd::new(shape, 2.0 * shape.ball.radius, pairs, batch);
        let hits = judge.count(&crowd.bodies, crowd.pairs())?;
        shares.push(hits as f64 / f64::from(pairs));
    }
    Ok(Estimate::of(&shares))
}
