//! The contacts of one worker's share of a pair, with what each does.

use glam::Vec3A;

use super::contact::{ContactPush, LayerContact};
use crate::bounded::{BoundedVec, Fill};

/// Contacts, and what each does in the same place; what gathers reads the second alone. All storage is made once.
#[derive(Debug, Clone)]
pub struct ContactList {
    contacts: BoundedVec<LayerContact>,
    pushes: BoundedVec<ContactPush>,
}

impl ContactList {
    /// Room for so many. At load.
    pub fn new(most: usize) -> Self {
        Self { contacts: BoundedVec::new(most), pushes: BoundedVec::new(most) }
    }

    /// Has none.
    pub fn clear(&mut self) {
        self.contacts.clear();
        self.pushes.clear();
    }

    /// Adds one, along a normal; returns whether it fitted.
    pub fn push(&mut self, contact: LayerContact, normal: Vec3A) -> bool {
        self.contacts.push(contact) && self.pushes.push(ContactPush::along(normal))
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.contacts.len()
    }

    /// The contacts.
    pub fn contacts(&self) -> &[LayerContact] {
        &self.contacts
    }

    /// What each does.
    pub fn pushes(&self) -> &[ContactPush] {
        &self.pushes
    }

    /// Both of each.
    pub fn pairs(&self) -> impl Iterator<Item = (&LayerContact, &ContactPush)> {
        self.contacts.iter().zip(&self.pushes)
    }

    /// Both of each, to be changed.
    pub fn pairs_mut(&mut self) -> impl Iterator<Item = (&mut LayerContact, &mut ContactPush)> {
        self.contacts.iter_mut().zip(&mut *self.pushes)
    }

    /// How full it was so far.
    pub fn usage(&self) -> Fill {
        self.contacts.usage()
    }

    /// Memory that it holds (bytes).
    pub fn bytes(&self) -> usize {
        self.contacts.bytes() + self.pushes.bytes()
    }
}
