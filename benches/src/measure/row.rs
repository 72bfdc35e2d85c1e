//! The one schema of a study's results: one number per row, with its meaning, unit and interval.

use serde::Serialize;

use super::estimate::Estimate;
use super::turns::Regime;

/// One number of a study.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// The study: the command that measured it.
    pub study: &'static str,
    /// The scene.
    pub scene: String,
    /// What was varied: a strategy, or a variant by its name in tables.
    pub variant: String,
    /// Warm or cold frames; `None` for numbers that are no times of frames.
    pub regime: Option<Regime>,
    /// The quantity; one of a single volume has its name in brackets, as in `Nu (sphere)`.
    pub metric: String,
    /// Its unit; 1 for shares and ratios.
    pub unit: &'static str,
    /// The value: a mean over `n` seeds or passes.
    pub value: f64,
    /// Half the width of its 95 % interval; infinite, and empty in CSV, if there is none.
    pub half_width: f64,
    /// The number of seeds or passes; 0 for numbers that have neither.
    pub n: usize,
}

impl Row {
    /// The value with its interval.
    #[must_use]
    pub fn estimate(&self) -> Estimate {
        Estimate { mean: self.value, half_width: self.half_width, seeds: self.n }
    }

    /// The quantity without its volume, and the volume of a number that is one's.
    #[must_use]
    pub fn quantity(&self) -> (&str, Option<&str>) {
        let split = self.metric.strip_suffix(')').and_then(|metric| metric.rsplit_once(" ("));
        split.map_or((&self.metric, None), |(quantity, volume)| (quantity, Some(volume)))
    }
}

/// The rows of a study on one scene, as they are added.
#[derive(Debug)]
pub struct Rows {
    study: &'static str,
    scene: String,
    all: Vec<Row>,
}

impl Rows {
    /// No rows yet.
    #[must_use]
    pub fn new(study: &'static str, scene: &str) -> Self {
        Self { study, scene: scene.to_owned(), all: Vec::new() }
    }

    /// Adds a number.
    pub fn add(
        &mut self,
        (variant, regime): (&str, Option<Regime>),
        metric: impl Into<String>,
        unit: &'static str,
        value: Estimate,
    ) {
        self.all.push(Row {
            study: self.study,
            scene: self.scene.clone(),
            variant: variant.to_owned(),
            regime,
            metric: metric.into(),
            unit,
            value: value.mean,
            half_width: value.half_width,
            n: value.seeds,
        });
    }

    /// All rows.
    #[must_use]
    pub fn finish(self) -> Vec<Row> {
        self.all
    }
}
