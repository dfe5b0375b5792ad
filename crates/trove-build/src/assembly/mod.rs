//! Puts the parts of a place together: one stock of meshes and materials, one numbering.

mod feet;
mod flat;
mod legs;
mod lens;
mod movement;
mod pedals;
mod pose;
mod postures;
mod stock;
mod weather;
mod wheels;

use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::TAU;
use std::sync::Arc;

use glam::{DAffine3, DMat3, DQuat, DVec3, Vec3};
use trove_model::{
    Asset, Class, Cuboid, Drive, DriveOrigin, Instance, InstanceId, Kind, Mesh, Origin, Placement, Pose, Posture,
    Provenance, SceneObject, StreetMap,
};

use crate::between::{Moments, is_tremor};
use crate::pieces::{Piece, Scenery};
use crate::placement::{Role, Shown};

use feet::plant;
use legs::{Legs, bones};
pub(crate) use lens::UNIT_CD_M2;
pub(crate) use movement::Movement;
use movement::movements;
use pedals::GEAR;
pub(crate) use pose::ActorPose;
pub(crate) use postures::MeshesNow;
use postures::{Bend, Joints, Posed};
pub(crate) use stock::Stock;
pub use weather::Weather;
use wheels::{curves_per_m, turned_rad, ways_m};

/// What gets farther than this does not stand.
const LEAVES_M: f64 = 1.0;

/// A recorded object with its asset, ready to be put into a scene.
#[derive(Clone, Debug)]
pub(crate) struct Actor {
    /// What its pixels are.
    class: Class,
    /// The assets' ids: one, and for people one a posture.
    assets: Vec<String>,
    /// Of each slot.
    pub materials: Vec<usize>,
    /// The same while it brakes; `None` where that does not show.
    pub braking: Option<Vec<usize>>,
    /// As in [`SceneObject::paint`].
    pub paint: Option<Vec3>,
    /// The slot that has it.
    painted: Option<usize>,
    /// What of it moves by itself.
    joints: Joints,
    /// By moment, in the order of time.
    poses: Vec<(usize, ActorPose)>,
    /// How far a foot that stands slides at most, metres.
    pub slides_m: f64,
}

impl Actor {
    /// Where it is at a keyframe; `None` where it was not annotated then.
    pub(crate) fn at(&self, keyframe: usize) -> Option<&ActorPose> {
        let found = self.poses.binary_search_by_key(&keyframe, |(k, _)| *k).ok()?;
        Some(&self.poses[found].1)
    }

    /// The id of the asset that a pose shows.
    pub(crate) fn asset(&self, pose: &ActorPose) -> String {
        self.assets[pose.asset].clone()
    }

    /// What its pixels are.
    pub(crate) fn class(&self) -> Class {
        self.class
    }

    /// Changes its paint, or its largest garment, by a factor.
    pub(crate) fn repaint(&mut self, factor: Vec3, stock: &mut Stock) {
        let Some(slot) = self.painted else { return };
        for materials in [Some(&mut self.materials), self.braking.as_mut()].into_iter().flatten() {
            materials[slot] = stock.tinted(materials[slot], factor);
        }
        self.paint = Some(stock.materials[self.materials[slot]].base_color);
    }

    /// Index of its mesh in the stock, as it first is; `None` for who is never there.
    pub(crate) fn mesh(&self) -> Option<usize> {
        self.poses.first().map(|(_, pose)| pose.posed.mesh)
    }

    /// Whether it is a vehicle that slows down at some time by so much that it has to show it.
    pub(crate) fn brakes(&self) -> bool {
        self.poses.iter().any(|(_, pose)| pose.posture.is_none() && pose.movement.brakes())
    }

    /// Whether it is somewhere else at some time.
    pub(crate) fn moves(&self) -> bool {
        let places = || self.poses.iter().map(|(_, pose)| pose.cuboid.world_from_body.translation);
        places().next().is_some_and(|first| places().any(|place| place.distance(first) > LEAVES_M))
    }

    /// Its instance at a keyframe, with where it is at the neighbouring ones.
    pub(crate) fn instance(
        &self,
        id: InstanceId,
        keyframe: usize,
        [previous, next]: [Option<usize>; 2],
        meshes: &mut MeshesNow,
        object: Option<SceneObject>,
    ) -> Option<Instance> {
        let mut placement = |k: Option<usize>| {
            let &ActorPose { posed, bend, world_from_mesh, .. } = self.at(k?)?;
            Some(Placement { mesh: meshes.bent(posed, &self.joints, &bend), world_from_mesh })
        };
        let Placement { mesh, world_from_mesh } = placement(Some(keyframe))?;
        let brakes = self.at(keyframe).is_some_and(|pose| pose.movement.brakes());
        Some(Instance {
            id,
            class: self.class,
            mesh,
            materials: self.braking.as_ref().filter(|_| brakes).unwrap_or(&self.materials).clone(),
            world_from_mesh,
            previous: placement(previous),
            next: placement(next),
            object: object.map(Arc::new),
        })
    }
}

/// Gives each pose at a keyframe that is the one at the keyframe before but for an annotator's tremor that pose, so that what
/// stands has no flow of its own. Between the two it stands already.
fn hold_still(poses: &mut [(usize, ActorPose)], moments: Moments) {
    let mut last = 0;
    for i in 1..poses.len() {
        if moments.keyframe(poses[i].0).is_none() {
            continue;
        }
        let before = poses[last].1;
        let at = |pose: &ActorPose| (pose.cuboid.world_from_body.rotation, pose.cuboid.world_from_body.translation);
        let stands = poses[last + 1..i].iter().all(|(_, pose)| is_tremor(at(&before), at(pose)));
        if stands && is_tremor(at(&before), at(&poses[i].1)) {
            poses[last + 1..=i].iter_mut().for_each(|(_, pose)| *pose = before);
        }
        last = i;
    }
}

/// A place being put together.
#[derive(Debug, Default)]
pub(crate) struct Assembly {
    /// Meshes and materials so far.
    pub stock: Stock,
    /// What stands still so far.
    pub fixed: Vec<Instance>,
    /// Assets used so far, by licence.
    licences: BTreeMap<String, BTreeSet<String>>,
}

impl Assembly {
    /// Takes a recorded object.
    pub(crate) fn actor(&mut self, role: &Role, moments: Moments) -> Actor {
        let mut assets: Vec<String> = Vec::new();
        let mut poses = Vec::with_capacity(role.placements.len());
        for ((k, placement), &Shown { asset: shown, towards, shift_m, turn_rad, .. }) in
            role.placements.iter().zip(&role.postures)
        {
            self.credit(shown);
            let known = assets.iter().position(|id| *id == shown.id);
            let asset = known.unwrap_or_else(|| {
                assets.push(shown.id.clone());
                assets.len() - 1
            });
            let mesh = self.stock.individual(shown, role.is_driven, role.seed);
            let towards = towards.map(|(other, share)| {
                self.credit(other);
                (other, self.stock.individual(other, role.is_driven, role.seed), share)
            });
            let world_from_mesh = role.world_from_mesh(placement, turn_rad) * DAffine3::from_translation(shift_m);
            let world = |p: Vec3| world_from_mesh.transform_point3(p.as_dvec3());
            let keypoints = match towards.and_then(|(other, _, share)| Some((other.keypoints?, share))) {
                Some((others, share)) => {
                    shown.keypoints.map(|points| std::array::from_fn(|i| points[i].lerp(others[i], share)))
                }
                None => shown.keypoints,
            };
            let posed = Posed { mesh, towards: towards.map(|(_, mesh, share)| (mesh, share)) };
            let keypoints_world = keypoints.map(|points| points.map(world));
            let posture = shown.figure.as_ref().map(|figure| figure.posture);
            let cuboid = placement.cuboid;
            let (movement, bend) = (Movement::default(), Bend::default());
            let pose = ActorPose { world_from_mesh, cuboid, posed, bend, asset, keypoints_world, posture, movement };
            poses.push((*k, pose));
        }
        hold_still(&mut poses, moments);
        let (legs, slides_m) = self.plant(role, &mut poses, moments).unzip();
        let cuboids: Vec<(usize, Cuboid)> = poses.iter().map(|(moment, pose)| (*moment, pose.cuboid)).collect();
        for (movement, (_, pose)) in movements(&cuboids, moments).into_iter().zip(&mut poses) {
            pose.movement = movement;
        }
        let drives = role.is_driven && role.asset.kind.is_vehicle();
        let mut joints = if drives { self.stock.vehicle(role.asset) } else { Joints::default() };
        joints.legs = legs;
        if !joints.wheels.is_empty() {
            let scale = role.fit.scale.x;
            // Not all riders begin with the same foot.
            let start_rad = role.seed.child("cranks").random().unit() * TAU;
            let ways_m = ways_m(&cuboids, moments);
            let curves_per_m = curves_per_m(&cuboids, &ways_m, moments);
            for ((way_m, curve_per_m), (_, pose)) in ways_m.into_iter().zip(curves_per_m).zip(&mut poses) {
                let rolled_m = way_m / scale;
                pose.bend = Bend { rolled_m, curve_per_m: curve_per_m * scale, ..pose.bend };
                if let Some(pedals) = &joints.pedals {
                    pose.bend.cranks_rad = start_rad + turned_rad(&joints.wheels, rolled_m) / GEAR;
                    let points = role.asset.keypoints.map(|mut points| {
                        pedals.turn_points(&mut points, pose.bend.cranks_rad);
                        points.map(|p| pose.world_from_mesh.transform_point3(p.as_dvec3()))
                    });
                    pose.keypoints_world = points;
                }
            }
        }
        let (class, materials) = (role.asset.class, self.stock.painted(role.asset, role.seed));
        let painted = largest_painted(role.asset);
        let paint = painted.map(|slot| self.stock.materials[materials[slot]].base_color);
        let slides_m = slides_m.unwrap_or(0.0);
        Actor { class, assets, materials, braking: None, paint, painted, joints, poses, slides_m }
    }

    /// Plants the feet of someone on foot where there are moments between keyframes; returns the legs, and how far a foot that
    /// stands slides at most all the same, metres.
    fn plant(&mut self, role: &Role, poses: &mut [(usize, ActorPose)], moments: Moments) -> Option<(Arc<Legs>, f64)> {
        role.asset.figure.as_ref().filter(|_| moments.are_between())?;
        // Legs are told apart best in a long step.
        let assets = role.postures.iter().map(|shown| shown.asset);
        let widest = assets.max_by(|a, b| step_m(a).total_cmp(&step_m(b)))?;
        let legs = self.stock.legs(widest)?;
        let stands: Vec<[bool; 2]> = role.postures.iter().map(|shown| shown.stands).collect();
        let times_s: Vec<f64> = poses.iter().map(|(moment, _)| moments.time_s(*moment)).collect();
        let slides_m = plant(poses, &times_s, &stands, &legs, &self.stock.meshes);
        Some((legs, slides_m))
    }

    /// Takes a piece of the built place; pieces of no kind are stuff and get no number.
    pub(crate) fn piece(&mut self, piece: &Piece, next_id: &mut u32) {
        let object = piece
            .kind
            .map(|kind| scene_object(kind, piece.asset.as_deref(), cuboid(&piece.mesh, &piece.world_from_mesh)));
        let instance = Instance {
            id: object.as_ref().map_or(InstanceId(0), |_| take(next_id)),
            class: piece.class,
            mesh: self.stock.mesh(&piece.mesh),
            materials: piece.materials.iter().map(|m| self.stock.material(m)).collect(),
            world_from_mesh: piece.world_from_mesh,
            previous: None,
            next: None,
            object: object.map(Arc::new),
        };
        self.fixed.push(instance.at_rest());
    }

    /// Takes a plant or a piece of furniture that stands at some distance from the driven path.
    pub(crate) fn scenery(&mut self, scenery: &Scenery, distance_m: f64, next_id: &mut u32) {
        self.credit(scenery.asset);
        let world_from_mesh = scenery.world_from_mesh();
        let asset = scenery.asset;
        let object = scene_object(asset.kind, Some(&asset.id), cuboid(&asset.mesh, &world_from_mesh));
        let instance = Instance {
            id: take(next_id),
            class: scenery.asset.class,
            mesh: self.stock.seen(scenery.asset, distance_m, scenery.seed),
            materials: self.stock.painted(scenery.asset, scenery.seed),
            world_from_mesh,
            previous: None,
            next: None,
            object: Some(Arc::new(object)),
        };
        self.fixed.push(instance.at_rest());
    }

    /// Where everything came from: recording, map, and the assets by licence.
    pub(crate) fn provenance(&self, drive: &Drive, map: Option<&StreetMap>) -> Vec<Provenance> {
        let recording = (drive.origin == DriveOrigin::Recorded)
            .then(|| Provenance { source: format!("{} {}", drive.dataset, drive.id), licence: drive.licence.clone() });
        let street_map =
            map.map(|m| Provenance { source: format!("street map of {}", drive.id), licence: m.licence.clone() });
        let assets = self.licences.iter().map(|(licence, ids)| {
            let ids: Vec<&str> = ids.iter().map(String::as_str).collect();
            Provenance { source: format!("assets {}", ids.join(", ")), licence: licence.clone() }
        });
        recording.into_iter().chain(street_map).chain(assets).collect()
    }

    fn credit(&mut self, asset: &Asset) {
        self.licences.entry(asset.licence.clone()).or_default().insert(asset.id.clone());
    }
}

/// The slot with the largest area among those that are drawn in one colour or another.
fn largest_painted(asset: &Asset) -> Option<usize> {
    let mut areas = vec![0.0; asset.slots.len()];
    for (triangle, corners) in asset.mesh.triangles.iter().enumerate() {
        let [a, b, c] = corners.map(|i| asset.mesh.positions[i as usize].as_dvec3());
        areas[usize::from(asset.mesh.slot(triangle))] += (b - a).cross(c - a).length();
    }
    let painted = (0..areas.len()).filter(|slot| !asset.slots[*slot].paints.is_empty());
    painted.max_by(|a, b| areas[*a].total_cmp(&areas[*b]).then(b.cmp(a)))
}

/// How far apart the feet of a posture are over the ground, metres: 0 in running, where legs are lifted to the trunk.
fn step_m(asset: &Asset) -> f32 {
    let runs = asset.figure.as_ref().is_some_and(|figure| matches!(figure.posture, Posture::Running { .. }));
    let Some(keypoints) = asset.keypoints.as_ref().filter(|_| !runs) else { return 0.0 };
    let [left, right] = [0, 1].map(|side| bones(keypoints, side)[2].truncate());
    left.distance(right)
}

fn take(next_id: &mut u32) -> InstanceId {
    *next_id += 1;
    InstanceId(*next_id - 1)
}

fn scene_object(kind: Kind, asset: Option<&str>, cuboid: Cuboid) -> SceneObject {
    let asset = asset.map(str::to_owned);
    SceneObject {
        kind,
        origin: Origin::Scenery,
        asset,
        cuboid,
        velocity_mps: None,
        yaw_rate_radps: None,
        states: Vec::new(),
        paint: None,
        keypoints_world: None,
    }
}

/// The box of a mesh where it stands.
fn cuboid(mesh: &Mesh, world_from_mesh: &DAffine3) -> Cuboid {
    let (low, high) = mesh.bounds().unwrap_or_default();
    let (low, high) = (low.as_dvec3(), high.as_dvec3());
    let axes = world_from_mesh.matrix3;
    let scale = DVec3::new(axes.x_axis.length(), axes.y_axis.length(), axes.z_axis.length());
    let rotation = DMat3::from_cols(axes.x_axis / scale.x, axes.y_axis / scale.y, axes.z_axis / scale.z);
    let centre_world = world_from_mesh.transform_point3((low + high) / 2.0);
    Cuboid { world_from_body: Pose::new(DQuat::from_mat3(&rotation), centre_world), size_m: (high - low) * scale }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_annotator_s_tremor_is_no_motion_and_a_creep_is() {
        let at = |x: f64| {
            let cuboid = Cuboid { world_from_body: Pose::from_yaw(0.0, DVec3::new(x, 0.0, 0.5)), size_m: DVec3::ONE };
            let world_from_mesh = DAffine3::from_translation(DVec3::X * x);
            ActorPose {
                world_from_mesh,
                cuboid,
                posed: Posed { mesh: 0, towards: None },
                bend: Bend::default(),
                asset: 0,
                keypoints_world: None,
                posture: None,
                movement: Movement::default(),
            }
        };
        let mut poses: Vec<(usize, ActorPose)> =
            [0.0, 0.008, 0.016, 0.024, 1.0].into_iter().map(at).enumerate().collect();
        let drive = crate::testing::drive();
        hold_still(&mut poses, Moments::of_keyframes(&drive));
        let placed: Vec<f64> = poses.iter().map(|(_, pose)| pose.world_from_mesh.translation.x).collect();
        assert_eq!(placed, [0.0, 0.0, 0.0, 0.024, 1.0]);
    }
}
