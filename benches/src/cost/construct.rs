//! Co: what it costs to build a variant's volumes and its culler once.

use std::time::Instant;

use crate::measure::counts::Volume;
use crate::measure::culling::Culling;
use crate::measure::variant::Variant;
use crate::measure::waiting_time::WaitingTime;
use crate::scene::Scene;
use crate::simulate::SimulationError;
use sdop::settings::Axes;
use sdop::simd::Tier;
use sdop::volume::{Ball, Shape};

/// Builds a variant's volume of one shape, except what the culler builds: the work that Co counts.
pub fn construct(volume: Volume, shape: &Shape, axes: Axes) {
    match volume {
        Volume::Sphere => drop(std::hint::black_box(Ball::smallest(&shape.vertices))),
        Volume::OrDop => {
            drop(std::hint::black_box(shape.ordop_along(axes, shape.ordop.directions)))
        }
        // The culler builds these itself, from the hulls.
        Volume::Aabb | Volume::KDop | Volume::Obb | Volume::Hull => {}
    }
}

/// Seconds to build each of a variant's volumes for all shapes once.
pub(super) fn volume_seconds(variant: &Variant, shapes: &[Shape]) -> Vec<f64> {
    let mut waiting = WaitingTime::of_this_thread();
    let seconds = |volume: Volume| {
        let (waited, start) = (waiting.seconds(), Instant::now());
        shapes.iter().for_each(|shape| construct(volume, shape, variant.settings.axes));
        let seconds = start.elapsed().as_secs_f64();
        (seconds - (waiting.seconds() - waited)).max(0.0)
    };
    variant.volumes().into_iter().map(seconds).collect()
}

/// Builds a variant's volumes of all shapes and its culler, once: the culler, and Co as measured,
/// in seconds.
///
/// # Errors
/// The settings can't be carried out.
pub fn build(
    variant: &Variant,
    shapes: &[Shape],
    scene: &Scene,
    tier: Tier,
) -> Result<(Culling, f64), SimulationError> {
    let volumes: f64 = volume_seconds(variant, shapes).iter().sum();
    let culling = variant.culling_of(shapes, scene, tier)?;
    let seconds = volumes + culling.construct;
    Ok((culling, seconds))
}
