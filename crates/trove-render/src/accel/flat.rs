//! A scene's shapes as tables of plain numbers, which lie in this processor's memory or in a card's.

use std::any::Any;
use std::collections::BTreeMap;
use std::convert::Infallible;
use std::sync::Arc;

use glam::Vec2;
use trove_model::Mesh;
use trove_trace::{
    Asked, FlatLook, FlatMesh, FlatOpacity, FlatScene, FlatTexture, Look, Motion, NONE, Placement, SHELTERS, STAYS,
    Table,
};

use super::hierarchy::Hierarchy;
use super::obvhs::{Bottom, over};
use super::shapes::Shapes;
use crate::ray::Ray;
use crate::texture::MipMap;

/// The tables of a scene in which something is.
pub(crate) struct Flat {
    shapes: Arc<Shapes>,
    over: Hierarchy,
    placements: Vec<Placement>,
    motions: Vec<Motion>,
    /// Each mesh, and its lowest z, metres.
    meshes: Vec<(Arc<Mesh>, f32)>,
    materials: Vec<u32>,
}

impl Flat {
    /// `None` where nothing is in the scene.
    pub(crate) fn new(shapes: &Arc<Shapes>) -> Option<Self> {
        let over = over(&shapes.placed)?;
        let (mut placements, mut motions, mut materials) = (Vec::new(), Vec::new(), Vec::new());
        let mut meshes = Vec::new();
        let mut numbers: BTreeMap<usize, u32> = BTreeMap::new();
        for placed in &shapes.placed {
            let mesh = *numbers.entry(Arc::as_ptr(&placed.mesh) as usize).or_insert_with(|| {
                meshes.push((placed.mesh.clone(), placed.foot_z));
                meshes.len() as u32 - 1
            });
            let judged = shapes.lets_pass(placed);
            let stays = STAYS.iter().zip(placed.stays).map(|(mark, stays)| mark * u32::from(stays)).sum::<u32>();
            placements.push(Placement {
                mesh_from_world: placed.world_from_mesh.middle.inverse(),
                motion: placed.world_from_mesh.flat().map_or(NONE, |motion| listed(&mut motions, [motion])),
                mesh,
                id: placed.id.0,
                marks: stays | (SHELTERS * u32::from(placed.sort.shelters())),
                materials: if judged { listed(&mut materials, placed.materials.iter().copied()) } else { NONE },
            });
        }
        Some(Self { shapes: shapes.clone(), over, placements, motions, meshes, materials })
    }

    /// Each mesh, and its lowest z, metres.
    pub(crate) fn meshes(&self) -> &[(Arc<Mesh>, f32)] {
        &self.meshes
    }

    /// The tables in some memory, into which `hold` puts each of them, and what each mesh looks like.
    pub(crate) fn scene<H: Hold>(&self, hold: &mut H) -> Result<(FlatScene, Table<FlatLook>), H::Error> {
        let (mut meshes, mut looks) = (Vec::new(), Vec::new());
        for (mesh, foot_z) in &self.meshes {
            let (mesh, look) = hold.mesh(mesh, *foot_z)?;
            meshes.push(mesh);
            looks.push(look);
        }
        let mut opacities = Vec::with_capacity(self.shapes.opacities.len());
        for opacity in self.shapes.opacities.iter() {
            let is_pane = u32::from(opacity.is_pane());
            opacities.push(match opacity.holes() {
                Some((mask, scale)) => FlatOpacity { holes: hold.hold(mask.blocks)?, size: mask.size, scale, is_pane },
                None => FlatOpacity { holes: Table::at(0, 0), size: [8; 2], scale: Vec2::ONE, is_pane },
            });
        }
        let scene = FlatScene {
            pairs: hold.hold(&self.over.pairs)?,
            order: hold.hold(&self.over.order)?,
            placements: hold.hold(&self.placements)?,
            motions: hold.hold(&self.motions)?,
            meshes: hold.hold(&meshes)?,
            materials: hold.hold(&self.materials)?,
            opacities: hold.hold(&opacities)?,
            root: self.over.root,
        };
        Ok((scene, hold.hold(&looks)?))
    }
}

/// A memory that tables are put into.
pub(crate) trait Hold {
    type Error;

    /// Where the values lie from now on.
    fn hold<T: Copy + Send + Sync + 'static>(&mut self, values: &[T]) -> Result<Table<T>, Self::Error>;

    /// A mesh as it is traced and as it looks, with its lowest z, metres.
    fn mesh(&mut self, mesh: &Arc<Mesh>, foot_z: f32) -> Result<(FlatMesh, FlatLook), Self::Error> {
        flat_mesh(self, mesh, foot_z)
    }

    /// A texture that many may share.
    fn map(&mut self, map: &Arc<MipMap>) -> Result<FlatTexture, Self::Error> {
        flat_map(self, map)
    }
}

/// A mesh in a memory of its own or of all.
pub(crate) fn flat_mesh<H: Hold + ?Sized>(
    hold: &mut H,
    mesh: &Mesh,
    foot_z: f32,
) -> Result<(FlatMesh, FlatLook), H::Error> {
    let bottom = Bottom::new(mesh);
    let traced = FlatMesh {
        pairs: hold.hold(&bottom.pairs)?,
        corners: hold.hold(&bottom.corners)?,
        looks: hold.hold(&looks(mesh))?,
        root: bottom.root,
    };
    let look = FlatLook {
        triangles: hold.hold(&mesh.triangles)?,
        positions: hold.hold(&mesh.positions)?,
        normals: hold.hold(&mesh.normals)?,
        uvs: hold.hold(&mesh.uvs)?,
        tints: hold.hold(&mesh.tints)?,
        slots: hold.hold(&mesh.slots)?,
        foot_z,
    };
    Ok((traced, look))
}

/// A texture in a memory of its own or of all.
pub(crate) fn flat_map<H: Hold + ?Sized>(hold: &mut H, map: &MipMap) -> Result<FlatTexture, H::Error> {
    let texture = map.texture();
    let (firsts, texels) = (hold.hold(texture.firsts)?, hold.hold(texture.texels)?);
    // SAFETY: whoever holds them keeps them.
    Ok(unsafe { FlatTexture::new(texture.size, firsts, texels, texture.is_srgb) })
}

/// Copies in the processor's memory.
#[derive(Default)]
pub(crate) struct Here(Vec<Box<dyn Any + Send + Sync>>);

impl Hold for Here {
    type Error = Infallible;

    fn hold<T: Copy + Send + Sync + 'static>(&mut self, values: &[T]) -> Result<Table<T>, Infallible> {
        let copies = Box::new(values.to_vec());
        let table = Table::at(copies.as_ptr() as u64, copies.len());
        self.0.push(copies);
        Ok(table)
    }
}

/// A ray as the tables' functions want it.
pub(crate) fn asked(ray: &Ray) -> Asked {
    Asked {
        ray: ray.plain(),
        past: ray.past.map_or(0, |id| id.0),
        marks: ray.beside.map_or(0, |beside| STAYS[beside as usize]) | (SHELTERS * u32::from(ray.for_shelter)),
        through_glass: u32::from(ray.through_glass),
    }
}

/// Puts values at the end of a table; the index of the first.
fn listed<T>(table: &mut Vec<T>, values: impl IntoIterator<Item = T>) -> u32 {
    let first = table.len() as u32;
    table.extend(values);
    first
}

fn looks(mesh: &Mesh) -> Vec<Look> {
    let corners = |t: &[u32; 3]| if mesh.uvs.is_empty() { [Vec2::ZERO; 3] } else { t.map(|i| mesh.uvs[i as usize]) };
    let look = |(i, t): (usize, &[u32; 3])| Look { uvs: corners(t), slot: u32::from(mesh.slot(i)) };
    mesh.triangles.iter().enumerate().map(look).collect()
}

#[cfg(test)]
mod tests;
