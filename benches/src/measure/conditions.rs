//! Whether the machine had other load during a measurement, so that readers know which times not to
//! quote.

use serde::{Deserialize, Serialize};

use super::estimate::Estimate;

/// Intervals wider than this share of their mean, to either side, are a disturbance.
const WIDE_INTERVAL: f64 = 0.1;
/// Processes next to ours that want to run, on average, from which on the machine counts as
/// disturbed.
const BUSY_PROCESSES: f64 = 0.5;

/// What the machine was like.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Conditions {
    /// Processes that wanted to run next to ours, before and after, where the system reports them:
    /// one-minute means.
    pub others: [Option<f64>; 2],
    /// How many of the quoted times have an interval of more than ± 10 %.
    pub wide: usize,
    /// The number of all quoted times.
    pub of: usize,
}

impl Conditions {
    /// Before anything is measured.
    #[must_use]
    pub fn before() -> Self {
        Self { others: [Load::now().map(|load| load.one_minute), None], wide: 0, of: 0 }
    }

    /// After everything is: with the times that will be quoted.
    #[must_use]
    pub fn after(self, times: impl Iterator<Item = Estimate>) -> Self {
        let times: Vec<Estimate> = times.collect();
        // Our own single thread has been running all the time.
        let others = Load::now().map(|load| (load.one_minute - 1.0).max(0.0));
        Self {
            others: [self.others[0], others],
            wide: times.iter().filter(|time| time.relative() > WIDE_INTERVAL).count(),
            of: times.len(),
        }
    }

    /// Whether the times shouldn't be quoted.
    #[must_use]
    pub fn disturbed(&self) -> bool {
        self.wide > 0 || self.others.iter().flatten().any(|&others| others > BUSY_PROCESSES)
    }

    /// What to say of it; `None` of an undisturbed machine.
    #[must_use]
    pub fn warning(&self) -> Option<String> {
        if !self.disturbed() {
            return None;
        }
        let load =
            |load: Option<f64>| load.map_or("unknown".to_owned(), |load| format!("{load:.1}"));
        let wide = match self.of {
            0 => String::new(),
            of => format!("; {} of {of} intervals above 10 %", self.wide),
        };
        Some(format!(
            "The machine did other work (load of other processes: {} before, {} after{wide}): don't quote these times.",
            load(self.others[0]),
            load(self.others[1])
        ))
    }
}

/// Mean numbers of waiting or running threads over one and five minutes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Load {
    /// Over the last minute.
    pub one_minute: f64,
    /// Over the last five.
    pub five_minutes: f64,
}

impl Load {
    /// The load now, where the system reports it.
    #[must_use]
    pub fn now() -> Option<Self> {
        let text = std::fs::read_to_string("/proc/loadavg").ok()?;
        let mut numbers = text.split(' ').map(str::parse);
        Some(Self { one_minute: numbers.next()?.ok()?, five_minutes: numbers.next()?.ok()? })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A wide interval or a load is a disturbance.
    #[test]
    fn wide_interval_or_load_disturbs() {
        let quiet = Conditions { others: [Some(0.1), Some(0.2)], wide: 0, of: 2 };
        assert_eq!(quiet.warning(), None);
        let loaded = Conditions { others: [Some(0.1), Some(3.0)], ..quiet };
        assert!(loaded.warning().is_some_and(|text| text.contains("3.0 after")));
        let times = [[1.0, 1.01, 0.99], [1.0, 2.0, 0.5]];
        let wide = quiet.after(times.iter().map(|times| Estimate::of(times)));
        assert_eq!((wide.wide, wide.of), (1, 2));
        assert!(wide.disturbed());
    }
}
