//! The thread pool: the same results in the same order, on any number of threads.
//!
//! Work is cut into parts by the data alone; a part's results go to buffers of its own, which are joined in the order of
//! the parts. So lists, counters and hashes are those of one thread, to the bit.
//!
//! The calling thread works too: waking another takes as long as finding the pairs of some thousand bodies. Each thread
//! that is free takes the next part, so one that wakes late delays nothing.

use std::sync::Mutex;

use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};

/// The fewest pieces of a column for which waking a thread pays.
const FEWEST_PIECES: usize = 8;

/// The caller's thread, or it and a pool of others.
#[derive(Debug, Default)]
pub struct Threads(Option<ThreadPool>);

/// Threads that the system refused.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
#[error("cannot start {threads} threads: {source}")]
#[diagnostic(help("ask for fewer threads"))]
pub struct ThreadsError {
    threads: usize,
    source: ThreadPoolBuildError,
}

impl Threads {
    /// A pool of so many threads; none or one means the caller's own.
    ///
    /// # Errors
    /// The system refuses to start them.
    pub fn new(threads: usize) -> Result<Self, ThreadsError> {
        if threads <= 1 {
            return Ok(Self(None));
        }
        let others = threads - 1;
        let pool = ThreadPoolBuilder::new().num_threads(others).build();
        match pool {
            Ok(pool) => Ok(Self(Some(pool))),
            Err(source) => Err(ThreadsError { threads, source }),
        }
    }

    /// Number of threads.
    #[must_use]
    pub fn threads(&self) -> usize {
        let others = self.0.as_ref().map_or(0, ThreadPool::current_num_threads);
        others + 1
    }

    /// Calls `work` once for each item, with its index.
    pub fn each<T: Send>(&self, items: &mut [T], work: impl Fn(usize, &mut T) + Sync) {
        let items = items.iter_mut().enumerate();
        match &self.0 {
            Some(pool) if items.len() > 1 => {
                distribute(pool, items, |(index, item)| work(index, item))
            }
            _ => items.for_each(|(index, item)| work(index, item)),
        }
    }

    /// Calls `work` for consecutive pieces of a column, `size` long, with the index of each one's first element. Less than
    /// eight pieces are the caller's own.
    pub fn pieces<T: Send>(
        &self,
        column: &mut [T],
        size: usize,
        work: impl Fn(usize, &mut [T]) + Sync,
    ) {
        let worth_waking = column.len() >= FEWEST_PIECES * size;
        let pieces = column.chunks_mut(size).enumerate();
        match &self.0 {
            Some(pool) if worth_waking => {
                distribute(pool, pieces, |(index, piece)| work(index * size, piece));
            }
            _ => pieces.for_each(|(index, piece)| work(index * size, piece)),
        }
    }
}

/// Calls `work` for each item, on the calling thread and on those of the pool.
fn distribute<T>(
    pool: &ThreadPool,
    items: impl Iterator<Item = T> + Send,
    work: impl Fn(T) + Sync,
) {
    let queue = Mutex::new(items);
    // Poisoned by a panic, which the scope passes on.
    let next = || queue.lock().ok().and_then(|mut items| items.next());
    let work_off = || {
        while let Some(item) = next() {
            work(item);
        }
    };
    pool.in_place_scope(|scope| {
        for _ in 0..pool.current_num_threads() {
            scope.spawn(|_| work_off());
        }
        work_off();
    });
}
