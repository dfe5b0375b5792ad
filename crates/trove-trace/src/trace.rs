//! From a ray to what it meets.

use crate::beam::Beam;
use crate::pair::places;
use crate::ray::{Hit, Ray};
use crate::sheared::Sheared;
use crate::stack::Stack;
use crate::tables::{Mesh, Tables};

/// The nearest hit that counts, on an instance that the ray enters.
#[inline(always)]
pub fn closest<T: Tables>(
    tables: &T,
    ray: &Ray,
    enters: impl Fn(u32) -> bool,
    counts: impl FnMut(&Hit) -> bool,
) -> Option<Hit> {
    trace::<T, false>(tables, ray, None, enters, counts)
}

/// Any hit that counts, on an instance that the ray enters.
#[inline(always)]
pub fn any<T: Tables>(
    tables: &T,
    ray: &Ray,
    enters: impl Fn(u32) -> bool,
    counts: impl FnMut(&Hit) -> bool,
) -> Option<Hit> {
    trace::<T, true>(tables, ray, None, enters, counts)
}

/// The nearest hit that counts on one instance, as if nothing else were there.
#[inline(always)]
pub fn closest_on<T: Tables>(tables: &T, ray: &Ray, instance: u32, counts: impl FnMut(&Hit) -> bool) -> Option<Hit> {
    trace::<T, false>(tables, ray, Some(instance), |_| true, counts)
}

/// Among an instance's triangles.
struct Inside<'a> {
    instance: u32,
    mesh: Mesh<'a>,
    sheared: Sheared,
}

/// One loop over both levels, so that the threads of a card go down different instances side by side.
#[inline(always)]
fn trace<T: Tables, const STOP_AT_ANY: bool>(
    tables: &T,
    ray: &Ray,
    alone: Option<u32>,
    enters: impl Fn(u32) -> bool,
    mut counts: impl FnMut(&Hit) -> bool,
) -> Option<Hit> {
    let mut stack = Stack::new();
    let mut nearest: Option<Hit> = None;
    let mut t_max = ray.t_max;
    let enter = |instance: u32| {
        let mesh = tables.mesh(instance);
        let mesh_from_world = tables.mesh_from_world(instance, ray.time);
        let origin = mesh_from_world.transform_point3(ray.origin);
        let direction = mesh_from_world.transform_vector3(ray.direction);
        (Inside { instance, mesh, sheared: Sheared::new(origin, direction) }, Beam::new(origin, direction))
    };
    let in_world = || Beam::new(ray.origin, ray.direction);

    let (top, root) = tables.top();
    let (mut pairs, mut next, mut beam) = (top, root, in_world());
    let mut inside: Option<Inside<'_>> = None;
    // What lies on the stack below belongs to the top hierarchy.
    let mut below = 0;
    if let Some(instance) = alone {
        let (entered, local) = enter(instance);
        (pairs, next, beam) = (entered.mesh.pairs, entered.mesh.root, local);
        inside = Some(entered);
    }

    loop {
        let (first, count) = places(next);
        let mut goes_down = false;
        if count == 0 {
            // The nearer child at once, the other one later.
            let pair = &pairs[first as usize];
            let [t_first, t_second] = beam.enters(pair);
            let [mut near, mut far] = pair.children;
            let (mut t_near, mut t_far) = (t_first, t_second);
            if t_first > t_second {
                (near, far, t_near, t_far) = (far, near, t_second, t_first);
            }
            if t_near < t_max {
                if t_far < t_max {
                    stack.push(t_far, far);
                }
                (next, goes_down) = (near, true);
            }
        } else if let Some(Inside { instance, mesh, sheared }) = &inside {
            for corners in &mesh.corners[first as usize..(first + count) as usize] {
                let Some((t, u, v)) = sheared.intersect(corners, ray.t_min, t_max) else { continue };
                let hit = Hit { t, instance: *instance, triangle: corners.triangle, u, v };
                if counts(&hit) {
                    if STOP_AT_ANY {
                        return Some(hit);
                    }
                    (nearest, t_max) = (Some(hit), t);
                }
            }
        } else {
            let instance = tables.instance(first);
            if enters(instance) {
                let (entered, local) = enter(instance);
                (pairs, next, beam) = (entered.mesh.pairs, entered.mesh.root, local);
                (inside, below, goes_down) = (Some(entered), stack.len, true);
            }
        }

        // Back to what was left for later and is still near enough, out of the instance where nothing is left of it.
        while !goes_down {
            if stack.len == below && inside.is_some() && alone.is_none() {
                (pairs, beam, inside, below) = (top, in_world(), None, 0);
            }
            if stack.len == below {
                return nearest;
            }
            let (t, child) = stack.pop();
            (next, goes_down) = (child, t < t_max);
        }
    }
}
