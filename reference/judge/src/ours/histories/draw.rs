//! Draws histories: bodies that touch to the last place, and a few changes per frame. The kinds of
//! change take turns. One function, "a number below n", makes all other choices, so that a fuzzer's
//! bytes can make them, too.

use rand::SeedableRng as _;
use rand_chacha::ChaCha8Rng;

use super::worlds::Properties;
use super::{Change, ChangeKind, History, WorldKind};
use crate::ours::boxes::beside;
use crate::ours::contact::PlacedShape;
use crate::ours::forms::{Form, FormError, build};
use crate::ours::reference_shapes::Shapes;
use crate::ours::seeded_draws::{ContactSpec, TurnKind};
use sdop::bodies::Aabb;
use sdop::boxes::BoxBody;
use sdop::volume::{Axes, DirectionSet};
use sdop::world::Body;
use sdop::{Groups, Motion};

/// Bodies at first. With as many, a few changes per frame leave the others' pairs as they are.
const FIRST: [usize; 2] = [32, 48];
/// Frames: each kind of change comes twice.
const FRAMES: usize = 2 * ChangeKind::ALL.len();
/// Contact margins that are drawn.
pub(super) const MARGINS: [f32; 3] = [0.0, 0.1, 0.25];
/// Sides of drawn boxes.
const SIDES: [[f32; 3]; 4] = [[1.0, 1.0, 1.0], [0.25, 2.0, 8.0], [0.0, 1.0, 1.0], [6.0, 6.0, 0.5]];

/// The shapes of histories of meshes, of sizes that a seed draws.
///
/// # Errors
/// As [`build`].
pub fn history_shapes((k, axes): (DirectionSet, Axes), seed: u64) -> Result<Shapes, FormError> {
    let offset =
        Form { radius: None, offset: Some([0.7, -0.3, 0.4]), ..Form::of("l-shape", [0.0; 2]) };
    let plain = ["box", "icosphere", "tetrahedron"].map(|name| Form::of(name, [-0.5, 0.5]));
    let forms: Vec<Form> = plain.into_iter().chain([offset]).collect();
    build(&forms, 1, k, axes, &mut ChaCha8Rng::seed_from_u64(seed))
}

/// A history of given boxes. `below(n)` draws a number below n.
pub fn draw_boxes(below: &mut impl FnMut(u32) -> u32) -> History<BoxBody> {
    let new = |others: &[BoxBody], below: &mut dyn FnMut(u32) -> u32| {
        let sides = SIDES[below(SIDES.len() as u32) as usize];
        let free = [(); 3].map(|()| below(1 << 16) as f32 / (1 << 13) as f32);
        let placed = Aabb::new(free, [0, 1, 2].map(|axis| free[axis] + sides[axis]));
        let bounds = match other(others, below) {
            Some(other) if below(4) > 0 => beside(&other.bounds, sides, &mut |n| below(n)),
            _ => placed,
        };
        BoxBody { bounds, motion: motion(below), groups: groups(below) }
    };
    let moved = |from: &BoxBody, to: &BoxBody, part: u32| {
        let mut bounds = from.bounds;
        for axis in (0..3).filter(|axis| part == 0 || part == 1 + axis % 2) {
            let axis = axis as usize;
            (bounds.min[axis], bounds.max[axis]) = (to.bounds.min[axis], to.bounds.max[axis]);
        }
        BoxBody { bounds, ..*from }
    };
    let kinds = ChangeKind::ALL.iter().copied().filter(|change| WorldKind::Boxes.has(*change));
    draw(&kinds.collect::<Vec<_>>(), new, moved, |body, _, _| body, below)
}

/// A history of meshes in these shapes.
pub fn draw_meshes(shapes: &Shapes, below: &mut impl FnMut(u32) -> u32) -> History<Body> {
    let spec = ContactSpec {
        turn: [TurnKind::Any, TurnKind::Quarter, TurnKind::Identity][below(3) as usize],
        ..ContactSpec::default()
    };
    let count = shapes.built.len() as u32;
    let new = |others: &[Body], below: &mut dyn FnMut(u32) -> u32| {
        let mut rng = ChaCha8Rng::seed_from_u64(u64::from(below(u32::MAX)));
        let shape = below(count) as usize;
        let placed = match other(others, below) {
            Some(other) if below(8) > 0 => {
                let first = PlacedShape {
                    shape: other.shape as usize,
                    rotation: other.rotation,
                    translation: other.translation.map(|x| x as f32),
                };
                spec.partner(shapes, &first, shape, &mut rng)
            }
            _ => PlacedShape {
                translation: [(); 3].map(|()| below(64) as f32 / 8.0),
                ..spec.start(shape, &mut rng)
            },
        };
        let translation = placed.translation.map(f64::from);
        let body = Body::at(shape as u32, placed.rotation, translation);
        with_properties(body, below)
    };
    draw_bodies(count, new, below)
}

/// A history of bodies in as many shapes as are counted, each body drawn by `new` next to others.
pub(super) fn draw_bodies(
    shapes: u32,
    new: impl Fn(&[Body], &mut dyn FnMut(u32) -> u32) -> Body,
    below: &mut dyn FnMut(u32) -> u32,
) -> History<Body> {
    let moved = |from: &Body, to: &Body, part: u32| Body {
        rotation: [to, to, from][part as usize].rotation,
        translation: [to, from, to][part as usize].translation,
        ..*from
    };
    let own = |body: Body, kind, below: &mut dyn FnMut(u32) -> u32| match kind {
        ChangeKind::Margin => Body { margin: next_margin(body.margin, below), ..body },
        _ => Body { shape: (body.shape + 1 + below(shapes - 1)) % shapes, ..body },
    };
    draw(ChangeKind::ALL, new, moved, own, below)
}

/// A body at a pose, with properties that are drawn.
pub(super) fn with_properties(body: Body, below: &mut dyn FnMut(u32) -> u32) -> Body {
    Body {
        motion: motion(below),
        groups: groups(below),
        margin: MARGINS[below(2) as usize * below(MARGINS.len() as u32) as usize],
        ..body
    }
}

/// A margin other than this one.
fn next_margin(margin: f32, below: &mut dyn FnMut(u32) -> u32) -> f32 {
    let at = MARGINS.iter().position(|&known| known == margin);
    let step = 1 + below(MARGINS.len() as u32 - 1) as usize;
    MARGINS[(at.unwrap_or(0) + step) % MARGINS.len()]
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
/// that a world searches for each changed body. `new` draws a body next to others, `moved` copies a
/// pose or a part of it (1, 2), and `own` makes a change that only bodies of this kind have.
fn draw<B: Properties>(
    kinds: &[ChangeKind],
    new: impl Fn(&[B], &mut dyn FnMut(u32) -> u32) -> B,
    moved: impl Fn(&B, &B, u32) -> B,
    own: impl Fn(B, ChangeKind, &mut dyn FnMut(u32) -> u32) -> B,
    below: &mut dyn FnMut(u32) -> u32,
) -> History<B> {
    let mut drawn = Drawn { bodies: Vec::new(), excluded: Vec::new() };
    for _ in 0..FIRST[below(2) as usize] {
        let body = new(&drawn.present(), below);
        drawn.bodies.push(Some(body));
    }
    let first = drawn.present();
    let offset = below(kinds.len() as u32) as usize;
    let mut frames = Vec::with_capacity(FRAMES);
    for frame in 0..FRAMES {
        let mut changes = Vec::new();
        for extra in 0..=below(2) {
            let kind = match extra {
                0 => kinds[(frame + offset) % kinds.len()],
                _ => kinds[below(kinds.len() as u32) as usize],
            };
            changes.extend(drawn.change(kind, &new, &moved, &own, below).map(|one| (kind, one)));
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
}

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
        moved: &impl Fn(&B, &B, u32) -> B,
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
                let to = new(&self.present(), below);
                body = moved(&body, &to, below(3));
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
