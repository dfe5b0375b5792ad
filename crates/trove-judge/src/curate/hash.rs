//! Perceptual hashes: pictures that look alike have hashes that differ in few bits.

use image::GrayImage;

/// The difference hash (Krawetz 2013): whether each of 8 × 8 cells is darker than its neighbour to the right.
pub fn difference_hash(picture: &GrayImage) -> u64 {
    let (width, height) = picture.dimensions();
    if width < 9 || height < 8 {
        return 0;
    }
    let mut cells = [[0.0f64; 9]; 8];
    for (row, cells) in (0..8).zip(&mut cells) {
        for (column, cell) in (0..9).zip(cells.iter_mut()) {
            let (xs, ys) = (column * width / 9..(column + 1) * width / 9, row * height / 8..(row + 1) * height / 8);
            let count = f64::from(xs.len() as u32 * ys.len() as u32);
            let sum: u64 = ys.flat_map(|y| xs.clone().map(move |x| u64::from(picture.get_pixel(x, y).0[0]))).sum();
            *cell = sum as f64 / count;
        }
    }
    let mut hash = 0;
    for cells in cells {
        for pair in cells.windows(2) {
            hash = hash << 1 | u64::from(pair[0] < pair[1]);
        }
    }
    hash
}

/// Brightness of a colour (Rec. 601), 0 to 255.
pub(super) fn luma(rgb: [u8; 3]) -> u8 {
    ((u32::from(rgb[0]) * 299 + u32::from(rgb[1]) * 587 + u32::from(rgb[2]) * 114) / 1000) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn brighter_pictures_keep_their_hash_and_mirrored_ones_do_not() {
        let picture = GrayImage::from_fn(90, 80, |x, y| image::Luma([((x * x / 40 + y * 3) % 200) as u8]));
        let brighter = GrayImage::from_fn(90, 80, |x, y| image::Luma([picture.get_pixel(x, y).0[0] + 20]));
        let mirrored = image::imageops::flip_horizontal(&picture);
        let apart = |a: &GrayImage, b: &GrayImage| (difference_hash(a) ^ difference_hash(b)).count_ones();
        assert_eq!(apart(&picture, &brighter), 0);
        assert!(apart(&picture, &mirrored) > 20);
    }
}
