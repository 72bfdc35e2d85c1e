//! Bodies outside of the contract, from a file or from a caller.

use sdop::bodies::Bodies;
use sdop::bodies::contract::check_bodies;
use sdop_bench::effects::Velocities;

use super::{SOUND, build, posed, refusal};

/// A pose outside of the contract names its body.
#[test]
fn invalid_pose_names_its_body() {
    let limit = "coordinates are finite and at most 2^60 in size";
    let norm = "a quaternion (x, y, z, w) has a finite norm above zero";
    for (pose, problem, hint) in [
        ("[0, 0, 0, 1, nan, 0, 0]", "translation [NaN, 0.0, 0.0]", limit),
        ("[0, 0, 0, 1, 0, -inf, 0]", "translation [0.0, -inf, 0.0]", limit),
        ("[0, 0, 0, 1, 0, 0, 2e18]", "translation [0.0, 0.0, 2e18]", limit),
        ("[0, 0, 0, 0, 0, 0, 0]", "rotation [0.0, 0.0, 0.0, 0.0]", norm),
        ("[0, nan, 0, 1, 0, 0, 0]", "rotation [0.0, NaN, 0.0, 1.0]", norm),
        ("[0, 0, 1e39, 1, 0, 0, 0]", "rotation [0.0, 0.0, inf, 1.0]", norm),
    ] {
        assert_eq!(refusal(&posed(pose)), format!("a.toml:6:2: body 1: {problem} | {hint}"));
    }
    let moving = |v: &str| {
        refusal(
            &posed("[0, 0, 0, 1, 0, 0, 0]")
                .replace("poses", &format!("velocities = [[0, 0, 0], {v}]\nposes")),
        )
    };
    assert_eq!(
        moving("[nan, 0, 0]"),
        format!("a.toml:5:26: body 1: velocity [NaN, 0.0, 0.0] | {limit}")
    );
    // The squares of both leave f32's range, but not f64's.
    build(&posed("[0, 0, 0, 1e-23, 1152921504606846976, 0, 0]")).unwrap();
    build(&posed("[0, 0, 3e38, 0, 0, 0, 0]")).unwrap();
    assert_eq!(
        refusal(&posed("[0, 0, 0, 1, 0, 0]")),
        "a.toml:6:2: invalid length 6, expected an array of length 7"
    );
}

/// Bodies of a caller are checked at the border.
#[test]
fn caller_bodies_are_checked() {
    let scene = build(SOUND).unwrap();
    let refusal = |change: fn(&mut Bodies)| {
        let mut bodies = scene.bodies.clone();
        change(&mut bodies);
        check_bodies(&bodies, &scene.shapes).unwrap_err().to_string()
    };
    check_bodies(&scene.bodies, &scene.shapes).unwrap();
    assert_eq!(refusal(|b| b.shape[2] = 1), "body 2: shape 1 of 1");
    assert_eq!(refusal(|b| b.rotation[0] = [0.0; 4]), "body 0: rotation [0.0, 0.0, 0.0, 0.0]");
    assert_eq!(refusal(|b| b.translation[1][2] = f32::NAN).split(", ").last(), Some("NaN]"));
    let refused = |change: fn(&mut Velocities)| {
        let mut velocities = scene.velocities.clone();
        change(&mut velocities);
        velocities.check(3).unwrap_err().to_string()
    };
    assert_eq!(refused(|v| v.linear[2] = [f32::INFINITY; 3]), "body 2: velocity [inf, inf, inf]");
    assert_eq!(refused(|v| v.angular[2] = [0.0, 1.2e18, 0.0]), "body 2: spin [0.0, 1.2e18, 0.0]");
    assert_eq!(refused(|v| v.angular.truncate(1)), "body 1: spin has 1 entries for 3 bodies");
    assert_eq!(refusal(|b| b.dynamic.truncate(1)), "body 1: dynamic has 1 entries for 3 bodies");
    // Zeroed memory that nobody reads takes no room.
    let crowd = Bodies { shape: vec![0; 1 << 28], ..Bodies::default() };
    let error = check_bodies(&crowd, &scene.shapes).unwrap_err();
    assert_eq!(error.to_string(), "body 268435440: number 268435456 of 268435440 at most");
    let mut shapes = scene.shapes.clone();
    shapes[0].ball.radius = f32::NAN;
    let error = check_bodies(&scene.bodies, &shapes).unwrap_err().to_string();
    assert!(error.starts_with("body 0: shape box with reach 1"), "{error}");
}
