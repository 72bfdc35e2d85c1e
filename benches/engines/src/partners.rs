//! The pairs of an engine that only answers which boxes of its tree meet a box. Its user has to
//! write this: each body has a list of its partners.

use crate::incremental::Change;

/// The partners of every body, and what has changed in the last frame.
#[derive(Default)]
pub struct Partners {
    lists: Vec<Vec<u32>>,
    changes: Vec<Change>,
}

impl Partners {
    /// No pairs of so many bodies.
    pub fn new(bodies: usize) -> Self {
        Self { lists: vec![Vec::new(); bodies], changes: Vec::new() }
    }

    /// Begins a frame.
    pub fn begin_frame(&mut self) {
        self.changes.clear();
    }

    /// Ends the pairs of a moved body with those of its partners that it no longer meets.
    pub fn end(&mut self, body: u32, meets: impl Fn(u32) -> bool) {
        let mut at = 0;
        while let Some(&other) = self.lists[body as usize].get(at) {
            if meets(other) {
                at += 1;
                continue;
            }
            self.lists[body as usize].swap_remove(at);
            let others = &mut self.lists[other as usize];
            if let Some(at) = others.iter().position(|&partner| partner == body) {
                others.swap_remove(at);
            }
            self.changes.push(([body, other], false));
        }
    }

    /// Begins the pair of a moved body with a box that it meets, unless it is there.
    pub fn begin(&mut self, body: u32, other: u32) {
        let [one, two] = [body, other].map(|body| body as usize);
        if !self.lists[one].contains(&other) {
            self.lists[one].push(other);
            self.lists[two].push(body);
            self.changes.push(([body, other], true));
        }
    }

    /// What has begun and ended in this frame.
    pub fn changes(&self) -> &[Change] {
        &self.changes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A pair begins once, and ends on both sides.
    #[test]
    fn pairs_begin_once_and_end_on_both_sides() {
        let mut partners = Partners::new(3);
        partners.begin(0, 1);
        partners.begin(1, 0);
        partners.begin(1, 2);
        assert_eq!(partners.changes(), [([0, 1], true), ([1, 2], true)]);
        partners.begin_frame();
        partners.end(1, |other| other == 2);
        partners.end(0, |_| false);
        assert_eq!(partners.changes(), [([1, 0], false)]);
    }
}
