//! Least squares of few unknowns, none of which may be below 0.

use super::work::KINDS;

/// The times a unit for which the sums over the rows come nearest to what was measured, relative to it. A unit that no row
/// has any of gets 0.
pub fn fit(rows: &[[f64; KINDS]], measured: &[f64]) -> [f64; KINDS] {
    let mut best = (f64::INFINITY, [0.0; KINDS]);
    // Few enough to try every choice of the unknowns that are not 0.
    for chosen in 0..1u32 << KINDS {
        let columns: Vec<usize> = (0..KINDS).filter(|k| chosen >> k & 1 != 0).collect();
        let Some(found) = solve(rows, measured, &columns) else { continue };
        let off = |(row, y): (&[f64; KINDS], &f64)| {
            let sum: f64 = row.iter().zip(found).map(|(a, b)| a * b).sum();
            if *y > 0.0 { ((sum - y) / y).powi(2) } else { 0.0 }
        };
        let error: f64 = rows.iter().zip(measured).map(off).sum();
        if found.iter().all(|c| *c >= 0.0) && error < best.0 {
            best = (error, found);
        }
    }
    best.1
}

/// The normal equations of the chosen columns, by Gauss's elimination; none where they do not tell them apart.
fn solve(rows: &[[f64; KINDS]], measured: &[f64], columns: &[usize]) -> Option<[f64; KINDS]> {
    let n = columns.len();
    let mut m = [[0.0; KINDS + 1]; KINDS];
    for (row, &y) in rows.iter().zip(measured).filter(|(_, y)| **y > 0.0) {
        let scaled = |k: usize| row[columns[k]] / y;
        for (i, equation) in m.iter_mut().enumerate().take(n) {
            (0..n).for_each(|j| equation[j] += scaled(i) * scaled(j));
            equation[KINDS] += scaled(i);
        }
    }
    let mut found = [0.0; KINDS];
    for i in 0..n {
        let pivot = (i..n).max_by(|a, b| m[*a][i].abs().total_cmp(&m[*b][i].abs()))?;
        m.swap(i, pivot);
        if m[i][i].abs() < 1e-12 {
            return None;
        }
        for k in (0..n).filter(|k| *k != i) {
            let by = m[k][i] / m[i][i];
            let row = m[i];
            m[k].iter_mut().zip(row).for_each(|(to, from)| *to -= by * from);
        }
    }
    (0..n).for_each(|i| found[columns[i]] = m[i][KINDS] / m[i][i]);
    Some(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_times_are_found_again() {
        let rows = [[100.0, 3.0, 7.0, 0.0], [20.0, 30.0, 1.0, 0.0], [5.0, 2.0, 50.0, 0.0], [60.0, 60.0, 6.0, 0.0]];
        let unit = [0.02, 0.5, 0.0];
        let measured = rows.map(|r| r.iter().zip(unit).map(|(a, b)| a * b).sum());
        let found = fit(&rows, &measured);
        assert!(found.iter().zip(unit).all(|(a, b)| (a - b).abs() < 1e-9), "{found:?}");
    }

    #[test]
    fn nothing_takes_less_than_no_time() {
        // By itself the second unit would be found below 0.
        let found = fit(&[[10.0, 1.0, 0.0, 0.0], [10.0, 2.0, 0.0, 0.0], [20.0, 1.0, 0.0, 0.0]], &[2.0, 1.5, 4.0]);
        assert!(found.iter().all(|c| *c >= 0.0) && found[1] == 0.0, "{found:?}");
        assert_eq!(fit(&[], &[]), [0.0; KINDS]);
    }
}
