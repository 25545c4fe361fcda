fn main() {
    for _ in 0..5 {
        println!("Y {:.1}", toile_perf::yardstick::measure().unwrap());
    }
}
