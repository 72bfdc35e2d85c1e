# A body looks for those of another level as far as f64(widen(R) + widest), which is no less than what `finder.g` needs,
# A + B = (Ra + Rb)(1 + 16u) + 2^-77: `up` makes each widened radius 2^-26 more than its f64 value at the least (L4), more than
# its own f64 arithmetic loses by 2^-27 and more than the sum of both loses by 2^-53.

@f64 = float<53, -2000, ne>;
factor = 1 + 1b-20;
floor = 1b-78;
least = 1b-26;
f64_radius = f64(f64(R * factor) + floor);
widened = f64_radius * (1 + more);
A = R * factor + floor;
reach = f64(wa + wb);

{ R in [1b-70, 1b63] /\ more - least in [0, 1] /\ wa in [1b-70, 1b64] /\ wb in [1b-70, 1b64]
  -> (widened - A) / A in [1b-27, 2] /\ (reach - (wa + wb)) / (wa + wb) in [-1b-53, 1b-53] }

(widened - A) / A -> (f64_radius - A) / A * (1 + more) + (more - least) + least { A <> 0 };
