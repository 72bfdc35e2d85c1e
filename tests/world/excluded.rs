//! Excluded pairs: whatever comes and goes, a world reports the pairs that it would report
//! otherwise, without those that are excluded now.

use super::*;

fn sorted(a: BodyId, b: BodyId) -> [BodyId; 2] {
    [a.min(b), a.max(b)]
}

/// What a world has, and the pairs that it must not report, as sets of their own.
#[derive(Default)]
struct Model {
    bodies: HashMap<BodyId, Body>,
    excluded: BTreeSet<[BodyId; 2]>,
    reported: Pairs,
}

impl Model {
    fn any(&self, random: &mut Random) -> BodyId {
        let mut ids: Vec<BodyId> = self.bodies.keys().copied().collect();
        ids.sort();
        ids[random.below(ids.len() as u32) as usize]
    }

    fn change(&mut self, world: &mut World, random: &mut Random) {
        match random.below(6) {
            0 if self.bodies.len() > 20 => {
                let gone = self.any(random);
                world.remove(gone).unwrap();
                self.bodies.remove(&gone);
                self.excluded.retain(|pair| !pair.contains(&gone));
            }
            1..=3 if self.bodies.len() > 2 => {
                let [a, b] = [self.any(random), self.any(random)];
                let is_new = a != b && self.excluded.insert(sorted(a, b));
                assert_eq!(world.exclude(a, b).unwrap(), is_new);
            }
            4 if !self.excluded.is_empty() => {
                let at = random.below(self.excluded.len() as u32) as usize;
                let [a, b] = *self.excluded.iter().nth(at).unwrap();
                self.excluded.remove(&[a, b]);
                assert!(world.include(b, a).unwrap() && !world.include(a, b).unwrap());
            }
            _ => {
                let mut body = random.body(3);
                // Closer together, so that more of them meet; f32 still holds the numbers.
                body.translation = body.translation.map(|x| 0.25 * x);
                self.bodies.insert(world.insert(body).unwrap(), body);
            }
        }
    }

    /// Culls the world, and checks pairs and events. Returns how many would be reported, and how
    /// many of them aren't.
    fn check(&mut self, world: &mut World, way: &CullSettings) -> [usize; 2] {
        let mut wanted = afresh(&shapes(), way, &self.bodies);
        let all = wanted.len();
        wanted.retain(|pair| !self.excluded.contains(pair));
        world.cull().unwrap();
        let found: Pairs = world.pairs().collect();
        assert_eq!(found, wanted, "{way:?}");
        let events = world.events();
        assert!(events.begun().eq(wanted.difference(&self.reported).copied()));
        assert!(events.ended().eq(self.reported.difference(&wanted).copied()));
        assert_eq!(world.excluded(), Vec::from_iter(self.excluded.iter().copied()));
        self.reported = wanted;
        [all, all - self.reported.len()]
    }
}

/// Budgets are spent on the pairs that are left, so that those ways report other pairs.
fn is_spending(way: &CullSettings) -> bool {
    way.strategy == Strategy::SDopTimeCritical
}

/// Excluded pairs are left out in every way of culling.
#[test]
fn exclusions_hold_in_every_way() {
    let mut counted = 0;
    for way in ways().into_iter().filter(|way| !is_spending(way)) {
        let mut random = Random(ChaCha8Rng::seed_from_u64(47));
        let mut world = World::with(shapes(), &Culler::builder().settings(&way)).unwrap();
        let (mut model, mut sum) = (Model::default(), [0; 2]);
        for _ in 0..12 {
            for _ in 0..20 {
                model.change(&mut world, &mut random);
            }
            let [all, left_out] = model.check(&mut world, &way);
            sum = [sum[0] + all, sum[1] + left_out];
        }
        // Without bodies of interest some ways report nothing.
        assert!(sum[0] == 0 || sum[1] > 10, "{way:?}: {sum:?}");
        counted += usize::from(sum[1] > 0);
    }
    assert!(counted > 40, "{counted} ways");
}

/// A pair is lost and comes back although no body has changed.
#[test]
fn exclusions_alone_change_pairs() {
    let mut counted = 0;
    for way in ways().into_iter().filter(|way| !is_spending(way)) {
        let mut random = Random(ChaCha8Rng::seed_from_u64(50));
        let mut world = World::with(shapes(), &Culler::builder().settings(&way)).unwrap();
        let mut model = Model::default();
        for _ in 0..60 {
            let mut body = random.body(3);
            body.translation = body.translation.map(|x| 0.5 * x);
            model.bodies.insert(world.insert(body).unwrap(), body);
        }
        model.check(&mut world, &way);
        for pair in model.reported.clone().into_iter().take(4) {
            let [a, b] = pair;
            assert!(world.exclude(a, b).unwrap() && model.excluded.insert(pair));
            model.check(&mut world, &way);
            assert!(world.include(b, a).unwrap() && model.excluded.remove(&pair));
            model.check(&mut world, &way);
            counted += 1;
        }
    }
    assert!(counted > 80, "{counted} pairs");
}

#[test]
fn restored_worlds_exclude_the_same_pairs() {
    let way = &CullSettings::all_pairs();
    let mut random = Random(ChaCha8Rng::seed_from_u64(48));
    let mut world = World::with(shapes(), &Culler::builder().settings(way)).unwrap();
    let mut model = Model::default();
    for _ in 0..80 {
        model.change(&mut world, &mut random);
    }
    model.check(&mut world, way);
    let saved = serde_json::to_value(world.snapshot()).unwrap();
    let mut other = World::with(shapes(), &Culler::builder().settings(way)).unwrap();
    let [a, b] = [(); 2].map(|()| other.insert(Body::default()).unwrap());
    other.exclude(a, b).unwrap();
    other.restore(&serde_json::from_value(saved.clone()).unwrap()).unwrap();
    assert_eq!(other.snapshot(), world.snapshot());
    world.shrink_to_fit();
    for world in [&mut world.clone(), &mut other, &mut world] {
        let mut model = Model {
            bodies: model.bodies.clone(),
            excluded: model.excluded.clone(),
            reported: model.reported.clone(),
        };
        let mut random = Random(ChaCha8Rng::seed_from_u64(49));
        for _ in 0..30 {
            model.change(world, &mut random);
            model.check(world, way);
        }
    }
    // Snapshots of before have none; damaged ones are refused.
    let mut without = saved.clone();
    without.as_object_mut().unwrap().remove("excluded");
    other.restore(&serde_json::from_value(without).unwrap()).unwrap();
    assert!(other.excluded().is_empty());
    for bad in [[[1, 0]], [[2, 2]], [[0, 9999]]] {
        let mut damaged = saved.clone();
        damaged["excluded"] = serde_json::json!(bad);
        let damaged = serde_json::from_value(damaged).unwrap();
        let error = other.restore(&damaged).unwrap_err().to_string();
        assert!(error.contains("excluded pairs that there can't be"), "{error}");
    }
}

#[test]
fn removed_bodies_have_no_pairs() {
    let mut world = World::new(shapes()).unwrap();
    let [a, b] = [(); 2].map(|()| world.insert(Body::default()).unwrap());
    world.exclude(a, b).unwrap();
    assert!(world.is_excluded(b, a));
    world.remove(a).unwrap();
    assert!(!world.is_excluded(a, b) && world.excluded().is_empty());
    assert_eq!(world.exclude(a, b), Err(WorldError::Gone(a)));
    assert_eq!(world.include(b, a), Err(WorldError::Gone(a)));
    world.cull().unwrap();
    let next = world.insert(Body::default()).unwrap();
    assert_eq!(next.slot(), a.slot());
    assert_eq!(world.cull().unwrap().len(), 1, "another body in the slot is another pair");
    assert_eq!(world.exclude(next, next), Ok(false));
}
