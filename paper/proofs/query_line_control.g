# Control of query_line.g, one notch tighter: 2^-51. Gappa must fail.
WIDENING = 1b-51;
s = (1 + ed) * (1 + ei) * (1 + es);
t = (s - s * WIDENING) * (1 + et);
l = (s + s * WIDENING) * (1 + et);

{ |ed| <= 1b-53 /\ |ei| <= 1b-53 /\ |es| <= 1b-53 /\ |ev| <= 1b-53 /\ |et| <= 1b-53
  -> t - (1 + ev) <= 0 /\ l - (1 + ev) >= 0 }
