use super::*;

#[test]
#[ignore]
fn probe() {
    let only = std::env::var("CASE").unwrap_or_default();
    let levels: Vec<Level> = if std::env::var("ALL").is_ok() { Level::ALL.to_vec() } else { vec![Level::GATED, Level::Converged] };
    for case in cases::all().into_iter().filter(|c| c.name.contains(&only)) {
        let t = std::time::Instant::now();
        for r in case.rows(&levels).unwrap() {
            println!("{:11} {:24} {:12} {:3} {:9} n{:3} {:10.5} {:10.5} {:+8.2}% solver {:+8.2} {:7.1}us {:?} {}", r.name, r.parameter, r.mesh, r.resolution, r.quality, r.substeps, r.expected, r.got, r.error_percent, r.solver_error.unwrap_or(0.0), r.step_us, r.pass, r.cause.unwrap_or_default());
        }
        println!("   {:.2} s", t.elapsed().as_secs_f64());
    }
}
