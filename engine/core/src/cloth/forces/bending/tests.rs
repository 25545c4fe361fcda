//! Bending against its stencils in f64, against itself at every width, and against what must stay.

use glam::{DVec3, Vec3};
use toile_assets::scene::skirt::{self, Stretch};
use toile_bake::bake;
use toile_base::garment::Garment;
use toile_base::garment::layout::OWNERS;

use super::*;
use crate::cloth::links::records::FillRecords;
use crate::cloth::state::State;
use crate::lanes::{RECORD, Store, Width};

/// A grid, whose rows are strips, and meshes whose rows are blocks.
fn garments() -> Vec<Garment> {
    let shapes = [skirt::shape(32), skirt::irregular(23, 2), skirt::irregular(12, 5)];
    let baked = |shape| bake("skirt", "one", &shape, &skirt::fabric(&shape, Stretch::Inextensible)).unwrap();
    shapes.into_iter().map(baked).collect()
}

/// Where the particles are: shaken out of their rest.
fn shaken(garment: &Garment) -> Vec<Vec3> {
    let by = |i: usize| 0.01 * Vec3::new((1.3 * i as f32).sin(), (0.7 * i as f32).cos(), (2.1 * i as f32).sin());
    garment.start.iter().enumerate().map(|(i, p)| *p + by(i)).collect()
}

/// What a matrix makes of them in `by` seconds.
fn pushed(width: Width, garment: &Garment, matrix: &BendingMatrix, places: &[Vec3], by: f32) -> Vec<Vec3> {
    let mut state = State::new(places, &garment.inverse_mass);
    let mut records = Store::zeros(RECORD * places.len());
    let (c, records) = (state.columns(), records.column());
    for owner in 0..OWNERS {
        width.run(FillRecords { from: c.x, w: c.w, spans: &garment.layout().spans[owner], records });
    }
    for owner in 0..OWNERS {
        width.run(Bend { matrix, owner, from: c.x, records, to: c.v, by });
    }
    (0..places.len()).map(|i| Vec3::from_array(state.velocities().map(|a| a[i]))).collect()
}

/// The same from the stencils, in f64; `share` of the stiffness of what bends these particles counts.
fn exact(garment: &Garment, places: &[Vec3], by: f64, share: impl Fn(&[u32]) -> f64) -> Vec<DVec3> {
    let mut out = vec![DVec3::ZERO; places.len()];
    garment.layout().for_each_bend(|particles, c| {
        let d = |k: usize| places[particles[k] as usize].as_dvec3() * f64::from(c(k));
        let d: DVec3 = (0..particles.len()).map(d).sum();
        for (k, &i) in particles.iter().enumerate() {
            let weight = f64::from(garment.inverse_mass[i as usize]);
            out[i as usize] -= d * (by * weight * share(particles) * f64::from(c(k)));
        }
    });
    out
}

fn compare(garment: &Garment, got: &[Vec3], expected: &[DVec3]) {
    let size = expected.iter().map(|v| v.length()).fold(0.0, f64::max);
    assert!(size > 0.0);
    for (i, (got, expected)) in got.iter().zip(expected).enumerate() {
        let off = (got.as_dvec3() - expected).length();
        // Rows that are alike to 1e-5 have the values of the first.
        assert!(off < 3e-5 * size, "particle {i} of {}: {got} for {expected}", garment.start.len());
    }
}

#[test]
fn the_matrix_is_its_stencils_and_the_same_bits_at_every_width() {
    for garment in garments() {
        let (matrix, places) = (BendingMatrix::new(&garment), shaken(&garment));
        let plain = pushed(Width::One, &garment, &matrix, &places, 0.002);
        compare(&garment, &plain, &exact(&garment, &places, 0.002, |_| 1.0));
        for width in Width::ALL.into_iter().filter(|w| w.available()) {
            assert_eq!(pushed(width, &garment, &matrix, &places, 0.002), plain, "{width} lanes");
        }
    }
}

#[test]
fn grids_have_strips_and_other_meshes_blocks_and_no_row_is_written_twice() {
    let (mut strips, mut blocks) = (0, 0);
    for garment in garments() {
        let matrix = BendingMatrix::new(&garment);
        (strips, blocks) = (strips + matrix.strips.len(), blocks + matrix.blocks.len());
        let mut seen = vec![false; garment.start.len()];
        matrix.for_each_row(|i, entries| {
            assert!(!std::mem::replace(&mut seen[i as usize], true), "row {i} twice");
            assert!(garment.inverse_mass[i as usize] > 0.0, "row {i} is of a particle that does not move");
            assert_eq!(entries.filter(|(j, _)| *j == i).count(), 0);
        });
        // Each owner's rows are its own.
        for owner in 0..OWNERS {
            let own = |i: u32| usize::from(garment.layout().owner[i as usize]) == owner;
            let [strips, blocks] = [&matrix.owned_strips[owner], &matrix.owned_blocks[owner]].map(|r| r.clone());
            assert!(matrix.strips[strips.start as usize..strips.end as usize].iter().all(|s| own(s.first)));
            assert!(
                blocks.flat_map(|b| b as usize * MOST..(b as usize + 1) * MOST).all(|k| own(matrix.rows.record(k)))
            );
        }
    }
    assert!(strips > 10 && blocks > 10, "{strips} strips, {blocks} blocks");
}

#[test]
fn moved_or_turned_as_a_whole_it_bends_no_more_and_momentum_stays() {
    for garment in garments() {
        let matrix = BendingMatrix::new(&garment);
        let places: Vec<Vec3> = garment.start.iter().map(|p| *p + Vec3::new(3.0, -2.0, 5.0)).collect();
        let (here, there) = (
            pushed(Width::widest(), &garment, &matrix, &garment.start, 0.002),
            pushed(Width::widest(), &garment, &matrix, &places, 0.002),
        );
        let size = here.iter().map(|v| v.length()).fold(0.0, f32::max);
        assert!(here.iter().zip(&there).all(|(a, b)| a.distance(*b) < 1e-3 * size + 1e-3));
        // Pushes on all particles, those of fixed ones from the stencils, add up to nothing.
        let shaken = shaken(&garment);
        let got = pushed(Width::widest(), &garment, &matrix, &shaken, 0.002);
        let mut sum = DVec3::ZERO;
        let mut all = 0.0;
        garment.layout().for_each_bend(|particles, c| {
            let d: DVec3 =
                (0..particles.len()).map(|k| shaken[particles[k] as usize].as_dvec3() * f64::from(c(k))).sum();
            let fixed = (0..particles.len()).filter(|k| garment.inverse_mass[particles[*k] as usize] <= 0.0);
            sum -= fixed.map(|k| d * (0.002 * f64::from(c(k)))).sum::<DVec3>();
        });
        for (v, w) in got.iter().zip(&garment.inverse_mass).filter(|(_, w)| **w > 0.0) {
            sum += v.as_dvec3() / f64::from(*w);
            all += v.as_dvec3().length() / f64::from(*w);
        }
        assert!(sum.length() < 1e-5 * all, "{sum} of {all}");
    }
}

#[test]
fn what_is_too_stiff_is_weakened_and_whole_again_whatever_came_between() {
    for garment in garments() {
        let mut matrix = BendingMatrix::new(&garment);
        let (whole, places) = (matrix.clone(), shaken(&garment));
        let mut load = vec![0.0; garment.start.len()];
        add_load(garment.layout(), &garment.inverse_mass, 0.002, &mut load);
        let mut sorted = load.clone();
        sorted.sort_by(f32::total_cmp);
        let limit = sorted[sorted.len() * 9 / 10];
        let least = matrix.fill(&garment, &load, limit);
        let share = |particles: &[u32]| {
            let most = particles.iter().map(|i| load[*i as usize]).fold(0.0, f32::max);
            if most > limit { limit / most } else { 1.0 }
        };
        assert!((least - limit / sorted[sorted.len() - 1]).abs() < 1e-6 && (0.0..1.0).contains(&least), "{least}");
        if matrix.strips.iter().all(|s| !s.alike) {
            let expected = exact(&garment, &places, 0.002, |p| f64::from(share(p)));
            compare(&garment, &pushed(Width::One, &garment, &matrix, &places, 0.002), &expected);
        }
        // No particle is left with more than the limit.
        let mut left = vec![0.0f32; load.len()];
        garment.layout().for_each_bend(|particles, c| {
            let sum: f32 = (0..particles.len()).map(|k| c(k).abs()).sum();
            for (k, &i) in particles.iter().enumerate() {
                left[i as usize] += 4e-6 * garment.inverse_mass[i as usize] * c(k).abs() * sum * share(particles);
            }
        });
        assert!(left.iter().all(|l| *l <= limit * 1.0001));
        let again = matrix.fill(&garment, &load, f32::INFINITY);
        assert_eq!((again, &matrix.values), (1.0, &whole.values));
    }
}
