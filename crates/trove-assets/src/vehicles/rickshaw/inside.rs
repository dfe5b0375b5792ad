//! Seats, the wall behind the driver, and who sits there.

use glam::{Vec3, vec3};

use super::measures::FLOOR_M;
use crate::people::{Figure, Hair, Outfit, Physique, Pose, Wardrobe};
use crate::shape::Shape;
use crate::vehicles::workshop::{Workshop, block};

/// Shirts of drivers: khaki above all.
const SHIRTS: [Vec3; 5] = [
    vec3(0.3, 0.22, 0.11),
    vec3(0.27, 0.19, 0.09),
    vec3(0.34, 0.26, 0.15),
    vec3(0.6, 0.6, 0.58),
    vec3(0.25, 0.33, 0.45),
];

const MAN: Physique = Physique { height_m: 1.68, ..Physique::MAN };

/// Middle of the handlebar.
pub(super) const BAR: Vec3 = vec3(-0.68, 0.0, 0.98);

pub(super) fn build(work: &mut Workshop) {
    let slots = work.slots;
    // The driver sits on a box, the wall behind is his backrest.
    work.add(slots.paint, block([0.4, 0.56, 0.26], [-1.1, 0.0, FLOOR_M + 0.13], 0.02));
    work.add(slots.seat, block([0.42, 0.6, 0.1], [-1.09, 0.0, 0.61], 0.035));
    work.add(slots.seat, block([0.07, 0.56, 0.28], [-1.26, 0.0, 0.83], 0.03));
    work.add(slots.paint, block([0.02, 1.17, 0.68], [-1.31, 0.0, FLOOR_M + 0.34], 0.0));
    work.add(slots.chrome, Shape::tube(&[0.59, -0.59].map(|y| vec3(-1.31, y, 1.0)), 0.014, 6));
    work.add(slots.chrome, Shape::tube(&[0.59, -0.59].map(|y| vec3(-1.31, y, 1.14)), 0.012, 6));
    // The bench over the engine, and behind it room for luggage.
    work.add(slots.paint, block([0.02, 1.2, 0.28], [-1.75, 0.0, 0.44], 0.0));
    work.add(slots.seat, block([0.5, 1.16, 0.12], [-1.97, 0.0, 0.63], 0.04));
    let back = Shape::rounded_block(vec3(0.1, 1.16, 0.52), 0.04).turned(glam::Quat::from_rotation_y(-0.14));
    work.add(slots.seat, back.moved(vec3(-2.24, 0.0, 0.92)));
    work.add(slots.trim, block([0.3, 1.2, 0.02], [-2.42, 0.0, 0.9], 0.0));
    // Bars close the side of the traffic: it is kept to the left.
    for z in [0.66, 0.9] {
        work.add(slots.chrome, Shape::tube(&[vec3(-1.3, -0.6, z), vec3(-1.68, -0.625, z)], 0.013, 6));
    }
    people(work);
}

fn people(work: &mut Workshop) {
    let khaki = Wardrobe::new(&mut work.model, &SHIRTS, &[]);
    let both = |at: Vec3| [1.0, -1.0].map(|side| at * vec3(1.0, side, 1.0));
    let driver = Pose {
        hips: vec3(-1.08, 0.0, 0.74),
        lean_rad: 0.02,
        ankles: both(vec3(-0.68, 0.25, FLOOR_M + 0.085)),
        toes_rad: [0.0; 2],
        wrists: both(BAR + vec3(-0.06, 0.25, 0.03)),
    };
    let shape = Figure::new(MAN, driver).dressed(&Outfit::CASUAL, &khaki);
    work.model.add_extra("driver", 1.0, true, shape);

    let clothes = Wardrobe::new(&mut work.model, &[], &[]);
    let passenger = |body: Physique, hair: Hair, y: f32| {
        let at = |x: f32, side: f32, z: f32| vec3(x, y + side, z);
        let pose = Pose {
            hips: at(-2.02, 0.0, 0.76),
            lean_rad: -0.1,
            ankles: [at(-1.6, 0.1, FLOOR_M + 0.08), at(-1.58, -0.1, FLOOR_M + 0.08)],
            toes_rad: [0.0; 2],
            wrists: [at(-1.72, 0.12, 0.89), at(-1.7, -0.12, 0.89)],
        };
        Figure::new(body, pose).dressed(&Outfit { hair, ..Outfit::CASUAL }, &clothes)
    };
    let woman = passenger(Physique { height_m: 1.56, ..Physique::WOMAN }, Hair::Tail, 0.28);
    let man = passenger(MAN, Hair::Short, -0.28);
    work.model.add_extra("passenger", 0.25, true, woman.clone().and(man.clone()));
    work.model.add_extra("passenger", 0.2, true, woman);
    work.model.add_extra("passenger", 0.2, true, man);
}
