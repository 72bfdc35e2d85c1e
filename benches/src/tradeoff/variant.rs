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

/// Every variant for a scene, with the scene's settings for everything else. `hits` is the mean
/// number of sphere hits per frame; half of it is the budget of time-critical culling.
#[must_use]
pub fn all(scene: &Scene, hits: u64) -> Vec<Variant> {
    let own = &scene.cull;
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
    list.extend(strategies(scene, hits));
    list.push(Variant::hulls(own));
    list
}

/// S-DOP over k × axes × overlap.
#[must_use]
pub fn s_dops(own: &CullSettings) -> Vec<Variant> {
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
fn strategies(scene: &Scene, hits: u64) -> Vec<Variant> {
    let own = &scene.cull;
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
