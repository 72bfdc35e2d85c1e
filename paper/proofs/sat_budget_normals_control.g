# Control of sat_budget_normals.g, one notch tighter: a margin of 104u instead of 128u. Gappa must fail.

margin = 0x.Dp-17;
rb = 1 - ra;
t = 3 * (1.7321 * (t1 + t2) + t3) + 1.7321 * t4;
d = (1.7321 * (1.7321 * d1 + d2) + d3) * 1.7321;
Vb = Sb + (margin * (1 - w) - d) * rb;
h = ((Sa + margin * ra) + (Vb * (1 - p) - fb)) * (1 - e) - f;
tau = Sa + Sb + t;

{ ra in [0, 1] /\ Sa = ra * ka /\ ka in [0, 1.0001] /\ Vb = rb * kb /\ kb in [0, 1.7321] /\
  |t1| <= 0x5.21p-24 /\ |t2| <= 0x1.01p-24 /\ |t3| <= 0x1.B1p-24 /\ |t4| <= 0x9.21p-24 /\
  |d1| <= 0x6.82p-24 /\ |d2| <= 0x1.B1p-24 /\ |d3| <= 0x3.81p-24 /\
  p in [0, 0x5.02p-24] /\ fb in [0, 1b-26] /\ w in [0, 1b-17] /\ e in [0, 1b-24] /\ f in [0, 1b-30]
  -> h - tau >= 0 }

h - tau -> margin * ra + (margin * (1 - w) - d) * rb - t - (Vb * p + fb) * (1 - e) - (Sa + margin * ra + Vb) * e - f;
$ ra in 8;
