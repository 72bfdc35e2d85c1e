//! The culler as a user has it: poses in, pairs out, found on the grid.

use sdop::culler::Culler;
use sdop::settings::{CullSettings, Finder, Strategy};
use sdop::simd::Tier;

use crate::boxes::Frame;
use crate::peer::{Peer, Setup};

/// A culler with one strategy.
pub struct Culled(Culler);

impl Culled {
    /// With k = 18, two-sided, all volumes updated each frame: what [`CullSettings`] has by default.
    pub fn new(setup: &Setup<'_>, strategy: Strategy) -> miette::Result<Self> {
        let settings = CullSettings {
            strategy,
            pairs: Finder::Grid,
            ..CullSettings::default()
        };
        let bodies = &setup.first.bodies;
        let culler = Culler::new(&setup.scene.shapes, bodies, &settings, Tier::detect())?;
        Ok(Self(culler.with_threads(setup.threads)?))
    }
}

impl Peer for Culled {
    fn frame(&mut self, frame: &Frame) {
        self.0.cull(&frame.bodies);
    }

    fn pairs(&self) -> Vec<[u32; 2]> {
        self.0.pairs().iter().collect()
    }
}
