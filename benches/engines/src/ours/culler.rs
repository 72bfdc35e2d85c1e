//! The culler as a user has it: poses in, pairs out, by the finder that `auto` picks.

use sdop::culler::Culler;
use sdop::settings::Strategy;

use sdop_bench::remedy::OrReport as _;
use sdop_judge::contestant::Contestant;

use crate::boxes::Frame;
use crate::entry::Setup;

/// A culler with one strategy.
pub struct StrategyCuller(Culler);

impl StrategyCuller {
    /// With k = 18, two-sided, all volumes updated each frame: what a culler has by default.
    pub fn new(setup: &Setup<'_>, strategy: Strategy) -> miette::Result<Self> {
        let culler = Culler::builder()
            .strategy(strategy)
            .threads(setup.threads)
            .build(&setup.scene.shapes, &setup.first.bodies)
            .or_report()?;
        Ok(Self(culler))
    }
}

impl Contestant<Frame> for StrategyCuller {
    fn frame(&mut self, frame: &Frame) {
        let pairs = self.0.cull(&frame.bodies);
        assert!(pairs.is_ok(), "{pairs:?}: frames keep their bodies");
    }

    fn pairs(&self) -> Vec<[u32; 2]> {
        self.0.pairs().iter().collect()
    }
}
