//! What the figures share: colours that the colour-blind tell apart (Okabe & Ito 2008), fonts, whiskers, legends.

use plotters::coord::CoordTranslate;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use sdop::cost::predict::{Terms, Volume};
use sdop::reproduce::Estimate;
use sdop::scene::settings::Strategy;

use super::Area;

pub const FONT: &str = "sans-serif";
pub const GREY: RGBColor = RGBColor(110, 110, 110);
pub const PALE: RGBColor = RGBColor(225, 225, 225);

/// A strategy's colour in every figure.
pub fn colour(strategy: Strategy) -> RGBColor {
    match strategy {
        Strategy::None => RGBColor(90, 90, 90),
        Strategy::Sphere => RGBColor(0, 114, 178),
        Strategy::SDopObjectOfInterest => RGBColor(86, 180, 233),
        Strategy::SDopSequential => RGBColor(0, 158, 115),
        Strategy::SDopBatch => RGBColor(230, 159, 0),
        _ => RGBColor(213, 94, 0),
    }
}

/// One part of a stacked cost.
pub struct Part {
    pub name: &'static str,
    pub colour: RGBColor,
    pub of: fn(&[Terms]) -> f64,
}

/// The formula's terms, from the bottom of the stack to its top.
pub const PARTS: [Part; 5] = [
    Part {
        name: "Nu·Cu spheres",
        colour: RGBColor(0, 114, 178),
        of: |terms| of(terms, |t| t.update, true),
    },
    Part {
        name: "Nu·Cu or-DOPs",
        colour: RGBColor(204, 121, 167),
        of: |terms| of(terms, |t| t.update, false),
    },
    Part {
        name: "F pair finding",
        colour: RGBColor(170, 170, 170),
        of: |terms| terms.iter().map(|t| t.finding).sum(),
    },
    Part {
        name: "Nv·Cv spheres",
        colour: RGBColor(86, 180, 233),
        of: |terms| of(terms, |t| t.test, true),
    },
    Part {
        name: "Nv·Cv or-DOPs",
        colour: RGBColor(230, 159, 0),
        of: |terms| of(terms, |t| t.test, false),
    },
];

/// A term summed over the spheres, or over all other volumes.
fn of(terms: &[Terms], term: fn(&Terms) -> f64, spheres: bool) -> f64 {
    terms
        .iter()
        .filter(|t| (t.volume == Volume::Sphere) == spheres)
        .map(term)
        .sum()
}

/// Text at a size, dark grey.
pub fn text(size: i32) -> TextStyle<'static> {
    (FONT, size).into_font().color(&RGBColor(40, 40, 40))
}

/// Text with an anchor.
pub fn anchored(size: i32, horizontal: HPos, vertical: VPos) -> TextStyle<'static> {
    text(size).pos(Pos::new(horizontal, vertical))
}

/// A finite interval's ends, or the mean twice for one seed alone.
pub fn ends(estimate: &Estimate) -> [f64; 2] {
    if estimate.half_width.is_finite() {
        estimate.interval()
    } else {
        [estimate.mean; 2]
    }
}

/// A title over a figure; returns what is left of the area.
pub fn titled<'a>(area: &Area<'a>, title: &str) -> Result<Area<'a>, super::Failure> {
    let (head, body) = area.split_vertically(34);
    head.draw(&Text::new(title.to_owned(), (14, 10), text(17)))?;
    Ok(body)
}

/// Coloured keys in one row; `hollow` ones are outlines.
pub fn legend(
    area: &Area<'_>,
    mut at: (i32, i32),
    keys: &[(&str, RGBColor, bool)],
) -> super::Drawn {
    for (name, colour, hollow) in keys {
        let style = if *hollow {
            ShapeStyle::from(colour).stroke_width(2)
        } else {
            colour.filled()
        };
        area.draw(&Circle::new((at.0 + 6, at.1), 5, style))?;
        area.draw(&Text::new(
            (*name).to_owned(),
            (at.0 + 17, at.1),
            anchored(13, HPos::Left, VPos::Center),
        ))?;
        at.0 += 17 + 8 * name.chars().count() as i32 + 14;
    }
    Ok(())
}

/// Text some pixels off a point of a chart; it may stand outside of the axes.
pub fn label<CT: CoordTranslate>(
    area: &DrawingArea<SVGBackend<'_>, CT>,
    at: &CT::From,
    offset: (i32, i32),
    text: String,
    style: TextStyle<'_>,
) -> super::Drawn {
    let (at, origin) = (area.map_coordinate(at), area.get_base_pixel());
    let place = (at.0 - origin.0 + offset.0, at.1 - origin.1 + offset.1);
    area.strip_coord_spec()
        .draw(&Text::new(text, place, style))?;
    Ok(())
}
