//! Scenes with parts that don't fit together: box and bodies, meshes, effects, culling.

use std::path::Path;

use miette::Diagnostic;
use sdop_bench::scene::SceneFile;

use super::{SOUND, changed, posed, refusal};

/// Boxes that hold no bodies are refused.
#[test]
fn too_small_boxes_are_rejected() {
    assert_eq!(
        changed("side = 20", "side = 1.5"),
        "a.toml:3:1: a box of side 1.5 is too small for bodies of radius 1.0000001 | the side must be at least 2.0000002, \
         and larger for room to move"
    );
    assert_eq!(
        changed("side = 20", "partners = 1e9"),
        "a.toml:3:1: a box of side 0.0040619657 is too small for bodies of radius 1.0000001 | the side must be at least 2.0000002, \
         and larger for room to move"
    );
    assert_eq!(
        changed("[box]\nside = 20\n", ""),
        "a.toml:5:9: seeded bodies need a box | add [box] with side = … or partners = …"
    );
    assert_eq!(
        changed("count = 3", "count = 3\nplacement = { plane = { thickness = 19 } }"),
        "a.toml:8:13: a slice of thickness 19 doesn't fit into a box of side 20 | the thickness can be up to 18"
    );
    assert_eq!(
        changed("count = 3", "count = 3\nplacement = { clusters = { number = 2, radius = 9.5 } }"),
        "a.toml:8:13: clusters of radius 9.5 don't fit into a box of side 20 | the radius can be up to 9"
    );
    assert_eq!(
        changed("count = 3", "count = 3\nplacement = { clusters = { number = 4, radius = 1 } }"),
        "a.toml:8:13: 4 clusters of 3 bodies | a cluster has one body at least"
    );
    assert_eq!(
        changed("count = 3", "count = 4000000000"),
        "a.toml:7:9: 4000000000 bodies are too many | a scene has up to 16777216 bodies"
    );
}

/// Missing and broken meshes are pointed at.
#[test]
fn broken_meshes_are_located() {
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("cube.tri"), "1 1\nnonsense").unwrap();
    let refusal = |mesh: &str| {
        let text = SOUND.replace("shape = \"box\"", &format!("mesh = \"{mesh}\""));
        let error =
            SceneFile::parse(&text, "a.toml", directory.path()).unwrap().build().unwrap_err();
        (error.to_string(), error.help().map(|hint| hint.to_string()).unwrap_or_default())
    };
    let (message, hint) = refusal("cub.tri");
    assert!(message.starts_with("a.toml:6:8: ") && message.contains("cub.tri"), "{message}");
    assert_eq!(hint, "mesh paths are relative to the scene file; did you mean `cube.tri`?");
    // A scene in the working directory has the empty path as its directory.
    let text = SOUND.replace("shape = \"box\"", "mesh = \"Cargo.tom\"");
    let here = SceneFile::parse(&text, "a.toml", Path::new("")).unwrap();
    assert_eq!(
        here.build().unwrap_err().help().unwrap().to_string(),
        "mesh paths are relative to the scene file; did you mean `Cargo.toml`?"
    );
    let (message, _) = refusal("cube.tri");
    assert!(message.starts_with("a.toml:6:8: ") && message.contains("cube.tri:1"), "{message}");
}

/// Effects and culling that the scene cannot have are refused.
#[test]
fn impossible_settings_are_located() {
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
        with("[effects]\ngravity = -9.81\n"),
        "a.toml:8:11: invalid type: floating point `-9.81`, expected an acceleration such as [0, 0, -9.81], or { acceleration = \
         [0, 0, -9.81] }"
    );
    assert_eq!(
        with("[effects]\nspin = 2\n"),
        "a.toml:8:8: invalid type: integer `2`, expected a table such as { rate = [0, 2] }, in radians per second"
    );
    assert_eq!(
        with("[effects]\nbrownian = 2\n"),
        "a.toml:8:12: invalid type: integer `2`, expected a table such as { share = 0.1, speed = [0, 2] }"
    );
    assert!(with("[effects]\ngravity = [0, -9.81]\n").starts_with("a.toml:8:11: invalid length 2"));
    let unknown = with("[effects]\ngravity = { acceleratoin = [0, 0, -9.81] }\n");
    assert!(unknown.ends_with("did you mean `acceleration`?"), "{unknown}");
    assert_eq!(
        with("[cull]\ninterest = [2]\n"),
        "interest: body 2 of a scene of 2 | bodies are counted from 0"
    );
    assert!(with("[cull]\nstrategy = \"s-dop-time-critical\"\n").contains("needs `budget`"));
}
