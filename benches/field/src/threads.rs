//! Threads for engines that work on rayon's pool.

use miette::IntoDiagnostic as _;
use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

/// The caller's thread alone, or a pool of several.
pub struct Threads(Option<ThreadPool>);

impl Threads {
    /// A pool of this many threads.
    pub fn new(threads: usize) -> miette::Result<Self> {
        if threads <= 1 {
            return Ok(Self(None));
        }
        let pool = ThreadPoolBuilder::new().num_threads(threads).build();
        Ok(Self(Some(pool.into_diagnostic()?)))
    }

    /// Whether there are several.
    pub fn several(&self) -> bool {
        self.0.is_some()
    }

    /// Does the work where rayon finds these threads and no others.
    pub fn run<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        match &self.0 {
            Some(pool) => pool.install(work),
            None => work(),
        }
    }

    /// Answers each question, on all threads if there are several.
    pub fn each<Q: Sync, A: Send>(
        &self,
        questions: &[Q],
        answer: impl Fn(&Q) -> A + Sync + Send,
    ) -> Vec<A> {
        if self.several() {
            self.run(|| questions.par_iter().with_min_len(32).map(answer).collect())
        } else {
            questions.iter().map(answer).collect()
        }
    }
}

/// Makes the caller's thread the only thread of rayon's global pool. Otherwise engines that use
/// this pool for any number of threads would use every CPU, or pass each search to another thread.
pub fn claim_caller() -> miette::Result<()> {
    let alone = ThreadPoolBuilder::new().num_threads(1).use_current_thread();
    alone.build_global().into_diagnostic()
}

/// Does the work on a thread that belongs to no pool. [`claim_caller`] makes the caller's one of
/// rayon's, and on such a thread a culler with its own threads starts another one for each section
/// of a frame, because otherwise it would start other jobs of the pool while it waits.
pub fn outside_of_pools<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    let done = std::thread::scope(|scope| scope.spawn(work).join());
    done.unwrap_or_else(|panic| std::panic::resume_unwind(panic))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::*;

    /// What is done outside is no pool's work.
    #[test]
    fn outside_work_leaves_the_pool() {
        let threads = Threads::new(2).unwrap();
        let number = rayon::current_thread_index;
        let [inside, outside] = threads.run(|| [number(), outside_of_pools(number)]);
        assert!(inside.is_some() && outside.is_none());
    }
}
