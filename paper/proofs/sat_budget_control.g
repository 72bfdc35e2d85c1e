# Control of sat_budget.g, one notch tighter: the margin 2^-18 = 64u instead of 2^-17. Gappa must fail.

margin = 1b-18;
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
