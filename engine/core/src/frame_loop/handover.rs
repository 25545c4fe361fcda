//! Handover: a scene that was made elsewhere takes the place of the one that is stepped, and the old one goes back to be
//! dropped elsewhere. The physics swaps two values and allocates nothing.

use super::queue::{Receiver, Sender, bounded};

/// Changes that wait: one, for a second that comes before the first was taken has nothing to hurry for.
pub const CHANGES: usize = 1;

/// Name of this capacity in reports and warnings.
pub const CHANGES_NAME: &str = "CHANGES (queue of scenes to hand over)";

/// Something whole that takes another's place.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneChange<S> {
    /// What comes; what went, when it is back.
    pub scene: S,
    /// Its number, by which a recording names it.
    pub number: u64,
    /// Whether another shopper comes with it, so that no motion is carried on.
    pub afresh: bool,
}

/// The end held by the maker of scenes.
#[derive(Debug)]
pub struct HandoverSender<S> {
    to: Sender<Box<SceneChange<S>>>,
    back: Receiver<Box<SceneChange<S>>>,
}

/// The end held by the loop that steps or shows them.
#[derive(Debug)]
pub struct HandoverReceiver<S> {
    from: Receiver<Box<SceneChange<S>>>,
    back: Sender<Box<SceneChange<S>>>,
}

/// Both ends. At load.
pub fn handover<S>() -> (HandoverSender<S>, HandoverReceiver<S>) {
    let ((to, from), (back, returned)) = (bounded(CHANGES_NAME, CHANGES), bounded(CHANGES_NAME, CHANGES));
    (HandoverSender { to, back: returned }, HandoverReceiver { from, back })
}

impl<S> HandoverSender<S> {
    /// Offers a change; gives it back where one waits already.
    ///
    /// # Errors
    /// The change itself.
    pub fn give(&mut self, change: Box<SceneChange<S>>) -> Result<(), Box<SceneChange<S>>> {
        if self.to.is_full() {
            return Err(change);
        }
        self.to.push(change);
        Ok(())
    }

    /// What was replaced, to be dropped here. The next change is not taken before that.
    pub fn returned(&mut self) -> Option<Box<SceneChange<S>>> {
        self.back.pop()
    }
}

impl<S> HandoverReceiver<S> {
    /// Has what was given put in its place, if something was, and sends back what `put` leaves in it; gives its number and
    /// whether another shopper comes.
    pub fn take(&mut self, put: impl FnOnce(&mut SceneChange<S>)) -> Option<(u64, bool)> {
        // A box that did not fit into the way back would be dropped here.
        if self.back.is_full() {
            return None;
        }
        let mut change = self.from.pop()?;
        put(&mut change);
        let taken = (change.number, change.afresh);
        self.back.push(change);
        Some(taken)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_given_takes_the_place_and_what_went_comes_back() {
        let (mut giver, mut taker) = handover();
        let mut here = "first".to_owned();
        let take = |taker: &mut HandoverReceiver<String>, here: &mut String| {
            taker.take(|c| std::mem::swap(&mut c.scene, here))
        };
        assert_eq!(take(&mut taker, &mut here), None);
        let change = |scene: &str, number| Box::new(SceneChange { scene: scene.to_owned(), number, afresh: true });
        giver.give(change("second", 1)).unwrap();
        assert_eq!(giver.give(change("third", 2)).unwrap_err().number, 2, "one waits already");
        assert_eq!((take(&mut taker, &mut here), here.as_str()), (Some((1, true)), "second"));
        giver.give(change("third", 2)).unwrap();
        assert_eq!(take(&mut taker, &mut here), None, "the first was not fetched yet");
        assert_eq!(giver.returned().unwrap().scene, "first");
        assert_eq!((take(&mut taker, &mut here), here.as_str()), (Some((2, true)), "third"));
    }
}
