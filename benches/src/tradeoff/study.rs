//! Joins the results of the units of a comparison.

use super::Estimate;
use super::counts::{Tally, share};
use super::findings::{ComparedVariants, Findings, SeedCounts};
use super::interest;
use super::pays::{self, Line, Point, Standing};
use super::result::{Tradeoff, VariantResult};
use super::units::Settings;
use super::variant::Variant;
use crate::cost::pass::Pass;
use crate::cost::table;
use crate::measure::conditions::Conditions;
use crate::measure::counts::Volume;
use crate::measure::turns::Regime;

impl Findings {
    /// The comparison. `None` if units are missing or belong to another one. `before` are the
    /// machine's conditions at the start.
    #[must_use]
    pub fn finish(self, settings: &Settings, before: Conditions) -> Option<Tradeoff> {
        let ComparedVariants { hits, variants, volumes } = self.compared?;
        let of_all = |tallies: &[Tally]| tallies.len() == variants.len();
        let (first, narrow_phase) = (self.seeds.first()?, self.narrow_phase.unwrap_or_default());
        let samples = first.tallies.first()?.frames as usize;
        let fits = self.seeds.iter().all(|seed| of_all(&seed.tallies))
            && self.passes.iter().all(|pass| pass.culled.len() == variants.len())
            && volumes.len() == variants.len();
        if !fits {
            return None;
        }
        let measured = VariantMeasurements {
            scene: (settings.scene.as_str(), settings.bodies),
            seeds: &self.seeds,
            passes: self.passes.iter().collect(),
        };
        let rows = measured.rows(&variants, &volumes);
        let prices = Regime::ALL.iter();
        let prices = prices.flat_map(|&regime| table::prices(&measured.passes, regime));
        let cheapest = pays::envelope(&rows.iter().map(line).collect::<Vec<Line>>());
        Some(Tradeoff {
            prices: prices.collect(),
            conditions: before.after(rows.iter().map(VariantResult::seconds)),
            scene: settings.scene.clone(),
            bodies: settings.bodies,
            frames: settings.frames,
            samples,
            seeds: settings.seeds.clone(),
            simd: settings.machine.simd.clone(),
            truth: measured.true_pairs(),
            partners: 2.0 * hits / settings.bodies as f64,
            advice: pays::advice(&cheapest, &narrow_phase),
            narrow_phase,
            interest: interest::rows(&first.interest, &self.interest),
            worlds: self.worlds,
            rows,
            cheapest,
            densities: self.densities,
            budgets: self.budgets,
            clock: self.clock,
        })
    }
}

/// Counts per seed and times per pass of every variant.
struct VariantMeasurements<'a> {
    /// The scene's name and its number of bodies.
    scene: (&'a str, usize),
    seeds: &'a [SeedCounts],
    passes: Vec<&'a Pass>,
}

impl VariantMeasurements<'_> {
    fn rows(&self, variants: &[Variant], volumes: &[Option<f64>]) -> Vec<VariantResult> {
        let mut rows: Vec<VariantResult> = variants
            .iter()
            .zip(volumes)
            .enumerate()
            .map(|(at, (variant, volume))| self.row(at, variant, *volume))
            .collect();
        let point = |row: &VariantResult| Point {
            times: row.times.clone(),
            precisions: row.precisions.clone(),
        };
        let points: Vec<Point> = rows.iter().map(point).collect();
        for (row, standing) in rows.iter_mut().zip(pays::standings(&points)) {
            row.standing = standing;
        }
        rows
    }

    fn row(&self, at: usize, variant: &Variant, volume_over_hull: Option<f64>) -> VariantResult {
        let tallies = || self.seeds.iter().map(|seed| &seed.tallies[at]);
        let over_seeds =
            |value: fn(&Tally) -> f64| Estimate::of(&tallies().map(value).collect::<Vec<_>>());
        let total = |count: fn(&Tally) -> u64| tallies().map(count).sum::<u64>();
        let settings = &variant.settings;
        let volume = variant.decides();
        let ordop = volume == Some(Volume::OrDop);
        let cost = |regime| {
            let passes = (&self.passes[..], &self.passes[..]);
            table::cost(self.scene, (at, variant), passes, regime)
        };
        let time = |pass: &&Pass| pass.culled[at].times.quartiles(Regime::Warm).median;
        VariantResult {
            name: variant.name.clone(),
            strategy: settings.strategy,
            hulls: variant.hulls,
            volume,
            k: (ordop || volume == Some(Volume::KDop)).then(|| settings.k.k()),
            axes: ordop.then_some(settings.axes),
            overlap: ordop.then_some(settings.overlap),
            reported: over_seeds(Tally::reported_a_frame),
            precision: over_seeds(|t| t.quality().precision),
            precisions: tallies().map(|t| t.quality().precision).collect(),
            per_true: over_seeds(|t| t.quality().per_true),
            recall: share(total(|t| t.found), total(|t| t.truth)),
            volume_over_hull,
            warm: cost(Regime::Warm),
            cold: cost(Regime::Cold),
            times: self.passes.iter().map(time).collect(),
            standing: Standing::Front,
            pairs_sha256: tallies().map(|t| t.pairs_sha256.clone()).collect(),
        }
    }

    /// Pairs per frame whose meshes meet.
    fn true_pairs(&self) -> Estimate {
        let tallies = self.seeds.iter().filter_map(|seed| seed.tallies.first());
        let a_frame = |tally: &Tally| tally.truth as f64 / f64::from(tally.frames);
        Estimate::of(&tallies.map(a_frame).collect::<Vec<_>>())
    }
}

fn line(row: &VariantResult) -> Line {
    Line {
        name: row.name.clone(),
        decides: row.volume,
        ordop: None,
        times: row.times.clone(),
        pairs: row.reported.mean,
        construct: row.warm.as_ref().map_or(0.0, |cost| cost.construct.measured.mean),
    }
}
