//! Lists that grow on several threads and come out as on one.

use std::ops::Range;

use crate::counters::VolumeCounters;
use crate::pairs::PairList;
use crate::threads::Threads;

/// Workers a thread: whoever is done early takes another's.
const WORKERS_PER_THREAD: usize = 4;

/// One contiguous share of the work, with buffers that stay from frame to frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct Worker {
    pub out: PairList,
    pub block: PairList,
    pub selected: PairList,
    pub passed: PairList,
    pub first: VolumeCounters,
    pub refined: VolumeCounters,
    /// Seconds spent in the or-DOP test.
    pub refining: f64,
}

/// What all workers did together.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Done {
    pub first: VolumeCounters,
    pub refined: VolumeCounters,
    /// Wall time of the or-DOP test: its seconds over the threads.
    pub refining: f64,
}

/// Splits `units` of work among workers and appends their lists to `out`, in the order of the work.
pub(super) fn share(
    pool: &Threads,
    workers: &mut Vec<Worker>,
    units: usize,
    out: &mut PairList,
    work: impl Fn(Range<usize>, &mut Worker) + Sync,
) -> Done {
    let threads = pool.threads();
    let count = match threads {
        1 => 1,
        _ => (WORKERS_PER_THREAD * threads).min(units).max(1),
    };
    if workers.len() < count {
        workers.resize(count, Worker::default());
    }
    let workers = &mut workers[..count];
    for worker in workers.iter_mut() {
        worker.out.clear();
        worker.block.clear();
        (worker.first, worker.refined, worker.refining) = Default::default();
    }
    // The first worker's list is the common one: with a single worker nothing is copied.
    std::mem::swap(out, &mut workers[0].out);
    pool.each(workers, |index, worker| {
        work(index * units / count..(index + 1) * units / count, worker);
    });
    std::mem::swap(out, &mut workers[0].out);
    let mut done = Done::default();
    for (index, worker) in workers.iter().enumerate() {
        if index > 0 {
            out.append(&worker.out);
        }
        add(&mut done.first, worker.first);
        add(&mut done.refined, worker.refined);
        done.refining += worker.refining / threads as f64;
    }
    done
}

/// Adds tests, hits and updates.
pub(super) fn add(to: &mut VolumeCounters, more: VolumeCounters) {
    to.updates += more.updates;
    to.tests += more.tests;
    to.hits += more.hits;
}
