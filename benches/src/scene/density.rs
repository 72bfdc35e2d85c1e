//! The side of the box that gives a requested density.
//!
//! Let spheres of radii r be uniform in a volume V, and ignore its edges. Then body i overlaps
//! Σ_{j≠i} (4/3)π(rᵢ + rⱼ)³/V others on average. The mean over bodies is `partners`, so V =
//! (4/3)π/(N·partners)·Σ_{i≠j}(rᵢ + rⱼ)³, and by power sums Sₖ = Σ rᵢᵏ the double sum is 2N·S₃ +
//! 6·S₁S₂ − 8·S₃. In a finite box, fewer overlap near the walls, but centres stay at least r away
//! from the walls; these two effects nearly cancel.

use std::f64::consts::PI;

/// The power sums of radii, added up in the order of the bodies.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PowerSums {
    n: f64,
    s1: f64,
    s2: f64,
    s3: f64,
}

impl PowerSums {
    /// Adds a sphere.
    pub(super) fn add(&mut self, radius: f32) {
        let r = f64::from(radius);
        self.n += 1.0;
        self.s1 += r;
        self.s2 += r * r;
        self.s3 += r * r * r;
    }

    /// The side of the cube in which spheres of these radii have `partners` overlaps each, in the
    /// mean.
    pub(super) fn side(&self, partners: f32) -> f32 {
        let Self { n, s1, s2, s3 } = *self;
        let cubes = 2.0 * n * s3 + 6.0 * s1 * s2 - 8.0 * s3;
        let volume = 4.0 / 3.0 * PI * cubes / (n * f64::from(partners));
        libm::cbrt(volume) as f32
    }
}
