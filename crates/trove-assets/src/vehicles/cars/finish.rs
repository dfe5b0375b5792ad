//! A car with all that belongs to it: plates, extras, mirrors, who sits in it.

use std::collections::BTreeMap;
use std::f32::consts::PI;

use glam::{Quat, Vec2, Vec3, vec3};
use rayon::prelude::*;
use trove_model::{Asset, Material, Tags};

use super::plan::CarPlan;
use super::{cabin, extras, fittings};
use crate::shape::Shape;
use crate::vehicles::decal::face;
use crate::vehicles::workshop::Workshop;

/// The cars of these plans.
pub(crate) fn assets(plans: &[CarPlan]) -> Vec<Asset> {
    // Cars with the same plate share its picture.
    let mut plates = BTreeMap::new();
    for plan in plans {
        plates.entry(plan.plate.name.as_str()).or_insert_with(|| plan.plate.material());
    }
    plans.par_iter().map(|plan| finished(plan, &plates[plan.plate.name.as_str()])).collect()
}

fn finished(plan: &CarPlan, plate: &Material) -> Asset {
    let mut work = Workshop::of_car(&plan.id, &plan.paint, plate.clone());
    let slots = work.slots;
    let car = plan.build(&slots);
    plates(&mut work, plan, &car);
    work.model.add_marked(car);
    extras::put_on(&mut work, plan);
    work.model.add_extra("mirrors", 1.0, false, fittings::mirrors(plan, &slots));
    work.model.add_extra("driver", 1.0, true, cabin::occupant(plan, true, &slots));
    work.model.add_extra("passenger", 0.35, true, cabin::occupant(plan, false, &slots));
    let asset = work.asset(plan.kind.into());
    Asset { class: plan.class.into(), tags: Tags::new(&plan.tags), commonness: plan.commonness, ..asset }
}

/// Number plates in front and behind.
fn plates(work: &mut Workshop, plan: &CarPlan, car: &Shape) {
    let p = &plan.profile;
    let middle = |direction: Vec3, z: f32| {
        // Clear of bumpers that lean.
        let reach = |dz: f32| car.outermost(direction, vec3(0.0, 0.01, z + dz)).unwrap_or(0.0);
        reach(0.05).max(reach(-0.05))
    };
    let (front_z, back_z) = (p.clearance_m + plan.face.plate_m, p.tail_m + plan.back.plate_m);
    let front = vec3(middle(Vec3::X, front_z), 0.0, front_z);
    let back = vec3(-middle(-Vec3::X, back_z), 0.0, back_z);
    let size = Vec2::from_array(plan.plate.size_m);
    let frame = Shape::rounded_block(vec3(0.016, size.x + 0.02, size.y + 0.02), 0.006).slot(work.slots.trim);
    let one = frame.and(face(size, Vec3::X * 0.0095).slot(work.plate));
    let turned = one.clone().turned(Quat::from_rotation_z(PI));
    work.model.add_marked(one.moved(front + Vec3::X * 0.004).and(turned.moved(back - Vec3::X * 0.004)));
}
