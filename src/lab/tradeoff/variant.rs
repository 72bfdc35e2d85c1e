//! What is compared: every volume and strategy, as culling settings with the shapes that they need.

use glam::Vec3;

use crate::lab::scene::Scene;
use crate::lab::tightness::mean_world_aligned_volume;
use crate::settings::{
    Axes, Budget, CullSettings, DirectionSet, Interest, Overlap, Strategy, Updates,
};
use crate::volume::{Hull, Shape};

/// Random rotations over which a world-aligned volume is averaged.
const TURNS: u32 = 64;

/// One way to cull.
#[derive(Clone, Debug, PartialEq)]
pub struct Variant {
    /// What tables call it.
    pub name: String,
    /// Its culling settings.
    pub settings: CullSettings,
    /// Whether pairs that the settings report are then tested by their convex hulls.
    pub hulls: bool,
}

impl Variant {
    /// Spheres alone, with a scene's other settings.
    #[must_use]
    pub fn spheres(own: &CullSettings) -> Self {
        let settings = CullSettings {
            strategy: Strategy::Sphere,
            ..own.clone()
        };
        Self::of("sphere".into(), settings)
    }

    /// Spheres, then convex hulls.
    #[must_use]
    pub fn hulls(own: &CullSettings) -> Self {
        Self {
            name: "sphere + hull".into(),
            hulls: true,
            ..Self::spheres(own)
        }
    }

    /// A variant of the scene's settings.
    pub(super) fn of(name: String, settings: CullSettings) -> Self {
        Self {
            name,
            settings,
            hulls: false,
        }
    }

    /// The volume that decides last.
    #[must_use]
    pub fn volume(&self) -> &'static str {
        match self.settings.strategy {
            _ if self.hulls => "hull",
            Strategy::None | Strategy::Sphere => "sphere",
            Strategy::Aabb => "aabb",
            Strategy::KDop => "k-dop",
            Strategy::Obb => "obb",
            _ => "or-dop",
        }
    }

    /// The scene culled this way, its shapes' or-DOPs rebuilt for it.
    #[must_use]
    pub fn apply(&self, scene: &Scene) -> Scene {
        Scene {
            shapes: scene
                .shapes
                .iter()
                .map(|s| refit(s, &self.settings))
                .collect(),
            cull: self.settings.clone(),
            ..scene.clone()
        }
    }

    /// Mean volume over hull volume of the scene's bodies; world-aligned volumes are averaged over rotations. `None` when
    /// a hull is flat.
    #[must_use]
    pub fn tightness(&self, scene: &Scene) -> Option<f64> {
        let ratios = scene
            .shapes
            .iter()
            .map(|shape| self.shape_tightness(shape))
            .collect::<Option<Vec<_>>>()?;
        let sum: f64 = scene.bodies.shape.iter().map(|&s| ratios[s as usize]).sum();
        Some(sum / scene.bodies.len() as f64)
    }

    fn shape_tightness(&self, shape: &Shape) -> Option<f64> {
        let hull = Hull::of(&shape.vertices);
        let inner = hull.volume(&shape.vertices);
        let aligned = |k| {
            let points: Vec<Vec3> = hull.points(&shape.vertices);
            mean_world_aligned_volume(&points, k, TURNS)
        };
        let volume = match self.volume() {
            "hull" => inner,
            "sphere" => shape.ball.volume(),
            "aabb" => aligned(DirectionSet::K6),
            "k-dop" => aligned(self.settings.k),
            "obb" => shape.obb(&hull).volume(),
            _ => refit(shape, &self.settings).ordop.volume(),
        };
        (inner > 0.0).then_some(volume / inner)
    }
}

/// The shape with the or-DOP that the settings ask for.
fn refit(shape: &Shape, settings: &CullSettings) -> Shape {
    Shape {
        ordop: shape.ordop_along(settings.axes, settings.k),
        ..shape.clone()
    }
}

/// Every variant for a scene: its own settings give what is not varied. `hits` is the mean number of sphere hits a
/// frame; half of it is time-critical culling's budget here.
#[must_use]
pub fn all(scene: &Scene, hits: u64) -> Vec<Variant> {
    let own = &scene.cull;
    let with = |strategy| CullSettings {
        strategy,
        ..own.clone()
    };
    let mut list = vec![
        Variant::spheres(own),
        Variant::of("aabb".into(), with(Strategy::Aabb)),
        Variant::of("obb".into(), with(Strategy::Obb)),
    ];
    for &k in DirectionSet::ALL {
        let set = CullSettings {
            k,
            ..with(Strategy::KDop)
        };
        list.push(Variant::of(format!("{k}-dop"), set));
    }
    for &k in DirectionSet::ALL {
        let set = CullSettings {
            k,
            ..with(Strategy::OrDop)
        };
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

/// The other strategies, with the scene's own or-DOPs.
fn strategies(scene: &Scene, hits: u64) -> Vec<Variant> {
    let own = &scene.cull;
    let with = |strategy, updates| CullSettings {
        strategy,
        updates,
        ..own.clone()
    };
    let interest = own.interest.clone().unwrap_or(Interest::Bodies(vec![0]));
    let budget = hits.div_ceil(2);
    vec![
        Variant::of(
            "s-dop lazy".into(),
            with(Strategy::SDopSequential, Updates::Lazy),
        ),
        Variant::of(
            "s-dop batch".into(),
            with(Strategy::SDopBatch, Updates::Eager),
        ),
        Variant::of(
            "s-dop batch lazy".into(),
            with(Strategy::SDopBatch, Updates::Lazy),
        ),
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
                order: crate::settings::Order::LargestOverlap,
                ..with(Strategy::SDopTimeCritical, Updates::Eager)
            },
        ),
    ]
}
