//! Poses of parts: a local pose, then the pose of the body.
//!
//! A part's local pose is (qₚ, tₚ), its body's pose is (q, t), and its points are at
//! R(q)(R(qₚ)x + tₚ) + t. As R(q)R(qₚ) = R(q·qₚ), the part has the rotation of a product of two
//! quaternions and the translation R(q)tₚ + t. The second is computed in f64 with the bound of
//! [`OFFSET_ERROR`](super::pose::OFFSET_ERROR). The first is rounded to f32 again, so that every
//! volume and test has a pose as its bounds assume, and the part is grown by the distance that its
//! points may move ([`TURN_ERROR`]). Theorem D of `paper/proofs/LEMMAS.md`.

use super::exp2;

/// 9/8·2⁻²³: the distance between a point turned by [`product`] and by the exact product, as a
/// multiple of the point's distance from the origin. With ε = 2⁻⁵³ and u = 2⁻²⁴: products of two
/// f32 are exact in f64, so by Cauchy–Schwarz three sums make an error below 3.01ε‖q‖‖qₚ‖ per
/// component, 6.02ε of the product's norm. Division by the largest component and rounding to f32
/// bring u + ε of each component, or 2⁻¹²⁶ where it is flushed. So the quaternion is within (1 +
/// 2⁻²⁵)u of its norm of exact, the angle between the two is at most its arc sine, rotations differ
/// by twice that, and a point of distance ‖x‖ moves by at most 2(1 + 2⁻²⁵)u‖x‖. The rest covers the
/// arithmetic on the bound. Hill climbing finds 0.56 of it, since the largest component is exact.
pub const TURN_ERROR: f64 = 1.125 * exp2(-23);

/// The product of two quaternions (x, y, z, w) of any non-zero norm, rounded to f32: the rotation
/// by `q` after the rotation by `inner`. Its largest component is 1 or −1.
#[must_use]
pub fn product(q: [f32; 4], inner: [f32; 4]) -> [f32; 4] {
    let [x, y, z, w] = q.map(f64::from);
    let [a, b, c, d] = inner.map(f64::from);
    let product = [
        w * a + x * d + y * c - z * b,
        w * b - x * c + y * d + z * a,
        w * c + x * b - y * a + z * d,
        w * d - x * a - y * b - z * c,
    ];
    let largest = product.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    product.map(|x| (x / largest) as f32)
}

#[cfg(test)]
mod tests {
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};

    use super::*;

    const UNTURNED: [f32; 4] = [0.0, 0.0, 0.0, 1.0];

    /// How far a point at the distance 1 may move, as a share of the bound: twice the sine of the
    /// angle between the product and its f32 numbers.
    fn share(q: [f32; 4], inner: [f32; 4]) -> f64 {
        let [x, y, z, w] = q.map(f64::from);
        let [a, b, c, d] = inner.map(f64::from);
        let exact = [
            w * a + x * d + y * c - z * b,
            w * b - x * c + y * d + z * a,
            w * c + x * b - y * a + z * d,
            w * d - x * a - y * b - z * c,
        ];
        let rounded = product(q, inner).map(f64::from);
        let dot = |a: [f64; 4], b: [f64; 4]| (0..4).map(|i| a[i] * b[i]).sum::<f64>();
        let along = dot(exact, rounded) / dot(exact, exact);
        let across = [0, 1, 2, 3].map(|i| rounded[i] - along * exact[i]);
        2.0 * (dot(across, across) / dot(rounded, rounded)).sqrt() / TURN_ERROR
    }

    /// A quarter about x and then one about z, and the other way round.
    #[test]
    fn the_inner_rotation_is_first() {
        let [about_x, about_z] = [[1.0, 0.0, 0.0, 1.0], [0.0, 0.0, 1.0, 1.0]];
        assert_eq!(product(about_z, about_x), [1.0, 1.0, 1.0, 1.0]);
        assert_eq!(product(about_x, about_z), [1.0, -1.0, 1.0, 1.0]);
        assert_eq!(product([0.0, 0.0, -3.0, 3.0], UNTURNED), [0.0, 0.0, -1.0, 1.0]);
    }

    /// Norms are free, up to those whose squares no f32 holds.
    #[test]
    fn norms_do_not_change_the_product() {
        let (q, inner) = ([0.5, -0.25, 0.125, 1.0], [1.0, 0.75, -0.5, 0.25]);
        let scaled = |q: [f32; 4], by: f32| q.map(|x| x * by);
        let subnormal = f32::from_bits(1 << 9);
        for by in [2.0_f32.powi(100), 2.0_f32.powi(-100), subnormal] {
            assert_eq!(product(scaled(q, by), scaled(inner, by)), product(q, inner));
        }
    }

    #[test]
    fn turn_error_covers_rounding() {
        let mut words = ChaCha8Rng::seed_from_u64(2);
        let mut random = move || (words.next_u64() >> 40) as f32 / (1 << 23) as f32 - 1.0;
        let mut worst = 0.0_f64;
        for _ in 0..400_000 {
            let q = [(); 4].map(|()| random());
            worst = worst.max(share(q, [(); 4].map(|()| random())));
            // Components just above a power of two are rounded the most.
            let near = [0.5, 0.5, 0.5, 1.0].map(|x| x + 1.0e-3 * random());
            worst = worst.max(share(near, UNTURNED.map(|x| x + 1.0e-3 * random())));
        }
        assert!((0.5..=1.0).contains(&worst), "{worst}");
    }
}
