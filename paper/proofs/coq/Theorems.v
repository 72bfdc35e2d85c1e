(* What each theorem rests on. .ci/proofs accepts the four axioms of README.md and no other. *)
From Sdop Require Rejected.

Print Assumptions Rejected.sphere_rejects_disjoint.
