//! In which numbers a folder's labels are, as far as its files tell.

use std::collections::BTreeMap;
use std::path::Path;

use image::DynamicImage;
use png::{BitDepth, ColorType};
use trove_format::FrameTable;
use trove_model::{Class, ClassMap, InstanceCoding, Kind, Raster, Role};

use crate::JudgeError;
use crate::pictures::{BY_ID, BY_TRAIN_ID, OURS, color_type, name, read, read_labels};

/// The numbers of a folder's labels, and how that is known.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Numbering {
    /// The numbers.
    pub map: ClassMap,
    /// How that is known (`class.png beside frame.json`).
    pub why: String,
}

impl Numbering {
    fn built_in(name: &str, why: &str) -> Option<Self> {
        Some(Self { map: ClassMap::named(name)?, why: why.to_owned() })
    }

    /// What a file of labels tells: our own by `frame.json` beside it, Cityscapes' by its name, KITTI-STEP's by being in
    /// colours. `None` where nothing is told.
    pub(crate) fn of_file(path: &Path) -> Result<Option<Self>, JudgeError> {
        let file = name(path);
        Ok(if file == OURS && path.with_file_name(FrameTable::NAME).is_file() {
            Self::built_in("trove20", "class.png beside frame.json")
        } else if file.ends_with(BY_ID) {
            Self::built_in("cityscapes", "named …_labelIds.png")
        } else if file.ends_with(BY_TRAIN_ID) {
            Self::built_in("cityscapes-train", "named …_labelTrainIds.png")
        } else if color_type(path)? == (ColorType::Rgb, BitDepth::Eight) {
            let step = Self::built_in("kitti-step", "images in colours (Rgb), with classes in red");
            let is_known = |id: &u8| step.as_ref().is_some_and(|step| step.map.class(*id).is_some());
            read(path)?.into_rgb8().pixels().all(|pixel| is_known(&pixel.0[0])).then_some(step).flatten()
        } else {
            None
        })
    }
}

/// Labels in the numbers of the map that they are judged in, with the objects' numbers where the picture has them itself.
pub(crate) struct Judged {
    pub labels: Raster<u8>,
    pub objects: Option<Vec<u16>>,
}

/// Reads labels in some numbers as those of another map, in which `numbers` has every one.
pub(crate) fn read_as(
    path: &Path,
    own: &ClassMap,
    wanted: &ClassMap,
    numbers: &[u8; 256],
) -> Result<Judged, JudgeError> {
    let (mut labels, objects) = read_coded(path, own)?;
    let mut known = [false; 256];
    own.classes.iter().map(|class| class.id).chain(own.ignored()).for_each(|id| known[usize::from(id)] = true);
    if let Some(i) = labels.data.iter().position(|id| !known[usize::from(*id)]) {
        return Err(unknown(path, own, &labels, i));
    }
    let refined = if own.name == "trove20" { finer(path, &labels, wanted)? } else { Vec::new() };
    labels.data.iter_mut().for_each(|id| *id = numbers[usize::from(*id)]);
    for (i, id) in refined {
        labels.data[i] = id;
    }
    Ok(Judged { labels, objects })
}

fn unknown(path: &Path, map: &ClassMap, labels: &Raster<u8>, i: usize) -> JudgeError {
    let listed = |ids: &mut dyn Iterator<Item = u8>| ids.map(|id| id.to_string()).collect::<Vec<_>>().join(" ");
    let known = listed(&mut map.counted().map(|class| class.id));
    let expected = format!("{}'s ids ({known}, ignored {})", map.name, listed(&mut map.ignored().into_iter()));
    let (x, y) = (i as u32 % labels.width, i as u32 / labels.width);
    let remedy =
        "choose the class map of both sides with --classes, or of one with --predicted-classes or --truth-classes";
    JudgeError::unexpected(path, expected, format!("{} at x {x}, y {y}", labels.data[i]), remedy)
}

/// A picture's classes, and its objects where the map says that it has them itself.
fn read_coded(path: &Path, map: &ClassMap) -> Result<(Raster<u8>, Option<Vec<u16>>), JudgeError> {
    match (map.instances, color_type(path)?) {
        (InstanceCoding::GreenBlue, (ColorType::Rgb, BitDepth::Eight)) => {
            let picture = read(path)?.into_rgb8();
            let (width, height) = picture.dimensions();
            let ids = picture.pixels().map(|pixel| pixel.0[0]).collect();
            let objects = picture.pixels().map(|pixel| u16::from_be_bytes([pixel.0[1], pixel.0[2]])).collect();
            Ok((Raster { width, height, data: ids }, Some(objects)))
        }
        (InstanceCoding::Divisor(divisor), (ColorType::Grayscale, BitDepth::Sixteen)) => {
            let DynamicImage::ImageLuma16(picture) = read(path)? else {
                return Err(JudgeError::unexpected(path, "16-bit greyscale", "another image", "write the file again"));
            };
            let (width, height) = picture.dimensions();
            let pixels = picture.into_raw();
            if let Some(high) = pixels.iter().map(|pixel| *pixel / divisor).find(|class| *class > u16::from(u8::MAX)) {
                let expected = format!("classes up to 255, as pixels divided by {divisor}");
                let remedy = "give the map with the divisor of these labels by --classes";
                return Err(JudgeError::unexpected(path, expected, high.to_string(), remedy));
            }
            let ids = pixels.iter().map(|pixel| (*pixel / divisor) as u8).collect();
            let objects = pixels.into_iter().map(|pixel| pixel % divisor).collect();
            Ok((Raster { width, height, data: ids }, Some(objects)))
        }
        _ => Ok((read_labels(path)?, None)),
    }
}

/// Pixels of our own labels at which an object's kind, or a part of it, says more than its class, with their numbers in a
/// map that is finer.
fn finer(path: &Path, labels: &Raster<u8>, wanted: &ClassMap) -> Result<Vec<(usize, u8)>, JudgeError> {
    let says_more = |kind: &Kind| Class::ALL.iter().any(|class| wanted.object_id(*class, *kind) != wanted.id(*class));
    let knows_more = wanted.knows_parts() || Kind::ALL.iter().any(says_more);
    let Some(folder) = path.parent().filter(|folder| knows_more && folder.join(FrameTable::NAME).is_file()) else {
        return Ok(Vec::new());
    };
    let [instances, parts] = [INSTANCES, PARTS].map(|file| Some(folder.join(file)).filter(|path| path.is_file()));
    if instances.is_none() && parts.is_none() {
        return Ok(Vec::new());
    }
    let objects = instances.map(|instances| read_objects(&instances, labels, path)).transpose()?;
    let parts = parts.filter(|_| wanted.knows_parts()).map(|parts| read_parts(&parts, labels, path)).transpose()?;
    let table = FrameTable::read(folder)?;
    let kinds: BTreeMap<u32, (Class, Kind)> =
        table.objects.iter().map(|object| (object.id, (object.class, object.kind))).collect();
    let refined = labels.data.iter().enumerate().filter_map(|(i, id)| {
        let class = Class::from_id(*id)?;
        let object = objects.as_ref().and_then(|objects| kinds.get(&u32::from(objects[i])));
        let kind = object.filter(|(of, _)| *of == class).map(|(_, kind)| *kind);
        let part = parts.as_ref().and_then(|parts| Role::from_id(parts[i]));
        let id = wanted.part_id(class, kind, part);
        (id != wanted.id(class)).then_some((i, id))
    });
    Ok(refined.collect())
}

/// The parts of objects of our own frames.
const PARTS: &str = "part.png";

/// The numbers of parts beside some labels.
fn read_parts(path: &Path, labels: &Raster<u8>, of: &Path) -> Result<Vec<u8>, JudgeError> {
    let parts = read_labels(path)?.data;
    if parts.len() != labels.data.len() {
        let expected = format!("{} pixels, like {}", labels.data.len(), name(of));
        return Err(JudgeError::unexpected(path, expected, parts.len().to_string(), "run trove generate again"));
    }
    Ok(parts)
}

/// The objects of our own frames.
pub(crate) const INSTANCES: &str = "instance.png";

/// The numbers of objects beside some labels.
pub(crate) fn read_objects(path: &Path, labels: &Raster<u8>, of: &Path) -> Result<Vec<u16>, JudgeError> {
    let of = name(of);
    let bad = |expected: String, found: String| {
        JudgeError::unexpected(path, expected, found, "write the file again, or omit --panoptic")
    };
    let wanted = || format!("16-bit greyscale ids of the objects in {of}");
    if !path.is_file() {
        return Err(bad(wanted(), "no file".into()));
    }
    let objects: Vec<u16> = match read(path)? {
        DynamicImage::ImageLuma16(numbers) => numbers.into_raw(),
        DynamicImage::ImageLuma8(numbers) => numbers.into_raw().into_iter().map(u16::from).collect(),
        other => return Err(bad(wanted(), format!("{:?}", other.color()))),
    };
    if objects.len() != labels.data.len() {
        return Err(bad(format!("{} pixels, like {of}", labels.data.len()), objects.len().to_string()));
    }
    Ok(objects)
}
