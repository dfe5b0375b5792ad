//! Bicycles and motorcycles, with and without riders.

mod bicycle;
mod motorcycle;
mod parts;
mod rider;

use trove_model::{Asset, Kind, Role};

use crate::people::{Hair, Leg, Outfit, Physique};
use crate::shape::{Model, Shape};
use bicycle::BicyclePlan;
use motorcycle::{Build, Motorcycle};
use parts::Parts;
use rider::{Helmet, Rider};

const SHORTS: Outfit = Outfit { leg: Leg::Shorts, ..Outfit::CASUAL };
const LONG: Outfit = Outfit { hair: Hair::Long, ..Outfit::CASUAL };
const SKIRT: Outfit = Outfit { leg: Leg::Skirt, hair: Hair::Bun, ..Outfit::CASUAL };
const TIGHT: Outfit = Outfit { leg: Leg::Shorts, loose_m: 0.002, hem: 0.0, ..Outfit::CASUAL };

/// A bicycle's name, its plan, who rides it in what, with a helmet, with a bag on the back.
#[rustfmt::skip]
const BICYCLES: [(&str, BicyclePlan, Physique, Outfit, Helmet, bool); 10] = [
    ("city", BicyclePlan::CITY, Physique::WOMAN, LONG, Helmet::None, false),
    ("roadster", BicyclePlan::ROADSTER, Physique::MAN, Outfit::JACKET, Helmet::None, false),
    ("trekking", BicyclePlan::TREKKING, Physique::MAN, Outfit::CASUAL, Helmet::Open, false),
    ("electric", BicyclePlan::ELECTRIC, Physique::WOMAN, SKIRT, Helmet::Open, false),
    ("racing", BicyclePlan::RACING, Physique::MAN, TIGHT, Helmet::Open, false),
    ("mountain", BicyclePlan::MOUNTAIN, Physique::MAN, SHORTS, Helmet::Open, false),
    ("courier", BicyclePlan::TREKKING, Physique::MAN, SHORTS, Helmet::Open, true),
    ("cargo", BicyclePlan::CARGO, Physique::WOMAN, Outfit::JACKET, Helmet::Open, false),
    ("child", BicyclePlan::CHILD, Physique::CHILD, SHORTS, Helmet::Open, false),
    ("city-small", BicyclePlan { saddle_m: 0.84, wheel_m: 0.33, front_wheel_m: 0.33, wheelbase_m: 1.0, ..BicyclePlan::CITY }, Physique::WOMAN, Outfit::JACKET, Helmet::None, false),
];

/// A motorcycle's name, how it is built, whether it delivers, who rides it in what.
#[rustfmt::skip]
const MOTORCYCLES: [(&str, Build, bool, Physique, Outfit); 8] = [
    ("naked", Build::Naked, false, Physique::MAN, Outfit::JACKET),
    ("sports", Build::Sports, false, Physique::MAN, Outfit::JACKET),
    ("cruiser", Build::Cruiser, false, Physique::MAN, Outfit::JACKET),
    ("delivery", Build::Naked, true, Physique::MAN, Outfit::JACKET),
    ("underbone", Build::Underbone, false, Physique::MAN, Outfit::CASUAL),
    ("underbone-delivery", Build::Underbone, true, Physique::MAN, Outfit::JACKET),
    ("scooter", Build::Scooter, false, Physique::WOMAN, Outfit::JACKET),
    ("scooter-delivery", Build::Scooter, true, Physique::MAN, Outfit::CASUAL),
];

/// Every model of this family.
pub(crate) fn assets() -> Vec<Asset> {
    let mut all = Vec::new();
    for (name, plan, body, outfit, helmet, bag) in BICYCLES {
        let build = |parts: &Parts| plan.build(parts);
        let rider = Rider { body, pose: plan.pose(body.height_m), outfit, helmet, bag };
        let ridden = |id: &str, outfit: &Outfit| {
            cycle(id, Kind::BicycleWithRider, build, Some(Rider { outfit: *outfit, ..rider }))
        };
        if !bag {
            all.push(cycle(&format!("bicycle/{name}"), Kind::Bicycle, build, None));
        }
        all.extend(outfit.in_all_weathers(&format!("bicycle/{name}-rider"), ridden));
    }
    for (name, build, delivers, body, outfit) in MOTORCYCLES {
        let plan = Motorcycle { build, delivers };
        let shape = |parts: &Parts| plan.shape(parts);
        let helmet = if matches!(build, Build::Scooter | Build::Underbone) { Helmet::Jet } else { Helmet::Full };
        let rider = Rider { body, pose: plan.pose(body.height_m), outfit, helmet, bag: false };
        let ridden = |id: &str, outfit: &Outfit| {
            cycle(id, Kind::MotorcycleWithRider, shape, Some(Rider { outfit: *outfit, ..rider }))
        };
        all.push(cycle(&format!("motorcycle/{name}"), Kind::Motorcycle, shape, None));
        all.extend(outfit.in_all_weathers(&format!("motorcycle/{name}-rider"), ridden));
    }
    all
}

fn cycle(id: &str, kind: Kind, build: impl Fn(&Parts) -> Shape, rider: Option<Rider>) -> Asset {
    let mut model = Model::default();
    let parts = Parts::new(&mut model, id);
    model.add_marked(build(&parts));
    if let Some(rider) = rider {
        let of_cycle = model.slots().len();
        model.slots().iter_mut().for_each(|slot| _ = slot.material.role.get_or_insert(Role::Ridden));
        // Helmet and bag are of the cycle's materials, but not parts of it.
        let parts = Parts::new(&mut model, id);
        rider.sit(&mut model, &parts);
        let role = if kind == Kind::BicycleWithRider { Role::Cyclist } else { Role::Motorcyclist };
        model.slots()[of_cycle..].iter_mut().for_each(|slot| slot.material.role = Some(role));
    }
    model.asset(id, kind, kind.class())
}
