//! Images as NumPy arrays, which take over their memory.

use numpy::{Element, PyArray1, PyArrayMethods, PyReadonlyArray2, PyReadonlyArray3, PyUntypedArrayMethods};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use trove::{Occlusion, Raster, Role, colors};

/// Rows × columns.
pub(crate) fn values<T: Element>(py: Python<'_>, raster: Raster<T>) -> PyResult<Bound<'_, PyAny>> {
    let shape = [raster.height as usize, raster.width as usize];
    Ok(PyArray1::from_vec(py, raster.data).reshape(shape)?.into_any())
}

/// Rows × columns × channels.
pub(crate) fn channels<T: Element, const N: usize>(
    py: Python<'_>,
    raster: Raster<[T; N]>,
) -> PyResult<Bound<'_, PyAny>> {
    let shape = [raster.height as usize, raster.width as usize, N];
    Ok(PyArray1::from_vec(py, raster.data.into_flattened()).reshape(shape)?.into_any())
}

/// As in the pictures: 0, 128 or 255.
pub(crate) fn occlusion(py: Python<'_>, raster: Raster<Occlusion>) -> PyResult<Bound<'_, PyAny>> {
    values(py, raster.map(|occlusion| occlusion.value()))
}

/// As in `part.png`.
pub(crate) fn parts(py: Python<'_>, raster: Raster<Option<Role>>) -> PyResult<Bound<'_, PyAny>> {
    values(py, raster.map(|part| part.map_or(0, Role::id)))
}

/// The names of what [`label_colors`] knows.
const COLORED: &str = "class, instance, panoptic, depth, normal, normal_world, albedo, flow, scene_flow, object_coordinates, \
                       roughness, coverage, part, occluded or change";

/// The colours (H, W, 3; `uint8`) in which a label's array is shown.
#[pyfunction]
pub(crate) fn label_colors<'py>(
    py: Python<'py>,
    label: &str,
    array: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyAny>> {
    let colored = match label {
        "class" => colored(array, colors::of_class)?,
        "instance" => colored(array, colors::of_instance)?,
        "depth" => colored(array, colors::of_depth)?,
        "panoptic" => colored(array, |segment: u32| match segment as u16 {
            0 => colors::of_class((segment >> 16) as u8),
            id => colors::of_instance(id),
        })?,
        "part" => colored(array, |part: u8| colors::of_instance(part.into()))?,
        "occluded" | "coverage" => colored(array, |value: u8| [value; 3])?,
        "roughness" => colored(array, |share: f32| colors::of_shares([share; 3]))?,
        "normal_world" => colored_vectors(array, colors::of_normal_world)?,
        "albedo" => colored_vectors(array, colors::of_albedo)?,
        "object_coordinates" => colored_vectors(array, colors::of_shares)?,
        "scene_flow" => {
            let array: PyReadonlyArray3<'_, f32> = array.extract()?;
            let lengths = array.as_slice()?.as_chunks().0.iter().map(|[x, y, _]: &[f32; 3]| x.hypot(*y));
            let most_m = lengths.filter(|length| length.is_finite()).fold(0.0, f32::max);
            colored_vectors(array.as_any(), |way| colors::of_scene_flow(way, most_m))?
        }
        "change" => colored(array, |differs: bool| if differs { [255; 3] } else { [0; 3] })?,
        "normal" => colored_vectors(array, colors::of_normal)?,
        "flow" => {
            let array: PyReadonlyArray3<'_, f32> = array.extract()?;
            let lengths = array.as_slice()?.as_chunks().0.iter().map(|[u, v]: &[f32; 2]| u.hypot(*v));
            let most_px = lengths.filter(|length| length.is_finite()).fold(0.0, f32::max);
            colored_vectors(array.as_any(), |flow| colors::of_flow(flow, most_px))?
        }
        _ => {
            return Err(PyTypeError::new_err(format!("label: expected {COLORED}, found {label:?}")));
        }
    };
    channels(py, colored)
}

fn colored<T: Element + Copy>(array: &Bound<'_, PyAny>, color: impl Fn(T) -> [u8; 3]) -> PyResult<Raster<[u8; 3]>> {
    let array: PyReadonlyArray2<'_, T> = array.extract()?;
    let data = array.as_slice()?.iter().map(|value| color(*value)).collect();
    Ok(Raster { width: array.shape()[1] as u32, height: array.shape()[0] as u32, data })
}

fn colored_vectors<const N: usize>(
    array: &Bound<'_, PyAny>,
    color: impl Fn([f32; N]) -> [u8; 3],
) -> PyResult<Raster<[u8; 3]>> {
    let array: PyReadonlyArray3<'_, f32> = array.extract()?;
    if array.shape()[2] != N {
        return Err(PyTypeError::new_err(format!("expected {N} channels, found {}", array.shape()[2])));
    }
    let data = array.as_slice()?.as_chunks().0.iter().map(|value| color(*value)).collect();
    Ok(Raster { width: array.shape()[1] as u32, height: array.shape()[0] as u32, data })
}

/// The bytes of a PNG file of a picture (H, W, 3; `uint8`, sRGB).
#[pyfunction]
pub(crate) fn encode_png(picture: PyReadonlyArray3<'_, u8>) -> PyResult<Vec<u8>> {
    let &[height, width, 3] = picture.shape() else {
        return Err(PyTypeError::new_err(format!("expected height × width × 3, found {:?}", picture.shape())));
    };
    let data = picture.as_slice()?.as_chunks().0.to_vec();
    let picture = Raster { width: width as u32, height: height as u32, data };
    trove::encode_picture("picture", &picture).map_err(crate::error::trove_error)
}
