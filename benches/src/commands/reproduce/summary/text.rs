//! Numbers and table rows as text.

use std::fmt::{Result, Write as _};

use sdop_bench::reproduce::Estimate;

/// Mean ± half-width: two significant digits of the half-width, but no more than six of the mean.
pub fn interval(estimate: &Estimate) -> String {
    let Estimate {
        mean, half_width, ..
    } = *estimate;
    if !half_width.is_finite() || half_width <= 1e-6 * mean.abs() {
        return number(mean);
    }
    let digits = places(half_width, 2.0).min(places(mean, 6.0));
    format!("{mean:.digits$} ± {half_width:.digits$}")
}

/// Four significant digits.
pub fn number(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    format!("{value:.*}", places(value, 4.0))
}

/// Decimal places that show so many significant digits.
fn places(value: f64, significant: f64) -> usize {
    (significant - 1.0 - value.abs().log10().floor()).clamp(0.0, 9.0) as usize
}

/// The head of a table.
pub fn header(out: &mut String, columns: &[&str]) -> Result {
    writeln!(out, "| {} |", columns.join(" | "))?;
    writeln!(out, "|{}", "---|".repeat(columns.len()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_show_the_digits_that_mean_something() {
        let of = |mean, half_width| {
            interval(&Estimate {
                mean,
                half_width,
                seeds: 3,
            })
        };
        assert_eq!(of(1.01374, 0.0123), "1.014 ± 0.012");
        assert_eq!(of(1234.5, 56.0), "1234 ± 56");
        assert_eq!(of(59.877952, 0.00002), "59.88");
        assert_eq!(of(59.877952, 0.002), "59.8780 ± 0.0020");
        assert_eq!(of(2.0, f64::INFINITY), "2.000");
        assert_eq!(
            [0.0, 12.3456, 123_456.0].map(number),
            ["0", "12.35", "123456"]
        );
    }
}
