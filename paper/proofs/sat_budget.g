# All errors of one separating axis together: with the margin 2^-17 = 128u in the slabs, bodies that meet are not culled,
#   fl(ha + hb) >= tau,  in units of T |a| = 1, ra + rb = 1 the shares of the two reaches.
# Sa, Sb: the exact supports, tau* <= Sa + Sb. t: error of tau, tau_dot + sqrt(3) (v_dot + Q's rounding) + sqrt(3) gap.
# da, db: distance of the direction that the coefficients combine from the exact one, A's |a| itself (support only),
# B's sqrt(3) (sqrt(3) product + dot) + support. pa, pb and fa, fb: support_sum.g. Va, Vb: the exact weighted sums,
# at most sqrt(3) of the reach (k = 6; 1.25 for the others); w: what the margin loses because the combined direction isn't of
# length |a| exactly.

margin = 1b-17;
rb = 1 - ra;
t = t1 + 1.732051 * (t2 + t3) + 1.732051 * t4;
db = 1.732051 * (1.732051 * d1 + d2) + d3;
Va = Sa + (margin * (1 - w) - da) * ra;
Vb = Sb + (margin * (1 - w) - db) * rb;
h = ((Va * (1 - pa) - fa) + (Vb * (1 - pb) - fb)) * (1 - e) - f;
tau = Sa + Sb + t;

{ ra in [0, 1] /\ Va = ra * ka /\ Vb = rb * kb /\ ka in [0, 1.7321] /\ kb in [0, 1.7321] /\
  |t1| <= 0x5.21p-24 /\ |t2| <= 0x5.21p-24 /\ |t3| <= 0x1.01p-24 /\ |t4| <= 0x5.21p-24 /\
  |d1| <= 0x6.82p-24 /\ |d2| <= 0x5.21p-24 /\ |d3| <= 0x3.81p-24 /\ |da| <= 0x3.81p-24 /\
  pa in [0, 0x5.02p-24] /\ pb in [0, 0x5.02p-24] /\ fa in [0, 1b-26] /\ fb in [0, 1b-26] /\
  w in [0, 1b-17] /\ e in [0, 1b-24] /\ f in [0, 1b-30]
  -> h - tau >= 0 }

h - tau -> (margin * (1 - w) - da) * ra + (margin * (1 - w) - db) * rb - t
         - (Va * pa + fa + Vb * pb + fb) * (1 - e) - (Va + Vb) * e - f;
$ ra in 8;
