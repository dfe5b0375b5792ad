//! OpenEXR, read back: those parts that are asked for.
//!
//! The `exr` crate reads headers and finds blocks. Those that are packed with ZIP, as ours are, are unpacked here, in less
//! than half of its time.

use std::io::{BufReader, ErrorKind};
use std::path::Path;

use exr::block::chunk::{Chunk, CompressedBlock};
use exr::block::reader::ChunksReader;
use exr::block::{BlockIndex, UncompressedBlock};
use exr::meta::attribute::SampleType;
use exr::meta::header::Header;
use exr::prelude::{Compression, MetaData, Vec2, f16};
use libdeflater::Decompressor;
use trove_files::{Budget, LARGEST_FILE, open_regular};
use trove_model::{Patches, Raster};

use crate::WriteError;

/// Reads the channels of a picture, of so many columns and rows. Blocks without pixels that are asked for are left 0.
pub(crate) fn read<const N: usize>(
    path: &Path,
    [width, height]: [u32; 2],
    names: [&str; N],
    patches: Patches,
) -> Result<Raster<[f32; N]>, WriteError> {
    let damaged = |found: String| WriteError::Damaged { path: path.to_owned(), found };
    let unread = |e: exr::error::Error| damaged(e.to_string());
    let refused = WriteError::storage(path, "read the file");
    let file = open_regular(path).and_then(|file| Ok((file.metadata()?.len(), file)));
    let (bytes, file) = match file {
        Ok((bytes, _)) if bytes > LARGEST_FILE => return Err(refused(ErrorKind::FileTooLarge.into())),
        Ok(file) => file,
        Err(e) => return Err(refused(e)),
    };
    let reader = exr::block::read(BufReader::new(file), false).map_err(unread)?;
    let [layer] = reader.headers() else {
        return Err(damaged(format!("{} layers instead of one", reader.headers().len())));
    };
    let layer = layer.clone();
    let found = [layer.layer_size.x() as u32, layer.layer_size.y() as u32];
    if found != [width, height] {
        return Err(damaged(format!("{}×{} pixels instead of {width}×{height}", found[0], found[1])));
    }
    let channels = &layer.channels.list;
    if let Some(name) = names.iter().find(|name| channels.iter().all(|channel| channel.name != ***name)) {
        return Err(damaged(format!("no channel {name}")));
    }
    if channels.iter().any(|channel| channel.sampling != Vec2(1, 1)) {
        return Err(damaged("channels of fewer pixels than the picture".into()));
    }
    // Before anything is unpacked: a header of a few bytes may ask for any amount of memory.
    let floats = layer.layer_size.area().saturating_mul(channels.len().max(N));
    Budget::of_file(bytes).take(floats, size_of::<f32>()).map_err(|e| damaged(e.found()))?;

    let mut raster = Raster::filled(width, height, [0.0; N]);
    let wanted = |level: Vec2<usize>, block: BlockIndex| {
        let (start, end) = (block.pixel_position, block.pixel_position + block.pixel_size);
        let mut rows = start.y()..end.y();
        level == Vec2(0, 0) && rows.any(|y| patches.columns(end.x() as u32, y as u32).any(|x| x as usize >= start.x()))
    };
    let chunks = reader.filter_chunks(false, |_, tile, block| wanted(tile.level_index, block)).map_err(unread)?;
    let meta = chunks.meta_data().clone();
    let place: Vec<Option<usize>> =
        channels.iter().map(|channel| names.iter().position(|name| channel.name == **name)).collect();
    let mut unpacking = Unpacking { inflater: Decompressor::new(), halves: Vec::new() };
    for chunk in chunks {
        let block = unpacking.block(chunk.map_err(unread)?, &meta, &layer).map_err(damaged)?;
        let end = block.index.pixel_position + block.index.pixel_size;
        if end.x() > width as usize || end.y() > height as usize {
            return Err(damaged("a block that is not in the picture".into()));
        }
        for line in block.lines(&layer.channels) {
            let Some(at) = place[line.location.channel] else { continue };
            let start = line.location.position.y() * width as usize + line.location.position.x();
            let pixels = &mut raster.data[start..start + line.location.sample_count];
            let values = pixels.iter_mut().map(|pixel| &mut pixel[at]);
            let kind = channels[line.location.channel].sample_type;
            set(values, line.value, kind);
        }
    }
    Ok(raster)
}

/// Sets values from the bytes of a line.
fn set<'a>(values: impl Iterator<Item = &'a mut f32>, line: &[u8], kind: SampleType) {
    match kind {
        SampleType::F32 => {
            values.zip(line.as_chunks().0).for_each(|(value, bytes)| *value = f32::from_ne_bytes(*bytes))
        }
        SampleType::F16 => {
            values.zip(line.as_chunks().0).for_each(|(value, bytes)| *value = f16::from_ne_bytes(*bytes).to_f32());
        }
        SampleType::U32 => {
            values.zip(line.as_chunks().0).for_each(|(value, bytes)| *value = u32::from_ne_bytes(*bytes) as f32);
        }
    }
}

/// What unpacks one block after another.
struct Unpacking {
    inflater: Decompressor,
    /// Bytes as ZIP has them: first those of even places, then those of odd ones.
    halves: Vec<u8>,
}

impl Unpacking {
    fn block(&mut self, chunk: Chunk, meta: &MetaData, layer: &Header) -> Result<UncompressedBlock, String> {
        let told = |e: exr::error::Error| e.to_string();
        let is_zip = matches!(layer.compression, Compression::ZIP1 | Compression::ZIP16);
        let packed = match &chunk.compressed_block {
            CompressedBlock::ScanLine(lines) => Some(&lines.compressed_pixels_le),
            CompressedBlock::Tile(tile) => Some(&tile.compressed_pixels_le),
            _ => None,
        };
        if let Some(packed) = packed.filter(|_| is_zip && cfg!(target_endian = "little")) {
            let index = layer.get_block_data_indices(&chunk.compressed_block).map_err(told)?;
            let within = layer.get_absolute_block_pixel_coordinates(index).map_err(told)?;
            within.validate(Some(layer.layer_size)).map_err(told)?;
            let size = within.size.area() * layer.channels.bytes_per_pixel;
            // Blocks that would not get smaller are not packed.
            if packed.len() != size {
                self.halves.resize(size, 0);
                match self.inflater.zlib_decompress(packed, &mut self.halves) {
                    Ok(bytes) if bytes == size => {}
                    Ok(bytes) => return Err(format!("a block of {bytes} bytes instead of {size}")),
                    Err(e) => return Err(format!("a block that cannot be unpacked: {e}")),
                }
                add_up(&mut self.halves);
                let pixel_position = within.position.to_usize("block").map_err(told)?;
                let index = BlockIndex { layer: 0, pixel_position, pixel_size: within.size, level: index.level_index };
                return Ok(UncompressedBlock { index, data: interleaved(&self.halves) });
            }
        }
        UncompressedBlock::decompress_chunk(chunk, meta, false).map_err(told)
    }
}

/// Every byte is kept as the difference to the one before it, and 128.
fn add_up(bytes: &mut [u8]) {
    const TOP: u64 = 0x8080_8080_8080_8080;
    // Eight bytes are added to eight others without carrying over.
    let add = |a: u64, b: u64| ((a & !TOP) + (b & !TOP)) ^ ((a ^ b) & TOP);
    let (words, rest) = bytes.as_chunks_mut::<8>();
    let mut last = 128u8;
    for word in words {
        let mut sums = u64::from_le_bytes(*word) ^ TOP;
        for shift in [8, 16, 32] {
            sums = add(sums, sums << shift);
        }
        *word = add(sums, u64::from(last) * 0x0101_0101_0101_0101).to_le_bytes();
        last = last.wrapping_add((sums >> 56) as u8);
    }
    for byte in rest {
        last = last.wrapping_add(*byte ^ 128);
        *byte = last;
    }
}

fn interleaved(halves: &[u8]) -> Vec<u8> {
    let (even, odd) = halves.split_at(halves.len().div_ceil(2));
    let mut bytes = vec![0; halves.len()];
    let (pairs, rest) = bytes.as_chunks_mut::<2>();
    for ((pair, even), odd) in pairs.iter_mut().zip(even).zip(odd) {
        *pair = [*even, *odd];
    }
    if let ([last], Some(even)) = (rest, even.last()) {
        *last = *even;
    }
    bytes
}

#[cfg(test)]
mod tests {
    use exr::prelude::{
        AnyChannel, AnyChannels, Blocks, Encoding, FlatSamples, Image, Layer, LayerAttributes, LineOrder, SmallVec,
        WritableImage,
    };

    use super::*;

    const SIZE: [u32; 2] = [37, 50];

    fn value(x: usize, y: usize) -> f32 {
        match (x * 7 + y * 13) % 11 {
            0 => f32::NAN,
            1 => f32::INFINITY,
            n => (x as f32 * 0.37).sin() * n as f32 - y as f32,
        }
    }

    fn write(path: &Path, blocks: Blocks, compression: Compression, channels: &[(&str, bool)]) {
        let (width, height) = (SIZE[0] as usize, SIZE[1] as usize);
        let of = |factor: f32| (0..width * height).map(move |i| value(i % width, i / width) * factor);
        let channels: SmallVec<[_; 4]> = (1..)
            .zip(channels)
            .map(|(factor, (name, is_half))| {
                let values = of(factor as f32);
                let samples = if *is_half {
                    FlatSamples::F16(values.map(f16::from_f32).collect())
                } else {
                    FlatSamples::F32(values.collect())
                };
                AnyChannel::new(*name, samples)
            })
            .collect();
        let encoding = Encoding { compression, blocks, line_order: LineOrder::Increasing };
        let layer = Layer::new((width, height), LayerAttributes::default(), encoding, AnyChannels::sort(channels));
        Image::from_layer(layer).write().to_file(path).unwrap();
    }

    #[test]
    fn every_lossless_way_to_pack_is_read_and_channels_go_by_their_names() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a.exr");
        for compression in
            [Compression::ZIP16, Compression::ZIP1, Compression::RLE, Compression::PIZ, Compression::Uncompressed]
        {
            for (is_half, blocks) in
                [(false, Blocks::ScanLines), (true, Blocks::ScanLines), (false, Blocks::Tiles(Vec2(16, 24)))]
            {
                write(&path, blocks, compression, &[("B", false), ("A", true), ("R", is_half)]);
                let read = read(&path, SIZE, ["R", "B"], Patches::ALL).unwrap();
                for (i, [r, b]) in read.data.iter().enumerate() {
                    let expected = value(i % 37, i / 37);
                    let third = if is_half { f16::from_f32(expected * 3.0).to_f32() } else { expected * 3.0 };
                    let same = |a: f32, b: f32| a.is_nan() && b.is_nan() || a.to_bits() == b.to_bits();
                    assert!(
                        same(*r, third) && same(*b, expected),
                        "{compression:?} {i}: {r} {b}, not {third} {expected}"
                    );
                }
            }
        }
    }

    #[test]
    fn blocks_that_are_not_asked_for_are_not_read() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a.exr");
        let size = [200, 150];
        let raster = Raster::from_fn(200, 150, |x, y| [value(x as usize, y as usize)]);
        std::fs::write(&path, crate::exr_file::encode("a.exr", &raster, ["Y"]).unwrap()).unwrap();
        let patches = Patches::one_of(3, 1);
        let part = read(&path, size, ["Y"], patches).unwrap();
        for (i, (part, whole)) in part.data.iter().zip(&raster.data).enumerate() {
            let expected = if patches.hold(i as u32 % 200, i as u32 / 200) { whole[0].to_bits() } else { 0 };
            assert_eq!(part[0].to_bits(), expected);
        }
    }

    #[test]
    fn damage_is_told_wherever_it_is() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a.exr");
        write(&path, Blocks::ScanLines, Compression::ZIP16, &[("Y", false)]);
        let sound = std::fs::read(&path).unwrap();
        let mut told = 0;
        for at in 0..sound.len() {
            let mut bytes = sound.clone();
            bytes[at] ^= 0x55;
            std::fs::write(&path, &bytes).unwrap();
            told += usize::from(read(&path, SIZE, ["Y"], Patches::ALL).is_err());
        }
        // Names and values of attributes that nobody asks for are anyone's.
        assert!(told * 4 > sound.len() * 3, "{told} of {}", sound.len());
        std::fs::write(&path, &sound[..sound.len() - 40]).unwrap();
        assert!(read(&path, SIZE, ["Y"], Patches::ALL).is_err());
        write(&path, Blocks::ScanLines, Compression::ZIP16, &[("Y", false)]);
        assert!(read(&path, [37, 51], ["Y"], Patches::ALL).unwrap_err().to_string().contains("37×50"));
        assert!(read(&path, SIZE, ["R"], Patches::ALL).unwrap_err().to_string().contains("no channel R"));
    }
}
