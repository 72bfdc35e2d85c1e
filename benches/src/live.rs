//! The program of the page to play with, for WebAssembly with WASI: it culls a scene's frames and
//! writes what the viewer shows to standard output, as `sdop view` inserts it into its page.
//!
//!     sdop-live SCENE [--truth] [STRATEGY]
//!
//! A strategy is shown next to the scene's own. With `--truth`, the meshes that meet are decided in
//! exact arithmetic, which takes longer.

use std::io::{self, Write as _};
use std::path::Path;

use miette::{Diagnostic, IntoDiagnostic as _, miette};
use sdop::settings::CullSettings;
use sdop::simd::Tier;
use sdop_bench::remedy::OrReport as _;
use sdop_bench::scene::SceneFile;
use sdop_bench::view::{Page, ShownRun, decide_truth};

fn main() {
    if let Err(report) = show() {
        let error: &dyn Diagnostic = report.as_ref();
        let help = error.help().map_or(String::new(), |help| format!("\n{help}"));
        eprintln!("{error}{help}");
        std::process::exit(1);
    }
}

fn show() -> miette::Result<()> {
    let (flags, names): (Vec<_>, Vec<_>) =
        std::env::args().skip(1).partition(|arg| arg.starts_with("--"));
    let (path, beside) = names.split_first().ok_or_else(|| miette!("no scene is given"))?;
    let scene = SceneFile::read(Path::new(path))?.build()?;
    let mut show = ShownRun::scene(&scene, Path::new(path), Tier::detect(), || ())?;
    let mut culled = vec![show.recorded()];
    for name in beside {
        let strategy = name.parse().into_diagnostic()?;
        let settings = CullSettings { strategy, ..scene.cull.clone() };
        culled.push(show.cull(&settings, Tier::detect()).or_report()?);
    }
    if flags.contains(&"--truth".to_owned()) {
        decide_truth(&mut show, || ())?;
    }
    let mut out = io::stdout().lock();
    Page::new(&show, &culled, None)?.write_data(&mut out).into_diagnostic()?;
    out.flush().into_diagnostic()
}
