//! Files of the project that its programs carry with them.

macro_rules! corpus {
    ($($name:literal),+ $(,)?) => {
        /// The groups of hard cases: the text of each one's file, by name.
        pub const HARD_CASES: &[(&str, &str)] =
            &[$(($name, include_str!(concat!("../hard_cases/", $name, ".toml")))),+];
    };
}

corpus! {
    "ball-centres-off-origin",
    "coincident",
    "concentric-stacks",
    "contained",
    "cell-boundaries",
    "coplanar-and-edges",
    "counts",
    "duplicates",
    "equal-and-quarter-turns",
    "far-from-origin",
    "flat-and-points",
    "giant-among-tiny",
    "huge",
    "near-parallel-edges",
    "needles-and-plates",
    "on-a-line",
    "on-a-plane",
    "one-cell",
    "one-ulp-turns",
    "quaternion-norms",
    "quaternion-signs",
    "shared-vertices",
    "subnormal",
    "teleports",
    "touch-by-quadruples",
    "touch-within-an-ulp",
    "unequal-sizes",
    "vertex-on-face",
    "finder-borders",
}
