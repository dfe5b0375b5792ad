//! Elevation files as their specifications have them, written for tests.

use std::io::Write;

use flate2::Compression;
use flate2::write::{DeflateEncoder, ZlibEncoder};

/// The bytes of an SRTM tile of 1201 × 1201 samples; `height_m` takes fractions of a degree east and north of its
/// corner.
pub(crate) fn hgt(height_m: impl Fn(f64, f64) -> i16) -> Vec<u8> {
    let at = |i: u32| f64::from(i) / 1200.0;
    (0..1201).flat_map(|row| (0..1201).map(move |column| (column, row))).fold(Vec::new(), |mut bytes, (column, row)| {
        bytes.extend(height_m(at(column), 1.0 - at(row)).to_be_bytes());
        bytes
    })
}

/// A zip file of one file, deflated or stored.
pub(crate) fn zip(name: &str, content: &[u8], deflated: bool) -> Vec<u8> {
    let mut packed = content.to_vec();
    if deflated {
        let mut packer = DeflateEncoder::new(Vec::new(), Compression::fast());
        packer.write_all(content).unwrap();
        packed = packer.finish().unwrap();
    }
    let method = if deflated { 8u16 } else { 0 };
    let sizes = [0, packed.len() as u32, content.len() as u32].map(u32::to_le_bytes).concat();
    // Flags, method, time and date; then the sum, both lengths, and the lengths of the name and of what else there is.
    let shared = |more: &[u8]| {
        let head = [20u16, 0, method, 0, 0].map(u16::to_le_bytes).concat();
        [&head[..], &sizes, &(name.len() as u16).to_le_bytes(), more].concat()
    };
    let local = [b"PK\x03\x04".as_slice(), &shared(&[0; 2]), name.as_bytes(), &packed].concat();
    let entry = [b"PK\x01\x02\x14\x00".as_slice(), &shared(&[0; 16]), name.as_bytes()].concat();
    let counts = [0u16, 0, 1, 1].map(u16::to_le_bytes).concat();
    let ends = [entry.len() as u32, local.len() as u32].map(u32::to_le_bytes).concat();
    [&local[..], &entry, b"PK\x05\x06", &counts, &ends, &[0; 2]].concat()
}

/// A little-endian TIFF.
#[derive(Default)]
pub(crate) struct Tiff {
    /// Tag, type, count, bytes.
    entries: Vec<(u16, u16, u32, Vec<u8>)>,
    chunks: Vec<Vec<u8>>,
    tiled: bool,
}

impl Tiff {
    /// Of a picture with one band of so many bits; sample format 1 is unsigned, 2 signed, 3 floats.
    pub(crate) fn new(size: [u32; 2], bits: u16, format: u16) -> Self {
        Self::default()
            .longs(256, &[size[0]])
            .longs(257, &[size[1]])
            .shorts(258, &[bits])
            .shorts(259, &[1])
            .shorts(262, &[1])
            .shorts(277, &[1])
            .shorts(339, &[format])
    }

    /// On degrees, with samples for areas; the corner's longitude and latitude, and a pixel's sides.
    pub(crate) fn placed(self, corner_deg: [f64; 2], step_deg: [f64; 2]) -> Self {
        self.doubles(33550, &[step_deg[0], step_deg[1], 0.0])
            .doubles(33922, &[0.0, 0.0, 0.0, corner_deg[0], corner_deg[1], 0.0])
            .shorts(34735, &[1, 1, 0, 3, 1024, 0, 1, 2, 1025, 0, 1, 1, 2048, 0, 1, 4326])
    }

    pub(crate) fn shorts(self, tag: u16, values: &[u16]) -> Self {
        self.entry(tag, 3, values.len(), values.iter().flat_map(|v| v.to_le_bytes()).collect())
    }

    pub(crate) fn longs(self, tag: u16, values: &[u32]) -> Self {
        self.entry(tag, 4, values.len(), values.iter().flat_map(|v| v.to_le_bytes()).collect())
    }

    pub(crate) fn doubles(self, tag: u16, values: &[f64]) -> Self {
        self.entry(tag, 12, values.len(), values.iter().flat_map(|v| v.to_le_bytes()).collect())
    }

    pub(crate) fn text(self, tag: u16, text: &str) -> Self {
        self.entry(tag, 2, text.len() + 1, [text.as_bytes(), &[0]].concat())
    }

    pub(crate) fn entry(mut self, tag: u16, kind: u16, count: usize, bytes: Vec<u8>) -> Self {
        self.entries.retain(|entry| entry.0 != tag);
        self.entries.push((tag, kind, count as u32, bytes));
        self
    }

    /// Strips of so many rows.
    pub(crate) fn strips(mut self, rows: u32, chunks: Vec<Vec<u8>>) -> Self {
        self.chunks = chunks;
        self.longs(278, &[rows])
    }

    /// Square tiles.
    pub(crate) fn tiles(mut self, side: u32, chunks: Vec<Vec<u8>>) -> Self {
        (self.chunks, self.tiled) = (chunks, true);
        self.longs(322, &[side]).longs(323, &[side])
    }

    /// The whole file.
    pub(crate) fn bytes(self) -> Vec<u8> {
        let (offsets, lengths) = if self.tiled { (324, 325) } else { (273, 279) };
        let mut at = 8;
        let start = |chunk: &Vec<u8>| {
            at += chunk.len() as u32;
            at - chunk.len() as u32
        };
        let starts: Vec<u32> = self.chunks.iter().map(start).collect();
        let sizes: Vec<u32> = self.chunks.iter().map(|chunk| chunk.len() as u32).collect();
        let chunks = self.chunks.concat();
        let mut entries = self.longs(offsets, &starts).longs(lengths, &sizes).entries;
        entries.sort_by_key(|entry| entry.0);
        let mut beyond = at + 2 + 12 * entries.len() as u32 + 4;
        let (mut directory, mut values) = ((entries.len() as u16).to_le_bytes().to_vec(), Vec::new());
        for (tag, kind, count, mut bytes) in entries {
            directory.extend([tag, kind].map(u16::to_le_bytes).concat());
            directory.extend(count.to_le_bytes());
            if bytes.len() > 4 {
                directory.extend(beyond.to_le_bytes());
                beyond += bytes.len() as u32;
                values.extend(bytes);
            } else {
                bytes.resize(4, 0);
                directory.extend(bytes);
            }
        }
        [b"II\x2a\0".as_slice(), &at.to_le_bytes(), &chunks, &directory, &[0; 4], &values].concat()
    }
}

/// Packed as compression 8 has it.
pub(crate) fn deflated(bytes: &[u8]) -> Vec<u8> {
    let mut packer = ZlibEncoder::new(Vec::new(), Compression::fast());
    packer.write_all(bytes).unwrap();
    packer.finish().unwrap()
}

/// A tile of floats with the floating-point predictor (Adobe, TIFF technical note 3): in each row the bytes of all
/// samples by significance, then differences.
pub(crate) fn with_float_predictor(rows: &[Vec<f32>]) -> Vec<u8> {
    let predicted = |row: &Vec<f32>| {
        let plane = |byte: usize| row.iter().map(move |v| v.to_be_bytes()[byte]);
        let bytes: Vec<u8> = (0..4).flat_map(plane).collect();
        let before = std::iter::once(0).chain(bytes.iter().copied());
        bytes.iter().zip(before).map(|(b, a)| b.wrapping_sub(a)).collect::<Vec<u8>>()
    };
    rows.iter().flat_map(predicted).collect()
}
