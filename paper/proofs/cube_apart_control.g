# Control of cube_apart.g, one notch tighter: the factor 1 + 4u instead of 1 + 16u. Gappa must fail.

u = 1b-24;
floor = 1b-100;
factor = 1 + 4 * u;
H = S * (1 + e2) * (1 + e3) * factor + 2 * floor - f2;
reach = H * (1 + e4) * (1 + e5) - f3;
D = S * (1 + e1) + f1;

{ S in [0, 1b127] /\
  |e1| <= 1b-24 /\ |e2| <= 1b-24 /\ |e3| <= 1b-24 /\ |e4| <= 1b-24 /\ |e5| <= 1b-24 /\
  f1 in [0, 1b-126] /\ f2 in [0, 1b-123] /\ f3 in [0, 1b-124]
  -> reach - D >= 0 }

reach - D -> S * ((1 + e2) * (1 + e3) * (1 + e4) * (1 + e5) * factor - (1 + e1))
           + ((2 * floor - f2) * (1 + e4) * (1 + e5) - f3 - f1);
