//! Your own mesh as a scene: a flag of your own triangles held at two corners, then the same in wind, by a scene file in memory.
//!
//! `cargo run --release -p toile-sdk --example own_mesh`

use std::fmt::Write;

use toile_sdk::glam::Vec3;
use toile_sdk::{Error, Scene};

const ROWS: u32 = 24;
const COLUMNS: u32 = 32;

fn main() -> Result<(), Error> {
    let at = |row: u32, column: u32| Vec3::new(0.02 * column as f32, 2.0 - 0.02 * row as f32, 0.0);
    let positions: Vec<Vec3> = (0..ROWS).flat_map(|row| (0..COLUMNS).map(move |column| at(row, column))).collect();
    let corners = (0..ROWS - 1).flat_map(|row| (0..COLUMNS - 1).map(move |column| row * COLUMNS + column));
    let triangles: Vec<[u32; 3]> =
        corners.flat_map(|a| [[a, a + COLUMNS, a + 1], [a + 1, a + COLUMNS, a + COLUMNS + 1]]).collect();
    let pins = [0, COLUMNS - 1];

    let mut still = Scene::of_mesh(&positions, &triangles, &pins, "cotton-lawn")?;
    still.step_many(120);
    let now = still.positions(0)?;
    println!("still air: the middle of the hem hangs at {:.3} m", now[now.len() - COLUMNS as usize / 2].y);
    for pin in pins {
        assert_eq!(now[pin as usize], positions[pin as usize], "a pin is where your own mesh has it, to the bit");
    }

    // Everything else that a scene may have stands in a scene file; its files may lie in memory.
    let mut obj = String::new();
    positions.iter().for_each(|p| writeln!(obj, "v {} {} {}", p.x, p.y, p.z).expect("text can be written"));
    triangles
        .iter()
        .for_each(|[a, b, c]| writeln!(obj, "f {} {} {}", a + 1, b + 1, c + 1).expect("text can be written"));
    let text = "duration = 2\n[wind]\nvelocity = [0, 0, 8]\ndrag = 0.6\n[garment]\nmesh = \"flag.obj\"\npin = { vertices = [0, 31] }\n";
    let files = [("flag.obj".to_owned(), obj.into_bytes())];
    let mut windy = Scene::parse("flag.toml", text, &files)?;
    windy.step_many(windy.duration_steps().unwrap_or_default());
    let blown = windy.positions(0)?.iter().map(|p| p.z).sum::<f32>() / positions.len() as f32;
    println!("in wind: blown {:.2} m out of its plane on average after {:.1} s", blown, windy.time());
    assert!(blown > 0.02);

    // What cannot be honoured is refused, with the line and the cure.
    let refused = Scene::parse("flag.toml", &text.replace("drag", "darg"), &files).expect_err("there is no key `darg`");
    println!("refused: {refused}");
    Ok(())
}
