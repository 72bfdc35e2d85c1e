# The sphere test never culls when the exact distance is within the exact sum of the stored radii, up to 8u:
#   D <= Q (1 - 8u)  =>  d2 <= t,   D = |a - b|^2, Q = (Ra + Rb)^2.
# 5u of the 8 belong to d2, 3u to t. No underflow here: sphere_underflow.g and sphere_flush.g.

@rnd = float<24, ne>;
ax = rnd(ax_); ay = rnd(ay_); az = rnd(az_);
bx = rnd(bx_); by = rnd(by_); bz = rnd(bz_);
Ra = rnd(Ra_); Rb = rnd(Rb_);

dx rnd= ax - bx; dy rnd= ay - by; dz rnd= az - bz;
d2 rnd= (dx * dx + dy * dy) + dz * dz;
s rnd= Ra + Rb;
t rnd= s * s;

X = ax - bx; Y = ay - by; Z = az - bz;
D = (X * X + Y * Y) + Z * Z;
Q = (Ra + Rb) * (Ra + Rb);

# Partial sums of squares are shares of the whole.
{ X * X / (X * X + Y * Y) in [0, 1] /\ X * X + Y * Y <> 0 /\
  (X * X + Y * Y) / D in [0, 1] /\ D <> 0 /\ Q <> 0 /\
  D / Q in [0, 0xFFFFF8p-24]
  -> d2 / t <= 1 }

d2 / t -> (d2 / D) * (D / Q) / (t / Q) { D <> 0, Q <> 0, t <> 0 };
d2 / D -> 1 + (d2 - D) / D { D <> 0 };
t / Q -> 1 + (t - Q) / Q { Q <> 0 };
