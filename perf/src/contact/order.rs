//! Order that was lost: the outer garment starts inside the inner one.

use toile_base::numeric::random::SplitMix64;

use super::row::{ContactError, ContactRow};
use super::scenes::{self, play, runner};
use crate::crossings::CrossingTest;

/// Starts that are tried.
const SEEDS: u64 = 100;

/// Starts of 100 in which anything still crosses after half a second.
pub fn order() -> Result<Vec<ContactRow>, ContactError> {
    let mut random = SplitMix64::new(20);
    let (mut crossed, mut inside) = (0u32, 0u32);
    for _ in 0..SEEDS {
        let mut unit = || f64::from(random.next_u64() as u32) / f64::from(u32::MAX);
        let (turn, shift) = (90.0 * unit(), 0.1 * (unit() - 0.5));
        let mut run = runner(&scenes::lost_order(turn, shift))?;
        play(&mut run);
        let at: Vec<Vec<_>> = run.cloths().iter().map(|c| c.positions.iter().map(|p| p.as_dvec3()).collect()).collect();
        let faces: Vec<&[[u32; 3]]> = run.garments().iter().map(|g| &*g.triangles).collect();
        crossed += u32::from(!CrossingTest::new(&faces).between(&[&at[0], &at[1]]).is_empty());
        let height = |g: usize| at[g].iter().map(|p| p.y).sum::<f64>() / at[g].len() as f64;
        inside += u32::from(height(1) < height(0));
    }
    Ok(vec![
        ContactRow::at_most(
            "outer sheet 10 mm inside the inner: of 100 still crossing after .5 s",
            0.0,
            crossed.into(),
            "starts",
        ),
        ContactRow::at_most(
            "outer sheet 10 mm inside the inner: of 100 still inside after .5 s",
            0.0,
            inside.into(),
            "starts",
        ),
    ])
}
