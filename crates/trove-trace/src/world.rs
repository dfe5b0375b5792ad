//! A scene with all that paths find in it as tables of plain numbers, in a processor's memory or in a card's.

use glam::{Affine3A, IVec3, Mat3A, Vec2, Vec3};

use crate::exposure::{Bears, ComesDown, SnowLeft, exposure};
use crate::field::{GRIDS, LightField, Node};
use crate::flat::{Asked, FlatScene, Readable, SHELTERS, Table};
use crate::fog::Fog;
use crate::light::{
    Aim, BeamTable, Beams, Cell, Cells, Emitter, Emitters, Group, Haze, Lights, Patches, Pattern, Picture, Sky, Sun,
    Tree, Within,
};
use crate::lookups::Lookups;
use crate::material::Material;
use crate::math::unit_or;
use crate::motion::Motion;
use crate::path::World;
use crate::ray::{Hit, NONE, Ray};
use crate::spray::{Plume, Puff, Spray};
use crate::surface::{Exposure, Surface, Triangle};
use crate::texture::FlatTexture;
use crate::trace;

/// What surfaces are made of.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct FlatMaterials {
    /// One.
    pub lookups: Table<Lookups>,
    /// By index.
    pub materials: Table<Material<FlatTexture>>,
}

/// What a mesh's triangles look like; tables of what it has not are empty.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct FlatLook {
    /// Indices of corners.
    pub triangles: Table<[u32; 3]>,
    /// By corner, metres.
    pub positions: Table<Vec3>,
    /// By corner.
    pub normals: Table<Vec3>,
    /// By corner.
    pub uvs: Table<Vec2>,
    /// By corner.
    pub tints: Table<Vec3>,
    /// By triangle; without them all are 0.
    pub slots: Table<u16>,
    /// Lowest z of the mesh, metres.
    pub foot_z: f32,
}

/// How an instance stands.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Stand {
    /// At the moment of the labels.
    pub world_from_mesh: Affine3A,
    /// The inverse transpose of that, turned so that outside stays outside.
    pub world_from_normal: Mat3A,
    /// Where the materials of its slots begin.
    pub materials: u32,
    /// What snow it bears.
    pub bears: Bears,
}

/// All lights.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct FlatLights {
    /// As in [`Picture`].
    pub picture: Table<[f32; 3]>,
    /// As in [`Cells`].
    pub cells: Table<Cell>,
    /// One.
    pub patches: Table<Patches>,
    /// As in [`Cells`].
    pub within: Table<Within>,
    /// As in [`Cells`].
    pub cumulative: Table<f32>,
    /// As in [`Cells`].
    pub guide: Table<u32>,
    /// As in [`Beams`].
    pub tables: Table<BeamTable>,
    /// As in [`Beams`].
    pub numbers: Table<f32>,
    /// As in [`Emitters`]; none where nothing shines.
    pub triangles: Table<Emitter>,
    /// As in [`Emitters`].
    pub patterns: Table<Pattern<FlatTexture>>,
    /// As in [`Tree`].
    pub groups: Table<Group>,
    /// As in [`Tree`].
    pub order: Table<u32>,
    /// As in [`Tree`].
    pub leaf_of: Table<u32>,
    /// As in [`Tree`].
    pub aims: Table<Aim>,
    /// As in [`Lights`], if any shines.
    pub sun: Sun,
    /// As in [`Lights`], if anything is known of the air.
    pub haze: Haze,
    /// Texels of the picture.
    pub picture_size: [u32; 2],
    /// As in [`Cells`].
    pub side: u32,
    /// As in [`Lights`].
    pub emitter_share: f32,
    /// As in [`Lights`].
    pub scale: f32,
    /// As in [`Sky`].
    pub is_smooth: bool,
    /// Whether there is a sun.
    pub has_sun: bool,
    /// Whether there is haze.
    pub has_haze: bool,
}

/// What comes down, and what vehicles throw up.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct FlatWeather {
    /// As in [`SnowLeft`]; none where snow lies as it fell.
    pub shares: Table<u8>,
    /// As in [`SnowLeft`].
    pub size: [u32; 2],
    /// As in [`SnowLeft`].
    pub origin: Vec2,
    /// As in [`SnowLeft`].
    pub cell_m: f32,
    /// As in [`ComesDown`], if there is snow.
    pub snow: f32,
    /// As in [`ComesDown`].
    pub rain_mm_h: f32,
    /// As in [`ComesDown`].
    pub moment_s: f32,
    /// As in [`Spray`]; none where there is no spray.
    pub plumes: Table<Plume>,
    /// As in [`Spray`].
    pub puffs: Table<Puff>,
    /// Whether there is snow.
    pub has_snow: bool,
}

/// A scene with its materials and its lights.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct FlatWorld {
    /// What rays meet.
    pub scene: FlatScene,
    /// By instance.
    pub stands: Table<Stand>,
    /// By mesh.
    pub looks: Table<FlatLook>,
    /// Indices of materials by slot, of all instances.
    pub slots: Table<u32>,
    /// What they are made of.
    pub materials: FlatMaterials,
    /// What they are lit by.
    pub lights: FlatLights,
    /// Nodes of the field of light in the air; none where it is not read.
    pub nodes: Table<Node>,
    /// As in [`LightField`].
    pub lowest: [IVec3; GRIDS],
    /// Droplets of the air, if there are any.
    pub fog: Fog,
    /// Whether there are.
    pub has_fog: bool,
    /// What comes down.
    pub weather: FlatWeather,
}

/// A world whose tables are vouched for.
pub struct ReadableWorld<'a> {
    world: &'a FlatWorld,
    lights: Lights<'a, FlatTexture>,
    field: Option<LightField<'a>>,
    spray: Option<Spray<'a>>,
    /// What comes down where a path has arrived.
    exposure: Exposure,
}

impl FlatWorld {
    /// The world as paths find it.
    ///
    /// # Safety
    /// All tables have to be there and to stay as they are, and their indices have to be of what they index; something has to
    /// be in the scene.
    #[inline(always)]
    pub unsafe fn readable(&self) -> ReadableWorld<'_> {
        // SAFETY: the caller vouches for all tables.
        unsafe {
            let nodes = self.nodes.values();
            let field = (!nodes.is_empty()).then_some(LightField { lowest: self.lowest, nodes });
            let lights = self.lights.readable(&self.materials.lookups.values()[0]);
            let (plumes, puffs) = (self.weather.plumes.values(), self.weather.puffs.values());
            let spray = (!plumes.is_empty()).then_some(Spray { plumes, puffs });
            ReadableWorld { world: self, lights, field, spray, exposure: Exposure::BARE }
        }
    }
}

impl FlatLights {
    /// # Safety
    /// As for [`FlatWorld::readable`].
    #[inline(always)]
    unsafe fn readable<'a>(&'a self, lookups: &'a Lookups) -> Lights<'a, FlatTexture> {
        // SAFETY: the caller vouches for all tables.
        unsafe {
            let [width, height] = self.picture_size.map(|size| size as usize);
            let cells = Cells {
                side: self.side as usize,
                cells: self.cells.values(),
                patches: &self.patches.values()[0],
                within: self.within.values(),
                cumulative: self.cumulative.values(),
                guide: self.guide.values(),
            };
            let picture = Picture { width, height, rgb: self.picture.values() };
            let beams = Beams { tables: self.tables.values(), numbers: self.numbers.values() };
            let triangles = self.triangles.values();
            let tree = Tree {
                groups: self.groups.values(),
                order: self.order.values(),
                leaf_of: self.leaf_of.values(),
                aims: self.aims.values(),
                beams,
            };
            let emitters = Emitters { triangles, patterns: self.patterns.values(), tree };
            Lights {
                lookups,
                sun: self.has_sun.then_some(self.sun),
                haze: self.has_haze.then_some(self.haze),
                sky: Sky { picture, is_smooth: self.is_smooth, cells },
                beams,
                emitters: (!triangles.is_empty()).then_some(emitters),
                emitter_share: self.emitter_share,
                scale: self.scale,
            }
        }
    }
}

impl ReadableWorld<'_> {
    /// The same where so much comes down, as [`Self::exposure`] has it.
    #[inline(always)]
    pub fn under(self, exposure: Exposure) -> Self {
        Self { exposure, ..self }
    }

    /// What comes down where a ray meets something.
    #[inline(always)]
    pub fn exposure(&self, hit: &Hit, ray: &Ray) -> Exposure {
        let weather = &self.world.weather;
        if !weather.has_snow && self.material(hit).wetness <= 0.0 {
            return Exposure::BARE;
        }
        // SAFETY: whoever made it vouches for all tables.
        let shares = unsafe { weather.shares.values() };
        let FlatWeather { size, origin, cell_m, rain_mm_h, moment_s, .. } = *weather;
        let what = ComesDown {
            snow: weather.has_snow.then_some(weather.snow),
            left: (!shares.is_empty()).then_some(SnowLeft { origin, cell_m, size, shares }),
            rain_mm_h,
            moment_s,
        };
        let (stand, triangle, (world_from_mesh, world_from_normal)) = self.triangle(hit, ray.time);
        let surface = Surface::new(&triangle, hit, ray.direction, world_from_mesh, world_from_normal);
        exposure(&what, stand.bears, &surface, ray, |looking| {
            let asked = Asked { ray: *looking, past: 0, marks: SHELTERS, through_glass: 0 };
            // SAFETY: as above.
            unsafe { self.world.scene.is_blocked(&asked) }
        })
    }

    /// Leaves of light along a ray what nothing keeps back: nothing behind what is solid, and behind panes what goes straight
    /// through them.
    #[inline(always)]
    pub fn let_through(&self, ray: &Ray, light: Vec3) -> Vec3 {
        let scene = Readable(&self.world.scene);
        let mut left = light;
        let asked = Asked { ray: *ray, past: 0, marks: 0, through_glass: 0 };
        let keeps_back = |hit: &Hit| {
            if !scene.is_seen(hit, &asked) {
                return false;
            }
            left *= self.straight_through(hit, ray);
            left == Vec3::ZERO
        };
        let blocked = trace::any(&scene, ray, |_| true, keeps_back).is_some();
        if blocked { Vec3::ZERO } else { left }
    }

    /// Share of light that goes straight through the surface at a hit.
    #[inline(always)]
    fn straight_through(&self, hit: &Hit, ray: &Ray) -> Vec3 {
        let material = self.material(hit);
        if material.transmission <= 0.0 {
            return Vec3::ZERO;
        }
        let (_, triangle, (_, world_from_normal)) = self.triangle(hit, ray.time);
        let [a, b, c] = triangle.positions;
        let normal = unit_or(world_from_normal * (b - a).cross(c - a), Vec3::Z);
        material.straight_through(&self.lookups().lobes, normal.dot(ray.direction))
    }

    #[inline(always)]
    fn stand(&self, instance: u32) -> &Stand {
        // SAFETY: whoever made it vouches for all tables.
        unsafe { &self.world.stands.values()[instance as usize] }
    }

    #[inline(always)]
    fn look(&self, instance: u32) -> &FlatLook {
        // SAFETY: as above.
        unsafe {
            let mesh = self.world.scene.placements.values()[instance as usize].mesh;
            &self.world.looks.values()[mesh as usize]
        }
    }

    #[inline(always)]
    fn material(&self, hit: &Hit) -> &Material<FlatTexture> {
        let (stand, look) = (self.stand(hit.instance), self.look(hit.instance));
        // SAFETY: as above.
        unsafe {
            let slots = look.slots.values();
            let slot = if slots.is_empty() { 0 } else { u32::from(slots[hit.triangle as usize]) };
            let index = self.world.slots.values()[(stand.materials + slot) as usize];
            &self.world.materials.materials.values()[index as usize]
        }
    }

    /// What is known of the triangle at a hit, and how its mesh's points and normals are taken to World at a ray's time.
    #[inline(always)]
    fn triangle(&self, hit: &Hit, time: f32) -> (&Stand, Triangle, (Affine3A, Mat3A)) {
        let (stand, look) = (self.stand(hit.instance), self.look(hit.instance));
        // SAFETY: as above.
        unsafe {
            let corners = look.triangles.values()[hit.triangle as usize].map(|corner| corner as usize);
            let (positions, normals) = (look.positions.values(), look.normals.values());
            let (uvs, tints) = (look.uvs.values(), look.tints.values());
            let triangle = Triangle {
                positions: corners.map(|i| positions[i]),
                normals: (!normals.is_empty()).then(|| corners.map(|i| normals[i])),
                uvs: (!uvs.is_empty()).then(|| corners.map(|i| uvs[i])),
                tints: (!tints.is_empty()).then(|| corners.map(|i| tints[i])),
                foot_z: look.foot_z,
            };
            let motion = self.world.scene.placements.values()[hit.instance as usize].motion;
            if motion == NONE || time == Motion::MIDDLE {
                return (stand, triangle, (stand.world_from_mesh, stand.world_from_normal));
            }
            let world_from_mesh = self.world.scene.motions.values()[motion as usize].at(time);
            (stand, triangle, (world_from_mesh, of_normals(&world_from_mesh)))
        }
    }
}

/// Takes a mesh's normals to World: the inverse transpose, not normalised, turned so that outside stays outside.
#[inline(always)]
pub fn of_normals(world_from_mesh: &Affine3A) -> Mat3A {
    let matrix = world_from_mesh.matrix3;
    matrix.inverse().transpose() * if matrix.determinant() < 0.0 { -1.0 } else { 1.0 }
}

impl World for ReadableWorld<'_> {
    type Map = FlatTexture;

    #[inline(always)]
    fn lookups(&self) -> &Lookups {
        self.lights.lookups
    }

    #[inline(always)]
    fn lights(&self) -> &Lights<'_, FlatTexture> {
        &self.lights
    }

    #[inline(always)]
    fn surface(&self, hit: &Hit, ray: &Ray) -> (Surface, &Material<FlatTexture>) {
        let (_, triangle, (world_from_mesh, world_from_normal)) = self.triangle(hit, ray.time);
        let surface = Surface::new(&triangle, hit, ray.direction, world_from_mesh, world_from_normal);
        (Surface { exposure: self.exposure, ..surface }, self.material(hit))
    }

    #[inline(always)]
    fn direction_mesh(&self, instance: u32, direction: Vec3) -> Vec3 {
        // SAFETY: as above.
        let placement = unsafe { &self.world.scene.placements.values()[instance as usize] };
        placement.mesh_from_world.transform_vector3(direction)
    }

    #[inline(always)]
    fn fog(&self) -> Option<&Fog> {
        self.world.has_fog.then_some(&self.world.fog)
    }

    #[inline(always)]
    fn field(&self) -> Option<&LightField<'_>> {
        self.field.as_ref()
    }

    #[inline(always)]
    fn spray(&self) -> Option<&Spray<'_>> {
        self.spray.as_ref()
    }
}
