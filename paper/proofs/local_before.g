# A body whose f64 translation lies D from its region's origin along an axis is at far = f64(D) before the corner is
# subtracted. `Region::place` adds MOVED_BEFORE times the largest |far|, more than sqrt(3) times what an axis moves by. Below
# the range differences of f64 are exact, as all f64 are multiples of 2^-1074.

@f64 = float<53, -1074, ne>;
MOVED_BEFORE = 1b-52;
root = 0x1.bb67bp0; # above sqrt(3)
far = f64(D);

{ D in [1b-1000, 1b62]
  -> root * |(far - D) / far| - MOVED_BEFORE * (1 - 1b-49) <= 0 }

(far - D) / far -> ((far - D) / D) / (1 + (far - D) / D) { D <> 0, far <> 0 };
