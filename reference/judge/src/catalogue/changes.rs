//! Changes along a single axis: a culler that keeps a body's old place or extent along that axis
//! misses a pair.
//!
//! Small bodies are in rows, far from one another. In each row a change brings one of them to its
//! partner along one axis alone: from either side, so that both ends of a box matter.

use rand::{Rng, RngExt};

use super::crowds::CrowdKind;
use super::{CatalogueError, DrawnCase};
use crate::case::{Frame, picked};
use crate::draw::forms::Form;
use glam::Vec3;
use sdop::bodies::Bodies;
use sdop::mesh::TriangleMesh;
use sdop::volume::{Axes, DirectionSet, Origin, Shape, ShapeSpec};

/// Rows of bodies: pairs of them, one on either side.
const ROWS: usize = 6;
const FRAMES: usize = 6;
/// The distance from a cube to another that it meets.
pub(super) const MEETING_DISTANCE: f32 = 1.2;
/// The distance from a cube to another that it doesn't meet.
pub(super) const PARTED_DISTANCE: f32 = 6.0;
/// The distance from a needle's centre to its tips.
pub(super) const TIP_DISTANCE: f32 = 4.0;
pub(super) const UNTURNED: [f32; 4] = [0.0, 0.0, 0.0, 1.0];
/// Quarter turns that lay a needle along each axis.
pub(super) const QUARTER_TURNS: [[f32; 4]; 3] =
    [[0.0, 1.0, 0.0, 1.0], [-1.0, 0.0, 0.0, 1.0], UNTURNED];

/// A case whose changes are along the axis of this number, modulo 3.
pub fn along_an_axis(
    kind: CrowdKind,
    number: u32,
    rng: &mut impl Rng,
) -> Result<DrawnCase, CatalogueError> {
    let shapes = vec![cube(rng)?, needle()?];
    let axis = number as usize % 3;
    let early = [0, 1].map(|side| 2 * rng.random_range(0..ROWS / 2) + side);
    let places = places(axis, ROWS, rng);
    let rows = Rows { axis, places, early };
    let frames = (0..FRAMES).map(|n| match kind {
        CrowdKind::InsertRemove => rows.with_another_set(n, &shapes),
        _ => Frame::fitted(rows.changed(kind, n), &shapes),
    });
    let frames = frames.collect();
    Ok(DrawnCase { shapes, frames })
}

/// Where rows are, far from each other, whose changes are along an axis.
pub(super) fn places(axis: usize, rows: usize, rng: &mut impl Rng) -> Vec<[f32; 3]> {
    let place = |row: usize| {
        let mut place: [f32; 3] = std::array::from_fn(|_| rng.random_range(-0.5..0.5));
        place[(axis + 1) % 3] += 16.0 * row as f32; // few rows
        place
    };
    (0..rows).map(place).collect()
}

/// A cube whose sides are a little shorter than 2.
pub(super) fn cube(rng: &mut impl Rng) -> Result<Shape, CatalogueError> {
    let form = Form { radius: Some([0.7, 0.75]), ..Form::of("box", [0.0, 0.0]) };
    Ok(form.shape(DirectionSet::K18, Axes::Model, rng)?)
}

/// A thin tetrahedron along z.
pub(super) fn needle() -> Result<Shape, CatalogueError> {
    let vertices = vec![
        Vec3::new(0.0, 0.0, -TIP_DISTANCE),
        Vec3::new(0.0, 0.0, TIP_DISTANCE),
        Vec3::new(0.25, 0.0, 0.0),
        Vec3::new(0.0, 0.25, 0.0),
    ];
    let sides = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    let spec = ShapeSpec {
        origin: Origin::File,
        radius: None,
        directions: DirectionSet::K18,
        axes: Axes::Model,
    };
    Ok(Shape::build(&TriangleMesh::new("needle", vertices, sides)?, &spec)?)
}

/// Rows of two or three bodies; the first of each is static and stays.
struct Rows {
    axis: usize,
    /// Where the static bodies are.
    places: Vec<[f32; 3]>,
    /// The rows, one on each side, whose bodies meet when those of the others don't.
    early: [usize; 2],
}

impl Rows {
    /// At a distance from a row's static body along the axis of the changes, on the row's side.
    fn beside(&self, row: usize, distance: f32) -> [f32; 3] {
        let mut place = self.places[row];
        place[self.axis] += if row.is_multiple_of(2) { distance } else { -distance };
        place
    }

    /// The bodies of the frame of this number. Each row's pair meets in every other frame, after a
    /// change.
    fn changed(&self, kind: CrowdKind, frame: usize) -> Bodies {
        let mut bodies = Bodies::default();
        for (row, &place) in self.places.iter().enumerate() {
            bodies.push(0, false, UNTURNED, place);
            let after = (frame % 2 == 1) != self.early.contains(&row);
            let mut push = |shape, turn, distance| {
                bodies.push(shape, true, turn, self.beside(row, distance));
            };
            match kind {
                CrowdKind::Turn => {
                    let axis = self.axis + if after { 0 } else { 2 };
                    push(1, QUARTER_TURNS[axis % 3], TIP_DISTANCE);
                }
                CrowdKind::Swap => {
                    let [first, second] = if after {
                        [PARTED_DISTANCE, MEETING_DISTANCE]
                    } else {
                        [MEETING_DISTANCE, PARTED_DISTANCE]
                    };
                    push(0, UNTURNED, first);
                    push(0, UNTURNED, second);
                }
                CrowdKind::Teleport => {
                    push(0, UNTURNED, if after { MEETING_DISTANCE } else { 1e6 })
                }
                _ => push(0, UNTURNED, if after { MEETING_DISTANCE } else { PARTED_DISTANCE }),
            }
        }
        bodies
    }

    /// The frame of this number, with another set of bodies than the one before. In a third of the
    /// rows a new body is at another place than the one whose number it takes, in a third it
    /// reaches further, and in a third a body moves while others come and go. The fourth frame's
    /// bodies are in reverse.
    fn with_another_set(&self, frame: usize, shapes: &[Shape]) -> Frame {
        let after = frame % 2 == 1;
        let (mut bodies, mut stays) = (Bodies::default(), Vec::new());
        for (row, &place) in self.places.iter().enumerate() {
            bodies.push(0, false, UNTURNED, place);
            let (shape, distance) = match row / 2 % 3 {
                1 => (u32::from(after), TIP_DISTANCE),
                _ => (0, if after { MEETING_DISTANCE } else { PARTED_DISTANCE }),
            };
            let place = self.beside(row, distance);
            bodies.push(shape, true, QUARTER_TURNS[self.axis], place);
            stays.extend([true, row / 2 % 3 == 2]);
        }
        let order = |frame: usize| -> Vec<usize> {
            match frame {
                3 => (0..stays.len()).rev().collect(),
                _ => (0..stays.len()).collect(),
            }
        };
        let was = (frame > 0).then(|| {
            let before = order(frame - 1);
            let number = |body: &usize| before.iter().position(|b| b == body).map(|n| n as u32);
            let former = |body: usize| number(&body).filter(|_| stays[body]);
            order(frame).into_iter().map(former).collect()
        });
        Frame { was, ..Frame::fitted(picked(&bodies, &order(frame)), shapes) }
    }
}

#[cfg(test)]
mod tests;
