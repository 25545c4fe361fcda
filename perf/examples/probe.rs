//! probe
use toile_assets::bake::bake;
use toile_assets::scene::skirt;
use toile_engine::cloth::bending_matrix::BendingMatrix;
use toile_perf::worn::Mannequin;
fn show(name: &str, g: &toile_assets::garment::Garment) {
    let m = BendingMatrix::new(g);
    let rows: u32 = m.strips.iter().map(|s| s.len).sum();
    let alike: u32 = m.strips.iter().filter(|s| s.alike).map(|s| s.len).sum();
    let ent: u32 = m.strips.iter().map(|s| s.len*s.entries).sum();
    let brows: u32 = m.blocks.iter().map(|s| s.len).sum();
    let bent: u32 = m.blocks.iter().map(|s| 16*s.entries).sum();
    {
        use toile_engine::lanes::*; use toile_engine::cloth::{bending::Bend, records::FillRecords};
        let n = g.start.len();
        let mut st = toile_engine::cloth::state::State::new(&g.start, &g.inverse_mass);
        let c = st.columns();
        let mut rec = Store::zeros(4*n); let r = rec.column();
        let spans=[(0u32,n as u32)];
        for w in [Width::Sixteen, Width::Eight, Width::Four] {
        let mut best=[f64::MAX;2];
        for _ in 0..200 {
            let t=std::time::Instant::now();
            w.run(FillRecords{from:c.x,w:c.w,spans:&spans,records:r});
            best[0]=best[0].min(t.elapsed().as_secs_f64()*1e6);
            let t=std::time::Instant::now();
            for owner in 0..2 { w.run(Bend{matrix:&m,owner,from:c.x,records:r,to:c.v,by:1e-9}); }
            best[1]=best[1].min(t.elapsed().as_secs_f64()*1e6);
        }
        println!("  {w} lanes: fill {:.1} bend {:.1} us", best[0], best[1]);
        }
    }
    {
        use toile_engine::lanes::*; use toile_engine::cloth::{links::*, record_links::*, records::*};
        let n = g.start.len();
        let mut st = toile_engine::cloth::state::State::new(&g.start, &g.inverse_mass);
        let c = st.columns();
        let mut rec = Store::zeros(4*(n+2)); let r = rec.column();
        let spans=[(0u32,n as u32)];
        let w = &g.layout().weft;
        let mut gains = LinkGains::new(w); gains.prepare(w, &g.inverse_mass, [0.002, 0.0], Passes::Many);
        let mut rl = RecordLinks::new(w, &g.inverse_mass); rl.prepare(w, &gains, false);
        for width in [Width::Sixteen, Width::Eight, Width::Four] {
        width.run(FillRecords{from:c.x,w:c.w,spans:&spans,records:r});
        let mut best=[f64::MAX;2];
        for _ in 0..200 {
            let t=std::time::Instant::now();
            for set in 0..w.tuples.sets.len() { width.run(SolveRecordLinks{links:&rl,set,owner:0,records:r,tension:None}); width.run(SolveRecordLinks{links:&rl,set,owner:1,records:r,tension:None}); }
            best[0]=best[0].min(t.elapsed().as_secs_f64()*1e6);
            let t=std::time::Instant::now();
            for set in &w.tuples.sets { for owner in 0..2 { width.run(SolveLinks{columns:c,links:w,gains:&gains,set,owner,gamma:0.0,tension:None}); } }
            best[1]=best[1].min(t.elapsed().as_secs_f64()*1e6);
        }
        println!("  {width} lanes: {} links records {:.1} columns {:.1} us", w.tuples.count, best[0], best[1]);
        }
    }
    println!("{name}: {} strips of {rows} rows ({alike} alike) {ent} entries; {} blocks of {brows} rows, {bent} entries; bytes {}", m.strips.len(), m.blocks.len(), m.bytes());
}
fn main() {
    for n in ["sun-dress", "wide-trousers", "t-shirt"] {
        let m = Mannequin::of(n).unwrap();
        let (size, shape, fabric) = m.wear(n).unwrap();
        show(n, &bake(n, &size, &shape, &fabric).unwrap());
    }
    let s = skirt::irregular(64, 1);
    show("irregular", &bake("skirt", "one", &s, &skirt::fabric(&s, skirt::Stretch::Inextensible)).unwrap());
    let s = skirt::shape(64);
    show("grid", &bake("skirt", "one", &s, &skirt::fabric(&s, skirt::Stretch::Inextensible)).unwrap());
}
