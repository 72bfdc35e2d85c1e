# Control of local_before.g, one notch tighter: MOVED_BEFORE = 2^-53 instead of 2^-52. Gappa must fail.

@f64 = float<53, -1074, ne>;
MOVED_BEFORE = 1b-53;
root = 0x1.bb67bp0; # above sqrt(3)
far = f64(D);

{ D in [1b-1000, 1b62]
  -> root * |(far - D) / far| - MOVED_BEFORE * (1 - 1b-49) <= 0 }

(far - D) / far -> ((far - D) / D) / (1 + (far - D) / D) { D <> 0, far <> 0 };
