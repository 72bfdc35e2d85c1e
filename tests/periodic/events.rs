//! What is one pair in events.

use super::*;

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
