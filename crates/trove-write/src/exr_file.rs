//! OpenEXR, as bytes: 32-bit float, in tiles of 64 × 64 pixels, without loss.

use exr::prelude::{
    AnyChannel, AnyChannels, Blocks, Compression, Encoding, FlatSamples, Image, Layer, LayerAttributes, LineOrder,
    SmallVec, Vec2, WritableImage,
};
use std::io::Cursor;
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
    // The smallest of the lossless ways that are fast to read. Patches of `trove_model::Patches` are such tiles.
    let side = trove_model::Patches::SIDE as usize;
    let blocks = Blocks::Tiles(Vec2(side, side));
    let encoding = Encoding { compression: Compression::ZIP16, blocks, line_order: LineOrder::Increasing };
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
