(* What each theorem rests on. .ci/proofs accepts the four axioms of README.md and no other. *)
From Sdop Require Rejected Ieee Controls.

Print Assumptions Rejected.sphere_rejects_disjoint.
Print Assumptions Ieee.rejected32_disjoint.
Print Assumptions Controls.lower_factor_refuted.
Print Assumptions Controls.lower_floor_refuted.
