//! Constants that are stored without their zeros; DENSIFY puts these back.
//!
//! Dimension after dimension, outermost first: a dense one has all its places; a sparse one lists, for each place of the
//! dimensions before it, the places that are there (compressed sparse rows). Blocks are not read, since no network here has them.

use super::NetworkFault;
use super::reader::Table;

/// How one dimension is stored.
#[derive(Debug)]
enum Dimension {
    Dense(usize),
    Sparse { segments: Vec<usize>, places: Vec<usize> },
}

fn fault(what: &str) -> NetworkFault {
    NetworkFault::new(format!("its sparse weights cannot be read: {what}"))
}

/// A list of whole numbers of 32, 16 or 8 bits.
fn numbers(dimension: &Table<'_>, kind: usize, list: usize) -> Result<Vec<usize>, NetworkFault> {
    let table = dimension.table(list)?.ok_or_else(|| fault("a list of places is missing"))?;
    Ok(match dimension.byte(kind, 0)? {
        1 => table.ints(0)?.into_iter().map(|n| usize::try_from(n).unwrap_or(usize::MAX)).collect(),
        2 => table.bytes(0, 2)?.as_chunks().0.iter().map(|b| usize::from(u16::from_le_bytes(*b))).collect(),
        3 => table.bytes(0, 1)?.iter().map(|b| usize::from(*b)).collect(),
        _ => return Err(fault("places of an unknown kind")),
    })
}

fn dimension(table: &Table<'_>, size: usize) -> Result<Dimension, NetworkFault> {
    match table.byte(0, 0)? {
        0 if table.int(1, 0)? as i64 == size as i64 => Ok(Dimension::Dense(size)),
        1 => {
            let (segments, places) = (numbers(table, 2, 3)?, numbers(table, 4, 5)?);
            let ordered =
                segments.windows(2).all(|w| w[0] <= w[1]) && segments.last().is_none_or(|n| *n <= places.len());
            let inside = places.iter().all(|place| *place < size);
            if ordered && inside {
                Ok(Dimension::Sparse { segments, places })
            } else {
                Err(fault("places outside of it"))
            }
        }
        _ => Err(fault("a dimension of another size")),
    }
}

/// Where each stored value belongs among all, in the order in which they are stored.
pub fn places(table: &Table<'_>, shape: &[usize]) -> Result<Vec<usize>, NetworkFault> {
    let order = table.ints(0)?;
    if !table.ints(1)?.is_empty() || order.iter().map(|n| i64::from(*n)).ne(0..shape.len() as i64) {
        return Err(fault("they are stored in blocks or in another order"));
    }
    let tables = table.tables(2, shape.len(), "dimensions of sparse weights")?;
    if tables.len() != shape.len() {
        return Err(fault("a dimension is missing"));
    }
    // For each place of the dimensions so far: its number among those that are stored, and its number among all.
    let most: usize = shape.iter().product();
    let mut all = vec![0_usize];
    for (table, &size) in tables.iter().zip(shape) {
        let mut next = Vec::new();
        match dimension(table, size)? {
            Dimension::Dense(size) if all.len() * size > most => return Err(fault("more places than it has")),
            Dimension::Dense(size) => all.iter().for_each(|at| next.extend((0..size).map(|i| at * size + i))),
            Dimension::Sparse { segments, places } => {
                if segments.len() != all.len() + 1 || places.len() > most {
                    return Err(fault("a list of places of another length"));
                }
                for (at, ends) in all.iter().zip(segments.windows(2)) {
                    next.extend(places[ends[0]..ends[1]].iter().map(|place| at * size + place));
                }
            }
        }
        all = next;
    }
    Ok(all)
}
