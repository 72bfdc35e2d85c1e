# Control of support_26.g, one notch tighter: |d| <= u |e| instead of sqrt(2) u |e|. Gappa must fail.

@rnd = float<24, ne>;
b = a * r; c = b * s;
pair = rnd(b - c + f1);
lead = rnd(a - b + f2);
x = pair - (b - c);
y = lead - (a - b);
D = (x + y) * (x + y) + x * x;
N = a * a * (1 + r * r * (1 + s * s));

{ a in [1, 2] /\ r in [0, 1] /\ s in [0, 1] /\ |f1| <= 1b-100 /\ |f2| <= 1b-100
  -> D - N * (1 * 1b-48) <= 0 }

x -> (pair - (b - c + f1)) + f1;
y -> (lead - (a - b + f2)) + f2;
b - c -> b * (1 - s);
a - b -> a * (1 - r);
$ a in 3, r in 3, s in 3;
