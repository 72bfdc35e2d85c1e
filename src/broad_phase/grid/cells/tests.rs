use super::*;

/// Rows that one body looks through, its own and the others' views of it included, differ by up to
/// two each way; three cells of each must not share a place.
#[test]
fn wrapped_rows_are_disjoint() {
    let bounds = BallBounds { lo: [0.0; 3], hi: [1e6; 3], widest: 1.0 };
    for bodies in (0..=28).map(|e| 1usize << e) {
        let cells = Cells::fit(&bounds, bodies, TableLayout::Wrapped);
        let (table, most) = (cells.table_len() as u32, WRAPPED_SPAN as i32 - 1);
        for y in -most..=most {
            for z in -most..=most {
                let at = cells.index([0, y as u32, z as u32]);
                let apart = at.min(table - at);
                assert!((y, z) == (0, 0) || apart >= WRAPPED_SPAN, "{table}: {y}, {z}");
            }
        }
    }
}

/// Bounds beyond the contract get some cells.
#[test]
fn invalid_bounds_get_some_cells() {
    let ends =
        [0.0, -0.0, 1e-45, 7.5, f32::MAX, f32::MIN, f32::INFINITY, f32::NEG_INFINITY, f32::NAN];
    for [lo, hi, widest] in (0..9 * 9 * 9).map(|i| [i % 9, i / 9 % 9, i / 81]) {
        let bounds = BallBounds {
            lo: [ends[lo], 0.0, 1.0],
            hi: [ends[hi], ends[hi], 2.0],
            widest: ends[widest].max(0.0),
        };
        for layout in [TableLayout::Box, TableLayout::Wrapped] {
            let cells = Cells::fit(&bounds, 10, layout);
            assert!(cells.count().iter().all(|&n| n > 0), "{bounds:?}");
            assert!(cells.table_len() < 2000, "{bounds:?}");
        }
    }
}

/// The farthest centre falls in the last cell.
#[test]
fn farthest_centre_is_in_last_cell() {
    for (n, radius) in (1..200u16).zip([0.954, 1.0, 1e-9, 7.0].into_iter().cycle()) {
        let widest = BallBounds { widest: radius, ..BallBounds::EMPTY };
        let size = Cells::fit(&widest, 1000, TableLayout::Box).size();
        let far = ((f64::from(n) + 0.5) * size) as f32;
        for lo in [0.0, (f64::from(far) - (f64::from(n) + 0.5) * size) as f32] {
            let bounds = BallBounds { lo: [lo; 3], hi: [far, lo, lo], widest: radius };
            let cells = Cells::fit(&bounds, 1000, TableLayout::Box);
            let mut found = [0; 2];
            let balls = [[lo, lo, lo, radius], [far, lo, lo, radius]];
            let (tier, to) = (crate::simd::Tier::SCALAR, &mut found);
            crate::simd::dispatch(
                tier,
                super::super::level::AssignCells { cells: &cells, balls: &balls, to },
            );
            assert_eq!(found, [0, cells.count()[0] - 1], "{n} cells and a half");
        }
    }
}

/// A box's table has room for every body's cell; its cells are as small as that and the widest body
/// allow, within a sixteenth.
#[test]
fn box_cells_are_minimal() {
    let mut larger = 0;
    for bodies in [0, 1, 10, 300, 5000, 100_000] {
        for sides in [[1.0, 1.0, 1.0], [1e3, 1.0, 0.0], [70.0, 300.0, 20.0], [1e4, 1e4, 9e3]] {
            for widest in [0.01, 0.5, 3.0, 1000.0] {
                let lo = [-7.0, 3.0, 100.0];
                let hi = [0, 1, 2].map(|i| lo[i] + sides[i]);
                let cells = Cells::fit(&BallBounds { lo, hi, widest }, bodies, TableLayout::Box);
                let most = CELLS_PER_BODY * bodies as f64 + SPARE_CELLS;
                let needed = 2.0 * f64::from(widen(widest)) * (1.0 + 1.0 / 65536.0);
                let in_box = |size: f64| -> f64 {
                    let ends = (0..3).map(|i| f64::from(hi[i]) - f64::from(lo[i]));
                    ends.map(|side| (side / size).round_ties_even() + 2.0).product()
                };
                let size = cells.size();
                assert!(size >= needed && in_box(size * 1.0001) <= most, "{size}");
                if size > needed {
                    assert!(in_box(size / 1.07) > most, "{size} of {needed}");
                    larger += 1;
                }
            }
        }
    }
    assert!(larger > 20, "{larger}");
}

/// Cells that are slightly larger than 2, this many along each axis.
fn cells(count: [u8; 3]) -> Cells {
    let bounds =
        BallBounds { lo: [0.0; 3], hi: count.map(|n| 2.0 * f32::from(n) - 2.0), widest: 1.0 };
    let cells = Cells::fit(&bounds, 1000, TableLayout::Box);
    assert_eq!(cells.count(), count.map(u32::from));
    cells
}

/// An empty cell lies after each row, and an empty row after each layer that has more than one;
/// the table ends with the last cell that the last body looks at.
#[test]
fn box_table_is_minimal() {
    for (count, row, layer, farthest) in [
        ([10, 4, 2], 11, 55, 66),
        ([10, 1, 2], 11, 11, 11),
        ([10, 4, 1], 11, 55, 11),
        ([10, 1, 1], 11, 11, 0),
        ([1, 1, 1], 2, 2, 0),
        ([1, 3, 3], 2, 8, 10),
    ] {
        let cells = cells(count);
        assert_eq!(cells.index([0, 1, 0]), row, "{count:?}");
        assert_eq!(cells.index([0, 0, 1]), layer, "{count:?}");
        let [x, y, z] = count.map(u32::from);
        let last = x - 1 + row * (y - 1) + layer * (z - 1);
        assert_eq!(cells.last(), last, "{count:?}");
        assert_eq!(cells.forward().last().copied().unwrap_or(0), farthest);
        assert_eq!(cells.table_len(), (last + farthest + 2) as usize, "{count:?}");
    }
}

/// Cells far from the origin are as small as others.
#[test]
fn far_cells_are_as_small() {
    let lo = 2.0_f32.powi(34);
    let bounds = BallBounds { lo: [lo; 3], hi: [lo + 4096.0; 3], widest: 1.0 };
    let size = Cells::fit(&bounds, 1000, TableLayout::Wrapped).size();
    assert!((2.0..2.001).contains(&size), "{size}");
}
