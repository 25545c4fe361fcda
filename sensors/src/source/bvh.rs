//! BVH motion capture as a session: parsed, its joints named, posed.

use super::{bvh_file, bvh_names, bvh_pose};
use crate::error::ReaderFault;
use crate::session::Session;

pub(super) fn read(bytes: &[u8]) -> Result<Session, ReaderFault> {
    let bvh = bvh_file::parse(bytes)?;
    let names = bvh_names::map(&bvh.nodes)?;
    bvh_pose::session(&bvh, &names)
}
