# An entry of Q before its rounding to f32, fl(v * fl(1 / n)): v a coordinate of R b in f64 for a basis vector b (within 24 * 2^-53 |b|,
# pose_point.g with t = 0), n = fl(sqrt(.)) its norm from exact products. Within 2^-48 of the exact entry K.

@rnd = float<53, ne>;
xx = x * x; yy = y * y; zz = z * z;
square rnd= (xx + yy) + zz;
Square = (xx + yy) + zz;
n = rnd(sqrt(square));
N = sqrt(Square);
v = N * (K + e);
o = rnd(1 / n);
q = rnd(v * o);

{ Square in [0x1p-4, 4] /\ xx + yy <> 0 /\ xx / (xx + yy) in [0, 1] /\ (xx + yy) / Square in [0, 1] /\
  |K| <= 1 /\ |e| <= 24b-53
  -> |q - K| <= 1b-48 }

v / n -> (K + e) / (1 + (n - N) / N) { n <> 0, N <> 0, 1 + (n - N) / N <> 0 };
(K + e) / (1 + (n - N) / N) - K -> (e - K * ((n - N) / N)) / (1 + (n - N) / N) { N <> 0, 1 + (n - N) / N <> 0 };
v * o - v / n -> v / n * ((o - 1 / n) / (1 / n)) { n <> 0 };
q - K -> (q - v * o) + (v * o - v / n) + ((K + e) / (1 + (n - N) / N) - K) { n <> 0, N <> 0, 1 + (n - N) / N <> 0 };
