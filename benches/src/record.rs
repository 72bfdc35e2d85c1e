//! The lines of a run record ([`sdop_judge::record`]) for scenes and culled frames.

use sdop::counters::Counters;
use sdop::settings::Strategy;
use sdop_judge::record::{BodyLine, EffectLine, FrameLine, Header, VolumeLine};

use crate::measure::counts::{Counts, Volume};
use crate::scene::Scene;
use crate::simulate::SimulatedFrame;

/// The first line of a scene's record.
#[must_use]
pub fn header(scene: &Scene) -> Header {
    let effects = scene.effects.lists().into_iter();
    let effects = effects.map(|(name, on)| EffectLine { name: name.to_owned(), on });
    Header {
        frames: Some(scene.frames),
        dt: Some(scene.dt),
        side: scene.side,
        effects: Some(effects.collect()),
        cull: Some(scene.cull.clone()),
        ..Header::new(&scene.name, scene.seed, &scene.shapes, BodyLine::all(&scene.bodies))
    }
}

/// The line of a culled frame.
#[must_use]
pub fn frame_line(frame: &SimulatedFrame<'_>, strategy: Strategy) -> FrameLine {
    FrameLine {
        frame: frame.number,
        poses: FrameLine::poses(frame.bodies),
        translations: frame.fine.of(frame.bodies),
        pairs: frame.pairs.sorted(),
        counters: Some(volume_lines(strategy, &frame.counters)),
        meets: None,
    }
}

/// A strategy's counters, in the order of its tests.
#[must_use]
pub fn volume_lines(strategy: Strategy, counters: &Counters) -> Vec<VolumeLine> {
    let counts = Counts { culler: *counters, ..Counts::default() };
    let line =
        |volume: Volume| VolumeLine { volume: volume.to_string(), counters: counts.of(volume) };
    Volume::of(strategy).into_iter().map(line).collect()
}
