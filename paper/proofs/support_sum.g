# The weighted sum of slab ends, all terms >= 0, in the deepest of the four summation trees (k = 14: a product and at most four
# additions above it): computed >= (1 - 5.01u) exact - 2^-26. w: exact products; e: roundings, f: flushing, scaled so that
# the sum is at most 2 (LEMMAS.md). k = 6, 18 and 26 are no deeper.

p0 = w0 * (1 + e0) + f0;
p1 = w1 * (1 + e1) + f1; p2 = w2 * (1 + e2) + f2; p3 = w3 * (1 + e3) + f3;
l1 = w4 * (1 + e4) + f4; l2 = w5 * (1 + e5) + f5; l3 = w6 * (1 + e6) + f6;
b1 = (p1 + p2) * (1 + a1) + g1;
b2 = (b1 + p3) * (1 + a2) + g2;
c1 = (p0 + b2) * (1 + a3) + g3;
c2 = (l1 + l2) * (1 + a4) + g4;
c3 = (c2 + l3) * (1 + a5) + g5;
v = (c1 + c3) * (1 + a6) + g6;
k = 1 - 0x5.02p-24;
V = w0 + w1 + w2 + w3 + w4 + w5 + w6;

{ w0 in [0, 2] /\ w1 in [0, 2] /\ w2 in [0, 2] /\ w3 in [0, 2] /\ w4 in [0, 2] /\ w5 in [0, 2] /\ w6 in [0, 2] /\
  |e0| <= 1b-24 /\ |e1| <= 1b-24 /\ |e2| <= 1b-24 /\ |e3| <= 1b-24 /\ |e4| <= 1b-24 /\ |e5| <= 1b-24 /\ |e6| <= 1b-24 /\
  |a1| <= 1b-24 /\ |a2| <= 1b-24 /\ |a3| <= 1b-24 /\ |a4| <= 1b-24 /\ |a5| <= 1b-24 /\ |a6| <= 1b-24 /\
  |f0| <= 1b-30 /\ |f1| <= 1b-30 /\ |f2| <= 1b-30 /\ |f3| <= 1b-30 /\ |f4| <= 1b-30 /\ |f5| <= 1b-30 /\ |f6| <= 1b-30 /\
  |g1| <= 1b-30 /\ |g2| <= 1b-30 /\ |g3| <= 1b-30 /\ |g4| <= 1b-30 /\ |g5| <= 1b-30 /\ |g6| <= 1b-30
  -> v - V * k >= -1b-26 }

v - V * k ->
    w0 * ((1 + e0) * (1 + a3) * (1 + a6) - k)
  + w1 * ((1 + e1) * (1 + a1) * (1 + a2) * (1 + a3) * (1 + a6) - k)
  + w2 * ((1 + e2) * (1 + a1) * (1 + a2) * (1 + a3) * (1 + a6) - k)
  + w3 * ((1 + e3) * (1 + a2) * (1 + a3) * (1 + a6) - k)
  + w4 * ((1 + e4) * (1 + a4) * (1 + a5) * (1 + a6) - k)
  + w5 * ((1 + e5) * (1 + a4) * (1 + a5) * (1 + a6) - k)
  + w6 * ((1 + e6) * (1 + a5) * (1 + a6) - k)
  + ((f0 + g2 + (g1 + f3 + (f1 + f2) * (1 + a1)) * (1 + a2)) * (1 + a3) + g3
     + (g4 + f6 + (f4 + f5) * (1 + a4)) * (1 + a5) + g5) * (1 + a6) + g6;
