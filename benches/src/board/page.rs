//! The board as one HTML page that opens from disk.
//!
//! `board.html` is its template. The page contains the viewer once, and for each counter-example
//! only its data. The browser joins the two when a reader opens a counter-example.

use minijinja::value::Serde;
use minijinja::{Environment, Value, context};

use super::speed::{SELF_REPORTED, Speed};
use super::{Board, Row};
use crate::report::digits::thousands;
use crate::view::Page;

const TEMPLATE: &str = include_str!("board.html");

/// The page.
///
/// # Errors
/// Never for a board: the template is tested.
pub fn page(board: &Board) -> Result<String, minijinja::Error> {
    let mut environment = Environment::new();
    environment.set_undefined_behavior(minijinja::UndefinedBehavior::Strict);
    environment.add_filter("thousands", thousands);
    environment.add_template("board.html", TEMPLATE)?;
    let cells = || board.adapters.iter().flat_map(|row| &row.cells);
    let mut families: Vec<String> = cells().map(|cell| cell.family.clone()).collect();
    families.sort_unstable();
    families.dedup();
    let around = Page::around().map(|parts| script(&parts)).unwrap_or_default();
    let pictures: Vec<(String, String)> = board
        .adapters
        .iter()
        .flat_map(|row| row.cells.iter().map(move |cell| (row, cell)))
        .filter_map(|(row, cell)| {
            let page = &cell.smallest.as_ref()?.page;
            Some((format!("{}-{}", row.adapter.name, cell.family), script(page)))
        })
        .collect();
    environment.get_template("board.html")?.render(context! {
        board => plain(board),
        libraries => plain(&libraries(board)),
        families,
        around => Value::from_safe_string(around),
        pictures => pictures.into_iter().map(|(name, data)| (name, Value::from_safe_string(data))).collect::<Vec<_>>(),
        times => plain(&times(board)),
    })
}

/// The rows of each use of a library, which are one line of the page.
fn libraries(board: &Board) -> Vec<&[Row]> {
    let is_same = |a: &Row, b: &Row| a.adapter.base == b.adapter.base;
    board.adapters.chunk_by(is_same).collect()
}

/// A value for the template.
fn plain(value: &impl serde::Serialize) -> Value {
    Value::from(Serde(serde_json::to_value(value).unwrap_or_default()))
}

/// A value as JSON that can't end the element that contains it.
fn script(value: &(impl serde::Serialize + ?Sized)) -> String {
    serde_json::to_string(value).unwrap_or_default().replace('<', "\\u003c")
}

/// A line of the table of times.
#[derive(serde::Serialize)]
struct Time<'a> {
    #[serde(flatten)]
    speed: &'a Speed,
    /// The time with its unit.
    time: String,
    /// The recall in percent; 100 % is never a rounded value.
    percent: String,
    /// The length of its bar in percent, on a logarithmic scale.
    bar: f64,
    /// Whether it is one of this project's cullers.
    is_ours: bool,
}

/// Every contestant, sorted by claim and then by time.
fn times(board: &Board) -> Vec<Time<'_>> {
    let mut all: Vec<&Speed> = board.times.iter().collect();
    all.sort_by_key(|speed| (speed.claim.name(), speed.median_ns));
    let logs = || all.iter().map(|speed| (speed.median_ns.max(1) as f64).ln());
    let (low, high) = (logs().fold(f64::INFINITY, f64::min), logs().fold(0.0, f64::max));
    let bar = |ns: u64| 4.0 + 96.0 * ((ns.max(1) as f64).ln() - low) / (high - low).max(1e-9);
    let line = |speed| Time {
        time: milliseconds(speed),
        percent: percent(speed),
        bar: bar(speed.median_ns),
        is_ours: speed.clock != SELF_REPORTED,
        speed,
    };
    all.into_iter().map(line).collect()
}

fn percent(speed: &Speed) -> String {
    match (speed.recall * 1000.0).floor() / 10.0 {
        100.0 => "100 %".to_owned(),
        percent => format!("{percent:.1} %"),
    }
}

fn milliseconds(speed: &Speed) -> String {
    let milliseconds = speed.median_ns as f64 / 1e6;
    let digits = if milliseconds < 10.0 { 3 } else { 1 };
    format!("{milliseconds:.digits$} ms")
}
