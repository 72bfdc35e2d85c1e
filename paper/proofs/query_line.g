# The parameter at which a line comes to an end of a box or slab (`crossing`), in f64, as a multiple of the exact one, d / v:
#   s = d (1 + ed) * (1 + ei) / (v (1 + ev)) * (1 + es),
# as a segment's speed is the difference of two points, and the quotient a product. What is widened and rounded again is no later than the
# exact one at one end, and no earlier at the other. Multiplying by 2^-50 rounds nothing; what underflows is below QUERY_FLOOR.

WIDENING = 1b-50;
s = (1 + ed) * (1 + ei) * (1 + es);
t = (s - s * WIDENING) * (1 + et);
l = (s + s * WIDENING) * (1 + et);

{ |ed| <= 1b-53 /\ |ei| <= 1b-53 /\ |es| <= 1b-53 /\ |ev| <= 1b-53 /\ |et| <= 1b-53
  -> t - (1 + ev) <= 0 /\ l - (1 + ev) >= 0 }
