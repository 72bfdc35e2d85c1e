//! Compares every engine's pairs with those of the present boxes, found from nothing: by the
//! oracle, and for meshes by a newly built culler.

use miette::miette;
use sdop::bodies::Bodies;
use sdop::culler::Culler;
use sdop::volume::Shape;

use sdop_bench::remedy::OrReport as _;

use crate::boxes::{Slabs, meet};
use crate::entry::Work;
use crate::incremental::{Extras, MoverEntry};
use crate::oracle;

/// The pairs that every engine must report after a frame.
pub struct Truth<'a> {
    boxes: &'a [Slabs],
    touching: Vec<[u32; 2]>,
    /// What a culler of meshes finds from nothing.
    culled: Option<Vec<[u32; 2]>>,
}

impl<'a> Truth<'a> {
    /// Of these boxes, and of meshes if any engine has them.
    pub fn of(boxes: &'a [Slabs], meshes: Option<(&[Shape], &Bodies)>) -> miette::Result<Self> {
        let culled = meshes.map(|(shapes, bodies)| {
            let mut culler = Culler::new(shapes, bodies).or_report()?;
            let mut pairs: Vec<_> = culler.cull(bodies).or_report()?.iter().collect();
            pairs.sort_unstable();
            Ok::<_, miette::Report>(pairs)
        });
        Ok(Self { boxes, touching: oracle::pairs(boxes), culled: culled.transpose()? })
    }

    /// Compares an engine's pairs, which may come in any order and either way round. Returns how
    /// many there are, and how many are additional.
    ///
    /// # Errors
    /// The first pair that is missing, listed twice, or additional where it must not be.
    pub fn judge(
        &self,
        entry: &MoverEntry,
        mut pairs: Vec<[u32; 2]>,
    ) -> miette::Result<(usize, usize)> {
        pairs.iter_mut().for_each(|pair| pair.sort_unstable());
        pairs.sort_unstable();
        let required = match (entry.work, &self.culled) {
            (Work::SDop, Some(culled)) => culled,
            _ => &self.touching,
        };
        let (missing, additional) = differences(required, &pairs);
        let refused = additional.iter().find(|pair| !self.allows(entry, **pair));
        let twice = pairs.windows(2).find(|two| two[0] == two[1]);
        let fault = [
            (missing.first(), "missing"),
            (refused, "no pair"),
            (twice.map(|two| &two[0]), "reported twice"),
        ];
        match fault.into_iter().find_map(|(pair, fault)| Some((pair?, fault))) {
            None => Ok((pairs.len(), additional.len())),
            Some((pair, fault)) => Err(miette!(
                help = "nothing is timed while answers differ",
                "{}: the pair {pair:?} is {fault}: boxes {:?}",
                entry.name,
                pair.map(|body| self.boxes.get(body as usize))
            )),
        }
    }

    /// Whether an engine may report this additional pair.
    fn allows(&self, entry: &MoverEntry, pair: [u32; 2]) -> bool {
        let [Some(a), Some(b)] = pair.map(|body| self.boxes.get(body as usize)) else {
            return false;
        };
        match entry.extras {
            Extras::None => false,
            Extras::Late => true,
            // The coordinates' own rounding is far less than the thousandth.
            Extras::Within(distance) => {
                let reach = 1.001 * distance;
                let grown = a.map(|[lo, hi]| [lo - reach, hi + reach]);
                pair[0] != pair[1] && meet(&grown, b)
            }
        }
    }
}

/// Those of the sorted `required` that the sorted `pairs` lack, and those that they have in
/// addition.
fn differences(required: &[[u32; 2]], pairs: &[[u32; 2]]) -> (Vec<[u32; 2]>, Vec<[u32; 2]>) {
    let outside = |these: &[[u32; 2]], those: &[[u32; 2]]| {
        let mut those = those.iter().peekable();
        let is_outside = |pair: &&[u32; 2]| {
            while those.next_if(|other| other < pair).is_some() {}
            those.peek() != Some(pair)
        };
        these.iter().filter(is_outside).copied().collect()
    };
    (outside(required, pairs), outside(pairs, required))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::*;

    fn engine(extras: Extras) -> MoverEntry {
        MoverEntry {
            name: "engine",
            version: "",
            margin: 0.0,
            extras,
            work: Work::Boxes,
            only: None,
            most_bodies: 3,
            new: |_| Err(miette!("never asked for")),
        }
    }

    fn at(x: f32) -> Slabs {
        [[x, x + 1.0], [0.0, 1.0], [0.0, 1.0]]
    }

    /// Boxes 0 and 1 touch, 2 is a tenth from 1.
    #[test]
    fn additional_pairs_are_within_the_margin() {
        let boxes = [at(0.0), at(1.0), at(2.1)];
        let truth = Truth::of(&boxes, None).unwrap();
        let judge = |extras, pairs: &[[u32; 2]]| {
            let judged = truth.judge(&engine(extras), pairs.to_vec());
            judged.map_err(|fault| fault.to_string().split(':').nth(1).unwrap().to_owned())
        };
        assert_eq!(judge(Extras::None, &[[1, 0]]), Ok((1, 0)));
        let near = [[0, 1], [2, 1]];
        assert_eq!(judge(Extras::Within(0.11), &near), Ok((2, 1)));
        assert_eq!(judge(Extras::Late, &[[0, 1], [0, 2]]), Ok((2, 1)));
        for (extras, pairs, fault) in [
            (Extras::None, &near[..], " the pair [1, 2] is no pair"),
            (Extras::Within(0.09), &near, " the pair [1, 2] is no pair"),
            (Extras::Late, &[[1, 2]], " the pair [0, 1] is missing"),
            (Extras::None, &[[0, 1], [1, 0]], " the pair [0, 1] is reported twice"),
        ] {
            assert_eq!(judge(extras, pairs), Err(fault.to_owned()));
        }
    }
}
