(* What the theorems rest on. .ci/proofs accepts the four axioms of README.md and no other. One list
   for all of them, since each takes Coq a second. *)
From Sdop Require Sphere Ieee Place ReadPose WorldBall Rejected Controls Cells Grid Same Outward
  Finder Lists Levels Duality Margins Refit SupportRounded OrDop OrDopPose SlabEnd OrDopBody
  SameOrDop OrDopRun Cubes CubeLists Binning.

Definition theorems := (
  Rejected.sphere_rejects_disjoint,
  Rejected.quaternion_sound,
  Sphere.stored_balls_disjoint,
  Ieee.rejected32_disjoint,
  Place.transform_error,
  ReadPose.pose_change,
  WorldBall.world_ball_contains,
  Controls.lower_factor_refuted,
  Controls.lower_floor_refuted,
  Cells.centre_in_table,
  Cells.around_covers,
  Grid.touching_bodies_in_neighbouring_cells,
  Grid.fit_most_cells,
  Controls.former_count_refuted,
  Same.run_rejects_disjoint,
  Same.world_ball64_is,
  Same.widen32_is,
  Same.cell64_is,
  Same.number_of_is,
  Finder.reported_within_reach,
  Outward.up_outward,
  Outward.down_outward,
  Outward.sweep_finds,
  Outward.boxes_that_meet_have_near_cubes,
  Outward.ball_with_margin,
  Outward.grown_boxes_meet,
  Outward.grown_no_farther,
  Lists.drift_within_budget,
  Lists.lists_hold_reported_pairs,
  Levels.levels_hand_over,
  Duality.support_bounds,
  Duality.axis_separates,
  SupportRounded.support_rounded,
  OrDop.rejected_polytopes_disjoint,
  OrDopPose.posed_row_is,
  SlabEnd.slab_end_covers,
  OrDopBody.ordops_reject_disjoint,
  OrDopBody.tight_slabs_near,
  SameOrDop.run_rejects,
  OrDopRun.run_ordops_reject_disjoint,
  Cubes.cubes_lose_none,
  Cubes.cubes_add_none,
  CubeLists.cube_lists_hold,
  Binning.polytope_in_ball,
  Binning.far_ordops_separated,
  Margins.place_within_moved,
  Margins.slab_with_margin,
  Refit.refit_contains
).

Print Assumptions theorems.
