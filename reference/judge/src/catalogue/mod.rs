//! The cases by which every culler is judged, in groups. Each group has a name, the bug that it
//! looks for, and the source of that bug.
//!
//! A case depends only on its group's name and its number, so `touch/edge-edge/0017` has the same
//! bodies on every machine. With a seed, as in `touch/edge-edge/0017@42`, the group draws other
//! bodies, for which nobody can prepare.

mod approaches;
mod boxes;
mod changes;
mod claim_inputs;
mod contacts;
mod crowds;
mod exact_touches;
mod grid;
mod histories;
mod neutral_inputs;
mod parts;
mod periodic;
mod sleep;
mod stale_data;

use rand::SeedableRng as _;
use rand_chacha::ChaCha8Rng;

use super::case::{Case, Frame, matches};
use super::claim::Claim;
use crate::draw::bodies::TurnKind;
use crate::draw::contact::ContactKind;
use crate::draw::forms::FormError;
use crate::draw::hard::{self, HardCaseError, Recipe};
use crate::truth::reference_shapes::InvalidInput;
use sdop::mesh::MeshError;
use sdop::volume::{Axes, DirectionSet, Shape, VolumeError};

use approaches::ApproachKind;
use boxes::BoxKind;
pub use boxes::of_boxes;
use claim_inputs::ClaimInputKind;
use crowds::CrowdKind;
use histories::HistoryKind;
use parts::PartsKind;
use periodic::PeriodicKind;
use stale_data::StaleKind;

/// A case that can't be drawn.
#[derive(Debug, thiserror::Error)]
pub enum CatalogueError {
    /// A form.
    #[error(transparent)]
    Form(#[from] FormError),
    /// A group of hard cases.
    #[error(transparent)]
    Hard(#[from] HardCaseError),
    /// A mesh.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// A shape.
    #[error(transparent)]
    Shape(#[from] VolumeError),
    /// A composed pose that f64 doesn't hold.
    #[error(transparent)]
    Pose(#[from] InvalidInput),
}

/// Shapes and frames as drawn.
#[derive(Clone, Debug)]
pub(super) struct DrawnCase {
    pub(super) shapes: Vec<Shape>,
    pub(super) frames: Vec<Frame>,
}

/// How a group's cases are drawn.
#[derive(Clone, Copy, Debug)]
enum CaseDraw {
    /// Bodies in contact with a probe.
    Contact(ContactKind, TurnKind),
    /// The same far from the world's origin.
    Far(ContactKind),
    /// Cubes and octahedra on short binary coordinates.
    Exact(exact_touches::Touch),
    /// The same in oblique directions.
    Oblique(exact_touches::Touch),
    /// Tips that touch across the borders of cells.
    CellBorder,
    /// Crowds and what happens to them.
    Crowd(CrowdKind),
    /// A few crowds, then as many changes along each axis.
    Changes(CrowdKind, u32),
    /// Boxes without bodies.
    Boxes(BoxKind),
    /// Changes of all kinds.
    Stale(StaleKind),
    /// Bodies that sleep and wake while they touch.
    Sleep,
    /// Slow approaches.
    Approach(ApproachKind),
    /// Boxes with the additional input of one claim.
    ClaimInput(ClaimInputKind, &'static [Claim; 1]),
    /// Bodies of several parts.
    Parts(PartsKind),
    /// Boxes in space that repeats.
    Periodic(PeriodicKind),
    /// Many frames, for all claims that are about such bodies or for one.
    Long(HistoryKind),
    /// More bodies than 16 bits count.
    Many,
    /// A file of the hard cases.
    Hard(&'static str),
}

/// A group of cases.
#[derive(Clone, Copy, Debug)]
pub struct CaseGroup {
    /// The beginning of its cases' names.
    pub name: &'static str,
    /// The bug that it looks for.
    pub flag: &'static str,
    /// Where it comes from.
    pub source: &'static str,
    /// The number of published cases.
    pub cases: u32,
    draw: CaseDraw,
}

/// One list of groups: the catalogue's own, then the files of hard cases. It also generates a test
/// for each of them.
macro_rules! groups {
    (
        hard { $($hard:ident = $file:literal;)+ }
        $($test:ident $name:literal, $cases:literal, $draw:expr, $flag:literal $(, after $reports:literal)?;)+
    ) => {
        const OWN: &[CaseGroup] =
            &[$(CaseGroup { name: $name, flag: $flag, source: groups!(@source $($reports)?), cases: $cases, draw: $draw }),+];
        const HARD: &[&str] = &[$(concat!("hard/", $file)),+];
        groups! { @stamp ($) $($test = $name;)+ $($hard = concat!("hard/", $file);)+ }
    };
    (@source) => { "drawn for this catalogue" };
    (@source $reports:literal) => { concat!("drawn for this catalogue, after ", $reports) };
    (@stamp ($d:tt) $($test:ident = $name:expr;)+) => {
        /// Generates a test for each group of cases, in a separate module:
        /// `judge_tests!(Claim::Mesh, |scene| Mine::new(scene));`. Groups without a case of the
        /// claim get an empty test.
        #[macro_export]
        macro_rules! judge_tests {
            ($d claim:expr, $d make:expr) => {
                $(
                    #[test]
                    fn $test() {
                        $crate::judge($d make)
                            .claims($d claim)
                            .cases(concat!($name, "/*"))
                            .assert_if_any();
                    }
                )+
            };
        }
    };
}

sdop_data::with_hard_cases! { groups! {
    touch_ball_ball "touch/ball-ball", 12, CaseDraw::Contact(ContactKind::Ball, TurnKind::Any), "a radius or a distance rounded down";
    touch_edge_edge "touch/edge-edge", 12, CaseDraw::Contact(ContactKind::Edges, TurnKind::Any), "an axis that is a rounded cross product";
    touch_face_corner "touch/face-corner", 12, CaseDraw::Contact(ContactKind::FirstFace, TurnKind::Any), "a slab of the first body rounded inward";
    touch_corner_face "touch/corner-face", 12, CaseDraw::Contact(ContactKind::SecondFace, TurnKind::Any), "a slab of the second body rounded inward";
    touch_oriented_box "touch/oriented-box", 12, CaseDraw::Contact(ContactKind::Box, TurnKind::Any), "an oriented box smaller than its mesh";
    touch_world_extent "touch/world-extent", 12, CaseDraw::Contact(ContactKind::World, TurnKind::Any), "a world-aligned extent rounded inward";
    touch_vertex "touch/vertex", 12, CaseDraw::Contact(ContactKind::Mesh, TurnKind::Any), "vertices that only just meet";
    touch_triangle "touch/triangle", 12, CaseDraw::Contact(ContactKind::Triangle, TurnKind::Any), "a vertex that only just meets a triangle";
    touch_near_parallel "touch/near-parallel", 8, CaseDraw::Contact(ContactKind::Edges, TurnKind::NearlyParallel), "edges nearly parallel: a cross product of noise";
    touch_quarter_turns "touch/quarter-turns", 8, CaseDraw::Contact(ContactKind::Mesh, TurnKind::Quarter), "coinciding faces and edges";
    pose_norms "pose/norms", 8, CaseDraw::Contact(ContactKind::Mesh, TurnKind::Norm), "a quaternion taken for a unit one";
    pose_signs "pose/signs", 8, CaseDraw::Contact(ContactKind::Mesh, TurnKind::Sign), "q and -q told apart, negative zeros";
    pose_far "pose/far", 12, CaseDraw::Far(ContactKind::Mesh), "differences of large world coordinates";
    exact_face_to_face "exact/face-to-face", 8, CaseDraw::Exact(exact_touches::Touch::Faces), "touching taken for apart: < in place of <=";
    exact_edge_to_edge "exact/edge-to-edge", 8, CaseDraw::Exact(exact_touches::Touch::Edges), "touching taken for apart: < in place of <=";
    exact_corner_to_corner "exact/corner-to-corner", 8, CaseDraw::Exact(exact_touches::Touch::Corners), "touching taken for apart: < in place of <=";
    exact_tip_on_face "exact/tip-on-face", 8, CaseDraw::Exact(exact_touches::Touch::TipOnFace), "touching taken for apart: < in place of <=";
    exact_tip_to_tip "exact/tip-to-tip", 8, CaseDraw::Exact(exact_touches::Touch::Tips), "touching taken for apart: < in place of <=";
    oblique_face_to_face "oblique/face-to-face", 3, CaseDraw::Oblique(exact_touches::Touch::Faces), "volumes in f32 without a margin, in directions off the axes";
    oblique_edge_to_edge "oblique/edge-to-edge", 3, CaseDraw::Oblique(exact_touches::Touch::Edges), "volumes in f32 without a margin, in directions off the axes";
    oblique_corner_to_corner "oblique/corner-to-corner", 3, CaseDraw::Oblique(exact_touches::Touch::Corners), "volumes in f32 without a margin, in directions off the axes";
    oblique_tip_on_face "oblique/tip-on-face", 3, CaseDraw::Oblique(exact_touches::Touch::TipOnFace), "volumes in f32 without a margin, in directions off the axes";
    oblique_tip_to_tip "oblique/tip-to-tip", 6, CaseDraw::Oblique(exact_touches::Touch::Tips), "balls in f32 without a margin, in directions off the axes";
    grid_cell_border "grid/cell-border", 12, CaseDraw::CellBorder, "cells exactly as large as the largest body: a partner two cells away";
    buffer_growth "buffer/growth", 2, CaseDraw::Crowd(CrowdKind::Growth), "a full buffer of pairs, and one that is never emptied";
    buffer_hub "buffer/hub", 2, CaseDraw::Crowd(CrowdKind::Hub), "a full buffer of one body's partners";
    order_repeated "order/repeated", 4, CaseDraw::Crowd(CrowdKind::Repeated), "answers that depend on the frames before";
    order_renumbered "order/renumbered", 4, CaseDraw::Crowd(CrowdKind::Renumbered), "answers that depend on the bodies' numbers";
    churn_swap "churn/swap", 7, CaseDraw::Changes(CrowdKind::Swap, 4), "stale places of bodies that jump";
    churn_teleport "churn/teleport", 7, CaseDraw::Changes(CrowdKind::Teleport, 4), "stale bounds of bodies that jump far";
    churn_insert_remove "churn/insert-remove", 7, CaseDraw::Changes(CrowdKind::InsertRemove, 4), "stale bodies that were removed, new ones not taken up";
    churn_move "churn/move", 3, CaseDraw::Changes(CrowdKind::Move, 0), "stale bounds of bodies that move";
    churn_turn "churn/turn", 3, CaseDraw::Changes(CrowdKind::Turn, 0), "stale bounds of bodies that turn in place";
    random_crowd "random/crowd", 6, CaseDraw::Crowd(CrowdKind::Still), "anything";
    random_moving "random/moving", 6, CaseDraw::Crowd(CrowdKind::Moving), "caches kept for too long";
    random_sizes "random/sizes", 6, CaseDraw::Crowd(CrowdKind::Sizes), "cells or trees for one size of body";
    box_grid "box/grid", 8, CaseDraw::Boxes(BoxKind::Grid), "touching taken for apart: < in place of <=";
    box_ulp "box/ulp", 8, CaseDraw::Boxes(BoxKind::Ulp), "ends rounded inward, centre and half size in place of ends";
    box_flat "box/flat", 8, CaseDraw::Boxes(BoxKind::Flat), "boxes without a volume, zeros of both signs";
    box_range "box/range", 8, CaseDraw::Boxes(BoxKind::Range), "overflow and underflow of areas and volumes";
    oblique_boxes "oblique/boxes", 4, CaseDraw::Boxes(BoxKind::Oblique), "balls around boxes in f32 without a margin";
    crowd_new_pairs "crowd/new-pairs", 2, CaseDraw::Crowd(CrowdKind::NewPairs), "a fixed buffer of new pairs", after "mujoco_warp #1461, newton #3702 and Box3D's \"ignoring this pair\"";
    crowd_partners "crowd/partners", 1, CaseDraw::Crowd(CrowdKind::Partners), "a fixed buffer of one body's partners, a fixed stack or pool of nodes", after "Jolt #1520 and #1235";
    stale_reshape "stale/reshape", 6, CaseDraw::Stale(StaleKind::Reshape), "stale bounds of bodies that get another shape", after "avian #654";
    stale_reorder "stale/reorder", 6, CaseDraw::Stale(StaleKind::Reorder), "stale bounds of bodies that get another number", after "fcl #368";
    stale_rebase "stale/rebase", 6, CaseDraw::Stale(StaleKind::Rebase), "stale bounds after another origin", after "newton #4008";
    stale_all_at_once "stale/all-at-once", 6, CaseDraw::Stale(StaleKind::AllAtOnce), "changes that are handled one a frame", after "Jolt #1682 and rapier's #162";
    stale_sleep "stale/sleep", 6, CaseDraw::Sleep, "verdicts kept while one of two bodies wakes, pairs lost when a body wakes";
    list_both "list/both", 3, CaseDraw::Approach(ApproachKind::Both), "a list kept until one body has moved as far as two together may", after "lammps #1701";
    list_one "list/one", 3, CaseDraw::Approach(ApproachKind::One), "a list kept for a number of frames", after "lammps #4239";
    list_return "list/return", 3, CaseDraw::Approach(ApproachKind::Return), "a list whose age is measured from frame to frame", after "lammps #1701";
    filter_groups "filter/groups", 6, CaseDraw::ClaimInput(ClaimInputKind::Groups, &[Claim::Filter]), "masks asked of one body alone, or of a few bits", after "newton #3713 and #990";
    filter_excluded "filter/excluded", 6, CaseDraw::ClaimInput(ClaimInputKind::Excluded, &[Claim::Filter]), "excluded pairs that are reported", after "newton #1553";
    filter_at_rest "filter/at-rest", 6, CaseDraw::ClaimInput(ClaimInputKind::AtRest, &[Claim::Filter]), "filters of bodies at rest that are not asked again", after "godot #54110";
    order_insertion "order/insertion", 6, CaseDraw::ClaimInput(ClaimInputKind::Insertion, &[Claim::Order]), "answers that depend on the order of insertion", after "fcl #368";
    restore_replay "restore/replay", 6, CaseDraw::ClaimInput(ClaimInputKind::Restored, &[Claim::Restore]), "a state that is not in the snapshot", after "parry #402 and rapier #966";
    margin_global "margin/global", 6, CaseDraw::ClaimInput(ClaimInputKind::Margin, &[Claim::Margin]), "a margin that only the later test knows of", after "coal #625 and #685";
    margin_by_body "margin/by-body", 6, CaseDraw::ClaimInput(ClaimInputKind::Margins, &[Claim::Margin]), "one body's margin taken for both, a rounded sum", after "avian #952 and coal #802";
    parts_touch "parts/touch", 6, CaseDraw::Parts(PartsKind::Still), "parts whose own rotation or offset is left out or not turned with the body, all parts but the first left out", after "Physijs #28 and bepuphysics2 #244";
    parts_move "parts/move", 3, CaseDraw::Parts(PartsKind::Moving), "parts that stay behind when their body moves or turns";
    parts_reframe "parts/reframe", 3, CaseDraw::Parts(PartsKind::Reframed), "stale parts after the frame of a body has changed", after "newton #4008 and playcanvas #3695";
    long_bodies "long/bodies", 3, CaseDraw::Long(HistoryKind::Bodies), "what is done for some frames only, and caches kept for too long";
    long_sets "long/sets", 2, CaseDraw::Long(HistoryKind::Sets), "bodies that come and go after many frames";
    long_filters "long/filters", 2, CaseDraw::Long(HistoryKind::Filters), "filters that are read once or with other changes alone";
    long_margins "long/margins", 2, CaseDraw::Long(HistoryKind::Margins), "margins that are read once or with other changes alone";
    long_states "long/states", 3, CaseDraw::Long(HistoryKind::States), "states saved and restored between any two frames";
    long_parts "long/parts", 2, CaseDraw::Long(HistoryKind::Parts), "parts that are read once, or stay behind";
    long_periods "long/periods", 2, CaseDraw::Long(HistoryKind::Periods), "periods that are read once or with other changes alone";
    large_frames "large/frames", 2, CaseDraw::Long(HistoryKind::Frames), "caches and counters that fill after hundreds of frames";
    large_bodies "large/bodies", 2, CaseDraw::Many, "numbers of 16 bits, buffers of 65,536";
    periodic_face "periodic/face", 6, CaseDraw::Periodic(PeriodicKind::Face), "images left out, touching taken for apart";
    periodic_edge "periodic/edge", 3, CaseDraw::Periodic(PeriodicKind::Edge), "images across one border alone";
    periodic_corner "periodic/corner", 3, CaseDraw::Periodic(PeriodicKind::Corner), "images across one border or two alone";
    periodic_far "periodic/far", 6, CaseDraw::Periodic(PeriodicKind::Far), "positions wrapped once alone, or by a rounded product";
    periodic_rounded "periodic/rounded", 3, CaseDraw::Periodic(PeriodicKind::Rounded), "ends compared after a rounded sum with the period";
    periodic_changed "periodic/changed", 3, CaseDraw::Periodic(PeriodicKind::Changed), "stale images after a period has changed";
    periodic_crossing "periodic/crossing", 6, CaseDraw::Periodic(PeriodicKind::Crossing), "stale images of bodies that cross a border";
} }

/// Every group: the catalogue's own, then the files of hard cases as `hard/…`.
///
/// # Errors
/// A file of hard cases can't be read. This does not happen for the files that are compiled in.
pub fn groups() -> Result<Vec<CaseGroup>, CatalogueError> {
    let mut groups = OWN.to_vec();
    for (&name, &(source, text)) in HARD.iter().zip(hard::FILES) {
        groups.push(CaseGroup {
            name,
            flag: why(text),
            source,
            cases: runs(&hard::HardCaseGroup::parse(text)?.recipe),
            draw: CaseDraw::Hard(text),
        });
    }
    Ok(groups)
}

/// What breaks in a group of hard cases, from the line `why` of its file.
fn why(text: &'static str) -> &'static str {
    let line = text.lines().find_map(|line| line.strip_prefix("why = \""));
    line.and_then(|line| line.strip_suffix('"')).unwrap_or("")
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

impl CaseGroup {
    /// The claims that its cases are about.
    #[must_use]
    pub fn claims(&self) -> &'static [Claim] {
        match self.draw {
            CaseDraw::Boxes(_) => &[Claim::Aabb],
            CaseDraw::ClaimInput(_, claims) => claims,
            CaseDraw::Parts(_) => &[Claim::Parts],
            CaseDraw::Periodic(_) => &[Claim::Periodic],
            CaseDraw::Long(kind) => kind.claims(),
            // So many bodies that meshes would take minutes.
            CaseDraw::Crowd(CrowdKind::NewPairs | CrowdKind::Partners) => {
                &[Claim::Sphere, Claim::Aabb]
            }
            // Their balls are set, and don't contain the meshes.
            CaseDraw::Hard(_) if self.sets_radii() => &[Claim::Sphere],
            _ => Claim::PLAIN,
        }
    }

    fn sets_radii(&self) -> bool {
        matches!(self.source, "touch-by-quadruples" | "touch-within-an-ulp" | "cell-boundaries")
    }

    /// The name of a case, of the published ones or of a seed's.
    #[must_use]
    pub fn case_name(&self, number: u32, seed: Option<u64>) -> String {
        match seed {
            None => format!("{}/{number:04}", self.name),
            Some(seed) => format!("{}/{number:04}@{seed}", self.name),
        }
    }

    /// Draws a case, about the first of the group's claims.
    ///
    /// # Errors
    /// A form can't be built.
    pub fn case(&self, number: u32, seed: Option<u64>) -> Result<Case, CatalogueError> {
        let mut rng = ChaCha8Rng::seed_from_u64(key(self.name) ^ seed.unwrap_or(0).rotate_left(17));
        rng.set_stream(u64::from(number) + (u64::from(seed.is_some()) << 32));
        let drawn = self.drawn(number, seed, [12, 8, 48], &mut rng)?;
        Ok(self.named(self.case_name(number, seed), drawn))
    }

    /// A case of two bodies, for groups that have such.
    ///
    /// # Errors
    /// As [`Self::case`].
    pub fn pair_case(&self, number: u32) -> Result<Option<Case>, CatalogueError> {
        let mut rng = ChaCha8Rng::seed_from_u64(key(self.name));
        rng.set_stream(u64::from(number) + (2 << 32));
        Ok(match self.draw {
            CaseDraw::Boxes(BoxKind::Oblique) => None, // not among the stored vectors
            CaseDraw::Contact(..) | CaseDraw::Far(_) | CaseDraw::Exact(_) | CaseDraw::Boxes(_) => {
                let drawn = self.drawn(number, None, [1, 1, 2], &mut rng)?;
                Some(self.named(self.case_name(number, None), drawn))
            }
            _ => None,
        })
    }

    fn named(&self, name: String, drawn: DrawnCase) -> Case {
        Case {
            name,
            flag: self.flag.to_owned(),
            source: self.source.to_owned(),
            claim: self.claims()[0],
            claims: self.claims().to_vec(),
            shapes: drawn.shapes,
            frames: drawn.frames,
        }
    }

    /// Draws bodies. The count is that of partners near the first body or touching it exactly, or
    /// of boxes.
    fn drawn(
        &self,
        number: u32,
        seed: Option<u64>,
        [near, exact, boxes]: [usize; 3],
        rng: &mut ChaCha8Rng,
    ) -> Result<DrawnCase, CatalogueError> {
        match self.draw {
            CaseDraw::Contact(kind, turn) => {
                Ok(contacts::around_a_probe(kind, turn, None, number, near, rng)?)
            }
            CaseDraw::Far(kind) => {
                let (turn, origin) = (TurnKind::Any, Some([8.0, 20.0]));
                Ok(contacts::around_a_probe(kind, turn, origin, number, near, rng)?)
            }
            CaseDraw::Exact(touch) => exact_touches::touching((touch, false), number, exact, rng),
            CaseDraw::Oblique(touch) => exact_touches::touching((touch, true), number, 24, rng),
            CaseDraw::CellBorder => grid::tips_across_borders(number, rng),
            CaseDraw::Crowd(kind) => Ok(crowds::crowd(kind, number, rng)?),
            CaseDraw::Changes(kind, crowds) if number < crowds => {
                Ok(crowds::crowd(kind, number, rng)?)
            }
            CaseDraw::Changes(kind, crowds) => changes::along_an_axis(kind, number - crowds, rng),
            CaseDraw::Boxes(kind) => boxes::boxes(kind, boxes, rng),
            CaseDraw::Stale(kind) => stale_data::changing(kind, number, rng),
            CaseDraw::Sleep => sleep::touching(number, rng),
            CaseDraw::Approach(kind) => Ok(approaches::approach(kind, number, rng)?),
            CaseDraw::ClaimInput(kind, _) => claim_inputs::with_input(kind, number, rng),
            CaseDraw::Parts(kind) => parts::touching(kind, number, rng),
            CaseDraw::Periodic(kind) => periodic::touching(kind, number, rng),
            CaseDraw::Long(kind) => histories::history(kind, number, rng),
            CaseDraw::Many => histories::many(number, rng),
            CaseDraw::Hard(text) => hard_case(text, number, seed),
        }
    }
}

fn hard_case(text: &str, number: u32, seed: Option<u64>) -> Result<DrawnCase, CatalogueError> {
    let mut group = hard::HardCaseGroup::parse(text)?;
    group.seed ^= seed.unwrap_or(0);
    let mut cases = group.cases(DirectionSet::K18, Axes::Principal)?;
    let shapes = cases.shapes.built;
    let run = cases.runs.swap_remove(number as usize % cases.runs.len().max(1));
    let frames = run.into_iter().map(|bodies| Frame::fitted(bodies, &shapes)).collect();
    Ok(DrawnCase { shapes, frames })
}

/// FNV-1a: a name as the start of its draws.
fn key(name: &str) -> u64 {
    name.bytes().fold(0xcbf2_9ce4_8422_2325, |hash: u64, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

/// A case of the catalogue, not drawn yet.
#[derive(Clone, Copy, Debug)]
pub struct CaseId {
    /// Its group.
    pub group: CaseGroup,
    /// Its number in the group.
    pub number: u32,
    /// The seed that draws it; absent if it is published.
    pub seed: Option<u64>,
    /// What it is judged by.
    pub claim: Claim,
}

impl CaseId {
    /// The case's name.
    #[must_use]
    pub fn name(&self) -> String {
        self.group.case_name(self.number, self.seed)
    }

    /// Draws it. A case of the claim that this one is based on gets an input that changes nothing.
    ///
    /// # Errors
    /// As [`CaseGroup::case`].
    pub fn case(&self) -> Result<Case, CatalogueError> {
        let drawn = self.group.case(self.number, self.seed)?;
        match self.group.claims().contains(&self.claim) {
            true => Ok(Case { claim: self.claim, ..drawn }),
            false => Ok(neutral_inputs::judged_by(self.claim, drawn)),
        }
    }

    /// Whether it is so large that a culler may be too slow for it.
    #[must_use]
    pub fn is_large(&self) -> bool {
        self.group.name.starts_with("large/")
    }
}

/// The selected cases, alternating between groups so that every bug is looked for early. Groups
/// that are only about this claim come first, large sets last. A claim that is as another one gets
/// all cases of that one, too.
///
/// # Errors
/// As [`groups`].
pub fn select(
    claim: Claim,
    pattern: &str,
    seed: Option<u64>,
) -> Result<Vec<CaseId>, CatalogueError> {
    let mut groups = groups()?;
    groups.sort_by_key(|group| group.claims() != [claim]);
    groups.retain(|group| {
        let is_about = |claim: Claim| group.claims().contains(&claim);
        is_about(claim) || claim.base().is_some_and(is_about)
    });
    let most = groups.iter().map(|group| group.cases).max().unwrap_or(0);
    let turn = |number| {
        let has = groups.iter().filter(move |group| number < group.cases);
        has.map(move |&group| CaseId { group, number, seed, claim })
    };
    let all = (0..most).flat_map(turn);
    let mut all: Vec<CaseId> = all.filter(|id| matches(pattern, &id.name())).collect();
    all.sort_by_key(CaseId::is_large);
    Ok(all)
}
