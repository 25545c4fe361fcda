//! Handles: numbers that stand for opened objects, in place of pointers.
//!
//! A handle is the number of a slot and the slot's generation, which rises when its object is closed. A handle that was closed is
//! therefore known as closed for ever, also after its slot was taken again; a slot whose generations are used up takes nothing more. A call
//! looks its handle up behind a lock that many may read at once, and holds what it finds, so that closing it meanwhile frees
//! nothing under it.

use std::any::Any;
use std::sync::{Arc, PoisonError, RwLock};

use crate::failure::{Failure, Result};

/// What a handle may stand for.
pub trait Held: Any + Send + Sync {
    /// What it is called, for messages.
    const NAME: &'static str;

    /// Whether it may be closed now.
    fn may_close(&self) -> Result<()> {
        Ok(())
    }
}

/// A handle as C has it.
pub trait Handle: Copy + Default {
    /// What it stands for.
    type Object: Held;

    /// Of its number.
    fn of_id(id: u64) -> Self;

    /// Its number.
    fn id(self) -> u64;

    /// A new handle for something.
    fn open(object: Self::Object) -> Self {
        Self::of_id(SLOTS.write().unwrap_or_else(PoisonError::into_inner).put(Self::Object::NAME, Arc::new(object)))
    }

    /// What it stands for.
    fn get(self) -> Result<Arc<Self::Object>> {
        let slots = SLOTS.read().unwrap_or_else(PoisonError::into_inner);
        let entry = slots.entry(self.id(), Self::Object::NAME)?;
        Arc::clone(&entry.object).downcast().map_err(|_| wrong_kind(entry.name, Self::Object::NAME))
    }

    /// Closes it; nothing of a null handle.
    fn close(self) -> Result<()> {
        if self.id() == 0 {
            return Ok(());
        }
        let mut slots = SLOTS.write().unwrap_or_else(PoisonError::into_inner);
        let entry = slots.entry(self.id(), Self::Object::NAME)?;
        let Some(object) = entry.object.downcast_ref::<Self::Object>() else {
            return Err(wrong_kind(entry.name, Self::Object::NAME));
        };
        object.may_close()?;
        let taken = slots.take(self.id());
        // The content is freed after the lock is released, so that no thread waits for it.
        drop(slots);
        drop(taken);
        Ok(())
    }
}

/// What a type of handles stands for.
macro_rules! stands_for {
    ($handle:ident, $object:ty) => {
        impl Handle for $handle {
            type Object = $object;

            fn of_id(id: u64) -> Self {
                Self { id }
            }

            fn id(self) -> u64 {
                self.id
            }
        }

        impl Default for $handle {
            fn default() -> Self {
                Self { id: 0 }
            }
        }
    };
    ($handle:ident, $object:ty, $name:literal) => {
        stands_for!($handle, $object);

        impl Held for $object {
            const NAME: &'static str = $name;
        }
    };
}
pub(crate) use stands_for;

#[derive(Debug)]
struct Entry {
    name: &'static str,
    object: Arc<dyn Any + Send + Sync>,
}

#[derive(Debug)]
struct Slot {
    /// That of what is in it, or will be; from 1, so that no handle is 0.
    generation: u32,
    entry: Option<Entry>,
}

#[derive(Debug)]
struct Slots {
    slots: Vec<Slot>,
    /// Those with nothing in them that may be used again.
    free: Vec<u32>,
}

static SLOTS: RwLock<Slots> = RwLock::new(Slots { slots: Vec::new(), free: Vec::new() });

/// Slot and generation of a handle's number.
fn parts(id: u64) -> (usize, u32) {
    (id as u32 as usize, (id >> 32) as u32)
}

fn wrong_kind(is: &str, wanted: &str) -> Failure {
    Failure::usage(format!("the handle is that of a {is}, and this call takes a {wanted}"))
}

impl Slots {
    fn put(&mut self, name: &'static str, object: Arc<dyn Any + Send + Sync>) -> u64 {
        let index = self.free.pop().unwrap_or_else(|| {
            self.slots.push(Slot { generation: 1, entry: None });
            (self.slots.len() - 1) as u32
        });
        let slot = &mut self.slots[index as usize];
        slot.entry = Some(Entry { name, object });
        u64::from(slot.generation) << 32 | u64::from(index)
    }

    fn entry(&self, id: u64, wanted: &str) -> Result<&Entry> {
        if id == 0 {
            return Err(Failure::usage(format!(
                "the {wanted} is a null handle; make it first, and look at the code of that call"
            )));
        }
        let (index, generation) = parts(id);
        let slot = self.slots.get(index).filter(|slot| generation != 0 && generation <= slot.generation);
        let slot =
            slot.ok_or_else(|| Failure::usage(format!("the number of the {wanted} was never that of a handle")))?;
        let entry = slot.entry.as_ref().filter(|_| slot.generation == generation);
        entry.ok_or_else(|| {
            Failure::usage(format!("the {wanted} was closed before; a handle that was closed stays closed"))
        })
    }

    /// Takes out what `entry` found.
    fn take(&mut self, id: u64) -> Option<Entry> {
        let (index, _) = parts(id);
        let slot = &mut self.slots[index];
        let entry = slot.entry.take();
        if slot.generation < u32::MAX {
            slot.generation += 1;
            self.free.push(index as u32);
        }
        entry
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug)]
    struct Thing(u32);
    #[derive(Debug)]
    struct Other;
    #[derive(Debug, Clone, Copy)]
    struct ThingHandle {
        id: u64,
    }
    #[derive(Debug, Clone, Copy)]
    struct OtherHandle {
        id: u64,
    }
    stands_for!(ThingHandle, Thing, "thing");
    stands_for!(OtherHandle, Other, "toy");

    fn refused<T: std::fmt::Debug>(result: Result<T>, words: &str) {
        let failure = result.unwrap_err();
        assert!(failure.sentence.contains(words), "{}", failure.sentence);
    }

    #[test]
    fn a_closed_handle_is_never_another_one() {
        let first = ThingHandle::open(Thing(1));
        assert_eq!(first.get().unwrap().0, 1);
        first.close().unwrap();
        for _ in 0..100 {
            let next = ThingHandle::open(Thing(2));
            assert_ne!(next.id, first.id);
            refused(first.get(), "closed before");
            refused(first.close(), "closed before");
            assert_eq!(next.get().unwrap().0, 2);
            next.close().unwrap();
        }
    }

    #[test]
    fn what_is_no_handle_is_refused() {
        refused(ThingHandle::default().get(), "null handle");
        ThingHandle::default().close().unwrap();
        for id in [1, 7 << 32 | 0xffff_ffff, u64::MAX, 0xffff_fff0_0000_0000] {
            refused(ThingHandle { id }.get(), "never");
            refused(ThingHandle { id }.close(), "never");
        }
        let other = OtherHandle::open(Other);
        refused(ThingHandle { id: other.id }.get(), "that of a toy, and this call takes a thing");
        refused(ThingHandle { id: other.id }.close(), "takes a thing");
        other.close().unwrap();
    }

    #[test]
    fn what_is_held_outlives_its_handle() {
        let handle = ThingHandle::open(Thing(3));
        let held = handle.get().unwrap();
        handle.close().unwrap();
        assert_eq!(held.0, 3);
    }

    #[test]
    fn a_slot_whose_generations_are_used_up_takes_nothing_more() {
        let mut slots = Slots { slots: vec![Slot { generation: u32::MAX, entry: None }], free: vec![0] };
        let last = slots.put("thing", Arc::new(Thing(0)));
        slots.take(last);
        assert!(slots.entry(last, "thing").is_err() && slots.free.is_empty());
        assert_ne!(slots.put("thing", Arc::new(Thing(1))), last);
    }
}
