//! Finished frames, read back.

use std::path::PathBuf;

use pyo3::prelude::*;
use trove::{FrameFile, RunLengths, StoredFrame};

use crate::arrays::{channels, occlusion, parts, values};
use crate::error::trove_error;

/// A finished frame's folder; its images are read, without Python's lock, when they are asked for.
#[pyclass(frozen, name = "StoredFrame")]
pub(crate) struct PyStoredFrame(StoredFrame);

#[pymethods]
impl PyStoredFrame {
    #[new]
    fn new(py: Python<'_>, folder: PathBuf) -> PyResult<Self> {
        py.detach(|| StoredFrame::open(&folder)).map(Self).map_err(trove_error)
    }

    /// `frame.json`, as text.
    fn table(&self) -> PyResult<String> {
        String::from_utf8(self.0.table.to_json()).map_err(trove_error)
    }

    /// What each pixel shows, in the numbers of a class map.
    fn labels<'py>(&self, py: Python<'py>, classes: &str) -> PyResult<Bound<'py, PyAny>> {
        values(py, py.detach(|| trove::mapped_labels(&self.0, classes)).map_err(trove_error)?)
    }

    /// The image of a name, such as `flow_forward`, as an array.
    fn read<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let frame = &self.0;
        match file_named(name)? {
            FrameFile::Rgb => channels(py, py.detach(|| frame.rgb()).map_err(trove_error)?),
            FrameFile::Radiance => channels(py, py.detach(|| frame.radiance()).map_err(trove_error)?),
            FrameFile::Class => {
                values(py, py.detach(|| frame.class().map(|c| c.map(|class| class.id()))).map_err(trove_error)?)
            }
            FrameFile::Instance => values(py, py.detach(|| frame.instance()).map_err(trove_error)?),
            FrameFile::Depth => values(py, py.detach(|| frame.depth_m()).map_err(trove_error)?),
            FrameFile::Normal => channels(py, py.detach(|| frame.normal()).map_err(trove_error)?),
            FrameFile::FlowForward => channels(py, py.detach(|| frame.flow_forward()).map_err(trove_error)?),
            FrameFile::FlowBackward => channels(py, py.detach(|| frame.flow_backward()).map_err(trove_error)?),
            FrameFile::OccludedForward => occlusion(py, py.detach(|| frame.occluded_forward()).map_err(trove_error)?),
            FrameFile::OccludedBackward => occlusion(py, py.detach(|| frame.occluded_backward()).map_err(trove_error)?),
            FrameFile::Panoptic => values(py, py.detach(|| frame.panoptic()).map_err(trove_error)?),
            FrameFile::Coverage => values(py, py.detach(|| frame.coverage()).map_err(trove_error)?),
            FrameFile::Part => parts(py, py.detach(|| frame.part()).map_err(trove_error)?),
            file @ (FrameFile::Range | FrameFile::Roughness) => {
                values(py, py.detach(|| frame.numbers(file)).map_err(trove_error)?)
            }
            file @ (FrameFile::NormalWorld
            | FrameFile::Albedo
            | FrameFile::SceneFlowForward
            | FrameFile::SceneFlowBackward
            | FrameFile::ObjectCoordinates) => channels(py, py.detach(|| frame.vectors(file)).map_err(trove_error)?),
            FrameFile::Change => values(py, py.detach(|| frame.change()).map_err(trove_error)?),
            FrameFile::Masks => Err(unknown(name)),
        }
    }
}

/// The names of the images that a frame may have.
#[pyfunction]
pub(crate) fn image_names() -> Vec<&'static str> {
    FrameFile::ALL.into_iter().filter(|file| file.is_picture()).map(stem).collect()
}

/// A file's name without its ending.
fn stem(file: FrameFile) -> &'static str {
    file.name().split('.').next().unwrap_or_default()
}

fn file_named(name: &str) -> PyResult<FrameFile> {
    FrameFile::ALL.into_iter().find(|file| stem(*file) == name).ok_or_else(|| unknown(name))
}

fn unknown(name: &str) -> PyErr {
    trove_error(format!("expected one of {}, found {name:?}", image_names().join(", ")))
}

/// The picture (H, W; `bool`) that run lengths in COCO's compressed form make up.
#[pyfunction]
pub(crate) fn painted(py: Python<'_>, size: [u32; 2], counts: String) -> PyResult<Bound<'_, PyAny>> {
    let damaged = || trove_error("expected run lengths that fill the picture, found others");
    values(py, trove::painted(&RunLengths { size, counts }).ok_or_else(damaged)?)
}
