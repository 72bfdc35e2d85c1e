//! The culler of given boxes, as a user has it.

use sdop::BoxCuller;

use sdop_bench::remedy::OrReport as _;
use sdop_judge::contestant::Contestant;

use crate::boxes::Frame;
use crate::entry::Setup;

/// A culler of boxes with what it has by default.
pub struct Boxes(BoxCuller);

impl Boxes {
    /// Runs on this many threads.
    pub fn new(setup: &Setup<'_>) -> miette::Result<Self> {
        let culler = BoxCuller::builder().threads(setup.threads).build();
        Ok(Self(culler.or_report()?))
    }
}

impl Contestant<Frame> for Boxes {
    fn frame(&mut self, frame: &Frame) {
        let pairs = self.0.cull(&frame.corners);
        assert!(pairs.is_ok(), "{pairs:?}: frames have boxes");
    }

    fn pairs(&self) -> Vec<[u32; 2]> {
        self.0.pairs().iter().collect()
    }
}
