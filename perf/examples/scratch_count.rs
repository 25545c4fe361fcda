use toile_assets::bake::bake;
use toile_assets::scene::skirt;
fn main() {
    let shape = skirt::shape(64);
    let fabric = skirt::fabric(&shape, skirt::Stretch::Inextensible);
    let g = bake("s", "s", &shape, &fabric).unwrap();
    let l = &g.layout;
    println!(
        "bends {} runs {} loose {} sets {}",
        l.bends.tuples.count,
        l.bends.tuples.runs.len(),
        l.bends.tuples.loose.len(),
        l.bends.tuples.sets.len()
    );
    let mut h = std::collections::BTreeMap::new();
    for r in &l.bends.tuples.runs {
        *h.entry((r.len, r.alike)).or_insert(0) += 1;
    }
    println!("{h:?}");
    println!("skewed {}", l.skewed.tuples.count);
    for (n, t) in [("shear", &l.shear.tuples), ("weft", &l.weft.tuples)] {
        let mut h = std::collections::BTreeMap::new();
        for r in &t.runs {
            *h.entry((r.len, r.alike)).or_insert(0) += 1;
        }
        println!("{n} {} loose {} sets {} {h:?}", t.count, t.loose.len(), t.sets.len());
    }
    for b in &l.fibers.bundles {
        println!("bundle {} lanes rows {:?} alike {} {:?}", b.lanes, b.rows, b.alike, b.solver);
    }
}
