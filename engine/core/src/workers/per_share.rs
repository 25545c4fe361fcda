//! Data of one share of a phase, lent to the worker of that share.

use std::marker::PhantomData;
use std::ptr;
use std::sync::atomic::Ordering::{Acquire, Release};

use super::SHARES;
use crate::sync::AtomicPtr;

/// One `T` a share, for a job that both workers call through a shared reference.
pub struct PerShare<'a, T> {
    places: [AtomicPtr<T>; SHARES],
    owner: PhantomData<&'a mut T>,
}

impl<'a, T: Send> PerShare<'a, T> {
    /// Lends out what is borrowed for so long.
    pub fn new(items: &'a mut [T; SHARES]) -> Self {
        Self { places: items.each_mut().map(|i| AtomicPtr::new(ptr::from_mut(i))), owner: PhantomData }
    }

    /// Works with the share's own data. `None` while it is lent to another caller, which a job that keeps to its share never
    /// sees.
    pub fn with<R>(&self, share: usize, work: impl FnOnce(&mut T) -> R) -> Option<R> {
        let place = self.places.get(share)?;
        // Acquire: what the last borrower wrote is seen. Release below: what this one wrote will be.
        let item = place.swap(ptr::null_mut(), Acquire);
        // SAFETY: the pointer came from a unique borrow that outlives `self`, and is out of its place while it is used.
        let result = unsafe { item.as_mut() }.map(work)?;
        place.store(item, Release);
        Some(result)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_share_is_lent_once_at_a_time() {
        let mut numbers = [1, 10];
        let own = PerShare::new(&mut numbers);
        assert_eq!(
            own.with(0, |n| {
                *n += 1;
                own.with(0, |_| ()).is_none()
                    && own.with(1, |m| {
                        *m += 1;
                        true
                    }) == Some(true)
            }),
            Some(true)
        );
        assert_eq!(own.with(1, |n| *n), Some(11));
        assert_eq!(own.with(2, |n| *n), None);
        assert_eq!(numbers, [2, 11]);
    }
}
