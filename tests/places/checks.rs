//! What must hold of every built place. A check returns what is wrong with it, each with its place, in metres.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};
use trove_model::{Bounds, Class, Cuboid, Instance, Kind, Origin, Report, Scene};

use crate::drawing::{BEYOND_M, Drawing, Hit, Triangle, is_built, triangles};
use crate::footing::{Ground, Solids, foot_outline, overlap_m};

/// Surfaces nearer to each other than this fight for the same pixels, metres.
const COPLANAR_M: f64 = 0.0005;
/// Surfaces that meet at more than 0.2° (cosine) cross in a line; and so much two of a kind may have in common, m².
const PARALLEL: f64 = 0.999_994;
const COMMON_M2: f64 = 0.5;
/// Buildings reach at most this far out of their place, metres.
const REACH_M: f64 = 500.0;
/// All buildings of a place together show at most this much more of their insides than is known, in all views, m²: one ray
/// from above that slips through where two triangles meet at a rounded corner; one from the side stands for 0.16 m².
const SLIT_M2: f64 = 0.05;
/// Cloth, panes and thin metal have no inside.
const SHEETS: [&str; 5] = ["awning", "curtain", "drapes", "balustrade glass", "zinc"];
/// Objects may sink into each other this far, metres.
const OVERLAP_M: f64 = 0.05;
/// Wheels and feet are this near to the ground, metres.
const STANDS_M: f64 = 0.03;
/// And everything else, which has no wheels or feet, metres.
const LET_IN_M: f64 = 0.05;
/// People who were recorded at least this high above the ground stood on something.
const PLATFORM_M: f64 = 0.5;
/// Rows of rays from above run so far from east to north.
const ASLANT_RAD: f64 = 0.231;
/// Directions in which a place is looked at from its sides.
const AZIMUTHS: usize = 6;

/// No mesh or placement has a number that is not finite, an index that does not exist, or no place.
pub(crate) fn numbers(scene: &Scene) -> Vec<String> {
    let meshes = scene.meshes.iter().enumerate().filter_map(|(i, m)| Some(format!("mesh {i}: {}", m.defect()?)));
    let placed = scene.instances.iter().filter(|i| !i.world_from_mesh.is_finite());
    meshes.chain(placed.map(|i| format!("{}: placement is not finite", name(i)))).collect()
}

/// No two surfaces that face the same way coincide, and no building shows its inside to someone outside, but for what is
/// known of the place, m² in all views.
pub(crate) fn solids(scene: &Scene, area: Bounds, known_m2: f64) -> Vec<String> {
    let middle_and_reach = |i: usize| {
        let object = scene.instances[i].object.as_ref().filter(|o| o.kind == Kind::Building)?;
        let Cuboid { world_from_body, size_m } = object.cuboid;
        Some((world_from_body.translation.truncate(), size_m.truncate().length() / 2.0))
    };
    // Houses beyond the place go on beyond what is drawn from above.
    let drawn = area.grown(BEYOND_M);
    let is_whole = |i: usize| middle_and_reach(i).is_none_or(|(p, reach_m)| drawn.grown(-reach_m).contains(p));
    let all = triangles(scene, |i| is_built(scene, i) && is_whole(i));
    let (mut wrong, mut open) = (Vec::new(), Vec::new());
    look(scene, &all, area, (DVec3::NEG_Z, 0.2), &mut wrong, &mut open);
    // They are shapes of the place, which are looked at where they are its own.
    let is_own = |i: usize| middle_and_reach(i).is_none_or(|(p, _)| area.contains(p));
    let buildings = triangles(scene, |i| scene.instances[i].class == Class::Building && is_own(i));
    for i in 0..AZIMUTHS {
        let azimuth = std::f64::consts::TAU * (i as f64 + 0.137) / AZIMUTHS as f64;
        let towards = DVec3::new(azimuth.cos(), azimuth.sin(), -0.05).normalize();
        look(scene, &buildings, area.grown(REACH_M), (towards, 0.4), &mut wrong, &mut open);
    }
    let open_m2: f64 = open.iter().map(|(area_m2, _)| area_m2).sum();
    if open_m2 > known_m2 + SLIT_M2 {
        wrong.push(format!("{open_m2:.2} m² of insides show in all, {known_m2:.2} m² are known"));
        wrong.extend(open.into_iter().map(|(_, what)| what));
    }
    wrong
}

/// One view along a direction with a cell's side: what coincides in it, and each building's inside that shows, m².
fn look(
    scene: &Scene,
    all: &[Triangle],
    area: Bounds,
    (towards, cell_m): (DVec3, f64),
    wrong: &mut Vec<String>,
    open: &mut Vec<(f64, String)>,
) {
    // Outlines that come from a raster run along the axes or half way between them.
    let aslant = DVec3::new(ASLANT_RAD.cos(), ASLANT_RAD.sin(), 0.0);
    let drawing = Drawing::new(all, area, (towards, aslant), cell_m);
    let normals: Vec<DVec3> = all.iter().map(Triangle::normal).collect();
    let name_of = |triangle: u32| {
        let triangle = all[triangle as usize];
        format!("{} ({})", name(&scene.instances[triangle.instance]), scene.materials[triangle.material].name)
    };
    let mut fights: BTreeMap<String, (usize, DVec3)> = BTreeMap::new();
    let mut insides: BTreeMap<String, (usize, DVec3, &str)> = BTreeMap::new();
    for ray in drawing.rays() {
        // What lies behind the first opaque surface is not seen.
        let seen_through = |hit: &Hit| scene.materials[all[hit.triangle as usize].material].transmission > 0.0;
        let depth = ray.iter().position(|hit| !seen_through(hit)).unwrap_or(ray.len());
        for pair in ray.windows(2).take(depth + 1) {
            let [a, b] = [&pair[0], &pair[1]].map(|hit| &all[hit.triangle as usize]);
            let alike = normals[pair[0].triangle as usize].dot(normals[pair[1].triangle as usize]) > PARALLEL;
            // Nobody can tell two faces of one building and one material apart.
            let name = |t: &Triangle| scene.materials[t.material].name.as_str();
            let same = a.instance == b.instance && name(a) == name(b);
            if alike && !same && pair[1].depth_m - pair[0].depth_m < COPLANAR_M {
                let both = format!("{} and {}", name_of(pair[0].triangle), name_of(pair[1].triangle));
                fights.entry(both).or_insert((0, drawing.point(&pair[0], towards))).0 += 1;
            }
        }
        let first = &ray[0];
        let material = &scene.materials[all[first.triangle as usize].material].name;
        // A model's pieces of cloth may be numbered.
        let is_sheet = SHEETS.iter().any(|sheet| material.starts_with(sheet));
        let instance = &scene.instances[all[first.triangle as usize].instance];
        if !is_sheet && instance.class == Class::Building && !first.from_front {
            let point = || (0, drawing.point(first, towards), material.as_str());
            insides.entry(name(instance)).or_insert_with(point).0 += 1;
        }
    }
    for (what, (rays, at)) in fights {
        let area_m2 = rays as f64 * cell_m * cell_m;
        if area_m2 > COMMON_M2 {
            wrong.push(format!("{what} coincide over {area_m2:.2} m², such as at {at:.2}"));
        }
    }
    for (building, (rays, at, material)) in insides {
        let area_m2 = rays as f64 * cell_m * cell_m;
        let what = format!(
            "{building} shows {area_m2:.2} m² of its inside towards {towards:.2}, such as {material} at {at:.2}"
        );
        open.push((area_m2, what));
    }
}

/// Everything that stands does so on the ground: vehicles and people within 3 cm, other things without a gap.
pub(crate) fn standing(scene: &Scene, area: Bounds) -> Vec<String> {
    let ground = Ground::new(scene);
    let mut wrong = Vec::new();
    for (instance, kind) in objects(scene).filter(|(_, kind)| *kind != Kind::Building) {
        for foot in feet(scene, instance, kind) {
            let Some(surface_m) = ground.height_near_m(foot) else {
                if area.contains(foot.truncate()) {
                    wrong.push(format!("{} at {foot:.2} has no ground below it", name(instance)));
                }
                continue;
            };
            let above_m = foot.z - surface_m;
            // Someone recorded on a platform is left there.
            if is_recorded(instance) && kind.class() == Class::Human && above_m > PLATFORM_M {
                continue;
            }
            let touches = kind.is_vehicle() || kind.class() == Class::Human;
            let most_m = if touches { STANDS_M } else { LET_IN_M };
            if above_m > most_m || (touches && above_m < -STANDS_M) {
                wrong.push(format!("{} stands {above_m:.3} m above the ground at {foot:.2}", name(instance)));
                break;
            }
        }
    }
    wrong
}

/// Where an object touches the ground: the wheels of a vehicle, else its lowest point.
fn feet(scene: &Scene, instance: &Instance, kind: Kind) -> Vec<DVec3> {
    let mesh = &scene.meshes[instance.mesh];
    let Some((low, high)) = mesh.bounds() else { return Vec::new() };
    let middle = (low + high) / 2.0;
    let lowest = |front: Option<bool>, left: Option<bool>| {
        let there = mesh
            .positions
            .iter()
            .filter(|p| front.is_none_or(|f| (p.x > middle.x) == f) && left.is_none_or(|l| (p.y > middle.y) == l));
        let lowest = there.min_by(|a, b| a.z.total_cmp(&b.z))?;
        (lowest.z < low.z + 0.03).then(|| instance.world_from_mesh.transform_point3(lowest.as_dvec3()))
    };
    let wheels: &[(Option<bool>, Option<bool>)] = if !kind.is_vehicle() {
        &[(None, None)]
    } else if matches!(kind.class(), Class::CycleRider | Class::MotorcycleRider) {
        &[(Some(true), None), (Some(false), None)]
    } else {
        &[(Some(true), Some(true)), (Some(true), Some(false)), (Some(false), Some(true)), (Some(false), Some(false))]
    };
    wheels.iter().filter_map(|&(front, left)| lowest(front, left)).collect()
}

/// No plant and no piece of furniture stands on a carriageway.
pub(crate) fn lanes(scene: &Scene) -> Vec<String> {
    let ground = Ground::new(scene);
    let mut wrong = Vec::new();
    for (instance, _) in made_up(scene) {
        let outline = foot_outline(scene, instance);
        let origin = instance.world_from_mesh.translation;
        // What lies flat has no outline at the height of a foot.
        let foot =
            if outline.is_empty() { origin.truncate() } else { outline.iter().sum::<DVec2>() / outline.len() as f64 };
        let at = foot.extend(origin.z);
        if ground.class_near(at) == Some(Class::Road) {
            wrong.push(format!("{} stands on the road at {at:.2}", name(instance)));
        }
    }
    wrong
}

/// No body is more than 5 cm inside a building or another body: at the height of people's knees to their heads.
pub(crate) fn bodies(scene: &Scene) -> Vec<String> {
    let solids = Solids::new(scene);
    let mut wrong = Vec::new();
    let outlines: Vec<(usize, Vec<DVec2>)> = scene
        .instances
        .iter()
        .enumerate()
        .filter(|(_, i)| i.object.as_ref().is_some_and(|o| o.kind != Kind::Building))
        .map(|(index, instance)| (index, foot_outline(scene, instance)))
        .filter(|(_, outline)| outline.len() > 2)
        .collect();
    for (index, outline) in &outlines {
        let instance = &scene.instances[*index];
        let z = instance.world_from_mesh.translation.z + 1.0;
        if let Some(&corner) = outline.iter().find(|p| solids.is_inside(p.extend(z), OVERLAP_M)) {
            wrong.push(format!("{} is inside a building at {corner:.2}", name(instance)));
        }
    }
    let mut near: BTreeMap<[i64; 2], Vec<usize>> = BTreeMap::new();
    for (k, (_, outline)) in outlines.iter().enumerate() {
        let low = outline.iter().copied().fold(DVec2::INFINITY, DVec2::min);
        let high = outline.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
        for x in (low.x / 4.0).floor() as i64..=(high.x / 4.0).floor() as i64 {
            for y in (low.y / 4.0).floor() as i64..=(high.y / 4.0).floor() as i64 {
                near.entry([x, y]).or_default().push(k);
            }
        }
    }
    let mut pairs: Vec<[usize; 2]> = Vec::new();
    for bucket in near.values() {
        for (i, &a) in bucket.iter().enumerate() {
            pairs.extend(bucket[i + 1..].iter().map(|&b| [a.min(b), a.max(b)]));
        }
    }
    pairs.sort_unstable();
    pairs.dedup();
    for [a, b] in pairs {
        let [first, second] = [a, b].map(|k| &scene.instances[outlines[k].0]);
        let apart_m = (first.world_from_mesh.translation.z - second.world_from_mesh.translation.z).abs();
        // What was recorded may overlap as it was annotated, and plants grow into each other.
        // Walls and fences are joined where they meet.
        let both = |is: fn(&Instance) -> bool| is(first) && is(second);
        let excused = both(is_recorded) || both(is_plant) || both(is_line);
        if excused || apart_m > 2.0 {
            continue;
        }
        let depth_m = overlap_m(&outlines[a].1, &outlines[b].1);
        if depth_m > OVERLAP_M {
            let at = first.world_from_mesh.translation;
            wrong.push(format!("{} and {} overlap by {depth_m:.2} m at {at:.2}", name(first), name(second)));
        }
    }
    wrong
}

/// At least 98 of 100 ways and relations of the map were used or are in the report.
pub(crate) fn accounted(report: &Report) -> Vec<String> {
    let measured: BTreeMap<String, f64> = report.measurements().into_iter().map(|m| (m.name, m.value)).collect();
    let mut wrong = Vec::new();
    for what in ["ways", "relations"] {
        let value = |name: &str| measured.get(&format!("osm.{what}_{name}")).copied();
        match (value("in_area"), value("accounted").or(value("used"))) {
            (Some(all), Some(known)) if known < 0.98 * all => {
                wrong.push(format!("{known} of {all} {what} are used or reported"));
            }
            (Some(_), Some(_)) => {}
            _ => wrong.push(format!("{what} are not counted")),
        }
    }
    wrong
}

fn objects(scene: &Scene) -> impl Iterator<Item = (&Instance, Kind)> {
    scene.instances.iter().filter_map(|i| Some((i, i.object.as_ref()?.kind)))
}

/// Plants and furniture: what nobody recorded.
fn made_up(scene: &Scene) -> impl Iterator<Item = (&Instance, Kind)> {
    objects(scene).filter(|(i, kind)| *kind != Kind::Building && !is_recorded(i) && !is_added(i))
}

fn is_added(instance: &Instance) -> bool {
    instance.object.as_ref().is_some_and(|o| o.origin == Origin::Added)
}

fn is_recorded(instance: &Instance) -> bool {
    instance.object.as_ref().is_some_and(|o| matches!(o.origin, Origin::Recorded { .. } | Origin::Carrier))
}

fn is_plant(instance: &Instance) -> bool {
    matches!(instance.class, Class::Tree | Class::Bush)
}

fn is_line(instance: &Instance) -> bool {
    matches!(instance.object.as_ref().map(|o| o.kind), Some(Kind::Wall | Kind::Fence | Kind::GuardRail))
}

fn name(instance: &Instance) -> String {
    match &instance.object {
        Some(object) => match &object.asset {
            Some(asset) => format!("{asset} {} ({:?})", instance.id.0, object.origin),
            None => format!("{:?} {}", object.kind, instance.id.0),
        },
        None => instance.class.row().name.to_owned(),
    }
}
