//! The data by which every kernel judges its hits.

use std::sync::Arc;

use glam::Vec3;
use trove_model::InstanceId;

use crate::material::Opacity;
use crate::placed::{Placed, Sort};
use crate::ray::{Hit, Ray};

/// What a kernel is built for: shapes, and what each of their materials lets pass.
pub(crate) struct Shapes {
    /// In the order of the scene's instances.
    pub(crate) placed: Vec<Placed>,
    /// In the order of the scene's materials.
    pub(crate) opacities: Arc<[Opacity]>,
    /// The recording vehicle.
    pub(super) carrier: Option<InstanceId>,
}

impl Shapes {
    pub(crate) fn new(placed: Vec<Placed>, opacities: Arc<[Opacity]>) -> Self {
        let carrier = placed.iter().find(|placed| placed.sort == Sort::Carrier).map(|placed| placed.id);
        Self { placed, opacities, carrier }
    }

    /// Whether hits on an instance have to be judged; those on others all count.
    pub(super) fn lets_pass(&self, placed: &Placed) -> bool {
        placed.materials.iter().any(|&m| !self.opacities[m as usize].is_opaque())
    }

    /// Whether there is a surface at a hit, and no hole.
    pub(super) fn is_there(&self, hit: &Hit) -> bool {
        let placed = &self.placed[hit.instance as usize];
        let opacity = &self.opacities[placed.material(hit)];
        !opacity.has_holes() || opacity.covers(placed.uv(hit))
    }

    /// Whether there is a surface at a hit for rays that pass through glass, or for those that do not.
    pub(super) fn is_seen(&self, hit: &Hit, through_glass: bool) -> bool {
        let is_pane = || self.opacities[self.placed[hit.instance as usize].material(hit)].is_pane();
        self.is_there(hit) && !(through_glass && is_pane())
    }

    /// Whether a hit keeps the last of the light back; what goes straight through it stays of `light`.
    pub(super) fn blocks(&self, hit: &Hit, ray: &Ray, light: &mut Vec3) -> bool {
        if !self.is_there(hit) {
            return false;
        }
        let placed = &self.placed[hit.instance as usize];
        let opacity = &self.opacities[placed.material(hit)];
        *light *= if opacity.is_pane() {
            opacity.straight_through(placed.normal(hit, ray.time).dot(ray.direction))
        } else {
            Vec3::ZERO
        };
        *light == Vec3::ZERO
    }

    /// Whether a ray passes through all of an instance.
    pub(super) fn is_passed(&self, ray: &Ray, instance: u32) -> bool {
        let placed = &self.placed[instance as usize];
        ray.past == Some(placed.id)
            || ray.beside.is_some_and(|beside| !placed.stays[beside as usize])
            || ray.for_shelter && !placed.sort.shelters()
    }

    /// What a ray meets behind all that it passes through, given what it meets first and how to ask again.
    pub(super) fn past(&self, ray: &Ray, first: Option<Hit>, closest: impl Fn(&Ray) -> Option<Hit>) -> Option<Hit> {
        let mut met = first;
        let mut ray = *ray;
        while let Some(hit) = met
            && self.is_passed(&ray, hit.instance)
        {
            ray.t_min = hit.t * (1.0 + 1e-6) + 1e-6;
            met = closest(&ray);
        }
        met
    }
}
