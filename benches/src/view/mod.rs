//! `sdop view`: a run as one HTML file, which works without a network.
//!
//! > record, scene or hard case → [`ShownRun`] → pairs with their flags ([`pairs`]), meshes to
//! > draw ([`detail`]), T ([`terms`]) → [`Page`]
//!
//! The page is `web/dist/page.html`, which is made from the TypeScript in `web/` and committed. A
//! run's data is inserted at a mark in it: a JSON header and blocks of little-endian numbers in
//! base64 ([`page`]). Poses are the record's f32 to the bit.

mod detail;
mod header;
mod page;
mod pairs;
mod shown_case;
mod shown_run;
mod terms;

pub use page::Page;
pub use shown_run::{Focus, ShownRun, ShownStrategy};

use rayon::prelude::*;

use crate::tradeoff::truth::ExactJudge;
use sdop::bodies::Bodies;
use sdop_judge::record::FrameLine;

/// Adds to every frame the pairs whose meshes meet, in exact arithmetic. Frames that have them stay
/// unchanged. `done` is called once per frame, from any thread.
///
/// # Errors
/// The exact reference rejects a number, which never happens for a record that was read.
pub fn decide_truth(show: &mut ShownRun, done: impl Fn() + Sync) -> miette::Result<()> {
    let judge = ExactJudge::new(&show.shapes)?;
    let bodies = &show.bodies;
    let decide = |frame: &mut FrameLine| -> miette::Result<()> {
        if frame.meets.is_none() {
            let mut posed: Bodies = bodies.clone();
            frame.pose(&mut posed);
            frame.meets = Some(judge.meetings(&posed, frame.translations.as_deref())?);
        }
        done();
        Ok(())
    };
    show.frames.par_iter_mut().try_for_each(decide)
}
