//! A case: shapes, and a few frames of bodies with their boxes.

use super::claim::Claim;
use crate::contestant::{BodyPart, Filter, WorldBox};
use sdop::Motion;
use sdop::bodies::Bodies;
use sdop::periodic::{PeriodicBox, PeriodicBoxes, PeriodicError};
use sdop::rounding::pose::{COORDINATE_ERROR, rotation, transform};
use sdop::rounding::{down, up};
use sdop::volume::Shape;
use sdop_reference::{InvalidInput, WidePose};

/// One frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frame {
    /// The bodies.
    pub bodies: Bodies,
    /// A box for each of them.
    pub boxes: Vec<WorldBox>,
    /// If the set of bodies differs from the frame before: each body's former number, `None` for a
    /// new body.
    pub was: Option<Vec<Option<u32>>>,
    /// Which pairs must not be reported, for the claim `filter`.
    pub filter: Option<Filter>,
    /// How far each body reaches beyond its box, for the claim `margin`.
    pub margins: Option<Vec<f32>>,
    /// The parts of each body, for the claim `parts`: a body with an empty list is its shape alone.
    pub parts: Option<Vec<Vec<BodyPart>>>,
    /// The period of each axis that has one, for the claim `periodic`. Each box is shorter than
    /// half of it.
    pub periods: Option<[Option<f64>; 3]>,
    /// Whether the culler goes back to the state that it has saved, before this frame.
    pub restore: bool,
    /// Whether it saves its state after this frame.
    pub save: bool,
}

impl Frame {
    /// The frame of these bodies, each in the box that its posed mesh needs, rounded outward.
    #[must_use]
    pub fn fitted(bodies: Bodies, shapes: &[Shape]) -> Self {
        let boxes = (0..bodies.len()).map(|i| fit(&bodies, shapes, i)).collect();
        Self { bodies, boxes, ..Self::default() }
    }

    /// The same for bodies of which each has a list of parts, empty for a body that is its shape
    /// alone. The shape of any other is that of its first part.
    ///
    /// # Errors
    /// A pose outside the contract, or a composed one that f64 doesn't hold.
    pub fn of_parts(
        mut bodies: Bodies,
        parts: Vec<Vec<BodyPart>>,
        shapes: &[Shape],
    ) -> Result<Self, InvalidInput> {
        if parts.iter().all(Vec::is_empty) {
            return Ok(Self::fitted(bodies, shapes));
        }
        for (shape, parts) in bodies.shape.iter_mut().zip(&parts) {
            *shape = parts.first().map_or(*shape, |part| part.shape);
        }
        let mut frame = Self { bodies, parts: Some(parts), ..Self::default() };
        frame.refit(shapes)?;
        Ok(frame)
    }

    /// Fits the boxes to the bodies again.
    ///
    /// # Errors
    /// As [`Frame::of_parts`].
    pub fn refit(&mut self, shapes: &[Shape]) -> Result<(), InvalidInput> {
        let (bodies, count) = (&self.bodies, self.bodies.len());
        self.boxes = match &self.parts {
            None => (0..count).map(|i| fit(bodies, shapes, i)).collect(),
            Some(_) => {
                let posed = (0..count).map(|i| Ok(fit_parts(&self.posed_parts(i)?, shapes)));
                posed.collect::<Result<_, _>>()?
            }
        };
        Ok(())
    }

    /// The shape numbers of a body's parts, with their exact poses in the world.
    ///
    /// # Errors
    /// As [`Frame::of_parts`].
    pub fn posed_parts(&self, i: usize) -> Result<Vec<(u32, WidePose)>, InvalidInput> {
        let parts = self.parts.as_ref().map_or(&[][..], |parts| &parts[i]);
        posed_parts(&self.bodies, i, parts)
    }

    /// Whether a body moves or is fixed, for a world.
    pub(crate) fn motion(&self, i: usize) -> Motion {
        match self.bodies.dynamic[i] {
            true => Motion::Dynamic,
            false => Motion::Fixed,
        }
    }

    /// The box of a body, for a world of periodic boxes.
    #[must_use]
    pub fn periodic_box(&self, i: usize) -> PeriodicBox {
        let [x0, y0, z0, x1, y1, z1] = self.boxes[i].map(f64::from);
        PeriodicBox { motion: self.motion(i), ..PeriodicBox::new([x0, y0, z0], [x1, y1, z1]) }
    }

    /// Checks that the periods are lengths, and that each box is shorter than half of them and not
    /// too many of them away from the origin.
    ///
    /// # Errors
    /// As our own periodic boxes.
    pub fn check_periods(&self) -> Result<(), PeriodicError> {
        let Some(periods) = self.periods else {
            return Ok(());
        };
        let mut world = PeriodicBoxes::new(periods)?;
        let mut boxes = (0..self.boxes.len()).map(|i| self.periodic_box(i));
        boxes.try_for_each(|body| world.insert(body).map(|_| ()))
    }

    /// Whether every body has the number that it had in the frame before.
    #[must_use]
    pub fn keeps_numbers(&self) -> bool {
        let mut was = self.was.iter().flatten().zip(0..);
        was.all(|(former, number)| *former == Some(number))
    }

    /// The bodies of these numbers alone, in this order. Numbers that change are forgotten.
    #[must_use]
    pub fn picked(&self, which: &[usize]) -> Self {
        let number = |body: u32| which.iter().position(|&kept| kept == body as usize);
        let renumbered = |&[i, j]: &[u32; 2]| {
            let [i, j] = [number(i)?, number(j)?].map(|body| body as u32);
            Some([i.min(j), i.max(j)])
        };
        let filter = self.filter.as_ref().map(|filter| {
            let mut excluded: Vec<_> = filter.excluded.iter().filter_map(renumbered).collect();
            excluded.sort_unstable();
            Filter { groups: which.iter().map(|&i| filter.groups[i]).collect(), excluded }
        });
        let (margins, parts) = (self.margins.as_ref(), self.parts.as_ref());
        let was = self.was.as_ref().filter(|_| self.keeps_numbers());
        Self {
            bodies: picked(&self.bodies, which),
            boxes: which.iter().map(|&i| self.boxes[i]).collect(),
            was: was.map(|_| (0..which.len() as u32).map(Some).collect()),
            filter,
            margins: margins.map(|margins| which.iter().map(|&i| margins[i]).collect()),
            parts: parts.map(|parts| which.iter().map(|&i| parts[i].clone()).collect()),
            ..*self
        }
    }
}

/// The group of a case's name: all but its number.
pub(crate) fn group_of(name: &str) -> &str {
    name.rsplit_once('/').map_or(name, |(group, _)| group)
}

/// The bodies of these numbers, in this order.
#[must_use]
pub fn picked(bodies: &Bodies, which: &[usize]) -> Bodies {
    let mut all = Bodies::default();
    for &i in which {
        all.push(bodies.shape[i], bodies.dynamic[i], bodies.rotation[i], bodies.translation[i]);
    }
    all
}

/// A box around a posed mesh: it contains every vertex exactly.
fn fit(bodies: &Bodies, shapes: &[Shape], i: usize) -> WorldBox {
    let (r, t) = (rotation(bodies.rotation[i]), bodies.translation[i]);
    let vertices = shapes[bodies.shape[i] as usize].vertices.iter();
    around(vertices.map(|vertex| {
        let size = vertex.iter().chain(&t).fold(0.0, |m: f32, x| m.max(x.abs()));
        // Above the bound by its half, for the addition's own rounding.
        let error = 1.5 * COORDINATE_ERROR * f64::from(size);
        (transform(&r, *vertex, t), error)
    }))
}

/// A box around posed parts: it contains every vertex exactly.
fn fit_parts(parts: &[(u32, WidePose)], shapes: &[Shape]) -> WorldBox {
    around(parts.iter().flat_map(|(shape, pose)| {
        let t = pose.translation();
        shapes[*shape as usize].vertices.iter().map(move |vertex| {
            let vertex = vertex.map(f64::from);
            let size = vertex.iter().chain(&t).fold(0.0, |m: f64, x| m.max(x.abs()));
            // Entries of the matrix are off by 9 roundings at most, since the quaternion is of f64,
            // and a coordinate by 41.
            (pose.point(&vertex), 4.0 * COORDINATE_ERROR * size)
        })
    }))
}

/// The box of points, each of which may be off by a bound; rounded outward.
fn around(points: impl Iterator<Item = ([f64; 3], f64)>) -> WorldBox {
    let (mut lo, mut hi) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for (point, error) in points {
        for (axis, x) in point.into_iter().enumerate() {
            lo[axis] = lo[axis].min(x - error);
            hi[axis] = hi[axis].max(x + error);
        }
    }
    let ([x0, y0, z0], [x1, y1, z1]) = (lo.map(down), hi.map(up));
    [x0, y0, z0, x1, y1, z1]
}

/// The shape numbers of the parts of body `i`, with their exact poses in the world.
///
/// # Errors
/// As [`Frame::of_parts`].
pub fn posed_parts(
    bodies: &Bodies,
    i: usize,
    parts: &[BodyPart],
) -> Result<Vec<(u32, WidePose)>, InvalidInput> {
    if parts.is_empty() {
        return Ok(vec![posed_part(bodies, i, None)?]);
    }
    let posed = |part| posed_part(bodies, i, Some(part));
    parts.iter().map(posed).collect()
}

/// The shape number of a part of body `i`, or of the body itself, with its exact pose in the world.
pub(crate) fn posed_part(
    bodies: &Bodies,
    i: usize,
    part: Option<&BodyPart>,
) -> Result<(u32, WidePose), InvalidInput> {
    let (rotation, translation) = (bodies.rotation[i], bodies.translation[i].map(f64::from));
    let Some(part) = part else {
        let pose = WidePose::new(rotation.map(f64::from), translation)?;
        return Ok((bodies.shape[i], pose));
    };
    let local = part.rotation_and_translation();
    let pose = WidePose::composed((rotation, translation), local);
    Ok((part.shape, pose.ok_or(InvalidInput::ComposedPose)?))
}

/// A case to be judged by.
#[derive(Clone, Debug)]
pub struct Case {
    /// Its stable name, such as `touch/edge-edge/0017`.
    pub name: String,
    /// The bug it looks for.
    pub flag: String,
    /// The source of the case.
    pub source: String,
    /// The claim by which it is judged.
    pub claim: Claim,
    /// All claims that it is about.
    pub claims: Vec<Claim>,
    /// The shapes of the bodies.
    pub shapes: Vec<Shape>,
    /// The frames, one process or culler for all of them.
    pub frames: Vec<Frame>,
}

impl Case {
    /// The group: the name without its number.
    #[must_use]
    pub fn group(&self) -> &str {
        group_of(&self.name)
    }

    /// The case with these bodies of each frame alone, in this order; bodies neither come nor go.
    #[must_use]
    pub fn picked(&self, which: &[usize]) -> Self {
        Self {
            frames: self.frames.iter().map(|frame| frame.picked(which)).collect(),
            ..self.clone()
        }
    }

    /// The case with the bodies of each frame in another order, which depends on their number.
    #[must_use]
    pub fn reordered(&self, order: impl Fn(usize) -> Vec<usize>) -> Self {
        let mut before = Vec::new();
        let frame = |frame: &Frame| {
            let now = order(frame.bodies.len());
            let former =
                |was: u32| before.iter().position(|&i| i == was as usize).map(|i| i as u32);
            let was = frame.was.as_ref();
            let was = was.map(|was| now.iter().map(|&i| was[i].and_then(former)).collect());
            let frame = Frame { was, ..frame.picked(&now) };
            before = now;
            frame
        };
        Self { frames: self.frames.iter().map(frame).collect(), ..self.clone() }
    }

    /// Whether a frame depends on earlier ones: its set of bodies changes, or it restores a state.
    #[must_use]
    pub fn has_history(&self) -> bool {
        let goes_on = |frame: &Frame| frame.was.is_some() || frame.restore;
        self.frames.iter().any(goes_on)
    }

    /// Binary digits of all ends of boxes, or of all poses, for claims about these.
    pub(crate) fn digits(&self) -> u32 {
        let digits = |x: &f32| match x.to_bits() << 9 {
            _ if *x == 0.0 => 0,
            fraction => 24 - fraction.trailing_zeros().min(23),
        };
        let of_frame = |frame: &Frame| -> u32 {
            let (turns, places) = (&frame.bodies.rotation, &frame.bodies.translation);
            match self.claim.is_of_boxes() {
                true => frame.boxes.iter().flatten().map(digits).sum(),
                false => turns.iter().flatten().chain(places.iter().flatten()).map(digits).sum(),
            }
        };
        self.frames.iter().map(of_frame).sum()
    }

    /// Pairs of bodies over all frames, not both static.
    #[must_use]
    pub fn pairs(&self) -> u64 {
        self.frames
            .iter()
            .map(|frame| {
                let n = frame.bodies.len() as u64;
                let fixed = frame.bodies.dynamic.iter().filter(|d| !**d).count() as u64;
                (n * n.saturating_sub(1) - fixed * fixed.saturating_sub(1)) / 2
            })
            .sum()
    }
}

/// Whether a name matches a pattern in which `*` matches any text, `/` included, and `?` one
/// character.
#[must_use]
pub fn matches(pattern: &str, name: &str) -> bool {
    let (pattern, name): (Vec<char>, Vec<char>) =
        (pattern.chars().collect(), name.chars().collect());
    let (mut p, mut n) = (0, 0);
    // The position of the last star, and the part of the name that it matches.
    let mut star: Option<(usize, usize)> = None;
    while n < name.len() {
        if p < pattern.len() && pattern[p] == '*' {
            star = Some((p, n));
            p += 1;
        } else if p < pattern.len() && (pattern[p] == '?' || pattern[p] == name[n]) {
            p += 1;
            n += 1;
        } else if let Some((at, taken)) = star {
            star = Some((at, taken + 1));
            (p, n) = (at + 1, taken + 1);
        } else {
            return false;
        }
    }
    pattern[p..].iter().all(|c| *c == '*')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_match_whole_names() {
        for (pattern, name, expected) in [
            ("touch/*", "touch/edge-edge/0017", true),
            ("*/0017", "touch/edge-edge/0017", true),
            ("touch/*/00?7", "touch/edge-edge/0017", true),
            ("touch", "touch/edge-edge/0017", false),
            ("*edge*edge*", "touch/edge-edge/0017", true),
            ("*edge*edge*edge*", "touch/edge-edge/0017", false),
            ("", "", true),
            ("*", "", true),
            ("?", "", false),
        ] {
            assert_eq!(matches(pattern, name), expected, "{pattern} {name}");
        }
    }
}
