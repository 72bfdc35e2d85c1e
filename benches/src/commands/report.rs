//! `sdop report`: renders the numbers on all pages from the records, or checks them.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use miette::{IntoDiagnostic as _, WrapErr as _, miette};
use sdop_bench::measure::conditions::Conditions;
use sdop_bench::report::{CodeVersion, Manifest, Quantities, Store, pages};
use serde::Deserialize as _;

use super::files::write;
use super::output::{print, rows};
use super::{Outcome, reproduce, tradeoff};

/// Pages that people write, with blocks whose numbers come from records.
const PAGES_WITH_BLOCKS: [&str; 16] = [
    "README.md",
    "paper/results.md",
    "benches/adapters/README.md",
    "benches/field/VERDICTS.md",
    "examples/bullet/README.md",
    "examples/rapier/README.md",
    "paper/machines.md",
    "paper/many-ranks.md",
    "paper/proofs/README.md",
    "paper/results/engines.md",
    "paper/results/formula.md",
    "paper/results/kernels.md",
    "paper/summary.md",
    "paper/tradeoff.md",
    "python/bench/README.md",
    "tests/README.md",
];

/// Where figures are.
const FIGURES: &str = "paper/figures";

/// The figures that are made of a record's text, each with its file's name.
type Figures = fn(&str) -> miette::Result<Vec<(String, String)>>;

/// The results that figures are drawn from, by the program that is run, whatever drew those that
/// the record has.
const DRAWN: [(&str, Figures); 2] = [
    ("reproduce/results.json", reproduce::figures_of),
    ("tradeoff/tradeoff.json", tradeoff::figures_of),
];

/// Macros that pages share.
const MACROS: &str = "paper/quantities.jinja";

/// What a page says of a record whose times are disturbed, and of its machine.
const LOADED: &str = "did other work";

/// Templates of blocks, and below `pages` those of whole pages.
const TEMPLATES: &str = "paper/templates";

/// Render the numbers in README and the other pages from data/record
///
/// Pages have blocks between <!-- BEGIN NAME --> and <!-- END NAME -->, from the template
/// paper/templates/NAME.md. The block NAME/PART is what that template has after the line <!-- PART
/// -->. A template paper/templates/pages/PAGE gives a whole page. Templates read records with
/// csv("EXPERIMENT/FILE"), md, json, text, record and records, select rows with where and one, and
/// round with fixed, sig, thousands and percent. The digests of all records are checked first, so
/// that a digit changed by hand is found in pages and in records. A number must look the same on
/// every page. If a record is older than the code that it measures, pages that quote it must name
/// its commit. data/record/quoted.toml names the machine whose records are quoted.
#[derive(clap::Args)]
#[command(
    after_help = "Examples: sdop report\n          sdop report --check\n          sdop report --quantities"
)]
pub struct Args {
    /// Change nothing; exit with 1 if a page would change, a record was changed, two pages show a
    /// number differently, or a page doesn't name the commit of an old record or the other work of
    /// its machine
    #[arg(long)]
    check: bool,
    /// List the numbers that are on more than one page
    #[arg(long)]
    quantities: bool,
    /// The repository
    #[arg(long, value_name = "DIR", default_value = ".")]
    root: PathBuf,
}

/// Runs the command.
///
/// # Errors
/// An expression without a value; pages that can't be read or written.
pub fn run(args: &Args) -> miette::Result<Outcome> {
    let records = args.root.join("data/record");
    let whole = Store::new(&records)?;
    let names = whole.names();
    if names.is_empty() {
        return Err(miette!(
            help = "run it in the root of the repository, or give --root DIR",
            "{} holds no records",
            records.display()
        ));
    }
    let mut problems = Vec::new();
    for name in &names {
        if let Err(error) = whole.manifest(name) {
            problems.push(error.to_string());
        }
    }
    for (from, draw) in DRAWN {
        if let Ok(text) = whole.text(from) {
            for (name, svg) in draw(&text).wrap_err_with(|| format!("cannot draw {from}"))? {
                problems.extend(figure(args, &whole.place(from), &svg, &name)?);
            }
        }
    }
    let quantities = Arc::new(Quantities::default());
    let macros = std::fs::read_to_string(args.root.join(MACROS)).unwrap_or_default();
    let root = args.root.join(TEMPLATES);
    let templates: BTreeMap<String, String> = templates(&root, &root)?
        .into_iter()
        .filter_map(|(name, text)| Some((name.strip_suffix(".md")?.to_owned(), text)))
        .collect();
    let wholes = root.join(pages::WHOLE);
    let wholes = self::templates(&wholes, &wholes)?;
    let now = CodeVersion::here(&args.root);
    let written = PAGES_WITH_BLOCKS
        .into_iter()
        .filter(|page| args.root.join(page).is_file())
        .map(|page| (page, None));
    let made = wholes.iter().map(|(page, template)| (page.as_str(), Some(template.as_str())));
    let pages: Vec<(&str, Option<&str>)> = written.chain(made).collect();
    for (page, template) in &pages {
        // A separate store per page records which records it quotes.
        let sources = pages::PageSources {
            store: Arc::new(Store::new(&records)?),
            macros: macros.clone(),
            templates: templates.clone(),
            quantities: quantities.clone(),
        };
        problems.extend(one_page(args, page, *template, &sources, now.as_ref())?);
    }
    let differing = quantities.given_differently();
    problems.extend(
        differing.iter().map(|quantity| format!("two ways to give one number: {quantity}")),
    );
    if args.quantities {
        list(&quantities)?;
    }
    if problems.is_empty() {
        print(&format!(
            "{} records are intact, {} pages agree with them, and {} numbers look the same on several pages",
            names.len(),
            pages.len(),
            quantities.on_several_pages().len()
        ))?;
        return Ok(Outcome::Passed);
    }
    let table = rows(&["problem"], &problems, |problem| vec![problem.clone()]);
    print(&table.to_string())?;
    Ok(Outcome::Failed(format!("{} problems, the first: {}", problems.len(), problems[0])))
}

/// Files of a directory, and of those in it, by their path from `root`. A repository may have none.
fn templates(root: &Path, directory: &Path) -> miette::Result<BTreeMap<String, String>> {
    let Ok(entries) = directory.read_dir() else {
        return Ok(BTreeMap::new());
    };
    let mut found = BTreeMap::new();
    for entry in entries {
        let path = entry.into_diagnostic()?.path();
        if path.is_dir() {
            found.extend(templates(root, &path)?);
            continue;
        }
        let text = std::fs::read_to_string(&path)
            .into_diagnostic()
            .wrap_err_with(|| format!("cannot read {}", path.display()))?;
        let parts = path.strip_prefix(root).into_diagnostic()?.iter();
        let parts: Vec<_> = parts.map(|part| part.to_string_lossy()).collect();
        found.insert(parts.join("/"), text);
    }
    Ok(found)
}

/// The numbers that stand on more than one page.
fn list(quantities: &Quantities) -> miette::Result<()> {
    let found = quantities.on_several_pages();
    let table = rows(&["number", "as", "pages"], &found, |quantity| {
        let texts: Vec<&str> = quantity.texts.keys().map(String::as_str).collect();
        let pages: std::collections::BTreeSet<&str> =
            quantity.texts.values().flatten().map(String::as_str).collect();
        let pages: Vec<&str> = pages.into_iter().collect();
        vec![quantity.value.to_string(), texts.join(" | "), pages.join(", ")]
    });
    print(&table.to_string())
}

/// Writes a figure of the record that is quoted, or says that the one which is there differs.
fn figure(args: &Args, from: &str, text: &str, name: &str) -> miette::Result<Option<String>> {
    let to = format!("{FIGURES}/{name}");
    let path = args.root.join(&to);
    if std::fs::read_to_string(&path).is_ok_and(|copy| copy == text) {
        return Ok(None);
    }
    if args.check {
        return Ok(Some(format!("{to}: differs from {from}; run sdop report")));
    }
    write(&path, text)?;
    Ok(None)
}

/// Renders or checks one page, from its template or with blocks. Returns what is wrong with it.
fn one_page(
    args: &Args,
    page: &str,
    template: Option<&str>,
    sources: &pages::PageSources,
    now: Option<&CodeVersion>,
) -> miette::Result<Vec<String>> {
    let path = args.root.join(page);
    let text = match std::fs::read_to_string(&path) {
        Err(_) if template.is_some() => String::new(), // not made yet
        text => {
            text.into_diagnostic().wrap_err_with(|| format!("cannot read {}", path.display()))?
        }
    };
    let rendered = match template {
        Some(template) => pages::whole(page, template, sources),
        None => pages::blocks(page, &text, sources),
    };
    let rendered = match rendered {
        Ok(rendered) => rendered,
        Err(error) if args.check => return Ok(vec![error.to_string()]),
        Err(error) => return Err(error),
    };
    let mut problems = Vec::new();
    if rendered != text {
        if args.check {
            problems.push(first_difference(page, &text, &rendered));
        } else {
            write(&path, &rendered)?;
        }
    }
    problems.extend(unnamed_age(page, &rendered, &sources.store, now));
    problems.extend(unnamed_load(page, &rendered, &sources.store));
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
fn unnamed_age(page: &str, text: &str, store: &Store, now: Option<&CodeVersion>) -> Vec<String> {
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

/// Records used by a page whose machine did other work, where the page doesn't say so.
fn unnamed_load(page: &str, text: &str, store: &Store) -> Vec<String> {
    let says_so = text.split_whitespace().collect::<Vec<_>>().join(" ").contains(LOADED);
    let is_disturbed = |(name, manifest): &(String, Manifest)| {
        let files = manifest.files.keys().filter(|file| file.ends_with(".json"));
        let results = files.filter_map(|file| store.json(&format!("{name}/{file}")).ok());
        let mut found = results.filter_map(|of| Conditions::deserialize(&of["conditions"]).ok());
        !says_so && found.any(|conditions| conditions.disturbed())
    };
    let disturbed = store.used().into_iter().filter(is_disturbed);
    let say = |name| format!("{page}: the machine of {name} {LOADED}: say so, or measure again");
    disturbed.map(|(name, _)| say(name)).collect()
}
