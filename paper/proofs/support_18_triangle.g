# Support coefficients of k = 18 for |e| = a >= b >= c >= 0 (others by symmetry) and a <= fl(b + c):
#   fl(fl(a + b) - c) / 2 on (110), fl(fl(a + c) - b) / 2 on (101), fl(fl(b + c) - a) / 2 on (011).
# They are nonnegative and combine to e + d with |d|^2 <= 12.25 u^2 |e|^2. Scaled to a in [1, 2]; f..: flushing (LEMMAS.md).

@rnd = float<24, ne>;
b = a * r; c = b * s;
ab1 = rnd(a + b + f1); ab = rnd(ab1 - c + f2);
ac1 = rnd(a + c + f3); ac = rnd(ac1 - b + f4);
bc1 = rnd(b + c + f5); bc = rnd(bc1 - a + f6);
x = ab - (a + b - c);
y = ac - (a + c - b);
z = bc - (b + c - a);
D = ((x + y) * (x + y) + (x + z) * (x + z) + (y + z) * (y + z)) * 0.25;
N = a * a * (1 + r * r * (1 + s * s));

{ a in [1, 2] /\ r in [0.49, 1] /\ s in [0, 1] /\
  |f1| <= 1b-100 /\ |f2| <= 1b-100 /\ |f3| <= 1b-100 /\ |f4| <= 1b-100 /\ |f5| <= 1b-100 /\ |f6| <= 1b-100
  -> D - N * (0xC.4 * 1b-48) <= 0 }

x -> (ab - (ab1 - c + f2)) + (ab1 - (a + b + f1)) + (f1 + f2);
y -> (ac - (ac1 - b + f4)) + (ac1 - (a + c + f3)) + (f3 + f4);
z -> (bc - (bc1 - a + f6)) + (bc1 - (b + c + f5)) + (f5 + f6);
a + b + f1 -> a * (1 + r) + f1;
a + c + f3 -> a * (1 + r * s) + f3;
b + c + f5 -> b * (1 + s) + f5;
$ a in 6, r in 6, s in 6;
