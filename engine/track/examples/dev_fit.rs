//! Development only.
use std::time::Instant;
use toile_assets::body::{En, Sex};
use toile_sensors::source::synthetic::Rng;
use toile_assets::sizes::Population;
use toile_track::agreement::Subject;
use toile_track::fit::measuring::{self, TAKEN};
use toile_track::fit::{BodyFit, Options};
use toile_track::cloud;

fn main() {
    let mut args = std::env::args().skip(1).map(|a| a.parse::<u64>().unwrap());
    let (n, frames) = (args.next().unwrap_or(4), args.next().unwrap_or(5) as usize);
    let mut errors = vec![Vec::new(); TAKEN.len()];
    for (i, sex) in (0..n).flat_map(|i| [(i, Sex::Female), (i, Sex::Male)]) {
        let mut rng = Rng::new(900 + 2 * i + u64::from(sex == Sex::Male));
        let Ok(subject) = Subject::new(sex, &mut rng) else { println!("skip"); continue };
        let depth = subject.seen(frames, &mut rng);
        let alone: Vec<_> = depth.iter().map(|f| cloud::people(f).people[0].alone(f)).collect();
        let options = Options { clothed: false, ..Options::MEASURING };
        if i == 0 {
            let mut fit = BodyFit::new(sex, Options { clothed: false, ..Options::LIVE });
            for f in &alone {
                let t = Instant::now();
                let s = fit.push(f);
                println!("live {:.1} ms found {} explained {:.3} off {:.1} mm", t.elapsed().as_secs_f64()*1e3, s.found, s.explained, s.off*1e3);
            }
        }
        let t = Instant::now();
        let m = measuring::measure(&alone, Population::Mixed, options);
        let Some(m) = m else { println!("{sex:?} lost"); continue };
        let truth = subject.truth();
        println!("{sex:?} woman {:.2} off {:.1} explained {:.3} {:.2} s", m.woman, m.off*1e3, m.explained, t.elapsed().as_secs_f64());
        for (k, j) in [(0, 0), (1, 1), (6, 2), (8, 3), (9, 4)] {
            let e = m.measures[k];
            errors[k].push((e.value - truth[j], e.sigma));
            print!("  {} {:+.1} ({:.1})", TAKEN[k].0, (e.value - truth[j]) * 1e3, e.sigma * 1e3);
        }
        println!();
        let _ = En::Stature;
    }
    for (k, e) in errors.iter().enumerate().filter(|e| !e.1.is_empty()) {
        let n = e.len() as f32;
        let bias = e.iter().map(|x| x.0).sum::<f32>() / n * 1e3;
        let mae = e.iter().map(|x| x.0.abs()).sum::<f32>() / n * 1e3;
        println!("{} bias {bias:.1} mae {mae:.1}", TAKEN[k].0);
    }
}
