//! What is looked at, and what was found wrong.

use std::collections::BTreeMap;

use serde::Serialize;

/// A rule that labels keep.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Check {
    /// Every file can be read and has the size and the values that it may have.
    Files,
    /// Cameras are cameras: intrinsics, rigid poses, and poses of the neighbouring moments that are theirs.
    Camera,
    /// Images are neither black nor blown, and change where labels do.
    Image,
    /// Ids in images are those of listed objects.
    Ids,
    /// An object's pixels have its class, and what has no object is stuff.
    Classes,
    /// Pixels, boxes and shares of objects are those of their masks.
    Masks,
    /// Outlines, painted, are the labels.
    Outlines,
    /// Panoptic labels are classes and instances in one.
    Panoptic,
    /// Depth is positive, and infinite where the sky is.
    Depth,
    /// Normals are unit and face the camera.
    Normals,
    /// Normals are those of the surface that depth tells.
    Surfaces,
    /// What is seen of an object lies in its 3D box, and 3D boxes project onto 2D boxes.
    Boxes,
    /// Points of people lie where their positions in World are projected to, and at the person.
    Keypoints,
    /// Flow of what stands still is what depth and the cameras' poses say.
    Flow,
    /// Flow that nothing hides ends on the same object, at its depth.
    FlowEnds,
    /// Flow there and back ends where it began.
    FlowReturns,
    /// Something is nearer where flow is told to be hidden.
    Occlusion,
    /// Cameras of one moment see the same surfaces.
    Views,
    /// Ids mean the same object in all views and at all times, and boxes move smoothly.
    Tracks,
    /// LiDAR points lie on the surfaces of depth images, and in boxes as many as told.
    Lidar,
}

impl Check {
    /// All that there are.
    pub const ALL: [Self; 20] = [
        Self::Files,
        Self::Camera,
        Self::Image,
        Self::Ids,
        Self::Classes,
        Self::Masks,
        Self::Outlines,
        Self::Panoptic,
        Self::Depth,
        Self::Normals,
        Self::Surfaces,
        Self::Boxes,
        Self::Keypoints,
        Self::Flow,
        Self::FlowEnds,
        Self::FlowReturns,
        Self::Occlusion,
        Self::Views,
        Self::Tracks,
        Self::Lidar,
    ];

    /// Its name in tables (`flow-ends`).
    pub fn name(self) -> &'static str {
        match self {
            Self::Files => "files",
            Self::Camera => "camera",
            Self::Image => "image",
            Self::Ids => "ids",
            Self::Classes => "classes",
            Self::Masks => "masks",
            Self::Outlines => "outlines",
            Self::Panoptic => "panoptic",
            Self::Depth => "depth",
            Self::Normals => "normals",
            Self::Surfaces => "surfaces",
            Self::Boxes => "boxes",
            Self::Keypoints => "keypoints",
            Self::Flow => "flow",
            Self::FlowEnds => "flow-ends",
            Self::FlowReturns => "flow-returns",
            Self::Occlusion => "occlusion",
            Self::Views => "views",
            Self::Tracks => "tracks",
            Self::Lidar => "lidar",
        }
    }
}

impl Check {
    /// What is expected, in a few words.
    pub fn rule(self) -> &'static str {
        match self {
            Self::Files => "files can be read, and have their size and values",
            Self::Camera => "intrinsics and poses are those of a camera, and of the neighbouring moments",
            Self::Image => "images show something, with edges where labels have them",
            Self::Ids => "every id in an image is listed, once",
            Self::Classes => "pixels have the class of their object",
            Self::Masks => "pixel counts, 2D boxes and shares are those of the masks",
            Self::Outlines => "polygons, painted, are the labels",
            Self::Panoptic => "panoptic labels are classes and instances in one",
            Self::Depth => "depth is positive, and infinite in the sky alone",
            Self::Normals => "normals are unit and face the camera",
            Self::Surfaces => "normals are those of depth's surfaces",
            Self::Boxes => "what is seen lies in 3D boxes, which project onto 2D boxes",
            Self::Keypoints => "points of people are projected from World, and lie on them",
            Self::Flow => "flow of what stands still is that of depth and poses",
            Self::FlowEnds => "flow ends on the same object where nothing hides it",
            Self::FlowReturns => "flow there and back ends where it began",
            Self::Occlusion => "something is nearer where flow is hidden, nothing where it is not",
            Self::Views => "cameras of one moment see the same surfaces and objects",
            Self::Tracks => "ids mean one object everywhere, and boxes move smoothly",
            Self::Lidar => "LiDAR points lie on the surfaces that cameras see",
        }
    }
}

/// Something that is wrong.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Finding {
    /// The rule that is broken.
    pub check: Check,
    /// Where: a file or folder below the dataset's.
    pub place: String,
    /// What was expected and what was found.
    pub what: String,
    /// How bad it is, 0 to 1: the share of what was compared that is wrong; 1 where one is enough.
    pub severity: f64,
    /// The image that shows it, below the dataset's folder; `None` where none does.
    pub image: Option<String>,
    /// Pixels of it that are wrong (column, row), thinned out.
    #[serde(skip)]
    pub pixels: Vec<[u32; 2]>,
}

/// How a check came out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Tally {
    /// Frames, tables or sequences that it could be made on.
    pub looked_at: usize,
    /// What it found.
    pub findings: usize,
}

/// What an audit found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Audit {
    /// Frames that were looked at.
    pub frames: usize,
    /// By check; those that nothing could be looked at for are missing.
    pub tallies: BTreeMap<Check, Tally>,
    /// What is wrong, the worst of each check first; of each at most [`Audit::MOST`].
    pub findings: Vec<Finding>,
}

impl Audit {
    /// Findings of one check that are kept.
    pub const MOST: usize = 200;

    /// Whether nothing is wrong.
    pub fn is_sound(&self) -> bool {
        self.findings.is_empty()
    }

    /// Puts another part's beside.
    pub(super) fn add(&mut self, notes: Notes) {
        for check in notes.looked_at {
            self.tallies.entry(check).or_default().looked_at += 1;
        }
        for finding in notes.findings {
            self.tallies.entry(finding.check).or_default().findings += 1;
            self.findings.push(finding);
        }
    }

    /// Sorts findings and drops what is too many.
    pub(super) fn finish(mut self) -> Self {
        let key = |a: &Finding, b: &Finding| {
            a.check.cmp(&b.check).then(b.severity.total_cmp(&a.severity)).then_with(|| a.place.cmp(&b.place))
        };
        self.findings.sort_by(key);
        let mut kept = BTreeMap::<Check, usize>::new();
        self.findings.retain(|finding| {
            let count = kept.entry(finding.check).or_default();
            *count += 1;
            *count <= Self::MOST
        });
        self
    }
}

/// What is noted while one part is looked at.
#[derive(Debug, Default)]
pub(super) struct Notes {
    /// Below the dataset's folder.
    place: String,
    image: Option<String>,
    looked_at: Vec<Check>,
    findings: Vec<Finding>,
}

/// Marked pixels of a finding.
const MOST_PIXELS: usize = 2000;

impl Notes {
    /// Of a place, with the image that shows it.
    pub(super) fn of(place: impl Into<String>, image: Option<String>) -> Self {
        Self { place: place.into(), image, ..Self::default() }
    }

    /// A check is made here.
    pub(super) fn look(&mut self, check: Check) {
        if !self.looked_at.contains(&check) {
            self.looked_at.push(check);
        }
    }

    /// Something is wrong, of which one is enough.
    pub(super) fn wrong(&mut self, check: Check, what: impl Into<String>) {
        self.found(check, 1.0, what, Vec::new());
    }

    /// Something is wrong at pixels.
    pub(super) fn found(&mut self, check: Check, severity: f64, what: impl Into<String>, mut pixels: Vec<[u32; 2]>) {
        if pixels.len() > MOST_PIXELS {
            pixels = pixels.iter().step_by(pixels.len().div_ceil(MOST_PIXELS)).copied().collect();
        }
        self.look(check);
        let (place, image) = (self.place.clone(), self.image.clone());
        self.findings.push(Finding { check, place, what: what.into(), severity, image, pixels });
    }

    /// What was counted is wrong where fewer than a share of enough are right.
    pub(super) fn judge(&mut self, check: Check, count: &Count, least: f64, what: impl FnOnce(f64) -> String) {
        self.look(check);
        if count.share() < least && count.all >= count.enough {
            self.found(check, 1.0 - count.share(), what(count.share()), count.wrong.clone());
        }
    }
}

/// Fewer pixels than this tell nothing about a share.
pub(super) const ENOUGH: usize = 64;

/// Pixels that are right, of those that were compared.
#[derive(Debug)]
pub(super) struct Count {
    pub(super) all: usize,
    /// From how many on their share is judged.
    pub(super) enough: usize,
    wrong: Vec<[u32; 2]>,
}

impl Default for Count {
    fn default() -> Self {
        Self { all: 0, enough: ENOUGH, wrong: Vec::new() }
    }
}

impl Count {
    pub(super) fn tell(&mut self, pixel: [u32; 2], is_right: bool) {
        self.all += 1;
        if !is_right {
            self.wrong.push(pixel);
        }
    }

    /// Of those that are right; 1 where there are none.
    pub(super) fn share(&self) -> f64 {
        1.0 - self.wrong.len() as f64 / self.all.max(1) as f64
    }
}
