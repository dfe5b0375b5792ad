//! The lorries and trailers that there are.

mod bed;
mod cab;
mod chassis;
mod cover;
mod load;
mod paints;
mod special;
mod trailer;

use glam::{Vec3, vec3};
use trove_model::{Asset, Kind};

use super::slots::COMMERCIAL;
use super::workshop::Workshop;
use bed::Bed;
pub(super) use cab::Cab;
use chassis::Frame;
use paints::{BOXES, CANOPY, CANVAS, FIRE, MUNICIPAL, OLIVE, TANKS, TIPPERS};
use trailer::Trailer;

/// What is on the frame.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Body {
    /// A closed box with a name on some.
    Box(&'static str),
    /// A closed box with a cooling unit.
    Cooled(&'static str),
    /// Drop sides under a canvas roof with its curtains drawn up, a tail lift, goods.
    Canopy,
    /// Curtains on the sides.
    Curtains(&'static str),
    /// Canvas over hoops.
    Hoops,
    /// Low sides and goods.
    Flatbed,
    Tipper,
    Refuse,
    Tank,
    Mixer,
    Fire,
    /// A fifth wheel.
    Tractor,
    /// A fifth wheel with a trailer on it.
    Semi(Trailer),
}

/// A lorry to build; distances are from its front.
#[derive(Clone, Copy, Debug)]
struct TruckPlan {
    id: &'static str,
    length_m: f32,
    /// Top of the load.
    top_m: f32,
    /// Top of the frame.
    deck_m: f32,
    wheel_m: f32,
    front_axles_m: &'static [f32],
    rear_axles_m: &'static [f32],
    cab: Cab,
    body: Body,
    second: &'static [Vec3],
    commonness: f32,
}

const HEAVY: Cab = Cab {
    length_m: 1.8,
    height_m: 2.85,
    width_m: 2.45,
    floor_m: 0.36,
    axle_m: 1.3,
    wheel_m: 0.5,
    bonnet_m: 0.0,
    crew: false,
    plain: false,
    grille: (5, 1.0, true),
    driver_side: 1.0,
};
const LIGHT: Cab = Cab {
    length_m: 1.55,
    height_m: 2.15,
    width_m: 1.95,
    floor_m: 0.32,
    axle_m: 1.05,
    wheel_m: 0.37,
    grille: (3, 0.6, false),
    ..HEAVY
};
const SMALL: Cab = Cab {
    length_m: 1.5,
    height_m: 1.98,
    width_m: 1.72,
    floor_m: 0.3,
    axle_m: 0.98,
    wheel_m: 0.33,
    grille: (2, 0.32, false),
    ..HEAVY
};
const SLEEPER: Cab =
    Cab { length_m: 2.3, height_m: 3.62, width_m: 2.48, axle_m: 1.4, grille: (7, 1.0, false), ..HEAVY };
const BONNETED: Cab = Cab {
    length_m: 3.15,
    height_m: 2.5,
    width_m: 2.3,
    floor_m: 0.42,
    axle_m: 1.0,
    wheel_m: 0.48,
    bonnet_m: 1.45,
    ..HEAVY
};
const CONVENTIONAL: Cab =
    Cab { length_m: 5.0, height_m: 3.75, width_m: 2.44, axle_m: 1.15, bonnet_m: 1.8, wheel_m: 0.51, ..BONNETED };

const PLAN: TruckPlan = TruckPlan {
    id: "",
    length_m: 8.6,
    top_m: 3.5,
    deck_m: 1.0,
    wheel_m: 0.5,
    front_axles_m: &[1.3],
    rear_axles_m: &[6.0],
    cab: HEAVY,
    body: Body::Box(""),
    second: &BOXES,
    commonness: 1.0,
};
const LIGHT_PLAN: TruckPlan = TruckPlan {
    length_m: 5.9,
    top_m: 2.85,
    deck_m: 0.8,
    wheel_m: 0.37,
    front_axles_m: &[1.05],
    rear_axles_m: &[4.35],
    cab: LIGHT,
    ..PLAN
};

#[rustfmt::skip]
const TRUCKS: [TruckPlan; 29] = [
    TruckPlan { id: "truck/box-small", body: Body::Box("SWIFT PARCEL"), ..LIGHT_PLAN },
    TruckPlan { id: "truck/box-kei", length_m: 4.6, top_m: 2.45, deck_m: 0.68, wheel_m: 0.33, front_axles_m: &[0.98], rear_axles_m: &[3.35], cab: SMALL, body: Body::Box("FLORA"), ..LIGHT_PLAN },
    TruckPlan { id: "truck/box-city", length_m: 6.6, top_m: 3.1, rear_axles_m: &[4.8], body: Body::Box("HOME MOVERS"), ..LIGHT_PLAN },
    TruckPlan { id: "truck/box-medium", length_m: 7.6, top_m: 3.3, rear_axles_m: &[5.3], cab: Cab { height_m: 2.6, grille: (3, 0.7, false), ..HEAVY }, body: Body::Box("NORDFRACHT"), ..PLAN },
    TruckPlan { id: "truck/box", body: Body::Box("EASTERN CARGO"), ..PLAN },
    TruckPlan { id: "truck/box-large", length_m: 10.4, top_m: 3.8, rear_axles_m: &[7.0, 8.35], cab: Cab { height_m: 3.1, grille: (6, 1.0, false), ..HEAVY }, body: Body::Box("ATLAS LOGISTICS"), ..PLAN },
    TruckPlan { id: "truck/box-bonneted", length_m: 9.2, top_m: 3.6, deck_m: 1.0, wheel_m: 0.48, front_axles_m: &[1.0], rear_axles_m: &[6.6], cab: BONNETED, body: Body::Box("RENT A TRUCK"), ..PLAN },
    TruckPlan { id: "truck/cooled", length_m: 8.2, top_m: 3.5, rear_axles_m: &[5.8], body: Body::Cooled("FRESH FOODS"), ..PLAN },
    TruckPlan { id: "truck/cooled-small", length_m: 6.3, top_m: 3.0, rear_axles_m: &[4.6], body: Body::Cooled("FISCH"), ..LIGHT_PLAN },
    TruckPlan { id: "truck/canopy", length_m: 9.9, top_m: 3.6, rear_axles_m: &[6.9], cab: Cab { height_m: 2.75, grille: (4, 0.6, false), ..HEAVY }, body: Body::Canopy, second: &CANOPY, ..PLAN },
    TruckPlan { id: "truck/canopy-small", length_m: 6.4, top_m: 3.05, rear_axles_m: &[4.6], body: Body::Canopy, second: &CANOPY, ..LIGHT_PLAN },
    TruckPlan { id: "truck/curtain", length_m: 9.3, top_m: 3.75, rear_axles_m: &[6.5], cab: Cab { height_m: 3.0, grille: (6, 1.0, false), ..HEAVY }, body: Body::Curtains("TRANSALPIN"), second: &CANVAS, ..PLAN },
    TruckPlan { id: "truck/hoops", length_m: 7.2, top_m: 3.15, deck_m: 1.05, rear_axles_m: &[5.2], cab: Cab { plain: true, ..HEAVY }, body: Body::Hoops, second: &OLIVE, ..PLAN },
    TruckPlan { id: "truck/hoops-small", length_m: 5.6, top_m: 2.6, rear_axles_m: &[4.1], body: Body::Hoops, second: &OLIVE, ..LIGHT_PLAN },
    TruckPlan { id: "truck/flatbed", length_m: 8.8, top_m: 2.3, rear_axles_m: &[6.2], body: Body::Flatbed, ..PLAN },
    TruckPlan { id: "truck/flatbed-light", length_m: 5.5, top_m: 1.9, rear_axles_m: &[4.05], body: Body::Flatbed, ..LIGHT_PLAN },
    TruckPlan { id: "truck/flatbed-kei", length_m: 4.5, top_m: 1.6, deck_m: 0.66, wheel_m: 0.33, front_axles_m: &[0.98], rear_axles_m: &[3.3], cab: SMALL, body: Body::Flatbed, ..LIGHT_PLAN },
    TruckPlan { id: "truck/tipper", length_m: 7.9, top_m: 2.75, deck_m: 1.08, rear_axles_m: &[5.1, 6.45], cab: Cab { plain: true, ..HEAVY }, body: Body::Tipper, second: &TIPPERS, ..PLAN },
    TruckPlan { id: "truck/tipper-large", length_m: 9.2, top_m: 3.0, deck_m: 1.1, front_axles_m: &[1.3, 3.05], rear_axles_m: &[6.3, 7.65], cab: Cab { plain: true, ..HEAVY }, body: Body::Tipper, second: &TIPPERS, ..PLAN },
    TruckPlan { id: "truck/tipper-small", length_m: 5.6, top_m: 2.0, deck_m: 0.82, rear_axles_m: &[4.0], body: Body::Tipper, second: &TIPPERS, ..LIGHT_PLAN },
    TruckPlan { id: "truck/refuse", length_m: 9.3, top_m: 3.35, deck_m: 1.0, rear_axles_m: &[5.3, 6.65], cab: Cab { height_m: 2.75, ..HEAVY }, body: Body::Refuse, second: &MUNICIPAL, ..PLAN },
    TruckPlan { id: "truck/tanker", length_m: 8.8, top_m: 3.2, deck_m: 1.05, rear_axles_m: &[5.6, 6.95], body: Body::Tank, second: &TANKS, commonness: 0.5, ..PLAN },
    TruckPlan { id: "truck/mixer", length_m: 8.9, top_m: 3.85, deck_m: 1.1, front_axles_m: &[1.3, 3.0], rear_axles_m: &[5.4, 6.75], cab: Cab { plain: true, ..HEAVY }, body: Body::Mixer, second: &BOXES, ..PLAN },
    TruckPlan { id: "truck/fire", length_m: 8.2, top_m: 3.0, deck_m: 1.0, rear_axles_m: &[5.6], cab: Cab { length_m: 2.95, height_m: 2.95, crew: true, ..HEAVY }, body: Body::Fire, second: &FIRE, commonness: 0.2, ..PLAN },
    TruckPlan { id: "truck/tractor", length_m: 6.0, top_m: 3.62, deck_m: 0.95, front_axles_m: &[1.4], rear_axles_m: &[5.05], cab: SLEEPER, body: Body::Tractor, commonness: 0.5, ..PLAN },
    TruckPlan { id: "truck/tractor-bonneted", length_m: 7.9, top_m: 3.75, deck_m: 0.98, wheel_m: 0.51, front_axles_m: &[1.15], rear_axles_m: &[5.75, 7.1], cab: CONVENTIONAL, body: Body::Tractor, commonness: 0.5, ..PLAN },
    TruckPlan { id: "truck/semi", length_m: 16.4, top_m: 4.0, deck_m: 0.95, front_axles_m: &[1.4], rear_axles_m: &[5.05], cab: SLEEPER, body: Body::Semi(Trailer::CURTAINS), second: &CANVAS, ..PLAN },
    TruckPlan { id: "truck/semi-bonneted", length_m: 20.3, top_m: 4.05, deck_m: 0.98, wheel_m: 0.51, front_axles_m: &[1.15], rear_axles_m: &[5.75, 7.1], cab: CONVENTIONAL, body: Body::Semi(Trailer::LONG_BOX), ..PLAN },
    TruckPlan { id: "truck/semi-tanker", length_m: 15.2, top_m: 3.6, deck_m: 0.95, front_axles_m: &[1.4], rear_axles_m: &[5.05], cab: SLEEPER, body: Body::Semi(Trailer::TANK), second: &TANKS, commonness: 0.5, ..PLAN },
];

/// Every lorry and trailer.
pub(crate) fn assets() -> Vec<Asset> {
    TRUCKS.iter().map(TruckPlan::asset).chain(trailer::assets()).collect()
}

impl TruckPlan {
    fn asset(&self) -> Asset {
        let paints: &[Vec3] = match self.body {
            Body::Fire => &FIRE,
            Body::Refuse => &MUNICIPAL,
            _ => &COMMERCIAL,
        };
        let mut work = Workshop::new(self.id, paints, self.second);
        self.cab.build(&mut work);
        let half = self.cab.width_m / 2.0 - 0.02;
        let tractor = matches!(self.body, Body::Tractor | Body::Semi(_));
        let end =
            if tractor { self.rear_axles_m.last().map_or(6.0, |a| a + self.wheel_m + 0.45) } else { self.length_m };
        let frame = Frame {
            from_m: if self.cab.bonnet_m > 0.0 { 0.5 } else { 0.6 },
            to_m: end - 0.04,
            half_m: half,
            deck_m: self.deck_m,
            wheel_m: self.wheel_m,
            front_axles_m: self.front_axles_m,
            rear_axles_m: self.rear_axles_m,
            twin: true,
            sides: self.body != Body::Fire,
            hazard: matches!(self.body, Body::Canopy | Body::Tipper | Body::Mixer),
        };
        frame.build(&mut work);
        let bed = Bed {
            from: self.cab.length_m + 0.14,
            to: end,
            half: self.cab.width_m / 2.0 + 0.03,
            deck: self.deck_m,
            top: self.top_m,
        };
        self.load(&mut work, &bed, end);
        Asset { commonness: self.commonness, ..work.asset(Kind::Truck) }
    }

    fn load(&self, work: &mut Workshop, bed: &Bed, end: f32) {
        let light = self.wheel_m < 0.4;
        match self.body {
            Body::Box(name) => bed.closed(work, name),
            Body::Cooled(name) => {
                bed.closed(work, name);
                bed.cooler(work);
            }
            Body::Canopy => {
                bed.canopy(work);
                bed.pallets(work, 0.8, 1.3, 0.8);
            }
            Body::Curtains(name) => bed.curtains(work, name),
            Body::Hoops => bed.hoops(work),
            Body::Flatbed => {
                let alu = work.slots.alu;
                bed.floor(work, alu);
                bed.drop_sides(work, if light { 0.36 } else { 0.5 }, alu, false);
                bed.headboard(work, bed.top - bed.floor_top(), alu);
                bed.pallets(work, 0.3, bed.top - bed.floor_top() - 0.1, 0.9);
                bed.pipes(work, 0.2, if light { 0.055 } else { 0.1 });
                bed.sand_bags(work, 0.2);
                if !light {
                    bed.drums(work, 0.1, 0.52);
                }
            }
            Body::Tipper => {
                bed.tipper(work);
                bed.gravel(work, 0.6, bed.top, 0.12);
                work.beacon(vec3(-self.cab.length_m + 0.35, 0.0, self.cab.height_m - 0.02));
            }
            Body::Refuse => {
                bed.refuse(work);
                work.beacon(vec3(-self.cab.length_m + 0.35, 0.5, self.cab.height_m - 0.03));
            }
            Body::Tank => {
                let paint = work.slots.panel;
                bed.tank(work, paint);
            }
            Body::Mixer => bed.mixer(work),
            Body::Fire => {
                bed.fire(work);
                work.blue_lights(vec3(-0.95, 0.0, self.cab.height_m - 0.03), 1.5);
            }
            Body::Tractor => bed.fifth_wheel(work, end - 1.2, self.wheel_m, self.rear_axles_m),
            Body::Semi(trailer) => {
                let back = self.rear_axles_m.iter().sum::<f32>() / self.rear_axles_m.len() as f32;
                bed.fifth_wheel(work, back - 0.3, self.wheel_m, self.rear_axles_m);
                trailer.build(work, self.length_m - trailer.length_m, self.top_m, false);
            }
        }
    }
}
