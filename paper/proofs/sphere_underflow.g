# As sphere_decision.g and sphere_radius.g together, with underflow: touching spheres of any size are not culled while
# t is normal or underflows gradually (t flushed to zero: sphere_flush.g).
# A machine operation is x (1 + e) + g. P = ra + rb >= sqrt(D); g1 and g2 are what denormals read as zero change in radii and
# coordinate differences, h1 and h2 what products lose (or, in d2, gain) by underflow. S and d2 are the extreme cases.

u = 1b-24;
floor = 1b-70;
alpha = (1 + 8 * u) * (1 + e1) * (1 + e2) * (1 + e3);
beta = (2 * floor * (1 + e2) - g1) * (1 + e3);
S = P * alpha + beta;
t = S * S * (1 + e4) - h1;
kappa = (1 + e5) * (1 + e5) * (1 + e6) * (1 + e7) * (1 + e8);
d2 = (P + g2) * (P + g2) * kappa + h2;

{ P in [0, 1b62] /\
  |e1| <= 1b-24 /\ |e2| <= 1b-24 /\ |e3| <= 1b-24 /\ |e4| <= 1b-24 /\
  |e5| <= 1b-24 /\ |e6| <= 1b-24 /\ |e7| <= 1b-24 /\ |e8| <= 1b-24 /\
  g1 in [0, 1b-124] /\ g2 in [0, 1b-124] /\ h1 in [0, 1b-150] /\ h2 in [0, 1b-148]
  -> t - d2 >= 0 }

t - d2 -> P * P * (alpha * alpha * (1 + e4) - kappa)
        + P * 2 * (alpha * beta * (1 + e4) - g2 * kappa)
        + (beta * beta * (1 + e4) - g2 * g2 * kappa - h1 - h2);
