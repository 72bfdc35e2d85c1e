# One coordinate of R x + t in f64 from a computed row r: within 8 * 2^-53 m, m = max(|x|_inf, |t|_inf) in [1, 2] (powers of
# two scale out). A row is a unit vector, so by Cauchy-Schwarz its partial products with |x_i| <= m sum to sqrt(2) m, sqrt(3) m.
# With the entries' own errors (pose_entry.g, LEMMAS.md) the coordinate is within 24 * 2^-53 m.

@rnd = float<53, ne>;
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
  -> (y - Y) - m * 8b-53 <= 0 }

$ m in 64;
