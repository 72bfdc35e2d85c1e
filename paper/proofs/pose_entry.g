# Entries of the rotation matrix in f64, from a quaternion of any norm; products of two f32 are exact. In units of 2^-53:
# an off-diagonal entry errs by at most 6.01 of itself, a diagonal one by 7.2.
# m is the share of xx + yy in |q|^2, so that |xx - yy| <= m |q|^2 and |ww - zz| <= (1 - m) |q|^2.

@rnd = float<53, ne>;
xx = x * x; yy = y * y; zz = z * z; ww = w * w;
n rnd= ((xx + yy) + zz) + ww;
N = ((xx + yy) + zz) + ww;
o = rnd(1 / n);
O = 1 / N;

P = xx - yy; p = rnd(P);
Q = ww - zz; q = rnd(Q);
Num = P + Q; num = rnd(p + q);
Diagonal = Num / N;
diagonal = rnd(num * o);

Off = 2 * (x * y - w * z) * O;
off = rnd(2 * rnd(x * y - w * z) * o);

{ N <> 0 /\ n <> 0 /\ xx + yy <> 0 /\ (xx + yy) + zz <> 0 /\
  xx / (xx + yy) in [0, 1] /\ (xx + yy) / ((xx + yy) + zz) in [0, 1] /\ ((xx + yy) + zz) / N in [0, 1] /\
  m in [0, 1] /\ P / N = m * s1 /\ |s1| <= 1 /\ Q / N = (1 - m) * s2 /\ |s2| <= 1 /\ |Num / N| <= 1
  -> |off -/ Off| <= 0x6.01p-53 /\ |diagonal - Diagonal| <= 0x7.3p-53 }

(num - Num) / N -> ((p - P) / N + (q - Q) / N) + (num - (p + q)) / N { N <> 0 };
(p + q) / N -> (P / N + (p - P) / N) + (Q / N + (q - Q) / N) { N <> 0 };
num * o - Diagonal -> ((num - Num) / N + Diagonal * ((o - O) / O)) + (num - Num) / N * ((o - O) / O) { N <> 0 };
$ m in 64;
