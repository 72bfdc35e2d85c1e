# The place of a far mesh's vertices: a coordinate of t + R o in f64 from a computed row r, o and t any f64, as in pose_point.g, with
# m = max(|o|_inf, |t|_inf) in [1, 2]. The row's own entries bring up to 16 * 2^-53 m (pose_entry.g, LEMMAS.md), and three such
# coordinates sqrt(3) times one. `compose` says OFFSET_ERROR m, in f64.

@rnd = float<53, ne>;
OFFSET_ERROR = 1b-47;
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
