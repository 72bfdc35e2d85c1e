# Control of pose_refit.g, one notch tighter: the margin 2^-47 instead of 2^-46. Gappa must fail.

@rnd = float<53, ne>;
k = 1b-47;
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
