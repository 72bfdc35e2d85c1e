//! The thread pool. Results, and their order, are the same on any number of threads.
//!
//! The data alone decides how work is split into parts. Each part writes its results into its own
//! buffers, which are joined in the order of the parts. Lists, counters and hashes are therefore
//! those of one thread, to the bit.
//!
//! The calling thread works too, because waking another takes as long as finding the pairs of about
//! a thousand bodies. Each free thread takes the next part, so a thread that wakes late delays
//! nothing.

use std::ops::Range;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::simd::{Tier, in_default_mode};

/// The fewest pieces of a column for which it pays to wake a thread.
const FEWEST_PIECES: usize = 8;

/// The most threads of a pool, including the caller's: more than machines have cores, but few
/// enough to start quickly.
pub const MOST_THREADS: usize = 1024;

/// The caller's thread, alone or with a pool of others.
#[derive(Debug, Default)]
pub struct Threads(Option<OwnPool>);

/// A pool, and the process that has its threads: they don't exist in a child that was forked from
/// it, where work given to them would never end.
#[derive(Debug)]
struct OwnPool {
    /// `None` only while it is dropped.
    pool: Option<ThreadPool>,
    process: u32,
    threads: usize,
}

impl OwnPool {
    /// The pool, in the process that has its threads.
    fn get(&self) -> Option<&ThreadPool> {
        self.pool.as_ref().filter(|_| self.process == std::process::id())
    }
}

impl Drop for OwnPool {
    fn drop(&mut self) {
        if self.get().is_none() {
            std::mem::forget(self.pool.take()); // it would wake its threads, and may wait for them
        }
    }
}

impl Clone for Threads {
    /// Starts as many threads as the original has, so that both can be used at the same time. If
    /// the system refuses to start them, the clone runs on the caller's thread; results are the
    /// same.
    fn clone(&self) -> Self {
        Self::new(self.threads()).unwrap_or_default()
    }
}

/// An estimate of a frame's work on one thread, in nanoseconds. It is computed from counts with
/// rounded prices (measured with AVX-512 on an Intel CPU), so that it is the same on every machine.
#[derive(Clone, Copy, Debug, Default)]
pub struct FrameWork {
    /// Volumes placed.
    pub updates: u64,
    /// Candidates of the first test.
    pub candidates: u64,
    /// Pairs refined.
    pub refined: u64,
}

impl FrameWork {
    fn nanoseconds(self) -> u64 {
        16 * self.updates + 2 * self.candidates + 20 * self.refined
    }
}

/// The least work of a frame, in nanoseconds, for which other threads are woken. Two threads break
/// even with one at half of that: 30,000 boxes or spheres, or 10,000 bodies of S-DOP, which take a
/// quarter of a millisecond on an otherwise idle AMD CPU.
pub const WORTH_WAKING: u64 = 1 << 20;

/// The threads for each frame: all of them, or only the caller's if the frame is little work.
#[derive(Clone, Debug)]
pub struct FrameThreads {
    all: Threads,
    alone: Threads,
    worth_waking: u64,
    wakes: bool,
}

impl FrameThreads {
    /// These threads, woken for frames of at least `worth_waking` nanoseconds of work
    /// ([`WORTH_WAKING`]), or for all frames if that is 0.
    #[must_use]
    pub fn new(all: Threads, worth_waking: u64) -> Self {
        Self { all, alone: Threads::default(), worth_waking, wakes: worth_waking == 0 }
    }

    /// Sets the expected work of the coming frame, estimated from the last one.
    pub fn expect(&mut self, work: FrameWork) {
        self.wakes = work.nanoseconds() >= self.worth_waking;
        if self.wakes {
            self.all.renew();
        }
    }

    /// The threads for this frame.
    #[must_use]
    pub fn get(&self) -> &Threads {
        if self.wakes { &self.all } else { &self.alone }
    }
}

/// What work runs on: a CPU tier and a thread pool.
#[derive(Clone, Copy, Debug)]
pub struct Executor<'a> {
    /// The tier that kernels use.
    pub tier: Tier,
    /// The calling thread, alone or with a pool.
    pub pool: &'a Threads,
}

/// The error for threads that can't be started: more than 1,024, or refused by the system.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
#[error("cannot start {threads} threads: {reason}; {help}", help = self.help())]
pub struct ThreadsError {
    threads: usize,
    reason: String,
}

crate::problem::errors!(ThreadsError);

impl ThreadsError {
    /// How to mend it.
    #[must_use]
    #[allow(clippy::unused_self, reason = "as of the other errors")]
    pub fn help(&self) -> &str {
        "ask for fewer threads"
    }
}

impl Threads {
    /// A pool of `threads` threads, including the caller's. 0 counts as 1.
    ///
    /// # Errors
    /// More than [`MOST_THREADS`]; threads that the system refuses to start. No thread is left
    /// running.
    pub fn new(threads: usize) -> Result<Self, ThreadsError> {
        if threads <= 1 {
            return Ok(Self(None));
        }
        if threads > MOST_THREADS {
            return Err(ThreadsError {
                threads,
                reason: format!("at most {MOST_THREADS} can be asked for"),
            });
        }
        let others = threads - 1;
        let pool = ThreadPoolBuilder::new().num_threads(others).build();
        match pool {
            Ok(pool) => {
                Ok(Self(Some(OwnPool { pool: Some(pool), process: std::process::id(), threads })))
            }
            Err(error) => Err(ThreadsError { threads, reason: error.to_string() }),
        }
    }

    /// An executor of these threads and a tier.
    #[must_use]
    pub fn executor(&self, tier: Tier) -> Executor<'_> {
        Executor { tier, pool: self }
    }

    /// Number of threads.
    #[must_use]
    pub fn threads(&self) -> usize {
        self.0.as_ref().map_or(1, |own| own.threads)
    }

    /// Starts the threads in this process, if it was forked from the one that has them. Until then,
    /// or if the system refuses to start them, work runs on the caller's thread; results are the
    /// same.
    pub fn renew(&mut self) {
        if self.0.as_ref().is_some_and(|own| own.get().is_none())
            && let Ok(renewed) = Self::new(self.threads())
        {
            *self = renewed;
        }
    }

    /// Calls `work` once for each item, with its index.
    pub fn each<T: Send>(&self, items: &mut [T], work: impl Fn(usize, &mut T) + Sync) {
        let is_worth_waking = items.len() > 1;
        let items = items.iter_mut().enumerate();
        self.share_out(is_worth_waking, items, |(index, item)| work(index, item));
    }

    /// Calls `work` for consecutive pieces of `size` elements of a column, with the index of each
    /// piece's first element. Fewer than eight pieces run on the caller's thread.
    pub fn pieces<T: Send>(
        &self,
        column: &mut [T],
        size: usize,
        work: impl Fn(usize, &mut [T]) + Sync,
    ) {
        let is_worth_waking = column.len() >= FEWEST_PIECES * size;
        let pieces = column.chunks_mut(size).enumerate();
        self.share_out(is_worth_waking, pieces, |(index, piece)| work(index * size, piece));
    }

    /// Calls `work` for pieces of two columns of one length at once.
    pub fn pieces_of_two<T: Send>(
        &self,
        [one, other]: [&mut [T]; 2],
        size: usize,
        work: impl Fn(usize, [&mut [T]; 2]) + Sync,
    ) {
        let is_worth_waking = one.len() >= FEWEST_PIECES * size;
        let pieces = one.chunks_mut(size).zip(other.chunks_mut(size)).enumerate();
        self.share_out(is_worth_waking, pieces, |(index, (one, other))| {
            work(index * size, [one, other])
        });
    }

    /// Calls `work` for consecutive ranges of `size` numbers in 0..`len`. Fewer than eight ranges
    /// run on the caller's thread.
    pub fn ranges(&self, len: usize, size: usize, work: impl Fn(Range<usize>) + Sync) {
        let is_worth_waking = len >= FEWEST_PIECES * size;
        let starts = (0..len).step_by(size);
        let ranges = starts.map(|start| start..len.min(start + size));
        self.share_out(is_worth_waking, ranges, work);
    }

    /// Whether `holds` is true for all such ranges. Once it is false for one, no further ranges are
    /// tested.
    pub fn all(
        &self,
        len: usize,
        size: usize,
        holds: impl Fn(Range<usize>) -> bool + Sync,
    ) -> bool {
        let all = AtomicBool::new(true);
        self.ranges(len, size, |range| {
            if all.load(Relaxed) && !holds(range) {
                all.store(false, Relaxed);
            }
        });
        all.into_inner()
    }

    /// Calls `work` for each item, on all threads if it pays to wake them.
    fn share_out<T>(
        &self,
        is_worth_waking: bool,
        items: impl Iterator<Item = T> + Send,
        work: impl Fn(T) + Sync,
    ) {
        let own = self.0.as_ref().filter(|_| is_worth_waking);
        match own.and_then(OwnPool::get) {
            Some(pool) => distribute(pool, items, work),
            None => items.for_each(work),
        }
    }
}

/// Calls `work` for each item, on the calling thread and on those of the pool.
///
/// If the caller is a worker of another pool, waiting here would make it start that pool's next job
/// on top of this one, and so on until its stack overflows. Therefore a new thread waits in its
/// place.
fn distribute<T>(
    pool: &ThreadPool,
    items: impl Iterator<Item = T> + Send,
    work: impl Fn(T) + Sync,
) {
    if rayon::current_thread_index().is_none() {
        return share(pool, items, work);
    }
    let work = &work;
    let waits = move || share(pool, items, work);
    let done = std::thread::scope(|scope| scope.spawn(waits).join());
    if let Err(panic) = done {
        std::panic::resume_unwind(panic);
    }
}

fn share<T>(pool: &ThreadPool, items: impl Iterator<Item = T> + Send, work: impl Fn(T) + Sync) {
    let queue = Mutex::new(items);
    // Poisoned by a panic, which the scope passes on.
    let next = || queue.lock().ok().and_then(|mut items| items.next());
    // A worker inherits the floating-point mode of the thread that started it, which may be the
    // host's.
    let work_off = || {
        in_default_mode(|| {
            while let Some(item) = next() {
                work(item);
            }
        });
    };
    pool.in_place_scope(|scope| {
        for _ in 0..pool.current_num_threads() {
            scope.spawn(|_| work_off());
        }
        work_off();
    });
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use std::cell::Cell;
    use std::sync::Barrier;
    use std::thread;
    use std::time::Duration;

    use super::*;
    use crate::simd::FpMode;

    /// Others are woken for frames that are worth it and always for nothing.
    #[test]
    fn threads_wake_for_enough_work() {
        let work = |candidates| FrameWork { updates: 100, candidates, refined: 10 };
        assert_eq!(work(50).nanoseconds(), 1900);
        let mut threads = FrameThreads::new(Threads::new(2).unwrap(), 1900);
        assert_eq!(threads.get().threads(), 1, "before anything is known");
        for (candidates, wanted) in [(50, 2), (49, 1), (1000, 2)] {
            threads.expect(work(candidates));
            assert_eq!(threads.get().threads(), wanted, "{candidates}");
        }
        let mut always = FrameThreads::new(Threads::new(2).unwrap(), 0);
        assert_eq!(always.get().threads(), 2);
        always.expect(FrameWork::default());
        assert_eq!(always.get().threads(), 2);
    }

    /// Too many threads are refused at once.
    #[test]
    fn too_many_threads_are_rejected() {
        for threads in [MOST_THREADS + 1, 5_000, usize::MAX] {
            let refused = Threads::new(threads).unwrap_err().problem();
            let wanted = format!("cannot start {threads} threads: at most 1024 can be asked for");
            assert_eq!(refused, wanted);
        }
    }

    /// A forked child has no threads of its parent's pool: it works alone until it has its own.
    #[test]
    fn forked_child_gets_new_threads() {
        let mut threads = FrameThreads::new(Threads::new(3).unwrap(), 0);
        let caller = thread::current().id();
        let workers = |threads: &Threads| {
            let (all, mut ids) = (Barrier::new(3), vec![caller; 3]);
            let is_alone = threads.0.as_ref().unwrap().get().is_none();
            threads.each(&mut ids, |_, id| {
                if !is_alone {
                    all.wait();
                }
                *id = thread::current().id();
            });
            ids.iter().filter(|id| **id != caller).count()
        };
        assert_eq!(workers(&threads.all), 2);
        threads.all.0.as_mut().unwrap().process += 1; // as if this process were another
        assert_eq!((workers(&threads.all), threads.all.threads()), (0, 3));
        threads.expect(FrameWork::default());
        assert_eq!((workers(&threads.all), threads.all.threads()), (2, 3));
    }

    /// Covers pools that were started in another mode, and callers that run in one.
    #[test]
    fn work_runs_in_the_default_mode() {
        for mode in FpMode::OTHERS {
            mode.run(|| {
                let threads = Threads::new(4).unwrap();
                let (all, wakes) = (Barrier::new(4), &mut [FpMode::OTHERS[0]; 4]);
                threads.each(wakes, |_, found| {
                    all.wait(); // one item for each thread
                    *found = FpMode::current();
                });
                assert_eq!(*wakes, [FpMode::DEFAULT; 4]);
                assert_eq!(FpMode::current(), mode);
            });
        }
    }

    /// Ranges cover each number once on any number of threads.
    #[test]
    fn ranges_cover_each_number_once() {
        for threads in [1, 3] {
            let threads = Threads::new(threads).unwrap();
            for (len, size, expected) in [(0, 4, 0), (3, 4, 1), (4, 4, 1), (33, 4, 9), (79, 8, 10)]
            {
                let seen = Mutex::new(Vec::new());
                threads.ranges(len, size, |range| seen.lock().unwrap().push(range));
                let mut seen = seen.into_inner().unwrap();
                seen.sort_by_key(|range| range.start);
                assert_eq!(seen.len(), expected, "{len} by {size}");
                assert!(seen.iter().all(|range| range.len() <= size));
                assert!(seen.into_iter().flatten().eq(0..len), "{len} by {size}");
            }
        }
    }

    /// All ranges hold unless one does not wherever it is.
    #[test]
    fn one_failing_range_is_found() {
        for threads in [1, 3] {
            let threads = Threads::new(threads).unwrap();
            let all_but = |bad| threads.all(79, 8, |range| !range.contains(&bad));
            assert!(all_but(79));
            assert!((0..79).all(|bad| !all_but(bad)));
        }
        let (alone, asked) = (Threads::default(), Mutex::new(Vec::new()));
        alone.all(79, 8, |range| {
            asked.lock().unwrap().push(range.start);
            range.start < 16
        });
        assert_eq!(*asked.lock().unwrap(), [0, 8, 16], "the others are spared");
    }

    /// A waiting worker of another pool starts no other job.
    #[test]
    fn waiting_worker_starts_no_job() {
        thread_local!(static BUSY: Cell<bool> = const { Cell::new(false) });
        let job = || {
            assert!(!BUSY.replace(true), "a job on top of another");
            let (both, threads) = (Barrier::new(2), Threads::new(2).unwrap());
            let pool = threads.0.as_ref().unwrap().get().unwrap();
            threads.each(&mut [(); 2], |_, ()| {
                both.wait();
                if pool.current_thread_index().is_some() {
                    thread::sleep(Duration::from_millis(20)); // the caller ends first, and waits
                }
            });
            BUSY.set(false);
        };
        let one = ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        one.scope(|scope| (0..4).for_each(|_| scope.spawn(|_| job())));
    }
}
