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
use miette::IntoDiagnostic as _;
use questions::{Question, Questions, judge};
use sdop_bench::measure::turns::{Quartiles, median};
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
    #[arg(
        long,
        value_delimiter = ',',
        default_value = "box,ball,along,first,sets"
    )]
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
        for &question in &args.kinds {
            eprintln!("{boxes} boxes, {question:?}");
            let truth = questions.truth(question);
            for threads in [1, args.threads] {
                let measure = || measure(&questions, question, &truth, threads, args.turns);
                let measured = match threads {
                    1 => measure(),
                    _ => threads::outside_of_pools(measure),
                };
                rows.extend(measured?);
            }
        }
    }
    let text = facts::csv(&rows)?;
    print!("{text}");
    if let Some(directory) = &args.out {
        std::fs::create_dir_all(directory).into_diagnostic()?;
        sdop::files::write(&directory.join("queries.csv"), text).into_diagnostic()?;
    }
    Ok(())
}

fn measure(
    questions: &Questions,
    question: Question,
    truth: &[Vec<u32>],
    threads: usize,
    turns: usize,
) -> miette::Result<Vec<QueryTiming>> {
    // rapier3d has no query for two sets.
    let entries = match question {
        Question::Sets => &ENTRIES[..2],
        _ => &ENTRIES[..],
    };
    let build = |(_, _, new): &AskedEntry| new(questions, threads);
    let mut engines = entries
        .iter()
        .map(build)
        .collect::<miette::Result<Vec<_>>>()?;
    let count = questions.count(question);
    let mut times = vec![Vec::new(); engines.len()];
    for turn in 0..=turns {
        for number in 0..engines.len() {
            let number = (number + turn) % engines.len();
            let start = Instant::now();
            engines[number].ask(question);
            let seconds = start.elapsed().as_secs_f64();
            if turn > 0 {
                times[number].push(1e6 * seconds / count as f64);
            }
        }
    }
    let rows = entries.iter().zip(&engines).zip(&times);
    let rows = rows.map(|(((engine, version, _), asked), us)| {
        let answers = asked.answers();
        let [missed, extra] = judge(question, truth, &answers);
        let spread = Quartiles::of(us.clone());
        QueryTiming {
            question,
            boxes: questions.boxes.len(),
            threads,
            engine,
            version,
            questions: count,
            answers: answers.iter().map(Vec::len).sum(),
            missed,
            extra,
            us_low: spread.low,
            us: median(us.clone()),
            us_high: spread.high,
            ratio: median_ratio(us, &times[0]),
        }
    });
    Ok(rows.collect())
}
