//! A frame in the layout of `trove generate`, as whoever reads it hands it over.

use glam::{DAffine3, DMat3, DVec2, DVec3};
use trove_format::{FrameTable, Matrix4, ObjectOrigin, ObjectRow, SweepTable};
use trove_model::{Class, InPatches, Lens, LidarPoint, Occlusion, Patches, Raster, Role};

/// What is known of a frame; images that it does not have are `None`. Those in patches have those of [`patches`].
#[derive(Clone, Debug)]
pub struct LabelledFrame {
    /// Its folder below the dataset's.
    pub place: String,
    /// Camera and objects.
    pub table: FrameTable,
    /// The image, 8-bit sRGB.
    pub rgb: Option<Raster<[u8; 3]>>,
    /// Classes.
    pub class: Option<Raster<Class>>,
    /// Ids of objects; 0: none.
    pub instance: Option<Raster<u16>>,
    /// Metres along the camera's z axis; +inf: sky.
    pub depth_m: Option<Raster<f32>>,
    /// Unit normals in Camera; 0: sky.
    pub normal: Option<InPatches<[f32; 3]>>,
    /// Pixels to the next and the previous moment's image, right and down; NaN: not defined.
    pub flow: [Option<InPatches<[f32; 2]>>; 2],
    /// Whether those images show the same.
    pub occluded: [Option<Raster<Occlusion>>; 2],
    /// 65536 · class + object.
    pub panoptic: Option<Raster<u32>>,
    /// Parts of objects.
    pub part: Option<Raster<Option<Role>>>,
    /// Metres along the ray; +inf: sky.
    pub range_m: Option<InPatches<f32>>,
    /// Unit normals in World; 0: sky.
    pub normal_world: Option<InPatches<[f32; 3]>>,
    /// Where a point is in its object's box, 0 to 1; NaN: no box.
    pub object_coordinates: Option<InPatches<[f32; 3]>>,
    /// Metres in World to where the point is at the next and was at the previous moment; NaN: not defined.
    pub scene_flow: [Option<InPatches<[f32; 3]>>; 2],
    /// Files that cannot be read, each with what was expected and found.
    pub damage: Vec<String>,
}

/// What is known of a LiDAR's sweep.
#[derive(Clone, Debug)]
pub struct LabelledSweep {
    /// Its folder below the dataset's.
    pub place: String,
    /// The sweep and its objects.
    pub table: SweepTable,
    /// Its points, in the sensor's axes at the sweep's time.
    pub points: Vec<LidarPoint>,
}

impl LabelledFrame {
    /// The camera; what is wrong with its numbers.
    pub(super) fn eye(&self) -> Result<Eye, String> {
        let table = &self.table;
        let [[fx_px, skew, cx_px], [below, fy_px, cy_px], last] = table.intrinsics;
        let is_k = fx_px > 0.0 && fy_px > 0.0 && [skew, below] == [0.0; 2] && last == [0.0, 0.0, 1.0];
        if !(is_k && cx_px.is_finite() && cy_px.is_finite()) {
            let found = &table.intrinsics;
            return Err(format!("intrinsics: expected positive focal lengths and no skew, found {found:?}"));
        }
        let distortion = table.lens_model.distortion(&table.distortion)?;
        let (width_px, height_px) = (table.width_px, table.height_px);
        let lens = Lens { width_px, height_px, fx_px, fy_px, cx_px, cy_px, distortion };
        let world_from_camera = rigid(&table.world_from_camera, "world_from_camera")?;
        let quaternion = glam::DQuat::from_xyzw(
            table.world_from_camera_rotation_wxyz[1],
            table.world_from_camera_rotation_wxyz[2],
            table.world_from_camera_rotation_wxyz[3],
            table.world_from_camera_rotation_wxyz[0],
        );
        let apart = (DMat3::from_quat(quaternion) - world_from_camera.matrix3).to_cols_array().map(f64::abs);
        let moved = DVec3::from_array(table.world_from_camera_translation_m) - world_from_camera.translation;
        if !quaternion.is_normalized() || apart.iter().any(|part| *part > 1e-6) || moved.length() > 1e-6 {
            let fields = "world_from_camera_rotation_wxyz and world_from_camera_translation_m";
            return Err(format!("{fields}: expected the pose of world_from_camera, found another"));
        }
        Ok(Eye { lens, world_from_camera, camera_from_world: world_from_camera.inverse() })
    }

    /// The row of an object.
    pub(super) fn object(&self, id: u16) -> Option<&ObjectRow> {
        self.table.objects.iter().find(|object| object.id == u32::from(id))
    }

    /// By id, whether something holds of the object; not of ids that no object has.
    pub(super) fn ids(&self, holds: impl Fn(&ObjectRow) -> bool) -> Vec<bool> {
        let mut ids = vec![false; usize::from(u16::MAX) + 1];
        for object in self.table.objects.iter().filter(|object| holds(object)) {
            if let Some(slot) = ids.get_mut(object.id as usize) {
                *slot = true;
            }
        }
        ids
    }

    /// By id, what stands still: what no object is, and scenery.
    pub(super) fn stands_still(&self) -> Vec<bool> {
        let mut still = self.ids(|object| object.origin == ObjectOrigin::Scenery);
        still[0] = true;
        still
    }
}

/// A rigid transform that a table tells.
pub(super) fn rigid(matrix: &Matrix4, field: &str) -> Result<DAffine3, String> {
    let [x, y, z, last] = *matrix;
    let rotation = DMat3::from_cols_array(&[x[0], y[0], z[0], x[1], y[1], z[1], x[2], y[2], z[2]]);
    let apart = (rotation * rotation.transpose() - DMat3::IDENTITY).to_cols_array().map(f64::abs);
    let is_rotation = apart.iter().all(|part| *part < 1e-6) && rotation.determinant() > 0.0;
    let translation = DVec3::new(x[3], y[3], z[3]);
    if !(is_rotation && translation.is_finite() && last == [0.0, 0.0, 0.0, 1.0]) {
        return Err(format!("{field}: expected a rotation and a translation, found {matrix:?}"));
    }
    Ok(DAffine3 { matrix3: rotation, translation })
}

/// A camera that can be reckoned with.
#[derive(Clone, Debug)]
pub(super) struct Eye {
    pub(super) lens: Lens,
    pub(super) world_from_camera: DAffine3,
    pub(super) camera_from_world: DAffine3,
}

/// Nearer to the plane of the camera depth along its axis tells little of where a point is, as a cosine.
const AXIAL: f64 = 0.05;

impl Eye {
    /// The unit direction in Camera through a pixel's centre, where depth along the axis tells how far a point is.
    pub(super) fn direction(&self, [x, y]: [u32; 2]) -> Option<DVec3> {
        let direction = self.lens.unproject(DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5))?;
        (direction.z > AXIAL).then_some(direction)
    }

    /// What a pixel shows, in Camera, metres.
    pub(super) fn point(&self, pixel: [u32; 2], depth_m: f32) -> Option<DVec3> {
        let direction = self.direction(pixel)?;
        depth_m.is_finite().then(|| direction * (f64::from(depth_m) / direction.z))
    }

    /// The pixel in which a point in World falls, with its depth.
    pub(super) fn sees(&self, point_world: DVec3) -> Option<([u32; 2], f64)> {
        let point = self.camera_from_world.transform_point3(point_world);
        let pixel = self.lens.project(point).filter(|pixel| self.lens.contains(*pixel))?;
        (point.z > AXIAL * point.length()).then_some(([pixel.x as u32, pixel.y as u32], point.z))
    }
}

/// Holes in leaves, fences and wires are finer than pixels.
pub(super) fn is_porous(class: Class) -> bool {
    matches!(class, Class::Tree | Class::Bush | Class::Barrier | Class::Void | Class::Ground)
}

/// Pixels with their values.
pub(super) fn pixels<T>(raster: &Raster<T>) -> impl Iterator<Item = ([u32; 2], &T)> {
    // Two divisions a pixel would take longer than most of what is asked of it.
    let mut next = [0, 0];
    raster.data.iter().map(move |value| {
        let [x, y] = next;
        next = if x + 1 == raster.width { [0, y + 1] } else { [x + 1, y] };
        ([x, y], value)
    })
}

/// The 3 × 3 values around a pixel, as far as they are in the image.
pub(super) fn around<T: Copy>(raster: &Raster<T>, [x, y]: [u32; 2]) -> impl Iterator<Item = T> + '_ {
    let columns = x.saturating_sub(1)..=(x + 1).min(raster.width - 1);
    let rows = y.saturating_sub(1)..=(y + 1).min(raster.height - 1);
    rows.flat_map(move |y| columns.clone().map(move |x| *raster.at(x, y)))
}

/// The least and the greatest depth around a pixel, metres.
pub(super) fn extremes(depth_m: &Raster<f32>, pixel: [u32; 2]) -> (f64, f64) {
    around(depth_m, pixel).fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), depth| {
        (least.min(f64::from(depth)), most.max(f64::from(depth)))
    })
}

/// Pixels that are compared where a share of them tells enough.
pub(super) const SAMPLES: u32 = 30_000;

/// Pixels that are compared where each of many small things has its own share.
pub(super) const DENSE: u32 = 400_000;

/// Pixels spread evenly over an image, not counting the rim: all of a small one, at most about so many of a large one.
pub(super) fn spread(width: u32, height: u32, most: u32) -> impl Iterator<Item = [u32; 2]> {
    let step = step(f64::from(width) * f64::from(height), most);
    let rows = (1..height.saturating_sub(1)).step_by(step);
    rows.flat_map(move |y| (1..width.saturating_sub(1)).step_by(step).map(move |x| [x, y]))
}

/// Parts of which a frame's numbers are read: about 400,000 pixels, since unpacking them takes most of the time. Two
/// moments after each other have the same parts, and all have had their turn after some more.
pub fn patches(table: &FrameTable) -> Patches {
    let pixels = u64::from(table.width_px) * u64::from(table.height_px);
    let every = pixels.div_ceil(u64::from(DENSE));
    Patches::one_of(u32::try_from(every).unwrap_or(u32::MAX), table.keyframe / 2)
}

/// [`spread`] over those pixels that are known.
pub(super) fn known<T>(image: &InPatches<T>, most: u32) -> impl Iterator<Item = ([u32; 2], &T)> {
    let (Raster { width, height, .. }, patches) = (&image.raster, image.patches);
    let (width, height) = (*width, *height);
    // Of the rim nothing is asked.
    let columns = move |y| patches.columns(width.saturating_sub(1), y).filter(|x| *x > 0);
    let known: u64 = (0..height).step_by(Patches::SIDE as usize).map(|y| columns(y).count() as u64).sum();
    let step = step(known as f64 * f64::from(Patches::SIDE), most);
    let rows = (1..height.saturating_sub(1)).step_by(step);
    rows.flat_map(move |y| columns(y).step_by(step).map(move |x| ([x, y], image.raster.at(x, y))))
}

/// One of so many columns and rows are as many pixels.
fn step(pixels: f64, most: u32) -> usize {
    (pixels / f64::from(most)).sqrt().ceil().max(1.0) as usize
}
