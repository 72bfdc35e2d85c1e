//! Bodies of several parts that touch others by one of them, to the bit.
//!
//! Bodies are in rows of two. Parts are bars and cubes. All rotations are by multiples of a quarter
//! turn, and all coordinates are short binary numbers. Therefore composed poses are exact, and each
//! part is a box on the axes of the world. Parts of one body may overlap.

use rand::{Rng, RngExt};

use super::exact_touches::{TURNS, cuboid};
use super::{CatalogueError, DrawnCase};
use crate::case::{Frame, posed_part};
use crate::contestant::BodyPart;
use sdop::bodies::Bodies;
use sdop::volume::Shape;

/// What changes from frame to frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PartsKind {
    /// Nothing: there is one frame.
    Still,
    /// The poses of bodies. In every other frame the two bodies of a row are apart.
    Moving,
    /// The frames of bodies: their origins move, and the local poses of their parts so that the
    /// parts stay where they are. In half of the rows, the touching part is missing in every other
    /// frame.
    Reframed,
}

const ROWS: usize = 12;
const FRAMES: usize = 5;
/// Half sides of a bar and of a cube. All lengths are in units of the case's size.
const HALVES: [[f32; 3]; 2] = [[1.0, 2.0, 4.0], [1.0; 3]];
/// The distance from row to row.
const SPACING: f32 = 64.0;
/// The distance of a part from the origin of its body, if it is far from there.
const FAR: f32 = 16_384.0;
/// The distance of bodies that are apart.
const GAP: f32 = 32.0;

/// A body of a row; without parts it is a bar.
#[derive(Clone, Debug)]
struct RowBody {
    parts: Vec<BodyPart>,
    dynamic: bool,
    rotation: [f32; 4],
    translation: [f32; 3],
}

/// The centre of a part in the world, and how far it reaches from there along each axis.
struct PartBox {
    centre: [f32; 3],
    reach: [f32; 3],
}

/// A case whose bodies touch along the axis of this number, modulo 3.
pub fn touching(
    kind: PartsKind,
    number: u32,
    rng: &mut impl Rng,
) -> Result<DrawnCase, CatalogueError> {
    let size = 2_f32.powi(rng.random_range(-4..=4));
    let shapes = [("bar", HALVES[0]), ("cube", HALVES[1])];
    let shapes = shapes.map(|(name, half)| cuboid(name, half.map(|x| x * size)));
    let shapes = shapes.into_iter().collect::<Result<Vec<Shape>, _>>()?;
    let axis = number as usize % 3;
    let mut rows: Vec<[RowBody; 2]> = (0..ROWS).map(|row| row_bodies(row, axis, rng)).collect();
    let count = if kind == PartsKind::Still { 1 } else { FRAMES };
    let mut frames = Vec::new();
    for n in 0..count {
        let (mut bodies, mut parts) = (Bodies::default(), Vec::new());
        for (row, pair) in rows.iter_mut().enumerate() {
            if n == 0 || kind == PartsKind::Moving {
                move_row(kind, axis, [row, n], pair, rng)?;
            }
            let mut shown = pair.clone();
            if n > 0 && kind == PartsKind::Reframed {
                shown.iter_mut().try_for_each(|body| reframe(body, rng))?;
                if n % 2 == 1 && row % 2 == 1 {
                    shown[0].parts.pop();
                }
            }
            for body in shown {
                let translation = body.translation.map(|x| x * size);
                bodies.push(0, body.dynamic, body.rotation, translation);
                parts.push(body.parts.into_iter().map(|part| scaled(part, size)).collect());
            }
        }
        let was = (0..bodies.len() as u32).map(Some).collect();
        frames.push(Frame {
            was: (n > 0 && kind == PartsKind::Reframed).then_some(was),
            ..Frame::of_parts(bodies, parts, &shapes)?
        });
    }
    Ok(DrawnCase { shapes, frames })
}

/// The bodies of a row: the first has several parts, the second is a bar alone, or has one part or
/// several.
fn row_bodies(row: usize, axis: usize, rng: &mut impl Rng) -> [RowBody; 2] {
    // Far enough from zero for an ulp of a translation to be in range.
    let mut at: [f32; 3] = std::array::from_fn(|_| rng.random_range(256..=320) as f32);
    at[(axis + 1) % 3] = 256.0 + SPACING * row as f32; // few rows
    [(2 + row % 2, row % 4 == 1), (row % 4, row % 4 == 2)].map(|(count, is_far)| RowBody {
        parts: row_parts(count, is_far, rng),
        dynamic: true,
        rotation: turn(rng),
        translation: at,
    })
}

/// Parts near the origin of their body, with the last one far from it or not.
fn row_parts(count: usize, is_far: bool, rng: &mut impl Rng) -> Vec<BodyPart> {
    let mut parts: Vec<BodyPart> = (0..count)
        .map(|n| {
            let at: [f32; 3] = std::array::from_fn(|_| rng.random_range(-6..=6) as f32);
            // The last part touches, and its rotation has to matter.
            let shape = if n + 1 == count { 0 } else { rng.random_range(0..2) };
            part(shape, turn(rng), at)
        })
        .collect();
    if is_far && let Some(last) = parts.last_mut() {
        last.pose[4 + rng.random_range(0..3)] = [FAR, -FAR][rng.random_range(0..2)];
    }
    parts
}

/// Poses both bodies of a row anew. Their last parts touch, in every third row they are an ulp
/// apart. In every fourth row the first body is static.
fn move_row(
    kind: PartsKind,
    axis: usize,
    [row, n]: [usize; 2],
    [first, second]: &mut [RowBody; 2],
    rng: &mut impl Rng,
) -> Result<(), CatalogueError> {
    first.dynamic = row % 4 != 3;
    if n > 0 && first.dynamic {
        first.rotation = turn(rng);
        first.translation[axis] += rng.random_range(-16..=16) as f32;
    }
    second.rotation = turn(rng);
    second.translation = [0.0; 3];
    let (target, own) = (last_part(first)?, last_part(second)?);
    let side = if row.is_multiple_of(2) { 1.0 } else { -1.0 };
    for i in 0..3 {
        let reach = target.reach[i] + own.reach[i];
        let beside = reach as i32 - 1;
        let along = match i == axis {
            true => side * reach,
            false => rng.random_range(-beside..=beside) as f32,
        };
        second.translation[i] = target.centre[i] + along - own.centre[i];
    }
    let t = &mut second.translation[axis];
    if kind == PartsKind::Moving && n % 2 == row / 2 % 2 {
        *t += side * GAP;
    } else if row % 3 == 2 {
        *t = if side > 0.0 { t.next_up() } else { t.next_down() };
    }
    Ok(())
}

/// Moves the origin of a body that has parts, and leaves its parts where they are.
fn reframe(body: &mut RowBody, rng: &mut impl Rng) -> Result<(), CatalogueError> {
    if body.parts.is_empty() {
        return Ok(());
    }
    let by: [f32; 3] = std::array::from_fn(|_| rng.random_range(-24..=24) as f32);
    let parts = vec![part(0, [0.0, 0.0, 0.0, 1.0], by)];
    body.translation = last_part(&RowBody { parts, ..body.clone() })?.centre;
    for part in &mut body.parts {
        for (at, by) in part.pose[4..].iter_mut().zip(by) {
            *at -= by;
        }
    }
    Ok(())
}

/// Where the last part of a body is, or the bar that it is.
fn last_part(body: &RowBody) -> Result<PartBox, CatalogueError> {
    let mut bodies = Bodies::default();
    bodies.push(0, true, body.rotation, body.translation);
    let (shape, pose) = posed_part(&bodies, 0, body.parts.last())?;
    let centre = pose.translation();
    let corner = pose.point(&HALVES[shape as usize].map(f64::from));
    Ok(PartBox {
        centre: centre.map(|x| x as f32),
        reach: [0, 1, 2].map(|axis| (corner[axis] - centre[axis]).abs() as f32),
    })
}

fn part(shape: u32, [x, y, z, w]: [f32; 4], [tx, ty, tz]: [f32; 3]) -> BodyPart {
    let pose = [x, y, z, w, tx, ty, tz];
    BodyPart { shape, pose }
}

fn scaled(mut part: BodyPart, size: f32) -> BodyPart {
    part.pose[4..].iter_mut().for_each(|x| *x *= size);
    part
}

fn turn(rng: &mut impl Rng) -> [f32; 4] {
    TURNS[rng.random_range(0..TURNS.len())]
}
