//! `sdop check`: judges existing answers.

use std::path::PathBuf;

use miette::{IntoDiagnostic as _, WrapErr as _, miette};
use sdop_judge::answer::{Answer, StopReason};
use sdop_judge::run::examine_given;
use sdop_judge::wire::{Wire, book};
use sdop_judge::{Case, Claim, Options, Outcome as CaseOutcome, Subject};

use super::files::ReadArgs;
use super::judge::{ReportFormat, emit_verdict, read_case};
use super::{Outcome, one_of};

/// Judge the pairs in a record, or a program's answers to a case
///
/// Without --pairs, the record's own pairs are judged by the exact reference. The exit code is 1 if
/// a pair that meets is missing, and 3 if frames of the record are missing.
#[derive(clap::Args)]
#[command(
    after_help = "Examples: sdop check run.ndjson --claims mesh\n          ./mine < cases/touch/vertex/0000.ndjson | sdop check cases/touch/vertex/0000.ndjson --pairs -"
)]
pub struct Args {
    /// A case of `sdop cases`, or a record of `sdop run --record`
    record: PathBuf,
    /// The answers, one line per frame; - is standard input
    #[arg(long, value_name = "FILE")]
    pairs: Option<PathBuf>,
    /// The claim [default: the case's first claim; mesh for a record]
    #[arg(long, value_name = "CLAIM", value_parser = one_of::<Claim>(Claim::NAMES))]
    claims: Option<Claim>,
    /// Encoding of the answers
    #[arg(long, value_name = "WIRE", default_value_t = Wire::Ndjson, value_parser = one_of::<Wire>(Wire::NAMES))]
    wire: Wire,
    #[command(flatten)]
    files: ReadArgs,
    /// Output format
    #[arg(long, value_enum, default_value_t)]
    format: ReportFormat,
}

/// A contestant that returns answers from a file.
struct StoredAnswers(Result<Vec<Answer>, StopReason>);

impl Subject for StoredAnswers {
    fn answer(&self, _case: &Case) -> Result<Vec<Answer>, StopReason> {
        self.0.clone()
    }
}

/// Runs the command.
///
/// # Errors
/// A file that can't be read.
pub fn run(args: &Args) -> miette::Result<Outcome> {
    let read = read_case(&args.record, args.files.max_bytes())?;
    let claim = args.claims.unwrap_or(read.case.claim);
    if read.without.contains(&claim) {
        return Err(miette!(
            help = "give each shape its `ball` or `ordop` in body coordinates, or claim mesh",
            "{} can't be judged by the claim {claim}: shapes don't have that volume",
            args.record.display()
        ));
    }
    let options = Options {
        claim,
        // The answers stand; no smaller case has any.
        shrink_time: std::time::Duration::ZERO,
        ..Options::default()
    };
    let answers = match &args.pairs {
        Some(path) => {
            let text = text(path, args.files.max_bytes())?;
            said(args.wire, &text, read.case.frames.len())
        }
        None => Ok(recorded(args, read.pairs)?),
    };
    let mut verdict =
        examine_given(&StoredAnswers(answers), &options, read.case).into_diagnostic()?;
    if let Some(why) = read.lacks {
        // A miss in the existing frames counts even if others are missing.
        for case in &mut verdict.cases {
            if case.outcome == CaseOutcome::Pass {
                let why = why.clone();
                case.outcome = CaseOutcome::Skipped { why };
            }
        }
    }
    emit_verdict(args.format, &verdict)?;
    Ok(Outcome::from(&verdict))
}

fn recorded(args: &Args, pairs: Vec<Option<Vec<[u32; 2]>>>) -> miette::Result<Vec<Answer>> {
    let answer =
        |pairs: Option<Vec<[u32; 2]>>| pairs.map(|pairs| Answer { pairs, ..Answer::default() });
    let answers: Option<Vec<Answer>> = pairs.into_iter().map(answer).collect();
    answers.ok_or_else(|| {
        miette!(
            help = "give the answers with --pairs FILE",
            "{} has frames without pairs",
            args.record.display()
        )
    })
}

/// The content of a file, or of standard input for `-`: at most `most` bytes.
///
/// # Errors
/// It can't be read.
pub fn text(path: &std::path::Path, most: u64) -> miette::Result<Vec<u8>> {
    let read = if path.as_os_str() == "-" {
        sdop::files::read_all(std::io::stdin(), most)
    } else {
        sdop::files::read(path, most)
    };
    read.into_diagnostic().wrap_err_with(|| format!("cannot read {}", path.display()))
}

/// The answers in a text, one per line.
///
/// # Errors
/// A line that is not a valid answer, or more lines than frames.
pub fn said(wire: Wire, text: &[u8], frames: usize) -> Result<Vec<Answer>, StopReason> {
    let lines = text.split(|byte| *byte == b'\n').filter(|line| !line.trim_ascii().is_empty());
    let mut answers = Vec::new();
    for line in lines {
        if answers.len() == frames {
            let line = String::from_utf8_lossy(&line[..line.len().min(80)]).into_owned();
            return Err(sdop_judge::answer::AnswerError::TooMany { frames, line }.into());
        }
        let said = wire.decode(answers.len(), line)?;
        book(&mut answers, said, line)?;
    }
    Ok(answers)
}
