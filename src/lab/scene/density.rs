//! The box side that a wished density needs.
//!
//! Spheres of radii r, uniform in a volume V, edges ignored: body i overlaps Σ_{j≠i} (4/3)π(rᵢ + rⱼ)³/V others in the
//! mean. The mean over bodies is `partners`, so
//! V = (4/3)π/(N·partners)·Σ_{i≠j}(rᵢ + rⱼ)³, and by power sums Sₖ = Σ rᵢᵏ the double sum is 2N·S₃ + 6·S₁S₂ − 8·S₃.
//! In a finite box fewer overlap near the walls, but centres keep r off them: the two nearly cancel.

use std::f64::consts::PI;

/// The side of the cube in which spheres of these radii have `partners` overlaps each, in the mean.
pub(super) fn side(radii: impl Iterator<Item = f32>, partners: f32) -> f32 {
    let (mut n, mut s1, mut s2, mut s3) = (0.0, 0.0, 0.0, 0.0);
    for r in radii.map(f64::from) {
        n += 1.0;
        s1 += r;
        s2 += r * r;
        s3 += r * r * r;
    }
    let cubes = 2.0 * n * s3 + 6.0 * s1 * s2 - 8.0 * s3;
    let volume = 4.0 / 3.0 * PI * cubes / (n * f64::from(partners));
    libm::cbrt(volume) as f32
}
