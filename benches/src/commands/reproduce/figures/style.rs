//! The common style of the figures: fonts, whiskers, legends, and one colour per strategy.

use plotters::chart::MeshStyle;
use plotters::coord::CoordTranslate;
use plotters::coord::ranged1d::Ranged;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use sdop::settings::Strategy;
use sdop_bench::cost::terms::Terms;
use sdop_bench::measure::counts::Volume;
use sdop_bench::reproduce::Estimate;

use super::Area;
use crate::commands::palette::{
    BATCH, FINDING, GREY, INTEREST, ORDOPS, PALE, SEQUENTIAL, SPHERE, TESTS, UPDATES,
};

/// A strategy's colour in every figure.
pub fn colour(strategy: Strategy) -> RGBColor {
    match strategy {
        Strategy::None => RGBColor(90, 90, 90),
        Strategy::Sphere => SPHERE,
        Strategy::SDopObjectOfInterest => INTEREST,
        Strategy::SDopSequential => SEQUENTIAL,
        Strategy::SDopBatch => BATCH,
        _ => ORDOPS,
    }
}

/// One part of a stacked cost.
pub struct CostPart {
    pub name: &'static str,
    pub colour: RGBColor,
    pub of: fn(&[Terms]) -> f64,
}

/// The formula's terms, from the bottom of the stack to its top.
pub const PARTS: [CostPart; 7] = [
    CostPart {
        name: "Nu·Cu spheres",
        colour: UPDATES[0],
        of: |terms| of(terms, |t| t.update, is_sphere),
    },
    CostPart {
        name: "Nu·Cu or-DOPs",
        colour: UPDATES[1],
        of: |terms| of(terms, |t| t.update, is_ordop),
    },
    CostPart {
        name: "Nu·Cu aabb, k-dop, obb",
        colour: UPDATES[2],
        of: |terms| of(terms, |t| t.update, is_other),
    },
    CostPart {
        name: "F pair finding",
        colour: FINDING,
        of: |terms| of(terms, |t| t.finding, |_| true),
    },
    CostPart {
        name: "Nv·Cv spheres",
        colour: TESTS[0],
        of: |terms| of(terms, |t| t.test, is_sphere),
    },
    CostPart {
        name: "Nv·Cv or-DOPs",
        colour: TESTS[1],
        of: |terms| of(terms, |t| t.test, is_ordop),
    },
    CostPart {
        name: "Nv·Cv aabb, k-dop, obb",
        colour: TESTS[2],
        of: |terms| of(terms, |t| t.test, is_other),
    },
];

fn is_sphere(volume: Volume) -> bool {
    volume == Volume::Sphere
}

fn is_ordop(volume: Volume) -> bool {
    volume == Volume::OrDop
}

fn is_other(volume: Volume) -> bool {
    !is_sphere(volume) && !is_ordop(volume)
}

/// A term summed over some volumes.
fn of(terms: &[Terms], term: fn(&Terms) -> f64, which: fn(Volume) -> bool) -> f64 {
    terms.iter().filter(|t| which(t.volume)).map(term).sum()
}

/// Text at a size, dark grey.
pub fn text(size: i32) -> TextStyle<'static> {
    ("sans-serif", size).into_font().color(&RGBColor(40, 40, 40))
}

/// Text with an anchor.
pub fn anchored(size: i32, horizontal: HPos, vertical: VPos) -> TextStyle<'static> {
    text(size).pos(Pos::new(horizontal, vertical))
}

/// Axes and lines in the background.
pub fn quiet<'m, 'a, 'b, X: Ranged, Y: Ranged, B: DrawingBackend>(
    mesh: &'m mut MeshStyle<'a, 'b, X, Y, B>,
) -> &'m mut MeshStyle<'a, 'b, X, Y, B> {
    mesh.light_line_style(TRANSPARENT)
        .bold_line_style(PALE)
        .axis_style(GREY)
        .label_style(text(12))
        .axis_desc_style(text(13))
}

/// A finite interval's ends, or the mean twice for one seed alone.
pub fn ends(estimate: &Estimate) -> [f64; 2] {
    if estimate.half_width.is_finite() { estimate.interval() } else { [estimate.mean; 2] }
}

/// A title over a figure; returns what is left of the area.
pub fn titled<'a>(area: &Area<'a>, title: &str) -> Result<Area<'a>, super::DrawError> {
    let (head, body) = area.split_vertically(34);
    head.draw(&Text::new(title.to_owned(), (14, 10), text(17)))?;
    Ok(body)
}

/// Coloured keys in one row; `hollow` ones are outlines.
pub fn legend(
    area: &Area<'_>,
    mut at: (i32, i32),
    keys: &[(&str, RGBColor, bool)],
) -> super::DrawResult {
    for (name, colour, hollow) in keys {
        let style =
            if *hollow { ShapeStyle::from(colour).stroke_width(2) } else { colour.filled() };
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
) -> super::DrawResult {
    let (at, origin) = (area.map_coordinate(at), area.get_base_pixel());
    let place = (at.0 - origin.0 + offset.0, at.1 - origin.1 + offset.1);
    area.strip_coord_spec().draw(&Text::new(text, place, style))?;
    Ok(())
}
