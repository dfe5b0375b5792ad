//! A file as a scene, node by node, such as `trove build` writes it.

use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::Arc;

use glam::{DAffine3, DMat3, DMat4, Mat4};
use serde_json::Value;
use trove_model::{Class, Kind, Material, Mesh};

use super::container::Container;
use super::json::Node;
use super::material::Looks;
use super::pose::Pose;
use super::{add_node, packed};
use crate::ReadError;
use crate::asset_files::fault::Fault;
use crate::asset_files::model::Model;
use crate::asset_files::picture::Pictures;

/// What stands in a file, in World (z up).
#[derive(Debug, Default)]
pub struct FileScene {
    /// Shapes.
    pub meshes: Vec<Arc<Mesh>>,
    /// Materials.
    pub materials: Vec<Material>,
    /// Meshes at their places.
    pub nodes: Vec<FileNode>,
    /// Cameras.
    pub cameras: Vec<FileCamera>,
}

/// A mesh somewhere.
#[derive(Debug)]
pub struct FileNode {
    /// Index of the mesh.
    pub mesh: usize,
    /// Index of the material of each of its slots.
    pub materials: Vec<usize>,
    /// Placement, with scale.
    pub world_from_mesh: DAffine3,
    /// What it is, where the file says so in our words.
    pub class: Option<Class>,
    /// Number in the labels; 0 for what is not counted.
    pub id: u32,
    /// Its kind, where the file says so in our words.
    pub kind: Option<Kind>,
    /// How it comes to be in the scene, in the words of [`Origin::name`](trove_model::Origin::name); empty where nothing is said.
    pub origin: String,
    /// The asset's id; empty where it has none.
    pub asset: String,
    /// Its box: from Body to World, and its size in metres, where the file says so.
    pub cuboid: Option<(DAffine3, [f64; 3])>,
}

/// A camera with its place.
#[derive(Debug)]
pub struct FileCamera {
    /// Its node's name.
    pub name: String,
    /// Camera (x right, y down, z forward) to World.
    pub world_from_camera: DAffine3,
    /// Columns and rows.
    pub size_px: [u32; 2],
    /// Focal lengths and the principal point, pixels.
    pub intrinsics_px: [f64; 4],
}

/// Rows of a picture of a camera that tells its opening alone.
const ROWS_PX: f64 = 900.0;
/// Textures are looked at for their mean colours.
const TEXTURE_PX: u32 = 256;

/// Reads a `.glb` or `.gltf` file.
///
/// # Errors
/// A file that cannot be read or is damaged.
pub fn read_scene(path: &Path) -> Result<FileScene, ReadError> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let pictures = Pictures::new("", folder, TEXTURE_PX);
    let bytes =
        trove_files::read_regular(path, trove_files::LARGEST_FILE).map_err(|error| ReadError::io(path, error))?;
    let container = packed::open(path, &bytes, &pictures.folder)?;
    assemble(&container, &pictures).map_err(|fault| fault.at(path))
}

fn assemble(container: &Container, pictures: &Pictures) -> Result<FileScene, Fault> {
    let pose = Pose::of(container)?;
    let mut looks = Looks::new(container, pictures);
    let mut scene = FileScene::default();
    // Holds the materials of all, and one mesh after the other.
    let mut model = Model::default();
    // A mesh that is bent by its node is another one.
    let mut known: BTreeMap<(usize, Option<usize>), (usize, Vec<usize>)> = BTreeMap::new();
    // glTF's y is up.
    let world_from_file = DAffine3::from_mat3(DMat3::from_rotation_x(std::f64::consts::FRAC_PI_2));
    for &(i, file_from_node) in &pose.placed {
        let node = &container.root.nodes[i];
        let world_from_node = world_from_file * DAffine3::from_mat4(file_from_node.as_dmat4());
        if let Some(camera) = node.camera {
            scene.cameras.extend(self::camera(container, node, camera, &world_from_node));
        }
        let Some(mesh) = node.mesh else { continue };
        let is_bent = node.skin.is_some() || !node.weights.is_empty() || pose.morphs.contains_key(&i);
        let key = (mesh, is_bent.then_some(i));
        if let Entry::Vacant(new) = known.entry(key) {
            add_node(container, (i, Mat4::IDENTITY), &pose, &mut looks, &mut model)?;
            let mut mesh = std::mem::take(&mut model.mesh);
            let used = own_slots(&mut mesh);
            scene.meshes.push(Arc::new(mesh));
            new.insert((scene.meshes.len() - 1, used));
        }
        let (mesh, materials) = known[&key].clone();
        // Joints move vertices into the file's axes.
        let world_from_mesh = if node.skin.is_some() { world_from_file } else { world_from_node };
        let number = |name: &str| node.extras.get(name).and_then(Value::as_u64);
        let text = |name: &str| node.extras.get(name).and_then(Value::as_str).unwrap_or_default().to_owned();
        scene.nodes.push(FileNode {
            mesh,
            materials,
            world_from_mesh,
            class: number("class_id").and_then(|id| Class::from_id(u8::try_from(id).ok()?)),
            id: number("id").and_then(|id| u32::try_from(id).ok()).unwrap_or_default(),
            kind: Kind::from_name(&text("kind")),
            origin: text("origin"),
            asset: text("asset"),
            cuboid: cuboid(&node.extras),
        });
    }
    scene.materials = model.materials;
    Ok(scene)
}

fn cuboid(extras: &Value) -> Option<(DAffine3, [f64; 3])> {
    let rows: [[f64; 4]; 4] = serde_json::from_value(extras.get("world_from_body")?.clone()).ok()?;
    let size_m = serde_json::from_value(extras.get("size_m")?.clone()).ok()?;
    Some((DAffine3::from_mat4(DMat4::from_cols_array_2d(&rows).transpose()), size_m))
}

/// Numbers a mesh's slots from 0 and says which materials they have.
fn own_slots(mesh: &mut Mesh) -> Vec<usize> {
    let used: BTreeSet<u16> = (0..mesh.triangles.len()).map(|t| mesh.slot(t)).collect();
    let used: Vec<u16> = used.into_iter().collect();
    for slot in &mut mesh.slots {
        *slot = used.binary_search(slot).unwrap_or_default() as u16;
    }
    used.into_iter().map(usize::from).collect()
}

/// A camera as its node's extras tell it, or as glTF does; `None` of a parallel projection.
fn camera(container: &Container, node: &Node, index: usize, world_from_node: &DAffine3) -> Option<FileCamera> {
    let camera = container.root.cameras.get(index)?;
    let extra = |name: &str| node.extras.get(name).and_then(Value::as_f64);
    let told = ["width_px", "height_px", "fx_px", "fy_px", "cx_px", "cy_px"].map(extra);
    let [w, h, fx, fy, cx, cy] = match told {
        [Some(w), Some(h), Some(fx), Some(fy), Some(cx), Some(cy)] => [w, h, fx, fy, cx, cy],
        _ => {
            let perspective = camera.perspective.as_ref()?;
            let columns = ROWS_PX * perspective.aspect_ratio.unwrap_or(16.0 / 9.0);
            let focal_px = 0.5 * ROWS_PX / (0.5 * perspective.yfov).tan();
            [columns, ROWS_PX, focal_px, focal_px, 0.5 * columns, 0.5 * ROWS_PX]
        }
    };
    // glTF's cameras look along −z with y up.
    let turned = *world_from_node * DAffine3::from_mat4(DMat4::from_scale(glam::DVec3::new(1.0, -1.0, -1.0)));
    Some(FileCamera {
        name: node.name.clone().or_else(|| camera.name.clone()).unwrap_or_else(|| format!("camera {index}")),
        world_from_camera: turned,
        size_px: [w.round() as u32, h.round() as u32],
        intrinsics_px: [fx, fy, cx, cy],
    })
}
