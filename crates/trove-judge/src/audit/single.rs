//! What one frame's files say of each other.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};
use trove_format::{ObjectOrigin, ObjectRow};
use trove_model::{CLASSES, Class, InPatches, Raster};

use super::finding::{Check, Count, Notes};
use super::frame::{Eye, LabelledFrame, SAMPLES, around, known, pixels, rigid};

/// Makes every check that needs no other frame.
pub(super) fn check(frame: &LabelledFrame, eye: Option<&Eye>, notes: &mut Notes) {
    notes.look(Check::Files);
    frame.damage.iter().for_each(|damage| notes.wrong(Check::Files, damage));
    if let Some(image) = &frame.rgb {
        super::image::check(image, frame.class.as_ref(), notes);
    }
    if let Some(instance) = &frame.instance {
        ids(frame, instance, notes);
        masks(frame, instance, notes);
    }
    if let (Some(class), Some(instance)) = (&frame.class, &frame.instance) {
        classes(frame, class, instance, notes);
    }
    if let Some(depth) = &frame.depth_m {
        sky(frame, depth, eye, notes);
    }
    let Some(eye) = eye else { return };
    if let Some(normal) = &frame.normal {
        normals(frame, normal, eye, notes);
    }
    if let (Some(depth), Some(instance)) = (&frame.depth_m, &frame.instance) {
        boxes(frame, depth, instance, eye, notes);
    }
    keypoints(frame, eye, notes);
}

fn ids(frame: &LabelledFrame, instance: &Raster<u16>, notes: &mut Notes) {
    notes.look(Check::Ids);
    let ids: Vec<u32> = frame.table.objects.iter().map(|object| object.id).collect();
    if !ids.is_sorted_by(|a, b| a < b) || ids.first() == Some(&0) {
        notes.wrong(Check::Ids, "frame.json: expected ids from 1, each once and in their order, found others");
    }
    let mut listed = vec![false; usize::from(u16::MAX) + 1];
    listed[0] = true;
    for id in &ids {
        if let Some(listed) = listed.get_mut(*id as usize) {
            *listed = true;
        }
    }
    let mut strange = BTreeMap::<u16, Vec<[u32; 2]>>::new();
    for (pixel, id) in pixels(instance) {
        if !listed[usize::from(*id)] {
            strange.entry(*id).or_default().push(pixel);
        }
    }
    for (id, pixels) in strange {
        let what = format!("instance.png: {} pixels of object {id}, which frame.json does not list", pixels.len());
        notes.found(Check::Ids, 1.0, what, pixels);
    }
}

fn classes(frame: &LabelledFrame, class: &Raster<Class>, instance: &Raster<u16>, notes: &mut Notes) {
    notes.look(Check::Classes);
    let mut of_id: Vec<Option<Class>> = vec![None; usize::from(u16::MAX) + 1];
    for object in &frame.table.objects {
        if object.class.id() != object.class_id {
            let what = format!("object {}: class {:?} has not the id {}", object.id, object.class, object.class_id);
            notes.wrong(Check::Classes, what);
        }
        if let Some(slot) = of_id.get_mut(object.id as usize) {
            *slot = Some(object.class);
        }
    }
    let mut wrong = BTreeMap::<(u16, Class), Vec<[u32; 2]>>::new();
    for ((pixel, class), id) in pixels(class).zip(&instance.data) {
        // Ids that are not listed are another check's.
        let is_right = match (*id, of_id[usize::from(*id)]) {
            (0, _) => !class.row().thing,
            (_, expected) => expected.is_none_or(|expected| expected == *class),
        };
        if !is_right {
            wrong.entry((*id, *class)).or_default().push(pixel);
        }
    }
    for ((id, class), pixels) in wrong {
        let (name, count) = (CLASSES[usize::from(class.id())].name, pixels.len());
        let what = match of_id[usize::from(id)].filter(|_| id > 0) {
            Some(expected) => {
                format!("class.png: expected {} on object {id}, found {name} on {count} pixels", expected.row().name)
            }
            None => format!("instance.png: expected an object on {count} pixels of {name}, found none"),
        };
        notes.found(Check::Classes, 1.0, what, pixels);
    }
}

/// The pixels of an id: how many, and the box around them.
#[derive(Clone, Copy)]
struct Extent {
    count: u32,
    around: [u32; 4],
}

fn extents(instance: &Raster<u16>) -> BTreeMap<u32, Extent> {
    let mut extents = BTreeMap::<u32, Extent>::new();
    // Runs of one id in a row are many pixels long.
    for (y, row) in (0..).zip(instance.data.chunks(instance.width.max(1) as usize)) {
        let mut x = 0;
        for run in row.chunk_by(|a, b| a == b) {
            let (first, last) = (x, x + run.len() as u32 - 1);
            x = last + 1;
            if run[0] == 0 {
                continue;
            }
            let start = Extent { count: 0, around: [first, y, last, y] };
            let extent = extents.entry(u32::from(run[0])).or_insert(start);
            extent.count += run.len() as u32;
            let [x0, y0, x1, y1] = extent.around;
            extent.around = [x0.min(first), y0, x1.max(last), y1.max(y)];
        }
    }
    extents
}

fn masks(frame: &LabelledFrame, instance: &Raster<u16>, notes: &mut Notes) {
    notes.look(Check::Masks);
    let extents = extents(instance);
    for object in &frame.table.objects {
        let seen = extents.get(&object.id);
        let (count, around) = (seen.map_or(0, |seen| seen.count), seen.map(|seen| seen.around));
        let what = |field: &str, expected: String, found: String| {
            format!("object {}: {field}: expected {expected}, found {found}", object.id)
        };
        if object.visible_px != count {
            let told = object.visible_px.to_string();
            notes.wrong(Check::Masks, what("visible_px", format!("{count} as in instance.png"), told));
        }
        if object.visible_box != around {
            let told = format!("{:?}", object.visible_box);
            notes.wrong(Check::Masks, what("visible_box", format!("{around:?} as in instance.png"), told));
        }
        let holds = |[x0, y0, x1, y1]: [u32; 4], inner: [u32; 4]| {
            x0 <= inner[0] && y0 <= inner[1] && x1 >= inner[2] && y1 >= inner[3]
        };
        let is_held = match (object.visible_box, object.amodal_box) {
            (Some(visible), Some(amodal)) => holds(amodal, visible),
            (visible, _) => visible.is_none(),
        };
        if !is_held || object.amodal_px < object.visible_px {
            let found = format!("{:?} with {} pixels", object.amodal_box, object.amodal_px);
            notes.wrong(Check::Masks, what("amodal_box and amodal_px", "at least what is visible".into(), found));
        }
        let hidden = 1.0 - f64::from(object.visible_px) / f64::from(object.amodal_px.max(1));
        if (f64::from(object.occlusion) - hidden).abs() > 1e-4 || !(0.0..=1.0).contains(&object.truncation) {
            let found = format!("{} and {}", object.occlusion, object.truncation);
            notes.wrong(Check::Masks, what("occlusion and truncation", format!("{hidden:.4} and a share"), found));
        }
    }
}

fn sky(frame: &LabelledFrame, depth: &Raster<f32>, eye: Option<&Eye>, notes: &mut Notes) {
    notes.look(Check::Depth);
    let sees_behind = eye.is_none_or(|eye| eye.lens.distortion.sees_behind());
    let impossible = |depth: f32| depth.is_nan() || depth == f32::NEG_INFINITY || !(sees_behind || depth > 0.0);
    let wrong: Vec<_> = pixels(depth).filter(|(_, depth)| impossible(**depth)).map(|(pixel, _)| pixel).collect();
    if let Some([x, y]) = wrong.first().copied() {
        let (found, count) = (depth.at(x, y), wrong.len());
        let what = format!("depth.exr: expected positive metres or +inf, found {found} on {count} pixels");
        notes.found(Check::Depth, 1.0, what, wrong);
    }
    let Some(class) = &frame.class else { return };
    let is_right = |class: Class, depth: f32| match class {
        Class::Sky => depth == f32::INFINITY,
        // Outside a lens's circle there is nothing; wires are void too.
        Class::Void => true,
        _ => depth.is_finite(),
    };
    let wrong = pixels(class).zip(&depth.data).filter(|((_, class), depth)| !is_right(**class, **depth));
    let wrong: Vec<_> = wrong.map(|((pixel, _), _)| pixel).collect();
    if !wrong.is_empty() {
        let what = format!("depth.exr: expected +inf in the sky alone, found otherwise on {} pixels", wrong.len());
        notes.found(Check::Depth, 1.0, what, wrong);
    }
}

/// Share of pixels whose normal faces the camera.
const FACING: f64 = 0.999;
/// Share of pixels on smooth surfaces whose normal is that of depth within 20°.
const SMOOTH: f64 = 0.9;

fn normals(frame: &LabelledFrame, normal: &InPatches<[f32; 3]>, eye: &Eye, notes: &mut Notes) {
    notes.look(Check::Normals);
    let vector = |n: &[f32; 3]| glam::Vec3::from_array(*n).as_dvec3();
    let is_unit = |n: &[f32; 3]| {
        let length = glam::Vec3::from_array(*n).length();
        length == 0.0 || (length - 1.0).abs() < 1e-3
    };
    let wrong: Vec<_> = normal.pixels().filter(|(_, n)| !is_unit(n)).map(|(pixel, _)| pixel).collect();
    if !wrong.is_empty() {
        let what = format!("normal.exr: expected unit vectors or 0, found others on {} pixels", wrong.len());
        notes.found(Check::Normals, 1.0, what, wrong);
    }
    let mut facing = Count::default();
    for (pixel, n) in known(normal, SAMPLES) {
        let (n, Some(direction)) = (vector(n), eye.direction(pixel)) else { continue };
        if n != DVec3::ZERO {
            facing.tell(pixel, n.dot(direction) < 0.01);
        }
    }
    notes.judge(Check::Normals, &facing, FACING, |share| {
        format!("normal.exr: expected surfaces to face the camera, found {:.1} % that do", 100.0 * share)
    });
    let (Some(depth), Some(instance)) = (&frame.depth_m, &frame.instance) else { return };
    let mut smooth = Count::default();
    for (pixel, n) in known(normal, SAMPLES) {
        let Some(surface) = surface(depth, instance, eye, pixel) else { continue };
        let n = vector(n);
        if n != DVec3::ZERO {
            smooth.tell(pixel, n.dot(surface) > 20f64.to_radians().cos());
        }
    }
    notes.judge(Check::Surfaces, &smooth, SMOOTH, |share| {
        let percent = 100.0 * share;
        format!("normal.exr: expected the normals of depth.exr's surfaces, found {percent:.1} % within 20°")
    });
}

/// The normal of the surface that depth tells around a pixel, in Camera; `None` where it is not one smooth surface seen
/// from the front.
fn surface(depth: &Raster<f32>, instance: &Raster<u16>, eye: &Eye, [x, y]: [u32; 2]) -> Option<DVec3> {
    let cross = [[x, y], [x - 1, y], [x + 1, y], [x, y - 1], [x, y + 1]];
    let id = instance.at(x, y);
    if cross.iter().any(|[x, y]| instance.at(*x, *y) != id) {
        return None;
    }
    let [middle, left, right, above, below] = cross.map(|[x, y]| f64::from(*depth.at(x, y)));
    // Inverse depth is linear in the image of a plane.
    let bends = |a: f64, b: f64| (1.0 / a + 1.0 / b - 2.0 / middle).abs() * middle > 2e-4;
    if bends(left, right) || bends(above, below) {
        return None;
    }
    let point = |i: usize| eye.point(cross[i], *depth.at(cross[i][0], cross[i][1]));
    let normal = (point(2)? - point(1)?).cross(point(3)? - point(4)?).normalize();
    let towards = -point(0)?.normalize();
    (normal.dot(towards) > 0.2).then_some(normal)
}

/// Share of an object's visible points that lie in its box.
const WITHIN: f64 = 0.9;
/// Mirrors, arms and loads stand out of boxes, metres.
const OUT_M: f64 = 0.4;

fn boxes(frame: &LabelledFrame, depth: &Raster<f32>, instance: &Raster<u16>, eye: &Eye, notes: &mut Notes) {
    notes.look(Check::Boxes);
    let is_boxed = |object: &&ObjectRow| object.origin != ObjectOrigin::Scenery && object.visible_box.is_some();
    for object in frame.table.objects.iter().filter(is_boxed) {
        let body_from_world = match rigid(&object.world_from_body, "world_from_body") {
            Ok(world_from_body) => world_from_body.inverse(),
            Err(what) => {
                notes.wrong(Check::Boxes, format!("object {}: {what}", object.id));
                continue;
            }
        };
        let body_from_camera = body_from_world * eye.world_from_camera;
        let half = DVec3::from_array(object.size_m) * 0.5 + DVec3::splat(OUT_M);
        let mut within = Count::default();
        let [x0, y0, x1, y1] = object.visible_box.unwrap_or_default();
        let pixels = (y0..=y1).flat_map(|y| (x0..=x1).map(move |x| [x, y]));
        let is_inside = |[x, y]: &[u32; 2]| *x < depth.width && *y < depth.height;
        for pixel in pixels.filter(is_inside).filter(|[x, y]| u32::from(*instance.at(*x, *y)) == object.id) {
            let Some(point) = eye.point(pixel, *depth.at(pixel[0], pixel[1])) else { continue };
            within.tell(pixel, body_from_camera.transform_point3(point).abs().cmple(half).all());
        }
        notes.judge(Check::Boxes, &within, WITHIN, |share| {
            format!("object {}: expected what is seen in its 3D box, found {:.1} % there", object.id, 100.0 * share)
        });
        let range_m = eye.camera_from_world.transform_point3(position(object)).length();
        if (range_m - f64::from(object.range_m)).abs() > 0.01 * range_m.max(1.0) {
            let found = object.range_m;
            notes.wrong(Check::Boxes, format!("object {}: range_m: expected {range_m:.2}, found {found}", object.id));
        }
    }
}

/// The centre of an object's box in World.
pub(super) fn position(object: &ObjectRow) -> DVec3 {
    let [x, y, z, _] = object.world_from_body;
    DVec3::new(x[3], y[3], z[3])
}

/// People of fewer pixels are too small for their points to be told from what is beside them.
const TELLING_PX: u32 = 500;
const SEEN_PX: u32 = 16;

fn keypoints(frame: &LabelledFrame, eye: &Eye, notes: &mut Notes) {
    for object in &frame.table.objects {
        let (Some(pixels), Some(world)) = (&object.keypoints, &object.keypoints_world_m) else { continue };
        notes.look(Check::Keypoints);
        for (i, ([x, y, seen], point)) in pixels.iter().zip(world).enumerate() {
            let point = eye.camera_from_world.transform_point3(DVec3::from_array(*point));
            let expected = eye.lens.project(point).filter(|pixel| eye.lens.contains(*pixel));
            let is_right = match (*seen > 0.0, expected) {
                (true, Some(expected)) => expected.distance(DVec2::new(*x, *y)) < 0.5,
                (false, None) => true,
                // On the rim either is right.
                (told, Some(p)) => !told && !inset(frame, p),
                (true, None) => !inset(frame, DVec2::new(*x, *y)),
            };
            if !is_right {
                let what = format!("object {}: keypoint {i}: expected {expected:?}, found ({x:.2}, {y:.2})", object.id);
                notes.wrong(Check::Keypoints, what);
            }
        }
        let (Some([x0, y0, x1, y1]), Some(instance)) = (object.amodal_box, &frame.instance) else { continue };
        let wide = f64::from((x1 - x0).max(y1 - y0)) * 0.25 + 4.0;
        let near = |[x, y, _]: &&[f64; 3]| {
            let (within_x, within_y) =
                (f64::from(x0) - wide..f64::from(x1) + wide, f64::from(y0) - wide..f64::from(y1) + wide);
            within_x.contains(x) && within_y.contains(y)
        };
        let visible: Vec<&[f64; 3]> = pixels.iter().filter(|[_, _, seen]| *seen == 2.0).collect();
        // What is seen of people far away may be their umbrella alone.
        let far = visible.iter().find(|point| !near(point)).filter(|_| object.amodal_px >= SEEN_PX);
        if let Some([x, y, _]) = far {
            let what = format!("object {}: a keypoint at ({x:.1}, {y:.1}) is far from it", object.id);
            notes.wrong(Check::Keypoints, what);
        }
        // Joints lie inside the silhouette; those of the face and of thin limbs may lie a pixel beside it, as may most of
        // those of people who are a few pixels high.
        if object.visible_px < TELLING_PX {
            continue;
        }
        let mut on = Count::default();
        for [x, y, _] in visible.into_iter().filter(near_in(instance)) {
            let pixel = [*x as u32, *y as u32];
            on.tell(pixel, around(instance, pixel).any(|id| u32::from(id) == object.id));
        }
        if on.all > 2 && on.share() < 0.6 {
            let what =
                format!("object {}: expected visible keypoints on it, found {:.0} %", object.id, 100.0 * on.share());
            notes.wrong(Check::Keypoints, what);
        }
    }
}

fn near_in(instance: &Raster<u16>) -> impl Fn(&&[f64; 3]) -> bool + '_ {
    |[x, y, _]| *x >= 0.0 && *y >= 0.0 && *x < f64::from(instance.width) && *y < f64::from(instance.height)
}

/// Whether a position is half a pixel or more inside the image.
fn inset(frame: &LabelledFrame, p: DVec2) -> bool {
    let (width, height) = (f64::from(frame.table.width_px), f64::from(frame.table.height_px));
    p.x > 0.5 && p.y > 0.5 && p.x < width - 0.5 && p.y < height - 0.5
}
