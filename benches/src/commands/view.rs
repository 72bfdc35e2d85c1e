//! `sdop view`: writes a run as one self-contained HTML page.

mod input;

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use miette::{IntoDiagnostic as _, WrapErr as _, miette};
use sdop::files::WholeFile;
use sdop::settings::{CullSettings, Strategy};
use sdop_bench::remedy::OrReport as _;
use sdop_bench::view::{Page, ShownRun, ShownStrategy, decide_truth};

use super::Outcome;
use super::output::{print, progress};
use super::scene_args::{MachineArgs, SceneArgs};
use input::ViewInput;

/// Write a page that shows a run: bodies, pairs, volumes and counts, frame by frame
///
/// The page contains all of its data and opens from disk. Bodies of reported pairs change colour;
/// the colour also shows whether their meshes meet. A missed pair flashes and is listed. A record
/// shows what a program reported, ours or any other.
#[derive(clap::Args)]
#[command(
    mut_arg("scene", |arg| arg.value_name("SCENE|RECORD|CASE").help(
        "A scene file (TOML), a record (as `sdop run --record` writes it), a case of the judge (as `sdop cases` and a miss of `sdop judge` are written), or a group of hard cases (data/hard_cases/*.toml)"
    )),
    after_help = "Examples: sdop view data/scenes/paper-500.toml --open\n          sdop run data/scenes/paper-50.toml --record run.ndjson && sdop view run.ndjson --beside sphere"
)]
pub struct Args {
    /// Output file [default: the scene's name, in the current directory]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Open the page in the browser
    #[arg(long)]
    open: bool,
    /// A second strategy on the same frames, or another record of them, side by side
    #[arg(long, value_name = "STRATEGY|RECORD")]
    beside: Option<String>,
    /// A program's answers to a case (`sdop cases`) or record, one line per frame; - is standard
    /// input
    #[arg(long, value_name = "FILE")]
    answers: Option<PathBuf>,
    /// Which run of a group of hard cases
    #[arg(long, value_name = "N")]
    run: Option<usize>,
    /// Don't compute which meshes meet, unless the record has it; the exact decision is slow for
    /// large scenes
    #[arg(long)]
    no_truth: bool,
    /// Don't show T, whose prices would be calibrated on this machine
    #[arg(long)]
    no_prices: bool,
    #[command(flatten)]
    scene: SceneArgs,
    #[command(flatten)]
    machine: MachineArgs,
}

/// Runs the command. A broken record makes a page that says so, with the frames before the flaw,
/// and is an error too.
///
/// # Errors
/// A bad scene or record, settings that it can't have, a page that can't be written.
pub fn run(args: &Args) -> miette::Result<Outcome> {
    let tier = args.machine.tier();
    let (page, name, broken) =
        match input::read(&args.scene, args.run, args.answers.as_deref(), tier)? {
            ViewInput::Run(mut show, broken) => {
                let culled = culled(args, &show)?;
                if !args.no_truth {
                    let bar = progress(show.frames.len() as u64, "which meshes meet");
                    decide_truth(&mut show, || bar.inc(1))?;
                    bar.finish_and_clear();
                }
                let tier = (!args.no_prices).then_some(tier);
                let page = Page::new(&show, &culled, tier)?;
                (page, show.header.scene, broken)
            }
            ViewInput::Broken(error) => {
                let path = &args.scene.path;
                let stem = path.file_stem().unwrap_or(path.as_os_str());
                (Page::broken(path, &error), stem.to_string_lossy().into_owned(), Some(error))
            }
        };
    let written = write(args, &page, &name)?;
    match broken {
        Some(error) => Err(error)
            .or_report()
            .wrap_err_with(|| format!("the page {} shows what can be read", written.display())),
        None => Ok(Outcome::Passed),
    }
}

/// What is shown: the pairs as recorded, and a second strategy's or record's.
fn culled(args: &Args, show: &ShownRun) -> miette::Result<Vec<ShownStrategy>> {
    let mut culled = vec![show.recorded()];
    let Some(beside) = &args.beside else {
        return Ok(culled);
    };
    culled.push(match beside.parse::<Strategy>() {
        Ok(strategy) => {
            let settings =
                CullSettings { strategy, ..show.header.cull.clone().unwrap_or_default() };
            show.cull(&settings, args.machine.tier()).or_report()?
        }
        Err(unknown) if !Path::new(beside).exists() => {
            return Err(miette!(
                help = unknown.hint,
                "--beside: {beside:?} is neither a strategy nor a record"
            ));
        }
        Err(_) => {
            let (other, broken) = ShownRun::record(Path::new(beside), None).or_report()?;
            if let Some(error) = broken {
                return Err(error).or_report();
            }
            show.culled_by(&other).map_err(|why| {
                miette!(
                    help = "--beside takes another record of the same bodies in the same poses",
                    "{beside}: not the frames of {}: {why}",
                    show.source
                )
            })?
        }
    });
    Ok(culled)
}

/// Writes the page, opens it if requested, and returns its path.
fn write(args: &Args, page: &Page, name: &str) -> miette::Result<PathBuf> {
    let own = || format!("{}.html", safe(name)).into();
    let path = args.out.clone().unwrap_or_else(own);
    let bytes = write_page(page, &path)?;
    print(&format!("{}: {:.1} MB", path.display(), bytes as f64 / 1e6))?;
    if args.open {
        open(&path)?;
    }
    Ok(path)
}

/// Has the desktop open a file, and doesn't wait for it.
fn open(path: &Path) -> miette::Result<()> {
    let opener = match std::env::consts::OS {
        "macos" => "open",
        "windows" => "explorer",
        _ => "xdg-open",
    };
    let started =
        Command::new(opener).arg(path).stdout(Stdio::null()).stderr(Stdio::null()).spawn();
    started.map(drop).map_err(|cause| {
        miette!(
            help = "open it in any browser",
            "--open: {opener} can't open {}: {cause}",
            path.display()
        )
    })
}

fn write_page(page: &Page, path: &Path) -> miette::Result<u64> {
    let cannot = || format!("cannot write {}", path.display());
    let mut file = WholeFile::create(path).into_diagnostic().wrap_err_with(cannot)?;
    page.write(&mut file).into_diagnostic().wrap_err_with(cannot)?;
    file.finish().into_diagnostic().wrap_err_with(cannot)?;
    std::fs::metadata(path).map(|found| found.len()).into_diagnostic().wrap_err_with(cannot)
}

/// A scene's name as a file's: it may hold anything.
fn safe(name: &str) -> String {
    let plain = |c: char| {
        if c.is_alphanumeric() || "-_.".contains(c) { c } else { '-' }
    };
    let name: String = name.chars().map(plain).collect();
    match name.trim_matches(['.', '-']) {
        "" => "run".to_owned(),
        name => name.to_owned(),
    }
}
