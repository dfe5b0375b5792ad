//! One frame's small pictures, read from its folder.

use std::path::Path;

use trove_format::FrameFile;

use crate::{StoredFrame, WriteError, colors};

/// What is read of a frame, as far as it is there.
pub(super) const READ: [FrameFile; 5] =
    [FrameFile::Rgb, FrameFile::Normal, FrameFile::Class, FrameFile::Instance, FrameFile::Depth];

/// A frame's pictures, all as large.
pub(super) struct Tiles {
    pub(super) height: u32,
    pub(super) pictures: Vec<Vec<[u8; 3]>>,
}

impl Tiles {
    /// Of what the frame has: the picture (else normals), classes over it, instances, depth.
    pub(super) fn read(dir: &Path, width: u32) -> Result<Self, WriteError> {
        let frame = StoredFrame::open(dir)?;
        let there = |file: FrameFile| frame.has(file).then_some(&frame);
        let class = there(FrameFile::Class).map(StoredFrame::class).transpose()?;
        let instance = there(FrameFile::Instance).map(StoredFrame::instance).transpose()?;
        let depth_m = there(FrameFile::Depth).map(StoredFrame::depth_m).transpose()?;
        let rgb = there(FrameFile::Rgb).map(StoredFrame::rgb).transpose()?;
        let normal = there(FrameFile::Normal).filter(|_| rgb.is_none()).map(StoredFrame::normal).transpose()?;
        let [full_width, full_height] = [frame.table.width_px, frame.table.height_px];
        if full_width == 0 || full_height == 0 {
            return Ok(Self { height: 0, pictures: Vec::new() });
        }
        let height = ((u64::from(full_height) * u64::from(width) / u64::from(full_width)) as u32).max(1);
        let small = Grid { full: [full_width, full_height], small: [width, height] };

        let picture = match (&rgb, &normal) {
            (Some(rgb), _) => Some(small.averaged(|x, y| *rgb.at(x, y))),
            (None, Some(normal)) => Some(small.averaged(|x, y| colors::of_normal(*normal.at(x, y)))),
            (None, None) => None,
        };
        let classes = class.map(|class| {
            let class_color = |x, y| class.at(x, y).row().rgb;
            let mut classes = small.averaged(class_color);
            for (color, seen) in classes.iter_mut().zip(picture.iter().flatten()) {
                // Two thirds class, one third brightness of the picture.
                let grey = (u32::from(seen[0]) * 2 + u32::from(seen[1]) * 5 + u32::from(seen[2])) / 8;
                *color = color.map(|c| ((u32::from(c) * 2 + grey) / 3) as u8);
            }
            classes
        });
        let instances = instance.map(|ids| small.averaged(|x, y| colors::of_instance(*ids.at(x, y))));
        let depths = depth_m.map(|depth_m| small.averaged(|x, y| colors::of_depth(*depth_m.at(x, y))));
        Ok(Self { height, pictures: [picture, classes, instances, depths].into_iter().flatten().collect() })
    }
}

/// From an image's pixels to a tile's.
struct Grid {
    full: [u32; 2],
    small: [u32; 2],
}

impl Grid {
    /// Each tile's pixel is the mean colour of the pixels under it (of the nearest where the image is smaller).
    fn averaged(&self, color: impl Fn(u32, u32) -> [u8; 3]) -> Vec<[u8; 3]> {
        let range = |i: u32, axis: usize| {
            let at = |i: u32| (u64::from(i) * u64::from(self.full[axis]) / u64::from(self.small[axis])) as u32;
            at(i)..at(i + 1).max(at(i) + 1)
        };
        let mut pixels = Vec::with_capacity(self.small[0] as usize * self.small[1] as usize);
        for y in 0..self.small[1] {
            for x in 0..self.small[0] {
                let (mut sum, mut count) = ([0u32; 3], 0);
                for (px, py) in range(y, 1).flat_map(|py| range(x, 0).map(move |px| (px, py))) {
                    let c = color(px, py);
                    sum = [sum[0] + u32::from(c[0]), sum[1] + u32::from(c[1]), sum[2] + u32::from(c[2])];
                    count += 1;
                }
                pixels.push(sum.map(|s| ((s + count / 2) / count) as u8));
            }
        }
        pixels
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_pictures_are_enlarged_and_large_ones_averaged() {
        let checker = |x: u32, y: u32| [if (x + y).is_multiple_of(2) { 0 } else { 200 }; 3];
        assert_eq!(Grid { full: [4, 4], small: [2, 2] }.averaged(checker), vec![[100; 3]; 4]);
        let large = Grid { full: [2, 1], small: [4, 2] }.averaged(checker);
        assert_eq!(large, [[0; 3], [0; 3], [200; 3], [200; 3], [0; 3], [0; 3], [200; 3], [200; 3]]);
    }
}
