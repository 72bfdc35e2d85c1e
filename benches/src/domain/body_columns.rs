//! [`BodyColumns`]: the bodies that a rank holds, its own and its ghosts (copies of bodies that
//! other ranks own), in the order of their numbers in the scene. In that order the lower number is
//! always first, so a pair's test is the same on every rank.

use crate::effects::Velocities;
use sdop::bodies::Bodies;

/// Bodies as columns of one length, by ascending number.
#[derive(Debug, Default)]
pub(super) struct BodyColumns {
    /// Each body's number in the scene.
    pub numbers: Vec<u32>,
    /// Whether this rank owns it; the others are ghosts.
    pub owned: Vec<bool>,
    pub bodies: Bodies,
    /// Those of ghosts are zero.
    pub velocities: Velocities,
}

/// One body on its way from rank to rank.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct BodyMessage {
    pub number: u32,
    pub shape: u32,
    pub dynamic: bool,
    pub rotation: [f32; 4],
    pub translation: [f32; 3],
    /// Linear, then angular velocity; none on the way to where the body is a ghost.
    pub velocities: Option<[[f32; 3]; 2]>,
}

/// Number and shape, with a bit for `dynamic`; the pose; velocities.
const POSE_BYTES: usize = 28;
const GHOST_BYTES: usize = 8 + POSE_BYTES;
const MOVER_BYTES: usize = GHOST_BYTES + 24;

/// Shapes are fewer than bodies, whose number leaves this bit free.
const DYNAMIC_BIT: u32 = 1 << 31;

impl BodyMessage {
    /// Appends the body's bytes.
    pub fn write(&self, out: &mut Vec<u8>) {
        let kind = self.shape | if self.dynamic { DYNAMIC_BIT } else { 0 };
        out.extend(self.number.to_le_bytes());
        out.extend(kind.to_le_bytes());
        write_pose(self.rotation, self.translation, out);
        if let Some(velocities) = self.velocities {
            write_numbers(velocities.as_flattened(), out);
        }
    }

    /// The bodies of a message, all with velocities or all without.
    pub fn read_all(message: &[u8], movers: bool) -> impl Iterator<Item = Self> {
        let size = if movers { MOVER_BYTES } else { GHOST_BYTES };
        message.chunks_exact(size).map(move |bytes| {
            let (head, rest) = bytes.split_at(8);
            let word = |at: usize| {
                u32::from_le_bytes([head[at], head[at + 1], head[at + 2], head[at + 3]])
            };
            let (rotation, translation) = read_pose(rest);
            let velocities = movers.then(|| {
                let [a, b, c, d, e, f] = read_numbers(&rest[POSE_BYTES..]);
                [[a, b, c], [d, e, f]]
            });
            Self {
                number: word(0),
                shape: word(4) & !DYNAMIC_BIT,
                dynamic: word(4) & DYNAMIC_BIT != 0,
                rotation,
                translation,
                velocities,
            }
        })
    }
}

/// Appends a pose's bytes.
pub(super) fn write_pose(rotation: [f32; 4], translation: [f32; 3], out: &mut Vec<u8>) {
    write_numbers(&rotation, out);
    write_numbers(&translation, out);
}

/// The poses of a message.
pub(super) fn read_poses(message: &[u8]) -> impl Iterator<Item = ([f32; 4], [f32; 3])> {
    message.chunks_exact(POSE_BYTES).map(read_pose)
}

fn read_pose(bytes: &[u8]) -> ([f32; 4], [f32; 3]) {
    let [x, y, z, w, tx, ty, tz] = read_numbers(bytes);
    ([x, y, z, w], [tx, ty, tz])
}

fn write_numbers(numbers: &[f32], out: &mut Vec<u8>) {
    numbers.iter().for_each(|x| out.extend(x.to_le_bytes()));
}

fn read_numbers<const N: usize>(bytes: &[u8]) -> [f32; N] {
    let (words, _) = bytes.as_chunks::<4>();
    std::array::from_fn(|i| f32::from_le_bytes(words[i]))
}

impl BodyColumns {
    /// All of a scene's share, owned.
    pub fn new(first: usize, bodies: Bodies) -> Self {
        // A scene has fewer than 2³¹ bodies.
        let numbers = (first..first + bodies.len()).map(|number| number as u32);
        Self {
            numbers: numbers.collect(),
            owned: vec![true; bodies.len()],
            bodies,
            velocities: Velocities::default(),
        }
    }

    /// How many bodies are held.
    pub fn len(&self) -> usize {
        self.numbers.len()
    }

    /// The places of the bodies that this rank owns.
    pub fn own(&self) -> impl Iterator<Item = usize> {
        (0..self.len()).filter(|&place| self.owned[place])
    }

    /// The body in a place, with velocities where it goes to another owner.
    pub fn record(&self, place: usize, moves: bool) -> BodyMessage {
        let Bodies { shape, dynamic, rotation, translation } = &self.bodies;
        let Velocities { linear, angular } = &self.velocities;
        BodyMessage {
            number: self.numbers[place],
            shape: shape[place],
            dynamic: dynamic[place],
            rotation: rotation[place],
            translation: translation[place],
            velocities: moves.then(|| [linear[place], angular[place]]),
        }
    }

    /// The place of the body with this number in the scene.
    pub fn place(&self, number: u32) -> Option<usize> {
        self.numbers.binary_search(&number).ok()
    }

    /// Keeps the bodies for which `stays`, and adds others: with velocities as owned ones, without
    /// as ghosts.
    pub fn change(&mut self, stays: impl Fn(usize) -> bool, mut incoming: Vec<BodyMessage>) {
        incoming.sort_unstable_by_key(|record| record.number);
        let old = std::mem::take(self);
        self.reserve(old.len() + incoming.len());
        let mut incoming = incoming.into_iter().peekable();
        for place in (0..old.len()).filter(|&place| stays(place)) {
            let number = old.numbers[place];
            while let Some(record) = incoming.next_if(|record| record.number < number) {
                self.push(record);
            }
            self.push(old.record(place, old.owned[place]));
        }
        incoming.for_each(|record| self.push(record));
    }

    fn reserve(&mut self, bodies: usize) {
        self.numbers.reserve(bodies);
        self.owned.reserve(bodies);
        self.bodies.shape.reserve(bodies);
        self.bodies.dynamic.reserve(bodies);
        self.bodies.rotation.reserve(bodies);
        self.bodies.translation.reserve(bodies);
        self.velocities.linear.reserve(bodies);
        self.velocities.angular.reserve(bodies);
    }

    fn push(&mut self, record: BodyMessage) {
        self.numbers.push(record.number);
        self.owned.push(record.velocities.is_some());
        self.bodies.push(record.shape, record.dynamic, record.rotation, record.translation);
        let [linear, angular] = record.velocities.unwrap_or_default();
        self.velocities.linear.push(linear);
        self.velocities.angular.push(angular);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(number: u32, owned: bool) -> BodyMessage {
        let x = number as f32;
        BodyMessage {
            number,
            shape: number % 3,
            dynamic: number.is_multiple_of(2),
            rotation: [x, 1.0, -2.0, 0.5],
            translation: [x, -x, 1.0e-40],
            velocities: owned.then_some([[x, 2.0, 3.0], [4.0, 5.0, -x]]),
        }
    }

    #[test]
    fn bodies_arrive_as_they_left() {
        for owned in [false, true] {
            let sent: Vec<_> = (0..5).map(|number| record(number, owned)).collect();
            let mut message = Vec::new();
            sent.iter().for_each(|record| record.write(&mut message));
            assert_eq!(message.len(), 5 * if owned { MOVER_BYTES } else { GHOST_BYTES });
            let received: Vec<_> = BodyMessage::read_all(&message, owned).collect();
            assert_eq!(received, sent);
        }
    }

    /// A change keeps the order of numbers.
    #[test]
    fn change_keeps_number_order() {
        let mut held = BodyColumns::default();
        held.change(|_| true, vec![record(9, true), record(2, true), record(5, false)]);
        held.change(|place| place != 1, vec![record(7, false), record(0, true), record(11, false)]);
        assert_eq!(held.numbers, [0, 2, 7, 9, 11]);
        assert_eq!(held.owned, [true, true, false, true, false]);
        for (place, &number) in held.numbers.iter().enumerate() {
            let owned = held.owned[place];
            assert_eq!(held.record(place, owned), record(number, owned));
            assert_eq!(held.place(number), Some(place));
        }
        assert_eq!(held.place(5), None);
        assert_eq!(held.own().collect::<Vec<_>>(), [0, 1, 3]);
    }
}
