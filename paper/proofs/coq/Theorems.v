(* What each theorem rests on. .ci/proofs accepts the four axioms of README.md and no other. *)
From Sdop Require Sphere Ieee Place ReadPose WorldBall Rejected Controls Cells Grid Same Outward
  Finder.

Print Assumptions Rejected.sphere_rejects_disjoint.
Print Assumptions Rejected.quaternion_sound.
Print Assumptions Sphere.stored_balls_disjoint.
Print Assumptions Ieee.rejected32_disjoint.
Print Assumptions Place.transform_error.
Print Assumptions ReadPose.pose_change.
Print Assumptions WorldBall.world_ball_contains.
Print Assumptions Controls.lower_factor_refuted.
Print Assumptions Controls.lower_floor_refuted.
Print Assumptions Cells.centre_in_table.
Print Assumptions Cells.around_covers.
Print Assumptions Grid.touching_bodies_in_neighbouring_cells.
Print Assumptions Grid.fit_most_cells.
Print Assumptions Controls.former_count_refuted.
Print Assumptions Same.run_rejects_disjoint.
Print Assumptions Same.world_ball64_is.
Print Assumptions Same.widen32_is.
Print Assumptions Same.cell64_is.
Print Assumptions Same.number_of_is.
Print Assumptions Finder.reported_within_reach.
Print Assumptions Outward.up_outward.
Print Assumptions Outward.down_outward.
Print Assumptions Outward.sweep_finds.
Print Assumptions Outward.boxes_that_meet_have_near_cubes.
Print Assumptions Outward.ball_with_margin.
Print Assumptions Outward.grown_boxes_meet.
Print Assumptions Outward.grown_no_farther.
