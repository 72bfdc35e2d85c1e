# If s*s is flushed to zero (s < 2^-63), then so is all of d2: touching spheres compare 0 > 0 and are not culled.
# d2 bounds every partial result; below 2^-126 (1 - u) it is tiny before and after rounding. Names: sphere_underflow.g.

u = 1b-24;
gain = 8 * u; floor = 1b-70;
alpha = (1 + gain) * (1 + e1) * (1 + e2);
beta = 2 * floor * (1 + e2) - g1;
P = (s / (1 + e3) - beta) / alpha;
d2 = (P + g2) * (P + g2) * ((1 + e5) * (1 + e5) * (1 + e6) * (1 + e7) * (1 + e8));

{ s in [1b-70, 1b-63] /\ P >= 0 /\
  |e1| <= 1b-24 /\ |e2| <= 1b-24 /\ |e3| <= 1b-24 /\
  |e5| <= 1b-24 /\ |e6| <= 1b-24 /\ |e7| <= 1b-24 /\ |e8| <= 1b-24 /\
  g1 in [0, 1b-124] /\ g2 in [0, 1b-124]
  -> d2 <= 0xFFFFFFp-150 }
