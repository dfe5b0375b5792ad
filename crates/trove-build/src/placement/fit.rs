//! How well an asset fits a box: the paper's measure, and what is done to the chosen one.

use glam::{DAffine3, DVec3};
use trove_model::Kind;

/// An asset made to fit a box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Fit {
    /// Scale along the asset's own axes.
    pub scale: DVec3,
    /// The asset is turned left by a quarter, for things without a front.
    pub quarter_turn: bool,
    /// The paper's quality, IoU_xy · min(z_i, z_j), of the asset with its aspect kept, metres.
    pub quality_m: f64,
    /// Volume of the intersection over that of the union, after the scale, both standing on the same spot.
    pub iou3d: f64,
}

impl Fit {
    /// The better way round to fit an asset of `asset_m` into a box of `box_m` (length, width, height).
    pub(crate) fn new(asset_m: DVec3, box_m: DVec3, kind: Kind) -> Self {
        let straight = Self::one_way(asset_m, box_m, kind, false);
        if has_front(kind) {
            return straight;
        }
        let turned = Self::one_way(asset_m, box_m, kind, true);
        if turned.quality_m > straight.quality_m { turned } else { straight }
    }

    fn one_way(asset_m: DVec3, box_m: DVec3, kind: Kind, quarter_turn: bool) -> Self {
        let swap = |v: DVec3| if quarter_turn { DVec3::new(v.y, v.x, v.z) } else { v };
        let size_m = swap(asset_m).max(DVec3::splat(1e-3));

        // The largest sides are made equal, the aspect is kept, and the quality is taken.
        let uniform = box_m.max_element() / size_m.max_element();
        let quality_m = quality_m(size_m * uniform, box_m);

        // Then every axis goes towards the box as far as it does not look stretched.
        let limit = stretch_limit(kind);
        let towards = (box_m / (size_m * uniform)).clamp(DVec3::splat(1.0 / limit), DVec3::splat(limit));
        let scale = towards * uniform;
        Self { scale: swap(scale), quarter_turn, quality_m, iou3d: iou3d(size_m * scale, box_m) }
    }

    /// From the asset's mesh, scaled and turned, to axes with x along the box.
    pub(crate) fn body_from_mesh(&self) -> DAffine3 {
        let turn = if self.quarter_turn { std::f64::consts::FRAC_PI_2 } else { 0.0 };
        DAffine3::from_rotation_z(turn) * DAffine3::from_scale(self.scale)
    }
}

/// The paper's quality of fit of two boxes with the same centre and axes, metres: IoU_xy · min(z_i, z_j).
fn quality_m(a: DVec3, b: DVec3) -> f64 {
    let shared = a.min(b);
    let shared_m2 = shared.x * shared.y;
    shared_m2 / (a.x * a.y + b.x * b.y - shared_m2) * shared.z
}

fn iou3d(a: DVec3, b: DVec3) -> f64 {
    let shared_m3 = a.min(b).element_product();
    shared_m3 / (a.element_product() + b.element_product() - shared_m3)
}

/// Whether it matters which way round it stands.
fn has_front(kind: Kind) -> bool {
    !matches!(kind, Kind::Barrier | Kind::TrafficCone | Kind::PushablePullable | Kind::Debris | Kind::BicycleRack)
}

/// By how much an axis may be scaled more than the others.
fn stretch_limit(kind: Kind) -> f64 {
    match kind {
        // Shapes that come in any proportion in the street.
        Kind::Barrier | Kind::Trailer | Kind::BicycleRack | Kind::Debris | Kind::PushablePullable => 1.5,
        _ => 1.15,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_quality_of_fit_is_the_papers() {
        // An asset of 2 × 1 × 1 for a box of 4 × 1.5 × 1.2: scaled by 2 to 4 × 2 × 2, so the plane's intersection is
        // 4 · 1.5 = 6 of a union of 8 + 6 − 6 = 8, times the lower height 1.2.
        let fit = Fit::new(DVec3::new(2.0, 1.0, 1.0), DVec3::new(4.0, 1.5, 1.2), Kind::Car);
        assert!((fit.quality_m - 0.9).abs() < 1e-12);
        // Length fits; width and height want 0.75 and 0.6 of it and get 1 / 1.15.
        assert!((fit.scale - DVec3::new(2.0, 2.0 / 1.15, 2.0 / 1.15)).length() < 1e-12);
        // 4 × 1.739 × 1.739 m against 4 × 1.5 × 1.2 m: the box lies inside.
        assert!((fit.iou3d - 7.2 / (4.0 * (2.0f64 / 1.15).powi(2))).abs() < 1e-12);
    }

    #[test]
    fn a_barrier_across_its_box_is_turned_and_a_car_is_not() {
        let (along, across) = (DVec3::new(2.0, 0.5, 1.0), DVec3::new(0.5, 2.0, 1.0));
        let barrier = Fit::new(along, across, Kind::Barrier);
        assert!(barrier.quarter_turn && (barrier.iou3d - 1.0).abs() < 1e-12);
        let corner = barrier.body_from_mesh().transform_point3(along / 2.0);
        assert!((corner.abs() - across / 2.0).length() < 1e-12);
        assert!(!Fit::new(along, across, Kind::Car).quarter_turn);
    }
}
