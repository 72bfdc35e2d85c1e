//! Recommends a volume, axes and a finder for one scene: every candidate is timed and counted on
//! it, without an exact truth.
//!
//! All variants report every pair that meets, so fewer reported pairs are fewer false ones: T +
//! Np·Cp needs no truth. The finder is chosen first, since its time is the same in every variant;
//! `auto` is kept unless another one is certainly faster.

use serde::Serialize;

use super::pays::{CheapestRange, Choice, Line, choose, envelope};
use super::timing::{lines, lines_of_a_run};
use super::variant::{Variant, volumes};
use crate::measure::conditions::Conditions;
use crate::measure::estimate::Estimate;
use crate::scene::{Scene, SceneFile};
use sdop::settings::{Axes, CullSettings, Finder, Strategy};
use sdop::simd::Tier;

/// The most frames of the scene that are used: enough for its pairs, few enough for a minute.
pub const FRAMES: u32 = 200;
/// The fewest frames: a scene with fewer is simulated further, since the first frame of a run is
/// cold.
const FEWEST_FRAMES: u32 = 24;
/// Sample frames among them.
const SAMPLES: u32 = 10;
/// The most bodies for which all-pairs is tried: 50 million pairs.
const MOST_FOR_ALL_PAIRS: usize = 10_000;

/// The candidates; `None` means all.
#[derive(Clone, Copy, Debug, Default)]
pub struct CandidateFilter {
    /// Only this finder.
    pub finder: Option<Finder>,
    /// Only these axes.
    pub axes: Option<Axes>,
}

/// The recommendation, and its numbers.
#[derive(Clone, Debug, Serialize)]
pub struct Advice {
    /// The scene.
    pub scene: String,
    /// Its bodies.
    pub bodies: usize,
    /// Number of frames that were used, from the first on.
    pub frames: u32,
    /// Seconds of a narrow-phase check.
    pub check: f64,
    /// The cheapest variant in total.
    pub best: String,
    /// The settings of the cheapest variant.
    pub cull: CullSettings,
    /// Whether convex hulls should be tested after them.
    pub hulls: bool,
    /// Its total T + Np·Cp, seconds per frame.
    pub total: f64,
    /// The variants tied with it: the interval of the difference contains zero.
    pub tied: Vec<String>,
    /// The finders tied with the chosen one.
    pub tied_finders: Vec<String>,
    /// The cheapest variant for each price of a check.
    pub cheapest: Vec<CheapestRange>,
    /// For a scene with `rest`, the cheapest variant in a world.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub world: Option<WorldTimes>,
    /// Every finder, with the scene's S-DOP.
    pub finders: Vec<Candidate>,
    /// Every variant, with the chosen finder.
    pub candidates: Vec<Candidate>,
    /// Other load of the machine.
    pub conditions: Conditions,
}

/// T of a variant in a culler, which is given every pose, and in a world, which is given the poses
/// that have changed: seconds per warm frame.
#[derive(Clone, Debug, Serialize)]
pub struct WorldTimes {
    /// The variant.
    pub variant: String,
    /// T of a culler.
    pub culler: Estimate,
    /// T of a world.
    pub world: Estimate,
}

/// One candidate.
#[derive(Clone, Debug, Serialize)]
pub struct Candidate {
    /// The variant or finder.
    pub name: String,
    /// T, seconds per warm frame.
    pub time: Estimate,
    /// Np: reported pairs per frame.
    pub pairs: f64,
    /// T + Np·Cp, seconds per frame.
    pub total: f64,
    /// The difference of that from the best one's, pass by pass.
    pub beyond: Estimate,
}

/// Measures a scene and recommends. `check` is the price of a narrow-phase check, in seconds.
///
/// # Errors
/// The scene can't be built or run.
pub fn advise(
    file: &SceneFile,
    tried: CandidateFilter,
    check: f64,
    tier: Tier,
) -> miette::Result<Option<Advice>> {
    let before = Conditions::before();
    let mut scene = file.build()?;
    scene.frames = scene.frames.clamp(FEWEST_FRAMES, FRAMES);
    let found = lines_of_a_run(&scene, &finders(&scene, tried.finder), tier)?;
    let Some((finder, tied_finders)) = chosen_finder(&found) else {
        return Ok(None);
    };
    scene.cull.pairs = finder;
    let variants = volumes(&scene.cull, tried.axes);
    let lines = lines(&scene, &variants, tier, SAMPLES)?;
    let Some(choice) = choose(&lines, check) else {
        return Ok(None);
    };
    let Some(best) = lines.iter().position(|line| line.name == choice.best) else {
        return Ok(None);
    };
    let finders = match found.iter().find(|line| line.name == finder.name()) {
        Some(own) => candidates(&found, own, check),
        None => Vec::new(),
    };
    let candidates = candidates(&lines, &lines[best], check);
    let cheapest = |candidate: &Candidate| {
        let mut variants = variants.iter().filter(|one| one.may_be_in_world());
        variants.find(|variant| variant.name == candidate.name)
    };
    let world = match candidates.iter().find_map(cheapest) {
        Some(variant) if scene.effects.rest.is_some() => Some(in_world(&scene, variant, tier)?),
        _ => None,
    };
    Ok(Some(Advice {
        scene: scene.name,
        bodies: scene.bodies.len(),
        frames: scene.frames,
        check,
        best: choice.best,
        cull: variants[best].settings.clone(),
        hulls: variants[best].hulls,
        total: choice.total,
        tied: choice.tied,
        tied_finders,
        cheapest: envelope(&lines),
        conditions: before.after(candidates.iter().map(|candidate| candidate.time)),
        world,
        finders,
        candidates,
    }))
}

/// S-DOP with the scene's settings and each finder.
fn finders(scene: &Scene, only: Option<Finder>) -> Vec<Variant> {
    let few = scene.bodies.len() <= MOST_FOR_ALL_PAIRS;
    let is_tried = |finder: &Finder| match only {
        Some(only) => *finder == only,
        None => few || *finder != Finder::AllPairs,
    };
    let variant = |finder: Finder| {
        let settings = CullSettings {
            strategy: Strategy::SDopSequential,
            pairs: finder,
            ..scene.cull.clone()
        };
        Variant::of(finder.name().to_owned(), settings)
    };
    let all = Finder::ALL.iter().copied().filter(is_tried);
    all.map(variant).collect()
}

/// The fastest finder, or `auto` if it is tied with it, and the other tied ones.
fn chosen_finder(lines: &[Line]) -> Option<(Finder, Vec<String>)> {
    let Choice { best, mut tied, .. } = choose(lines, 0.0)?;
    let auto = Finder::Auto.name();
    let chosen = match tied.iter().position(|name| name == auto) {
        Some(at) => {
            tied[at] = best;
            auto.to_owned()
        }
        None => best,
    };
    Some((chosen.parse().ok()?, tied))
}

/// A variant in a culler and in a world, on the same frames.
fn in_world(scene: &Scene, variant: &Variant, tier: Tier) -> miette::Result<WorldTimes> {
    let both = [variant.clone(), variant.clone().in_world()];
    let lines = lines_of_a_run(scene, &both, tier)?;
    let time = |line: &Line| Estimate::in_order(&line.times);
    Ok(WorldTimes {
        variant: variant.name.clone(),
        culler: time(&lines[0]),
        world: time(&lines[1]),
    })
}

/// The numbers of each candidate, cheapest first.
fn candidates(lines: &[Line], best: &Line, check: f64) -> Vec<Candidate> {
    let candidate = |line: &Line| Candidate {
        name: line.name.clone(),
        time: Estimate::in_order(&line.times),
        pairs: line.pairs,
        total: line.time() + check * line.pairs,
        beyond: line.beyond(best, check),
    };
    let mut candidates: Vec<Candidate> = lines.iter().map(candidate).collect();
    candidates.sort_by(|a, b| a.total.total_cmp(&b.total));
    candidates
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(name: &str, times: [f64; 3]) -> Line {
        Line { name: name.into(), times: times.to_vec(), pairs: 1.0 }
    }

    /// Auto is kept unless another is surely faster.
    #[test]
    fn auto_is_kept_if_tied() {
        let grid = line("grid", [1.0, 1.1, 0.9]);
        let near =
            [line("all-pairs", [9.0, 9.1, 9.2]), grid.clone(), line("auto", [1.1, 1.0, 1.0])];
        assert_eq!(chosen_finder(&near), Some((Finder::Auto, vec!["grid".to_owned()])));
        let far = [grid, line("auto", [5.0, 5.1, 4.9])];
        assert_eq!(chosen_finder(&far), Some((Finder::Grid, vec![])));
        assert_eq!(chosen_finder(&[]), None);
    }

    #[test]
    fn both_axes_are_tried() {
        let own = CullSettings::default();
        let along = |axes: Axes, only| {
            let list = volumes(&own, only);
            let s_dop = |v: &&Variant| v.settings.strategy == Strategy::SDopSequential;
            let list = list.iter().filter(s_dop);
            list.filter(|v| v.settings.axes == axes).count()
        };
        assert_eq!([Axes::Principal, Axes::Model].map(|a| along(a, None)), [8, 8]);
        let model = Some(Axes::Model);
        assert_eq!([Axes::Principal, Axes::Model].map(|a| along(a, model)), [0, 8]);
    }
}
