//! Carries out a history in a world, and compares the world's pairs and events after each frame.

use std::collections::{BTreeMap, HashMap};

use super::draw::MARGINS;
use super::places::place;
use super::state::{NumberedPair, Pairs, State, by_number, in_order};
use super::worlds::JudgedWorld;
use super::{Change, ChangeKind, History, HistoryError, WorldKind};
use crate::configuration::coverage::{Cell, Judged, ListLedger};
use crate::configuration::cullers::{box_culler, culler, finder};
use crate::configuration::{Mode, rows};
use crate::truth::answers::{Answers, Predicate};
use crate::truth::compare::{difference, meeting};
use crate::truth::reference_shapes::{Shapes, grown};
use sdop::Motion;
use sdop::bodies::{Aabb, Bodies};
use sdop::boxes::{BoxBody, BoxWorld};
use sdop::settings::{CullSettings, Finder, Strategy};
use sdop::simd::Tier;
use sdop::volume::{Axes, DirectionSet};
use sdop::world::{Body, BodyId, World};

/// What a world must report after each frame.
pub(super) struct Truth {
    /// Pairs that must be reported.
    pub required: Vec<Pairs>,
    /// The lists of newly built worlds.
    pub fresh: Vec<Pairs>,
    /// Whether a list may lack pairs of a newly built world's that are not required.
    pub may_lack: bool,
    /// All pairs that may be reported, where that is known otherwise than from a new world.
    pub allowed: Option<Vec<Pairs>>,
}

impl Truth {
    /// What is required is all that may be reported.
    pub fn exact(required: Vec<Pairs>) -> Self {
        Self { fresh: required.clone(), required, may_lack: false, allowed: None }
    }
}

/// Those of the first list that are not in the second.
fn outside(these: &Pairs, those: &Pairs) -> Pairs {
    let is_outside = |pair: &&NumberedPair| those.binary_search(pair).is_err();
    these.iter().filter(is_outside).copied().collect()
}

/// Makes an empty world. All of them report the same; the number may choose how they find it.
type MakeWorld<'a, W> = dyn Fn(usize) -> Result<W, HistoryError> + 'a;

/// A world that lives through a history.
pub(super) struct Life<'a, W: JudgedWorld> {
    pub world: W,
    make: Box<MakeWorld<'a, W>>,
    history: &'a History<W::Body>,
    states: &'a [State<W::Body>],
    ids: Vec<BodyId>,
    numbers: HashMap<BodyId, u32>,
    /// The bodies of the pairs when events were last read.
    before: Pairs,
    /// Whether a world says that nothing changes when two bodies are excluded or included again, or
    /// gives other pairs in portions or up to a limit.
    is_told_wrong: bool,
    /// With the numbers of bodies and the pairs of that time.
    saved: Option<(W::Saved, HashMap<BodyId, u32>, Pairs)>,
}

impl<'a, W: JudgedWorld> Life<'a, W> {
    /// A world that gets the first bodies.
    pub fn new(
        make: impl Fn(usize) -> Result<W, HistoryError> + 'a,
        history: &'a History<W::Body>,
        states: &'a [State<W::Body>],
    ) -> Result<Self, HistoryError> {
        let mut life = Self {
            world: make(0)?,
            make: Box::new(make),
            history,
            states,
            ids: Vec::new(),
            numbers: HashMap::new(),
            before: Vec::new(),
            is_told_wrong: false,
            saved: None,
        };
        for &body in &history.first {
            life.insert(body)?;
        }
        Ok(life)
    }

    fn insert(&mut self, body: W::Body) -> Result<(), HistoryError> {
        let id = self.world.insert(body)?;
        self.numbers.insert(id, self.ids.len() as u32);
        self.ids.push(id);
        Ok(())
    }

    /// The changes that lead to a frame.
    pub fn change(&mut self, frame: usize) -> Result<(), HistoryError> {
        let Some(before) = frame.checked_sub(1) else {
            return Ok(());
        };
        let mut state = self.states[before].clone();
        for (_, change) in &self.history.frames[before] {
            match change {
                Change::Insert(body) => self.insert(*body)?,
                Change::Remove(number) => self.world.remove(self.ids[*number])?,
                Change::Set(number, body) => {
                    let former = state.bodies[*number].unwrap_or(*body);
                    self.world.change(self.ids[*number], former, *body)?;
                }
                Change::Exclude(pair, excluded) => {
                    let pair = pair.map(|number| self.ids[number]);
                    self.is_told_wrong |= !self.world.exclude(pair, *excluded)?;
                }
                Change::Interest(numbers) => {
                    let of_interest = numbers.iter().filter(|n| state.bodies[**n].is_some());
                    let ids: Vec<_> = of_interest.map(|&number| self.ids[number]).collect();
                    self.world.interest(&ids)?;
                }
                Change::Save => {
                    let (state, before) = (self.world.save(), self.before.clone());
                    self.saved = Some((state, self.numbers.clone(), before));
                }
                Change::Restore => self.restore(frame)?,
                Change::Detour(kind) => self.is_told_wrong |= !self.world.detour(*kind)?,
            }
            state.take(change);
        }
        Ok(())
    }

    /// Goes back to the saved state, in every other frame in another world.
    fn restore(&mut self, frame: usize) -> Result<(), HistoryError> {
        let Some((saved, numbers, before)) = &self.saved else {
            return Ok(());
        };
        if frame % 2 == 1 {
            self.world = (self.make)(frame)?;
        }
        self.numbers.clone_from(numbers);
        self.before.clone_from(before);
        self.world.restore(saved)
    }

    /// Culls, and returns the pairs that are missed, and those on which the list, the events or the
    /// bodies are not what they must be. Events are not read in each frame.
    fn compare(&mut self, frame: usize, truth: &Truth) -> Result<[Pairs; 2], HistoryError> {
        let listed = self.world.cull()?;
        let is_sorted = listed.is_sorted_by(|one, next| one < next);
        let list = by_number(listed, &self.numbers);
        let missed = outside(&truth.required[frame], &list);
        let mut differ = match truth.may_lack {
            true => outside(&list, &truth.fresh[frame]),
            false => difference(&list, &truth.fresh[frame]),
        };
        if let Some(allowed) = &truth.allowed {
            differ.extend(outside(&list, &allowed[frame]));
        }
        if !is_sorted {
            differ.extend(list.first());
        }
        let present = self.states[frame].present();
        let mut wanted: Vec<_> = present.map(|(number, body)| (self.ids[number], body)).collect();
        wanted.sort_by_key(|(id, _)| *id); // images have slots of their own
        if wanted != self.world.all() || self.is_told_wrong {
            differ.push(NumberedPair::of([u32::MAX; 2]));
        }
        let is_read = frame % 3 != 2;
        if let Some(events) = is_read.then(|| self.world.events()).flatten() {
            // A pair that goes on in another image is the same.
            let bodies = |pairs: Pairs| {
                in_order(pairs.into_iter().map(|pair| NumberedPair { image: [0; 3], ..pair }))
            };
            let list = bodies(list);
            let (begun, ended) = (outside(&list, &self.before), outside(&self.before, &list));
            let lasting = outside(&list, &begun);
            for (told, wanted) in events.into_iter().zip([begun, lasting, ended]) {
                differ.extend(difference(&bodies(by_number(told, &self.numbers)), &wanted));
            }
            self.before = list;
        }
        Ok([missed, differ])
    }

    /// Lives through all frames.
    pub fn live(
        mut self,
        kind: WorldKind,
        mode: Mode,
        truth: &Truth,
        ledger: &mut ListLedger,
    ) -> Result<(), HistoryError> {
        for frame in 0..self.states.len() {
            self.change(frame)?;
            let [missed, differ] = self.compare(frame, truth)?;
            let kinds: Vec<ChangeKind> = match frame.checked_sub(1) {
                Some(before) => self.history.frames[before].iter().map(|one| one.0).collect(),
                None => Vec::new(),
            };
            for change in ChangeKind::ALL.iter().copied() {
                if kinds.contains(&change) && kind.has(change) {
                    ledger.coverage.count(Cell::of(Judged::World(kind, change), mode), 1);
                }
            }
            ledger.lists += 1;
            ledger.required += truth.required[frame].len() as u64;
            ledger.missed += missed.len() as u64;
            ledger.differ += differ.len() as u64;
            let wrong = missed.first().map(|pair| ("misses", pair));
            let wrong = wrong.or(differ.first().map(|pair| ("differs on", pair)));
            if let (Some((fault, pair)), None) = (wrong, &ledger.failure) {
                let names: Vec<&str> = kinds.iter().map(|kind| kind.name()).collect();
                ledger.failure = Some(format!(
                    "a world of {} {fault} {pair} in frame {frame} of a history, after {} \
                     ({}, {} threads)",
                    kind.name(),
                    names.join(", "),
                    mode.tier,
                    mode.threads
                ));
            }
        }
        Ok(())
    }
}

/// A history of given boxes in these modes.
///
/// # Errors
/// Threads that the system refuses, invalid boxes.
pub fn judge_boxes(history: &History<BoxBody>, modes: &[Mode]) -> Result<ListLedger, HistoryError> {
    let states = State::all(history)?;
    let truth = Truth::exact(required_boxes(&states)); // boxes are compared as they are
    let mut ledger = ListLedger::default();
    for (number, &mode) in modes.iter().enumerate() {
        let make = |turn| Ok(BoxWorld::with(&box_culler(finder(number + turn), mode))?);
        let life = Life::new(make, history, &states)?;
        life.live(WorldKind::Boxes, mode, &truth, &mut ledger)?;
    }
    Ok(ledger)
}

/// The pairs of boxes that a world must report after each frame, by their definition.
pub(super) fn required_boxes(states: &[State<BoxBody>]) -> Vec<Pairs> {
    let required = |state: &State<BoxBody>| {
        let (numbers, parts) = state.parts(|body| body.groups);
        let bodies: Vec<BoxBody> = state.present().map(|(_, body)| body).collect();
        let bounds: Vec<Aabb> = bodies.iter().map(|body| body.bounds).collect();
        let is_fixed = |at: &u32| bodies[*at as usize].motion == Motion::Fixed;
        let counts = |pair: &[u32; 2]| !parts(*pair) && !pair.iter().all(is_fixed);
        let meeting = meeting(&bounds).into_iter().filter(counts);
        let number = |at: u32| numbers[at as usize] as u32;
        in_order(meeting.map(|pair| NumberedPair::of(pair.map(number))))
    };
    states.iter().map(required).collect()
}

/// A history of meshes, by every strategy and overlap test that has a mode: `modes(n)` are those of
/// row number `n` of [`rows`].
///
/// # Errors
/// Settings that a world refuses, poses outside the contract.
pub fn judge_meshes(
    shapes: &Shapes,
    history: &History<Body>,
    variant: (DirectionSet, Axes),
    modes: impl Fn(usize) -> Vec<Mode>,
) -> Result<ListLedger, HistoryError> {
    let states = State::all(history)?;
    let rows = rows(variant).into_iter().enumerate();
    let rows = rows.map(|(number, row)| (row, modes(number)));
    let rows: Vec<_> = rows.filter(|(_, modes)| !modes.is_empty()).collect();
    let is_asked = |predicate: &Predicate| rows.iter().any(|(row, _)| needs(row, *predicate));
    let predicates: Vec<Predicate> = Predicate::ALL.into_iter().filter(is_asked).collect();
    let with_margins = with_margins(shapes)?;
    let answers = |state| answers(shapes, &with_margins, state, variant.0, &predicates);
    let answers = states.iter().map(answers).collect::<Result<Vec<_>, _>>()?;
    let mut ledger = ListLedger::default();
    for (way, modes) in rows {
        let required = states.iter().zip(&answers);
        let required: Vec<Pairs> =
            required.map(|(state, answers)| required_of(shapes, state, answers, &way)).collect();
        let mut truths: BTreeMap<&str, Truth> = BTreeMap::new();
        for (number, mode) in modes.into_iter().enumerate() {
            let plain = match mode.tier {
                Tier::SCALAR_FLUSH => mode.tier,
                _ => Tier::SCALAR,
            };
            if !truths.contains_key(plain.name()) {
                let truth = Truth {
                    required: required.clone(),
                    fresh: fresh_lists(shapes, &states, &way, plain)?,
                    may_lack: false,
                    allowed: None,
                };
                truths.insert(plain.name(), truth);
            }
            let make = |turn| {
                let way = CullSettings { pairs: finder(number + turn), ..way.clone() };
                world(shapes, &way, mode)
            };
            let life = Life::new(make, history, &states)?;
            life.live(WorldKind::of(&way), mode, &truths[plain.name()], &mut ledger)?;
        }
    }
    Ok(ledger)
}

/// Whether what a way must report follows from a predicate.
fn needs(way: &CullSettings, predicate: Predicate) -> bool {
    let strategy = way.strategy;
    match predicate {
        Predicate::OrDop(overlap) => strategy.scheme().has_overlap_test() && overlap == way.overlap,
        Predicate::Aabb => strategy == Strategy::Aabb,
        Predicate::KDop => strategy == Strategy::KDop,
        Predicate::Obb => strategy == Strategy::Obb,
        Predicate::Sphere => true,
        Predicate::Mesh => false,
    }
}

fn world(shapes: &Shapes, way: &CullSettings, mode: Mode) -> Result<World, HistoryError> {
    Ok(World::with(shapes.built.clone(), &culler(way, mode))?)
}

/// What all-pairs finds in newly built worlds.
fn fresh_lists(
    shapes: &Shapes,
    states: &[State<Body>],
    way: &CullSettings,
    tier: Tier,
) -> Result<Vec<Pairs>, HistoryError> {
    let way = CullSettings { pairs: Finder::AllPairs, ..way.clone() };
    let lists = states.iter().map(|state| {
        let world = world(shapes, &way, Mode::plain(tier))?;
        state.fresh(world)
    });
    lists.collect()
}

/// The shapes for the reference, each grown by every margin, rounded inward.
pub(super) fn with_margins(shapes: &Shapes) -> Result<Shapes, HistoryError> {
    let all = shapes.built.iter();
    let all = all.flat_map(|shape| MARGINS.map(|margin| grown(shape, margin)));
    Ok(Shapes { built: Vec::new(), judged: all.collect::<Result<_, _>>()?, widened: Vec::new() })
}

/// The number of a body's shape among those [`with_margins`].
pub(super) fn grown_shape(body: &Body) -> u32 {
    let margin = MARGINS.iter().position(|&known| known == body.margin);
    body.shape * MARGINS.len() as u32 + margin.unwrap_or(0) as u32
}

/// The exact answers about the present bodies, grown by their margins, each within its region.
pub(super) fn answers(
    shapes: &Shapes,
    grown: &Shapes,
    state: &State<Body>,
    k: DirectionSet,
    predicates: &[Predicate],
) -> Result<Answers, HistoryError> {
    let mut bodies = Bodies::default();
    for (_, body) in state.present() {
        let translation = place(&shapes.built, &body).1.map(|x| x as f32); // drawn as f32
        let is_dynamic = body.motion.is_dynamic();
        bodies.push(grown_shape(&body), is_dynamic, body.rotation, translation);
    }
    Ok(Answers::judge(grown, &bodies, k, predicates)?)
}

/// The pairs that a way must report.
pub(super) fn required_of(
    shapes: &Shapes,
    state: &State<Body>,
    answers: &Answers,
    way: &CullSettings,
) -> Pairs {
    let (numbers, parts) = state.parts(|body| body.groups);
    let interest: Vec<u32> = (0..)
        .zip(&numbers)
        .filter(|(_, number)| state.interest.contains(number))
        .map(|(at, _)| at)
        .collect();
    let (strategy, overlap) = (way.strategy, way.overlap);
    let regions: Vec<usize> =
        state.present().map(|(_, body)| place(&shapes.built, &body).0).collect();
    let is_near = |[i, j]: [u32; 2]| regions[i as usize] == regions[j as usize];
    let counted = answers.pairs.iter().enumerate().filter(|(n, pair)| {
        let is_required = || answers.required(strategy, overlap, &interest, *n);
        is_near(**pair) && !parts(**pair) && is_required()
    });
    let number = |at: u32| numbers[at as usize] as u32;
    in_order(counted.map(|(_, pair)| NumberedPair::of(pair.map(number))))
}
