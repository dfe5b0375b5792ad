//! What flow says, held to depth, the cameras' poses and the neighbouring moment's labels.

use glam::{DVec2, DVec3};
use trove_model::{Occlusion, Raster};

use super::finding::{Check, Count, Notes};
use super::frame::{DENSE, Eye, LabelledFrame, SAMPLES, around, extremes, is_porous, known, rigid};

/// A frame with its camera, and which ids stand still.
pub(super) struct Looked<'a> {
    pub(super) frame: &'a LabelledFrame,
    pub(super) eye: Option<Eye>,
    pub(super) still: Vec<bool>,
}

impl<'a> Looked<'a> {
    pub(super) fn at(frame: &'a LabelledFrame) -> Self {
        Self { frame, eye: frame.eye().ok(), still: frame.stands_still() }
    }
}

/// The two ways of flow: to the next moment, and to the previous one.
pub(super) const WAYS: [usize; 2] = [0, 1];
const NAMES: [[&str; 2]; 2] =
    [["flow_forward.exr", "occluded_forward.png"], ["flow_backward.exr", "occluded_backward.png"]];

/// Flow of what stands still may differ from its projection by this, pixels: rounding of depth and flow.
const STATIC_PX: f64 = 0.1;
const STATIC: f64 = 0.99;
/// Share of an object's pixels, and of all, whose flow ends on the same.
const ENDS: [f64; 2] = [0.5, 0.97];
/// Share of what stands still that is seen at its depth at the end of its flow.
const AT_DEPTH: f64 = 0.97;
/// Forward and backward may differ by this, pixels: flow is interpolated between pixels, and not linear.
const RETURNS_PX: f64 = 1.0;
const RETURNS: f64 = 0.95;
/// Share of hidden ends that something nearer hides, as far as an image tells.
const HIDDEN: f64 = 0.6;
/// What is as near as this share of the distance hides what is behind.
const NEARER: f64 = 0.997;
/// The same where nothing is known of how the surface slopes within a pixel, as a road does.
const FACING_NEARER: f64 = 0.97;
/// Normals of one face, as a cosine.
const SAME_FACE: f64 = 0.9;
/// What is told as hidden is judged from this part of what is told as visible on.
const MUCH: usize = 50;

/// Holds flow of what stands still to depth and the two cameras' poses; needs no other frame.
pub(super) fn of_still(looked: &Looked, notes: &mut Notes) {
    let Looked { frame, eye: Some(eye), still } = looked else { return };
    let (Some(depth), Some(instance)) = (&frame.depth_m, &frame.instance) else { return };
    let to = [&frame.table.world_from_camera_next, &frame.table.world_from_camera_previous];
    for way in WAYS {
        let Some(flow) = &frame.flow[way] else { continue };
        let Some(matrix) = to[way] else {
            notes.look(Check::Flow);
            let defined = flow.pixels().filter(|(_, flow)| !flow[0].is_nan());
            let defined: Vec<_> = defined.map(|(pixel, _)| pixel).collect();
            if !defined.is_empty() {
                let what = format!("{}: expected NaN without a neighbouring moment, found numbers", NAMES[way][0]);
                notes.found(Check::Flow, 1.0, what, defined);
            }
            continue;
        };
        let other = match rigid(matrix, "the neighbouring camera's pose") {
            Ok(world_from_camera) => world_from_camera.inverse() * eye.world_from_camera,
            Err(what) => {
                notes.wrong(Check::Camera, what);
                continue;
            }
        };
        let mut count = Count::default();
        for (pixel, flow) in known(flow, SAMPLES) {
            let ([x, y], metres) = (pixel, *depth.at(pixel[0], pixel[1]));
            if !still[usize::from(*instance.at(x, y))] {
                continue;
            }
            let Some(direction) = eye.direction(pixel) else { continue };
            // The sky is a point at infinity: only rotation moves it.
            let moved = if metres.is_finite() {
                other.transform_point3(direction * (f64::from(metres) / direction.z))
            } else {
                other.transform_vector3(direction)
            };
            let Some(expected) = moved_to(eye, moved) else { continue };
            let start = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
            let end = start + DVec2::new(f64::from(flow[0]), f64::from(flow[1]));
            // Far outside of the image rounding is magnified as distances are.
            let slack = STATIC_PX + 1e-4 * (expected - start).length();
            count.tell(pixel, expected.distance(end) < slack);
        }
        notes.judge(Check::Flow, &count, STATIC, |share| {
            let percent = 100.0 * share;
            format!("{}: expected what depth and the cameras' poses say, found it on {percent:.1} %", NAMES[way][0])
        });
    }
}

/// Where a point in Camera falls, unless it is so close to the camera that nothing can be told.
fn moved_to(eye: &Eye, point: DVec3) -> Option<DVec2> {
    (point.z > 0.1).then(|| eye.lens.project(point)).flatten()
}

/// Holds two neighbouring moments of one view to each other, by the flow from one to the other and back.
pub(super) fn between(from: &Looked, to: &Looked, way: usize, notes: &mut Notes) {
    poses(from, to, way, notes);
    let (Some(flow), Some(there)) = (&from.frame.flow[way], &to.frame.instance) else { return };
    if (flow.raster.width, flow.raster.height) != (there.width, there.height) {
        return;
    }
    ends(from, to, way, notes);
    surfaces(from, to, way, notes);
}

/// Flow that nothing hides ends on its own object.
fn ends(from: &Looked, to: &Looked, way: usize, notes: &mut Notes) {
    let a = from.frame;
    let (Some(flow), Some(instance), Some(there)) = (&a.flow[way], &a.instance, &to.frame.instance) else { return };
    let last = a.table.objects.iter().map(|object| object.id as usize).max().unwrap_or(0);
    let mut of_object: Vec<Count> = (0..=last).map(|_| Count::default()).collect();
    let mut all = Count::default();
    let is_thin = a.ids(|object| is_porous(object.class));
    for (pixel, flow) in known(flow, DENSE) {
        let Some(end) = end(there, pixel, flow) else { continue };
        // Without occlusion nothing is known of any one pixel, but most ends are visible.
        if matches!(occlusion(a, way, pixel), Some(Occlusion::Hidden | Occlusion::Undefined)) {
            continue;
        }
        let id = *instance.at(pixel[0], pixel[1]);
        let is_same = is_shown(there, end, id);
        all.tell(pixel, is_same);
        // Ids that are not listed are another check's.
        if let Some(count) = of_object.get_mut(usize::from(id)).filter(|_| id > 0 && !is_thin[usize::from(id)]) {
            count.tell(pixel, is_same);
        }
    }
    let name = NAMES[way][0];
    let [least_object, least] = if a.occluded[way].is_some() { ENDS } else { [0.3, 0.6] };
    notes.judge(Check::FlowEnds, &all, least, |share| {
        format!("{name}: expected to end on the same object, found {:.1} % of pixels that do", 100.0 * share)
    });
    for (id, count) in (0..=u16::MAX).zip(&of_object).filter(|(_, count)| count.all > 0) {
        notes.judge(Check::FlowEnds, count, least_object, |share| {
            let (class, percent) = (a.object(id).map_or("?", |object| object.class.row().name), 100.0 * share);
            format!("{name}: object {id} ({class}): expected to end on it, found {percent:.1} % of pixels that do")
        });
    }
}

/// What is told as visible is seen at its depth and leads back, and what is told as hidden is behind something.
fn surfaces(from: &Looked, to: &Looked, way: usize, notes: &mut Notes) {
    let (a, b) = (from.frame, to.frame);
    let (Some(flow), Some(instance), Some(there)) = (&a.flow[way], &a.instance, &b.instance) else { return };
    let [mut seen, mut hidden, mut returns] = [(); 3].map(|()| Count::default());
    for (pixel, flow) in known(flow, SAMPLES) {
        let Some(end) = end(there, pixel, flow) else { continue };
        match occlusion(a, way, pixel) {
            Some(Occlusion::Hidden) => {
                if let Some(is_hidden) = is_nearer(from, to, pixel, end) {
                    hidden.tell(pixel, is_hidden);
                }
            }
            Some(Occlusion::Seen) if is_shown(there, end, *instance.at(pixel[0], pixel[1])) => {
                if let Some(is_there) = is_at_depth(from, to, pixel, end) {
                    seen.tell(pixel, is_there);
                }
                if let Some(error) = returned(a, b, way, pixel, flow) {
                    returns.tell(pixel, error < RETURNS_PX);
                }
            }
            _ => {}
        }
    }
    let [flow_name, occlusion_name] = NAMES[way];
    notes.judge(Check::Occlusion, &seen, AT_DEPTH, |share| {
        let percent = 100.0 * share;
        format!("{occlusion_name}: expected points told as visible to be seen at their depth, found {percent:.1} %")
    });
    // Reveals and pilasters hide their own wall from no distance; they are few.
    hidden.enough = hidden.enough.max(seen.all / MUCH);
    notes.judge(Check::Occlusion, &hidden, HIDDEN, |share| {
        let percent = 100.0 * share;
        format!(
            "{occlusion_name}: expected something nearer where points are told as hidden, found it at {percent:.1} %"
        )
    });
    notes.judge(Check::FlowReturns, &returns, RETURNS, |share| {
        let percent = 100.0 * share;
        format!("{flow_name}: expected to be undone by the flow back, found {percent:.1} % within {RETURNS_PX} px")
    });
}

/// Whether the neighbouring image shows what a pixel shows; `None` where that is not told.
fn occlusion(frame: &LabelledFrame, way: usize, [x, y]: [u32; 2]) -> Option<Occlusion> {
    frame.occluded[way].as_ref().map(|occluded| *occluded.at(x, y))
}

/// Whether an id is at a pixel or beside it.
fn is_shown(instance: &Raster<u16>, pixel: [u32; 2], id: u16) -> bool {
    *instance.at(pixel[0], pixel[1]) == id || around(instance, pixel).any(|other| other == id)
}

/// The poses that a frame tells of its neighbours are theirs.
fn poses(from: &Looked, to: &Looked, way: usize, notes: &mut Notes) {
    let told = [&from.frame.table.world_from_camera_next, &from.frame.table.world_from_camera_previous][way];
    notes.look(Check::Camera);
    let Some(told) = told else { return };
    let apart = told.iter().flatten().zip(to.frame.table.world_from_camera.iter().flatten());
    let apart = apart.map(|(told, found)| (told - found).abs()).fold(0.0, f64::max);
    if apart.is_nan() || apart > 1e-6 {
        let name = ["world_from_camera_next", "world_from_camera_previous"][way];
        notes.wrong(Check::Camera, format!("{name}: expected the pose of {}, found another", to.frame.place));
    }
}

/// The pixel in which flow ends, unless that is at the rim, whose neighbours are not seen.
fn end<T>(there: &Raster<T>, [x, y]: [u32; 2], [u, v]: &[f32; 2]) -> Option<[u32; 2]> {
    let (x, y) = (f64::from(x) + 0.5 + f64::from(*u), f64::from(y) + 0.5 + f64::from(*v));
    let is_inside = x >= 1.0 && y >= 1.0 && x + 1.0 < f64::from(there.width) && y + 1.0 < f64::from(there.height);
    is_inside.then_some([x as u32, y as u32])
}

/// Where in World the point is that a pixel shows, if that stands still.
fn still_point(looked: &Looked, [x, y]: [u32; 2]) -> Option<DVec3> {
    let eye = looked.eye.as_ref()?;
    let (depth, instance) = (looked.frame.depth_m.as_ref()?, looked.frame.instance.as_ref()?);
    if !looked.still[usize::from(*instance.at(x, y))] {
        return None;
    }
    Some(eye.world_from_camera.transform_point3(eye.point([x, y], *depth.at(x, y))?))
}

/// Depth where flow ends may differ by this share and these metres, …
const AT: [f64; 2] = [0.03, 0.05];
/// … and by what a pixel shows of a surface seen so flat, as a cosine: occlusion is not told within that.
const FLATTEST: f64 = 0.02;

/// Whether what stands still is seen where its flow ends; `None` where that cannot be told.
pub(super) fn is_at_depth(from: &Looked, to: &Looked, pixel: [u32; 2], end: [u32; 2]) -> Option<bool> {
    let (point, other) = (still_point(from, pixel)?, to.eye.as_ref()?);
    let expected = other.camera_from_world.transform_point3(point).z;
    let normal = from.frame.normal.as_ref().and_then(|normal| in_world((from, normal.at(pixel[0], pixel[1])?)));
    let flatness = normal.map_or(1.0, |n| n.dot((point - other.world_from_camera.translation).normalize()).abs());
    let share = (1.0 / (other.lens.fx_px * flatness.max(FLATTEST))).max(AT[0]);
    let (least, most) = extremes(to.frame.depth_m.as_ref()?, end);
    Some(least * (1.0 - share) - AT[1] < expected && expected < most * (1.0 + share) + AT[1])
}

/// Whether the pixel in which a hidden point's flow ends shows something before the surface that the point lies on, or
/// the edge of another thing, or another face of the same, as at the reveals and pilasters of a wall; `None` where that
/// cannot be told, as of leaves, which hide each other within a pixel.
fn is_nearer(from: &Looked, to: &Looked, pixel: [u32; 2], end: [u32; 2]) -> Option<bool> {
    let (point, other) = (still_point(from, pixel)?, to.eye.as_ref()?);
    let (depth, there) = (to.frame.depth_m.as_ref()?, to.frame.instance.as_ref()?);
    if is_porous(*from.frame.class.as_ref()?.at(pixel[0], pixel[1])) {
        return None;
    }
    let id = from.frame.instance.as_ref()?.at(pixel[0], pixel[1]);
    if around(there, end).any(|other| other != *id) {
        return Some(true);
    }
    // Without normals the surface is taken to face the camera, and a slope within the pixel is not told from what is nearer.
    let expected = other.camera_from_world.transform_point3(point).z * FACING_NEARER;
    let expected = match (&from.frame.normal, &to.frame.normal) {
        (Some(here), Some(there)) => {
            let [here, there] = [(from, here.at(pixel[0], pixel[1])?), (to, there.at(end[0], end[1])?)].map(in_world);
            if here?.dot(there?) < SAME_FACE {
                return Some(true);
            }
            depth_of_plane(other, end, point, here?).map_or(expected, |depth| depth * NEARER)
        }
        _ => expected,
    };
    Some(f64::from(*depth.at(end[0], end[1])) < expected)
}

/// A normal in World.
fn in_world((looked, normal): (&Looked, &[f32; 3])) -> Option<DVec3> {
    let normal = glam::Vec3::from_array(*normal).as_dvec3();
    Some(looked.eye.as_ref()?.world_from_camera.transform_vector3(normal))
}

/// Depth at which a pixel's centre would show the plane through a point; `None` where it would not.
fn depth_of_plane(eye: &Eye, pixel: [u32; 2], point: DVec3, normal: DVec3) -> Option<f64> {
    let direction = eye.direction(pixel)?;
    let way = (point - eye.world_from_camera.translation).dot(normal);
    let along = way / eye.world_from_camera.transform_vector3(direction).dot(normal);
    (along.is_finite() && along > 0.0).then_some(along * direction.z)
}

/// How far flow there and back ends from where it began, pixels; `None` where flow back is not known, or where the four
/// pixels around the end are not of one smooth surface, between which it may be interpolated.
fn returned(a: &LabelledFrame, b: &LabelledFrame, way: usize, pixel: [u32; 2], flow: &[f32; 2]) -> Option<f64> {
    let (back, normal) = (b.flow[1 - way].as_ref()?, b.normal.as_ref()?);
    let (here, there, depth) = (a.instance.as_ref()?, b.instance.as_ref()?, b.depth_m.as_ref()?);
    let id = here.at(pixel[0], pixel[1]);
    let flow = DVec2::from_array(flow.map(f64::from));
    let end = DVec2::new(f64::from(pixel[0]), f64::from(pixel[1])) + flow;
    let is_inside =
        end.x >= 0.0 && end.y >= 0.0 && end.x < f64::from(there.width - 1) && end.y < f64::from(there.height - 1);
    let [x, y] = is_inside.then_some([end.x as u32, end.y as u32])?;
    let corners = [[x, y], [x + 1, y], [x, y + 1], [x + 1, y + 1]];
    let (metres, up) = (*depth.at(x, y), glam::Vec3::from_array(*normal.at(x, y)?));
    let is_one = |[x, y]: [u32; 2]| {
        let faces = |normal: &[f32; 3]| glam::Vec3::from_array(*normal).dot(up) > 0.87;
        there.at(x, y) == id && (depth.at(x, y) / metres - 1.0).abs() < 0.05 && normal.at(x, y).is_some_and(faces)
    };
    if !corners.into_iter().all(is_one) {
        return None;
    }
    let vector = |[x, y]: [u32; 2]| Some(DVec2::from_array(back.at(x, y)?.map(f64::from)));
    let [a, b, c, d] = corners.map(vector);
    let part = end - end.floor();
    let returned = a?.lerp(b?, part.x).lerp(c?.lerp(d?, part.x), part.y);
    let error = (flow + returned).length();
    error.is_finite().then_some(error)
}
