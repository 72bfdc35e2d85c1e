//! Colours of the figures: a palette for colour-blind readers (Okabe & Ito 2008), and greys.

use plotters::style::RGBColor;

pub const BLUE: RGBColor = RGBColor(0, 114, 178);
pub const VERMILION: RGBColor = RGBColor(213, 94, 0);
pub const GREEN: RGBColor = RGBColor(0, 158, 115);
pub const PURPLE: RGBColor = RGBColor(204, 121, 167);
pub const ORANGE: RGBColor = RGBColor(230, 159, 0);
pub const SKY: RGBColor = RGBColor(86, 180, 233);
/// The terms of the formula, in all figures and on the page of `sdop view` (`web/src/style.css`):
/// updates, finding, tests. Light for spheres, dark for re-fitted and oriented boxes and k-DOPs.
pub const UPDATES: [RGBColor; 3] = [
    RGBColor(235, 199, 217),
    RGBColor(204, 121, 167),
    RGBColor(133, 62, 102),
];
pub const FINDING: RGBColor = RGBColor(170, 170, 170);
pub const TESTS: [RGBColor; 3] = [
    RGBColor(197, 187, 235),
    RGBColor(123, 99, 207),
    RGBColor(64, 45, 140),
];
pub const GREY: RGBColor = RGBColor(110, 110, 110);
/// Lines in the background.
pub const PALE: RGBColor = RGBColor(225, 225, 225);
