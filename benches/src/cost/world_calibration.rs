//! Calibration of worlds, on [scenes](super::world_design) in which most bodies sleep.

use super::construct::volume_seconds;
use super::design::{SCENE_STEP, SCENES};
use super::explain::{Round, TurnObservation, VariantTurns};
use super::explain_world;
use super::predict::Prices;
use super::world_design;
use crate::measure::counts::Counts;
use crate::measure::culling::Culling;
use crate::measure::turns::{MOST_TURN_FRAMES, Turns};
use crate::measure::variant::Variant;
use crate::scene::Scene;
use crate::simulate::{SimulationError, Trajectory};
use sdop::bodies::Bodies;
use sdop::simd::Tier;
use sdop::volume::Shape;
use sdop_judge::contestant::Contestant;

/// Frames of a calibration scene that are timed in a round. Each is one observation, because few
/// bodies are queried, and frames differ in how many of them are thawed.
const TIMED_FRAMES: usize = MOST_TURN_FRAMES;

/// The calibration of some worlds.
pub(super) struct WorldCalibration {
    /// The worlds, followed by cullers that take turns with them, as in a run. Worlds alone read so
    /// little that the data of all of them would stay in the caches.
    contestants: Vec<(Variant, Vec<Shape>)>,
    worlds: usize,
    subjects: Vec<(Scene, Trajectory)>,
    turns: Turns,
    tier: Tier,
}

impl WorldCalibration {
    /// Prepares the calibration scenes of some worlds, with which `cullers` take turns; none if
    /// there is no world.
    ///
    /// # Errors
    /// The effects can't be simulated.
    pub fn new(
        scene: &Scene,
        worlds: &[Variant],
        cullers: &[Variant],
        tier: Tier,
    ) -> Result<Self, SimulationError> {
        let subject = |scene: Scene| {
            let trajectory = Trajectory::new(&scene)?.with_frames(u32::MAX);
            Ok((scene, trajectory))
        };
        let with_shapes = |variant: &Variant| (variant.clone(), variant.shapes(scene));
        let scenes = world_design::scenes(scene).take(match worlds {
            [] => 0,
            _ => SCENES,
        });
        Ok(Self {
            contestants: worlds.iter().chain(cullers).map(with_shapes).collect(),
            worlds: worlds.len(),
            subjects: scenes.map(subject).collect::<Result<_, SimulationError>>()?,
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
        let mut observed = vec![[Vec::new(), Vec::new()]; self.worlds];
        for number in 0..self.subjects.len() {
            self.turn(number * SCENE_STEP % SCENES, &mut observed)?;
        }
        Ok(std::array::from_fn(|regime| {
            let variants = self.contestants.iter().zip(&observed);
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

    /// One turn of each variant on a calibration scene. Appends what it observes of each warm and
    /// each cold frame.
    fn turn(
        &mut self,
        subject: usize,
        observed: &mut [[Vec<TurnObservation>; 2]],
    ) -> Result<(), SimulationError> {
        let (scene, trajectory) = &mut self.subjects[subject];
        let mut poses: Vec<Bodies> = Vec::new();
        for _ in 0..TIMED_FRAMES + 2 {
            poses.extend(trajectory.advance()?.cloned());
        }
        let [first, second, poses @ ..] = &*poses else {
            return Ok(());
        };
        let begun = Scene { bodies: first.clone(), ..scene.clone() };
        let all = self.contestants.iter();
        let mut all = all
            .map(|(variant, shapes)| variant.culling_of(shapes, &begun, self.tier))
            .collect::<Result<Vec<Culling>, _>>()?;
        // In the first frame, a world thaws every body that moves.
        all.iter_mut().for_each(|one| one.frame(second));
        let mut before: Vec<Counts> = all.iter().map(Culling::counts).collect();
        self.turns.round(&mut all, poses, |timed| {
            if timed.number >= self.worlds {
                return;
            }
            let (world, counts) = (&timed.contestant, timed.contestant.counts());
            observed[timed.number][timed.regime as usize].push(TurnObservation {
                bodies: first.len(),
                frames: 1,
                counts: counts.since(&before[timed.number]),
                stages: world.last().without(timed.waited),
                construct: world.construct_seconds(),
            });
            before[timed.number] = counts;
        });
        for one in &all {
            one.accepted()?;
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

    /// Few enough bodies move that every frame keeps the others. Of those queried in warm frames,
    /// many have just been woken in half of the scenes, and hardly any in the others.
    #[test]
    fn calibration_worlds_keep_bodies() {
        let text = "name = \"a\"\nframes = 2\n[box]\npartners = 1\n\
                    [[bodies]]\nshape = \"box\"\ncount = 600\n\
                    [effects]\nmotion = true\nspin = { rate = 1 }\n";
        let file = SceneFile::parse(text, "a.toml", Path::new(".")).unwrap();
        let scene = file.build().unwrap();
        let spheres = [Variant::spheres(&scene.cull).in_world()];
        let mut worlds = WorldCalibration::new(&scene, &spheres, &[], Tier::detect()).unwrap();
        let mut observed = vec![[Vec::new(), Vec::new()]];
        for subject in 0..SCENES {
            worlds.turn(subject, &mut observed).unwrap();
        }
        let [warm, cold] = &observed[0];
        assert_eq!(cold.len(), SCENES);
        let mut woken = Vec::new();
        for frames in warm.chunks(TIMED_FRAMES - 1) {
            let (mut queried, mut thawed) = (0, 0);
            for frame in frames {
                let rest = frame.counts.culler.rest;
                assert_eq!(rest.queried + rest.kept, frame.bodies as u64);
                assert!(rest.queried >= 1 && rest.kept > rest.queried);
                (queried, thawed) = (queried + rest.queried, thawed + rest.thawed);
            }
            woken.push(thawed as f64 / queried as f64);
        }
        woken.sort_by(f64::total_cmp);
        assert!(woken[SCENES / 2 - 1] < 0.05, "{woken:?}");
        assert!(woken[SCENES - 3] > 0.2, "{woken:?}");
    }
}
