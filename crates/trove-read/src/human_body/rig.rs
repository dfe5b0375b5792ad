//! The rig whose bones are few: 53 joints, a hand's fingers among them.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Deserialize;
use serde::de::DeserializeOwned;
use trove_model::BodyJoint;

use super::base::Base;
use super::file::{format, text};
use crate::ReadError;

const RIG: &str = "rig.game_engine.json";
const WEIGHTS: &str = "weights.game_engine.json";

#[derive(Deserialize)]
struct Bone {
    parent: String,
    head: Place,
}

/// Where a bone begins: in the middle of a small cube of the base mesh, or of some vertices.
#[derive(Deserialize)]
struct Place {
    cube_name: Option<String>,
    vertex_indices: Option<Vec<u32>>,
}

#[derive(Deserialize)]
struct Weights {
    weights: BTreeMap<String, Vec<(u32, f32)>>,
}

/// Joints, parents first, and each vertex's four strongest with their shares.
type Rig = (Vec<BodyJoint>, Vec<[(u16, f32); 4]>);

pub(super) fn read(folder: &Path, base: &Base) -> Result<Rig, ReadError> {
    let joints = joints(&folder.join(RIG), base)?;
    let path = folder.join(WEIGHTS);
    let read: Weights = json(&path)?;
    let mut all: Vec<Vec<(u16, f32)>> = vec![Vec::new(); base.positions.len()];
    for (j, joint) in joints.iter().enumerate() {
        for &(vertex, share) in read.weights.get(&joint.name).into_iter().flatten() {
            let place = || format!("weights of {}", joint.name);
            let of = all.get_mut(vertex as usize).ok_or_else(|| {
                let expected = format!("vertices below {}", base.positions.len());
                format(&path, place(), &expected, &vertex.to_string())
            })?;
            if !(0.0..=1.001).contains(&share) {
                return Err(format(&path, place(), "shares from 0 to 1", &share.to_string()));
            }
            of.push((j as u16, share));
        }
    }
    Ok((joints, all.into_iter().map(strongest).collect()))
}

/// The four strongest, made to come to 1; what nothing moves hangs on the root.
fn strongest(mut shares: Vec<(u16, f32)>) -> [(u16, f32); 4] {
    shares.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    shares.truncate(4);
    let sum: f32 = shares.iter().map(|s| s.1).sum();
    if sum < 1e-6 {
        return [(0, 1.0), (0, 0.0), (0, 0.0), (0, 0.0)];
    }
    std::array::from_fn(|i| shares.get(i).map_or((0, 0.0), |&(joint, share)| (joint, share / sum)))
}

fn joints(path: &Path, base: &Base) -> Result<Vec<BodyJoint>, ReadError> {
    let mut bones: BTreeMap<String, Bone> = json(path)?;
    let mut joints: Vec<BodyJoint> = Vec::new();
    while !bones.is_empty() {
        let number = |name: &str| joints.iter().position(|j| j.name == name);
        let is_root = |bone: &Bone| bone.parent.is_empty() && joints.is_empty();
        let next = bones.iter().find(|(_, bone)| is_root(bone) || number(&bone.parent).is_some());
        let Some(name) = next.map(|(name, _)| name.clone()) else {
            let orphan = bones.keys().next().cloned().unwrap_or_default();
            return Err(format(path, orphan, "a parent, and one root for all", "none"));
        };
        let Some(bone) = bones.remove(&name) else { continue };
        let around = match (bone.head.cube_name, bone.head.vertex_indices) {
            (Some(cube), _) => {
                let faces = base.groups.get(&cube).ok_or_else(|| format(path, name.clone(), "a cube's name", &cube))?;
                let mut vertices: Vec<u32> = faces.iter().flatten().copied().collect();
                vertices.sort_unstable();
                vertices.dedup();
                vertices
            }
            (None, Some(vertices)) if !vertices.is_empty() => vertices,
            _ => return Err(format(path, name, "a cube or vertices at its head", "neither")),
        };
        if let Some(vertex) = around.iter().find(|v| **v as usize >= base.positions.len()) {
            let expected = format!("vertices below {}", base.positions.len());
            return Err(format(path, name, &expected, &vertex.to_string()));
        }
        joints.push(BodyJoint { parent: number(&bone.parent), name, around });
    }
    Ok(joints)
}

fn json<T: DeserializeOwned>(path: &Path) -> Result<T, ReadError> {
    serde_json::from_str(&text(path)?).map_err(|e| {
        format(path, format!("line {}, column {}", e.line(), e.column()), "MakeHuman's JSON", &e.to_string())
    })
}
