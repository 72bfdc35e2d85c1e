# Control of outward.g, one notch tighter: `up` as if it only rounded to nearest. Gappa must fail.

@f64 = float<53, -1074, ne>;
least = -1b-54;
end = f64(Z) * (1 + more);

{ Z in [1b-1000, 1b64] /\ more - least in [0, 1] -> (end - Z) / Z >= 0 }

(end - Z) / Z -> (f64(Z) - Z) / Z * (1 + more) + (more - least) + least { Z <> 0 };
