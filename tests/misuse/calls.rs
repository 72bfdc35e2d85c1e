//! When each public method may be called, and what its answer is about.

use std::collections::BTreeSet;
use std::fmt::Display;
use std::path::Path;

use sdop::compound::{Compound, Part, PartCuller};
use sdop::periodic::{PeriodicBox, PeriodicBoxes, PeriodicIndex};
use sdop::query::QuerySource;
use sdop::world::PeriodicWorld;
use sdop::{Aabb, Body, BoxCuller, BoxWorld, Line, QueryIndex, QueryVolume, World};

use super::*;

/// The states in which methods are called: before any cull or update; after bodies have moved since
/// then; after one was removed; after a world was restored; after a cull that listed no
/// pairs.
const STATES: [&str; 5] = ["new", "moved", "removed", "restored", "unlisted"];

/// For each type, the methods that answer about pairs or places of bodies, with one letter per
/// state: `n`ow, as the bodies are; `l`ast, as they were in the last cull or update, which the
/// documentation says; `!`, an error that says what to call; `-`, no such state. Methods without
/// letters change a set, return what was set, or count.
const METHODS: [(&str, &str, &str); 24] = [
    ("Culler", "nn--n", "cull cull_in_portions cull_up_to"),
    ("Culler", "ll--l", "pairs"),
    ("Culler", "", "add_shape builder counters finder finder_bytes list_tests new pair_bytes"),
    ("Culler", "", "potentially_colliding refresh seconds set_groups shrink_to_fit"),
    ("BoxCuller", "nn--n", "cull cull_in_portions cull_up_to"),
    ("BoxCuller", "ll--l", "pairs"),
    ("BoxCuller", "", "builder counters list_tests new pair_bytes set_groups shrink_to_fit"),
    ("World", "nnnnn", "cull cull_in_portions cull_up_to"),
    ("World", "lllll", "events pairs"),
    ("World", "", "add_shape bodies body contains counters exclude excluded finder ids include"),
    (
        "World",
        "",
        "insert is_empty is_excluded len new pair_bytes remove remove_shape replace_shape",
    ),
    (
        "World",
        "",
        "restore seconds set set_interest set_motion set_pose set_pose_f64 shapes shrink_to_fit",
    ),
    ("World", "", "slots snapshot with"),
    ("BoxWorld", "nnnnn", "cull cull_in_portions cull_up_to"),
    ("BoxWorld", "lllll", "events pairs"),
    ("BoxWorld", "", "bodies body contains counters exclude excluded ids include insert is_empty"),
    ("BoxWorld", "", "is_excluded len new pair_bytes remove rest_counters restore set set_bounds"),
    ("BoxWorld", "", "set_many set_motion shrink_to_fit slots snapshot with"),
    ("Periodic", "nnn--", "cull cull_up_to"),
    ("Periodic", "lll--", "events pairs"),
    ("Periodic", "", "body contains exclude ids images include insert is_excluded periods remove"),
    ("Periodic", "", "bodies is_empty len set set_periods"),
    ("PartCuller", "!!!n!", "cull"),
    ("PartCuller", "lllll", "body_pairs pairs"),
];

/// The rest of the table.
const QUERIES: [(&str, &str, &str); 6] = [
    ("PartCuller", "", "new remove_parts set_parts"),
    ("QueryIndex", "!ll--", "along along_all first first_all first_judged pairs_with touching"),
    ("QueryIndex", "!ll--", "touching_all"),
    ("QueryIndex", "", "is_empty len most_answers new on_tier update with_threads"),
    ("PeriodicIndex", "!ll--", "touching touching_all"),
    ("PeriodicIndex", "", "most_answers new on_tier update with_threads"),
];

fn rows() -> impl Iterator<Item = (&'static str, &'static str, &'static str)> {
    let all = METHODS.into_iter().chain(QUERIES);
    all.flat_map(|(of, letters, names)| names.split(' ').map(move |name| (of, letters, name)))
}

/// Every public method of these types is in the table.
#[test]
fn every_method_has_a_row() {
    let mut found = BTreeSet::new();
    for room in ["culler", "living", "boxes", "world", "periodic", "compound", "query"] {
        for file in std::fs::read_dir(Path::new("src").join(room)).unwrap() {
            let text = std::fs::read_to_string(file.unwrap().path()).unwrap_or_default();
            let (mut of, mut is_hidden) = ("", false);
            for line in text.lines() {
                if let Some(head) = line.strip_prefix("impl") {
                    let generic = head.strip_prefix('<').and_then(|rest| rest.split_once("> "));
                    let head = generic.map_or(head, |(_, rest)| rest);
                    of = head.trim().split(['<', ' ']).next().unwrap_or_default();
                }
                is_hidden = !line.is_empty() && (is_hidden || line.contains("#[doc(hidden)]"));
                if let Some(method) = line.strip_prefix("    pub fn ") {
                    let method = method.split(['(', '<']).next().unwrap_or_default();
                    let types = match of {
                        "LivingSet" => &["World", "BoxWorld"][..],
                        of => &[of],
                    };
                    if !std::mem::take(&mut is_hidden) {
                        let known = types.iter().filter(|of| rows().any(|row| row.0 == **of));
                        found.extend(known.map(|of| format!("{of}::{method}")));
                    }
                }
            }
        }
    }
    let known: BTreeSet<_> = rows().map(|(of, _, method)| format!("{of}::{method}")).collect();
    assert_eq!(found, known);
}

/// How many pairs or bodies a method finds; an error must say what to call.
fn found<E: Display>(answer: Result<usize, E>) -> Option<usize> {
    answer.map_err(|error| assert!(error.to_string().contains("; call `"), "{error}")).ok()
}

/// What there is to find in a state: now, and in the last cull or update.
#[derive(Clone, Copy)]
struct Wanted(usize, usize, usize);

impl Wanted {
    /// Compares the answers of a type's methods with the table.
    fn check<const N: usize>(self, of: &str, answers: [(&str, Option<usize>); N]) {
        let Self(state, now, last) = self;
        for (method, answer) in answers {
            let row = rows().find(|row| (row.0, row.2) == (of, method)).unwrap();
            let wanted = match row.1.as_bytes()[state] {
                b'n' => Some(now),
                b'l' => Some(last),
                b'!' => None,
                other => panic!("{of}::{method} is called in state {other}"),
            };
            assert_eq!(answer, wanted, "{of}::{method}, {}", STATES[state]);
        }
    }

    /// Two bodies are on a line and in a box.
    fn check_index(self, world: &impl QuerySource, index: &mut QueryIndex) {
        let around = QueryVolume::Box { min: [-9.0; 3], max: [9.0; 3] };
        let line = Line::Segment { from: [-9.0, 0.5, 0.5], to: [9.0, 0.5, 0.5] };
        let judged = index.first_judged(&line, |hit| Some(hit.at));
        // A first body is found whether there are one or two.
        let bodies = index.len();
        let first = |hit: Option<_>| hit.map_or(0, |_| bodies);
        let answers = [
            ("touching", found(index.touching(&around).map(|ids| ids.len()))),
            ("touching_all", found(index.touching_all(&[around]).map(|all| all.of(0).len()))),
            ("along", found(index.along(&line).map(|hits| hits.len()))),
            ("along_all", found(index.along_all(&[line]).map(|all| all.of(0).len()))),
            ("first", found(index.first(&line).map(first))),
            ("first_all", found(index.first_all(&[line]).map(|all| bodies * all.of(0).len()))),
            ("first_judged", found(judged.map(first))),
            ("pairs_with", found(index.pairs_with(index).map(|pairs| pairs.len().isqrt()))),
        ];
        self.check("QueryIndex", answers);
        index.update(world);
    }
}

/// Checks what a culler or world answers when it is asked for all pairs.
macro_rules! check_culls {
    ($wanted:expr, $of:literal, $subject:expr $(, $now:expr)?) => {{
        let mut portions = 0;
        $subject.clone().cull_in_portions($($now,)? |portion| portions += portion.len()).unwrap();
        let limited = $subject.clone().cull_up_to($($now,)? 9).map(|pairs| pairs.len());
        $wanted.check($of, [
            ("cull", found($subject.clone().cull($($now)?).map(|pairs| pairs.len()))),
            ("cull_in_portions", Some(portions)),
            ("cull_up_to", found(limited)),
            ("pairs", Some($subject.pairs().len())),
        ]);
    }};
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
    let mut world = World::new(vec![compound.shape().clone()]).unwrap();
    let (mut boxes, mut parts) = (BoxWorld::new(), PartCuller::new());
    parts.set_parts(0, compound);
    let [mut of_boxes, mut of_bodies] = [QueryIndex::new(), QueryIndex::new()];
    let boxed = [0.0, 0.5].map(|x| boxes.insert(cube_at(x)).unwrap());
    let bodies = [0.0, 0.5].map(|x| world.insert(body_at(x)).unwrap());
    let (mut saved_boxes, mut saved) = (boxes.snapshot(), world.snapshot());
    for (state, now, last) in [(0, 1, 0), (1, 0, 1), (3, 1, 1), (2, 0, 1), (4, 1, 0)] {
        if state > 0 {
            boxes.cull().unwrap();
            world.cull().unwrap();
            assert_eq!(parts.cull(&world).unwrap().len(), usize::from(state < 3));
        }
        match state {
            1 => {
                (saved_boxes, saved) = (boxes.snapshot(), world.snapshot());
                boxes.set_bounds(boxed[1], cube_at(50.0)).unwrap();
                world.set_pose(bodies[1], UNTURNED, [50.0, 0.5, 0.5]).unwrap();
            }
            3 | 4 => {
                boxes.restore(&saved_boxes).unwrap();
                world.restore(&saved).unwrap();
            }
            2 => {
                boxes.remove(boxed[1]).unwrap();
                world.remove(bodies[1]).unwrap();
            }
            _ => {}
        }
        if state == 4 {
            parts = PartCuller::new();
            for _ in 0..2 {
                boxes.cull_in_portions(|_| ()).unwrap();
                world.cull_in_portions(|_| ()).unwrap();
                drop((boxes.events(), world.events())); // nothing happens after the first ones
            }
        }
        let wanted = Wanted(state, now, last);
        check_culls!(wanted, "BoxWorld", boxes);
        check_culls!(wanted, "World", world);
        wanted.check("BoxWorld", [("events", Some(boxes.clone().events().iter().count()))]);
        wanted.check("World", [("events", Some(world.clone().events().iter().count()))]);
        let last = if state == 3 { 0 } else { last };
        Wanted(state, now, last).check(
            "PartCuller",
            [
                ("cull", found(parts.clone().cull(&world).map(<[_]>::len))),
                ("pairs", Some(parts.pairs().len())),
                ("body_pairs", Some(parts.body_pairs().count())),
            ],
        );
        if state < 3 {
            Wanted(state, 0, 2).check_index(&boxes, &mut of_boxes);
            Wanted(state, 0, 2).check_index(&world, &mut of_bodies);
        } else {
            of_boxes.update(&boxes);
            of_bodies.update(&world);
        }
    }
}

#[test]
fn cullers_answer_about_present_bodies() {
    let (mut bodies, mut boxes) = (Bodies::default(), vec![cube_at(0.0), cube_at(5.0)]);
    bodies.push(0, false, UNTURNED, [0.0; 3]);
    bodies.push(0, true, UNTURNED, [5.0, 0.0, 0.0]);
    let (mut culler, mut box_culler) = (Culler::new(&shapes(), &bodies).unwrap(), BoxCuller::new());
    for state in [0, 1, 4] {
        let wanted = Wanted(state, usize::from(state > 0), 0);
        if state == 1 {
            culler.cull(&bodies).unwrap();
            box_culler.cull(&boxes).unwrap();
            (bodies.translation[0][0], boxes[0]) = (5.0, cube_at(5.0));
        } else if state == 4 {
            culler.cull_in_portions(&bodies, |_| ()).unwrap();
            box_culler.cull_in_portions(&boxes, |_| ()).unwrap();
        }
        check_culls!(wanted, "Culler", culler, &bodies);
        check_culls!(wanted, "BoxCuller", box_culler, &boxes);
    }
}

#[test]
fn periodic_worlds_answer_about_present_bodies() {
    macro_rules! check_periodic {
        ($world:expr, $at:expr) => {{
            let (mut world, mut index) = ($world.unwrap(), PeriodicIndex::new());
            let [_, second] = [0.0, 0.5].map(|x| world.insert($at(x)).unwrap());
            let around = QueryVolume::Box { min: [-9.0; 3], max: [9.0; 3] };
            for (state, now, last) in [(0, 1, 0), (1, 0, 1), (2, 0, 1)] {
                if state > 0 {
                    world.set(second, $at(0.5)).unwrap();
                    world.cull().unwrap();
                    index.update(&world);
                }
                match state {
                    0 => {}
                    1 => world.set(second, $at(20.0)).unwrap(),
                    _ => world.remove(second).unwrap(),
                }
                Wanted(state, now, last).check(
                    "Periodic",
                    [
                        ("cull", found(world.clone().cull().map(<[_]>::len))),
                        ("cull_up_to", found(world.clone().cull_up_to(9).map(<[_]>::len))),
                        ("pairs", Some(world.pairs().len())),
                        ("events", Some(world.clone().events().begun().len())),
                    ],
                );
                let all = index.touching_all(&[around]).map(|all| all.of(0).len());
                Wanted(state, 0, 2).check(
                    "PeriodicIndex",
                    [
                        ("touching", found(index.touching(&around).map(|hits| hits.len()))),
                        ("touching_all", found(all)),
                    ],
                );
            }
        }};
    }
    let periods = [Some(100.0), None, None];
    let box_at = |x: f64| PeriodicBox::new([x, 0.0, 0.0], [x + 1.0, 1.0, 1.0]);
    check_periodic!(PeriodicBoxes::new(periods), box_at);
    check_periodic!(PeriodicWorld::new(vec![shapes()[0].clone()], periods), body_at);
}
