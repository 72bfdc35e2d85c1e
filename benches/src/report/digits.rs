//! Formatting numbers for pages, and checking that a recorded number looks the same on every page.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Mutex, PoisonError};

use crate::measure::estimate::Estimate;

/// The pages on which each recorded number is, and its form there.
#[derive(Debug, Default)]
pub struct Quantities {
    /// The texts of each number, which is stored as its bits, and the pages that have each text.
    shown: Mutex<BTreeMap<u64, BTreeMap<String, BTreeSet<String>>>>,
}

/// A recorded number that is on more than one page.
#[derive(Clone, Debug, PartialEq)]
pub struct Quantity {
    /// The number.
    pub value: f64,
    /// Its texts, each with the pages that have it: one, where all is well.
    pub texts: BTreeMap<String, BTreeSet<String>>,
}

impl Quantities {
    /// Notes that `page` shows `value` as `text`. A round number is no quantity: 64 seeds and 64
    /// bytes are two things.
    pub fn note(&self, page: &str, value: f64, text: &str) {
        if !value.is_finite() || value.to_string().trim_matches(['-', '0', '.']).len() < 6 {
            return;
        }
        let mut shown = self.shown.lock().unwrap_or_else(PoisonError::into_inner);
        let texts = shown.entry(value.to_bits()).or_default();
        texts.entry(text.to_owned()).or_default().insert(page.to_owned());
    }

    /// The numbers that stand on more than one page.
    #[must_use]
    pub fn on_several_pages(&self) -> Vec<Quantity> {
        self.all()
            .filter(|quantity| quantity.texts.values().flatten().collect::<BTreeSet<_>>().len() > 1)
            .collect()
    }

    /// The numbers that are given in more than one way.
    #[must_use]
    pub fn given_differently(&self) -> Vec<Quantity> {
        self.all().filter(|quantity| quantity.texts.len() > 1).collect()
    }

    fn all(&self) -> impl Iterator<Item = Quantity> {
        let shown = self.shown.lock().unwrap_or_else(PoisonError::into_inner);
        let all = shown
            .iter()
            .map(|(bits, texts)| Quantity { value: f64::from_bits(*bits), texts: texts.clone() });
        all.collect::<Vec<_>>().into_iter()
    }
}

impl std::fmt::Display for Quantity {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let given = self.texts.iter().map(|(text, pages)| {
            let pages: Vec<&str> = pages.iter().map(String::as_str).collect();
            format!("{text} in {}", pages.join(", "))
        });
        let given: Vec<String> = given.collect();
        write!(f, "{} is {}", self.value, given.join("; "))
    }
}

/// Writes a number with this many significant digits, without an exponent.
#[must_use]
pub fn significant(x: f64, digits: usize) -> String {
    if x == 0.0 || !x.is_finite() {
        return x.to_string();
    }
    let magnitude = x.abs().log10().floor() as i64;
    let behind = digits as i64 - 1 - magnitude;
    let text = format!("{x:.*}", usize::try_from(behind).unwrap_or(0));
    // 9.996 to three digits is 10.00: one digit too many after the point.
    let rounded: f64 = text.parse().unwrap_or(x);
    if rounded.abs().log10().floor() as i64 > magnitude && behind > 0 {
        return format!("{x:.*}", usize::try_from(behind - 1).unwrap_or(0));
    }
    text
}

/// A whole number with a comma between thousands.
pub fn thousands(x: f64) -> String {
    let digits = format!("{:.0}", x.abs());
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    if x < 0.0 { format!("-{text}") } else { text }
}

/// The table of a Markdown text that comes `nth`, as rows of named cells: numbers as numbers.
#[cfg_attr(not(feature = "maintain"), allow(dead_code, reason = "pages alone need it"))]
pub(super) fn markdown_table(
    text: &str,
    nth: usize,
) -> Vec<serde_json::Map<String, serde_json::Value>> {
    let lines: Vec<&str> = text.lines().collect();
    let tables = lines.split(|line| !line.starts_with('|'));
    let Some(table) = tables.filter(|table| table.len() > 1).nth(nth) else {
        return Vec::new();
    };
    let cells = |line: &&str| -> Vec<String> {
        let line = line.trim().trim_matches('|');
        line.split('|').map(|cell| cell.trim().to_owned()).collect()
    };
    let columns = cells(&table[0]);
    let row = |line| {
        let values = cells(line).into_iter().map(|cell| match cell.parse::<f64>() {
            Ok(number) => number.into(),
            Err(_) => cell.into(),
        });
        columns.iter().cloned().zip(values).collect()
    };
    table[2..].iter().map(row).collect()
}

/// Mean ± half-width: two significant digits of the half-width, but no more than six of the mean.
#[must_use]
pub fn interval(estimate: &Estimate) -> String {
    let Estimate { mean, half_width, .. } = *estimate;
    if !half_width.is_finite() || half_width <= 1e-6 * mean.abs() {
        return number(mean);
    }
    let digits = places(half_width, 2.0).min(places(mean, 6.0));
    format!("{mean:.digits$} ± {half_width:.digits$}")
}

/// Four significant digits.
#[must_use]
pub fn number(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    format!("{value:.*}", places(value, 4.0))
}

/// The decimal places that show this many significant digits.
fn places(value: f64, significant: f64) -> usize {
    (significant - 1.0 - value.abs().log10().floor()).clamp(0.0, 9.0) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_that_count() {
        for (x, digits, text) in [
            (9.996, 3, "10.0"),
            (0.012_349, 3, "0.0123"),
            (1441.0, 3, "1441"),
            (2.16, 3, "2.16"),
            (0.0, 3, "0"),
        ] {
            assert_eq!(significant(x, digits), text);
        }
        assert_eq!(thousands(1_234_567.0), "1,234,567");
        assert_eq!(thousands(-999.0), "-999");
    }

    /// A number that looks different on two pages is found.
    #[test]
    fn number_forms_are_compared() {
        let quantities = Quantities::default();
        let ratio = 6.706_745_3;
        quantities.note("a.md", ratio, "6.71");
        quantities.note("b.md", ratio, "6.71");
        assert_eq!(quantities.on_several_pages().len(), 1);
        assert!(quantities.given_differently().is_empty());
        quantities.note("b.md", ratio, "6.7");
        let found = quantities.given_differently();
        assert_eq!(found[0].to_string(), "6.7067453 is 6.7 in b.md; 6.71 in a.md, b.md");
        quantities.note("a.md", 64.0, "64");
        quantities.note("b.md", 64.0, "64.0");
        assert_eq!(quantities.given_differently().len(), 1, "64 is a round number");
    }

    /// A table of a page is rows.
    #[test]
    fn page_table_parses_to_rows() {
        let text = "above\n\n| bodies | ns |\n|--:|--:|\n| 100 | 1.5 |\n| all | – |\n\n| x |\n|---|\n| 3 |\n";
        let rows = markdown_table(text, 0);
        assert_eq!((rows[0]["ns"].as_f64(), rows[1]["bodies"].as_str()), (Some(1.5), Some("all")));
        assert_eq!(markdown_table(text, 1)[0]["x"].as_f64(), Some(3.0));
        assert!(markdown_table(text, 2).is_empty());
    }

    #[test]
    fn intervals_show_meaningful_digits() {
        let of = |mean, half_width| interval(&Estimate { mean, half_width, seeds: 3 });
        assert_eq!(of(1.01374, 0.0123), "1.014 ± 0.012");
        assert_eq!(of(1234.5, 56.0), "1234 ± 56");
        assert_eq!(of(59.877952, 0.00002), "59.88");
        assert_eq!(of(59.877952, 0.002), "59.8780 ± 0.0020");
        assert_eq!(of(2.0, f64::INFINITY), "2.000");
        assert_eq!([0.0, 12.3456, 123_456.0].map(number), ["0", "12.35", "123456"]);
    }
}
