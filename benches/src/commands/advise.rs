//! `sdop advise`: which volume and k to use for a scene.

use miette::miette;
use sdop::settings::{CullSettings, Strategy};
use sdop_bench::measure::row::{Row, Rows};
use sdop_bench::measure::turns::Regime;
use sdop_bench::report::digits::interval;
use sdop_bench::tradeoff::Estimate;
use sdop_bench::tradeoff::advise::{
    Advice, Candidate, CandidateFilter, FRAMES, WorldTimes, advise,
};

use super::Outcome;
use super::output::{Format, Listing, emit, paragraphs, rows};
use super::scene_args::{CandidateArgs, MachineArgs, SceneArgs};

/// The default price of a narrow-phase check, in nanoseconds.
const DEFAULT_CHECK_NANOSECONDS: f64 = 1000.0;

/// Recommend a volume, axes and a finder for a scene, with the settings to paste
///
/// Measures every finder, then spheres, boxes, S-DOP at each k with both kinds of axes, and hulls,
/// on the scene's first frames. For each volume it adds the culling time and the narrow phase's
/// time for the pairs that are left. Every volume reports all pairs that meet; they differ in time
/// and in false pairs. With --pairs or --axes, only that finder or these axes are tried. For a
/// scene with `rest`, the cheapest volume is also timed in a World, which keeps the pairs of
/// sleeping bodies.
#[derive(clap::Args)]
#[command(after_help = "Example: sdop advise data/scenes/paper-500.toml --narrow-ns 200")]
pub struct Args {
    #[command(flatten)]
    scene: SceneArgs<CandidateArgs>,
    /// Price of a narrow-phase check of a pair that doesn't meet, in nanoseconds
    #[arg(long, value_name = "X", default_value_t = DEFAULT_CHECK_NANOSECONDS, value_parser = nanoseconds)]
    narrow_ns: f64,
    #[command(flatten)]
    machine: MachineArgs,
    /// Print all tables: also every finder's time
    #[arg(long)]
    all: bool,
    /// Output format
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// Runs the command.
///
/// # Errors
/// An invalid scene.
pub fn run(args: &Args) -> miette::Result<Outcome> {
    let file = args.scene.read()?;
    let CandidateArgs { pairs, axes } = args.scene.cull;
    let tried = CandidateFilter { finder: pairs, axes };
    let advice = advise(&file, tried, 1e-9 * args.narrow_ns, args.machine.tier())?
        .ok_or_else(|| miette!("nothing could be timed"))?;
    match args.format {
        Format::Csv => emit(Format::Csv, &rows_of(&advice), |_| String::new())?,
        format => emit(format, &advice, |advice| text(advice, args.all))?,
    }
    Ok(Outcome::Passed)
}

/// The numbers of every candidate.
fn rows_of(advice: &Advice) -> Vec<Row> {
    let mut rows = Rows::new("advise", &advice.scene);
    for Candidate { name, time, pairs, total, beyond } in &advice.candidates {
        let of = (name.as_str(), Some(Regime::Warm));
        rows.add(of, "time", "s per frame", *time);
        rows.add(of, "reported", "pairs per frame", Estimate::alone(*pairs));
        rows.add(of, "total", "s per frame", Estimate::alone(*total));
        rows.add(of, "above the best", "s per frame", *beyond);
    }
    rows.finish()
}

fn text(advice: &Advice, is_whole: bool) -> String {
    let us = |seconds: f64| format!("{:.1} µs", 1e6 * seconds);
    let of = |name: &str| advice.candidates.iter().find(|candidate| candidate.name == name);
    let spheres = of("sphere").map(|it| format!("; spheres alone take {}", us(it.total)));
    let sum = of(&advice.best).map(|best| {
        format!(
            ": {} of culling + {:.1} pairs × {:.0} ns = {} per frame{}",
            us(best.time.mean),
            best.pairs,
            1e9 * advice.check,
            us(advice.total),
            spheres.unwrap_or_default()
        )
    });
    let tied = match advice.tied.as_slice() {
        [] => "No other is tied with it: every other total is higher by more than its interval."
            .into(),
        tied => format!(
            "Tied with it, since the interval of the difference covers zero: {}.",
            tied.join("; ")
        ),
    };
    let stretches = advice.cheapest.iter().map(|stretch| match stretch.from {
        0.0 => stretch.name.clone(),
        from => format!("{} from {:.0} ns", stretch.name, 1e9 * from),
    });
    let finders = match advice.tied_finders.as_slice() {
        [] => String::new(),
        tied => format!(" (tied with {})", tied.join(", ")),
    };
    let Advice { best, scene, bodies, frames, cull, hulls, .. } = advice;
    let mut parts = vec![
        format!("Use {best}{}.", sum.unwrap_or_default()),
        tied,
        format!("By the price of a check: {}.\n", stretches.collect::<Vec<_>>().join("; ")),
        to_paste(cull, *hulls),
        format!(
            "{scene}: {bodies} bodies, {frames} frames ({FRAMES} at most), pairs from {}{finders}",
            cull.pairs
        ),
        table(&advice.candidates).to_string(),
    ];
    if let Some(WorldTimes { variant, culler, world }) = &advice.world {
        let way = if world.mean < culler.mean { "Use" } else { "Don't use" };
        parts.push(format!(
            "{way} a World, which is given moved bodies and keeps the pairs of all others: {variant} takes {} there, and \
             {} in a Culler.",
            us(world.mean),
            us(culler.mean),
        ));
    }
    parts.push(match is_whole {
        true => format!("\nFinders, for S-DOP\n{}", table(&advice.finders)),
        false => "--all prints the finders' times.".to_owned(),
    });
    parts.extend(advice.conditions.warning());
    paragraphs(&parts.join("\n"))
}

fn table(candidates: &[Candidate]) -> Listing {
    let header = ["variant", "warm µs", "pairs", "total µs", "above the best, µs"];
    rows(&header, candidates, |candidate: &Candidate| {
        let us = |time: &Estimate| interval(&time.scaled(1e6));
        vec![
            candidate.name.clone(),
            us(&candidate.time),
            format!("{:.1}", candidate.pairs),
            format!("{:.1}", 1e6 * candidate.total),
            us(&candidate.beyond),
        ]
    })
}

/// The advice as a scene file's table, as flags, and as Rust.
fn to_paste(cull: &CullSettings, hulls: bool) -> String {
    let CullSettings { strategy, pairs, k, axes, overlap, .. } = cull;
    let mut toml = format!("[cull]\nstrategy = \"{strategy}\"\npairs = \"{pairs}\"\n");
    let mut flags = format!("--strategy {strategy} --pairs {pairs}");
    let mut rust = format!(
        "    sdop::Culler::builder()\n        .strategy(sdop::Strategy::{strategy:?})\n        .finder(sdop::Finder::{pairs:?})\n"
    );
    let mut shape = String::new();
    if *strategy == Strategy::SDopSequential {
        toml += &format!("k = {k}\naxes = \"{axes}\"\noverlap = \"{overlap}\"\n");
        flags += &format!(" \\\n    --k {k} --axes {axes} --overlap {overlap}");
        rust += &format!("        .overlap(sdop::Overlap::{overlap:?})\n");
        shape = format!(
            "    sdop::ShapeSpec {{\n        directions: sdop::DirectionSet::{k:?},\n        axes: sdop::Axes::{axes:?},\n        ..Default::default()\n    }}\n"
        );
    }
    let hulls = if hulls {
        "Then test each reported pair by its convex hulls, which the library leaves to you.\n"
    } else {
        ""
    };
    format!("{toml}\nAs flags: {flags}\nIn Rust:\n{shape}{rust}{hulls}")
}

fn nanoseconds(text: &str) -> Result<f64, String> {
    let value: f64 = text.parse().map_err(|_| "expected nanoseconds, as in 200".to_owned())?;
    if value.is_finite() && value >= 0.0 {
        Ok(value)
    } else {
        Err("expected a finite number of nanoseconds, 0 or more".to_owned())
    }
}

#[cfg(test)]
mod tests {
    #![allow(
        unused_qualifications,
        reason = "pasted code has whole paths, for who has imported nothing"
    )]
    use super::*;
    use sdop::settings::{Axes, DirectionSet, Finder, Overlap};

    /// Compiles the printed code, to check that it is valid.
    macro_rules! compiled {
        ($($code:tt)*) => {{
            let _ = $($code)*;
            stringify!($($code)*)
        }};
    }

    /// Whether a text has this code, whatever the white space in both.
    fn has(text: &str, code: &str) -> bool {
        let dense = |text: &str| text.split_whitespace().collect::<String>();
        dense(text).contains(&dense(code))
    }

    #[test]
    fn pasted_code_compiles() {
        let s_dop = CullSettings {
            strategy: Strategy::SDopSequential,
            pairs: Finder::Neighbours,
            k: DirectionSet::K26,
            axes: Axes::Model,
            overlap: Overlap::OneSided,
            ..CullSettings::default()
        };
        let text = to_paste(&s_dop, true);
        for code in [
            compiled!(sdop::ShapeSpec {
                directions: sdop::DirectionSet::K26,
                axes: sdop::Axes::Model,
                ..Default::default()
            }),
            compiled!(
                sdop::Culler::builder()
                    .strategy(sdop::Strategy::SDopSequential)
                    .finder(sdop::Finder::Neighbours)
                    .overlap(sdop::Overlap::OneSided)
            ),
        ] {
            assert!(has(&text, code), "{text}\n{code}");
        }
        assert!(text.contains("--k 26 --axes model --overlap one-sided"), "{text}");
        assert!(text.contains("convex hulls"));
        let boxes = CullSettings { strategy: Strategy::Aabb, ..CullSettings::default() };
        let text = to_paste(&boxes, false);
        let code = compiled!(
            sdop::Culler::builder().strategy(sdop::Strategy::Aabb).finder(sdop::Finder::Auto)
        );
        assert!(has(&text, code), "{text}");
        assert!(!text.contains("k =") && !text.contains("hulls"), "{text}");
    }
}
