//! What a frame is to each of the long-lived worlds.

use std::collections::HashMap;

use crate::case::Frame;
use crate::contestant::BodyPart;
use crate::history::{
    Asked, AskedWorld, CompoundWorld, HistoryError, JudgedWorld, Listing, ReportedPair,
};
use sdop::Groups;
use sdop::bodies::Aabb;
use sdop::boxes::{BoxBody, BoxWorld};
use sdop::compound::{Compound, Part, PartCuller};
use sdop::culler::CullerBuilder;
use sdop::periodic::{PeriodicBox, PeriodicBoxes};
use sdop::volume::Shape;
use sdop::world::PeriodicWorld;
use sdop::world::{Body, World};

/// A world that can have the bodies of a frame.
pub trait LivingWorld: JudgedWorld {
    /// The body of a frame with this number.
    fn body(&mut self, frame: &Frame, i: usize) -> Result<Self::Body, HistoryError>;

    /// Whether its bodies have margins.
    fn has_margins(&self) -> bool {
        false
    }

    /// Whether its bodies have parts.
    fn has_parts(&self) -> bool {
        false
    }

    /// Takes over periods; false if its space can't repeat.
    fn set_periods(&mut self, periods: [Option<f64>; 3]) -> Result<bool, HistoryError> {
        let _ = periods;
        Ok(false)
    }
}

fn groups(frame: &Frame, i: usize) -> Groups {
    let groups = frame.filter.as_ref().map(|filter| filter.groups[i]);
    groups.map_or(Groups::ALL, |[member, mask]| Groups { member, mask })
}

/// A box that reaches out by the body's margin, rounded outward.
fn box_body(frame: &Frame, i: usize) -> BoxBody {
    let margin = frame.margins.as_ref().map_or(0.0, |margins| margins[i]);
    let [lo, hi] = [0, 3].map(|corner| [0, 1, 2].map(|axis| frame.boxes[i][corner + axis]));
    let bounds = Aabb::new(lo, hi).grown(margin);
    BoxBody { bounds, motion: frame.motion(i), groups: groups(frame, i) }
}

impl LivingWorld for BoxWorld {
    fn body(&mut self, frame: &Frame, i: usize) -> Result<BoxBody, HistoryError> {
        Ok(box_body(frame, i))
    }

    fn has_margins(&self) -> bool {
        true
    }
}

impl LivingWorld for World {
    fn body(&mut self, frame: &Frame, i: usize) -> Result<Body, HistoryError> {
        Ok(mesh_body(frame, i, frame.bodies.shape[i]))
    }
}

impl LivingWorld for PeriodicBoxes {
    fn body(&mut self, frame: &Frame, i: usize) -> Result<PeriodicBox, HistoryError> {
        Ok(PeriodicBox { groups: groups(frame, i), ..frame.periodic_box(i) })
    }

    fn set_periods(&mut self, periods: [Option<f64>; 3]) -> Result<bool, HistoryError> {
        if self.periods() != periods {
            PeriodicBoxes::set_periods(self, periods)?;
        }
        Ok(true)
    }
}

impl LivingWorld for PeriodicWorld {
    fn body(&mut self, frame: &Frame, i: usize) -> Result<Body, HistoryError> {
        Ok(mesh_body(frame, i, frame.bodies.shape[i]))
    }
}

/// A world of which an index is asked.
impl<W: LivingWorld + AskedWorld> LivingWorld for Asked<W> {
    fn body(&mut self, frame: &Frame, i: usize) -> Result<Self::Body, HistoryError> {
        self.world.body(frame, i)
    }

    fn has_margins(&self) -> bool {
        self.world.has_margins()
    }

    fn set_periods(&mut self, periods: [Option<f64>; 3]) -> Result<bool, HistoryError> {
        self.world.set_periods(periods)
    }
}

/// Meshes, each of one shape or of several parts.
pub struct MeshLife {
    world: CompoundWorld,
    shapes: Vec<Shape>,
    /// The numbers of shapes that were added, by their parts.
    added: HashMap<Vec<u32>, u32>,
}

impl MeshLife {
    /// A world of the shapes of a scene.
    pub fn new(shapes: &[Shape], culler: &CullerBuilder) -> Result<Self, HistoryError> {
        let world = World::with(shapes.to_vec(), culler)?;
        let world = CompoundWorld { world, parts: PartCuller::new() };
        Ok(Self { world, shapes: shapes.to_vec(), added: HashMap::new() })
    }

    fn compound(&mut self, parts: &[BodyPart]) -> Result<u32, HistoryError> {
        let bits = |part: &BodyPart| [&[part.shape][..], &part.pose.map(f32::to_bits)].concat();
        let key: Vec<u32> = parts.iter().flat_map(bits).collect();
        if let Some(&number) = self.added.get(&key) {
            return Ok(number);
        }
        let part = |part: &BodyPart| {
            let (rotation, translation) = part.rotation_and_translation();
            Part { shape: part.shape, rotation, translation, rounded: false }
        };
        let parts: Vec<Part> = parts.iter().map(part).collect();
        let compound = Compound::build("parts", &self.shapes, &parts)?;
        let number = self.world.world.add_shape(compound.shape().clone())?;
        self.world.parts.set_parts(number, compound);
        self.added.insert(key, number);
        Ok(number)
    }
}

impl Listing for MeshLife {
    type World = CompoundWorld;

    fn world(&self) -> &CompoundWorld {
        &self.world
    }

    fn world_mut(&mut self) -> &mut CompoundWorld {
        &mut self.world
    }

    fn list(&mut self) -> Result<Vec<ReportedPair>, HistoryError> {
        self.world.list()
    }
}

impl LivingWorld for MeshLife {
    fn body(&mut self, frame: &Frame, i: usize) -> Result<Body, HistoryError> {
        let parts = frame.parts.as_ref().map_or(&[][..], |parts| &parts[i]);
        let shape = match parts {
            [] => frame.bodies.shape[i],
            _ => self.compound(parts)?,
        };
        Ok(mesh_body(frame, i, shape))
    }

    fn has_parts(&self) -> bool {
        true
    }
}

fn mesh_body(frame: &Frame, i: usize, shape: u32) -> Body {
    let translation = frame.bodies.translation[i].map(f64::from);
    let body = Body::at(shape, frame.bodies.rotation[i], translation);
    Body { motion: frame.motion(i), groups: groups(frame, i), ..body }
}
