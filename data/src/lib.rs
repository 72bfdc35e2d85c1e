//! Files of the project that its programs carry with them.

/// The experiments that `sdop record` runs.
pub const EXPERIMENTS: &str = include_str!("../experiments.toml");

macro_rules! corpus {
    (($d:tt) $($test:ident = $name:literal;)+) => {
        /// The groups of hard cases: the text of each one's file, by name.
        pub const HARD_CASES: &[(&str, &str)] =
            &[$(($name, include_str!(concat!("../hard_cases/", $name, ".toml")))),+];

        /// Calls a macro with `hard { identifier = "name"; … }` before its other input: every group
        /// of hard cases, in the order of [`HARD_CASES`].
        #[macro_export]
        macro_rules! with_hard_cases {
            ($d then:ident! { $d ($d given:tt)* }) => {
                $d then! { hard { $($test = $name;)+ } $d ($d given)* }
            };
        }
    };
}

corpus! { ($)
    hard_ball_centres_off_origin = "ball-centres-off-origin";
    hard_coincident = "coincident";
    hard_concentric_stacks = "concentric-stacks";
    hard_contained = "contained";
    hard_cell_boundaries = "cell-boundaries";
    hard_coplanar_and_edges = "coplanar-and-edges";
    hard_counts = "counts";
    hard_duplicates = "duplicates";
    hard_equal_and_quarter_turns = "equal-and-quarter-turns";
    hard_far_from_origin = "far-from-origin";
    hard_flat_and_points = "flat-and-points";
    hard_giant_among_tiny = "giant-among-tiny";
    hard_huge = "huge";
    hard_near_parallel_edges = "near-parallel-edges";
    hard_needles_and_plates = "needles-and-plates";
    hard_on_a_line = "on-a-line";
    hard_on_a_plane = "on-a-plane";
    hard_one_cell = "one-cell";
    hard_one_ulp_turns = "one-ulp-turns";
    hard_quaternion_norms = "quaternion-norms";
    hard_quaternion_signs = "quaternion-signs";
    hard_shared_vertices = "shared-vertices";
    hard_subnormal = "subnormal";
    hard_teleports = "teleports";
    hard_touch_by_quadruples = "touch-by-quadruples";
    hard_touch_within_an_ulp = "touch-within-an-ulp";
    hard_unequal_sizes = "unequal-sizes";
    hard_vertex_on_face = "vertex-on-face";
    hard_finder_borders = "finder-borders";
}
