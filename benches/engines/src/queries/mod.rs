//! Queries on boxes that rest: each engine's index is built once and asked for all that meet a box
//! or a ball, for all and the first along a segment, and for the pairs between two sets.
//!
//! Every answer is compared with the exact one. An engine's time runs from the question to its
//! answers in memory, in turns with the others, one question after the other on one thread, and all
//! together on several.

mod asked;
mod questions;
mod rapier;

use std::path::PathBuf;
use std::time::Instant;

use asked::{Asked, Ours, Parry};
use questions::{Question, Questions, judge};
use sdop_bench::measure::turns::Quartiles;
use serde::Serialize;

use crate::boxes::Frame;
use crate::compare::median_ratio;
use crate::facts;
use crate::scenes::{Course, Order, Spread};
use crate::threads;

/// Time queries on boxes: single ones and batches
#[derive(clap::Args)]
pub struct Args {
    /// Numbers of boxes
    #[arg(long, value_delimiter = ',', default_value = "1000,10000,100000")]
    sizes: Vec<usize>,
    /// Kinds of questions
    #[arg(long, value_delimiter = ',', default_value = "box,ball,along,first,sets")]
    kinds: Vec<Question>,
    /// Questions of each kind
    #[arg(long, default_value_t = 1000)]
    questions: usize,
    /// Threads of a batch
    #[arg(long, default_value_t = 2)]
    threads: usize,
    /// Turns of each engine
    #[arg(long, default_value_t = 31)]
    turns: usize,
    /// Write queries.csv here
    #[arg(long)]
    out: Option<PathBuf>,
}

/// One engine's answers to one kind of question.
#[derive(Serialize)]
struct QueryTiming {
    question: Question,
    boxes: usize,
    threads: usize,
    engine: &'static str,
    version: &'static str,
    questions: usize,
    answers: usize,
    missed: usize,
    extra: usize,
    us_low: f64,
    us: f64,
    us_high: f64,
    /// Its time over ours, the median over turns.
    ratio: f64,
}

/// An engine's name, its version, and how it is built.
type AskedEntry = (&'static str, &'static str, BuildAsked);
type BuildAsked = fn(&Questions, usize) -> miette::Result<Box<dyn Asked>>;

/// Ours, then the others.
const ENTRIES: [AskedEntry; 3] = [
    ("sdop", env!("CARGO_PKG_VERSION"), |questions, threads| {
        Ok(Box::new(Ours::new(questions, threads)?))
    }),
    ("parry3d", crate::parry::VERSION, |questions, threads| {
        Ok(Box::new(Parry::new(questions, threads)?))
    }),
    ("rapier3d", crate::rapier::VERSION, |questions, threads| {
        Ok(Box::new(rapier::Rapier::new(questions, threads)?))
    }),
];

/// Checks, measures, prints the table, and writes it if asked to.
pub fn run(args: &Args) -> miette::Result<()> {
    let mut rows = Vec::new();
    for &boxes in &args.sizes {
        let mut frame = Frame::default();
        Course::new(Spread::Uniform, boxes, Order::Random, 0)?.next_frame(&mut frame)?;
        let questions = Questions::new(frame.boxes, args.questions);
        let truth = |&question: &Question| (question, questions.truth(question));
        let truths: Vec<_> = args.kinds.iter().map(truth).collect();
        for threads in [1, args.threads] {
            eprintln!("{boxes} boxes, {threads} threads");
            let measure = || measure(&questions, &truths, threads, args.turns);
            rows.extend(match threads {
                1 => measure()?,
                _ => threads::outside_of_pools(measure)?,
            });
        }
    }
    facts::print_csv(&rows, args.out.as_deref(), "queries")
}

/// The questions of all kinds, each with its true answers.
fn measure(
    questions: &Questions,
    truths: &[(Question, Vec<Vec<u32>>)],
    threads: usize,
    turns: usize,
) -> miette::Result<Vec<QueryTiming>> {
    let build = |(_, _, new): &AskedEntry| new(questions, threads);
    let engines = ENTRIES.iter().map(build);
    let mut engines = engines.collect::<miette::Result<Vec<_>>>()?;
    let mut rows = Vec::new();
    for (question, truth) in truths {
        // rapier3d has no query for two sets.
        let count = match question {
            Question::Sets => 2,
            _ => ENTRIES.len(),
        };
        let asked = &mut engines[..count];
        let times = take_turns(questions, *question, asked, turns);
        let timed = ENTRIES.iter().zip(&*asked).zip(&times);
        rows.extend(timed.map(|((&(engine, version, _), asked), us)| {
            let answers = asked.answers();
            let [missed, extra] = judge(*question, truth, &answers);
            let spread = Quartiles::of(us.clone());
            QueryTiming {
                question: *question,
                boxes: questions.boxes.len(),
                threads,
                engine,
                version,
                questions: questions.count(*question),
                answers: answers.iter().map(Vec::len).sum(),
                missed,
                extra,
                us_low: spread.low,
                us: spread.median,
                us_high: spread.high,
                ratio: median_ratio(us, &times[0]),
            }
        }));
    }
    Ok(rows)
}

/// Microseconds per question of each engine in each turn but the first, which warms up.
fn take_turns(
    questions: &Questions,
    question: Question,
    engines: &mut [Box<dyn Asked>],
    turns: usize,
) -> Vec<Vec<f64>> {
    let mut times = vec![Vec::new(); engines.len()];
    for turn in 0..=turns {
        for number in 0..engines.len() {
            let number = (number + turn) % engines.len();
            let start = Instant::now();
            engines[number].ask(question);
            let seconds = start.elapsed().as_secs_f64();
            if turn > 0 {
                times[number].push(1e6 * seconds / questions.count(question) as f64);
            }
        }
    }
    times
}
