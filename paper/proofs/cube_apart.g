# Cubes about boxes (src/rounding/cube.rs), that of each box with half side H, its rounded extent about the rounded centre times
# 1 + 16u, plus 1e-30: boxes that meet have centres no farther apart, as computed, than the computed H1 + H2.
#   D the distance of the centres along an axis, exact, at most S, the sum of the exact extents about them;
# each machine operation x(1 + e) + f, |f| <= 2^-126 with denormals flushed (six of them on one side, one on the other).

u = 1b-24;
floor = 1b-100;
factor = 1 + 16 * u;
H = S * (1 + e2) * (1 + e3) * factor + 2 * floor - f2;
reach = H * (1 + e4) * (1 + e5) - f3;
D = S * (1 + e1) + f1;

{ S in [0, 1b127] /\
  |e1| <= 1b-24 /\ |e2| <= 1b-24 /\ |e3| <= 1b-24 /\ |e4| <= 1b-24 /\ |e5| <= 1b-24 /\
  f1 in [0, 1b-126] /\ f2 in [0, 1b-123] /\ f3 in [0, 1b-124]
  -> reach - D >= 0 }

reach - D -> S * ((1 + e2) * (1 + e3) * (1 + e4) * (1 + e5) * factor - (1 + e1))
           + ((2 * floor - f2) * (1 + e4) * (1 + e5) - f3 - f1);
