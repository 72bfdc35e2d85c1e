//! `sdop report`: renders every page's numbers from the records, or checks that they are what the records say.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use miette::{IntoDiagnostic as _, WrapErr as _, miette};
use sdop::lab::report::{Code, Store, pages};

use super::Outcome;
use super::files::write;
use super::output::{print, rows};

/// Pages whose numbers come from records.
const PAGES: [&str; 8] = [
    "README.md",
    "benches/README.md",
    "benches/peers/BIAS.md",
    "benches/peers/VERDICTS.md",
    "tests/README.md",
    "paper/guide.md",
    "paper/artifact.md",
    "paper/report.typ",
];

/// Render the numbers of README and the other pages from data/record
///
/// A page quotes a record between markers, <!--= EXPRESSION -->3.14<!--/-->. Every record's digests are checked first, so a
/// digit changed by hand is found wherever it stands, in a page or in a record. A record that is older than the code it measures must have
/// its commit named on the pages that quote it.
#[derive(clap::Args)]
#[command(after_help = "Examples: sdop report\n          sdop report --check")]
pub struct Args {
    /// Change nothing; exit with 1 when a page would change, a record was changed, or an old record isn't called old
    #[arg(long)]
    check: bool,
    /// The repository
    #[arg(long, value_name = "DIR", default_value = ".")]
    root: PathBuf,
}

/// Runs the command.
///
/// # Errors
/// A marker without a value; pages that can't be read or written.
pub fn run(args: &Args) -> miette::Result<Outcome> {
    let records = args.root.join("data/record");
    let names = Store::new(&records).names();
    if names.is_empty() {
        return Err(miette!(
            help = "run it in the root of the repository, or give --root DIR",
            "{} holds no records",
            records.display()
        ));
    }
    let mut problems = Vec::new();
    let whole = Store::new(&records);
    for name in &names {
        if let Err(error) = whole.manifest(name) {
            problems.push(error.to_string());
        }
    }
    let now = Code::here(&args.root);
    for page in PAGES.iter().filter(|page| args.root.join(page).is_file()) {
        problems.extend(one_page(args, &records, page, now.as_ref())?);
    }
    if problems.is_empty() {
        print(&format!(
            "{} records whole, {} pages agree with them",
            names.len(),
            PAGES
                .iter()
                .filter(|page| args.root.join(page).is_file())
                .count()
        ))?;
        return Ok(Outcome::Passed);
    }
    let table = rows(&["problem"], &problems, |problem| vec![problem.clone()]);
    print(&table.to_string())?;
    Ok(Outcome::Failed)
}

/// Renders or checks one page; what is wrong with it.
fn one_page(
    args: &Args,
    records: &Path,
    page: &str,
    now: Option<&Code>,
) -> miette::Result<Vec<String>> {
    let path = args.root.join(page);
    let text = std::fs::read_to_string(&path)
        .into_diagnostic()
        .wrap_err_with(|| format!("cannot read {}", path.display()))?;
    let store = Arc::new(Store::new(records));
    let rendered = match pages::render(page, &text, &store) {
        Ok(rendered) => rendered,
        Err(error) if args.check => return Ok(vec![error.to_string()]),
        Err(error) => return Err(error.into()),
    };
    let mut problems = Vec::new();
    if rendered != text {
        if args.check {
            problems.push(first_difference(page, &text, &rendered));
        } else {
            write(&path, &rendered)?;
        }
    }
    problems.extend(unnamed_age(page, &rendered, &store, now));
    Ok(problems)
}

/// Where a page first differs from its records.
fn first_difference(page: &str, text: &str, rendered: &str) -> String {
    let pairs = text.lines().zip(rendered.lines()).enumerate();
    let mut differing = pairs.filter(|(_, (a, b))| a != b);
    match differing.next() {
        Some((index, (written, recorded))) => format!(
            "{page}:{}: written `{}`, recorded `{}`; run sdop report",
            index + 1,
            written.trim(),
            recorded.trim()
        ),
        None => format!("{page}: lines missing; run sdop report"),
    }
}

/// Records used by a page that are older than the code, and whose commit the page doesn't name.
fn unnamed_age(page: &str, text: &str, store: &Store, now: Option<&Code>) -> Vec<String> {
    let Some(now) = now else {
        return Vec::new();
    };
    let old = store.used().into_iter().filter_map(|(name, manifest)| {
        let code = manifest.code?;
        let commit = code.commit.get(..7)?.to_owned();
        (code.trees != now.trees && !text.contains(&commit)).then_some((name, commit))
    });
    old.map(|(name, commit)| {
        format!("{page}: {name} is older than the code: name its commit {commit} or measure again")
    })
    .collect()
}
