//! A finished frame, read back from its folder.

use std::io::BufReader;
use std::path::{Path, PathBuf};

use image::{DynamicImage, GrayImage, ImageDecoder, ImageFormat, ImageReader};
use trove_files::{Budget, open_regular};
use trove_format::{FrameFile, FrameTable, MaskTable, ObjectRow, RunLengths};
use trove_model::{Class, InPatches, Occlusion, Patches, Raster, Role};

use crate::{WriteError, exr_parts, masks};

/// The folder of a finished frame; its files are read when they are asked for.
#[derive(Clone, Debug)]
pub struct StoredFrame {
    /// The folder.
    pub folder: PathBuf,
    /// Camera and objects; every picture is as large as it says.
    pub table: FrameTable,
}

impl StoredFrame {
    /// Opens a frame's folder.
    ///
    /// # Errors
    /// A table that cannot be read or is damaged.
    pub fn open(folder: &Path) -> Result<Self, WriteError> {
        let table = FrameTable::read(folder)?;
        let fits = |[x0, y0, x1, y1]: [u32; 4]| x0 <= x1 && y0 <= y1 && x1 < table.width_px && y1 < table.height_px;
        let strays =
            |object: &&ObjectRow| [object.visible_box, object.amodal_box].into_iter().flatten().any(|b| !fits(b));
        // As many as instance.png can hold.
        if let Some(object) = table.objects.iter().find(|object| object.id > u16::MAX.into()) {
            let found = format!("object {}", object.id);
            return Err(WriteError::Damaged { path: folder.join(FrameTable::NAME), found });
        }
        if let Some(object) = table.objects.iter().find(strays) {
            let found = format!("object {} with a box that is not in the picture", object.id);
            return Err(WriteError::Damaged { path: folder.join(FrameTable::NAME), found });
        }
        Ok(Self { folder: folder.to_owned(), table })
    }

    /// Where a file of it lies, whether it is there or not.
    pub fn path(&self, file: FrameFile) -> PathBuf {
        self.folder.join(file.name())
    }

    /// Where a file of it lies that something cannot do without.
    ///
    /// # Errors
    /// A file that the run was told to leave out.
    pub fn needed(&self, file: FrameFile) -> Result<PathBuf, WriteError> {
        let path = self.path(file);
        if path.is_file() {
            return Ok(path);
        }
        let entry = file.name().split('.').next().unwrap_or_default();
        let light = if file.shows_light() { ", with render.light," } else { "" };
        Err(WriteError::Unfit {
            path,
            expected: "a file that is needed".into(),
            found: "none".into(),
            remedy: format!("name {entry} in the recipe's output.files{light} and run trove generate again"),
        })
    }

    /// Whether it has a file.
    pub fn has(&self, file: FrameFile) -> bool {
        self.path(file).is_file()
    }

    /// The picture, 8-bit sRGB.
    ///
    /// # Errors
    /// As for all files: one that is not there, cannot be read, or has another size than the table says.
    pub fn rgb(&self) -> Result<Raster<[u8; 3]>, WriteError> {
        let picture = self.png(FrameFile::Rgb)?.into_rgb8();
        let data = picture.as_raw().as_chunks().0.to_vec();
        Ok(Raster { width: picture.width(), height: picture.height(), data })
    }

    /// The masks of its objects, as they are coded.
    ///
    /// # Errors
    /// As for [`StoredFrame::rgb`].
    pub fn masks(&self) -> Result<MaskTable, WriteError> {
        let path = self.needed(FrameFile::Masks)?;
        Ok(MaskTable::read(path.parent().unwrap_or(&self.folder))?)
    }

    /// The pixels of a mask of its own.
    ///
    /// # Errors
    /// Run lengths that do not fill the picture.
    pub fn painted(&self, mask: &RunLengths) -> Result<Raster<bool>, WriteError> {
        let [rows, columns] = mask.size;
        let fits = [columns, rows] == [self.table.width_px, self.table.height_px];
        let picture = fits.then(|| masks::painted(mask)).flatten();
        picture.ok_or_else(|| self.damaged(FrameFile::Masks, "run lengths that do not fill the picture".into()))
    }

    /// What each pixel shows.
    ///
    /// # Errors
    /// As for [`StoredFrame::rgb`], and a number that no class has.
    pub fn class(&self) -> Result<Raster<Class>, WriteError> {
        let picture = self.png(FrameFile::Class)?;
        let DynamicImage::ImageLuma8(ids) = picture else {
            return Err(self.damaged(FrameFile::Class, format!("{:?} instead of 8-bit greys", picture.color())));
        };
        self.meant(FrameFile::Class, &ids, Class::from_id, "which no class has")
    }

    /// The id of the object that each pixel shows; 0: none.
    ///
    /// # Errors
    /// As for [`StoredFrame::rgb`].
    pub fn instance(&self) -> Result<Raster<u16>, WriteError> {
        match self.png(FrameFile::Instance)? {
            DynamicImage::ImageLuma16(ids) => {
                Ok(Raster { width: ids.width(), height: ids.height(), data: ids.into_raw() })
            }
            other => Err(self.damaged(FrameFile::Instance, format!("{:?} instead of 16-bit greys", other.color()))),
        }
    }

    /// Whether each pixel's surface differs from the compared frame's.
    ///
    /// # Errors
    /// As for [`StoredFrame::rgb`].
    pub fn change(&self) -> Result<Raster<bool>, WriteError> {
        let picture = self.png(FrameFile::Change)?.into_luma8();
        let data = picture.as_raw().iter().map(|value| *value > 0).collect();
        Ok(Raster { width: picture.width(), height: picture.height(), data })
    }

    /// Metres along the camera's z axis; +inf: sky.
    ///
    /// # Errors
    /// As for [`StoredFrame::rgb`].
    pub fn depth_m(&self) -> Result<Raster<f32>, WriteError> {
        self.numbers(FrameFile::Depth)
    }

    /// Unit normals in Camera; 0: sky.
    ///
    /// # Errors
    /// As for [`StoredFrame::rgb`].
    pub fn normal(&self) -> Result<Raster<[f32; 3]>, WriteError> {
        self.vectors(FrameFile::Normal)
    }

    /// Linear Rec. 709 radiance before exposure.
    ///
    /// # Errors
    /// As for [`StoredFrame::rgb`].
    pub fn radiance(&self) -> Result<Raster<[f32; 3]>, WriteError> {
        self.vectors(FrameFile::Radiance)
    }

    /// Pixels to the next keyframe, right and down; NaN: not defined.
    ///
    /// # Errors
    /// As for [`StoredFrame::rgb`].
    pub fn flow_forward(&self) -> Result<Raster<[f32; 2]>, WriteError> {
        Ok(self.pairs_in(FrameFile::FlowForward, Patches::ALL)?.raster)
    }

    /// Pixels to the previous keyframe, right and down; NaN: not defined.
    ///
    /// # Errors
    /// As for [`StoredFrame::rgb`].
    pub fn flow_backward(&self) -> Result<Raster<[f32; 2]>, WriteError> {
        Ok(self.pairs_in(FrameFile::FlowBackward, Patches::ALL)?.raster)
    }

    /// Whether the next keyframe's picture shows what each pixel shows.
    ///
    /// # Errors
    /// As for [`StoredFrame::rgb`], and a value that says nothing.
    pub fn occluded_forward(&self) -> Result<Raster<Occlusion>, WriteError> {
        self.occlusion(FrameFile::OccludedForward)
    }

    /// Whether the previous keyframe's picture does.
    ///
    /// # Errors
    /// As for [`StoredFrame::occluded_forward`].
    pub fn occluded_backward(&self) -> Result<Raster<Occlusion>, WriteError> {
        self.occlusion(FrameFile::OccludedBackward)
    }

    /// Class and object of each pixel in one number: 65536 · class + object.
    ///
    /// # Errors
    /// As for [`StoredFrame::rgb`].
    pub fn panoptic(&self) -> Result<Raster<u32>, WriteError> {
        let picture = self.png(FrameFile::Panoptic)?;
        let DynamicImage::ImageRgb8(segments) = picture else {
            return Err(self.damaged(FrameFile::Panoptic, format!("{:?} instead of 8-bit colours", picture.color())));
        };
        let data = segments.pixels().map(|pixel| u32::from_le_bytes([pixel[0], pixel[1], pixel[2], 0])).collect();
        Ok(Raster { width: segments.width(), height: segments.height(), data })
    }

    /// Share of each pixel, in 255ths, that shows what its centre shows.
    ///
    /// # Errors
    /// As for [`StoredFrame::rgb`].
    pub fn coverage(&self) -> Result<Raster<u8>, WriteError> {
        let picture = self.png(FrameFile::Coverage)?.into_luma8();
        Ok(Raster { width: picture.width(), height: picture.height(), data: picture.into_raw() })
    }

    /// The part of its object that each pixel shows.
    ///
    /// # Errors
    /// As for [`StoredFrame::rgb`], and a number that no part has.
    pub fn part(&self) -> Result<Raster<Option<Role>>, WriteError> {
        let picture = self.png(FrameFile::Part)?.into_luma8();
        let part = |id| if id == 0 { Some(None) } else { Role::from_id(id).map(Some) };
        self.meant(FrameFile::Part, &picture, part, "which no part has")
    }

    /// The numbers of `range.exr` (metres along the ray; +inf: sky), `depth.exr` or `roughness.exr` (NaN: sky).
    ///
    /// # Errors
    /// As for [`StoredFrame::rgb`], and a file of vectors.
    pub fn numbers(&self, file: FrameFile) -> Result<Raster<f32>, WriteError> {
        Ok(self.numbers_in(file, Patches::ALL)?.raster)
    }

    /// The vectors of a file with three channels, such as `scene_flow_forward.exr`, as docs/output.md tells.
    ///
    /// # Errors
    /// As for [`StoredFrame::rgb`], and a file of other values.
    pub fn vectors(&self, file: FrameFile) -> Result<Raster<[f32; 3]>, WriteError> {
        Ok(self.vectors_in(file, Patches::ALL)?.raster)
    }

    /// Parts of [`StoredFrame::numbers`].
    ///
    /// # Errors
    /// As for it.
    pub fn numbers_in(&self, file: FrameFile, patches: Patches) -> Result<InPatches<f32>, WriteError> {
        let InPatches { raster: Raster { width, height, data }, patches } = self.channels(file, ["Y"], patches)?;
        Ok(InPatches { raster: Raster { width, height, data: data.into_flattened() }, patches })
    }

    /// Parts of [`StoredFrame::vectors`].
    ///
    /// # Errors
    /// As for it.
    pub fn vectors_in(&self, file: FrameFile, patches: Patches) -> Result<InPatches<[f32; 3]>, WriteError> {
        self.channels(file, ["R", "G", "B"], patches)
    }

    /// Parts of a file of flow, such as [`StoredFrame::flow_forward`].
    ///
    /// # Errors
    /// As for it.
    pub fn pairs_in(&self, file: FrameFile, patches: Patches) -> Result<InPatches<[f32; 2]>, WriteError> {
        self.channels(file, ["R", "G"], patches)
    }

    fn channels<const N: usize>(
        &self,
        file: FrameFile,
        names: [&str; N],
        patches: Patches,
    ) -> Result<InPatches<[f32; N]>, WriteError> {
        Ok(InPatches { raster: exr_parts::read(&self.needed(file)?, self.size(), names, patches)?, patches })
    }

    fn occlusion(&self, file: FrameFile) -> Result<Raster<Occlusion>, WriteError> {
        let picture = self.png(file)?.into_luma8();
        let known = [Occlusion::Seen, Occlusion::Undefined, Occlusion::Hidden];
        let of = |value| known.into_iter().find(|occlusion| occlusion.value() == value);
        self.meant(file, &picture, of, "not 0, 128 or 255")
    }

    /// What each grey means.
    fn meant<T: Copy>(
        &self,
        file: FrameFile,
        greys: &GrayImage,
        of: impl Fn(u8) -> Option<T>,
        wrong: &str,
    ) -> Result<Raster<T>, WriteError> {
        let table: [Option<T>; 256] = std::array::from_fn(|value| of(value as u8));
        let meant = |value: &u8| table[usize::from(*value)];
        let data: Vec<T> = greys.as_raw().iter().filter_map(meant).collect();
        if data.len() < greys.as_raw().len() {
            let value = greys.as_raw().iter().find(|value| meant(value).is_none()).copied().unwrap_or_default();
            return Err(self.damaged(file, format!("{value}, {wrong}")));
        }
        Ok(Raster { width: greys.width(), height: greys.height(), data })
    }

    /// Columns and rows of every picture.
    fn size(&self) -> [u32; 2] {
        [self.table.width_px, self.table.height_px]
    }

    fn png(&self, file: FrameFile) -> Result<DynamicImage, WriteError> {
        let path = self.needed(file)?;
        let bytes = open_regular(&path).map_err(WriteError::storage(&path, "read the file"))?;
        let packed = bytes.metadata().map_or(0, |file| file.len());
        let broken = |e: image::ImageError| self.damaged(file, e.to_string());
        // Before anything is unpacked: a header of a few bytes may ask for any amount of memory.
        let decoder =
            ImageReader::with_format(BufReader::new(bytes), ImageFormat::Png).into_decoder().map_err(broken)?;
        let (width, height) = decoder.dimensions();
        if [width, height] != self.size() {
            let [columns, rows] = self.size();
            return Err(self.damaged(file, format!("{width}×{height} pixels instead of {columns}×{rows}")));
        }
        Budget::of_file(packed).take(decoder.total_bytes() as usize, 1).map_err(|e| self.damaged(file, e.found()))?;
        DynamicImage::from_decoder(decoder).map_err(broken)
    }

    fn damaged(&self, file: FrameFile, found: String) -> WriteError {
        WriteError::Damaged { path: self.path(file), found }
    }
}
