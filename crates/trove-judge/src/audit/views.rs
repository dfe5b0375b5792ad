//! Cameras and LiDARs of one moment see one place.

use glam::DVec3;
use trove_format::ObjectOrigin;
use trove_model::Occlusion;

use super::finding::{Check, Count, Notes};
use super::flow::Looked;
use super::frame::{LabelledSweep, SAMPLES, around, extremes, is_porous, rigid, spread};

/// Share of points that another camera does not look through.
const NOT_LOOKED_THROUGH: f64 = 0.95;
/// Share of points seen at the same depth that are the same object.
const SAME: f64 = 0.95;
/// Share of LiDAR points that cameras do not look through, and that have the class of the pixel.
const LIDAR: f64 = 0.95;

/// What one camera sees is not transparent to another, and is the same there.
pub(super) fn check(a: &Looked, b: &Looked, notes: &mut Notes) {
    let (Some(eye), Some(other)) = (&a.eye, &b.eye) else { return };
    let (Some(depth), Some(instance), Some(class)) = (&a.frame.depth_m, &a.frame.instance, &a.frame.class) else {
        return;
    };
    let (Some(depth_b), Some(instance_b)) = (&b.frame.depth_m, &b.frame.instance) else { return };
    // A camera does not see the vehicle that carries it, which others may see.
    let of = [a.frame.table.carrier, b.frame.table.carrier];
    let carries = a.frame.ids(|object| object.origin == ObjectOrigin::Carrier || of.contains(&Some(object.id)));
    let (mut opaque, mut same) = (Count::default(), Count::default());
    for pixel in spread(depth.width, depth.height, SAMPLES) {
        let [x, y] = pixel;
        let (id, metres) = (*instance.at(x, y), *depth.at(x, y));
        if is_porous(*class.at(x, y)) || carries[usize::from(id)] || around(instance, pixel).any(|other| other != id) {
            continue;
        }
        let Some(point) = eye.point(pixel, metres) else { continue };
        let point_world = eye.world_from_camera.transform_point3(point);
        let Some((at, expected)) = other.sees(point_world) else { continue };
        let (least, most) = extremes(depth_b, at);
        opaque.tell(pixel, least < expected * 1.05 + 0.3);
        let within = 0.02 * expected;
        if least > expected - within && most < expected + within {
            same.tell(pixel, around(instance_b, at).any(|other| other == id));
        }
    }
    let place = &b.frame.place;
    notes.judge(Check::Views, &opaque, NOT_LOOKED_THROUGH, |share| {
        format!("expected surfaces that {place} does not look through, found {:.1} %", 100.0 * share)
    });
    notes.judge(Check::Views, &same, SAME, |share| {
        format!("expected the same objects as {place} at the same points, found {:.1} %", 100.0 * share)
    });
}

/// What a LiDAR of the moment met is where a camera sees it, as far as it stands still.
pub(super) fn lidar(sweep: &LabelledSweep, looked: &Looked, notes: &mut Notes) {
    let Some(eye) = &looked.eye else { return };
    let (Some(depth), Some(class)) = (&looked.frame.depth_m, &looked.frame.class) else { return };
    let world_from_lidar = match rigid(&sweep.table.world_from_lidar, "world_from_lidar") {
        Ok(pose) => pose,
        Err(what) => return notes.wrong(Check::Lidar, what),
    };
    let moves: Vec<u32> = (sweep.table.objects.iter())
        .filter(|object| object.origin != ObjectOrigin::Scenery)
        .map(|object| object.id)
        .collect();
    let (mut opaque, mut same) = (Count::default(), Count::default());
    let still = sweep.points.iter().filter(|p| moves.binary_search(&p.instance.0).is_err() && !is_porous(p.class));
    for point in still {
        let Some((at, expected)) = eye.sees(world_from_lidar.transform_point3(point.position_m)) else { continue };
        if is_at_rim(at, looked) {
            continue;
        }
        let (least, most) = extremes(depth, at);
        opaque.tell(at, least < expected * 1.05 + 0.3);
        let within = 0.02 * expected + 0.05;
        if least > expected - within && most < expected + within {
            same.tell(at, around(class, at).any(|class| class == point.class));
        }
    }
    let place = &sweep.place;
    notes.judge(Check::Lidar, &opaque, LIDAR, |share| {
        format!("expected points of {place} on surfaces that are seen, found {:.1} %", 100.0 * share)
    });
    notes.judge(Check::Lidar, &same, LIDAR, |share| {
        format!("expected the classes of {place}'s points, found {:.1} %", 100.0 * share)
    });
}

fn is_at_rim([x, y]: [u32; 2], looked: &Looked) -> bool {
    let table = &looked.frame.table;
    x == 0 || y == 0 || x + 1 >= table.width_px || y + 1 >= table.height_px
}

/// The points of a sweep lie within reach and count as its table says.
pub(super) fn sweep(sweep: &LabelledSweep, notes: &mut Notes) {
    notes.look(Check::Lidar);
    let told = sweep.table.points as usize;
    if told != sweep.points.len() {
        notes.wrong(Check::Lidar, format!("points: expected {} as in points.npy, found {told}", sweep.points.len()));
    }
    if sweep.points.iter().any(|point| !point.position_m.is_finite() || point.position_m == DVec3::ZERO) {
        notes.wrong(Check::Lidar, "points.npy: expected points away from the sensor, found others");
    }
    for object in &sweep.table.objects {
        let of_it = || sweep.points.iter().filter(|point| point.instance.0 == object.id);
        if of_it().count() != object.points as usize || of_it().any(|point| point.class != object.class) {
            let (name, told) = (object.class.row().name, object.points);
            notes.wrong(Check::Lidar, format!("object {}: expected {told} points of {name}, found others", object.id));
        }
    }
    if sweep.points.iter().any(|point| usize::from(point.ring) >= sweep.table.elevations_deg.len()) {
        notes.wrong(Check::Lidar, "points.npy: expected rings that sweep.json lists, found others");
    }
}

/// Flow is told as visible only where it is defined.
pub(super) fn occlusion(looked: &Looked, notes: &mut Notes) {
    for way in super::flow::WAYS {
        let (Some(flow), Some(occluded)) = (&looked.frame.flow[way], &looked.frame.occluded[way]) else { continue };
        notes.look(Check::Occlusion);
        let undefined = |[x, y]: [u32; 2]| *occluded.at(x, y) == Occlusion::Undefined;
        let wrong = flow.pixels().filter(|(pixel, flow)| flow[0].is_nan() != undefined(*pixel));
        let wrong: Vec<_> = wrong.map(|(pixel, _)| pixel).collect();
        if !wrong.is_empty() {
            let what =
                format!("expected occlusion wherever flow is defined, found otherwise on {} pixels", wrong.len());
            notes.found(Check::Occlusion, 1.0, what, wrong);
        }
    }
}
