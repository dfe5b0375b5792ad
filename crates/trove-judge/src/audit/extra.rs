//! Files that only some recipes ask for, held to those that say the same in another way.

use glam::{DVec3, Vec3};
use trove_model::{Class, Kind, Role};

use super::finding::{Check, Count, Notes};
use super::flow::{Looked, WAYS};
use super::frame::{Eye, LabelledFrame, SAMPLES, known, pixels, rigid};

/// Share of pixels that have to agree.
const AGREE: f64 = 0.999;

/// Makes the checks of those files that are there.
pub(super) fn check(looked: &Looked, notes: &mut Notes) {
    let frame = looked.frame;
    panoptic(frame, notes);
    parts(frame, notes);
    scene_flow(looked, notes);
    let Some(eye) = &looked.eye else { return };
    range(frame, eye, notes);
    normals(frame, eye, notes);
    coordinates(frame, eye, notes);
}

fn panoptic(frame: &LabelledFrame, notes: &mut Notes) {
    let (Some(panoptic), Some(class), Some(instance)) = (&frame.panoptic, &frame.class, &frame.instance) else {
        return;
    };
    notes.look(Check::Panoptic);
    let expected =
        class.data.iter().zip(&instance.data).map(|(class, id)| u32::from(class.id()) << 16 | u32::from(*id));
    let wrong = pixels(panoptic).zip(expected).filter(|((_, found), expected)| *found != expected);
    let wrong: Vec<_> = wrong.map(|((pixel, _), _)| pixel).collect();
    if !wrong.is_empty() {
        let what =
            format!("panoptic.png: expected class.png and instance.png in one, found others on {} pixels", wrong.len());
        notes.found(Check::Panoptic, 1.0, what, wrong);
    }
}

/// Riders are on ridden cycles, boards at houses, kerbs and yards beside roads.
fn parts(frame: &LabelledFrame, notes: &mut Notes) {
    let (Some(part), Some(class)) = (&frame.part, &frame.class) else { return };
    notes.look(Check::Classes);
    let cycles = frame.ids(|object| object.kind == Kind::BicycleWithRider);
    let motorcycles = frame.ids(|object| object.kind == Kind::MotorcycleWithRider);
    let is_of = |ids: &[bool], x, y| frame.instance.as_ref().is_none_or(|ids_of| ids[usize::from(*ids_of.at(x, y))]);
    let fits = |[x, y]: [u32; 2], part: Role| match part {
        Role::Cyclist => is_of(&cycles, x, y) && *class.at(x, y) == Class::CycleRider,
        Role::Motorcyclist => is_of(&motorcycles, x, y) && *class.at(x, y) == Class::MotorcycleRider,
        Role::Ridden => is_of(&cycles, x, y) || is_of(&motorcycles, x, y),
        Role::ShopSign | Role::Awning => *class.at(x, y) == Class::Building,
        Role::Kerb => *class.at(x, y) == Class::Sidewalk,
        Role::Unpaved => matches!(class.at(x, y), Class::Sidewalk | Class::Ground),
        Role::Paved | Role::CarPark => *class.at(x, y) == Class::Ground,
        // Lamps, and what names are written on, are of many things.
        _ => true,
    };
    let wrong = pixels(part).filter(|(pixel, part)| part.is_some_and(|part| !fits(*pixel, part)));
    let wrong: Vec<_> = wrong.map(|(pixel, _)| pixel).collect();
    if !wrong.is_empty() {
        let what = format!("part.png: expected parts where what has them is, found others on {} pixels", wrong.len());
        notes.found(Check::Classes, 1.0, what, wrong);
    }
}

fn range(frame: &LabelledFrame, eye: &Eye, notes: &mut Notes) {
    let (Some(range), Some(depth)) = (&frame.range_m, &frame.depth_m) else { return };
    let mut count = Count::default();
    for (pixel, range_m) in known(range, SAMPLES) {
        let (range_m, depth_m) = (f64::from(*range_m), *depth.at(pixel[0], pixel[1]));
        let expected = eye.point(pixel, depth_m).map(DVec3::length);
        let Some(expected) = expected.or((depth_m == f32::INFINITY).then_some(f64::INFINITY)) else { continue };
        count.tell(pixel, range_m == expected || (range_m - expected).abs() < 1e-4 * expected);
    }
    notes.judge(Check::Depth, &count, AGREE, |share| {
        format!("range.exr: expected depth.exr along the rays, found it on {:.1} %", 100.0 * share)
    });
}

fn normals(frame: &LabelledFrame, eye: &Eye, notes: &mut Notes) {
    let (Some(world), Some(camera)) = (&frame.normal_world, &frame.normal) else { return };
    let vector = |vector: &[f32; 3]| Vec3::from_array(*vector).as_dvec3();
    let mut count = Count::default();
    for (pixel, world) in known(world, SAMPLES) {
        let Some(camera) = camera.at(pixel[0], pixel[1]) else { continue };
        let expected = eye.world_from_camera.transform_vector3(vector(camera));
        count.tell(pixel, expected.distance(vector(world)) < 1e-3);
    }
    notes.judge(Check::Normals, &count, AGREE, |share| {
        format!("normal_world.exr: expected normal.exr in World, found it on {:.1} %", 100.0 * share)
    });
}

/// Points in boxes lead back to where depth tells that they are.
fn coordinates(frame: &LabelledFrame, eye: &Eye, notes: &mut Notes) {
    let (Some(coordinates), Some(depth), Some(instance)) = (&frame.object_coordinates, &frame.depth_m, &frame.instance)
    else {
        return;
    };
    let mut boxes = vec![None; usize::from(u16::MAX) + 1];
    for object in &frame.table.objects {
        let pose = rigid(&object.world_from_body, "world_from_body").ok();
        if let (Some(slot), Some(pose)) = (boxes.get_mut(object.id as usize), pose) {
            *slot = Some((pose, DVec3::from_array(object.size_m)));
        }
    }
    let mut count = Count::default();
    for (pixel, found) in known(coordinates, SAMPLES) {
        let ([x, y], found) = (pixel, Vec3::from_array(*found).as_dvec3());
        let Some((world_from_body, size)) = boxes[usize::from(*instance.at(x, y))] else { continue };
        let Some(point) = eye.point(pixel, *depth.at(x, y)).filter(|_| !found.is_nan()) else { continue };
        let told = world_from_body.transform_point3((found - 0.5) * size);
        let apart = told.distance(eye.world_from_camera.transform_point3(point));
        count.tell(pixel, apart < 0.01 + 1e-4 * point.length());
    }
    notes.judge(Check::Boxes, &count, AGREE, |share| {
        format!("object_coordinates.exr: expected depth.exr's points, found {:.1} %", 100.0 * share)
    });
}

/// What stands still does not move in World.
fn scene_flow(looked: &Looked, notes: &mut Notes) {
    let Some(instance) = &looked.frame.instance else { return };
    for way in WAYS {
        let Some(flow) = &looked.frame.scene_flow[way] else { continue };
        let mut count = Count::default();
        for (pixel, moved) in known(flow, SAMPLES) {
            let moved = Vec3::from_array(*moved);
            if looked.still[usize::from(*instance.at(pixel[0], pixel[1]))] && !moved.is_nan() {
                count.tell(pixel, moved.length() < 1e-3);
            }
        }
        let name = ["scene_flow_forward.exr", "scene_flow_backward.exr"][way];
        notes.judge(Check::Flow, &count, AGREE, |share| {
            format!("{name}: expected 0 of what stands still, found it on {:.1} %", 100.0 * share)
        });
    }
}
