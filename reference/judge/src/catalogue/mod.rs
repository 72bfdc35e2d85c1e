//! The cases that everyone is judged by: groups with a name, the bug that each looks for, and its
//! source.
//!
//! A case is drawn from its group's name and its number alone, so `touch/edge-edge/0017` is the
//! same bodies on every machine. With a seed the same group draws other bodies,
//! `touch/edge-edge/0017@42`: nobody can prepare for those.

mod boxes;
mod changes;
mod contacts;
mod crowds;
mod exact;
mod grid;

use rand::SeedableRng as _;
use rand_chacha::ChaCha8Rng;

use super::case::{Case, Frame, matches};
use super::claim::Claim;
use crate::ours::contact::Kind;
use crate::ours::draw::TurnKind;
use crate::ours::forms::FormError;
use crate::ours::hard::{self, GroupError, Recipe};
use sdop::mesh::MeshError;
use sdop::volume::{Axes, DirectionSet, Shape, VolumeError};

pub use boxes::of_boxes;
pub use crowds::picked;

/// A case that can't be drawn.
#[derive(Debug, thiserror::Error)]
pub enum CatalogueError {
    /// A form.
    #[error(transparent)]
    Form(#[from] FormError),
    /// A group of hard cases.
    #[error(transparent)]
    Hard(#[from] GroupError),
    /// A mesh.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// A shape.
    #[error(transparent)]
    Shape(#[from] VolumeError),
}

/// Shapes and frames as drawn.
#[derive(Clone, Debug)]
pub(super) struct Drawn {
    pub(super) shapes: Vec<Shape>,
    pub(super) frames: Vec<Frame>,
}

/// How a group's cases are drawn.
#[derive(Clone, Copy, Debug)]
enum Draw {
    /// Bodies in contact with a probe.
    Contact(Kind, TurnKind),
    /// The same far from the world's origin.
    Far(Kind),
    /// Cubes and octahedra on short binary coordinates.
    Exact(exact::Touch),
    /// Tips that touch across the borders of cells.
    CellBorder,
    /// Crowds and what happens to them.
    Crowd(crowds::Kind),
    /// A few crowds, then as many changes along each axis.
    Changes(crowds::Kind, u32),
    /// Boxes without bodies.
    Boxes(boxes::Kind),
    /// A file of the hard cases.
    Hard(&'static str),
}

/// A group of cases.
#[derive(Clone, Copy, Debug)]
pub struct Group {
    /// The beginning of its cases' names.
    pub name: &'static str,
    /// The bug that it looks for.
    pub flag: &'static str,
    /// Where it comes from.
    pub source: &'static str,
    /// How many cases are published.
    pub cases: u32,
    draw: Draw,
}

const DRAWN: &str = "drawn for this catalogue";

macro_rules! groups {
    ($($name:literal, $cases:literal, $draw:expr, $flag:literal;)+) => {
        const OWN: &[Group] = &[$(Group { name: $name, flag: $flag, source: DRAWN, cases: $cases, draw: $draw }),+];
    };
}

groups! {
    "touch/ball-ball", 12, Draw::Contact(Kind::Ball, TurnKind::Any), "a radius or a distance rounded down";
    "touch/edge-edge", 12, Draw::Contact(Kind::Edges, TurnKind::Any), "an axis that is a rounded cross product";
    "touch/face-corner", 12, Draw::Contact(Kind::FirstFace, TurnKind::Any), "a slab of the first body rounded inward";
    "touch/corner-face", 12, Draw::Contact(Kind::SecondFace, TurnKind::Any), "a slab of the second body rounded inward";
    "touch/oriented-box", 12, Draw::Contact(Kind::Box, TurnKind::Any), "an oriented box smaller than its mesh";
    "touch/world-extent", 12, Draw::Contact(Kind::World, TurnKind::Any), "a world-aligned extent rounded inward";
    "touch/vertex", 12, Draw::Contact(Kind::Mesh, TurnKind::Any), "vertices that only just meet";
    "touch/triangle", 12, Draw::Contact(Kind::Triangle, TurnKind::Any), "a vertex that only just meets a triangle";
    "touch/near-parallel", 8, Draw::Contact(Kind::Edges, TurnKind::NearlyParallel), "edges nearly parallel: a cross product of noise";
    "touch/quarter-turns", 8, Draw::Contact(Kind::Mesh, TurnKind::Quarter), "coinciding faces and edges";
    "pose/norms", 8, Draw::Contact(Kind::Mesh, TurnKind::Norm), "a quaternion taken for a unit one";
    "pose/signs", 8, Draw::Contact(Kind::Mesh, TurnKind::Sign), "q and -q told apart, negative zeros";
    "pose/far", 12, Draw::Far(Kind::Mesh), "differences of large world coordinates";
    "exact/face-to-face", 8, Draw::Exact(exact::Touch::Faces), "touching taken for apart: < in place of <=";
    "exact/edge-to-edge", 8, Draw::Exact(exact::Touch::Edges), "touching taken for apart: < in place of <=";
    "exact/corner-to-corner", 8, Draw::Exact(exact::Touch::Corners), "touching taken for apart: < in place of <=";
    "exact/tip-on-face", 8, Draw::Exact(exact::Touch::TipOnFace), "touching taken for apart: < in place of <=";
    "exact/tip-to-tip", 8, Draw::Exact(exact::Touch::Tips), "touching taken for apart: < in place of <=";
    "grid/cell-border", 12, Draw::CellBorder, "cells exactly as large as the largest body: a partner two cells away";
    "buffer/growth", 2, Draw::Crowd(crowds::Kind::Growth), "a full buffer of pairs, and one that is never emptied";
    "buffer/hub", 2, Draw::Crowd(crowds::Kind::Hub), "a full buffer of one body's partners";
    "order/repeated", 4, Draw::Crowd(crowds::Kind::Repeated), "answers that depend on the frames before";
    "order/renumbered", 4, Draw::Crowd(crowds::Kind::Renumbered), "answers that depend on the bodies' numbers";
    "churn/swap", 7, Draw::Changes(crowds::Kind::Swap, 4), "stale places of bodies that jump";
    "churn/teleport", 7, Draw::Changes(crowds::Kind::Teleport, 4), "stale bounds of bodies that jump far";
    "churn/insert-remove", 7, Draw::Changes(crowds::Kind::InsertRemove, 4), "stale bodies that were removed, new ones not taken up";
    "churn/move", 3, Draw::Changes(crowds::Kind::Move, 0), "stale bounds of bodies that move";
    "churn/turn", 3, Draw::Changes(crowds::Kind::Turn, 0), "stale bounds of bodies that turn in place";
    "random/crowd", 6, Draw::Crowd(crowds::Kind::Still), "anything";
    "random/moving", 6, Draw::Crowd(crowds::Kind::Moving), "caches kept for too long";
    "random/sizes", 6, Draw::Crowd(crowds::Kind::Sizes), "cells or trees for one size of body";
    "box/grid", 8, Draw::Boxes(boxes::Kind::Grid), "touching taken for apart: < in place of <=";
    "box/ulp", 8, Draw::Boxes(boxes::Kind::Ulp), "ends rounded inward, centre and half size in place of ends";
    "box/flat", 8, Draw::Boxes(boxes::Kind::Flat), "boxes without a volume, zeros of both signs";
    "box/range", 8, Draw::Boxes(boxes::Kind::Range), "overflow and underflow of areas and volumes";
}

/// Every group: the catalogue's own, then the files of hard cases as `hard/…`.
///
/// # Errors
/// A file of hard cases that can't be read: none that is compiled in.
pub fn groups() -> Result<Vec<Group>, CatalogueError> {
    let mut groups = OWN.to_vec();
    for &(name, text) in hard::FILES {
        groups.push(Group {
            name: hard_name(name),
            flag: why(text),
            source: name,
            cases: runs(&hard::Group::parse(text)?.recipe),
            draw: Draw::Hard(text),
        });
    }
    Ok(groups)
}

/// What breaks in a group of hard cases: its file says so in a line of its own.
fn why(text: &'static str) -> &'static str {
    let line = text.lines().find_map(|line| line.strip_prefix("why = \""));
    line.and_then(|line| line.strip_suffix('"')).unwrap_or("")
}

macro_rules! hard_names {
    ($($name:literal),+ $(,)?) => {
        fn hard_name(name: &str) -> &'static str {
            match name {
                $($name => concat!("hard/", $name),)+
                _ => "hard/unnamed",
            }
        }
    };
}

hard_names! {
    "ball-centres-off-origin", "coincident", "concentric-stacks", "contained", "cell-boundaries", "coplanar-and-edges",
    "counts", "duplicates", "equal-and-quarter-turns", "far-from-origin", "flat-and-points", "giant-among-tiny", "huge",
    "near-parallel-edges", "needles-and-plates", "on-a-line", "on-a-plane", "one-cell", "one-ulp-turns",
    "quaternion-norms", "quaternion-signs", "shared-vertices", "subnormal", "teleports", "touch-by-quadruples",
    "touch-within-an-ulp", "unequal-sizes", "vertex-on-face",
    "finder-borders",
}

/// The runs that a recipe makes: a case each.
fn runs(recipe: &Recipe) -> u32 {
    let runs = match recipe {
        Recipe::Probe { frames, .. } => *frames,
        Recipe::Chain { bodies, .. } => bodies.len(),
        Recipe::Borders { scenes, .. } => *scenes,
        Recipe::Quadruples { .. } | Recipe::Lattice { .. } => 1,
    };
    runs as u32 // a few
}

impl Group {
    /// The claims that its cases are about.
    #[must_use]
    pub fn claims(&self) -> &'static [Claim] {
        match self.draw {
            Draw::Boxes(_) => &[Claim::Aabb],
            // Their balls are set, and don't contain the meshes.
            Draw::Hard(_) if self.sets_radii() => &[Claim::Sphere],
            _ => Claim::ALL,
        }
    }

    fn sets_radii(&self) -> bool {
        matches!(
            self.source,
            "touch-by-quadruples" | "touch-within-an-ulp" | "cell-boundaries"
        )
    }

    /// The name of a case, of the published ones or of a seed's.
    #[must_use]
    pub fn case_name(&self, number: u32, seed: Option<u64>) -> String {
        match seed {
            None => format!("{}/{number:04}", self.name),
            Some(seed) => format!("{}/{number:04}@{seed}", self.name),
        }
    }

    /// Draws a case.
    ///
    /// # Errors
    /// Forms that can't be had.
    pub fn case(&self, number: u32, seed: Option<u64>) -> Result<Case, CatalogueError> {
        let mut rng = ChaCha8Rng::seed_from_u64(key(self.name) ^ seed.unwrap_or(0).rotate_left(17));
        rng.set_stream(u64::from(number) + (u64::from(seed.is_some()) << 32));
        let drawn = self.drawn(number, seed, &mut rng)?;
        Ok(self.named(self.case_name(number, seed), drawn))
    }

    /// A case of two bodies, for groups that have such.
    ///
    /// # Errors
    /// As [`Self::case`].
    pub fn pair_case(&self, number: u32) -> Result<Option<Case>, CatalogueError> {
        let mut rng = ChaCha8Rng::seed_from_u64(key(self.name));
        rng.set_stream(u64::from(number) + (2 << 32));
        let drawn = match self.draw {
            Draw::Contact(kind, turn) => {
                contacts::around_a_probe(kind, turn, None, number, 1, &mut rng)?
            }
            Draw::Far(kind) => contacts::around_a_probe(
                kind,
                TurnKind::Any,
                Some([8.0, 20.0]),
                number,
                1,
                &mut rng,
            )?,
            Draw::Exact(touch) => exact::touching(touch, number, 1, &mut rng)?,
            Draw::Boxes(kind) => boxes::boxes(kind, 2, &mut rng)?,
            Draw::CellBorder | Draw::Crowd(_) | Draw::Changes(..) | Draw::Hard(_) => {
                return Ok(None);
            }
        };
        Ok(Some(self.named(self.case_name(number, None), drawn)))
    }

    fn named(&self, name: String, drawn: Drawn) -> Case {
        Case {
            name,
            flag: self.flag.to_owned(),
            source: self.source.to_owned(),
            claims: self.claims().to_vec(),
            shapes: drawn.shapes,
            frames: drawn.frames,
        }
    }

    fn drawn(
        &self,
        number: u32,
        seed: Option<u64>,
        rng: &mut ChaCha8Rng,
    ) -> Result<Drawn, CatalogueError> {
        match self.draw {
            Draw::Contact(kind, turn) => {
                Ok(contacts::around_a_probe(kind, turn, None, number, 12, rng)?)
            }
            Draw::Far(kind) => Ok(contacts::around_a_probe(
                kind,
                TurnKind::Any,
                Some([8.0, 20.0]),
                number,
                12,
                rng,
            )?),
            Draw::Exact(touch) => exact::touching(touch, number, 8, rng),
            Draw::CellBorder => grid::tips_across_borders(number, rng),
            Draw::Crowd(kind) => Ok(crowds::crowd(kind, rng)?),
            Draw::Changes(kind, crowds) if number < crowds => Ok(crowds::crowd(kind, rng)?),
            Draw::Changes(kind, crowds) => changes::along_an_axis(kind, number - crowds, rng),
            Draw::Boxes(kind) => boxes::boxes(kind, 48, rng),
            Draw::Hard(text) => hard_case(text, number, seed),
        }
    }
}

fn hard_case(text: &str, number: u32, seed: Option<u64>) -> Result<Drawn, CatalogueError> {
    let mut group = hard::Group::parse(text)?;
    group.seed ^= seed.unwrap_or(0);
    let mut cases = group.cases(DirectionSet::K18, Axes::Principal)?;
    let shapes = cases.shapes.built;
    let run = cases
        .runs
        .swap_remove(number as usize % cases.runs.len().max(1));
    let frames = run
        .into_iter()
        .map(|bodies| Frame::fitted(bodies, &shapes))
        .collect();
    Ok(Drawn { shapes, frames })
}

/// FNV-1a: a name as the start of its draws.
fn key(name: &str) -> u64 {
    name.bytes().fold(0xcbf2_9ce4_8422_2325, |hash: u64, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

/// Which cases: a group and a number each, in turns over the groups so that every bug is looked for
/// early. Groups that are about this claim alone come first.
///
/// # Errors
/// As [`groups`].
pub fn select(
    claim: Claim,
    pattern: &str,
    seed: Option<u64>,
) -> Result<Vec<(Group, u32)>, CatalogueError> {
    let mut groups = groups()?;
    groups.sort_by_key(|group| group.claims() != [claim]);
    let most = groups.iter().map(|group| group.cases).max().unwrap_or(0);
    let about = |group: &&Group| group.claims().contains(&claim);
    let all = (0..most).flat_map(|n| groups.iter().filter(about).map(move |group| (*group, n)));
    let wanted = |(group, n): &(Group, u32)| {
        *n < group.cases && matches(pattern, &group.case_name(*n, seed))
    };
    Ok(all.filter(wanted).collect())
}
