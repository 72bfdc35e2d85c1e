//! Where listed pairs go: into one list, or portion after portion to a function, so that memory
//! stays bounded whatever the number of pairs.
//!
//! Portions come in the order of the list, whichever thread found them: a thread whose list is full
//! waits for its turn. Tasks are begun in their order, so the task whose turn it is always runs,
//! and no thread waits for ever. While a task hands many portions over, the others wait: in a
//! crowd, more threads bring nothing.

use std::sync::{Condvar, Mutex, MutexGuard};

use crate::pairs::PairList;

/// Pairs in a portion; a block of candidates more may come with the last of them.
pub(crate) const PORTION: usize = 1 << 16;

/// Where the pairs of a frame go.
pub(crate) enum Output<'a> {
    /// All into one list.
    List(&'a mut PairList),
    /// Portions to a function, which empties each.
    Portions(&'a mut Sink<'a>),
}

/// Takes a portion.
pub(crate) type Sink<'a> = dyn FnMut(&mut PairList) + Send + 'a;

#[cfg(feature = "shapes")]
impl Output<'_> {
    pub(super) fn is_in_portions(&self) -> bool {
        matches!(self, Self::Portions(_))
    }
}

/// Where a task's list goes while it is being written.
pub(super) enum Outlet<'t, 's> {
    /// It is kept until all tasks are done.
    Kept,
    /// It is handed over whenever it is a portion.
    HandedOver(Turn<'t, 's>),
}

impl Outlet<'_, '_> {
    /// How many pairs make a list worth offering.
    pub fn worth(&self) -> usize {
        match self {
            Self::Kept => usize::MAX,
            Self::HandedOver(_) => PORTION,
        }
    }

    /// Hands the list over, and empties it, if that is worth it.
    pub fn offer(&self, list: &mut PairList) {
        if let Self::HandedOver(turn) = self
            && list.len() >= PORTION
        {
            turn.hand_over(list);
        }
    }

    /// The list is complete: the last of it is handed over, and it is the next task's turn.
    pub fn end(self, list: &mut PairList) {
        if let Self::HandedOver(turn) = self {
            turn.hand_over(list);
        }
    }
}

/// The order in which tasks hand portions over.
pub(super) struct Turns<'s> {
    state: Mutex<State<'s>>,
    changed: Condvar,
}

struct State<'s> {
    /// The task whose turn it is.
    task: usize,
    /// Whether a task panicked: nothing is handed over from then on.
    abandoned: bool,
    sink: &'s mut Sink<'s>,
}

/// One task's turn.
pub(super) struct Turn<'t, 's> {
    turns: &'t Turns<'s>,
    task: usize,
}

impl<'s> Turns<'s> {
    pub fn new(sink: &'s mut Sink<'s>) -> Self {
        let state = State {
            task: 0,
            abandoned: false,
            sink,
        };
        Self {
            state: Mutex::new(state),
            changed: Condvar::new(),
        }
    }

    pub fn of(&self, task: usize) -> Turn<'_, 's> {
        Turn { turns: self, task }
    }
}

impl<'t, 's> Turn<'t, 's> {
    /// Hands a list over when it is this task's turn, and empties it.
    fn hand_over(&self, list: &mut PairList) {
        if let Some(mut state) = self.wait()
            && !list.is_empty()
        {
            (state.sink)(list);
        }
        list.clear();
    }

    /// Waits for this task's turn; `None` if another task panicked, which its thread passes on.
    fn wait(&self) -> Option<MutexGuard<'t, State<'s>>> {
        let mut state = self.turns.state.lock().ok()?;
        while state.task != self.task && !state.abandoned {
            state = self.turns.changed.wait(state).ok()?;
        }
        (!state.abandoned).then_some(state)
    }
}

impl Drop for Turn<'_, '_> {
    fn drop(&mut self) {
        // A poisoned lock means that the sink panicked: waiting tasks see that by themselves once
        // they are woken.
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

    #[test]
    fn a_task_that_panics_leaves_no_other_waiting() {
        let (done, is_done) = mpsc::channel();
        std::thread::spawn(move || {
            let mut handed_over = 0;
            let mut sink = |list: &mut PairList| handed_over += list.len();
            let turns = Turns::new(&mut sink);
            let panicked = std::thread::scope(|scope| {
                let later = scope.spawn(|| {
                    let _outlet = Outlet::HandedOver(turns.of(1));
                    panic!("planted");
                });
                later.join().is_err()
            });
            let mut list: PairList = (0..PORTION as u32).map(|pair| [pair, pair + 1]).collect();
            let outlet = Outlet::HandedOver(turns.of(0));
            outlet.offer(&mut list);
            outlet.end(&mut list);
            done.send((panicked, list.len(), handed_over))
        });
        let outcome = is_done.recv_timeout(Duration::from_secs(20));
        assert_eq!(outcome, Ok((true, 0, 0)));
    }
}
