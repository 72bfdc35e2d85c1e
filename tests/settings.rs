//! The culling settings by name: flags, scene files and JSON spell them alike.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use sdop::settings::*;
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
