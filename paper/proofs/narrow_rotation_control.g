# Control of narrow_rotation.g, one notch tighter: (1 - 2^-24) u instead of (1 + 2^-24) u. Gappa must fail.

@f64 = float<53, -1074, ne>;
@f32 = float<24, -149, ne>;
most = 0x1.fffffep-25;
x = f64(X);
narrow = f32(x);
quotient = f64(Q);
divided = f32(quotient);

{ x in [1b-125, 1b60] /\ Q in [1b-125, 1]
  -> |(narrow - x) / x| - most <= 0 /\ |(divided - Q) / Q| - most <= 0 }

(divided - Q) / Q -> (divided - quotient) / quotient * (1 + (quotient - Q) / Q) + (quotient - Q) / Q { Q <> 0, quotient <> 0 };
