//! Effects: only what a scene lists runs, static bodies stay as they are, and each effect does what
//! its equation says.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod response;
mod rest;

use std::path::Path;

use sdop::bodies::Bodies;
use sdop_bench::effects::{EffectReport, Effects, NAMES, Velocities};
use sdop_bench::scene::{Scene, SceneFile};

fn scene(text: &str) -> Scene {
    let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/scenes");
    let text = format!("name = \"e\"\nframes = 10\ndt = 0.125\n{text}");
    SceneFile::parse(&text, "e.toml", &directory).and_then(|file| file.build()).unwrap()
}

/// Forty moving and ten static bodies of two sizes in a box of side 12, with the given `[effects]`.
fn crowd(effects: &str) -> Scene {
    scene(&format!(
        "[box]\nside = 12\n\
         [[bodies]]\nshape = \"box\"\ncount = 25\nradius = 1\nspeed = [1, 3]\n\
         [[bodies]]\nshape = \"torus\"\ncount = 10\nradius = 0.7\nstatic = true\n\
         [[bodies]]\nmesh = \"../meshes/spot.tri\"\norigin = \"file\"\ncount = 15\nspeed = [1, 3]\n\
         [effects]\n{effects}\n"
    ))
}

/// One cube of radius 1 at `pose` with `velocity`, in a box of side 10.
fn single(pose: &str, velocity: &str, effects: &str) -> Scene {
    scene(&format!(
        "[box]\nside = 10\n[[bodies]]\nshape = \"box\"\nradius = 1\nposes = [{pose}]\nvelocities = [{velocity}]\n\
         [effects]\n{effects}\n"
    ))
}

fn after(scene: &Scene, steps: usize) -> (Bodies, Velocities) {
    let mut bodies = scene.bodies.clone();
    let mut effects = scene.start_effects().unwrap();
    for _ in 0..steps {
        effects.step(&mut bodies).unwrap();
    }
    (bodies, effects.velocities().clone())
}

/// What each effect does to a crowd: its line of `[effects]`, and the one column that it changes
/// there; the walls of a crowd that stays inside change nothing, and none of it is slow enough to
/// rest.
const EACH: &[(&str, &str, Option<Column>)] = &[
    ("gravity", "acceleration = [0, 0, -1]", Some(Column::Velocity)),
    ("brownian", "share = 0.5, speed = 1", Some(Column::Velocity)),
    ("response", "\"elastic\"", Some(Column::Velocity)),
    ("rest", "speed = 0.5, after = 0.5", None),
    ("motion", "true", Some(Column::Translation)),
    ("spin", "rate = 1", Some(Column::Rotation)),
    ("walls", "\"specular\"", None),
];

#[derive(Clone, Copy, Debug, PartialEq)]
enum Column {
    Translation,
    Rotation,
    Velocity,
}

/// The line of `[effects]` that lists an effect, and what it changes.
fn listed(name: &str) -> (String, Option<Column>) {
    let row = EACH.iter().find(|row| row.0 == name);
    let (_, settings, changes) = row.unwrap_or_else(|| {
        panic!(
            "the effect `{name}` is new: say in EACH how it is listed and which column it changes"
        )
    });
    let is_table = settings.contains('=');
    let settings = match is_table {
        true => format!("{{ {settings} }}"),
        false => (*settings).to_owned(),
    };
    (format!("{name} = {settings}"), *changes)
}

/// Every effect's line.
fn all() -> String {
    let lines: Vec<String> = NAMES.iter().map(|name| listed(name).0).collect();
    lines.join("\n")
}

/// What the effect of this name did.
fn report<'a>(effects: &'a Effects, name: &str) -> &'a EffectReport {
    let mut reports = effects.reports().iter();
    reports.find(|report| report.name == name).unwrap()
}

#[test]
fn only_listed_effects_run() {
    for name in NAMES {
        let (line, changes) = listed(name);
        let scene = crowd(&line);
        let mut effects = scene.start_effects().unwrap();
        let mut bodies = scene.bodies.clone();
        for _ in 0..3 {
            effects.step(&mut bodies).unwrap();
        }
        let reported: Vec<&str> = effects.reports().iter().map(|r| r.name).collect();
        assert_eq!(reported, NAMES);
        for report in effects.reports() {
            let counts = (report.steps, report.visited, report.changed, report.seconds);
            assert_eq!(report.listed, report.name == *name);
            if report.listed {
                assert_eq!((report.steps, report.visited), (3, 3 * 40));
            } else {
                assert_eq!(counts, (0, 0, 0, 0.0));
            }
        }
        let (start, velocities) = (&scene.bodies, effects.velocities());
        for (column, is_changed) in [
            (Column::Translation, bodies.translation != start.translation),
            (Column::Rotation, bodies.rotation != start.rotation),
            (Column::Velocity, velocities.linear != scene.velocities.linear),
        ] {
            assert_eq!(is_changed, changes == Some(column), "{name}: {column:?}");
        }
        assert_eq!(velocities.angular, scene.velocities.angular);
    }
}

#[test]
fn nothing_listed_is_nothing_done() {
    let scene = crowd("");
    let mut effects = scene.start_effects().unwrap();
    let mut bodies = scene.bodies.clone();
    effects.step(&mut bodies).unwrap();
    assert_eq!(bodies, scene.bodies);
    assert_eq!(*effects.velocities(), scene.velocities);
    assert!(effects.reports().iter().all(|r| !r.listed && r.steps == 0 && r.seconds == 0.0));
}

#[test]
fn static_bodies_stay_to_the_bit() {
    let mut scene = crowd(&all());
    // Files can't say so, but a caller may: a static body stays whatever its velocity and spin.
    scene.velocities.linear[25..35].fill([1.0, 2.0, 3.0]);
    scene.velocities.angular[25..35].fill([1.0, 2.0, 3.0]);
    let (bodies, velocities) = after(&scene, 50);
    for body in 0..50 {
        let same = bodies.rotation[body].map(f32::to_bits)
            == scene.bodies.rotation[body].map(f32::to_bits)
            && bodies.translation[body].map(f32::to_bits)
                == scene.bodies.translation[body].map(f32::to_bits)
            && velocities.linear[body] == scene.velocities.linear[body]
            && velocities.angular[body] == scene.velocities.angular[body];
        assert_eq!(same, (25..35).contains(&body), "body {body}");
    }
}

#[test]
fn motion_adds_dt_times_velocity() {
    let scene = single("[0, 0, 0, 1, 1, 2, 3]", "[0.5, -8, 0.1]", "motion = true");
    assert_eq!(after(&scene, 1).0.translation[0], [1.0625, 1.0, 3.0 + 0.125 * 0.1]);
}

#[test]
fn walls_mirror_and_turn() {
    // The ball's radius is 1 rounded up: its centre may get to 5 − r.
    let limit = |scene: &Scene| 5.0 - scene.shapes[0].ball.radius;
    let pose = "[0, 0, 0, 1, 3.5, -3.75, 1]";
    let specular = single(pose, "[8, -4, 2]", "motion = true\nwalls = \"specular\"");
    let w = limit(&specular);
    let (bodies, velocities) = after(&specular, 1);
    assert_eq!(bodies.translation[0], [2.0 * w - 4.5, -2.0 * w + 4.25, 1.25]);
    assert_eq!(velocities.linear[0], [-8.0, 4.0, 2.0]);
    let reverse = single(pose, "[8, -1, 2]", "motion = true\nwalls = \"reverse\"");
    let (bodies, velocities) = after(&reverse, 1);
    assert_eq!(bodies.translation[0], [2.0 * w - 4.5, -3.875, 1.25]);
    assert_eq!(velocities.linear[0], [-8.0, 1.0, -2.0]);
    // Touching is no bounce; a step longer than the box ends at the far wall.
    let touching = single(pose, "[0, 0, 0]", "motion = true\nwalls = \"specular\"");
    assert_eq!(after(&touching, 1).1.linear[0], [0.0; 3]);
    let fast = single(pose, "[1000, 0, 0]", "motion = true\nwalls = \"specular\"");
    assert_eq!(after(&fast, 1).0.translation[0], [-w, -3.75, 1.0]);
}

/// Bounding spheres stay inside and speeds stay.
#[test]
fn walls_keep_spheres_and_speeds() {
    for walls in ["specular", "reverse"] {
        let scene = crowd(&format!("motion = true\nwalls = \"{walls}\"\nspin = {{ rate = 2 }}"));
        let mut bodies = scene.bodies.clone();
        let mut effects = scene.start_effects().unwrap();
        for step in 0..400 {
            effects.step(&mut bodies).unwrap();
            for body in 0..bodies.len() {
                let ball = scene.shapes[bodies.shape[body] as usize].ball;
                let q = glam::Quat::from_array(bodies.rotation[body]);
                let centre =
                    q * glam::Vec3::from(ball.centre) + glam::Vec3::from(bodies.translation[body]);
                let room = 6.0 - ball.radius + 1e-5;
                assert!(
                    centre.abs().max_element() <= room,
                    "{walls}: body {body} at {centre} in step {step}"
                );
            }
        }
        assert!(report(&effects, "walls").changed > 100);
        let velocities = effects.velocities().linear.iter();
        for (v, start) in velocities.zip(&scene.velocities.linear) {
            assert_eq!(v.map(f32::abs), start.map(f32::abs));
        }
    }
}

/// Spin turns by its rate and keeps the norm.
#[test]
fn spin_keeps_rate_and_norm() {
    let mut scene = crowd("spin = { rate = [0.5, 2] }");
    // Any norm is a rotation: these two leave f32's range when squared.
    scene.bodies.rotation[0] = [0.0, 0.0, 0.0, 1e-23];
    scene.bodies.rotation[1] = [3e38, 0.0, 0.0, 0.0];
    let (bodies, velocities) = after(&scene, 1);
    for body in (0..25).chain(35..50) {
        let q = |bodies: &Bodies| {
            glam::DQuat::from_array(bodies.rotation[body].map(f64::from)).normalize()
        };
        let rate = glam::DVec3::from(velocities.angular[body].map(f64::from));
        let turn = q(&bodies) * q(&scene.bodies).inverse();
        // First order: tan of half the angle is half the angle.
        let angle = 2.0 * (0.5 * 0.125 * rate.length()).atan();
        let expected = glam::DQuat::from_axis_angle(rate.normalize(), angle);
        assert!(turn.dot(expected).abs() > 1.0 - 1e-12, "body {body}");
        let norm: f64 = bodies.rotation[body].iter().map(|x| f64::from(*x).powi(2)).sum();
        assert!((norm - 1.0).abs() < 2e-7, "body {body}: {norm}");
    }
}

#[test]
fn gravity_accelerates_and_turns() {
    let constant =
        single("[0, 0, 0, 1, 0, 0, 0]", "[1, 0, 0]", "gravity = { acceleration = [0, 0, -8] }");
    assert_eq!(after(&constant, 5).1.linear[0], [1.0, 0.0, -5.0]);
    let short = single("[0, 0, 0, 1, 0, 0, 0]", "[1, 0, 0]", "gravity = [0, 0, -8]");
    assert_eq!(after(&short, 5).1.linear[0], [1.0, 0.0, -5.0]);
    // A period of eight steps about x: −z, then after two steps y, after four z, after six −y.
    let turning = single(
        "[0, 0, 0, 1, 0, 0, 0]",
        "[0, 0, 0]",
        "gravity = { acceleration = [0, 0, -8], period = 1, axis = [3, 0, 0] }",
    );
    let gain = |step: usize| {
        let (a, b) = (after(&turning, step).1.linear[0], after(&turning, step + 1).1.linear[0]);
        [0, 1, 2].map(|axis| b[axis] - a[axis])
    };
    for (step, expected) in
        [(0, [0.0, 0.0, -1.0]), (2, [0.0, 1.0, 0.0]), (4, [0.0, 0.0, 1.0]), (6, [0.0, -1.0, 0.0])]
    {
        let found = gain(step);
        assert!(
            (0..3).all(|axis| (found[axis] - expected[axis]).abs() < 1e-6),
            "step {step}: {found:?}"
        );
    }
    let round = after(&turning, 8).1.linear[0];
    assert!(round.iter().all(|v| v.abs() < 1e-6), "a full turn adds up to nothing: {round:?}");
}

#[test]
fn brownian_kicks_its_share() {
    let scene = crowd("brownian = { share = 0.1, speed = [5, 6] }");
    let mut bodies = scene.bodies.clone();
    let mut effects = scene.start_effects().unwrap();
    for _ in 0..500 {
        effects.step(&mut bodies).unwrap();
    }
    // Four of forty a step.
    assert!(
        (1990..=2010).contains(&report(&effects, "brownian").changed),
        "{}",
        report(&effects, "brownian").changed
    );
    for (body, v) in
        effects.velocities().linear.iter().enumerate().filter(|(body, _)| !(25..35).contains(body))
    {
        let speed = v.iter().map(|x| f64::from(*x).powi(2)).sum::<f64>().sqrt();
        assert!((4.999..6.001).contains(&speed), "body {body} was kicked: {speed}");
    }
    let kicked =
        |v: &[[f32; 3]]| v.iter().zip(&scene.velocities.linear).filter(|(a, b)| a != b).count();
    assert!((1..=4).contains(&kicked(&after(&scene, 1).1.linear)));
}

/// A body that leaves the contract is named at its step.
#[test]
fn leaving_body_is_named() {
    let mut scene = crowd("motion = true");
    scene.velocities.linear[37] = [0.0, f32::NAN, 0.0];
    let mut bodies = scene.bodies.clone();
    let mut effects = scene.start_effects().unwrap();
    let error = effects.step(&mut bodies).unwrap_err();
    assert_eq!(error.body, 37);
    assert!(error.to_string().starts_with("body 37: translation ["), "{error}");
    let runaway = single("[0, 0, 0, 1, 0, 0, 0]", "[1e18, 0, 0]", "motion = true");
    let mut bodies = runaway.bodies.clone();
    let mut effects = runaway.start_effects().unwrap();
    let failed = (1..=20).find(|_| effects.step(&mut bodies).is_err());
    assert_eq!(failed, Some(10), "2^60 lies between nine and ten steps of 1.25e17");
}
