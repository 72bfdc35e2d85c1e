//! Builds a scene from its file: checks the groups, builds the shapes, and places the bodies by the
//! seed.

use std::ops::Range;

use toml::Spanned;

use super::density::PowerSums;
use super::error::SceneError;
use super::file::{Placement, SceneFile};
use super::fine_translations::FineTranslations;
use super::group::{BodyDraws, BodyForm, BodyGroup, DrawPurpose};
use super::library::ShapeLibrary;
use super::placement::Placer;
use super::{Scene, Share};
use crate::effects::{Velocities, world_centre};
use crate::number::{Interval, Positive};
use sdop::bodies::Bodies;
use sdop::bodies::contract::ContractError;
use sdop::volume::check_bodies;

impl SceneFile {
    /// Builds the scene to be studied in f32: as [`Self::build_exact`], with translations rounded
    /// to f32.
    ///
    /// # Errors
    /// As [`Self::build_exact`]; translations so far out that rounding would move a body by more
    /// than 2⁻¹⁰ of its radius.
    pub fn build(&self) -> Result<Scene, SceneError> {
        let mut scene = self.build_exact()?;
        if let Some((body, moved)) = scene.fine.coarse(&scene.bodies, &scene.shapes) {
            let span = self.span_of(&self.groups(1)?, body, false);
            let message =
                format!("body {body}: rounding its translation to f32 moves it by {moved}");
            let hint = "`sdop run` culls f64 translations; other commands study f32 ones: place the scene near the origin for them";
            return Err(self.wrong(span, &message, hint));
        }
        scene.fine = FineTranslations::default();
        Ok(scene)
    }

    /// Builds the scene: reads meshes, builds shapes, places bodies. Translations of `poses` that
    /// f32 doesn't hold are kept.
    ///
    /// # Errors
    /// Everything that a value can't show alone: exclusive keys, missing or broken meshes, a box
    /// too small, bodies outside of the contract, effects or culling that the scene can't have.
    pub fn build_exact(&self) -> Result<Scene, SceneError> {
        self.build_share(0, 1)
    }

    /// Builds the share of rank `rank` of `ranks`: the same scene with a part of its bodies, each
    /// as in the whole.
    ///
    /// Shapes are made for all bodies, so that all ranks number them alike. With
    /// [`Seeding::ByBody`](super::file::Seeding::ByBody) a rank draws poses and velocities of its
    /// own bodies alone.
    ///
    /// # Errors
    /// As [`Self::build_exact`]; what is wrong with a body alone, only the rank that holds it
    /// finds.
    pub fn build_share(&self, rank: usize, ranks: usize) -> Result<Scene, SceneError> {
        let groups = self.groups(ranks)?;
        let share = share_of(&groups, rank, ranks);
        let mut library = ShapeLibrary::default();
        let (mut bodies, mut velocities) = (Bodies::default(), Velocities::default());
        let mut fine = FineTranslations::default();
        let mut sizes = RadiusSums::default();
        for (group, run) in runs(&groups) {
            let held = share.within(&run);
            self.add_shapes(group, held, &mut library, &mut bodies, &mut sizes)?;
        }
        let side = self.side(&groups, &sizes)?;
        for ((group, run), widest) in runs(&groups).zip(&sizes.widest) {
            let held = share.within(&run);
            match &group.spec.poses {
                Some(poses) => {
                    for pose in &poses.get_ref()[held.clone()] {
                        add_pose(*pose.get_ref(), &mut bodies, &mut fine);
                    }
                }
                None => self.place(group, held.clone(), (side, *widest), &library, &mut bodies)?,
            }
            self.add_velocities(group, held, &mut velocities);
        }
        let (shapes, construct_seconds) = library.into_shapes();
        check_bodies(&bodies, &shapes)
            .and_then(|()| fine.check(&bodies))
            .and_then(|()| velocities.check(bodies.len()))
            .map_err(|error| ContractError { body: error.body + share.held.start, ..error })
            .map_err(|error| self.contract_error(&groups, &error))?;
        self.spec.cull.check(share.all)?;
        let scene = Scene {
            name: self.spec.name.clone(),
            seed: self.spec.seed,
            frames: self.spec.frames.get(),
            dt: self.spec.dt.0,
            side,
            shapes,
            bodies,
            fine,
            share: (ranks > 1).then_some(share),
            velocities,
            effects: self.spec.effects.clone(),
            cull: self.spec.cull.clone(),
            construct_seconds,
        };
        match scene.start_effects() {
            Ok(_) => Ok(scene),
            Err(error) => Err(self.wrong(error.span.clone(), &error.to_string(), error.hint)),
        }
    }

    /// Draws the radii of all the group's bodies, makes their shapes, and adds one shape and one
    /// dynamic entry per body held.
    fn add_shapes(
        &self,
        group: &BodyGroup<'_>,
        held: Range<usize>,
        library: &mut ShapeLibrary,
        bodies: &mut Bodies,
        sizes: &mut RadiusSums,
    ) -> Result<(), SceneError> {
        let mesh = library.mesh(self, group)?;
        let mut draws = group.draws(DrawPurpose::Radius);
        let range = group.spec.radius.as_ref().map(|range| *range.get_ref());
        let uniform = group.is_uniform();
        let mut widest = 0.0_f32;
        let mut last = None;
        for index in 0..group.bodies {
            let radius = match range {
                Some(range) if range.min < range.max => Some(draws.of(index).radius(range)),
                Some(range) => Some(range.min),
                None => None,
            };
            let shape = match last {
                Some((known, shape)) if known == radius => Ok(shape),
                _ => library.shape(mesh, group.origin, radius, &self.spec.cull),
            };
            let shape = shape.map_err(|(message, hint)| {
                let span = match group.form {
                    BodyForm::File(name) | BodyForm::Procedural(name, _) => name.span(),
                };
                self.source.error(
                    group.spec.radius.as_ref().map_or(span, Spanned::span),
                    message,
                    hint,
                )
            })?;
            last = Some((radius, shape));
            let radius = library.get(shape).ball.radius;
            widest = widest.max(radius);
            if uniform {
                sizes.uniform.add(radius);
            }
            if held.contains(&index) {
                bodies.shape.push(shape);
                bodies.dynamic.push(!group.spec.fixed);
            }
        }
        sizes.widest.push(widest);
        Ok(())
    }

    /// The box's side: as given, or from the seeded bodies' radii and the requested density.
    fn side(
        &self,
        groups: &[BodyGroup<'_>],
        sizes: &RadiusSums,
    ) -> Result<Option<f32>, SceneError> {
        let Some(bounds) = &self.spec.bounds else {
            return Ok(None);
        };
        let wrong = |span, message, hint| Err(self.wrong(span, message, hint));
        let partners = match (&bounds.get_ref().side, &bounds.get_ref().partners) {
            (Some(side), None) => return Ok(Some(side.get_ref().0)),
            (None, Some(partners)) => partners,
            (Some(_), Some(partners)) => {
                return wrong(
                    partners.span(),
                    "`side` and `partners` exclude each other",
                    "keep one of them",
                );
            }
            (None, None) => {
                return wrong(
                    bounds.span(),
                    "a box without a size",
                    "add side = … or partners = …",
                );
            }
        };
        for group in groups.iter().filter(|group| group.spec.poses.is_none()) {
            if let (Some(placement), false) = (&group.spec.placement, group.is_uniform()) {
                let hint = "give the side instead of partners";
                return wrong(
                    placement.span(),
                    "`partners` is the density of uniform placement",
                    hint,
                );
            }
        }
        let Positive(wished) = *partners.get_ref();
        let side = sizes.uniform.side(wished);
        if side > 0.0 {
            return Ok(Some(side));
        }
        wrong(
            partners.span(),
            "`partners` needs two seeded bodies that have an extent",
            "give the side instead",
        )
    }

    /// Places the bodies held by the seed; the pair is the box's side and the radius of the group's
    /// largest ball.
    fn place(
        &self,
        group: &BodyGroup<'_>,
        held: Range<usize>,
        (side, widest): (Option<f32>, f32),
        library: &ShapeLibrary,
        bodies: &mut Bodies,
    ) -> Result<(), SceneError> {
        let first = bodies.translation.len();
        let count_span = group.spec.count.as_ref().map_or(0..0, Spanned::span);
        let Some(side) = side else {
            return Err(self.wrong(
                count_span,
                "seeded bodies need a box",
                "add [box] with side = … or partners = …",
            ));
        };
        let half = 0.5 * side;
        if half < widest {
            let bounds = self.spec.bounds.as_ref().map_or(count_span, Spanned::span);
            let message =
                format!("a box of side {side} is too small for bodies of radius {widest}");
            let hint =
                format!("the side must be at least {}, and larger for room to move", 2.0 * widest);
            return Err(self.wrong(bounds, &message, &hint));
        }
        let wished = group.spec.placement.as_ref();
        let placement = wished.map_or(Placement::Uniform, |placement| *placement.get_ref());
        let mut centres = group.draws(DrawPurpose::Centre);
        let placer = Placer::new(placement, group.bodies, half, widest, centres.common());
        let placer = placer.map_err(|(message, hint)| {
            self.wrong(wished.map_or(count_span, Spanned::span), &message, &hint)
        })?;
        let mut turns = group.draws(DrawPurpose::Rotation);
        for index in centres.visited(&held) {
            let (turns, centres) = (turns.of(index), centres.of(index));
            let rotation = turns.rotation();
            if !held.contains(&index) {
                placer.centre(0.0, centres);
                continue;
            }
            let shape = bodies.shape[first + index - held.start];
            let ball = library.get(shape).ball;
            let centre = placer.centre(ball.radius, centres);
            // The ball's centre is placed: t is what brings it there, the ball's centre itself for
            // origin = "ball".
            let offset = world_centre(ball.centre, &rotation, &[0.0; 3]);
            bodies.rotation.push(rotation);
            bodies.translation.push([0, 1, 2].map(|axis| centre[axis] - offset[axis]));
        }
        Ok(())
    }

    /// Draws or copies velocities, and the angular velocities of dynamic bodies where the scene
    /// lists `spin`.
    fn add_velocities(
        &self,
        group: &BodyGroup<'_>,
        held: Range<usize>,
        velocities: &mut Velocities,
    ) {
        let (spec, all) = (group.spec, velocities.linear.len() + held.len());
        let (linear, angular) = (&mut velocities.linear, &mut velocities.angular);
        if let Some(given) = &spec.velocities {
            linear.extend(given.get_ref()[held.clone()].iter().map(|v| *v.get_ref()));
        } else if let Some(speed) = &spec.speed {
            let draws = group.draws(DrawPurpose::Velocity);
            linear.extend(vectors(draws, *speed.get_ref(), &held));
        } else {
            linear.resize(all, [0.0; 3]);
        }
        match &self.spec.effects.spin {
            Some(spin) if !spec.fixed => {
                let draws = group.draws(DrawPurpose::Spin);
                angular.extend(vectors(draws, spin.get_ref().rate, &held));
            }
            _ => angular.resize(all, [0.0; 3]),
        }
    }

    /// Points at what the file says of the body: its velocity, its pose, or its group.
    fn contract_error(&self, groups: &[BodyGroup<'_>], error: &ContractError) -> SceneError {
        let span = self.span_of(groups, error.body, error.quantity == "velocity");
        self.wrong(span, &error.problem(), error.hint)
    }

    /// Where the file has a body's pose or velocity, or its group.
    fn span_of(&self, groups: &[BodyGroup<'_>], body: usize, velocity: bool) -> Range<usize> {
        let mut of_body = runs(groups).zip(&self.spec.bodies);
        let Some(((group, run), table)) = of_body.find(|((_, run), _)| run.contains(&body)) else {
            return 0..0;
        };
        let (spec, at) = (group.spec, body - run.start);
        let narrow = if velocity {
            let velocities = spec.velocities.as_ref();
            velocities.map(|list| list.get_ref()[at].span())
        } else {
            let poses = spec.poses.as_ref();
            poses.map(|list| list.get_ref()[at].span())
        };
        narrow.unwrap_or(table.span())
    }
}

/// Adds a pose as the file has it.
fn add_pose(pose: [f64; 7], bodies: &mut Bodies, fine: &mut FineTranslations) {
    let [qx, qy, qz, qw, tx, ty, tz] = pose;
    let body = bodies.translation.len();
    bodies.rotation.push([qx, qy, qz, qw].map(|x| x as f32));
    bodies.translation.push(fine.add(body, [tx, ty, tz]));
}

/// What is known of radii once all shapes are made.
#[derive(Default)]
struct RadiusSums {
    /// The sums over bodies that are spread uniformly.
    uniform: PowerSums,
    /// The largest of each group.
    widest: Vec<f32>,
}

/// Each group with its run of bodies in the whole scene.
fn runs<'a, 'b>(
    groups: &'b [BodyGroup<'a>],
) -> impl Iterator<Item = (&'b BodyGroup<'a>, Range<usize>)> + use<'a, 'b> {
    groups.iter().scan(0, |next, group| {
        let first = *next;
        *next += group.bodies;
        Some((group, first..*next))
    })
}

fn share_of(groups: &[BodyGroup<'_>], rank: usize, ranks: usize) -> Share {
    let moving = runs(groups).filter(|(group, _)| !group.spec.fixed);
    let moving = moving.map(|(_, run)| run).collect();
    let all = groups.iter().map(|group| group.bodies).sum();
    Share::of_rank(rank, ranks, all, moving)
}

/// Drawn vectors of the bodies held.
fn vectors(
    mut draws: BodyDraws,
    length: Interval,
    held: &Range<usize>,
) -> impl Iterator<Item = [f32; 3]> {
    draws.visited(held).filter_map(move |index| {
        let vector = draws.of(index).vector(length);
        held.contains(&index).then_some(vector)
    })
}
