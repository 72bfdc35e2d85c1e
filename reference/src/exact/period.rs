//! Space that repeats along some axes, in exact fractions: the images in which two boxes meet, a
//! point that they share there, and how far apart the images of two points are. Touching counts.

use dashu_ratio::RBig;

use super::common::{Point, lifted};
use crate::linear::Vector;
use crate::number::Number;

/// The numbers of periods by which the second of two boxes is moved where the two meet: one number
/// per axis, 0 where the axis has no period. Boxes are two corners, the lower one first; periods
/// are above zero.
///
/// # Panics
/// Two boxes meet in more than 2⁶³ images.
#[must_use]
pub fn meeting_images(
    a: [Vector<f64>; 2],
    b: [Vector<f64>; 2],
    periods: [Option<f64>; 3],
) -> Vec<[i64; 3]> {
    let ([a_lo, a_hi], [b_lo, b_hi]) = (a.map(lifted), b.map(lifted));
    let mut images = vec![[0; 3]];
    for (axis, period) in periods.into_iter().enumerate() {
        // a_lo ≤ b_hi + n·period, and b_lo + n·period ≤ a_hi.
        let (first, last) = (&a_lo[axis] - &b_hi[axis], &a_hi[axis] - &b_lo[axis]);
        let (fewest, most) = match period {
            None => (i64::from(first > RBig::ZERO), -i64::from(last < RBig::ZERO)),
            Some(period) => {
                let period = RBig::lift(period, 0);
                let whole = |number| i64::try_from(number).unwrap_or(i64::MAX);
                let (first, last) = (first / &period, last / &period);
                (whole(first.ceil()), whole(last.floor()))
            }
        };
        let along = |image: [i64; 3]| {
            (fewest..=most).map(move |n| {
                let mut image = image;
                image[axis] = n;
                image
            })
        };
        images = images.into_iter().flat_map(along).collect();
    }
    images
}

/// A point of the first of two boxes that an image of the second one shares; `None` if none does.
///
/// # Panics
/// As [`meeting_images`].
#[must_use]
pub fn common_point(
    a: [Vector<f64>; 2],
    b: [Vector<f64>; 2],
    periods: [Option<f64>; 3],
) -> Option<Point> {
    let image = *meeting_images(a, b, periods).first()?;
    let (a, b) = (lifted(a[0]), lifted(b[0]));
    Some(Point([0, 1, 2].map(|axis| {
        let period = RBig::lift(periods[axis].unwrap_or(0.0), 0);
        a[axis].larger(&(&b[axis] + RBig::from(image[axis]) * period))
    })))
}

/// The difference of two points, of which the second is moved by whole periods, if f64 holds it.
#[must_use]
pub fn separation(
    a: Vector<f64>,
    b: Vector<f64>,
    image: [i64; 3],
    periods: [Option<f64>; 3],
) -> Option<Vector<f64>> {
    let mut apart = [0.0; 3];
    for (axis, apart) in apart.iter_mut().enumerate() {
        let lift = |x: f64| RBig::lift(x, 0);
        let way = RBig::from(image[axis]) * lift(periods[axis].unwrap_or(0.0));
        let exact = lift(b[axis]) + way - lift(a[axis]);
        *apart = exact.to_f64_fast();
        if lift(*apart) != exact {
            return None;
        }
    }
    Some(apart)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn along_x(lo: f64, hi: f64) -> [Vector<f64>; 2] {
        [[lo, 0.0, 0.0], [hi, 1.0, 1.0]]
    }

    #[test]
    fn touching_images_are_counted() {
        let found = |b, period| {
            let images = meeting_images(along_x(0.0, 1.0), b, [period, None, Some(1.0e9)]);
            images.into_iter().map(|[x, ..]| x).collect::<Vec<_>>()
        };
        assert_eq!(found(along_x(9.0, 10.0), None), []);
        assert_eq!(found(along_x(1.0, 2.0), None), [0]);
        assert_eq!(found(along_x(9.0, 10.0), Some(10.0)), [-1]);
        assert_eq!(found(along_x(9.0, 9.999), Some(10.0)), []);
        assert_eq!(found(along_x(-99.0, -98.0), Some(10.0)), [10]);
        assert_eq!(found(along_x(1.0, 10.0), Some(10.0)), [-1, 0]);
        assert_eq!(found(along_x(0.0, 2.0), Some(0.5)), [-4, -3, -2, -1, 0, 1, 2]);
        // 0.1 is not a tenth, so ten of it are more than 1.
        assert_eq!(found(along_x(2.0, 3.0), Some(0.1)).last(), Some(&-10));
        assert_eq!(found(along_x(2.0, 3.0), Some(0.1)).first(), Some(&-29));
    }

    #[test]
    fn every_axis_counts() {
        let unit = [[0.0; 3], [1.0; 3]];
        let at = |corner: [f64; 3]| [corner, corner.map(|x| x + 1.0)];
        let periods = [Some(4.0), Some(8.0), Some(16.0)];
        let images = |corner| meeting_images(unit, at(corner), periods);
        assert_eq!(images([3.0, 7.0, -15.0]), [[-1, -1, 1]]);
        assert_eq!(images([3.0, 6.0, -15.0]), [[0; 3]; 0]);
        let wide = [[0.0; 3], [4.0, 8.0, 16.0]];
        assert_eq!(meeting_images(unit, wide, periods).len(), 8);
    }

    /// The second box begins in the first, one period of 0.1 further left: at 0.5 − 0.1, which no
    /// f64 holds.
    #[test]
    fn common_points_are_exact() {
        let periods = [Some(0.1), None, None];
        let point = common_point(along_x(0.375, 0.4375), along_x(0.5, 0.5), periods);
        let [x, ..] = point.map_or_else(Default::default, |point| point.0);
        assert_eq!(x, RBig::lift(0.5, 0) - RBig::lift(0.1, 0));
        assert_eq!(common_point(along_x(0.0, 0.0625), along_x(0.375, 0.375), periods), None);
    }

    #[test]
    fn separations_are_exact() {
        let periods = [Some(0.1), None, Some(3.0)];
        let apart = |b, image| separation([0.5, 1.0, -1.0], b, image, periods);
        assert_eq!(apart([0.5, 4.0, 2.0], [0, 0, -1]), Some([0.0, 3.0, 0.0]));
        assert_eq!(apart([0.5, 4.0, 2.0], [1, 0, 0]), Some([0.1, 3.0, 3.0]));
        assert_eq!(apart([0.5, 4.0, 2.0], [3, 0, 0]), None, "3 · 0.1 is no f64");
    }
}
