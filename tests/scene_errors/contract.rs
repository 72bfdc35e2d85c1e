//! Bodies of a caller that are outside of the contract.

use sdop::bodies::Bodies;
use sdop::volume::check_bodies;
use sdop_bench::effects::Velocities;

use super::{SOUND, build};

/// Bodies of a caller are checked at the border.
#[test]
fn caller_bodies_are_checked() {
    let scene = build(SOUND).unwrap();
    let refusal = |change: fn(&mut Bodies)| {
        let mut bodies = scene.bodies.clone();
        change(&mut bodies);
        check_bodies(&bodies, &scene.shapes).unwrap_err().problem()
    };
    check_bodies(&scene.bodies, &scene.shapes).unwrap();
    assert_eq!(refusal(|b| b.shape[2] = 1), "body 2: shape 1 of 1");
    assert_eq!(refusal(|b| b.rotation[0] = [0.0; 4]), "body 0: rotation [0.0, 0.0, 0.0, 0.0]");
    assert_eq!(refusal(|b| b.translation[1][2] = f32::NAN).split(", ").last(), Some("NaN]"));
    let refused = |change: fn(&mut Velocities)| {
        let mut velocities = scene.velocities.clone();
        change(&mut velocities);
        velocities.check(3).unwrap_err().problem()
    };
    assert_eq!(refused(|v| v.linear[2] = [f32::INFINITY; 3]), "body 2: velocity [inf, inf, inf]");
    assert_eq!(refused(|v| v.angular[2] = [0.0, 1.2e18, 0.0]), "body 2: spin [0.0, 1.2e18, 0.0]");
    assert_eq!(refused(|v| v.angular.truncate(1)), "body 1: spin has 1 entries for 3 bodies");
    assert_eq!(refusal(|b| b.dynamic.truncate(1)), "body 1: dynamic has 1 entries for 3 bodies");
    // Zeroed memory that nobody reads takes no room.
    let crowd = Bodies { shape: vec![0; 1 << 28], ..Bodies::default() };
    let error = check_bodies(&crowd, &scene.shapes).unwrap_err();
    assert_eq!(error.problem(), "body 268435440: number 268435456 of 268435440 at most");
    let mut shapes = scene.shapes.clone();
    shapes[0].ball.radius = f32::NAN;
    let error = check_bodies(&scene.bodies, &shapes).unwrap_err().problem();
    assert!(error.starts_with("body 0: shape box with reach 1"), "{error}");
}
