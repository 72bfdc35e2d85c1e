//! A group of alike bodies as a scene file lists it, its keys checked against each other.

use toml::Spanned;

use super::error::SceneError;
use super::file::{GroupSpec, SceneFile};
use super::library::Form;
use super::random::Stream;
use crate::volume::Origin;

/// The most bodies of a scene: a hundred bytes each, in several copies, fit into memory.
const MOST_BODIES: usize = 1 << 24;

/// The independent streams of draws that a group has, in the order of their numbers.
#[derive(Clone, Copy)]
pub(super) enum Purpose {
    Radius,
    Centre,
    Rotation,
    Velocity,
    Spin,
}

/// A checked group: what it looks like and how many bodies it has.
pub(super) struct Group<'a> {
    pub(super) spec: &'a GroupSpec,
    pub(super) number: u64,
    pub(super) seed: u64,
    pub(super) form: Form<'a>,
    pub(super) origin: Origin,
    pub(super) bodies: usize,
}

impl Group<'_> {
    /// The group's stream of draws for one purpose: what one purpose draws leaves the others as they are.
    pub(super) fn stream(&self, purpose: Purpose) -> Stream {
        Stream::new(self.seed, self.number * 8 + purpose as u64)
    }
}

impl SceneFile {
    /// Checks each group's keys against each other.
    pub(super) fn groups(&self) -> Result<Vec<Group<'_>>, SceneError> {
        let mut groups = Vec::new();
        let mut total = 0_usize;
        for (number, spec) in self.spec.bodies.iter().enumerate() {
            let group = self.group(number as u64, spec)?;
            total = total.saturating_add(group.bodies);
            if total > MOST_BODIES {
                let span = group.spec.count.as_ref().map_or(spec.span(), Spanned::span);
                let hint = format!("a scene has up to {MOST_BODIES} bodies");
                return Err(self
                    .source
                    .error(span, format!("{total} bodies are too many"), hint));
            }
            groups.push(group);
        }
        if total == 0 {
            let end = self.source.text.len();
            let hint = "add [[bodies]] with a mesh or shape, and count = … or poses = …".to_owned();
            return Err(self.source.error(end..end, "the scene has no bodies", hint));
        }
        Ok(groups)
    }

    fn group<'a>(
        &self,
        number: u64,
        spanned: &'a Spanned<GroupSpec>,
    ) -> Result<Group<'a>, SceneError> {
        let spec = spanned.get_ref();
        let wrong = |span, message: &str, hint: &str| {
            Err(self.source.error(span, message, hint.to_owned()))
        };
        let form = match (&spec.mesh, &spec.shape) {
            (Some(mesh), None) => Form::File(mesh),
            (None, Some(shape)) => Form::Procedural(shape, &spec.sizes),
            (Some(_), Some(shape)) => {
                return wrong(
                    shape.span(),
                    "`mesh` and `shape` exclude each other",
                    "keep one of them",
                );
            }
            (None, None) => {
                return wrong(
                    spanned.span(),
                    "bodies without a form",
                    "add mesh = \"file\" or shape = \"name\"",
                );
            }
        };
        if let (Form::File(_), Some((size, _))) = (form, spec.sizes.first_key_value()) {
            return wrong(
                size.span(),
                "`sizes` belong to a `shape`",
                "scale a mesh by its `radius`",
            );
        }
        let bodies = match (&spec.count, &spec.poses) {
            // A u32 fits into the usize of every machine that holds such a scene.
            (Some(count), None) => count.get_ref().get() as usize,
            (None, Some(poses)) => poses.get_ref().len(),
            (Some(_), Some(poses)) => {
                return wrong(
                    poses.span(),
                    "`count` and `poses` exclude each other",
                    "keep one of them",
                );
            }
            (None, None) => {
                return wrong(
                    spanned.span(),
                    "how many bodies?",
                    "add count = … or poses = [[qx, qy, qz, qw, tx, ty, tz]]",
                );
            }
        };
        self.check_motion(spec, bodies)?;
        if let (Some(placement), Some(_)) = (&spec.placement, &spec.poses) {
            return wrong(
                placement.span(),
                "`placement` and `poses` exclude each other",
                "keep one of them",
            );
        }
        let origin = match &spec.origin {
            Some(origin) => *origin.get_ref(),
            None if spec.poses.is_some() && spec.radius.is_none() => Origin::File,
            None => Origin::Ball,
        };
        if let Some(radius) = &spec.radius {
            if origin == Origin::File {
                return wrong(
                    radius.span(),
                    "`radius` scales, origin = \"file\" keeps the size",
                    "keep one of them",
                );
            }
            if radius.get_ref().min == 0.0 {
                return wrong(
                    radius.span(),
                    "a radius of 0",
                    "a radius is above 0; leave it out to keep the mesh's size",
                );
            }
        }
        Ok(Group {
            spec,
            number,
            seed: self.spec.seed,
            form,
            origin,
            bodies,
        })
    }

    fn check_motion(&self, spec: &GroupSpec, bodies: usize) -> Result<(), SceneError> {
        let wrong = |span, message: String, hint: &str| {
            Err(self.source.error(span, message, hint.to_owned()))
        };
        if let Some(velocities) = &spec.velocities {
            if let Some(speed) = &spec.speed {
                let message = "`speed` and `velocities` exclude each other".to_owned();
                return wrong(speed.span(), message, "keep one of them");
            }
            let given = velocities.get_ref().len();
            if spec.poses.is_none() || given != bodies {
                let message = format!("{given} velocities for {bodies} bodies");
                return wrong(
                    velocities.span(),
                    message,
                    "give one velocity a pose; seeded bodies take `speed`",
                );
            }
        }
        let moving = spec
            .speed
            .as_ref()
            .map(Spanned::span)
            .or(spec.velocities.as_ref().map(Spanned::span));
        match moving {
            Some(span) if spec.fixed => wrong(
                span,
                "static bodies don't move".to_owned(),
                "leave out the velocity, or `static = true`",
            ),
            _ => Ok(()),
        }
    }
}
