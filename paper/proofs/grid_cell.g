# Balls that a test may report fall in cells beside each other. With c >= 2 w (1 + 2^-16), w the widest widened radius, and
# centres X and Y from the origin, 0 <= X - Y <= 2 w, the numbers of their cells as `Rule::cell` computes them, plus T, differ
# by less than 2, and so, being integers, by at most 1. Scaled such that c is in [1, 2].

@f64 = float<53, -2000, ne>;
T = 6755399441055744;
factor = 1 + 1b-16;
inverse = f64(1 / c);
qx = f64(f64(X) * inverse);
qy = f64(f64(Y) * inverse);
cell_x = f64(qx + T);
cell_y = f64(qy + T);

{ c in [1, 2] /\ X in [1b-60, 0x1.0001p30] /\ Y in [1b-60, 0x1.0001p30] /\ (X - Y) * factor / c in [0, 1]
  -> cell_x - cell_y <= 0x1.ffffcp0 }

cell_x - cell_y -> (cell_x - (qx + T)) - (cell_y - (qy + T)) + (qx - X / c) - (qy - Y / c) + (X - Y) * factor / c / factor
  { c <> 0, factor <> 0 };
qx - X / c -> (qx - f64(X) * inverse) + (f64(X) - X) * inverse + X * (inverse - 1 / c) { c <> 0 };
qy - Y / c -> (qy - f64(Y) * inverse) + (f64(Y) - Y) * inverse + Y * (inverse - 1 / c) { c <> 0 };
