//! A `.gltf` or `.glb` file's JSON and the bytes of its buffers.

use std::path::{Path, PathBuf};

use trove_files::Folder;

use super::json::Root;
use crate::ReadError;
use crate::asset_files::fault::Fault;
use trove_files::Budget;

/// A file with everything that it refers to but pictures.
#[derive(Debug)]
pub(super) struct Container {
    pub(super) root: Root,
    path: PathBuf,
    folder: PathBuf,
    /// Holds every file that the file may name.
    library: Folder,
    buffers: Vec<Vec<u8>>,
    /// For everything that is made of the file and of the buffers beside it.
    pub(super) budget: Budget,
    /// Views that were packed with meshopt, unpacked.
    pub(super) unpacked: Vec<Option<Vec<u8>>>,
}

/// What is done about the required extensions that are understood.
const UNDERSTOOD: [&str; 21] = [
    "KHR_draco_mesh_compression",
    "EXT_meshopt_compression",
    "KHR_meshopt_compression",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
    "KHR_materials_emissive_strength",
    "KHR_materials_transmission",
    "KHR_materials_volume",
    "KHR_materials_ior",
    "KHR_materials_clearcoat",
    "KHR_materials_specular",
    "KHR_materials_sheen",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_materials_anisotropy",
    "KHR_materials_iridescence",
    "KHR_lights_punctual",
    "EXT_texture_webp",
    "KHR_node_visibility",
];

impl Container {
    /// Reads a file's bytes, and leaves views that are packed as they are; buffers beside it are read from `path`'s folder.
    pub(super) fn open(path: &Path, bytes: &[u8], library: &Folder) -> Result<Self, ReadError> {
        let (json, binary) = chunks(bytes).map_err(|fault| fault.at(path))?;
        let root: Root = serde_json::from_slice(json)
            .map_err(|e| Fault::damaged("JSON", "a glTF 2.0 document", e.to_string()).at(path))?;
        if !root.asset.version.starts_with('2') {
            let remedy = "convert it: `npx gltf-pipeline -i model.gltf -o model.glb`";
            let found = format!("version {:?}", root.asset.version);
            return Err(Fault::new("asset.version", "glTF 2", found, remedy).at(path));
        }
        if let Some(unknown) = root.extensions_required.iter().find(|e| !UNDERSTOOD.contains(&e.as_str())) {
            return Err(unknown_extension(unknown).at(path));
        }
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        let mut binary = binary.map(<[u8]>::to_vec);
        let mut buffers = Vec::new();
        for (i, buffer) in root.buffers.iter().enumerate() {
            let bytes = match &buffer.uri {
                Some(uri) => {
                    resource(library, &folder, uri).map_err(|e| e.into_error(path, &format!("buffers[{i}]")))?
                }
                None => binary.take().unwrap_or_default(),
            };
            if bytes.len() < buffer.byte_length {
                let expected = format!("{} bytes", buffer.byte_length);
                let found = format!("{} bytes", bytes.len());
                return Err(Fault::damaged(format!("buffers[{i}]"), expected, found).at(path));
            }
            buffers.push(bytes);
        }
        let size = bytes.len() + buffers.iter().map(Vec::len).sum::<usize>();
        let budget = Budget::of_file(size as u64);
        Ok(Self {
            budget,
            root,
            path: path.to_owned(),
            folder,
            library: library.clone(),
            buffers,
            unpacked: Vec::new(),
        })
    }

    /// A slice of a buffer.
    pub(super) fn bytes(&self, buffer: usize, offset: usize, length: usize, place: &str) -> Result<&[u8], Fault> {
        let all = self.buffers.get(buffer).ok_or_else(|| none(place, "buffer", buffer, self.buffers.len()))?;
        offset.checked_add(length).and_then(|end| all.get(offset..end)).ok_or_else(|| {
            let expected = format!("{length} bytes from byte {offset} of buffers[{buffer}]");
            Fault::damaged(place, expected, format!("a buffer of {} bytes", all.len()))
        })
    }

    /// The bytes of a view and the distance of its elements, where it says so.
    pub(super) fn view(&self, view: usize, place: &str) -> Result<(&[u8], Option<usize>), Fault> {
        let v = self.root.buffer_views.get(view);
        let v = v.ok_or_else(|| none(place, "bufferView", view, self.root.buffer_views.len()))?;
        if let Some(Some(bytes)) = self.unpacked.get(view) {
            return Ok((bytes, v.byte_stride));
        }
        let place = format!("{place}: bufferViews[{view}]");
        Ok((self.bytes(v.buffer, v.byte_offset, v.byte_length, &place)?, v.byte_stride))
    }

    /// A picture's bytes and the file that it is in, with `#` and its number where it is embedded.
    pub(super) fn image(&self, image: usize) -> Result<(Vec<u8>, PathBuf), String> {
        let embedded = || PathBuf::from(format!("{}#{image}", self.path.display()));
        let i = self.root.images.get(image).ok_or_else(|| format!("images[{image}] of {}", self.root.images.len()))?;
        if let Some(view) = i.buffer_view {
            let (bytes, _) = self.view(view, &format!("images[{image}]")).map_err(|f| format!("{f:?}"))?;
            return Ok((bytes.to_vec(), embedded()));
        }
        let uri = i.uri.as_deref().ok_or_else(|| format!("images[{image}] has neither bytes nor a file"))?;
        let bytes = resource(&self.library, &self.folder, uri).map_err(|e| e.found)?;
        Ok((bytes, if uri.starts_with("data:") { embedded() } else { self.folder.join(percent_decoded(uri)) }))
    }
}

/// An index that does not exist.
pub(super) fn none(place: &str, what: &str, index: usize, count: usize) -> Fault {
    Fault::damaged(place, format!("a {what} below {count}"), format!("{index}"))
}

fn unknown_extension(name: &str) -> Fault {
    let remedy = match name {
        "KHR_texture_basisu" => "unpack its textures: `npx @gltf-transform/cli ktxdecompress in.glb out.glb`",
        _ => "export the model without this extension",
    };
    Fault::new("extensionsRequired", "extensions that TRoVE knows", name, remedy)
}

/// JSON and binary chunk of a `.glb`, or all of a `.gltf`.
fn chunks(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), Fault> {
    if !bytes.starts_with(b"glTF") {
        return Ok((bytes, None));
    }
    let word = |at: usize| bytes.get(at..at + 4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]));
    let mut at = 12;
    let (mut json, mut binary) = (None, None);
    while let (Some(length), Some(kind)) = (word(at), word(at + 4)) {
        let chunk = (at + 8).checked_add(length as usize).and_then(|end| bytes.get(at + 8..end)).ok_or_else(|| {
            let found = format!("{} bytes", bytes.len());
            Fault::damaged(format!("chunk at byte {at}"), format!("{length} bytes after its header"), found)
        })?;
        match kind {
            0x4E4F_534A if json.is_none() => json = Some(chunk),
            0x004E_4942 if binary.is_none() => binary = Some(chunk),
            _ => {}
        }
        at += 8 + chunk.len().next_multiple_of(4);
    }
    let json = json.ok_or_else(|| {
        Fault::damaged("byte 12", "a JSON chunk", format!("the end of the file at byte {}", bytes.len()))
    })?;
    Ok((json, binary))
}

/// Why something that a file refers to is not there.
pub(super) struct Unavailable {
    uri: String,
    found: String,
}

impl Unavailable {
    fn into_error(self, path: &Path, place: &str) -> ReadError {
        ReadError::Missing {
            path: path.to_owned(),
            expected: format!("{place} in {:?}", self.uri),
            found: self.found,
            remedy: "put the file there, or export the model as one .glb file".into(),
        }
    }
}

/// The bytes of a `data:` URI or of a file beside the model.
fn resource(library: &Folder, folder: &Path, uri: &str) -> Result<Vec<u8>, Unavailable> {
    let fail = |found: String| Unavailable { uri: uri.chars().take(80).collect(), found };
    if let Some(data) = uri.strip_prefix("data:") {
        let base64 = data.split_once(";base64,").ok_or_else(|| fail("a data URI without base64".into()))?.1;
        return decode_base64(base64).ok_or_else(|| fail("characters that are not base64".into()));
    }
    if uri.contains("://") {
        return Err(fail("a network address".into()));
    }
    library.read(folder, &percent_decoded(uri)).map_err(|e| fail(e.to_string()))
}

fn percent_decoded(uri: &str) -> String {
    let bytes = uri.as_bytes();
    let mut out = Vec::with_capacity(bytes.len());
    let mut i = 0;
    while i < bytes.len() {
        let hex = (bytes[i] == b'%').then(|| bytes.get(i + 1..i + 3)).flatten();
        let value = hex.and_then(|h| std::str::from_utf8(h).ok()).and_then(|h| u8::from_str_radix(h, 16).ok());
        out.push(value.unwrap_or(bytes[i]));
        i += if value.is_some() { 3 } else { 1 };
    }
    String::from_utf8_lossy(&out).into_owned()
}

fn decode_base64(text: &str) -> Option<Vec<u8>> {
    let mut out = Vec::with_capacity(text.len() / 4 * 3);
    let (mut bits, mut count) = (0u32, 0);
    for letter in text.bytes().filter(|b| !b.is_ascii_whitespace() && *b != b'=') {
        let value = match letter {
            b'A'..=b'Z' => letter - b'A',
            b'a'..=b'z' => letter - b'a' + 26,
            b'0'..=b'9' => letter - b'0' + 52,
            b'+' | b'-' => 62,
            b'/' | b'_' => 63,
            _ => return None,
        };
        bits = bits << 6 | u32::from(value);
        count += 6;
        if count >= 8 {
            count -= 8;
            out.push((bits >> count) as u8);
        }
    }
    Some(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_and_percent_signs_are_decoded() {
        assert_eq!(decode_base64("aGVsbG8="), Some(b"hello".to_vec()));
        assert_eq!(decode_base64("aGVs bG8h\n"), Some(b"hello!".to_vec()));
        assert_eq!(decode_base64("a*"), None);
        assert_eq!(percent_decoded("my%20car%2Epng%4"), "my car.png%4");
    }
}
