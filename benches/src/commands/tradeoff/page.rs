//! The page that a reader can quote: what each step of accuracy costs.

use std::fmt::Write as _;

use comfy_table::Table;
use sdop::settings::{Axes, Overlap};
use sdop_bench::tradeoff::figure_4;
use sdop_bench::tradeoff::pays::Standing;
use sdop_bench::tradeoff::{Estimate, Tradeoff, VariantResult};

use super::{Recorded, tables};

/// P(or-DOP hit | sphere hit), two-sided, from an earlier study of 12 public meshes and 3 boxes.
const STUDY: [(usize, f64); 4] = [(6, 0.666), (14, 0.478), (18, 0.441), (26, 0.409)];

/// The whole page, as Markdown.
pub(super) fn page(recorded: &Recorded) -> String {
    let mut out = String::new();
    // Writing to a String cannot fail.
    let _ = write_page(&mut out, recorded);
    out
}

fn write_page(out: &mut String, recorded: &Recorded) -> std::fmt::Result {
    let result = &recorded.result;
    writeln!(out, "# What accuracy costs in time\n")?;
    writeln!(
        out,
        "Made by `{}`; nothing here is written by hand. {}. Truth is the exact intersection of the meshes. \
         Counts reproduce to the bit; seconds are one machine's: {}. Times are medians over *warm* frames, which follow one \
         another as in a simulation, unless a column says *cold*: other cullers ran in between. ± is a 95 % interval, of counts over \
         seeds and of times over passes apart in time.\n",
        recorded.command,
        tables::heading(result),
        recorded.machine
    )?;
    if let Some(warning) = result.conditions.warning() {
        writeln!(out, "**{warning}**\n")?;
    }
    section(out, "What should I use?", &tables::decisions(result))?;
    writeln!(
        out,
        "The cheapest total of culling and narrow phase; \"tied\" is what the interval of the difference doesn't tell from it. Times at \
         each density are of this scene's shapes; how many pairs each volume leaves is the mean over the shapes of a class: round \
         ones, whose hulls meet in 70 % of sphere hits at least, thin ones (below 20 %), and compact ones. {}\n",
        result.advice
    )?;
    steps(out, result)?;
    writeln!(out, "![Precision against time](figures/tradeoff.svg)\n")?;
    section(out, "Every volume and strategy", &tables::variants(result))?;
    writeln!(
        out,
        "*front*: on the Pareto front of time and precision; *beaten*: something is better, and the interval of the difference says so; \
         *tied*: only its mean says so. Nu and Nv are a volume each, in the order of the tests. The sum Nu·Cu + F + Nv·Cv is \
         predicted with prices from other, resampled scenes, whose frames took turns with these; F, pair finding, is not in the paper's \
         equation. The residual is measured over predicted, less one; Co is paid once.\n"
    )?;
    figure_4(out, result)?;
    section(out, "When does an or-DOP pay?", &tables::break_even(result))?;
    pays(out, result)?;
    variations(out, result)?;
    survival(out, result)?;
    sizes(out, result)?;
    section(out, "Time-critical", &tables::budgets(result))?;
    writeln!(
        out,
        "![Precision against budget](figures/tradeoff-budget.svg)\n"
    )?;
    writeln!(
        out,
        "For *interest-first*, every tenth body is of interest.\n"
    )?;
    section(out, "Budgets by the clock", &tables::clock(result))?;
    section(out, "Object of interest", &tables::interest(result))?;
    section(out, "The price of safety", &tables::safety(result))?;
    writeln!(
        out,
        "Margins sit in the volumes, so the tests are the same instructions with and without them: they cost no time, \
         only extra pairs, and those are rare. f64 is the reference's plain loops over the same predicate with true supports; \
         what f32 reports beyond it without any margin comes from supports by weak duality."
    )
}

/// The order of volumes that the paper draws, step by step.
fn figure_4(out: &mut String, result: &Tradeoff) -> std::fmt::Result {
    let claim = figure_4::claim(&result.rows);
    writeln!(out, "## Fig. 4's order\n")?;
    writeln!(
        out,
        "\"{}\" **{}**. Volumes alone, k = 18:\n",
        claim.claim,
        claim.verdict()
    )?;
    writeln!(out, "| ratio | value | claimed | verdict |")?;
    writeln!(out, "|---|---:|---:|---|")?;
    for check in &claim.checks {
        writeln!(
            out,
            "| {} | {:.3} ± {:.3} | {} | {} |",
            check.quantity, check.value, check.half_width, check.expected, check.verdict
        )?;
    }
    writeln!(out)
}

/// The steps of accuracy along the front, in words and numbers.
fn steps(out: &mut String, result: &Tradeoff) -> std::fmt::Result {
    let on_front = |row: &&VariantResult| row.standing == Standing::Front;
    let mut front: Vec<&VariantResult> = result.rows.iter().filter(on_front).collect();
    front.sort_by(|a, b| a.seconds().mean.total_cmp(&b.seconds().mean));
    writeln!(out, "## Each step of accuracy\n")?;
    writeln!(
        out,
        "| step | µs per warm frame | false pairs per frame | ns per false pair removed |"
    )?;
    writeln!(out, "|---|---:|---:|---:|")?;
    let mut before: Option<(&VariantResult, f64)> = None;
    for row in front {
        let wrong = row.reported.mean * (1.0 - row.precision.mean);
        let price = before.map_or("–".to_owned(), |(last, w)| {
            let differences = row.times.iter().zip(&last.times).map(|(t, l)| t - l);
            let step = Estimate::in_order(&differences.collect::<Vec<_>>());
            tables::plus_minus(&step, 1e9 / (w - wrong), 0)
        });
        writeln!(
            out,
            "| {} | {} | {wrong:.1} | {price} |",
            row.name,
            tables::plus_minus(&row.seconds(), 1e6, 1)
        )?;
        before = Some((row, wrong));
    }
    writeln!(out)
}

fn pays(out: &mut String, result: &Tradeoff) -> std::fmt::Result {
    writeln!(
        out,
        "Cp in ns above which T + Np·Cp is below that of spheres alone. The exact reference takes {:.1} µs for a pair \
         that doesn't meet and {:.1} µs for one that does.\n",
        1e6 * result.narrow_phase.miss,
        1e6 * result.narrow_phase.hit
    )?;
    writeln!(out, "![Break-even](figures/tradeoff-pays.svg)\n")?;
    writeln!(out, "Cheapest at each density, from which Cp on:\n")?;
    for density in &result.densities {
        let parts: Vec<String> = density
            .cheapest
            .iter()
            .map(|s| format!("{} ({:.0} ns)", s.name, 1e9 * s.from))
            .collect();
        writeln!(
            out,
            "- {:.3} overlaps a body: {}",
            density.partners,
            parts.join(", ")
        )?;
    }
    writeln!(out)
}

/// What moves the choice, beside density.
fn variations(out: &mut String, result: &Tradeoff) -> std::fmt::Result {
    section(
        out,
        "When something else changes",
        &tables::variations(result),
    )?;
    writeln!(
        out,
        "The scene with one thing changed, and the cheapest total for each price of a check, with each variant's own pairs. *bodies* \
         and *motion* keep the density and find pairs by `auto` on frames that follow one another; theirs are means of warm frames, \
         since neighbour lists are made anew in some frames only. *motion* has ten times the bodies, and changes the time step: bodies \
         turn as much further as they move. *triangles* are collapsed edge by edge; they change what an or-DOP costs to build \
         (Co, the dearest of those compared) and what the exact check costs, hardly the volumes. *shapes* have the scene's radii.\n"
    )
}

/// P(hit | spheres hit) beside the earlier study.
fn survival(out: &mut String, result: &Tradeoff) -> std::fmt::Result {
    section(out, "Survivors per sphere hit", &tables::shapes(result))?;
    writeln!(
        out,
        "Two-sided, mean over the shapes, beside an earlier study of 12 meshes and 3 boxes:\n"
    )?;
    writeln!(out, "| k | principal axes | model axes | study |")?;
    writeln!(out, "|---:|---:|---:|---:|")?;
    for (k, study) in STUDY {
        let mean = |axes: Axes| {
            let shares: Vec<f64> = result
                .shapes
                .iter()
                .filter_map(|shape| tables::survivors(shape, k, axes, Overlap::TwoSided))
                .map(|share| share.mean)
                .collect();
            shares.iter().sum::<f64>() / shares.len() as f64
        };
        let (principal, model) = (mean(Axes::Principal), mean(Axes::Model));
        writeln!(out, "| {k} | {principal:.3} | {model:.3} | {study:.3} |")?;
    }
    writeln!(
        out,
        "\nThe means depend on which shapes are averaged, not on chance: elongated and flat shapes (needle, plate, gear) \
         fill little of their spheres and let few pairs through, compact ones (cube, sphere) many.\n"
    )?;
    writeln!(
        out,
        "\"Outside\" are pairs of 18-DOPs that overlap (`full`) although their spheres don't, per pair whose spheres do: what the \
         sphere stage removes beyond the or-DOP. Only corners of an or-DOP that stick out of the sphere can meet there, so it is \
         nothing to speak of unless a mesh nearly fills its sphere.\n"
    )
}

/// Volume over hull volume, every volume and shape.
fn sizes(out: &mut String, result: &Tradeoff) -> std::fmt::Result {
    section(out, "Volume over hull", &tables::sizes(result))?;
    writeln!(
        out,
        "World-aligned volumes are re-fitted as a body turns: theirs is the mean over 64 rotations. The earlier study has 15 other \
         shapes. Needle and plate carry the means of all that isn't oriented with the body; the medians compare. A study's AABB of \
         1.93 is smaller than a cube's over all rotations, so it was taken in the model's frame, where it is or-dop-6-model here.\n"
    )
}

fn section(out: &mut String, title: &str, table: &Table) -> std::fmt::Result {
    writeln!(out, "## {title}\n")?;
    let header: Vec<String> = table
        .header()
        .map(|row| row.cell_iter().map(comfy_table::Cell::content).collect())
        .unwrap_or_default();
    writeln!(out, "| {} |", header.join(" | "))?;
    let ruler: Vec<&str> = header
        .iter()
        .enumerate()
        .map(|(place, _)| if place == 0 { "---" } else { "---:" })
        .collect();
    writeln!(out, "|{}|", ruler.join("|"))?;
    for row in table.row_iter() {
        let cells: Vec<String> = row.cell_iter().map(comfy_table::Cell::content).collect();
        writeln!(out, "| {} |", cells.join(" | "))?;
    }
    writeln!(out)
}
