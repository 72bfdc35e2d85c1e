//! Compares the f64 maps of the filter with rationals: how much of the error bound do the worst
//! cases use?

use super::rational::{Rational3, posed, rational, rational3, unposed};
use super::shapes::{Draws, exact_basis, slabs};
use crate::DirectionSet;
use crate::exact::polytope::Polytope;
use crate::exact::relative::Approximate;
use crate::linear::largest;
use crate::number::power_of_two;

/// The largest coordinate difference between a rounded and an exact vector, in f64.
fn difference(rounded: &[f64; 3], exact: &Rational3) -> f64 {
    let off = |i: usize| (rational(rounded[i]) - &exact[i]).to_f64().value().abs();
    off(0).max(off(1)).max(off(2))
}

#[test]
fn mapped_points_stay_within_the_bound() {
    let mut draws = Draws(23);
    let (mut worst, mut worst_over) = (0.0_f64, 0.0_f64);
    for n in 0..4000 {
        let case = draws.hard_case();
        let (a, b) = if n % 2 == 0 { (case.a, case.b) } else { (draws.pose(1.0), draws.pose(1.0)) };
        let point = draws.vector(power_of_two(if n % 2 == 0 { case.size } else { 0 }) as f32);
        let seen = unposed(&a, &posed(&b, &rational3(point)));
        let map = Approximate::between(&a, &b);
        let point = point.map(f64::from);
        let used = difference(&map.map(&point), &seen) / map.error(largest(&point));
        assert!(used <= 1.0, "{a:?} {b:?} {point:?}");
        worst = worst.max(used);

        let bases = [exact_basis([1, 2, -3, 5]), exact_basis([7, -1, 2, 3])];
        let of = |basis| Polytope::new(&slabs(DirectionSet::K6, basis, &[[0.0; 3]])).unwrap();
        let [over_a, over_b] = bases.map(of);
        let map = Approximate::over((&a, &over_a), (&b, &over_b));
        let xi = point.map(|x| x * 39.0);
        let rows = |p: &Polytope| p.basis.map(|row| row.map(rational));
        let norm = super::rational::dot(&rows(&over_b)[0], &rows(&over_b)[0]);
        let columns = rows(&over_b);
        let y = [0, 1, 2].map(|i| {
            (0..3).map(|j| rational(xi[j]) * &columns[j][i]).fold(rational(0.0), |s, x| s + x)
                / &norm
        });
        let x = unposed(&a, &posed(&b, &y));
        let expected = rows(&over_a).map(|row| super::rational::dot(&row, &x));
        let used = difference(&map.map(&xi), &expected) / map.error(largest(&xi));
        assert!(used <= 1.0, "{a:?} {b:?} {xi:?}");
        worst_over = worst_over.max(used);
    }
    // 256u are taken, 72u and 180u derived; a bound that nothing comes near would hide a map that
    // never runs.
    assert!(worst > 1.0 / 256.0 && worst_over > 1.0 / 256.0, "{worst} {worst_over}");
}
