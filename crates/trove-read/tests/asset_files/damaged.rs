//! Whatever is in a file: an error that names it, or a repair that is reported.

use proptest::prelude::*;
use serde_json::{Value, json};
use trove_model::Seed;

use crate::files::{Folder, Glb, fbx, obj, png};

/// What a library says of one file: its report, and whether there was an asset.
fn verdict(name: &str, bytes: &[u8]) -> (bool, String) {
    let (library, report) = Folder::new(&[(name, bytes)]).read();
    assert!(!report.contains("a fault of TRoVE"), "a panic was caught: {report}");
    (library.is_some_and(|l| !l.assets.is_empty()), report)
}

fn car() -> Glb {
    let mut glb = Glb::cuboid([1.8, 1.5, 4.5]);
    let texture = glb.texture(4, 4, |x, y| [x as u8, y as u8, 9, 255]);
    glb.material(json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": texture}}}))
}

#[test]
fn files_that_end_early_are_named() {
    for (name, bytes) in
        [("car.glb", car().bytes()), ("car.fbx", fbx().into_bytes()), ("car.obj", obj().0.into_bytes())]
    {
        for length in (0..bytes.len()).step_by(100) {
            let (whole, report) = verdict(name, &bytes[..length]);
            assert!(whole || report.contains(name), "{name} at {length}: {report}");
            assert!(name != "car.glb" || !whole, "{length}: {report}");
        }
    }
}

/// What the report names, whether the asset is still there, and the damage.
type Case<'a> = (&'a str, bool, &'a dyn Fn(&mut Value));

#[test]
fn damaged_documents_are_refused_or_repaired_by_name() {
    let broken = |change: &dyn Fn(&mut Value)| {
        let mut glb = car();
        change(&mut glb.json);
        verdict("car.glb", &glb.bytes())
    };
    let cases: [Case; 13] = [
        ("loop", true, &|j| j["nodes"] = json!([{"mesh": 0, "children": [1]}, {"children": [0, 1]}])),
        ("accessors[0]", false, &|j| j["accessors"][0]["count"] = json!(4_000_000_000_u64)),
        ("accessors[0]", false, &|j| j["accessors"][0]["byteOffset"] = json!(u64::MAX)),
        ("bufferViews[0]", false, &|j| j["bufferViews"][0]["byteLength"] = json!(1_u64 << 40)),
        ("accessor", false, &|j| j["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!(99)),
        ("componentType", false, &|j| j["accessors"][0]["componentType"] = json!(7)),
        ("nowhere.bin", false, &|j| j["buffers"] = json!([{"uri": "nowhere.bin", "byteLength": 8}])),
        ("network", false, &|j| j["buffers"] = json!([{"uri": "https://example.org/a.bin", "byteLength": 8}])),
        ("ktxdecompress", false, &|j| j["extensionsRequired"] = json!(["KHR_texture_basisu"])),
        ("version", false, &|j| j["asset"]["version"] = json!("1.0")),
        ("texture", true, &|j| j["textures"][0]["source"] = json!(77)),
        ("material", false, &|j| j["meshes"][0]["primitives"][0]["material"] = json!(5)),
        ("points and lines", false, &|j| j["meshes"][0]["primitives"][0]["mode"] = json!(1)),
    ];
    for (what, whole, change) in cases {
        let (is_whole, report) = broken(change);
        assert!(report.contains(what) || what == "points and lines", "{what}: {report}");
        assert!(report.contains("car"), "{what}: {report}");
        assert_eq!(is_whole, whole, "{what}: {report}");
    }
}

#[test]
fn broken_triangles_go_and_the_rest_stays() {
    let mut glb = car();
    let bad = glb.floats(&[f32::NAN, 0.0, 0.0, f32::INFINITY, 0.0, 0.0, 1.0, 1.0, 1.0], "VEC3");
    let indices = glb.indices(&[0, 1, 2, 0, 0, 0, 2, 2, 1, 0, 1, 900]);
    let primitives = glb.json["meshes"][0]["primitives"].as_array_mut().unwrap();
    primitives.push(json!({"attributes": {"POSITION": bad}, "indices": indices}));
    let (whole, report) = verdict("car.glb", &glb.bytes());
    assert!(whole && report.contains("triangles with invalid vertices were dropped"), "{report}");
}

#[test]
fn what_is_no_picture_is_left_out_and_named() {
    let mut glb = Glb::cuboid([1.8, 1.5, 4.5]);
    let view = glb.view(b"this is no picture");
    let texture = glb.picture(json!({"bufferView": view}));
    let glb = glb.material(json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": texture}}}));
    let (whole, report) = verdict("car.glb", &glb.bytes());
    assert!(whole && report.contains("not an image"), "{report}");
}

#[test]
fn large_pictures_are_scaled_and_larger_ones_refused() {
    let of = |width: u32| {
        let mut glb = Glb::cuboid([1.8, 1.5, 4.5]);
        let texture = glb.texture(width, 16, |_, _| [9, 9, 9, 255]);
        let glb = glb.material(json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": texture}}}));
        verdict("car.glb", &glb.bytes())
    };
    let (whole, report) = of(16_384);
    assert!(whole && report.contains("16384 × 16 pixels became 2048 × 2"), "{report}");
    let (whole, report) = of(16_400);
    assert!(whole && report.contains("at most 16384"), "{report}");
}

#[test]
fn models_of_millions_of_triangles_are_thinned_out() {
    // A wavy sheet, closed enough to be a rock.
    let side = 600;
    let at = |i: usize| {
        let (x, z) = ((i % side) as f32 / side as f32, (i / side) as f32 / side as f32);
        [x * 2.0, (x * 9.0).sin() * (z * 7.0).cos() * 0.4, z * 2.0]
    };
    let mut glb = Glb::new();
    let positions: Vec<f32> = (0..side * side).flat_map(at).collect();
    let quad = |i: usize| {
        let a = (i / (side - 1) * side + i % (side - 1)) as u32;
        let below = a + side as u32;
        [a, below, a + 1, a + 1, below, below + 1]
    };
    let indices: Vec<u32> = (0..(side - 1) * (side - 1)).flat_map(quad).collect();
    let (positions, indices) = (glb.floats(&positions, "VEC3"), glb.indices(&indices));
    glb.json["meshes"] = json!([{"primitives": [{"attributes": {"POSITION": positions}, "indices": indices}]}]);
    let folder = Folder::new(&[("bush.glb", &glb.bytes())]);
    let (library, report) = folder.read();
    let asset = &library.expect(&report).assets[0];
    assert!(report.contains("717602 triangles became"), "{report}");
    assert!((20_000..=110_000).contains(&asset.mesh.triangles.len()), "{}", asset.mesh.triangles.len());
    assert!(!asset.coarser.is_empty() && asset.coarser[0].mesh.triangles.len() < 30_000);
}

#[test]
fn indices_beyond_their_own_vertices_do_not_lead_into_the_next_piece() {
    let mut glb = car();
    let none = glb.accessor(json!({"componentType": 5126, "count": 0, "type": "VEC3"}));
    let indices = glb.indices(&[0, 1, 2, u32::MAX, 7, 6]);
    let primitives = glb.json["meshes"][0]["primitives"].as_array_mut().unwrap();
    primitives.insert(0, json!({"attributes": {"POSITION": none}, "indices": indices}));
    let (whole, report) = verdict("car.glb", &glb.bytes());
    assert!(whole && report.contains("triangles with invalid vertices were dropped"), "{report}");
}

#[test]
fn small_models_that_unpack_to_gigabytes_are_refused() {
    let refused = |change: &dyn Fn(&mut Glb)| {
        let mut glb = car();
        change(&mut glb);
        let (whole, report) = verdict("car.glb", &glb.bytes());
        assert!(!whole && report.contains("unpacks to at most"), "{report}");
    };
    // Zeros that are nowhere in the file.
    refused(&|glb| {
        let zeros = glb.accessor(json!({"componentType": 5126, "count": 100_000_000, "type": "VEC3"}));
        glb.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!(zeros);
    });
    // The same geometry again and again.
    refused(&|glb| {
        let positions = glb.floats(&[0.5; 3 * 20_000], "VEC3");
        glb.json["meshes"][0]["primitives"] = json!(vec![json!({"attributes": {"POSITION": positions}}); 2000]);
    });
    let plain = |width: u32, height: u32| png(width, height, |_, _| [9, 9, 9, 255]);
    let mut glb = Glb::cuboid([1.8, 1.5, 4.5]);
    let view = glb.view(&plain(16_384, 8192));
    let texture = glb.picture(json!({"bufferView": view}));
    let glb = glb.material(json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": texture}}}));
    let (whole, report) = verdict("car.glb", &glb.bytes());
    assert!(whole && report.contains("made to fill the memory"), "{report}");
}

/// A car whose buffer or texture is a file beside it.
fn referring(uri: &str) -> Vec<u8> {
    let mut glb = Glb::cuboid([1.8, 1.5, 4.5]);
    let texture = glb.picture(json!({"uri": uri}));
    glb.material(json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": texture}}})).bytes()
}

#[cfg(unix)]
#[test]
fn only_regular_files_of_the_library_are_read() {
    let folder = Folder::new(&[("in.png", &png(4, 4, |_, _| [9, 9, 9, 255])), ("maps/plain.txt", b"")]);
    let outside = folder.path.parent().unwrap().join("secret.png");
    std::fs::write(&outside, png(4, 4, |_, _| [1, 2, 3, 255])).unwrap();
    std::os::unix::fs::symlink(&outside, folder.path.join("link.png")).unwrap();
    std::os::unix::fs::symlink("/", folder.path.join("root")).unwrap();
    assert!(std::process::Command::new("mkfifo").arg(folder.path.join("pipe.png")).status().unwrap().success());
    let absolute = outside.to_str().unwrap().to_owned();
    for (uri, read) in [
        ("in.png", true),
        ("maps/../in.png", true),
        ("pipe.png", false),
        ("../secret.png", false),
        ("link.png", false),
        (&absolute, false),
        ("/dev/zero", false),
    ] {
        folder.write("car.glb", &referring(uri));
        let (library, report) = folder.read();
        let textured = library.unwrap().assets[0].materials(Seed(0), None).iter().any(|m| m.base_color_map.is_some());
        assert_eq!(textured, read, "{uri}: {report}");
        assert!(read || report.contains("a texture was left out"), "{uri}: {report}");
        assert!(report.contains("a link out of the folder"), "{report}");
        std::fs::remove_file(folder.path.join("library.toml")).unwrap();
    }
    folder.write(
        "library.toml",
        b"[[asset]]\nfile = \"../secret.glb\"\n[[asset]]\nfile = \"/dev/zero\"\n[[environment]]\nfile = \"pipe.png\"\n",
    );
    let findings = trove_read::asset_files::check(&folder.path);
    assert_eq!(findings.iter().filter(|f| f.severe).count(), 3, "{findings:?}");
}

#[cfg(unix)]
#[test]
fn materials_and_maps_of_an_obj_are_regular_files_of_the_library() {
    let (text, mtl) = obj();
    let secret = png(4, 4, |_, _| [1, 2, 3, 255]);
    let colored = |mtl: &str, library: &str| {
        let folder = Folder::new(&[("car.obj", text.replace("car.mtl", library).as_bytes())]);
        std::fs::write(folder.path.parent().unwrap().join("secret.png"), &secret).unwrap();
        std::fs::write(folder.path.parent().unwrap().join("secret.mtl"), mtl).unwrap();
        folder.write("car.mtl", mtl.as_bytes());
        std::process::Command::new("mkfifo").arg(folder.path.join("pipe")).status().unwrap();
        let library = folder.read().0.unwrap();
        let materials: Vec<_> = library.assets[0].materials(Seed(0), None);
        (materials.iter().any(|m| m.base_color_map.is_some()), materials.iter().any(|m| m.base_color.z > 0.5))
    };
    assert_eq!(colored(&mtl, "car.mtl"), (false, true), "its colour is that of the file beside it");
    assert_eq!(colored(&mtl, "../secret.mtl"), (false, true), "found by the model's own name");
    for map in ["pipe", "../secret.png", "/dev/zero"] {
        let mapped = mtl.replace("Kd 0.1 0.2 0.8", &format!("Kd 0.1 0.2 0.8\nmap_Kd {map}"));
        assert!(!colored(&mapped, "car.mtl").0, "{map}");
    }
    assert!(!colored(&mtl, "pipe").0);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn any_bytes_never_panic(bytes in proptest::collection::vec(any::<u8>(), 0..400), ending in 0..4usize) {
        let name = ["car.glb", "car.gltf", "car.fbx", "car.obj"][ending];
        verdict(name, &bytes);
        let start: &[u8] = [b"glTF\x02\0\0\0".as_slice(), b"{\"asset\":{\"version\":\"2.0\"}", b"Kaydara FBX Binary  \0\x1a\0", b"v 1 2 3\nf "][ending];
        verdict(name, &[start, &bytes].concat());
    }

    #[test]
    fn changed_bytes_never_panic(changes in proptest::collection::vec((any::<proptest::sample::Index>(), any::<u8>()), 1..12), which in 0..3usize) {
        let (name, mut bytes) = match which {
            0 => ("car.glb", car().bytes()),
            1 => ("car.fbx", fbx().into_bytes()),
            _ => ("car.obj", obj().0.into_bytes()),
        };
        for (index, value) in changes {
            let at = index.index(bytes.len());
            bytes[at] = value;
        }
        verdict(name, &bytes);
    }

    #[test]
    fn any_library_file_never_panics(text in "[a-z_\\[\\]=\"\n. 0-9+-]{0,200}") {
        let folder = Folder::new(&[("library.toml", text.as_bytes())]);
        folder.read();
        trove_read::asset_files::check(&folder.path);
    }
}
