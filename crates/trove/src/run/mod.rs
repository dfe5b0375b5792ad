//! `trove generate`: from a recipe to a folder of labelled pictures, and on from where an earlier run ended.

mod estimate;
mod exports;
mod identity;
mod inputs;
mod journals;
mod manifest;
mod merging;
mod output;
mod portions;
mod private;
mod read;
mod share;
mod stored;

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{self, Receiver};
use std::time::{Duration, Instant};

use anyhow::{Context, Result, ensure};
use rayon::Scope;
use trove_build::Moments;
use trove_format::{
    Counterfactual, FrameFile, FrameRow, LanesFile, MadeRows, ManifestRows, RunIdentity, SiteFile, TrajectoryFile,
    WrittenFile,
};
use trove_model::{
    AssetLibrary, Capture, GridForm, GridShot, LidarShot, Occupancy, Outcome, PointCloud, RadarDetection, RadarShot,
    Report, Scene, Shot, Viewpoint,
};
use trove_render::{Denoising, DeviceChoice, KernelChoice, PreparedScene, Renderer, RendererOptions};
use trove_write::{Frame, FrameFolders, FrameMeta, Grid, RadarCycle, Sweep, WriteError};

use crate::contents::Contents;
use crate::photographs::match_photographs;
use crate::progress::Progress;
use crate::recipe::{GridSection, LibrarySource, Recipe};
use crate::sources::Sources;
use crate::virtual_scene::VirtualScene;
use crate::watch::Watch;
use crate::{library, message};
pub use estimate::{Estimate, estimate};
pub(crate) use manifest::fit_rows;
use manifest::{FrameKey, Sensed, SiteSummary, planned, variation_folder};
use output::OutputFolder;
pub(crate) use output::{begun_with, is_whole, part_folders, recipe_of, refuse_foreign};
use portions::{Portion, portions};
pub(crate) use private::PRIVATE;
use read::Read;
use share::Slice;
pub use share::{MOST_SHARES, Share};
pub(crate) use stored::journals;

/// Frames that are encoded and written at once: pictures are large.
const WRITING: usize = 2;
/// A trial begins no further frame of a kind after as long.
const TRIAL: Duration = Duration::from_secs(10);

/// How to run, beside the recipe; none of it changes the labels.
pub struct RunOptions {
    /// Where the recipe lies, for a later `trove merge`.
    pub recipe_file: Option<PathBuf>,
    /// Ray kernel.
    pub kernel: KernelChoice,
    /// Who follows light.
    pub device: DeviceChoice,
    /// Files and folders to look for Embree and Open Image Denoise in.
    pub search: Vec<PathBuf>,
    /// Paths of the only frames to render (`scene-0103/v00/k005/ego.CAM_FRONT`); `None`: all that the recipe asks for.
    pub frames: Option<BTreeSet<String>>,
    /// Which part of the frames to render, to be merged by a later run; `None`: all, and what sums them up.
    pub share: Option<Share>,
    /// Folders with frames of the same recipe that are taken over.
    pub adopt: Vec<PathBuf>,
    /// To measure, of one moment of one scene: what is begun in ten seconds, of each kind of frame by itself.
    pub trial: bool,
    /// Whom the run tells how far it is, and who may end it.
    pub watch: Watch,
}

/// What a run did.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// Frames that the recipe asks for, or the part of them that was to be rendered, as far as they are known.
    pub frames: usize,
    /// Frames rendered by this run.
    pub rendered: Vec<RenderedFrame>,
    /// Whether it was asked to end before all were done.
    pub interrupted: bool,
    /// What else took how long.
    pub timings: Timings,
}

/// What took how long in a run, apart from the pictures.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Timings {
    /// Threads that rendered.
    pub threads: usize,
    /// Until the first scene, seconds.
    pub setup_s: f64,
    /// Reading and building scenes, seconds.
    pub building_s: f64,
    /// In a trial: making the first moment of a scene ready, and a further one, seconds.
    pub preparing_s: [f64; 2],
    /// In a trial: encoding and writing, by the frame's path, seconds.
    pub writing_s: BTreeMap<String, f64>,
}

/// A frame that a run rendered, and how long it took.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderedFrame {
    /// Its folder below the output folder.
    pub path: String,
    /// Waiting until the scene was ready, seconds; 0 where an earlier frame's scene was still there.
    pub prepare_s: f64,
    /// Picture and labels, seconds, without writing them.
    pub render_s: f64,
}

/// Runs a recipe; what `out` already holds of it is kept.
///
/// # Errors
/// Input that cannot be read, a place that cannot be built or rendered, an output folder that holds another run or that
/// another process writes to, or a file system that refuses.
pub fn generate(recipe: &Recipe, out: &Path, options: &RunOptions) -> Result<Summary> {
    let started = Instant::now();
    exports::check(recipe, out)?;
    let renderer = Renderer::new(&RendererOptions {
        kernel: options.kernel,
        // Labels are the processor's: no scene need be sent to a card for them.
        device: if recipe.follows_light() { options.device } else { DeviceChoice::Cpu },
        denoise: recipe.denoising(),
        threads: recipe.render.threads,
        search: options.search.clone(),
    })?;
    let report = Report::default();
    if let (true, Err(why)) = (recipe.denoising() != Denoising::None, renderer.capabilities().denoiser) {
        tracing::warn!("images stay noisy: no denoiser ({why}); pip install pyoidn, or set TROVE_OIDN");
        report.note(Outcome::Warned, "images stay noisy: no denoiser", why);
    }
    let sources = Sources::open(recipe, &report)?;
    let scenes = scenes(&sources, &report)?;
    let mut contents = Contents::open();
    let identity = identity::of_run(recipe, &options.search, &renderer, &sources, &mut contents)?;
    let mut output = OutputFolder::open(out, &identity, options.share)?;
    let folders = FrameFolders::made_by(output.root(), output.maker.clone());
    if let Some(file) = &options.recipe_file {
        output.write_recipe_file(file)?;
    }
    for folder in &options.adopt {
        merging::adopt(folder, &identity, &mut output, &folders, &options.watch)?;
    }
    let frames = options.frames.as_ref();
    let portions = portions(recipe, &scenes, frames, options.share);
    let planned = portions.iter().flatten().flatten().map(|portion| portion.frames_hint).sum();
    let of_all =
        self::portions(recipe, &scenes, frames, None).iter().flatten().flatten().map(|all| all.frames_hint).sum();
    let keyframes_and_cameras = identity::planned(recipe, &sources)?;
    // What is wrong with a user's models is in the report of every run; the built-in ones are not needed to merge.
    let is_built_in = recipe.libraries().iter().all(|source| matches!(source, LibrarySource::Procedural));
    let library =
        (!is_built_in).then(|| library::gather(recipe, &options.search, &mut contents, &report)).transpose()?;
    let mut run = Run {
        recipe,
        renderer: &renderer,
        sources,
        search: &options.search,
        library,
        contents,
        planned: keyframes_and_cameras,
        grid_forms: grid_forms(recipe)?,
        output,
        folders: Arc::new(folders),
        writing: VecDeque::new(),
        progress: Progress::new(planned, &options.watch),
        watch: &options.watch,
        report,
        frames,
        of_all,
        trial: options.trial,
        sites: Vec::new(),
        rendered: Vec::new(),
        timings: Timings {
            threads: renderer.capabilities().threads,
            setup_s: started.elapsed().as_secs_f64(),
            ..Timings::default()
        },
    };
    run.plan()?;
    for ((scene, _), portions) in scenes.iter().zip(portions) {
        if let Err(stop) = run.scene(scene, &portions) {
            let kept = run.settle();
            run.progress.finish();
            return match stop {
                Stop::Interrupted => {
                    kept?;
                    let frames = planned.max(run.rendered.len());
                    Ok(Summary { frames, rendered: run.rendered, interrupted: true, timings: run.timings })
                }
                Stop::Failed(error) => Err(error),
            };
        }
    }
    if options.share.is_some() {
        return run.finish_part();
    }
    let summary = run.finish(identity)?;
    let interrupted = !exports::write(recipe, out, &options.watch)?;
    Ok(Summary { interrupted, ..summary })
}

/// Names and keyframes of the scenes that a run makes.
fn scenes(sources: &Sources, report: &Report) -> Result<Vec<(String, usize)>> {
    let mut scenes = sources.scenes()?;
    scenes.retain(|(scene, _)| {
        let possible = !FrameFolders::RESERVED.contains(&scene.as_str());
        if !possible {
            report.note(Outcome::Dropped, "scene with the name of a file of the output folder", scene);
        }
        possible
    });
    Ok(scenes)
}

/// How the grids of a recipe are written, by their views.
fn grid_forms(recipe: &Recipe) -> Result<BTreeMap<String, GridForm>> {
    let form =
        |(name, grid): (&String, &GridSection)| Ok((format!("ego.{name}"), grid.plan(|file| recipe.at(file))?.form));
    recipe.grids.iter().map(form).collect()
}

/// Why a run ends early.
enum Stop {
    Interrupted,
    Failed(anyhow::Error),
}

impl<E: Into<anyhow::Error>> From<E> for Stop {
    fn from(error: E) -> Self {
        Self::Failed(error.into())
    }
}

/// A run under way.
struct Run<'a> {
    recipe: &'a Recipe,
    renderer: &'a Renderer,
    sources: Sources<'a>,
    /// Where the ingredients of models are looked for.
    search: &'a [PathBuf],
    /// The models, once something has to be built.
    library: Option<AssetLibrary>,
    contents: Contents,
    /// Which keyframes and cameras the recipe asks for.
    planned: serde_json::Value,
    /// How the grids of views are written.
    grid_forms: BTreeMap<String, GridForm>,
    output: OutputFolder,
    folders: Arc<FrameFolders>,
    /// Frames that are encoded and written while the next ones are rendered, in the order of rendering.
    writing: VecDeque<Receiver<(Written, f64)>>,
    progress: Progress,
    watch: &'a Watch,
    report: Report,
    frames: Option<&'a BTreeSet<String>>,
    /// Frames of the whole recipe, as far as they are known.
    of_all: usize,
    trial: bool,
    sites: Vec<SiteSummary>,
    rendered: Vec<RenderedFrame>,
    timings: Timings,
}

/// What was taken of a moment, to be written.
struct Job {
    /// Below the output folder.
    path: String,
    scene: Arc<Scene>,
    meta: FrameMeta,
    taken: Taken,
}

/// What was taken.
enum Taken {
    Frame { shot: Box<Shot>, capture: Box<Capture>, pictures: BTreeSet<FrameFile> },
    Sweep { shot: Box<LidarShot>, cloud: PointCloud },
    Radar { shot: Box<RadarShot>, detections: Vec<RadarDetection> },
    Grid { shot: Box<GridShot>, cells: Occupancy },
}

/// A frame's path and files.
type Written = Result<(String, Vec<WrittenFile>), WriteError>;

fn write(folders: &FrameFolders, Job { path, scene, meta, taken }: Job) -> Written {
    let files = match taken {
        Taken::Frame { shot, capture, pictures } => {
            folders.frame(&Frame::of(path.clone(), &scene, &shot, *capture, &meta)?, &pictures)?
        }
        Taken::Grid { shot, cells } => folders.grid(&Grid::of(path.clone(), &scene, &shot, cells, &meta))?,
        Taken::Sweep { shot, cloud } => folders.sweep(&Sweep::of(path.clone(), &scene, &shot, cloud, &meta))?,
        Taken::Radar { shot, detections } => {
            folders.radar(&RadarCycle::of(path.clone(), &scene, &shot, detections, &meta))?
        }
    };
    Ok((path, files))
}

/// A scene of one variation, ready to be photographed.
struct Built<'a> {
    scene: VirtualScene<'a>,
    /// Shots of each chosen moment.
    shots: Vec<(u32, Vec<Shot>)>,
    /// Sweeps of each chosen moment.
    sweeps: Vec<(u32, Vec<LidarShot>)>,
    /// Radars' cycles of each chosen moment.
    radars: Vec<(u32, Vec<RadarShot>)>,
    /// Grids of each chosen moment.
    grids: Vec<(u32, Vec<GridShot>)>,
}

/// A moment's scene, made ready.
struct Photographed {
    scene: Arc<Scene>,
    prepared: PreparedScene,
}

impl Run<'_> {
    /// All variations of one scene. A scene that cannot be read or built is reported and passed over.
    fn scene(&mut self, scene: &str, portions: &[Option<Portion>]) -> Result<(), Stop> {
        let read = Read::new(scene);
        // Of a counterfactual set v00, which the others are compared with.
        let mut base: Option<Built> = None;
        for (variation, portion) in (0..).zip(portions) {
            let Some(Portion { slice, frames_hint, of_hint }) = *portion else { continue };
            if self.trial && !self.sites.is_empty() {
                break;
            }
            let folder = variation_folder(scene, variation);
            let known = self.output.site(&folder)?;
            let missing = match &known {
                Some(site) => site.planned != self.planned || self.missing(scene, variation, site, slice)?,
                None => true,
            };
            let (file, built) = match (known, missing) {
                (Some(file), false) => (file, None),
                (known, _) => {
                    if let Some(known) = known {
                        read.refuse_another(&known, &self.sources, &mut self.contents)?;
                    }
                    self.progress.say(&format!("building {scene} v{variation:02}"));
                    match self.build(&read, variation) {
                        Ok((file, built)) => {
                            let moments = built.scene.moments;
                            let way = TrajectoryFile::new(moments.drive, |moment| moments.keyframe(moment));
                            let lanes = LanesFile::new(moments.drive, built.scene.site.roads());
                            self.output.write_site(&folder, &file, &way, &lanes)?;
                            (file, Some(built))
                        }
                        Err(error) => {
                            self.progress.correct(frames_hint, 0);
                            self.of_all = self.of_all.saturating_sub(of_hint);
                            self.plan()?;
                            let why = format!("{scene}: {}", message::of(&error));
                            self.progress.say(&format!("passed over: {why}"));
                            self.report.note(Outcome::Dropped, "scene", why);
                            continue;
                        }
                    }
                }
            };
            let wanted = self.wanted(scene, variation, &file, slice);
            self.progress.correct(frames_hint, wanted.len());
            self.of_all =
                (self.of_all + self.wanted(scene, variation, &file, Slice::ALL).len()).saturating_sub(of_hint);
            self.plan()?;
            let compares = built.is_some() && self.recipe.pictures(variation).contains(&FrameFile::Change);
            if compares && base.is_none() {
                base = Some(self.build(&read, 0)?.1);
            }
            self.frames(wanted, built.as_ref(), base.as_ref().filter(|_| compares))?;
            self.sites.push(SiteSummary { scene: scene.to_owned(), variation, file });
            if variation == 0 && self.recipe.variations.counterfactual.is_some() {
                base = built;
            }
        }
        Ok(())
    }

    /// Whether a frame of a built scene is not finished.
    fn missing(&mut self, scene: &str, variation: u32, site: &SiteFile, slice: Slice) -> Result<bool> {
        let wanted = self.wanted(scene, variation, site, slice);
        self.output.verify(&wanted.iter().map(FrameKey::path).collect::<Vec<_>>())?;
        for key in wanted {
            if self.finished(&key)?.is_none() {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// What is to be made of a variation of a scene, keyframe by keyframe.
    fn wanted(&self, scene: &str, variation: u32, file: &SiteFile, slice: Slice) -> Vec<FrameKey> {
        let mut keys = planned(scene, variation, file);
        keys.retain(|key| self.frames.is_none_or(|frames| frames.contains(&key.path())));
        let moments: BTreeSet<u32> = keys.iter().map(|key| key.keyframe).collect();
        let in_slice = moments.into_iter().enumerate().filter(|(place, _)| slice.has(*place));
        let in_slice: BTreeSet<u32> = in_slice.map(|(_, moment)| moment).collect();
        keys.retain(|key| in_slice.contains(&key.keyframe));
        if self.trial {
            let middle = keys.get(keys.len() / 2).map(|key| key.keyframe);
            keys.retain(|key| Some(key.keyframe) == middle);
        }
        keys
    }

    /// Writes down how much there is to do, for whoever looks at the folder.
    fn plan(&mut self) -> Result<()> {
        self.output.plan(self.progress.total(), self.of_all as u64)
    }

    fn finished(&mut self, key: &FrameKey) -> Result<Option<Vec<WrittenFile>>> {
        let files = match key.sensed {
            Sensed::Frame => FrameFolders::files(&self.recipe.pictures(key.variation)),
            Sensed::Sweep => Sweep::FILES.to_vec(),
            Sensed::Radar => RadarCycle::FILES.to_vec(),
            Sensed::Grid => {
                let form =
                    self.grid_forms.get(&key.view).with_context(|| format!("{}: a grid of no recipe", key.path()))?;
                Grid::files(*form).to_vec()
            }
        };
        self.output.finished(&key.path(), &files)
    }

    fn build<'r>(&mut self, read: &'r Read<'_>, variation: u32) -> Result<(SiteFile, Built<'r>)> {
        let started = Instant::now();
        let recording = read.recording(&self.sources, &mut self.contents)?.clone();
        let (timeline, map, report) = read.drive(&self.sources)?;
        let report = report.clone();
        let library = match self.library.take() {
            Some(library) => library,
            None => library::gather(self.recipe, self.search, &mut self.contents, &self.report)?,
        };
        let library = self.library.insert(library);
        let mut built = VirtualScene::build(&self.sources, (timeline, map.as_ref()), library, variation, &report)?;
        if self.recipe.views.match_photographs && variation == 0 {
            match_photographs(&mut built, &self.sources, self.renderer, &report)?;
        }
        let keyframes = match &self.recipe.drive {
            Some(section) => section.keyframes.of(timeline.recorded.keyframes.len())?,
            None => (0..timeline.recorded.keyframes.len()).collect(),
        };
        let moments = timeline.moments().chosen(&keyframes);
        let shots: Vec<(u32, Vec<Shot>)> = moments.iter().map(|&k| (k as u32, built.shots(k, &report))).collect();
        let sweeps: Vec<(u32, Vec<LidarShot>)> = moments.iter().map(|&k| (k as u32, built.lidar_shots(k))).collect();
        let radars: Vec<(u32, Vec<RadarShot>)> = moments.iter().map(|&k| (k as u32, built.radar_shots(k))).collect();
        let grids = shots.iter().zip(&sweeps);
        let grids: Vec<(u32, Vec<GridShot>)> =
            grids.map(|((k, shots), (_, sweeps))| (*k, built.grid_shots(*k as usize, shots, sweeps))).collect();
        ensure!(shots.iter().any(|(_, shots)| !shots.is_empty()), "expected at least one view, found none");
        let file = SiteFile {
            drive: (&timeline.recorded).into(),
            sources: built.site.provenance().iter().map(Into::into).collect(),
            report: (&report).into(),
            fits: fit_rows(built.site.fits()),
            factors: built.factors.clone(),
            locale: Some((&built.locale).into()),
            recording,
            planned: self.planned.clone(),
            frames: shots.iter().flat_map(|(k, shots)| shots.iter().map(|s| (*k, s.view.clone()))).collect(),
            sweeps: sweeps.iter().flat_map(|(k, shots)| shots.iter().map(|s| (*k, s.view.clone()))).collect(),
            radars: radars.iter().flat_map(|(k, shots)| shots.iter().map(|s| (*k, s.view.clone()))).collect(),
            grids: grids.iter().flat_map(|(k, shots)| shots.iter().map(|s| (*k, s.view.clone()))).collect(),
        };
        self.timings.building_s += started.elapsed().as_secs_f64();
        Ok((file, Built { scene: built, shots, sweeps, radars, grids }))
    }

    /// Renders what is missing of what is wanted of a scene; `base` is what its pictures are compared with.
    fn frames(
        &mut self,
        wanted: Vec<FrameKey>,
        built: Option<&Built<'_>>,
        base: Option<&Built<'_>>,
    ) -> Result<(), Stop> {
        let mut missing: Vec<(u32, Vec<FrameKey>)> = Vec::new();
        for key in wanted {
            if self.finished(&key)?.is_some() {
                self.progress.frame_found();
                continue;
            }
            match missing.last_mut() {
                Some((last, keys)) if *last == key.keyframe => keys.push(key),
                _ => missing.push((key.keyframe, vec![key])),
            }
        }
        let Some((_, keys)) = missing.first() else { return Ok(()) };
        let built = built.with_context(|| format!("{}: removed during the run", keys[0].path()))?;
        let renderer = self.renderer;
        let ready = &|keyframe| -> Result<_> {
            let before = base.map(|base| base.photographed(renderer, keyframe)).transpose()?;
            Ok((built.photographed(renderer, keyframe)?, before))
        };
        if self.trial {
            for (moment, seconds) in [keys[0].keyframe, built.beside(keys[0].keyframe)].into_iter().zip(0..) {
                let started = Instant::now();
                ready(moment)?;
                self.timings.preparing_s[seconds] = started.elapsed().as_secs_f64();
            }
        }
        // A keyframe is made ready, mostly by one core, and frames are written, while further pictures are taken.
        renderer.beside(|threads| {
            let mut ahead = missing.iter().map(|(keyframe, keys)| {
                let (made, waiting) = mpsc::channel();
                // Nobody waits any more once a frame has failed.
                threads.spawn(move |_| drop(made.send(ready(*keyframe))));
                (keys, waiting)
            });
            let mut next = ahead.next();
            while let Some((keys, waiting)) = next {
                let started = Instant::now();
                // Without an answer it has panicked, and the panic goes on when this returns.
                let (photographed, before) = waiting.recv().context("a scene could not be made ready")??;
                next = ahead.next();
                let mut prepare_s = started.elapsed().as_secs_f64();
                let mut tried = BTreeMap::new();
                for key in keys {
                    if self.trial && tried.entry(key.sensed).or_insert_with(Instant::now).elapsed() > TRIAL {
                        continue;
                    }
                    let prepare_s = std::mem::take(&mut prepare_s);
                    let job = match key.sensed {
                        Sensed::Frame => self.frame(key, built, &photographed, before.as_ref(), prepare_s)?,
                        Sensed::Sweep => {
                            let shot = key.of(&built.sweeps, |shot| &shot.view)?;
                            self.beside(key, built, &photographed, prepare_s, |renderer, scene| Taken::Sweep {
                                shot: Box::new(shot.clone()),
                                cloud: renderer.sweep(scene, shot),
                            })?
                        }
                        Sensed::Radar => {
                            let shot = key.of(&built.radars, |shot| &shot.view)?;
                            self.beside(key, built, &photographed, prepare_s, |renderer, scene| Taken::Radar {
                                shot: Box::new(shot.clone()),
                                detections: renderer.detections(scene, shot),
                            })?
                        }
                        Sensed::Grid => {
                            let shot = key.of(&built.grids, |shot| &shot.view)?;
                            self.beside(key, built, &photographed, prepare_s, |renderer, scene| Taken::Grid {
                                shot: Box::new(shot.clone()),
                                cells: renderer.occupancy(scene, shot),
                            })?
                        }
                    };
                    self.write(threads, job)?;
                    if self.trial {
                        // Times of their own: nothing is written beside what is rendered.
                        self.record(0)?;
                    }
                    self.progress.frame_done();
                }
            }
            Ok(())
        })
    }

    /// Renders one frame.
    fn frame(
        &mut self,
        key: &FrameKey,
        built: &Built<'_>,
        photographed: &Photographed,
        before: Option<&Photographed>,
        prepare_s: f64,
    ) -> Result<Job, Stop> {
        let (shot, moments) = (key.of(&built.shots, |shot| &shot.view)?, built.scene.moments);
        self.progress.say(&key.path());
        let within = |share: f32| {
            self.progress.within(share);
            self.watch.stops()
        };
        let started = Instant::now();
        let Photographed { scene, prepared } = photographed;
        let capture = self.renderer.render(prepared, shot, self.recipe.follows_light(), &within);
        let Some(mut capture) = capture else { return Err(Stop::Interrupted) };
        let after = (&**scene, prepared);
        capture.change = before.map(|b| self.renderer.changes((&b.scene, &b.prepared), after, shot));
        let render_s = started.elapsed().as_secs_f64();
        if let Some(why) = &capture.stats.refused {
            self.report.note(Outcome::Warned, "light followed by the processor instead of the card", why);
        }
        let moment = &moments.drive.keyframes[key.keyframe as usize];
        let exposure = match shot.viewpoint {
            Viewpoint::Recording { camera } => moment.exposures.iter().find(|e| e.camera == camera),
            Viewpoint::OtherVehicle { .. } | Viewpoint::Free => None,
        };
        let meta = FrameMeta {
            source_token: exposure.and_then(|e| e.token.clone()),
            source_image: exposure.and_then(|e| e.file.clone()),
            ..meta(key, moments)
        };
        let path = key.path();
        self.rendered.push(RenderedFrame { path: path.clone(), prepare_s, render_s });
        let pictures = self.recipe.pictures(key.variation);
        let taken = Taken::Frame { shot: Box::new(shot.clone()), capture: Box::new(capture), pictures };
        Ok(Job { path, scene: scene.clone(), meta, taken })
    }

    /// Makes what lies beside frames: a sweep, a radar's cycle or a grid.
    fn beside(
        &mut self,
        key: &FrameKey,
        built: &Built<'_>,
        photographed: &Photographed,
        prepare_s: f64,
        take: impl FnOnce(&Renderer, &PreparedScene) -> Taken,
    ) -> Result<Job, Stop> {
        let path = key.path();
        self.progress.say(&path);
        let started = Instant::now();
        let taken = take(self.renderer, &photographed.prepared);
        self.rendered.push(RenderedFrame { path: path.clone(), prepare_s, render_s: started.elapsed().as_secs_f64() });
        Ok(Job { path, scene: photographed.scene.clone(), meta: meta(key, built.scene.moments), taken })
    }

    /// Lets one of the renderer's threads write a frame, once there is room for it.
    fn write(&mut self, threads: &Scope<'_>, job: Job) -> Result<(), Stop> {
        self.record(WRITING - 1)?;
        let (done, waiting) = mpsc::channel();
        let folders = self.folders.clone();
        threads.spawn(move |_| {
            let started = Instant::now();
            let written = write(&folders, job);
            drop(done.send((written, started.elapsed().as_secs_f64())));
        });
        self.writing.push_back(waiting);
        if self.watch.stops() { Err(Stop::Interrupted) } else { Ok(()) }
    }

    /// Writes down which frames are finished, and waits until no more than so many are not.
    fn record(&mut self, under_way: usize) -> Result<()> {
        while let Some(first) = self.writing.front() {
            let (written, seconds) = if self.writing.len() > under_way {
                // Without an answer its thread has panicked, and the panic goes on where the threads were lent.
                first.recv().context("a frame could not be written")?
            } else if let Ok(written) = first.try_recv() {
                written
            } else {
                break;
            };
            self.writing.pop_front();
            let (path, files) = written?;
            if self.trial {
                self.timings.writing_s.insert(path.clone(), seconds);
            }
            self.output.record(&path, files)?;
        }
        Ok(())
    }

    /// Waits until every frame is written and where it belongs.
    fn settle(&mut self) -> Result<()> {
        self.record(0)?;
        self.output.settle()
    }

    /// The manifest's row of what is finished.
    fn row(&mut self, key: &FrameKey, file: &SiteFile) -> Result<FrameRow> {
        let path = key.path();
        let files = self.finished(key)?.with_context(|| format!("{path}: removed during the run"))?;
        let is_compared = key.sensed == Sensed::Frame && key.variation > 0;
        let counterfactual = self.recipe.variations.counterfactual.filter(|_| is_compared);
        Ok(FrameRow {
            path,
            scene: key.scene.clone(),
            variation: key.variation,
            keyframe: key.keyframe,
            view: key.view.clone(),
            factors: file.factors.clone(),
            files: files.into_iter().map(|file| (file.name, file.sha256)).collect(),
            counterfactual: counterfactual.map(|factor| Counterfactual {
                factor: factor.name().into(),
                base: FrameKey { variation: 0, ..key.clone() }.path(),
            }),
        })
    }

    /// Ends a part, which has nothing to sum up.
    fn finish_part(mut self) -> Result<Summary> {
        self.settle()?;
        self.progress.finish();
        let frames = self.progress.total() as usize;
        Ok(Summary { frames, rendered: self.rendered, interrupted: false, timings: self.timings })
    }

    /// Writes what sums the run up.
    fn finish(mut self, identity: RunIdentity) -> Result<Summary> {
        self.settle()?;
        self.progress.finish();
        let sites = std::mem::take(&mut self.sites);
        let of_site = |site: &SiteSummary| {
            let mut keys = self.wanted(&site.scene, site.variation, &site.file, Slice::ALL);
            if self.trial {
                keys.retain(|key| self.rendered.iter().any(|frame| frame.path == key.path()));
            }
            keys
        };
        let keys: Vec<(&SiteSummary, FrameKey)> =
            sites.iter().flat_map(|site| of_site(site).into_iter().map(move |key| (site, key))).collect();
        if let Some(asked) = self.frames {
            let given: BTreeSet<String> = keys.iter().map(|(_, key)| key.path()).collect();
            for frame in asked.difference(&given) {
                self.report.note(Outcome::Dropped, "frame that the recipe does not produce", frame.clone());
            }
        }
        ensure!(!keys.is_empty(), "no scene could be built: {}", self.dropped_scenes());
        let pictures = keys.iter().filter(|(_, key)| key.sensed == Sensed::Frame);
        let pictures: Vec<String> = pictures.map(|(_, key)| key.path()).collect();
        let sheet = FrameFolders::in_sheet(&pictures);
        self.output.bring(&sheet)?;
        let manifest = manifest::manifest(self.recipe.seed, identity, &sites);
        let report = manifest::report(&self.report, &sites);
        let folders = self.folders.clone();
        // Of many frames the rows do not fit into memory.
        let run = RefCell::new(&mut self);
        let rows = |sensed: Sensed| -> MadeRows<'_> {
            let of_kind = keys.iter().filter(move |(_, key)| key.sensed == sensed);
            let row = |(site, key): &(&SiteSummary, FrameKey)| run.borrow_mut().row(key, &site.file);
            Box::new(of_kind.map(move |one| row(one).map_err(|error| message::of(&error))))
        };
        let rows = ManifestRows {
            frames: rows(Sensed::Frame),
            sweeps: rows(Sensed::Sweep),
            radars: rows(Sensed::Radar),
            grids: rows(Sensed::Grid),
        };
        folders.finish(&manifest, rows, &sheet, &report)?;
        self.output.finish()?;
        Ok(Summary { frames: keys.len(), rendered: self.rendered, interrupted: false, timings: self.timings })
    }

    fn dropped_scenes(&self) -> String {
        let entries = self.report.entries();
        let examples = entries.iter().filter(|e| e.outcome == Outcome::Dropped).flat_map(|e| e.examples.clone());
        examples.collect::<Vec<_>>().join("; ")
    }
}

impl Built<'_> {
    /// A moment beside another, where there is one.
    fn beside(&self, moment: u32) -> u32 {
        let moments = self.shots.iter().map(|(other, _)| *other).filter(|other| *other != moment);
        moments.min_by_key(|other| other.abs_diff(moment)).unwrap_or(moment)
    }

    fn photographed(&self, renderer: &Renderer, keyframe: u32) -> Result<Photographed> {
        let scene = Arc::new(self.scene.at(keyframe as usize));
        let prepared = renderer.prepare(&scene)?;
        Ok(Photographed { scene, prepared })
    }
}

/// What is told of a view that clones no recorded picture and has no vehicle.
fn meta(key: &FrameKey, moments: Moments) -> FrameMeta {
    let drive = moments.drive;
    let moment = &drive.keyframes[key.keyframe as usize];
    FrameMeta {
        scene: key.scene.clone(),
        dataset: drive.dataset.clone(),
        place: drive.place.clone(),
        variation: key.variation,
        keyframe: key.keyframe,
        keyframe_token: moment.token.clone(),
        keyframe_time_ns: moment.time_ns,
        recorded_keyframe: moments.keyframe(key.keyframe as usize).map(|k| k as u32),
        source_token: None,
        source_image: None,
        projection: drive.projection,
    }
}
