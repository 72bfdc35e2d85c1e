# A ball whose measured drift is below its skin s has a true drift of at most its budget B = s (1 + 32u) + 2^-60:
#   D < left^2  =>  |c' - c| + (R' - R)(1 + 16u) <= B,   left = fl(s - g), g = fl(R' - R) = s (1 - q), q in [0, 1];
# a larger g leaves nothing, and nothing is below 0. kappa undoes the rounding of D as in finder.g; h is what underflow or
# flushing hides in the squares, and what it hides in differences is below 2^-120.

u = 1b-24;
g = s * (1 - q);
left = (s - g) * (1 + e1);
kappa = (1 + e5) * (1 + e5) * (1 + e6) * (1 + e7) * (1 + e8);
D = (left * left * (1 + e3) + h) * kappa;
floor = 1b-60 - 1b-120;
factor = 1 + 32 * u;
m = (factor - 1) - (1 - q) * (16 * u + e2 * (1 + 16 * u));
W = s * factor - g * (1 + e2) * (1 + 16 * u) + floor;
K = (1 + e1) * (1 + e1) * (1 + e3) * kappa;

{ s in [1b-60, 1b63] /\ q in [0, 1] /\
  |e1| <= 1b-24 /\ |e2| <= 0x1.000002p-24 /\ |e3| <= 1b-24 /\
  |e5| <= 0x1.000002p-24 /\ |e6| <= 0x1.000002p-24 /\ |e7| <= 0x1.000002p-24 /\ |e8| <= 0x1.000002p-24 /\
  h in [0, 1b-122]
  -> W >= 0 /\ W * W - D >= 0 }

W -> s * (q + m) + floor;
W * W - D -> s * (s * (q * (q * (1 - K) + 2 * m) + m * m)) + 2 * (s * floor) * (q + m) + (floor * floor - h * kappa);
