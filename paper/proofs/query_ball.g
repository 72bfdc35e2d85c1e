# Whether a point is beyond a radius from a box (`is_beyond`), in f64, as multiples: of the exact squared distance D the computed one is at
# most (1 + ed)^2 (1 + es)(1 + e1)(1 + e2), since every term is positive, and of the exact squared radius Q the bound is at least what
# follows. If D is no more than Q, the computed distance is no more than the bound. What underflows is below QUERY_FLOOR.

WIDENING = 1b-50;
d = (1 + ed) * (1 + ed) * (1 + es) * (1 + e1) * (1 + e2);
w = 1 + ew;
b = (w + w * WIDENING) * (1 + eb);

{ |ed| <= 1b-53 /\ |es| <= 1b-53 /\ |e1| <= 1b-53 /\ |e2| <= 1b-53 /\ |ew| <= 1b-53 /\ |eb| <= 1b-53
  -> d - b <= 0 }
