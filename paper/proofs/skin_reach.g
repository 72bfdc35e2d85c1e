# The sphere test of grown radii L = fl(fl(R a) + F), a = fl((1 + share)(1 + 64u)), F = fl(least (1 + 64u) + 2^-56), loses no pair
# of balls that may be reported within their budgets: L is no less than `inflate_radius` of W + B rounded up to f32, where
# W = R (1 + 16u) + 2^-78 (finder.g), B = s (1 + 32u) + 2^-60 (skin.g), s = max(fl(R share), least) <= R share (1 + u) + least.
# The errors of a and F include those of f64.

u = 1b-24;
grown = 1 + 64 * u;
a = (1 + share) * grown * (1 + ea);
F = (least * grown + 1b-56) * (1 + ef);
L = (R * a * (1 + e1) + F) * (1 + e2);
s = R * share * (1 + u) + least;
needed = R * (1 + 16 * u) + 1b-78 + s * (1 + 32 * u) + 1b-60;
f = (1 + 2 * u) * (1 + 8 * u) * (1 + u) * (1 + u);
N = needed * f + 1b-70 * (1 + u);
A = grown * (1 + ea) * (1 + e1) * (1 + e2);
G = (1 + ef) * (1 + e2);

{ R in [1b-70, 1b63] /\ share in [0, 1] /\ least in [1b-60, 1b63] /\
  |ea| <= 0x1.000002p-24 /\ |ef| <= 0x1.000002p-24 /\ |e1| <= 1b-24 /\ |e2| <= 1b-24 -> L - N >= 0 }

L - N -> R * ((A - (1 + 16 * u) * f) + share * (A - (1 + u) * (1 + 32 * u) * f)) + least * (grown * G - (1 + 32 * u) * f)
       + (1b-56 * G - (1b-78 + 1b-60) * f - 1b-70 * (1 + u));
