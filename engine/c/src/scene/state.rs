//! State behind a scene's handle.

use std::ffi::CString;
use std::sync::{Arc, Mutex, MutexGuard, TryLockError};

use toile_sdk::glam::Vec3;
use toile_sdk::{Scene, WornGarment};

use crate::failure::{Failure, Result};
use crate::handle::{Handle, Held, stands_for};
use crate::texts::lent;

/// A scene in motion: a dressed body, or cloth and colliders of a scene file. It takes one call at a time.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct SceneHandle {
    /// Its number; 0 is the null handle.
    id: u64,
}

/// A scene, which one call at a time works on.
#[derive(Debug)]
pub struct SceneObject {
    state: Mutex<SceneState>,
}

/// A scene and what is lent of it.
#[derive(Debug)]
pub struct SceneState {
    pub scene: Scene,
    /// Names, sizes and fabrics of its garments.
    pub texts: Vec<[CString; 3]>,
    /// Positions that were lent, of each garment; they keep their place from the first time on.
    pub lent: Vec<Vec<Vec3>>,
}

stands_for!(SceneHandle, SceneObject);

impl Held for SceneObject {
    const NAME: &'static str = "scene";

    fn may_close(&self) -> Result<()> {
        match self.state.try_lock() {
            Err(TryLockError::WouldBlock) => Err(busy()),
            _ => Ok(()),
        }
    }
}

fn busy() -> Failure {
    Failure::usage(
        "another call is at work on this scene; let one thread call it, or let the threads wait for each other",
    )
}

impl SceneObject {
    pub fn new(scene: Scene) -> Self {
        let texts = |worn: &WornGarment| [lent(&worn.name), lent(&worn.size), lent(&worn.fabric)];
        let texts: Vec<_> = scene.garments().iter().map(texts).collect();
        let lent = vec![Vec::new(); texts.len()];
        Self { state: Mutex::new(SceneState { scene, texts, lent }) }
    }

    /// The scene for one call; where a panic ended an earlier one, nothing is known of it any more.
    fn lock(&self) -> Result<MutexGuard<'_, SceneState>> {
        self.state.try_lock().map_err(|refused| match refused {
            TryLockError::WouldBlock => busy(),
            TryLockError::Poisoned(_) => Failure::internal(
                "a fault of Toile's own ended an earlier call on this scene; close it and make another",
            ),
        })
    }
}

impl SceneHandle {
    /// Works on the scene, which takes no other call meanwhile.
    pub fn with<T>(self, work: impl FnOnce(&mut SceneState) -> Result<T>) -> Result<T> {
        let scene: Arc<SceneObject> = self.get()?;
        let mut state = scene.lock()?;
        work(&mut state)
    }
}

impl SceneState {
    /// A garment by its number.
    pub fn worn(&self, garment: usize) -> Result<&WornGarment> {
        // If the number does not exist, the scene returns an error that says so.
        self.scene.faces(garment)?;
        Ok(&self.scene.garments()[garment])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::failure::{Code, call};

    fn flag() -> SceneHandle {
        let corners = [(0.0, 1.0), (0.1, 1.0), (0.0, 1.1), (0.1, 1.1)].map(|(x, y)| Vec3::new(x, y, 0.0));
        let scene = Scene::of_mesh(&corners, &[[0, 1, 2], [1, 3, 2]], &[2, 3], "cotton-lawn").unwrap();
        SceneHandle::open(SceneObject::new(scene))
    }

    #[test]
    fn a_scene_takes_one_call_at_a_time() {
        let scene = flag();
        scene
            .with(|_| {
                let second = std::thread::spawn(move || scene.with(|_| Ok(()))).join().unwrap().unwrap_err();
                assert_eq!(second.code, Code::Usage);
                assert!(second.sentence.contains("another call is at work"), "{}", second.sentence);
                assert_eq!(scene.close().unwrap_err(), second);
                Ok(())
            })
            .unwrap();
        scene.with(|state| state.worn(0).map(|worn| assert_eq!(worn.vertices, 4))).unwrap();
        scene.close().unwrap();
    }

    #[test]
    fn a_scene_whose_call_panicked_can_only_be_closed() {
        let scene = flag();
        assert_eq!(call("step", || scene.with(|_| panic!("in a step"))), Code::Internal);
        let after = scene.with(|_| Ok(())).unwrap_err();
        assert_eq!(after.code, Code::Internal);
        assert!(after.sentence.contains("close it"), "{}", after.sentence);
        scene.close().unwrap();
    }
}
