# Control of sat_gap.g, one notch tighter: 9u instead of 9.2u. Gappa must fail.

@rnd = float<24, ne>;
oa = rnd(OA + da);
ob = rnd(OB + db);
g1 = rnd(t + f1);
g2 = rnd(ob - oa + f2);
g = rnd(g1 + g2 + f3);
C = OB - OA;
G = t + C;

{ T in [1, 2] /\
  t = T * k1 /\ OA = T * ka /\ OB = T * kb /\ C = T * k2 /\ G = T * kg /\
  |k1| <= 4 /\ |ka| <= 1 /\ |kb| <= 1 /\ |k2| <= 1 /\ |kg| <= 3 /\
  |da| <= 1b-30 /\ |db| <= 1b-30 /\ |f1| <= 1b-30 /\ |f2| <= 1b-30 /\ |f3| <= 1b-30
  -> (g - G) - T * 9b-24 <= 0 }

OA + da - OA -> da; OB + db - OB -> db;
t + f1 - t -> f1;
ob - oa + f2 - C -> (ob - oa - C) + f2;
g1 + g2 + f3 - G -> (g1 + g2 - G) + f3;
oa ~ OA; ob ~ OB; g1 ~ t; g ~ G;
$ T in 64;
