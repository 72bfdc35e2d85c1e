# Control of sphere_excess.g, one notch tighter: 14u instead of 15u. Gappa must fail.

u = 1b-24;
alpha = (1 + 8 * u) * (1 + e1) * (1 + e2) * (1 + e3);
beta = 2 * 1b-70 * (1 + e2) * (1 + e3);
S = P * alpha + beta;
t = S * S * (1 + e4) + h1;
kappa = (1 + e5) * (1 + e5) * (1 + e6) * (1 + e7) * (1 + e8);
D = (t + h2) * kappa;
factor = 1 + 14 * u;
B = P * factor + 1b-68;

{ P in [0, 1b62] /\
  |e1| <= 1b-24 /\ |e2| <= 1b-24 /\ |e3| <= 1b-24 /\ |e4| <= 1b-24 /\
  |e5| <= 0x1.000002p-24 /\ |e6| <= 0x1.000002p-24 /\ |e7| <= 0x1.000002p-24 /\ |e8| <= 0x1.000002p-24 /\
  h1 in [0, 1b-149] /\ h2 in [0, 1b-148]
  -> B * B - D >= 0 }

B * B - D -> P * P * (factor * factor - alpha * alpha * (1 + e4) * kappa)
           + P * 2 * (factor * 1b-68 - alpha * beta * (1 + e4) * kappa)
           + (1b-136 - (beta * beta * (1 + e4) + h1 + h2) * kappa);
