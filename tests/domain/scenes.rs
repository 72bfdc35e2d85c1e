//! Whole scenes: the digest, the hash and the sums of counters, over ranks, strategies and finders.

use sdop::settings::{CullSettings, Finder, Interest, Strategy, Updates};
use sdop_bench::scene::Scene;

use crate::domain::{RANKS, alone, build, ghosts, on, parse};

const EFFECTS: &str = "
    [effects]
    motion = true
    walls = \"specular\"
    spin = { rate = [0.1, 1.0] }
    gravity = { acceleration = [0.0, 0.0, -9.81], period = 0.7 }
    brownian = { share = 0.05, speed = [1.0, 4.0] }
";

/// Boxes, L-shapes about a corner of their file, and a tenth that never moves, with the given
/// placement.
fn scene(radius: &str, placement: &str, box_of: &str) -> Scene {
    let group = |shape: &str, rest: &str| {
        format!(
            "[[bodies]]\nshape = \"{shape}\"\nradius = {radius}\nplacement = {placement}\n{rest}\n"
        )
    };
    let groups = [
        group("box", "count = 110\nspeed = [0.5, 6.0]"),
        group("l-shape", "count = 110\nspeed = [0.5, 6.0]"),
        group("needle", "count = 24\nstatic = true"),
    ];
    build(&format!(
        "name = \"domain\"\nframes = 8\ndt = 0.0166\n[box]\n{box_of}\n{}{EFFECTS}",
        groups.concat()
    ))
}

/// Unit balls on a lattice: each touches its neighbours, and any plane cuts through rows of
/// touching ones.
fn straddling() -> Scene {
    let at = |i: i32| [i % 6, i / 6 % 6, i / 36].map(|x| 2 * x - 5);
    let poses = (0..216).map(|i| {
        let [x, y, z] = at(i);
        format!("[0, 0, 0, 1, {x}, {y}, {z}]")
    });
    let poses: Vec<_> = poses.collect();
    build(&format!(
        "name = \"straddling\"\nframes = 4\n[[bodies]]\nshape = \"icosphere\"\nradius = 1.0\nposes = [{}]\n
         velocities = [{}]\n[effects]\nmotion = true\n",
        poses.join(", "),
        vec!["[0.5, -0.25, 0.125]"; 216].join(", ")
    ))
}

fn scenes() -> [(&'static str, Scene); 5] {
    let clusters = "{ clusters = { number = 3, radius = 2.5 } }";
    let plane = "{ plane = { thickness = 1.0 } }";
    [
        ("uniform", scene("1.0", "\"uniform\"", "partners = 2.5")),
        ("mixed", scene("[0.25, 4.0]", "\"uniform\"", "partners = 2.5")),
        ("clustered", scene("0.5", clusters, "side = 40.0")),
        ("plane", scene("0.5", plane, "side = 20.0")),
        ("straddling", straddling()),
    ]
}

/// The pairs of any number of ranks are those of one process.
#[test]
fn any_rank_count_matches() {
    let strategies = Strategy::ALL.iter().filter(|s| !s.scheme().has_budget());
    for (name, mut scene) in scenes() {
        for &strategy in strategies.clone() {
            scene.cull.strategy = strategy;
            scene.cull.interest = Some(Interest::Bodies((0..200).step_by(7).collect()));
            scene.cull.pairs = Finder::AllPairs;
            let whole = alone(&scene);
            for &finder in Finder::ALL {
                scene.cull.pairs = finder;
                for ranks in RANKS {
                    let what = format!("{name}, {strategy} over {finder} on {ranks} ranks");
                    let summary = on(ranks, &scene).unwrap();
                    let shared = &summary.whole;
                    assert_eq!(shared.pairs_digest, whole.pairs_digest, "{what}");
                    assert_eq!(shared.pairs_sha256, whole.pairs_sha256, "{what}");
                    assert_eq!(shared.volumes_sha256, whole.volumes_sha256, "{what}");
                    assert_eq!(shared.counters.reported, whole.counters.reported, "{what}");
                    for volume in strategy.scheme().volumes() {
                        let updates = |summary: &sdop_bench::simulate::Summary| {
                            summary.counters.of(volume).updates
                        };
                        assert_eq!(updates(shared), updates(&whole), "{what}: {volume} updates");
                    }
                    for (ours, theirs) in shared.effects.iter().zip(&whole.effects) {
                        let counts =
                            |e: &sdop_bench::effects::EffectReport| (e.steps, e.visited, e.changed);
                        assert_eq!(counts(ours), counts(theirs), "{what}: {}", ours.name);
                    }
                }
            }
        }
    }
}

/// One rank counts what one process counts.
#[test]
fn one_rank_counts_like_a_process() {
    for (name, mut scene) in scenes() {
        for &strategy in Strategy::ALL.iter().filter(|s| !s.scheme().has_budget()) {
            for updates in [Updates::Eager, Updates::Lazy] {
                scene.cull.strategy = strategy;
                scene.cull.updates = updates;
                scene.cull.interest = Some(Interest::Bodies(vec![3, 50]));
                let counters = on(1, &scene).unwrap().whole.counters;
                assert_eq!(counters, alone(&scene).counters, "{name}, {strategy}");
            }
        }
    }
}

/// A cone that a body looks along sees the same from every rank.
#[test]
fn view_cone_matches_on_ranks() {
    let mut scene = scene("1.0", "\"uniform\"", "partners = 2.5");
    scene.cull.strategy = Strategy::SDopObjectOfInterest;
    for cone in [
        "{ body = 17, direction = [0, 0, 1], half_angle = 40 }",
        "{ apex = [1, 2, 3], direction = [1, 0, 1], half_angle = 60, range = 6.0 }",
    ] {
        let text = format!("interest = {cone}");
        scene.cull.interest = toml::from_str::<CullSettings>(&text).unwrap().interest;
        let whole = alone(&scene);
        assert!(whole.counters.ordop.tests < whole.counters.sphere.hits, "some are of no interest");
        for ranks in RANKS {
            let shared = on(ranks, &scene).unwrap().whole;
            assert_eq!(shared.pairs_sha256, whole.pairs_sha256, "{cone} on {ranks}");
        }
    }
}

/// Ghosts are a skin of the domain and owners are kept while bodies are slow.
#[test]
fn slow_bodies_keep_their_owners() {
    let text = "name = \"many\"\nframes = 24\n[box]\nside = 40.0\n[[bodies]]\nshape = \"box\"\nradius = 0.5\ncount = 8000
        speed = [0.5, 1.0]\n[effects]\nmotion = true\nwalls = \"specular\"\n[cull]\npairs = \"grid\"\n";
    let summary = on(8, &build(text)).unwrap();
    for line in &summary.ranks {
        assert!((900..1100).contains(&line.bodies), "{line:?}");
        // A cell of side 20 with a border of two reaches and two skins on three sides: (21.5/20)³ −
        // 1 is 0.24.
        let a_frame = line.ghosts / 24;
        assert!((100..350).contains(&a_frame), "{line:?}");
        // A skin of half the radius lasts fifteen steps of a sixtieth at speed 1.
        assert!((2..=3).contains(&line.renewals), "{line:?}");
        assert_eq!(line.cuts, 1);
        let told = serde_json::to_value(line).unwrap();
        assert_eq!(told["ghosts"].as_u64(), Some(line.ghosts), "{told}");
        let ghosts = line.seconds.border.ghosts;
        assert_eq!(told["seconds"]["ghosts"].as_f64(), Some(ghosts), "{told}");
    }
    assert_eq!(ghosts(&on(1, &build(text)).unwrap().ranks), 0);
}

/// Shares hold the bodies of the whole.
#[test]
fn shares_partition_the_bodies() {
    for seeding in ["by-group", "by-body"] {
        for placement in ["\"uniform\"", "{ clusters = { number = 5, radius = 2.0 } }"] {
            let group = |shape: &str| {
                format!(
                    "[[bodies]]\nshape = \"{shape}\"\ncount = 37\nradius = [0.25, 1.0]\nspeed = [1.0, 2.0]\nplacement = {placement}\n"
                )
            };
            let file = parse(&format!(
                "name = \"shares\"\nseeding = \"{seeding}\"\nframes = 1\n[box]\nside = 20.0\n{}{}[effects]\nspin = {{ rate = [0.1, 1.0] }}\n",
                group("box"),
                group("l-shape")
            ));
            let whole = file.build().unwrap();
            let mut next = 0;
            for rank in 0..5 {
                let part = file.build_share(rank, 5).unwrap();
                let held = part.share().held;
                assert_eq!(held.start, next);
                next = held.end;
                assert_eq!(part.bodies.shape, whole.bodies.shape[held.clone()]);
                assert_eq!(part.bodies.dynamic, whole.bodies.dynamic[held.clone()]);
                assert_eq!(part.bodies.rotation, whole.bodies.rotation[held.clone()]);
                assert_eq!(part.bodies.translation, whole.bodies.translation[held.clone()]);
                assert_eq!(part.velocities.linear, whole.velocities.linear[held.clone()]);
                assert_eq!(part.velocities.angular, whole.velocities.angular[held]);
                assert_eq!(part.shapes.len(), whole.shapes.len());
                assert_eq!(part.side, whole.side);
            }
            assert_eq!(next, whole.bodies.len());
        }
    }
}

/// By body each body draws for itself.
#[test]
fn seeding_by_body_is_independent() {
    let file = |count: u32| {
        parse(&format!(
            "name = \"own\"\nseeding = \"by-body\"\nframes = 1\n[box]\nside = 20.0\n[[bodies]]\nshape = \"box\"\ncount = {count}\nspeed = [1.0, 2.0]\n"
        ))
    };
    let (few, many) = (file(10).build().unwrap(), file(100).build().unwrap());
    assert_eq!(few.bodies.translation, many.bodies.translation[..10]);
    assert_eq!(few.velocities.linear, many.velocities.linear[..10]);
    let mut different: Vec<_> =
        many.bodies.translation.iter().map(|t| t.map(f32::to_bits)).collect();
    different.sort_unstable();
    different.dedup();
    assert_eq!(different.len(), 100);
}

/// What needs one order over all pairs, or the contacts of all bodies, is refused on many ranks.
#[test]
fn global_orders_are_rejected_on_ranks() {
    let refusal = |file: &Scene| on(2, file).unwrap_err().to_string();
    let mut scene = scene("1.0", "\"uniform\"", "partners = 2.5");
    scene.cull.strategy = Strategy::SDopTimeCritical;
    scene.cull.budget = Some(sdop::settings::Budget::Tests(10));
    assert_eq!(refusal(&scene), "strategy s-dop-time-critical on 2 ranks");
    assert!(on(1, &scene).is_ok());
    for (name, line) in
        [("response", "response = \"elastic\""), ("rest", "rest = { speed = 1, after = 1 }")]
    {
        let scene = build(&format!(
            "name = \"r\"\nframes = 2\n[[bodies]]\nshape = \"box\"\nposes = [[0, 0, 0, 1, 0, 0, 0]]\n[effects]\n{line}\n",
        ));
        assert_eq!(refusal(&scene), format!("effect {name} on 2 ranks"));
        assert!(on(1, &scene).is_ok());
    }
    let fine = parse(
        "name = \"f\"\nframes = 1\n[[bodies]]\nshape = \"box\"\nposes = [[0, 0, 0, 1, 0.1, 0, 0]]\n",
    );
    let fine = fine.build_exact().unwrap();
    assert_eq!(
        refusal(&fine),
        "`poses` with the translation [0.1, 0.0, 0.0], whose nearest f32 is [0.1, 0.0, 0.0], on 2 ranks"
    );
}

/// A body that leaves the contract is named by its number on every rank.
#[test]
fn leaving_body_is_named_on_ranks() {
    let text = "name = \"far\"\nframes = 3\ndt = 1.0\n[[bodies]]\nshape = \"box\"
        poses = [[0, 0, 0, 1, 0, 0, 0], [0, 0, 0, 1, 5, 0, 0], [0, 0, 0, 1, 9, 0, 0], [0, 0, 0, 1, 999999984306749440, 0, 0]]
        velocities = [[0, 0, 0], [0, 0, 0], [0, 0, 0], [1e18, 0, 0]]\n[effects]\nmotion = true\n";
    let file = parse(text);
    let all = sdop_bench::network::on_ranks(3, |net| {
        use sdop_bench::domain::{Rank, run};
        use sdop_bench::network::Network as _;
        let scene = file.build_share(net.rank(), 3).unwrap();
        let rank = Rank::new(net, scene, sdop::Tier::detect(), 1).unwrap();
        run(rank, |_| ()).unwrap_err().to_string()
    });
    let said = "frame 1: body 3: translation [2e18, 0.0, 0.0]";
    assert!(all.iter().all(|error| error.ends_with(said)), "{all:?}");
    assert!(all.iter().any(|error| error == said), "{all:?}");
}
