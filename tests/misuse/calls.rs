//! When each public method may be called, and what its answer is about.

use std::collections::BTreeMap;
use std::fmt::Display;
use std::path::Path;

use sdop::compound::{Compound, Part, PartCuller};
use sdop::periodic::{PeriodicBox, PeriodicBoxes, PeriodicIndex, PeriodicWorld};
use sdop::query::QuerySource;
use sdop::{Aabb, Body, BoxCuller, BoxWorld, Line, QueryIndex, QueryVolume, World};

use super::*;

/// The states in which methods are called: before any cull or update; after bodies have moved since
/// then; after one was removed; after a world was restored from before the move; after a cull that
/// listed no pairs.
const STATES: [&str; 5] = ["new", "moved", "removed", "restored", "unlisted"];

/// For each method that answers about pairs or places of bodies, one letter per state: `n`ow, as the
/// bodies are; `l`ast, as they were in the last cull or update, which the documentation says; `!`,
/// an error that says what to call; `-`, no such state.
const ANSWERS: [(&str, &str, &str); 33] = [
    ("Culler", "cull", "nn-nn"),
    ("Culler", "cull_in_portions", "nn-nn"),
    ("Culler", "cull_up_to", "nn-nn"),
    ("Culler", "pairs", "ll-ll"),
    ("BoxCuller", "cull", "nn-nn"),
    ("BoxCuller", "cull_in_portions", "nn-nn"),
    ("BoxCuller", "cull_up_to", "nn-nn"),
    ("BoxCuller", "pairs", "ll-ll"),
    ("World", "cull", "nnnnn"),
    ("World", "cull_in_portions", "nnnnn"),
    ("World", "cull_up_to", "nnnnn"),
    ("World", "pairs", "lllll"),
    ("World", "events", "lllll"),
    ("BoxWorld", "cull", "nnnnn"),
    ("BoxWorld", "cull_in_portions", "nnnnn"),
    ("BoxWorld", "cull_up_to", "nnnnn"),
    ("BoxWorld", "pairs", "lllll"),
    ("BoxWorld", "events", "lllll"),
    ("Periodic", "cull", "nnn--"),
    ("Periodic", "pairs", "lll--"),
    ("Periodic", "events", "lll--"),
    ("PartCuller", "cull", "!!!!!"),
    ("PartCuller", "pairs", "lllll"),
    ("PartCuller", "body_pairs", "lllll"),
    ("QueryIndex", "touching", "!ll--"),
    ("QueryIndex", "touching_all", "!ll--"),
    ("QueryIndex", "along", "!ll--"),
    ("QueryIndex", "along_all", "!ll--"),
    ("QueryIndex", "first", "!ll--"),
    ("QueryIndex", "first_all", "!ll--"),
    ("QueryIndex", "first_judged", "!ll--"),
    ("QueryIndex", "pairs_with", "!ll--"),
    ("PeriodicIndex", "touching", "!ll--"),
];

/// The other methods: they change a set, say what was set, or count.
const OTHERS: [(&str, &str); 9] = [
    (
        "Culler",
        "add_shape builder counters finder finder_bytes list_tests pair_bytes \
         potentially_colliding refresh seconds set_groups shrink_to_fit",
    ),
    ("BoxCuller", "builder counters list_tests new pair_bytes set_groups shrink_to_fit"),
    (
        "World",
        "add_shape bodies body contains counters exclude excluded finder ids include insert \
         is_empty is_excluded len new pair_bytes remove remove_shape replace_shape restore seconds \
         set set_interest set_motion set_pose shapes shrink_to_fit slots snapshot with",
    ),
    (
        "BoxWorld",
        "bodies body contains counters exclude excluded ids include insert is_empty is_excluded \
         len new pair_bytes remove rest_counters restore set set_bounds set_many set_motion \
         shrink_to_fit slots snapshot with",
    ),
    (
        "Periodic",
        "body contains exclude ids images include insert is_excluded periods remove set \
         set_periods",
    ),
    ("PartCuller", "new remove_parts set_parts"),
    ("QueryIndex", "is_empty len new on_tier update with_threads"),
    ("PeriodicIndex", "new on_tier touching_all update with_threads"),
    ("PeriodicBoxes", "new with"),
];

/// Every public method of these types is in one of the tables.
#[test]
fn every_method_has_a_row() {
    let mut found: BTreeMap<String, Vec<String>> = BTreeMap::new();
    let mut folders = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("src")];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let (mut of, mut is_hidden) = (None, false);
            for line in std::fs::read_to_string(path).unwrap_or_default().lines() {
                if let Some(head) = line.strip_prefix("impl") {
                    let head = head.split_once("> ").map_or(head, |(generic, rest)| {
                        if generic.starts_with('<') { rest } else { head }
                    });
                    let name = head.trim_start().split(['<', ' ']).next().unwrap_or_default();
                    of = OTHERS.iter().find(|(known, _)| *known == name && !head.contains(" for "));
                }
                is_hidden |= line.contains("#[doc(hidden)]");
                if let Some(method) = line.strip_prefix("    pub fn ") {
                    if let Some((of, _)) = of.filter(|_| !is_hidden) {
                        let method = method.split(['(', '<']).next().unwrap_or_default();
                        found.entry((*of).to_owned()).or_default().push(method.to_owned());
                    }
                    is_hidden = false;
                }
            }
        }
    }
    for (of, others) in OTHERS {
        let answering = ANSWERS.iter().filter(|row| row.0 == of).map(|row| row.1);
        let mut known: Vec<&str> = others.split_whitespace().chain(answering).collect();
        let mut found = found.remove(of).unwrap_or_default();
        known.sort_unstable();
        found.sort_unstable();
        found.dedup();
        found.retain(|method| !(of == "Culler" && method == "new"));
        assert_eq!(found, known, "{of}");
    }
}

/// How many pairs or bodies each method finds; an error must say what to call.
type Answers = Vec<(&'static str, &'static str, Option<usize>)>;

fn found<E: Display>(answer: Result<usize, E>) -> Option<usize> {
    answer.map_err(|error| assert!(error.to_string().contains("; call `"), "{error}")).ok()
}

/// Compares answers in a state with the table: `now` and `last` are what there is to find.
fn check(state: usize, now: usize, last: usize, answers: Answers) {
    for (of, method, answer) in answers {
        let row = ANSWERS.iter().find(|row| (row.0, row.1) == (of, method)).unwrap();
        let wanted = match row.2.as_bytes()[state] {
            b'n' => Some(now),
            b'l' => Some(last),
            b'!' => None,
            other => panic!("{of}::{method} is called in state {other}"),
        };
        assert_eq!(answer, wanted, "{of}::{method}, {}", STATES[state]);
    }
}

macro_rules! of_world {
    ($of:literal, $world:expr) => {{
        let mut portions = 0;
        let in_portions = $world.clone().cull_in_portions(|portion| portions += portion.len());
        assert_eq!(in_portions.unwrap(), portions as u64);
        vec![
            ($of, "cull", found($world.clone().cull().map(|pairs| pairs.len()))),
            ($of, "cull_in_portions", Some(portions)),
            ($of, "cull_up_to", found($world.clone().cull_up_to(9).map(|pairs| pairs.len()))),
            ($of, "pairs", Some($world.pairs().len())),
            ($of, "events", Some($world.clone().events().iter().count())),
        ]
    }};
}

macro_rules! of_culler {
    ($of:literal, $culler:expr, $now:expr) => {{
        let mut portions = 0;
        $culler.clone().cull_in_portions($now, |portion| portions += portion.len()).unwrap();
        vec![
            ($of, "cull", found($culler.clone().cull($now).map(|pairs| pairs.len()))),
            ($of, "cull_in_portions", Some(portions)),
            (
                $of,
                "cull_up_to",
                found($culler.clone().cull_up_to($now, 9).map(|pairs| pairs.len())),
            ),
            ($of, "pairs", Some($culler.pairs().len())),
        ]
    }};
}

fn of_parts(parts: &PartCuller, world: &World) -> Answers {
    vec![
        ("PartCuller", "cull", found(parts.clone().cull(world).map(<[_]>::len))),
        ("PartCuller", "pairs", Some(parts.pairs().len())),
        ("PartCuller", "body_pairs", Some(parts.body_pairs().count())),
    ]
}

/// The two bodies are on a line and in a box.
fn of_index(index: &QueryIndex) -> Answers {
    let around = QueryVolume::Box { min: [-9.0; 3], max: [9.0; 3] };
    let line = Line::Segment { from: [-9.0, 0.5, 0.5], to: [9.0, 0.5, 0.5] };
    let one = |hit: Option<_>| usize::from(hit.is_some());
    let judged = index.first_judged(&line, |hit| Some(hit.at));
    // A first body is found whether there are one or two.
    let of_first = |found: Option<usize>| found.map(|count| count * index.len());
    let squares = index.pairs_with(index).map(|pairs| pairs.len().isqrt());
    vec![
        ("QueryIndex", "touching", found(index.touching(&around).map(|ids| ids.len()))),
        (
            "QueryIndex",
            "touching_all",
            found(index.touching_all(&[around]).map(|all| all.of(0).len())),
        ),
        ("QueryIndex", "along", found(index.along(&line).map(|hits| hits.len()))),
        ("QueryIndex", "along_all", found(index.along_all(&[line]).map(|all| all.of(0).len()))),
        ("QueryIndex", "first", of_first(found(index.first(&line).map(one)))),
        (
            "QueryIndex",
            "first_all",
            of_first(found(index.first_all(&[line]).map(|all| all.of(0).len()))),
        ),
        ("QueryIndex", "first_judged", of_first(found(judged.map(one)))),
        ("QueryIndex", "pairs_with", found(squares)),
    ]
}

fn check_index(world: &impl QuerySource, state: usize, index: &mut QueryIndex, last: usize) {
    check(state, 0, last, of_index(index));
    index.update(world);
}

fn cube_at(x: f32) -> Aabb {
    Aabb::new([x, 0.0, 0.0], [x + 1.0, 1.0, 1.0])
}

fn body_at(x: f64) -> Body {
    Body::at(0, UNTURNED, [x, 0.5, 0.5])
}

#[test]
fn worlds_answer_about_present_bodies() {
    let shapes = vec![shapes()[0].clone()];
    let compound = Compound::build("one", &shapes, &[Part::default()]).unwrap();
    let (mut boxes, mut world) =
        (BoxWorld::new(), World::new(vec![compound.shape().clone()]).unwrap());
    let mut parts = PartCuller::new();
    parts.set_parts(0, compound);
    let [mut of_boxes, mut of_bodies] = [QueryIndex::new(), QueryIndex::new()];
    let boxed = [0.0, 0.5].map(|x| boxes.insert(cube_at(x)).unwrap());
    let bodies = [0.0, 0.5].map(|x| world.insert(body_at(x)).unwrap());
    let check_all = |state, now, last, boxes: &BoxWorld, world: &World, parts: &PartCuller| {
        check(state, now, last, of_world!("BoxWorld", boxes));
        check(state, now, last, of_world!("World", world));
        check(state, now, last, of_parts(parts, world));
    };
    check_all(0, 1, 0, &boxes, &world, &parts);
    check_index(&boxes, 0, &mut of_boxes, 0);
    check_index(&world, 0, &mut of_bodies, 0);

    boxes.cull().unwrap();
    world.cull().unwrap();
    assert_eq!(parts.cull(&world).unwrap().len(), 1);
    let (saved_boxes, saved) = (boxes.snapshot(), world.snapshot());
    boxes.set_bounds(boxed[1], cube_at(50.0)).unwrap();
    world.set_pose(bodies[1], UNTURNED, [50.0, 0.5, 0.5]).unwrap();
    check_all(1, 0, 1, &boxes, &world, &parts);
    check_index(&boxes, 1, &mut of_boxes, 2);
    check_index(&world, 1, &mut of_bodies, 2);

    boxes.restore(&saved_boxes).unwrap();
    world.restore(&saved).unwrap();
    check_all(3, 1, 1, &boxes, &world, &parts);
    of_boxes.update(&boxes);
    of_bodies.update(&world);
    boxes.cull().unwrap();
    world.cull().unwrap();
    assert_eq!(parts.cull(&world).unwrap().len(), 1);
    boxes.remove(boxed[1]).unwrap();
    world.remove(bodies[1]).unwrap();
    check_all(2, 0, 1, &boxes, &world, &parts);
    check_index(&boxes, 2, &mut of_boxes, 2);
    check_index(&world, 2, &mut of_bodies, 2);

    boxes.restore(&saved_boxes).unwrap();
    world.restore(&saved).unwrap();
    let mut without_parts = PartCuller::new();
    boxes.cull_in_portions(|_| ()).unwrap();
    world.cull_in_portions(|_| ()).unwrap();
    check(4, 1, 0, of_parts(&without_parts, &world));
    let (no_boxes, no_bodies) = (of_world!("BoxWorld", &boxes), of_world!("World", &world));
    check(4, 1, 0, no_boxes.into_iter().filter(|row| row.1 != "events").collect());
    check(4, 1, 0, no_bodies.into_iter().filter(|row| row.1 != "events").collect());
    world.cull().unwrap();
    assert_eq!(without_parts.cull(&world).unwrap().len(), 1);
}

#[test]
fn cullers_answer_about_present_bodies() {
    let (mut bodies, mut boxes) = (Bodies::default(), vec![cube_at(0.0), cube_at(5.0)]);
    bodies.push(0, false, UNTURNED, [0.0; 3]);
    bodies.push(0, true, UNTURNED, [5.0, 0.0, 0.0]);
    let (mut culler, mut box_culler) = (Culler::new(&shapes(), &bodies).unwrap(), BoxCuller::new());
    check(0, 0, 0, of_culler!("Culler", culler, &bodies));
    check(0, 0, 0, of_culler!("BoxCuller", box_culler, &boxes));
    culler.cull(&bodies).unwrap();
    box_culler.cull(&boxes).unwrap();
    (bodies.translation[0][0], boxes[0]) = (5.0, cube_at(5.0));
    for state in [1, 3] {
        check(state, 1, 0, of_culler!("Culler", culler, &bodies));
        check(state, 1, 0, of_culler!("BoxCuller", box_culler, &boxes));
        (culler, box_culler) = (culler.clone(), box_culler.clone());
    }
    culler.cull_in_portions(&bodies, |_| ()).unwrap();
    box_culler.cull_in_portions(&boxes, |_| ()).unwrap();
    check(4, 1, 0, of_culler!("Culler", culler, &bodies));
    check(4, 1, 0, of_culler!("BoxCuller", box_culler, &boxes));
}

#[test]
fn periodic_worlds_answer_about_present_bodies() {
    macro_rules! of_periodic {
        ($world:expr, $at:expr) => {{
            let (mut world, mut index) = ($world.unwrap(), PeriodicIndex::new());
            let [_, second] = [0.0, 0.5].map(|x| world.insert($at(x)).unwrap());
            let around = QueryVolume::Box { min: [-9.0; 3], max: [9.0; 3] };
            for (state, now, last) in [(0, 1, 0), (1, 0, 1), (2, 0, 1)] {
                match state {
                    0 => {}
                    1 => world.set(second, $at(20.0)).unwrap(),
                    _ => {
                        world.set(second, $at(0.5)).unwrap();
                        world.cull().unwrap();
                        index.update(&world);
                        world.remove(second).unwrap();
                    }
                }
                check(
                    state,
                    now,
                    last,
                    vec![
                        ("Periodic", "cull", found(world.clone().cull().map(<[_]>::len))),
                        ("Periodic", "pairs", Some(world.pairs().len())),
                        ("Periodic", "events", Some(world.clone().events().begun().len())),
                    ],
                );
                let touching = found(index.touching(&around).map(|hits| hits.len()));
                check(state, 0, 2, vec![("PeriodicIndex", "touching", touching)]);
                assert_eq!(index.touching_all(&[around]).is_ok(), touching.is_some());
                if state == 0 {
                    world.cull().unwrap();
                    index.update(&world);
                }
            }
        }};
    }
    let periods = [Some(100.0), None, None];
    of_periodic!(PeriodicBoxes::new(periods), |x: f64| {
        PeriodicBox::new([x, 0.0, 0.0], [x + 1.0, 1.0, 1.0])
    });
    of_periodic!(PeriodicWorld::new(vec![shapes()[0].clone()], periods), body_at);
}
