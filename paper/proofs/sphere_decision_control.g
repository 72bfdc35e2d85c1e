# Control of sphere_decision.g, one notch tighter: 7u instead of 8u. Gappa must fail.

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

{ X * X / (X * X + Y * Y) in [0, 1] /\ X * X + Y * Y <> 0 /\
  (X * X + Y * Y) / D in [0, 1] /\ D <> 0 /\ Q <> 0 /\
  D / Q in [0, 0xFFFFF9p-24]
  -> d2 / t <= 1 }

d2 / t -> (d2 / D) * (D / Q) / (t / Q) { D <> 0, Q <> 0, t <> 0 };
d2 / D -> 1 + (d2 - D) / D { D <> 0 };
t / Q -> 1 + (t - Q) / Q { Q <> 0 };
