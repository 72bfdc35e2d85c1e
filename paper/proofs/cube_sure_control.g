# Control of cube_sure.g, one notch tighter: H1 + H2 times 1 - 4u instead of 1 - 16u. Gappa must fail.

u = 1b-24;
narrower = 1 - 4 * u;
wider = 1 + 16 * u;
I = T * ((1 - q * (1 + e4)) * (1 + e5)) - f1;
D = T * (((1 + e0) * narrower * (1 + e1) - q * wider * (1 + e7)) * (1 + e2) * (1 + e6)) - floor;

{ T in [0, 1b127] /\ q in [0, 0x1.001p0] /\ floor in [1b-100, 1b-98] /\ f1 in [0, 1b-122] /\
  |e0| <= 1b-24 /\ |e1| <= 1b-24 /\ |e2| <= 1b-24 /\ |e4| <= 0x1.000002p-24 /\ |e5| <= 0x1.000002p-24 /\
  |e6| <= 0x1.000002p-24 /\ |e7| <= 0x1.000002p-23
  -> I - D >= 0 }

I - D -> T * ((1 - narrower) + q * (wider - 1) - q * e4 + (1 - q * (1 + e4)) * e5 - narrower * (e0 + e1 + e0 * e1) + q * (wider * e7)
              - ((1 + e0) * narrower * (1 + e1) - q * wider * (1 + e7)) * (e2 + e6 + e2 * e6)) + (floor - f1);
