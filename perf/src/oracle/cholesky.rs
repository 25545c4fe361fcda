//! A sparse Cholesky factorisation L L^T of a symmetric matrix of 3 x 3 blocks.
//!
//! Ordered by nested dissection (George 1973), analysed once, factored column by column, left-looking (Davis 2006,
//! "Direct methods for sparse linear systems", chapter 4). It is small because the matrix is a mesh's; a library for all
//! matrices (faer: two minutes of one core) would double the time of the first build.

use glam::{DMat3, DVec3};

/// Parts of a mesh that are not cut any further.
const UNCUT: usize = 24;

/// A row that is not in a column.
const NONE: u32 = u32::MAX;

/// The order of the blocks, and which of the factor's are not 0.
#[derive(Debug)]
pub struct Analysis {
    /// Place of each block row in the order.
    place: Vec<u32>,
    /// Where the rows of each column below the diagonal begin in `rows`; the columns are in the order.
    starts: Vec<usize>,
    /// Rows, ascending within a column.
    rows: Vec<u32>,
}

/// The factor: blocks on the diagonal inverted, the others as in the analysis.
#[derive(Debug)]
pub struct Factor {
    inverse: Vec<DMat3>,
    below: Vec<DMat3>,
}

impl Analysis {
    /// Of a matrix of `count` block rows with blocks at these pairs, and on its diagonal.
    pub fn new(count: usize, pairs: &[[u32; 2]]) -> Self {
        let mut beside = vec![Vec::new(); count];
        for &[p, q] in pairs {
            beside[p as usize].push(q);
            beside[q as usize].push(p);
        }
        let mut order = Vec::with_capacity(count);
        dissect(&beside, (0..count as u32).collect(), &mut order);
        let mut place = vec![NONE; count];
        order.iter().zip(0..).for_each(|(&v, k)| place[v as usize] = k);
        let mut columns: Vec<Vec<u32>> = vec![Vec::new(); count];
        for k in 0..count {
            let column = &mut columns[k];
            let own = beside[order[k] as usize].iter().map(|&v| place[v as usize]);
            column.extend(own.filter(|&row| row as usize > k));
            column.sort_unstable();
            column.dedup();
            // What this column has below, the column of its first row will have too: it has taken it when its turn comes.
            if let Some((&parent, rest)) = column.split_first() {
                let rest = rest.to_vec();
                let parent = order[parent as usize] as usize;
                let more = rest.iter().map(|&row| order[row as usize]);
                beside[parent].extend(more);
            }
        }
        let mut starts = vec![0];
        starts.extend(columns.iter().scan(0, |sum, c| {
            *sum += c.len();
            Some(*sum)
        }));
        Self { place, starts, rows: columns.concat() }
    }

    /// Blocks of the factor below the diagonal.
    #[cfg(test)]
    pub fn blocks(&self) -> usize {
        self.rows.len()
    }

    fn column(&self, k: usize) -> std::ops::Range<usize> {
        self.starts[k]..self.starts[k + 1]
    }

    /// Factors a matrix: its diagonal, and the blocks `(row, column)` of one half of it. None where it is not positive
    /// definite.
    pub fn factor(&self, diagonal: &[DMat3], blocks: impl Iterator<Item = ([u32; 2], DMat3)>) -> Option<Factor> {
        let count = diagonal.len();
        let mut out = Factor { inverse: vec![DMat3::ZERO; count], below: vec![DMat3::ZERO; self.rows.len()] };
        diagonal.iter().zip(&self.place).for_each(|(d, &k)| out.inverse[k as usize] = *d);
        for ([row, column], block) in blocks {
            let [p, q] = [self.place[row as usize], self.place[column as usize]];
            let (k, row, block) = if p > q { (q, p, block) } else { (p, q, block.transpose()) };
            let range = self.column(k as usize);
            if let Ok(at) = self.rows[range.clone()].binary_search(&row) {
                out.below[range.start + at] += block;
            }
        }
        // Columns that next have something to give to column k, as a list through `next`; and how far each has given.
        let (mut first, mut next) = (vec![NONE; count], vec![NONE; count]);
        let mut given: Vec<usize> = self.starts[..count].to_vec();
        let mut sum = vec![DMat3::ZERO; count];
        for k in 0..count {
            let mut from = std::mem::replace(&mut first[k], NONE);
            while from != NONE {
                let c = from as usize;
                from = next[c];
                let (at, end) = (given[c], self.starts[c + 1]);
                let turned = out.below[at].transpose();
                out.inverse[k] -= out.below[at] * turned;
                for i in at + 1..end {
                    sum[self.rows[i] as usize] += out.below[i] * turned;
                }
                self.pass_on(c, at + 1, &mut given, &mut first, &mut next);
            }
            let root = root(out.inverse[k])?;
            out.inverse[k] = root.inverse();
            let turned = out.inverse[k].transpose();
            for i in self.column(k) {
                let row = self.rows[i] as usize;
                out.below[i] = (out.below[i] - std::mem::replace(&mut sum[row], DMat3::ZERO)) * turned;
            }
            self.pass_on(k, self.starts[k], &mut given, &mut first, &mut next);
        }
        Some(out)
    }

    /// Column `c` gives to the column of its row at `at` next.
    fn pass_on(&self, c: usize, at: usize, given: &mut [usize], first: &mut [u32], next: &mut [u32]) {
        given[c] = at;
        if at < self.starts[c + 1] {
            let row = self.rows[at] as usize;
            next[c] = std::mem::replace(&mut first[row], c as u32);
        }
    }

    /// Solves for one right-hand side, in place.
    pub fn solve(&self, factor: &Factor, side: &mut [DVec3]) {
        let count = side.len();
        let mut x = vec![DVec3::ZERO; count];
        side.iter().zip(&self.place).for_each(|(s, &k)| x[k as usize] = *s);
        for k in 0..count {
            x[k] = factor.inverse[k] * x[k];
            for i in self.column(k) {
                let by = factor.below[i] * x[k];
                x[self.rows[i] as usize] -= by;
            }
        }
        for k in (0..count).rev() {
            for i in self.column(k) {
                let by = factor.below[i].transpose() * x[self.rows[i] as usize];
                x[k] -= by;
            }
            x[k] = factor.inverse[k].transpose() * x[k];
        }
        side.iter_mut().zip(&self.place).for_each(|(s, &k)| *s = x[k as usize]);
    }
}

/// The lower triangular root of a symmetric block; none where it is not positive definite.
fn root(m: DMat3) -> Option<DMat3> {
    let a = m.x_axis.x;
    let l11 = positive_root(a)?;
    let (l21, l31) = (m.x_axis.y / l11, m.x_axis.z / l11);
    let l22 = positive_root(m.y_axis.y - l21 * l21)?;
    let l32 = (m.y_axis.z - l31 * l21) / l22;
    let l33 = positive_root(m.z_axis.z - l31 * l31 - l32 * l32)?;
    Some(DMat3::from_cols(DVec3::new(l11, l21, l31), DVec3::new(0.0, l22, l32), DVec3::new(0.0, 0.0, l33)))
}

fn positive_root(x: f64) -> Option<f64> {
    (x > 0.0 && x.is_finite()).then(|| x.sqrt())
}

/// Appends the nodes of a part in an order of little fill: both sides of a cut, then the cut.
fn dissect(beside: &[Vec<u32>], part: Vec<u32>, order: &mut Vec<u32>) {
    let mut level = vec![NONE; beside.len()];
    let mut inside = vec![false; beside.len()];
    let mut left = vec![(part, false)];
    while let Some((nodes, done)) = left.pop() {
        if done || nodes.len() <= UNCUT {
            order.extend(nodes);
            continue;
        }
        nodes.iter().for_each(|&v| inside[v as usize] = true);
        let far = layers(beside, &inside, nodes[0], &mut level);
        let end = far[far.len() - 1];
        far.iter().for_each(|&v| level[v as usize] = NONE);
        let walked = layers(beside, &inside, end, &mut level);
        let apart: Vec<u32> = nodes.iter().copied().filter(|&v| level[v as usize] == NONE).collect();
        let middle = level[walked[walked.len() / 2] as usize];
        let side = |wanted: &dyn Fn(u32) -> bool| -> Vec<u32> {
            walked.iter().copied().filter(|&v| wanted(level[v as usize])).collect()
        };
        let (before, cut, after) = (side(&|l| l < middle), side(&|l| l == middle), side(&|l| l > middle));
        nodes.iter().for_each(|&v| (inside[v as usize], level[v as usize]) = (false, NONE));
        // The stack gives back what was put last first: sides before their cut.
        left.push((cut, true));
        left.extend([after, before, apart].into_iter().filter(|p| !p.is_empty()).map(|p| (p, false)));
    }
}

/// The nodes of a part that can be reached from one, nearest first; their distances into `level`.
fn layers(beside: &[Vec<u32>], inside: &[bool], start: u32, level: &mut [u32]) -> Vec<u32> {
    let mut found = vec![start];
    level[start as usize] = 0;
    let mut at = 0;
    while at < found.len() {
        let v = found[at] as usize;
        at += 1;
        for &u in &beside[v] {
            if inside[u as usize] && level[u as usize] == NONE {
                level[u as usize] = level[v] + 1;
                found.push(u);
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3Swizzles;

    /// A grid of `n` by `n` blocks with neighbours two apart joined too, positive definite.
    fn grid(n: u32) -> (Vec<DMat3>, Vec<([u32; 2], DMat3)>) {
        let mut blocks = Vec::new();
        for r in 0..n {
            for c in 0..n {
                for (dr, dc) in [(0, 1), (1, 0), (1, 1), (2, 0), (0, 2)] {
                    if r + dr < n && c + dc < n {
                        let seed = f64::from(r * 31 + c * 17 + dr * 7 + dc);
                        let v = DVec3::new(seed.sin(), (2.0 * seed).cos(), (3.0 * seed).sin());
                        let block = DMat3::from_cols(v * 0.3, v.yzx() * 0.2, v.zxy() * 0.1);
                        blocks.push(([(r + dr) * n + c + dc, r * n + c], block));
                    }
                }
            }
        }
        let own = |i: u32| DMat3::from_diagonal(DVec3::new(6.0, 7.0, 8.0 + f64::from(i % 3)));
        ((0..n * n).map(own).collect(), blocks)
    }

    #[test]
    fn the_solution_solves_the_system_and_every_block_has_its_place() {
        for n in [1, 2, 5, 17] {
            let (diagonal, blocks) = grid(n);
            let pairs: Vec<[u32; 2]> = blocks.iter().map(|b| b.0).collect();
            let analysis = Analysis::new(diagonal.len(), &pairs);
            let mut seen = analysis.place.clone();
            seen.sort_unstable();
            assert!(seen.into_iter().eq(0..n * n));
            let factor = analysis.factor(&diagonal, blocks.iter().copied()).expect("positive definite");
            let right: Vec<DVec3> = (0..n * n).map(|i| DVec3::new(f64::from(i), 1.0, -f64::from(i % 5))).collect();
            let mut x = right.clone();
            analysis.solve(&factor, &mut x);
            let mut back: Vec<DVec3> = diagonal.iter().zip(&x).map(|(d, x)| *d * *x).collect();
            for ([p, q], block) in &blocks {
                let (p, q) = (*p as usize, *q as usize);
                back[p] += *block * x[q];
                back[q] += block.transpose() * x[p];
            }
            let error = back.iter().zip(&right).map(|(a, b)| (*a - *b).length()).fold(0.0, f64::max);
            assert!(error < 1e-11 * f64::from(n * n), "{n}: {error}");
        }
    }

    #[test]
    fn what_is_not_positive_definite_is_refused_and_dissection_keeps_the_fill_low() {
        let (mut diagonal, blocks) = grid(8);
        let pairs: Vec<[u32; 2]> = blocks.iter().map(|b| b.0).collect();
        diagonal[20] = -diagonal[20];
        assert!(Analysis::new(64, &pairs).factor(&diagonal, blocks.iter().copied()).is_none());
        let (_, blocks) = grid(48);
        let pairs: Vec<[u32; 2]> = blocks.iter().map(|b| b.0).collect();
        // Row by row, each of 2,304 columns would reach over two rows and more: 96 blocks.
        let fill = Analysis::new(48 * 48, &pairs).blocks();
        assert!(fill < 48 * 48 * 60, "{fill}");
    }
}
