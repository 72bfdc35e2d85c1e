# A world-aligned slab end before its last rounding to f32: the margin 2^-46 m = 128 * 2^-53 m exceeds all errors, so
#   fl(d~ + 2^-46 m) >= d,  d = c.(R x + t) exact with c in {-1, 0, 1}^3, d~ the computed extreme.
# A coordinate errs by 24 * 2^-53 m and is at most (1 + sqrt(3)) m, |x| <= rho <= m; scaled to m in [1, 2].

@rnd = float<53, ne>;
k = 1b-46;
margin = k * m;
x = X + ex * m; y = Y + ey * m; z = Z + ez * m;
s = rnd(x + y);
a = rnd(s + z);
hi = rnd(a + margin);
A = X + Y + Z;

{ m in [1, 2] /\
  X = m * kx /\ Y = m * ky /\ Z = m * kz /\ |kx| <= 2.73206 /\ |ky| <= 2.73206 /\ |kz| <= 2.73206 /\
  |ex| <= 24b-53 /\ |ey| <= 24b-53 /\ |ez| <= 24b-53
  -> hi - A >= 0 }

hi - A -> (hi - (a + margin)) + (a - (s + z)) + (s - (x + y)) + m * (ex + ey + ez + k);
$ m in 16;
