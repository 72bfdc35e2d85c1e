//! Seeded generation: the same file and seed give the same bodies, and the bodies are what the file
//! asks for.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::Path;

use sdop::bodies::Bodies;
use sdop_bench::scene::{Scene, SceneFile};
use sdop_bench::simulate::Trajectory;

fn build(text: &str) -> Scene {
    SceneFile::parse(text, "a.toml", Path::new("data/scenes"))
        .and_then(|file| file.build())
        .unwrap()
}

/// A scene of cubes with the given box, and keys of its one group.
fn cubes(bounds: &str, seed: u64, group: &str) -> Scene {
    build(&format!(
        "name = \"c\"\nframes = 1\nseed = {seed}\n[box]\n{bounds}\n[[bodies]]\nshape = \"box\"\n{group}\n"
    ))
}

fn radius(scene: &Scene, body: usize) -> f32 {
    scene.shapes[scene.bodies.shape[body] as usize].ball.radius
}

/// Sphere overlaps by the plain double loop over a sweep along x.
fn overlaps(scene: &Scene) -> usize {
    let t = &scene.bodies.translation;
    let mut order: Vec<usize> = (0..t.len()).collect();
    order.sort_by(|&a, &b| t[a][0].total_cmp(&t[b][0]));
    let widest = (0..t.len()).map(|body| radius(scene, body)).fold(0.0, f32::max);
    let mut count = 0;
    for (place, &i) in order.iter().enumerate() {
        for &j in order[place + 1..].iter().take_while(|&&j| t[j][0] - t[i][0] <= 2.0 * widest) {
            let square: f64 =
                (0..3).map(|k| (f64::from(t[i][k]) - f64::from(t[j][k])).powi(2)).sum();
            let reach = f64::from(radius(scene, i)) + f64::from(radius(scene, j));
            count += usize::from(square <= reach * reach);
        }
    }
    count
}

/// The probability that two uniform points of a cube with unit side are within s.
fn closed_form(s: f64) -> f64 {
    let pi = std::f64::consts::PI;
    4.0 / 3.0 * pi * s.powi(3) - 1.5 * pi * s.powi(4) + 1.6 * s.powi(5) - s.powi(6) / 6.0
}

/// One seed is one scene and another is another.
#[test]
fn seeds_determine_scenes() {
    let group = "count = 100\nradius = [0.5, 2]\nspeed = [1, 2]";
    let a = cubes("side = 40", 7, group);
    let again = cubes("side = 40", 7, group);
    assert_eq!(a.bodies, again.bodies);
    assert_eq!(a.velocities, again.velocities);
    let b = cubes("side = 40", 8, group);
    let Bodies { shape, rotation, translation, .. } = &a.bodies;
    assert!(*shape != b.bodies.shape);
    for body in 0..100 {
        assert!(
            rotation[body] != b.bodies.rotation[body]
                && translation[body] != b.bodies.translation[body]
        );
        assert!(a.velocities.linear[body] != b.velocities.linear[body]);
    }
}

/// One draw leaves the others as they are.
#[test]
fn draws_are_independent() {
    let a = cubes("side = 40", 7, "count = 50\nspeed = [1, 2]");
    let b = cubes("side = 40", 7, "count = 70\nspeed = [3, 4]");
    assert_eq!(a.bodies.translation[..], b.bodies.translation[..50]);
    assert_eq!(a.bodies.rotation[..], b.bodies.rotation[..50]);
    assert!(a.velocities.linear[0] != b.velocities.linear[0]);
}

/// Spheres start inside of the box and speeds in their range.
#[test]
fn placed_spheres_are_inside() {
    let scene = cubes("side = 10", 3, "count = 5000\nradius = [0.5, 4]\nspeed = [0.5, 2]");
    for body in 0..5000 {
        let room = 5.0 - radius(&scene, body);
        assert!(scene.bodies.translation[body].iter().all(|x| x.abs() <= room), "body {body}");
        let speed =
            scene.velocities.linear[body].iter().map(|v| f64::from(*v).powi(2)).sum::<f64>().sqrt();
        assert!((0.499_999..2.000_001).contains(&speed), "body {body}: {speed}");
        let norm: f64 = scene.bodies.rotation[body].iter().map(|q| f64::from(*q).powi(2)).sum();
        assert!((norm - 1.0).abs() < 1e-6, "body {body}: {norm}");
    }
}

/// Radii take eight steps an octave log uniformly.
#[test]
fn radii_snap_to_eight_steps() {
    let scene = cubes("side = 100", 5, "count = 8000\nradius = [0.3, 4.8]");
    // Mantissas 1.25 to 1.875 · 2^-2 (0.3 itself moves to 0.3125), three octaves, 1 and 1.125 ·
    // 2^2, and 4.8.
    assert_eq!(scene.shapes.len(), 6 + 3 * 8 + 2 + 1);
    let mut octaves = [0; 4];
    for body in 0..8000 {
        let r = radius(&scene, body);
        octaves[(r / 0.3).log2().floor().clamp(0.0, 3.0) as usize] += 1;
    }
    // Binomial with p about ¼: five standard deviations are 194, and the steps move the octaves'
    // ends a little.
    assert!(octaves.iter().all(|count: &i32| (1700..2300).contains(count)), "{octaves:?}");
}

#[test]
fn directions_and_rotations_are_uniform() {
    let scene = cubes("side = 10", 11, "count = 20000\nspeed = 1");
    let n = 20_000.0;
    for axis in 0..3 {
        let (mut mean, mut square) = (0.0, 0.0);
        for v in &scene.velocities.linear {
            mean += f64::from(v[axis]) / n;
            square += f64::from(v[axis]).powi(2) / n;
        }
        // Mean 0 with deviation 1/√(3n); mean square ⅓ with deviation √(4/45n): five of each.
        assert!(
            mean.abs() < 0.0205 && (square - 1.0 / 3.0).abs() < 0.0106,
            "axis {axis}: {mean} {square}"
        );
    }
    for component in 0..4 {
        let square: f64 =
            scene.bodies.rotation.iter().map(|q| f64::from(q[component]).powi(2) / n).sum();
        // On the 3-sphere the mean square is ¼ with deviation √(1/16n).
        assert!((square - 0.25).abs() < 0.0089, "component {component}: {square}");
    }
}

/// Overlaps in a given box agree with the closed form, as placed and after long motion with elastic
/// walls, which keeps centres uniform.
#[test]
fn overlaps_match_closed_form() {
    let n = 3000.0;
    let group =
        "count = 3000\nradius = 1\nspeed = [5, 20]\n[effects]\nmotion = true\nwalls = \"specular\"";
    let mut scene = cubes("side = 40", 2, group);
    let expected = 0.5 * n * (n - 1.0) * closed_form(2.0 / 38.0);
    for _ in 0..2 {
        let found = overlaps(&scene) as f64;
        // Pairs of one body are nearly independent: Poisson, five deviations.
        assert!((found - expected).abs() < 5.0 * expected.sqrt(), "{found} of {expected}");
        let moved = Trajectory::new(&scene).unwrap().with_frames(1000).last();
        scene.bodies = moved.unwrap().unwrap();
    }
}

#[test]
fn partners_set_the_density() {
    for (group, n, edges) in [
        ("count = 30000\nradius = 1", 30_000.0, 1.05),
        ("count = 30000\nradius = [0.25, 4]", 30_000.0, 1.05),
    ] {
        let scene = cubes("partners = 1.5", 4, group);
        let found = 2.0 * overlaps(&scene) as f64 / n;
        // Walls keep centres off by r, which gains a few percent; five Poisson deviations are
        // 0.036.
        assert!((1.5 - 0.036..1.5 * edges + 0.036).contains(&found), "{group}: {found}");
    }
}

#[test]
fn placements_keep_to_their_form() {
    let plane =
        cubes("side = 50", 1, "count = 400\nradius = 1\nplacement = { plane = { thickness = 3 } }");
    assert!(plane.bodies.translation.iter().all(|t| t[2].abs() <= 1.5));
    assert!(plane.bodies.translation.iter().any(|t| t[0].abs() > 20.0));
    let group = "count = 400\nradius = 1\nplacement = { clusters = { number = 4, radius = 6 } }";
    let clusters = cubes("side = 100", 1, group);
    let t = &clusters.bodies.translation;
    let near =
        |a: &[f32; 3], b: &[f32; 3]| (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f32>() <= 144.0;
    // Bodies of one cluster are at most two radii apart: four bodies at most are needed to reach
    // all others.
    let mut apart: Vec<[f32; 3]> = Vec::new();
    for body in t {
        if !apart.iter().any(|seen| near(seen, body)) {
            apart.push(*body);
        }
    }
    assert!(apart.len() <= 4, "{}", apart.len());
    assert!(
        overlaps(&clusters)
            > 10 * overlaps(&cubes("side = 100", 1, "count = 400\nradius = 1")).max(1)
    );
}

/// Poses keep the files frame and seeded bodies are centred.
#[test]
fn poses_keep_the_file_origin() {
    let text = "name = \"p\"\nframes = 1\n[box]\nside = 20\n[[bodies]]\nmesh = \"../meshes/spot.tri\"\n\
                poses = [[0, 0, 0, 2, 1, 2, 3]]\nvelocities = [[4, 5, 6]]\nstatic = false\n\
                [[bodies]]\nmesh = \"../meshes/spot.tri\"\ncount = 1\nstatic = true\n";
    let scene = build(text);
    assert_eq!(scene.shapes.len(), 2, "two origins are two shapes");
    assert_eq!(scene.bodies.rotation[0], [0.0, 0.0, 0.0, 2.0]);
    assert_eq!(scene.bodies.translation[0], [1.0, 2.0, 3.0]);
    assert_eq!(scene.velocities.linear[0], [4.0, 5.0, 6.0]);
    assert_eq!(scene.bodies.dynamic, [true, false]);
    assert!(scene.shapes[0].ball.centre != [0.0; 3]);
    assert_eq!(scene.shapes[1].ball.centre, [0.0; 3]);
}

#[test]
fn alike_groups_share_their_shapes() {
    let group = "[[bodies]]\nshape = \"box\"\ncount = 2\nradius = 1\n";
    let scene = build(&format!("name = \"p\"\nframes = 1\n[box]\nside = 20\n{group}{group}"));
    assert_eq!((scene.bodies.len(), scene.shapes.len()), (4, 1));
    assert!(scene.bodies.translation[0] != scene.bodies.translation[2], "groups draw apart");
}
