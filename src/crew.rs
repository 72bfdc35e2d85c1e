//! Threads: the same work in the same order, whoever does it.
//!
//! Work is cut into parts by the data alone; a part's results go to buffers of its own, which are joined in the order of
//! the parts. So lists, counters and hashes are those of one thread, to the bit.

use std::sync::Arc;

use rayon::iter::{IndexedParallelIterator, IntoParallelRefMutIterator, ParallelIterator};
use rayon::slice::ParallelSliceMut;
use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};

/// Pieces of a column that are worth waking a thread for.
const WORTH_SHARING: usize = 8;

/// One thread, or a pool of several. A clone is the same crew.
#[derive(Clone, Debug, Default)]
pub struct Crew(Option<Arc<ThreadPool>>);

/// Threads that the system refused.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
#[error("cannot start {threads} threads: {source}")]
#[diagnostic(help("ask for fewer threads"))]
pub struct CrewError {
    threads: usize,
    source: ThreadPoolBuildError,
}

impl Crew {
    /// A crew of so many threads; none or one means the caller's own.
    ///
    /// # Errors
    /// The system refuses to start them.
    pub fn new(threads: usize) -> Result<Self, CrewError> {
        if threads <= 1 {
            return Ok(Self(None));
        }
        let pool = ThreadPoolBuilder::new().num_threads(threads).build();
        match pool {
            Ok(pool) => Ok(Self(Some(Arc::new(pool)))),
            Err(source) => Err(CrewError { threads, source }),
        }
    }

    /// Number of threads.
    #[must_use]
    pub fn threads(&self) -> usize {
        self.0.as_ref().map_or(1, |pool| pool.current_num_threads())
    }

    /// Does `work` on one of the threads: what it shares then needs no hand-over from outside, which takes as long as some
    /// thousand updates each time.
    pub fn inside<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        match &self.0 {
            Some(pool) => pool.install(work),
            None => work(),
        }
    }

    /// Calls `work` once for each item, with its index.
    pub fn each<T: Send>(&self, items: &mut [T], work: impl Fn(usize, &mut T) + Sync) {
        match &self.0 {
            Some(pool) if items.len() > 1 => pool.install(|| {
                let items = items.par_iter_mut().enumerate();
                items.for_each(|(index, item)| work(index, item));
            }),
            _ => {
                for (index, item) in items.iter_mut().enumerate() {
                    work(index, item);
                }
            }
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
        match &self.0 {
            Some(pool) if column.len() >= WORTH_SHARING * size => pool.install(|| {
                let pieces = column.par_chunks_mut(size).enumerate();
                pieces.for_each(|(index, piece)| work(index * size, piece));
            }),
            _ => {
                for (index, piece) in column.chunks_mut(size).enumerate() {
                    work(index * size, piece);
                }
            }
        }
    }
}
