//! Skinning on a graphics device beside the processor's, with the error of both from the same palettes.

use std::hint::black_box;
use std::time::Instant;

use glam::Affine3A;
use serde::Serialize;
use toile_assets::put_line;
use toile_base::numeric::statistics::median;
use toile_base::skeleton::BONES;
use toile_engine::lanes::Width;
use toile_engine::skin::{Blend, SkinningJob};
use toile_engine::workers::WorkerPool;
use toile_fitting::scene::reference_time;
use toile_fitting::scene::surface::SkinnedSurface;
use toile_fitting::timing;
use toile_gpu::graphics::{DeviceSkins, Graphics};

use super::{SkinningError, SkinningOptions, SkinningSubject, oracle, skinned, subject};
use crate::backend::Adapter;

/// Vertices of the rows with one surface: those of the reference loop, then up to the number of a crowd.
const SIZES: [usize; 4] = [reference_time::VERTICES, 65_536, 262_144, 1_048_576];

/// Numbers of bodies in the rows with the shopper's own.
const BODIES: [usize; 4] = [1, 4, 16, 64];

/// Steps that are sent one behind the other before the device is waited for.
const QUEUED: usize = 64;

/// Dispatches of which the device's clock gives the mean.
const CLOCKED: u32 = 64;

/// One surface, or bodies of one, by one blend.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DeviceRow {
    /// The skin that was measured.
    pub subject: SkinningSubject,
    /// Vertices of a body.
    pub verts: usize,
    /// Number of bodies.
    pub bodies: usize,
    /// `linear` or `dual`.
    pub blend: &'static str,
    /// The processor, in the order of the mesh, by one thread and by two (us, median).
    pub cpu_us: [f64; 2],
    /// From the call until positions and normals are back in the processor's memory (us, median).
    pub back_us: f64,
    /// A step whose result stays on the device, of many that are sent one behind the other (us, mean).
    pub kept_us: f64,
    /// One dispatch by the device's own clock (us); none where it has no such clock.
    pub device_us: Option<f64>,
    /// Bytes that a dispatch has to move at least: each number of a vertex read or written once.
    pub bytes: u64,
    /// Largest distance of a position from the f64 oracle (m): the processor, the device.
    pub max_error_m: [f64; 2],
    /// Largest angle of a normal to the oracle's (rad): the processor, the device.
    pub max_normal_error_rad: [f64; 2],
    /// Largest distance of a position of the device from the processor's (m).
    pub apart_m: f64,
}

/// Skinning by the processor and by a device.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DeviceSkinning {
    /// The graphics adapter that skinned.
    pub adapter: Adapter,
    /// Two rows a case: linear blending, dual quaternions.
    pub rows: Vec<DeviceRow>,
}

/// Measures what the options ask for, or every row of the table; `progress` is given what is being run.
///
/// # Errors
/// [`SkinningError::Device`] where there is no device, or it refuses; else as [`super::measure`].
pub fn run(
    options: &SkinningOptions,
    table: bool,
    progress: &mut dyn FnMut(&str),
) -> Result<DeviceSkinning, SkinningError> {
    let width = options.lanes.unwrap_or_else(Width::widest);
    if !width.available() {
        return Err(SkinningError::NoSuchLanes(width));
    }
    let graphics = Graphics::open().map_err(SkinningError::Device)?;
    let body = SkinningOptions { subject: SkinningSubject::Body, verts: None, ..*options };
    let four = |verts| SkinningOptions { subject: SkinningSubject::Four, verts: Some(verts), ..*options };
    let cases: Vec<(SkinningOptions, usize)> = if table {
        SIZES.into_iter().map(|verts| (four(verts), 1)).chain(BODIES.into_iter().map(|n| (body, n))).collect()
    } else {
        vec![(*options, 1)]
    };
    let mut rows = Vec::new();
    for (options, bodies) in cases {
        let surface = subject(&options)?;
        progress(&format!("{bodies} x {} vertices, {:?}", surface.positions.len(), options.subject));
        let mut job = SkinningJob::new(&surface.positions, &surface.normals, &surface.weights)?;
        job.width = width;
        for blend in Blend::ALL {
            rows.push(row(&graphics, &SkinnedCase { job: &job, surface: &surface, bodies, options: &options }, blend)?);
        }
    }
    Ok(DeviceSkinning { adapter: Adapter::of(graphics.adapter()), rows })
}

/// What is skinned in a row.
struct SkinnedCase<'a> {
    job: &'a SkinningJob,
    surface: &'a SkinnedSurface,
    bodies: usize,
    options: &'a SkinningOptions,
}

fn row(graphics: &Graphics, case: &SkinnedCase<'_>, blend: Blend) -> Result<DeviceRow, SkinningError> {
    let SkinnedCase { job, surface, bodies, options } = *case;
    let mut skins = DeviceSkins::lay(graphics, &vec![job; bodies]).map_err(SkinningError::Device)?;
    let palettes = vec![&surface.palette; bodies];
    let mut failed = None;
    let back_us = timing::median_us(|| {
        if let Err(reason) = skins.step(blend, &palettes, true).and_then(|()| skins.finish()) {
            failed.get_or_insert(reason);
        }
    });
    let kept_us = kept_us(&mut skins, blend, &palettes).map_err(SkinningError::Device)?;
    let device_us = skins.device_ns(blend, CLOCKED).map_err(SkinningError::Device)?.map(|ns| ns * 1e-3);
    if let Some(reason) = failed {
        return Err(SkinningError::Device(reason));
    }
    let posed = skinned(job, surface, blend);
    let cpu = oracle::compare(surface, blend, &posed);
    // The last body: what came before it must not have moved it.
    let (positions, normals) = (skins.positions(bodies - 1), skins.normals(bodies - 1));
    let device = oracle::compare_each(surface, blend, posed.vertices(), |v| [positions[v], normals[v]]);
    let apart = positions.iter().enumerate().map(|(v, p)| p.distance(posed.position(v)));
    Ok(DeviceRow {
        subject: options.subject,
        verts: job.vertices(),
        bodies,
        blend: blend.name(),
        cpu_us: [cpu_us(case, blend, 1)?, cpu_us(case, blend, 2)?],
        back_us,
        kept_us,
        device_us,
        bytes: bodies as u64 * least_bytes(job),
        max_error_m: [cpu.position_m, device.position_m],
        max_normal_error_rad: [cpu.normal_rad, device.normal_rad],
        apart_m: f64::from(apart.fold(0.0, f32::max)),
    })
}

/// A step of many whose results stay on the device (us).
fn kept_us(skins: &mut DeviceSkins, blend: Blend, palettes: &[&[Affine3A; BONES]]) -> Result<f64, String> {
    let mut rounds = Vec::new();
    for _ in 0..5 {
        let begun = Instant::now();
        for _ in 0..QUEUED {
            skins.step(blend, palettes, false)?;
        }
        skins.finish()?;
        rounds.push(begun.elapsed().as_secs_f64() * 1e6 / QUEUED as f64);
    }
    Ok(median(&mut rounds).unwrap_or(0.0))
}

/// All bodies of a case by the processor (us).
fn cpu_us(case: &SkinnedCase<'_>, blend: Blend, threads: usize) -> Result<f64, SkinningError> {
    let mut pool = WorkerPool::new(threads)?;
    let mut posed: Vec<_> = (0..case.bodies).map(|_| case.job.posed_mesh()).collect();
    Ok(timing::median_us(|| {
        for posed in &mut posed {
            case.job.run_mesh_with(&mut pool, blend, black_box(&case.surface.palette), posed);
        }
        black_box(&posed);
    }))
}

/// Least memory traffic of a surface (bytes): each vertex reads itself, its run and a weight for each bone but the first, and writes
/// place and normal.
fn least_bytes(job: &SkinningJob) -> u64 {
    const VERTEX: usize = 32;
    const PLACE_AND_NORMAL: usize = 32;
    let padding = job.padding();
    (padding.vertices * (VERTEX + PLACE_AND_NORMAL) + (padding.influences - padding.vertices) * 4) as u64
}

impl DeviceSkinning {
    /// The rows as a table in Markdown.
    pub fn markdown(&self) -> String {
        let mut text = String::from(
            "| bodies x vertices | blend | one thread us | two threads us | device us: until back, kept there, its own clock \
             | MB at least, GB/s | error um: processor, device | apart um |\n|---|---|---|---|---|---|---|---|\n",
        );
        for row in &self.rows {
            let own = row.device_us.map_or("-".into(), |us| format!("{us:.1}"));
            let rate = row.device_us.map_or("-".into(), |us| format!("{:.0}", row.bytes as f64 * 1e-3 / us));
            let influences =
                if row.subject == SkinningSubject::Four { "four influences each" } else { "the body's own" };
            put_line!(
                text,
                "| {} x {}, {influences} | {} | {:.1} | {:.1} | {:.1}, {:.1}, {own} | {:.2}, {rate} | {:.3}, {:.3} | {:.3} |",
                row.bodies,
                row.verts,
                row.blend,
                row.cpu_us[0],
                row.cpu_us[1],
                row.back_us,
                row.kept_us,
                row.bytes as f64 * 1e-6,
                row.max_error_m[0] * 1e6,
                row.max_error_m[1] * 1e6,
                row.apart_m * 1e6,
            );
        }
        let a = &self.adapter;
        put_line!(text, "\nDevice: {} ({}, {}).", a.name, a.kind, a.driver);
        if a.kind == "software" {
            put_line!(text, "It computes on the processor: its times say nothing about a graphics card.");
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_device_skins_as_exactly_as_the_processor_or_says_why_it_does_not() {
        let options = SkinningOptions { verts: Some(1_001), ..SkinningOptions::default() };
        let found = match run(&options, false, &mut |_| {}) {
            Ok(found) => found,
            Err(SkinningError::Device(reason)) => {
                // Without a driver the library's own tests fail in CI already; what is built in and there has to skin.
                assert!(!toile_gpu::BUILT_IN || toile_gpu::adapters().is_empty(), "{reason}");
                assert!(reason.contains("build it with") || reason.contains("install"), "{reason}");
                return;
            }
            Err(other) => panic!("{other}"),
        };
        assert_eq!(found.rows.len(), 2);
        for row in &found.rows {
            assert_eq!((row.verts, row.bodies), (1_001, 1));
            assert!(row.back_us > 0.0 && row.kept_us > 0.0 && row.cpu_us.iter().all(|us| *us > 0.0));
            assert!(row.max_error_m.iter().all(|m| (1e-9..2e-6).contains(m)), "{:?} m", row.max_error_m);
            assert!(row.max_normal_error_rad.iter().all(|rad| *rad < 1e-5), "{:?} rad", row.max_normal_error_rad);
            assert!(row.apart_m < 4e-6, "{} m", row.apart_m);
        }
        assert!(found.markdown().contains("| 1 x 1001, four influences each | dual |"));
    }
}
