//! Small model files, made on the fly.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use trove_model::{AssetLibrary, Report};
use trove_read::asset_files;

/// A glTF document under construction.
pub(crate) struct Glb {
    pub(crate) json: Value,
    pub(crate) bin: Vec<u8>,
}

impl Glb {
    pub(crate) fn new() -> Self {
        Self {
            json: json!({
                "asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
                "meshes": [], "accessors": [], "bufferViews": [], "materials": []
            }),
            bin: Vec::new(),
        }
    }

    /// A closed box of three sides' lengths, standing on y = 0, as mesh 0 of node 0.
    pub(crate) fn cuboid(size: [f32; 3]) -> Self {
        let mut glb = Self::new();
        let corner = |i: usize| [(i & 1) as f32 - 0.5, (i >> 1 & 1) as f32, (i >> 2 & 1) as f32 - 0.5];
        let positions: Vec<f32> = (0..8).flat_map(|i| (0..3).map(move |k| corner(i)[k] * size[k])).collect();
        let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        let indices: Vec<u32> = quads.iter().flat_map(|q| [q[0], q[1], q[2], q[0], q[2], q[3]]).collect();
        let positions = glb.floats(&positions, "VEC3");
        let indices = glb.indices(&indices);
        glb.json["meshes"] = json!([{"primitives": [{"attributes": {"POSITION": positions}, "indices": indices}]}]);
        glb
    }

    pub(crate) fn view(&mut self, bytes: &[u8]) -> usize {
        let offset = self.bin.len();
        self.bin.extend(bytes);
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        let views = self.json["bufferViews"].as_array_mut().unwrap();
        views.push(json!({"buffer": 0, "byteOffset": offset, "byteLength": bytes.len()}));
        views.len() - 1
    }

    pub(crate) fn accessor(&mut self, accessor: Value) -> usize {
        let accessors = self.json["accessors"].as_array_mut().unwrap();
        accessors.push(accessor);
        accessors.len() - 1
    }

    pub(crate) fn floats(&mut self, values: &[f32], shape: &str) -> usize {
        let width = match shape {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            "VEC4" => 4,
            _ => 16,
        };
        let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
        let view = self.view(&bytes);
        self.accessor(json!({"bufferView": view, "componentType": 5126, "count": values.len() / width, "type": shape}))
    }

    pub(crate) fn indices(&mut self, values: &[u32]) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
        let view = self.view(&bytes);
        self.accessor(json!({"bufferView": view, "componentType": 5125, "count": values.len(), "type": "SCALAR"}))
    }

    /// A PNG as texture; its index.
    pub(crate) fn texture(&mut self, width: u32, height: u32, rgba: impl Fn(u32, u32) -> [u8; 4]) -> usize {
        let view = self.view(&png(width, height, rgba));
        self.picture(json!({"bufferView": view, "mimeType": "image/png"}))
    }

    pub(crate) fn picture(&mut self, image: Value) -> usize {
        for (key, value) in [("images", image), ("textures", json!({}))] {
            if self.json[key].is_null() {
                self.json[key] = json!([]);
            }
            self.json[key].as_array_mut().unwrap().push(value);
        }
        let last = self.json["textures"].as_array().unwrap().len() - 1;
        self.json["textures"][last] = json!({"source": last});
        last
    }

    /// Gives the first primitive texture coordinates and a material.
    pub(crate) fn material(mut self, material: Value) -> Self {
        let uvs =
            self.floats(&[0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 1.0, 0.25, 0.5, 1.0, 0.5, 0.5, 1.0, 0.5, 0.5], "VEC2");
        self.json["materials"].as_array_mut().unwrap().push(material);
        self.json["meshes"][0]["primitives"][0]["material"] = json!(0);
        self.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = json!(uvs);
        self
    }

    pub(crate) fn bytes(&self) -> Vec<u8> {
        let mut document = self.json.clone();
        if document["buffers"].is_null() {
            document["buffers"] = json!([{"byteLength": self.bin.len()}]);
        }
        let mut text = document.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let total = 12 + 8 + text.len() + 8 + self.bin.len();
        let mut out = b"glTF".to_vec();
        out.extend([2, total as u32, text.len() as u32].iter().flat_map(|v: &u32| v.to_le_bytes()));
        out.extend(b"JSON");
        out.extend(&text);
        out.extend((self.bin.len() as u32).to_le_bytes());
        out.extend(b"BIN\0");
        out.extend(&self.bin);
        out
    }
}

pub(crate) fn png(width: u32, height: u32, rgba: impl Fn(u32, u32) -> [u8; 4]) -> Vec<u8> {
    let picture = image::RgbaImage::from_fn(width, height, |x, y| image::Rgba(rgba(x, y)));
    let mut bytes = std::io::Cursor::new(Vec::new());
    picture.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    bytes.into_inner()
}

/// An ASCII FBX file: a box in centimetres, y up, 180 × 150 × 450.
pub(crate) fn fbx() -> String {
    let corner = |i: usize| {
        let [x, y, z] = [(i & 1) as f64 - 0.5, (i >> 1 & 1) as f64, (i >> 2 & 1) as f64 - 0.5];
        format!("{},{},{}", x * 180.0, y * 150.0, z * 450.0)
    };
    let corners: Vec<String> = (0..8).map(corner).collect();
    // The last index of a polygon is its complement.
    let faces = "0,4,6,-3,1,3,7,-6,0,1,5,-5,2,6,7,-4,0,2,3,-2,4,5,7,-7";
    format!(
        "; FBX 7.4.0 project file\nFBXHeaderExtension: {{\n FBXHeaderVersion: 1003\n FBXVersion: 7400\n}}\n\
        GlobalSettings: {{\n Version: 1000\n Properties70: {{\n  P: \"UpAxis\", \"int\", \"Integer\", \"\",1\n  \
        P: \"UpAxisSign\", \"int\", \"Integer\", \"\",1\n  P: \"FrontAxis\", \"int\", \"Integer\", \"\",2\n  \
        P: \"FrontAxisSign\", \"int\", \"Integer\", \"\",1\n  P: \"CoordAxis\", \"int\", \"Integer\", \"\",0\n  \
        P: \"CoordAxisSign\", \"int\", \"Integer\", \"\",1\n  P: \"UnitScaleFactor\", \"double\", \"Number\", \"\",1\n }}\n}}\n\
        Objects: {{\n Geometry: 1000, \"Geometry::Box\", \"Mesh\" {{\n  Vertices: *24 {{\n   a: {}\n  }}\n  \
        PolygonVertexIndex: *24 {{\n   a: {faces}\n  }}\n  GeometryVersion: 124\n }}\n \
        Model: 2000, \"Model::Box\", \"Mesh\" {{\n  Version: 232\n }}\n \
        Material: 3000, \"Material::Paint\", \"\" {{\n  Version: 102\n  ShadingModel: \"phong\"\n  Properties70: {{\n   \
        P: \"DiffuseColor\", \"Color\", \"\", \"A\",0.8,0.1,0.1\n  }}\n }}\n}}\n\
        Connections: {{\n C: \"OO\",2000,0\n C: \"OO\",1000,2000\n C: \"OO\",3000,2000\n}}\n",
        corners.join(",")
    )
}

/// A box of 4.5 × 1.8 × 1.5 m with z up, forward along x, and its materials' file.
pub(crate) fn obj() -> (String, String) {
    let mut text = String::from("mtllib car.mtl\no Body\n");
    for i in 0..8 {
        let [x, y, z] = [(i & 1) as f64 - 0.5, (i >> 1 & 1) as f64 - 0.5, (i >> 2 & 1) as f64];
        text += &format!("v {} {} {}\n", x * 4.5, y * 1.8, z * 1.5);
    }
    text += "usemtl Paint\nf 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nusemtl Glass\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
    (text, "newmtl Paint\nKd 0.1 0.2 0.8\nNs 200\nnewmtl Glass\nKd 0.9 0.9 0.9\nd 0.3\n".into())
}

/// A folder that is a library.
pub(crate) struct Folder {
    _temporary: tempfile::TempDir,
    pub(crate) path: PathBuf,
}

impl Folder {
    pub(crate) fn new(files: &[(&str, &[u8])]) -> Self {
        let temporary = tempfile::tempdir().unwrap();
        let path = temporary.path().join("mine");
        std::fs::create_dir(&path).unwrap();
        let folder = Self { _temporary: temporary, path };
        files.iter().for_each(|(name, bytes)| folder.write(name, bytes));
        folder
    }

    pub(crate) fn write(&self, name: &str, bytes: &[u8]) {
        let path = self.path.join(name);
        std::fs::create_dir_all(path.parent().unwrap_or(Path::new(""))).unwrap();
        std::fs::write(path, bytes).unwrap();
    }

    pub(crate) fn toml(&self) -> String {
        std::fs::read_to_string(self.path.join("library.toml")).unwrap_or_default()
    }

    /// Imports and reads, with everything that was reported.
    pub(crate) fn read(&self) -> (Option<AssetLibrary>, String) {
        let report = Report::default();
        let library =
            asset_files::import(&self.path, &report).and_then(|_| asset_files::read_library(&self.path, &report));
        let mut text: Vec<String> =
            report.entries().iter().map(|e| format!("{:?} {}: {:?}", e.outcome, e.what, e.examples)).collect();
        let library = library.map_err(|e| text.push(e.to_string())).ok();
        (library, text.join("\n"))
    }
}

/// The one asset of a library with this file.
pub(crate) fn asset(name: &str, bytes: &[u8]) -> trove_model::Asset {
    let (library, report) = Folder::new(&[(name, bytes)]).read();
    let mut library = library.unwrap_or_else(|| panic!("{report}"));
    assert_eq!(library.assets.len(), 1, "{report}");
    library.assets.remove(0)
}
