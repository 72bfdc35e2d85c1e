//! Units handed out by rank 0 to whoever is free. Messages are few and small, so all ranks look for them now and then and
//! sleep between: a rank that waits takes no core from one that works.
//!
//! ```text
//!  rank 0   GO ──▶        ◀── HELLO header, node     UNIT n ──▶     ◀── DONE n, result        STOP ──▶
//! ```

use std::time::Duration;

use miette::{IntoDiagnostic as _, miette};
use mpi::Tag;
use mpi::point_to_point::{Destination as _, MatchedReceiveVec as _, Source as _};
use mpi::topology::Communicator as _;
use rayon::ThreadPoolBuilder;

use super::queue::{Move, Queue};
use super::{Event, Header, Sweep, attempt};
use crate::mpi::Ranks;

/// Rank 0 has its work ready: begin.
const GO: Tag = 1;
/// What a rank has to do by its own reading, and on which node.
const HELLO: Tag = 2;
/// Do this unit.
const UNIT: Tag = 3;
/// A unit's result.
const DONE: Tag = 4;
/// Why a unit has none.
const FAILED: Tag = 5;
/// There is nothing left to do.
const STOP: Tag = 6;

/// How long a rank that waits sleeps between two looks.
const NAP: Duration = Duration::from_micros(500);

/// A message: who sent it, what it is, what it says.
struct Letter {
    from: usize,
    tag: Tag,
    text: String,
}

impl Ranks {
    fn post(self, to: usize, tag: Tag, text: &str) {
        let world = self.world();
        // A rank's number is one of MPI's own.
        let to = world.process_at_rank(to as mpi::Rank);
        to.send_with_tag(text.as_bytes(), tag);
    }

    fn wait(self) -> miette::Result<Letter> {
        let world = self.world();
        loop {
            if let Some(found) = world.any_process().immediate_matched_probe() {
                let (bytes, status) = found.matched_receive_vec::<u8>();
                return Ok(Letter {
                    from: status.source_rank().unsigned_abs() as usize,
                    tag: status.tag(),
                    text: String::from_utf8(bytes).into_diagnostic()?,
                });
            }
            std::thread::sleep(NAP);
        }
    }
}

/// Waits until rank 0 has its work ready. A mistake in the arguments is then said by rank 0, once.
///
/// # Errors
/// A message that isn't text.
pub fn await_go(ranks: Ranks) -> miette::Result<()> {
    ranks.wait().map(drop)
}

/// Does the units that rank 0 hands out, until there are none left.
///
/// # Errors
/// A header that JSON has no form for, threads that the system refuses.
pub fn serve(ranks: Ranks, work: &dyn Sweep) -> miette::Result<()> {
    let node = mpi::environment::processor_name().into_diagnostic()?;
    let header = serde_json::to_string(&work.header()?).into_diagnostic()?;
    ranks.post(0, HELLO, &format!("{node}\n{header}"));
    // Ranks are what works side by side here, so each has one thread; what is timed has all that there are.
    let one = ThreadPoolBuilder::new().num_threads(1).build();
    let one = one.into_diagnostic()?;
    let run = |unit| {
        if work.timed(unit) {
            attempt(work, unit)
        } else {
            one.install(|| attempt(work, unit))
        }
    };
    loop {
        let letter = ranks.wait()?;
        if letter.tag == STOP {
            return Ok(());
        }
        let unit = letter.text.parse().into_diagnostic()?;
        match run(unit) {
            Ok(result) => ranks.post(0, DONE, &format!("{unit} {result}")),
            Err(error) => {
                let causes: Vec<String> = error.chain().map(ToString::to_string).collect();
                ranks.post(0, FAILED, &causes.join(": "));
            }
        }
    }
}

/// Has these units done by the other ranks; `on` is called for each when it begins and when it ends. A unit that is timed has its
/// node to itself, unless ranks are to share their cores. When one fails, those under way are still
/// finished and told. The ranks wait for more until [`dismiss`].
///
/// # Errors
/// A unit that fails, a rank that has other work, what `on` says.
pub fn coordinate(
    ranks: Ranks,
    work: &dyn Sweep,
    units: &[usize],
    share_cores: bool,
    on: &mut dyn FnMut(Event) -> miette::Result<()>,
) -> miette::Result<()> {
    let mut office = Office {
        ranks,
        header: work.header()?,
        queue: Queue::new(work, units, share_cores),
        failed: None,
    };
    for rank in 1..ranks.size {
        ranks.post(rank, GO, "");
    }
    let mut expected = ranks.size - 1;
    while expected > 0 || office.queue.under_way() {
        let letter = ranks.wait()?;
        if letter.tag == HELLO {
            expected -= 1;
        }
        office.read(letter, on)?;
    }
    match office.failed {
        Some(error) => Err(error),
        None => Ok(()),
    }
}

/// Lets the other ranks end. Until then they sleep: rank 0 may have work left that needs a quiet machine.
pub fn dismiss(ranks: Ranks) {
    for rank in 1..ranks.size {
        ranks.post(rank, STOP, "");
    }
}

/// What rank 0 knows.
struct Office<'a> {
    ranks: Ranks,
    header: Header,
    queue: Queue<'a>,
    failed: Option<miette::Report>,
}

impl Office<'_> {
    fn read(
        &mut self,
        letter: Letter,
        on: &mut dyn FnMut(Event) -> miette::Result<()>,
    ) -> miette::Result<()> {
        let Letter { from, tag, text } = letter;
        if tag == HELLO {
            let (node, header) = text.split_once('\n').unwrap_or_default();
            let header: Header = serde_json::from_str(header).into_diagnostic()?;
            if let Some(difference) = self.header.difference(&header) {
                return Err(miette!(
                    help = "all ranks must have the same program, scenes and kind of CPU; `here` is rank 0",
                    "rank {from} on {node} has other work: {difference}"
                ));
            }
            self.queue.arrives(from, node);
            return self.hand_out(on);
        }
        self.queue.ended(from);
        if tag == FAILED {
            let failed = miette!("rank {from}: {text}");
            self.failed.get_or_insert(failed);
            return Ok(());
        }
        let (unit, result) = text.split_once(' ').unwrap_or_default();
        let (unit, result) = (unit.parse().into_diagnostic()?, result.to_owned());
        on(Event::Done { unit, result })?;
        self.hand_out(on)
    }

    /// Begins what can be begun, unless something has failed.
    fn hand_out(&mut self, on: &mut dyn FnMut(Event) -> miette::Result<()>) -> miette::Result<()> {
        while self.failed.is_none()
            && let Some(next) = self.queue.next()
        {
            match next {
                Move::Start { unit, rank } => {
                    on(Event::Started { unit, rank })?;
                    self.ranks.post(rank, UNIT, &unit.to_string());
                }
                Move::Leave { unit } => on(Event::Left { unit })?,
            }
        }
        Ok(())
    }
}
