# Control of grid_cell.g, one notch tighter: cells wider by 1 + 2^-24 instead of 1 + 2^-16. Gappa must fail.

@f64 = float<53, -2000, ne>;
factor = 1 + 1b-24;
X = Y + share * c / factor;
inverse = f64(1 / c);
qx = f64(f64(X) * inverse);
qy = f64(f64(Y) * inverse);

{ c in [1, 2] /\ X in [1b-60, 0x1.0001p30] /\ Y in [1b-60, 0x1.0001p30] /\ share in [0, 1]
  -> qx - qy in [-1, 0x0.ffff8p0] }

qx - qy -> (qx - X / c) - (qy - Y / c) + share / factor { c <> 0, factor <> 0 };
qx - X / c -> (qx - f64(X) * inverse) + (f64(X) - X) * inverse + X * (inverse - 1 / c) { c <> 0 };
qy - Y / c -> (qy - f64(Y) * inverse) + (f64(Y) - Y) * inverse + Y * (inverse - 1 / c) { c <> 0 };
