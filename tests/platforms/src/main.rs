//! Prints the hashes, one a line: name, lanes, hash.

use toile_engine::lanes::Width;
use toile_platforms::skirt_hash;

fn main() {
    for width in [Width::One, Width::Four] {
        println!("skirt {width} {:#018x}", skirt_hash(width));
    }
}
