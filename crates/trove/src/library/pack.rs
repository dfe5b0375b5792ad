//! An asset library as one file: textures, meshes, then everything that refers to them, each block compressed.

use std::sync::Arc;

use rayon::prelude::*;
use trove_model::AssetLibrary;

use super::packed::{Packed, Packer, Unpacker};

/// Noise, of which textures are full, gains little by a higher one.
const LEVEL: i32 = 1;
/// Changes with the layout of the file.
const MAGIC: &[u8; 8] = b"TROVELB2";

/// The whole library as bytes.
pub(super) fn pack(library: &AssetLibrary) -> Vec<u8> {
    let mut packer = Packer::default();
    library.pack(&mut packer);
    let Packer { bytes, meshes, textures, .. } = packer;
    let mut blocks: Vec<Vec<u8>> = textures.par_iter().map(|t| block(&**t)).collect();
    blocks.par_extend(meshes.par_iter().map(|m| block(&**m)));
    blocks.push(compressed(&bytes));

    let mut file = MAGIC.to_vec();
    for count in [textures.len(), meshes.len()] {
        file.extend((count as u32).to_le_bytes());
    }
    for block in &blocks {
        file.extend((block.len() as u64).to_le_bytes());
        file.extend(crc32fast::hash(block).to_le_bytes());
    }
    blocks.iter().for_each(|block| file.extend_from_slice(block));
    file
}

fn block(value: &impl Packed) -> Vec<u8> {
    let mut packer = Packer::default();
    value.pack(&mut packer);
    compressed(&packer.bytes)
}

fn compressed(bytes: &[u8]) -> Vec<u8> {
    zstd::encode_all(bytes, LEVEL).expect("writing to memory does not fail")
}

/// The library again; `None` where the file is damaged or of another layout.
pub(super) fn unpack(file: &[u8]) -> Option<AssetLibrary> {
    let mut from = Unpacker { bytes: file.strip_prefix(MAGIC)?, meshes: &[], textures: &[] };
    let [textures, meshes]: [u32; 2] = Packed::unpack(&mut from)?;
    let (textures, meshes) = (textures as usize, meshes as usize);
    let count = textures.checked_add(meshes)?.checked_add(1)?;
    if count.checked_mul(12)? > from.bytes.len() {
        return None;
    }
    let mut table = Vec::with_capacity(count);
    for _ in 0..count {
        table.push((usize::unpack(&mut from)?, u32::unpack(&mut from)?));
    }
    let mut blocks = Vec::with_capacity(count);
    for (length, sum) in table {
        let (block, left) = from.bytes.split_at_checked(length)?;
        from.bytes = left;
        blocks.push((block, sum));
    }
    let textures_of =
        |blocks: &[(&[u8], u32)]| blocks.par_iter().map(|b| value(b).map(Arc::new)).collect::<Option<Vec<_>>>();
    let (textures, meshes): (Option<Vec<_>>, Option<Vec<_>>) = rayon::join(
        || textures_of(&blocks[..textures]),
        || blocks[textures..count - 1].par_iter().map(|b| value(b).map(Arc::new)).collect(),
    );
    let (textures, meshes) = (textures?, meshes?);
    let bytes = opened(&blocks[count - 1])?;
    AssetLibrary::unpack(&mut Unpacker { bytes: &bytes, meshes: &meshes, textures: &textures })
}

fn value<T: Packed>(block: &(&[u8], u32)) -> Option<T> {
    T::unpack(&mut Unpacker { bytes: &opened(block)?, meshes: &[], textures: &[] })
}

/// A block's bytes, where its sum is right.
fn opened((block, sum): &(&[u8], u32)) -> Option<Vec<u8>> {
    let whole = crc32fast::hash(block) == *sum;
    whole.then(|| zstd::decode_all(*block).ok()).flatten()
}
