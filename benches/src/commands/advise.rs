//! `sdop advise`: which volume and k to use for a scene.

use miette::miette;
use sdop_bench::tradeoff::advise::{Advice, Candidate, FRAMES, advise};

use super::Outcome;
use super::output::{Format, emit, rows};
use super::scene_args::{MachineArgs, SceneArgs};

/// What a narrow-phase check is taken to cost when nothing is said of it, in nanoseconds.
const CHECK: f64 = 1000.0;

/// Which volume and k to use for a scene, in three lines
///
/// Times spheres, boxes, S-DOP at each k and hulls on the scene's first frames, counts the pairs
/// that each leaves to the narrow phase, and adds both up. Every volume reports all pairs that
/// meet: they differ in time and in false pairs.
#[derive(clap::Args)]
#[command(after_help = "Example: sdop advise data/scenes/paper-500.toml --narrow-ns 200")]
pub struct Args {
    #[command(flatten)]
    scene: SceneArgs,
    /// What the narrow phase takes for a pair that doesn't meet, in nanoseconds
    #[arg(long, value_name = "X", default_value_t = CHECK, value_parser = nanoseconds)]
    narrow_ns: f64,
    #[command(flatten)]
    machine: MachineArgs,
    /// How the result is printed
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// Runs the command.
///
/// # Errors
/// A bad scene.
pub fn run(args: &Args) -> miette::Result<Outcome> {
    let file = args.scene.read()?;
    let advice = advise(&file, 1e-9 * args.narrow_ns, args.machine.tier())?
        .ok_or_else(|| miette!("nothing could be timed"))?;
    match args.format {
        Format::Csv => emit(Format::Csv, &advice.candidates, |_| String::new())?,
        format => emit(format, &advice, text)?,
    }
    Ok(Outcome::Passed)
}

fn text(advice: &Advice) -> String {
    let us = |seconds: f64| format!("{:.1} µs", 1e6 * seconds);
    let of = |name: &str| {
        advice
            .candidates
            .iter()
            .find(|candidate| candidate.name == name)
    };
    let spheres = of("sphere").map_or(String::new(), |spheres| {
        format!("; spheres alone take {}", us(spheres.total))
    });
    let sum = of(&advice.best).map_or(String::new(), |best| {
        format!(
            ": {} of culling + {:.1} pairs × {:.0} ns = {} per frame{spheres}",
            us(best.time.mean),
            best.pairs,
            1e9 * advice.check,
            us(advice.total)
        )
    });
    let tied = match advice.tied.as_slice() {
        [] => "Nothing else comes near: every other total is higher, and its interval says so."
            .to_owned(),
        tied => format!("As good, as far as these times tell: {}.", tied.join("; ")),
    };
    let stretches: Vec<String> = advice
        .cheapest
        .iter()
        .map(|stretch| match stretch.from {
            0.0 => stretch.name.clone(),
            from => format!("{} from {:.0} ns", stretch.name, 1e9 * from),
        })
        .collect();
    let header = [
        "variant",
        "warm µs",
        "±",
        "pairs",
        "total µs",
        "above the best, µs",
        "±",
    ];
    let numbers = rows(&header, &advice.candidates, |candidate: &Candidate| {
        let us = |seconds: f64| format!("{:.1}", 1e6 * seconds);
        vec![
            candidate.name.clone(),
            us(candidate.time.mean),
            us(candidate.time.half_width),
            format!("{:.1}", candidate.pairs),
            us(candidate.total),
            us(candidate.beyond.mean),
            us(candidate.beyond.half_width),
        ]
    });
    let mut text = format!(
        "Use {}{sum}.\n{tied}\nBy the price of a check: {}.\n\n{}: {} bodies, {} frames (at most {FRAMES} are looked at)\n{numbers}",
        advice.best,
        stretches.join("; "),
        advice.scene,
        advice.bodies,
        advice.frames,
    );
    if let Some(warning) = advice.conditions.warning() {
        text = format!("{text}\n{warning}");
    }
    text
}

fn nanoseconds(text: &str) -> Result<f64, String> {
    let value: f64 = text
        .parse()
        .map_err(|_| "expected nanoseconds, as in 200".to_owned())?;
    if value.is_finite() && value >= 0.0 {
        Ok(value)
    } else {
        Err("expected a finite number of nanoseconds, 0 or more".to_owned())
    }
}
