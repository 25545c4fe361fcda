//! The nodes of a glTF file as the forest that they have to be.

use std::collections::BTreeSet;

use glam::Mat4;
use serde_json::Value;

use super::error::Flaw;
use crate::import::gltf::file::{index, list, transform};
use toile_base::limits::MAX_BODY_NODES;

/// All nodes, each with its parent and its place in the scene.
pub(super) struct GltfNodes {
    names: Vec<String>,
    /// What the file itself says which joint of a humanoid it is.
    humanoid: Vec<Option<String>>,
    parents: Vec<Option<usize>>,
    local: Vec<Mat4>,
    global: Vec<Mat4>,
}

impl GltfNodes {
    /// Reads the nodes, and proves that they form a forest.
    pub fn read(json: &Value) -> Result<Self, Flaw> {
        let nodes = list(&json["nodes"]);
        if nodes.len() > MAX_BODY_NODES {
            let count = nodes.len();
            return Err(Flaw::syntax(format!(
                "it has {count} nodes, more than {MAX_BODY_NODES}; export the body alone"
            )));
        }
        let name =
            |(i, node): (usize, &Value)| node["name"].as_str().map_or_else(|| format!("node {i}"), str::to_owned);
        let names: Vec<String> = nodes.iter().enumerate().map(name).collect();
        let mut parents = vec![None; nodes.len()];
        for (parent, node) in nodes.iter().enumerate() {
            for child in list(&node["children"]) {
                let child = index(child).filter(|c| *c < nodes.len());
                let gone = || {
                    Flaw::syntax(format!("node \"{}\" has a child that is not there; export it again", names[parent]))
                };
                let child = child.ok_or_else(gone)?;
                if parents[child].replace(parent).is_some() {
                    return Err(Flaw::TwoParents { node: names[child].clone() });
                }
            }
        }
        let mut humanoid_names = vec![None; nodes.len()];
        for (node, bone) in humanoid(json) {
            if let Some(to) = humanoid_names.get_mut(node) {
                *to = Some(bone);
            }
        }
        let local: Vec<Mat4> = nodes.iter().map(transform).collect();
        if let Some(i) = local.iter().position(|m| !m.is_finite()) {
            return Err(Flaw::NotFinite { what: "the transform of node", index: i });
        }
        let mut nodes = Self { names, humanoid: humanoid_names, parents, global: local.clone(), local };
        nodes.settle()?;
        Ok(nodes)
    }

    /// Places every node in the scene, parents before children.
    fn settle(&mut self) -> Result<(), Flaw> {
        let mut done: Vec<bool> = self.parents.iter().map(Option::is_none).collect();
        for start in 0..self.len() {
            let mut path = vec![start];
            while let Some(parent) = self.parents[path[path.len() - 1]].filter(|_| !done[path[path.len() - 1]]) {
                if path.len() > self.len() {
                    return Err(Flaw::Cycle { node: self.names[start].clone() });
                }
                path.push(parent);
            }
            for &node in path.iter().rev().filter(|n| !done[**n]).collect::<Vec<_>>() {
                if let Some(parent) = self.parents[node] {
                    self.global[node] = self.global[parent] * self.local[node];
                }
                done[node] = true;
            }
        }
        Ok(())
    }

    pub fn len(&self) -> usize {
        self.names.len()
    }

    /// The node's own name.
    pub fn name(&self, node: usize) -> &str {
        &self.names[node]
    }

    /// What joint the node is: what the file says of its humanoid, else its name. Where a humanoid is marked, the
    /// names of all other nodes say nothing.
    pub fn called(&self, node: usize) -> &str {
        match &self.humanoid[node] {
            Some(bone) => bone,
            None if self.humanoid.iter().any(Option::is_some) => "",
            None => &self.names[node],
        }
    }

    pub fn parent(&self, node: usize) -> Option<usize> {
        self.parents[node]
    }

    /// The node's place beside its parent.
    pub fn local(&self, node: usize) -> Mat4 {
        self.local[node]
    }

    /// The node's place in the scene.
    pub fn global(&self, node: usize) -> Mat4 {
        self.global[node]
    }

    /// Some nodes and all that is above them, in order.
    pub fn with_ancestors(&self, nodes: &BTreeSet<usize>) -> Vec<usize> {
        let mut all = BTreeSet::new();
        for &node in nodes {
            let mut next = Some(node);
            while let Some(node) = next.filter(|n| all.insert(*n)) {
                next = self.parents[node];
            }
        }
        all.into_iter().collect()
    }

    /// Refuses scales that mirror or flatten.
    pub fn check_scales(&self, nodes: &[usize]) -> Result<(), Flaw> {
        for &node in nodes {
            let scale = self.local[node].determinant();
            if scale < 0.0 {
                return Err(Flaw::Mirrored { node: self.names[node].clone() });
            }
            if scale == 0.0 || !scale.is_finite() {
                return Err(Flaw::Flat { node: self.names[node].clone() });
            }
        }
        Ok(())
    }
}

/// What a file calls its joints where it says so itself: VRM 0.x and 1.0 name the nodes of a humanoid.
fn humanoid(json: &Value) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    for bone in list(&json["extensions"]["VRM"]["humanoid"]["humanBones"]) {
        if let (Some(name), Some(node)) = (bone["bone"].as_str(), index(&bone["node"])) {
            found.push((node, name.to_owned()));
        }
    }
    if let Some(bones) = json["extensions"]["VRMC_vrm"]["humanoid"]["humanBones"].as_object() {
        found.extend(bones.iter().filter_map(|(name, bone)| Some((index(&bone["node"])?, name.clone()))));
    }
    found
}
