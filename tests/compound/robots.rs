//! Random trees of parts against the exact meshes of all parts.

use std::collections::BTreeSet;

use sdop::settings::{CullSettings, Strategy};
use sdop::{Culler, Motion};
use sdop_reference::wide::meet;

use super::*;

struct Scene {
    world: World,
    compounds: Vec<(u32, Compound)>,
    /// The parts of each shape number.
    parts: Vec<Vec<Part>>,
    meshes: Vec<sdop_reference::Shape>,
    /// The radius of a ball about each mesh's origin.
    sizes: Vec<f64>,
}

impl Scene {
    /// Two compounds and a shape alone.
    fn new(
        strategy: Strategy,
        directions: DirectionSet,
        at: [f64; 3],
        random: &mut Random,
    ) -> Self {
        let shapes = shapes(directions);
        let trees = [7, 30].map(|count| tree(count, shapes.len(), random));
        let compounds: Vec<(u32, Compound)> = (0..)
            .zip(&trees)
            .map(|(number, tree)| (number, Compound::build("tree", &shapes, tree).unwrap()))
            .collect();
        let mut all: Vec<Shape> = compounds.iter().map(|(_, c)| c.shape().clone()).collect();
        all.push(shapes[0].clone());
        let settings = CullSettings { strategy, ..CullSettings::default() };
        let mut world = World::with(all, &Culler::builder().settings(&settings)).unwrap();
        for number in 0..40 {
            world.insert(body(number, at, random)).unwrap();
        }
        world.cull().unwrap();
        let [small, large] = trees;
        Self {
            world,
            compounds,
            parts: vec![small, large, vec![Part::default()]],
            meshes: shapes.iter().map(reference).collect(),
            sizes: shapes.iter().map(|shape| f64::from(shape.reach)).collect(),
        }
    }

    /// All pairs of parts that meet in exact arithmetic.
    fn truth(&self) -> BTreeSet<PartPair> {
        let bodies: Vec<_> = self.world.bodies().collect();
        let placed: Vec<Vec<_>> = bodies
            .iter()
            .map(|(_, body)| {
                let parts = self.parts[body.shape as usize].iter();
                let place = |part: &Part| (part.shape as usize, composed(body, part));
                parts.map(place).collect()
            })
            .collect();
        let mut meeting = BTreeSet::new();
        for (i, (a, one)) in bodies.iter().enumerate() {
            for (j, (b, other)) in bodies.iter().enumerate().skip(i + 1) {
                if !one.motion.is_dynamic() && !other.motion.is_dynamic() {
                    continue;
                }
                for (m, (shape, (pose, at))) in placed[i].iter().enumerate() {
                    for (n, (of_other, (there, to))) in placed[j].iter().enumerate() {
                        let reach = self.sizes[*shape] + self.sizes[*of_other];
                        let apart = distance(*at, *to);
                        let [own, others] = [&self.meshes[*shape], &self.meshes[*of_other]];
                        if apart <= 1.01 * reach && meet((own, pose), (others, there)).meets {
                            meeting.insert(pair(*a, *b, [m as u32, n as u32]));
                        }
                    }
                }
            }
        }
        meeting
    }
}

fn body(number: usize, at: [f64; 3], random: &mut Random) -> Body {
    let near = |x: f64, random: &mut Random| x + (random.below(16_384) as f64 - 8_192.0) * STEP;
    Body {
        shape: (number % 3) as u32,
        motion: if number.is_multiple_of(5) { Motion::Fixed } else { Motion::Dynamic },
        rotation: whole_rotation(random).map(|x| x as f32),
        translation: at.map(|x| near(x, random)),
        ..Body::default()
    }
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    let square = |axis: usize| (a[axis] - b[axis]) * (a[axis] - b[axis]);
    (square(0) + square(1) + square(2)).sqrt()
}

/// Checks the pairs of parts of a scene against exact truth.
fn check(scene: &Scene) {
    let found = afresh(&scene.world, &scene.compounds);
    assert!(found.is_sorted_by(|a, b| a < b), "sorted, and each once");
    let wanted = scene.truth();
    let missed = wanted.iter().find(|pair| found.binary_search(pair).is_err());
    assert_eq!(missed, None, "missed");
    assert!(wanted.len() > 100, "{} pairs", wanted.len());
    assert!(found.len() <= 2 * wanted.len(), "{} of {}", wanted.len(), found.len());
}

/// Parts that meet are reported, and few others.
#[test]
fn meeting_parts_are_reported() {
    let mut random = Random(1);
    for directions in DIRECTIONS {
        for at in [[0.0; 3], [1.0e9, -7.0e8, 0.25]] {
            let strategy = CullSettings::default().strategy;
            check(&Scene::new(strategy, directions, at, &mut random));
        }
    }
}

/// The same in worlds of every strategy that reports all pairs.
#[test]
fn every_strategy_has_parts() {
    let mut random = Random(2);
    for strategy in forms::strategies_that_report_all() {
        let scene = Scene::new(strategy, DirectionSet::K18, [0.0; 3], &mut random);
        check(&scene);
    }
}
