# Control of sat_dot.g, one notch tighter: 5u instead of 5.2u. Gappa must fail.

@rnd = float<24, ne>;
p1 = rnd(x1 * y1 + f1);
p2 = rnd(x2 * y2 + f2);
p3 = rnd(x3 * y3 + f3);
s = rnd(p1 + p2 + f4);
v = rnd(s + p3 + f5);
S = x1 * y1 + x2 * y2;
V = S + x3 * y3;

{ T in [1, 2] /\
  x1 * y1 = T * k1 /\ x2 * y2 = T * k2 /\ x3 * y3 = T * k3 /\ S = T * ks /\ V = T * kv /\
  |k1| <= 0x1.0001p0 /\ |k2| <= 0x1.0001p0 /\ |k3| <= 0x1.0001p0 /\ |ks| <= 0x1.0001p0 /\ |kv| <= 0x1.0001p0 /\
  |f1| <= 1b-30 /\ |f2| <= 1b-30 /\ |f3| <= 1b-30 /\ |f4| <= 1b-30 /\ |f5| <= 1b-30
  -> (v - V) - T * 5b-24 <= 0 }

x1 * y1 + f1 - x1 * y1 -> f1; x2 * y2 + f2 - x2 * y2 -> f2; x3 * y3 + f3 - x3 * y3 -> f3;
p1 + p2 + f4 - S -> (p1 + p2 - S) + f4;
s + p3 + f5 - V -> (s + p3 - V) + f5;
p1 ~ x1 * y1; p2 ~ x2 * y2; p3 ~ x3 * y3; s ~ S; v ~ V;
$ T in 64;
