//! Prints the tables of `docs/scene.md`, which a test compares with the page:
//! `cargo run --release -p toile-assets --example scene_reference`.

fn main() {
    print!("{}", toile_assets::scene_file::schema::reference());
}
