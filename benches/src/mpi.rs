//! Ranks: copies of this program that `mpirun` or a scheduler starts and that communicate by MPI.
//!
//! Without the feature `mpi` nothing is linked, and [`launched`] only serves to reject a start as
//! many ranks. With the feature, only `Ranks::start` starts MPI, so a program that runs alone does
//! not. [`RankEnding`] ensures that no rank waits for one that failed.

use std::env;

/// What launchers call the number of ranks: OpenMPI, and the PMI of MPICH and of Slurm.
const SIZE_VARIABLES: [&str; 2] = ["OMPI_COMM_WORLD_SIZE", "PMI_SIZE"];

/// Set by any launcher that speaks `PMIx`, whose number of ranks has to be requested from it; Slurm
/// also sets the number.
const PMIX_VARIABLES: [&str; 2] = ["PMIX_RANK", "SLURM_STEP_NUM_TASKS"];

/// What launchers call a rank's number.
const RANK_VARIABLES: [&str; 3] = ["OMPI_COMM_WORLD_RANK", "PMI_RANK", PMIX_VARIABLES[0]];

/// How many ranks of this program were started, as its launcher's environment says; 1 for a program
/// that is run alone.
#[must_use]
pub fn launched() -> usize {
    ranks(|name| env::var(name).ok())
}

/// This rank's number, as its launcher's environment says; 0 for a program that is run alone. Known
/// before MPI has started, for programs that start others as ranks.
#[must_use]
pub fn rank() -> usize {
    let number = |name: &&str| env::var(name).ok()?.trim().parse().ok();
    let said = || RANK_VARIABLES.iter().find_map(number).unwrap_or(0);
    if launched() > 1 { said() } else { 0 }
}

fn ranks(var: impl Fn(&str) -> Option<String>) -> usize {
    let number = |name: &str| var(name).and_then(|text| text.trim().parse().ok());
    let [rank, tasks] = PMIX_VARIABLES;
    let pmix = || var(rank).and_then(|_| number(tasks));
    let said = SIZE_VARIABLES.into_iter().find_map(number).or_else(pmix);
    said.unwrap_or(1).max(1)
}

/// Ends a rank in step with the others. `main` holds it from the beginning, so that a rank that
/// panics ends all of them.
#[derive(Debug)]
pub struct RankEnding;

impl RankEnding {
    /// Waits for the other ranks to end well, too. Nothing happens when MPI was not started.
    pub fn well(self) {
        #[cfg(feature = "mpi")]
        started::finish();
    }

    /// Ends when all ranks have come to the same end by themselves, as they do over arguments: the
    /// first says which.
    pub fn alike(self, say: impl FnOnce()) {
        #[cfg(feature = "mpi")]
        if launched() > 1 {
            // MPI is started for its end alone: no rank ends, and has its launcher end all, before
            // the first has spoken.
            if Ranks::start().rank == 0 {
                say();
            }
            return started::finish();
        }
        say();
    }

    /// Ends all ranks at once with this exit code: others may wait for what this one will not send.
    /// Returns when MPI was not started.
    pub fn badly(self, code: i32) {
        abort(code);
    }
}

impl Drop for RankEnding {
    fn drop(&mut self) {
        if std::thread::panicking() {
            abort(PANIC_EXIT_CODE);
        }
    }
}

/// The exit code of a Rust program that panicked.
const PANIC_EXIT_CODE: i32 = 101;

fn abort(code: i32) {
    #[cfg(feature = "mpi")]
    started::abort(code);
    #[cfg(not(feature = "mpi"))]
    let _ = code;
}

#[cfg(feature = "mpi")]
pub use started::Ranks;

#[cfg(feature = "mpi")]
mod started {
    use std::sync::{Mutex, PoisonError};
    use std::thread;
    use std::time::Duration;

    use mpi::Threading;
    use mpi::environment::Universe;
    use mpi::topology::{Communicator as _, SimpleCommunicator};
    use mpi::traits::CommunicatorCollectives as _;

    /// How long a rank that waits sleeps between two looks.
    const WAIT_INTERVAL: Duration = Duration::from_micros(500);

    /// MPI while it runs. It can't be started twice.
    static UNIVERSE: Mutex<Option<Universe>> = Mutex::new(None);

    /// This program as one of many ranks.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Ranks {
        /// Its number, from 0.
        pub rank: usize,
        /// How many there are.
        pub size: usize,
    }

    impl Ranks {
        /// Starts MPI, once: a second call returns the same numbers. Its functions are for the
        /// thread that starts it.
        #[must_use]
        pub fn start() -> Self {
            let mut universe = UNIVERSE.lock().unwrap_or_else(PoisonError::into_inner);
            if universe.is_none() {
                let started = mpi::initialize_with_threading(Threading::Funneled);
                *universe = started.map(|(universe, _)| universe);
            }
            Self::of_world()
        }

        fn of_world() -> Self {
            let world = SimpleCommunicator::world();
            Self {
                rank: world.rank().unsigned_abs() as usize,
                size: world.size().unsigned_abs() as usize,
            }
        }

        /// All ranks.
        #[must_use]
        pub fn world(self) -> SimpleCommunicator {
            SimpleCommunicator::world()
        }

        /// Returns when all ranks have called it. MPI's own barrier would keep a core busy until
        /// then.
        pub fn wait(self) {
            let mut barrier = self.world().immediate_barrier();
            while let Err(pending) = barrier.test() {
                barrier = pending;
                thread::sleep(WAIT_INTERVAL);
            }
        }
    }

    pub(super) fn finish() {
        let mut universe = UNIVERSE.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(universe) = universe.take() {
            // Rank 0 may still be at work: the others sleep until it ends, too.
            Ranks::of_world().wait();
            drop(universe);
        }
    }

    pub(super) fn abort(code: i32) {
        // Never waits: a panic may hold the lock.
        let runs = UNIVERSE.try_lock().map_or(true, |held| held.is_some());
        if runs {
            SimpleCommunicator::world().abort(code);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Launchers say how many ranks there are.
    #[test]
    fn launchers_set_the_rank_count() {
        let told = |vars: &[(&str, &str)]| {
            ranks(|name| {
                let var = vars.iter().find(|(known, _)| *known == name);
                var.map(|(_, text)| (*text).to_owned())
            })
        };
        assert_eq!(told(&[]), 1);
        assert_eq!(told(&[("OMPI_COMM_WORLD_SIZE", "8")]), 8);
        assert_eq!(told(&[("PMI_SIZE", "3")]), 3);
        let tasks = ("SLURM_STEP_NUM_TASKS", "5");
        assert_eq!(told(&[("PMIX_RANK", "0"), tasks]), 5);
        assert_eq!(told(&[tasks]), 1, "Slurm starts ordinary programs, too");
        assert_eq!(told(&[("PMI_SIZE", "many")]), 1);
        assert_eq!(told(&[("PMI_SIZE", "0")]), 1);
    }
}
