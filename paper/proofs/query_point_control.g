# Control of query_point.g, one notch tighter: 2^-49. Gappa must fail.

@rnd = float<53, ne>;
BODY_ERROR = 1b-49;
p = rnd(r1 * x1); q = rnd(r2 * x2); v = rnd(r3 * x3);
s = rnd(p + q);
y = rnd(s + v);
S = r1 * x1 + r2 * x2;
Y = S + r3 * x3;

{ m in [1, 2] /\
  r1 * x1 = m * k1 /\ r2 * x2 = m * k2 /\ r3 * x3 = m * k3 /\ S = m * ks /\ Y = m * ky /\
  |k1| <= 0x1.00001p0 /\ |k2| <= 0x1.00001p0 /\ |k3| <= 0x1.00001p0 /\
  |ks| <= 1.41422 /\ |ky| <= 1.73206
  -> (y - Y) + m * (17.7321 * 1b-53) - m * BODY_ERROR <= 0 }

$ m in 64;
