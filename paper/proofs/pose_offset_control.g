# Control of pose_offset.g, one notch tighter: 2^-48. Gappa must fail.

@rnd = float<53, ne>;
OFFSET_ERROR = 1b-48;
root = 0x1.bb67bp0; # above sqrt(3)
p = rnd(r1 * x1); q = rnd(r2 * x2); v = rnd(r3 * x3);
s = rnd(p + q);
w = rnd(s + v);
y = rnd(w + t);
S = r1 * x1 + r2 * x2;
W = S + r3 * x3;
Y = W + t;

{ m in [1, 2] /\
  r1 * x1 = m * k1 /\ r2 * x2 = m * k2 /\ r3 * x3 = m * k3 /\ S = m * ks /\ W = m * kw /\ Y = m * ky /\
  |k1| <= 0x1.00001p0 /\ |k2| <= 0x1.00001p0 /\ |k3| <= 0x1.00001p0 /\
  |ks| <= 1.41422 /\ |kw| <= 1.73206 /\ |ky| <= 2.73206
  -> root * ((y - Y) + m * 16b-53) - rnd(m * OFFSET_ERROR) <= 0 }

$ m in 64;
