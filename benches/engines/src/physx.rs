//! PhysX's broad phase, driven alone through its low-level interface: automatic box pruning (ABP).
//!
//! Objects are dynamic, each in a separate group, without a contact distance. Results are the pairs
//! that began and ended. ABP compares ends as they are.

#![allow(unsafe_code, reason = "PhysX is C++")]

use std::ptr;
use std::sync::OnceLock;

use miette::miette;
use physx_sys::{
    PxBounds3, PxBroadPhase, PxBroadPhase_release_mut, PxBroadPhase_update_mut_1,
    PxBroadPhaseDesc_new, PxBroadPhasePair, PxBroadPhaseResults, PxBroadPhaseResults_new,
    PxBroadPhaseType, PxBroadPhaseUpdateData_new, PxVec3, phys_PxCreateBroadPhase,
    phys_PxGetBroadPhaseDynamicFilterGroup, physx_create_foundation,
};

use sdop_judge::contestant::Contestant;

use crate::boxes::{Frame, Slabs};
use crate::changes::Changes;
use crate::entry::{Entry, Setup, Work};
use crate::incremental::{Change, Extras, Found, Incremental, MoverEntry, Moves};

const VERSION: &str = "5 (physx-sys 0.11.5)";

/// One way to drive it, on one thread.
pub const ENTRIES: [Entry; 1] = [Entry {
    name: "PhysX ABP",
    version: VERSION,
    work: Work::Boxes,
    threads: 1,
    ages: true,
    new: |setup| Ok(Box::new(PhysX::new(setup)?)),
}];

/// Given what has changed.
pub const MOVERS: [MoverEntry; 1] = [MoverEntry {
    name: "PhysX ABP",
    version: VERSION,
    margin: 0.0,
    extras: Extras::None,
    work: Work::Boxes,
    only: None,
    most_bodies: usize::MAX,
    new: |setup| Ok(Box::new(PhysX::new(setup)?)),
}];

struct PhysX {
    broad_phase: *mut PxBroadPhase,
    /// One element more than there are objects: PhysX reads past the end.
    bounds: Vec<PxBounds3>,
    groups: Vec<u32>,
    distances: Vec<f32>,
    objects: Vec<u32>,
    results: PxBroadPhaseResults,
    /// Those of the last frame, read.
    read: Vec<Change>,
    changes: Changes,
}

/// The process's one foundation; `false` when PhysX refuses.
fn has_foundation() -> bool {
    static MADE: OnceLock<bool> = OnceLock::new();
    // SAFETY: called once, as a singleton's constructor must be; it lives as long as the process.
    *MADE.get_or_init(|| !unsafe { physx_create_foundation() }.is_null())
}

impl PhysX {
    fn new(setup: &Setup<'_>) -> miette::Result<Self> {
        let objects: Vec<u32> = (0..setup.first.boxes.len() as u32).collect();
        // SAFETY: the foundation exists before anything else is asked for; descriptions are passed
        // by value or live on.
        let (broad_phase, groups) = unsafe {
            let broad_phase = if has_foundation() {
                phys_PxCreateBroadPhase(&PxBroadPhaseDesc_new(PxBroadPhaseType::Abp))
            } else {
                ptr::null_mut()
            };
            let group = |&object: &u32| phys_PxGetBroadPhaseDynamicFilterGroup(object);
            (broad_phase, objects.iter().map(group).collect())
        };
        if broad_phase.is_null() {
            return Err(miette!("PhysX makes no broad phase"));
        }
        // SAFETY: a plain value.
        let results = unsafe { PxBroadPhaseResults_new() };
        let mut physx = Self {
            broad_phase,
            bounds: Vec::new(),
            groups,
            distances: vec![0.0; objects.len() + 1],
            objects: Vec::new(),
            results,
            read: Vec::new(),
            changes: Changes::default(),
        };
        physx.take(setup.first);
        physx.update(&objects, &[]);
        physx.objects = objects;
        physx.settle();
        physx.read_results();
        Ok(physx)
    }

    fn take(&mut self, frame: &Frame) {
        self.bounds.clear();
        self.bounds.extend(frame.boxes.iter().map(bounds));
        self.bounds.push(bounds(&[[0.0; 2]; 3]));
    }

    fn update(&mut self, created: &[u32], updated: &[u32]) {
        // SAFETY: the columns have as many elements as there are objects, and one more where PhysX
        // reads past the end; they stay in place until the next call.
        unsafe {
            let data = PxBroadPhaseUpdateData_new(
                created.as_ptr(),
                created.len() as u32,
                updated.as_ptr(),
                updated.len() as u32,
                updated.as_ptr(),
                0,
                self.bounds.as_ptr(),
                self.groups.as_ptr(),
                self.distances.as_ptr(),
                self.groups.len() as u32,
            );
            PxBroadPhase_update_mut_1(self.broad_phase, &mut self.results, &data);
        }
    }

    /// What the last update has changed.
    fn changed(&self) -> impl Iterator<Item = Change> {
        let results = &self.results;
        let lists = [
            (results.mDeletedPairs, results.mNbDeletedPairs, false),
            (results.mCreatedPairs, results.mNbCreatedPairs, true),
        ];
        lists.into_iter().flat_map(|(pairs, count, begins)| {
            let pairs: &[PxBroadPhasePair] = match count {
                0 => &[],
                // SAFETY: PhysX keeps its lists until the next update.
                _ => unsafe { std::slice::from_raw_parts(pairs, count as usize) },
            };
            let change = move |pair: &PxBroadPhasePair| ([pair.mID0, pair.mID1], begins);
            pairs.iter().map(change)
        })
    }

    fn read_results(&mut self) {
        let mut read = std::mem::take(&mut self.read);
        read.clear();
        read.extend(self.changed());
        self.read = read;
    }
}

impl Contestant<Frame> for PhysX {
    fn frame(&mut self, frame: &Frame) {
        self.take(frame);
        let objects = std::mem::take(&mut self.objects);
        self.update(&[], &objects);
        self.objects = objects;
    }

    fn settle(&mut self) {
        let mut changes = std::mem::take(&mut self.changes);
        for (pair, begins) in self.changed() {
            changes.note(pair, begins);
        }
        self.changes = changes;
    }

    fn pairs(&self) -> Vec<[u32; 2]> {
        self.changes.pairs()
    }
}

impl Incremental for PhysX {
    fn frame(&mut self, moves: &Moves) {
        for (body, slabs) in moves.iter() {
            self.bounds[body as usize] = bounds(slabs);
        }
        self.update(&[], &moves.bodies);
        self.read_results();
    }

    fn found(&self) -> Found<'_> {
        Found::Changes(&self.read)
    }
}

impl Drop for PhysX {
    fn drop(&mut self) {
        // SAFETY: made by `phys_PxCreateBroadPhase` and released once.
        unsafe { PxBroadPhase_release_mut(self.broad_phase) };
    }
}

fn bounds(&[x, y, z]: &Slabs) -> PxBounds3 {
    let corner = |side: usize| PxVec3 { x: x[side], y: y[side], z: z[side] };
    PxBounds3 { minimum: corner(0), maximum: corner(1) }
}
