//! Many bodies that move, against the same ones laid out with all of their images in a world
//! without periods: the same pairs.

use sdop::{Aabb, Bodies, BoxCuller, Culler, Shape};

use super::*;

/// A step of all positions: multiples are exact in f32.
const STEP: f64 = 1.0 / 256.0;

/// Whole numbers of periods by which images are moved: none first.
fn shifts(periods: [Option<f64>; 3]) -> Vec<[i32; 3]> {
    let along = |axis: usize| {
        if periods[axis].is_some() { -1..=1 } else { 0..=0 }
    };
    let all = along(0).flat_map(|x| along(1).flat_map(move |y| along(2).map(move |z| [x, y, z])));
    let mut all: Vec<[i32; 3]> = all.collect();
    all.sort_by_key(|shift| *shift != [0; 3]);
    all
}

fn moved(at: [f64; 3], shift: [i32; 3], periods: [Option<f64>; 3]) -> [f64; 3] {
    [0, 1, 2].map(|axis| at[axis] + f64::from(shift[axis]) * periods[axis].unwrap_or(0.0))
}

/// The pairs of a layout in which body i of the image s is number s·n + i.
fn pairs_of_layout(
    pairs: &[[u32; 2]],
    n: usize,
    shifts: &[[i32; 3]],
) -> Vec<([usize; 2], [i32; 3])> {
    let mut found = Vec::new();
    for pair in pairs {
        let [(i, first), (j, second)] = pair.map(|at| (at as usize % n, at as usize / n));
        // The first as it is, the second moved, or the other way round.
        if first == 0 && i < j {
            found.push(([i, j], shifts[second]));
        } else if first == 0 && j < i {
            found.push(([j, i], shifts[second].map(|s| -s)));
        }
    }
    found.sort_unstable();
    found.dedup();
    found
}

fn reported(pairs: &[PeriodicPair]) -> Vec<([usize; 2], [i32; 3])> {
    let plain = |pair: &PeriodicPair| (pair.bodies.map(BodyId::slot), pair.image);
    pairs.iter().map(plain).collect()
}

/// Moves a position by some steps, and back into the period, in which layouts begin.
fn drift(at: &mut [f64; 3], periods: [Option<f64>; 3], random: &mut Random) {
    for axis in 0..3 {
        at[axis] += (random.below(65) as f64 - 32.0) * STEP;
        if let Some(period) = periods[axis] {
            at[axis] -= (at[axis] / period).floor() * period;
        }
    }
}

#[test]
fn boxes_meet_as_laid_out() {
    let mut random = Random::new(4);
    for (periods, sizes) in subsets([6.0, 7.0, 8.0]).zip([[8, 250], [128, 129]].into_iter().cycle())
    {
        let n = 600;
        let shifts = shifts(periods);
        let mut at: Vec<[f64; 3]> =
            (0..n).map(|_| [6, 7, 8].map(|most| random.below(most * 256) as f64 * STEP)).collect();
        let mut sides = || [(); 3].map(|()| (sizes[0] + random.below(sizes[1])) as f64 * STEP);
        let sides: Vec<[f64; 3]> = (0..n).map(|_| sides()).collect();
        let ends = |at: [f64; 3], side: [f64; 3]| [at, [0, 1, 2].map(|axis| at[axis] + side[axis])];
        let mut boxes = PeriodicBoxes::new(periods).unwrap();
        let bodies = |at: &[[f64; 3]]| -> Vec<PeriodicBox> {
            let ends = at.iter().zip(&sides).map(|(&at, &side)| ends(at, side));
            ends.map(|[min, max]| PeriodicBox::new(min, max)).collect()
        };
        let ids: Vec<BodyId> = bodies(&at).into_iter().map(|b| boxes.insert(b).unwrap()).collect();
        for frame in 0..6 {
            for (id, body) in ids.iter().zip(bodies(&at)) {
                boxes.set(*id, body).unwrap();
            }
            let mut layout = Vec::new();
            for &shift in &shifts {
                let images = at.iter().zip(&sides).map(|(&at, &side)| {
                    let [min, max] = ends(moved(at, shift, periods), side);
                    Aabb::new(min.map(|x| x as f32), max.map(|x| x as f32))
                });
                layout.extend(images);
            }
            let mut culler = BoxCuller::new();
            let wanted = pairs_of_layout(&culler.cull(&layout).unwrap().sorted(), n, &shifts);
            assert_eq!(reported(boxes.cull().unwrap()), wanted, "{periods:?} frame {frame}");
            assert!(wanted.len() > 200);
            // All move, or one in twenty.
            let some = 1 + 19 * (frame % 2);
            for at in at.iter_mut().step_by(some) {
                drift(at, periods, &mut random);
            }
        }
    }
}

fn shapes() -> Vec<Shape> {
    use sdop::ProceduralShape::{Box, Icosphere, Needle};
    let forms = [
        Box { x: 1.0, y: 0.5, z: 0.75 },
        Icosphere { radius: 0.5, subdivisions: 1 },
        Needle { length: 1.5, radius: 0.125, sides: 6 },
    ];
    let build = |form: sdop::ProceduralShape| {
        Shape::build(&form.build().unwrap(), &sdop::ShapeSpec::default()).unwrap()
    };
    forms.map(build).into()
}

/// Translations are exact, so pairs are those of the same tests, the spheres' and the or-DOPs'.
#[test]
fn meshes_meet_as_laid_out() {
    let mut random = Random::new(5);
    for periods in subsets([6.0, 7.0, 8.0]) {
        let n = 240;
        let (shapes, shifts) = (shapes(), shifts(periods));
        let mut world = PeriodicWorld::new(shapes.clone(), periods).unwrap();
        let mut bodies: Vec<Body> = (0..n)
            .map(|_| {
                let at = [6, 7, 8].map(|most| random.below(most * 256) as f64 * STEP);
                let rotation = [(); 4].map(|()| random.within(1.0));
                let is_fixed = random.below(8) == 0;
                let body = Body::at(random.below(3) as u32, rotation, at);
                if is_fixed { body.fixed() } else { body }
            })
            .collect();
        let ids: Vec<BodyId> = bodies.iter().map(|&body| world.insert(body).unwrap()).collect();
        for frame in 0..4 {
            for (id, body) in ids.iter().zip(&bodies) {
                world.set(*id, *body).unwrap();
            }
            let mut layout = Bodies::default();
            for &shift in &shifts {
                for body in &bodies {
                    let at = moved(body.translation, shift, periods).map(|x| x as f32);
                    layout.push(body.shape, body.motion.is_dynamic(), body.rotation, at);
                }
            }
            let mut culler = Culler::new(&shapes, &layout).unwrap();
            let wanted = pairs_of_layout(&culler.cull(&layout).unwrap().sorted(), n, &shifts);
            assert_eq!(reported(world.cull().unwrap()), wanted, "{periods:?} frame {frame}");
            assert!(wanted.len() > 100);
            let some = 1 + 11 * (frame % 2);
            for body in bodies.iter_mut().step_by(some) {
                drift(&mut body.translation, periods, &mut random);
            }
        }
    }
}
