//! The same scene in other boxes: how the break-even of S-DOP depends on density.
//!
//! Np is proportional to density, while the time of finding pairs stays the same, so an or-DOP test
//! pays earlier in a denser scene. This needs only counts of reported pairs and times, no truth.

use serde::{Deserialize, Serialize};

use super::pays::{Line, break_even};
use super::timing::lines;
use super::variant;
use crate::number::Positive;
use crate::scene::{Scene, SceneError, SceneFile};
use sdop::simd::Tier;

/// Densities as multiples of the scene's.
pub(super) const FACTORS: [f32; 7] = [0.0625, 0.125, 0.25, 0.5, 1.0, 2.0, 4.0];
/// Break-evens at one density.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Density {
    /// Multiple of the scene's own density.
    pub factor: f32,
    /// Mean sphere overlaps per body.
    pub partners: f64,
    /// T and Np of every compared variant.
    pub lines: Vec<Line>,
    /// For each compared S-DOP: the Cp in seconds above which it is cheaper than spheres alone.
    pub break_even: Vec<BreakEven>,
}

impl Density {
    /// The name of a quantity at this density in rows.
    #[must_use]
    pub fn metric(&self, quantity: &str) -> String {
        format!("{quantity} at {} times the density", self.factor)
    }
}

/// The price from which an S-DOP pays.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BreakEven {
    /// The variant.
    pub name: String,
    /// Seconds per pair.
    pub cp: f64,
}

/// Runs the scene at a multiple of its density. `None` if its box is too small for that, or if it
/// has no box.
///
/// # Errors
/// Running the scene fails.
pub fn at(
    file: &SceneFile,
    factor: f32,
    tier: Tier,
    count: u32,
) -> miette::Result<Option<Density>> {
    let scene = crowded(file, factor).map(|file| built_if_possible(&file));
    let Some(scene) = scene.transpose()?.flatten() else {
        return Ok(None);
    };
    let variants = variant::volumes(&scene.cull, Some(scene.cull.axes));
    let lines = lines(&scene, &variants, tier, count)?;
    Ok(Some(density(factor, scene.bodies.len(), lines)))
}

/// The scene of a file whose values were changed. `None` if it can't have them, such as spheres
/// larger than its box.
///
/// # Errors
/// Any other problem: files can't be read, or bodies are outside of the contract.
fn built_if_possible(file: &SceneFile) -> Result<Option<Scene>, SceneError> {
    match file.build() {
        Ok(scene) => Ok(Some(scene)),
        Err(SceneError::Text(_)) => Ok(None),
        Err(error) => Err(error),
    }
}

fn density(factor: f32, bodies: usize, lines: Vec<Line>) -> Density {
    let spheres = &lines[0];
    Density {
        factor,
        partners: 2.0 * spheres.pairs / bodies as f64,
        break_even: lines
            .iter()
            .filter(|line| line.pairs < spheres.pairs && line.name.starts_with("s-dop"))
            .map(|line| BreakEven { name: line.name.clone(), cp: break_even(spheres, line) })
            .collect(),
        lines,
    }
}

/// The scene at another density: the volume of its box, or its partners, scaled.
fn crowded(file: &SceneFile, factor: f32) -> Option<SceneFile> {
    let mut file = file.clone();
    let bounds = file.spec.bounds.as_mut()?.get_mut();
    if let Some(side) = &mut bounds.side {
        side.get_mut().0 /= libm::cbrtf(factor);
    }
    if let Some(Positive(partners)) = bounds.partners.as_mut().map(toml::Spanned::get_mut) {
        *partners *= factor;
    }
    Some(file)
}
