//! Cp: the price of a narrow-phase check in nanoseconds per pair that culling leaves, for pairs
//! that touch and pairs that don't.
//!
//! Pairs with the same answer are timed together, because one check is shorter than the clock's
//! resolution. Every answer is compared with the exact one: `missed` are pairs that meet but are
//! rejected, which a conservative method never has.

use std::path::PathBuf;
use std::time::Instant;

use miette::{IntoDiagnostic as _, miette};
use parry3d::math::{Pose, Rotation, Vector};
use parry3d::query::intersection_test;
use parry3d::shape::{ConvexPolyhedron, Shape as Solid, TriMesh};
use sdop::bodies::Bodies;
use sdop::culler::Culler;
use sdop::settings::{CullSettings, Finder, Strategy};
use sdop::volume::Shape;
use sdop_bench::hull_test::{HullGraph, PosedHull, may_touch};
use sdop_bench::remedy::OrReport as _;
use sdop_bench::scene::{Scene, SceneFile};
use sdop_bench::tradeoff::truth::samples;
use sdop_judge::contestant::Contestant;
use sdop_reference::exact::{meeting, mesh::Mesh};
use serde::Serialize;

use crate::boxes::Frame;
use crate::entry::{Engine, Entry, Setup, Work};
use crate::{facts, parry};

/// Measure narrow phases on the pairs that culling leaves
#[derive(clap::Args)]
pub struct Args {
    /// Scene files
    #[arg(default_value = "data/scenes/paper-500.toml")]
    scenes: Vec<PathBuf>,
    /// Frames of each scene, at equal distances
    #[arg(long, default_value_t = 5)]
    frames: u32,
    /// Write narrow.csv here
    #[arg(long)]
    out: Option<PathBuf>,
}

/// One method on what one strategy leaves.
#[derive(Serialize)]
struct MethodTiming {
    scene: String,
    survivors_of: &'static str,
    method: &'static str,
    pairs: usize,
    hits: usize,
    ns_hit: Option<f64>,
    ns_miss: Option<f64>,
    missed: usize,
    extra: usize,
}

/// Whether two bodies touch, for one method.
type PairVerdict<'a> = Box<dyn Fn(&Bodies, [u32; 2]) -> miette::Result<bool> + 'a>;

/// Tests of single pairs, applied to all pairs: judged like engines, and timed only here.
pub const ENTRIES: [Entry; 3] = [
    entry("sdop GJK on hulls", env!("CARGO_PKG_VERSION"), Work::Hulls, |setup| {
        Ok(Box::new(AllPairs::new(hulls(&setup.scene.shapes))))
    }),
    entry("parry3d GJK on hulls", parry::VERSION, Work::Hulls, |setup| {
        Ok(Box::new(AllPairs::new(parry(&setup.scene.shapes, convex)?)))
    }),
    entry("parry3d meshes", parry::VERSION, Work::Meshes, |setup| {
        Ok(Box::new(AllPairs::new(parry(&setup.scene.shapes, mesh)?)))
    }),
];

const fn entry(
    name: &'static str,
    version: &'static str,
    work: Work,
    new: fn(&Setup<'_>) -> miette::Result<Engine>,
) -> Entry {
    Entry { name, version, work, threads: 1, ages: false, new }
}

/// A test of single pairs as an engine.
struct AllPairs {
    test: PairVerdict<'static>,
    pairs: Vec<[u32; 2]>,
}

impl AllPairs {
    fn new(test: PairVerdict<'static>) -> Self {
        Self { test, pairs: Vec::new() }
    }
}

impl Contestant<Frame> for AllPairs {
    fn frame(&mut self, frame: &Frame) {
        self.pairs.clear();
        for j in 0..frame.bodies.len() as u32 {
            for i in 0..j {
                let answer = (self.test)(&frame.bodies, [i, j]);
                assert!(answer.is_ok(), "{answer:?}");
                if matches!(answer, Ok(true)) {
                    self.pairs.push([i, j]);
                }
            }
        }
    }

    fn pairs(&self) -> Vec<[u32; 2]> {
        self.pairs.clone()
    }
}

/// Repeats of each timing; the median counts.
const REPEATS: usize = 3;

/// Prints the table, and writes it if requested.
pub fn run(args: &Args) -> miette::Result<()> {
    let mut rows = Vec::new();
    for file in &args.scenes {
        let scene = SceneFile::read(file)?.build()?;
        for strategy in [Strategy::Sphere, Strategy::SDopSequential] {
            rows.extend(study(&scene, strategy, args.frames)?);
        }
    }
    facts::print_csv(&rows, args.out.as_deref(), "narrow")
}

fn study(scene: &Scene, strategy: Strategy, frames: u32) -> miette::Result<Vec<MethodTiming>> {
    let settings = CullSettings { strategy, pairs: Finder::Grid, ..scene.cull.clone() };
    let mut culler =
        Culler::builder().settings(&settings).build(&scene.shapes, &scene.bodies).or_report()?;
    let samples = samples(scene, frames)?;
    let survivors: Vec<_> = samples
        .iter()
        .map(|sample| Ok(culler.cull(&sample.bodies).or_report()?.sorted()))
        .collect::<miette::Result<_>>()?;
    let bodies = || samples.iter().map(|sample| &sample.bodies);
    let ask = |judge: &PairVerdict<'_>| -> miette::Result<Vec<Vec<bool>>> {
        let frames = bodies().zip(&survivors);
        frames
            .map(|(bodies, pairs)| pairs.iter().map(|&pair| judge(bodies, pair)).collect())
            .collect()
    };
    let exact = exact(&scene.shapes)?;
    let truth = ask(&exact)?;
    let methods = [
        ("exact reference", exact),
        ("sdop GJK on hulls", hulls(&scene.shapes)),
        ("parry3d GJK on hulls", parry(&scene.shapes, convex)?),
        ("parry3d meshes", parry(&scene.shapes, mesh)?),
    ];
    let mut rows = Vec::new();
    for (method, judge) in methods {
        let answers = ask(&judge)?;
        let time = |wanted: bool| {
            let chosen: Vec<(&Bodies, [u32; 2])> = bodies()
                .zip(survivors.iter().zip(&answers))
                .flat_map(|(bodies, (pairs, answers))| {
                    let kept =
                        pairs.iter().zip(answers).filter(move |(_, answer)| **answer == wanted);
                    kept.map(move |(&pair, _)| (bodies, pair))
                })
                .collect();
            nanoseconds(&chosen, &judge)
        };
        let differ = |answer: bool| {
            let both = truth.iter().flatten().zip(answers.iter().flatten());
            both.filter(|&(&truth, &given)| given == answer && truth != answer).count()
        };
        rows.push(MethodTiming {
            scene: scene.name.clone(),
            survivors_of: strategy.name(),
            method,
            pairs: answers.iter().map(Vec::len).sum(),
            hits: answers.iter().flatten().filter(|&&answer| answer).count(),
            ns_hit: time(true)?,
            ns_miss: time(false)?,
            missed: differ(false),
            extra: differ(true),
        });
    }
    Ok(rows)
}

/// The median over repeats of the mean over pairs; none without pairs.
fn nanoseconds(
    pairs: &[(&Bodies, [u32; 2])],
    judge: &PairVerdict<'_>,
) -> miette::Result<Option<f64>> {
    if pairs.is_empty() {
        return Ok(None);
    }
    let mut means = Vec::new();
    for _ in 0..REPEATS {
        let start = Instant::now();
        for &(bodies, pair) in pairs {
            std::hint::black_box(judge(bodies, pair)?);
        }
        means.push(1e9 * start.elapsed().as_secs_f64() / pairs.len() as f64);
    }
    means.sort_by(f64::total_cmp);
    Ok(Some(means[REPEATS / 2]))
}

fn exact(shapes: &[Shape]) -> miette::Result<PairVerdict<'static>> {
    let mesh = |shape: &Shape| Mesh::new(&shape.vertices, &shape.triangles).into_diagnostic();
    let meshes = shapes.iter().map(mesh).collect::<miette::Result<Vec<_>>>()?;
    Ok(Box::new(move |bodies, pair| {
        let posed = |body: u32| {
            let body = body as usize;
            let pose = sdop_reference::Pose::new(bodies.rotation[body], bodies.translation[body]);
            Ok((&meshes[bodies.shape[body] as usize], pose.into_diagnostic()?))
        };
        let [(a, pose_a), (b, pose_b)]: [(&Mesh, sdop_reference::Pose); 2] = match pair.map(posed) {
            [Ok(a), Ok(b)] => [a, b],
            [Err(error), _] | [_, Err(error)] => return Err(error),
        };
        Ok(meeting::meet((a, &pose_a), (b, &pose_b)).meets)
    }))
}

fn hulls(shapes: &[Shape]) -> PairVerdict<'static> {
    let graphs: Vec<_> = shapes.iter().map(HullGraph::new).collect();
    Box::new(move |bodies, pair| {
        let [a, b] = pair.map(|body| PosedHull::of(&graphs, bodies, body as usize));
        Ok(may_touch(&a, &b))
    })
}

fn parry(
    shapes: &[Shape],
    solid: fn(&Shape) -> miette::Result<Box<dyn Solid>>,
) -> miette::Result<PairVerdict<'static>> {
    let solids = shapes.iter().map(solid).collect::<miette::Result<Vec<_>>>()?;
    Ok(Box::new(move |bodies, pair| {
        let [(pose_a, a), (pose_b, b)] = pair.map(|body| {
            let body = body as usize;
            let [x, y, z, w] = bodies.rotation[body];
            let turn = Rotation::from_xyzw(x, y, z, w).normalize();
            let pose = Pose::from_parts(Vector::from_array(bodies.translation[body]), turn);
            (pose, &*solids[bodies.shape[body] as usize])
        });
        let answer = intersection_test(&pose_a, a, &pose_b, b).into_diagnostic()?;
        Ok(answer.intersecting)
    }))
}

fn vertices(shape: &Shape) -> Vec<Vector> {
    let corners = shape.vertices.iter();
    corners.map(|v| Vector::from_array(*v)).collect()
}

fn convex(shape: &Shape) -> miette::Result<Box<dyn Solid>> {
    let hull = ConvexPolyhedron::from_convex_hull(&vertices(shape));
    let hull = hull.ok_or_else(|| miette!("parry3d finds no hull of `{}`", shape.name))?;
    Ok(Box::new(hull))
}

fn mesh(shape: &Shape) -> miette::Result<Box<dyn Solid>> {
    let mesh = TriMesh::new(vertices(shape), shape.triangles.clone());
    Ok(Box::new(mesh.into_diagnostic()?))
}
