//! Keys, names and values that a scene file can't have, whatever else is in it.

use super::{build, changed, posed, refusal};

/// Unknown keys and names suggest the nearest.
#[test]
fn unknown_keys_suggest_the_nearest() {
    assert_eq!(
        changed("radius", "raduis"),
        "a.toml:8:1: unknown field `raduis`, expected one of `mesh`, `shape`, `sizes`, `scale`, `count`, `poses`, `radius`, \
         `origin`, `static`, `speed`, `velocities`, `placement` | did you mean `radius`?"
    );
    assert_eq!(
        changed("walls", "wals"),
        "a.toml:12:1: unknown field `wals`, expected one of `gravity`, `brownian`, `response`, `rest`, `motion`, \
         `spin`, `walls` | did you mean `walls`?"
    );
    assert_eq!(
        changed("\"specular\"", "\"bouncy\""),
        "a.toml:12:9: unknown variant `bouncy`, expected `specular` or `reverse` | one of: specular, reverse"
    );
    assert_eq!(
        changed("\"sphere\"", "\"spheer\"").split(" | ").last().unwrap(),
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

/// Wrong types and impossible values are pointed at.
#[test]
fn invalid_values_are_located() {
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
        changed("motion = true", "rest = { speed = 0, after = 1 }"),
        "a.toml:11:18: invalid value: integer `0`, expected a number above 0, at most 2^60"
    );
    assert_eq!(
        changed("motion = true", "rest = { speed = 1 }"),
        "a.toml:11:8: missing field `after` | add `after`"
    );
    assert_eq!(
        changed("motion = true", "rest = { sped = 1, after = 1 }"),
        "a.toml:11:10: unknown field `sped`, expected one of `speed`, `rate`, `after` | did you mean `speed`?"
    );
    assert_eq!(changed("name = \"s\"", ""), "a.toml:1:1: missing field `name` | add `name`");
}

/// Text that is no toml is pointed at.
#[test]
fn invalid_toml_is_located() {
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

/// Floats read as the nearest f32 of their text.
#[test]
fn floats_round_once() {
    // Just above the midpoint of 1 and the next f32: as f64 it is the midpoint itself, and ties to
    // even give 1.
    let text = "1.00000005960464477539062500000000000000001";
    assert_eq!(text.parse::<f64>().unwrap() as f32, 1.0);
    let scene = build(&posed(&format!("[0, 0, {text}, 16777217, 0.1, 0, 0]"))).unwrap();
    assert_eq!(scene.bodies.rotation[1][2], 1.0_f32.next_up());
    assert_eq!(scene.bodies.rotation[1][3], 16_777_216.0);
    assert_eq!(scene.bodies.translation[1][0], 0.1);
}
