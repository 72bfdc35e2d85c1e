//! What a function is compared by: the bits of its inputs and of its results.

use std::fmt;

/// A function's name, the bits of its inputs, and those of its results.
pub struct Case {
    name: &'static str,
    bits: [Vec<u64>; 2],
    with_results: bool,
}

impl Case {
    pub fn of(name: &'static str) -> Self {
        let bits = [Vec::new(), Vec::new()];
        Self { name, bits, with_results: false }
    }

    /// What comes from here on are results.
    pub fn gives(mut self) -> Self {
        self.with_results = true;
        self
    }

    pub fn number(mut self, bits: u64) -> Self {
        self.bits[usize::from(self.with_results)].push(bits);
        self
    }

    pub fn f32s(mut self, numbers: &[f32]) -> Self {
        for &x in numbers {
            let x = if x.is_nan() { f32::NAN } else { x };
            self = self.number(u64::from(x.to_bits()));
        }
        self
    }

    pub fn f64s(mut self, numbers: &[f64]) -> Self {
        for &x in numbers {
            let x = if x.is_nan() { f64::NAN } else { x };
            self = self.number(x.to_bits());
        }
        self
    }

    pub fn bit(self, yes: bool) -> Self {
        self.number(u64::from(yes))
    }
}

/// One line: the name, the inputs, `=` and the results, in hexadecimal.
impl fmt::Display for Case {
    fn fmt(&self, line: &mut fmt::Formatter) -> fmt::Result {
        line.write_str(self.name)?;
        let [inputs, results] = &self.bits;
        inputs.iter().try_for_each(|x| write!(line, " {x:x}"))?;
        line.write_str(" =")?;
        results.iter().try_for_each(|x| write!(line, " {x:x}"))
    }
}
