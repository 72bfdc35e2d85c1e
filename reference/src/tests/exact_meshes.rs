//! Compares triangles and meshes with brute force in rationals, and the stages with each other.

use dashu_int::IBig;

use super::hard::{TURN, turned_back};
use super::rational;
use super::shapes::{Draws, Mesh as Arrays, cuboid, torus};
use crate::Pose;
use crate::exact::meeting::meet;
use crate::exact::mesh::Mesh;
use crate::exact::triangle::{enclosed, filter, integral};
use crate::exact::{Interval, Path, Tally};
use crate::linear::Vector;
use crate::number::{Number, power_of_two, unit_of};

fn prepared((vertices, triangles): &Arrays) -> Mesh {
    Mesh::new(vertices, triangles).unwrap()
}

/// Corners on a coarse grid: coplanar, collinear and coincident ones are common.
fn grid_triangle(draws: &mut Draws, scale: f32) -> [[f32; 3]; 3] {
    [(); 3].map(|()| [(); 3].map(|()| draws.signed(3.0).trunc() * scale))
}

#[test]
fn grid_triangles_agree_with_rational_axes() {
    let mut draws = Draws(3);
    let (mut met, mut silent) = (0, 0);
    for n in 0..2500 {
        let scale = power_of_two([0, 59, -149][n % 3]) as f32;
        let mut corners = [(); 2].map(|()| grid_triangle(&mut draws, scale));
        if n % 5 == 0 {
            // All in one plane.
            corners.as_flattened_mut().iter_mut().for_each(|p| p[n / 5 % 3] = 0.0);
        }
        let truth = {
            let [a, b] = corners.map(|t| t.map(rational::rational3));
            rational::triangles_meet(&a, &b)
        };
        let [a, b] = corners.map(|t| t.map(|p| p.map(f64::from)));
        let unit = unit_of(corners.iter().flatten().flatten().map(|x| f64::from(*x)));
        fn lift<N: Number>(t: &[Vector<f64>; 3], unit: i32) -> [Vector<N>; 3] {
            t.map(|p| p.map(|x| N::lift(x, unit)))
        }
        assert_eq!(integral(&[lift::<IBig>(&a, unit), lift(&b, unit)]), Some(truth), "{corners:?}");
        for guess in
            [filter([&a, &b], 0.0), enclosed(&[lift::<Interval>(&a, unit), lift(&b, unit)])]
        {
            silent += u32::from(guess.is_none());
            assert!(guess.is_none_or(|guess| guess == truth), "{corners:?}");
        }
        met += u32::from(truth);
    }
    assert!(
        (600..1900).contains(&met) && (400..4600).contains(&silent),
        "{met} met, {silent} silent"
    );
}

/// The same grid contacts where f64 cannot represent a single mapped corner.
#[test]
fn turned_triangles_keep_contacts() {
    let mut draws = Draws(37);
    let (mut met, mut paths) = (0, Tally::default());
    for _ in 0..4000 {
        let corners = [(); 2].map(|()| grid_triangle(&mut draws, 1.0));
        let lift = |t: &[[f32; 3]; 3]| t.map(|p| p.map(|x| IBig::lift(f64::from(x), 0)));
        let truth = integral(&[lift(&corners[0]), lift(&corners[1])]) == Some(true);
        let alone = |corners: [[f32; 3]; 3]| prepared(&(corners.to_vec(), vec![[0, 1, 2]]));
        let (a, b) =
            (alone(corners[0].map(|p| p.map(|x| x * TURN))), alone(corners[1].map(turned_back)));
        let (pose_a, pose_b) = draws.turned_poses();
        let forth = meet((&a, &pose_a), (&b, &pose_b));
        let back = meet((&b, &pose_b), (&a, &pose_a));
        assert_eq!((forth.meets, back.meets), (truth, truth), "{corners:?} {pose_a:?}");
        met += u32::from(truth);
        paths.count(forth.path);
    }
    assert!(
        (1000..3000).contains(&met) && paths.exact > 1000 && paths.filter > 1000,
        "{met} {paths:?}"
    );
}

/// A closed tetrahedron with corners on a grid, perhaps flat.
fn tetrahedron(draws: &mut Draws, scale: f32) -> Arrays {
    let vertices =
        (0..4).map(|_| [(); 3].map(|()| draws.signed(4.0).trunc() / 2.0 * scale)).collect();
    (vertices, vec![[0, 1, 2], [0, 3, 1], [1, 3, 2], [0, 2, 3]])
}

/// Degenerate and open meshes, and a small one that fits inside others.
fn small_mesh(draws: &mut Draws, scale: f32) -> Arrays {
    let point = |draws: &mut Draws| [(); 3].map(|()| draws.signed(3.0).trunc() / 4.0 * scale);
    match draws.bits() % 6 {
        0 => (vec![point(draws)], vec![[0, 0, 0]]),
        1 => (vec![point(draws), point(draws)], vec![[0, 1, 1]]),
        2 => (vec![point(draws), point(draws), point(draws)], vec![[0, 1, 2]]),
        3 => {
            let (mut vertices, mut triangles) = tetrahedron(draws, 0.125 * scale);
            vertices.push(point(draws));
            triangles.push([4, 4, 4]);
            (vertices, triangles)
        }
        _ => tetrahedron(draws, scale),
    }
}

#[test]
fn hard_meshes_agree_with_brute_force() {
    let mut draws = Draws(5);
    let (mut met, mut paths) = (0, Tally::default());
    for _ in 0..500 {
        let case = draws.hard_case();
        let scale = power_of_two(case.size) as f32;
        let (a, b) = (
            prepared(&tetrahedron(&mut draws, 2.0 * scale)),
            prepared(&small_mesh(&mut draws, scale)),
        );
        let (a, b) = ((&a, &case.a), (&b, &case.b));
        let truth = rational::meshes_meet(a, b);
        for (a, b) in [(a, b), (b, a)] {
            let meeting = meet(a, b);
            assert_eq!(meeting.meets, truth, "{case:?} {:?} {:?}", a.0.triangles, b.0.triangles);
            paths.count(meeting.path);
        }
        met += u32::from(truth);
    }
    assert!((100..400).contains(&met) && paths.exact > 50, "{met} met, {paths:?}");
}

#[test]
fn inside_needs_a_closed_component() {
    let at = |t: [f32; 3]| Pose::new([0.3, -0.2, 0.9, 0.7], t).unwrap();
    let shell = prepared(&cuboid([1.0; 3]));
    let inner = prepared(&cuboid([0.25, 0.125, 0.0625]));
    let ring = prepared(&torus(1.0, 0.5, 24, 12));
    let meets = |a: &Mesh, b: &Mesh, t: [f32; 3]| {
        let forth = meet((a, &at([0.0; 3])), (b, &at(t))).meets;
        assert_eq!(meet((b, &at(t)), (a, &at([0.0; 3]))).meets, forth);
        forth
    };
    assert!(meets(&shell, &inner, [0.0; 3]), "concentric");
    assert!(!meets(&ring, &inner, [0.0; 3]), "in the hole");
    let (mut vertices, mut triangles) = cuboid([1.0; 3]);
    triangles.pop();
    assert!(
        !meets(&prepared(&(vertices.clone(), triangles.clone())), &inner, [0.0; 3]),
        "an open box has no inside"
    );
    // An open box about a closed one about the inner: the closed component alone decides.
    let (closer, faces) = cuboid([0.5; 3]);
    triangles.extend(faces.iter().map(|t| t.map(|i| i + 8)));
    vertices.extend(closer);
    assert!(meets(&prepared(&(vertices, triangles)), &inner, [0.0; 3]), "inside one component");
    // An open box about the inner and a closed one elsewhere.
    let (mut vertices, mut triangles) = cuboid([1.0; 3]);
    triangles.pop();
    let (closer, faces) = cuboid([0.5; 3]);
    triangles.extend(faces.iter().map(|t| t.map(|i| i + 8)));
    vertices.extend(closer.iter().map(|v| [v[0] + 3.0, v[1], v[2]]));
    assert!(
        !meets(&prepared(&(vertices, triangles)), &inner, [0.0; 3]),
        "inside an open one alone"
    );
    // Two shells, one inside the other: the point is inside both, once each.
    let (mut vertices, mut triangles) = cuboid([1.0; 3]);
    let (closer, faces) = cuboid([0.5; 3]);
    triangles.extend(faces.iter().map(|t| t.map(|i| i + 8)));
    vertices.extend(closer);
    assert!(meets(&prepared(&(vertices, triangles)), &inner, [0.0; 3]), "parity is per component");
    // A box whose triangles have vertices of their own, at 0 or at −0, and a closed one in its
    // corner.
    let (corners, faces) = cuboid([1.0; 3]);
    let own = |(n, i): (usize, &u32)| {
        corners[*i as usize].map(|x| if x < 0.0 { [0.0, -0.0][n % 2] } else { 2.0 })
    };
    let mut vertices: Vec<_> = faces.as_flattened().iter().enumerate().map(own).collect();
    let mut triangles: Vec<[u32; 3]> = (0..12).map(|t| [0, 1, 2].map(|i| 3 * t + i)).collect();
    let meets_inner = |vertices: &[[f32; 3]], triangles: &[[u32; 3]]| {
        // The middle of the box, near (1, 1, 1) before it is turned.
        let middle = [-0.972, -0.007, 1.434];
        meets(&prepared(&(vertices.to_vec(), triangles.to_vec())), &inner, middle)
    };
    assert!(meets_inner(&vertices, &triangles), "equal positions are one vertex");
    assert!(!meets_inner(&vertices, &triangles[1..]), "a triangle is missing");
    triangles.extend(faces.iter().map(|t| t.map(|i| i + 36)));
    vertices.extend(corners.iter().map(|v| v.map(|x| 0.125 * (x + 1.0))));
    assert!(meets_inner(&vertices, &triangles), "closed components stay apart");
}

/// Collapsed faces do not confuse the parity.
#[test]
fn collapsed_faces_keep_the_parity() {
    // A box whose faces carry zero-area slivers, and about it a closed pair of faces that are one
    // point; queried from many points inside and out.
    let (mut vertices, mut triangles) = cuboid([1.0; 3]);
    let middle = vertices.len() as u32;
    vertices.extend([[0.0, -1.0, -1.0], [0.0, -1.0, -1.0]]);
    let split = triangles.iter().position(|t| t.contains(&0) && t.contains(&1)).unwrap();
    let [a, b, c] = triangles.remove(split);
    let rotated = [[a, b, c], [b, c, a], [c, a, b]].into_iter().find(|t| t[0] + t[1] == 1).unwrap();
    let [a, b, c] = rotated;
    // The edge's new middle, twice: a sliver (a, middle, b) closes the gap to the other face, a
    // point face the rest.
    triangles.extend([
        [a, middle, c],
        [middle, b, c],
        [a, b, middle + 1],
        [a, middle + 1, middle],
        [middle, middle + 1, b],
    ]);
    let speck = vertices.len() as u32;
    vertices.extend([[7.0, 7.0, 7.0]; 3]);
    triangles.extend([[speck, speck + 1, speck + 2], [speck, speck + 2, speck + 1]]);
    let shell = Mesh::new(&vertices, &triangles).unwrap();
    assert!(shell.components.iter().all(|component| component.closed));
    let mut draws = Draws(9);
    for _ in 0..300 {
        let point = [(); 3].map(|()| draws.signed(9.0).trunc() / 5.0);
        let mote = prepared(&(vec![point], vec![[0, 0, 0]]));
        let pose = Pose::new([0.0, 0.0, 0.0, 1.0], [0.0; 3]).unwrap();
        let inside = point.iter().all(|x| x.abs() <= 1.0);
        assert_eq!(meet((&shell, &pose), (&mote, &pose)).meets, inside, "{point:?}");
    }
}

#[test]
fn generic_meshes_never_leave_the_filter() {
    let mesh = prepared(&torus(1.0, 0.4, 40, 20));
    let mut draws = Draws(13);
    let (mut met, mut tally) = (0, Tally::default());
    for _ in 0..200 {
        let meeting = meet((&mesh, &draws.pose(0.0)), (&mesh, &draws.pose(1.4)));
        assert_eq!(meeting.path, Path::Filter);
        met += u32::from(meeting.meets);
        tally.filter += meeting.tally.filter;
    }
    assert!((50..180).contains(&met) && tally.filter > 1000, "{met} met, {tally:?}");
}
