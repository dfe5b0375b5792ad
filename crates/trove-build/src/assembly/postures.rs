//! Shapes between two postures, and those some parts of which have moved, made for the scenes that show them: over a clip there
//! are many.

use std::collections::HashMap;
use std::sync::Arc;

use glam::Vec3;
use trove_model::Mesh;

use super::legs::{FootMove, Legs};
use super::pedals::Pedals;
use super::wheels::{Wheel, roll};

/// A shape: a mesh, or one on the way to another of the same triangles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Posed {
    /// Index of the mesh in the stock.
    pub mesh: usize,
    /// Index of the other, and the share of the way to it, 0 to 1.
    pub towards: Option<(usize, f32)>,
}

/// What of a shape moves by itself.
#[derive(Clone, Debug, Default)]
pub(crate) struct Joints {
    /// What turns as it drives.
    pub wheels: Arc<[Wheel]>,
    /// What is turned by feet.
    pub pedals: Option<Arc<Pedals>>,
    /// What follows feet.
    pub legs: Option<Arc<Legs>>,
}

/// How far it has moved.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Bend {
    /// How far its wheels have rolled, metres of its mesh.
    pub rolled_m: f64,
    /// How curved its way is, 1/m of its mesh, positive to the left.
    pub curve_per_m: f64,
    /// How far its cranks have turned forward, radians.
    pub cranks_rad: f64,
    /// Where its left and its right foot are.
    pub feet: [FootMove; 2],
}

/// The meshes of one scene: the stock's, and behind them those of postures between two of these, and with parts moved.
pub(crate) struct MeshesNow {
    meshes: Vec<Arc<Mesh>>,
    // Only ever looked up, so the order inside does not reach the scene.
    known: HashMap<(usize, usize, u32), usize>,
    bent: HashMap<(usize, Vec<u64>), usize>,
}

impl MeshesNow {
    /// Those of a stock alone.
    pub(crate) fn new(stock: &[Arc<Mesh>]) -> Self {
        Self { meshes: stock.to_vec(), known: HashMap::new(), bent: HashMap::new() }
    }

    /// The index of a shape.
    pub(super) fn index(&mut self, Posed { mesh, towards }: Posed) -> usize {
        let Some((other, share)) = towards else { return mesh };
        let meshes = &mut self.meshes;
        *self.known.entry((mesh, other, share.to_bits())).or_insert_with(|| {
            meshes.push(Arc::new(between(&meshes[mesh], &meshes[other], share)));
            meshes.len() - 1
        })
    }

    /// The index of a shape some of which has moved.
    pub(super) fn bent(&mut self, posed: Posed, joints: &Joints, bend: &Bend) -> usize {
        let mesh = self.index(posed);
        let Bend { rolled_m, curve_per_m, cranks_rad, feet } = bend;
        let rolls = !joints.wheels.is_empty() && (*rolled_m, *curve_per_m) != (0.0, 0.0);
        let legs = joints.legs.as_ref().filter(|_| *feet != <[FootMove; 2]>::default());
        let pedals = joints.pedals.as_ref().filter(|_| *cranks_rad != 0.0);
        if !rolls && legs.is_none() && pedals.is_none() {
            return mesh;
        }
        let meshes = &mut self.meshes;
        *self.bent.entry((mesh, bend.key())).or_insert_with(|| {
            let mut bent = Mesh::clone(&meshes[mesh]);
            if rolls {
                roll(&mut bent, &joints.wheels, *rolled_m, *curve_per_m);
            }
            if let Some(pedals) = pedals {
                pedals.turn(&mut bent, *cranks_rad);
            }
            if let Some(legs) = legs {
                legs.bend(&mut bent, feet);
            }
            meshes.push(Arc::new(bent));
            meshes.len() - 1
        })
    }

    /// All of them.
    pub(crate) fn into_meshes(self) -> Vec<Arc<Mesh>> {
        self.meshes
    }
}

impl Bend {
    /// Tells it from all others.
    fn key(&self) -> Vec<u64> {
        let Self { rolled_m, curve_per_m, cranks_rad, feet } = self;
        let of_foot = |FootMove { about, shift, turn_rad, down }: &FootMove| {
            let numbers = [about.to_array(), shift.to_array(), down.to_array(), [*turn_rad, 0.0, 0.0]];
            numbers.as_flattened().iter().map(|number| u64::from(number.to_bits())).collect::<Vec<u64>>()
        };
        [rolled_m, curve_per_m, cranks_rad]
            .map(|number| number.to_bits())
            .into_iter()
            .chain(feet.iter().flat_map(of_foot))
            .collect()
    }
}

/// A mesh on the way to another, each vertex on a straight line.
fn between(from: &Mesh, to: &Mesh, share: f32) -> Mesh {
    let on_the_way = |from: &[Vec3], to: &[Vec3]| -> Vec<Vec3> {
        from.iter().zip(to).map(|(from, to)| from.lerp(*to, share)).collect()
    };
    let normals = on_the_way(&from.normals, &to.normals);
    let unit = normals.into_iter().zip(&from.normals).map(|(normal, own)| normal.try_normalize().unwrap_or(*own));
    Mesh {
        positions: on_the_way(&from.positions, &to.positions),
        normals: unit.collect(),
        uvs: from.uvs.clone(),
        tints: from.tints.clone(),
        triangles: from.triangles.clone(),
        slots: from.slots.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shape_between_two_is_made_once_and_keeps_what_is_no_place() {
        let mesh = |x: f32, normal: Vec3| {
            let positions = vec![Vec3::ZERO, Vec3::X + Vec3::Z * x, Vec3::Y];
            Arc::new(Mesh { positions, normals: vec![normal; 3], triangles: vec![[0, 1, 2]], ..Mesh::default() })
        };
        let stock = [mesh(0.0, Vec3::Z), mesh(1.0, Vec3::X)];
        let mut meshes = MeshesNow::new(&stock);
        let quarter = Posed { mesh: 0, towards: Some((1, 0.25)) };
        assert_eq!(meshes.index(Posed { mesh: 1, towards: None }), 1);
        assert_eq!((meshes.index(quarter), meshes.index(quarter)), (2, 2));
        let made = &meshes.into_meshes()[2];
        assert_eq!((made.positions[1], made.defect()), (Vec3::new(1.0, 0.0, 0.25), None));
        assert!(made.normals.iter().all(|normal| normal.is_normalized() && normal.z > normal.x));
        assert_eq!(made.triangles, stock[0].triangles);
    }
}
