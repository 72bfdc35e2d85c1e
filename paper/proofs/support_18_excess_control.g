# Control of support_18_excess.g, one notch tighter: |d|^2 <= 6 u^2 |e|^2 instead of 12.25. Gappa must fail.

@rnd = float<24, ne>;
b = a * q * p; c = a * q * (1 - p);
S = rnd(b + c + f1);
ab1 = rnd(S + b + f2); ab = rnd(ab1 - c + f3);
ac1 = rnd(S + c + f4); ac = rnd(ac1 - b + f5);
lead = rnd(a - S + f6);
x = ab - (S + b - c);
y = ac - (S + c - b);
z = lead - (a - S);
w = S - (b + c);
D = ((x + y) * 0.5 + z) * ((x + y) * 0.5 + z) + ((x + w) * (x + w) + (y + w) * (y + w)) * 0.25;
N = a * a * (1 + q * q * (p * p + (1 - p) * (1 - p)));
{ a in [1, 2] /\ q in [0, 0x1.00001p0] /\ p in [0.5, 1] /\
  |f1| <= 1b-100 /\ |f2| <= 1b-100 /\ |f3| <= 1b-100 /\ |f4| <= 1b-100 /\ |f5| <= 1b-100 /\ |f6| <= 1b-100
  -> D - N * (6 * 1b-48) <= 0 }
x -> (ab - (ab1 - c + f3)) + (ab1 - (S + b + f2)) + (f2 + f3);
y -> (ac - (ac1 - b + f5)) + (ac1 - (S + c + f4)) + (f4 + f5);
z -> (lead - (a - S + f6)) + f6;
w -> (S - (b + c + f1)) + f1;
b + c -> a * q;
S + b + f2 -> a * q * (1 + p) + w + f2;
S + c + f4 -> a * q * (2 - p) + w + f4;
ab1 - c + f3 -> 2 * b + w + (ab1 - (S + b + f2)) + f2 + f3;
ac1 - b + f5 -> 2 * c + w + (ac1 - (S + c + f4)) + f4 + f5;
a - S + f6 -> a * (1 - q) - w + f6;
$ a in 6, q in 6, p in 6;
