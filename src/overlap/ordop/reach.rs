//! The distance from its centre within which an or-DOP can be reported: the radius by which pair
//! finders bin or-DOPs in a strategy without spheres.
//!
//! Two or-DOPs whose circumscribed balls are apart may still be reported, because slab normals
//! alone don't separate all disjoint polytopes. But some normal a of A is within the covering angle
//! θ of Δ, so a·Δ ≥ cos θ·|Δ|, while each support is at most S = C·w: w is the largest half width
//! of a slab over its normal's length, and C bounds Σλᵢ‖dᵢ‖ of the weak-duality multipliers of a
//! unit vector. Therefore they are separated if |Δ| > (S_A + S_B)/cos θ:
//!
//! | k | cos θ | C | C/cos θ |
//! |---|---|---|---|
//! | 6 | 1/√3 | √3 | 3 |
//! | 14 | .8069 | 1.2393 | 1.536 |
//! | 18 | √(2/3) | √(3/2) | 1.5 |
//! | 26 | .8865 | 1.1281 | 1.273 |

use super::table::{COEFFICIENTS, members_of};

/// Exceeds about forty roundings, and the rounding of the centre's offset.
const MARGIN: f64 = 1.0 / 4096.0;
const OFFSET_MARGIN: f64 = 1.0 / (1 << 20) as f64;

/// The radius about the or-DOP's centre: the test separates any two or-DOPs with |Δ| above the sum
/// of their radii. `reach` bounds the distance of the shape's centre from the body origin.
pub fn reach(table: &[f32], k: usize, reach: f32) -> f64 {
    let factor = match k {
        6 => 3.0,
        14 => 1.536,
        18 => 1.5,
        _ => 1.273,
    };
    let ends = table.chunks(2).zip(members_of(k));
    let widest = ends.fold(0.0, |widest: f64, (ends, &member)| {
        let length = COEFFICIENTS[member].iter().filter(|&&c| c != 0).count();
        let half = ends[0].max(ends[1]);
        widest.max(f64::from(half) / (length as f64).sqrt())
    });
    widest * factor * (1.0 + MARGIN) + f64::from(reach) * OFFSET_MARGIN
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Unit vectors spread evenly over the sphere.
    fn directions() -> impl Iterator<Item = [f64; 3]> {
        (0..20_000).map(|i| {
            let z = 1.0 - (2.0 * f64::from(i) + 1.0) / 20_000.0;
            let (turn, r) = (f64::from(i) * 2.399_963_229_728_653, (1.0 - z * z).sqrt());
            [r * turn.cos(), r * turn.sin(), z]
        })
    }

    /// max over members of d·e/‖d‖.
    fn nearest(k: usize, e: [f64; 3]) -> f64 {
        let cosine = |&member: &usize| {
            let d = COEFFICIENTS[member].map(f64::from);
            let length = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
            (d[0] * e[0] + d[1] * e[1] + d[2] * e[2]).abs() / length
        };
        members_of(k).iter().map(cosine).fold(0.0, f64::max)
    }

    #[test]
    fn factors_cover_every_direction() {
        for k in [6, 14, 18, 26] {
            // A table in which every half is its normal's length: w = 1, so S is the plain bound on
            // supports.
            let length = |&member: &usize| {
                COEFFICIENTS[member].map(f32::from).iter().map(|c| c * c).sum::<f32>()
            };
            let table: Vec<f32> =
                members_of(k).iter().flat_map(|m| [length(m).sqrt(); 2]).collect();
            // Written out, so that the test does not take the margin from the code.
            let factor = reach(&table, k, 0.0) / (1.0 + 1.0 / 4096.0);
            let cosine = directions().map(|e| nearest(k, e)).fold(1.0, f64::min);
            let support = directions().map(|e| support_of_unit_halves(k, e)).fold(0.0, f64::max);
            assert!(support / cosine <= factor * (1.0 + 1e-6), "k = {k}: {support} / {cosine}");
            assert!(support / cosine >= factor * 0.99, "k = {k}: not wasteful");
        }
    }

    /// A centre far from the origin reaches farther.
    #[test]
    fn far_centre_reaches_farther() {
        let table = [1.0; 6];
        let gained = reach(&table, 6, 4096.0) - reach(&table, 6, 0.0);
        // 4096 of 2^-20.
        assert!((0.99..1.01).contains(&(256.0 * gained)), "{gained}");
        assert!(reach(&table, 6, 0.0) > 3.0 * (1.0 + 0.99 / 4096.0));
    }

    fn support_of_unit_halves(k: usize, e: [f64; 3]) -> f64 {
        let mut s = e.map(f64::abs);
        s.sort_by(|a, b| b.total_cmp(a));
        let [x, y, z] = s;
        let (two, three) = (2f64.sqrt(), 3f64.sqrt());
        match k {
            6 => x + y + z,
            14 => (x - y) + three * y,
            18 if x > y + z => (x - y - z) + two * (y + z),
            18 => two * 0.5 * (x + y + z),
            _ => (x - y) + two * (y - z) + three * z,
        }
    }
}
