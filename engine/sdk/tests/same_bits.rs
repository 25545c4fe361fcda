//! This crate gives the same bits as the assembly below it.

use crate::{coarse_tee, first_second};
use toile_assets::scene_file::{SceneFile, SceneSource};
use toile_assets::sizes::Girth;
use toile_engine::cloth::Settings;
use toile_engine::world::World;
use toile_fitting::dress::garment_source::GarmentSource;
use toile_fitting::dress::measured::{self, ShopperFacts};
use toile_fitting::dress::player::Player;
use toile_fitting::dress::{garment_source, session};
use toile_fitting::scene::Runner;
use toile_sdk::glam::Vec3;
use toile_sdk::{Body, DressOptions, Garment, Recording, Scene, Sex, TryOnOptions, recommend, try_on};
use toile_sensors::source::Session;

/// As `toile try-on` goes about it.
#[test]
fn a_try_on_is_the_programs_own() {
    let recording = first_second();
    let (joints, depth) = (recording.joints().to_vec(), recording.depth().to_vec());
    let session = Session { depth, ..session::of_joints(joints) };
    let measured = measured::measure(&session, ShopperFacts::default()).unwrap();
    let garments = [coarse_tee()];
    let source = GarmentSource::find(garments[0].name()).unwrap();
    let sex = measured.sex(garment_source::population([&source]).unwrap());
    let (body, _) = measured::build_body(sex, &measured.best, Some(sex).into()).unwrap();
    let worn = source.put_on(None, &measured.best, &body, &[]).unwrap();
    let fit = worn.fit.clone().unwrap();
    let rig = toile_assets::rig::fit(&body);
    let (mut world, mut reader) = World::new(body, &rig, worn.garments, Settings::default()).unwrap();
    let track = session::standing(&session).unwrap();
    world.dress(&track[0]);
    let mut player = Player::new(&track);
    for _ in 0..player.steps() {
        world.step(&player.step());
    }

    let mut tried = try_on(&recording, &garments, &TryOnOptions::default()).unwrap();
    assert_eq!((tried.scene.steps(), tried.scene.state_hash()), (world.tick(), world.state_hash()));
    let own = tried.fits[0].as_ref().unwrap();
    assert_eq!((&own.size, own.probability, &own.verdict), (&fit.size, fit.probability, &fit.verdict));
    let given: Vec<(f64, f64, &str)> = own.zones.iter().map(|z| (z.ease_mm, z.sigma_mm, z.verdict)).collect();
    let wanted = fit.zones.iter().map(|z| (f64::from(z.ease) * 1e3, f64::from(z.sigma) * 1e3, z.verdict.name()));
    assert_eq!(given, wanted.collect::<Vec<_>>());

    // What is drawn is what was last published, in the order of the draft.
    let shown = reader.latest();
    let positions = tried.scene.positions(0).unwrap();
    let source = &world.garments()[0].source;
    assert!(source.iter().zip(&shown.garments[0]).all(|(vertex, p)| positions[*vertex as usize] == *p));
    let (skin, normals) = tried.scene.body().unwrap();
    assert!((0..skin.len()).all(|v| skin[v] == shown.skin.position(v) && normals[v] == shown.skin.normal(v)));
    assert_eq!(tried.scene.snapshot().body, skin);
}

#[test]
fn one_worker_gives_the_bits_of_two() {
    let body = Body::average(Sex::Female).unwrap();
    let garments = [coarse_tee()];
    let hash = |workers| {
        let mut scene =
            Scene::dress_with(&body, &garments, &DressOptions { workers, ..DressOptions::default() }).unwrap();
        scene.step_many(30);
        scene.state_hash()
    };
    assert_eq!(hash(1), hash(2));
}

#[test]
fn a_scene_file_runs_as_the_program_runs_it() {
    let text = "duration = 1\nstep_hz = 60\ngravity = [0, -5, 0]\n[wind]\nvelocity = [1, 0, 2]\n[settings]\nquality = \"fine\"\n\
                [garment]\ngrid = { rows = 12, columns = 10, width = 0.5, height = 0.6 }\nposition = [0, 1, 0]\nfabric = \"linen-twill\"\n\
                pin = { vertices = [0, 9] }\n[colliders]\nsphere = { centre = [0, 0.6, 0.1], radius = 0.15 }\nplane = {}\n";
    let mut runner = Runner::new(SceneFile::parse("a.toml", text, SceneSource::Inside(&[])).unwrap()).unwrap();
    let mut scene = Scene::parse("a.toml", text, &[]).unwrap();
    assert_eq!((scene.time_step(), scene.duration_steps()), (1.0 / 60.0, Some(60)));
    for _ in 0..60 {
        runner.step();
        scene.step();
    }
    assert_eq!((scene.state_hash(), scene.time()), (runner.state_hash(), runner.time()));
    assert!(scene.positions(0).unwrap().into_iter().eq(runner.positions(0)));
    let stats = scene.stats(0).unwrap();
    assert!(f64::from(stats.penetration_mm) <= runner.figures().penetration_mm && stats.strain_mean > 0.0);
}

#[test]
fn a_recommendation_is_for_the_body_as_it_is() {
    let mm = [("stature", 1680.0), ("shoulder_breadth", 370.0), ("chest", 960.0), ("waist", 800.0), ("hip", 1040.0)];
    let body = Body::from_measures_mm(Sex::Female, &mm).unwrap();
    let direct = toile_base::body::Measures {
        stature: 1.68,
        shoulder_breadth: 0.37,
        chest_girth: 0.96,
        waist_girth: 0.8,
        hip_girth: 1.04,
    };
    let direct = toile_assets::body::build(Sex::Female, &direct).unwrap();
    assert_eq!(body.positions(), direct.mesh.positions, "the same body, to the bit");
    let fit = recommend(&body, &Garment::open("strap-dress").unwrap()).unwrap();
    let sizes = toile_assets::drafting::package("strap-dress").unwrap().sizes.unwrap();
    let finished = sizes.girths.iter().find(|girths| girths.size == fit.size).unwrap();
    for zone in &fit.zones {
        let of = Girth::ALL.into_iter().find(|girth| girth.name() == zone.zone).unwrap();
        let ease = finished.at(of).unwrap() * 1e3 - body.measure_mm(zone.zone).unwrap();
        assert!((ease - zone.ease_mm).abs() < 0.01, "{}: {ease} and {}", zone.zone, zone.ease_mm);
        assert!((zone.sigma_mm - 5.0).abs() < 1.0, "by tape: {}", zone.sigma_mm);
    }
}

#[test]
fn what_a_thread_makes_another_may_have() {
    fn send<T: Send>() {}
    fn sync<T: Sync>() {}
    send::<Scene>();
    send::<toile_sdk::TryOn>();
    send::<Body>();
    sync::<Body>();
    send::<Garment>();
    sync::<Garment>();
    send::<Recording>();
    sync::<Recording>();
    send::<toile_sdk::Measured>();
    send::<toile_sdk::Picture>();
    send::<toile_sdk::Error>();
    let body = Body::average(Sex::Female).unwrap();
    let made = std::thread::spawn(move || Scene::dress(&body, &[coarse_tee()]).unwrap());
    let mut scene = made.join().unwrap();
    scene.step();
    assert!(scene.positions(0).unwrap().iter().all(|p: &Vec3| p.is_finite()));
}
