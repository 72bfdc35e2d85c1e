//! The grid's cells, every input of a format: coordinates and radii of a narrow one, arithmetic of
//! a wide one.

use super::format::{Format, exp2};

/// How cells are numbered and sized, in units of the formats.
#[derive(Clone, Copy, Debug)]
pub struct Rule {
    pub narrow: Format,
    pub wide: Format,
    /// Finders' factor and floor.
    pub widening: [f64; 2],
    /// A cell is larger than the widest ball by this factor.
    pub room: f64,
    /// Cells along the longest side.
    pub most: f64,
}

impl Rule {
    pub fn of(narrow: Format, wide: Format) -> Self {
        let floor = exp2((narrow.least - narrow.precision + 10).div_euclid(2) - 2);
        // As 2⁻¹⁶ and 2²⁹ are to the 53 bits of f64: their quotient is 2⁻⁸ of its ulp.
        let bits = wide.precision / 3;
        Self {
            narrow,
            wide,
            widening: [1.0 + 16.0 * narrow.u(), floor],
            room: 1.0 + exp2(-bits),
            most: exp2(wide.precision - bits - 6),
        }
    }

    fn whole_number_offset(&self) -> f64 {
        1.5 * exp2(self.wide.precision - 1)
    }

    /// `widen`
    pub fn widen(&self, radius: f64) -> f64 {
        let [factor, floor] = self.widening;
        self.narrow.up(self.wide.add(self.wide.mul(radius, factor), floor))
    }

    /// `Cells::fit` of a wrapped table.
    pub fn size(&self, longest: f64, widest: f64) -> f64 {
        let needed = self.wide.mul(self.wide.mul(2.0, self.widen(widest)), self.room);
        needed.max(self.wide.div(longest, self.most))
    }

    /// `CellRule::cell`, less `TO_INTEGER`.
    pub fn number(&self, origin: f64, size: f64, x: f64) -> f64 {
        let inverse = self.wide.div(1.0, size);
        let quotient = self.wide.mul(self.wide.sub(x, origin), inverse);
        self.wide.add(quotient, self.whole_number_offset()) - self.whole_number_offset()
    }

    /// `CellRule::count` less one, or what it was once: round(extent / size).
    pub fn last(&self, origin: f64, size: f64, hi: f64, former: bool) -> f64 {
        if former {
            self.wide.div(self.wide.sub(hi, origin), size).round()
        } else {
            self.number(origin, size, hi).max(0.0)
        }
    }
}

/// How many centres fall in no cell of the table, and how many in one two or more from that of a
/// ball that the first test may report with it: of all boxes' ends, widest balls and centres.
pub fn wrong_cells(rule: &Rule, top: i32) -> [u64; 2] {
    let numbers = rule.narrow.numbers(top);
    let mut wrong = [0; 2];
    for &widest in &rule.narrow.sizes(top) {
        let reach = 2.0 * rule.widen(widest);
        for (first, &origin) in numbers.iter().enumerate() {
            for (end, &hi) in numbers.iter().enumerate().skip(first) {
                let size = rule.size(rule.wide.sub(hi, origin), widest);
                let last = rule.last(origin, size, hi, false);
                let centres = &numbers[first..=end];
                let cells: Vec<f64> =
                    centres.iter().map(|&x| rule.number(origin, size, x)).collect();
                wrong[0] += cells.iter().filter(|&&cell| cell < 0.0 || cell > last).count() as u64;
                let mut far = 0;
                for (x, cell) in centres.iter().zip(&cells) {
                    while far + 1 < centres.len() && centres[far + 1] - x <= reach {
                        far += 1;
                    }
                    // Cells keep the order of centres, so the farthest in reach has the last cell.
                    wrong[1] += u64::from(cells[far] - cell > 1.0);
                }
            }
        }
    }
    wrong
}

/// How many farthest centres fall beyond the last cell, or next to the one before them in a cell
/// that is lower: of all sizes from 1 to 2 and boxes from the origin.
pub fn beyond_the_last(rule: &Rule, former: bool) -> u64 {
    let ulp = exp2(1 - rule.wide.precision);
    let sizes = (0..1u64 << (rule.wide.precision - 1)).map(|n| 1.0 + n as f64 * ulp);
    let ends = rule.narrow.sizes(5);
    let mut wrong = 0;
    for size in sizes {
        let mut before = 0.0;
        for &hi in &ends {
            let cell = rule.number(0.0, size, hi);
            wrong += u64::from(cell > rule.last(0.0, size, hi, former) || cell < before);
            before = cell;
        }
    }
    wrong
}
