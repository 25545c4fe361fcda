//! A body of own measures: who it is, what happens to measures that nobody has, and one dress in the sizes beside theirs.
//!
//! `cargo run --release -p toile-engine --example own_measures`

use std::error::Error;

use toile_assets::wardrobe;
use toile_base::body::{Body, Measures, Sex};
use toile_base::frame::Joints;
use toile_base::garment::Garment;
use toile_base::limits::STEP_HZ;
use toile_base::rig::Rig;
use toile_engine::body::JointFrames;
use toile_engine::cloth::{Settings, measure};
use toile_engine::frame::Frame;

/// By the definitions of EN 13402-1 (m).
const MEASURES: Measures =
    Measures { stature: 1.72, shoulder_breadth: 0.38, chest_girth: 0.92, waist_girth: 0.76, hip_girth: 1.0 };
/// The two sizes to compare.
const SIZES: [&str; 2] = ["38", "44"];

/// Mean tightness of a dress after a second at rest, -1 (loose) .. 1 (stretched as far as is comfortable).
fn worn(body: &Body, rig: &Rig, dress: Garment) -> Result<f32, Box<dyn Error>> {
    let rest = toile_base::skeleton::Pose::rest(&body.skeleton);
    let at = JointFrames::new(&body.skeleton, &rest).position;
    let joints = Joints::seen(0, at);
    let (mut frame, _reader) = Frame::new(body.clone(), rig, vec![dress], Settings::default())?;
    frame.dress(&joints);
    for _ in 0..STEP_HZ {
        frame.step(&joints);
    }
    let tight = measure::tightness(&frame.cloths()[0], &frame.garments()[0], frame.colliders());
    if tight.iter().any(|t| !t.is_finite()) {
        return Err("tightness is not finite".into());
    }
    Ok(tight.iter().sum::<f32>() / tight.len() as f32)
}

fn main() -> Result<(), Box<dyn Error>> {
    // The body is measured on its own mesh, by the tape: what was asked for and what was reached stand side by side.
    let body = toile_assets::body::build(Sex::Female, &MEASURES)?;
    let got = body.measures;
    let pairs = [
        ("stature", MEASURES.stature, got.stature),
        ("shoulder breadth", MEASURES.shoulder_breadth, got.shoulder_breadth),
        ("chest girth", MEASURES.chest_girth, got.chest_girth),
        ("waist girth", MEASURES.waist_girth, got.waist_girth),
        ("hip girth", MEASURES.hip_girth, got.hip_girth),
    ];
    for (name, asked, got) in pairs {
        println!("{name:<17} {:7.1} mm asked, {:7.1} mm built", asked * 1e3, got * 1e3);
        if (asked - got).abs() > 0.001 {
            return Err(format!("the {name} is off by more than a millimetre").into());
        }
    }

    // What no body has is refused with the cure, in words for a screen.
    let slip = Measures { stature: 172.0, ..MEASURES };
    match toile_assets::body::build(Sex::Female, &slip) {
        Ok(_) => return Err("a body of 172 m was built".into()),
        Err(refused) => println!("refused: {refused}"),
    }

    // Capsules that the cloth meets are fitted to this body, and the dress is cut for the size and laid on it.
    let rig = toile_assets::rig::fit(&body);
    println!(
        "collision body off the skin by {:.1} mm on average",
        toile_assets::rig::report(&rig, &body).whole.mean_mm
    );
    let style = wardrobe::style("sun-dress")?;
    let mut tight = [0.0; SIZES.len()];
    for (tight, size) in tight.iter_mut().zip(SIZES) {
        *tight = worn(&body, &rig, style.dress(size, &body)?)?;
        println!("sun dress in {size}: tightness {tight:+.2} on average");
    }
    if tight[0] <= tight[1] {
        return Err(format!("size {} sits no closer than {}", SIZES[0], SIZES[1]).into());
    }
    Ok(())
}
