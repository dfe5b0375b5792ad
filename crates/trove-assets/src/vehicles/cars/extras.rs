//! What is put on an ordinary car: signs, lights, liveries, loads.

use glam::{Vec2, Vec3, vec2, vec3};
use trove_model::Material;

use super::plan::{CarExtra, CarPlan, Checks, LightBar, Livery, Mount, Name};
use crate::shape::{Prism, Shape, rect};
use crate::vehicles::decal;
use crate::vehicles::workshop::Workshop;

/// Puts all that a plan names on its car.
pub(super) fn put_on(work: &mut Workshop, plan: &CarPlan) {
    for extra in &plan.extras {
        match extra {
            CarExtra::RoofBox => roof_box(work, plan),
            CarExtra::RoofSign(text) => roof_sign(work, plan, text),
            CarExtra::LoadDoors => load_doors(work, plan),
            CarExtra::LightBar(bar) => light_bar(work, plan, bar),
            CarExtra::Doors(livery) => doors(work, plan, livery),
            CarExtra::Band(livery) => band(work, plan, livery),
            CarExtra::Checks(rows) => checks(work, plan, rows),
            CarExtra::LoadName(name) => load_name(work, plan, name),
        }
    }
}

/// A lit sign on the roof.
fn roof_sign(work: &mut Workshop, plan: &CarPlan, text: &str) {
    let (s, z) = plan.profile.peak;
    let at = vec3(-s + 0.1, 0.0, z + 0.075);
    let sign = Shape::rounded_block(vec3(0.16, 0.6, 0.15), 0.03).moved(at);
    work.add(work.slots.plate, sign);
    work.add(work.slots.trim, Shape::block(vec3(0.12, 0.46, 0.04)).moved(at - Vec3::Z * 0.08));
    let size = vec2(0.5, 0.115);
    let name = format!("sign/{}", text.to_lowercase());
    let word = decal::word(&name, text, size, Vec3::splat(0.01), vec3(0.7, 0.5, 0.03));
    let word = work.model.slot(word, &[]);
    let front = decal::face(size, Vec3::X * 0.083);
    let back = front.clone().turned(glam::Quat::from_rotation_z(std::f32::consts::PI));
    work.add(word, front.and(back).moved(at));
}

/// A box for skis and luggage on the roof.
fn roof_box(work: &mut Workshop, plan: &CarPlan) {
    let (s, z) = plan.profile.peak;
    let shell = Shape::ellipsoid(vec3(1.05, 0.4, 0.26), 24);
    let flat = shell.bent(|p| {
        // A flat floor, sides like a boat's.
        let square = |v: f32, half: f32| half * (v / half).abs().powf(0.6) * v.signum();
        vec3(p.x, square(p.y, 0.4), if p.z < 0.0 { p.z * 0.35 } else { square(p.z, 0.26) })
    });
    let at = vec3(-s - 0.1, 0.0, z + 0.15);
    work.add(work.slots.trim, flat.moved(at));
    for x in [0.45, -0.45] {
        let wide = plan.half_m() * 1.15;
        work.add(
            work.slots.chrome,
            Shape::rounded_block(vec3(0.05, wide, 0.03), 0.012).moved(at + vec3(x, 0.0, -0.085)),
        );
    }
}

/// The doors in another paint.
fn doors(work: &mut Workshop, plan: &CarPlan, livery: &Livery) {
    let color = Vec3::from_array(livery.color);
    let paint = Material { coat: 1.0, ..Material::plain(&livery.paint, color, 0.4) };
    let painted = work.model.slot(paint, &[]);
    let p = &plan.profile;
    let [front, back] = plan.axles_m;
    let doors = rect(-back + 0.42, -front - 0.47, p.clearance_m + 0.06, p.belt_m[0] + 0.1);
    work.model.mark_both(&Prism::side(&doors, 0.55..=2.0), work.slots.paint, painted);
    let at = [vec2(-back + 0.7, p.belt_m[0] - 0.36), vec2(-front - 0.62, p.belt_m[0] - 0.16)];
    word(work, painted, at, &livery.text, livery.ink, livery.color);
}

/// A reflecting band along the sides.
fn band(work: &mut Workshop, plan: &CarPlan, livery: &Livery) {
    let p = &plan.profile;
    let painted = sheeting(work, &livery.paint, livery.color);
    let middle = p.clearance_m + (p.belt_m[0] - p.clearance_m) * 0.66;
    let band = [
        vec2(-p.length_m + 0.25, middle - 0.06),
        vec2(-0.5, middle - 0.12),
        vec2(-0.5, middle + 0.06),
        vec2(-p.length_m + 0.25, middle + 0.16),
    ];
    work.model.mark_both(&Prism::side(&band, 0.6..=2.0), work.slots.paint, painted);
    let doors = [vec2(-plan.axles_m[1] + 0.5, middle - 0.09), vec2(-plan.axles_m[0] - 0.7, middle + 0.1)];
    word(work, painted, doors, &livery.text, livery.ink, livery.color);
}

/// Two rows of checks from the front wheels to the tail.
fn checks(work: &mut Workshop, plan: &CarPlan, &Checks { colors, row_m }: &Checks) {
    let p = &plan.profile;
    let ground = sheeting(work, "reflective yellow", colors[0]);
    let other = sheeting(work, "reflective check", colors[1]);
    let low = p.clearance_m + (p.belt_m[0] - p.clearance_m) * 0.36;
    let whole = rect(-p.length_m + 0.12, -0.45, low, low + 2.0 * row_m);
    work.model.mark_both(&Prism::side(&whole, 0.5..=2.0), work.slots.paint, ground);
    let wide = 2.0 * row_m;
    for k in 0..(p.length_m / wide) as usize {
        let corner = vec2(-0.45 - wide * (k + 1) as f32, low + if k % 2 == 0 { 0.0 } else { row_m });
        let check = rect(corner.x, corner.x + wide, corner.y, corner.y + row_m);
        work.model.mark_both(&Prism::side(&check, 0.5..=2.0), ground, other);
    }
}

/// Windows and seams of the doors behind and of a sliding door.
fn load_doors(work: &mut Workshop, plan: &CarPlan) {
    let p = &plan.profile;
    let (low, high) = (p.belt_m[1] + 0.12, (p.rear_header.1 - 0.3).min(p.belt_m[1] + 0.7));
    let back = |polygon: &[Vec2]| Prism::front(polygon, -p.length_m - 0.1..=-p.length_m + 0.4);
    for (margin, slot) in [(0.0, work.slots.trim), (0.025, work.slots.privacy)] {
        let pane = rect(0.06 + margin, 0.6 - margin, low + margin, high - margin);
        work.model.mark_both(&back(&pane), work.slots.paint, slot);
        work.model.mark_both(&back(&pane), work.slots.trim, slot);
    }
    let middle = rect(-0.006, 0.006, p.clearance_m + 0.2, p.rear_header.1 - 0.1);
    work.model.mark(&back(&middle), work.slots.paint, work.slots.seam);
    let (front, rear) = (-plan.blind_from_m - 0.06, -plan.blind_from_m - 1.3);
    let (foot, head) = (p.clearance_m + 0.12, p.rear_header.1 - 0.22);
    let rail = p.belt_m[1] - 0.06;
    for line in [
        rect(rear, rear + 0.009, foot, head),
        rect(front, front + 0.009, foot, head),
        rect(rear, front, head, head + 0.009),
        rect(-p.length_m + 0.25, rear, rail, rail + 0.03),
    ] {
        work.model.mark_both(&Prism::side(&line, 0.5..=2.0), work.slots.paint, work.slots.seam);
    }
}

/// A word where a van's load is.
fn load_name(work: &mut Workshop, plan: &CarPlan, name: &Name) {
    let p = &plan.profile;
    let z = p.belt_m[1] + (p.rear_header.1 - p.belt_m[1]) * 0.42;
    let at = [vec2(-p.length_m + 0.5, z - 0.14), vec2(-plan.blind_from_m - 0.35, z + 0.14)];
    word(work, work.slots.paint, at, &name.text, name.ink, name.color);
}

/// A word on both sides, on what is in a slot there.
fn word(work: &mut Workshop, on: u16, at: [Vec2; 2], text: &str, ink: [f32; 3], ground: [f32; 3]) {
    let name = format!("livery/{}", text.to_lowercase());
    let word = decal::word(&name, text, at[1] - at[0], Vec3::from_array(ink), Vec3::from_array(ground));
    let slot = work.model.slot(word, &[]);
    for is_left in [true, false] {
        let lettered = decal::on_skin(work.model.shape(), on, at, is_left);
        work.add(slot, lettered);
    }
}

fn sheeting(work: &mut Workshop, name: &str, color: [f32; 3]) -> u16 {
    work.model.slot(Material { dirt: 0.3, ..Material::plain(name, Vec3::from_array(color), 0.35) }, &[])
}

fn light_bar(work: &mut Workshop, plan: &CarPlan, &LightBar { on, width_m }: &LightBar) {
    let p = &plan.profile;
    let (s, z) = match on {
        Mount::Roof => p.peak,
        Mount::Front => (p.header.0 + 0.3, p.header.1 + 0.03),
        Mount::Rear => (p.length_m - 0.45, p.rear_header.1),
    };
    let lens = |name: &str, color: Vec3| Material { coat: 1.0, ..Material::plain(name, color, 0.2) };
    let blue = work.model.slot(lens("blue light", vec3(0.01, 0.06, 0.6)), &[]);
    let place = vec3(-s, 0.0, z + 0.065);
    work.add(work.slots.trim, Shape::rounded_block(vec3(0.24, width_m, 0.04), 0.015).moved(place - Vec3::Z * 0.05));
    let cell = |wide: f32| Shape::rounded_block(vec3(0.27, wide, 0.085), 0.035);
    for side in [1.0, -1.0] {
        let y = |share: f32| Vec3::Y * side * width_m * share;
        work.add(blue, cell(width_m * 0.2).moved(place + y(0.4)));
        work.add(blue, cell(width_m * 0.14).moved(place + y(0.22)));
        work.add(if side > 0.0 { work.slots.red } else { blue }, cell(width_m * 0.1).moved(place + y(0.095)));
    }
    work.add(work.slots.trim, cell(width_m * 0.08).moved(place));
}
