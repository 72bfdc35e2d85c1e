//! The response compared with its formula, and the quantities that it conserves.

use sdop::bodies::Bodies;
use sdop_bench::effects::Velocities;
use sdop_bench::scene::Scene;

use super::{after, report, scene};

/// The response by its formula alone: all pairs in order, everything in f64. The velocities after
/// it, and how many pairs exchanged momentum.
fn respond(scene: &Scene) -> (Vec<[f32; 3]>, usize) {
    let (bodies, mut velocity) = (&scene.bodies, scene.velocities.linear.clone());
    let sphere = |bodies: &Bodies, body: usize| {
        let ball = scene.shapes[bodies.shape[body] as usize].ball;
        assert_eq!(ball.centre, [0.0; 3]);
        (glam::DVec3::from(bodies.translation[body].map(f64::from)), f64::from(ball.radius))
    };
    let mut exchanges = 0;
    for i in 0..bodies.len() {
        for j in i + 1..bodies.len() {
            let ((ci, ri), (cj, rj)) = (sphere(bodies, i), sphere(bodies, j));
            let n = cj - ci;
            let v = |body: usize| glam::DVec3::from(velocity[body].map(f64::from));
            let approach = (v(i) - v(j)).dot(n);
            if n.dot(n) > (ri + rj) * (ri + rj)
                || approach <= 0.0
                || !(bodies.dynamic[i] || bodies.dynamic[j])
            {
                continue;
            }
            let mass = |body: usize, r: f64| {
                if bodies.dynamic[body] { r.powi(3) } else { 1e300 }
            };
            let (mi, mj) = (mass(i, ri), mass(j, rj));
            let impulse = 2.0 * approach / n.dot(n) / (1.0 / mi + 1.0 / mj) * n;
            let (vi, vj) = (v(i) - impulse / mi, v(j) + impulse / mj);
            velocity[i] = vi.to_array().map(|x| x as f32);
            velocity[j] = vj.to_array().map(|x| x as f32);
            exchanges += 1;
        }
    }
    (velocity, exchanges)
}

/// Response is the formula on all pairs.
#[test]
fn response_matches_the_formula() {
    for (seed, radius, side) in [(1, "1", 9), (2, "[0.2, 3]", 14), (3, "[0.1, 1]", 200)] {
        let scene = scene(&format!(
            "seed = {seed}\n[box]\nside = {side}\n\
             [[bodies]]\nshape = \"box\"\ncount = 80\nradius = {radius}\nspeed = [1, 3]\n\
             [[bodies]]\nshape = \"box\"\ncount = 10\nradius = {radius}\nstatic = true\n\
             [effects]\nresponse = \"elastic\"\n"
        ));
        let (expected, exchanges) = respond(&scene);
        assert!(exchanges > 50 || side == 200, "{exchanges}");
        let (_, found) = after(&scene, 1);
        for (body, (found, expected)) in found.linear.iter().zip(&expected).enumerate() {
            for (&a, &b) in found.iter().zip(expected) {
                assert!(
                    (a - b).abs() <= 1e-5 * (1.0 + b.abs()),
                    "seed {seed}, body {body}: {a} {b}"
                );
            }
        }
    }
}

#[test]
fn response_keeps_momentum_and_energy() {
    let scene = scene(
        "[box]\nside = 12\n[[bodies]]\nshape = \"box\"\ncount = 120\nradius = [0.5, 2]\nspeed = [1, 3]\n\
         [effects]\nresponse = \"elastic\"\nmotion = true\n",
    );
    let totals = |velocities: &Velocities| {
        let (mut momentum, mut energy) = (glam::DVec3::ZERO, 0.0);
        for (body, v) in velocities.linear.iter().enumerate() {
            let mass =
                f64::from(scene.shapes[scene.bodies.shape[body] as usize].ball.radius).powi(3);
            let v = glam::DVec3::from(v.map(f64::from));
            momentum += mass * v;
            energy += 0.5 * mass * v.dot(v);
        }
        (momentum, energy)
    };
    let mut bodies = scene.bodies.clone();
    let mut effects = scene.start_effects().unwrap();
    let (momentum, energy) = totals(effects.velocities());
    for _ in 0..100 {
        effects.step(&mut bodies).unwrap();
    }
    let changed = report(&effects, "response").changed;
    assert!(changed > 500, "{changed}");
    let (momentum_now, energy_now) = totals(effects.velocities());
    // Each exchange rounds six velocities by 2⁻²⁴ of their size; roundings add up like a random
    // walk at most.
    let scale = changed as f64 * 2.0_f64.powi(-24);
    assert!((momentum_now - momentum).length() < scale * 10.0, "{momentum} {momentum_now}");
    assert!((energy_now / energy - 1.0).abs() < scale, "{energy} {energy_now}");
}
