//! Does work in units: all of it here, together with other ranks of `mpirun`, or a part for `sdop
//! merge`.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Instant;

use miette::{IntoDiagnostic as _, WrapErr as _};
use sdop_bench::mpi;
#[cfg(feature = "mpi")]
use sdop_bench::mpi::Ranks;
#[cfg(feature = "mpi")]
use sdop_bench::network::MpiNetwork;
use sdop_bench::sweep::{Header, OrderedResults, Shard, Sweep, run_in_process, write_shard};

use super::files::{SHARING, command};
use super::output::{print, progress};

/// How units are shared.
#[derive(clap::Args)]
#[command(next_help_heading = "Many machines")]
pub struct SweepArgs {
    /// Do shard i of n, every n-th unit of the work, and write it to the output directory for
    /// `sdop merge`
    #[arg(long, value_name = "i/n")]
    pub shard: Option<Shard>,
    /// Under mpirun, let ranks on one machine measure times at the same time
    #[arg(long)]
    share_cores: bool,
}

/// Receives results in the order of units.
type TakeResult<'a> = &'a mut dyn FnMut(usize, &str) -> miette::Result<()>;

/// Begins a command whose work may be shared: other ranks wait until the first one has checked the
/// arguments.
///
/// # Errors
/// A shard by one of many ranks.
pub fn enter(args: &SweepArgs) -> miette::Result<()> {
    if mpi::launched() > 1 {
        miette::ensure!(
            args.shard.is_none(),
            help = "leave --shard out, or start it once",
            "--shard is for processes that know nothing of each other, and these are ranks of mpirun"
        );
        #[cfg(feature = "mpi")]
        if Ranks::start().rank > 0 {
            Ranks::start().wait();
        }
    }
    Ok(())
}

impl SweepArgs {
    /// The request, as arguments for another command.
    pub fn arguments(&self) -> Vec<String> {
        let [shard, share_cores] = SHARING.map(str::to_owned);
        let mut arguments = Vec::new();
        if let Some(part) = self.shard {
            arguments.extend([shard, part.to_string()]);
        }
        arguments.extend(self.share_cores.then_some(share_cores));
        arguments
    }

    /// Does the work, and returns its wall time. `take` gets the results in the order of units.
    /// `None` when another process has them: this one wrote a shard's file into `directory`, or is
    /// a rank whose results rank 0 has received.
    ///
    /// # Errors
    /// A unit that fails, files that can't be written.
    pub fn run(
        &self,
        work: &dyn Sweep,
        directory: &Path,
        take: TakeResult,
    ) -> miette::Result<Option<f64>> {
        let start = Instant::now();
        let header = work.header()?;
        #[cfg(feature = "mpi")]
        if mpi::launched() > 1 {
            let seconds = self.on_ranks(work, &header, take)?;
            return Ok(seconds.then(|| start.elapsed().as_secs_f64()));
        }
        let Some(shard) = self.shard else {
            units(work, (0..header.units).collect(), take)?;
            return Ok(Some(start.elapsed().as_secs_f64()));
        };
        let mut part = BTreeMap::new();
        let mut keep = |unit, result: &str| {
            part.insert(unit, result.to_owned());
            Ok(())
        };
        units(work, shard.units(header.units), &mut keep)?;
        let header = Header { shard: Some(shard), line: command(), ..header };
        let name = format!("{}-{}-of-{}.units", header.command, shard.index, shard.of);
        let path = directory.join(name);
        std::fs::create_dir_all(directory)
            .and_then(|()| write_shard(&path, &header, &part, start.elapsed().as_secs_f64()))
            .into_diagnostic()
            .wrap_err_with(|| format!("cannot write {}", path.display()))?;
        let (units, all) = (part.len(), header.units);
        print(&format!("{}: {units} of {all} units", path.display()))?;
        Ok(None)
    }

    /// Does this rank's part of the work; whether this is rank 0, which takes all results.
    #[cfg(feature = "mpi")]
    fn on_ranks(
        &self,
        work: &dyn Sweep,
        header: &Header,
        take: TakeResult,
    ) -> miette::Result<bool> {
        let ranks = Ranks::start();
        let first = ranks.rank == 0;
        if first {
            ranks.wait(); // The others may begin.
        }
        let own = header.units.div_ceil(ranks.size) as u64;
        let bar = first.then(|| progress(own, "units of rank 0"));
        let mut ended = |unit| {
            if let Some(bar) = &bar {
                bar.set_message(work.name(unit));
                bar.inc(1);
            }
        };
        let network = MpiNetwork::new(ranks);
        let done = sdop_bench::sweep::on_ranks(&network, work, self.share_cores, &mut ended);
        if let Some(bar) = &bar {
            bar.finish_and_clear();
        }
        for (unit, result) in done? {
            take(unit, &result)?;
        }
        Ok(first)
    }
}

/// Does these units in this process.
fn units(work: &dyn Sweep, units: Vec<usize>, take: TakeResult) -> miette::Result<()> {
    let bar = progress(units.len() as u64, "units");
    let mut order = OrderedResults::new(units.clone(), take);
    let mut on = |unit, result| {
        bar.set_message(work.name(unit));
        bar.inc(1);
        order.put(unit, result)
    };
    let ended = run_in_process(work, &units, &mut on);
    bar.finish_and_clear();
    ended
}
