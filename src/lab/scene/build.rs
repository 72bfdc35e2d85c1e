//! From a scene file to a scene: each group is checked, its shapes are made, its bodies are placed by the seed.

use toml::Spanned;

use super::error::SceneError;
use super::file::{Placement, SceneFile};
use super::group::{Group, Purpose};
use super::library::{Form, Library};
use super::placement::Placer;
use super::{Scene, density};
use crate::bodies::Bodies;
use crate::bodies::contract::{ContractError, check_bodies};
use crate::lab::effects::world_centre;
use crate::lab::number::Positive;

impl SceneFile {
    /// Builds the scene: reads meshes, builds shapes, places bodies.
    ///
    /// # Errors
    /// Everything that a value can't show alone: exclusive keys, missing or broken meshes, a box too small, bodies
    /// outside of the contract, effects or culling that the scene can't have.
    pub fn build(&self) -> Result<Scene, SceneError> {
        let groups = self.groups()?;
        let mut library = Library::default();
        let mut bodies = Bodies::default();
        for group in &groups {
            self.add_shapes(group, &mut library, &mut bodies)?;
        }
        let side = self.side(&groups, &library, &bodies)?;
        for group in &groups {
            self.add_poses(group, side, &library, &mut bodies)?;
            self.add_velocities(group, &mut bodies);
        }
        let (shapes, construct_seconds) = library.into_shapes();
        check_bodies(&bodies, &shapes).map_err(|error| self.contract_error(&groups, &error))?;
        self.spec.cull.check(bodies.len())?;
        let scene = Scene {
            name: self.spec.name.clone(),
            seed: self.spec.seed,
            frames: self.spec.frames.get(),
            dt: self.spec.dt.0,
            side,
            shapes,
            bodies,
            effects: self.spec.effects.clone(),
            cull: self.spec.cull.clone(),
            construct_seconds,
        };
        match scene.start_effects() {
            Ok(_) => Ok(scene),
            Err(error) => Err(self.wrong(error.span.clone(), &error.to_string(), error.hint)),
        }
    }

    /// Draws the group's radii, makes the shapes and adds one shape and dynamic entry a body.
    fn add_shapes(
        &self,
        group: &Group<'_>,
        library: &mut Library,
        bodies: &mut Bodies,
    ) -> Result<(), SceneError> {
        let mesh = library.mesh(self, group.form)?;
        let mut draws = group.stream(Purpose::Radius);
        for _ in 0..group.bodies {
            let radius = group
                .spec
                .radius
                .as_ref()
                .map(|range| draws.radius(*range.get_ref()));
            let shape = library.shape(mesh, group.origin, radius, &self.spec.cull);
            let shape = shape.map_err(|(message, hint)| {
                let span = match group.form {
                    Form::File(name) | Form::Procedural(name, _) => name.span(),
                };
                self.source.error(
                    group.spec.radius.as_ref().map_or(span, Spanned::span),
                    message,
                    hint,
                )
            })?;
            bodies.shape.push(shape);
            bodies.dynamic.push(!group.spec.fixed);
        }
        Ok(())
    }

    /// The box's side: given, or from the seeded bodies' radii and the wished density.
    fn side(
        &self,
        groups: &[Group<'_>],
        library: &Library,
        bodies: &Bodies,
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
        let mut first = 0;
        let mut radii = Vec::new();
        for group in groups {
            let shapes = &bodies.shape[first..first + group.bodies];
            first += group.bodies;
            match &group.spec.placement {
                _ if group.spec.poses.is_some() => {}
                Some(placement) if *placement.get_ref() != Placement::Uniform => {
                    let hint = "give the side instead of partners";
                    return wrong(
                        placement.span(),
                        "`partners` is the density of uniform placement",
                        hint,
                    );
                }
                _ => radii.extend(shapes.iter().map(|&shape| library.get(shape).ball.radius)),
            }
        }
        let Positive(wished) = *partners.get_ref();
        let side = density::side(radii.into_iter(), wished);
        if side > 0.0 {
            return Ok(Some(side));
        }
        wrong(
            partners.span(),
            "`partners` needs two seeded bodies that have an extent",
            "give the side instead",
        )
    }

    fn add_poses(
        &self,
        group: &Group<'_>,
        side: Option<f32>,
        library: &Library,
        bodies: &mut Bodies,
    ) -> Result<(), SceneError> {
        let Some(poses) = &group.spec.poses else {
            return self.place(group, side, library, bodies);
        };
        for pose in poses.get_ref() {
            let [qx, qy, qz, qw, tx, ty, tz] = *pose.get_ref();
            bodies.rotation.push([qx, qy, qz, qw]);
            bodies.translation.push([tx, ty, tz]);
        }
        Ok(())
    }

    fn place(
        &self,
        group: &Group<'_>,
        side: Option<f32>,
        library: &Library,
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
        let shapes = bodies.shape[first..first + group.bodies].to_vec();
        let radius = |shape: &u32| library.get(*shape).ball.radius;
        let widest = shapes.iter().map(radius).fold(0.0, f32::max);
        let half = 0.5 * side;
        if half < widest {
            let bounds = self.spec.bounds.as_ref().map_or(count_span, Spanned::span);
            let message =
                format!("a box of side {side} is too small for bodies of radius {widest}");
            let hint = format!(
                "the side must be at least {}, for room to move well above",
                2.0 * widest
            );
            return Err(self.wrong(bounds, &message, &hint));
        }
        let wished = group.spec.placement.as_ref();
        let placement = wished.map_or(Placement::Uniform, |placement| *placement.get_ref());
        let placer = Placer::new(
            placement,
            group.bodies,
            half,
            widest,
            group.stream(Purpose::Centre),
        );
        let mut placer = placer.map_err(|(message, hint)| {
            self.wrong(wished.map_or(count_span, Spanned::span), &message, &hint)
        })?;
        let mut turns = group.stream(Purpose::Rotation);
        for shape in &shapes {
            let ball = library.get(*shape).ball;
            let rotation = turns.rotation();
            let centre = placer.centre(ball.radius);
            // The ball's centre is placed: t is what brings it there, the ball's centre itself for origin = "ball".
            let offset = world_centre(ball.centre.to_array(), &rotation, &[0.0; 3]);
            bodies.rotation.push(rotation);
            bodies
                .translation
                .push([0, 1, 2].map(|axis| centre[axis] - offset[axis]));
        }
        Ok(())
    }

    /// Draws or copies velocities, and the angular velocities of dynamic bodies where the scene lists `spin`.
    fn add_velocities(&self, group: &Group<'_>, bodies: &mut Bodies) {
        let spec = group.spec;
        if let Some(velocities) = &spec.velocities {
            bodies
                .velocity
                .extend(velocities.get_ref().iter().map(|v| *v.get_ref()));
        } else if let Some(speed) = &spec.speed {
            let mut draws = group.stream(Purpose::Velocity);
            bodies
                .velocity
                .extend((0..group.bodies).map(|_| draws.vector(*speed.get_ref())));
        } else {
            bodies
                .velocity
                .resize(bodies.velocity.len() + group.bodies, [0.0; 3]);
        }
        match &self.spec.effects.spin {
            Some(spin) if !spec.fixed => {
                let mut draws = group.stream(Purpose::Spin);
                bodies
                    .spin
                    .extend((0..group.bodies).map(|_| draws.vector(spin.get_ref().rate)));
            }
            _ => bodies
                .spin
                .resize(bodies.spin.len() + group.bodies, [0.0; 3]),
        }
    }

    /// Points at what the file says of the body: its velocity, its pose, or its group.
    fn contract_error(&self, groups: &[Group<'_>], error: &ContractError) -> SceneError {
        let mut first = 0;
        let mut span = 0..0;
        for (group, table) in groups.iter().zip(&self.spec.bodies) {
            if (first..first + group.bodies).contains(&error.body) {
                let at = error.body - first;
                let pose = group
                    .spec
                    .poses
                    .as_ref()
                    .map(|poses| poses.get_ref()[at].span());
                let velocity = group
                    .spec
                    .velocities
                    .as_ref()
                    .map(|list| list.get_ref()[at].span());
                let narrow = if error.quantity == "velocity" {
                    velocity
                } else {
                    pose
                };
                span = narrow.unwrap_or(table.span());
            }
            first += group.bodies;
        }
        self.wrong(span, &error.to_string(), error.hint)
    }
}
