//! Draws histories: bodies that touch to the last place, and a few changes per frame. The kinds of
//! change take turns. One function, "a number below n", makes all other choices, so that a fuzzer's
//! bytes can make them, too.

use rand::SeedableRng as _;
use rand_chacha::ChaCha8Rng;

use super::places::{REGIONS, drifted, place, placed};
use super::worlds::Properties;
use super::{Change, ChangeKind, History, HistoryError, WorldKind};
use crate::draw::bodies::{ContactSpec, TurnKind};
use crate::draw::boxes::beside;
use crate::draw::contact::PlacedShape;
use crate::draw::forms::{Form, build};
use crate::truth::reference_shapes::Shapes;
use sdop::bodies::Aabb;
use sdop::boxes::BoxBody;
use sdop::mesh::TriangleMesh;
use sdop::volume::{Axes, DirectionSet, Shape, ShapeSpec};
use sdop::world::Body;
use sdop::{Groups, Motion};

/// Bodies at first. With as many, a few changes per frame leave the others' pairs as they are.
const FIRST: [usize; 2] = [32, 64];
/// Frames: each kind of change comes twice.
const FRAMES: usize = 2 * ChangeKind::ALL.len();
/// Contact margins that are drawn, the last one larger than bodies.
pub(super) const MARGINS: [f32; 4] = [0.0, 0.1, 0.25, 3.0];
/// The number of those that are smaller than bodies.
pub(super) const SMALL_MARGINS: usize = 3;
/// Sides of drawn boxes.
const SIDES: [[f32; 3]; 7] = [
    [1.0, 1.0, 1.0],
    [0.25, 2.0, 8.0],
    [0.0, 1.0, 1.0],
    [6.0, 6.0, 0.5],
    [0.0; 3],
    [64.0; 3],
    [0.125, 32.0, 32.0],
];
/// The number of those that are at most 8 long.
const SHORT_SIDES: usize = 4;
/// Where a mesh is about its own origin that is far from it.
const FAR: [f64; 3] = [16_777_216.0, -8_388_608.0, 4_194_304.25];

/// Units of boxes, and where they are.
const UNITS: [(i32, [f32; 3]); 5] =
    [(0, [0.0; 3]), (0, [0.0; 3]), (0, [1.0e6, -3.0e5, 7.0]), (-70, [0.0; 3]), (50, [0.0; 3])];

/// Quaternions of bodies, up to the order and the signs of their components.
pub(super) const ROTATIONS: [[f32; 4]; 10] = [
    [0.0, 0.0, 0.0, 1.0],
    [0.0, 0.0, 1.0, 1.0],
    [1.0, 1.0, 1.0, 1.0],
    [0.0, 1.0, 1.0, 1.0],
    [1.0, 1.0, 2.0, 3.0],
    [0.0, 1.0, 2.0, 4.0],
    [0.0, 1.0, 2.0, 10.0],
    [1.0, 2.0, 6.0, 8.0],
    [2.0, 2.0, 4.0, 9.0],
    [2.0, 4.0, 6.0, 7.0],
];

/// Those whose matrices are of zeros and ones.
const QUARTER_TURNS: &[[f32; 4]] = ROTATIONS.split_at(3).0;

/// A quaternion of one of these kinds, in any order, with any signs, times a power of two.
pub(super) fn draw_rotation(
    kinds: &[[f32; 4]],
    below: &mut (impl FnMut(u32) -> u32 + ?Sized),
) -> [f32; 4] {
    let mut q = kinds[below(kinds.len() as u32) as usize];
    for last in (1..4).rev() {
        q.swap(last, below(last as u32 + 1) as usize);
    }
    let scale = [1.0, 1.0, 2_f32.powi(40), 2_f32.powi(-40)][below(4) as usize];
    q.map(|x| if below(2) == 0 { scale * x } else { -scale * x })
}

/// A step to either side or none, from a whole unit to an eighth of a thousandth of it.
fn drift(below: &mut dyn FnMut(u32) -> u32) -> f32 {
    (below(3) as f32 - 1.0) * 2.0_f32.powi(-(below(14) as i32))
}

/// The shapes of histories of meshes, of sizes that a seed draws; the last one may be far from its
/// own origin.
///
/// # Errors
/// As [`build`].
pub fn history_shapes(
    (k, axes): (DirectionSet, Axes),
    seed: u64,
    is_far: bool,
) -> Result<Shapes, HistoryError> {
    let offset =
        Form { radius: None, offset: Some([4.5, -0.3, 0.4]), ..Form::of("l-shape", [0.0; 2]) };
    let plain = ["box", "icosphere", "tetrahedron"].map(|name| Form::of(name, [-0.5, 0.5]));
    let forms: Vec<Form> = plain.into_iter().chain([offset]).collect();
    let mut shapes = build(&forms, 1, k, axes, &mut ChaCha8Rng::seed_from_u64(seed))?;
    if is_far {
        let near = &shapes.built[2];
        let far = |vertex: &[f32; 3]| [0, 1, 2].map(|axis| f64::from(vertex[axis]) + FAR[axis]);
        let points: Vec<[f64; 3]> = near.vertices.iter().map(far).collect();
        let mesh = TriangleMesh::from_f64(&points, &near.triangles)?;
        let spec = ShapeSpec { directions: k, axes, ..ShapeSpec::default() };
        shapes.built.push(Shape::build(&mesh, &spec)?);
        shapes = Shapes::new(shapes.built)?;
    }
    Ok(shapes)
}

/// A history of given boxes, of any length and anywhere, or at most 8 long and near the origin.
/// `below(n)` draws a number below n.
pub fn draw_boxes(is_wide: bool, below: &mut impl FnMut(u32) -> u32) -> History<BoxBody> {
    let (unit, at) = UNITS[if is_wide { below(UNITS.len() as u32) as usize } else { 0 }];
    let (unit, lengths) = (2.0_f32.powi(unit), if is_wide { SIDES.len() } else { SHORT_SIDES });
    let new = |others: &[BoxBody], below: &mut dyn FnMut(u32) -> u32| {
        let sides = SIDES[below(lengths as u32) as usize].map(|side| side * unit);
        let free = at.map(|at| at + unit * (below(1 << 16) as f32 / (1 << 13) as f32));
        let placed = Aabb::new(free, [0, 1, 2].map(|axis| free[axis] + sides[axis]));
        let bounds = match other(others, below) {
            Some(other) if below(4) > 0 => beside(&other.bounds, sides, &mut |n| below(n)),
            _ => placed,
        };
        BoxBody { bounds, motion: motion(below), groups: groups(below) }
    };
    let moved = |from: &BoxBody, to: &BoxBody, part: u32, below: &mut dyn FnMut(u32) -> u32| {
        let mut bounds = from.bounds;
        if part == DRIFT {
            for axis in 0..3 {
                let by = drift(below) * unit;
                (bounds.min[axis], bounds.max[axis]) =
                    (bounds.min[axis] + by, bounds.max[axis] + by);
            }
            return BoxBody { bounds, ..*from };
        }
        for axis in (0..3).filter(|axis| part == 0 || part == 1 + axis % 2) {
            let axis = axis as usize;
            (bounds.min[axis], bounds.max[axis]) = (to.bounds.min[axis], to.bounds.max[axis]);
        }
        BoxBody { bounds, ..*from }
    };
    let kinds = ChangeKind::ALL.iter().copied().filter(|change| WorldKind::Boxes.has(*change));
    draw(&kinds.collect::<Vec<_>>(), new, moved, |body, _, _| body, below)
}

/// A history of meshes in these shapes. With those that are far from their own origins, all turns
/// are by quarters, so that exact places can be told.
pub fn draw_meshes(shapes: &Shapes, below: &mut impl FnMut(u32) -> u32) -> History<Body> {
    let spec = ContactSpec {
        turn: [TurnKind::Any, TurnKind::Quarter, TurnKind::Identity][below(3) as usize],
        ..ContactSpec::default()
    };
    let near = shapes.built.iter().take_while(|shape| shape.pose_offset == [0.0; 3]).count();
    let drawn = &shapes.built[..if below(2) == 0 { near } else { shapes.built.len() }];
    // In most histories all bodies are in one region.
    let regions = [(0, 1), (0, 1), (1, 1), (0, REGIONS.len())][below(4) as usize];
    let new = |others: &[Body], below: &mut dyn FnMut(u32) -> u32| {
        let mut rng = ChaCha8Rng::seed_from_u64(u64::from(below(u32::MAX)));
        let shape = below(drawn.len() as u32) as usize;
        let partner = other(others, below).filter(|_| below(8) > 0);
        let (number, first) = match &partner {
            Some(body) => {
                let (number, within) = place(drawn, body);
                let translation = within.map(|x| x as f32);
                let (shape, rotation) = (body.shape as usize, body.rotation);
                (number, PlacedShape { shape, rotation, translation })
            }
            None => {
                // Now and then so far out that it moves the middle of all.
                let step = if below(8) == 0 { 32.0 } else { 0.125 };
                let translation = [(); 3].map(|()| step * below(64) as f32);
                let number = regions.0 + below(regions.1 as u32) as usize;
                (number, PlacedShape { translation, ..spec.start(shape, &mut rng) })
            }
        };
        let rotation = match (drawn.len() > near, &partner) {
            (true, _) => draw_rotation(QUARTER_TURNS, below),
            (false, Some(_)) => spec.turn.second(first.rotation, &mut rng),
            (false, None) => first.rotation,
        };
        let contact = partner.map(|_| spec.contact(&mut rng));
        let within = contact.and_then(|contact| contact.place(shapes, &first, shape, rotation));
        let body = Body::at(shape as u32, rotation, [0.0; 3]);
        let within = within.unwrap_or(first.translation).map(f64::from);
        with_properties(placed(drawn, body, (number, within)), &MARGINS, below)
    };
    draw_bodies(drawn, &MARGINS, new, below)
}

/// The part of a pose, or of ends, that a drifting body has of another: none.
const DRIFT: u32 = 3;

/// A history of bodies in these shapes, with these margins, each body drawn by `new` next to
/// others.
pub(super) fn draw_bodies(
    shapes: &[Shape],
    margins: &[f32],
    new: impl Fn(&[Body], &mut dyn FnMut(u32) -> u32) -> Body,
    below: &mut dyn FnMut(u32) -> u32,
) -> History<Body> {
    let moved = |from: &Body, to: &Body, part: u32, below: &mut dyn FnMut(u32) -> u32| {
        let (number, within) = place(shapes, from);
        let rotation = if part < 2 { to.rotation } else { from.rotation };
        let at = match part {
            DRIFT => (number, within.map(|x| drifted(x, drift(below)))),
            1 => (number, within),
            _ => place(shapes, to),
        };
        placed(shapes, Body { rotation, ..*from }, at)
    };
    let own = |body: Body, kind, below: &mut dyn FnMut(u32) -> u32| match kind {
        ChangeKind::Margin => Body { margin: next_margin(body.margin, margins, below), ..body },
        _ => {
            let count = shapes.len() as u32;
            let shape = (body.shape + 1 + below(count - 1)) % count;
            placed(shapes, Body { shape, ..body }, place(shapes, &body))
        }
    };
    draw(ChangeKind::ALL, new, moved, own, below)
}

/// A body at a pose, with properties that are drawn, its margin from these.
pub(super) fn with_properties(
    body: Body,
    margins: &[f32],
    below: &mut dyn FnMut(u32) -> u32,
) -> Body {
    Body {
        motion: motion(below),
        groups: groups(below),
        margin: margins[below(2) as usize * below(margins.len() as u32) as usize],
        ..body
    }
}

/// A margin other than this one.
fn next_margin(margin: f32, margins: &[f32], below: &mut dyn FnMut(u32) -> u32) -> f32 {
    let at = margins.iter().position(|&known| known == margin);
    let step = 1 + below(margins.len() as u32 - 1) as usize;
    margins[(at.unwrap_or(0) + step) % margins.len()]
}

/// One of the bodies, if there are some.
pub(super) fn other<B: Copy>(bodies: &[B], below: &mut dyn FnMut(u32) -> u32) -> Option<B> {
    let at = (!bodies.is_empty()).then(|| below(bodies.len() as u32) as usize);
    at.map(|at| bodies[at])
}

fn motion(below: &mut dyn FnMut(u32) -> u32) -> Motion {
    [Motion::Dynamic, Motion::Resting, Motion::Fixed][below(3) as usize]
}

fn groups(below: &mut dyn FnMut(u32) -> u32) -> Groups {
    match below(3) {
        0 => Groups { member: 1 << below(2), mask: 1 << below(2) },
        _ => Groups::ALL,
    }
}

/// Draws a history with a change per frame, of these kinds in turn, and often a second one: so few
/// that a world searches for each changed body. Now and then there are many. In the larger ones two
/// bodies near each other drift in each frame, so that worlds list them. `new` draws a body
/// next to others, `moved` copies a pose or a part of it (1, 2) or lets it drift, and `own` makes a
/// change that only bodies of this kind have.
fn draw<B: Properties>(
    kinds: &[ChangeKind],
    new: impl Fn(&[B], &mut dyn FnMut(u32) -> u32) -> B,
    moved: impl Fn(&B, &B, u32, &mut dyn FnMut(u32) -> u32) -> B,
    own: impl Fn(B, ChangeKind, &mut dyn FnMut(u32) -> u32) -> B,
    below: &mut dyn FnMut(u32) -> u32,
) -> History<B> {
    let mut drawn = Drawn { bodies: Vec::new(), excluded: Vec::new(), saved: None };
    let count = FIRST[below(2) as usize];
    for _ in 0..count {
        let body = new(&drawn.present(), below);
        drawn.bodies.push(Some(body));
    }
    let drifting: &[usize] = if count == FIRST[1] { &[0, 1] } else { &[] };
    if !drifting.is_empty() {
        drawn.bodies[1] = drawn.bodies[0].map(|body| new(&[body], below));
    }
    let first = drawn.present();
    let offset = below(kinds.len() as u32) as usize;
    let mut frames = Vec::with_capacity(FRAMES);
    for frame in 0..FRAMES {
        let mut changes = Vec::new();
        let extras = if below(16) == 0 { 24 } else { below(2) };
        for extra in 0..=extras {
            let kind = match extra {
                0 => kinds[(frame + offset) % kinds.len()],
                _ => kinds[below(kinds.len() as u32) as usize],
            };
            changes.extend(drawn.change(kind, &new, &moved, &own, below).map(|one| (kind, one)));
        }
        for &number in drifting {
            if let Some(body) = drawn.bodies[number] {
                let body = moved(&body, &body, DRIFT, below);
                drawn.bodies[number] = Some(body);
                changes.push((ChangeKind::Moved, Change::Set(number, body)));
            }
        }
        frames.push(changes);
    }
    History { first, frames }
}

/// The bodies as they are drawn.
struct Drawn<B> {
    /// By number; those that have left are `None`.
    bodies: Vec<Option<B>>,
    excluded: Vec<[usize; 2]>,
    /// Both, as they were saved.
    saved: Option<Saved<B>>,
}

type Saved<B> = (Vec<Option<B>>, Vec<[usize; 2]>);

impl<B: Properties> Drawn<B> {
    fn present(&self) -> Vec<B> {
        self.bodies.iter().flatten().copied().collect()
    }

    /// A body for which a condition holds.
    fn one(
        &self,
        below: &mut dyn FnMut(u32) -> u32,
        fits: impl Fn(&mut B) -> bool,
    ) -> Option<(usize, B)> {
        let numbered = self.bodies.iter().enumerate();
        let fitting = numbered.filter_map(|(number, body)| Some((number, (*body)?)));
        let fitting: Vec<_> = fitting.filter(|(_, body)| fits(&mut { *body })).collect();
        other(&fitting, below)
    }

    /// A change of this kind; `None` if no body allows it.
    fn change(
        &mut self,
        kind: ChangeKind,
        new: &impl Fn(&[B], &mut dyn FnMut(u32) -> u32) -> B,
        moved: &impl Fn(&B, &B, u32, &mut dyn FnMut(u32) -> u32) -> B,
        own: &impl Fn(B, ChangeKind, &mut dyn FnMut(u32) -> u32) -> B,
        below: &mut dyn FnMut(u32) -> u32,
    ) -> Option<Change<B>> {
        let any = |_: &mut B| true;
        let (number, mut body) = match kind {
            ChangeKind::Inserted => {
                let body = new(&self.present(), below);
                self.bodies.push(Some(body));
                return Some(Change::Insert(body));
            }
            ChangeKind::Removed => {
                let (number, _) = self.one(below, any)?;
                self.bodies[number] = None;
                self.excluded.retain(|pair| !pair.contains(&number));
                return Some(Change::Remove(number));
            }
            ChangeKind::Excluded => return self.exclude(below),
            ChangeKind::Saved => {
                self.saved = Some((self.bodies.clone(), self.excluded.clone()));
                return Some(Change::Save);
            }
            ChangeKind::Restored => {
                let (bodies, excluded) = self.saved.clone()?;
                self.bodies[..bodies.len()].copy_from_slice(&bodies);
                self.bodies[bodies.len()..].fill(None);
                self.excluded = excluded;
                return Some(Change::Restore);
            }
            ChangeKind::Cloned | ChangeKind::Shrunk | ChangeKind::Limited => {
                return Some(Change::Detour(kind));
            }
            ChangeKind::Interest => {
                let two = [(); 2].map(|()| self.one(below, any));
                let numbers = two.into_iter().flatten().map(|(number, _)| number);
                return Some(Change::Interest(numbers.collect()));
            }
            ChangeKind::Rested => self.one(below, |body| *body.motion() != Motion::Resting)?,
            ChangeKind::Woken => self.one(below, |body| *body.motion() == Motion::Resting)?,
            ChangeKind::Fixed => self.one(below, |body| *body.motion() != Motion::Fixed)?,
            _ => self.one(below, any)?,
        };
        match kind {
            ChangeKind::Rested => *body.motion() = Motion::Resting,
            ChangeKind::Woken => *body.motion() = Motion::Dynamic,
            ChangeKind::Fixed => *body.motion() = Motion::Fixed,
            ChangeKind::Regrouped => *body.groups() = groups(below),
            ChangeKind::Moved => {
                let (_, other) = self.one(below, any)?;
                let to = new(&self.present(), below);
                body = match below(8) {
                    0 => body, // the same again
                    1 => moved(&body, &other, 0, below),
                    2 | 3 => moved(&body, &to, DRIFT, below),
                    part => moved(&body, &to, part % 3, below),
                };
            }
            _ => body = own(body, kind, below),
        }
        self.bodies[number] = Some(body);
        Some(Change::Set(number, body))
    }

    /// Excludes two bodies, or includes two that are.
    fn exclude(&mut self, below: &mut dyn FnMut(u32) -> u32) -> Option<Change<B>> {
        if let (Some(pair), 0) = (other(&self.excluded, below), below(2)) {
            self.excluded.retain(|known| *known != pair);
            return Some(Change::Exclude(pair, false));
        }
        let (one, _) = self.one(below, |_| true)?;
        let (two, _) = self.one(below, |_| true)?;
        let pair = [one.min(two), one.max(two)];
        if one == two || self.excluded.contains(&pair) {
            return None;
        }
        self.excluded.push(pair);
        Some(Change::Exclude(pair, true))
    }
}
