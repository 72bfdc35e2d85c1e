//! The compared variants: every volume and strategy, as culling settings with the shapes that they
//! need.

use crate::tightness::PolytopeVolume as _;

use crate::measure::counts::Volume;
pub use crate::measure::variant::Variant;
use crate::scene::Scene;
use crate::tightness::mean_world_aligned_volume;
use sdop::settings::{
    Axes, Budget, CullSettings, DirectionSet, Interest, Overlap, Strategy, Updates,
};
use sdop::volume::{Hull, Shape};

/// Random rotations over which a world-aligned volume is averaged.
const TURNS: u32 = 64;

/// Mean volume / hull volume of the scene's bodies; world-aligned volumes are averaged over
/// rotations. `None` if a hull is flat, or if nothing is tested.
#[must_use]
pub fn tightness(variant: &Variant, scene: &Scene) -> Option<f64> {
    let shapes = variant.shapes(scene);
    let ratios =
        shapes.iter().map(|shape| shape_tightness(variant, shape)).collect::<Option<Vec<_>>>()?;
    let sum: f64 = scene.bodies.shape.iter().map(|&s| ratios[s as usize]).sum();
    Some(sum / scene.bodies.len() as f64)
}

fn shape_tightness(variant: &Variant, shape: &Shape) -> Option<f64> {
    let hull = Hull::of(&shape.vertices);
    let inner = hull.volume(&shape.vertices);
    let aligned = |k| {
        let points = hull.points(&shape.vertices);
        mean_world_aligned_volume(&points, k, TURNS)
    };
    let volume = match variant.decides()? {
        Volume::Hull => inner,
        Volume::Sphere => shape.ball.volume(),
        Volume::Aabb => aligned(DirectionSet::K6),
        Volume::KDop => aligned(variant.settings.k),
        Volume::Obb => shape.obb(&hull).volume(),
        Volume::OrDop => shape.ordop.volume(),
    };
    (inner > 0.0).then_some(volume / inner)
}

/// Every variant, with a scene's settings for everything else. `hits` is the mean number of sphere
/// hits per frame; half of it is the budget of time-critical culling.
#[must_use]
pub fn all(own: &CullSettings, hits: u64) -> Vec<Variant> {
    let with = |strategy| CullSettings { strategy, ..own.clone() };
    let mut list = vec![
        Variant::spheres(own),
        Variant::of("aabb".into(), with(Strategy::Aabb)),
        Variant::of("obb".into(), with(Strategy::Obb)),
    ];
    for &k in DirectionSet::ALL {
        let set = CullSettings { k, ..with(Strategy::KDop) };
        list.push(Variant::of(format!("{k}-dop"), set));
    }
    for &k in DirectionSet::ALL {
        let set = CullSettings { k, ..with(Strategy::OrDop) };
        list.push(Variant::of(format!("or-{k}, {}", own.overlap), set));
    }
    list.extend(s_dops(own));
    list.extend(strategies(own, hits));
    list.push(Variant::hulls(own));
    list
}

/// What a choice is made among: spheres, boxes, S-DOP with each k by the tests of sides, and hulls;
/// with these axes, or with both kinds.
#[must_use]
pub fn volumes(own: &CullSettings, axes: Option<Axes>) -> Vec<Variant> {
    let boxes = CullSettings { strategy: Strategy::Aabb, ..own.clone() };
    let mut list = vec![Variant::spheres(own), Variant::of("aabb".into(), boxes)];
    list.extend(s_dops(own).into_iter().filter(|variant| {
        let settings = &variant.settings;
        settings.overlap != Overlap::Full && axes.is_none_or(|axes| axes == settings.axes)
    }));
    list.push(Variant::hulls(own));
    list
}

/// The variant of a name: a strategy's, or one that tables show, such as `s-dop 26, model,
/// two-sided`. What the name leaves out is as in `own`. `None` of another name.
#[must_use]
pub fn named(own: &CullSettings, name: &str) -> Option<Variant> {
    if let Ok(strategy) = name.parse() {
        return Some(Variant::strategy(own, strategy));
    }
    let parts: Vec<&str> = name.split(',').map(str::trim).collect();
    let tests = parts.iter().find_map(|part| part.strip_suffix(" tests")?.parse().ok());
    let overlap = parts.iter().find_map(|part| part.parse().ok()).unwrap_or(own.overlap);
    let own = CullSettings { overlap, ..own.clone() };
    let has_parts = |variant: &Variant| {
        let its: Vec<&str> = variant.name.split(", ").collect();
        its[0] == parts[0] && parts.iter().all(|part| its.contains(part))
    };
    let differs = |variant: &Variant| {
        let CullSettings { axes, overlap, .. } = variant.settings;
        (axes != own.axes, overlap != own.overlap)
    };
    let fitting = all(&own, 2 * tests.unwrap_or(0)).into_iter().filter(has_parts);
    fitting.min_by_key(differs)
}

/// S-DOP over k × axes × overlap.
fn s_dops(own: &CullSettings) -> Vec<Variant> {
    let mut list = Vec::new();
    for &k in DirectionSet::ALL {
        for &axes in Axes::ALL {
            for &overlap in Overlap::ALL {
                let set = CullSettings {
                    strategy: Strategy::SDopSequential,
                    updates: Updates::Eager,
                    k,
                    axes,
                    overlap,
                    ..own.clone()
                };
                list.push(Variant::of(format!("s-dop {k}, {axes}, {overlap}"), set));
            }
        }
    }
    list
}

/// The other strategies, with the scene's or-DOPs.
fn strategies(own: &CullSettings, hits: u64) -> Vec<Variant> {
    let with = |strategy, updates| CullSettings { strategy, updates, ..own.clone() };
    let interest = own.interest.clone().unwrap_or(Interest::Bodies(vec![0]));
    let budget = hits.div_ceil(2);
    vec![
        Variant::of("s-dop lazy".into(), with(Strategy::SDopSequential, Updates::Lazy)),
        Variant::of("s-dop batch".into(), with(Strategy::SDopBatch, Updates::Eager)),
        Variant::of("s-dop batch lazy".into(), with(Strategy::SDopBatch, Updates::Lazy)),
        Variant::of(
            "s-dop of interest".into(),
            CullSettings {
                interest: Some(interest),
                ..with(Strategy::SDopObjectOfInterest, Updates::Eager)
            },
        ),
        Variant::of(
            format!("s-dop time-critical, {budget} tests"),
            CullSettings {
                budget: Some(Budget::Tests(budget)),
                order: sdop::settings::Order::LargestOverlap,
                ..with(Strategy::SDopTimeCritical, Updates::Eager)
            },
        ),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every name of a table is found again, and a short one is as the settings have it.
    #[test]
    fn names_of_tables_are_found() {
        let own = CullSettings::default();
        for variant in all(&own, 10) {
            assert_eq!(named(&own, &variant.name), Some(variant.clone()), "{}", variant.name);
        }
        let found = |name| named(&own, name).map(|variant| variant.name);
        assert_eq!(found("s-dop 26").as_deref(), Some("s-dop 26, principal, two-sided"));
        assert_eq!(found("s-dop 26, model").as_deref(), Some("s-dop 26, model, two-sided"));
        assert_eq!(found("or-14, full").as_deref(), Some("or-14, full"));
        assert_eq!(found("s-dop"), None);
        let batch = named(&own, "s-dop-batch").map(|variant| variant.settings.strategy);
        assert_eq!(batch, Some(Strategy::SDopBatch));
    }
}
