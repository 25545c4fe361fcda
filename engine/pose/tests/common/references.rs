//! Compares a network with its scalar reference.

use toile_base::numeric::random::SplitMix64;
use toile_pose::network::Network;

/// Whether both give the same bits for a picture of noise, in each of so many outputs.
pub fn agree(network: &mut Network, outputs: usize) -> bool {
    let mut random = SplitMix64::new(2);
    let picture: Vec<f32> = network.input().iter().map(|_| random.uniform()).collect();
    let mut bits = |plainly: bool| -> Vec<u32> {
        network.input().copy_from_slice(&picture);
        if plainly {
            network.run_plainly();
        } else {
            network.run();
        }
        (0..outputs).flat_map(|i| network.output(i)).map(|x| x.to_bits()).collect()
    };
    bits(false) == bits(true)
}
