//! A walk through two sorted sequences, by which pairs of two moments are compared.

use std::cmp::Ordering;
use std::iter::Peekable;

/// The next item of a walk through two sequences.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Merged<A, B> {
    /// Only the first one has it.
    First(A),
    /// Only the second one has it.
    Second(B),
    /// Both have it.
    Both(A, B),
}

/// The items of two sequences, both sorted as `order` says.
pub(crate) struct Merge<A: Iterator, B: Iterator, F> {
    first: Peekable<A>,
    second: Peekable<B>,
    order: F,
}

impl<A: Iterator, B: Iterator, F: Fn(&A::Item, &B::Item) -> Ordering> Merge<A, B, F> {
    pub fn new(
        first: impl IntoIterator<IntoIter = A, Item = A::Item>,
        second: impl IntoIterator<IntoIter = B, Item = B::Item>,
        order: F,
    ) -> Self {
        Self { first: first.into_iter().peekable(), second: second.into_iter().peekable(), order }
    }
}

impl<A, B, F> Iterator for Merge<A, B, F>
where
    A: Iterator,
    B: Iterator,
    F: Fn(&A::Item, &B::Item) -> Ordering,
{
    type Item = Merged<A::Item, B::Item>;
    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        let order = match (self.first.peek(), self.second.peek()) {
            (Some(one), Some(other)) => (self.order)(one, other),
            (Some(_), None) => Ordering::Less,
            (None, _) => Ordering::Greater,
        };
        match order {
            Ordering::Less => self.first.next().map(Merged::First),
            Ordering::Greater => self.second.next().map(Merged::Second),
            Ordering::Equal => Some(Merged::Both(self.first.next()?, self.second.next()?)),
        }
    }
}
