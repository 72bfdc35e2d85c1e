//! The output of listed pairs: into one list, or in portions to a function, so that memory stays
//! bounded whatever the number of pairs.
//!
//! Portions come in the order of the list, whichever thread found them: a thread whose list is full
//! waits for its turn. Tasks are started in their order, so the task whose turn it is always runs,
//! and no thread waits for ever. While a task passes on many portions, the others wait, so that
//! more threads don't help in a crowd.

use std::sync::{Condvar, Mutex, MutexGuard};

use crate::cull_error::CullError;
use crate::pairs::PairList;

/// Pairs in a portion. It may have one block of candidates more.
pub(crate) const PAIRS_PER_PORTION: usize = 1 << 16;

/// The destination of a frame's pairs.
pub(crate) enum Output<'a> {
    /// All into one list.
    List(&'a mut PairList),
    /// Portions to a function, which empties each one.
    Portions(&'a mut PortionSink<'a>),
}

/// A function that takes a portion.
pub(crate) type PortionSink<'a> = dyn FnMut(&mut PairList) + Send + 'a;

impl Output<'_> {
    pub fn is_in_portions(&self) -> bool {
        matches!(self, Self::Portions(_))
    }
}

/// Culls a frame in portions, and lists its pairs if there are no more than the limit. `cull`
/// returns their number.
pub(crate) fn list_up_to(
    limit: usize,
    list: &mut PairList,
    cull: impl FnOnce(&mut (dyn FnMut(&PairList) + Send)) -> Result<u64, CullError>,
) -> Result<(), CullError> {
    let outcome = cull(&mut |portion| list.append_up_to(portion, limit));
    CullError::check_memory(list)?;
    let refused = match outcome {
        Ok(pairs) if pairs == list.len() as u64 => return Ok(()),
        Ok(pairs) => CullError::TooManyPairs { pairs, limit },
        Err(error) => error,
    };
    list.clear();
    Err(refused)
}

/// The destination of a task's list while it is being written.
pub(crate) enum TaskOutput<'t, 's> {
    /// It is kept until all tasks are done.
    Kept,
    /// It is passed on whenever it is a portion.
    HandedOver(TaskTurn<'t, 's>),
}

impl TaskOutput<'_, '_> {
    /// The number of pairs from which on a list is offered.
    pub fn worth(&self) -> usize {
        match self {
            Self::Kept => usize::MAX,
            Self::HandedOver(_) => PAIRS_PER_PORTION,
        }
    }

    /// Passes the list on and empties it, if it has enough pairs.
    pub fn offer(&self, list: &mut PairList) {
        if let Self::HandedOver(turn) = self
            && list.len() >= PAIRS_PER_PORTION
        {
            turn.hand_over(list);
        }
    }

    /// Completes the list: passes on the rest of it, and ends the task's turn.
    pub fn end(self, list: &mut PairList) {
        if let Self::HandedOver(turn) = self {
            turn.hand_over(list);
        }
    }
}

/// The turns in which tasks pass on portions.
pub(super) struct OutputTurns<'s> {
    state: Mutex<TurnState<'s>>,
    changed: Condvar,
}

struct TurnState<'s> {
    /// The task that may pass on portions now.
    task: usize,
    /// Whether a task panicked. Nothing is passed on from then on.
    abandoned: bool,
    sink: &'s mut PortionSink<'s>,
}

/// One task's turn.
pub(crate) struct TaskTurn<'t, 's> {
    turns: &'t OutputTurns<'s>,
    task: usize,
}

impl<'s> OutputTurns<'s> {
    pub fn new(sink: &'s mut PortionSink<'s>) -> Self {
        let state = TurnState { task: 0, abandoned: false, sink };
        Self { state: Mutex::new(state), changed: Condvar::new() }
    }

    pub fn of(&self, task: usize) -> TaskTurn<'_, 's> {
        TaskTurn { turns: self, task }
    }
}

impl<'t, 's> TaskTurn<'t, 's> {
    /// Waits for this task's turn, passes a list on and empties it.
    fn hand_over(&self, list: &mut PairList) {
        if let Some(mut state) = self.wait()
            && !list.is_empty()
        {
            (state.sink)(list);
        }
        list.clear();
    }

    /// Waits for this task's turn; `None` if another task panicked.
    fn wait(&self) -> Option<MutexGuard<'t, TurnState<'s>>> {
        let mut state = self.turns.state.lock().ok()?;
        while state.task != self.task && !state.abandoned {
            state = self.turns.changed.wait(state).ok()?;
        }
        (!state.abandoned).then_some(state)
    }
}

impl Drop for TaskTurn<'_, '_> {
    fn drop(&mut self) {
        // A poisoned lock means that the sink panicked, which waiting tasks notice when they are
        // woken.
        if let Ok(mut state) = self.turns.state.lock() {
            state.abandoned |= std::thread::panicking();
            state.task = self.task + 1;
        }
        self.turns.changed.notify_all();
    }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc;
    use std::time::Duration;

    use super::*;

    /// A task that panics leaves no other waiting.
    #[test]
    fn panicking_task_wakes_others() {
        let (done, is_done) = mpsc::channel();
        std::thread::spawn(move || {
            let mut handed_over = 0;
            let mut sink = |list: &mut PairList| handed_over += list.len();
            let turns = OutputTurns::new(&mut sink);
            let panicked = std::thread::scope(|scope| {
                let later = scope.spawn(|| {
                    let _outlet = TaskOutput::HandedOver(turns.of(1));
                    panic!("planted");
                });
                later.join().is_err()
            });
            let mut list: PairList =
                (0..PAIRS_PER_PORTION as u32).map(|pair| [pair, pair + 1]).collect();
            let outlet = TaskOutput::HandedOver(turns.of(0));
            outlet.offer(&mut list);
            outlet.end(&mut list);
            done.send((panicked, list.len(), handed_over))
        });
        let outcome = is_done.recv_timeout(Duration::from_secs(20));
        assert_eq!(outcome, Ok((true, 0, 0)));
    }
}
