//! A scene as tables of plain numbers, in a processor's memory or in a card's.

use core::marker::PhantomData;

use glam::{Affine3A, Vec2};

use crate::mask::Mask;
use crate::motion::Motion;
use crate::pair::Pair;
use crate::ray::{Hit, NONE, Ray};
use crate::sheared::Corners;
use crate::tables::{Mesh, Tables};
use crate::trace;

/// Where a row of values lies, in the memory of whoever reads it.
#[repr(C)]
pub struct Table<T> {
    address: u64,
    count: u64,
    holds: PhantomData<T>,
}

impl<T> Clone for Table<T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Table<T> {}

impl<T> Table<T> {
    /// `count` values from an address on.
    pub fn at(address: u64, count: usize) -> Self {
        Self { address, count: count as u64, holds: PhantomData }
    }

    /// Where the `i`-th value lies.
    #[inline(always)]
    pub(crate) fn place(&self, i: usize) -> *mut T {
        assert!((i as u64) < self.count);
        (self.address as *mut T).wrapping_add(i)
    }

    /// # Safety
    /// The values have to be there and stay as they are.
    #[inline(always)]
    pub(crate) unsafe fn values<'a>(&self) -> &'a [T] {
        if self.count == 0 {
            return &[];
        }
        // SAFETY: the caller vouches for the values.
        unsafe { core::slice::from_raw_parts(self.address as *const T, self.count as usize) }
    }
}

/// A mesh's triangles under their hierarchy, and what judging a hit on them takes.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct FlatMesh {
    /// As in [`Mesh`].
    pub pairs: Table<Pair>,
    /// As in [`Mesh`].
    pub corners: Table<Corners>,
    /// By number of the triangle.
    pub looks: Table<Look>,
    /// As in [`Mesh`].
    pub root: u32,
}

/// What a triangle shows.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Look {
    /// Texture coordinates of its corners.
    pub uvs: [Vec2; 3],
    /// Slot of its material.
    pub slot: u32,
}

/// Bits of what stands at the previous, and at the next, keyframe as it stands now.
pub const STAYS: [u32; 2] = [1, 2];

/// Bit of what keeps rain and snow off what is below.
pub const SHELTERS: u32 = 4;

/// A mesh somewhere in World.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Placement {
    /// At the moment of the labels.
    pub mesh_from_world: Affine3A,
    /// Index of its motion; [`NONE`] for what stands.
    pub motion: u32,
    /// Index of its mesh.
    pub mesh: u32,
    /// The object that it is part of; 0 for stuff.
    pub id: u32,
    /// [`STAYS`] and [`SHELTERS`], as far as they are true of it.
    pub marks: u32,
    /// Where the materials of its slots begin; [`NONE`] where none of them lets anything pass.
    pub materials: u32,
}

/// What a material lets pass.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct FlatOpacity {
    /// Blocks of the mask of its holes, if it has any, as in [`Mask`].
    pub holes: Table<u64>,
    /// As in [`Mask`].
    pub size: [i32; 2],
    /// What texture coordinates are multiplied by.
    pub scale: Vec2,
    /// 1 for a pane of glass, else 0.
    pub is_pane: u32,
}

/// A ray and what it passes through.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(16))]
pub struct Asked {
    /// The ray.
    pub ray: Ray,
    /// The object that it passes through; 0 for none.
    pub past: u32,
    /// Those of [`Placement::marks`] that an instance has to have.
    pub marks: u32,
    /// 1 if panes of glass are not there, else 0.
    pub through_glass: u32,
}

/// A two-level scene.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct FlatScene {
    /// Over the boxes of instances, as in [`Tables::top`].
    pub pairs: Table<Pair>,
    /// Instances in the order of the leaves.
    pub order: Table<u32>,
    /// What stands where.
    pub placements: Table<Placement>,
    /// How what moves does.
    pub motions: Table<Motion>,
    /// What stands there.
    pub meshes: Table<FlatMesh>,
    /// Indices of the materials of the slots of what is judged.
    pub materials: Table<u32>,
    /// By index of the material.
    pub opacities: Table<FlatOpacity>,
    /// As in [`Tables::top`].
    pub root: u32,
}

/// A scene whose tables are vouched for.
pub(crate) struct Readable<'a>(pub(crate) &'a FlatScene);

impl FlatScene {
    /// The nearest surface that a ray meets.
    ///
    /// # Safety
    /// All tables have to be there, and their indices have to be of what they index; something has to be in the scene.
    #[inline(always)]
    pub unsafe fn closest(&self, asked: &Asked) -> Option<Hit> {
        let scene = Readable(self);
        trace::closest(&scene, &asked.ray, |i| scene.is_entered(i, asked), |hit| scene.is_seen(hit, asked))
    }

    /// Whether it meets one.
    ///
    /// # Safety
    /// As for [`FlatScene::closest`].
    #[inline(always)]
    pub unsafe fn is_blocked(&self, asked: &Asked) -> bool {
        let scene = Readable(self);
        trace::any(&scene, &asked.ray, |i| scene.is_entered(i, asked), |hit| scene.is_seen(hit, asked)).is_some()
    }
}

impl Readable<'_> {
    #[inline(always)]
    fn placement(&self, instance: u32) -> &Placement {
        // SAFETY: whoever asks vouches for all tables.
        unsafe { &self.0.placements.values()[instance as usize] }
    }

    #[inline(always)]
    fn flat_mesh(&self, placement: &Placement) -> &FlatMesh {
        // SAFETY: as above.
        unsafe { &self.0.meshes.values()[placement.mesh as usize] }
    }

    #[inline(always)]
    fn is_entered(&self, instance: u32, asked: &Asked) -> bool {
        let Placement { id, marks, .. } = self.placement(instance);
        !(asked.past != 0 && *id == asked.past) && marks & asked.marks == asked.marks
    }

    /// Whether there is a surface at a hit, and neither a hole nor glass that the ray passes through.
    #[inline(always)]
    pub(crate) fn is_seen(&self, hit: &Hit, asked: &Asked) -> bool {
        let placement = self.placement(hit.instance);
        if placement.materials == NONE {
            return true;
        }
        // SAFETY: as above.
        let (looks, materials, opacities) =
            unsafe { (self.flat_mesh(placement).looks.values(), self.0.materials.values(), self.0.opacities.values()) };
        let Look { uvs, slot } = &looks[hit.triangle as usize];
        let opacity = &opacities[materials[(placement.materials + slot) as usize] as usize];
        // SAFETY: as above.
        let blocks = unsafe { opacity.holes.values() };
        let is_there = || {
            let [a, b, c] = *uvs;
            let uv = a * (1.0 - hit.u - hit.v) + b * hit.u + c * hit.v;
            blocks.is_empty() || Mask { size: opacity.size, blocks }.covers(uv * opacity.scale)
        };
        !(opacity.is_pane != 0 && asked.through_glass != 0) && is_there()
    }
}

impl Tables for Readable<'_> {
    #[inline(always)]
    fn top(&self) -> (&[Pair], u32) {
        // SAFETY: as above.
        (unsafe { self.0.pairs.values() }, self.0.root)
    }

    #[inline(always)]
    fn instance(&self, place: u32) -> u32 {
        // SAFETY: as above.
        unsafe { self.0.order.values()[place as usize] }
    }

    #[inline(always)]
    fn mesh(&self, instance: u32) -> Mesh<'_> {
        let mesh = self.flat_mesh(self.placement(instance));
        // SAFETY: as above.
        let (pairs, corners) = unsafe { (mesh.pairs.values(), mesh.corners.values()) };
        Mesh { pairs, corners, root: mesh.root }
    }

    #[inline(always)]
    fn mesh_from_world(&self, instance: u32, time: f32) -> Affine3A {
        let placement = self.placement(instance);
        if placement.motion == NONE || time == Motion::MIDDLE {
            return placement.mesh_from_world;
        }
        // SAFETY: as above.
        let motion = unsafe { &self.0.motions.values()[placement.motion as usize] };
        motion.at(time).inverse()
    }
}
