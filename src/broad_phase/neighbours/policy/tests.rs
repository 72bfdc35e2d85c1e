use super::*;

impl Policy {
    /// A policy for bodies of one size, whose first list has a skin in typical radii.
    pub(in super::super) fn of_typical(typical: f64) -> Self {
        Self {
            radii: RadiusKind::Typical,
            sizes: SizeSummary::new(typical, typical),
            ..Self::default()
        }
    }
}

/// A list of a million bodies that ended.
fn list(pairs: usize, candidates: u64, [own, typical]: [f64; 2]) -> EndedList {
    EndedList {
        pairs,
        candidates,
        bodies: 1_000_000,
        motion: LargestDrift { own, typical },
        sizes: SizeSummary::new(2.0, 2.0),
    }
}

/// Runs the policy for 2000 frames and returns lists made, frames that a list served, and the
/// policy at the end. The fastest body moves by `speeds` per frame, in its own radii and in typical
/// ones; a list without a skin has 0.75 pairs per body.
fn frames(speeds: [f64; 2]) -> (u32, u32, Policy) {
    let (mut policy, mut since) = (Policy::default(), None);
    let (mut made, mut served) = (0, 0);
    for _ in 0..2000 {
        if let Some(since) = &mut since {
            *since += 1;
            let drifts = speeds.map(|speed| speed * f64::from(*since));
            let [own, typical] = drifts;
            let drift = if policy.radii == RadiusKind::Own { own } else { typical };
            if drift < SKINS[policy.skin] {
                policy.followed();
                served += 1;
                continue;
            }
            let pairs = 750_000.0 * policy.wider();
            policy.ended(&list(pairs as usize, (6.0 * pairs) as u64, drifts));
        }
        since = policy.next().map(|_| 0);
        if since.is_some() {
            (made, served) = (made + 1, served + 1);
        }
    }
    (made, served, policy)
}

/// Slow bodies are followed and fast ones searched for.
#[test]
fn only_slow_bodies_are_followed() {
    let mut before = 0;
    for speed in [0.0, 0.001, 0.01, 0.03, 0.1] {
        let (made, served, _) = frames([speed; 2]);
        assert!(served >= 1990, "{speed}: {served}");
        assert!(f64::from(made) <= 2000.0 * speed / 0.06 + 2.0, "{speed}: {made}");
        assert!(made >= before, "{speed}: {made}, and {before} when slower");
        before = made;
    }
    for speed in [1.0, 100.0] {
        let (made, served, _) = frames([speed; 2]);
        assert!(made < 20 && served == made, "{speed}: {made}, {served}");
    }
}

/// Skins are measured by the radii that last longer.
#[test]
fn skins_use_longer_lasting_radii() {
    for (speeds, radii) in [
        ([0.4, 0.05], RadiusKind::Typical),
        ([5.0, 0.05], RadiusKind::Typical),
        ([0.05, 0.4], RadiusKind::Own),
        ([0.05, 0.0499], RadiusKind::Own),
    ] {
        let (made, served, policy) = frames(speeds);
        assert_eq!(policy.radii, radii, "{speeds:?}");
        assert!(served >= 1990 && made < 500, "{speeds:?}: {served}, {made}");
    }
}

/// A skin is a share or a length and brings its cube of pairs.
#[test]
fn skin_multiplies_pairs_by_cube() {
    let of = |radii, skin| Policy {
        radii,
        skin,
        sizes: SizeSummary::new(3.0, 3.0),
        ..Policy::default()
    };
    assert_eq!(of(RadiusKind::Own, 1).skin(), Skin::share(0.125));
    assert_eq!(of(RadiusKind::Typical, 1).skin(), Skin::length(0.375));
    assert_eq!(Policy::default().skin(), Skin::share(0.25));
    for radii in [RadiusKind::Own, RadiusKind::Typical] {
        let policy = of(radii, 1);
        assert_eq!(policy.wider(), 1.125 * 1.125 * 1.125);
        let widest = 1.375f64 / 1.125;
        assert!((policy.widest() - widest * widest * widest).abs() < 1e-12);
    }
}

/// Within two skins a body has gone straight on; beyond, it has jumped, unless the list served no
/// frame but its own.
#[test]
fn jumping_body_is_ignored() {
    let never = f64::INFINITY;
    for (radii, served, drifts, speeds) in [
        (RadiusKind::Own, 4, [0.5, 3.0], [0.125, 0.75]),
        (RadiusKind::Own, 4, [0.51, 3.0], [0.25 / 3.5, never]),
        (RadiusKind::Typical, 4, [3.0, 0.5], [0.75, 0.125]),
        (RadiusKind::Typical, 2, [3.0, 0.51], [never, 0.25 / 1.5]),
        (RadiusKind::Own, 1, [9.0, 0.1], [9.0, 0.1]),
        (RadiusKind::Typical, 1, [0.1, 9.0], [0.1, 9.0]),
    ] {
        let policy = Policy { radii, served, ..Policy::default() };
        let [own, typical] = drifts;
        assert_eq!(policy.speeds(LargestDrift { own, typical }), speeds);
    }
}

/// A list that was too long is tried again seldom.
#[test]
fn overflow_lengthens_the_pause() {
    let mut policy = Policy::of_typical(1.0);
    let made = (0..4000).filter(|_| {
        let made = policy.next().is_some();
        if made {
            policy.overflowed();
            assert_eq!((policy.radii, policy.skin), (RadiusKind::Own, 0));
        }
        made
    });
    assert!((12..24).contains(&made.count()));
}

/// A list of a million bodies ends. Each row has its skin, the frames that it served, the largest
/// drifts at its end and the candidates per pair; then a number of pairs, and the next list's skin
/// with that number and with one pair more. Without a skin, the grid handles the next frames.
#[test]
fn next_skin_is_the_cheapest() {
    const INFINITE_DRIFT: f64 = f64::INFINITY;
    let own = |skin| Some((RadiusKind::Own, skin));
    let typical = |skin| Some((RadiusKind::Typical, skin));
    for (at, served, drifts, candidates, pairs, next) in [
        (own(3), 2, [0.3, INFINITE_DRIFT], 6, 3_837_626, [own(4), None]),
        (own(3), 3, [0.26, INFINITE_DRIFT], 4, 6_009_424, [own(5), own(2)]),
        (own(0), 2, [0.1, INFINITE_DRIFT], 5, 18_812_129, [own(3), None]),
        (own(3), 10, [0.27, INFINITE_DRIFT], 6, 2_195_551, [own(4), own(3)]),
        (own(2), 5, [0.2, INFINITE_DRIFT], 0, 7_728_640, [own(1), None]),
        (own(3), 2, [0.4, INFINITE_DRIFT], 3, 1_434_156, [own(3), None]),
        (own(4), 2, [0.33, INFINITE_DRIFT], 1, 4_149_165, [own(5), None]),
        (own(3), 3, [9.0, 0.1], 6, 7_692_074, [own(4), None]),
        (typical(5), 100, [INFINITE_DRIFT, 0.376], 10, 2_458_240, [typical(2), typical(1)]),
        (typical(1), 2, [0.02, 0.251], 6, 1_661_698, [typical(5), typical(3)]),
        (own(3), 1, [0.4, 0.05], 6, 1_862_170, [typical(5), typical(4)]),
        (own(3), 3, [0.3, 0.25], 8, 658_971, [typical(5), own(4)]),
        (own(3), 3, [0.3, 0.25], 8, 6_635_479, [own(4), typical(3)]),
    ] {
        let (radii, skin) = at.expect("a list has a skin");
        for (more, next) in (0..).zip(next) {
            let mut policy = Policy {
                radii,
                skin,
                sizes: SizeSummary::new(1.0, 1.0),
                is_by_boxes: false,
                served,
                wait: 0,
                pause: INITIAL_PAUSE_FRAMES,
            };
            let pairs = pairs + more;
            policy.ended(&list(pairs, candidates * pairs as u64, drifts));
            let found = policy.next().map(|_| (policy.radii, policy.skin));
            assert_eq!(found, next, "{at:?}, {served}: {pairs}");
            assert_eq!(policy.sizes, SizeSummary::new(2.0, 2.0));
        }
    }
}

/// Sizes of boxes that are longer than wide, of cubes next to them, and where no length suits all.
#[test]
fn long_boxes_use_length_skins() {
    let [long, cubes, giant] =
        [(3.0, 24.0), (2.0, 2.0), (0.0, 5.0)].map(|(a, b)| SizeSummary::new(a, b));
    let mut policy = Policy::default();
    policy.turn_to(false, || unreachable!("they are balls as before"));
    policy.turn_to(true, || long);
    assert_eq!((policy.skin(), policy.skins().len()), (Skin::length(0.75), 8));
    assert!((policy.more_candidates() - (1.0f64 + 0.25 / 8.0).powi(3)).abs() < 1e-12);
    policy.turn_to(true, || unreachable!("they are boxes as before"));
    // Slow ones with many candidates, of which the longest sides would make more.
    (policy.served, policy.wait) = (2, 0);
    let slow = list(3_000_000, 200_000_000, [0.01, 0.26]);
    policy.ended(&EndedList { sizes: long, ..slow });
    assert_eq!((policy.radii, SKINS[policy.skin]), (RadiusKind::Typical, 0.75));
    policy.overflowed();
    assert_eq!((policy.radii, policy.skin), (RadiusKind::Typical, 0));
    policy.skin = 7;
    policy.turn_to(false, || cubes);
    assert_eq!((policy.radii, SKINS[policy.skin]), (RadiusKind::Typical, 0.375));
    assert_eq!(policy.more_candidates(), policy.wider());
    let mut policy = Policy::default();
    policy.turn_to(true, || giant);
    assert_eq!((policy.skin(), policy.skins().len()), (Skin::share(0.25), 6));
}
