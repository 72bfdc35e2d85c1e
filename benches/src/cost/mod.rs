//! What culling costs: the paper's formula (equation 1) T = Nu·Cu + Nv·Cv + Co.
//!
//! Nu and Nv are [counted](crate::measure::counts) in the run that is predicted. A price belongs to
//! a machine, a volume (with the shapes that it bounds) and a declared regime: warm or cold frames,
//! and the [cache level](level) of the working set. It is [calibrated](calibrate) on calibration
//! scenes ([`design`]), which are never predicted. It is the same wherever it is printed: for
//! spheres in every strategy that begins with them, for or-DOPs in every strategy that refines by
//! them. What a strategy costs in addition to its volumes has separate prices, in F.
//!
//! | price | identified by | in which stage |
//! |---|---|---|
//! | Cu | the number of bodies | update |
//! | F per frame, per body | the number of bodies at one share of hits | finding |
//! | F per body with hits | the share of hits at one number of bodies, while most bodies have none | finding |
//! | Cv of a miss | tests, which grow as the square of bodies | finding, or refining for or-DOPs |
//! | Cv of a hit | the share of hits at one number of bodies; of a second test, lists of known shares | the same |
//! | Cv of a further slab | the share of hits: how many vectors of world-aligned slabs continue | finding |
//! | F per listed pair | pairs that are listed for a second test, in addition to the costs of spheres alone | finding, refining |

pub mod calibrate;
pub mod construct;
pub mod design;
mod expected;
mod explain;
mod fit;
mod hit_premium;
pub mod level;
pub mod pass;
pub mod predict;
pub mod rows;
pub mod study;
pub mod table;
pub mod terms;

use serde::{Deserialize, Serialize};

/// The prices of one volume, in seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct VolumeCosts {
    /// Co: building the volume of every shape and an empty culler, once.
    pub construct: f64,
    /// Cu: one update.
    pub update: f64,
    /// Co: the part of building the culler that grows with each body.
    pub construct_body: f64,
    /// F per frame, independent of the number of bodies. For a second volume, the part that its
    /// strategy adds.
    pub frame: f64,
    /// F per body and frame: arranging it for the finder and running over its candidates.
    pub body: f64,
    /// F per body that has a hit among its candidates: listing a vector of hits, full or not.
    pub row: f64,
    /// F per pair that passed the test before: listing it for this one, and with an object of
    /// interest selecting and merging it.
    pub handle: f64,
    /// Cv of a pair that survives.
    pub hit: f64,
    /// Cv of a pair that is culled, which may end at its first separating axis.
    pub miss: f64,
    /// Cv of a pair for each further slab that its vector is tested on, world-aligned volumes only.
    pub further: f64,
}

/// A price: its key in files, what it is of, its unit, and where it is.
pub struct PriceKind {
    /// Its key in files.
    pub key: &'static str,
    /// Its name in tables.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Where it is.
    pub of: fn(&mut VolumeCosts) -> &mut f64,
}

impl PriceKind {
    /// Its value.
    #[must_use]
    pub fn value(&self, mut costs: VolumeCosts) -> f64 {
        *(self.of)(&mut costs)
    }
}

/// All prices, in the order of the formula.
pub const PRICES: [PriceKind; 10] = [
    price("construct", "Co", "s", |c| &mut c.construct),
    price("construct_body", "Co per body", "s", |c| &mut c.construct_body),
    price("update", "Cu", "s per update", |c| &mut c.update),
    price("frame", "F per frame", "s per frame", |c| &mut c.frame),
    price("body", "F per body", "s per body and frame", |c| &mut c.body),
    price("row", "F per body with hits", "s per body", |c| &mut c.row),
    price("handle", "F per listed pair", "s per pair", |c| &mut c.handle),
    price("hit", "Cv hit", "s per test", |c| &mut c.hit),
    price("miss", "Cv miss", "s per test", |c| &mut c.miss),
    price("further", "Cv further slab", "s per slab", |c| &mut c.further),
];

const fn price(
    key: &'static str,
    name: &'static str,
    unit: &'static str,
    of: fn(&mut VolumeCosts) -> &mut f64,
) -> PriceKind {
    PriceKind { key, name, unit, of }
}
