//! Margins for a whole step: the largest distance that a shape's points can move from their present
//! place before the step ends.
//!
//! A body grown by this margin contains its whole path, whatever the path is, as long as the body
//! is no faster than stated. Two bodies that meet at any time of the step then meet now with their
//! margins, and are reported (theorem U of `paper/proofs/LEMMAS.md`). The report says which pairs
//! to test, not when they meet.

use super::Shape;
use crate::rounding::{pose::norm, up};
use crate::simd::in_default_mode;

impl Shape {
    /// The margin that covers a step: no point of the shape moves farther from its present place
    /// within `seconds`, if the speed of the body's origin is at most the length of `linear` and
    /// its angular speed at most the length of `angular` (in radians per second). The result is
    /// infinite if it exceeds f32, and NaN if an argument is.
    ///
    /// The origin is the point that poses place. Rotation moves a point at distance ρ by at most
    /// 2ρ, and by at most the angle times ρ.
    ///
    /// ```
    /// # use sdop::{ProceduralShape, Shape, ShapeSpec};
    /// let rod = ProceduralShape::Box { x: 2.0, y: 0.0625, z: 0.0625 }.build()?;
    /// let rod = Shape::build(&rod, &ShapeSpec::default())?;
    /// let step = 1.0 / 64.0;
    /// let margin = rod.swept_margin([40.0, 0.0, 0.0], [0.0, 0.0, 6.4], step);
    /// assert!(margin > 0.625 + 0.1 && margin < 0.625 + 0.101); // to go, and to turn
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn swept_margin(
        &self,
        linear: impl Into<[f32; 3]>,
        angular: impl Into<[f32; 3]>,
        seconds: f32,
    ) -> f32 {
        let (linear, angular) = (linear.into(), angular.into());
        in_default_mode(|| {
            let seconds = f64::from(seconds).abs();
            let [x, y, z] = self.pose_offset;
            let reach = f64::from(self.reach) + (x * x + y * y + z * z).sqrt();
            let angle = norm(angular) * seconds;
            let turned = if angle > 2.0 { 2.0 } else { angle }; // NaN stays
            up(norm(linear) * seconds + turned * reach)
        })
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::*;
    use crate::mesh::{ProceduralShape, TriangleMesh};
    use crate::volume::ShapeSpec;

    fn rod() -> Shape {
        let (x, y, z) = (4.0, 0.25, 0.25);
        let form = ProceduralShape::Box { x, y, z };
        Shape::build(&form.build().unwrap(), &ShapeSpec::default()).unwrap()
    }

    /// At no time of the step is a point farther from its place than the margin, and the farthest
    /// point is nearly that far.
    #[test]
    fn no_point_goes_farther() {
        let shape = rod();
        for turn in [0.0, 0.1, 1.0, 3.0, 40.0] {
            for speed in [0.0, 0.5, 7.0] {
                let margin =
                    f64::from(shape.swept_margin([speed, 0.0, 0.0], [0.0, 0.0, turn], 0.5));
                let mut farthest = 0.0_f64;
                for time in 0..=64 {
                    let time = f64::from(time) / 128.0;
                    let (sin, cos) = (f64::from(turn) * time).sin_cos();
                    for &[x, y, _] in &shape.vertices {
                        let [x, y] = [x, y].map(f64::from);
                        let moved = [
                            cos * x - sin * y - x + f64::from(speed) * time,
                            sin * x + cos * y - y,
                        ];
                        farthest = farthest.max(moved[0].hypot(moved[1]));
                    }
                }
                assert!(farthest <= margin, "{turn} {speed}: {farthest} {margin}");
                // A long path with a turn across it reaches less.
                let is_tight = turn <= 0.1 && turn * speed == 0.0;
                assert!(
                    !is_tight || farthest > 0.98 * margin - 1e-12,
                    "{turn} {speed}: {farthest} {margin}"
                );
            }
        }
    }

    #[test]
    fn a_margin_is_up() {
        let shape = rod();
        assert!(shape.swept_margin([0.0; 3], [0.0; 3], 1.0) > 0.0);
        let margin = shape.swept_margin([3.0, 4.0, 12.0], [0.0; 3], -2.0);
        assert!(margin > 26.0 && margin < 26.00001, "{margin}");
        // Half a turn moves a point to the opposite side, and no farther.
        let turned = shape.swept_margin([0.0; 3], [0.0, 99.0, 0.0], 1.0);
        assert!(turned > 2.0 * shape.reach && turned < 2.000_001 * shape.reach);
        assert!(shape.swept_margin([f32::NAN; 3], [0.0; 3], 1.0).is_nan());
        assert!(shape.swept_margin([0.0; 3], [f32::NAN; 3], 1.0).is_nan());
        assert!(shape.swept_margin([f32::MAX; 3], [0.0; 3], 9.0).is_infinite());
    }

    /// Poses turn a far mesh about the origin of its file.
    #[test]
    fn far_meshes_swing() {
        let points = [[1.0e9, 0.0, 0.0], [1.0e9 + 1.0, 0.0, 0.0], [1.0e9, 1.0, 0.0]];
        let mesh = TriangleMesh::from_f64(&points, &[[0, 1, 2]]).unwrap();
        let shape = Shape::build(&mesh, &ShapeSpec::default()).unwrap();
        let margin = shape.swept_margin([0.0; 3], [0.0, 0.0, 1.0e-3], 1.0);
        assert!((1.0e6..1.001e6).contains(&margin), "{margin}");
    }
}
