//! Bodies of a world against exact meshes at exact poses.

use sdop::query::QueryShape;
use sdop::volume::DirectionSet;
use sdop::{Body, BodyId, Line, Motion, QueryIndex, QueryVolume, Shape, World};
use sdop_reference::Pose;
use sdop_reference::exact::meeting::meet;
use sdop_reference::exact::query::{ExactLine, ball_meets_mesh, is_no_later, line_meets_mesh};

use crate::queries::forms::BOX_FACES;
use crate::queries::{UNTURNED, contains, cube, mesh, reference, shapes, tiers};
use sdop_judge::draw::random::Random;

fn pose_of(body: &Body) -> Pose {
    Pose::from_f64(body.rotation, body.translation).unwrap()
}

struct Scene {
    shapes: Vec<Shape>,
    meshes: Vec<sdop_reference::Shape>,
    bodies: Vec<(BodyId, Body)>,
    index: QueryIndex,
    /// How far each shape reaches from its origin.
    sizes: Vec<f64>,
    /// Where it is.
    at: [f64; 3],
}

impl Scene {
    fn new(shapes: Vec<Shape>, at: [f64; 3], count: usize, random: &mut Random) -> Self {
        let mut world = World::new(shapes.clone()).unwrap();
        for n in 0..count {
            let body = Body {
                shape: random.below(shapes.len()) as u32,
                motion: if n % 3 > 0 { Motion::Dynamic } else { Motion::Fixed },
                rotation: [(); 4].map(|()| random.within(1.0)),
                translation: near(at, 4.0, random),
                ..Body::default()
            };
            world.insert(body).unwrap();
        }
        let mut index = QueryIndex::new();
        index.update(&world);
        Self {
            meshes: shapes.iter().map(reference).collect(),
            sizes: shapes.iter().map(|shape| f64::from(shape.reach)).collect(),
            bodies: world.bodies().collect(),
            index,
            shapes,
            at,
        }
    }

    /// Whether a body may be within `reach` of a point. The exact tests are slow, and most bodies
    /// are certainly farther away.
    fn is_near(&self, body: &Body, point: [f64; 3], reach: f64) -> bool {
        let size = self.sizes[body.shape as usize];
        distance(body.translation, point) <= 1.01 * (size + reach) + 0.01
    }

    /// Checks what was found against the truth; returns how many there had to be, and how many
    /// there are. What may meet a body is within `reach` of `point`.
    fn check(
        &self,
        found: &[BodyId],
        (point, reach): ([f64; 3], f64),
        meets: impl Fn(&sdop_reference::Shape, &Pose) -> bool,
    ) -> [usize; 2] {
        let mut required = 0;
        for (id, body) in &self.bodies {
            if self.is_near(body, point, reach)
                && meets(&self.meshes[body.shape as usize], &pose_of(body))
            {
                assert!(contains(found, *id), "{body:?} is missed");
                required += 1;
            }
        }
        [required, found.len()]
    }
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    let square = |axis: usize| (a[axis] - b[axis]) * (a[axis] - b[axis]);
    (square(0) + square(1) + square(2)).sqrt()
}

fn near(at: [f64; 3], reach: f32, random: &mut Random) -> [f64; 3] {
    at.map(|x| x + f64::from(random.within(reach)))
}

fn scenes(seed: u64) -> impl Iterator<Item = (Scene, Random)> {
    let ways = [DirectionSet::K6, DirectionSet::K14, DirectionSet::K18, DirectionSet::K26];
    let places = [[0.0; 3], [1.0e9 + 0.1, -7.0e8, 0.3]];
    ways.into_iter().enumerate().flat_map(move |(n, directions)| {
        places.map(|at| {
            let mut random = Random::new(seed + n as u64);
            (Scene::new(shapes(directions), at, 60, &mut random), random)
        })
    })
}

/// Checks that enough was to be found, and that not much else was.
fn assert_tight([required, found]: [usize; 2]) {
    assert!(required > 30, "{required} of {found}");
    assert!(2 * found <= 5 * required, "{required} of {found}");
}

fn add(sum: &mut [usize; 2], [required, found]: [usize; 2]) {
    *sum = [sum[0] + required, sum[1] + found];
}

/// Meshes that meet a ball are found.
#[test]
fn ball_finds_meshes() {
    for (scene, mut random) in scenes(1) {
        let mut sum = [0; 2];
        for _ in 0..120 {
            let centre = near(scene.at, 4.0, &mut random);
            let radius = f64::from(random.unit());
            let ball = QueryVolume::Ball { centre, radius };
            let found = scene.index.touching(&ball).unwrap();
            for index in tiers(&scene.index) {
                assert_eq!(index.touching(&ball).unwrap(), found);
            }
            let meets = |mesh: &_, pose: &_| ball_meets_mesh(centre, radius, mesh, pose);
            add(&mut sum, scene.check(&found, (centre, radius), meets));
        }
        assert_tight(sum);
    }
}

/// The box between two corners, about the first.
fn box_mesh(size: [f32; 3]) -> sdop_reference::Shape {
    let corner = |n: u32| [0, 1, 2].map(|axis| (n >> axis & 1) as f32 * size[axis]);
    mesh((0..8).map(corner).collect(), BOX_FACES.into())
}

/// Meshes that meet a box are found.
#[test]
fn box_finds_meshes() {
    for (scene, mut random) in scenes(2) {
        let mut sum = [0; 2];
        for _ in 0..120 {
            let size = [(); 3].map(|()| random.unit());
            let min = near(scene.at, 4.0, &mut random);
            let max = [0, 1, 2].map(|axis| min[axis] + f64::from(size[axis]));
            // Exact, since the mesh of the truth is placed at `min` and as long as the rest says.
            let size = [0, 1, 2].map(|axis| (max[axis] - min[axis]) as f32);
            if (0..3).any(|axis| min[axis] + f64::from(size[axis]) != max[axis]) {
                continue;
            }
            let found = scene.index.touching(&QueryVolume::Box { min, max }).unwrap();
            let (asked, at) = (box_mesh(size), Pose::from_f64(UNTURNED, min).unwrap());
            let meets = |mesh: &sdop_reference::Shape, pose: &Pose| {
                meet((asked.mesh(), &at), (mesh.mesh(), pose)).meets
            };
            add(&mut sum, scene.check(&found, (min, distance(min, max)), meets));
        }
        assert_tight(sum);
    }
}

/// Meshes that meet a posed mesh are found.
#[test]
fn posed_mesh_finds_meshes() {
    for (scene, mut random) in scenes(3) {
        let asked: Vec<QueryShape> = scene.shapes.iter().map(QueryShape::new).collect();
        let mut sum = [0; 2];
        for n in 0..40 {
            let shape = n % asked.len();
            let rotation = [(); 4].map(|()| random.within(1.0));
            let translation = near(scene.at, 4.0, &mut random);
            let volume =
                QueryVolume::Shape { shape: &asked[shape], rotation, translation, margin: 0.0 };
            let found = scene.index.touching(&volume).unwrap();
            let at = Pose::from_f64(rotation, translation).unwrap();
            let meets = |mesh: &sdop_reference::Shape, pose: &Pose| {
                meet((scene.meshes[shape].mesh(), &at), (mesh.mesh(), pose)).meets
            };
            add(&mut sum, scene.check(&found, (translation, scene.sizes[shape]), meets));
        }
        assert_tight(sum);
    }
}

/// Meshes along a line are found before they are met.
#[test]
fn line_finds_meshes() {
    for (scene, mut random) in scenes(4) {
        let mut sum = [0; 2];
        for n in 0..60 {
            let from = near(scene.at, 6.0, &mut random);
            let to = near(scene.at, 4.0, &mut random);
            let direction = [(); 3].map(|()| f64::from(random.within(1.0)));
            let (line, exact) = if n % 3 > 0 {
                (Line::Segment { from, to }, ExactLine::segment(from, to))
            } else {
                let origin = from;
                (Line::Ray { origin, direction }, ExactLine::ray(from, direction))
            };
            let hits = scene.index.along(&line).unwrap();
            assert_eq!(scene.index.first(&line).unwrap(), hits.first().copied());
            let mut found: Vec<BodyId> = hits.iter().map(|hit| hit.body).collect();
            found.sort();
            // Exact, and so slow: once per body.
            let end = if n % 3 > 0 {
                to
            } else {
                // Farther than any body.
                let speed = distance(direction, [0.0; 3]).max(1e-3);
                [0, 1, 2].map(|axis| from[axis] + 40.0 / speed * direction[axis])
            };
            let near_line = scene.bodies.iter().filter(|(_, body)| {
                let way = [0, 1, 2].map(|axis| end[axis] - from[axis]);
                let to_body = [0, 1, 2].map(|axis| body.translation[axis] - from[axis]);
                let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
                let s = (dot(way, to_body) / dot(way, way)).clamp(0.0, 1.0);
                let nearest = [0, 1, 2].map(|axis| from[axis] + s * way[axis]);
                scene.is_near(body, nearest, 0.0)
            });
            let truth = near_line.map(|(id, body)| {
                let mesh = &scene.meshes[body.shape as usize];
                (*id, line_meets_mesh(&exact, mesh, &pose_of(body)))
            });
            let truth: Vec<_> = truth.filter_map(|(id, at)| Some((id, at?))).collect();
            for (id, _) in &truth {
                assert!(contains(&found, *id), "{line:?} misses {id:?}");
            }
            add(&mut sum, [truth.len(), found.len()]);
            // The first by exact judgement, and by bounds that come before it.
            let judge = |id: BodyId| {
                let met = truth.iter().find(|(other, _)| *other == id);
                met.map(|(_, at)| at.clone())
            };
            for hit in &hits {
                if let Some(at) = judge(hit.body) {
                    assert!(is_no_later(hit.at, &at), "{hit:?}");
                }
            }
            let judged = |hit: sdop::query::LineHit| judge(hit.body).map(|at| at.to_f64_fast());
            let first = scene.index.first_judged(&line, judged).unwrap();
            let wanted = truth.iter().map(|(id, at)| (at, *id));
            assert_eq!(first.map(|hit| hit.body), wanted.min().map(|(_, id)| id));
        }
        assert_tight(sum);
    }
}

/// A cube with faces at ±1, turned by quarters about its axes, far from the origin: what touches a
/// face, an edge or a corner in exact arithmetic.
#[test]
fn touching_to_the_bit_is_found() {
    let turns = [UNTURNED, [0.0, 0.0, 3.0, 3.0], [0.7, 0.7, 0.7, 0.7], [0.0, 0.1, 0.0, -0.1]];
    let asked = QueryShape::new(&cube());
    for at in [[0.0; 3], [1.0e9 + 0.1, 0.3, -7.0e12], [1.0 / 3.0, -1.0e-3, 0.7]] {
        for rotation in turns {
            let mut world = World::new(vec![cube()]).unwrap();
            world.insert(Body::at(0, rotation, at)).unwrap();
            let mut index = QueryIndex::new();
            index.update(&world);
            let pose = Pose::from_f64(rotation, at).unwrap();
            let mesh = reference(&cube());
            let away = |v: [f64; 3]| [0, 1, 2].map(|axis| at[axis] + v[axis]);
            let mut touched = 0;
            let ball = |centre, radius| QueryVolume::Ball { centre, radius };
            for (off, radius) in [
                ([3.0, 0.5, 0.25], 2.0),
                ([0.5, -3.0, 0.25], 2.0),
                ([3.0, 4.0, 7.0], 7.0),
                ([-1.0, 1.0, 1.0], 0.0),
                ([4.0, 5.0, 0.0], 5.0),
            ] {
                let centre = away(off);
                if ball_meets_mesh(centre, radius, &mesh, &pose) {
                    touched += 1;
                    let found = index.touching(&ball(centre, radius)).unwrap();
                    assert_eq!(found.len(), 1, "{at:?} {off:?}");
                }
                // No slab separates a corner from a ball that is much larger than the cube.
                let apart = ball(away(off.map(|x| 1.01 * x)), radius);
                if radius <= 2.0 {
                    assert_eq!(index.touching(&apart).unwrap(), [], "{at:?} {off:?}");
                }
            }
            for (from, to) in [
                ([3.0, 0.5, 0.25], [1.0, 0.5, 0.25]),
                ([3.0, 1.0, 0.0], [-3.0, 1.0, 0.0]),
                ([2.0, 0.0, 0.25], [0.0, 2.0, 0.25]),
                ([3.0, -1.0, 1.0], [-1.0, 3.0, 1.0]),
                ([1.0, 1.0, 1.0], [1.0, 1.0, 1.0]),
            ] {
                let [from, to] = [from, to].map(away);
                let line = Line::Segment { from, to };
                let exact = line_meets_mesh(&ExactLine::segment(from, to), &mesh, &pose);
                if let Some(exact) = exact {
                    touched += 1;
                    let hit = index.first(&line).unwrap().expect("it touches");
                    assert!(is_no_later(hit.at, &exact));
                }
            }
            for off in [[2.0, 0.3, 0.1], [2.0, 2.0, 0.5], [-2.0, 2.0, 2.0]] {
                let there = Pose::from_f64(rotation, away(off)).unwrap();
                if meet((mesh.mesh(), &there), (mesh.mesh(), &pose)).meets {
                    touched += 1;
                    let volume = QueryVolume::Shape {
                        shape: &asked,
                        rotation,
                        translation: away(off),
                        margin: 0.0,
                    };
                    assert_eq!(index.touching(&volume).unwrap().len(), 1, "{at:?} {off:?}");
                }
            }
            assert!(touched >= 2, "{at:?}: {touched}");
            if at == [0.0; 3] {
                assert_eq!(touched, 13);
            }
        }
    }
}

#[test]
fn margins_of_both_sides_count() {
    let mut world = World::new(vec![cube()]).unwrap();
    let body = world.insert(Body { margin: 0.5, ..Body::default() }).unwrap();
    let mut index = QueryIndex::new();
    index.update(&world);
    let asked = QueryShape::new(&cube());
    for (distance, is_near) in [(3.0, true), (3.01, false)] {
        let at = [distance, 0.0, 0.0];
        let shape = |margin| QueryVolume::Shape {
            shape: &asked,
            rotation: UNTURNED,
            translation: at,
            margin,
        };
        let wanted: &[BodyId] = if is_near { &[body] } else { &[] };
        assert_eq!(index.touching(&shape(0.5)).unwrap(), wanted);
        assert_eq!(index.touching(&shape(0.0)).unwrap(), []);
        let ball = QueryVolume::Ball { centre: at, radius: 1.5 };
        assert_eq!(index.touching(&ball).unwrap(), wanted);
        let min = [distance - 1.5, -1.0, -1.0];
        let of_box = QueryVolume::Box { min, max: [9.0; 3] };
        assert_eq!(index.touching(&of_box).unwrap(), wanted);
        let line = Line::Ray { origin: [distance - 1.5, 9.0, 0.0], direction: [0.0, -1.0, 0.0] };
        assert_eq!(index.along(&line).unwrap().len(), wanted.len());
    }
}

/// A mesh far from its own origin is where its file says, turned about that origin.
#[test]
fn far_meshes_are_where_they_are() {
    let far = 1_000_000_031.5;
    let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let points = corners.map(|c: [f64; 3]| [far + c[0], 0.25 + c[1], c[2] - far]);
    let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    let mesh = sdop::TriangleMesh::from_f64(&points, &faces).unwrap();
    let spec = sdop::ShapeSpec { axes: sdop::Axes::Model, ..sdop::ShapeSpec::default() };
    let shape = Shape::build(&mesh, &spec).unwrap();
    let mut world = World::new(vec![shape.clone()]).unwrap();
    // A quarter turn about z takes (x, y) to (−y, x).
    world.insert(Body::at(0, [0.0, 0.0, 1.0, 1.0], [0.5, 0.0, 0.0])).unwrap();
    let mut index = QueryIndex::new();
    index.update(&world);
    let at = |p: [f64; 3]| QueryVolume::Ball { centre: [0.5 - p[1], p[0], p[2]], radius: 0.0 };
    for point in points {
        assert_eq!(index.touching(&at(point)).unwrap().len(), 1);
        let beside = [point[0] - 0.5, point[1], point[2]];
        let is_out = point[0] == far;
        assert_eq!(index.touching(&at(beside)).unwrap().is_empty(), is_out);
    }
    let asked = QueryShape::new(&shape);
    for (shift, count) in [(0.9, 1), (1.1, 0)] {
        let volume = QueryVolume::Shape {
            shape: &asked,
            rotation: [0.0, 0.0, 1.0, 1.0],
            translation: [0.5, shift, 0.0],
            margin: 0.0,
        };
        assert_eq!(index.touching(&volume).unwrap().len(), count, "{shift}");
    }
}
