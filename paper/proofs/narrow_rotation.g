# A component q of a quaternion in f64 becomes f32(q), or f32(f64(q / largest)) where the largest is of extraordinary size (`narrow`).
# Either way it is within (1 + 2^-24) u of the exact one, u = 2^-24, where f32 is normal; below that it is off by 2^-126, which LEMMAS.md
# adds, and a negative one as its opposite. Of all four, the error's norm is then as small a share of the quaternion's. Q is the exact quotient.

@f64 = float<53, -1074, ne>;
@f32 = float<24, -149, ne>;
most = 0x1.000001p-24;
x = f64(X);
narrow = f32(x);
quotient = f64(Q);
divided = f32(quotient);

{ x in [1b-125, 1b60] /\ Q in [1b-125, 1]
  -> |(narrow - x) / x| - most <= 0 /\ |(divided - Q) / Q| - most <= 0 }

(divided - Q) / Q -> (divided - quotient) / quotient * (1 + (quotient - Q) / Q) + (quotient - Q) / Q { Q <> 0, quotient <> 0 };
