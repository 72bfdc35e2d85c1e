use super::*;
use crate::simd::{Kernel, Tier, dispatch};

struct ListMeeting<'a>(&'a Tree, Aabb);

impl Kernel for ListMeeting<'_> {
    type Output = Vec<u32>;
    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> Vec<u32> {
        let mut found = Vec::new();
        let Self(tree, aabb) = self;
        tree.each_meeting(l, &aabb, |place| found.push(tree.numbers()[place]));
        found.sort_unstable();
        found
    }
}

/// Boxes on a lattice of halves, of two sizes, so that many only touch.
fn boxes(count: u32, step: u32) -> Vec<Aabb> {
    let at = |i: u32, of: u32| ((i * step / of) % 9) as f32 * 0.5;
    (0..count)
        .map(|i| {
            let min = [at(i, 1), at(i, 9), at(i, 81)];
            let side = if i % 7 == 0 { 4.0 } else { 0.5 };
            Aabb::new(min, min.map(|x| x + side))
        })
        .collect()
}

fn assert_finds(tree: &Tree, boxes: &[Option<Aabb>]) {
    for query in [
        Aabb::new([1.0; 3], [1.0; 3]),
        Aabb::new([-9.0; 3], [0.0; 3]),
        Aabb::new([0.25; 3], [2.0, 3.0, 0.3]),
        Aabb::new([50.0; 3], [60.0; 3]),
    ] {
        let meets = |aabb: &Option<Aabb>| aabb.is_some_and(|aabb| aabb.meets(&query));
        let wanted = (0..).zip(boxes).filter(|(_, aabb)| meets(aabb));
        let wanted: Vec<u32> = wanted.map(|(number, _)| number).collect();
        for tier in Tier::available() {
            assert_eq!(dispatch(tier, ListMeeting(tree, query)), wanted, "{tier}");
        }
    }
}

/// A tree finds what meets whatever its size.
#[test]
fn tree_finds_meeting_boxes() {
    for count in [0, 1, 15, 16, 17, 256, 257, 4097] {
        let boxes = boxes(count, 5);
        let tree = Tree::build((0..).zip(boxes.iter().copied()).collect());
        let boxes: Vec<_> = boxes.into_iter().map(Some).collect();
        assert_finds(&tree, &boxes);
        assert!(!tree.is_worn());
    }
}

/// Changes are found and wear the tree.
#[test]
fn changes_wear_the_tree() {
    let first = boxes(300, 5);
    let mut tree = Tree::build((0..).zip(first.iter().copied()).collect());
    let mut place = vec![0; 300];
    for (at, &number) in tree.numbers().iter().enumerate() {
        place[number as usize] = at as u32;
    }
    let mut now: Vec<_> = first.into_iter().map(Some).collect();
    for (number, aabb) in boxes(340, 7).into_iter().enumerate() {
        match number {
            0..100 => tree.set(place[number], &aabb),
            100..120 => tree.remove(place[number]),
            300.. => _ = tree.push(number as u32, &aabb),
            _ => continue,
        }
        now.resize(now.len().max(number + 1), None);
        now[number] = (!(100..120).contains(&number)).then_some(aabb);
    }
    tree.settle();
    assert_finds(&tree, &now);
    for number in 120..200 {
        tree.remove(place[number]);
        now[number] = None;
    }
    tree.settle();
    assert_finds(&tree, &now);
    assert!(tree.is_worn(), "140 of 340");
}

/// One by one, so that levels come on top of others.
#[test]
fn a_tree_grows() {
    let boxes = boxes(300, 5);
    let (mut tree, mut now) = (Tree::default(), Vec::new());
    for (number, aabb) in (0..).zip(boxes) {
        assert_eq!(tree.push(number, &aabb), number);
        tree.settle();
        now.push(Some(aabb));
        if [1, 16, 17, 18, 256, 257, 300].contains(&now.len()) {
            assert_finds(&tree, &now);
        }
    }
}

#[test]
fn spreading_wears_the_tree() {
    let near = boxes(256, 5);
    let mut tree = Tree::build((0..).zip(near.iter().copied()).collect());
    for (at, number) in tree.numbers().to_vec().into_iter().enumerate() {
        let far = (number % 16) as f32 * 100.0;
        let aabb = near[number as usize];
        tree.set(at as u32, &Aabb::new(aabb.min.map(|x| x + far), aabb.max.map(|x| x + far)));
    }
    tree.settle();
    assert!(tree.is_worn());
}

/// A far box, in any direction and at any distance, leaves the groups of the others small.
#[test]
fn a_far_box_leaves_groups_small() {
    let cubes = |far: Option<f32>| {
        let at = |i: u32| [i % 16, i / 16 % 16, i / 256].map(|x| 2.0 * x as f32);
        let near = (0..4096).map(at).chain(far.map(|x| [-x, x, 0.5 * x]));
        let cubes = near.map(|min| Aabb::new(min, min.map(|x| x + 1.0)));
        Tree::build((0..).zip(cubes).collect())
    };
    // The half sides of all groups but the widest one, which has the far box.
    let width = |tree: &Tree| {
        let groups = tree.groups().iter().filter_map(BoxGroup::bounds);
        let mut widths: Vec<f32> =
            groups.map(|aabb| aabb.half_sides().iter().sum::<f32>()).collect();
        widths.sort_unstable_by(f32::total_cmp);
        widths.pop();
        widths.iter().sum::<f32>()
    };
    let alone = width(&cubes(None));
    for far in [1.0e3, 1.0e6, 1.0e18, 1.0e30] {
        let tree = cubes(Some(far));
        assert!(width(&tree) < 1.2 * alone, "{far}");
        assert!(tree.built_width < 1.2 * cubes(None).built_width, "{far}");
    }
}

/// Small boxes and a far larger one are in separate groups.
#[test]
fn sizes_are_apart() {
    let small = |i: u32| Aabb::new([i as f32; 3], [i as f32 + 0.5; 3]);
    let mut all: Vec<_> = (0..31).map(|i| (i, small(i))).collect();
    all.insert(7, (31, Aabb::new([0.0; 3], [500.0; 3])));
    let tree = Tree::build(all);
    assert_eq!(tree.numbers()[0], 31);
}
