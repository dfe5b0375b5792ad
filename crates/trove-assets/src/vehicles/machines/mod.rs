//! Construction machines.

mod arm;
mod cabin;
mod excavator;
mod lifter;
mod loader;
mod roller;
mod running;

use glam::{Vec3, vec3};
use trove_model::{Asset, Kind};

use super::workshop::Workshop;

/// Yellow mostly, then orange, green, red and white.
const PAINTS: [Vec3; 8] = [
    vec3(0.62, 0.36, 0.015),
    vec3(0.62, 0.36, 0.015),
    vec3(0.66, 0.42, 0.03),
    vec3(0.66, 0.42, 0.03),
    vec3(0.58, 0.18, 0.015),
    vec3(0.12, 0.3, 0.1),
    vec3(0.36, 0.02, 0.015),
    vec3(0.6, 0.6, 0.58),
];

/// An id, a scale, a commonness, a builder.
type Machine = (&'static str, f32, f32, fn(&mut Workshop));

/// Every machine: an id, how large it is against the builder's measures, how common it is, its builder.
#[rustfmt::skip]
const MACHINES: [Machine; 16] = [
    ("machine/excavator", 1.0, 1.0, excavator::tracked),
    ("machine/excavator-reaching", 1.0, 1.0, excavator::reaching),
    ("machine/excavator-compact", 0.58, 1.0, excavator::tracked),
    ("machine/excavator-large", 1.22, 0.5, excavator::tracked),
    ("machine/excavator-wheeled", 0.95, 1.0, excavator::wheeled),
    ("machine/wheel-loader", 1.0, 1.0, loader::wheel_loader),
    ("machine/wheel-loader-compact", 0.7, 1.0, loader::wheel_loader),
    ("machine/wheel-loader-raised", 0.9, 0.5, loader::raised),
    ("machine/backhoe", 1.0, 0.7, loader::backhoe),
    ("machine/roller", 1.0, 1.0, roller::single),
    ("machine/roller-tandem", 0.85, 1.0, roller::tandem),
    ("machine/roller-small", 0.58, 0.7, roller::tandem),
    ("machine/forklift", 1.0, 0.7, lifter::forklift),
    ("machine/telehandler", 1.0, 0.7, lifter::telehandler),
    ("machine/mobile-crane", 1.0, 0.7, lifter::crane),
    ("machine/mobile-crane-large", 1.18, 0.4, lifter::crane),
];

/// Every machine.
pub(crate) fn assets() -> Vec<Asset> {
    let machine = |&(id, scale, commonness, build): &Machine| {
        let mut work = Workshop::new(id, &PAINTS, &[vec3(0.05, 0.052, 0.055)]);
        build(&mut work);
        work.model.scale(scale);
        Asset { commonness, ..work.asset(Kind::ConstructionVehicle) }
    };
    MACHINES.iter().map(machine).collect()
}
