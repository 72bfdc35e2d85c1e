//! A suite of named tests for a culler, one for each group of cases.

/// Stamps a test for each group of cases: `judge_tests!(Claim::Mesh, |scene| Mine::new(scene));` in
/// a module of its own. Groups that have no case of the claim have a test with nothing in it.
#[macro_export]
macro_rules! judge_tests {
    ($claim:expr, $make:expr) => {
        $crate::judge_groups! { $claim, $make }
    };
}

macro_rules! groups {
    ($($test:ident = $group:literal;)+) => {
        /// The groups that `judge_tests!` stamps a test for.
        pub const STAMPED: &[&str] = &[$($group),+];

        groups! { @macro ($) $($test = $group;)+ }
    };
    (@macro ($d:tt) $($test:ident = $group:literal;)+) => {
        #[doc(hidden)]
        #[macro_export]
        macro_rules! judge_groups {
            ($d claim:expr, $d make:expr) => {
                $(
                    #[test]
                    fn $test() {
                        $crate::judge($d make)
                            .claims($d claim)
                            .cases(concat!($group, "/*"))
                            .assert_if_any();
                    }
                )+
            };
        }
    };
}

groups! {
            touch_ball_ball = "touch/ball-ball";
            touch_edge_edge = "touch/edge-edge";
            touch_face_corner = "touch/face-corner";
            touch_corner_face = "touch/corner-face";
            touch_oriented_box = "touch/oriented-box";
            touch_world_extent = "touch/world-extent";
            touch_vertex = "touch/vertex";
            touch_triangle = "touch/triangle";
            touch_near_parallel = "touch/near-parallel";
            touch_quarter_turns = "touch/quarter-turns";
            pose_norms = "pose/norms";
            pose_signs = "pose/signs";
            pose_far = "pose/far";
            exact_face_to_face = "exact/face-to-face";
            exact_edge_to_edge = "exact/edge-to-edge";
            exact_corner_to_corner = "exact/corner-to-corner";
            exact_tip_on_face = "exact/tip-on-face";
            exact_tip_to_tip = "exact/tip-to-tip";
            grid_cell_border = "grid/cell-border";
            buffer_growth = "buffer/growth";
            buffer_hub = "buffer/hub";
            order_repeated = "order/repeated";
            order_renumbered = "order/renumbered";
            churn_swap = "churn/swap";
            churn_teleport = "churn/teleport";
            churn_insert_remove = "churn/insert-remove";
            churn_move = "churn/move";
            churn_turn = "churn/turn";
            random_crowd = "random/crowd";
            random_moving = "random/moving";
            random_sizes = "random/sizes";
            box_grid = "box/grid";
            box_ulp = "box/ulp";
            box_flat = "box/flat";
            box_range = "box/range";
            hard_ball_centres_off_origin = "hard/ball-centres-off-origin";
            hard_coincident = "hard/coincident";
            hard_concentric_stacks = "hard/concentric-stacks";
            hard_contained = "hard/contained";
            hard_cell_boundaries = "hard/cell-boundaries";
            hard_coplanar_and_edges = "hard/coplanar-and-edges";
            hard_counts = "hard/counts";
            hard_duplicates = "hard/duplicates";
            hard_equal_and_quarter_turns = "hard/equal-and-quarter-turns";
            hard_far_from_origin = "hard/far-from-origin";
            hard_flat_and_points = "hard/flat-and-points";
            hard_giant_among_tiny = "hard/giant-among-tiny";
            hard_huge = "hard/huge";
            hard_near_parallel_edges = "hard/near-parallel-edges";
            hard_needles_and_plates = "hard/needles-and-plates";
            hard_on_a_line = "hard/on-a-line";
            hard_on_a_plane = "hard/on-a-plane";
            hard_one_cell = "hard/one-cell";
            hard_one_ulp_turns = "hard/one-ulp-turns";
            hard_quaternion_norms = "hard/quaternion-norms";
            hard_quaternion_signs = "hard/quaternion-signs";
            hard_shared_vertices = "hard/shared-vertices";
            hard_subnormal = "hard/subnormal";
            hard_teleports = "hard/teleports";
            hard_touch_by_quadruples = "hard/touch-by-quadruples";
            hard_touch_within_an_ulp = "hard/touch-within-an-ulp";
            hard_unequal_sizes = "hard/unequal-sizes";
            hard_vertex_on_face = "hard/vertex-on-face";
            hard_finder_borders = "hard/finder-borders";
}

#[cfg(test)]
mod tests {
    use super::STAMPED;
    use crate::catalogue::groups;

    #[test]
    fn every_group_has_its_test() {
        let groups = groups().unwrap_or_default();
        let names: Vec<&str> = groups.iter().map(|group| group.name).collect();
        assert_eq!(names, STAMPED);
    }
}
