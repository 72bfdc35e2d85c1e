//! Running units in this process, as many at a time as the default pool has threads.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc;
use std::thread;

use super::{EndHandler, Sweep, attempt};

/// Does these units; `on` is called for each when it ends. Those that need all threads come last,
/// one at a time. When one fails, running ones are still finished and reported.
///
/// # Errors
/// A unit that fails, the first that is seen; what `on` says.
pub fn run_in_process(work: &dyn Sweep, units: &[usize], on: EndHandler) -> miette::Result<()> {
    let (alone, beside): (Vec<usize>, Vec<usize>) =
        units.iter().partition(|&&unit| work.alone(unit));
    side_by_side(work, &beside, on)?;
    for unit in alone {
        on(unit, one(work, unit)?)?;
    }
    Ok(())
}

/// Uses its own threads, because a pool's worker that waits within a unit would start another unit
/// on top of it.
fn side_by_side(work: &dyn Sweep, units: &[usize], on: EndHandler) -> miette::Result<()> {
    let (next, stopped) = (AtomicUsize::new(0), AtomicBool::new(false));
    thread::scope(|scope| {
        let (send, receive) = mpsc::channel();
        for _ in 0..rayon::current_num_threads().min(units.len()) {
            let (send, next, stopped) = (send.clone(), &next, &stopped);
            scope.spawn(move || {
                while let Some(&unit) = units.get(next.fetch_add(1, Ordering::Relaxed)) {
                    if stopped.load(Ordering::Relaxed) {
                        return;
                    }
                    // Nobody listens once `on` has failed.
                    let _ = send.send((unit, one(work, unit)));
                }
            });
        }
        drop(send);
        let mut ended = Ok(());
        for (unit, result) in receive {
            let told = result.and_then(|result| on(unit, result));
            if told.is_err() {
                stopped.store(true, Ordering::Relaxed);
            }
            ended = ended.and(told);
        }
        ended
    })
}

fn one(work: &dyn Sweep, unit: usize) -> miette::Result<Option<String>> {
    let starts = work.starts(unit);
    starts.then(|| attempt(work, unit)).transpose()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::super::Header;
    use super::*;
    use std::collections::BTreeMap;

    /// Unit 5 fails, unit 7 panics if requested, and unit 3 is too late.
    struct Squares {
        units: usize,
        timed: bool,
        running: AtomicUsize,
    }

    impl Sweep for Squares {
        fn header(&self) -> miette::Result<Header> {
            let header =
                Header::new("squares", &BTreeMap::<String, u8>::new(), BTreeMap::new(), self.units);
            Ok(header.unwrap())
        }
        fn name(&self, unit: usize) -> String {
            format!("square of {unit}")
        }
        fn run(&self, unit: usize) -> miette::Result<String> {
            let beside = self.running.fetch_add(1, Ordering::SeqCst);
            assert!(!self.timed || beside == 0, "timed units run alone");
            self.running.fetch_sub(1, Ordering::SeqCst);
            assert!(unit != 7, "planted");
            miette::ensure!(unit != 5, "five");
            Ok((unit * unit).to_string())
        }
        fn timed(&self, _: usize) -> bool {
            self.timed
        }
        fn starts(&self, unit: usize) -> bool {
            unit != 3
        }
    }

    fn run(units: &[usize], timed: bool) -> (miette::Result<()>, Vec<(usize, Option<String>)>) {
        let work = Squares { units: 10, timed, running: AtomicUsize::new(0) };
        let mut told = Vec::new();
        let mut on = |unit, result| {
            told.push((unit, result));
            Ok(())
        };
        let ended = run_in_process(&work, units, &mut on);
        told.sort();
        (ended, told)
    }

    /// Every unit is done or left out once.
    #[test]
    fn every_unit_is_handled_once() {
        for timed in [false, true] {
            let (ended, told) = run(&[0, 2, 3, 4], timed);
            ended.unwrap();
            let done = |unit: usize| (unit, Some((unit * unit).to_string()));
            assert_eq!(told, [done(0), done(2), (3, None), done(4)]);
        }
    }

    /// A unit that fails or panics is named.
    #[test]
    fn failed_unit_is_named() {
        for (unit, why) in [(5, "five"), (7, "panicked")] {
            for timed in [false, true] {
                let (ended, _) = run(&[0, unit], timed);
                let error = ended.unwrap_err();
                assert_eq!(error.to_string(), format!("unit {unit}, square of {unit}, failed"));
                assert!(error.chain().any(|cause| cause.to_string().contains(why)));
            }
        }
    }
}
