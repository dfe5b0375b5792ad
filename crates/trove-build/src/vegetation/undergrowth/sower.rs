//! What undergrowth is laid by: where there is room for it, and how a patch lies on the ground.

use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec2, DVec3, Vec3};
use trove_model::{AssetLibrary, Bounds, Class, CoverKind, GroundCover, Material, Random, Seed};

use crate::geometry::distance_field::DistanceField;
use crate::geometry::plane_raster::PlaneRaster;
use crate::ground::Lawn;
use crate::pieces::Piece;
use crate::place::Conditions;
use crate::roads::Footing;
use crate::surroundings::{Clearance, Surroundings};
use crate::vegetation::blue_noise::BlueNoise;

/// Nothing is laid farther from the driven path than this, metres.
pub(super) const REACH_M: f64 = 30.0;
/// Cells of the raster of lawns, metres, and the most of them each way.
pub(super) const LAWN_CELL_M: f64 = 0.125;

/// What undergrowth is laid by.
pub(super) struct Sower<'a> {
    pub around: &'a Surroundings<'a>,
    pub library: &'a AssetLibrary,
    pub clearance: &'a Clearance<'a>,
    pub lawn: Lawn,
    /// 1 where grass grows.
    pub lawns: PlaneRaster,
    /// Distance to the driven path.
    pub path_m: DistanceField,
    /// Within reach of the path.
    pub bounds: Bounds,
    pub blue_noise: BlueNoise,
    pub conditions: Conditions,
    pub seed: Seed,
}

/// Where and how a patch lies.
pub(super) struct Lay {
    pub middle: DVec2,
    pub yaw_rad: f64,
    /// In the plane, and upwards.
    pub scale: [f64; 2],
    pub class: Class,
    /// Which of its paints it has: 0 the first to 1 the last.
    pub shade: f64,
    /// Above the surface, metres.
    pub lift_m: f64,
}

impl Sower<'_> {
    pub(super) fn covers(&self, kind: CoverKind) -> Vec<&GroundCover> {
        self.library.covers_of(kind).collect()
    }

    /// Distance of a place to the driven path, metres; infinite out of reach.
    pub(super) fn path_distance_m(&self, p: DVec2) -> f64 {
        if self.bounds.contains(p) { self.path_m.at(p) } else { f64::INFINITY }
    }

    pub(super) fn is_lawn(&self, p: DVec2) -> bool {
        self.lawns.at(p) == 1
    }

    pub(super) fn footing(&self, p: DVec2) -> Footing {
        self.around.stand.surfaces.footing(p)
    }

    /// Lays a patch: it follows the ground's slope by shear, so that all of it stands on the ground and upright.
    pub(super) fn piece(&self, cover: &GroundCover, lay: &Lay, random: &mut Random) -> Piece {
        let h = |dx, dy| self.around.stand.ground.height_m(lay.middle + DVec2::new(dx, dy));
        let e = cover.side_m / 2.0;
        let slope = DVec2::new(h(e, 0.0) - h(-e, 0.0), h(0.0, e) - h(0.0, -e)) / cover.side_m;
        let axis = |turn: f64| {
            let flat = DVec2::from_angle(lay.yaw_rad + turn) * lay.scale[0];
            flat.extend(slope.dot(flat))
        };
        let axes = DMat3::from_cols(axis(0.0), axis(std::f64::consts::FRAC_PI_2), DVec3::Z * lay.scale[1]);
        let foot = lay.middle.extend(self.around.stand.surface_m(lay.middle) + lay.lift_m);
        // Between two paints one is drawn: neighbours lead from one to the next.
        let mut paint = |paints: &[Vec3]| {
            let at = lay.shade.clamp(0.0, 1.0) * (paints.len() as f64 - 1.0) + random.unit();
            paints.get((at as usize).min(paints.len().saturating_sub(1))).copied()
        };
        let materials = cover.slots.iter().map(|slot| {
            let base_color = paint(&slot.paints).unwrap_or(slot.material.base_color);
            Material { base_color, ..slot.material.clone() }
        });
        Piece {
            materials: materials.collect(),
            mesh: Arc::clone(&cover.mesh),
            world_from_mesh: DAffine3 { matrix3: axes, translation: foot },
            class: lay.class,
            kind: None,
            asset: None,
        }
    }
}

/// What lies there is a part of what it lies on.
pub(super) fn class_of(footing: Footing) -> Class {
    match footing {
        Footing::Carriageway => Class::Road,
        Footing::Sidewalk => Class::Sidewalk,
        Footing::Land | Footing::Water => Class::Ground,
    }
}
