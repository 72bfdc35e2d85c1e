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

use super::events::{Change, Events};
use crate::entry::{New, Setup};
use crate::frame::{Frame, Slabs};

/// One way to drive it, on one thread.
pub const ENGINES: [(&str, New); 1] = [("PhysX ABP", |setup| Ok(Box::new(PhysX::new(setup)?)))];

struct PhysX {
    broad_phase: *mut PxBroadPhase,
    /// One element more than there are objects: PhysX reads past the end.
    bounds: Vec<PxBounds3>,
    groups: Vec<u32>,
    distances: Vec<f32>,
    /// All, for frames in which all change.
    objects: Vec<u32>,
    results: PxBroadPhaseResults,
    events: Events,
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
            bounds: vec![bounds(&[[0.0; 2]; 3]); objects.len() + 1],
            groups,
            distances: vec![0.0; objects.len() + 1],
            objects: Vec::new(),
            results,
            events: Events::default(),
        };
        physx.take(setup.first);
        physx.update(&objects, &[]);
        physx.objects = objects;
        Ok(physx)
    }

    fn take(&mut self, frame: &Frame) {
        for (body, slabs) in frame.changes() {
            self.bounds[body as usize] = bounds(slabs);
        }
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
        let mut read = std::mem::take(&mut self.events.last);
        read.clear();
        read.extend(self.changed());
        self.events.last = read;
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
}

impl Contestant<Frame> for PhysX {
    fn frame(&mut self, frame: &Frame) {
        self.take(frame);
        let objects = std::mem::take(&mut self.objects);
        self.update(&[], frame.changed.as_ref().unwrap_or(&objects));
        self.objects = objects;
    }

    fn settle(&mut self) {
        self.events.settle();
    }

    fn pairs(&self) -> Vec<[u32; 2]> {
        self.events.pairs()
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
