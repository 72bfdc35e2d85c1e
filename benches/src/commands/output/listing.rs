//! Tables and texts for people, which fit the terminal.

use std::fmt::{Display, Formatter};
use std::io::IsTerminal as _;

use sdop_bench::measure::estimate::Estimate;
use sdop_bench::measure::row::Row;
use sdop_bench::measure::turns::Regime;
use sdop_bench::report::digits::{interval, significant};

/// The width that output for people fits: the terminal's, or where there is none `COLUMNS`, or
/// `usual`.
fn width(usual: usize) -> usize {
    let asked = || std::env::var("COLUMNS").ok()?.parse().ok();
    match terminal_size::terminal_size() {
        Some((width, _)) if std::io::stdout().is_terminal() => usize::from(width.0).max(40),
        _ => asked().unwrap_or(usual),
    }
}

/// A table for people. All columns but the first are numbers, aligned to the right. One that is too
/// wide is printed as a block of lines for each of its rows.
pub struct Listing {
    header: Vec<String>,
    rows: Vec<Vec<String>>,
}

/// The longest name in a first column that isn't broken over lines.
const LONGEST_NAME: usize = 40;

fn length(text: &str) -> usize {
    text.chars().count()
}

/// Whether a cell is a number, with an interval or without.
fn is_number(cell: &str) -> bool {
    cell.contains('±') || !cell.contains(char::is_alphabetic)
}

/// An empty table with a header.
pub fn table(header: &[&str]) -> Listing {
    Listing { header: header.iter().map(|title| (*title).to_owned()).collect(), rows: Vec::new() }
}

/// A table with one row per item.
pub fn rows<T>(header: &[&str], items: &[T], row: impl Fn(&T) -> Vec<String>) -> Listing {
    Listing { rows: items.iter().map(row).collect(), ..table(header) }
}

impl Listing {
    /// Adds a row.
    pub fn add_row<T: Into<String>>(&mut self, row: impl IntoIterator<Item = T>) {
        self.rows.push(row.into_iter().map(Into::into).collect());
    }

    /// Leaves out columns that have nothing but zeros, and those without a number in any row.
    pub fn without_zeros(mut self) -> Self {
        let is_empty = |cell: &String| !cell.contains(|c: char| ('1'..='9').contains(&c));
        let kept: Vec<bool> = (0..self.header.len())
            .map(|at| at == 0 || self.rows.iter().any(|row| !is_empty(&row[at])))
            .collect();
        for row in self.rows.iter_mut().chain([&mut self.header]) {
            let mut kept = kept.iter();
            row.retain(|_| kept.next().copied().unwrap_or(true));
        }
        self
    }

    /// The widths of a column: with its words broken over lines, and without. Names and numbers are
    /// never broken.
    fn widths(&self, at: usize) -> [usize; 2] {
        let words = |text: &str| text.split(' ').map(length).max().unwrap_or(0);
        let is_name = |cell: &str| at == 0 && length(cell) <= LONGEST_NAME;
        let least = |row: &Vec<String>| match is_name(&row[at]) || is_number(&row[at]) {
            true => length(&row[at]),
            false => words(&row[at]),
        };
        let title = &self.header[at];
        let least = self.rows.iter().map(least).chain([words(title)]).max();
        let whole = self.rows.iter().map(|row| length(&row[at])).chain([length(title)]).max();
        [least.unwrap_or(0), whole.unwrap_or(0)]
    }

    fn text(&self, width: usize) -> String {
        if self.header.len() == 1 {
            return self.rows.concat().join("\n"); // lines of any width, which can be copied
        }
        let columns: Vec<[usize; 2]> = (0..self.header.len()).map(|at| self.widths(at)).collect();
        for gap in [3, 2] {
            let around = gap * (columns.len() - 1) + 2 * (gap - 2);
            let mut widths: Vec<usize> = columns.iter().map(|[least, _]| *least).collect();
            let Some(mut spare) = width.checked_sub(around + widths.iter().sum::<usize>()) else {
                continue;
            };
            while let Some(at) = (0..widths.len())
                .filter(|&at| spare > 0 && widths[at] < columns[at][1])
                .max_by_key(|&at| columns[at][1] - widths[at])
            {
                widths[at] += 1;
                spare -= 1;
            }
            return self.laid_out(&widths, gap);
        }
        self.blocks(width)
    }

    /// The table with columns of these widths, and so many blanks between them.
    fn laid_out(&self, widths: &[usize], gap: usize) -> String {
        let is_text =
            |at: usize| at == 0 || self.rows.iter().any(|row| length(&row[at]) > widths[at]);
        let edge = " ".repeat(gap - 2);
        let all = widths.iter().sum::<usize>() + gap * (widths.len() - 1) + 2 * edge.len();
        let mut lines = vec!["─".repeat(all)];
        for (number, row) in std::iter::once(&self.header).chain(&self.rows).enumerate() {
            let cells: Vec<Vec<String>> = row
                .iter()
                .zip(widths)
                .map(|(cell, width)| wrapped(cell, *width, 0).lines().map(str::to_owned).collect())
                .collect();
            for line in 0..cells.iter().map(Vec::len).max().unwrap_or(0) {
                let part = |(at, width): (usize, &usize)| {
                    let text = cells[at].get(line).map_or("", String::as_str);
                    let blanks = " ".repeat(width.saturating_sub(length(text)));
                    if is_text(at) { format!("{text}{blanks}") } else { format!("{blanks}{text}") }
                };
                let parts: Vec<String> = widths.iter().enumerate().map(part).collect();
                lines.push(format!("{edge}{}", parts.join(&" ".repeat(gap))).trim_end().to_owned());
            }
            if number == 0 {
                lines.push("═".repeat(all));
            }
        }
        lines.push("─".repeat(all));
        lines.join("\n")
    }

    /// A line with the row's name, then one line per column.
    fn blocks(&self, width: usize) -> String {
        let titles = self.header[1..].iter().map(|title| length(title));
        let room = titles.max().unwrap_or(0);
        let mut out = String::new();
        for row in &self.rows {
            out += &format!("{}\n", wrapped(&row[0], width, 2));
            for (title, cell) in self.header.iter().zip(row).skip(1) {
                let gap = " ".repeat(room - length(title));
                let line = format!("  {title}{gap}  {cell}");
                out += &wrapped(&line, width, room + 4);
                out.push('\n');
            }
        }
        out.trim_end().to_owned()
    }
}

impl Display for Listing {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.text(width(120)))
    }
}

/// A line, broken between words into lines of this width; all but the first are indented.
fn wrapped(line: &str, width: usize, indent: usize) -> String {
    let (mut out, mut used) = (String::new(), 0);
    for word in line.split_inclusive(' ') {
        if used + length(word.trim_end()) > width && used > indent {
            out.truncate(out.trim_end().len());
            out += &format!("\n{}", " ".repeat(indent));
            used = indent;
        }
        out += word;
        used += length(word);
    }
    out
}

/// A text for people within the terminal's width. Indented lines, such as code to copy, and tables
/// stay as they are.
pub fn paragraphs(text: &str) -> String {
    let width = width(80);
    let fit = |line: &str| match line.starts_with([' ', '─', '═']) {
        true => line.to_owned(),
        false => wrapped(line, width, 0),
    };
    text.lines().map(fit).collect::<Vec<_>>().join("\n")
}

/// A column of a study's table: its title, the quantity, and the factor to the title's unit.
pub type Column<'a> = (&'a str, &'a str, f64);

/// The rows of a regime, or of none, as a table: a line per variant, or per variant and volume, and
/// a column per quantity. Columns of zeros are left out.
pub fn pivot(rows: &[Row], regime: Regime, by_volume: bool, columns: &[Column<'_>]) -> Listing {
    let title = if by_volume { "strategy, volume" } else { "variant" };
    let titles = columns.iter().map(|(title, ..)| *title);
    let mut listing = table(&std::iter::once(title).chain(titles).collect::<Vec<_>>());
    let mut keys: Vec<(&str, Option<&str>)> = Vec::new();
    let of_regime = |row: &&Row| row.regime.is_none_or(|own| own == regime);
    let wanted: Vec<&Row> = rows.iter().filter(of_regime).collect();
    for row in &wanted {
        let (quantity, volume) = row.quantity();
        let key = (row.variant.as_str(), volume);
        let is_shown = columns.iter().any(|(_, wanted, _)| *wanted == quantity);
        if is_shown && volume.is_some() == by_volume && !keys.contains(&key) {
            keys.push(key);
        }
    }
    for (variant, volume) in keys {
        let cell = |&(_, quantity, factor): &Column<'_>| {
            let is_it =
                |row: &&&Row| row.variant == variant && row.quantity() == (quantity, volume);
            let found = wanted.iter().find(is_it);
            found.map_or("–".to_owned(), |row| short(&row.estimate().scaled(factor)))
        };
        let name = volume.map_or(variant.to_owned(), |volume| format!("{variant}, {volume}"));
        listing.add_row(std::iter::once(name).chain(columns.iter().map(cell)));
    }
    listing.without_zeros()
}

/// A value with its interval, or with three digits if it has none.
fn short(value: &Estimate) -> String {
    match value.half_width.is_finite() {
        true => interval(value),
        false => significant(value.mean, 3),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A table fits its width: titles are broken, numbers are not, and what can't fit is in blocks.
    #[test]
    fn tables_fit_their_width() {
        let mut one = table(&["strategy", "pairs per frame", "none", "µs per warm frame"]);
        one.add_row(["s-dop-sequential", "601.9", "0", "55.0 ± 1.1"]);
        let one = one.without_zeros();
        for width in [80, 46, 32] {
            let text = one.text(width);
            assert!(text.lines().all(|line| line.chars().count() <= width), "{text}");
            assert!(text.contains("55.0 ± 1.1") && text.contains("601.9"), "{text}");
            assert!(!text.contains("none"), "{text}");
        }
        assert!(one.text(32).contains("pairs per frame"), "{}", one.text(32));
        assert_eq!(wrapped("a bc def", 4, 1), "a bc\n def");
    }
}
