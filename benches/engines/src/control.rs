//! The gain of more threads: our cullers on one and on several threads, in turns with two control
//! loops that parallelise perfectly, one limited by arithmetic and one by memory.
//!
//! speed-up = t(one thread) / t(several threads) for the same frames, as the median over turns. A
//! control loop's speed-up is what the machine can give at that time, and ours is quoted relative
//! to it. The loops run on the same pool, in as many pieces, and with as much work or as many bytes
//! per body as the culler, so that waking threads costs them the same.

use std::fmt::Write as _;
use std::hint::black_box;
use std::path::PathBuf;

use miette::miette;
use sdop::threads::Threads;
use serde::Serialize;

use sdop_bench::measure::turns::median;
use sdop_bench::remedy::OrReport as _;
use sdop_judge::contestant::Contestant;

use crate::boxes::Frame;
use crate::compare::median_ratio;
use crate::entry::Setup;
use crate::facts::{self, Facts};
use crate::ours;
use crate::record::digits;
use crate::scenes::{Course, Order, Schedule, Spread};
use crate::turns::{TimedEngine, take_turns};

/// Measure the gain of more threads, compared with loops that parallelise perfectly
#[derive(clap::Args)]
pub struct Args {
    /// Numbers of bodies
    #[arg(long, value_delimiter = ',', default_value = "10000,100000,1000000")]
    sizes: Vec<usize>,
    /// Threads next to one
    #[arg(long, default_value_t = 2)]
    threads: usize,
    /// Other load on the machine, for the record
    #[arg(long, default_value = "nothing said of other work")]
    note: String,
    /// Write control.csv, control.json and control.md here
    #[arg(long)]
    out: Option<PathBuf>,
}

/// Names of the control loops.
const ARITHMETIC: &str = "arithmetic";
const MEMORY: &str = "memory";

/// Pieces of a control's work, on any number of threads: as many as ours has on two.
const PIECES: usize = 8;

/// Bytes per body that the memory loop reads and writes each frame: what a culler holds.
const BYTES: usize = 152;

/// Steps per body of the arithmetic loop: some 50 ns, as S-DOP takes.
const STEPS: usize = 96;

/// One work's speed-up.
#[derive(Serialize)]
struct SpeedUp {
    bodies: usize,
    work: &'static str,
    threads: usize,
    ms_1: f64,
    ms: f64,
    speed_up: f64,
    share_of_arithmetic: f64,
    share_of_memory: f64,
}

#[derive(Serialize)]
struct ControlResults {
    #[serde(flatten)]
    facts: Facts,
    rows: Vec<SpeedUp>,
}

/// Measures, prints the table, and writes it if requested.
pub fn run(args: &Args) -> miette::Result<()> {
    let mut measured = ControlResults { facts: Facts::new(args.note.clone()), rows: Vec::new() };
    for &bodies in &args.sizes {
        eprintln!("{bodies} bodies");
        measured.rows.extend(measure(bodies, args.threads)?);
        measured.facts.look_again();
    }
    let page = page(&measured, args.threads);
    if let Some(directory) = &args.out {
        let csv = facts::csv(&measured.rows)?;
        facts::write(directory, "control", csv, &measured, page.clone())?;
    }
    print!("{page}");
    Ok(())
}

fn measure(bodies: usize, threads: usize) -> miette::Result<Vec<SpeedUp>> {
    let course = Course::new(Spread::Uniform, bodies, Order::Random, 0)?;
    let mut names = Vec::new();
    let schedule = Schedule::of(bodies);
    let (timed, _) = take_turns(course, schedule, |course, first| {
        let mut timed = Vec::new();
        let mut enter = |name, engine, threads| {
            names.push(name);
            timed.push(TimedEngine::new(engine, true, threads));
        };
        for threads in [1, threads] {
            let setup = Setup { scene: &course.scene, first, threads };
            for entry in &ours::ENTRIES {
                enter(entry.name, (entry.new)(&setup)?, threads);
            }
            let arithmetic = ControlLoop::new(threads, bodies, compute)?;
            enter(ARITHMETIC, Box::new(arithmetic), threads);
            let floats = bodies * BYTES / size_of::<f32>();
            let memory = ControlLoop::new(threads, floats, touch)?;
            enter(MEMORY, Box::new(memory), threads);
        }
        Ok(timed)
    })?;
    rows(bodies, (threads, schedule.turn), &names, &timed)
}

/// The second half of the engines does what the first does, on more threads.
fn rows(
    bodies: usize,
    (threads, turn): (usize, usize),
    names: &[&'static str],
    timed: &[TimedEngine],
) -> miette::Result<Vec<SpeedUp>> {
    let (alone, together) = timed.split_at(timed.len() / 2);
    let sorted = |timed: &TimedEngine| {
        let mut pairs = timed.engine.pairs();
        pairs.iter_mut().for_each(|pair| pair.sort_unstable());
        pairs.sort_unstable();
        pairs
    };
    let mut rows = Vec::new();
    for ((name, one), several) in names.iter().zip(alone).zip(together) {
        if sorted(one) != sorted(several) {
            return Err(miette!("{name} finds other pairs on {threads} threads"));
        }
        let (one, several) = (one.turns(turn), several.turns(turn));
        rows.push(SpeedUp {
            bodies,
            work: name,
            threads,
            speed_up: median_ratio(&one, &several),
            ms_1: median(one),
            ms: median(several),
            share_of_arithmetic: f64::NAN,
            share_of_memory: f64::NAN,
        });
    }
    let of = |name| rows.iter().find(|row| row.work == name).map(|row| row.speed_up);
    let [arithmetic, memory] = [ARITHMETIC, MEMORY].map(|name| of(name).unwrap_or(f64::NAN));
    for row in &mut rows {
        row.share_of_arithmetic = row.speed_up / arithmetic;
        row.share_of_memory = row.speed_up / memory;
    }
    Ok(rows)
}

/// A control loop over columns of numbers.
struct ControlLoop {
    pool: Threads,
    pieces: Vec<Vec<f32>>,
    work: fn(&mut [f32]),
}

impl ControlLoop {
    fn new(threads: usize, numbers: usize, work: fn(&mut [f32])) -> miette::Result<Self> {
        Ok(Self {
            pool: Threads::new(threads).or_report()?,
            pieces: vec![vec![1.0; numbers / PIECES]; PIECES],
            work,
        })
    }
}

impl Contestant<Frame> for ControlLoop {
    fn frame(&mut self, _: &Frame) {
        let work = self.work;
        self.pool.each(&mut self.pieces, |_, piece| work(black_box(piece)));
    }

    /// None: a control finds nothing.
    fn pairs(&self) -> Vec<[u32; 2]> {
        Vec::new()
    }
}

/// Arithmetic on numbers that stay near.
fn compute(numbers: &mut [f32]) {
    for x in numbers {
        *x = (0..STEPS).fold(*x, |x, _| x * 0.999 + 0.001);
    }
}

/// One pass over memory, in and out.
fn touch(numbers: &mut [f32]) {
    for x in numbers {
        *x = *x * 0.999 + 0.001;
    }
}

fn page(measured: &ControlResults, threads: usize) -> String {
    let mut out = format!("# What {threads} threads are worth\n\n{}", measured.facts);
    let _ = write!(
        out,
        "- milliseconds a frame on one thread and on {threads}; shares of the speed-up of control loops bound by \
         arithmetic and by memory\n\n\
         | bodies | work | ms, 1 thread | ms, {threads} threads | speed-up | share of arithmetic | share of memory |\n\
         |--:|---|--:|--:|--:|--:|--:|\n"
    );
    for row in &measured.rows {
        let _ = writeln!(
            out,
            "| {} | {} | {} | {} | {:.2} | {:.0} % | {:.0} % |",
            row.bodies,
            row.work,
            digits(row.ms_1),
            digits(row.ms),
            row.speed_up,
            100.0 * row.share_of_arithmetic,
            100.0 * row.share_of_memory
        );
    }
    out
}
