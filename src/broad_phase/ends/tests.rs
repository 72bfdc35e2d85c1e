use super::*;
use crate::simd::Tier;

/// Grown boxes hold their own and are no longer than they may be.
#[test]
fn grown_boxes_are_tight() {
    let ends = [0.0_f32, 1.0, 1e-30, 3.0e7, 1.0e9, 1e30, f32::MAX, f32::from_bits(1)];
    for end in ends.into_iter().flat_map(|end| [end, -end]) {
        for by in [1e-20, 0.3, 0.375, 5.0e3, 1e30, f32::INFINITY] {
            let Aabb { min, max } = grown(Aabb::new([end; 3], [end; 3]), by);
            assert!(min[0] <= end && end <= max[0], "{end}, {by}: {min:?}");
            // Sums of f64 round to the nearest as well, so that they are no smaller than an f32
            // below the exact sum.
            let [end, by] = [end, by].map(f64::from);
            assert!(f64::from(max[0]) <= end + by, "{end}, {by}: {max:?}");
            assert!(f64::from(min[0]) >= end - by, "{end}, {by}: {min:?}");
        }
    }
    let cube = grown(Aabb::new([1.0, 2.0, 3.0], [4.0, 5.0, 6.0]), 0.5);
    let off = |found: [f32; 3], wanted: [f32; 3]| (0..3).map(move |k| found[k] - wanted[k]);
    let mut offs = off(cube.min, [0.5, 1.5, 2.5]).chain(off(cube.max, [4.5, 5.5, 6.5]));
    assert!(offs.all(|off| off.abs() < 1e-6), "{cube:?}");
}

/// Boxes are held until one of them leaves wherever it is in every tier.
#[test]
fn any_leaving_box_is_detected() {
    let pool = Threads::default();
    for count in [1, 15, 16, 17, 40, BOXES_PER_TASK + 3] {
        let mut boxes: Vec<Aabb> = (0..count)
            .map(|i| Aabb::new([i as f32, -2.0, 3.0], [i as f32 + 1.0, 5.0, 4.0]))
            .collect();
        let order: Vec<u32> = (0..count as u32).rev().collect();
        for tier in Tier::available() {
            let (executor, mut ends) = (pool.executor(tier), EndSlots::default());
            ends.fill(executor, &order, &boxes, true);
            for moved in [0, count / 2, count - 1] {
                assert!(ends.hold(executor, &order, &boxes), "{tier}: {count}");
                let Aabb { min, max } = boxes[moved];
                for axis in 0..3 {
                    boxes[moved].min[axis] = min[axis].next_down();
                    assert!(!ends.hold(executor, &order, &boxes), "{tier}: {moved}");
                    boxes[moved].min[axis] = min[axis].next_up();
                    assert!(ends.hold(executor, &order, &boxes), "{tier}: {moved}");
                    boxes[moved].max[axis] = max[axis].next_up();
                    assert!(!ends.hold(executor, &order, &boxes), "{tier}: {moved}");
                    boxes[moved] = Aabb { min, max };
                }
            }
            // Fewer are asked than there are.
            boxes[0].max[1] += 1.0;
            let others = &order[..count - 1];
            assert!(ends.hold(executor, others, &boxes), "{tier}: {count}");
            boxes[0].max[1] -= 1.0;
        }
    }
}

/// Moving boxes grow and others do not.
#[test]
fn only_moving_boxes_grow() {
    let boxes = [1.0, 2.0, 3.0].map(|x| Aabb::new([x; 3], [x + 10.0; 3]));
    let (pool, mut ends) = (Threads::default(), EndSlots::default());
    let (cubes, skin) = ([[0.0, 0.0, 0.0, 0.5]; 2], Skin::share(0.125));
    ends.fill_grown(pool.executor(Tier::SCALAR), &[2, 0, 1], &boxes, (&cubes, skin));
    let slots = |ends: &EndSlots| [0, 1, 2].map(|slot| [ends.lower[slot], ends.upper[slot]]);
    for (found, (name, grows)) in slots(&ends).into_iter().zip([(2, true), (0, true), (1, false)]) {
        let aabb: Aabb = boxes[name];
        let Aabb { min, max } = if grows { grown(aabb, 0.5) } else { aabb };
        assert_eq!(found.map(|quad| [quad[0], quad[1], quad[2]]), [min, max]);
    }
    let lowest = slots(&ends).map(|[lower, _]| lower[0]);
    assert_eq!(ends.columns[0][..3], lowest);
}
