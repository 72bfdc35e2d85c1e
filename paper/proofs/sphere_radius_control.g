# Control of sphere_radius.g, one notch tighter: the factor 1 + 4u instead of 1 + 8u. Gappa must fail.

@rnd = float<24, ne>;
k = 0x1.000004p0;
Ra rnd= ra * k;
Rb rnd= rb * k;
S = Ra + Rb;
E = ra * k + rb * k;
P = ra + rb;

{ ra / P in [0, 1] /\ P <> 0 /\ S <> 0 -> (P * P) / (S * S) <= 0xFFFFF8p-24 }

P * P / (S * S) -> 1 / ((S / P) * (S / P)) { P <> 0, S <> 0, S * S <> 0, S / P <> 0 };
S / P -> (1 + (S - E) / E) * k { P <> 0, E <> 0 };
ra * k / E -> ra / P { P <> 0, E <> 0 };
E -> P * k;
