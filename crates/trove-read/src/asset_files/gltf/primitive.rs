//! A primitive's vertices and triangles.

use glam::{Vec2, Vec3, vec2};

use super::container::Container;
use super::json::Primitive;
use super::packed::Draco;
use crate::asset_files::fault::Fault;

/// A primitive as it stands in the file, morphed and not yet skinned.
#[derive(Debug, Default)]
pub(super) struct Geometry {
    pub(super) positions: Vec<Vec3>,
    pub(super) normals: Vec<Vec3>,
    /// v runs down the picture, as in glTF.
    pub(super) uvs: Vec<Vec2>,
    /// Linear RGB.
    pub(super) tints: Vec<Vec3>,
    /// Four joints of the skin a vertex, and how much each of them moves it.
    pub(super) joints: Vec<[u32; 4]>,
    pub(super) weights: Vec<[f32; 4]>,
    pub(super) triangles: Vec<[u32; 3]>,
}

impl Geometry {
    /// Reads a primitive with the texture coordinates of `uv_set`; `None` for points and lines.
    pub(super) fn read(
        container: &Container,
        primitive: &Primitive,
        uv_set: usize,
        morph_weights: &[f32],
        place: &str,
    ) -> Result<Option<Self>, Fault> {
        let mode = primitive.mode.unwrap_or(4);
        if !(4..=6).contains(&mode) {
            return Ok(None);
        }
        let ext = primitive.extensions.get("KHR_draco_mesh_compression");
        let draco = ext.map(|ext| Draco::decode(container, ext, place)).transpose()?;
        let source = Source { container, primitive, draco, place };
        let Some(mut positions) = source.vectors("POSITION")? else {
            return Err(Fault::damaged(place, "positions", "none"));
        };
        let count = positions.len();
        let mut normals = source.vectors("NORMAL")?.unwrap_or_default();
        for (target, &weight) in primitive.targets.iter().zip(morph_weights).filter(|(_, w)| **w != 0.0) {
            for (name, values) in [("POSITION", &mut positions), ("NORMAL", &mut normals)] {
                let Some(&accessor) = target.get(name) else { continue };
                let moves = container.floats(accessor, 3, place)?;
                values.iter_mut().zip(moves.chunks_exact(3)).for_each(|(v, m)| *v += Vec3::from_slice(m) * weight);
            }
        }
        let uvs = source.floats(&format!("TEXCOORD_{uv_set}"), 2)?.unwrap_or_default();
        let width = source.components("COLOR_0");
        let colors = if width == 3 || width == 4 { source.floats("COLOR_0", width)? } else { None };
        let tints = colors.unwrap_or_default().chunks_exact(width.max(1)).map(Vec3::from_slice).collect();
        let weights = source.floats("WEIGHTS_0", 4)?.unwrap_or_default();
        let joints = match primitive.attributes.get("JOINTS_0") {
            Some(&accessor) if source.draco.is_none() => container.integers(accessor, 4, place)?,
            _ => source.floats("JOINTS_0", 4)?.unwrap_or_default().iter().map(|&j| j as u32).collect(),
        };
        let triangles = match (&source.draco, primitive.indices) {
            (Some(draco), _) => draco.triangles.clone(),
            (None, Some(accessor)) => triangles(&container.integers(accessor, 1, place)?, mode),
            (None, None) => triangles(&(0..count as u32).collect::<Vec<_>>(), mode),
        };
        let quads = |values: &[u32]| values.chunks_exact(4).map(|c| [c[0], c[1], c[2], c[3]]).collect();
        Ok(Some(Self {
            positions,
            normals,
            uvs: uvs.chunks_exact(2).map(|c| vec2(c[0], c[1])).collect(),
            tints,
            joints: quads(&joints),
            weights: weights.chunks_exact(4).map(|c| [c[0], c[1], c[2], c[3]]).collect(),
            triangles,
        }))
    }
}

/// Where a primitive's attributes are.
struct Source<'a> {
    container: &'a Container,
    primitive: &'a Primitive,
    draco: Option<Draco>,
    place: &'a str,
}

impl Source<'_> {
    fn floats(&self, name: &str, components: usize) -> Result<Option<Vec<f32>>, Fault> {
        let Some(&accessor) = self.primitive.attributes.get(name) else { return Ok(None) };
        if let Some(mut values) = self.draco.as_ref().and_then(|d| d.floats(name, components)) {
            let a = self.container.root.accessors.get(accessor).filter(|a| a.normalized);
            let scale = a.map_or(1.0, |a| match a.component_type {
                5120 => 127.0,
                5121 => 255.0,
                5122 => 32767.0,
                5123 => 65535.0,
                _ => 1.0,
            });
            values.iter_mut().for_each(|v| *v /= scale);
            return Ok(Some(values));
        }
        self.container.floats(accessor, components, &format!("{}: {name}", self.place)).map(Some)
    }

    fn vectors(&self, name: &str) -> Result<Option<Vec<Vec3>>, Fault> {
        Ok(self.floats(name, 3)?.map(|values| values.chunks_exact(3).map(Vec3::from_slice).collect()))
    }

    fn components(&self, name: &str) -> usize {
        let packed = self.draco.as_ref().map(|d| d.components(name)).filter(|&n| n > 0);
        let plain = || self.primitive.attributes.get(name).map_or(0, |&a| self.container.components(a));
        packed.unwrap_or_else(plain)
    }
}

/// Triangles of a list (4), a strip (5) or a fan (6) of corners.
fn triangles(corners: &[u32], mode: u32) -> Vec<[u32; 3]> {
    match mode {
        4 => corners.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect(),
        // Every other triangle of a strip runs the other way round.
        5 => corners
            .windows(3)
            .enumerate()
            .map(|(i, c)| if i % 2 == 0 { [c[0], c[1], c[2]] } else { [c[1], c[0], c[2]] })
            .collect(),
        _ => corners.windows(2).skip(1).map(|c| [corners[0], c[0], c[1]]).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::triangles;

    #[test]
    fn strips_and_fans_keep_their_winding() {
        assert_eq!(triangles(&[0, 1, 2, 3], 5), [[0, 1, 2], [2, 1, 3]]);
        assert_eq!(triangles(&[0, 1, 2, 3], 6), [[0, 1, 2], [0, 2, 3]]);
        assert!(triangles(&[0], 6).is_empty() && triangles(&[], 5).is_empty());
    }
}
