//! Colours of the figures. A colour has the same meaning in all figures and on the page of `sdop
//! view` (its style sheet is `view/web/src/style.css`): orange, blue and red are the page's pairs,
//! bluish green is its cells. Other curves are black.

use plotters::style::RGBColor;

/// The terms of the formula: updates, finding, tests. Light for spheres, middle for or-DOPs, dark
/// for boxes and k-DOPs.
pub const UPDATES: [RGBColor; 3] =
    [RGBColor(235, 199, 217), RGBColor(204, 121, 167), RGBColor(133, 62, 102)];
pub const FINDING: RGBColor = RGBColor(170, 170, 170);
pub const TESTS: [RGBColor; 3] =
    [RGBColor(197, 187, 235), RGBColor(123, 99, 207), RGBColor(64, 45, 140)];

/// The strategies of the paper, of different lightness for the colour-blind.
pub const SPHERE: RGBColor = RGBColor(86, 180, 233);
pub const INTEREST: RGBColor = RGBColor(27, 42, 107);
pub const SEQUENTIAL: RGBColor = RGBColor(27, 120, 55);
pub const BATCH: RGBColor = RGBColor(158, 150, 0);
pub const ORDOPS: RGBColor = RGBColor(115, 63, 16);

/// Sequential S-DOP by k, from few half-spaces to many.
pub const BY_K: [RGBColor; 4] =
    [RGBColor(166, 219, 160), RGBColor(90, 174, 97), SEQUENTIAL, RGBColor(0, 68, 27)];

pub const GREY: RGBColor = RGBColor(110, 110, 110);
/// Data that matter less.
pub const LIGHT: RGBColor = RGBColor(190, 190, 190);
/// Lines in the background.
pub const PALE: RGBColor = RGBColor(225, 225, 225);

#[cfg(test)]
mod tests {
    use super::*;

    const STYLE: &str = include_str!("../view/web/src/style.css");

    /// The page's colours by name, for light ground and for dark.
    fn of_page() -> Vec<(&'static str, RGBColor)> {
        let hex = |text: &str| {
            let number = u32::from_str_radix(text.strip_prefix('#')?, 16).ok()?;
            let [_, r, g, b] = number.to_be_bytes();
            Some(RGBColor(r, g, b))
        };
        let variables = STYLE.lines().filter_map(|line| {
            let (name, value) = line.trim().strip_prefix("--")?.split_once(": ")?;
            Some((name, hex(value.trim_end_matches(';'))?))
        });
        variables.collect()
    }

    fn distance(a: RGBColor, b: RGBColor) -> f64 {
        let square = |a: u8, b: u8| (f64::from(a) - f64::from(b)).powi(2);
        (square(a.0, b.0) + square(a.1, b.1) + square(a.2, b.2)).sqrt()
    }

    #[test]
    fn terms_have_the_page_s_colours() {
        let page = of_page();
        let first = |name: &str| page.iter().find(|(own, _)| *own == name).map(|it| it.1);
        assert_eq!(first("update"), Some(UPDATES[1]));
        assert_eq!(first("find"), Some(FINDING));
        assert_eq!(first("test"), Some(TESTS[1]));
    }

    #[test]
    fn a_colour_has_one_meaning() {
        let page = of_page();
        let pairs = ["reported", "meets", "missed", "cells", "pair-0", "pair-1"];
        let mut meanings: Vec<(&str, RGBColor)> =
            page.into_iter().filter(|(name, _)| pairs.contains(name)).collect();
        assert_eq!(meanings.len(), 2 * pairs.len() - 1, "orange is one on both grounds");
        for (names, colours) in [
            (["light updates", "updates", "dark updates"], UPDATES),
            (["light tests", "tests", "dark tests"], TESTS),
        ] {
            meanings.extend(names.into_iter().zip(colours));
        }
        meanings.extend([
            ("sphere", SPHERE),
            ("of interest", INTEREST),
            ("sequential", SEQUENTIAL),
            ("batch", BATCH),
            ("or-DOPs", ORDOPS),
        ]);
        meanings.extend(BY_K.map(|colour| ("sequential", colour)));
        for (at, (name, colour)) in meanings.iter().enumerate() {
            for (other, own) in &meanings[..at] {
                assert!(name == other || distance(*colour, *own) > 40.0, "{name} is like {other}");
            }
        }
    }
}
