//! The culling settings by name: flags, scene files and JSON spell them alike, and invalid ones are
//! rejected.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use sdop::settings::*;
use sdop::simd::Tier;
use sdop_bench::scene::SceneFile;

/// Every name reads back as its choice.
#[test]
fn names_read_back() {
    macro_rules! round_trip {
        ($($choice:ident),+) => {$(
            for (choice, name) in $choice::ALL.iter().zip($choice::NAMES) {
                assert_eq!(choice.to_string(), *name);
                assert_eq!(name.parse::<$choice>().unwrap(), *choice);
                assert_eq!(serde_json::from_str::<$choice>(&format!("{name:?}")).unwrap(), *choice);
                assert_eq!(serde_json::to_string(choice).unwrap(), format!("{name:?}"));
            }
        )+};
    }
    round_trip!(Strategy, Finder, Overlap, Updates, Axes, Order);
}

#[test]
fn an_unknown_name_suggests_the_nearest() {
    let error = "s-dop-sequentail".parse::<Strategy>().unwrap_err();
    assert_eq!(error.problem(), "unknown strategy `s-dop-sequentail`");
    assert_eq!(error.hint, "did you mean `s-dop-sequential`?");
    assert_eq!("two_sided".parse::<Overlap>().unwrap_err().hint, "did you mean `two-sided`?");
    assert_eq!(
        "octree".parse::<Finder>().unwrap_err().hint,
        "one of: all-pairs, grid, sweep, neighbours, auto"
    );
    assert_eq!("16".parse::<DirectionSet>().unwrap_err().hint, "one of: 6, 14, 18, 26");
}

/// Scene files default to the librarys settings.
#[test]
fn scene_defaults_match_the_library() {
    let settings: CullSettings = serde_json::from_str("{}").unwrap();
    assert_eq!(settings, CullSettings::default());
    assert_eq!(settings.pairs, Finder::Auto);
    let scene =
        "name = \"s\"\nframes = 1\n[[bodies]]\nshape = \"box\"\nposes = [[0, 0, 0, 1, 0, 0, 0]]\n";
    let file = SceneFile::parse(scene, "s.toml", std::path::Path::new(".")).unwrap();
    assert_eq!(file.spec.cull, CullSettings::default());
    assert_eq!(settings.strategy, Strategy::SDopSequential);
    assert_eq!(settings.k, DirectionSet::K18);
    assert_eq!(serde_json::to_value(&settings).unwrap()["k"], 18);
    settings.check(0).unwrap();
}

/// Settings that cannot be carried out are refused.
#[test]
fn invalid_settings_are_rejected() {
    let problem = |change: fn(&mut CullSettings)| {
        let mut settings = CullSettings::all_pairs();
        change(&mut settings);
        settings.check(10).unwrap_err().problem()
    };
    assert_eq!(
        problem(|s| s.strategy = Strategy::SDopObjectOfInterest),
        "strategy s-dop-object-of-interest needs `interest`"
    );
    assert_eq!(
        problem(|s| s.strategy = Strategy::SDopTimeCritical),
        "strategy s-dop-time-critical needs `budget`"
    );
    assert_eq!(
        problem(|s| s.interest = Some(Interest::Bodies(vec![3, 10]))),
        "interest: body 10 of a scene of 10"
    );
    let cone = |text: &str| {
        let text = format!("interest = {text}");
        let settings: CullSettings = toml::from_str(&text).unwrap();
        settings.check(10).unwrap_err().problem()
    };
    assert_eq!(cone("{ direction = [0, 0, 1], half_angle = 30 }"), "interest: a cone has one apex");
    assert_eq!(
        cone("{ body = 1, direction = [0, 0, 0], half_angle = 30 }"),
        "interest: direction [0.0, 0.0, 0.0]"
    );
    assert_eq!(
        cone("{ apex = [nan, 0, 0], direction = [0, 0, 1], half_angle = 30 }"),
        "interest: apex [NaN, 0.0, 0.0]"
    );
    assert_eq!(
        cone("{ body = 1, direction = [0, 0, 1], half_angle = nan }"),
        "interest: half_angle NaN"
    );
    assert_eq!(
        cone("{ body = 1, direction = [0, 0, 1], half_angle = 30, range = 0 }"),
        "interest: range 0"
    );
}

/// A builder keeps each setting and no other.
#[test]
fn builder_keeps_each_setting() {
    let settings = CullSettings {
        strategy: Strategy::KDop,
        pairs: Finder::Sweep,
        k: DirectionSet::K26,
        overlap: Overlap::Full,
        updates: Updates::Lazy,
        interest: Some(Interest::Bodies(vec![1])),
        budget: Some(Budget::Tests(7)),
        order: Order::OldestAnswer,
        ..CullSettings::default()
    };
    let new = sdop::Culler::builder;
    let one_by_one = new()
        .threads(2)
        .tier(Tier::SCALAR)
        .strategy(settings.strategy)
        .finder(settings.pairs)
        .k(settings.k)
        .overlap(settings.overlap)
        .updates(settings.updates)
        .interest(Interest::Bodies(vec![1]))
        .budget(Budget::Tests(7))
        .worth_waking(3)
        .order(settings.order);
    let on_two = new().threads(2).tier(Tier::SCALAR);
    let at_once = on_two.clone().worth_waking(3).settings(&settings);
    assert_eq!(one_by_one, at_once);
    let others = [
        new().settings(&settings),
        new().settings(&settings).threads(2),
        new().settings(&settings).tier(Tier::SCALAR),
        on_two.clone().settings(&settings),
        on_two.worth_waking(3),
    ];
    assert!(!others.contains(&at_once));
}
