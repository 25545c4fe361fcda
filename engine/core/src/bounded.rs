//! Vectors that are filled in the frame. Their storage is made at load; what does not fit is refused and counted.

use std::ops::{Deref, DerefMut};

/// How full vectors with a bound were since they were made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Fill {
    /// The most entries that one of them can hold.
    pub capacity: u64,
    /// The most entries that were in it at once.
    pub most: u64,
    /// Number of entries that did not fit.
    pub lost: u64,
}

impl Fill {
    /// The fuller of two, with what both lost.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        let fuller =
            if other.most * self.capacity > self.most * other.capacity || self.capacity == 0 { other } else { self };
        Self { lost: self.lost + other.lost, ..fuller }
    }
}

/// A vector that never grows beyond the storage it was made with. A clone has as much.
#[derive(Debug)]
pub struct BoundedVec<T> {
    /// Its own capacity is at least `capacity`, so that adding an entry allocates nothing.
    items: Vec<T>,
    capacity: usize,
    most: usize,
    lost: u64,
}

impl<T> BoundedVec<T> {
    /// Makes an empty vector for at most `capacity` entries. At load.
    pub fn new(capacity: usize) -> Self {
        Self { items: Vec::with_capacity(capacity), capacity, most: 0, lost: 0 }
    }

    /// Adds an entry and returns whether it fitted.
    #[inline(always)]
    pub fn push(&mut self, item: T) -> bool {
        let fits = self.items.len() < self.capacity;
        if fits {
            self.items.push(item);
        } else {
            self.lost += 1;
        }
        fits
    }

    /// Adds entries, as many as fit.
    pub fn extend(&mut self, items: impl IntoIterator<Item = T>) {
        items.into_iter().for_each(|item| _ = self.push(item));
    }

    /// Removes all entries.
    pub fn clear(&mut self) {
        self.most = self.most.max(self.items.len());
        self.items.clear();
    }

    /// Keeps the entries that `keep` answers yes to.
    pub fn retain_mut(&mut self, keep: impl FnMut(&mut T) -> bool) {
        self.most = self.most.max(self.items.len());
        self.items.retain_mut(keep);
    }

    /// How full it was so far.
    pub fn usage(&self) -> Fill {
        let most = self.most.max(self.items.len()) as u64;
        Fill { capacity: self.capacity as u64, most, lost: self.lost }
    }

    /// Memory that it holds (bytes).
    pub fn bytes(&self) -> usize {
        size_of::<T>() * self.capacity
    }
}

impl<T: Copy> BoundedVec<T> {
    /// Brings it to a length, as far as that fits, with `value` in new places.
    pub fn resize(&mut self, len: usize, value: T) {
        let fits = len.min(self.capacity);
        self.lost += (len - fits) as u64;
        self.items.resize(fits, value);
    }
}

impl<T: Clone> Clone for BoundedVec<T> {
    fn clone(&self) -> Self {
        let mut items = Vec::with_capacity(self.capacity);
        items.extend_from_slice(&self.items);
        Self { items, ..*self }
    }
}

impl<T> Deref for BoundedVec<T> {
    type Target = [T];

    #[inline(always)]
    fn deref(&self) -> &[T] {
        &self.items
    }
}

impl<T> DerefMut for BoundedVec<T> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [T] {
        &mut self.items
    }
}

impl<'a, T> IntoIterator for &'a BoundedVec<T> {
    type Item = &'a T;
    type IntoIter = std::slice::Iter<'a, T>;

    fn into_iter(self) -> Self::IntoIter {
        self.items.iter()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_not_fit_is_counted() {
        let mut list = BoundedVec::new(3);
        let fitted: Vec<bool> = (0..5).map(|i| list.push(i)).collect();
        assert_eq!((fitted, &*list), (vec![true, true, true, false, false], &[0, 1, 2][..]));
        list.clear();
        list.extend(7..9);
        assert_eq!((list.usage(), list.len()), (Fill { capacity: 3, most: 3, lost: 2 }, 2));
        list.resize(5, 1);
        assert_eq!((&*list, list.usage().lost), (&[7, 8, 1][..], 4));
        list.retain_mut(|i| *i > 1);
        assert_eq!(&*list, [7, 8]);
    }

    #[test]
    fn a_clone_has_the_same_capacity() {
        let mut list = BoundedVec::new(2);
        list.push(1);
        let mut copy = list.clone();
        assert!(copy.push(2) && !copy.push(3));
        assert_eq!((&*list, &*copy), (&[1][..], &[1, 2][..]));
    }

    #[test]
    fn the_fuller_list_speaks_for_all() {
        let fill = |capacity, most, lost| Fill { capacity, most, lost };
        assert_eq!(fill(10, 4, 1).and(fill(100, 50, 2)), fill(100, 50, 3));
        assert_eq!(Fill::default().and(fill(10, 0, 0)), fill(10, 0, 0));
        assert_eq!(fill(10, 2, 0).and(Fill::default()), fill(10, 2, 0));
    }
}
