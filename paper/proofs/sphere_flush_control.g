# Control of sphere_flush.g, one notch tighter: R = r (1 + 2u) without a floor to speak of. Gappa must fail.

u = 1b-24;
gain = 2 * u; floor = 1b-150;
alpha = (1 + gain) * (1 + e1) * (1 + e2);
beta = 2 * floor * (1 + e2) - g1;
P = (s / (1 + e3) - beta) / alpha;
d2 = (P + g2) * (P + g2) * ((1 + e5) * (1 + e5) * (1 + e6) * (1 + e7) * (1 + e8));

{ s in [1b-70, 1b-63] /\ P >= 0 /\
  |e1| <= 1b-24 /\ |e2| <= 1b-24 /\ |e3| <= 1b-24 /\
  |e5| <= 1b-24 /\ |e6| <= 1b-24 /\ |e7| <= 1b-24 /\ |e8| <= 1b-24 /\
  g1 in [0, 1b-124] /\ g2 in [0, 1b-124]
  -> d2 <= 0xFFFFFFp-150 }
