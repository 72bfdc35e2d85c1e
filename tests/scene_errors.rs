//! What is wrong with a scene file is said with file, line, column and a way to mend it; nothing panics.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::Path;

use miette::Diagnostic;
use proptest::prelude::*;
use sdop::scene::bodies::Bodies;
use sdop::scene::contract::check_bodies;
use sdop::scene::{Scene, SceneError, SceneFile};

fn build(text: &str) -> Result<Scene, SceneError> {
    SceneFile::parse(text, "a.toml", Path::new("data/scenes"))?.build()
}

/// The error of a scene as "message | hint".
fn refusal(text: &str) -> String {
    let error = build(text).expect_err(text);
    let hint = error
        .help()
        .map(|hint| format!(" | {hint}"))
        .unwrap_or_default();
    format!("{error}{hint}")
}

const SOUND: &str = r#"name = "s"
frames = 2
[box]
side = 20
[[bodies]]
shape = "box"
count = 3
radius = 1
speed = [0.5, 2]
[effects]
motion = true
walls = "specular"
[cull]
strategy = "sphere"
"#;

/// The sound scene with one piece of text replaced.
fn changed(from: &str, to: &str) -> String {
    assert!(SOUND.contains(from), "{from}");
    refusal(&SOUND.replacen(from, to, 1))
}

#[test]
fn the_sound_scene_builds() {
    let scene = build(SOUND).unwrap();
    assert_eq!(
        (scene.bodies.len(), scene.shapes.len(), scene.side),
        (3, 1, Some(20.0))
    );
}

#[test]
fn unknown_keys_and_names_suggest_the_nearest() {
    assert_eq!(
        changed("radius", "raduis"),
        "a.toml:8:1: unknown field `raduis`, expected one of `mesh`, `shape`, `sizes`, `count`, `poses`, `radius`, \
         `origin`, `static`, `speed`, `velocities`, `placement` | did you mean `radius`?"
    );
    assert_eq!(
        changed("walls", "wals"),
        "a.toml:12:1: unknown field `wals`, expected one of `gravity`, `brownian`, `response`, `motion`, `spin`, \
         `walls` | did you mean `walls`?"
    );
    assert_eq!(
        changed("\"specular\"", "\"bouncy\""),
        "a.toml:12:9: unknown variant `bouncy`, expected `specular` or `reverse` | one of: specular, reverse"
    );
    assert_eq!(
        changed("\"sphere\"", "\"spheer\"")
            .split(" | ")
            .last()
            .unwrap(),
        "did you mean `sphere`?"
    );
    assert_eq!(
        changed("strategy = \"sphere\"", "k = 16"),
        "a.toml:14:5: no or-DOP has k = `16`, expected one of `6`, `14`, `18`, `26` | one of: 6, 14, 18, 26"
    );
    assert_eq!(
        changed("\"box\"", "\"bok\""),
        "a.toml:6:9: there is no shape `bok` | did you mean `box`?"
    );
}

#[test]
fn wrong_types_and_impossible_values_are_pointed_at() {
    assert_eq!(
        changed("frames = 2", "frames = 0"),
        "a.toml:2:10: invalid value: integer `0`, expected a nonzero u32"
    );
    assert_eq!(
        changed("count = 3", "count = 0"),
        "a.toml:7:9: invalid value: integer `0`, expected a nonzero u32"
    );
    assert_eq!(
        changed("side = 20", "side = \"wide\""),
        "a.toml:4:8: invalid type: string \"wide\", expected a number above 0, at most 2^60"
    );
    assert_eq!(
        changed("side = 20", "side = nan"),
        "a.toml:4:8: invalid value: floating point `NaN`, expected a number above 0, at most 2^60"
    );
    assert_eq!(
        changed("side = 20", "side = 1e19"),
        "a.toml:4:8: invalid value: floating point `10000000000000000000.0`, expected a number above 0, at most 2^60"
    );
    assert_eq!(
        changed("[0.5, 2]", "[2, 0.5]"),
        "a.toml:9:9: invalid value: [2.0, 0.5], expected a number or [min, max], from 0 to 2^60"
    );
    assert_eq!(
        changed("motion = true", "motion = false"),
        "a.toml:11:10: invalid value: boolean `false`, expected true, or no such line where it is not simulated"
    );
    assert_eq!(
        changed("radius = 1", "radius = 0"),
        "a.toml:8:10: a radius of 0 | a radius is above 0; leave it out to keep the mesh's size"
    );
    assert_eq!(
        changed("radius = 1", "sizes = { x = -1 }"),
        "a.toml:8:15: the size \"x\" of the shape \"box\" cannot be -1 | x must be from 2^-60 to 2^58"
    );
    assert_eq!(
        changed("radius = 1", "sizes = { u = 1 }"),
        "a.toml:8:11: the shape \"box\" has no size \"u\" | its sizes are x, y, z"
    );
    assert_eq!(
        changed("name = \"s\"", ""),
        "a.toml:1:1: missing field `name` | add `name`"
    );
}

#[test]
fn text_that_is_no_toml_is_pointed_at() {
    assert!(changed("frames = 2", "frames = ").starts_with("a.toml:2:10: "));
    assert!(refusal("").starts_with("a.toml:1:1: missing field"));
    assert!(refusal("\u{feff}\0ö = [").starts_with("a.toml:1:"));
}

#[test]
fn columns_count_characters() {
    assert!(
        refusal("name = \"s\"\nframes = 1\nbodies = [{ shape = \"größer\", raduis = 1 }]")
            .starts_with("a.toml:3:31: unknown field `raduis`")
    );
}

#[test]
fn exclusive_keys_are_refused() {
    assert_eq!(
        changed("side = 20", "side = 20\npartners = 1.5"),
        "a.toml:5:12: `side` and `partners` exclude each other | keep one of them"
    );
    assert_eq!(
        changed("side = 20", ""),
        "a.toml:3:1: a box without a size | add side = … or partners = …"
    );
    assert_eq!(
        changed("count = 3", "count = 3\nposes = []"),
        "a.toml:8:9: `count` and `poses` exclude each other | keep one of them"
    );
    assert_eq!(
        changed("count = 3", ""),
        "a.toml:5:1: how many bodies? | add count = … or poses = [[qx, qy, qz, qw, tx, ty, tz]]"
    );
    assert_eq!(
        changed("shape = \"box\"", "shape = \"box\"\nmesh = \"x.tri\""),
        "a.toml:6:9: `mesh` and `shape` exclude each other | keep one of them"
    );
    assert_eq!(
        changed("count = 3", "count = 3\nstatic = true"),
        "a.toml:10:9: static bodies don't move | leave out the velocity, or `static = true`"
    );
    assert_eq!(
        changed("count = 3", "count = 3\norigin = \"file\""),
        "a.toml:9:10: `radius` scales, origin = \"file\" keeps the size | keep one of them"
    );
    assert_eq!(
        changed("count = 3", "count = 3\nvelocities = [[0, 0, 0]]"),
        "a.toml:10:9: `speed` and `velocities` exclude each other | keep one of them"
    );
}

#[test]
fn boxes_that_hold_no_bodies_are_refused() {
    assert_eq!(
        changed("side = 20", "side = 1.5"),
        "a.toml:3:1: a box of side 1.5 is too small for bodies of radius 1.0000001 | the side must be at least 2.0000002, for room \
         to move well above"
    );
    assert_eq!(
        changed("side = 20", "partners = 1e9"),
        "a.toml:3:1: a box of side 0.0040619657 is too small for bodies of radius 1.0000001 | the side must be at least 2.0000002, for \
         room to move well above"
    );
    assert_eq!(
        changed("[box]\nside = 20\n", ""),
        "a.toml:5:9: seeded bodies need a box | add [box] with side = … or partners = …"
    );
    assert_eq!(
        changed(
            "count = 3",
            "count = 3\nplacement = { plane = { thickness = 19 } }"
        ),
        "a.toml:8:13: a slice of thickness 19 doesn't fit into a box of side 20 | the thickness can be up to 18"
    );
    assert_eq!(
        changed(
            "count = 3",
            "count = 3\nplacement = { clusters = { number = 2, radius = 9.5 } }"
        ),
        "a.toml:8:13: clusters of radius 9.5 don't fit into a box of side 20 | the radius can be up to 9"
    );
    assert_eq!(
        changed(
            "count = 3",
            "count = 3\nplacement = { clusters = { number = 4, radius = 1 } }"
        ),
        "a.toml:8:13: 4 clusters of 3 bodies | a cluster has one body at least"
    );
    assert_eq!(
        changed("count = 3", "count = 4000000000"),
        "a.toml:7:9: 4000000000 bodies are too many | a scene has up to 16777216 bodies"
    );
}

#[test]
fn missing_and_broken_meshes_are_pointed_at() {
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("cube.tri"), "1 1\nnonsense").unwrap();
    let refusal = |mesh: &str| {
        let text = SOUND.replace("shape = \"box\"", &format!("mesh = \"{mesh}\""));
        let error = SceneFile::parse(&text, "a.toml", directory.path())
            .unwrap()
            .build()
            .unwrap_err();
        (
            error.to_string(),
            error
                .help()
                .map(|hint| hint.to_string())
                .unwrap_or_default(),
        )
    };
    let (message, hint) = refusal("cub.tri");
    assert!(
        message.starts_with("a.toml:6:8: ") && message.contains("cub.tri"),
        "{message}"
    );
    assert_eq!(
        hint,
        "mesh paths are relative to the scene file; did you mean `cube.tri`?"
    );
    let (message, _) = refusal("cube.tri");
    assert!(
        message.starts_with("a.toml:6:8: ") && message.contains("cube.tri:1"),
        "{message}"
    );
}

fn posed(pose: &str) -> String {
    format!(
        "name = \"p\"\nframes = 1\n[[bodies]]\nshape = \"box\"\nposes = [[0, 0, 0, 1, 0, 0, 0],\n {pose}]\n"
    )
}

#[test]
fn a_pose_outside_of_the_contract_names_its_body() {
    let limit = "coordinates are finite and at most 2^60 in size";
    let norm = "a quaternion (x, y, z, w) has a finite norm above zero";
    for (pose, problem, hint) in [
        (
            "[0, 0, 0, 1, nan, 0, 0]",
            "translation [NaN, 0.0, 0.0]",
            limit,
        ),
        (
            "[0, 0, 0, 1, 0, -inf, 0]",
            "translation [0.0, -inf, 0.0]",
            limit,
        ),
        (
            "[0, 0, 0, 1, 0, 0, 2e18]",
            "translation [0.0, 0.0, 2e18]",
            limit,
        ),
        (
            "[0, 0, 0, 0, 0, 0, 0]",
            "rotation [0.0, 0.0, 0.0, 0.0]",
            norm,
        ),
        (
            "[0, nan, 0, 1, 0, 0, 0]",
            "rotation [0.0, NaN, 0.0, 1.0]",
            norm,
        ),
        (
            "[0, 0, 1e39, 1, 0, 0, 0]",
            "rotation [0.0, 0.0, inf, 1.0]",
            norm,
        ),
    ] {
        assert_eq!(
            refusal(&posed(pose)),
            format!("a.toml:6:2: body 1: {problem} | {hint}")
        );
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

#[test]
fn effects_and_culling_that_the_scene_cannot_have_are_refused() {
    let with = |table: &str| refusal(&format!("{}{table}", posed("[0, 0, 0, 1, 5, 0, 0]")));
    assert_eq!(
        with("[effects]\nwalls = \"specular\"\n"),
        "a.toml:8:9: walls: the scene has no box | add [box] with side = …, or leave the walls out"
    );
    assert_eq!(
        with("[effects]\nwalls = \"specular\"\n[box]\nside = 10\n"),
        "a.toml:8:9: walls: dynamic body 1 of radius 0.86602545 at [5.0, 0.0, 0.0] starts beyond a wall of a box of side \
         10 | the box is centred on the origin and holds whole spheres: enlarge it or move the body"
    );
    assert_eq!(
        with("[effects]\ngravity = { acceleration = [0, 0, -9.81], axis = [0, 0, 1] }\n"),
        "a.toml:8:11: gravity: an axis without a period | give the period in seconds, or leave the axis out"
    );
    assert_eq!(
        with("[cull]\ninterest = [2]\n"),
        "interest: body 2 of a scene of 2 | bodies are counted from 0"
    );
    assert!(with("[cull]\nstrategy = \"s-dop-time-critical\"\n").contains("needs `budget`"));
}

#[test]
fn an_unreadable_file_is_named() {
    let error = SceneFile::read(Path::new("data/scenes/no-such-scene.toml")).unwrap_err();
    assert!(
        error
            .to_string()
            .starts_with("data/scenes/no-such-scene.toml: "),
        "{error}"
    );
}

#[test]
fn floats_read_as_the_nearest_f32_of_their_text() {
    // Just above the midpoint of 1 and the next f32: as f64 it is the midpoint itself, and ties to even give 1.
    let text = "1.00000005960464477539062500000000000000001";
    assert_eq!(text.parse::<f64>().unwrap() as f32, 1.0);
    let scene = build(&posed(&format!("[0, 0, 0, 1, {text}, 16777217, 0]"))).unwrap();
    assert_eq!(scene.bodies.translation[1][0], 1.0_f32.next_up());
    assert_eq!(scene.bodies.translation[1][1], 16_777_216.0);
}

#[test]
fn bodies_of_a_caller_are_checked_at_the_border() {
    let scene = build(SOUND).unwrap();
    let refusal = |change: fn(&mut Bodies)| {
        let mut bodies = scene.bodies.clone();
        change(&mut bodies);
        check_bodies(&bodies, &scene.shapes)
            .unwrap_err()
            .to_string()
    };
    check_bodies(&scene.bodies, &scene.shapes).unwrap();
    assert_eq!(refusal(|b| b.shape[2] = 1), "body 2: shape 1 of 1");
    assert_eq!(
        refusal(|b| b.rotation[0] = [0.0; 4]),
        "body 0: rotation [0.0, 0.0, 0.0, 0.0]"
    );
    assert_eq!(
        refusal(|b| b.translation[1][2] = f32::NAN)
            .split(", ")
            .last(),
        Some("NaN]")
    );
    assert_eq!(
        refusal(|b| b.velocity[2] = [f32::INFINITY; 3]),
        "body 2: velocity [inf, inf, inf]"
    );
    assert_eq!(
        refusal(|b| b.spin[2] = [0.0, 1.2e18, 0.0]),
        "body 2: spin [0.0, 1.2e18, 0.0]"
    );
    assert_eq!(
        refusal(|b| b.dynamic.truncate(1)),
        "body 1: dynamic is missing or too much: 1 entries for 3 bodies"
    );
    let mut shapes = scene.shapes.clone();
    shapes[0].ball.radius = f32::NAN;
    let error = check_bodies(&scene.bodies, &shapes)
        .unwrap_err()
        .to_string();
    assert!(
        error.starts_with("body 0: shape box with reach 1"),
        "{error}"
    );
}

/// The sound scene with a few bytes changed, dropped or doubled, as text.
fn damaged() -> impl Strategy<Value = String> {
    let edit = (0..SOUND.len(), "[ -~\n\u{0}-\u{ff}]{0,3}", 0..4_usize);
    proptest::collection::vec(edit, 1..4).prop_map(|edits| {
        let mut text: Vec<char> = SOUND.chars().collect();
        for (at, insert, drop) in edits {
            let at = at.min(text.len());
            let end = (at + drop).min(text.len());
            text.splice(at..end, insert.chars());
        }
        text.into_iter().collect()
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]

    #[test]
    fn no_text_panics(text in damaged()) {
        match SceneFile::parse(&text, "a.toml", Path::new("data/scenes")) {
            Err(error) => prop_assert!(error.to_string().starts_with("a.toml:"), "{error}"),
            // A digit more can ask for a million bodies: build small scenes alone.
            Ok(file) if text.contains("count = 3\n") => {
                if let Ok(scene) = file.build() {
                    prop_assert!(check_bodies(&scene.bodies, &scene.shapes).is_ok());
                }
            }
            Ok(_) => {}
        }
    }
}
