//! Makes the scene of a number, outside of the loop: the shopper's body, what they put on, and how they stand.

use std::sync::Arc;

use toile_assets::drafting;
use toile_base::body::Body;
use toile_base::frame::Joints;
use toile_base::garment::Garment;
use toile_base::rig::Rig;
use toile_engine::cloth::{Quality, Settings};
use toile_engine::triple_buffer::Reader;
use toile_engine::world::{Snapshot, World};
use toile_fitting::dress::try_on::DressedBody;

use super::error::SoakError;
use super::options::SceneWeight;
use super::scenario::{Scenario, WornSize};

/// Of a light scene: distance between particles (mm).
const LIGHT_MM: f64 = 40.0;

/// Substeps of a light scene.
const LIGHT_SUBSTEPS: u32 = 1;

/// Every so many of the body's vertices are left in a light scene.
const LIGHT_SKIN: usize = 16;

/// Makes scenes, and keeps the last shopper's body.
#[derive(Debug)]
pub struct SceneMaker {
    scenario: Arc<Scenario>,
    last: Option<(usize, Body, Rig)>,
}

impl SceneMaker {
    /// Makes the scenes of a scenario.
    pub fn new(scenario: Arc<Scenario>) -> Self {
        Self { scenario, last: None }
    }

    /// The scene of a number, the shopper dressed as they stood when it was asked for; stepped by one worker.
    ///
    /// # Errors
    /// A number that the scenario does not have, a body or a garment that cannot be made.
    pub fn make(&mut self, number: u64) -> Result<(World, Reader<Snapshot>), SoakError> {
        let wrong = |reason: String| SoakError::Scene { number, reason };
        let scenario = self.scenario.clone();
        let request = scenario.requests.get(number as usize).ok_or_else(|| wrong("the scenario has none".into()))?;
        let light = scenario.plan.scene == SceneWeight::Light;
        let (body, rig) = self.shopper(request.visit).map_err(wrong)?;
        let garments = request.outfit.iter().map(|worn| garment(worn, body, light)).collect::<Result<_, _>>();
        let garments: Vec<Garment> = garments.map_err(wrong)?;
        let quality = if light { Quality::Draft } else { Quality::default() };
        let settings = Settings { quality, workers: 1, ..Settings::default() };
        let shown = if light { thinned(body) } else { body.clone() };
        let (mut world, reader) = DressedBody::new(rig.clone(), shown, garments).build(settings)?;
        let at = scenario.visits[request.visit].joints(request.at_ns);
        world.dress(&Joints::seen(request.at_ns, at));
        Ok((world, reader))
    }

    fn shopper(&mut self, visit: usize) -> Result<(&Body, &Rig), String> {
        if self.last.as_ref().is_none_or(|(last, ..)| *last != visit) {
            let who = &self.scenario.visits[visit];
            // Not every set of measures goes together; those of a size do.
            let built = who.measures.iter().find_map(|m| toile_assets::body::build(who.sex, m).ok());
            let body = match built {
                Some(body) => body,
                None => {
                    let average = toile_base::body::Measures::average(who.sex);
                    toile_assets::body::build(who.sex, &average).map_err(|e| e.to_string())?
                }
            };
            let rig = toile_assets::rig::fit(&body);
            self.last = Some((visit, body, rig));
        }
        self.last.as_ref().map(|(_, body, rig)| (body, rig)).ok_or_else(String::new)
    }
}

fn garment(worn: &WornSize, body: &Body, light: bool) -> Result<Garment, String> {
    let mut package = drafting::package(worn.garment).map_err(|e| e.to_string())?;
    if light {
        package.spacing_mm = LIGHT_MM;
    }
    let mut garment = package.dress(&worn.size, body).map_err(|e| e.to_string())?;
    if light {
        garment.set_substeps(LIGHT_SUBSTEPS);
    }
    Ok(garment)
}

/// The same body with fewer vertices to skin; nothing else of it is looked at any more.
fn thinned(body: &Body) -> Body {
    fn some<T: Clone>(all: &[T]) -> Vec<T> {
        all.iter().step_by(LIGHT_SKIN).cloned().collect()
    }
    let mut thin = body.clone();
    thin.mesh.positions = some(&body.mesh.positions);
    thin.mesh.triangles = Vec::new();
    thin.mesh.uvs = Vec::new();
    (thin.normals, thin.weights) = (some(&body.normals), some(&body.weights));
    thin
}
