//! A group of bodies in a scene file, with its keys checked against each other.

use std::collections::BTreeMap;
use std::ops::Range;

use toml::Spanned;

use super::error::SceneError;
use super::file::{GroupSpec, Placement, SceneFile, Seeding};
use crate::number::Real;
use crate::random::Stream;
use sdop::volume::Origin;

/// The most bodies that a process holds of a scene: a hundred bytes each, in several copies, fit
/// into memory.
const MOST_BODIES: usize = 1 << 24;

/// The most that a u32 numbers, with a bit to spare.
const MOST_BODY_NUMBERS: usize = (1 << 31) - 1;

/// The independent streams of draws that a group has, in the order of their numbers.
#[derive(Clone, Copy)]
pub(super) enum DrawPurpose {
    Radius,
    Centre,
    Rotation,
    Velocity,
    Spin,
}

/// The sizes of a procedural shape, as the scene file has them.
pub(super) type ShapeSizes = BTreeMap<Spanned<String>, Spanned<Real>>;

/// What a group's bodies look like, as the scene file has it.
#[derive(Clone, Copy)]
pub(super) enum BodyForm<'a> {
    /// A mesh file.
    File(&'a Spanned<String>),
    /// A procedural shape.
    Procedural(&'a Spanned<String>, &'a ShapeSizes),
}

/// A checked group: what it looks like and how many bodies it has.
pub(super) struct BodyGroup<'a> {
    pub(super) spec: &'a GroupSpec,
    pub(super) number: u64,
    pub(super) seed: u64,
    pub(super) seeding: Seeding,
    pub(super) form: BodyForm<'a>,
    pub(super) origin: Origin,
    pub(super) bodies: usize,
}

impl BodyGroup<'_> {
    /// The group's stream of draws for one purpose: what one purpose draws leaves the others as
    /// they are.
    pub(super) fn stream(&self, purpose: DrawPurpose) -> Stream {
        Stream::new(self.seed, self.number * 8 + purpose as u64)
    }

    /// Whether its bodies are placed by the seed, uniformly in the box.
    pub(super) fn is_uniform(&self) -> bool {
        let placement = self.spec.placement.as_ref().map(Spanned::get_ref);
        self.spec.poses.is_none() && matches!(placement, None | Some(Placement::Uniform))
    }

    /// The draws of the group's bodies for one purpose.
    pub(super) fn draws(&self, purpose: DrawPurpose) -> BodyDraws {
        BodyDraws {
            seed: self.seed,
            seeding: self.seeding,
            stream: self.stream(purpose),
            number: self.number * 8 + purpose as u64,
        }
    }
}

/// Streams of bodies are numbered from here on, above those of groups and effects.
const FIRST_BODY_STREAM: u64 = 1 << 63;

/// What a group's bodies draw from for one purpose.
pub(super) struct BodyDraws {
    seed: u64,
    seeding: Seeding,
    stream: Stream,
    number: u64,
}

impl BodyDraws {
    /// The bodies of the group that must draw, in order, so that those in `wanted` have what is
    /// theirs.
    pub(super) fn visited(&self, wanted: &Range<usize>) -> Range<usize> {
        match self.seeding {
            Seeding::ByGroup => 0..wanted.end,
            Seeding::ByBody => wanted.clone(),
        }
    }

    /// What the group draws from for all its bodies, before any of them.
    pub(super) fn common(&mut self) -> &mut Stream {
        &mut self.stream
    }

    /// What the next body draws from, the group's body `index`.
    pub(super) fn of(&mut self, index: usize) -> &mut Stream {
        if self.seeding == Seeding::ByBody {
            // Fewer than 2²⁸ groups, and a group has fewer than 2³² bodies.
            let stream = FIRST_BODY_STREAM | self.number << 32 | index as u64;
            self.stream = Stream::new(self.seed, stream);
        }
        &mut self.stream
    }
}

impl SceneFile {
    /// Checks each group's keys against each other, for a scene that this many ranks share.
    pub(super) fn groups(&self, ranks: usize) -> Result<Vec<BodyGroup<'_>>, SceneError> {
        let mut groups = Vec::new();
        let mut total = 0_usize;
        for (number, spec) in self.spec.bodies.iter().enumerate() {
            let group = self.group(number as u64, spec)?;
            total = total.saturating_add(group.bodies);
            if total.div_ceil(ranks) > MOST_BODIES || total > MOST_BODY_NUMBERS {
                let span = group.spec.count.as_ref().map_or(spec.span(), Spanned::span);
                let message = format!("{total} bodies are too many");
                let most = MOST_BODIES.saturating_mul(ranks).min(MOST_BODY_NUMBERS);
                let hint = format!("a scene has up to {most} bodies");
                return Err(self.wrong(span, &message, &hint));
            }
            groups.push(group);
        }
        if total == 0 {
            let end = self.source.text.len();
            return Err(self.wrong(
                end..end,
                "the scene has no bodies",
                "add [[bodies]] with a mesh or shape, and count = … or poses = …",
            ));
        }
        Ok(groups)
    }

    fn group<'a>(
        &self,
        number: u64,
        spanned: &'a Spanned<GroupSpec>,
    ) -> Result<BodyGroup<'a>, SceneError> {
        let spec = spanned.get_ref();
        let form = self.form_of(spanned)?;
        let bodies = self.bodies_of(spanned)?;
        let origin = match &spec.origin {
            Some(origin) => *origin.get_ref(),
            None if spec.poses.is_some() && spec.radius.is_none() => Origin::File,
            None => Origin::Ball,
        };
        self.check_motion(spec, bodies)?;
        self.check_place(spec, origin)?;
        Ok(BodyGroup {
            spec,
            number,
            seed: self.spec.seed,
            seeding: self.spec.seeding,
            form,
            origin,
            bodies,
        })
    }

    /// What the group's bodies look like: a mesh file or a procedural shape.
    fn form_of<'a>(&self, spanned: &'a Spanned<GroupSpec>) -> Result<BodyForm<'a>, SceneError> {
        let spec = spanned.get_ref();
        match (&spec.mesh, &spec.shape) {
            (Some(mesh), None) => match spec.sizes.first_key_value() {
                None => Ok(BodyForm::File(mesh)),
                Some((size, _)) => Err(self.wrong(
                    size.span(),
                    "`sizes` belong to a `shape`",
                    "scale a mesh by `scale` or `radius`",
                )),
            },
            (None, Some(shape)) => Ok(BodyForm::Procedural(shape, &spec.sizes)),
            (Some(_), Some(shape)) => Err(self.wrong(
                shape.span(),
                "`mesh` and `shape` exclude each other",
                "keep one of them",
            )),
            (None, None) => Err(self.wrong(
                spanned.span(),
                "bodies without a form",
                "add mesh = \"file\" or shape = \"name\"",
            )),
        }
    }

    /// How many bodies the group has.
    fn bodies_of(&self, spanned: &Spanned<GroupSpec>) -> Result<usize, SceneError> {
        let spec = spanned.get_ref();
        match (&spec.count, &spec.poses) {
            // A u32 fits into the usize of every machine that holds such a scene.
            (Some(count), None) => Ok(count.get_ref().get() as usize),
            (None, Some(poses)) => Ok(poses.get_ref().len()),
            (Some(_), Some(poses)) => Err(self.wrong(
                poses.span(),
                "`count` and `poses` exclude each other",
                "keep one of them",
            )),
            (None, None) => Err(self.wrong(
                spanned.span(),
                "how many bodies?",
                "add count = … or poses = [[qx, qy, qz, qw, tx, ty, tz]]",
            )),
        }
    }

    /// Checks the keys that say where bodies begin and how large they are.
    fn check_place(&self, spec: &GroupSpec, origin: Origin) -> Result<(), SceneError> {
        if let (Some(placement), Some(_)) = (&spec.placement, &spec.poses) {
            return Err(self.wrong(
                placement.span(),
                "`placement` and `poses` exclude each other",
                "keep one of them",
            ));
        }
        match &spec.radius {
            Some(radius) if origin == Origin::File => Err(self.wrong(
                radius.span(),
                "`radius` scales, origin = \"file\" keeps the size",
                "keep one of them",
            )),
            Some(radius) if radius.get_ref().min == 0.0 => Err(self.wrong(
                radius.span(),
                "a radius of 0",
                "a radius is above 0; leave it out to keep the mesh's size",
            )),
            _ => Ok(()),
        }
    }

    /// Checks the keys that say how bodies begin to move.
    fn check_motion(&self, spec: &GroupSpec, bodies: usize) -> Result<(), SceneError> {
        if let Some(velocities) = &spec.velocities {
            if let Some(speed) = &spec.speed {
                return Err(self.wrong(
                    speed.span(),
                    "`speed` and `velocities` exclude each other",
                    "keep one of them",
                ));
            }
            let given = velocities.get_ref().len();
            if spec.poses.is_none() || given != bodies {
                return Err(self.wrong(
                    velocities.span(),
                    &format!("{given} velocities for {bodies} bodies"),
                    "give one velocity a pose; seeded bodies take `speed`",
                ));
            }
        }
        let moving =
            spec.speed.as_ref().map(Spanned::span).or(spec.velocities.as_ref().map(Spanned::span));
        match moving {
            Some(span) if spec.fixed => Err(self.wrong(
                span,
                "static bodies don't move",
                "leave out the velocity, or `static = true`",
            )),
            _ => Ok(()),
        }
    }

    /// An error at a place of the file, with its remedy.
    pub(super) fn wrong(&self, span: Range<usize>, message: &str, hint: &str) -> SceneError {
        self.source.error(span, message, hint.to_owned())
    }
}
