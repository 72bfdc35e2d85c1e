# Control of sat_product.g, one notch tighter: 6u instead of 6.51u. Gappa must fail.

@rnd = float<ieee_32, ne>;
a1 = rnd(A1 + da1); a2 = rnd(A2 + da2); a3 = rnd(A3 + da3);
b1 = rnd(B1 + db1); b2 = rnd(B2 + db2); b3 = rnd(B3 + db3);
p1 = rnd(a1 * b1 + f1);
p2 = rnd(a2 * b2 + f2);
p3 = rnd(a3 * b3 + f3);
s = rnd(p1 + p2 + f4);
m = rnd(s + p3 + f5);
S = A1 * B1 + A2 * B2;
M = S + A3 * B3;

{ |A1| <= 1 /\ |A2| <= 1 /\ |A3| <= 1 /\ |B1| <= 1 /\ |B2| <= 1 /\ |B3| <= 1 /\ |S| <= 1 /\ |M| <= 1 /\
  |da1| <= 1b-48 /\ |da2| <= 1b-48 /\ |da3| <= 1b-48 /\ |db1| <= 1b-48 /\ |db2| <= 1b-48 /\ |db3| <= 1b-48 /\
  |f1| <= 1b-120 /\ |f2| <= 1b-120 /\ |f3| <= 1b-120 /\ |f4| <= 1b-120 /\ |f5| <= 1b-120
  -> |m - M| <= 6b-24 }

A1 + da1 - A1 -> da1; A2 + da2 - A2 -> da2; A3 + da3 - A3 -> da3;
B1 + db1 - B1 -> db1; B2 + db2 - B2 -> db2; B3 + db3 - B3 -> db3;
a1 * b1 + f1 - A1 * B1 -> (a1 * b1 - A1 * B1) + f1;
a2 * b2 + f2 - A2 * B2 -> (a2 * b2 - A2 * B2) + f2;
a3 * b3 + f3 - A3 * B3 -> (a3 * b3 - A3 * B3) + f3;
p1 + p2 + f4 - S -> (p1 + p2 - S) + f4;
s + p3 + f5 - M -> (s + p3 - M) + f5;
a1 ~ A1; a2 ~ A2; a3 ~ A3; b1 ~ B1; b2 ~ B2; b3 ~ B3;
p1 ~ A1 * B1; p2 ~ A2 * B2; p3 ~ A3 * B3; s ~ S;
