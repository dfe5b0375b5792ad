//! Scenes that are ready for pictures.

use std::path::PathBuf;
use std::sync::Arc;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use trove::{FreeCamera, PictureRequest, Raster, ReadyScene};

use crate::arrays::{channels, occlusion, parts, values};
use crate::attended::attended;
use crate::error::trove_error;

/// Size (width, height), K, the lens's name and its coefficients.
type CameraRow = ([u32; 2], [[f64; 3]; 3], String, Vec<f64>);
type Matrix4 = [[f64; 4]; 4];

/// A recipe's scene at one keyframe, with its renderer.
#[pyclass(frozen, name = "ReadyScene")]
pub(crate) struct PyReadyScene(Arc<ReadyScene>);

#[pymethods]
impl PyReadyScene {
    #[staticmethod]
    fn build(py: Python<'_>, recipe: PathBuf, keyframe: Option<usize>, site_packages: Vec<PathBuf>) -> PyResult<Self> {
        let build = move |watch: &_| ReadyScene::build(&recipe, keyframe, &site_packages, watch);
        attended(py, None, build)?.map(|scene| Self(Arc::new(scene))).map_err(trove_error)
    }

    /// The scene's name and keyframe.
    fn name(&self) -> (String, usize) {
        let (name, keyframe) = self.0.name();
        (name.to_owned(), keyframe)
    }

    /// Name, camera and `world_from_camera` of each of the recipe's views.
    fn views(&self) -> Vec<(String, CameraRow, Matrix4)> {
        let row = |(name, camera, pose): (&str, FreeCamera, Matrix4)| {
            let FreeCamera { size_px, intrinsics, lens_model, distortion } = camera;
            (name.to_owned(), (size_px, intrinsics, lens_model, distortion), pose)
        };
        self.0.views().into_iter().map(row).collect()
    }

    /// What was dropped, guessed or substituted, as JSON.
    fn report(&self) -> &str {
        self.0.report()
    }

    /// Writes the scene as binary glTF.
    fn write_glb(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let scene = self.0.clone();
        attended(py, None, move |_| scene.write_glb(&path))?.map_err(trove_error)
    }

    /// Takes a picture: its table as JSON, its images as arrays by their names, and its masks as JSON where they were asked for.
    #[pyo3(signature = (view, camera, world_from_camera, spp, seed, labels_only, progress))]
    #[allow(clippy::too_many_arguments)] // trove.Scene.render names them
    fn picture<'py>(
        &self,
        py: Python<'py>,
        view: Option<String>,
        camera: Option<CameraRow>,
        world_from_camera: Option<Matrix4>,
        spp: Option<u32>,
        seed: Option<u64>,
        labels_only: bool,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<(String, Bound<'py, PyDict>, Option<String>)> {
        let camera = camera.map(|(size_px, intrinsics, lens_model, distortion)| FreeCamera {
            size_px,
            intrinsics,
            lens_model,
            distortion,
        });
        let request = PictureRequest { view, camera, world_from_camera, spp, seed, labels_only };
        let scene = self.0.clone();
        let taken = attended(py, progress.as_ref(), move |watch| scene.picture(&request, watch))?;
        let frame = taken.map_err(trove_error)?.ok_or_else(|| trove_error("ended before the picture was taken"))?;
        let table = String::from_utf8(frame.table.to_json()).map_err(trove_error)?;
        let images = PyDict::new(py);
        if let Some(color) = frame.color {
            images.set_item("rgb", channels(py, color.srgb)?)?;
            images.set_item("radiance", channels(py, color.radiance)?)?;
        }
        let labels = frame.labels;
        let masks = trove::mask_table(&labels).map(|table| String::from_utf8(table.to_json()));
        let masks = masks.transpose().map_err(trove_error)?;
        // As in panoptic.png, which every frame can have.
        let pixels = labels.class.data.iter().zip(&labels.instance.data);
        let data = pixels.map(|(class, id)| u32::from(class.id()) << 16 | id).collect();
        let Raster { width, height, .. } = labels.instance;
        let panoptic = Raster { width, height, data };
        images.set_item("class", values(py, labels.class.map(|class| class.id()))?)?;
        // As in instance.png.
        images.set_item("instance", values(py, labels.instance.map(|id| *id as u16))?)?;
        images.set_item("depth", values(py, labels.depth_m)?)?;
        images.set_item("normal", channels(py, labels.normal)?)?;
        images.set_item("flow_forward", channels(py, labels.flow_forward)?)?;
        images.set_item("flow_backward", channels(py, labels.flow_backward)?)?;
        images.set_item("occluded_forward", occlusion(py, labels.occluded_forward)?)?;
        images.set_item("occluded_backward", occlusion(py, labels.occluded_backward)?)?;
        images.set_item("panoptic", values(py, panoptic)?)?;
        let extra = labels.extra;
        let numbers = [("range", extra.range_m), ("roughness", extra.roughness)];
        for (name, raster) in numbers.into_iter().filter_map(|(name, raster)| Some((name, raster?))) {
            images.set_item(name, values(py, raster)?)?;
        }
        let vectors = [
            ("normal_world", extra.normal_world),
            ("albedo", extra.albedo),
            ("scene_flow_forward", extra.scene_flow_forward),
            ("scene_flow_backward", extra.scene_flow_backward),
            ("object_coordinates", extra.object_coordinates),
        ];
        for (name, raster) in vectors.into_iter().filter_map(|(name, raster)| Some((name, raster?))) {
            images.set_item(name, channels(py, raster)?)?;
        }
        if let Some(coverage) = extra.coverage {
            images.set_item("coverage", values(py, coverage)?)?;
        }
        if let Some(part) = extra.part {
            images.set_item("part", parts(py, part)?)?;
        }
        Ok((table, images, masks))
    }
}
