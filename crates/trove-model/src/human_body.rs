//! A body that takes on people's shapes and postures.

use std::collections::BTreeMap;

use glam::Vec3;

/// A mesh of a human being, clothing helpers included, with what shapes and moves it.
///
/// Metres, x forward, y to the body's left, z up. It stands with its arms held off its sides; the floor is anywhere.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HumanBody {
    /// Licence and author.
    pub licence: String,
    /// Vertices of the shape without any target.
    pub positions: Vec<Vec3>,
    /// Four corners a face, counter-clockwise seen from outside, by group (`body`, `helper-tights`); a triangle has its
    /// last corner twice.
    pub groups: BTreeMap<String, Vec<[u32; 4]>>,
    /// What moves which vertices where at full weight, by name (`universal-male-young-maxmuscle-averageweight`).
    pub targets: BTreeMap<String, Vec<(u32, Vec3)>>,
    /// Parents before their children; the first has none.
    pub joints: Vec<BodyJoint>,
    /// For each vertex the joints that move it and their shares, which come to 1.
    pub weights: Vec<[(u16, f32); 4]>,
}

/// A joint of the rig.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyJoint {
    /// Unique (`calf_l`).
    pub name: String,
    /// Index of what it hangs on.
    pub parent: Option<usize>,
    /// Vertices in whose middle it is, in every shape.
    pub around: Vec<u32>,
}
