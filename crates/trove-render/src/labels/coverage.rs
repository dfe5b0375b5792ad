//! How much of each pixel shows what its centre shows.

use glam::DVec2;
use rayon::prelude::*;
use trove_model::{Class, Labels, Raster};

use super::eye::Eye;
use crate::accel::PACKET;
use crate::sight;

/// Rays along a side of a pixel: as many in all as a packet has.
const SIDE: usize = 4;
const _: () = assert!(SIDE * SIDE == PACKET);

/// Where in its cell a ray lies, in quarters from the left by its row and from the top by its column: of all such orders
/// one that tells the area beside any straight edge best, to 0.105 of the pixel.
const ACROSS: [f64; SIDE] = [0.0, 2.0, 1.0, 3.0];
const DOWN: [f64; SIDE] = [3.0, 1.0, 2.0, 0.0];

/// What tells pixels apart: objects by their ids, all else by its class.
type Label = (u32, Class);

/// Of pixels beside others, by rays of their own; all others are whole. `None` once `stop` answers true.
pub(super) fn coverage(eye: &Eye<'_>, labels: &Labels, stop: &(dyn Fn() -> bool + Sync)) -> Option<Raster<u8>> {
    let (width, height) = (labels.class.width, labels.class.height);
    let at = |x: u32, y: u32| (*labels.instance.at(x, y), *labels.class.at(x, y));
    let is_beside_others = |x: u32, y: u32, label: Label| {
        let mut around = (y.saturating_sub(1)..height.min(y + 2))
            .flat_map(|row| (x.saturating_sub(1)..width.min(x + 2)).map(move |column| (column, row)));
        around.any(|(column, row)| at(column, row) != label)
    };
    let mut coverage = Raster::filled(width, height, u8::MAX);
    let row = |(y, row): (usize, &mut [u8])| {
        if stop() {
            return None;
        }
        for (x, value) in row.iter_mut().enumerate() {
            let (x, y) = (x as u32, y as u32);
            let label = at(x, y);
            if is_beside_others(x, y, label) {
                let same = labels_in(eye, x, y).filter(|found| *found == label).count();
                *value = ((same * usize::from(u8::MAX) + PACKET / 2) / PACKET) as u8;
            }
        }
        Some(())
    };
    coverage.data.par_chunks_mut(width.max(1) as usize).enumerate().try_for_each(row)?;
    Some(coverage)
}

/// What a pixel's own rays show, which lie in its cells so that no two share a row or a column (Chiu and others 1994).
fn labels_in(eye: &Eye<'_>, x: u32, y: u32) -> impl Iterator<Item = Label> {
    let n = SIDE as f64;
    let within = |i: usize| {
        let (column, row) = (i % SIDE, i / SIDE);
        DVec2::new(column as f64 + (ACROSS[row] + 0.5) / n, row as f64 + (DOWN[column] + 0.5) / n) / n
    };
    let corner = DVec2::new(f64::from(x), f64::from(y));
    let directions: [_; PACKET] = std::array::from_fn(|i| eye.shot.lens.unproject(corner + within(i)));
    let rays: Vec<_> = directions.iter().flatten().map(|direction| eye.shot.label_ray(*direction)).collect();
    let mut hits = sight::hits(eye.scene, &eye.carrier, &rays).into_iter();
    directions.into_iter().map(move |direction| {
        if direction.is_none() {
            return (0, Class::Void);
        }
        hits.next().flatten().map_or((0, Class::Sky), |hit| {
            (eye.scene.placed(hit.instance).id.0, eye.scene.instances[hit.instance as usize].class)
        })
    })
}
