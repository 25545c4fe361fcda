//! Development only.
use std::path::Path;
use std::time::Instant;
use toile_assets::sizes::Population;
use toile_sensors::source::{self, OpenOptions};
use toile_track::cloud;
use toile_track::fit::measuring::{self, TAKEN};
use toile_track::fit::Options;

fn main() {
    for pair in std::env::args().skip(1).collect::<Vec<_>>().chunks(2) { let file=&pair[0];
        let session = source::open(Path::new(&file), &OpenOptions{camera:Some(pair[1].clone().into())}).unwrap();
        let f = &session.depth[0];
        let scene = cloud::people(f);
        println!("{file} people {} notes {:?}", scene.people.len(), session.notes);
        let Some(p) = scene.people.first() else { continue };
        let (lo, hi) = p.points.iter().fold((9f32, -9f32), |a, q| (a.0.min(q.y), a.1.max(q.y)));
        println!("y {lo:.3} {hi:.3} cut {} cam {:?}", p.cut_below, f.camera_to_world.translation);
        let alone = p.alone(f);
        for clothed in [false, true] {
            let ground = if p.cut_below { None } else { Some(lo.min(0.3)) };
            let options = Options { clothed, ground, ..Options::MEASURING };
            let t = Instant::now();
            let Some(m) = measuring::measure(&vec![alone.clone(); 3], Population::Mixed, options) else { println!("lost"); continue };
            println!("clothed {clothed} woman {:.2} off {:.1} mm explained {:.3} {:.2} s", m.woman, m.off*1e3, m.explained, t.elapsed().as_secs_f64());
            for (k, e) in m.measures.iter().enumerate() { print!(" {} {:.0} ({:.0})", TAKEN[k].0, e.value*1e3, e.sigma*1e3); }
            println!();
        }
    }
}
