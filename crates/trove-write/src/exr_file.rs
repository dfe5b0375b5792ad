//! OpenEXR, as bytes: 32-bit float, scan lines, without loss.

use std::io::{BufReader, Cursor};
use std::path::Path;

use exr::prelude::{
    AnyChannel, AnyChannels, Compression, Encoding, FlatSamples, Image, Layer, LayerAttributes, LineOrder,
    ReadChannels, ReadLayers, SmallVec, WritableImage, read,
};
use trove_files::open_regular;
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

/// Reads back a file of [`encode_scalar`]'s.
pub(crate) fn read_scalar(path: &Path) -> Result<Raster<f32>, WriteError> {
    let (width, height, [values]) = read_planes(path, ["Y"])?;
    Ok(Raster { width, height, data: values })
}

/// Reads back a file of [`encode`]'s with three channels R, G and B.
pub(crate) fn read_rgb(path: &Path) -> Result<Raster<[f32; 3]>, WriteError> {
    let (width, height, [r, g, b]) = read_planes(path, ["R", "G", "B"])?;
    let data = r.iter().zip(&g).zip(&b).map(|((&r, &g), &b)| [r, g, b]).collect();
    Ok(Raster { width, height, data })
}

fn read_planes<const N: usize>(path: &Path, names: [&str; N]) -> Result<(u32, u32, [Vec<f32>; N]), WriteError> {
    let damaged = |found: String| WriteError::Damaged { path: path.to_owned(), found };
    let file = open_regular(path).map_err(WriteError::storage(path, "read the file"))?;
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(BufReader::new(file))
        .map_err(|e| damaged(e.to_string()))?;
    let (size, list) = (image.layer_data.size, image.layer_data.channel_data.list);
    let mut planes = [const { Vec::new() }; N];
    for (plane, name) in planes.iter_mut().zip(names) {
        let channel = list.iter().find(|c| c.name == *name).ok_or_else(|| damaged(format!("no channel {name}")))?;
        *plane = channel.sample_data.values_as_f32().collect();
    }
    Ok((size.x() as u32, size.y() as u32, planes))
}
