//! `sdop cases`: writes the cases as files, for programs that are judged later or elsewhere.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use miette::{IntoDiagnostic as _, miette};
use sdop_judge::Claim;
use sdop_judge::broadmark::{self, RecordingError};
use sdop_judge::catalogue::select;
use sdop_judge::vectors;
use sdop_judge::wire::Wire;

use super::output::{print, progress};
use super::{Outcome, files, one_of};

/// Write the cases of the judge as files
///
/// Writes one file per case, named after the case. A program reads it and answers each frame with
/// one line; `sdop check CASE --pairs FILE` judges the answers.
#[derive(clap::Args)]
#[command(
    after_help = "Examples: sdop cases --out cases --claims mesh\n          sdop cases --case exact/tip-to-tip/0003 --out - | ./mine | sdop check cases/exact/tip-to-tip/0003.ndjson --pairs -"
)]
pub struct Args {
    /// Output directory; - is standard output, for one case
    #[arg(long, value_name = "DIR", required_unless_present = "vectors")]
    out: Option<PathBuf>,
    /// Instead, write small cases of two bodies with the answers for all claims into this directory
    #[arg(long, value_name = "DIR", conflicts_with_all = ["out", "claims", "case", "fresh", "wire"])]
    vectors: Option<PathBuf>,
    /// The claim whose cases are written
    #[arg(long, value_name = "CLAIM", default_value_t = Claim::Mesh, value_parser = one_of::<Claim>(Claim::NAMES))]
    claims: Claim,
    /// Only cases with matching names: * matches any text, ? one character
    #[arg(long, value_name = "GLOB", default_value = "*")]
    case: String,
    /// Fresh cases with this seed instead of the published ones
    #[arg(long, value_name = "SEED")]
    fresh: Option<u64>,
    /// Write Broadmark's recordings (.aabbs) instead of text; for the claim aabb, without cases in
    /// which the set of bodies changes
    #[arg(long, conflicts_with = "wire")]
    aabbs: bool,
    /// Encoding of the cases
    #[arg(long, value_name = "WIRE", default_value_t = Wire::Ndjson, value_parser = one_of::<Wire>(Wire::NAMES))]
    wire: Wire,
}

/// Runs the command.
///
/// # Errors
/// No case of that name, a file that can't be written.
pub fn run(args: &Args) -> miette::Result<Outcome> {
    if let Some(directory) = &args.vectors {
        return vectors(directory);
    }
    let Some(out) = &args.out else {
        return Err(miette!("no directory: give --out DIR"));
    };
    let claim = if args.aabbs { Claim::Aabb } else { args.claims };
    let jobs = select(claim, &args.case, args.fresh).into_diagnostic()?;
    let to_stdout = out.as_os_str() == "-";
    if jobs.is_empty() || (to_stdout && jobs.len() > 1) {
        let help = "`sdop cases --out DIR` writes them all: their names are the files'";
        return Err(miette!(
            help = help,
            "{} cases of the claim {} match `{}`",
            jobs.len(),
            claim,
            args.case
        ));
    }
    let extension = match args.wire {
        _ if args.aabbs => "aabbs",
        Wire::Ndjson => "ndjson",
        Wire::Text => "txt",
    };
    let mut written = 0;
    let bar = progress(jobs.len() as u64, "cases");
    for id in &jobs {
        let case = id.case().into_diagnostic()?;
        let bytes = match broadmark::write(&case) {
            _ if !args.aabbs => args.wire.encode(&case).into_diagnostic()?,
            Ok(bytes) => bytes,
            Err(RecordingError::Changes) => continue,
            Err(error) => return Err(error).into_diagnostic(),
        };
        if to_stdout {
            std::io::stdout().write_all(&bytes).into_diagnostic()?;
        } else {
            files::write(&out.join(format!("{}.{extension}", case.name)), &bytes)?;
        }
        written += 1;
        bar.inc(1);
    }
    bar.finish_and_clear();
    if !to_stdout {
        print(&format!("{} cases of the claim {} in {}", written, claim, out.display()))?;
    }
    Ok(Outcome::Passed)
}

fn vectors(directory: &Path) -> miette::Result<Outcome> {
    let made = vectors::files().into_diagnostic()?;
    for (name, bytes) in &made {
        files::write(&directory.join(name), bytes)?;
    }
    print(&format!("{} files in {}", made.len(), directory.display()))?;
    Ok(Outcome::Passed)
}
