//! Development only.
use std::path::Path;
use toile_perf::ansur::Survey;
use toile_perf::measuring::{Options, Sensor, study};
use toile_track::fit::measuring::TAKEN;
fn main() {
    let a: Vec<String> = std::env::args().skip(1).collect();
    let sensor = if a[0] == "azure" { Sensor::Azure } else { Sensor::Kinect };
    let options = Options { people: a[1].parse().unwrap(), frames: a[2].parse().unwrap(), seed: a[3].parse().unwrap(), sensor };
    let dir = std::env::var("TOILE_DATA").unwrap() + "/anthropometry/ansur2/";
    let files: Vec<Survey> = std::fs::read_dir(&dir).unwrap().filter_map(|f| Survey::read(&f.unwrap().path()).ok()).filter(|s| s.sex().is_ok()).collect();
    let _ = Path::new("");
    let s = study(&files, &options, &|c| {
        print!("{:?} {:.2} w {:?}", c.sex, c.distance, c.woman);
        for (k, (n, ..)) in TAKEN.iter().enumerate() { if let Some(e) = c.fit[k] { print!(" {} {:+.0}", &n[..5], (e.value - c.truth[k]) * 1e3); } }
        println!();
    }).unwrap();
    println!("{} people {} lost {} sex {:.3}", s.sensor, s.people, s.lost, s.sex_right);
    for (w, t) in [("fit", &s.fit), ("sections", &s.sections)] {
        for r in t { println!("{w} {:<18} n {} bias {:+.1} [{:+.1} {:+.1}] lim {} mae {:.1} ({:.2} %) p95 {:.1} sigma {:.1} in2 {:.2} {}", r.measure, r.taken, r.bias_mm, r.interval_mm[0], r.interval_mm[1], r.limit_mm, r.mean_absolute_mm, r.mean_absolute_percent, r.p95_mm, r.sigma_mm, r.within_two_sigma, r.pass); }
    }
}
