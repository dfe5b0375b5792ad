//! Bicycles and motorcycles, with and without riders.

mod bicycle;
mod motorcycle;
mod parts;

use glam::{Vec3, vec2, vec3};
use trove_model::{Asset, Kind, Material};

use crate::people::{Figure, Hair, Leg, Outfit, Physique, Pose, Wardrobe};
use crate::shape::{Model, Shape};
use bicycle::BicyclePlan;
use motorcycle::Motorcycle;
use parts::Parts;

/// Every model of this family.
pub(crate) fn assets() -> Vec<Asset> {
    let sports = BicyclePlan { wheel_radius_m: 0.345, tyre_m: 0.016, city: false };
    let city = BicyclePlan { wheel_radius_m: 0.34, tyre_m: 0.021, city: true };
    let (man, woman) = (Physique::MAN, Physique::WOMAN);
    let casual = Outfit::CASUAL;
    let shorts = Outfit { leg: Leg::Shorts, ..casual };
    let long = Outfit { hair: Hair::Long, ..casual };
    let mut all = Vec::new();
    for (name, plan, body, outfit) in [("sports", sports, man, shorts), ("city", city, woman, long)] {
        let build = |parts: &Parts| plan.build(parts);
        let pose = plan.pose(body.height_m);
        all.push(cycle(&format!("bicycle/{name}"), Kind::Bicycle, build, None));
        let rider = Rider { body, pose, outfit, helmet: name == "sports", visor: false };
        all.push(cycle(&format!("bicycle/{name}-rider"), Kind::BicycleWithRider, build, Some(rider)));
    }
    let other = Rider { body: man, pose: city.pose(man.height_m), outfit: Outfit::JACKET, helmet: true, visor: false };
    all.push(cycle("bicycle/city-rider-2", Kind::BicycleWithRider, |p| city.build(p), Some(other)));
    let kinds = [("roadster", Motorcycle::Roadster), ("sports", Motorcycle::Sports), ("scooter", Motorcycle::Scooter)];
    for (name, plan) in kinds {
        let build = |parts: &Parts| plan.build(parts);
        let body = if plan == Motorcycle::Scooter { woman } else { man };
        let rider = Rider { body, pose: plan.pose(body.height_m), outfit: Outfit::JACKET, helmet: true, visor: true };
        all.push(cycle(&format!("motorcycle/{name}"), Kind::Motorcycle, build, None));
        all.push(cycle(&format!("motorcycle/{name}-rider"), Kind::MotorcycleWithRider, build, Some(rider)));
    }
    all
}

struct Rider {
    body: Physique,
    pose: Pose,
    outfit: Outfit,
    helmet: bool,
    /// A full-face helmet.
    visor: bool,
}

fn cycle(id: &str, kind: Kind, build: impl Fn(&Parts) -> Shape, rider: Option<Rider>) -> Asset {
    let mut model = Model::default();
    let parts = Parts::new(&mut model);
    model.add_marked(build(&parts));
    if let Some(rider) = rider {
        let slots = Wardrobe::new(&mut model, &[], &[]);
        let figure = Figure::new(rider.body, rider.pose);
        model.add_marked(figure.dressed(&rider.outfit, &slots));
        if rider.helmet {
            let paints = [vec3(0.02, 0.02, 0.022), Vec3::splat(0.7), vec3(0.4, 0.02, 0.02), vec3(0.03, 0.1, 0.3)];
            let shell = model.slot(Material { coat: 1.0, ..Material::plain("helmet", paints[0], 0.35) }, &paints);
            model.add(shell, helmet(&figure, rider.visor));
            if rider.visor {
                let visor = Shape::ellipsoid(vec3(0.082, 0.108, 0.06), 18).moved(figure.head + vec3(0.08, 0.0, 0.01));
                model.add(parts.black, visor);
            }
        }
    }
    model.asset(id, kind, kind.class())
}

fn helmet(figure: &Figure, full: bool) -> Shape {
    if full {
        return Shape::ellipsoid(vec3(0.15, 0.128, 0.155), 24).moved(figure.head + vec3(0.0, 0.0, 0.0));
    }
    let shell = [vec2(0.118, 0.0), vec2(0.12, 0.02), vec2(0.108, 0.07), vec2(0.07, 0.105), vec2(0.0, 0.118)];
    Shape::lathe(&shell, 20).scaled(vec3(1.2, 0.9, 1.0)).moved(figure.head + vec3(-0.01, 0.0, 0.04))
}
