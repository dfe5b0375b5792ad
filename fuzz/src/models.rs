//! Models, textures, skies and pictures of labels.

use std::fs;
use std::io::Cursor;
use std::path::Path;

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use glam::Vec3;
use image::{DynamicImage, ImageFormat};
use serde_json::json;
use trove_judge::evaluate::{Settings, evaluate};
use trove_model::{ClassMap, Report, Seed};
use trove_read::{asset_files, environment};

#[allow(clippy::unwrap_used, dead_code, unreachable_pub)] // the reader's tests use the rest
#[path = "../../crates/trove-read/tests/asset_files/files.rs"]
mod files;

use files::Glb;

const LIBRARY: &str = "licence = \"CC0-1.0\"\n";

pub(crate) fn prepare(folder: &Path) {
    let _ = fs::create_dir_all(folder.join("mine"));
    let _ = fs::write(folder.join("mine/in.png"), picture(ImageFormat::Png));
}

/// Reads a model without a guess of what it is, and with all of them.
fn feed_model(folder: &Path, name: &str, data: &[u8]) {
    let folder = folder.join("mine");
    let _ = fs::write(folder.join(name), data);
    let entry = format!("[[asset]]\nfile = \"{name}\"\n");
    let _ = fs::write(folder.join("library.toml"), format!("{LIBRARY}{entry}"));
    let _ = asset_files::read_library(&folder, &Report::default());
    asset_files::check(&folder);
}

pub(crate) fn feed_gltf(folder: &Path, data: &[u8]) {
    let name = if data.starts_with(b"glTF") { "a.glb" } else { "a.gltf" };
    feed_model(folder, name, data);
}

pub(crate) fn feed_fbx(folder: &Path, data: &[u8]) {
    feed_model(folder, "a.fbx", data);
}

/// Materials follow the model after a zero byte.
pub(crate) fn feed_obj(folder: &Path, data: &[u8]) {
    let mut parts = data.splitn(2, |&byte| byte == 0);
    let (model, materials) = (parts.next().unwrap_or_default(), parts.next().unwrap_or_default());
    let _ = fs::write(folder.join("mine/car.mtl"), materials);
    feed_model(folder, "car.obj", model);
}

pub(crate) fn gltf_seeds() -> Vec<Vec<u8>> {
    let mut car = Glb::cuboid([1.8, 1.5, 4.5]);
    let texture = car.texture(4, 4, |x, y| [x as u8, y as u8, 9, 255]);
    let mut car = car.material(json!({
        "name": "Paint", "alphaMode": "MASK", "emissiveFactor": [1, 0.5, 0],
        "pbrMetallicRoughness": {"baseColorTexture": {"index": texture}, "metallicFactor": 0.5},
        "normalTexture": {"index": texture}, "extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 1}},
    }));
    let times = car.floats(&[0.0, 1.0], "SCALAR");
    let turns = car.floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0], "VEC4");
    let matrices = car.floats(&[1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1.], "MAT4");
    let moves = car.floats(&[0.1; 24], "VEC3");
    let joints = car.view(&[0; 32]);
    let joints = car.accessor(json!({"bufferView": joints, "componentType": 5121, "count": 8, "type": "VEC4"}));
    let weights = car.floats(&[0.25; 32], "VEC4");
    car.json["nodes"] = json!([{"mesh": 0, "skin": 0, "name": "car", "children": [1]}, {"translation": [0, 0, 1]}]);
    car.json["skins"] = json!([{"joints": [1], "inverseBindMatrices": matrices}]);
    car.json["animations"] = json!([{"name": "idle", "channels": [{"sampler": 0, "target": {"node": 1, "path": "rotation"}}],
        "samplers": [{"input": times, "output": turns}]}]);
    car.json["meshes"][0]["primitives"][0]["targets"] = json!([{"POSITION": moves}]);
    car.json["meshes"][0]["weights"] = json!([0.5]);
    car.json["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] = json!(joints);
    car.json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] = json!(weights);
    let glb = car.bytes();
    // As text, lengths are nowhere but where they belong, so mutations get further.
    let data = BASE64_STANDARD.encode(&car.bin);
    let mut document = car.json.clone();
    document["buffers"] = json!([{"byteLength": car.bin.len(), "uri": format!("data:;base64,{data}")}]);
    document["images"] = json!([{"uri": "in.png"}]);
    vec![glb, document.to_string().into_bytes()]
}

pub(crate) fn fbx_seeds() -> Vec<Vec<u8>> {
    vec![files::fbx().into_bytes()]
}

pub(crate) fn obj_seeds() -> Vec<Vec<u8>> {
    let (model, materials) = files::obj();
    let materials = format!("{materials}map_Kd in.png\nmap_Bump -bm 0.5 in.png\nKe 1 1 1\n");
    vec![[model.as_bytes(), b"\0", materials.as_bytes()].concat()]
}

pub(crate) fn prepare_texture(folder: &Path) {
    let folder = folder.join("mine");
    let _ = fs::create_dir_all(&folder);
    let entry = "[[surface]]\nname = \"a\"\nkind = \"asphalt\"\ncolor = \"a.tga\"\ndisplacement = \"a.tga\"\n";
    let _ = fs::write(folder.join("library.toml"), format!("{LIBRARY}{entry}"));
}

/// `.tga` lets every format through: it is told by its bytes, and TGA, which has no mark, by its name.
pub(crate) fn feed_texture(folder: &Path, data: &[u8]) {
    let folder = folder.join("mine");
    let _ = fs::write(folder.join("a.tga"), data);
    let _ = asset_files::read_library(&folder, &Report::default());
}

fn picture(format: ImageFormat) -> Vec<u8> {
    let picture = image::RgbaImage::from_fn(12, 9, |x, y| image::Rgba([x as u8 * 20, y as u8 * 20, 7, 255]));
    let picture = match format {
        ImageFormat::Jpeg => DynamicImage::ImageRgb8(DynamicImage::ImageRgba8(picture).into_rgb8()),
        ImageFormat::Hdr => DynamicImage::ImageRgb32F(DynamicImage::ImageRgba8(picture).into_rgb32f()),
        _ => DynamicImage::ImageRgba8(picture),
    };
    let mut bytes = Cursor::new(Vec::new());
    picture.write_to(&mut bytes, format).expect("a picture in memory can be encoded");
    bytes.into_inner()
}

fn exr(width: usize, height: usize) -> Vec<u8> {
    use exr::prelude::{Image, WritableImage};
    let pixel = |at: exr::prelude::Vec2<usize>| (at.x() as f32, at.y() as f32, 0.5f32);
    let mut bytes = Cursor::new(Vec::new());
    let image = Image::from_channels((width, height), exr::prelude::SpecificChannels::rgb(pixel));
    image.write().non_parallel().to_buffered(&mut bytes).expect("a picture in memory can be encoded");
    bytes.into_inner()
}

pub(crate) fn picture_seeds() -> Vec<Vec<u8>> {
    let formats =
        [ImageFormat::Png, ImageFormat::Jpeg, ImageFormat::WebP, ImageFormat::Bmp, ImageFormat::Tga, ImageFormat::Hdr];
    formats.map(picture).into_iter().chain([exr(8, 8)]).collect()
}

pub(crate) fn feed_sky(folder: &Path, data: &[u8]) {
    let path = folder.join("sky.exr");
    let _ = fs::write(&path, data);
    if let Ok(map) = environment::read(&path) {
        assert!(map.rgb.iter().flatten().all(|v| v.is_finite() && *v >= 0.0), "radiance is finite and not negative");
        assert_eq!(map.rgb.len(), (map.width * map.height) as usize);
    }
}

pub(crate) fn sky_seeds() -> Vec<Vec<u8>> {
    let mut hdr = Cursor::new(Vec::new());
    let sky = image::Rgb32FImage::from_fn(16, 8, |x, y| image::Rgb(Vec3::new(x as f32, y as f32, 3.0).to_array()));
    DynamicImage::ImageRgb32F(sky).write_to(&mut hdr, ImageFormat::Hdr).expect("a picture in memory can be encoded");
    vec![hdr.into_inner(), exr(16, 8)]
}

pub(crate) fn prepare_labels(folder: &Path) {
    for side in ["predicted", "truth"] {
        let _ = fs::create_dir_all(folder.join(side));
    }
    let _ = fs::write(folder.join("truth/class.png"), &label_seeds()[0]);
    for side in ["predicted", "truth"] {
        let _ = fs::write(folder.join(side).join("instance.png"), instances());
    }
}

/// 16-bit numbers of objects.
fn instances() -> Vec<u8> {
    let picture = image::ImageBuffer::from_fn(8, 6, |x, y| image::Luma([(x / 2 + 10 * (y / 3)) as u16]));
    let mut bytes = Cursor::new(Vec::new());
    DynamicImage::ImageLuma16(picture)
        .write_to(&mut bytes, ImageFormat::Png)
        .expect("a picture in memory can be encoded");
    bytes.into_inner()
}

/// As classes and as numbers of objects.
pub(crate) fn feed_labels(folder: &Path, data: &[u8]) {
    let (predicted, truth) = (folder.join("predicted"), folder.join("truth"));
    let classes = ClassMap::named("trove20");
    let settings = Settings { classes, predicted: None, truth: None, boundary: true, panoptic: true, seed: Seed(1) };
    for (name, whole) in [("class.png", label_seeds().remove(0)), ("instance.png", instances())] {
        let _ = fs::write(predicted.join(name), data);
        let _ = evaluate(&predicted, &truth, &settings, &|_, _| true);
        let _ = trove_judge::thumbnail(&predicted.join(name), 64);
        let _ = fs::write(predicted.join(name), whole);
    }
}

pub(crate) fn label_seeds() -> Vec<Vec<u8>> {
    let picture = image::GrayImage::from_fn(8, 6, |x, y| image::Luma([((x / 2 + y) % 20) as u8]));
    let mut bytes = Cursor::new(Vec::new());
    DynamicImage::ImageLuma8(picture)
        .write_to(&mut bytes, ImageFormat::Png)
        .expect("a picture in memory can be encoded");
    vec![bytes.into_inner(), instances(), self::picture(ImageFormat::Jpeg)]
}
