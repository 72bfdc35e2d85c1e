//! The long search for the worst rounding error of every bound: `cargo bench --bench worst_case --
//! EVALUATIONS`.
//!
//! Runs one search per thread, each with its own seeds. `paper/proofs/README.md` and `src/rounding`
//! quote the table. Fails if a bound is exceeded, or if a search finds less than the short search
//! of the tests has to.

#[path = "../../tests/worst_case/mod.rs"]
mod searches;

use std::process::ExitCode;

/// Steps of each search when the command line names none.
const EVALUATIONS: u64 = 10_000_000;

fn main() -> ExitCode {
    let evaluations = std::env::args().find_map(|arg| arg.parse().ok()).unwrap_or(EVALUATIONS);
    let threads = std::thread::available_parallelism().map_or(1, |n| n.get() as u64);
    let mut passed = true;
    println!("{evaluations} evaluations each, seeds 1 to {threads}\n");
    println!("| bound | found | constant | unit |\n|---|--:|--:|---|");
    let containments =
        searches::CONTAINMENTS.map(|(name, search)| (name, "", f64::NEG_INFINITY, 0.0, search));
    for (name, unit, teeth, constant, search) in searches::BOUNDS.into_iter().chain(containments) {
        let found = std::thread::scope(|scope| {
            let search = |seed| scope.spawn(move || search(seed, evaluations / threads));
            let searches: Vec<_> = (1..=threads).map(search).collect();
            searches.into_iter().filter_map(|s| s.join().ok()).fold(f64::NEG_INFINITY, f64::max)
        });
        println!("| {name} | {found:.6} | {constant} | {unit} |");
        passed &= teeth <= found && found <= constant;
    }
    if passed { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
