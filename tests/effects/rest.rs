//! Bodies fall asleep, keep their poses to the bit, and wake, as the definition says.

use glam::DVec3;
use sdop::bodies::Bodies;
use sdop_bench::effects::Velocities;
use sdop_bench::scene::Scene;

use super::{after, crowd, report, scene, single};

/// Rest by its definition alone: which bodies a step moves, given all velocities after it, by
/// comparing all pairs.
struct Expected {
    speed: f64,
    steps: u32,
    slow_steps: Vec<u32>,
}

impl Expected {
    fn new(scene: &Scene, speed: f64, steps: u32) -> Self {
        let mut expected = Self { speed, steps, slow_steps: vec![0; scene.bodies.len()] };
        for body in 0..scene.bodies.len() {
            expected.slow_steps[body] =
                u32::from(expected.is_slow(&scene.velocities, body)) * steps;
        }
        expected
    }

    fn is_slow(&self, velocities: &Velocities, body: usize) -> bool {
        DVec3::from(velocities.linear[body].map(f64::from)).length() < self.speed
    }

    /// Whether each body moves in the step from these poses.
    fn step(&mut self, scene: &Scene, bodies: &Bodies, velocities: &Velocities) -> Vec<bool> {
        let sphere = |body: usize| {
            let ball = scene.shapes[bodies.shape[body] as usize].ball;
            assert_eq!(ball.centre, [0.0; 3]);
            (DVec3::from(bodies.translation[body].map(f64::from)), f64::from(ball.radius))
        };
        let touch = |i: usize, j: usize| {
            let ((ci, ri), (cj, rj)) = (sphere(i), sphere(j));
            (ci - cj).length_squared() <= (ri + rj) * (ri + rj)
        };
        let dynamic: Vec<usize> = (0..bodies.len()).filter(|&b| bodies.dynamic[b]).collect();
        let (slow, fast): (Vec<usize>, Vec<usize>) =
            dynamic.iter().partition(|&&body| self.is_slow(velocities, body));
        let mut moves = vec![false; bodies.len()];
        for &body in &fast {
            self.slow_steps[body] = 0;
            moves[body] = true;
        }
        for &body in &slow {
            self.slow_steps[body] = match fast.iter().any(|&other| touch(body, other)) {
                true => 0,
                false => self.slow_steps[body] + 1,
            };
            moves[body] = self.slow_steps[body] < self.steps;
        }
        moves
    }
}

/// Follows a scene with `rest = { speed = 1, after = 0.5 }`, which is four steps. Returns how often
/// bodies moved, and how often they stayed.
fn follow(scene: &Scene, steps: usize) -> [usize; 2] {
    let mut expected = Expected::new(scene, 1.0, 4);
    let mut effects = scene.start_effects().unwrap();
    let (mut bodies, mut counts) = (scene.bodies.clone(), [0; 2]);
    for step in 0..steps {
        let before = bodies.clone();
        effects.step(&mut bodies).unwrap();
        let velocities = effects.velocities();
        let moves = expected.step(scene, &before, velocities);
        for body in (0..bodies.len()).filter(|&body| bodies.dynamic[body]) {
            let (from, v) = (before.translation[body], velocities.linear[body]);
            let moved = [0, 1, 2].map(|axis| from[axis] + 0.125 * v[axis]);
            let to = if moves[body] { moved } else { from };
            assert_eq!(
                bodies.translation[body].map(f32::to_bits),
                to.map(f32::to_bits),
                "step {step}: body {body}"
            );
            assert_eq!(
                bodies.rotation[body] == before.rotation[body],
                !moves[body],
                "step {step}: body {body}"
            );
            counts[usize::from(!moves[body])] += 1;
        }
    }
    counts
}

const REST: &str = "rest = { speed = 1, after = 0.5 }";

#[test]
fn rest_matches_its_definition() {
    for (seed, others) in [
        (1, ""),
        (2, "brownian = { share = 0.05, speed = [0, 1.2] }"),
        (3, "response = \"elastic\""),
    ] {
        let scene = scene(&format!(
            "seed = {seed}\n[box]\nside = 14\n\
             [[bodies]]\nshape = \"box\"\ncount = 150\nradius = [0.5, 1]\nspeed = [0.1, 0.9]\n\
             [[bodies]]\nshape = \"box\"\ncount = 20\nradius = 1\nstatic = true\n\
             [[bodies]]\nshape = \"box\"\ncount = 8\nradius = 1\nspeed = [1, 4]\n\
             [effects]\nmotion = true\nspin = {{ rate = [1, 2] }}\n{REST}\n{others}\n"
        ));
        let [moved, stayed] = follow(&scene, 60);
        assert!(moved > 500 && stayed > 500, "seed {seed}: {moved} {stayed}");
    }
}

/// A body that slows down moves for the last time before it has been slow for four steps. Gravity
/// doesn't pull a sleeping body.
#[test]
fn slowing_body_falls_asleep() {
    let scene = single(
        "[0, 0, 0, 1, 0, 0, 0]",
        "[0, 0, 3.25]",
        "gravity = [0, 0, -4]\nmotion = true\nrest = { speed = 1, after = 0.5 }",
    );
    // Speeds 2.75, 2.25 … 0.75, 0.25, −0.25, −0.75: the fourth slow step is the eighth of all.
    let z = |steps: usize| after(&scene, steps).0.translation[0][2];
    assert_eq!(z(7), 0.125 * (2.75 + 2.25 + 1.75 + 1.25 + 0.75 + 0.25 - 0.25));
    for steps in [8, 9, 50] {
        let (bodies, velocities) = after(&scene, steps);
        assert_eq!(bodies.translation[0][2].to_bits(), z(7).to_bits());
        assert_eq!(velocities.linear[0], [0.0, 0.0, -0.75]);
    }
}

/// Spheres that touch to the bit wake a body, and the next number further apart doesn't.
#[test]
fn touching_to_the_bit_wakes() {
    let cube = "shape = \"box\"\nradius = 1\norigin = \"ball\"";
    let pair = |x: f64| {
        scene(&format!(
            "[[bodies]]\n{cube}\nposes = [[0, 0, 0, 1, 0, 0, 0]]\nvelocities = [[0, 0.5, 0]]\n\
             [[bodies]]\n{cube}\nposes = [[0, 0, 0, 1, {x:?}, 0, 0]]\nvelocities = [[4, 0, 0]]\n\
             [effects]\nmotion = true\n{REST}\n"
        ))
    };
    let reach = 2.0 * pair(8.0).shapes[0].ball.radius;
    for (x, wakes) in [(reach, true), (reach.next_up(), false)] {
        let (bodies, _) = after(&pair(f64::from(x)), 1);
        assert_eq!(bodies.translation[0][1] != 0.0, wakes, "{x}");
    }
}

/// A spinning body sleeps only if its rate is below the limit, or if there is no limit.
#[test]
fn spinning_bodies_need_a_rate() {
    for (rest, sleeps) in [
        ("speed = 9, after = 0.1", true),
        ("speed = 9, rate = 2.5, after = 0.1", true),
        ("speed = 9, rate = 1.5, after = 0.1", false),
    ] {
        let scene = crowd(&format!("spin = {{ rate = 2 }}\nrest = {{ {rest} }}"));
        let (bodies, _) = after(&scene, 3);
        assert_eq!(bodies == scene.bodies, sleeps, "{rest}");
    }
}

/// Effects that don't wake are given no sleeping body, and the report counts who fell asleep or
/// woke.
#[test]
fn sleeping_bodies_cost_no_motion() {
    let scene = scene(&format!(
        "[[bodies]]\nshape = \"box\"\nradius = 1\nposes = [[0, 0, 0, 1, -9, 0, 0], [0, 0, 0, 1, 0, 0, 0]]\n\
         velocities = [[8, 0, 0], [0, 0.5, 0]]\n[effects]\nmotion = true\n{REST}\n"
    ));
    let mut bodies = scene.bodies.clone();
    let mut effects = scene.start_effects().unwrap();
    for _ in 0..30 {
        effects.step(&mut bodies).unwrap();
    }
    // The mover comes by at one unit per step: at −2 it touches, at 2 no longer, since the other
    // has moved on; then four steps pass.
    let (rest, motion) = (report(&effects, "rest"), report(&effects, "motion"));
    assert_eq!((rest.visited, rest.changed), (60, 2));
    assert_eq!((motion.visited, motion.changed), (30 + 4 + 3, 30 + 4 + 3));
}
