//! Compares the exact decisions about volumes with rationals, and their stages with each other.

use dashu_int::IBig;
use dashu_ratio::RBig;

use super::hard::{Case, TURN, turned_back};
use super::rational::{self, Rational3, posed, rational};
use super::shapes::{Draws, exact_basis, slabs};
use crate::exact::axes::{self, Corners, Posed, Rounded, Separation};
use crate::exact::ordop::{self, Certificate};
use crate::exact::polytope::{DENOMINATOR, Polytope};
use crate::exact::{Interval, Path, Tally, sphere};
use crate::linear::integers;
use crate::number::power_of_two;
use crate::{Ball, DirectionSet, Pose, Slabs};

/// A radius with which B comes as close to touching A as f32 can say, one float more or one float
/// less.
fn touching_radius(draws: &mut Draws, a: (&Ball, &Pose), b: (&Ball, &Pose)) -> f32 {
    let centre = |(ball, pose): (&Ball, &Pose)| posed(pose, &rational::rational3(ball.centre));
    let d = rational::sub(&centre(b), &centre(a)).map(|x| x.to_f64().value());
    let gap = (d[0].hypot(d[1]).hypot(d[2]) - f64::from(a.0.radius)) as f32;
    [gap, gap.next_up(), gap.next_down()][(draws.bits() % 3) as usize].max(0.0)
}

fn ball(draws: &mut Draws, case: &Case) -> Ball {
    let scale = power_of_two(case.size) as f32;
    let reach = if draws.bits().is_multiple_of(2) { 0.0 } else { 4.0 };
    let centre = [(); 3].map(|()| draws.signed(reach).trunc() / 4.0 * scale);
    Ball { centre, radius: (draws.signed(4.0).trunc().abs() / 8.0 + 0.25) * scale }
}

/// Spheres agree with rationals and between stages.
#[test]
fn spheres_agree_with_rationals() {
    let mut draws = Draws(7);
    let mut tally = Tally::default();
    let mut silent = 0;
    for _ in 0..4000 {
        let case = draws.hard_case();
        let (ball_a, mut ball_b) = (ball(&mut draws, &case), ball(&mut draws, &case));
        ball_b.radius = touching_radius(&mut draws, (&ball_a, &case.a), (&ball_b, &case.b));
        let (a, b) = ((&ball_a, &case.a), (&ball_b, &case.b));
        let decision = sphere::overlap_balls(a, b);
        tally.count(decision.path);
        assert_eq!(decision.value, rational::balls_overlap(a, b), "{case:?} {ball_a:?} {ball_b:?}");
        let exact = sphere::judge::<IBig>(a, b, sphere::common_unit(a, b));
        assert_eq!(exact, Some(decision.value), "{case:?} {ball_a:?} {ball_b:?}");
        for stage in [sphere::filter(a, b), sphere::judge::<Interval>(a, b, 0)] {
            silent += u32::from(stage.is_none());
            assert!(
                stage.is_none_or(|answer| answer == decision.value),
                "{case:?} {ball_a:?} {ball_b:?}"
            );
        }
    }
    // The families are hard enough to reach every stage, and not so hard that none decides.
    assert!(tally.filter > 1000 && tally.exact > 100, "{tally:?}, {silent} silent");
}

/// Balls, turned so that f64 rounds every centre, whose centres are as far apart as the radii
/// reach, give or take next to nothing.
#[test]
fn turned_spheres_that_touch() {
    let mut draws = Draws(31);
    let mut paths = Tally::default();
    for n in 0..2000_i32 {
        let nothing = power_of_two(-20 - n / 3 % 60) as f32;
        let off = [0.0, nothing, -nothing][n as usize % 3];
        let (ball_a, ball_b) = (
            Ball { centre: [-off, 0.0, 0.0], radius: TURN },
            Ball { centre: turned_back([2.0, 3.0, 6.0]), radius: 6.0 * TURN },
        );
        let (pose_a, pose_b) = draws.turned_poses();
        let (a, b) = ((&ball_a, &pose_a), (&ball_b, &pose_b));
        for (a, b) in [(a, b), (b, a)] {
            let decision = sphere::overlap_balls(a, b);
            assert_eq!(decision.value, off <= 0.0, "{pose_a:?} {off:e} {:?}", decision.path);
            paths.count(decision.path);
        }
    }
    assert!(paths.filter > 500 && paths.interval > 50 && paths.exact > 1000, "{paths:?}");
}

/// A polytope of random slabs that a handful of grid points bound, as a mesh's would.
fn polytope(draws: &mut Draws, directions: DirectionSet, size: i32) -> Polytope {
    let scale = power_of_two(size) as f32;
    let flat = draws.bits() % 8;
    let vertices: Vec<[f32; 3]> = (0..1 + draws.bits() % 6)
        .map(|_| {
            let mut v = [(); 3].map(|()| draws.signed(3.0).trunc() / 2.0 * scale);
            if flat < 3 {
                v[flat as usize] = 0.0;
            }
            v
        })
        .collect();
    let basis = match draws.bits() % 3 {
        0 => exact_basis([1, 2, -3, 5]),
        1 => exact_basis([0, 0, 3, 4]),
        _ => exact_basis([0, 0, 0, 1]),
    };
    // Exact ends where f32 can hold them, so that flat things stay flat and contacts exact.
    let mut fitted = slabs(directions, basis, &vertices);
    let tight = super::shapes::exact_slabs(directions, basis, &vertices);
    for (end, exact) in
        fitted.lo.iter_mut().zip(&tight.lo).chain(fitted.hi.iter_mut().zip(&tight.hi))
    {
        if exact.is_finite() {
            *end = *exact;
        }
    }
    Polytope::new(&fitted).unwrap()
}

/// Corners, normals and edges in world coordinates.
struct World {
    corners: Vec<Rational3>,
    normals: Vec<Rational3>,
    edges: Vec<Rational3>,
}

fn world((pose, polytope): Posed) -> World {
    let rows = polytope.basis.map(|row| row.map(rational));
    let norm = rational::dot(&rows[0], &rows[0]);
    let combine = |xi: Rational3| {
        [0, 1, 2]
            .map(|i| (&xi[0] * &rows[0][i] + &xi[1] * &rows[1][i] + &xi[2] * &rows[2][i]) / &norm)
    };
    let unit = rational(power_of_two(polytope.unit)) / RBig::from(DENOMINATOR);
    let corner = |xi: &[IBig; 3]| {
        posed(pose, &combine(xi.each_ref().map(|x| RBig::from(x.clone()) * &unit)))
    };
    let origin = posed(pose, &[RBig::ZERO, RBig::ZERO, RBig::ZERO]);
    let direction =
        |c: &[i32; 3]| rational::sub(&posed(pose, &combine(c.map(RBig::from))), &origin);
    World {
        corners: polytope.corners.iter().map(corner).collect(),
        normals: polytope.normals.iter().map(direction).collect(),
        edges: polytope.edges.iter().map(direction).collect(),
    }
}

/// What the filter or the intervals say of one axis, the integers say too.
fn stages_agree(a: Posed, b: Posed) {
    let exact = Corners::<IBig>::new(a, b);
    let (filter, interval) = (Rounded::new(a, b), Corners::<Interval>::new(a, b));
    for normal in &a.1.normals {
        let truth = exact.separates(&integers(*normal));
        let guesses =
            [filter.separates(&integers(*normal)), interval.separates(&integers(*normal))];
        assert!(
            guesses.iter().all(|guess| guess.is_none() || *guess == truth),
            "{guesses:?} {truth:?}"
        );
    }
}

/// Polytopes agree with rational axes and prove it.
#[test]
fn polytopes_agree_with_rational_axes() {
    let mut draws = Draws(11);
    let (mut full, mut sided, mut met) = (Tally::default(), Tally::default(), 0);
    for n in 0..800 {
        let case = draws.hard_case();
        let directions = DirectionSet::ALL[n % 4];
        let shapes = [(); 2].map(|()| polytope(&mut draws, directions, case.size));
        let (a, b) = ((&case.a, &shapes[0]), (&case.b, &shapes[1]));
        let (world_a, world_b) = (world(a), world(b));
        let apart = |axes: &[Rational3]| {
            axes.iter().any(|axis| rational::separates(axis, &world_a.corners, &world_b.corners))
        };
        let one_sided = axes::overlap_one_sided(a, b);
        assert_eq!(one_sided.value, !apart(&world_a.normals), "one-sided {case:?}");
        stages_agree(a, b);
        let two_sided = axes::overlap_two_sided(a, b);
        let apart_sided = apart(&world_a.normals) || apart(&world_b.normals);
        assert_eq!(two_sided.value, !apart_sided, "two-sided {case:?}");
        assert_eq!(axes::two_sided::<IBig>(a, b), Some(apart_sided), "{case:?}");
        let enclosed = axes::two_sided::<Interval>(a, b);
        assert!(enclosed.is_none_or(|apart| apart == apart_sided), "{case:?}");
        let crossed: Vec<Rational3> = world_a
            .edges
            .iter()
            .flat_map(|ea| world_b.edges.iter().map(|eb| rational::cross(ea, eb)))
            .collect();
        let decision = ordop::meet(a, b);
        let meets = matches!(decision.value, Certificate::Common { .. });
        assert_eq!(meets, !(apart_sided || apart(&crossed)), "full {case:?} {:?}", decision.path);
        assert!(decision.value.verify(a, b), "{case:?} {:?}", decision);
        let exact = ordop::solve(a, b, ordop::START);
        assert_eq!(matches!(exact, Certificate::Common { .. }), meets, "{case:?}");
        assert!(exact.verify(a, b), "{case:?}");
        full.count(decision.path);
        sided.count(one_sided.path);
        sided.count(two_sided.path);
        met += u32::from(meets);
    }
    assert!((100..300).contains(&met), "{met} met");
    assert!(full.filter > 100 && full.exact > 20 && sided.exact > 20, "{full:?} {sided:?}");
}

/// Certificates that do not hold are refused.
#[test]
fn invalid_certificates_are_rejected() {
    let cube = |half: f32| {
        let (lo, hi) = (vec![-half; 3], vec![half; 3]);
        let basis = exact_basis([0, 0, 0, 1]);
        Polytope::new(&Slabs { directions: DirectionSet::K6, basis, lo, hi }).unwrap()
    };
    let (small, large) = (cube(1.0), cube(2.0));
    let at = |x: f32| Pose::new([0.0, 0.0, 0.0, 2.0], [x, 0.0, 0.0]).unwrap();
    let (origin, touching, beyond) = (at(0.0), at(3.0), at(3.0f32.next_up()));
    let touch = ordop::meet((&origin, &small), (&touching, &large));
    let miss = ordop::meet((&origin, &small), (&beyond, &large));
    assert_eq!(touch.path, Path::Exact);
    assert!(
        matches!(touch.value, Certificate::Common { .. })
            && matches!(miss.value, Certificate::Separated(_))
    );
    assert!(touch.value.verify((&origin, &small), (&touching, &large)));
    assert!(!touch.value.verify((&origin, &small), (&beyond, &large)));
    assert!(!miss.value.verify((&origin, &small), (&touching, &large)));
}

/// Two k-DOPs on either side of a plane, turned so that f64 rounds every corner; A ends on the
/// plane or next to nothing before or after it.
#[test]
fn turned_faces_that_touch() {
    let mut draws = Draws(29);
    let mut paths = Tally::default();
    for n in 0..600 {
        let directions = DirectionSet::ALL[n % 4];
        let coefficients = directions.coefficients();
        let half = |c: &[i32; 3]| 0.75 * c.iter().map(|x| x.abs()).sum::<i32>() as f32;
        // The ends of the regular k-DOP about (x, 0, 0).
        let ends = |x: f32, sign: f32, scale: f32| -> Vec<f32> {
            coefficients.iter().map(|c| scale * (sign * half(c) + x * c[0] as f32)).collect()
        };
        let nothing = power_of_two(-20 - n as i32 / 12 % 50) as f32;
        let past = [0.0, nothing, -nothing][n / 4 % 3];
        let mut hi = ends(-0.75, 1.0, 1.0);
        hi[0] = past;
        let axes = exact_basis([0, 0, 0, 1]);
        let below = Slabs { directions, basis: axes, lo: ends(-0.75, -1.0, 1.0), hi };
        let (lo, hi) = (ends(0.75, -1.0, TURN), ends(0.75, 1.0, TURN));
        let above = Slabs { directions, basis: axes.map(turned_back), lo, hi };
        let [below, above] = [below, above].map(|slabs| Polytope::new(&slabs).unwrap());
        let (pose_a, pose_b) = draws.turned_poses();
        let (a, b) = ((&pose_a, &below), (&pose_b, &above));
        for (a, b) in [(a, b), (b, a)] {
            let decision = ordop::meet(a, b);
            let meets = matches!(decision.value, Certificate::Common { .. });
            assert_eq!(meets, past >= 0.0, "{pose_a:?} {past:e} {:?}", decision.path);
            assert!(decision.value.verify(a, b), "{pose_a:?} {past:e} {:?}", decision.path);
            assert_eq!(axes::overlap_one_sided(a, b).value, meets, "one-sided {pose_a:?} {past:e}");
            assert_eq!(axes::overlap_two_sided(a, b).value, meets, "two-sided {pose_a:?} {past:e}");
            paths.count(decision.path);
        }
    }
    assert!(paths.exact > 400 && paths.interval > 10 && paths.filter > 200, "{paths:?}");
}
