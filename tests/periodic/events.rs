//! Events against the sets of pairs when they were read.

use std::collections::BTreeMap;

use super::*;

const LENGTHS: [f64; 3] = [4.0, 5.0, 6.0];

fn random_box(random: &mut Random) -> PeriodicBox {
    let min = LENGTHS.map(|length| (3.0 * unit(random) - 1.0) * length);
    let size = LENGTHS.map(|length| 0.4 * length * unit(random));
    let max = [0, 1, 2].map(|axis| min[axis] + size[axis]);
    PeriodicBox::new(min, max)
}

/// The image of each pair of bodies.
fn images(pairs: &[PeriodicPair]) -> BTreeMap<[BodyId; 2], [i32; 3]> {
    let images: BTreeMap<_, _> = pairs.iter().map(|pair| (pair.bodies, pair.image)).collect();
    assert_eq!(images.len(), pairs.len(), "each once");
    assert!(pairs.is_sorted());
    images
}

#[test]
fn events_are_changes_since_last_read() {
    let mut random = Random(11);
    let mut cell = PeriodicBoxes::new(LENGTHS.map(Some)).unwrap();
    let mut ids: Vec<BodyId> =
        (0..30).map(|_| cell.insert(random_box(&mut random)).unwrap()).collect();
    let mut before = BTreeMap::new();
    let mut counts = [0; 3];
    for frame in 0..200 {
        for _ in 0..random.below(4) {
            let at = random.below(ids.len());
            if random.below(3) == 0 {
                cell.remove(ids.swap_remove(at)).unwrap();
                ids.push(cell.insert(random_box(&mut random)).unwrap());
            } else {
                cell.set(ids[at], random_box(&mut random)).unwrap();
            }
        }
        let now = images(cell.cull().unwrap());
        if random.below(3) == 0 {
            continue; // nobody reads
        }
        let events = cell.events();
        let [begun, persisting, ended] =
            [events.begun(), events.persisting(), events.ended()].map(images);
        let only = |of: &BTreeMap<_, _>, not: &BTreeMap<_, _>| -> BTreeMap<_, _> {
            let kept = of.iter().filter(|(pair, _)| !not.contains_key(*pair));
            kept.map(|(pair, image)| (*pair, *image)).collect()
        };
        assert_eq!(begun, only(&now, &before), "frame {frame}");
        assert_eq!(ended, only(&before, &now), "frame {frame}");
        assert_eq!(persisting, only(&now, &begun), "frame {frame}");
        for (count, kind) in counts.iter_mut().zip([begun, persisting, ended]) {
            *count += kind.len();
        }
        before = now;
    }
    assert!(counts.iter().all(|&count| count > 200), "{counts:?}");
}

/// A body that leaves over one border and comes in over the other keeps its pairs.
#[test]
fn pair_persists_across_borders() {
    let mut cell = PeriodicBoxes::new([Some(10.0), None, None]).unwrap();
    let at = |x: f64| PeriodicBox::new([x, 0.0, 0.0], [x + 1.0, 1.0, 1.0]);
    let a = cell.insert(at(0.0)).unwrap();
    let b = cell.insert(at(0.5)).unwrap();
    cell.cull().unwrap();
    assert_eq!(cell.events().begun()[0].image, [0; 3]);
    cell.set(b, at(10.5)).unwrap();
    cell.cull().unwrap();
    let events = cell.events();
    let pair = PeriodicPair { bodies: [a, b], image: [-1, 0, 0] };
    assert_eq!(events.persisting(), [pair]);
    assert!(events.begun().is_empty() && events.ended().is_empty());
}
