# A body at D from the local origin along an axis, D = f64(t - origin) - corner, is placed at local = f32(f64(D)). Where it lies
# farthest, `Region::place` says moved = f64(f64(f64(D) 2^-23) + 2^-149), no less than D 2^-23 (1 - 2^-50) and more than sqrt(3) times
# what an axis moves by. Normal f32 here; subnormal ones are in local_origin_underflow.g.

@f64 = float<53, -1074, ne>;
@f32 = float<24, -149, ne>;
MOVED = 1b-23;
root = 0x1.bb67bp0; # above sqrt(3)
far = f64(D);
local = f32(far);
product = f64(far * MOVED);

{ D in [1b-125, 1b61]
  -> root * |(local - D) / D| - MOVED * (1 - 1b-49) <= 0 /\ (product - D * MOVED) / (D * MOVED) >= -0x1p-50 }

(local - D) / D -> (local - far) / far * (1 + (far - D) / D) + (far - D) / D { D <> 0, far <> 0 };
(product - D * MOVED) / (D * MOVED) -> (product - far * MOVED) / (far * MOVED) * (1 + (far - D) / D) + (far - D) / D { D <> 0, far <> 0 };
