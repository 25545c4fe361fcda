use glam::*;
use std::time::Instant;
use toile_assets::bake::bake;
use toile_assets::scene::skirt::{self, *};
use toile_assets::skeleton::BONES;
use toile_engine::{cloth::*, colliders::*, lanes::Width};
fn m0(s: u64) -> f64 {
    s as f64
}
fn main() {
    let mut rowsum = [vec![(0f64, 0f64); 300], vec![(0f64, 0f64); 300]];
    let a: Vec<String> = std::env::args().collect();
    let n: usize = a[1].parse().unwrap();
    let motion = match &a[2][..] {
        "walk" => Motion::Walk,
        "fast" => Motion::Fast,
        _ => Motion::Settled,
    };
    let q: Quality = a[3].parse().unwrap();
    let sub: u32 = a[4].parse().unwrap();
    let lanes: usize = a[5].parse().unwrap();
    let irregular = a.get(6).is_some_and(|s| s == "irr");
    let steps: u64 = a.get(7).map_or(600, |s| s.parse().unwrap());
    let shape = if irregular { skirt::irregular(n, 1) } else { skirt::shape(n) };
    let fabric = skirt::fabric(&shape, Stretch::Inextensible);
    let mut fabric = fabric;
    if let Ok(f) = std::env::var("MU") {
        fabric.friction = f.parse().unwrap();
    }
    if let Ok(f) = std::env::var("OFF") {
        fabric.contact_offset_mm = f.parse().unwrap();
    }
    if let Ok(f) = std::env::var("BEND") {
        let k: f32 = f.parse().unwrap();
        fabric.bend_warp_un_m *= k;
        fabric.bend_weft_un_m *= k;
    }
    if std::env::var("NOWEFT").is_ok() {
        fabric.bend_weft_un_m = 0.0;
    }
    if std::env::var("NOWARP").is_ok() {
        fabric.bend_warp_un_m = 0.0;
    }
    if let Ok(f) = std::env::var("SHEAR") {
        fabric.shear_n_m = f.parse().unwrap();
    }
    let g = bake("skirt", "", &shape, &fabric).unwrap();
    let l = &g.layout;
    println!(
        "particles {} shear {} ({} runs {} loose {} sets) weft {} ({} runs {} loose {} sets) bundles {} crossing {} hoops {} bends {} ({} runs {} loose) bytes {} substeps {}",
        g.start.len(),
        l.shear.rest.len(),
        l.shear.tuples.runs.len(),
        l.shear.tuples.loose.len(),
        l.shear.tuples.sets.len(),
        l.weft.rest.len(),
        l.weft.tuples.runs.len(),
        l.weft.tuples.loose.len(),
        l.weft.tuples.sets.len(),
        l.fibers.bundles.len(),
        l.crossing.lists.len(),
        l.hoops.lists.len(),
        l.bends.tuples.count,
        l.bends.tuples.runs.len(),
        l.bends.tuples.loose.len(),
        l.bytes(),
        g.substeps
    );
    let rest: [RestSphere; 16] =
        skirt::spheres(motion, 0.0).map(|s| RestSphere { bone: 0, centre: s.truncate(), radius: s.w });
    let mut col = Colliders::new(&rest, &CAPSULES, false).unwrap();
    let mut cloth = Cloth::new(&g, &col);
    let set = Settings {
        quality: q,
        substeps: (sub > 0).then_some(sub),
        width: Width::of(lanes).unwrap(),
        timed: a.iter().any(|s| s == "timed"),
        ..Settings::default()
    };
    let mut us = vec![];
    let (mut mean, mut p99, mut max, mut pen) = (0.0, 0.0, 0f32, 0f32);
    let mut st = vec![vec![]; 6];
    for k in 0..240 + steps {
        let t = (k + 1) as f64 / 120.0;
        col.place_spheres(&skirt::spheres(motion, t));
        let root: Affine3A = skirt::root(motion, t);
        let pal = [root; BONES];
        let b = Instant::now();
        cloth.step(&g, &Step { palette: &pal, colliders: &col, settings: &set });
        let e = b.elapsed().as_nanos() as f64 / 1e3;
        if k >= 240 {
            us.push(e);
            for i in 0..6 {
                st[i].push(cloth.stage_ns[i]);
            }
            for ([i, j], r) in g.strain_edges.iter() {
                let (vi, vj) = (g.source[*i as usize] as usize, g.source[*j as usize] as usize);
                let e = (cloth.positions[*i as usize].distance(cloth.positions[*j as usize]) / r - 1.0) as f64;
                let k = if vi / n == vj / n { 0 } else { 1 };
                let row = (vi / n).max(vj / n);
                rowsum[k][row].0 += e.abs();
                if e.abs() > rowsum[k][row].1 {
                    rowsum[k][row].1 = e.abs();
                }
            }
            let s = measure::strain(&mut cloth, &g);
            mean += s.mean as f64;
            if a.iter().any(|s| s == "series") && k >= 480 && k < 600 {
                print!("{:.2}/{:.1} ", s.mean * 100., s.p99 * 100.);
            }
            p99 += s.p99 as f64;
            max = max.max(s.max);
            pen = pen.max(measure::penetration(&cloth, &g, &col));
        }
    }
    if a.iter().any(|s| s == "diag") {
        for (name, arr) in [("weft", &rowsum[0]), ("warp", &rowsum[1])] {
            print!("{name} ");
            for r in 0..n {
                print!("{:.2} ", arr[r].0 / m0(steps) / n as f64 * 100.);
            }
            println!();
            print!("{name} max ");
            for r in 0..n {
                print!("{:.0} ", arr[r].1 * 100.);
            }
            println!();
        }
    }
    us.sort_by(f64::total_cmp);
    let m = steps as f64;
    println!(
        "p50 {:.1} p99 {:.1} | strain {:.3} / {:.2} max {:.1} % | pen {:.2} mm ke {:.3} mJ | stages {:?} bytes {} sub {} {:?}",
        us[us.len() / 2],
        us[us.len() * 99 / 100],
        mean / m * 100.,
        p99 / m * 100.,
        max * 100.,
        pen * 1e3,
        cloth.kinetic_energy(&g) * 1e3,
        st.iter_mut()
            .map(|s| {
                s.sort();
                s[s.len() / 2] / 100
            })
            .collect::<Vec<_>>(),
        cloth.bytes(),
        cloth.substeps(),
        cloth.events
    );
    println!("{:?} {:?}", cloth.bend_pace(), cloth.contact_tally());
}
