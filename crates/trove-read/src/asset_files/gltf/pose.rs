//! Where the nodes are: the first frame of an animation, or the rest pose in a file without animations.

use std::collections::BTreeMap;

use glam::{Mat4, Quat, Vec3};

use super::container::Container;
use super::json::{Animation, Node};
use crate::asset_files::fault::Fault;

/// Deeper trees of nodes than this are damaged files.
const DEEPEST: usize = 512;

/// The nodes of a file in one pose.
#[derive(Debug)]
pub(super) struct Pose {
    /// Nodes of the scene with `file_from_node`, each once, in the order of the tree.
    pub(super) placed: Vec<(usize, Mat4)>,
    /// Weights of morph targets by node, where the animation says something about them.
    pub(super) morphs: BTreeMap<usize, Vec<f32>>,
    /// What is wrong with the tree.
    pub(super) repair: Option<String>,
}

impl Pose {
    /// Follows the tree from the scene's roots; a node that is reached twice counts once.
    pub(super) fn of(container: &Container) -> Result<Self, Fault> {
        let root = &container.root;
        let (moves, morphs) = match chosen(&root.animations) {
            Some(animation) => first_frame(container, animation)?,
            None => Default::default(),
        };
        let local = |i: usize, node: &Node| {
            let [translation, rotation, scale] = ["translation", "rotation", "scale"].map(|path| moves.get(&(i, path)));
            if let (Some(m), None, None, None) = (&node.matrix, translation, rotation, scale) {
                return Mat4::from_cols_array(m);
            }
            let (s, r, t) = node.matrix.map(|m| Mat4::from_cols_array(&m).to_scale_rotation_translation()).unwrap_or((
                node.scale.map_or(Vec3::ONE, Vec3::from),
                node.rotation.map_or(Quat::IDENTITY, Quat::from_array),
                node.translation.map_or(Vec3::ZERO, Vec3::from),
            ));
            let vector = |values: Option<&Vec<f32>>| values.filter(|v| v.len() >= 3).map(|v| Vec3::from_slice(v));
            let turn = rotation.filter(|v| v.len() >= 4).map(|v| Quat::from_slice(v)).unwrap_or(r);
            let turn = if turn.length_squared() > 1e-12 { turn.normalize() } else { Quat::IDENTITY };
            Mat4::from_scale_rotation_translation(vector(scale).unwrap_or(s), turn, vector(translation).unwrap_or(t))
        };
        let mut pose = Self { placed: Vec::new(), morphs, repair: None };
        let mut seen = vec![false; root.nodes.len()];
        let mut stack: Vec<(usize, Mat4, usize)> =
            roots(container).into_iter().rev().map(|i| (i, Mat4::IDENTITY, 0)).collect();
        while let Some((i, parent, depth)) = stack.pop() {
            let Some(node) = root.nodes.get(i) else {
                pose.repair = Some(format!("nodes[{i}] of {}", root.nodes.len()));
                continue;
            };
            if std::mem::replace(&mut seen[i], true) || depth > DEEPEST {
                pose.repair = Some(format!("nodes[{i}] is reached twice"));
                continue;
            }
            let file_from_node = parent * local(i, node);
            pose.placed.push((i, file_from_node));
            stack.extend(node.children.iter().rev().map(|&child| (child, file_from_node, depth + 1)));
        }
        Ok(pose)
    }

    /// `file_from_node` of a node; the identity for one outside the scene.
    pub(super) fn of_node(&self, node: usize) -> Mat4 {
        self.placed.iter().find(|(i, _)| *i == node).map_or(Mat4::IDENTITY, |(_, m)| *m)
    }
}

/// The scene's roots; without a scene every node that is nobody's child.
fn roots(container: &Container) -> Vec<usize> {
    let root = &container.root;
    if let Some(scene) = root.scenes.get(root.scene.unwrap_or(0)) {
        return scene.nodes.clone();
    }
    let children: std::collections::BTreeSet<usize> =
        root.nodes.iter().flat_map(|n| n.children.iter().copied()).collect();
    (0..root.nodes.len()).filter(|i| !children.contains(i)).collect()
}

/// An animation that stands about, or the first: rest poses of figures often spread their arms.
fn chosen(animations: &[Animation]) -> Option<&Animation> {
    let idle = |a: &&Animation| {
        let name = a.name.as_deref().unwrap_or_default().to_lowercase();
        name.contains("idle") || name.contains("stand")
    };
    animations.iter().find(idle).or(animations.first())
}

type Moves = BTreeMap<(usize, &'static str), Vec<f32>>;

fn first_frame(container: &Container, animation: &Animation) -> Result<(Moves, BTreeMap<usize, Vec<f32>>), Fault> {
    let (mut moves, mut morphs) = (Moves::new(), BTreeMap::new());
    for (c, channel) in animation.channels.iter().enumerate() {
        let place = format!("animation {:?}: channels[{c}]", animation.name.as_deref().unwrap_or_default());
        let (Some(node), Some(sampler)) = (channel.target.node, animation.samplers.get(channel.sampler)) else {
            continue;
        };
        // A cubic spline's key is tangent, value, tangent.
        let skip = usize::from(sampler.interpolation == "CUBICSPLINE");
        let (path, width) = match channel.target.path.as_str() {
            "translation" => ("translation", 3),
            "rotation" => ("rotation", 4),
            "scale" => ("scale", 3),
            "weights" => {
                let mesh = container.root.nodes.get(node).and_then(|n| container.root.meshes.get(n.mesh?));
                let targets = mesh.and_then(|m| m.primitives.first()).map_or(0, |p| p.targets.len());
                let values = container.floats(sampler.output, 1, &place)?;
                if let Some(first) = values.get(skip * targets..(skip + 1) * targets) {
                    morphs.insert(node, first.to_vec());
                }
                continue;
            }
            _ => continue,
        };
        let values = container.floats(sampler.output, width, &place)?;
        if let Some(first) = values.get(skip * width..(skip + 1) * width) {
            moves.insert((node, path), first.to_vec());
        }
    }
    Ok((moves, morphs))
}
