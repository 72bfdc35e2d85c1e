//! The results for the terminal.

use sdop::settings::Strategy;
use sdop_bench::report::digits::{interval, number};
use sdop_bench::reproduce::paper_name;
use sdop_bench::reproduce::readings::{Reading, TABLE_1_STRATEGIES};

use super::rows::Tables;
use crate::commands::output::{paragraphs, rows};

/// Table 1, times and verdicts; `place` is where the rest was written.
pub fn brief(tables: &Tables, seconds: f64, place: &str) -> String {
    let scenes = tables.drawn.boxes.iter().map(|row| row.scene.as_str());
    let heads: Vec<&str> = std::iter::once("strategy").chain(scenes).collect();
    let by_scene = |strategies: &[Strategy], cells: &dyn Fn(Strategy) -> Vec<String>| {
        let row = |&strategy: &Strategy| {
            [vec![paper_name(strategy).to_owned()], cells(strategy)].concat()
        };
        rows(&heads, strategies, row).to_string()
    };
    let percentages = by_scene(&TABLE_1_STRATEGIES, &|strategy| {
        let reading = Reading::shown(strategy);
        let cells = tables.drawn.table_1.iter();
        let cells = cells.filter(|cell| cell.reading == reading && cell.strategy == strategy);
        let text = |paper: f64| format!(" ({paper:.2})");
        cells
            .map(|cell| interval(&cell.measured) + &cell.paper.map_or_else(String::new, text))
            .collect()
    });
    let times = by_scene(&tables.drawn.strategies(), &|strategy| {
        let costs = tables.drawn.costs.iter().filter(|cost| cost.strategy == strategy);
        let cell = |time: f64, off: f64| format!("{} ({:+.0} %)", number(1e6 * time), 100.0 * off);
        costs.map(|cost| cell(cost.frame.measured.mean, cost.frame.residual.mean)).collect()
    });
    let mut parts = vec![
        format!(
            "Collisions in percent of tests, {} seeds of {} frames; in brackets the paper's\n{percentages}",
            tables.seeds.len(),
            tables.frames
        ),
        format!("Culling, µs per warm frame, and how far the formula's prediction is off\n{times}"),
    ];
    parts.extend(tables.conditions.warning());
    let claim = |verdict: &str, claim: &str| format!("{verdict:<12} {claim}");
    let claims = tables.claims.iter().map(|of| claim(of.verdict().name(), of.claim));
    parts.push(format!("The paper's claims\n{}", claims.collect::<Vec<_>>().join("\n")));
    parts.push(format!("{seconds:.1} s; written to {place}"));
    paragraphs(&parts.join("\n\n"))
}
