(* What each theorem rests on. .ci/proofs accepts the four axioms of README.md and no other. *)
From Sdop Require Rejected Ieee Controls Cells Grid.

Print Assumptions Rejected.sphere_rejects_disjoint.
Print Assumptions Ieee.rejected32_disjoint.
Print Assumptions Controls.lower_factor_refuted.
Print Assumptions Controls.lower_floor_refuted.
Print Assumptions Cells.centre_in_table.
Print Assumptions Cells.neighbouring_cells.
Print Assumptions Cells.around_covers.
Print Assumptions Grid.touching_bodies_in_neighbouring_cells.
