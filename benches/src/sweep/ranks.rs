//! Ranks of `mpirun` as shards: rank i of n does shard i + 1 of n, and rank 0 receives all results.
//!
//! All ranks do units without timing at the same time. Then the ranks of one machine do their timed
//! units one rank at a time, while the others sleep.

use std::collections::BTreeMap;

use miette::{IntoDiagnostic as _, miette};
use rayon::ThreadPoolBuilder;

use super::{Header, Shard, Sweep, attempt};
use crate::network::{Network, tell_all, tell_first};

/// Does this rank's part of the work; `ended` is called after each of its units. Rank 0 gets the
/// results of all ranks, the others none. With `share_cores`, ranks of one machine time side by
/// side. Collective.
///
/// # Errors
/// A unit that fails, on the rank that has it; ranks with different work, on rank 0. Other ranks
/// may wait for this one then: the caller ends them.
pub fn on_ranks(
    network: &impl Network,
    work: &dyn Sweep,
    share_cores: bool,
    ended: &mut dyn FnMut(usize),
) -> miette::Result<BTreeMap<usize, String>> {
    let header = work.header()?;
    let headers = tell_first(network, serde_json::to_vec(&header).into_diagnostic()?);
    same_work(&header, &headers, network.rank())?;
    let shard = Shard { index: network.rank() + 1, of: network.size() };
    let units = shard.units(header.units).into_iter();
    let (timed, counted): (Vec<usize>, Vec<usize>) = units.partition(|&unit| work.timed(unit));
    let mut done = BTreeMap::new();
    let mut run = |unit: usize, attempt: &dyn Fn(usize) -> miette::Result<String>| {
        if work.starts(unit) {
            done.insert(unit, attempt(unit).map_err(|error| of_rank(network, &error))?);
        }
        ended(unit);
        Ok::<_, miette::Report>(())
    };
    // Ranks are what works side by side here, so each has one thread; what is timed has all that
    // there are.
    let one = ThreadPoolBuilder::new().num_threads(1).build();
    let one = one.into_diagnostic()?;
    for unit in counted {
        run(unit, &|unit| one.install(|| attempt(work, unit)))?;
    }
    let mut timed = || timed.iter().try_for_each(|&unit| run(unit, &|unit| attempt(work, unit)));
    if share_cores {
        timed()?;
    } else {
        let machines = tell_all(network, network.machine().as_bytes());
        let own = turn(&machines, network.rank());
        let last = (0..network.size()).map(|rank| turn(&machines, rank)).max();
        for now in 0..=last.unwrap_or(0) {
            network.wait();
            if now == own {
                timed()?;
            }
        }
    }
    network.wait();
    let mine = serde_json::to_vec(&done).into_diagnostic()?;
    let mut all = BTreeMap::new();
    for part in tell_first(network, mine).iter().filter(|part| !part.is_empty()) {
        let part: BTreeMap<usize, String> = serde_json::from_slice(part).into_diagnostic()?;
        all.extend(part);
    }
    Ok(all)
}

/// How many ranks of a rank's machine time before it.
fn turn(machines: &[Vec<u8>], rank: usize) -> usize {
    let before = machines[..rank].iter();
    before.filter(|other| **other == machines[rank]).count()
}

/// Checks on rank 0, which has the headers of all ranks, that they belong to the same work.
fn same_work(header: &Header, headers: &[Vec<u8>], rank: usize) -> miette::Result<()> {
    for (other, text) in headers.iter().enumerate().filter(|_| rank == 0) {
        let other_header: Header = serde_json::from_slice(text).into_diagnostic()?;
        if let Some(difference) = header.difference(&other_header) {
            return Err(miette!(
                help = "all ranks must have the same program, scenes and kind of CPU; `here` is rank 0",
                "rank {other} has different work: {difference}"
            ));
        }
    }
    Ok(())
}

/// An error with its causes in one line that names the rank: lines of many ranks arrive in any
/// order.
fn of_rank(network: &impl Network, error: &miette::Report) -> miette::Report {
    let causes: Vec<String> = error.chain().map(ToString::to_string).collect();
    miette!("rank {}: {}", network.rank(), causes.join(": "))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;

    /// Ten squares. Odd units are timed, unit 6 comes too late, `fails` has no result.
    struct Squares {
        fails: usize,
        running: AtomicUsize,
        met: AtomicUsize,
    }

    impl Sweep for Squares {
        fn header(&self) -> miette::Result<Header> {
            let settings = BTreeMap::<String, u8>::new();
            Header::new("squares", &settings, BTreeMap::new(), 10).into_diagnostic()
        }
        fn name(&self, unit: usize) -> String {
            format!("square of {unit}")
        }
        fn run(&self, unit: usize) -> miette::Result<String> {
            miette::ensure!(unit != self.fails, "planted");
            let beside = self.running.fetch_add(1, Ordering::SeqCst);
            std::thread::sleep(std::time::Duration::from_millis(20));
            if beside > 0 && self.timed(unit) {
                self.met.fetch_add(1, Ordering::SeqCst);
            }
            self.running.fetch_sub(1, Ordering::SeqCst);
            Ok(format!("{{\"square\": {}}}", unit * unit))
        }
        fn timed(&self, unit: usize) -> bool {
            unit % 2 == 1
        }
        fn starts(&self, unit: usize) -> bool {
            unit != 6
        }
    }

    /// What each rank gets, and how many timed units ran next to others.
    fn run(ranks: usize, share_cores: bool) -> (Vec<BTreeMap<usize, String>>, usize) {
        let work =
            Squares { fails: usize::MAX, running: AtomicUsize::new(0), met: AtomicUsize::new(0) };
        let each = crate::network::on_ranks(ranks, |net| {
            on_ranks(net, &work, share_cores, &mut |_| {}).unwrap()
        });
        (each, work.met.into_inner())
    }

    #[test]
    fn rank_0_has_every_result() {
        let done = (0..10).filter(|unit| *unit != 6);
        let expected: BTreeMap<usize, String> =
            done.map(|unit| (unit, format!("{{\"square\": {}}}", unit * unit))).collect();
        for ranks in [1, 2, 3, 12] {
            let (each, _) = run(ranks, false);
            assert_eq!(each[0], expected, "{ranks} ranks");
            assert!(each[1..].iter().all(BTreeMap::is_empty));
        }
    }

    #[test]
    fn timed_units_run_alone() {
        assert_eq!(run(3, false).1, 0);
        // Three ranks that sleep in five units, all at once.
        assert!(run(3, true).1 > 0);
    }

    #[test]
    fn turns_count_within_a_machine() {
        let machines = ["a", "b", "a", "c", "a", "b"].map(|name| name.as_bytes().to_vec());
        let turns: Vec<usize> = (0..6).map(|rank| turn(&machines, rank)).collect();
        assert_eq!(turns, [0, 0, 1, 0, 2, 1]);
    }

    #[test]
    fn a_failure_names_its_rank() {
        let work = Squares { fails: 5, running: AtomicUsize::new(0), met: AtomicUsize::new(0) };
        let errors = crate::network::on_ranks(1, |net| {
            on_ranks(net, &work, false, &mut |_| {}).unwrap_err().to_string()
        });
        assert_eq!(errors, ["rank 0: unit 5, square of 5, failed: planted"]);
    }

    #[test]
    fn other_work_is_refused() {
        let header =
            |units| Header::new("squares", &BTreeMap::<String, u8>::new(), BTreeMap::new(), units);
        let texts = [9, 8].map(|units| serde_json::to_vec(&header(units).unwrap()).unwrap());
        let error = same_work(&header(9).unwrap(), &texts, 0).unwrap_err().to_string();
        assert_eq!(error, "rank 1 has different work: the number of units is 9 here and 8 there");
    }
}
