//! Every operation of every tier against plain arithmetic on arrays.

use super::*;

const X: [f32; 16] = [
    0.0, -0.0, 1.5, -2.25, 1e-40, -1e-40, 3e38, -3e38, 7.0, 0.1, -0.3, 1e-20, 5.0, -5.0, 42.0, 1.0,
];
const Y: [f32; 16] =
    [-0.0, 0.0, 1.5, 2.25, 1e-40, 1e-40, -3e38, 3e38, 0.7, -0.1, -0.2, 1e20, -5.0, -6.0, 41.0, 1.0];

/// Lanes as numbers: a vector's lane i is what `select` and `gt` can tell of it, so compare through
/// tables.
struct Check;

impl Kernel for Check {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) {
        for start in (0..16).step_by(L::WIDTH) {
            arithmetic(l, start);
            doubles(l, start);
            integers(l, start);
            transposed(l, start);
            quads(l, start);
        }
        masks(l);
        columns(l);
    }
}

/// Whether vector `v` holds exactly the numbers `expected` (compared as numbers: both orders of
/// `gt` are false).
fn same<L: Lanes>(l: L, v: L::F, expected: &[f32]) -> bool {
    let e = l.load(expected);
    l.bits(l.gt(v, e) | l.gt(e, v)) == 0
}

/// The bits of each lane, which tell −0 from +0.
fn bits_of<L: Lanes>(l: L, v: L::F) -> Vec<u32> {
    let mut out = [0; MAX_WIDTH];
    l.compress(u32::MAX, l.as_u32(v), &mut out);
    out[..L::WIDTH].to_vec()
}

fn columns<L: Lanes>(l: L) {
    let quads: [[f32; 4]; MAX_WIDTH] =
        std::array::from_fn(|i| std::array::from_fn(|c| (4 * i + c) as f32));
    let of_quads = quads_in_columns(l, &quads);
    let rows: [[f32; ROW]; MAX_WIDTH] =
        std::array::from_fn(|i| std::array::from_fn(|c| (ROW * i + c) as f32));
    let (mut turned, mut back) = ([[0.0; MAX_WIDTH]; ROW], [[0.0; MAX_WIDTH]; ROW]);
    turn_rows(l, &rows, &mut turned);
    turn_rows(l, &turned, &mut back);
    for i in 0..MAX_WIDTH {
        assert_eq!(of_quads.map(|column| column[i]), quads[i]);
        assert_eq!(turned.map(|column| column[i]), rows[i]);
    }
    assert_eq!(back, rows);
}

/// A number that f32 hasn't, and whose product with one of f32 rounds.
const THIRD: f64 = 1.0 / 3.0;

fn doubles<L: Lanes>(l: L, start: usize) {
    let (x, y) = (l.load(&X[start..]), l.load(&Y[start..]));
    let (a, b, third) = (l.widen(x), l.widen(y), l.splat_f64(THIRD));
    let found = [a * third + b, b - third * a, (a + third) / (b + third), a * b, a];
    for lane in 0..L::WIDTH {
        let [a, b] = [X[start + lane], Y[start + lane]].map(f64::from);
        let expected = [a * THIRD + b, b - THIRD * a, (a + THIRD) / (b + THIRD), a * b, a];
        for (found, expected) in found.into_iter().zip(expected) {
            let found = bits_of(l, l.narrow(found))[lane];
            assert_eq!(found, (expected as f32).to_bits(), "lane {}", start + lane);
        }
    }
}

fn masks<L: Lanes>(l: L) {
    let all = l.bits(l.first(L::WIDTH));
    for (a, b) in [(0, 0), (0, L::WIDTH), (L::WIDTH, L::WIDTH), (1, L::WIDTH)] {
        for (a, b) in [(a, b), (b, a)] {
            let (x, y) = (l.first(a), l.first(b));
            assert_eq!(l.bits(x & y), l.bits(x) & l.bits(y) & all);
            assert_eq!(l.bits(x | y), (l.bits(x) | l.bits(y)) & all);
        }
    }
}

fn arithmetic<L: Lanes>(l: L, start: usize) {
    let (xs, ys) = (&X[start..], &Y[start..]);
    let (x, y) = (l.load(xs), l.load(ys));
    let expect = |f: &dyn Fn(f32, f32) -> f32| -> Vec<f32> {
        xs.iter().zip(ys).map(|(&x, &y)| f(x, y)).collect()
    };
    assert!(same(l, x + y, &expect(&|x, y| x + y)));
    assert!(same(l, x - y, &expect(&|x, y| x - y)));
    assert!(same(l, x * y, &expect(&|x, y| x * y)));
    assert!(same(l, l.min(x, y), &expect(&|x, y| if x < y { x } else { y })));
    assert!(same(l, l.max(x, y), &expect(&|x, y| if x > y { x } else { y })));
    assert!(same(l, l.abs(x), &expect(&|x, _| x.abs())));
    let signs = [l.min(x, y), l.max(x, y)].map(|v| bits_of(l, v));
    let min = expect(&|x, y| if x < y { x } else { y });
    let max = expect(&|x, y| if x > y { x } else { y });
    for (found, expected) in signs.iter().zip([min, max]) {
        let expected: Vec<u32> = expected.iter().map(|x| x.to_bits()).collect();
        assert_eq!(found[..], expected[..L::WIDTH], "of equal ones the second");
    }
    let mut stored = [f32::NAN; MAX_WIDTH + 1];
    l.store(x, &mut stored);
    assert_eq!(stored[..L::WIDTH], xs[..L::WIDTH]);
    assert!(stored[L::WIDTH].is_nan(), "nothing is written behind the lanes");
    let flipped = expect(&|x, y| if y.is_sign_negative() { -x } else { x });
    assert!(same(l, l.flip_sign(x, y), &flipped));
    let negative =
        (0..L::WIDTH).filter(|&i| xs[i].is_sign_negative()).fold(0, |bits, i| bits | 1 << i);
    assert_eq!(l.bits(l.negative(x)), negative);
    let chosen = expect(&|x, y| if x.is_sign_negative() { x } else { y });
    assert!(same(l, l.select(l.negative(x), x, y), &chosen));
    let mut packed = [f32::NAN; MAX_WIDTH];
    l.pack(negative, x, &mut packed);
    let kept: Vec<f32> = xs[..L::WIDTH].iter().copied().filter(|x| x.is_sign_negative()).collect();
    assert_eq!(packed[..kept.len()], kept[..]);
    let greater = l.gt(x, y);
    let expected = (0..L::WIDTH).filter(|&i| xs[i] > ys[i]).fold(0, |bits, i| bits | 1 << i);
    assert_eq!(l.bits(greater), expected);
    assert!(same(l, l.select(greater, x, y), &expect(&f32::max)));
    let nan = l.splat(f32::NAN);
    assert_eq!(l.bits(l.gt(nan, x) | l.gt(x, nan)), 0, "NaN compares as not greater");
    assert!(same(l, l.max(nan, x), xs) && same(l, l.min(nan, x), xs), "a NaN yields the second");

    let table = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];
    let index: Vec<u32> = (0..16).map(|i| (5 * i + start as u32) % 8).collect();
    let expected: Vec<f32> = index.iter().map(|&i| table[i as usize]).collect();
    assert!(same(l, l.gather(&table, l.load_u32(&index)), &expected));
    assert!(same(l, l.gather(&table, l.splat_u32(1000)), &[7.0; 16]), "clamped");
    let index: Vec<u32> = (0..16).map(|i| (7 * i + start as u32) % 16).collect();
    let expected: Vec<f32> = index.iter().map(|&i| X[i as usize]).collect();
    assert!(same(l, l.lookup_16(&X, l.load_u32(&index)), &expected));
}

fn integers<L: Lanes>(l: L, start: usize) {
    let a: Vec<u32> = (0..16).map(|i| (i * 7 + start as u32) % 11).collect();
    let b: Vec<u32> = (0..16).map(|i| (i * 5 + 3) % 13).collect();
    let as_floats = |values: L::I| {
        let mut out = [0; MAX_WIDTH];
        l.compress(u32::MAX, values, &mut out);
        out[..L::WIDTH].to_vec()
    };
    let (va, vb) = (l.load_u32(&a), l.load_u32(&b));
    let expect = |f: &dyn Fn(u32, u32) -> u32| -> Vec<u32> {
        (0..L::WIDTH).map(|i| f(a[i], b[i])).collect()
    };
    assert_eq!(as_floats(l.add_u32(va, vb)), expect(&|a, b| a + b));
    let mut stored = [99; MAX_WIDTH + 1];
    l.store_u32(va, &mut stored);
    assert_eq!(stored[..L::WIDTH], a[..L::WIDTH]);
    assert_eq!(stored[L::WIDTH], 99, "nothing is written behind the lanes");
    look_up_integers(l, start);
    let bits: Vec<u32> = X[start..][..L::WIDTH].iter().map(|x| x.to_bits()).collect();
    assert_eq!(as_floats(l.as_u32(l.load(&X[start..]))), bits);
    let any: u32 = (0..L::WIDTH).filter(|&i| a[i] & b[i] != 0).map(|i| 1 << i).sum();
    let codes: Vec<u32> =
        (start as u32..).map(|i| (i * 77_777_777) | (i % 16)).take(L::WIDTH).collect();
    let (high, low) = l.split_u32(l.load_u32(&codes));
    let expect = |f: &dyn Fn(u32) -> u32| -> Vec<u32> {
        codes[..L::WIDTH].iter().map(|&code| f(code)).collect()
    };
    assert_eq!(as_floats(high), expect(&|code| code >> 4));
    assert_eq!(as_floats(low), expect(&|code| code & 15));
    for n in 0..=L::WIDTH + 1 {
        assert_eq!(l.bits(l.first(n)).count_ones() as usize, n.min(L::WIDTH));
    }
    let kept: Vec<u32> = (0..L::WIDTH).filter(|&i| a[i] & b[i] != 0).map(|i| a[i]).collect();
    let mut out = [99; MAX_WIDTH];
    l.compress(any, va, &mut out);
    assert_eq!(out[..kept.len()], kept[..]);
}

/// The lanes of a vector.
fn lanes_of<L: Lanes>(l: L, v: L::I) -> Vec<u32> {
    let mut out = [0; MAX_WIDTH];
    l.store_u32(v, &mut out);
    out[..L::WIDTH].to_vec()
}

/// Comparisons of integers on either side of 2³¹, and tables of them.
fn look_up_integers<L: Lanes>(l: L, start: usize) {
    let numbers = [0, 1, 7, (1 << 31) - 1, 1 << 31, (1 << 31) + 1, u32::MAX];
    for shift in 0..numbers.len() {
        let column = |step: usize| -> Vec<u32> {
            (start..start + L::WIDTH)
                .map(|lane| numbers[(step * lane + shift * step / 2) % numbers.len()])
                .collect()
        };
        let (a, b) = (column(1), column(3));
        let expect = |f: &dyn Fn(u32, u32) -> u32| -> Vec<u32> {
            a.iter().zip(&b).map(|(&a, &b)| f(a, b)).collect()
        };
        let (va, vb) = (l.load_u32(&a), l.load_u32(&b));
        let greater = l.gt_u32(va, vb);
        let lanes = (0..L::WIDTH).filter(|&lane| a[lane] > b[lane]);
        assert_eq!(l.bits(greater), lanes.fold(0, |bits, lane| bits | 1 << lane));
        assert_eq!(lanes_of(l, l.select_u32(greater, va, vb)), expect(&u32::max));
        assert_eq!(lanes_of(l, l.select_u32(greater, vb, va)), expect(&u32::min));
    }
    let table: [u32; 16] = std::array::from_fn(|entry| u32::MAX - 10 * entry as u32);
    let entries = |scale: u32| -> Vec<u32> {
        let first = start as u32;
        (first..first + L::WIDTH as u32).map(|lane| (scale * lane + 3) % 24).collect()
    };
    let index = entries(7);
    let gathered: Vec<u32> = index.iter().map(|&entry| table[entry.min(15) as usize]).collect();
    assert_eq!(lanes_of(l, l.gather_u32(&table, l.load_u32(&index))), gathered);
    assert_eq!(
        lanes_of(l, l.gather_u32(&table, l.splat_u32(u32::MAX))),
        [table[15]; 16][..L::WIDTH]
    );
    let index: Vec<u32> = entries(5).iter().map(|entry| entry % 16).collect();
    let found: Vec<u32> = index.iter().map(|&entry| table[entry as usize]).collect();
    assert_eq!(lanes_of(l, l.lookup_16_u32(&table, l.load_u32(&index))), found);
}

fn transposed<L: Lanes>(l: L, start: usize) {
    let rows: Vec<[f32; ROW]> =
        (0..40).map(|row| std::array::from_fn(|column| (row * 100 + column) as f32)).collect();
    // The seventh index lies after the table and reads its end.
    let pick: Vec<u32> = (0..16)
        .map(|lane| if lane == 6 { 1000 } else { (lane * 23 + 5) % 40 })
        .skip(start)
        .collect();
    for (column, lanes) in l.load_transposed(&rows, &pick).into_iter().enumerate() {
        let expected: Vec<f32> =
            pick.iter().map(|&row| (row.min(39) * 100 + column as u32) as f32).collect();
        assert!(same(l, lanes, &expected), "column {column}");
    }
}

fn quads<L: Lanes>(l: L, start: usize) {
    let quads: Vec<[f32; 4]> =
        (0..40).map(|quad| std::array::from_fn(|column| (quad * 10 + column) as f32)).collect();
    // Every other index lies after the table and reads its end.
    let pick: Vec<u32> = (start as u32..16).map(|lane| (15 - lane) * 2 + lane % 2 * 80).collect();
    let codes: Vec<u32> = pick.iter().map(|&quad| (quad << 4) | (quad % 16)).collect();
    let columns = l.load_quads(&quads[3..]).into_iter().zip(l.gather_quads(&quads, &codes));
    for (column, (loaded, gathered)) in columns.enumerate() {
        let loaded_from: Vec<f32> = (3..19).map(|quad| quads[quad][column]).collect();
        assert!(same(l, loaded, &loaded_from), "column {column}");
        let gathered_from: Vec<f32> =
            pick.iter().map(|&quad| quads[(quad as usize).min(39)][column]).collect();
        assert!(same(l, gathered, &gathered_from), "column {column}");
    }
    let mut stored = [[0.5; 4]; MAX_WIDTH + 1];
    l.store_quads(l.load_quads(&quads[3..]), &mut stored);
    assert_eq!(stored[..L::WIDTH], quads[3..3 + L::WIDTH]);
    assert_eq!(stored[L::WIDTH], [0.5; 4], "nothing is written behind");
    let sixes: Vec<[f32; 6]> =
        (0..40).map(|six| std::array::from_fn(|column| (six * 10 + column) as f32)).collect();
    for (column, lanes) in l.gather_sixes(&sixes, &pick).into_iter().enumerate() {
        let of_six = |&six: &u32| sixes[(six as usize).min(39)][column];
        let expected: Vec<f32> = pick.iter().map(of_six).collect();
        assert!(same(l, lanes, &expected), "column {column}");
    }
}

#[test]
fn every_tier_does_plain_arithmetic() {
    for tier in Tier::available() {
        dispatch(tier, Check);
    }
}

/// A safe call with nothing to read from must not read; of integers, or of numbers.
struct GatherFromNothing(bool);

impl Kernel for GatherFromNothing {
    type Output = u32;

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> u32 {
        if self.0 {
            let read = l.gather_u32(&[], l.splat_u32(3));
            return l.bits(l.gt_u32(read, read));
        }
        let read = l.gather(&[], l.splat_u32(3));
        l.bits(l.gt(read, read))
    }
}

/// An empty table is refused in every tier.
#[test]
fn empty_table_is_rejected() {
    for tier in Tier::available() {
        for integers in [false, true] {
            let read = std::panic::catch_unwind(|| dispatch(tier, GatherFromNothing(integers)));
            assert!(read.is_err(), "{tier}");
        }
    }
}

#[test]
fn the_flushing_tier_drops_denormals() {
    struct Flush;
    impl Kernel for Flush {
        type Output = [u32; 3];
        fn run<L: Lanes>(self, l: L) -> [u32; 3] {
            let (tiny, half) = (l.splat(f32::MIN_POSITIVE), l.splat(0.5));
            let zero = l.splat(0.0);
            let denormal = l.load(&[1e-40; 16]);
            [tiny * half, tiny - tiny * l.splat(0.75), denormal].map(|v| l.bits(l.gt(v, zero)) & 1)
        }
    }
    assert_eq!(dispatch(Tier::SCALAR, Flush), [1; 3]);
    assert_eq!(dispatch(Tier::SCALAR_FLUSH, Flush), [0, 1, 0]);
}

/// Levels are there and go by their names.
#[test]
fn tiers_parse_by_name() {
    let available = Tier::available();
    assert_eq!(available.first(), Some(&Tier::SCALAR));
    assert!(available.contains(&Tier::detect()));
    for tier in available {
        assert!(Tier::NAMES.contains(&tier.name()), "{tier}");
        assert_eq!(tier.to_string(), tier.name());
        assert_eq!(format!("{tier:?}"), format!("Tier({})", tier.name()));
    }
}

/// An unknown tier and a missing one are different errors.
#[test]
fn unknown_and_missing_tiers_differ() {
    let unknown = "avx1024".parse::<Tier>();
    assert_eq!(unknown, Err(TierError::Unknown("avx1024".into())));
    for name in Tier::NAMES {
        match name.parse::<Tier>() {
            Ok(tier) => assert_eq!(tier.name(), name),
            Err(error) => assert!(matches!(error, TierError::Unavailable { .. }), "{error}"),
        }
    }
}
