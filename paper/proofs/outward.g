# The end of a sweep's ball, the half of a cube about a box and the radius of a model with a margin are `up` of an f64 sum or
# difference of two f32: never below the exact one. `up(x)` is at least x + 2^-26 |x| (L4), whatever the sign; here x > 0, and for
# x < 0 the same script holds of -x and `down`. Z is the exact sum; where it underflows f64 it is exact.

@f64 = float<53, -1074, ne>;
least = 1b-26;
end = f64(Z) * (1 + more);

{ Z in [1b-1000, 1b64] /\ more - least in [0, 1] -> (end - Z) / Z >= 0 }

(end - Z) / Z -> (f64(Z) - Z) / Z * (1 + more) + (more - least) + least { Z <> 0 };
