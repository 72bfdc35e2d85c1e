//! What must not change between two frames of a culler, and the checks that it has not changed.
//!
//! The number of bodies, the `dynamic` flags and the shapes are compared in every frame: a change
//! before [`Culler::refresh`] is an error. The poses of static bodies are compared, too, and the
//! culler follows those that have changed. Translations are checked where they are read for the
//! volumes.

use std::ops::Range;

use super::{BodySet, CullError, Culler};
use crate::bodies::Bodies;
use crate::bodies::contract::{check_columns, check_numbers, check_poses};
use crate::settings::{CullSettings, DirectionSet};
use crate::simd::in_default_mode;
use crate::volume::{Shape, has_sound_size};

/// The copy of the bodies that a culler keeps: their shapes, which of them may move, and all poses
/// if some may not.
pub(super) fn fixed(bodies: &Bodies) -> Bodies {
    if bodies.dynamic.contains(&false) {
        return bodies.clone();
    }
    Bodies { shape: bodies.shape.clone(), dynamic: bodies.dynamic.clone(), ..Bodies::default() }
}

/// The runs of static bodies.
pub(super) fn static_runs(bodies: &Bodies) -> Vec<Range<usize>> {
    let mut end = 0;
    let runs = bodies.dynamic.chunk_by(|a, b| a == b).map(|run| {
        end += run.len();
        (run[0], end - run.len()..end)
    });
    runs.filter(|(moves, _)| !moves).map(|(_, run)| run).collect()
}

/// Whether two columns differ in a bit. It has no early exit, so that the compiler vectorises it.
fn differ<const N: usize>(now: &[[f32; N]], then: &[[f32; N]]) -> bool {
    let numbers = now.as_flattened().iter().zip(then.as_flattened());
    numbers.fold(0, |bits, (now, then)| bits | (now.to_bits() ^ then.to_bits())) != 0
}

/// Bodies whose poses one thread compares at a time.
const BODIES_PER_TASK: usize = 1 << 12;

/// How to mend a shape that is far from its origin.
pub(crate) const FAR_SHAPE_HELP: &str = "keep its bodies in a `World`, whose translations are f64; or move the mesh's vertices near its \
                              origin; or build it with `Origin::Ball` and pose it by the centre of its ball, `Shape::offset`";

/// Rejects shapes that f32 poses can't place: those far from the origin that the poses refer to.
pub(super) fn near(shapes: &[Shape]) -> Result<(), CullError> {
    match shapes.iter().find(|shape| shape.is_far()) {
        None => Ok(()),
        Some(shape) => Err(CullError::Shape {
            shape: shape.name.clone(),
            problem: format!(
                "lies far from the origin of its file, about {:?}: in f32 its vertices would move by more than 2^-20 of its size, \
                 and a culler's poses are f32",
                shape.offset
            ),
            hint: FAR_SHAPE_HELP,
        }),
    }
}

/// If or-DOPs are tested, checks that all shapes have the slab directions of the first.
pub(super) fn directions(shapes: &[Shape], settings: &CullSettings) -> Result<(), CullError> {
    let first = shapes.first().map(|shape| shape.ordop.directions);
    let wanted = first.filter(|_| !settings.strategy.scheme().has_boxes());
    let mut others = shapes.iter();
    others.try_for_each(|shape| same_directions(shape, wanted))
}

/// Checks that a shape is at most 2⁶⁰ in size and has the slab directions `wanted`.
pub(super) fn shape(shape: &Shape, wanted: Option<DirectionSet>) -> Result<(), CullError> {
    if !has_sound_size(shape) {
        return Err(CullError::Shape {
            shape: shape.name.clone(),
            problem: format!("has reach {} and {:?}", shape.reach, shape.ball),
            hint: "sizes are finite and at most 2^60",
        });
    }
    same_directions(shape, wanted)
}

fn same_directions(shape: &Shape, wanted: Option<DirectionSet>) -> Result<(), CullError> {
    let found = shape.ordop.directions;
    match wanted.filter(|&wanted| wanted != found) {
        None => Ok(()),
        Some(wanted) => Err(CullError::Shape {
            shape: shape.name.clone(),
            problem: format!("has an or-DOP of k = {found}, shapes before it have k = {wanted}"),
            hint: "build all shapes with the same `ShapeSpec::directions`, or use `Shape::with_directions`",
        }),
    }
}

impl Culler {
    /// Reads again what [`Self::cull`] takes as fixed: the number of bodies, their shapes, which of
    /// them may move, and the poses of static bodies. Costs about as much as a frame. Groups are
    /// dropped if the number of bodies changes.
    ///
    /// # Errors
    /// Bodies that break the contract; an interest in a body that no longer exists. The culler
    /// stays as it was.
    pub fn refresh(&mut self, bodies: &Bodies) -> Result<(), CullError> {
        in_default_mode(|| {
            check_columns(bodies)?;
            check_numbers(&bodies.shape, self.models.frames.len())?;
            check_poses(bodies, 0..bodies.len())?;
            self.setup.settings.check(bodies.len())?;
            if bodies.len() != self.set.fixed.len() {
                self.set.groups = None;
            }
            self.replace(bodies, &vec![true; bodies.len()]);
            self.set.watched = static_runs(bodies);
            Ok(())
        })
    }

    /// Checks that the number of bodies, the `dynamic` flags and the shapes have not changed.
    pub(super) fn check_set(&self, bodies: &Bodies) -> Result<(), CullError> {
        check_columns(bodies)?;
        let (made_for, given) = (self.set.fixed.len(), bodies.len());
        let what = if given != made_for {
            format!("{given} bodies in place of {made_for}")
        } else if bodies.dynamic != self.set.fixed.dynamic {
            let mut flags = bodies.dynamic.iter().zip(&self.set.fixed.dynamic);
            let body = flags.position(|(now, then)| now != then).unwrap_or(0);
            let now = if bodies.dynamic[body] { "dynamic" } else { "static" };
            format!("body {body} has become {now}")
        } else if bodies.shape != self.set.fixed.shape {
            let mut shapes = bodies.shape.iter().zip(&self.set.fixed.shape);
            let body = shapes.position(|(now, then)| now != then).unwrap_or(0);
            let [now, then] = [bodies, &self.set.fixed].map(|bodies| bodies.shape[body]);
            format!("body {body} has shape {now} in place of {then}")
        } else {
            return Ok(());
        };
        Err(CullError::Changed { what })
    }

    /// Takes the static bodies to where they are now, if that isn't where they were.
    pub(super) fn follow_static(&mut self, bodies: &Bodies) -> Result<(), CullError> {
        let BodySet { watched, fixed, .. } = &self.set;
        let stays = |run: Range<usize>| {
            !differ(&bodies.rotation[run.clone()], &fixed.rotation[run.clone()])
                && !differ(&bodies.translation[run.clone()], &fixed.translation[run])
        };
        let pool = self.threads.get();
        let stay = |run: &Range<usize>| {
            let part = |part: Range<usize>| run.start + part.start..run.start + part.end;
            pool.all(run.len(), BODIES_PER_TASK, |range| stays(part(range)))
        };
        if watched.iter().all(stay) {
            return Ok(());
        }
        in_default_mode(|| {
            let mut runs = self.set.watched.iter();
            runs.try_for_each(|run| check_poses(bodies, run.clone()))?;
            self.exchange(bodies, &vec![true; bodies.len()]);
            Ok(())
        })
    }

    /// Finds the body whose pose breaks the contract, and resets what the next frame would sort by.
    #[cold]
    pub(super) fn check_moved(&mut self, bodies: &Bodies) -> Result<(), CullError> {
        let outcome = check_poses(bodies, 0..bodies.len());
        if outcome.is_err() {
            self.volumes.balls[..self.set.places.moving].fill([0.0; 4]);
        }
        Ok(outcome?)
    }
}
