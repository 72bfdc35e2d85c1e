//! From a recipe and a seed to the bodies of a hard case.

use glam::DVec3;
use rand::{Rng, RngExt};
use serde::{Deserialize, Serialize};

use crate::draw::bodies::{ContactSpec, add, probe};
use crate::draw::borders::{Borders, bar_within};
use crate::draw::contact::PlacedShape;
use crate::draw::forms::{self, Form, FormError};
use crate::truth::reference_shapes::Shapes;
use sdop::bodies::Bodies;
use sdop::volume::{Axes, DirectionSet};

/// How bodies are arranged.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Recipe {
    /// One dynamic probe among static partners in contact with it.
    Probe {
        /// Independent frames, each with its own probe.
        frames: usize,
        /// Partners per frame.
        partners: usize,
        /// The first form is the probe and the others are the partners; otherwise any is either.
        #[serde(default)]
        first_is_probe: bool,
    },
    /// Dynamic bodies, each in contact with one before it.
    Chain {
        /// Numbers of bodies, one case for each.
        bodies: Vec<usize>,
        /// How often each pose is taken: coincident bodies.
        #[serde(default = "one")]
        copies: usize,
        /// Copies have different shapes: concentric bodies.
        #[serde(default)]
        stacked: bool,
        /// Frames in which all bodies change places and jump by 2⁴⁰ between the chain's own.
        #[serde(default)]
        jumps: usize,
    },
    /// Balls whose centres differ by 24-bit Pythagorean quadruples, radii adding up to the distance
    /// exactly.
    Quadruples {
        /// Partners of the probe.
        partners: usize,
        /// Moves one coordinate by one ulp outward or inward.
        #[serde(default)]
        nudged: bool,
    },
    /// Bars on the borders between a finder's cells, to a few units in the last place of f64.
    Borders {
        /// Scenes, each a separate run.
        scenes: usize,
        /// How many of them have an extent whose cells a division would count otherwise.
        divided: usize,
        /// The most bodies of a scene.
        most: usize,
    },
    /// Balls on a cubic lattice that is turned by a 24-bit integer quaternion, so that neighbours
    /// touch exactly.
    Lattice {
        /// Balls along each edge.
        edge: usize,
    },
}

fn one() -> usize {
    1
}

/// The cases that a recipe makes: shapes, and runs of frames that one culler sees.
#[derive(Clone, Debug)]
pub struct HardCases {
    /// Their shapes.
    pub shapes: Shapes,
    /// Each run is a list of frames with the same bodies.
    pub runs: Vec<Vec<Bodies>>,
}

impl Recipe {
    /// Makes the cases for one or-DOP: contacts of its faces and edges depend on it.
    ///
    /// # Errors
    /// A form can't be built.
    pub fn cases(
        &self,
        forms: &[Form],
        contacts: &ContactSpec,
        (k, axes): (DirectionSet, Axes),
        rng: &mut impl Rng,
    ) -> Result<HardCases, FormError> {
        let exact = |count: usize, rng: &mut _| {
            let forms: Vec<Form> = forms.iter().cycle().take(count).cloned().collect();
            forms::build(&forms, 1, k, axes, rng)
        };
        match *self {
            Self::Quadruples { partners, nudged } => {
                Ok(quadruples(exact(partners + 1, rng)?, nudged, rng))
            }
            Self::Lattice { edge } => Ok(lattice(exact(1, rng)?, edge, rng)),
            Self::Borders { scenes, divided, most } => {
                let drawn = (0..scenes).map(|n| border(n < divided, most, rng));
                bars(drawn.collect(), k, axes)
            }
            Self::Probe { frames, partners, first_is_probe } => {
                let shapes = forms::build(forms, 2, k, axes, rng)?;
                let run = |n: usize| {
                    let shape = if first_is_probe { 0 } else { n % shapes.built.len() };
                    vec![probe(&shapes, contacts, shape, partners, rng)]
                };
                let runs = (0..frames).map(run).collect();
                Ok(HardCases { shapes, runs })
            }
            Self::Chain { ref bodies, copies, stacked, jumps } => {
                let shapes = forms::build(forms, 2, k, axes, rng)?;
                let run = |&n: &usize| {
                    let first = chain(&shapes, contacts, n, (copies, stacked), rng);
                    jumping(first, jumps)
                };
                let runs = bodies.iter().map(run).collect();
                Ok(HardCases { shapes, runs })
            }
        }
    }
}

fn chain(
    shapes: &Shapes,
    contacts: &ContactSpec,
    n: usize,
    (copies, stacked): (usize, bool),
    rng: &mut impl Rng,
) -> Bodies {
    let mut bodies = Bodies::default();
    let mut placed: Vec<PlacedShape> = Vec::new();
    while bodies.len() < n {
        let shape = rng.random_range(0..shapes.built.len());
        let next = match placed.len() {
            0 => contacts.start(shape, rng),
            before => {
                let first = placed[rng.random_range(0..before)];
                contacts.partner(shapes, &first, shape, rng)
            }
        };
        placed.push(next);
        for copy in 0..copies.min(n - bodies.len()) {
            let shift = if stacked { copy } else { 0 };
            let shape = (shape + shift) % shapes.built.len();
            // Every fifth body is static.
            let dynamic = bodies.len() % 5 != 4;
            add(&mut bodies, &PlacedShape { shape, ..next }, dynamic);
        }
    }
    bodies
}

/// The frame, then for each jump one far away with places exchanged, and the first again. Static
/// bodies stay.
fn jumping(first: Bodies, jumps: usize) -> Vec<Bodies> {
    let mut frames = vec![first.clone()];
    for jump in 0..jumps {
        let mut away = first.clone();
        let movable: Vec<usize> = (0..first.len()).filter(|&i| first.dynamic[i]).collect();
        for (to, from) in movable.iter().zip(movable.iter().rev()) {
            away.rotation[*to] = first.rotation[*from];
            away.translation[*to] = first.translation[*from];
            away.translation[*to][jump % 3] += (1_u64 << 40) as f32;
        }
        frames.extend([away, first.clone()]);
    }
    frames
}

/// (m²+n²−p²−q², 2(mq+np), 2(nq−mp)) and its length m²+n²+p²+q² < 2²⁴, all nearly as long as f32
/// holds.
fn quadruple(rng: &mut impl Rng) -> ([f32; 3], f32) {
    loop {
        let [m, n, p, q]: [i64; 4] = std::array::from_fn(|_| rng.random_range(-2047..=2047));
        let length = m * m + n * n + p * p + q * q;
        if (1 << 22..1 << 24).contains(&length) {
            let d = [m * m + n * n - p * p - q * q, 2 * (m * q + n * p), 2 * (n * q - m * p)];
            return (d.map(|x| x as f32), length as f32); // exact: below 2²⁴
        }
    }
}

/// Every pair of the probe and a partner touches, exactly (unless nudged); the bounding balls are
/// set, not computed.
fn quadruples(mut shapes: Shapes, nudged: bool, rng: &mut impl Rng) -> HardCases {
    let mut bodies = Bodies::default();
    let last = shapes.built.len() - 1;
    let radius = rng.random_range(1 << 19..1 << 20) as f32;
    set_radius(&mut shapes, last, radius);
    let at_rest = |shape: usize, translation: [f32; 3]| PlacedShape {
        shape,
        rotation: [0.0, 0.0, 0.0, 1.0],
        translation,
    };
    for partner in 0..last {
        let (mut d, length) = quadruple(rng);
        set_radius(&mut shapes, partner, length - radius);
        let axis = rng.random_range(0..3);
        if nudged {
            d[axis] =
                if rng.random_range(0..2) == 0 { d[axis].next_up() } else { d[axis].next_down() };
        }
        add(&mut bodies, &at_rest(partner, d), false);
    }
    add(&mut bodies, &at_rest(last, [0.0; 3]), true);
    HardCases { shapes, runs: vec![vec![bodies]] }
}

fn set_radius(shapes: &mut Shapes, shape: usize, radius: f32) {
    shapes.built[shape].ball.radius = radius;
    shapes.judged[shape].ball.radius = radius;
    let wider = f64::from(radius) * (1.0 + 15.0 * sdop::rounding::U);
    shapes.widened[shape].ball.radius = sdop::rounding::up(wider);
}

/// A scene on the borders between cells.
fn border(divides: bool, most: usize, rng: &mut impl Rng) -> Borders {
    loop {
        let scene = Borders::draw(&mut |below| rng.random_range(0..below));
        if scene.bodies.len() <= most && (scene.divides || !divides) {
            return scene;
        }
    }
}

/// The scenes as cases of one list of shapes, two per scene.
fn bars(scenes: Vec<Borders>, k: DirectionSet, axes: Axes) -> Result<HardCases, FormError> {
    let (mut built, mut runs) = (Vec::new(), Vec::new());
    for mut scene in scenes {
        let first = built.len() as u32;
        scene.bodies.shape.iter_mut().for_each(|shape| *shape += first);
        for radius in scene.radii {
            built.push(bar_within(radius, k, axes).map_err(|error| FormError::of("bar", error))?);
        }
        runs.push(vec![scene.bodies]);
    }
    let shapes = Shapes::new(built).map_err(|error| FormError::of("bar", error))?;
    Ok(HardCases { shapes, runs })
}

fn lattice(mut shapes: Shapes, edge: usize, rng: &mut impl Rng) -> HardCases {
    // The columns of R(q)|q|² are three quadruples of one length, exactly orthogonal.
    let (columns, length) = loop {
        let q: [i32; 4] = std::array::from_fn(|_| rng.random_range(-1023..=1023));
        let [x, y, z, w] = q.map(f64::from);
        let length = x * x + y * y + z * z + w * w;
        if length > 2_f64.powi(20) && length < 2_f64.powi(21) {
            let matrix = glam::DMat3::from_quat(glam::DQuat::from_xyzw(x, y, z, w).normalize());
            let exact = |c: DVec3| (c * length).round();
            break ([matrix.x_axis, matrix.y_axis, matrix.z_axis].map(exact), length);
        }
    };
    set_radius(&mut shapes, 0, (length / 2.0) as f32);
    let mut bodies = Bodies::default();
    let middle = edge as f64 / 2.0;
    for cell in 0..edge.pow(3) {
        let along = [cell % edge, cell / edge % edge, cell / edge / edge];
        let [i, j, k] = along.map(|x| (x as f64 - middle).floor());
        let centre = columns[0] * i + columns[1] * j + columns[2] * k;
        let placed = PlacedShape {
            shape: 0,
            rotation: [0.0, 0.0, 0.0, 1.0],
            translation: centre.as_vec3().to_array(),
        };
        add(&mut bodies, &placed, true);
    }
    HardCases { shapes, runs: vec![vec![bodies]] }
}
