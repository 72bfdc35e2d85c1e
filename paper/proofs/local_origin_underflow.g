# local_origin.g where f32 is subnormal: sqrt(3) times what an axis moves by is less than the floor 2^-149.

@f64 = float<53, -1074, ne>;
@f32 = float<24, -149, ne>;
root = 0x1.bb67bp0; # above sqrt(3)
floor = 1b-149;
local = f32(f64(D));

{ D in [0, 1b-125] -> root * |local - D| - floor <= 0 }
