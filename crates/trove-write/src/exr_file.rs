//! OpenEXR, as bytes: 32-bit float, scan lines, without loss.

use std::io::Cursor;
use std::path::Path;

use exr::prelude::{
    AnyChannel, AnyChannels, Compression, Encoding, FlatSamples, Image, Layer, LayerAttributes, LineOrder, MetaData,
    ReadChannels, ReadLayers, SmallVec, WritableImage, read,
};
use trove_files::{Budget, LARGEST_FILE, read_regular};
use trove_model::Raster;

use crate::WriteError;

/// Several floats a pixel, under the channels' names.
pub(crate) fn encode<const N: usize>(
    name: &str,
    raster: &Raster<[f32; N]>,
    channels: [&str; N],
) -> Result<Vec<u8>, WriteError> {
    let plane = |i: usize| raster.data.iter().map(|p| p[i]).collect();
    let channels = (0..N).map(|i| AnyChannel::new(channels[i], FlatSamples::F32(plane(i)))).collect();
    encode_channels(name, raster.width, raster.height, channels)
}

/// One float a pixel in the luminance channel, which every reader knows.
pub(crate) fn encode_scalar(name: &str, raster: &Raster<f32>) -> Result<Vec<u8>, WriteError> {
    let channel = AnyChannel::new("Y", FlatSamples::F32(raster.data.clone()));
    encode_channels(name, raster.width, raster.height, SmallVec::from_iter([channel]))
}

fn encode_channels(
    name: &str,
    width: u32,
    height: u32,
    channels: SmallVec<[AnyChannel<FlatSamples>; 4]>,
) -> Result<Vec<u8>, WriteError> {
    let size = (width as usize, height as usize);
    // Sixteen lines a block: the smallest of the lossless ways that are fast to read.
    let encoding =
        Encoding { compression: Compression::ZIP16, line_order: LineOrder::Increasing, ..Encoding::default() };
    let layer = Layer::new(size, LayerAttributes::default(), encoding, AnyChannels::sort(channels));
    let mut bytes = Cursor::new(Vec::new());
    // One core: the pipeline writes frames while it renders the next.
    Image::from_layer(layer)
        .write()
        .non_parallel()
        .to_buffered(&mut bytes)
        .map_err(|e| WriteError::Encoding { name: name.to_owned(), found: e.to_string() })?;
    Ok(bytes.into_inner())
}

/// Reads back a file of [`encode_scalar`]'s, of so many columns and rows.
pub(crate) fn read_scalar(path: &Path, size: [u32; 2]) -> Result<Raster<f32>, WriteError> {
    let [data] = read_planes(path, size, ["Y"])?;
    Ok(Raster { width: size[0], height: size[1], data })
}

/// Reads back a file of [`encode`]'s with three channels R, G and B.
pub(crate) fn read_rgb(path: &Path, size: [u32; 2]) -> Result<Raster<[f32; 3]>, WriteError> {
    let [r, g, b] = read_planes(path, size, ["R", "G", "B"])?;
    let data = r.iter().zip(&g).zip(&b).map(|((&r, &g), &b)| [r, g, b]).collect();
    Ok(Raster { width: size[0], height: size[1], data })
}

/// Reads back a file of [`encode`]'s with two channels R and G.
pub(crate) fn read_rg(path: &Path, size: [u32; 2]) -> Result<Raster<[f32; 2]>, WriteError> {
    let [r, g] = read_planes(path, size, ["R", "G"])?;
    let data = r.iter().zip(&g).map(|(&r, &g)| [r, g]).collect();
    Ok(Raster { width: size[0], height: size[1], data })
}

fn read_planes<const N: usize>(path: &Path, size: [u32; 2], names: [&str; N]) -> Result<[Vec<f32>; N], WriteError> {
    let damaged = |found: String| WriteError::Damaged { path: path.to_owned(), found };
    let bytes = read_regular(path, LARGEST_FILE).map_err(WriteError::storage(path, "read the file"))?;
    // Before anything is unpacked: a header of a few bytes may ask for any amount of memory.
    let headers = MetaData::read_from_buffered(Cursor::new(&bytes), false).map_err(|e| damaged(e.to_string()))?.headers;
    let [layer] = headers.as_slice() else { return Err(damaged(format!("{} layers instead of one", headers.len()))) };
    let found = [layer.layer_size.x() as u32, layer.layer_size.y() as u32];
    if found != size {
        return Err(damaged(format!("{}×{} pixels instead of {}×{}", found[0], found[1], size[0], size[1])));
    }
    let floats = layer.layer_size.area().saturating_mul(layer.channels.list.len());
    Budget::of_file(bytes.len() as u64).take(floats, size_of::<f32>()).map_err(|e| damaged(e.found()))?;
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(&bytes))
        .map_err(|e| damaged(e.to_string()))?;
    let mut list = image.layer_data.channel_data.list;
    let mut planes = [const { Vec::new() }; N];
    for (plane, name) in planes.iter_mut().zip(names) {
        let channel = list.iter_mut().find(|c| c.name == *name).ok_or_else(|| damaged(format!("no channel {name}")))?;
        *plane = match &mut channel.sample_data {
            // As we write them: the values are taken as they are.
            FlatSamples::F32(values) => std::mem::take(values),
            other => other.values_as_f32().collect(),
        };
    }
    Ok(planes)
}
