//! A .glb file, such as `trove build` writes it.

use std::path::Path;

use anyhow::{Result, ensure};
use glam::DVec3;
use serde_json::json;
use trove_format::ObjectOrigin;
use trove_read::asset_files::{FileNode, FileScene, read_scene};

use super::chunks::Chunks;
use super::pose::pose;
use super::scene::{SceneChunk, Thing, Things, centimetres};
use super::shapes::{Shapes, Stand, Stock};
use super::table::{Camera, SceneRow, Table};

/// Adds what stands in a file, as a scene of one moment.
pub(super) fn add(path: &Path, table: &mut Table, chunks: &mut Chunks) -> Result<()> {
    let scene = read_scene(path)?;
    ensure!(!scene.nodes.is_empty(), "{}: expected a scene with meshes, found none", path.display());
    let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let mut row = SceneRow::new(name.clone(), name.clone(), name.clone());
    let moment = row.moment(0);
    moment.frames.extend(scene.cameras.iter().map(|camera| Camera::of_file(&name, camera)));
    let mut chunk = SceneChunk::default();
    chunk.moments.push(Things::default());
    let (mut stands, mut bodies) = (Vec::new(), Vec::new());
    for node in &scene.nodes {
        let stand = Stand { mesh: node.mesh, materials: &node.materials, place: node.world_from_mesh };
        let thing = thing(node);
        match (&node.cuboid, &thing) {
            (Some((world_from_body, _)), Some(thing)) if thing.origin != ObjectOrigin::Scenery => {
                bodies.push((node.id, Stand { place: world_from_body.inverse() * stand.place, ..stand }));
            }
            _ => stands.push(stand),
        }
        if let Some(thing) = thing {
            chunk.add(thing);
        }
    }
    let stock = Stock { meshes: &scene.meshes, materials: &scene.materials };
    let mut shapes = Shapes::of(stock, &stands, &standpoints(&scene));
    shapes.add_bodies(stock, &bodies);
    chunk.shapes = Some(shapes);
    chunks.add(&name, &chunk)?;
    table.scenes.push(row);
    Ok(())
}

/// Near what most detail is wanted: where cameras stand, else what is in the middle.
fn standpoints(scene: &FileScene) -> Vec<DVec3> {
    let cameras: Vec<DVec3> = scene.cameras.iter().map(|camera| camera.world_from_camera.translation).collect();
    let nodes = scene.nodes.iter().map(|node| node.world_from_mesh.translation);
    if cameras.is_empty() { vec![nodes.sum::<DVec3>() / scene.nodes.len() as f64] } else { cameras }
}

fn thing(node: &FileNode) -> Option<Thing> {
    let (world_from_body, size_m) = &node.cuboid?;
    Some(Thing {
        id: node.id,
        class_id: node.class?.id(),
        kind: node.kind?.name(),
        origin: serde_json::from_value(json!(node.origin)).ok()?,
        asset: node.asset.clone(),
        pose: pose(world_from_body),
        size: size_m.map(centimetres),
    })
}
