//! Geometry packed with meshopt (`EXT_meshopt_compression`) or Draco (`KHR_draco_mesh_compression`).

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use draco_core::{DecoderBuffer, Mesh as DracoMesh, MeshDecoder};
use meshopt::ffi;
use serde_json::Value;
use trove_files::Folder;

use super::container::Container;
use crate::ReadError;
use crate::asset_files::fault::Fault;
use crate::asset_files::model::too_large;

/// Bytes that a byte of Draco may become.
const DRACO_RATIO: usize = 16;
const REMEDY: &str = "export the model without compression, or unpack it with `npx gltf-pipeline -i in.glb -o out.glb`";

/// Opens a file and unpacks its views.
pub(super) fn open(path: &Path, bytes: &[u8], library: &Folder) -> Result<Container, ReadError> {
    let mut container = Container::open(path, bytes, library)?;
    container.unpacked = views(&container).map_err(|fault| fault.at(path))?;
    Ok(container)
}

/// Every view that is packed with meshopt, unpacked; `None` where a view is plain.
fn views(container: &Container) -> Result<Vec<Option<Vec<u8>>>, Fault> {
    let unpack = |(i, view): (usize, &super::json::View)| {
        let ext = ["EXT_meshopt_compression", "KHR_meshopt_compression"].iter().find_map(|e| view.extensions.get(*e));
        ext.map(|ext| meshopt_view(container, ext, &format!("bufferViews[{i}]"))).transpose()
    };
    container.root.buffer_views.iter().enumerate().map(unpack).collect()
}

fn meshopt_view(container: &Container, ext: &Value, place: &str) -> Result<Vec<u8>, Fault> {
    let number = |key: &str| ext.get(key).and_then(Value::as_u64).map_or(0, |n| n as usize);
    let (stride, count) = (number("byteStride"), number("count"));
    let packed = container.bytes(number("buffer"), number("byteOffset"), number("byteLength"), place)?;
    // As words, and as the bytes that are made of them.
    container.budget.take(count, stride.saturating_mul(2)).map_err(|e| too_large(place, e))?;
    let length = stride * count;
    let mode = ext.get("mode").and_then(Value::as_str).unwrap_or_default();
    // What the library asserts rather than reports.
    let fits = match mode {
        "ATTRIBUTES" => (4..=256).contains(&stride) && stride.is_multiple_of(4),
        "TRIANGLES" => (stride == 2 || stride == 4) && count.is_multiple_of(3),
        "INDICES" => stride == 2 || stride == 4,
        _ => false,
    };
    let filter = ext.get("filter").and_then(Value::as_str).unwrap_or("NONE");
    let filtered = match filter {
        "NONE" => true,
        "OCTAHEDRAL" | "COLOR" => stride == 4 || stride == 8,
        "QUATERNION" => stride == 8,
        "EXPONENTIAL" => true,
        _ => false,
    };
    if !fits || !filtered {
        let found = format!("mode {mode:?}, filter {filter:?}, {count} × {stride} bytes");
        return Err(Fault::new(place, "meshopt data as its extension defines it", found, REMEDY));
    }
    // u32s, so that the memory is aligned for every element the filters write.
    let mut out = vec![0u32; length.div_ceil(4)];
    let target = out.as_mut_ptr().cast();
    let (source, size) = (packed.as_ptr(), packed.len());
    // SAFETY: `target` has room for count × stride bytes, `source` for `size`; the decoders check what they read and
    // report it; stride and count are what each of them demands (above).
    let code = unsafe {
        match mode {
            "ATTRIBUTES" => ffi::meshopt_decodeVertexBuffer(target, count, stride, source, size),
            "TRIANGLES" => ffi::meshopt_decodeIndexBuffer(target, count, stride, source, size),
            _ => ffi::meshopt_decodeIndexSequence(target, count, stride, source, size),
        }
    };
    if code != 0 {
        return Err(Fault::new(place, "whole meshopt data", format!("decoder error {code}"), REMEDY));
    }
    // SAFETY: as above; filters work in place on count × stride bytes.
    unsafe {
        match filter {
            "OCTAHEDRAL" => ffi::meshopt_decodeFilterOct(target, count, stride),
            "QUATERNION" => ffi::meshopt_decodeFilterQuat(target, count, stride),
            "EXPONENTIAL" => ffi::meshopt_decodeFilterExp(target, count, stride),
            "COLOR" => ffi::meshopt_decodeFilterColor(target, count, stride),
            _ => {}
        }
    }
    let mut bytes: Vec<u8> = out.iter().flat_map(|word| word.to_ne_bytes()).collect();
    bytes.truncate(length);
    Ok(bytes)
}

/// A primitive's geometry as Draco packed it.
pub(super) struct Draco {
    mesh: DracoMesh,
    attributes: Value,
    pub(super) triangles: Vec<[u32; 3]>,
}

impl Draco {
    /// Unpacks a primitive's extension.
    pub(super) fn decode(container: &Container, ext: &Value, place: &str) -> Result<Self, Fault> {
        let place = format!("{place}: KHR_draco_mesh_compression");
        let view = ext.get("bufferView").and_then(Value::as_u64);
        let view = view.ok_or_else(|| Fault::damaged(&place, "a bufferView", "none"))? as usize;
        let (bytes, _) = container.view(view, &place)?;
        container.budget.take(bytes.len(), DRACO_RATIO).map_err(|e| too_large(&place, e))?;
        // The decoder is young: should it panic on damaged data, that is an error of the file.
        let decoded = catch_unwind(AssertUnwindSafe(|| {
            let mut mesh = DracoMesh::new();
            MeshDecoder::new().decode(&mut DecoderBuffer::new(bytes), &mut mesh).map(|()| mesh)
        }));
        let mesh = match decoded {
            Ok(Ok(mesh)) => mesh,
            Ok(Err(e)) => return Err(Fault::new(place, "whole Draco data", format!("{e:?}"), REMEDY)),
            Err(_) => return Err(Fault::new(place, "whole Draco data", "damaged data", REMEDY)),
        };
        let triangles = mesh.faces().iter().map(|face| face.map(|point| point.0)).collect();
        let attributes = ext.get("attributes").cloned().unwrap_or_default();
        Ok(Self { mesh, attributes, triangles })
    }

    /// An attribute's numbers, `components` a point; `None` where it is not among the packed ones.
    pub(super) fn floats(&self, name: &str, components: usize) -> Option<Vec<f32>> {
        let id = self.attributes.get(name)?.as_u64()?;
        let attribute =
            (0..self.mesh.num_attributes()).map(|i| self.mesh.attribute(i)).find(|a| u64::from(a.unique_id()) == id)?;
        let points = self.mesh.num_points();
        catch_unwind(AssertUnwindSafe(|| attribute.read_f32s(points, components))).ok()
    }

    /// Numbers a point of an attribute.
    pub(super) fn components(&self, name: &str) -> usize {
        let id = self.attributes.get(name).and_then(Value::as_u64);
        let attribute = (0..self.mesh.num_attributes())
            .map(|i| self.mesh.attribute(i))
            .find(|a| Some(u64::from(a.unique_id())) == id);
        attribute.map_or(0, |a| usize::from(a.num_components()))
    }
}
