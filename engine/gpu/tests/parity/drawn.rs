//! What is drawn: normals against their reference, and one device for both.

use std::sync::Arc;

use glam::{Vec3, Vec3A};
use toile_assets::scene::skirt::Stretch;
use toile_base::garment::Garment;
use toile_base::mesh::vertex_normals;
use toile_engine::cloth::Settings;
use toile_gpu::cloth::Offload;
use toile_gpu::cloth::cloth_device::ClothDevice;
use toile_gpu::device::{AdapterChoice, Device, DeviceNeeds, GpuError};

use super::scene::{REST, around, no_body, offload, skirt, swaying, worn};

/// What a component of a unit normal may be off by on a device that fuses products and sums or rounds roots coarsely. In a
/// crease the triangles around a particle add up to a hundredth of what they have each.
const BOUND: f32 = 1e-4;

/// A device that draws. None where this machine has no adapter, which CI does not excuse.
fn device(needs: DeviceNeeds) -> Option<Device> {
    match Device::open_to_draw(Device::instance(), None, &AdapterChoice::Fastest, needs) {
        Ok(device) => Some(device),
        Err(error @ GpuError::NoAdapter(_)) => {
            assert_ne!(std::env::var("CI").as_deref(), Ok("true"), "{error}");
            eprintln!("not run: {error}");
            None
        }
        Err(error) => panic!("{error}"),
    }
}

fn reference(positions: &[Vec3A], garment: &Garment) -> Vec<Vec3> {
    let positions: Vec<Vec3> = positions.iter().map(|p| Vec3::from(*p)).collect();
    let mut normals = vec![Vec3::ZERO; positions.len()];
    vertex_normals(&positions, &garment.triangles, &mut normals);
    normals
}

#[test]
fn normals_follow_the_reference_through_every_step() {
    let (one, other, settings, no_body) = (skirt(20, Stretch::Physical), worn("tee"), Settings::default(), no_body());
    let (garments, colliders) = ([&one, &other], [&no_body, &no_body]);
    let needs = Offload::needs(&garments, &colliders, &settings);
    let Some(device) = device(needs) else { return };
    let opened = Arc::new(ClothDevice::on(device.clone()).expect("every driver takes the kernels"));
    let mut gpu = Offload::drawn(&opened, &garments, &colliders, &settings).expect("the device has what they need");
    for n in 0..6 {
        if n > 0 {
            let palette = swaying(4 * n);
            gpu.step(&garments, &[around(&palette, &no_body, &settings); 2]).expect("the step is sent");
            gpu.finish().expect("it comes back");
        }
        for (k, garment) in garments.iter().enumerate() {
            let (got, expected) = (gpu.normals(k).expect("they are read"), reference(gpu.positions(k), garment));
            assert_eq!(got.len(), garment.particles());
            let off =
                got.iter().zip(&expected).map(|(a, b)| (Vec3::from(*a) - *b).abs().max_element()).fold(0.0, f32::max);
            let same = got.iter().zip(&expected).filter(|(a, b)| Vec3::from(**a) == **b).count();
            println!("{} after {n} steps: {same} of {} the same, {off} apart", garment.name, got.len());
            assert!(off <= BOUND, "{}: {off}", garment.name);
            assert!(same == got.len() || !device.is_software(), "{}: {off} on what fuses nothing", garment.name);
            assert!(expected.iter().all(|n| (n.length() - 1.0).abs() < 1e-5));
        }
    }
    let [of_one, of_other] = [0, 1].map(|k| gpu.source(k).expect("it is drawn").vertices());
    assert_eq!([of_one, of_other], [one.particles(), other.particles()]);
}

#[test]
fn who_draws_nothing_pays_for_no_normals() {
    let (garment, settings) = (skirt(12, Stretch::Inextensible), Settings::default());
    let Some(gpu) = offload(&[&garment], &settings) else { return };
    assert!(gpu.source(0).is_none());
    assert_eq!(gpu.normals(0), Ok(Vec::new()));
}

#[test]
fn a_fault_of_one_side_is_known_to_the_other() {
    let (garment, settings, no_body) = (skirt(12, Stretch::Inextensible), Settings::default(), no_body());
    let Some(device) = device(DeviceNeeds::default()) else { return };
    let opened = Arc::new(ClothDevice::on(device.clone()).expect("every driver takes the kernels"));
    let drawn = || Offload::drawn(&opened, &[&garment], &[&no_body], &settings);
    let mut gpu = drawn().expect("a small scene fits a device that was opened for none");
    device.lose();
    assert!(gpu.device().lost());
    let step = [around(&REST, &no_body, &settings)];
    assert!(matches!(gpu.step(&[&garment], &step), Err(GpuError::Lost(_))));
    assert!(matches!(drawn(), Err(GpuError::Lost(_))));
}

#[test]
fn a_scene_too_large_for_the_device_is_refused_with_the_limit() {
    let Some(device) = device(DeviceNeeds::default()) else { return };
    assert_eq!(device.takes(DeviceNeeds { largest: 1 << 20, workgroups: 8 }), Ok(()));
    let error = device.takes(DeviceNeeds { largest: 1 << 40, workgroups: 8 }).expect_err("it was opened for less");
    assert!(matches!(error, GpuError::TooSmall { .. }) && error.to_string().contains("buffer"), "{error}");
}
