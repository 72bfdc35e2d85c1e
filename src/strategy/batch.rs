//! S-DOP in batches (paper, section 4b): the potentially colliding set is listed first, then its or-DOPs are tested.
//!
//! Lazy updates need the whole set, and so flow this way under every strategy that refines.

use std::mem::take;

use super::Stage;
use super::interest::Chosen;
use super::listing::First;
use super::workers::Done;

/// Candidates that pass `first` are listed, then refined; with `interest`, only those that have a body of interest.
pub(super) fn flow(stage: &mut Stage<'_>, first: First<'_>, interest: Option<&[bool]>) -> Done {
    let mut done = stage.list_candidates(first);
    let (candidates, mut out) = (take(stage.candidates), take(stage.out));
    done.refined = match interest {
        None => stage.refine_list(&candidates, &mut out),
        Some(interest) => {
            let chosen = Chosen {
                pairs: &candidates,
                body: &stage.places.body,
                interest,
            };
            // Listing has made a worker; its buffers stay from frame to frame.
            let mut worker = take(&mut stage.workers[0]);
            chosen.select(&mut worker.selected);
            worker.passed.clear();
            let refined = stage.refine_list(&worker.selected, &mut worker.passed);
            chosen.merge(&worker.passed, &mut out);
            stage.workers[0] = worker;
            refined
        }
    };
    (*stage.candidates, *stage.out) = (candidates, out);
    done
}
