//! Scenes in a card's memory: what scenes share is sent there once.

use std::any::Any;
use std::sync::Arc;

use rayon::prelude::*;
use trove_model::Mesh;
use trove_trace::field::LightField;
use trove_trace::path::{Arrival, Path, Sample, Shadows, Start};
use trove_trace::wave::{Counts, Step, Wave};
use trove_trace::{Exposure, FlatLook, FlatMesh, FlatTexture, FlatWorld, Hit, Table};

use super::driver::{Buffer, Device};
use super::follow::{Steps, follow};
use super::world::world;
use crate::PreparedScene;
use crate::accel::{Flat, Hold, flat_map, flat_mesh};
use crate::cache::Cache;
use crate::remote::{RemoteScene, RemoteWave};
use crate::texture::MipMap;

/// Threads that start together; 64 to 256 differ by little.
pub(super) const BLOCK: u32 = 128;

/// What of earlier scenes is still there.
#[derive(Default)]
pub(super) struct Shared {
    meshes: Cache<Mesh, Held<(FlatMesh, FlatLook)>>,
    maps: Cache<MipMap, Held<FlatTexture>>,
}

/// Tables that lie in buffers.
struct Held<T> {
    tables: T,
    bytes: usize,
    _buffers: Vec<Buffer<u8>>,
}

/// A scene in a card's memory.
pub(super) struct Uploaded {
    device: Arc<Device>,
    /// Without a field of the light in its air.
    pub(super) world: FlatWorld,
    pub(super) bytes: usize,
    _held: Vec<Arc<dyn Any + Send + Sync>>,
}

impl Uploaded {
    /// Sends a scene in which something is.
    pub(super) fn new(
        device: &Arc<Device>,
        shared: &Shared,
        shapes: &Flat,
        scene: &PreparedScene,
    ) -> Result<Self, String> {
        shared.meshes.forget_unused();
        shared.maps.forget_unused();
        // One after the other below, but most of their time is the processor's.
        shapes.meshes().par_iter().try_for_each(|(mesh, foot_z)| shared.mesh(device, mesh, *foot_z).map(drop))?;
        let mut memory = Memory { device, shared: Some(shared), bytes: 0, buffers: Vec::new(), held: Vec::new() };
        let world = world(scene, shapes, &mut memory)?;
        let Memory { bytes, buffers, mut held, .. } = memory;
        held.push(Arc::new(buffers));
        Ok(Self { device: device.clone(), world, bytes, _held: held })
    }
}

impl Shared {
    fn mesh(
        &self,
        device: &Arc<Device>,
        mesh: &Arc<Mesh>,
        foot_z: f32,
    ) -> Result<Arc<Held<(FlatMesh, FlatLook)>>, String> {
        self.meshes.try_get(mesh, |mesh| Held::new(device, |memory| flat_mesh(memory, mesh, foot_z)))
    }

    fn map(&self, device: &Arc<Device>, map: &Arc<MipMap>) -> Result<Arc<Held<FlatTexture>>, String> {
        self.maps.try_get(map, |map| Held::new(device, |memory| flat_map(memory, map)))
    }
}

impl<T> Held<T> {
    fn new(device: &Arc<Device>, make: impl FnOnce(&mut Memory<'_>) -> Result<T, String>) -> Result<Self, String> {
        let mut memory = Memory { device, shared: None, bytes: 0, buffers: Vec::new(), held: Vec::new() };
        let tables = make(&mut memory)?;
        Ok(Self { tables, bytes: memory.bytes, _buffers: memory.buffers })
    }
}

/// What is kept there as long as somebody keeps this.
struct Memory<'a> {
    device: &'a Arc<Device>,
    shared: Option<&'a Shared>,
    bytes: usize,
    buffers: Vec<Buffer<u8>>,
    held: Vec<Arc<dyn Any + Send + Sync>>,
}

impl Memory<'_> {
    fn keep<T: Copy + Send + Sync + 'static>(&mut self, shared: Arc<Held<T>>) -> T {
        let tables = shared.tables;
        self.bytes += shared.bytes;
        self.held.push(shared);
        tables
    }
}

impl Hold for Memory<'_> {
    type Error = String;

    fn hold<T: Copy + Send + Sync + 'static>(&mut self, values: &[T]) -> Result<Table<T>, String> {
        let buffer = self.device.hold(values)?.into_bytes();
        let table = Table::at(buffer.address(), values.len());
        self.bytes += buffer.bytes();
        self.buffers.push(buffer);
        Ok(table)
    }

    fn mesh(&mut self, mesh: &Arc<Mesh>, foot_z: f32) -> Result<(FlatMesh, FlatLook), String> {
        match self.shared {
            Some(shared) => shared.mesh(self.device, mesh, foot_z).map(|held| self.keep(held)),
            None => flat_mesh(self, mesh, foot_z),
        }
    }

    fn map(&mut self, map: &Arc<MipMap>) -> Result<FlatTexture, String> {
        match self.shared {
            Some(shared) => shared.map(self.device, map).map(|held| self.keep(held)),
            None => flat_map(self, map),
        }
    }
}

impl RemoteScene for Uploaded {
    fn wave<'a>(&'a self, field: Option<LightField<'a>>, most: usize) -> Result<Box<dyn RemoteWave + 'a>, String> {
        UploadedWave::new(self, field, most).map(|wave| Box::new(wave) as Box<dyn RemoteWave>)
    }
}

/// A wave in a card's memory.
pub(super) struct UploadedWave<'a> {
    scene: &'a Uploaded,
    world: Buffer<FlatWorld>,
    wave: Buffer<Wave>,
    starts: Buffer<Start>,
    counts: Buffer<Counts>,
    samples: Buffer<Sample>,
    /// What the other tables of world and wave lie in.
    _held: Vec<Buffer<u8>>,
}

impl<'a> UploadedWave<'a> {
    pub(super) fn new(scene: &'a Uploaded, field: Option<LightField<'_>>, most: usize) -> Result<Self, String> {
        let device = &scene.device;
        let (nodes, lowest) = field.map_or((&[][..], Default::default()), |field| (field.nodes, field.lowest));
        let nodes_there = device.hold(nodes)?;
        let of_nodes = Table::at(nodes_there.address(), nodes.len());
        let world = device.hold(&[FlatWorld { nodes: of_nodes, lowest, ..scene.world }])?;
        let (starts, samples, counts) = (device.room(most)?, device.room(most)?, device.hold(&[Counts::default()])?);
        let (paths, hits) = (device.room::<Path>(most)?, device.room::<Hit>(most)?);
        let exposures = device.room::<Exposure>(most)?;
        let (arrivals, shadows) = (device.room::<Arrival>(most)?, device.room::<Shadows>(most)?);
        let (first, second) = (device.room::<u32>(most)?, device.room::<u32>(most)?);
        let wave = device.hold(&[Wave {
            starts: Table::at(starts.address(), most),
            paths: Table::at(paths.address(), most),
            hits: Table::at(hits.address(), most),
            exposures: Table::at(exposures.address(), most),
            arrivals: Table::at(arrivals.address(), most),
            shadows: Table::at(shadows.address(), most),
            active: [&first, &second].map(|list| Table::at(list.address(), most)),
            counts: Table::at(counts.address(), 1),
            samples: Table::at(samples.address(), most),
        }])?;
        let held = vec![
            nodes_there.into_bytes(),
            paths.into_bytes(),
            hits.into_bytes(),
            exposures.into_bytes(),
            arrivals.into_bytes(),
            shadows.into_bytes(),
            first.into_bytes(),
            second.into_bytes(),
        ];
        Ok(Self { scene, world, wave, starts, counts, samples, _held: held })
    }
}

impl Steps for UploadedWave<'_> {
    fn step(&mut self, step: Step, which: usize, count: usize) -> Result<(), String> {
        let name = match step {
            Step::Begin => c"begin",
            Step::Trace => c"trace",
            Step::Shelter => c"shelter",
            Step::Arrive => c"arrive",
            Step::Scatter => c"scatter",
            Step::Ask => c"ask",
            Step::Send => c"send",
            Step::Light => c"light",
            Step::End => c"end",
        };
        let (addresses, numbers) = ([self.world.address(), self.wave.address()], [which as u32, count as u32]);
        // SAFETY: world and wave are as `world` and `new` make them, and `follow` does the steps in order.
        unsafe { self.scene.device.function(name)?.launch(&addresses, &numbers, BLOCK) }
    }

    fn counts(&mut self) -> Result<Counts, String> {
        let mut counts = [Counts::default()];
        self.counts.read(&mut counts)?;
        self.counts.write(&[Counts::default()])?;
        Ok(counts[0])
    }
}

impl RemoteWave for UploadedWave<'_> {
    fn follow(&mut self, starts: &[Start], samples: &mut [Sample]) -> Result<u64, String> {
        self.starts.write(starts)?;
        let rays = follow(self, starts.len())?;
        self.samples.read(samples)?;
        Ok(rays)
    }
}
