//! Worlds that are saved and restored, cloned or rolled back go on as if nothing had happened: the
//! same ids, pairs, order and events, at every frame of random histories, in which shapes come and
//! go, too.

use sdop::culler::{Culler, CullerBuilder};
use sdop::mesh::ProceduralShape;
use sdop::settings::{Budget, CullSettings, Finder, Order, Strategy};
use sdop::volume::{Shape, ShapeSpec};
use sdop::world::{Body, BodyId, Event, World, WorldSnapshot};

use super::{Random, shapes};

/// What a frame does to a world, drawn once and done to each of them.
#[derive(Clone, Debug)]
enum Call {
    Insert(Body),
    Remove(BodyId),
    Set(BodyId, Body),
    Pose(BodyId, [f32; 4], [f64; 3]),
    Interest(Vec<BodyId>),
    AddShape(u32),
    RemoveShape(u32),
    ReplaceShape(u32, u32),
    Shrink,
    /// Culls, and whether events are read.
    Cull(bool),
}

/// What a call returns.
#[derive(Debug, PartialEq)]
enum Answer {
    Id(Option<BodyId>),
    Shape(Option<u32>),
    Done(bool),
    Frame(Vec<[BodyId; 2]>, Vec<Event>),
}

/// A box whose sides follow from a number.
fn box_of(number: u32) -> Shape {
    let side = |n: u32| 0.5 + (n % 5) as f32 / 2.0;
    let mesh =
        ProceduralShape::Box { x: side(number), y: side(number / 5 + 1), z: side(number / 3 + 2) };
    Shape::build(&mesh.build().unwrap(), &ShapeSpec::default()).unwrap()
}

fn carry_out(world: &mut World, call: &Call) -> Answer {
    match call.clone() {
        Call::Insert(body) => Answer::Id(world.insert(body).ok()),
        Call::Remove(id) => Answer::Done(world.remove(id).is_ok()),
        Call::Set(id, body) => Answer::Done(world.set(id, body).is_ok()),
        Call::Pose(id, turn, place) => Answer::Done(world.set_pose(id, turn, place).is_ok()),
        Call::Interest(ids) => Answer::Done(world.set_interest(&ids).is_ok()),
        Call::AddShape(number) => Answer::Shape(world.add_shape(box_of(number)).ok()),
        Call::RemoveShape(shape) => Answer::Done(world.remove_shape(shape).is_ok()),
        Call::ReplaceShape(shape, number) => {
            Answer::Done(world.replace_shape(shape, &box_of(number)).is_ok())
        }
        Call::Shrink => {
            world.shrink_to_fit();
            Answer::Done(true)
        }
        Call::Cull(reads) => {
            let pairs: Vec<_> = world.cull().unwrap().iter().collect();
            assert!(pairs.is_sorted_by(|a, b| a < b), "in the order of slots");
            assert!(world.pairs().eq(pairs.iter().copied()));
            let events = match reads {
                true => world.events().iter().collect(),
                false => Vec::new(),
            };
            Answer::Frame(pairs, events)
        }
    }
}

/// The calls of the next frame of a world in this state.
fn drawn(random: &mut Random, world: &World, moves_only: bool) -> Vec<Call> {
    let mut calls = Vec::new();
    let shapes: Vec<u32> = world.shapes().collect();
    let body = |random: &mut Random| {
        let shape = shapes[random.below(shapes.len() as u32) as usize];
        let margin = random.below(3) as f32 * 0.1 * random.below(4) as f32;
        let drawn = super::drawn(random, 1);
        let translation = drawn.translation.map(|x| 0.75 * x + 1.0e-9);
        Body { shape, margin, translation, ..drawn }
    };
    for id in world.ids() {
        match random.below(12) {
            0 if !moves_only => calls.push(Call::Remove(id)),
            1 if !moves_only => calls.push(Call::Set(id, body(random))),
            2..6 => {
                let there = body(random);
                calls.push(Call::Pose(id, there.rotation, there.translation));
            }
            _ => {}
        }
    }
    if !moves_only {
        for _ in 0..random.below(16) {
            calls.push(Call::Insert(body(random)));
        }
        let number = random.below(75);
        let shape = random.below(shapes.len() as u32 + 2);
        match random.below(4) {
            0 => calls.push(Call::AddShape(number)),
            1 if shapes.len() > 1 => calls.push(Call::RemoveShape(shape)),
            2 => calls.push(Call::ReplaceShape(shape, number)),
            _ => {}
        }
        if random.below(6) == 0 {
            calls.push(Call::Shrink);
        }
    }
    let all: Vec<BodyId> = world.ids().collect();
    if random.below(3) == 0 {
        let of = |random: &mut Random| all[random.below(all.len() as u32) as usize];
        let few = if all.is_empty() { 0 } else { 4 };
        calls.push(Call::Interest((0..few).map(|_| of(random)).collect()));
    }
    calls.push(Call::Cull(random.below(3) > 0));
    calls
}

/// Every strategy; of the one with a budget, every order in which it is spent.
fn strategies() -> Vec<CullSettings> {
    let mut all = Vec::new();
    for &strategy in Strategy::ALL {
        let has_budget = strategy == Strategy::SDopTimeCritical;
        for &order in if has_budget { Order::ALL } else { &Order::ALL[..1] } {
            all.push(CullSettings {
                strategy,
                order,
                budget: has_budget.then_some(Budget::Tests(17)),
                ..CullSettings::default()
            });
        }
    }
    all
}

/// Finders and threads: nothing that a world reports may depend on them.
fn builders(settings: &CullSettings) -> Vec<CullerBuilder> {
    let with = |finder| Culler::builder().settings(settings).finder(finder);
    let mut all: Vec<_> = Finder::ALL.iter().map(|&finder| with(finder)).collect();
    all.push(with(Finder::Grid).threads(3).worth_waking(0));
    all
}

fn through_text(snapshot: &WorldSnapshot) -> WorldSnapshot {
    serde_json::from_str(&serde_json::to_string(snapshot).unwrap()).unwrap()
}

/// An empty world with the shapes of another, of which all that were ever used are known.
fn like(world: &World, forms: &[Option<Shape>], builder: &CullerBuilder) -> World {
    let mut other = World::with(Vec::new(), builder).unwrap();
    for (number, form) in (0..).zip(forms) {
        let shape = form.clone().unwrap_or_else(|| box_of(0));
        assert_eq!(other.add_shape(shape), Ok(number));
    }
    for (number, form) in (0..).zip(forms) {
        if form.is_none() {
            other.remove_shape(number).unwrap();
        }
    }
    assert!(other.shapes().eq(world.shapes()));
    other
}

/// Keeps the shapes of each number, as calls change them.
fn note(forms: &mut Vec<Option<Shape>>, call: &Call, answer: &Answer) {
    match (call, answer) {
        (Call::AddShape(number), Answer::Shape(Some(at))) => {
            let at = *at as usize;
            forms.resize(forms.len().max(at + 1), None);
            forms[at] = Some(box_of(*number));
        }
        (Call::RemoveShape(at), Answer::Done(true)) => forms[*at as usize] = None,
        (Call::ReplaceShape(at, number), Answer::Done(true)) => {
            forms[*at as usize] = Some(box_of(*number));
        }
        _ => {}
    }
}

const FRAMES: usize = 10;

/// At every frame a snapshot is restored in another world, with another finder and other threads,
/// and in a clone that has gone astray; both do what the world does from then on.
#[test]
fn restored_worlds_go_on_alike() {
    for (number, settings) in strategies().into_iter().enumerate() {
        let builders = builders(&settings);
        let mut random = Random::new(number as u64);
        let mut world = World::with(shapes(), &builders[0]).unwrap();
        let mut forms: Vec<_> = shapes().into_iter().map(Some).collect();
        let mut followers: Vec<World> = Vec::new();
        let mut seen = 0;
        for frame in 0..FRAMES {
            let calls = drawn(&mut random, &world, frame % 4 == 3);
            let mut astray = world.clone();
            let saved = through_text(&world.snapshot());
            let builder = &builders[(number + frame) % builders.len()];
            let mut other = like(&world, &forms, builder);
            other.restore(&saved).unwrap();
            assert_eq!(other.snapshot(), saved, "what was restored is what was saved");
            for call in drawn(&mut random, &astray, true) {
                carry_out(&mut astray, &call);
            }
            astray.restore(&saved).unwrap();
            followers.extend([other, astray]);
            for call in &calls {
                let answer = carry_out(&mut world, call);
                for (number, follower) in followers.iter_mut().enumerate() {
                    let theirs = carry_out(follower, call);
                    assert_eq!(theirs, answer, "{settings:?}: {number}, frame {frame}");
                }
                note(&mut forms, call, &answer);
                if let Answer::Frame(pairs, _) = answer {
                    seen += pairs.len();
                }
            }
            let now = world.snapshot();
            assert!(followers.iter().all(|follower| follower.snapshot() == now));
        }
        assert!(seen > 0 || settings.strategy == Strategy::None, "{settings:?}");
    }
}

/// A world in its third frame, with pairs, and bodies and shapes that have gone.
fn lived(settings: &CullSettings) -> World {
    let mut random = Random::new(2);
    let mut world = World::with(shapes(), &Culler::builder().settings(settings)).unwrap();
    for _ in 0..30 {
        world.insert(super::drawn(&mut random, 3)).unwrap();
    }
    world.cull().unwrap();
    world.events();
    let ids: Vec<BodyId> = world.ids().collect();
    for &id in &ids[..9] {
        world.remove(id).unwrap();
    }
    world.cull().unwrap();
    world.remove(ids[12]).unwrap();
    world.remove(ids[17]).unwrap();
    for _ in 0..4 {
        world.insert(super::drawn(&mut random, 3)).unwrap();
    }
    world
}

fn budgeted() -> CullSettings {
    CullSettings {
        strategy: Strategy::SDopTimeCritical,
        order: Order::OldestAnswer,
        budget: Some(Budget::Tests(3)),
        ..CullSettings::default()
    }
}

/// Each number of a snapshot's text in turn becomes another, each list shorter or longer: an error,
/// or a world that culls.
#[test]
fn damaged_snapshots_are_rejected() {
    let world = lived(&budgeted());
    let whole = serde_json::to_value(world.snapshot()).unwrap();
    assert!(!whole["answers"].as_array().unwrap().is_empty());
    let mut paths = Vec::new();
    leaves(&whole, String::new(), &mut paths);
    let nan = serde_json::json!(f32::NAN.to_bits());
    let (mut refused, mut tried) = (0, 0);
    for path in paths {
        let changes: [&dyn Fn(&mut serde_json::Value); 5] = [
            &|value| *value = serde_json::json!(u32::MAX),
            &|value| *value = serde_json::json!(0),
            &|value| *value = nan.clone(),
            &|value| {
                if let Some(list) = value.as_array_mut() {
                    list.pop();
                }
            },
            &|value| {
                if let Some(list) = value.as_array_mut() {
                    list.extend(list.first().cloned());
                }
            },
        ];
        for change in changes {
            let mut text = whole.clone();
            change(text.pointer_mut(&path).unwrap());
            let Ok(snapshot) = serde_json::from_value::<WorldSnapshot>(text) else {
                refused += 1;
                continue;
            };
            tried += 1;
            let mut other = world.clone();
            match other.restore(&snapshot) {
                Err(_) => {
                    refused += 1;
                    assert_eq!(other.snapshot(), world.snapshot(), "{path}");
                }
                Ok(()) => assert_eq!(other.snapshot(), snapshot, "{path}"),
            }
            for _ in 0..2 {
                other.cull().unwrap();
                other.events().iter().count();
                other.insert(Body::default()).unwrap();
            }
        }
    }
    assert!(refused > 300 && tried > 300, "{refused} of {tried}");
}

/// The paths of all numbers and lists, of long lists those at both ends.
fn leaves(value: &serde_json::Value, path: String, found: &mut Vec<String>) {
    match value {
        serde_json::Value::Array(list) => {
            found.push(path.clone());
            let last = list.len().saturating_sub(3);
            for (at, entry) in list.iter().enumerate() {
                if at < 3 || at >= last {
                    leaves(entry, format!("{path}/{at}"), found);
                }
            }
        }
        serde_json::Value::Object(map) => {
            for (key, entry) in map {
                leaves(entry, format!("{path}/{key}"), found);
            }
        }
        _ => found.push(path),
    }
}

#[test]
fn each_damage_is_named() {
    let world = lived(&CullSettings::default());
    let whole = serde_json::to_value(world.snapshot()).unwrap();
    let message = |path: &str, value: serde_json::Value| {
        let mut text = whole.clone();
        *text.pointer_mut(path).unwrap() = value;
        let snapshot: WorldSnapshot = serde_json::from_value(text).unwrap();
        world.clone().restore(&snapshot).unwrap_err().problem()
    };
    let number = |n: u32| serde_json::json!(n);
    let nan = f64::NAN.to_bits();
    for (path, value, wanted) in [
        ("/rotation/20", serde_json::json!([0, 0, 0, 0]), "rotation [0.0, 0.0"),
        ("/translation/20/1", serde_json::json!(nan), "translation"),
        ("/margin/20", number(f32::NAN.to_bits()), "margin NaN"),
        ("/shape/20", number(7), "slot 27 has shape 7"),
        ("/margin", serde_json::json!([]), "`margin` has 0 entries for 23 bodies"),
        ("/ids/free/0/0", number(900), "vacant slots"),
        ("/ids/free/0", whole["ids"]["free"][1].clone(), "in two states"),
        ("/ids/free", serde_json::json!([]), "vacant slots"),
        ("/pairs/last/1/0", number(30), "pair"),
        ("/pairs/last/0/0", number(29), "the pair 29"),
        ("/pairs/last/0", serde_json::json!([]), "halves of pairs"),
    ] {
        let told = message(path, value);
        assert!(told.contains(wanted), "{path}: {told}");
    }
    let mut text = whole.clone();
    text["version"] = number(1);
    let refused = serde_json::from_value::<WorldSnapshot>(text).unwrap_err();
    assert!(refused.to_string().contains("snapshot of version 1"), "{refused}");
}

#[test]
fn another_shape_is_refused_by_name() {
    let world = lived(&CullSettings::default());
    let saved = world.snapshot();
    let builder = Culler::builder();
    let mut others = shapes();
    others[1] = box_of(3);
    let mut other = World::with(others, &builder).unwrap();
    let told = other.restore(&saved).unwrap_err().problem();
    assert!(told.starts_with("shape 1 of the snapshot is `"), "{told}");
    assert!(other.is_empty() && told.contains("another shape"), "{told}");
    let mut fewer = World::with(shapes()[..2].to_vec(), &builder).unwrap();
    let told = fewer.restore(&saved).unwrap_err().problem();
    assert!(told.contains("none of that number"), "{told}");
    assert_eq!(fewer.add_shape(shapes()[2].clone()), Ok(2));
    assert_eq!(fewer.add_shape(box_of(7)), Ok(3), "more of them do no harm");
    fewer.restore(&saved).unwrap();
    assert!(fewer.bodies().eq(world.bodies()));
}
