//! Calibration of worlds, on [scenes](super::world_design) in which most bodies sleep.

use super::construct::volume_seconds;
use super::design::{SCENE_STEP, SCENES};
use super::explain::{Round, TurnObservation, VariantTurns};
use super::explain_world;
use super::predict::Prices;
use super::world_design;
use crate::measure::culling::Culling;
use crate::measure::turns::{FrameTimes, Regime, Turns};
use crate::measure::variant::Variant;
use crate::scene::Scene;
use crate::simulate::{SimulationError, Trajectory};
use sdop::bodies::Bodies;
use sdop::simd::Tier;
use sdop::volume::Shape;

/// Frames of a calibration scene that are timed in a round, after the one that a world begins with.
const TIMED_FRAMES: usize = 8;

/// The calibration of some worlds.
pub(super) struct WorldCalibration {
    variants: Vec<(Variant, Vec<Shape>)>,
    subjects: Vec<(Scene, Trajectory)>,
    turns: Turns,
    tier: Tier,
}

impl WorldCalibration {
    /// Prepares the calibration scenes; none if there is no variant.
    ///
    /// # Errors
    /// The effects can't be simulated.
    pub fn new(scene: &Scene, variants: &[Variant], tier: Tier) -> Result<Self, SimulationError> {
        let subject = |scene: Scene| {
            let trajectory = Trajectory::new(&scene)?.with_frames(u32::MAX);
            Ok((scene, trajectory))
        };
        let with_shapes = |variant: &Variant| (variant.clone(), variant.shapes(scene));
        let scenes = world_design::scenes(scene).take(match variants {
            [] => 0,
            _ => SCENES,
        });
        Ok(Self {
            variants: variants.iter().map(with_shapes).collect(),
            subjects: scenes
                .map(subject)
                .collect::<Result<_, SimulationError>>()?,
            turns: Turns::from_stream(2),
            tier,
        })
    }

    /// Measures all calibration scenes, and returns the prices of each variant for warm and for
    /// cold frames.
    ///
    /// # Errors
    /// The settings can't be carried out, or a body leaves the contract.
    pub fn round(&mut self, round: Round) -> Result<[Vec<Prices>; 2], SimulationError> {
        let mut observed = vec![[Vec::new(), Vec::new()]; self.variants.len()];
        for number in 0..self.subjects.len() {
            self.turn(number * SCENE_STEP % SCENES, &mut observed)?;
        }
        Ok(std::array::from_fn(|regime| {
            let variants = self.variants.iter().zip(&observed);
            let all: Vec<_> = variants
                .map(|((variant, shapes), observed)| VariantTurns {
                    variant,
                    turns: &observed[regime],
                    built: volume_seconds(variant, shapes),
                    splits: &[],
                })
                .collect();
            explain_world::prices(&all, round)
        }))
    }

    /// One turn of each variant on a calibration scene. Appends what it observes of warm and of
    /// cold frames.
    fn turn(
        &mut self,
        subject: usize,
        observed: &mut [[Vec<TurnObservation>; 2]],
    ) -> Result<(), SimulationError> {
        let (scene, trajectory) = &mut self.subjects[subject];
        let mut poses: Vec<Bodies> = Vec::new();
        for _ in 0..=TIMED_FRAMES {
            poses.extend(trajectory.advance()?.cloned());
        }
        let Some((first, poses)) = poses.split_first() else {
            return Ok(());
        };
        let begun = Scene {
            bodies: first.clone(),
            ..scene.clone()
        };
        let worlds = self.variants.iter();
        let mut worlds = worlds
            .map(|(variant, shapes)| variant.culling_of(shapes, &begun, self.tier))
            .collect::<Result<Vec<Culling>, _>>()?;
        let mut times = vec![FrameTimes::default(); worlds.len()];
        self.turns
            .round(&mut worlds, poses, |timed| times[timed.number].push(&timed));
        for ((world, times), observed) in worlds.iter().zip(&times).zip(observed) {
            world.accepted()?;
            for (&regime, all) in Regime::ALL.iter().zip(observed) {
                all.push(TurnObservation {
                    bodies: first.len(),
                    frames: poses.len(),
                    counts: world.counts(),
                    stages: times.medians(regime),
                    construct: world.construct_seconds(),
                });
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use std::path::Path;

    use super::*;
    use crate::scene::SceneFile;

    /// Few enough bodies move that every frame keeps the others. Of those queried, many or few have
    /// just been woken.
    #[test]
    fn calibration_worlds_keep_bodies() {
        let text = "name = \"a\"\nframes = 2\n[box]\npartners = 1\n\
                    [[bodies]]\nshape = \"box\"\ncount = 600\n\
                    [effects]\nmotion = true\nspin = { rate = 1 }\n";
        let file = SceneFile::parse(text, "a.toml", Path::new(".")).unwrap();
        let scene = file.build().unwrap();
        let spheres = [Variant::spheres(&scene.cull).in_world()];
        let mut worlds = WorldCalibration::new(&scene, &spheres, Tier::detect()).unwrap();
        let mut observed = vec![[Vec::new(), Vec::new()]];
        for subject in 0..SCENES {
            worlds.turn(subject, &mut observed).unwrap();
        }
        let mut woken = Vec::new();
        for turn in &observed[0][0] {
            let rest = turn.counts.culler.rest;
            assert_eq!(rest.queried + rest.kept, (turn.bodies * turn.frames) as u64);
            assert!(rest.queried >= turn.frames as u64 && rest.kept > rest.queried);
            woken.push(rest.thawed as f64 / rest.queried as f64);
        }
        woken.sort_by(f64::total_cmp);
        assert!(woken[2] < 0.15 && woken[SCENES - 3] > 0.25, "{woken:?}");
    }
}
