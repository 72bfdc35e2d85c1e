# Control of query_ball.g, one notch tighter: 2^-51. Gappa must fail.

WIDENING = 1b-51;
d = (1 + ed) * (1 + ed) * (1 + es) * (1 + e1) * (1 + e2);
w = 1 + ew;
b = (w + w * WIDENING) * (1 + eb);

{ |ed| <= 1b-53 /\ |es| <= 1b-53 /\ |e1| <= 1b-53 /\ |e2| <= 1b-53 /\ |ew| <= 1b-53 /\ |eb| <= 1b-53
  -> d - b <= 0 }
