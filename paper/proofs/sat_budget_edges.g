# As sat_budget_normals.g, along an axis edge x edge: any computed vector a, both supports by weak duality. Polytopes that meet
# are not culled: they have |G| <= sqrt(3) T, and a point of either is within sqrt(3) of its share.
# t: the dot products tau and v, Q's rounding, the gap. da, db: as there, A's direction being |a| itself (support only) and
# B's e = M a a dot product.

margin = 1b-17;
rb = 1 - ra;
t = 1.7321 * (t1 + 1.7321 * (t1 + t2) + t4);
d = (1.7321 * (1.7321 * d1 + d2) + d3) * 1.7321;
c = d3 * 1.7321;
Va = Sa + (margin * (1 - w) - c) * ra;
Vb = Sb + (margin * (1 - w) - d) * rb;
h = ((Va * (1 - p) - fa) + (Vb * (1 - p) - fb)) * (1 - e) - f;
tau = Sa + Sb + t;

{ ra in [0, 1] /\ Va = ra * ka /\ ka in [0, 1.7321] /\ Vb = rb * kb /\ kb in [0, 1.7321] /\
  |t1| <= 0x5.21p-24 /\ |t2| <= 0x1.01p-24 /\ |t4| <= 0x9.21p-24 /\
  |d1| <= 0x6.82p-24 /\ |d2| <= 0x5.21p-24 /\ |d3| <= 0x3.81p-24 /\
  p in [0, 0x5.02p-24] /\ fa in [0, 1b-26] /\ fb in [0, 1b-26] /\ w in [0, 1b-17] /\ e in [0, 1b-24] /\ f in [0, 1b-30]
  -> h - tau >= 0 }

h - tau -> (margin * (1 - w) - c) * ra + (margin * (1 - w) - d) * rb - t
         - (Va * p + fa + Vb * p + fb) * (1 - e) - (Va + Vb) * e - f;
$ ra in 8;
