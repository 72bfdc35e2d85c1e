//! The same scene with one change: the number of bodies, their triangles, motion or shapes.
//!
//! [Density](super::density) has a separate study, since the decision table depends on it. Bodies
//! and motion are measured with the finder `auto`, whose choice depends on them, on consecutive
//! frames of a run, and by the mean of warm frames, since a finder that keeps lists rebuilds them
//! only in some frames.

use std::fmt;
use std::num::NonZeroU32;

use serde::{Deserialize, Serialize};

use super::TradeoffError;
use super::decide::{CHECKS, choose_measured};
use super::density::{self, built_if_possible, variants};
use super::pays::Line;
use super::truth::{ExactJudge, NarrowPhase};
use crate::number::{Interval, Positive};
use crate::scene::{Scene, SceneFile};
use crate::simulate::{SimulationError, Trajectory};
use sdop::choice::choices;
use sdop::mesh::decimate::decimate;
use sdop::mesh::{ProceduralShape, TriangleMesh};
use sdop::settings::Finder;
use sdop::simd::Tier;
use sdop::volume::{Origin, Shape, ShapeSpec};

choices! {
    /// The changed property of a scene.
    Aspect, "aspect", {
        /// Number of bodies, at the scene's density.
        Bodies = "bodies",
        /// Triangles of a mesh.
        Triangles = "triangles",
        /// Motion and rotation per frame, with ten times the scene's bodies.
        Motion = "motion",
        /// The shapes, in balls as large as the scene's.
        Shapes = "shapes",
    }
}

choices! {
    /// The shapes of the bodies.
    Mix, "mix of shapes", {
        /// Balls.
        Round = "balls",
        /// Cubes.
        Compact = "cubes",
        /// Needles.
        Thin = "needles",
        /// All three alternately.
        Mixed = "balls, cubes, needles",
        /// The scene's meshes, each with a radius from half to twice its own.
        Sizes = "own, radii 1 : 4",
    }
}

/// One change of a scene.
#[derive(Clone, Copy, Debug)]
pub(super) enum SceneChange {
    /// This multiple of the bodies, in this multiple of the volume.
    Bodies(f32),
    /// At most this number of triangles per mesh.
    Triangles(usize),
    /// This multiple of the motion per frame.
    Motion(f32),
    /// Other shapes.
    Shapes(Mix),
}

impl SceneChange {
    fn aspect(self) -> Aspect {
        match self {
            Self::Bodies(_) => Aspect::Bodies,
            Self::Triangles(_) => Aspect::Triangles,
            Self::Motion(_) => Aspect::Motion,
            Self::Shapes(_) => Aspect::Shapes,
        }
    }
}

impl fmt::Display for SceneChange {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Bodies(factor) => write!(f, "{factor} times the bodies"),
            Self::Triangles(usize::MAX) => f.write_str("all triangles"),
            Self::Triangles(most) => write!(f, "at most {most} triangles"),
            Self::Motion(factor) => write!(f, "{factor} times the motion"),
            Self::Shapes(mix) => write!(f, "shapes: {mix}"),
        }
    }
}

impl Aspect {
    fn changes(self) -> Vec<SceneChange> {
        match self {
            Self::Bodies => [0.1, 1.0, 10.0, 40.0].map(SceneChange::Bodies).to_vec(),
            Self::Triangles => [100, 1000, usize::MAX].map(SceneChange::Triangles).to_vec(),
            Self::Motion => [0.1, 1.0, 10.0, 40.0].map(SceneChange::Motion).to_vec(),
            Self::Shapes => Mix::ALL.iter().map(|mix| SceneChange::Shapes(*mix)).collect(),
        }
    }
}

/// A scene with one change.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Variation {
    /// The changed property.
    pub aspect: Aspect,
    /// The mix of shapes, if shapes were changed.
    pub mix: Option<Mix>,
    /// Number of bodies.
    pub bodies: usize,
    /// Mean triangles of a body's mesh.
    pub triangles: f64,
    /// Mean motion of a moving body's centre in the first frame, in radii of its ball.
    pub motion: f64,
    /// Mean sphere overlaps per body.
    pub partners: f64,
    /// The exact reference as narrow phase.
    pub narrow_phase: NarrowPhase,
    /// T and Np of every compared variant.
    pub lines: Vec<Line>,
    /// The cheapest variant for each price of a narrow-phase check.
    pub best: Vec<Recommendation>,
}

/// Pairs on which a variation's narrow phase is timed.
const CHECKED_PAIRS: usize = 500;

/// The recommendation for one price of a check.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Recommendation {
    /// Seconds of a narrow-phase check of a pair that doesn't meet.
    pub check: f64,
    /// The cheapest variant.
    pub name: String,
    /// The variants tied with it.
    pub tied: Vec<String>,
}

/// Every change.
pub(super) fn changes() -> Vec<SceneChange> {
    Aspect::ALL.iter().flat_map(|aspect| aspect.changes()).collect()
}

/// Runs the scene with a change. `None` if it can't have it.
///
/// # Errors
/// Running the scene fails.
pub(super) fn varied(
    file: &SceneFile,
    change: SceneChange,
    tier: Tier,
    count: u32,
) -> Result<Option<Variation>, TradeoffError> {
    let scene = changed(file, change)?;
    let of = |scene| variation(change, &scene, tier, count);
    scene.map(of).transpose()
}

fn variation(
    change: SceneChange,
    scene: &Scene,
    tier: Tier,
    count: u32,
) -> Result<Variation, TradeoffError> {
    let variants = variants(&scene.cull);
    let lines = match change {
        SceneChange::Bodies(_) | SceneChange::Motion(_) => {
            density::lines_of_a_run(scene, &variants, tier)?
        }
        SceneChange::Triangles(_) | SceneChange::Shapes(_) => {
            density::lines(scene, &variants, tier, count)?
        }
    };
    let bodies = &scene.bodies;
    let triangles = bodies.shape.iter().map(|&shape| scene.shapes[shape as usize].triangles.len());
    let best = CHECKS.iter().filter_map(|&check| {
        let choice = choose_measured(&lines, check)?;
        Some(Recommendation { check, name: choice.best, tied: choice.tied })
    });
    Ok(Variation {
        aspect: change.aspect(),
        mix: match change {
            SceneChange::Shapes(mix) => Some(mix),
            _ => None,
        },
        bodies: bodies.len(),
        triangles: triangles.sum::<usize>() as f64 / bodies.len() as f64,
        motion: motion(scene)?,
        partners: lines.first().map_or(0.0, |spheres| 2.0 * spheres.pairs / bodies.len() as f64),
        narrow_phase: ExactJudge::new(&scene.shapes)?.price_of_spheres(
            scene,
            bodies,
            tier,
            CHECKED_PAIRS,
        )?,
        best: best.collect(),
        lines,
    })
}

/// Mean motion of moving bodies in the first frame, in radii.
fn motion(scene: &Scene) -> Result<f64, TradeoffError> {
    let mut trajectory = Trajectory::new(scene).map_err(SimulationError::from)?.with_frames(2);
    let mut states = Vec::new();
    while let Some(bodies) = trajectory.advance()? {
        states.push(bodies.clone());
    }
    let [before, after] = states.as_slice() else {
        return Ok(0.0);
    };
    let moving = (0..before.len()).filter(|&body| before.dynamic[body]);
    let ways: Vec<f64> = moving
        .map(|body| {
            let [from, to] = [before, after].map(|state| glam::Vec3::from(state.translation[body]));
            let radius = scene.shapes[before.shape[body] as usize].ball.radius;
            f64::from(from.distance(to)) / f64::from(radius)
        })
        .collect();
    Ok(ways.iter().sum::<f64>() / ways.len().max(1) as f64)
}

/// The scene with a change. `None` if it can't have it: bodies at given places, spheres larger than
/// the box.
fn changed(file: &SceneFile, change: SceneChange) -> Result<Option<Scene>, TradeoffError> {
    let mut file = file.clone();
    let mut possible = true;
    match change {
        SceneChange::Bodies(factor) => possible = multiply(&mut file, factor),
        SceneChange::Motion(factor) => {
            possible = multiply(&mut file, 10.0);
            file.spec.dt = Positive(file.spec.dt.0 * factor);
        }
        SceneChange::Shapes(Mix::Sizes) => spread_radii(&mut file),
        SceneChange::Triangles(_) | SceneChange::Shapes(_) => {}
    }
    if !possible {
        return Ok(None);
    }
    let Some(mut scene) = built_if_possible(&file)? else {
        return Ok(None);
    };
    match change {
        SceneChange::Triangles(most) => fewer_triangles(&mut scene, most)?,
        SceneChange::Shapes(mix) => other_shapes(&mut scene, mix)?,
        SceneChange::Bodies(_) | SceneChange::Motion(_) => {}
    }
    Ok(Some(scene))
}

/// Multiplies the bodies at the same density, with the finder `auto`. Returns whether the scene can
/// have them.
fn multiply(file: &mut SceneFile, factor: f32) -> bool {
    file.spec.cull.pairs = Finder::Auto;
    let counts = file.spec.bodies.iter_mut().map(|group| group.get_mut().count.as_mut());
    let Some(counts) = counts.collect::<Option<Vec<_>>>() else {
        return false;
    };
    for count in counts {
        let most = (count.get_ref().get() as f32 * factor).round() as u32;
        *count.get_mut() = NonZeroU32::new(most).unwrap_or(NonZeroU32::MIN);
    }
    let bounds = file.spec.bounds.as_mut().map(toml::Spanned::get_mut);
    if let Some(side) = bounds.and_then(|bounds| bounds.side.as_mut()) {
        side.get_mut().0 *= libm::cbrtf(factor);
    }
    true
}

/// Sets radii from half to twice the present ones.
fn spread_radii(file: &mut SceneFile) {
    for group in &mut file.spec.bodies {
        if let Some(radius) = &mut group.get_mut().radius {
            let Interval { min, max } = *radius.get_ref();
            *radius.get_mut() = Interval { min: 0.5 * min, max: 2.0 * max };
        }
    }
}

fn fewer_triangles(scene: &mut Scene, most: usize) -> Result<(), TradeoffError> {
    for shape in &mut scene.shapes {
        if shape.triangles.len() > most {
            let mesh = TriangleMesh {
                name: shape.name.clone(),
                vertices: shape.vertices.clone(),
                triangles: shape.triangles.clone(),
                ..TriangleMesh::default()
            };
            *shape = Shape::build(&decimate(&mesh, most), &spec(&scene.cull, shape))?;
        }
    }
    Ok(())
}

fn other_shapes(scene: &mut Scene, mix: Mix) -> Result<(), TradeoffError> {
    let names: &[&str] = match mix {
        Mix::Round => &["icosphere"],
        Mix::Compact => &["box"],
        Mix::Thin => &["needle"],
        Mix::Mixed => &["icosphere", "box", "needle"],
        Mix::Sizes => return Ok(()),
    };
    for (at, shape) in scene.shapes.iter_mut().enumerate() {
        let mesh = ProceduralShape::from_name(names[at % names.len()], &[])?.build()?;
        *shape = Shape::build(&mesh, &spec(&scene.cull, shape))?;
    }
    Ok(())
}

/// The specification of a shape as large as another, with the scene's settings.
fn spec(cull: &sdop::settings::CullSettings, like: &Shape) -> ShapeSpec {
    ShapeSpec {
        origin: Origin::Ball,
        radius: Some(like.ball.radius),
        directions: cull.k,
        axes: cull.axes,
    }
}
