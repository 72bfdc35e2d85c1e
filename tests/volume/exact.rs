//! Exact arithmetic for the checks: every finite f32 is an integer multiple of 2⁻¹⁴⁹.

use dashu_int::IBig;
use sdop::volume::{Ball, OrDop};

/// x·2¹⁴⁹.
pub fn integer(x: f32) -> IBig {
    assert!(x.is_finite());
    let bits = x.to_bits();
    let (exponent, fraction) = (bits >> 23 & 0xff, i64::from(bits & 0x7f_ffff));
    let magnitude = match exponent {
        0 => IBig::from(fraction),
        e => IBig::from(fraction | 1 << 23) << (e as usize - 1),
    };
    if x < 0.0 { -magnitude } else { magnitude }
}

pub fn point(v: impl Into<[f32; 3]>) -> [IBig; 3] {
    v.into().map(integer)
}

pub fn dot(a: &[IBig; 3], b: &[IBig; 3]) -> IBig {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

pub fn sub(a: &[IBig; 3], b: &[IBig; 3]) -> [IBig; 3] {
    std::array::from_fn(|k| &a[k] - &b[k])
}

/// ‖v − c‖² ≤ r² for every vertex.
pub fn ball_contains(ball: &Ball, vertices: &[impl Into<[f32; 3]> + Copy]) -> bool {
    let (centre, radius) = (point(ball.centre), integer(ball.radius));
    let squared = &radius * &radius;
    ball.radius >= 0.0
        && vertices.iter().all(|&v| {
            let offset = sub(&point(v), &centre);
            dot(&offset, &offset) <= squared
        })
}

/// lo ≤ d·v ≤ hi for every slab and vertex, with d summed exactly from the basis.
pub fn slabs_contain(ordop: &OrDop, vertices: &[impl Into<[f32; 3]> + Copy]) -> bool {
    let basis = ordop.basis.columns.map(point);
    let coefficients = ordop.directions.coefficients();
    assert_eq!(coefficients.len(), ordop.lo.len());
    assert_eq!(coefficients.len(), ordop.hi.len());
    coefficients.iter().enumerate().all(|(i, c)| {
        let direction: [IBig; 3] =
            std::array::from_fn(|k| (0..3).map(|j| &basis[j][k] * IBig::from(c[j])).sum());
        // Products carry the factor 2²⁹⁸.
        let (lo, hi) = (integer(ordop.lo[i]) << 149, integer(ordop.hi[i]) << 149);
        vertices.iter().all(|&v| {
            let value = dot(&direction, &point(v));
            lo <= value && value <= hi
        })
    })
}
