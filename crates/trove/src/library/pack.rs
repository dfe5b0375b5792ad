//! An asset library as one file: textures, meshes, then everything that refers to them, each block compressed.

use std::collections::HashMap;
use std::sync::Arc;

use rayon::prelude::*;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use trove_model::{AssetLibrary, ColorSpace, Mesh, Texture};

/// Noise, of which textures are full, gains little by a higher one.
const LEVEL: i32 = 1;
/// Changes with the layout of the file.
const MAGIC: &[u8; 8] = b"TROVELB6";

/// What stands before the blocks.
#[derive(Serialize, Deserialize)]
struct Header {
    /// So many of the blocks are textures; all others but the last one are meshes.
    textures: usize,
    blocks: Vec<Block>,
}

#[derive(Serialize, Deserialize)]
struct Block {
    bytes: usize,
    crc32: u32,
}

/// The last block: a library without its meshes and textures, and which of them go where.
#[derive(Serialize, Deserialize)]
struct Rest {
    library: AssetLibrary,
    /// In the order of [`AssetLibrary::meshes_mut`].
    meshes: Vec<u32>,
    /// In the order of [`AssetLibrary::textures_mut`].
    textures: Vec<u32>,
}

/// The whole library as bytes.
pub(super) fn pack(library: &AssetLibrary) -> Vec<u8> {
    let mut library = library.clone();
    let (meshes, mesh_numbers) = taken(library.meshes_mut(), &Arc::new(Mesh::default()));
    let none = Texture { name: String::new(), width: 0, height: 0, rgba: Vec::new(), color_space: ColorSpace::Linear };
    let (textures, texture_numbers) = taken(library.textures_mut(), &Arc::new(none));

    let mut blocks: Vec<Vec<u8>> = textures.par_iter().map(|t| block(&**t)).collect();
    blocks.par_extend(meshes.par_iter().map(|m| block(&**m)));
    blocks.push(block(&Rest { library, meshes: mesh_numbers, textures: texture_numbers }));

    let row = |block: &Vec<u8>| Block { bytes: block.len(), crc32: crc32fast::hash(block) };
    let header = bytes(&Header { textures: textures.len(), blocks: blocks.iter().map(row).collect() });
    let sum = crc32fast::hash(&header).to_le_bytes();
    [&MAGIC[..], &sum, &header].into_iter().chain(blocks.iter().map(Vec::as_slice)).flatten().copied().collect()
}

/// What is shared, each once, and its number in every place; `stand_in` is left there.
fn taken<'a, T: 'a>(places: impl Iterator<Item = &'a mut Arc<T>>, stand_in: &Arc<T>) -> (Vec<Arc<T>>, Vec<u32>) {
    let mut all = Vec::new();
    let mut known = HashMap::new(); // only ever looked up
    let number = |place: &mut Arc<T>| {
        let shared = std::mem::replace(place, stand_in.clone());
        *known.entry(Arc::as_ptr(&shared).addr()).or_insert_with(|| {
            all.push(shared);
            all.len() as u32 - 1
        })
    };
    let numbers = places.map(number).collect();
    (all, numbers)
}

/// Puts back what was taken; `None` where the numbers are not those of the places.
fn put<'a, T: 'a>(places: impl Iterator<Item = &'a mut Arc<T>>, all: &[Arc<T>], numbers: &[u32]) -> Option<()> {
    let mut numbers = numbers.iter();
    for place in places {
        *place = all.get(*numbers.next()? as usize)?.clone();
    }
    numbers.next().is_none().then_some(())
}

fn bytes(value: &impl Serialize) -> Vec<u8> {
    postcard::to_stdvec(value).expect("memory takes everything, and our types say how many elements they have")
}

fn block(value: &impl Serialize) -> Vec<u8> {
    zstd::encode_all(&bytes(value)[..], LEVEL).expect("writing to memory does not fail")
}

/// The library again; `None` where the file is damaged or of another layout.
pub(super) fn unpack(file: &[u8]) -> Option<AssetLibrary> {
    let (sum, file) = file.strip_prefix(MAGIC)?.split_first_chunk()?;
    let (header, mut left): (Header, &[u8]) = postcard::take_from_bytes(file).ok()?;
    if crc32fast::hash(&file[..file.len() - left.len()]) != u32::from_le_bytes(*sum) {
        return None;
    }
    let mut blocks = Vec::with_capacity(header.blocks.len());
    for Block { bytes, crc32 } in header.blocks {
        let (block, after) = left.split_at_checked(bytes)?;
        left = after;
        blocks.push((block, crc32));
    }
    let (rest, shared) = blocks.split_last()?;
    let (textures, meshes) = shared.split_at_checked(header.textures)?;
    let ((textures, meshes), rest) =
        rayon::join(|| rayon::join(|| values(textures), || values(meshes)), || value::<Rest>(rest));
    let Rest { mut library, meshes: mesh_numbers, textures: texture_numbers } = rest?;
    put(library.meshes_mut(), &meshes?, &mesh_numbers)?;
    put(library.textures_mut(), &textures?, &texture_numbers)?;
    Some(library)
}

fn values<T: DeserializeOwned + Send + Sync>(blocks: &[(&[u8], u32)]) -> Option<Vec<Arc<T>>> {
    blocks.par_iter().map(|block| value(block).map(Arc::new)).collect()
}

/// What a block holds, where its sum is right.
fn value<T: DeserializeOwned>((block, sum): &(&[u8], u32)) -> Option<T> {
    let whole = crc32fast::hash(block) == *sum;
    let bytes = whole.then(|| zstd::decode_all(*block).ok()).flatten()?;
    postcard::from_bytes(&bytes).ok()
}
