//! For each group about changes, filters, orders, states, margins and lists: the group catches a
//! culler with the flaw that it looks for, and passes one without it.

use sdop::bodies::Bodies;
use sdop_judge::truth::{boxes_meet, boxes_near};
use sdop_judge::{Claim, Conclusion, Contestant, Filter, Scene, Verdict, WorldBox, judge};

/// What is wrong with a culler of boxes that looks at all pairs.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Flaw {
    None,
    /// Holds so many pairs.
    Room(usize),
    /// Keeps the box of a body whose pose stays.
    SamePose,
    /// Keeps the box that a number had in the frame before, whosever it is.
    SameNumber,
    /// Keeps the first box of a static body.
    Static,
    /// Adds a new body one frame too late.
    Late,
    /// Keeps the verdict of a pair while one of its bodies sleeps.
    OneAsleep,
    /// Loses the pairs of a body in the frame in which it wakes.
    LostOnWaking,
    /// Takes over a body's move only when the body has moved in two frames.
    FirstMove,
    /// Asks the mask of the first body alone.
    OneMask,
    /// Knows eight groups.
    EightGroups,
    /// Knows no excluded pairs.
    NothingExcluded,
    /// Keeps the filter of the first frame.
    FirstFilter,
    /// Grows the box of the lower number.
    Grown,
    /// Takes over boxes that differ from those it saw last, which is not in its snapshot.
    Unsaved,
    /// Leaves margins to a later test.
    NoMargin,
    /// The larger margin in place of both.
    LargerMargin,
    /// Ends moved by a sum of margins that is rounded first.
    RoundedMargins,
}

/// What a snapshot holds.
#[derive(Clone, Default)]
struct State {
    boxes: Vec<WorldBox>,
    pairs: Vec<[u32; 2]>,
    /// Whether each body moved in the frame.
    moved: Vec<bool>,
}

struct Twin {
    flaw: Flaw,
    given: Vec<WorldBox>,
    state: State,
    saved: State,
    /// What was given in the frame before, and the bodies.
    seen: (Vec<WorldBox>, Bodies),
    was: Option<Vec<Option<u32>>>,
    filter: Option<Filter>,
    margins: Vec<f32>,
}

impl Twin {
    fn new(flaw: Flaw) -> Self {
        Self {
            flaw,
            given: Vec::new(),
            state: State::default(),
            saved: State::default(),
            seen: (Vec::new(), Bodies::default()),
            was: None,
            filter: None,
            margins: Vec::new(),
        }
    }

    /// The number that a body had in the frame before.
    fn former(&self, body: usize) -> Option<usize> {
        let number = match &self.was {
            Some(was) => was[body].map(|number| number as usize),
            None => Some(body),
        };
        number.filter(|&number| number < self.state.boxes.len())
    }

    /// Whether a body has another pose than in the frame before.
    fn has_moved(&self, bodies: &Bodies, body: usize) -> bool {
        let pose = |bodies: &Bodies, i: usize| (bodies.rotation[i], bodies.translation[i]);
        let former = self.former(body);
        former.is_none_or(|former| pose(&self.seen.1, former) != pose(bodies, body))
    }

    /// Whether it reports a pair whose boxes meet or don't.
    fn reports(&self, meets: bool, pair: [u32; 2], moved: &[bool]) -> bool {
        let moved_before = |body: u32| self.state.moved.get(body as usize) != Some(&false);
        let wakes = |body: &u32| moved[*body as usize] && !moved_before(*body);
        match self.flaw {
            Flaw::OneAsleep if pair.iter().any(|&body| !moved[body as usize]) => {
                self.state.pairs.contains(&pair)
            }
            Flaw::LostOnWaking => meets && !pair.iter().any(wakes),
            _ => meets,
        }
    }

    /// The box that it works with; `None` when it doesn't know the body yet.
    fn known(&self, bodies: &Bodies, body: usize) -> Option<WorldBox> {
        let (former, old) = (self.former(body), &self.seen.1);
        let kept = match self.flaw {
            Flaw::SamePose => former.filter(|_| !self.has_moved(bodies, body)),
            Flaw::FirstMove => former.filter(|&f| !self.state.moved[f]),
            Flaw::SameNumber => Some(body).filter(|&body| body < self.state.boxes.len()),
            Flaw::Static => former.filter(|_| !bodies.dynamic[body]),
            Flaw::Unsaved => former.filter(|&f| self.seen.0[f] == self.given[body]),
            Flaw::Late if former.is_none() && !old.is_empty() => return None,
            _ => None,
        };
        Some(kept.map_or(self.given[body], |number| self.state.boxes[number]))
    }

    fn meet(&self, [a, b]: [&WorldBox; 2], [i, j]: [usize; 2]) -> bool {
        if self.margins.is_empty() || self.flaw == Flaw::NoMargin {
            return boxes_meet(a, b);
        }
        let margins = [self.margins[i], self.margins[j]];
        let sum = margins[0] + margins[1];
        let apart = |a: &WorldBox, b: &WorldBox| (0..3).any(|axis| b[axis] > a[axis + 3] + sum);
        match self.flaw {
            Flaw::LargerMargin => boxes_near(a, b, [margins[0].max(margins[1]), 0.0]),
            Flaw::RoundedMargins => !apart(a, b) && !apart(b, a),
            _ => boxes_near(a, b, margins),
        }
    }

    fn parts(&self, pair: [u32; 2]) -> bool {
        let Some(filter) = &self.filter else {
            return false;
        };
        let [[in_a, of_a], [in_b, of_b]] = pair.map(|body| filter.groups[body as usize]);
        match self.flaw {
            Flaw::OneMask => of_a & in_b == 0 || filter.excluded.contains(&pair),
            Flaw::EightGroups => in_a & of_b & 255 == 0 || in_b & of_a & 255 == 0,
            Flaw::NothingExcluded => in_a & of_b == 0 || in_b & of_a == 0,
            _ => filter.parts(pair),
        }
    }
}

impl Contestant for Twin {
    fn boxes(&mut self, boxes: &[WorldBox]) {
        self.given = boxes.to_vec();
    }

    fn frame(&mut self, bodies: &Bodies) {
        let all: Vec<Option<WorldBox>> =
            (0..bodies.len()).map(|body| self.known(bodies, body)).collect();
        let moved: Vec<bool> = (0..bodies.len()).map(|body| self.has_moved(bodies, body)).collect();
        let mut pairs = Vec::new();
        for j in 0..all.len() {
            for i in 0..j {
                let (Some(mut a), Some(b)) = (all[i], all[j]) else {
                    continue;
                };
                if self.flaw == Flaw::Grown {
                    a[3..].iter_mut().for_each(|x| *x += 0.5);
                }
                let pair = [i as u32, j as u32];
                let moves = bodies.dynamic[i] || bodies.dynamic[j];
                let meets = self.reports(self.meet([&a, &b], [i, j]), pair, &moved);
                if moves && meets && !self.parts(pair) {
                    pairs.push(pair);
                }
            }
        }
        if let Flaw::Room(room) = self.flaw {
            pairs.truncate(room);
        }
        let boxes = all.iter().zip(&self.given).map(|(known, given)| known.unwrap_or(*given));
        self.state = State { boxes: boxes.collect(), pairs, moved };
        self.seen = (self.given.clone(), bodies.clone());
        self.was = None;
    }

    fn pairs(&self) -> Vec<[u32; 2]> {
        self.state.pairs.clone()
    }

    fn change(&mut self, _bodies: &Bodies, was: &[Option<u32>]) -> bool {
        self.was = Some(was.to_vec());
        true
    }

    fn filter(&mut self, filter: &Filter) -> bool {
        if self.filter.is_none() || self.flaw != Flaw::FirstFilter {
            self.filter = Some(filter.clone());
        }
        true
    }

    fn margins(&mut self, margins: &[f32]) -> bool {
        self.margins = margins.to_vec();
        true
    }

    fn save(&mut self) -> bool {
        self.saved = self.state.clone();
        true
    }

    fn restore(&mut self) -> bool {
        self.state = self.saved.clone();
        true
    }
}

fn run(claim: Claim, group: &str, flaw: Flaw) -> Verdict {
    let make = move |_: &Scene<'_>| Twin::new(flaw);
    let cases = format!("{group}/*");
    judge(make).claims(claim).cases(&cases).seed(3).run().unwrap()
}

#[test]
fn groups_catch_their_twins() {
    for (claim, group, flaws) in [
        (Claim::Aabb, "crowd/new-pairs", &[Flaw::Room(1 << 18)][..]),
        (Claim::Aabb, "crowd/partners", &[Flaw::Room(4096)]),
        (Claim::Aabb, "stale/reshape", &[Flaw::SamePose, Flaw::SameNumber]),
        (Claim::Aabb, "stale/reorder", &[Flaw::SameNumber]),
        (Claim::Aabb, "stale/rebase", &[Flaw::Static, Flaw::SameNumber]),
        (Claim::Aabb, "stale/all-at-once", &[Flaw::Late, Flaw::SamePose, Flaw::SameNumber]),
        (Claim::Aabb, "stale/sleep", &[Flaw::OneAsleep, Flaw::LostOnWaking, Flaw::FirstMove]),
        (Claim::Filter, "filter/groups", &[Flaw::OneMask, Flaw::EightGroups]),
        (Claim::Filter, "filter/excluded", &[Flaw::NothingExcluded]),
        (Claim::Filter, "filter/at-rest", &[Flaw::FirstFilter]),
        (Claim::Order, "order/insertion", &[Flaw::Grown]),
        (Claim::Restore, "restore/replay", &[Flaw::Unsaved]),
        (Claim::Margin, "margin/global", &[Flaw::NoMargin, Flaw::LargerMargin]),
        (
            Claim::Margin,
            "margin/by-body",
            &[Flaw::NoMargin, Flaw::LargerMargin, Flaw::RoundedMargins],
        ),
    ] {
        let right = run(claim, group, Flaw::None);
        assert_eq!(right.conclusion(), Conclusion::Pass, "{group}: {right}");
        assert_eq!(right.pairs().extra, 0, "{group}: {right}");
        for &flaw in flaws {
            let wrong = run(claim, group, flaw);
            assert_eq!(wrong.conclusion(), Conclusion::NotPassed, "{flaw:?}: {wrong}");
        }
    }
}

/// When a list of candidates is made anew.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Renewal {
    /// When a body has moved by more than half of the skin since the list was made.
    HalfSkin,
    /// By more than the skin.
    Skin,
    /// By more than half of the skin since the frame before.
    FrameToFrame,
    /// Every eighth frame.
    Eighth,
}

/// Keeps a list of boxes that are nearer than a skin.
struct Listed {
    renewal: Renewal,
    age: usize,
    boxes: Vec<WorldBox>,
    /// The boxes when the list was made, or of the frame before.
    known: Vec<WorldBox>,
    list: Vec<[u32; 2]>,
}

const SKIN: f32 = 1.5;

impl Contestant for Listed {
    fn boxes(&mut self, boxes: &[WorldBox]) {
        self.boxes = boxes.to_vec();
    }

    fn frame(&mut self, bodies: &Bodies) {
        let moved = self.boxes.iter().flatten().zip(self.known.iter().flatten());
        let moved = moved.fold(0.0, |most: f32, (x, y)| most.max((x - y).abs()));
        let is_old = match self.renewal {
            Renewal::HalfSkin | Renewal::FrameToFrame => moved >= 0.49 * SKIN,
            Renewal::Skin => moved >= 0.98 * SKIN,
            Renewal::Eighth => self.age == 8,
        };
        self.age += 1;
        if is_old || self.known.is_empty() {
            self.age = 0;
            self.list.clear();
            for j in 0..bodies.len() {
                for i in 0..j {
                    let moves = bodies.dynamic[i] || bodies.dynamic[j];
                    if moves && boxes_near(&self.boxes[i], &self.boxes[j], [SKIN, 0.0]) {
                        self.list.push([i as u32, j as u32]);
                    }
                }
            }
        }
        if self.age == 0 || self.renewal == Renewal::FrameToFrame {
            self.known.clone_from(&self.boxes);
        }
    }

    fn pairs(&self) -> Vec<[u32; 2]> {
        self.list.clone()
    }
}

#[test]
fn overdue_lists_are_caught() {
    let run = |group: &str, renewal| {
        let make = move |_: &Scene<'_>| Listed {
            renewal,
            age: 0,
            boxes: Vec::new(),
            known: Vec::new(),
            list: Vec::new(),
        };
        let cases = format!("{group}/*");
        judge(make).claims(Claim::Aabb).cases(&cases).run().unwrap()
    };
    for (group, wrong) in [
        ("list/both", &[Renewal::Skin, Renewal::FrameToFrame][..]),
        ("list/one", &[Renewal::Eighth, Renewal::FrameToFrame]),
        ("list/return", &[Renewal::FrameToFrame, Renewal::Eighth]),
    ] {
        let right = run(group, Renewal::HalfSkin);
        assert_eq!(right.conclusion(), Conclusion::Pass, "{group}: {right}");
        for &renewal in wrong {
            let verdict = run(group, renewal);
            let word = verdict.conclusion();
            assert_eq!(word, Conclusion::NotPassed, "{group}, {renewal:?}: {verdict}");
        }
    }
}
