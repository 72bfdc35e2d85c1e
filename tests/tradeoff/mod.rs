//! The comparison of volumes: its truth, its hulls, its counts.

#![allow(clippy::unwrap_used, reason = "a test that cannot build its input has failed")]

use std::fs;
use std::path::Path;

use sdop::bodies::Bodies;
use sdop::mesh::ProceduralShape;
use sdop::simd::Tier;
use sdop::volume::{Hull, Origin, Shape, ShapeSpec};
use sdop_bench::hull_test::{HullGraph, PosedHull, may_touch};
use sdop_bench::scene::{Scene, SceneFile};
use sdop_bench::tradeoff::counts::Tally;
use sdop_bench::tradeoff::truth::{ExactJudge, samples};
use sdop_bench::tradeoff::variant::{self, Variant};
use sdop_reference::Pose;
use sdop_reference::exact::{meeting, mesh::Mesh};

use crate::drawn_pairs::DrawnPairs;

const SCENE: &str = r#"
name = "few"
seed = 3
frames = 40
[box]
side = 6.0
[[bodies]]
shape = "gear"
count = 20
radius = 1.0
speed = [1.0, 2.0]
[[bodies]]
shape = "l-shape"
count = 15
radius = [0.6, 1.2]
speed = [1.0, 2.0]
[[bodies]]
shape = "torus"
count = 15
radius = 1.0
static = true
[effects]
motion = true
walls = "specular"
spin = { rate = [0.5, 1.0] }
"#;

/// A cube and the procedural shapes, about the centres of their balls.
fn built_shapes() -> Vec<Shape> {
    let spec = ShapeSpec { origin: Origin::Ball, ..ShapeSpec::default() };
    let others = ProceduralShape::NAMES.iter().filter(|name| **name != "box");
    let others = others.map(|name| ProceduralShape::default_of(name).unwrap());
    let all = std::iter::once(ProceduralShape::Box { x: 1.0, y: 1.0, z: 1.0 }).chain(others);
    all.map(|shape| Shape::build(&shape.build().unwrap(), &spec).unwrap()).collect()
}

fn scene() -> Scene {
    SceneFile::parse(SCENE, "few.toml", Path::new("")).unwrap().build().unwrap()
}

/// Hulls agree with the exact meeting of hull meshes.
#[test]
fn hulls_agree_with_exact_meshes() {
    let (mut meetings, mut pairs) = (0, 0);
    for shape in built_shapes() {
        let hull = Hull::of(&shape.vertices);
        let mesh = Mesh::new(&shape.vertices, &hull.facets).unwrap();
        let graphs = [HullGraph::new(&shape)];
        let drawn = DrawnPairs::new(std::slice::from_ref(&shape), 1.0, 300, 5);
        let bodies = &drawn.bodies;
        for [i, j] in drawn.pairs() {
            let pose = |b: u32| {
                Pose::new(bodies.rotation[b as usize], bodies.translation[b as usize]).unwrap()
            };
            let exact = meeting::meet((&mesh, &pose(i)), (&mesh, &pose(j))).meets;
            let posed = |b: u32| PosedHull::of(&graphs, bodies, b as usize);
            assert_eq!(may_touch(&posed(i), &posed(j)), exact, "{} {i}", shape.name);
            meetings += u32::from(exact);
            pairs += 1;
        }
    }
    assert!(meetings > pairs / 5 && meetings < 4 * pairs / 5);
}

#[test]
fn touching_hulls_are_reported() {
    // Unit cubes face to face, corner to corner, edge to edge: exact in f32, a sign in f64 could
    // fall either way.
    let cubes = [built_shapes().remove(0)];
    let graphs = [HullGraph::new(&cubes[0])];
    let half = 0.5_f32;
    for gap in [[1.0, 0.0, 0.0], [1.0, 1.0, 1.0], [1.0, -1.0, 0.3], [0.0, 0.0, 0.0]] {
        for (stretch, touch) in [(1.0, true), (1.0 + 1e-6, gap == [0.0; 3])] {
            let mut drawn = DrawnPairs::new(&cubes, 1.0, 1, 0);
            drawn.bodies.rotation = vec![[0.0, 0.0, 0.0, 1.0]; 2];
            drawn.bodies.translation = vec![[0.0; 3], gap.map(|x: f32| 2.0 * half * x * stretch)];
            let posed = |b| PosedHull::of(&graphs, &drawn.bodies, b);
            assert_eq!(may_touch(&posed(0), &posed(1)), touch, "{gap:?} {stretch}");
        }
    }
}

/// The truth is every meeting and is kept.
#[test]
fn truth_is_complete_and_cached() {
    let scene = scene();
    let samples = samples(&scene, 3).unwrap();
    assert_eq!(samples.iter().map(|s| s.frame).collect::<Vec<_>>(), [0, 13, 26]);
    let judge = ExactJudge::new(&scene.shapes).unwrap();
    let cache = tempfile::tempdir().unwrap();
    let truth = judge.truth(&samples, Some(cache.path())).unwrap();

    let n = scene.bodies.len() as u32;
    let all = (0..n).flat_map(|i| (i + 1..n).map(move |j| [i, j]));
    let moving =
        |&[i, j]: &[u32; 2]| scene.bodies.dynamic[i as usize] || scene.bodies.dynamic[j as usize];
    let built = scene.shapes.iter().map(|shape| Mesh::new(&shape.vertices, &shape.triangles));
    let meshes: Vec<Mesh> = built.map(Result::unwrap).collect();
    let posed = |body: u32| {
        let (body, Bodies { shape, rotation, translation, .. }) =
            (body as usize, &samples[0].bodies);
        (&meshes[shape[body] as usize], Pose::new(rotation[body], translation[body]).unwrap())
    };
    let meets = |&[i, j]: &[u32; 2]| {
        let [(a, a_pose), (b, b_pose)] = [i, j].map(posed);
        meeting::meet((a, &a_pose), (b, &b_pose)).meets
    };
    let counted = all.filter(moving).filter(meets).count();
    assert_eq!(truth[0].len(), counted);
    assert!(counted > 20 && truth.iter().all(|pairs| pairs.is_sorted()));

    // What was kept is read again; a file that was tampered with is not.
    let file = fs::read_dir(cache.path()).unwrap().next().unwrap().unwrap().path();
    let kept = fs::read_to_string(&file).unwrap();
    let first = format!("{} {} ", truth[0][0][0], truth[0][0][1]);
    fs::write(&file, kept.replacen(&first, "", 1)).unwrap();
    assert_eq!(judge.truth(&samples, Some(cache.path())).unwrap(), truth);
    assert_eq!(fs::read_to_string(&file).unwrap(), kept);
    // Another scene has another file.
    judge.truth(&samples[..2], Some(cache.path())).unwrap();
    assert_eq!(fs::read_dir(cache.path()).unwrap().count(), 2);
}

/// Every variant finds every true pair and finer ones report fewer.
#[test]
fn finer_variants_report_fewer() {
    let scene = scene();
    let samples = samples(&scene, 5).unwrap();
    let truth = ExactJudge::new(&scene.shapes).unwrap().truth(&samples, None).unwrap();
    let tier = Tier::detect();
    let tally = |variant: &Variant| Tally::of(&scene, variant, tier, &samples, &truth).unwrap();
    let variants = variant::all(&scene.cull, 30);
    let tallies: Vec<Tally> = variants.iter().map(tally).collect();
    for (variant, found) in variants.iter().zip(&tallies) {
        assert_eq!(found.quality().recall, 1.0, "{}", variant.name);
        assert_eq!(*found, tally(variant), "{}", variant.name);
        let tightness = variant::tightness(variant, &scene).unwrap();
        assert!(tightness >= 1.0 - 1e-6, "{}: {tightness}", variant.name);
    }
    let reported = |name: &str| {
        let place = variants.iter().position(|v| v.name == name).unwrap();
        tallies[place].reported
    };
    for k in [6, 14, 18, 26] {
        let of = |overlap| reported(&format!("s-dop {k}, principal, {overlap}"));
        assert!(of("one-sided") >= of("two-sided") && of("two-sided") >= of("full"));
        assert!(reported("sphere") > of("one-sided"));
        assert!(of("full") >= reported("sphere + hull"));
    }
    assert_eq!(reported("aabb"), reported("6-dop"));
    for same in ["s-dop lazy", "s-dop batch", "s-dop batch lazy"] {
        assert_eq!(reported(same), reported("s-dop 18, principal, two-sided"));
    }
}
