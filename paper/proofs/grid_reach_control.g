# Control of grid_reach.g, one notch tighter: `up` adds nothing. Gappa must fail.

@f64 = float<53, -2000, ne>;
factor = 1 + 1b-20;
floor = 1b-78;
least = 0;
f64_radius = f64(f64(R * factor) + floor);
widened = f64_radius * (1 + more);
A = R * factor + floor;
reach = f64(wa + wb);

{ R in [1b-70, 1b63] /\ more - least in [0, 1] /\ wa in [1b-70, 1b64] /\ wb in [1b-70, 1b64]
  -> (widened - A) / A in [1b-27, 2] /\ (reach - (wa + wb)) / (wa + wb) in [-1b-53, 1b-53] }

(widened - A) / A -> (f64_radius - A) / A * (1 + more) + (more - least) + least { A <> 0 };
