//! Rays put to Embree, and what counts as a hit.

use std::ffi::{c_int, c_void};
use std::ptr;

use glam::Vec3;

use super::api::{
    self, Context, FilterArguments, Packet, PacketHits, PacketRays, QueryArguments, RawHit, RawRay, RayHit,
};
use super::device::BuiltScene;
use super::{PACKET, Shapes};
use crate::placed::{Placed, Sort};
use crate::ray::{Beside, Hit, Ray};

/// What a filter judges by.
struct Question<'a> {
    shapes: &'a Shapes,
    /// The instance, where Embree does not know it.
    instance: Option<u32>,
    /// Rays on their way to light, by their ids, and what is left of it; empty where the closest hit is looked for.
    rays: &'a [Ray],
    light: &'a mut [Vec3],
    through_glass: bool,
}

const NOW: u32 = 1;
const PREVIOUS: u32 = 2;
const NEXT: u32 = 4;
/// Farther left are the same bits of the recording vehicle.
const OF_CARRIER: u32 = 3;
/// What keeps off rain and snow now.
const SHELTER: u32 = 1 << 6;

/// The bits of an instance: it shares one with the rays of every moment at which it is there as it is now.
pub(super) fn mask(placed: &Placed) -> u32 {
    let [before, after] = placed.stays;
    let moments = NOW | if before { PREVIOUS } else { 0 } | if after { NEXT } else { 0 };
    let moments = if placed.sort == Sort::Carrier { moments << OF_CARRIER } else { moments };
    if placed.sort.shelters() { moments | SHELTER } else { moments }
}

fn mask_of(shapes: &Shapes, ray: &Ray) -> u32 {
    if ray.for_shelter {
        return SHELTER;
    }
    let moment = match ray.beside {
        None => NOW,
        Some(Beside::Previous) => PREVIOUS,
        Some(Beside::Next) => NEXT,
    };
    if is_masked(shapes, ray) { moment } else { moment | moment << OF_CARRIER }
}

/// Whether a ray meets nothing that it passes through; of other vehicles that carry sensors there may be many.
pub(super) fn is_masked(shapes: &Shapes, ray: &Ray) -> bool {
    ray.past.is_some() && ray.past == shapes.carrier
}

/// Leaves the hits that count, given the ray's id.
///
/// # Safety
/// To be called with what Embree calls a filter with, in a query whose context was made by [`context`].
unsafe fn judge(arguments: *const FilterArguments, counts: impl Fn(&mut Question<'_>, usize, &Hit) -> bool) {
    // SAFETY: Embree passes valid pointers, and the context that the query was made with, whose `user` points to a
    // `Question` that outlives the query.
    let (arguments, question) = unsafe {
        let arguments = &*arguments;
        (arguments, &mut *(*arguments.context).user.cast::<Question<'_>>())
    };
    let n = arguments.n as usize;
    for lane in 0..n {
        // SAFETY: `valid` points to n numbers, `ray` to 12 · n and `hit` to at least 8 · n of four bytes.
        unsafe {
            let valid = arguments.valid.add(lane);
            if *valid == 0 {
                continue;
            }
            let ray = |field: usize| *arguments.ray.add(field * n + lane);
            let hit = |field: usize| *arguments.hit.add(field * n + lane);
            // Fields are numbered as `RawRay` and `RawHit` list them.
            let t = f32::from_bits(ray(8));
            let (u, v) = (f32::from_bits(hit(3)), f32::from_bits(hit(4)));
            let hit = hit_of(t, u, v, [hit(5), hit(6), hit(7)], question.instance);
            if !counts(question, ray(10) as usize, &hit) {
                *valid = 0;
            }
        }
    }
}

/// Holes are not there, nor are panes for rays that pass through glass.
///
/// # Safety
/// As for [`judge`].
unsafe extern "C" fn keep_surfaces(arguments: *const FilterArguments) {
    // SAFETY: the same is asked of the caller.
    unsafe { judge(arguments, |question, _, hit| question.shapes.is_seen(hit, question.through_glass)) }
}

/// Holes are not there, and panes take their share of the light.
///
/// # Safety
/// As for [`judge`].
unsafe extern "C" fn keep_blockers(arguments: *const FilterArguments) {
    // SAFETY: the same is asked of the caller.
    unsafe {
        judge(arguments, |question, ray, hit| {
            question.shapes.blocks(hit, &question.rays[ray], &mut question.light[ray])
        })
    }
}

/// From Embree's numbers for triangle, geometry and instance.
fn hit_of(t: f32, u: f32, v: f32, [triangle, geometry, instance]: [u32; 3], known: Option<u32>) -> Hit {
    // Triangles of the top scene are attached to it by the instance's index.
    let found = if instance == api::INVALID_ID { geometry } else { instance };
    Hit { t, instance: known.unwrap_or(found), triangle, u, v }
}

/// What a single ray has met.
fn found(RayHit { ray, hit, .. }: &RayHit, known: Option<u32>) -> Option<Hit> {
    (hit.geometry != api::INVALID_ID)
        .then(|| hit_of(ray.t_max, hit.u, hit.v, [hit.primitive, hit.geometry, hit.instance], known))
}

const NO_HIT: RawHit = RawHit {
    normal: [0.0; 3],
    u: 0.0,
    v: 0.0,
    primitive: api::INVALID_ID,
    geometry: api::INVALID_ID,
    instance: api::INVALID_ID,
};

fn raw_ray(ray: &Ray, mask: u32) -> RawRay {
    RawRay {
        origin: ray.origin.to_array(),
        t_min: ray.t_min,
        direction: ray.direction.to_array(),
        time: ray.time,
        t_max: ray.t_max,
        mask,
        id: 0,
        flags: 0,
    }
}

/// Which rays of a packet are there (−1).
#[repr(align(64))]
struct Valid([c_int; PACKET]);

fn packet(rays: &[Ray], mask: impl Fn(&Ray) -> u32) -> (Valid, PacketRays) {
    let none = [0.0; PACKET];
    let (mut origin, mut direction) = ([none; 3], [none; 3]);
    let (mut t_min, mut time, mut t_max, mut masks) = (none, none, none, [0; PACKET]);
    let mut valid = Valid([0; PACKET]);
    for (i, ray) in rays.iter().enumerate().take(PACKET) {
        for axis in 0..3 {
            origin[axis][i] = ray.origin[axis];
            direction[axis][i] = ray.direction[axis];
        }
        (t_min[i], time[i], t_max[i], masks[i], valid.0[i]) = (ray.t_min, ray.time, ray.t_max, mask(ray), -1);
    }
    let id = std::array::from_fn(|i| i as u32);
    (valid, PacketRays { origin, t_min, direction, time, t_max, mask: masks, id, flags: [0; PACKET] })
}

/// For surfaces.
fn looking(shapes: &Shapes, instance: Option<u32>, through_glass: bool) -> Question<'_> {
    Question { shapes, instance, rays: &[], light: &mut [], through_glass }
}

fn context(question: &mut Question<'_>) -> Context {
    Context { ids: [api::INVALID_ID; 4], user: ptr::from_mut(question).cast::<c_void>() }
}

fn arguments(context: &mut Context, flags: c_int, filter: api::Filter) -> QueryArguments {
    QueryArguments {
        flags,
        features: api::FEATURES_ALL,
        context,
        filter: Some(filter),
        user_geometry: ptr::null_mut(),
        min_width: 0.0,
    }
}

impl BuiltScene {
    /// The nearest surface; `instance` is what it is of where the scene does not know it.
    pub(super) fn closest(&self, shapes: &Shapes, ray: &Ray, instance: Option<u32>) -> Option<Hit> {
        let raw = raw_ray(ray, mask_of(shapes, ray));
        let mut ray_hit = RayHit { ray: raw, hit: NO_HIT, room: [api::INVALID_ID; 4] };
        let mut question = looking(shapes, instance, ray.through_glass);
        let mut context = context(&mut question);
        let mut arguments = arguments(&mut context, 0, keep_surfaces);
        // SAFETY: the scene is committed; ray, context and arguments are as Embree declares them and outlive the call.
        unsafe { (self.device.api.intersect1)(self.handle, &mut ray_hit, &mut arguments) };
        found(&ray_hit, instance)
    }

    /// The same of up to [`PACKET`] rays that run alike.
    pub(super) fn closest_packet(
        &self,
        shapes: &Shapes,
        rays: &[Ray],
        instance: Option<u32>,
        hits: &mut [Option<Hit>],
    ) {
        const NONE: [u32; PACKET] = [api::INVALID_ID; PACKET];
        let nothing = PacketHits {
            normal: [[0.0; PACKET]; 3],
            u: [0.0; PACKET],
            v: [0.0; PACKET],
            primitive: NONE,
            geometry: NONE,
            instance: NONE,
        };
        let (valid, ray) = packet(rays, |ray| mask_of(shapes, ray));
        let mut packet = Packet { ray, hit: nothing, room: NONE };
        let mut question = looking(shapes, instance, rays.iter().any(|ray| ray.through_glass));
        let mut context = context(&mut question);
        let mut arguments = arguments(&mut context, api::QUERY_COHERENT, keep_surfaces);
        // SAFETY: as for `closest`; `valid` has a number for each ray and is as aligned as Embree demands.
        unsafe { (self.device.api.intersect16)(valid.0.as_ptr(), self.handle, &mut packet, &mut arguments) };
        for (i, hit) in hits.iter_mut().enumerate() {
            let found = [packet.hit.primitive[i], packet.hit.geometry[i], packet.hit.instance[i]];
            *hit = (found[1] != api::INVALID_ID)
                .then(|| hit_of(packet.ray.t_max[i], packet.hit.u[i], packet.hit.v[i], found, instance));
        }
    }

    /// Which of up to [`PACKET`] rays that run alike meet a surface.
    pub(super) fn blocked_packet(&self, shapes: &Shapes, rays: &[Ray], blocked: &mut [bool]) {
        let (valid, mut packet) = packet(rays, |ray| mask_of(shapes, ray));
        let mut question = looking(shapes, None, rays.iter().any(|ray| ray.through_glass));
        let mut context = context(&mut question);
        let mut arguments = arguments(&mut context, api::QUERY_COHERENT, keep_surfaces);
        // SAFETY: as for `closest_packet`.
        unsafe { (self.device.api.occluded16)(valid.0.as_ptr(), self.handle, &mut packet, &mut arguments) };
        blocked.iter_mut().zip(packet.t_max).for_each(|(blocked, t_max)| *blocked = t_max == f32::NEG_INFINITY);
    }

    /// Whether a ray meets a surface.
    pub(super) fn blocked(&self, shapes: &Shapes, ray: &Ray) -> bool {
        let mut raw = raw_ray(ray, mask_of(shapes, ray));
        let mut question = looking(shapes, None, ray.through_glass);
        let mut context = context(&mut question);
        let mut arguments = arguments(&mut context, 0, keep_surfaces);
        // SAFETY: as for `closest`.
        unsafe { (self.device.api.occluded1)(self.handle, &mut raw, &mut arguments) };
        raw.t_max == f32::NEG_INFINITY
    }

    /// What is left of the light along up to [`PACKET`] rays that run alike.
    pub(super) fn any_packet(&self, shapes: &Shapes, rays: &[Ray], light: &mut [Vec3]) {
        let (valid, mut packet) = packet(rays, |_| u32::MAX);
        let mut question = Question { shapes, instance: None, rays, light, through_glass: false };
        let mut context = context(&mut question);
        let mut arguments = arguments(&mut context, api::QUERY_COHERENT, keep_blockers);
        // SAFETY: as for `closest_packet`.
        unsafe { (self.device.api.occluded16)(valid.0.as_ptr(), self.handle, &mut packet, &mut arguments) };
        extinguish(light, packet.t_max);
    }

    pub(super) fn any(&self, shapes: &Shapes, ray: &Ray, light: &mut Vec3) {
        let mut raw = raw_ray(ray, u32::MAX);
        let (rays, light) = (std::slice::from_ref(ray), std::slice::from_mut(light));
        let mut question = Question { shapes, instance: None, rays, light, through_glass: false };
        let mut context = context(&mut question);
        let mut arguments = arguments(&mut context, 0, keep_blockers);
        // SAFETY: as for `closest`.
        unsafe { (self.device.api.occluded1)(self.handle, &mut raw, &mut arguments) };
        extinguish(question.light, [raw.t_max]);
    }

    /// Whether a ray meets a triangle, found as the nearest one with nothing judged.
    pub(super) fn bare_closest(&self, ray: &Ray) -> bool {
        let mut ray_hit = RayHit { ray: raw_ray(ray, u32::MAX), hit: NO_HIT, room: [api::INVALID_ID; 4] };
        // SAFETY: as for `closest`; without arguments Embree takes its defaults.
        unsafe { (self.device.api.intersect1)(self.handle, &mut ray_hit, ptr::null_mut()) };
        found(&ray_hit, None).is_some()
    }

    /// The same, found as any.
    pub(super) fn bare_any(&self, ray: &Ray) -> bool {
        let mut raw = raw_ray(ray, u32::MAX);
        // SAFETY: as for `bare_closest`.
        unsafe { (self.device.api.occluded1)(self.handle, &mut raw, ptr::null_mut()) };
        raw.t_max == f32::NEG_INFINITY
    }
}

/// Embree marks rays that are blocked by a length of −∞.
fn extinguish(light: &mut [Vec3], lengths: impl IntoIterator<Item = f32>) {
    for (light, t_max) in light.iter_mut().zip(lengths) {
        if t_max == f32::NEG_INFINITY {
            *light = Vec3::ZERO;
        }
    }
}
