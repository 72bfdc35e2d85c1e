//! [`OrderedResults`]: passes on results in the order of units, in whatever order they arrive.

use std::collections::BTreeMap;

/// Hands on results in the order of their units; those that come early wait.
pub struct OrderedResults<'a> {
    units: std::vec::IntoIter<usize>,
    next: Option<usize>,
    early: BTreeMap<usize, Option<String>>,
    take: &'a mut dyn FnMut(usize, &str) -> miette::Result<()>,
}

impl<'a> OrderedResults<'a> {
    /// Passes on the results of these units, in this order.
    pub fn new(
        units: Vec<usize>,
        take: &'a mut dyn FnMut(usize, &str) -> miette::Result<()>,
    ) -> Self {
        let mut units = units.into_iter();
        Self { next: units.next(), units, early: BTreeMap::new(), take }
    }

    /// A unit's result, or none for one that was left out.
    ///
    /// # Errors
    /// What the taker says.
    pub fn put(&mut self, unit: usize, result: Option<String>) -> miette::Result<()> {
        self.early.insert(unit, result);
        while let Some(next) = self.next {
            let Some(result) = self.early.remove(&next) else {
                break;
            };
            if let Some(result) = result {
                (self.take)(next, &result)?;
            }
            self.next = self.units.next();
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::*;

    /// Results are taken in the order of units.
    #[test]
    fn results_keep_unit_order() {
        let mut taken = Vec::new();
        let mut take = |unit, result: &str| {
            taken.push((unit, result.to_owned()));
            Ok(())
        };
        let mut order = OrderedResults::new(vec![1, 4, 7, 10], &mut take);
        for unit in [7, 1, 10] {
            order.put(unit, Some(format!("r{unit}"))).unwrap();
        }
        order.put(4, None).unwrap();
        let expected = [1, 7, 10].map(|unit| (unit, format!("r{unit}")));
        assert_eq!(taken, expected);
    }
}
