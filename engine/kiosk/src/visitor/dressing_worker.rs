//! The dressing worker: measures a shopper, dresses them, drapes two sizes, takes a picture and makes a head of their face, one after the other, on a thread of its own for
//! which no other thread waits.

use std::net::SocketAddr;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

use toile_assets::file;
use toile_assets::sizes::Population;
use toile_base::body::Sex;
use toile_base::frame::Joints;
use toile_engine::cloth::Quality;
use toile_engine::world::{Snapshot, World};
use toile_fitting::FittingError;
use toile_fitting::dress::garment_source::GarmentSource;
use toile_fitting::dress::measured::{self, ShopperFacts};
use toile_fitting::dress::try_on::{DressedWorld, RequestedGarment, TryOn};
use toile_fitting::live::background::{BackgroundJob, Finished};
use toile_fitting::live::shopper_source::ShopperSource;
use toile_track::tape_readings;
use toile_view::drawn_frame::{self, DrawnFrame};
use toile_view::figure::{Appearance, OwnHead};
use toile_view::image::{Size, linear};

use super::own_face::{FaceTrouble, MakeHeads, Portrait};
use super::picture::{self, RgbImage};
use super::picture_link::PictureServer;
use super::picture_store::{OfferedPicture, PictureLink};
use super::size_fit::VisitorMeasures;
use super::wardrobe::{Outfit, Wardrobe};
use crate::error::KioskError;
use crate::service::picture_config::PictureConfig;

/// Size at which a picture is drawn, to be made smaller: twice the largest that a code holds.
const DRAWN: Size = Size::new(192, 320);

/// Size of a picture behind a link: a phone's screen, nearly.
const DRAWN_LARGE: Size = Size::new(720, 1200);

/// Garments of a visit that stay open: a package of a shop's own takes a few megabytes.
const WORN_OPEN: usize = 8;

/// A frame that was dressed, and the snapshot of it.
pub type DrapedFrame = (World, Snapshot);

/// A measured person, in the pose in which they are dressed.
#[derive(Debug, Clone)]
pub struct MeasuredVisitor {
    /// Measures of the visitor, as far as they are known.
    pub known: VisitorMeasures,
    /// The joints in which they are dressed.
    pub pose: Joints,
}

/// A person to be measured.
#[derive(Debug, Clone)]
pub struct MeasuringJob {
    /// What was seen of them.
    pub source: ShopperSource,
    /// Whether they sit: nothing is taken from their legs and hips.
    pub seated: bool,
    /// Depth of a turn counts up to this time of a recording (ns); 0 is the front alone.
    pub until_ns: u64,
}

/// A job for the dressing worker.
#[derive(Debug, Clone)]
pub enum DressingJob {
    /// Measure a person.
    Measure(MeasuringJob),
    /// Dress a person in an outfit.
    Dress(Box<MeasuredVisitor>, Outfit),
    /// Drape two outfits on them.
    Two(Box<MeasuredVisitor>, Box<[Outfit; 2]>),
    /// Take a picture of them from an angle (rad).
    Snap(Box<MeasuredVisitor>, Outfit, f32),
    /// Make a head of the face in a picture of them, for the body that wears this outfit.
    Face(Box<MeasuredVisitor>, Outfit, Arc<Portrait>),
}

/// Result of a job.
pub enum JobResult {
    /// The measures of a person.
    Measured(Box<VisitorMeasures>),
    /// The dressed body of a person.
    Dressed(Box<DressedWorld>),
    /// Both outfits are draped.
    Two(Box<[DrapedFrame; 2]>),
    /// The picture, by its codes.
    Picture(OfferedPicture),
    /// Their head, of each drawing that their body may have; or why there is none.
    Face(Result<Vec<Arc<OwnHead>>, FaceTrouble>),
    /// It could not be done; why is not reported, for it may say something about them.
    Failed,
}

/// What every job needs.
pub struct DressingContext {
    /// The garments that can be chosen.
    pub wardrobe: Arc<Wardrobe>,
    /// What every visitor wears first, open.
    first: Arc<TryOn>,
    /// How their cloth is stepped.
    quality: Quality,
    /// What is known of every shopper.
    facts: ShopperFacts,
    /// How their body looks in pictures.
    appearance: Appearance,
    /// Where pictures are served, if they are.
    served: PictureConfig,
    /// Makes heads of faces, where shoppers may have theirs taken.
    faces: Option<MakeHeads>,
    /// What this shopper has put on, open, the last one last: they keep it, whatever becomes of its file.
    worn: Mutex<Vec<Arc<GarmentSource>>>,
}

/// Runs one job at a time on a thread of its own, beside the live loop.
pub struct DressingWorker {
    context: Arc<DressingContext>,
    job: BackgroundJob<(u32, Result<JobResult, KioskError>)>,
}

impl DressingWorker {
    /// A worker without a job. Starts its thread with the first.
    pub fn new(context: DressingContext) -> Self {
        Self { context: Arc::new(context), job: BackgroundJob::default() }
    }

    /// Whether a job is under way, wanted or not.
    pub fn is_busy(&self) -> bool {
        self.job.is_running()
    }

    /// Whether it makes heads of faces.
    pub fn makes_faces(&self) -> bool {
        self.context.faces.is_some()
    }

    /// Begins a job, by its number.
    ///
    /// # Errors
    /// Where the system gives no thread.
    pub fn begin(&mut self, number: u32, job: DressingJob) -> std::io::Result<()> {
        let context = self.context.clone();
        self.job.start("toile-visitor", move || (number, context.work(job)))
    }

    /// The shopper has left: what comes of the job is thrown away, and what they wore is closed.
    pub fn forget(&mut self) {
        self.job.abandon();
        self.context = Arc::new(self.context.anew());
    }

    /// Other garments hang from now on.
    pub fn restock(&mut self, wardrobe: Arc<Wardrobe>, first: Arc<TryOn>) {
        self.context = Arc::new(DressingContext { wardrobe, first, ..self.context.anew() });
    }

    /// What has come of a job, once, when it has ended.
    ///
    /// # Errors
    /// Where its thread panicked.
    pub fn poll(&mut self) -> Result<Option<(u32, JobResult)>, KioskError> {
        match self.job.poll() {
            Some(Finished::Panicked) => {
                Err(KioskError::Internal("the dressing thread panicked; start the kiosk again".into()))
            }
            Some(Finished::Done { value: (number, done), wanted: true }) => {
                Ok(Some((number, done.unwrap_or(JobResult::Failed))))
            }
            Some(Finished::Done { .. }) | None => Ok(None),
        }
    }
}

impl DressingContext {
    /// A context in which nothing was worn yet.
    pub fn new(
        wardrobe: Arc<Wardrobe>,
        first: Arc<TryOn>,
        quality: Quality,
        facts: ShopperFacts,
        appearance: Appearance,
    ) -> Self {
        let served = PictureConfig::default();
        Self { wardrobe, first, quality, facts, appearance, served, faces: None, worn: Mutex::default() }
    }

    /// The same, whose pictures are served.
    #[must_use]
    pub fn serving(self, served: PictureConfig) -> Self {
        Self { served, ..self }
    }

    /// The same, which makes heads of faces.
    #[must_use]
    pub fn making_faces(self, faces: Option<MakeHeads>) -> Self {
        Self { faces, ..self }
    }

    /// The same for the next shopper.
    fn anew(&self) -> Self {
        Self::new(self.wardrobe.clone(), self.first.clone(), self.quality, self.facts, self.appearance)
            .serving(self.served.clone())
            .making_faces(self.faces.clone())
    }

    /// A garment as it hangs: one whose file is another one by now is not what the shopper has seen.
    fn find(&self, name: &str) -> Result<Arc<GarmentSource>, FittingError> {
        if let Some(first) = self.first.garments.iter().find(|garment| garment.name == name) {
            return first.source();
        }
        let mut worn = self.worn.lock().unwrap_or_else(PoisonError::into_inner);
        let found = match worn.iter().position(|source| source.name == name) {
            Some(place) => worn.remove(place),
            None => {
                let found = GarmentSource::find(name).map(Arc::new)?;
                let hung = self.wardrobe.items.iter().find(|item| item.name == name).and_then(|item| item.stamp);
                if hung.is_some() && hung != file::stamp(Path::new(name)) {
                    return Err(FittingError::Input(format!(
                        "{name}: it was changed since it hangs; it hangs anew soon"
                    )));
                }
                found
            }
        };
        if worn.len() >= WORN_OPEN {
            worn.remove(0);
        }
        worn.push(found.clone());
        Ok(found)
    }

    fn work(&self, job: DressingJob) -> Result<JobResult, KioskError> {
        Ok(match job {
            DressingJob::Measure(job) => JobResult::Measured(Box::new(self.measure(job)?)),
            DressingJob::Dress(client, outfit) => JobResult::Dressed(Box::new(self.dressed(&client, &outfit)?)),
            DressingJob::Two(client, outfits) => {
                let [left, right] = &*outfits;
                JobResult::Two(Box::new([self.draped(&client, left)?, self.draped(&client, right)?]))
            }
            DressingJob::Snap(client, outfit, yaw) => JobResult::Picture(self.picture(&client, &outfit, yaw)?),
            DressingJob::Face(client, outfit, portrait) => JobResult::Face(self.face(&client, &outfit, &portrait)?),
        })
    }

    /// Measures the person who stands or sits in view.
    fn measure(&self, job: MeasuringJob) -> Result<VisitorMeasures, KioskError> {
        let MeasuringJob { source, seated, until_ns } = job;
        let measured = measured::measure(&source.session(), ShopperFacts { seated, until_ns, ..self.facts })?;
        // Measures by tape are checked against it on the service's thread, which is not to wait for it.
        _ = tape_readings::population(Population::Mixed);
        let known = VisitorMeasures::new(measured.best, seated);
        Ok(known.with_fit(measured.population, measured.fitted.map(|fit| fit.all)))
    }

    fn request(&self, client: &MeasuredVisitor, worn: &Outfit) -> Result<TryOn, KioskError> {
        let mut garments = Vec::with_capacity(worn.len());
        for w in worn {
            let item = self
                .wardrobe
                .items
                .get(w.item)
                .ok_or_else(|| KioskError::internal("a garment is not in the wardrobe"))?;
            let size = item.sizes.get(w.size).ok_or_else(|| KioskError::internal("a size is not made"))?;
            garments.push(RequestedGarment::of(self.find(&item.name)?, Some(size.clone())));
        }
        let sex = self.sex(client, worn);
        let (body, _) = measured::build_body(sex, &client.known.measured, Population::from(Some(sex)))?;
        Ok(TryOn::of_body("shopper", sex, body.measures, garments).in_quality(self.quality))
    }

    /// Sex of the body shown in an outfit: as measured, else that of the innermost garment that is made for one.
    fn sex(&self, client: &MeasuredVisitor, worn: &Outfit) -> Sex {
        let made_for = worn.iter().filter_map(|w| self.wardrobe.items.get(w.item)).map(|item| item.population);
        let garments = made_for.into_iter().find(|p| *p != Population::Mixed).unwrap_or(Population::Mixed);
        measured::sex(client.known.population, garments)
    }

    /// The heads that a face in a picture makes.
    fn face(
        &self,
        client: &MeasuredVisitor,
        worn: &Outfit,
        portrait: &Portrait,
    ) -> Result<Result<Vec<Arc<OwnHead>>, FaceTrouble>, KioskError> {
        let faces = self.faces.as_ref().ok_or_else(|| KioskError::internal("no network finds faces"))?;
        let sex = self.sex(client, worn);
        // Whose sex is not known changes the drawing with the garment.
        let either: Vec<Sex> = if client.known.population == Population::Mixed { Sex::ALL.into() } else { vec![sex] };
        Ok(faces(portrait, &either))
    }

    fn dressed(&self, client: &MeasuredVisitor, worn: &Outfit) -> Result<DressedWorld, KioskError> {
        self.request(client, worn)?.build(&client.pose)
    }

    fn draped(&self, client: &MeasuredVisitor, worn: &Outfit) -> Result<DrapedFrame, KioskError> {
        let DressedWorld { mut world, mut reader, .. } = self.dressed(client, worn)?;
        world.step(&client.pose);
        let snapshot = reader.latest().clone();
        Ok((world, snapshot))
    }

    fn picture(&self, client: &MeasuredVisitor, worn: &Outfit, yaw: f32) -> Result<OfferedPicture, KioskError> {
        let (world, snapshot) = self.draped(client, worn)?;
        let colour = |w: &super::wardrobe::WornItem| self.wardrobe.items.get(w.item)?.colours.get(w.colour);
        let colours: Vec<[f32; 3]> = worn.iter().filter_map(colour).map(|c| c.srgb.map(linear)).collect();
        let drawn = DrawnFrame::new(&world, self.appearance).coloured(&colours);
        let size = if self.served.serve.is_some() { DRAWN_LARGE } else { DRAWN };
        let image = drawn_frame::still(drawn, &snapshot, yaw, size);
        let still = RgbImage { size: image.size(), bytes: image.bytes().to_vec() };
        // Where the link cannot be had, as while the network is down, there is the code that holds the picture.
        let link = self.served.serve.and_then(|address| self.link(address, &still).ok());
        let own = picture::encode(&still).map_err(KioskError::internal);
        match (link, own) {
            (None, Err(why)) => Err(why),
            (link, own) => Ok(OfferedPicture { link, own: own.ok() }),
        }
    }

    /// Serves a picture; gives the code of its link.
    fn link(&self, address: SocketAddr, still: &RgbImage) -> Result<PictureLink, KioskError> {
        let png = picture::png(still).map_err(KioskError::internal)?;
        let server = PictureServer::start(address, png).map_err(KioskError::internal)?;
        let code = picture::link_code(server.url()).map_err(KioskError::internal)?;
        Ok(PictureLink { code, network: self.served.network.clone(), server: Arc::new(server) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::service::config::Config;
    use crate::service::stock::Stock;
    use crate::visitor::size_fit::{BodyPart, MeasureBasis};
    use crate::visitor::wardrobe::WornItem;
    use toile_assets::sizes::Girth;
    use toile_fitting::dress::session;
    use toile_sensors::source::Session;
    use toile_track::measures::Measures;

    fn context(config: &Config) -> DressingContext {
        let stock = Stock::read(config).unwrap();
        let wardrobe = Arc::new(Wardrobe::of(&stock, None, &mut Vec::new()).unwrap());
        DressingContext::new(wardrobe, stock.first, Quality::Draft, ShopperFacts::default(), Appearance::default())
    }

    /// The same whose visitors wear a coarse T-shirt first, which is soon draped, and the name of that.
    fn with_coarse_tee() -> (DressingContext, String) {
        let mut tee = toile_assets::drafting::package("tee").unwrap();
        tee.spacing_mm = 40.0;
        let file = std::env::temp_dir().join(format!("toile-worker-{}.json", std::process::id()));
        std::fs::write(&file, tee.text()).unwrap();
        let name = file.display().to_string();
        let mut config = Config::default();
        config.wear.garments = vec![name.clone()];
        let context = context(&config);
        std::fs::remove_file(file).unwrap();
        (context, name)
    }

    fn job(source: ShopperSource, seated: bool) -> MeasuringJob {
        MeasuringJob { source, seated, until_ns: u64::MAX }
    }

    fn session() -> Session {
        session::open(None, None).unwrap()
    }

    #[test]
    fn depth_gives_eleven_measures_joints_fewer_and_a_chair_fewest() {
        let (context, session) = (context(&Config::default()), Arc::new(session()));
        let recording = ShopperSource::Recording(session.clone());
        let depth = context.measure(job(recording.clone(), false)).unwrap();
        assert!(depth.missing.is_empty() && depth.count == 11 && !depth.seated);
        assert_eq!(depth.basis(Girth::Waist), MeasureBasis::Seen);
        let stature = depth.measured.measures.stature.unwrap();
        assert!((stature.value - 1.694).abs() < 0.02, "{stature:?}");
        let until = |until_ns| {
            let job = MeasuringJob { until_ns, ..job(recording.clone(), false) };
            context.measure(job).unwrap().measured.measures
        };
        // The embedded shopper stands for seven seconds and then turns: that counts once it was played, and not before.
        let front = until(0);
        assert_eq!(until(6_500_000_000), front);
        let shoulders = |measures: Measures| measures.shoulder_breadth.unwrap().sigma;
        assert!(shoulders(depth.measured.measures) < 0.9 * shoulders(front));
        let joints = context.measure(job(ShopperSource::Joints(session.joints.clone()), false)).unwrap();
        assert!(joints.count < depth.count && joints.basis(Girth::Waist) == MeasureBasis::Bones);
        let seated = context.measure(job(recording, true)).unwrap();
        assert!(seated.count < joints.count && seated.seated);
        assert_eq!(seated.missing, [BodyPart::Hip, BodyPart::Legs]);
        assert_eq!(seated.basis(Girth::Hip), MeasureBasis::Guessed);
        assert!(matches!(
            context.work(DressingJob::Measure(job(ShopperSource::Joints(Vec::new()), false))),
            Err(KioskError::Input(_))
        ));
    }

    #[test]
    fn two_sizes_of_one_garment_are_draped_apart_and_a_picture_is_a_code() {
        let ((context, tee), session) = (with_coarse_tee(), session());
        let track = session::filtered(&session);
        let pose = track[session::first_standing(&track)];
        let known = context.measure(job(ShopperSource::Joints(session.joints), false)).unwrap();
        let item = context.wardrobe.find(&tee).unwrap();
        let outfit = |size, colour| -> Outfit { [WornItem { item, size, colour }].into_iter().collect() };
        let client = Box::new(MeasuredVisitor { known, pose });
        let mut worker = DressingWorker::new(context);
        let mut done = |number, job| {
            worker.begin(number, job).unwrap();
            assert!(worker.is_busy());
            loop {
                match worker.poll().unwrap() {
                    Some((n, done)) => {
                        assert_eq!(n, number);
                        return done;
                    }
                    None => std::thread::sleep(std::time::Duration::from_millis(5)),
                }
            }
        };
        let JobResult::Two(two) = done(7, DressingJob::Two(client.clone(), Box::new([outfit(1, 0), outfit(4, 0)])))
        else {
            panic!()
        };
        let wide = |d: &DrapedFrame| d.1.garments[0].iter().map(|p| p.x.abs()).fold(0.0, f32::max);
        assert_ne!(wide(&two[0]), wide(&two[1]));
        let JobResult::Picture(offered) = done(8, DressingJob::Snap(client.clone(), outfit(2, 3), 0.0)) else {
            panic!()
        };
        assert!(offered.link.is_none());
        let code = offered.own.unwrap();
        assert!(code.side >= 101 && code.dark.len() == code.side * code.side, "{code:?}");
        let JobResult::Dressed(dressed) = done(9, DressingJob::Dress(client.clone(), outfit(2, 3))) else { panic!() };
        assert_eq!(dressed.request.garments, [RequestedGarment::named(tee, Some("36".to_owned()))]);
        let JobResult::Failed = done(10, DressingJob::Dress(client.clone(), outfit(99, 0))) else { panic!() };
        // Who has left gets nothing.
        worker.begin(11, DressingJob::Dress(client, outfit(2, 3))).unwrap();
        worker.forget();
        while worker.is_busy() {
            assert!(worker.poll().unwrap().is_none());
        }
    }
}
