//! zelll: a CellGrid of the bodies' origins with twice the radius as its cutoff.

use adapters::{Frame, serve};
use zelll::CellGrid;

fn main() {
    serve("zelll", || {
        |frame: &Frame| {
            let balls = frame
                .bodies
                .iter()
                .map(|body| frame.shapes[body.shape].ball.map(f64::from));
            // If balls are off the origins, more pairs than needed are found, which is no failure.
            let far = |[x, y, z, radius]: [f64; 4]| match (x * x + y * y + z * z).sqrt() {
                0.0 => radius,
                offset => (offset.next_up() + radius).next_up(),
            };
            let radius = balls.map(far).fold(0.0, f64::max);
            if frame.bodies.is_empty() {
                return Ok(Vec::new());
            }
            if radius <= 0.0 {
                return Err("its cutoff must be above zero");
            }
            let place = |pose: &[f32; 7]| [4, 5, 6].map(|axis| f64::from(pose[axis]));
            let points = frame.ids.iter().copied().zip(frame.poses.iter().map(place));
            let cells = CellGrid::new(points, 2.0 * radius);
            Ok(cells
                .particle_pairs()
                .map(|((a, _), (b, _))| [*a, *b])
                .collect())
        }
    });
}
