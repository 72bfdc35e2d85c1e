//! Work in units: done here, by the ranks of `mpirun`, or in part for `sdop merge`; kept in a journal and gone on from.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Instant;

use miette::{IntoDiagnostic as _, WrapErr as _};
use sdop_bench::mpi;
#[cfg(feature = "mpi")]
use sdop_bench::mpi::Ranks;
use sdop_bench::sweep::{Event, Header, InOrder, Journal, Shard, Sweep, Units, here, write_shard};

use super::files::command;
use super::output::{print, progress};

/// How units are shared.
#[derive(clap::Args)]
#[command(next_help_heading = "Many machines")]
pub struct SweepArgs {
    /// Do part i of n, every n-th unit of the work, and leave it in the output directory for `sdop merge`
    #[arg(long, value_name = "i/n")]
    shard: Option<Shard>,
    /// Go on from the journal that an interrupted run left in the output directory, if there is one
    #[arg(long)]
    resume: bool,
    /// Under mpirun, let ranks on one machine time side by side
    #[arg(long)]
    share_cores: bool,
}

/// The flags of [`SweepArgs`].
pub const SHARING: [&str; 3] = ["--shard", "--resume", "--share-cores"];

/// Work of which all units are done and taken.
pub struct Finished {
    /// Wall time.
    pub seconds: f64,
    journal: Option<Journal>,
}

impl Finished {
    /// What was taken has become a result: neither the journal nor other ranks are needed any more.
    ///
    /// # Errors
    /// The system refuses to remove it.
    pub fn clear(self) -> miette::Result<()> {
        #[cfg(feature = "mpi")]
        if mpi::launched() > 1 {
            sdop_bench::sweep::ranks::dismiss(Ranks::start());
        }
        match self.journal {
            Some(journal) => Ok(journal.remove()?),
            None => Ok(()),
        }
    }
}

/// Begins a command whose work may be shared: ranks but the first wait until that has found the arguments good.
///
/// # Errors
/// A shard by one of many ranks.
pub fn enter(args: &SweepArgs) -> miette::Result<()> {
    #[cfg(feature = "mpi")]
    if mpi::launched() > 1 {
        miette::ensure!(
            args.shard.is_none(),
            help = "leave --shard out, or start it once",
            "--shard is for processes that know nothing of each other, and these are ranks of mpirun"
        );
        let ranks = Ranks::start();
        if ranks.rank > 0 {
            return sdop_bench::sweep::ranks::await_go(ranks);
        }
    }
    let _ = args;
    Ok(())
}

impl SweepArgs {
    /// The part of the work that was asked for.
    pub fn shard(&self) -> Option<Shard> {
        self.shard
    }

    /// Whether an interrupted run is to be gone on from.
    pub fn resumes(&self) -> bool {
        self.resume
    }

    /// What was said, as arguments of another command.
    pub fn arguments(&self) -> Vec<String> {
        let [shard, resume, share_cores] = SHARING.map(str::to_owned);
        let mut arguments = Vec::new();
        if let Some(part) = self.shard {
            arguments.extend([shard, part.to_string()]);
        }
        arguments.extend(self.resume.then_some(resume));
        arguments.extend(self.share_cores.then_some(share_cores));
        arguments
    }

    /// Does the work. `take` gets the results in the order of units; `None` when another process has them: this one wrote a
    /// shard's file into `directory`, or is a rank that rank 0 has taken the results of.
    ///
    /// # Errors
    /// A unit that fails, a journal that can't be used, files that can't be written.
    pub fn run(
        &self,
        work: &dyn Sweep,
        directory: &Path,
        take: &mut dyn FnMut(usize, &str) -> miette::Result<()>,
    ) -> miette::Result<Option<Finished>> {
        #[cfg(feature = "mpi")]
        if mpi::launched() > 1 && Ranks::start().rank > 0 {
            sdop_bench::sweep::ranks::serve(Ranks::start(), work)?;
            return Ok(None);
        }
        let header = Header {
            shard: self.shard,
            line: command(),
            ..work.header()?
        };
        if self.shard.is_none() {
            return self.whole(work, directory, &header, take).map(Some);
        }
        let mut part = BTreeMap::new();
        let mut keep = |unit, result: &str| {
            part.insert(unit, result.to_owned());
            Ok(())
        };
        let finished = self.whole(work, directory, &header, &mut keep)?;
        let path = directory.join(name(&header)).with_extension("units");
        write_shard(&path, &header, &part, finished.seconds)
            .into_diagnostic()
            .wrap_err_with(|| format!("cannot write {}", path.display()))?;
        finished.clear()?;
        let (units, all) = (part.len(), header.units);
        print(&format!("{}: {units} of {all} units", path.display()))?;
        Ok(None)
    }

    /// Does all units, or those of the shard.
    fn whole(
        &self,
        work: &dyn Sweep,
        directory: &Path,
        header: &Header,
        take: &mut dyn FnMut(usize, &str) -> miette::Result<()>,
    ) -> miette::Result<Finished> {
        let start = Instant::now();
        let units = match self.shard {
            Some(shard) => shard.units(header.units),
            None => (0..header.units).collect(),
        };
        let (mut journal, before) = self.journal(directory, header)?;
        let done = before.map_or_else(BTreeMap::new, |before| {
            tell(&before, work, &units);
            before.done
        });
        let ended = self.rest(work, units, done, &mut journal, take);
        if let (Err(_), Some(_)) = (&ended, &journal) {
            let place = directory.display();
            eprintln!("what is done is kept in {place}: --resume goes on from it");
        }
        ended?;
        let seconds = start.elapsed().as_secs_f64();
        Ok(Finished { seconds, journal })
    }

    /// A journal, with `--resume` or `--shard`, or when there are many ranks.
    fn journal(
        &self,
        directory: &Path,
        header: &Header,
    ) -> miette::Result<(Option<Journal>, Option<Units>)> {
        if !(self.resume || self.shard.is_some() || mpi::launched() > 1) {
            return Ok((None, None));
        }
        let path = directory.join(name(header)).with_extension("journal");
        let (journal, before) = Journal::open(&path, header, self.resume)?;
        Ok((Some(journal), before))
    }

    /// Does what is not done yet.
    fn rest(
        &self,
        work: &dyn Sweep,
        units: Vec<usize>,
        done: BTreeMap<usize, String>,
        journal: &mut Option<Journal>,
        take: &mut dyn FnMut(usize, &str) -> miette::Result<()>,
    ) -> miette::Result<()> {
        let left: Vec<usize> = units
            .iter()
            .copied()
            .filter(|unit| !done.contains_key(unit))
            .collect();
        let bar = progress(units.len() as u64, "units");
        bar.inc(done.len() as u64);
        let mut order = InOrder::new(units, take);
        for (unit, result) in done {
            order.put(unit, Some(result))?;
        }
        let mut on = |event: Event| {
            if let Some(journal) = journal {
                journal.keep(&event)?;
            }
            let (unit, result) = match event {
                Event::Started { .. } => return Ok(()),
                Event::Done { unit, result } => (unit, Some(result)),
                Event::Left { unit } => (unit, None),
            };
            bar.set_message(work.name(unit));
            bar.inc(1);
            order.put(unit, result)
        };
        let ended = self.units(work, &left, &mut on);
        bar.finish_and_clear();
        ended
    }

    /// Does these units, by other ranks if there are some.
    fn units(
        &self,
        work: &dyn Sweep,
        units: &[usize],
        on: &mut dyn FnMut(Event) -> miette::Result<()>,
    ) -> miette::Result<()> {
        #[cfg(feature = "mpi")]
        if mpi::launched() > 1 {
            let ranks = Ranks::start();
            return sdop_bench::sweep::ranks::coordinate(ranks, work, units, self.share_cores, on);
        }
        here(work, units, on)
    }
}

/// What a work's files are called.
fn name(header: &Header) -> String {
    let shard = header
        .shard
        .map(|shard| format!("-{}-of-{}", shard.index, shard.of));
    format!("{}{}", header.command, shard.unwrap_or_default())
}

/// What a journal has.
fn tell(before: &Units, work: &dyn Sweep, units: &[usize]) {
    eprintln!(
        "{} of {} units are done already",
        before.done.len(),
        units.len()
    );
    if before.torn > 0 {
        eprintln!(
            "the journal's last line was torn ({} bytes) and is dropped",
            before.torn
        );
    }
    for (&unit, rank) in &before.begun {
        eprintln!(
            "rank {rank} had begun unit {unit}, {}, when the run ended",
            work.name(unit)
        );
    }
}
