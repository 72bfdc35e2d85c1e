//! The long search for the worst rounding error of every bound: `cargo bench --bench worst_case --
//! EVALUATIONS`.
//!
//! Runs one search per thread, each with its own seeds. `paper/proofs/README.md` and `src/rounding`
//! quote the table. Fails if a bound is exceeded, or if a search finds less than the short search
//! of the tests has to.

#[path = "../../tests/worst_case/bounds.rs"]
mod bounds;
#[path = "../../tests/worst_case/climb.rs"]
mod climb;
#[path = "../../tests/worst_case/exact.rs"]
mod exact;
#[path = "../../tests/worst_case/machine.rs"]
mod machine;
#[path = "../../tests/worst_case/ordop.rs"]
mod ordop;
#[path = "../../tests/worst_case/poses.rs"]
mod poses;
#[path = "../../tests/worst_case/slabs.rs"]
mod slabs;
#[path = "../../tests/worst_case/spheres.rs"]
mod spheres;

use std::process::ExitCode;

/// Steps of each search when the command line names none.
const EVALUATIONS: u64 = 10_000_000;

fn main() -> ExitCode {
    let evaluations = std::env::args().find_map(|arg| arg.parse().ok()).unwrap_or(EVALUATIONS);
    let threads = std::thread::available_parallelism().map_or(1, |n| n.get() as u64);
    let mut passed = true;
    println!("{evaluations} evaluations each, seeds 1 to {threads}\n");
    println!("| bound | found | constant | unit |\n|---|--:|--:|---|");
    for bound in bounds::all().iter().chain(&bounds::containments()) {
        let found = std::thread::scope(|scope| {
            let search = |seed| scope.spawn(move || (bound.search)(seed, evaluations / threads));
            let searches: Vec<_> = (1..=threads).map(search).collect();
            searches.into_iter().filter_map(|s| s.join().ok()).fold(f64::NEG_INFINITY, f64::max)
        });
        println!("| {} | {found:.6} | {} | {} |", bound.name, bound.constant, bound.unit);
        passed &= bound.teeth <= found && found <= bound.constant;
    }
    if passed { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
