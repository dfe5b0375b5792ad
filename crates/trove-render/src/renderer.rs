//! The renderer: kernel, denoiser and threads, kept from one scene to the next.

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};

use trove_model::{
    Capture, CaptureStats, Color, GridShot, LidarShot, Occupancy, PointCloud, Points, RadarDetection, RadarShot,
    Raster, Scene, Sensor, Shot,
};

use crate::accel::{self, Kernel, KernelChoice};
use crate::card::{self, Card, CardRate, Emulated, Machine};
use crate::denoise::{Denoiser, Denoising, blended};
use crate::light::LastSurroundings;
use crate::path::Ended;
use crate::remote::Place;
use crate::texture::Textures;
use crate::{PreparedScene, RayTimes, RenderError, drops, film, labels, lidar, path, radar, scan, voxels};

/// How to set a renderer up.
#[derive(Clone, Debug, Default)]
pub struct RendererOptions {
    /// Which ray-tracing kernel.
    pub kernel: KernelChoice,
    /// How pictures are denoised where a denoiser is installed.
    pub denoise: Denoising,
    /// Who follows light.
    pub device: DeviceChoice,
    /// Threads; 0 is one for every core.
    pub threads: usize,
    /// Files, or folders with them, in which Embree and Open Image Denoise are looked for before the system's folders.
    pub search: Vec<PathBuf>,
}

/// Who follows the paths of pictures. Labels are always the processor's.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DeviceChoice {
    /// The first graphics card that can be used, else the processor.
    Auto,
    /// The processor.
    #[default]
    Cpu,
    /// NVIDIA's card of a number, counted from 0; an error where there is none that could be used.
    Cuda(u32),
    /// A card's functions and tables on the processor, slower than the processor's own: what a card is checked against.
    Emulated,
}

/// What a renderer works with.
#[derive(Clone, Debug)]
pub struct Capabilities {
    /// Name and version of the ray-tracing kernel.
    pub kernel: String,
    /// Name and version of the denoiser, or why there is none.
    pub denoiser: Result<String, String>,
    /// The kind of processor whose instructions kernel and denoiser choose among, on which last digits depend
    /// (`x86-64-v3`); `None` where every machine gives the same.
    pub device: Option<String>,
    /// The graphics card that follows light; `None` where the processor does.
    pub card: Option<String>,
    /// Threads that it uses.
    pub threads: usize,
}

/// Turns scenes into captures.
pub struct Renderer {
    kernel: Box<dyn Kernel>,
    denoiser: Result<Denoiser, String>,
    card: Option<Box<dyn Machine>>,
    textures: Textures,
    surroundings: LastSurroundings,
    pool: rayon::ThreadPool,
}

impl Renderer {
    /// Loads the kernel and the denoiser, opens the card and starts the threads.
    ///
    /// # Errors
    /// A kernel that was asked for and is not installed, a card that cannot be used, or threads that the system refuses to
    /// start.
    pub fn new(options: &RendererOptions) -> Result<Self, RenderError> {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(options.threads)
            .thread_name(|i| format!("render-{i}"))
            .build()
            .map_err(|source| RenderError::Threads { threads: options.threads, source })?;
        let kernel = accel::kernel(options.kernel, &options.search)?;
        let denoiser = match options.denoise {
            Denoising::None => Err("not asked for".into()),
            how => Denoiser::load(&options.search, pool.current_num_threads(), how).map_err(|e| e.to_string()),
        };
        let card = card(options.device)?;
        let (textures, surroundings) = (Textures::default(), LastSurroundings::default());
        Ok(Self { kernel, denoiser, card, textures, surroundings, pool })
    }

    /// The same, with another machine to follow light.
    #[cfg(test)]
    pub(crate) fn with(self, machine: Box<dyn Machine>) -> Self {
        Self { card: Some(machine), ..self }
    }

    /// What this renderer works with.
    pub fn capabilities(&self) -> Capabilities {
        Capabilities {
            kernel: self.kernel.name(),
            denoiser: self.denoiser.as_ref().map(Denoiser::name).map_err(Clone::clone),
            device: (!self.kernel.is_same_everywhere() || self.denoiser.is_ok()).then(device),
            card: self.card.as_ref().map(|card| card.name().to_owned()),
            threads: self.pool.current_num_threads(),
        }
    }

    /// Checks a scene and makes it ready, also while a picture of another one is taken; what it shares with earlier
    /// scenes (by `Arc`) is not made again.
    ///
    /// # Errors
    /// A mesh, material or instance that breaks the rules of [`Scene`], which the error names, or a kernel that cannot build
    /// its tree, such as for want of memory.
    pub fn prepare(&self, scene: &Scene) -> Result<PreparedScene, RenderError> {
        self.pool.install(|| {
            let mut prepared = PreparedScene::new(scene, &*self.kernel, &self.textures, &self.surroundings)?;
            if let Some(card) = &self.card {
                prepared.place = card.take(&prepared).map_or_else(Place::Refused, Place::There);
            }
            Ok(prepared)
        })
    }

    /// Runs `work` on this thread; what it spawns takes one of the renderer's threads, besides the pictures that `work` takes.
    /// Spawned before a picture, it starts at once.
    pub fn beside<'scope, R>(&self, work: impl FnOnce(&rayon::Scope<'scope>) -> R) -> R {
        self.pool.in_place_scope(work)
    }

    /// Measures how long the rays of one sample a pixel take one thread, and the bare kernel.
    pub fn ray_times(&self, scene: &PreparedScene, shot: &Shot) -> RayTimes {
        self.pool.install(|| path::ray_times(scene, shot))
    }

    /// Measures how fast a card traces the rays of one sample a pixel, and compares what it finds; and how
    /// many bytes the scene takes there.
    ///
    /// # Errors
    /// What the card refuses: most likely it is full.
    pub fn card_rates(
        &self,
        scene: &PreparedScene,
        shot: &Shot,
        card: &Card,
    ) -> Result<(Vec<CardRate>, usize), String> {
        card::card_rates(scene, shot, card)
    }

    /// The pixels through whose centres two scenes, each with itself made ready, differ in what is met first: in class,
    /// place or look. Shadows, reflections and light alone are no difference.
    pub fn changes(
        &self,
        before: (&Scene, &PreparedScene),
        after: (&Scene, &PreparedScene),
        shot: &Shot,
    ) -> Raster<bool> {
        self.pool.install(|| labels::changes([before, after], shot))
    }

    /// What the rays of a sensor meet first, each at its own time: holes of cut-outs and the sensor's carrier are not there,
    /// panes of glass are.
    pub fn scan(&self, scene: &PreparedScene, sensor: &dyn Sensor) -> Points {
        self.pool.install(|| scan::scan(scene, sensor))
    }

    /// Makes a LiDAR's sweep: docs/lidar.md says by which model.
    pub fn sweep(&self, scene: &PreparedScene, shot: &LidarShot) -> PointCloud {
        self.pool.install(|| lidar::sweep(scene, shot))
    }

    /// Fills the cells of a grid: docs/grids.md says how.
    pub fn occupancy(&self, scene: &PreparedScene, shot: &GridShot) -> Occupancy {
        self.pool.install(|| voxels::occupancy(scene, shot))
    }

    /// Makes a radar's cycle, nearest detections first: docs/radar.md says by which model.
    pub fn detections(&self, scene: &PreparedScene, shot: &RadarShot) -> Vec<RadarDetection> {
        self.pool.install(|| radar::detections(scene, shot))
    }

    /// Takes a picture with its labels, or with `light` false the labels alone.
    ///
    /// `stop` is told the share of the work that is done, from any thread; once it answers true, nothing is returned.
    pub fn render(
        &self,
        scene: &PreparedScene,
        shot: &Shot,
        light: bool,
        stop: &(dyn Fn(f32) -> bool + Sync),
    ) -> Option<Capture> {
        let stopped = AtomicBool::new(false);
        let stop = |share: f32| {
            if stop(share) {
                stopped.store(true, Ordering::Relaxed);
            }
            stopped.load(Ordering::Relaxed)
        };
        self.pool.install(|| {
            if stop(0.0) {
                return None;
            }
            let labels = || labels::render(scene, shot, &|| stop(0.0));
            let seen = || light.then(|| self.radiance(scene, shot, &stop));
            let (labels, seen) = match scene.place {
                // A card follows light while the processor makes labels.
                Place::There(_) => rayon::join(labels, seen),
                Place::Here | Place::Refused(_) => (Some(labels()?), seen()),
            };
            let labels = labels?;
            let Some(seen) = seen else {
                return Some(Capture { color: None, labels, change: None, stats: CaptureStats::default() });
            };
            let (mut radiance, mut stats) = seen?;
            if let Some(falling) = scene.falling {
                path::falling::draw(scene, shot, falling, &labels.depth_m, &mut radiance);
            }
            if let Some(drops) = shot.drops {
                // Its share of the work is not told: the picture's has been.
                let (around, wide) = self.radiance(scene, &drops::wide(shot), &|_| stop(1.0))?;
                stats.rays += wide.rays;
                stats.refused = stats.refused.or(wide.refused);
                drops::draw(shot, drops, &around, &mut radiance);
            }
            let (srgb, exposure_ev) = film::develop(&radiance, shot);
            Some(Capture { color: Some(Color { radiance, srgb, exposure_ev }), labels, change: None, stats })
        })
    }

    /// What comes to a shot's lens, denoised where there is a denoiser.
    fn radiance(
        &self,
        scene: &PreparedScene,
        shot: &Shot,
        stop: &(dyn Fn(f32) -> bool + Sync),
    ) -> Option<(Raster<[f32; 3]>, CaptureStats)> {
        let (remote, mut refused) = match &scene.place {
            Place::Here => (None, None),
            Place::Refused(why) => (None, Some(why.clone())),
            Place::There(remote) => (Some(&**remote), None),
        };
        let mut traced = path::trace(scene, shot, remote, stop);
        if let Err(Ended::Failed(why)) = traced {
            refused = Some(why);
            traced = path::trace(scene, shot, None, stop);
        }
        let buffers = traced.ok()?;
        let clean = match &self.denoiser {
            Ok(denoiser) => denoiser.denoise(&buffers.own, &buffers.albedo, &buffers.normal, buffers.spp),
            Err(_) => None,
        };
        let stats = CaptureStats { rays: buffers.rays, spp: buffers.spp, denoised: clean.is_some(), refused };
        let blended = clean.map(|clean| blended(&clean, &buffers.radiance, &buffers.variance));
        Some((blended.unwrap_or(buffers.radiance), stats))
    }
}

/// The card that was asked for.
fn card(choice: DeviceChoice) -> Result<Option<Box<dyn Machine>>, RenderError> {
    let open = |number| Card::open(number).map(|card| Box::new(card) as Box<dyn Machine>);
    match choice {
        DeviceChoice::Cpu => Ok(None),
        DeviceChoice::Emulated => Ok(Some(Box::new(Emulated))),
        DeviceChoice::Cuda(number) => open(number).map(Some).map_err(|problem| RenderError::Card { number, problem }),
        DeviceChoice::Auto => Ok(open(0).inspect_err(|why| tracing::info!(%why, "no card is used")).ok()),
    }
}

/// The kind of this machine's processor, by the instructions that libraries choose code by.
fn device() -> String {
    #[cfg(target_arch = "x86_64")]
    let level = match () {
        () if is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512vl") => "x86-64-v4",
        () if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") => "x86-64-v3",
        () => "x86-64-v2",
    };
    #[cfg(not(target_arch = "x86_64"))]
    let level = std::env::consts::ARCH;
    level.into()
}
