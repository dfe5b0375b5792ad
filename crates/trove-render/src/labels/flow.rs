//! Where the point of a pixel is in the picture of a neighbouring keyframe, and whether that picture shows it.

use glam::{DVec2, DVec3, Vec3};
use trove_model::{Camera, Lens, Mesh, Occlusion, Pose, Shot, World};

use crate::PreparedScene;
use crate::accel::PACKET;
use crate::prepare::{Carrier, Then};
use crate::ray::{Beside, Hit, Ray};

/// Rays find triangles in the renderer's precision: a point may lie this share of an edge beside its triangle.
const EDGE: f64 = 1e-2;

/// A surface is taken to be seen no flatter than this, as the cosine to its normal: a pixel's extent on it is endless.
const FLATTEST: f64 = 0.02;

/// Where a pixel leads.
pub(super) struct Arrow {
    pub flow: [f32; 2],
    end: End,
}

/// Where an arrow ends.
enum End {
    Undefined,
    /// Beside the picture.
    Outside,
    /// There, if nothing meets this ray.
    Before(Ray),
}

/// A surface's point and normal in World.
#[derive(Clone, Copy)]
pub(super) struct Spot {
    pub point: DVec3,
    pub normal: DVec3,
}

const UNDEFINED: Arrow = Arrow { flow: [f32::NAN; 2], end: End::Undefined };

/// The previous or the next keyframe.
pub(super) struct Neighbour<'a> {
    scene: &'a PreparedScene,
    beside: Beside,
    lens: Lens,
    /// `None`: the camera has no such keyframe.
    world_from_camera: Option<Pose<World, Camera>>,
    carrier: Carrier,
}

impl<'a> Neighbour<'a> {
    /// The previous keyframe of a shot, and the next.
    pub(super) fn both(scene: &'a PreparedScene, shot: &Shot) -> [Self; 2] {
        let poses = [shot.world_from_camera_previous, shot.world_from_camera_next];
        [Beside::Previous, Beside::Next].map(|beside| Self {
            scene,
            beside,
            lens: shot.lens,
            world_from_camera: poses[beside as usize],
            carrier: Carrier::of_labels(scene, Some(beside), shot),
        })
    }

    /// From `centre` to a spot then.
    pub(super) fn arrow(&self, centre: DVec2, then: Option<Spot>) -> Arrow {
        let Some(eye) = self.world_from_camera else { return UNDEFINED };
        let Some(Spot { point, normal }) = then else { return UNDEFINED };
        let way = point - eye.translation;
        let range_m = way.length();
        let flatness = (normal.dot(way).abs() / range_m).max(FLATTEST);
        // What is nearer to the point than a pixel's extent on the surface does not hide it.
        let before = range_m * (1.0 - 1.0 / (self.lens.fx_px * flatness));
        self.to(centre, eye.inverse().point(point), || Ray {
            t_max: before as f32,
            ..Ray::new(eye.translation.as_vec3(), (way / range_m).as_vec3())
        })
    }

    /// The same for a point infinitely far away, which only the camera's rotation moves.
    pub(super) fn arrow_of_sky(&self, centre: DVec2, direction: DVec3) -> Arrow {
        self.world_from_camera.map_or(UNDEFINED, |eye| {
            let ray = || Ray::new(eye.translation.as_vec3(), direction.as_vec3());
            self.to(centre, eye.inverse().vector(direction), ray)
        })
    }

    /// Whether the neighbour's picture shows what a packet of neighbouring pixels leads to, each at its index in `layer`.
    pub(super) fn occlusion(&self, arrows: &[(usize, Arrow)], layer: &mut [Occlusion]) {
        let mut rays = [Ray::new(Vec3::ZERO, Vec3::Z); PACKET];
        let mut n = 0;
        for (_, arrow) in arrows {
            if let End::Before(ray) = arrow.end {
                rays[n] = self.carrier.past(ray);
                n += 1;
            }
        }
        let mut blocked = self.scene.blocks_then(self.beside, &rays[..n]).into_iter();
        for (i, arrow) in arrows {
            layer[*i] = match arrow.end {
                End::Undefined => Occlusion::Undefined,
                End::Outside => Occlusion::Hidden,
                End::Before(_) if blocked.next() == Some(true) => Occlusion::Hidden,
                End::Before(_) => Occlusion::Seen,
            };
        }
    }

    fn to(&self, centre: DVec2, point_camera: DVec3, ray: impl FnOnce() -> Ray) -> Arrow {
        let Some(pixel) = self.lens.project(point_camera) else { return UNDEFINED };
        let end = if self.lens.contains(pixel) { End::Before(ray()) } else { End::Outside };
        Arrow { flow: (pixel - centre).as_vec2().to_array(), end }
    }

    /// Where a hit's spot is then; `None` where its instance is not there.
    pub(super) fn carried(&self, hit: &Hit, spot: Spot) -> Option<Spot> {
        let instance = &self.scene.instances[hit.instance as usize];
        let (then, world_from_mesh, then_from_now) = match &instance.then[self.beside as usize] {
            Then::IsNotThere => return None,
            Then::Stays => return Some(spot),
            Then::Moves { mesh, world_from_mesh, then_from_now } => (mesh, world_from_mesh, then_from_now),
        };
        if let Some(then_from_now) = then_from_now {
            let normal = then_from_now.transform_vector3(spot.normal).normalize_or_zero();
            return Some(Spot { point: then_from_now.transform_point3(spot.point), normal });
        }
        let mesh = &self.scene.placed(hit.instance).mesh;
        let point_mesh = instance.mesh_from_world.transform_point3(spot.point);
        let place = place_in(corners(mesh, hit.triangle), point_mesh);
        let [u, v] = place.unwrap_or([hit.u.into(), hit.v.into()]);
        let [a, b, c] = corners(then, hit.triangle).map(|corner| world_from_mesh.transform_point3(corner));
        let normal = (b - a).cross(c - a).normalize_or_zero();
        Some(Spot { point: a + (b - a) * u + (c - a) * v, normal })
    }
}

/// A triangle's corners in the mesh's own metres.
fn corners(mesh: &Mesh, triangle: u32) -> [DVec3; 3] {
    mesh.triangles[triangle as usize].map(|i| mesh.positions[i as usize].as_dvec3())
}

/// Where in a triangle a point on it is, (1 − u − v)·a + u·b + v·c; `None` where the triangle has no area or the point is
/// beside it.
fn place_in([a, b, c]: [DVec3; 3], point: DVec3) -> Option<[f64; 2]> {
    let (ab, ac, ap) = (b - a, c - a, point - a);
    let normal = ab.cross(ac);
    let [u, v] = [ap.cross(ac), ab.cross(ap)].map(|part| part.dot(normal) / normal.length_squared());
    let inside = -EDGE..=1.0 + EDGE;
    (inside.contains(&u) && inside.contains(&v) && inside.contains(&(u + v))).then_some([u, v])
}
