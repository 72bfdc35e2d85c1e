//! The order in which bodies are stored inside a culler.
//!
//! A body's place is its index in a culler's columns of volumes. Moving bodies come first, then
//! static ones, so that neither updates nor static pairs need a flag. A pair finder now and then
//! sorts places by location, so that neighbours in space are neighbours in memory, whatever the
//! order of the user's columns.

use crate::bodies::Bodies;

/// Which body is in which place. All columns have one length.
#[derive(Clone, Debug, Default)]
pub struct Places {
    /// The body in each place.
    pub body: Vec<u32>,
    /// Its shape.
    pub shape: Vec<u32>,
    /// How many bodies move. They have the first places.
    pub moving: usize,
}

impl Places {
    /// Moving bodies, then static ones, each in the order of the user's columns.
    #[must_use]
    pub fn new(bodies: &Bodies) -> Self {
        let everyone = 0..bodies.shape.len() as u32;
        let (mut body, fixed): (Vec<u32>, Vec<u32>) =
            everyone.partition(|&body| bodies.dynamic[body as usize]);
        let moving = body.len();
        body.extend(fixed);
        let shape = body.iter().map(|&b| bodies.shape[b as usize]).collect();
        Self { body, shape, moving }
    }

    /// Number of bodies.
    #[must_use]
    pub fn len(&self) -> usize {
        self.body.len()
    }

    /// Whether there are no bodies.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.body.is_empty()
    }

    /// Replaces the set of bodies by those that are `present`. Among moving bodies, those that were
    /// moving before keep their order and the others follow; the same holds for static bodies.
    /// Shapes are left to [`Self::reread_shapes`]. Returns, for each former place, whether its body
    /// kept its order.
    pub(crate) fn replace(&mut self, dynamic: &[bool], present: &[bool]) -> Vec<bool> {
        let mut is_new = present.to_vec();
        let former = self.body.iter().enumerate();
        let stays: Vec<bool> = former
            .map(|(place, &body)| {
                let body = body as usize;
                let moved = place < self.moving;
                let stays = present.get(body) == Some(&true) && dynamic[body] == moved;
                if stays {
                    is_new[body] = false;
                }
                stays
            })
            .collect();
        let mut order = Vec::with_capacity(present.len());
        for (moves, range) in [(true, 0..self.moving), (false, self.moving..stays.len())] {
            let kept = self.body[range.clone()].iter().zip(&stays[range]);
            order.extend(kept.filter(|(_, stays)| **stays).map(|(&body, _)| body));
            let others = (0..present.len()).filter(|&body| is_new[body] && dynamic[body] == moves);
            order.extend(others.map(|body| body as u32));
            if moves {
                self.moving = order.len();
            }
        }
        self.body = order;
        stays
    }

    /// Copies each body's shape from the user's columns.
    pub(crate) fn reread_shapes(&mut self, bodies: &Bodies) {
        self.shape.resize(self.body.len(), 0);
        for (shape, &body) in self.shape.iter_mut().zip(&self.body) {
            *shape = bodies.shape[body as usize];
        }
    }

    /// Puts the bodies in another order. `order` names the body that takes each place, by its
    /// present place or by its number, and holds the former order afterwards.
    pub(crate) fn reorder(&mut self, bodies: &Bodies, order: &mut Vec<u32>, by_place: bool) {
        if by_place {
            for place in order.iter_mut() {
                *place = self.body[*place as usize];
            }
        }
        std::mem::swap(&mut self.body, order);
        self.reread_shapes(bodies);
    }
}
