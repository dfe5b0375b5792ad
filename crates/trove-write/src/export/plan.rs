//! Which frames go into a dataset, on which side, under which numbers.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};
use trove_format::{Curated, FrameRow, Manifest};

use crate::{StoredFrame, StoredRadarCycle, StoredSweep, WriteError};

/// The side that all frames are on where nobody has split them.
const UNSPLIT: &str = "train";

/// The frames of a dataset, ordered by split, sequence and place in it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Plan {
    /// The folder that they are read from.
    pub source: PathBuf,
    /// Names of the splits that have frames.
    pub splits: Vec<String>,
    /// The frames.
    pub frames: Vec<PlannedFrame>,
    /// LiDAR sweeps by drive, variation and keyframe.
    sweeps: HashMap<(String, u32, u32), Vec<PlannedSweep>>,
    /// Radars' cycles likewise.
    radars: HashMap<(String, u32, u32), Vec<PlannedSweep>>,
    /// Places in `frames` by what [`moment`] makes of them.
    moments: HashMap<u64, Vec<usize>>,
}

/// A frame and its numbers.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PlannedFrame {
    /// Its folder below the source's.
    pub path: String,
    /// The drive.
    pub scene: String,
    /// Number of the variation, from 0.
    pub variation: u32,
    /// Index of the keyframe in its drive, from 0.
    pub keyframe: u32,
    /// The camera (`ego.CAM_FRONT`).
    pub view: String,
    /// `train` or `val`.
    pub split: String,
    /// Number of its sequence (one camera's frames of one variation of a drive), from 0.
    pub sequence: u32,
    /// Its place in the sequence, from 0.
    pub index: u32,
    /// SHA-256 over the hashes of its files.
    pub content: [u8; 32],
}

/// A LiDAR's sweep, or a radar's cycle.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PlannedSweep {
    /// Its folder below the source's.
    path: String,
    /// The sensor on its vehicle (`ego.LIDAR_TOP`).
    pub view: String,
    /// SHA-256 over the hashes of its files.
    pub content: [u8; 32],
}

impl PlannedFrame {
    /// A name that no other frame has, for folders that hold all frames.
    pub(crate) fn flat_name(&self) -> String {
        self.flat_name_of(&self.view)
    }

    /// Such a name for what another sensor measured at the frame's moment.
    pub(crate) fn flat_name_of(&self, view: &str) -> String {
        let Self { scene, variation, keyframe, .. } = self;
        format!("{scene}_v{variation:02}_k{keyframe:03}_{view}")
    }
}

impl Plan {
    /// Of a finished output folder; with `curated` of the frames that it lists for training and validation alone.
    ///
    /// # Errors
    /// A folder that is not finished, a list that names frames that are not there, no frames, or views of one moment on
    /// both sides.
    pub(crate) fn new(source: &Path, curated: Option<&Curated>) -> Result<(Self, Manifest), WriteError> {
        let unfit = |expected: &str, found: String, remedy: &str| WriteError::Unfit {
            path: source.to_owned(),
            expected: expected.into(),
            found,
            remedy: remedy.into(),
        };
        let mut manifest = Manifest::read(source)?.ok_or_else(|| {
            unfit("a finished folder of trove generate", format!("no {}", Manifest::NAME), "run trove generate on it")
        })?;
        let splits = curated.map(splits).transpose()?;
        let mut rows: BTreeMap<_, Vec<FrameRow>> = BTreeMap::new();
        let [sweeps, radars] = [&mut manifest.sweeps, &mut manifest.radars].map(|rows| {
            let mut of_moments: HashMap<_, Vec<PlannedSweep>> = HashMap::new();
            for row in std::mem::take(rows) {
                let sweep = PlannedSweep { content: content(&row), path: row.path, view: row.view };
                of_moments.entry((row.scene, row.variation, row.keyframe)).or_default().push(sweep);
            }
            of_moments
        });
        let mut unlisted = splits.clone().unwrap_or_default();
        for row in std::mem::take(&mut manifest.frames) {
            unlisted.remove(&row.path);
            let split = match &splits {
                None => UNSPLIT.to_owned(),
                Some(splits) => match splits.get(&row.path) {
                    Some(split) => (*split).to_owned(),
                    None => continue,
                },
            };
            let sequence = (split, row.scene.clone(), row.variation, row.view.clone());
            rows.entry(sequence).or_default().push(row);
        }
        if let Some((path, _)) = unlisted.first_key_value() {
            let remedy = "give the list that trove curate wrote for this folder";
            return Err(unfit("every frame of the split's list", format!("no {path}"), remedy));
        }
        let mut plan = Self {
            source: source.to_owned(),
            splits: Vec::new(),
            frames: Vec::new(),
            sweeps,
            radars,
            moments: HashMap::new(),
        };
        for (sequence, ((split, ..), mut members)) in (0..).zip(rows) {
            if plan.splits.last() != Some(&split) {
                plan.splits.push(split.clone());
            }
            members.sort_by_key(|row| row.keyframe);
            for (index, row) in (0..).zip(members) {
                let content = content(&row);
                let FrameRow { path, scene, variation, keyframe, view, .. } = row;
                let split = split.clone();
                plan.frames.push(PlannedFrame {
                    path,
                    scene,
                    variation,
                    keyframe,
                    view,
                    split,
                    sequence,
                    index,
                    content,
                });
            }
        }
        if plan.frames.is_empty() {
            return Err(unfit("at least one frame", "none".into(), "run trove generate on it"));
        }
        plan.check_moments()?;
        for (i, frame) in plan.frames.iter().enumerate() {
            plan.moments.entry(moment(frame)).or_default().push(i);
        }
        Ok((plan, manifest))
    }

    /// Opens a frame.
    ///
    /// # Errors
    /// A table that cannot be read.
    pub(crate) fn open(&self, frame: &PlannedFrame) -> Result<StoredFrame, WriteError> {
        StoredFrame::open(&self.source.join(&frame.path))
    }

    /// The folder of a frame's variation, which tells of its scene.
    pub(crate) fn variation(&self, frame: &PlannedFrame) -> PathBuf {
        self.source.join(format!("{}/v{:02}", frame.scene, frame.variation))
    }

    /// The first LiDAR's sweep of a frame's moment from its vehicle; `None` where there is none.
    pub(crate) fn sweep(&self, frame: &PlannedFrame) -> Option<&PlannedSweep> {
        of_vehicle(&self.sweeps, frame).next()
    }

    /// All LiDARs' sweeps of a frame's moment, whatever carries them.
    pub(crate) fn sweeps(&self, frame: &PlannedFrame) -> &[PlannedSweep] {
        let of_moment = self.sweeps.get(&(frame.scene.clone(), frame.variation, frame.keyframe));
        of_moment.map_or(&[], Vec::as_slice)
    }

    /// The radars' cycles of a frame's moment from its vehicle.
    pub(crate) fn radars(&self, frame: &PlannedFrame) -> impl Iterator<Item = &PlannedSweep> {
        of_vehicle(&self.radars, frame)
    }

    /// The radars of all moments, by their views.
    pub(crate) fn radar_views(&self) -> BTreeSet<&str> {
        self.radars.values().flatten().map(|cycle| cycle.view.as_str()).collect()
    }

    /// Whether there is any sweep.
    pub(crate) fn has_sweeps(&self) -> bool {
        !self.sweeps.is_empty()
    }

    /// Opens a sweep.
    ///
    /// # Errors
    /// A table that cannot be read.
    pub(crate) fn open_sweep(&self, sweep: &PlannedSweep) -> Result<StoredSweep, WriteError> {
        StoredSweep::open(&self.source.join(&sweep.path))
    }

    /// Opens a radar's cycle.
    ///
    /// # Errors
    /// A table that cannot be read.
    pub(crate) fn open_radar(&self, cycle: &PlannedSweep) -> Result<StoredRadarCycle, WriteError> {
        StoredRadarCycle::open(&self.source.join(&cycle.path))
    }

    /// Other frames of a frame's moment, variation and split.
    pub(crate) fn same_moment(&self, frame: usize) -> impl Iterator<Item = usize> + '_ {
        let of = move |i: usize| {
            let PlannedFrame { split, scene, variation, keyframe, .. } = &self.frames[i];
            (split, scene, *variation, *keyframe)
        };
        let all = self.moments.get(&moment(&self.frames[frame]));
        all.into_iter().flatten().copied().filter(move |other| *other != frame && of(*other) == of(frame))
    }

    /// Runs of frames for which something is the same, in their order.
    pub(crate) fn grouped<K: PartialEq>(&self, key: impl Fn(&PlannedFrame) -> K) -> Vec<Vec<usize>> {
        let indices: Vec<usize> = (0..self.frames.len()).collect();
        indices.chunk_by(|a, b| key(&self.frames[*a]) == key(&self.frames[*b])).map(<[usize]>::to_vec).collect()
    }

    /// Frames of one sequence each.
    pub(crate) fn sequences(&self) -> Vec<Vec<usize>> {
        self.grouped(|frame| frame.sequence)
    }

    /// Two views of one moment, or two variations of it, on both sides would let a network be judged on what it has seen.
    fn check_moments(&self) -> Result<(), WriteError> {
        let mut moments: BTreeMap<(&str, u32), &PlannedFrame> = BTreeMap::new();
        for frame in &self.frames {
            let first = moments.entry((&frame.scene, frame.keyframe)).or_insert(frame);
            if first.split != frame.split {
                return Err(WriteError::Unfit {
                    path: self.source.clone(),
                    expected: "all views of one moment in one split".into(),
                    found: format!("{} in {} and {} in {}", first.path, first.split, frame.path, frame.split),
                    remedy: "split by place, with trove curate --val".into(),
                });
            }
        }
        Ok(())
    }
}

/// What a frame's vehicle measured at its moment.
fn of_vehicle<'a>(
    measured: &'a HashMap<(String, u32, u32), Vec<PlannedSweep>>,
    frame: &PlannedFrame,
) -> impl Iterator<Item = &'a PlannedSweep> {
    let vehicle = |view: &str| view.split('.').next().map(str::to_owned);
    let own = vehicle(&frame.view);
    let of_moment = measured.get(&(frame.scene.clone(), frame.variation, frame.keyframe));
    of_moment.into_iter().flatten().filter(move |one| vehicle(&one.view) == own)
}

/// A hash of a frame's drive, variation and keyframe.
fn moment(frame: &PlannedFrame) -> u64 {
    let mut hasher = DefaultHasher::new();
    (&frame.scene, frame.variation, frame.keyframe).hash(&mut hasher);
    hasher.finish()
}

/// The split of each frame of a list.
fn splits(curated: &Curated) -> Result<BTreeMap<String, &'static str>, WriteError> {
    let mut splits = BTreeMap::new();
    for (split, paths) in [("train", &curated.train), ("val", &curated.val)] {
        for path in paths {
            if splits.insert(path.clone(), split).is_some_and(|other| other != split) {
                return Err(WriteError::Mismatch(format!("{path} for training and for validation")));
            }
        }
    }
    Ok(splits)
}

fn content(row: &FrameRow) -> [u8; 32] {
    let mut hasher = Sha256::new();
    for (name, hash) in &row.files {
        hasher.update(name);
        hasher.update(hash);
    }
    hasher.finalize().into()
}
