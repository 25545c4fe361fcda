use super::*;
use super::mesh::{Cloth, Hold, Strip, Style};
use super::rig::{G, Rig, Scenery};
use glam::DVec3;

#[test]
#[ignore]
fn probe() {
    for style in Style::ALL {
        for rows in [12, 24] {
            for gamma in [0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0] {
                let strip = Strip { length: 0.3, width: 0.15, rows, columns: rows / 2, style, ends: [Hold::Clamped, Hold::Free] };
                let shape = strip.shape(|s, c| DVec3::new(s, 0.0, c));
                let w = 0.2 * G;
                let cloth = Cloth { bend: w * 0.027 / gamma, damping: 10.0, ..Cloth::PLAIN };
                let exact = exact::elastica::tip(gamma, 0.0).slope();
                print!("{:13} {rows} G {gamma:6} exact {exact:8.4}", style.name());
                for level in Level::ALL {
                    let mut rig = Rig::new(&shape, &cloth, level, &Scenery::default()).unwrap();
                    let t = std::time::Instant::now();
                    let rested = rig.rest(8.0);
                    let tip = rig.mean((0..rig.vertices()).filter(|v| (shape.cut[*v].y as f64 + 0.3).abs() < 1e-5));
                    let got = -tip.y / tip.x;
                    print!(" | {:9.4} {:+6.1}% n{} k{:.2} {:.0}us {} {:.1}s", got, 100.0 * (got / exact - 1.0), rig.cloth.substeps(), rig.cloth.bend_pace().least, rig.step_us(), if rested { "" } else { "MOVING" }, t.elapsed().as_secs_f64());
                }
                println!();
            }
        }
    }
}
