# Control of finder.g, one notch tighter: the factor 1 + 4u instead of 1 + 16u. Gappa must fail.

u = 1b-24;
t = S * S * (1 + e3) * (1 + e3) * (1 + e4) + h1;
kappa = (1 + e5) * (1 + e5) * (1 + e6) * (1 + e7) * (1 + e8);
D = (t + h2) * kappa;
floor = 1b-77;
factor = 1 + 4 * u;
W = S * factor + floor;

{ S in [1b-70, 1b63] /\
  |e3| <= 1b-24 /\ |e4| <= 1b-24 /\
  |e5| <= 0x1.000002p-24 /\ |e6| <= 0x1.000002p-24 /\ |e7| <= 0x1.000002p-24 /\ |e8| <= 0x1.000002p-24 /\
  h1 in [0, 1b-149] /\ h2 in [0, 1b-148]
  -> W * W - D >= 0 }

W * W - D -> S * (S * (factor * factor - (1 + e3) * (1 + e3) * (1 + e4) * kappa) + 2 * floor * factor)
           + (floor * floor - (h1 + h2) * kappa);
