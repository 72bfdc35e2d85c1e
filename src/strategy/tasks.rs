//! Work split into tasks for several threads, with results in the order of one.

use std::ops::Range;

use super::Totals;
use super::output::{Outlet, Output, Turns};
use crate::counters::VolumeCounters;
use crate::pairs::PairList;
use crate::threads::Threads;

/// Tasks per thread: a thread that is done early takes another.
const TASKS_PER_THREAD: usize = 4;

/// One contiguous range of the work, with buffers that stay from frame to frame.
#[derive(Clone, Debug, Default)]
pub(super) struct Task {
    /// Reported pairs, or candidates.
    pub out: PairList,
    /// Candidates that wait for the refining test.
    pub block: PairList,
    /// Those of a block that have a body of interest.
    pub selected: PairList,
    /// Those of them that survived.
    pub survivors: PairList,
    pub first: VolumeCounters,
    pub refining: VolumeCounters,
    /// Seconds in the refining test.
    pub seconds: f64,
}

impl Task {
    /// All lists of pairs.
    pub fn lists(&self) -> [&PairList; 4] {
        [&self.out, &self.block, &self.selected, &self.survivors]
    }
}

/// Splits `units` of work into tasks; what they list goes to `output` in the order of the work.
pub(super) fn split_work(
    pool: &Threads,
    tasks: &mut Vec<Task>,
    units: usize,
    output: Output<'_>,
    work: impl Fn(Range<usize>, &mut Task, &Outlet<'_, '_>) + Sync,
) -> Totals {
    let threads = pool.threads();
    let count = match threads {
        1 => 1,
        _ => (TASKS_PER_THREAD * threads).min(units).max(1),
    };
    if tasks.len() < count {
        tasks.resize(count, Task::default());
    }
    let tasks = &mut tasks[..count];
    for task in tasks.iter_mut() {
        task.out.clear();
        task.block.clear();
        (task.first, task.refining, task.seconds) = Default::default();
    }
    let range = |index: usize| index * units / count..(index + 1) * units / count;
    match output {
        Output::List(out) => {
            // The first task's list is the common one: with a single task nothing is copied.
            std::mem::swap(out, &mut tasks[0].out);
            pool.each(tasks, |index, task| {
                work(range(index), task, &Outlet::Kept);
            });
            std::mem::swap(out, &mut tasks[0].out);
            out.append_all(tasks[1..].iter().map(|task| &task.out));
        }
        Output::Portions(sink) => {
            let turns = Turns::new(sink);
            pool.each(tasks, |index, task| {
                let outlet = Outlet::HandedOver(turns.of(index));
                work(range(index), task, &outlet);
                outlet.end(&mut task.out);
            });
        }
    }
    let mut totals = Totals::default();
    for task in tasks.iter() {
        totals.first += task.first;
        totals.refining += task.refining;
        totals.refining_seconds += task.seconds / threads as f64;
    }
    totals
}
