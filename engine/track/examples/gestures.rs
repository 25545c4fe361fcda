//! Temporary.
use toile_track::gesture::study::*;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let n = a.get(1).and_then(|a| a.parse().ok()).unwrap_or(20);
    if let Some(act) = a.get(2) {
        let act = Act::GESTURES.into_iter().chain(Act::OTHERS).find(|x| x.name().contains(act.as_str())).unwrap();
        let distance = a.get(3).and_then(|a| a.parse().ok()).unwrap_or(2.0);
        let c = Conditions { distance, ..Conditions::default() };
        for i in 0..n {
            let f = sequence(act, &c, u64::from(i) + 1);
            eprintln!("--- {i}");
            let e = events(&f);
            println!("{i} {act:?} {:?}", e.iter().map(|e| (e.time_ns / 1_000_000, e.gesture, e.side)).collect::<Vec<_>>());
        }
        return;
    }
    println!("{}", Study::run(n, 1, &mut |s| eprintln!("{s}")).markdown());
}
