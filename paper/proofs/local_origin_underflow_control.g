# Control of local_origin_underflow.g, one notch tighter: the floor 2^-150 instead of 2^-149. Gappa must fail.

@f64 = float<53, -1074, ne>;
@f32 = float<24, -149, ne>;
root = 0x1.bb67bp0; # above sqrt(3)
floor = 1b-150;
local = f32(f64(D));

{ D in [0, 1b-125] -> root * |local - D| - floor <= 0 }
