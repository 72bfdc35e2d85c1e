//! An engine that is linked in as a program that speaks the judge's format: `sdop board` judges it
//! like all others.

use std::io::{BufRead, Write as _};
use std::path::Path;
use std::time::Instant;

use miette::{IntoDiagnostic as _, miette};
use sdop_bench::scene::{Scene, SceneFile};
use sdop_judge::Case;
use sdop_judge::wire::ndjson;
use serde_json::json;

use crate::entry::{Engine, Entry, Setup, roster};
use crate::frame::{Frame, Slabs};

/// Answer the judge's cases with an engine: read them from standard input, print each frame's pairs
#[derive(clap::Args)]
pub struct Args {
    /// The engine's name
    engine: String,
    /// Print the engine's version
    #[arg(long)]
    version: bool,
}

/// The longest case.
const MOST_BYTES: u64 = 1 << 30;

/// A scene whose shapes and bodies a case replaces.
const SCENE: &str =
    "name = 'case'\nframes = 1\n[[bodies]]\nshape = 'box'\nposes = [[0, 0, 0, 1, 0, 0, 0]]\n";

/// Answers cases until the input ends.
///
/// # Errors
/// An engine that isn't here, a case that can't be read.
pub fn run(args: &Args) -> miette::Result<()> {
    let entry = roster().into_iter().find(|entry| entry.name() == args.engine);
    let entry = entry.ok_or_else(|| miette!("no engine is called `{}`", args.engine))?;
    if args.version {
        println!("{}", entry.row.version);
        return Ok(());
    }
    let mut input = std::io::stdin().lock();
    loop {
        let mut text = Vec::new();
        if input.read_until(b'\n', &mut text).into_diagnostic()? == 0 {
            return Ok(());
        }
        let header: serde_json::Value = serde_json::from_slice(&text).into_diagnostic()?;
        for _ in 0..header["frames"].as_u64().unwrap_or(u64::MAX) {
            if input.read_until(b'\n', &mut text).into_diagnostic()? == 0 {
                break;
            }
        }
        let read = ndjson::read(text.as_slice(), MOST_BYTES);
        answer(&entry, &read.map_err(|problem| miette!("{problem}"))?.case)?;
    }
}

/// Answers a case. An engine whose set of bodies changes is made anew; one without bodies isn't
/// asked.
fn answer(entry: &Entry, case: &Case) -> miette::Result<()> {
    let mut scene = SceneFile::parse(SCENE, "case", Path::new(""))?.build()?;
    scene.shapes.clone_from(&case.shapes);
    scene.side = Some(reach(case));
    let mut engine: Option<Engine> = None;
    let mut out = std::io::stdout().lock();
    for (number, given) in case.frames.iter().enumerate() {
        let frame = frame(given, &scene);
        if given.was.is_some() {
            engine = None;
        }
        let (mut pairs, mut ns) = (Vec::new(), 0);
        if !frame.boxes.is_empty() {
            if engine.is_none() {
                let setup = Setup { scene: &scene, first: &frame, threads: 1, is_sparse: false };
                match (entry.new)(&setup) {
                    Ok(made) => engine.insert(made).settle(),
                    Err(problem) => {
                        let why = json!({ "frame": number, "skipped": problem.to_string() });
                        return writeln!(out, "{why}").into_diagnostic();
                    }
                }
            }
            if let Some(engine) = &mut engine {
                let start = Instant::now();
                engine.frame(&frame);
                ns = start.elapsed().as_nanos() as u64;
                engine.settle();
                pairs = engine.pairs();
            }
        }
        // Engines do not know which bodies are static: all boxes meet all. A body that doesn't
        // exist is for the judge to see.
        let is_dynamic = |&body: &u32| frame.bodies.dynamic.get(body as usize) != Some(&false);
        pairs.retain(|pair| pair.iter().any(is_dynamic));
        pairs.iter_mut().for_each(|pair| pair.sort_unstable());
        writeln!(out, "{}", json!({ "frame": number, "pairs": pairs, "ns": ns }))
            .into_diagnostic()?;
    }
    out.flush().into_diagnostic()
}

/// The largest coordinate of a case's boxes, for engines that want to know their world.
fn reach(case: &Case) -> f32 {
    let boxes = case.frames.iter().flat_map(|frame| &frame.boxes);
    boxes.flatten().fold(1.0, |most: f32, end| most.max(end.abs()))
}

/// A frame of a case as engines take it.
fn frame(given: &sdop_judge::Frame, scene: &Scene) -> Frame {
    let slabs = |ends: &[f32; 6]| -> Slabs { [0, 1, 2].map(|axis| [ends[axis], ends[axis + 3]]) };
    let mut frame = Frame::default();
    frame.fill(&given.bodies, &scene.shapes);
    frame.set_boxes(given.boxes.iter().map(slabs).collect());
    frame
}
