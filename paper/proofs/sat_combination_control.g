# Control of sat_combination.g, one notch tighter: 1.63u instead of 1.7u. Gappa must fail.

@rnd = float<24, ne>;
s = rnd(x + y + f1);
v = rnd(s + z + f2);
S = x + y;
V = S + z;

{ T in [1, 2] /\ S = T * ks /\ V = T * kv /\ |ks| <= 1.41424 /\ |kv| <= 1.7321 /\ |f1| <= 1b-30 /\ |f2| <= 1b-30
  -> (v - V) - T * (1.732051 * 0x1.Ap-24) <= 0 }

x + y + f1 - S -> f1;
s + z + f2 - V -> (s - S) + f2;
s ~ S; v ~ V;
$ T in 64;
