//! Starts by `mpirun`: which commands support many ranks, and the error of those that don't.

use sdop_bench::mpi;

/// Fails if the program was started as one of many ranks and the command would do all of its work
/// in each of them.
///
/// # Errors
/// Many ranks, and the program is built without MPI or the command doesn't take them.
pub fn refuse(takes_ranks: bool) -> miette::Result<()> {
    let ranks = mpi::launched();
    if ranks == 1 || (takes_ranks && cfg!(feature = "mpi")) {
        return Ok(());
    }
    if !cfg!(feature = "mpi") {
        miette::bail!(
            help = "build it with `cargo build --release --features mpi`, or start it once",
            "started as one of {ranks} ranks, but this program is built without MPI: each rank would do all of the work"
        );
    }
    miette::bail!(
        help = "start it once, without mpirun",
        "started as one of {ranks} ranks, which this command doesn't take: each would do all of the work"
    )
}
