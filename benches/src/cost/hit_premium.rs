//! What a hit of a second test costs more than a miss: times of lists with known shares of hits.

use crate::hull_test::HullTest;
use crate::measure::counts::Volume;
use crate::measure::turns::time;
use crate::measure::variant::Variant;
use crate::posed_ordops::PosedOrDops;
use crate::random::Stream;
use sdop::bodies::Bodies;
use sdop::pairs::PairList;
use sdop::simd::Tier;
use sdop::volume::Shape;

/// The seed of the draws of lists with a known share of hits.
const SEED: u64 = 0xca11_b8a7_e001_0000;
/// How many times such a list is timed.
const REPEATS: usize = 15;
/// The fewest pairs of such a list.
const FEWEST_PAIRS: usize = 32;

/// The price of a hit of a second test minus that of a miss, in seconds.
#[derive(Clone, Copy, Debug)]
pub(super) struct HitPremium(pub(super) f64);

impl HitPremium {
    /// Times lists of which a quarter and three quarters hit. `None` if there is no second test, or
    /// too few pairs.
    pub fn of(
        variant: &Variant,
        shapes: &[Shape],
        bodies: &Bodies,
        tier: Tier,
        [listed, kept]: [&[[u32; 2]]; 2],
    ) -> Option<Self> {
        let &[_, second] = variant.volumes().as_slice() else {
            return None;
        };
        let [few, many] = [1, 3].map(|quarters| mixture(listed, kept, quarters));
        let (few, many) = (few?, many?);
        let seconds: [f64; 2] = if second == Volume::Hull {
            let mut hulls = HullTest::new(shapes);
            [&few, &many].map(|list| time(REPEATS, || hulls.cull(bodies, list)))
        } else {
            let posed =
                PosedOrDops::new(shapes.iter().map(|shape| (shape, &shape.ordop)), bodies, tier);
            let columns = posed.columns(variant.settings.overlap);
            let mut out = PairList::default();
            [&few, &many].map(|list| {
                time(REPEATS, || {
                    out.clear();
                    columns.test_pairs(tier, list.first(), list.second(), &mut out)
                })
            })
        };
        Some(Self((seconds[1] - seconds[0]) / (0.5 * few.len() as f64)))
    }
}

/// A list in random order, of which `quarters` quarters are from `kept`, until either kind is used
/// up.
fn mixture(listed: &[[u32; 2]], kept: &[[u32; 2]], quarters: usize) -> Option<PairList> {
    let mut kept = kept.to_vec();
    kept.sort_unstable();
    let (mut hits, mut misses): (Vec<_>, Vec<_>) =
        listed.iter().partition(|pair| kept.binary_search(pair).is_ok());
    let quarter = hits.len().min(misses.len()) / 3;
    hits.truncate(quarters * quarter);
    misses.truncate((4 - quarters) * quarter);
    let mut all = [hits, misses].concat();
    if all.len() < FEWEST_PAIRS {
        return None;
    }
    let mut draws = Stream::new(SEED, quarters as u64);
    for last in (1..all.len()).rev() {
        all.swap(last, draws.index(last as u32 + 1) as usize);
    }
    Some(all.into_iter().collect())
}
