# A slab normal's combination of three numbers, fl(fl(x + y) + z) with signs: within 1.7u |a| T of the exact x + y + z, |a| = sqrt(3),
# for (x, y, z) of norm T; two numbers alone, |a| = sqrt(2), err less. By Cauchy-Schwarz |x + y| <= sqrt(2) T, |x + y + z| <= sqrt(3) T
# (2^-16 of slack). Scaled to T in [1, 2]; f..: what flushing changes (LEMMAS.md).

@rnd = float<24, ne>;
s = rnd(x + y + f1);
v = rnd(s + z + f2);
S = x + y;
V = S + z;

{ T in [1, 2] /\ S = T * ks /\ V = T * kv /\ |ks| <= 1.41424 /\ |kv| <= 1.7321 /\ |f1| <= 1b-30 /\ |f2| <= 1b-30
  -> (v - V) - T * (1.732051 * 0x1.Bp-24) <= 0 }

x + y + f1 - S -> f1;
s + z + f2 - V -> (s - S) + f2;
s ~ S; v ~ V;
$ T in 64;
