# Control of support_14.g, one notch tighter: |d| <= u |e| instead of sqrt(3) u |e|. Gappa must fail.

@rnd = float<24, ne>;
b = a * r; c = b * s;
base = rnd(b + c + f1);
bent = rnd(b - c + f2);
lead = rnd(a - b + f3);
x = base - (b + c);
y = bent - (b - c);
z = lead - (a - b);
D = ((x + y) * 0.5 + z) * ((x + y) * 0.5 + z) + (x * x + y * y) * 0.5;
N = a * a * (1 + r * r * (1 + s * s));

{ a in [1, 2] /\ r in [0, 1] /\ s in [0, 1] /\ |f1| <= 1b-100 /\ |f2| <= 1b-100 /\ |f3| <= 1b-100
  -> D - N * (1 * 1b-48) <= 0 }

x -> (base - (b + c + f1)) + f1;
y -> (bent - (b - c + f2)) + f2;
z -> (lead - (a - b + f3)) + f3;
b + c -> b * (1 + s);
b - c -> b * (1 - s);
a - b -> a * (1 - r);
$ a in 2, r in 2, s in 2;
