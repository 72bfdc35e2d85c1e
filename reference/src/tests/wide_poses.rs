//! Poses of f64 against brute force in rationals.

use super::hard::{TURN, turned_back};
use super::rational;
use super::shapes::{Draws, Mesh as Arrays, cuboid};
use crate::exact::meeting::{self, Meeting};
use crate::exact::mesh::Mesh;
use crate::exact::{Path, Tally};
use crate::number::power_of_two as exp2;
use crate::{InvalidInput, WidePose};

const UNTURNED: [f64; 4] = [0.0, 0.0, 0.0, 1.0];

fn prepared((vertices, triangles): &Arrays) -> Mesh {
    Mesh::new(vertices, triangles).unwrap()
}

fn tetrahedron(corners: [[f32; 3]; 4]) -> Mesh {
    let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    prepared(&(corners.to_vec(), faces))
}

fn meet(a: (&Mesh, WidePose), b: (&Mesh, WidePose)) -> Meeting {
    meeting::meet((a.0, &a.1.0), (b.0, &b.1.0))
}

/// All 53 bits, in [−1, 1).
fn signed(draws: &mut Draws) -> f64 {
    (draws.bits() >> 10) as f64 / (1_u64 << 53) as f64 - 1.0
}

#[test]
fn far_translations_keep_their_bits() {
    let corner = tetrahedron([[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
    let at = |x: f64| (&corner, WidePose::new(UNTURNED, [x, 0.0, 0.0]).unwrap());
    assert!(meet(at(1_000_000_031.5), at(1_000_000_032.2)).meets);
    let place = 1_000_000_031.7;
    assert!(meet(at(place), at(place + 1.0)).meets, "they touch");
    assert!(!meet(at(place), at((place + 1.0).next_up())).meets);
    // The f64 nearest 1.1 is above 1 + the f64 nearest 0.1, though their difference rounds to 1.
    assert!(!meet(at(0.1), at(1.1)).meets);
    assert!(meet(at(0.1), at(1.1_f64.next_down())).meets);
}

/// A quarter turn and 2⁻⁴⁰ more takes a point 2³⁰ away past the quarter by 2⁻¹⁰.
#[test]
fn wide_turns_keep_their_bits() {
    let mote = prepared(&(vec![[exp2(30) as f32, 0.0, 0.0]], vec![[0, 0, 0]]));
    let turn = |z: f64| WidePose::new([0.0, 0.0, z, 1.0], [0.0; 3]).unwrap();
    let wall = prepared(&cuboid([1.0; 3]));
    let at = WidePose::new(UNTURNED, [1.0 - exp2(-11), exp2(30), 0.0]).unwrap();
    assert!(meet((&mote, turn(1.0)), (&wall, at)).meets);
    assert!(!meet((&mote, turn(1.0 + exp2(-40))), (&wall, at)).meets);
}

#[test]
fn wide_poses_agree_with_brute_force() {
    let mut draws = Draws(44);
    let (mut met, mut paths) = (0, Tally::default());
    for n in 0..270 {
        let mut corners = [[0.0; 3]; 4];
        let mut mesh = |scale: f32| {
            corners = corners.map(|_| [(); 3].map(|()| draws.signed(4.0).trunc() * scale));
            tetrahedron(corners)
        };
        let (a, b) = (mesh(1.0), mesh(0.5));
        let far = [0.0, 1e9, 1e12][n % 3];
        let norm = [1.0, 1e200, 1e-200][n / 3 % 3];
        // A third each: at the same turn, at a turn that is off by little, at any turn.
        let turn = [(); 4].map(|()| signed(&mut draws));
        let near = turn.map(|x| x * (1.0 + 1e-13 * signed(&mut draws)));
        let other = [(); 4].map(|()| signed(&mut draws));
        let turns = [[turn, turn], [turn, near], [turn, other]][n / 9 % 3];
        let place = [(); 3].map(|()| far * signed(&mut draws));
        let step = [(); 3].map(|()| 2.0 * signed(&mut draws));
        let pose = |q: [f64; 4], t| WidePose::new(q.map(|x| x * norm), t).unwrap();
        let (a, b) = (
            (&a, pose(turns[0], place)),
            (&b, pose(turns[1], [0, 1, 2].map(|i| place[i] + step[i]))),
        );
        let truth = rational::meshes_meet((a.0, &a.1.0), (b.0, &b.1.0));
        for meeting in [meet(a, b), meet(b, a)] {
            assert_eq!(meeting.meets, truth, "{:?} {:?}", a.1, b.1);
            paths.count(meeting.path);
        }
        met += u32::from(truth);
    }
    assert!((70..220).contains(&met), "{met} met, {paths:?}");
}

/// Contacts of triangles on a grid, turned by what f64 holds exactly and f32 doesn't.
#[test]
fn wide_contacts_are_kept_when_turned() {
    let mut draws = Draws(45);
    let (mut met, mut paths) = (0, Tally::default());
    for _ in 0..500 {
        let corners =
            [(); 2].map(|()| [(); 3].map(|()| [(); 3].map(|()| draws.signed(3.0).trunc())));
        let alone = |corners: [[f32; 3]; 3]| prepared(&(corners.to_vec(), vec![[0, 1, 2]]));
        let (a, b) =
            (alone(corners[0].map(|p| p.map(|x| x * TURN))), alone(corners[1].map(turned_back)));
        let odd = ((1_u64 << 30) + 1) as f64;
        let place = [(); 3].map(|()| 1e9 * signed(&mut draws));
        let (pose_a, pose_b) = draws.turned_poses();
        let wide = |q: [f64; 4]| WidePose::new(q.map(|x| x * odd), place).unwrap();
        let (pose_a, pose_b) = (wide(pose_a.quaternion()), wide(pose_b.quaternion()));
        let truth = {
            let [a, b] = corners.map(|t| t.map(rational::rational3));
            rational::triangles_meet(&a, &b)
        };
        let meeting = meet((&a, pose_a), (&b, pose_b));
        assert_eq!(meeting.meets, truth, "{corners:?} {pose_a:?}");
        met += u32::from(truth);
        paths.count(meeting.path);
    }
    assert!(
        (130..370).contains(&met) && paths.exact > 100 && paths.filter > 100,
        "{met} {paths:?}"
    );
}

#[test]
fn any_norm_is_the_same_turn() {
    let boxes = [prepared(&cuboid([1.0; 3])), prepared(&cuboid([1.0, 2.0, 3.0]))];
    let at = |norm: f64, x: f64| {
        let q = [0.0, 0.0, 1.0, 1.0].map(|c| c * norm);
        WidePose::new(q, [x, 0.0, 0.0]).unwrap()
    };
    for norm in [1.0, f64::MAX, -1e300, f64::MIN_POSITIVE, 5e-324] {
        let meets = |x: f64| meet((&boxes[0], at(1.0, 0.0)), (&boxes[1], at(norm, x)));
        assert!(meets(3.0).meets, "{norm}");
        assert!(!meets(3.0_f64.next_up()).meets, "{norm}");
    }
    let far = meet((&boxes[0], at(1.0, 1e308)), (&boxes[1], at(1.0, -1e308)));
    assert_eq!((far.meets, far.path), (false, Path::Exact));
}

#[test]
fn lost_components_are_refused() {
    let refused = |q, t| WidePose::new(q, t).unwrap_err();
    assert_eq!(refused([0.0; 4], [0.0; 3]), InvalidInput::ZeroQuaternion);
    assert_eq!(refused([1e200, 0.0, 0.0, 1e-200], [0.0; 3]), InvalidInput::QuaternionSpread);
    assert_eq!(refused([1.0, 0.0, 0.0, 1e-300], [0.0; 3]), InvalidInput::QuaternionSpread);
    for (q, t) in [([f64::NAN; 4], [0.0; 3]), (UNTURNED, [f64::INFINITY; 3])] {
        assert!(matches!(refused(q, t), InvalidInput::NotFinite(_)));
    }
}

/// A point of a part is where the poses of the part and of its body take it, in this order.
#[test]
fn parts_have_composed_poses() {
    let part = ([0.0, 0.0, 3.0, 3.0], [105.0, 0.0, 35.0 * exp2(-20)]);
    let body = ([5.0, 3.0, 1.0, 0.0], [0.5, 0.0, -exp2(30)]);
    let composed = WidePose::composed(body, part).unwrap();
    let [inner, outer] = [part, body].map(|(q, t)| WidePose::new(q.map(f64::from), t).unwrap());
    for point in [[0.0; 3], [1.0, -2.0, 0.75]] {
        let [at, wanted] = [composed.point(&point), outer.point(&inner.point(&point))];
        let off = (0..3).map(|axis| (at[axis] - wanted[axis]).abs());
        assert!(off.fold(0.0, f64::max) < exp2(-20), "{at:?} {wanted:?}");
    }
    assert_eq!(composed.translation()[0], 45.5 + 10.0 * exp2(-20));
    let thirds = ([1.0, 1.0, 1.0, 0.0], [0.0; 3]);
    let at = |x: f64| WidePose::composed(thirds, (part.0, [x, 0.0, 0.0]));
    assert_eq!(at(105.0).map(|pose| pose.translation()[1]), Some(70.0));
    assert_eq!(at(1.0), None, "two thirds are no f64");
}
