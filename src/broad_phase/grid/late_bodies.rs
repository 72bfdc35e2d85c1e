//! Bodies that come and go between two plans of the levels: those that stay keep their levels, and
//! new ones share one more level.
//!
//! The assignment of bodies to levels affects only the time of a search, because a level's cells
//! are fitted to its largest ball in every frame. Therefore a plan can stay while there are few
//! late bodies.

use std::ops::Range;

use super::{FRAMES_PER_REORDER, Grid, GridLevel};

/// How many late bodies, of any sizes, are accepted: [`LEAST_LATE_LIMIT`], or one in
/// [`BODIES_PER_LATE`] bodies, but at most [`MOST_LATE_LIMIT`], because all of them may be in one
/// cell.
const LEAST_LATE_LIMIT: usize = 64;
const BODIES_PER_LATE: usize = 16;
const MOST_LATE_LIMIT: usize = 4096;

impl Grid {
    /// Changes the set of bodies, in the order after
    /// [`Places::replace`](crate::bodies::Places::replace); `stays` says which former places keep
    /// their body. Returns false if too many bodies are late, and levels have to be planned again.
    pub(in crate::broad_phase) fn replace(
        &mut self,
        stays: &[bool],
        moving: usize,
        bodies: usize,
    ) -> bool {
        let former = std::mem::take(&mut self.levels);
        let (moving_levels, static_levels) = former.split_at(self.moving_levels);
        self.take_levels(moving_levels, stays, 0..moving);
        self.moving_levels = self.levels.len();
        self.take_levels(static_levels, stays, moving..bodies);
        // Slots belong to the former set. No order of places is taken from them until bodies are
        // sorted again.
        self.age = self.age.next_multiple_of(FRAMES_PER_REORDER).max(FRAMES_PER_REORDER);
        (self.fixed_sorted, self.candidates) = (false, 0);
        let late = self.levels.iter().filter(|level| level.is_late);
        let late: usize = late.map(|level| level.range.len()).sum();
        late <= LEAST_LATE_LIMIT.max(MOST_LATE_LIMIT.min(bodies / BODIES_PER_LATE))
    }

    /// Distributes `places` to the levels whose bodies stay, in their order, and to one level of
    /// late bodies.
    fn take_levels(&mut self, former: &[GridLevel], stays: &[bool], places: Range<usize>) {
        let mut start = places.start;
        for level in former.iter().filter(|level| !level.is_late) {
            let stay = stays[level.range.clone()].iter().filter(|stays| **stays);
            let end = start + stay.count();
            if start < end {
                self.levels.push(level.clone().holding(start..end));
            }
            start = end;
        }
        if start < places.end {
            self.levels.push(GridLevel::late(start..places.end));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::broad_phase::Reorder;

    /// A grid of moving balls in a row, small ones and some giants.
    fn planned(balls: &[[f32; 4]]) -> Grid {
        let (mut grid, mut order) = (Grid::default(), Vec::new());
        let names: Vec<u32> = (0..balls.len() as u32).collect();
        assert_eq!(grid.reorder(balls.len(), balls, &names, &mut order), Reorder::All);
        grid
    }

    /// Those that stay keep their levels and the late ones share one.
    #[test]
    fn late_bodies_share_one_level() {
        let radius = |i: usize| if i.is_multiple_of(50) { 64.0 } else { 1.0 };
        let balls: Vec<_> = (0..2000).map(|i| [2.0 * i as f32, 0.0, 0.0, radius(i)]).collect();
        let mut grid = planned(&balls);
        let ranges = |grid: &Grid| -> Vec<_> {
            let levels = grid.levels.iter();
            levels.map(|level| (level.range.clone(), level.is_late)).collect()
        };
        assert_eq!(ranges(&grid), [(0..40, false), (40..2000, false)]);
        // A giant and two small ones go, five come.
        let mut stays = vec![true; 2000];
        for gone in [7, 40, 1999] {
            stays[gone] = false;
        }
        assert!(grid.replace(&stays, 2002, 2002));
        let now = [(0..39, false), (39..1997, false), (1997..2002, true)];
        assert_eq!(ranges(&grid), now);
        // Two of the late ones go, three come, and one that is static.
        let mut stays = vec![true; 2002];
        stays[1998..2000].fill(false);
        assert!(grid.replace(&stays, 2003, 2004));
        let now = [(0..39, false), (39..1997, false), (1997..2003, true)];
        assert_eq!(ranges(&grid)[..3], now);
        assert_eq!(ranges(&grid)[3..], [(2003..2004, true)]);
        assert_eq!(grid.moving_levels, 3);
        // All but one of a level go, and then the last one.
        let mut stays = vec![false; 2004];
        stays[39..45].fill(true);
        assert!(grid.replace(&stays, 6, 6));
        assert_eq!(ranges(&grid), [(0..6, false)]);
        assert!(grid.replace(&[false; 6], 0, 0));
        assert_eq!((ranges(&grid).len(), grid.moving_levels), (0, 0));
    }

    /// Many late bodies are worth a plan.
    #[test]
    fn many_late_bodies_trigger_a_plan() {
        let balls: Vec<_> = (0..3200).map(|i| [2.0 * i as f32, 0.0, 0.0, 1.0]).collect();
        for (late, keeps) in [(64, true), (213, true), (214, false), (3200, false)] {
            let mut grid = planned(&balls);
            let all = balls.len() + late;
            assert_eq!(grid.replace(&[true; 3200], all, all), keeps, "{late}");
        }
        let mut grid = planned(&balls);
        let all = balls.len() + 100;
        assert!(grid.replace(&[true; 3200], all, all), "few so far");
        assert!(!grid.replace(&vec![true; all], all + 150, all + 150));
    }
}
