# Control of local_origin.g, one notch tighter: MOVED = 2^-24 instead of 2^-23. Gappa must fail.

@f64 = float<53, -1074, ne>;
@f32 = float<24, -149, ne>;
MOVED = 1b-24;
root = 0x1.bb67bp0; # above sqrt(3)
far = f64(D);
local = f32(far);
product = f64(far * MOVED);

{ D in [1b-125, 1b61]
  -> root * |(local - D) / D| - MOVED * (1 - 1b-49) <= 0 /\ (product - D * MOVED) / (D * MOVED) >= -0x1p-50 }

(local - D) / D -> (local - far) / far * (1 + (far - D) / D) + (far - D) / D { D <> 0, far <> 0 };
(product - D * MOVED) / (D * MOVED) -> (product - far * MOVED) / (far * MOVED) * (1 + (far - D) / D) + (far - D) / D { D <> 0, far <> 0 };
