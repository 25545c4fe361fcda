use glam::*;
use toile_sensors::frame::*;
use toile_track::measure::*;
fn load(path: &str, w: u32, h: u32) -> Box<[u16]> {
    std::fs::read(path).unwrap().chunks(2).map(|b| u16::from_le_bytes([b[0], b[1]])).collect::<Vec<_>>().into()
}
fn main() {
    let root = std::env::var("TOILE_DATA").unwrap();
    let m = [
        [0.09780464454942962f32, 0.9387262642898904, 0.33928174907453956, -0.7618406335406821],
        [0.9900606869841373, -0.026848001589683985, -0.1686016614991829, 1.3404791579666983],
        [-0.1455159323880762, 0.3197736016629305, -0.9310039800746125, 2.0714992502659506],
    ];
    let a = Affine3A::from_mat3_translation(
        Mat3::from_cols(
            vec3(m[0][0], m[1][0], m[2][0]),
            vec3(m[0][1], m[1][1], m[2][1]),
            vec3(m[0][2], m[1][2], m[2][2]),
        ),
        vec3(m[0][3], m[1][3], m[2][3]),
    );
    let f = DepthFrame {
        time_ns: 0,
        intrinsics: Intrinsics { width: 1024, height: 512, fx: 1166.2634, fy: 1066.8362, cx: 459.756, cy: 241.4567 },
        camera_to_world: a,
        depth_mm: load(&format!("{root}/depth/depthkit-chae/derived/chae_depth_mm_1024x512.u16le"), 1024, 512),
    };
    show("chae", &[f]);
    for n in [1028894671u64, 1038901490, 1045879925, 1051883281, 1058893191, 1064898470, 1078881076, 1399145206] {
        let c = Affine3A::from_mat3_translation(
            Mat3::from_cols(vec3(-1., 0., 0.), vec3(0., -1., 0.), vec3(0., 0., -1.)),
            vec3(0., 1.2, 1.3),
        );
        // x: camera right is the person's left seen from the front mirrored: person faces +z, camera looks along -z, camera right = world -x?
        let c2 = Affine3A::from_mat3_translation(
            Mat3::from_cols(vec3(1., 0., 0.), vec3(0., -1., 0.), vec3(0., 0., -1.)),
            vec3(0., 1.2, 1.3),
        );
        let _ = c;
        let f = DepthFrame {
            time_ns: 0,
            intrinsics: Intrinsics { width: 640, height: 480, fx: 575.8, fy: 575.8, cx: 319.5, cy: 239.5 },
            camera_to_world: c2,
            depth_mm: load(&format!("{root}/depth/skeltrack/depth-data-{n}.u16le"), 640, 480),
        };
        show(&n.to_string(), &[f]);
    }
}
fn show(n: &str, f: &[DepthFrame]) {
    let s = toile_track::cloud::people(&f[0]);
    for p in &s.people {
        println!("  person {} px dist {:.2} cut {} pitch {:.4}", p.points.len(), p.distance, p.cut_below, p.pitch);
        let l = toile_track::anthropometry::levels(toile_assets::sizes::Population::Mixed);
        println!("  {:?}", toile_track::silhouette::read(p, &l, toile_assets::sizes::Population::Mixed));
    }
    let t = std::time::Instant::now();
    match measure(&[], f, &Hint::default()) {
        Ok(m) => {
            print!("{n} {} px people {} {:?}:", m.valid_pixels, m.people, t.elapsed());
            for (k, e) in m.measures.named() {
                match e {
                    Some(e) => print!(" {k} {:.3}±{:.3}", e.value, e.sigma),
                    None => print!(" {k} -"),
                }
            }
            println!(" {:?}", m.notes)
        }
        Err(e) => println!("{n} ERR {e}"),
    }
}
