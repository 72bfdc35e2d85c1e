//! Draws compounds, and histories of bodies whose parts touch parts of others to the last place.
//!
//! Every composed pose is exact in f64. The squared norms of bodies' quaternions divide [`SQUARE`]
//! times 4, and translations of parts are multiples of that many [`STEP`]s, so that turned ones are
//! whole steps. Components of parts' quaternions are multiples of 2⁻¹⁵, so that products are exact.

use rand::SeedableRng as _;
use rand_chacha::ChaCha8Rng;

use sdop_reference::WidePose;

use super::draw::{
    MARGINS, ROTATIONS, SMALL_MARGINS, draw_bodies, draw_rotation, other, with_properties,
};
use super::{History, HistoryError};
use crate::draw::bodies::ContactSpec;
use crate::draw::contact::{Contact, PlacedShape};
use crate::truth::reference_shapes::Shapes;
use sdop::compound::{Compound, Part, PartCuller};
use sdop::rounding::U;
use sdop::volume::Shape;
use sdop::world::Body;

/// A multiple of the squared norms of quaternions of bodies, up to factors of 4.
const SQUARE: f64 = 105.0;

/// A step of parts' translations.
const STEP: f64 = 1.0 / (1 << 20) as f64;

/// Where the bodies of a history are, and a step of their translations: f64 holds sums of such
/// steps and of those of parts.
const PLACES: [([f64; 3], f64); 3] = [
    ([0.0; 3], 1.0 / (1_u64 << 42) as f64),
    ([1_048_576.0, -524_288.0, 0.0], 1.0 / (1_u64 << 31) as f64),
    ([-805_306_368.0, 0.0, 536_870_912.0], 1.0 / (1_u64 << 22) as f64),
];

/// The compounds of a history, and the shapes of their parts.
#[derive(Clone, Debug)]
pub struct Robots {
    /// The shapes of parts.
    pub shapes: Shapes,
    /// The parts of each shape number of a world. The last number is a shape alone.
    pub parts: Vec<Vec<Part>>,
    compounds: Vec<Compound>,
}

impl Robots {
    /// Draws a compound of one part, of a few and of several in these shapes.
    ///
    /// # Errors
    /// As [`Compound::build`].
    pub fn draw(shapes: Shapes, below: &mut impl FnMut(u32) -> u32) -> Result<Self, HistoryError> {
        let counts = [1, 2 + below(3), 5 + below(4) + 8 * below(4)];
        let mut parts = counts.map(|count| draw_parts(count, shapes.built.len() as u32, below));
        let build = |parts: &Vec<Part>| Compound::build("robot", &shapes.built, parts);
        let compounds = parts.iter().map(build).collect::<Result<_, _>>()?;
        let alone = Part { shape: below(shapes.built.len() as u32), ..Part::default() };
        Ok(Self {
            parts: parts.iter_mut().map(std::mem::take).chain([vec![alone]]).collect(),
            compounds,
            shapes,
        })
    }

    /// The shapes of a world.
    pub fn world_shapes(&self) -> Vec<Shape> {
        let compounds = self.compounds.iter().map(|compound| compound.shape().clone());
        let alone = self.parts.last().into_iter().flatten();
        let alone = alone.map(|part| self.shapes.built[part.shape as usize].clone());
        compounds.chain(alone).collect()
    }

    /// A culler of the parts of such a world.
    pub fn part_culler(&self) -> PartCuller {
        let mut culler = PartCuller::new();
        for (number, compound) in (0..).zip(&self.compounds) {
            culler.set_parts(number, compound.clone());
        }
        culler
    }

    /// The shape of a part, and its pose in the world.
    pub fn posed(&self, body: &Body, part: usize) -> (usize, WidePose) {
        let part = &self.parts[body.shape as usize][part];
        let of_part = (part.rotation, part.translation);
        let pose = WidePose::composed((body.rotation, body.translation), of_part);
        let pose = pose.unwrap_or_else(|| unreachable!("sums of whole steps"));
        (part.shape as usize, pose)
    }

    /// Draws a history of such bodies.
    pub fn history(&self, below: &mut impl FnMut(u32) -> u32) -> History<Body> {
        let (place, step) = PLACES[below(PLACES.len() as u32) as usize];
        let spec = ContactSpec::default();
        let (shapes, margins) = (self.world_shapes(), &MARGINS[..SMALL_MARGINS]);
        let new = |others: &[Body], below: &mut dyn FnMut(u32) -> u32| {
            let mut rng = ChaCha8Rng::seed_from_u64(u64::from(below(u32::MAX)));
            let shape = below(shapes.len() as u32);
            let body = Body::at(shape, draw_rotation(&ROTATIONS, below), [0.0; 3]);
            let mut body = with_properties(body, margins, below);
            let part_of = |body: &Body, below: &mut dyn FnMut(u32) -> u32| {
                below(self.parts[body.shape as usize].len() as u32) as usize
            };
            let touching = match other(others, below) {
                Some(other) if below(8) > 0 => {
                    let parts = [part_of(&other, below), part_of(&body, below)];
                    self.touching([&other, &body], parts, &spec.contact(&mut rng))
                }
                _ => None,
            };
            let free = || [0, 1, 2].map(|axis| place[axis] + f64::from(below(64)) / 8.0);
            let at = touching.unwrap_or_else(free);
            body.translation = at.map(|x| (x / step).round() * step);
            body
        };
        draw_bodies(&shapes, margins, new, below)
    }

    /// The translation at which a part of the second body, which is at the origin, nearly touches a
    /// part of the first. Both are grown by the margins of their bodies.
    fn touching(
        &self,
        [first, second]: [&Body; 2],
        parts: [usize; 2],
        contact: &Contact,
    ) -> Option<[f64; 3]> {
        let (shape, pose) = self.posed(first, parts[0]);
        let (partner, local) = self.posed(second, parts[1]);
        let rounded = |pose: &WidePose| pose.quaternion().map(|x| x as f32);
        let placed = PlacedShape { shape, rotation: rounded(&pose), translation: [0.0; 3] };
        let reach = [shape, partner].map(|number| f64::from(self.shapes.built[number].reach));
        let margin = f64::from(first.margin) + f64::from(second.margin);
        let contact =
            Contact { gap: contact.gap + margin / (U * (reach[0] + reach[1])), ..contact.clone() };
        let apart = contact.place(&self.shapes, &placed, partner, rounded(&local))?;
        let (from, own) = (pose.translation(), local.translation());
        Some([0, 1, 2].map(|axis| from[axis] + f64::from(apart[axis]) - own[axis]))
    }
}

/// Parts as the links of a tree: each near an earlier one.
fn draw_parts(count: u32, shapes: u32, below: &mut impl FnMut(u32) -> u32) -> Vec<Part> {
    let mut parts: Vec<Part> = Vec::new();
    for number in 0..count {
        let from = match number {
            0 => [0.0; 3],
            _ => parts[below(number) as usize].translation,
        };
        let way = [(); 3].map(|()| f64::from(below(1 << 15)) - f64::from(1 << 14));
        let rotation = match below(4) {
            0 => Part::default().rotation,
            1 => draw_rotation(&ROTATIONS, below),
            // Not zero: an odd number of steps along w.
            _ => [0, 0, 0, 1]
                .map(|odd| (below(1 << 16) as f32 - 32768.0 + odd as f32 / 2.0) / 32768.0),
        };
        parts.push(Part {
            shape: below(shapes),
            rotation,
            translation: [0, 1, 2].map(|axis| from[axis] + way[axis] * SQUARE * STEP),
            rounded: false,
        });
    }
    parts
}
