//! Work split into tasks for several threads, with results in the order of one.

use std::ops::Range;

use super::Totals;
use super::output::{Output, OutputTurns, TaskOutput};
use crate::counters::VolumeCounters;
use crate::pairs::PairList;
use crate::threads::Threads;

/// Tasks per thread. A thread that finishes early takes another one.
const TASKS_PER_THREAD: usize = 4;

/// One contiguous range of the work, with buffers that stay from frame to frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct Task<W> {
    /// Reported pairs, or candidates.
    pub out: PairList,
    /// Candidates for the refining test.
    pub block: PairList,
    /// The candidates of a block that have a body of interest.
    pub selected: PairList,
    /// The selected candidates that survived.
    pub survivors: PairList,
    /// Rows that are computed where they are tested.
    pub window: W,
    pub first: VolumeCounters,
    pub refining: VolumeCounters,
    /// Seconds in the refining test.
    pub seconds: f64,
    /// Seconds of computing rows.
    pub update_seconds: f64,
}

/// The tasks of a frame, whose buffers stay for the next.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tasks<W>(pub Vec<Task<W>>);

impl<W: Default> Tasks<W> {
    /// Frees the memory of all lists of pairs.
    pub fn shrink_to_fit(&mut self) {
        *self = Self::default();
    }

    /// Bytes that lists of pairs hold.
    pub fn pair_bytes(&self) -> usize {
        let lists = |task: &Task<W>| {
            let lists = [&task.out, &task.block, &task.selected, &task.survivors];
            lists.map(PairList::bytes).iter().sum::<usize>()
        };
        self.0.iter().map(lists).sum()
    }
}

/// Splits `units` of work into tasks. The pairs that they list go to `output` in the order of the
/// work.
pub(crate) fn split_work<W: Clone + Default + Send>(
    pool: &Threads,
    Tasks(tasks): &mut Tasks<W>,
    units: usize,
    output: Output<'_>,
    work: impl Fn(Range<usize>, &mut Task<W>, &TaskOutput<'_, '_>) + Sync,
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
        (task.first, task.refining) = Default::default();
        (task.seconds, task.update_seconds) = Default::default();
    }
    let range = |index: usize| index * units / count..(index + 1) * units / count;
    match output {
        Output::List(out) => {
            // The first task writes to the common list, so that a single task copies nothing.
            std::mem::swap(out, &mut tasks[0].out);
            pool.each(tasks, |index, task| {
                work(range(index), task, &TaskOutput::Kept);
            });
            std::mem::swap(out, &mut tasks[0].out);
            out.append_all(tasks[1..].iter().map(|task| &task.out));
        }
        Output::Portions(sink) => {
            let turns = OutputTurns::new(sink);
            pool.each(tasks, |index, task| {
                let outlet = TaskOutput::HandedOver(turns.of(index));
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
        totals.update_seconds += task.update_seconds / threads as f64;
    }
    totals
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The result of this much work on this many threads: each task's share, in the order of the
    /// list, and the totals.
    fn shares(threads: usize, units: usize) -> (Vec<[u32; 2]>, Totals) {
        let pool = Threads::new(threads).expect("a few threads");
        let mut out = PairList::default();
        let work = |share: Range<usize>, task: &mut Task<()>, _: &TaskOutput<'_, '_>| {
            task.out.push(share.start as u32, share.end as u32);
            (task.first.tests, task.refining.hits) = (share.len() as u64, 1);
            task.seconds = 6.0;
        };
        let mut tasks = Tasks::default();
        let totals = split_work(&pool, &mut tasks, units, Output::List(&mut out), work);
        (out.iter().collect(), totals)
    }

    /// A thread has four tasks unless there is less work.
    #[test]
    fn threads_get_four_tasks() {
        for (threads, units, tasks) in [(1, 100, 1), (3, 100, 12), (3, 5, 5), (2, 0, 1)] {
            let (shares, totals) = shares(threads, units);
            assert_eq!(shares.len(), tasks, "{units} units");
            let ends = shares.iter().map(|&[_, end]| end);
            let starts = shares.iter().map(|&[start, _]| start);
            assert!(starts.eq(std::iter::once(0).chain(ends).take(tasks)));
            assert_eq!(shares[tasks - 1][1], units as u32);
            assert_eq!(totals.first.tests, units as u64);
            assert_eq!(totals.refining.hits, tasks as u64);
            // Wall time: threads refine at the same time.
            assert_eq!(totals.refining_seconds, (6 * tasks) as f64 / threads as f64);
        }
    }
}
