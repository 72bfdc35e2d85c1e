# Control of margin_slab.g, one notch tighter: a factor of 1 + 2^-41 instead of 1 + 2^-40. Gappa must fail.

@f64 = float<53, -1074, ne>;
factor = 1 + 1b-41;
s = f64(f64(xx + yy) + zz);
len = f64(sqrt(s));
product = f64(m * len);
out = f64(product * factor);
M = m * sqrt(s);

{ xx in [1b-40, 1b60] /\ yy in [0, 1b60] /\ zz in [0, 1b60] /\ m in [1b-149, 1b60]
  -> (out - M) / M in [0x1p-41, 1] }

(out - M) / M -> (1 + (out - product * factor) / (product * factor)) * (1 + (product - M) / M) * factor - 1 { M <> 0, product <> 0 };
(product - M) / M -> (1 + (product - m * len) / (m * len)) * (1 + (len - sqrt(s)) / sqrt(s)) - 1 { M <> 0, m <> 0, len <> 0, sqrt(s) <> 0 };
