//! What a user asks for: the TOML recipe.

mod camera;
mod check;
mod grids;
mod labels;
mod light;
mod place;
mod season;
mod sensors;
mod standpoint;
mod time;
mod variations;
mod weather;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow, bail, ensure};
use serde::{Deserialize, Serialize};
use trove_build::PictureSize;
use trove_files::{LARGEST_TEXT, read_text};
use trove_format::FrameFile;
use trove_model::LabelSettings;
use trove_read::DATASETS;
use trove_read::drive_source::Opener;
use trove_read::osm::GeoJsonFrame;
use trove_read::rig;
use trove_render::Denoising;
use trove_write::DatasetFormat;

use self::check::check;
pub(crate) use self::check::nearest;
use crate::store::fetched;
pub use camera::CameraSection;
pub use grids::{GridSection, GridsSection};
pub use labels::LabelsSection;
pub use light::LightSection;
pub use place::PlaceSection;
pub use season::SeasonChoice;
pub use sensors::{SensorKind, SensorSection, SensorsSection};
pub use standpoint::Standpoint;
pub use time::TimeSection;
pub use variations::{COMPUTED_SKY, Factor, Range, VariationsSection};
pub use weather::{WeatherSection, covered_by, rain, snowfall, wet_by};

/// A recipe with its defaults filled in; its paths are as they were written (see [`Recipe::at`]).
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Recipe {
    /// The only source of randomness.
    #[serde(default)]
    pub seed: u64,
    /// A recorded drive …
    pub drive: Option<DriveSection>,
    /// … or a place without one.
    pub place: Option<PlaceSection>,
    /// The street map.
    #[serde(default)]
    pub map: MapSection,
    /// Moments between keyframes.
    #[serde(default, skip_serializing_if = "TimeSection::is_default")]
    pub time: TimeSection,
    /// Models.
    #[serde(default)]
    pub assets: AssetsSection,
    /// Cameras.
    #[serde(default)]
    pub views: ViewsSection,
    /// What measures beside the cameras.
    #[serde(default, skip_serializing_if = "SensorsSection::is_empty")]
    pub sensors: SensorsSection,
    /// Cells around the vehicle.
    #[serde(default, skip_serializing_if = "GridsSection::is_empty")]
    pub grids: GridsSection,
    /// What the pictures are taken with.
    #[serde(default)]
    pub camera: CameraSection,
    /// Sky.
    #[serde(default)]
    pub light: LightSection,
    /// Rain and dirt.
    #[serde(default)]
    pub weather: WeatherSection,
    /// Pictures.
    #[serde(default)]
    pub render: RenderSection,
    /// What labels tell.
    #[serde(default)]
    pub labels: LabelsSection,
    /// What is written.
    #[serde(default)]
    pub output: OutputSection,
    /// How many scenes a keyframe becomes.
    #[serde(default)]
    pub variations: VariationsSection,
    /// The recipe's own folder, where its relative paths start; empty is the working directory.
    #[serde(skip)]
    pub folder: PathBuf,
    /// Where what it names in object stores lies on this machine.
    #[serde(skip)]
    pub(crate) fetched: BTreeMap<PathBuf, PathBuf>,
}

/// More threads than any machine has use for.
pub const MOST_THREADS: i64 = 1024;

/// `[drive]`
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct DriveSection {
    /// The dataset's name in [`DATASETS`].
    pub dataset: String,
    /// The dataset's root folder.
    pub root: PathBuf,
    /// Names of scenes; without it all.
    pub scenes: Option<Vec<String>>,
    /// Which moments.
    #[serde(default)]
    pub keyframes: Keyframes,
    /// Where a drive lies that does not know it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at: Option<Standpoint>,
    /// All other keys: the dataset's own.
    #[serde(flatten)]
    pub options: toml::Table,
}

/// The keys of `[drive]` that every dataset has.
const DRIVE_KEYS: [&str; 5] = ["dataset", "root", "scenes", "keyframes", "at"];

impl DriveSection {
    /// What opens the dataset, with its own keys read.
    ///
    /// # Errors
    /// A dataset that has no reader, and a key that the dataset does not have or that is not of its type.
    pub fn opener(&self) -> Result<Opener> {
        let Some(dataset) = DATASETS.iter().find(|dataset| dataset.name == self.dataset) else {
            let names: Vec<&str> = DATASETS.iter().map(|dataset| dataset.name).collect();
            let hint = nearest(&self.dataset, &names);
            bail!("drive.dataset: expected one of {}, found \"{}\"{hint}", names.join(", "), self.dataset);
        };
        (dataset.configure)(self.options.clone()).map_err(|error| {
            let hint = match unknown_field(&error) {
                Some((unknown, known)) => nearest(unknown, &[&known[..], &DRIVE_KEYS].concat()),
                None => String::new(),
            };
            anyhow!("drive: {}{hint}", error.message())
        })
    }
}

/// Which keyframes of a drive.
#[derive(Clone, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(untagged)]
pub enum Keyframes {
    /// `"all"`
    #[default]
    #[serde(with = "all")]
    All,
    /// `[0, 10]`: these, by their number from 0.
    Listed(Vec<usize>),
    /// `{ every = 5 }`: 0, 5, 10, …
    Every(EveryNth),
}

/// `{ every = N }`
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct EveryNth {
    /// Distance of one keyframe to the next.
    pub every: usize,
}

/// `[map]`
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct MapSection {
    /// OpenStreetMap extracts, `.osm` or `.osm.pbf`, or GeoJSON; each scene takes the first that covers it.
    #[serde(default)]
    pub osm: Extracts,
    /// What the coordinates of GeoJSON files are that do not say so themselves.
    #[serde(default)]
    pub geojson_frame: GeoJsonFrame,
    /// Elevation files, SRTM `.hgt` (zipped or not) or GeoTIFF: relief where nothing was recorded.
    #[serde(default)]
    pub elevation: Extracts,
    /// What becomes of the extract where it does not lie on the drive.
    #[serde(default)]
    pub on_disagreement: OnDisagreement,
    /// Whether buildings are made up along streets beside which the extract has none.
    #[serde(default)]
    pub invent: bool,
    /// Whose customs the place follows: `auto`, the country that it lies in, or an ISO 3166-1 code.
    #[serde(default = "auto")]
    pub country: String,
    /// A table of customs over the built-in one.
    #[serde(default)]
    pub locales: Option<PathBuf>,
}

const AUTO: &str = "auto";

fn auto() -> String {
    AUTO.into()
}

impl Default for MapSection {
    fn default() -> Self {
        Self {
            osm: Extracts::default(),
            geojson_frame: GeoJsonFrame::default(),
            elevation: Extracts::default(),
            on_disagreement: OnDisagreement::default(),
            invent: false,
            country: auto(),
            locales: None,
        }
    }
}

impl MapSection {
    /// The country that the recipe tells; `None` where it is that which the place lies in.
    pub fn country(&self) -> Option<&str> {
        Some(self.country.as_str()).filter(|country| *country != AUTO)
    }
}

/// One path or a list of them.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(untagged)]
pub enum Extracts {
    /// A path.
    One(PathBuf),
    /// A list.
    Several(Vec<PathBuf>),
}

impl Default for Extracts {
    fn default() -> Self {
        Self::Several(Vec::new())
    }
}

impl Extracts {
    /// The paths as the recipe has them.
    pub fn paths(&self) -> &[PathBuf] {
        match self {
            Self::One(path) => std::slice::from_ref(path),
            Self::Several(paths) => paths,
        }
    }
}

/// What becomes of a street map that does not lie on the drive.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum OnDisagreement {
    /// It is used all the same.
    Warn,
    /// Only its buildings are used.
    #[default]
    BuildingsOnly,
    /// It is not used.
    Refuse,
}

impl From<OnDisagreement> for trove_build::OnDisagreement {
    fn from(chosen: OnDisagreement) -> Self {
        match chosen {
            OnDisagreement::Warn => Self::Warn,
            OnDisagreement::BuildingsOnly => Self::BuildingsOnly,
            OnDisagreement::Refuse => Self::Refuse,
        }
    }
}

/// Where models and surfaces come from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LibrarySource {
    /// The built-in generator.
    Procedural,
    /// A folder with a `library.toml`.
    Folder(PathBuf),
}

/// `[assets]`
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct AssetsSection {
    /// Libraries that are searched together: `procedural`, and folders with a `library.toml`.
    pub libraries: Vec<String>,
    /// Draw among the k best fits; 1 is the best.
    pub top_k: usize,
    /// Resolution of the built-in textures: 1 (at most 1024 texels a side), 2 or 4.
    pub texture_scale: u32,
    /// Whether surfaces have patterns and relief; otherwise each has the mean colour of its texture.
    #[serde(skip_serializing_if = "Clone::clone")]
    pub textures: bool,
}

/// `[views]`
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct ViewsSection {
    /// Which of the vehicle's cameras, or which others in their place.
    pub rig: Rig,
    /// How many other vehicles carry the rig too.
    pub other_vehicles: usize,
    /// Whether variation 0 is exposed and coloured as the recorded photographs are.
    pub match_photographs: bool,
}

/// Cameras of the rig.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(untagged)]
pub enum Rig {
    /// `"all"`
    #[serde(with = "all")]
    All,
    /// One camera's name, a preset's, or a path that ends in `.toml`.
    One(String),
    /// Names of cameras.
    Named(Vec<String>),
}

/// Cameras in place of the recorded ones.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum OwnRig {
    /// A file's, as this process reaches it.
    File(PathBuf),
    /// A preset's.
    Preset(&'static str),
}

/// `[render]`
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct RenderSection {
    /// Of the dataset's own resolution; `None` is 1.
    pub scale: Option<f64>,
    /// In place of `scale`: width and height in pixels of the picture's middle, which is cut to that aspect.
    pub size: Option<[u32; 2]>,
    /// Samples a pixel; the most that one may get where `noise` is more than 0.
    pub spp: u32,
    /// The share of brightness by which a pixel may still be wrong when it has had enough samples; 0: all get `spp`.
    pub noise: f32,
    /// Whether light that fog scatters again and again is read from a field around the camera.
    pub cache: bool,
    /// Whether noise is removed.
    pub denoise: Denoise,
    /// False: labels only.
    pub light: bool,
    /// Whether the linear radiance behind a picture is written too.
    pub radiance: bool,
    /// 0: all. It is not kept in the manifest, for it changes nothing.
    #[serde(skip_serializing)]
    pub threads: usize,
}

/// `true`, `false` or `"fast"`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(untagged)]
pub enum Denoise {
    /// As well as it goes, or not at all.
    Switched(bool),
    /// `"fast"`
    Quickly(Quickly),
}

/// The word `"fast"`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Quickly {
    /// For many small pictures.
    Fast,
}

/// `[output]`
#[derive(Clone, Debug, Default, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct OutputSection {
    /// The pictures in a frame's folder; `None`: the usual ones.
    pub files: Option<BTreeSet<FrameFile>>,
    /// Datasets for other tools that the finished run is exported as, by the names of their forms.
    #[serde(default)]
    pub formats: Vec<String>,
}

impl Default for AssetsSection {
    fn default() -> Self {
        Self { libraries: vec![crate::PROCEDURAL.into()], top_k: 3, texture_scale: 1, textures: true }
    }
}

impl Default for ViewsSection {
    fn default() -> Self {
        Self { rig: Rig::All, other_vehicles: 0, match_photographs: false }
    }
}

impl Default for RenderSection {
    fn default() -> Self {
        Self {
            scale: None,
            size: None,
            spp: 64,
            noise: 0.0,
            cache: false,
            denoise: Denoise::Switched(true),
            light: true,
            radiance: false,
            threads: 0,
        }
    }
}

/// The word `"all"` in place of a list.
mod all {
    use serde::{Deserialize, Deserializer, Serializer, de::Error};

    pub(super) fn serialize<S: Serializer>(serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str("all")
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<(), D::Error> {
        let word = String::deserialize(deserializer)?;
        if word == "all" { Ok(()) } else { Err(D::Error::custom("expected \"all\"")) }
    }
}

impl Recipe {
    /// Reads a recipe file; relative paths in it start from its folder.
    ///
    /// # Errors
    /// A file that cannot be read, or a recipe that [`Recipe::parse`] refuses.
    pub fn read(path: &Path) -> Result<Self> {
        let text = read_text(path, LARGEST_TEXT)
            .with_context(|| format!("{}: expected a recipe (TOML) that can be read", path.display()))?;
        let mut recipe = Self::parse(&text).with_context(|| path.display().to_string())?;
        recipe.folder = path.parent().unwrap_or(Path::new("")).to_owned();
        recipe.fetched = fetched(&toml::from_str(&text)?)?;
        Ok(recipe)
    }

    /// Reads a recipe's text and checks its values.
    ///
    /// # Errors
    /// Text that is not TOML, a key that recipes do not have, or a value out of its range.
    pub fn parse(text: &str) -> Result<Self> {
        let recipe: Self = toml::from_str(text).map_err(|error| explain(&error))?;
        recipe.check()?;
        Ok(recipe)
    }

    /// A path of the recipe as this process reaches it.
    pub fn at(&self, path: &Path) -> PathBuf {
        self.fetched.get(path).cloned().unwrap_or_else(|| self.folder.join(path))
    }

    fn check(&self) -> Result<()> {
        match (&self.drive, &self.place) {
            (None, None) => bail!("expected a [drive] or a [place] section, found neither; add one of them"),
            (Some(_), Some(_)) => bail!("expected [drive] or [place], found both; remove one of them"),
            (None, Some(place)) => {
                check("place.lat_deg", place.lat_deg, (-85.0..=85.0).contains(&place.lat_deg), "-85 to 85")?;
                check("place.lon_deg", place.lon_deg, (-180.0..=180.0).contains(&place.lon_deg), "-180 to 180")?;
                check("place.size_m", place.size_m, (50.0..=5000.0).contains(&place.size_m), "50 to 5000")?;
                ensure!(
                    !self.map.osm.paths().is_empty(),
                    "map.osm: a [place] has no map of its own; name an OpenStreetMap extract (trove map fetches it)"
                );
            }
            (Some(drive), None) => {
                drive.opener().map(drop)?;
                if let Some(at) = &drive.at {
                    at.check()?;
                }
                if let Keyframes::Every(EveryNth { every }) = drive.keyframes {
                    check("drive.keyframes.every", every, every > 0, "1 or more")?;
                }
                if let Keyframes::Listed(listed) = &drive.keyframes {
                    ensure!(!listed.is_empty(), "drive.keyframes: expected at least one keyframe, found none");
                }
                let names_none = drive.scenes.as_ref().is_some_and(Vec::is_empty);
                ensure!(!names_none, "drive.scenes: expected at least one scene, found none; omit it for all");
            }
        }
        self.time.check(self.drive.as_ref().map(|drive| drive.keyframes.every()))?;
        let (render, assets) = (&self.render, &self.assets);
        match (render.scale, render.size) {
            (Some(_), Some(_)) => bail!("expected render.scale or render.size, found both; remove one of them"),
            (Some(scale), None) => {
                check("render.scale", scale, scale > 0.0 && scale <= 4.0, "more than 0, at most 4")?;
            }
            (None, Some([width, height])) => {
                let is_picture = [width, height].iter().all(|side| (1..=16_384).contains(side));
                check("render.size", format!("[{width}, {height}]"), is_picture, "two numbers of 1 to 16384")?;
            }
            (None, None) => {}
        }
        check("render.threads", render.threads, render.threads <= MOST_THREADS as usize, "0 to 1024")?;
        check("render.spp", render.spp, (1..=65_536).contains(&render.spp), "1 to 65536")?;
        check("render.noise", render.noise, (0.0..1.0).contains(&render.noise), "0 to less than 1")?;
        ensure!(
            render.light || !render.radiance,
            "render.radiance: without light there is no radiance; remove it or render.light = false"
        );
        for name in &self.output.formats {
            let known: Vec<&str> = DatasetFormat::all().map(DatasetFormat::name).collect();
            ensure!(
                known.contains(&name.as_str()),
                "output.formats: expected some of {}, found {name}{}",
                known.join(", "),
                nearest(name, &known)
            );
        }
        let files = self.output.files.iter().flatten();
        ensure!(
            render.light || files.clone().all(|file| !file.shows_light()),
            "output.files: without light there is no rgb and no radiance; remove them or render.light = false"
        );
        ensure!(
            self.variations.counterfactual.is_some() || files.clone().all(|file| *file != FrameFile::Change),
            "output.files: only counterfactual sets have change.png; remove change or set variations.counterfactual"
        );
        self.camera.check()?;
        sensors::check_all(&self.sensors)?;
        grids::check_all(&self.grids, &self.sensors)?;
        self.light.check()?;
        self.weather.check(self.variations.visibility_m.is_some())?;
        check("assets.top_k", assets.top_k, assets.top_k > 0, "1 or more")?;
        check("assets.texture_scale", assets.texture_scale, matches!(assets.texture_scale, 1 | 2 | 4), "1, 2 or 4")?;
        self.variations.check(&self.light)?;
        ensure!(!assets.libraries.is_empty(), "assets.libraries: expected at least one, found none");
        Ok(())
    }

    /// Where models and surfaces come from.
    pub fn libraries(&self) -> Vec<LibrarySource> {
        let source = |name: &String| match name.as_str() {
            crate::PROCEDURAL => LibrarySource::Procedural,
            folder => LibrarySource::Folder(self.at(Path::new(folder))),
        };
        self.assets.libraries.iter().map(source).collect()
    }

    /// The picture of a sky that is asked for; `None` for a computed one.
    pub fn environment_file(&self) -> Option<PathBuf> {
        self.light.is_file().then(|| self.at(Path::new(&self.light.environment)))
    }

    /// The pictures in the folder of a variation's frame.
    pub fn pictures(&self, variation: u32) -> BTreeSet<FrameFile> {
        let usual = || FrameFile::ALL.into_iter().filter(|file| file.is_usual()).collect();
        let mut files = self.output.files.clone().unwrap_or_else(usual);
        if self.render.radiance {
            files.insert(FrameFile::Radiance);
        }
        files.retain(|file| self.render.light || !file.shows_light());
        if variation == 0 || self.variations.counterfactual.is_none() {
            files.remove(&FrameFile::Change);
        }
        files
    }

    /// Which labels pictures get.
    pub fn label_settings(&self) -> LabelSettings {
        let extra = self.pictures(0).into_iter().filter_map(FrameFile::extra).collect();
        LabelSettings { glass: self.labels.glass.into(), extra }
    }

    /// Whether there is a picture that shows light.
    pub fn follows_light(&self) -> bool {
        self.pictures(0).iter().any(|file| file.shows_light())
    }

    /// How noise is removed.
    pub fn denoising(&self) -> Denoising {
        match self.render.denoise {
            _ if !self.follows_light() => Denoising::None,
            Denoise::Switched(false) => Denoising::None,
            Denoise::Switched(true) => Denoising::Best,
            Denoise::Quickly(Quickly::Fast) => Denoising::Fast,
        }
    }

    /// The cameras in place of the recorded ones; `None` where these are meant.
    pub fn own_rig(&self) -> Option<OwnRig> {
        let Rig::One(name) = &self.views.rig else { return None };
        let preset = rig::presets().find(|preset| preset == name).map(OwnRig::Preset);
        preset.or_else(|| name.ends_with(".toml").then(|| OwnRig::File(self.at(Path::new(name)))))
    }

    /// The cameras that are asked for; `None` for all.
    pub fn camera_names(&self) -> Option<Vec<String>> {
        match &self.views.rig {
            Rig::All => None,
            Rig::One(_) if self.own_rig().is_some() => None,
            Rig::One(name) => Some(vec![name.clone()]),
            Rig::Named(names) => Some(names.clone()),
        }
    }
}

impl RenderSection {
    /// How large pictures are.
    pub fn picture_size(&self) -> PictureSize {
        self.size.map_or(PictureSize::Scaled(self.scale.unwrap_or(1.0)), PictureSize::Cropped)
    }
}

impl Keyframes {
    /// One in so many is asked for; 1 where they are listed.
    fn every(&self) -> usize {
        if let Self::Every(EveryNth { every }) = self { *every } else { 1 }
    }

    /// The keyframes' numbers out of `count`, ascending.
    ///
    /// # Errors
    /// A listed keyframe that is not there.
    pub fn of(&self, count: usize) -> Result<Vec<usize>> {
        match self {
            Self::All => Ok((0..count).collect()),
            Self::Every(EveryNth { every }) => Ok((0..count).step_by(*every).collect()),
            Self::Listed(listed) => {
                if let Some(missing) = listed.iter().find(|&&k| k >= count) {
                    bail!("drive.keyframes: expected numbers from 0 to {}, found {missing}", count.saturating_sub(1));
                }
                let mut listed = listed.clone();
                listed.sort_unstable();
                listed.dedup();
                Ok(listed)
            }
        }
    }
}

/// The parser's error (which shows the place) and, for a key that is not known, the nearest one that is.
fn explain(error: &toml::de::Error) -> anyhow::Error {
    let hint = unknown_field(error).map(|(unknown, known)| nearest(unknown, &known)).unwrap_or_default();
    anyhow!("{error}{}", hint.trim_start_matches("; "))
}

/// The key that the parser does not know, and those that it knows there.
fn unknown_field(error: &toml::de::Error) -> Option<(&str, Vec<&str>)> {
    let mut names = error.message().split('`').skip(1).step_by(2);
    let unknown = names.next().filter(|_| error.message().starts_with("unknown field"))?;
    Some((unknown, names.collect()))
}

#[cfg(test)]
mod tests {
    use trove_model::{ExtraLabel, GlassLabels};

    use super::*;

    const DRIVE: &str = "[drive]\ndataset = \"nuscenes\"\nroot = \"data\"\n";

    fn error(text: &str) -> String {
        format!("{:#}", Recipe::parse(text).unwrap_err())
    }

    #[test]
    fn everything_but_the_drive_has_a_default() {
        let recipe = Recipe::parse(DRIVE).unwrap();
        assert_eq!((recipe.render.spp, recipe.assets.top_k, recipe.variations.count), (64, 3, 1));
        assert_eq!(recipe.drive.unwrap().keyframes, Keyframes::All);
        assert_eq!(recipe.views.rig, Rig::All);
    }

    #[test]
    fn the_example_is_a_recipe() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/boston.toml");
        let recipe = Recipe::read(&path).unwrap();
        assert_eq!((recipe.render.scale, recipe.variations.count), (Some(0.5), 4));
    }

    #[test]
    fn a_map_is_one_extract_or_several() {
        for (text, count) in [("", 0), ("[map]\nosm = \"a.osm\"\n", 1), ("[map]\nosm = [\"a.osm\", \"b.osm\"]\n", 2)] {
            assert_eq!(Recipe::parse(&format!("{DRIVE}{text}")).unwrap().map.osm.paths().len(), count, "{text}");
        }
    }

    #[test]
    fn a_rig_is_named_cameras_a_preset_or_a_file() {
        let mut recipe = Recipe::parse(DRIVE).unwrap();
        recipe.folder = "folder".into();
        for (rig, own, names) in [
            ("all", None, None),
            ("CAM_FRONT", None, Some(vec!["CAM_FRONT".to_owned()])),
            ("kitti", Some(OwnRig::Preset("kitti")), None),
            ("a/my.toml", Some(OwnRig::File("folder/a/my.toml".into())), None),
        ] {
            let text = toml::from_str::<ViewsSection>(&format!("rig = \"{rig}\"")).unwrap();
            recipe.views.rig = text.rig;
            assert_eq!((recipe.own_rig(), recipe.camera_names()), (own, names), "{rig}");
        }
        recipe.views.rig = Rig::Named(vec!["kitti".into()]);
        assert_eq!((recipe.own_rig(), recipe.camera_names()), (None, Some(vec!["kitti".into()])));
    }

    #[test]
    fn relief_is_one_file_or_several() {
        for (text, count) in [("", 0), ("\"N43E007.hgt.zip\"", 1), ("[\"a.tif\", \"b.hgt\"]", 2)] {
            let map = if text.is_empty() { String::new() } else { format!("[map]\nelevation = {text}\n") };
            assert_eq!(Recipe::parse(&format!("{DRIVE}{map}")).unwrap().map.elevation.paths().len(), count, "{text}");
        }
    }

    #[test]
    fn keyframes_come_in_three_forms() {
        for (text, expect) in [("\"all\"", vec![0, 1, 2, 3]), ("[2, 0, 2]", vec![0, 2]), ("{ every = 3 }", vec![0, 3])]
        {
            let recipe = Recipe::parse(&format!("{DRIVE}keyframes = {text}\n")).unwrap();
            assert_eq!(recipe.drive.unwrap().keyframes.of(4).unwrap(), expect, "{text}");
        }
        assert!(Keyframes::Listed(vec![4]).of(4).is_err());
    }

    #[test]
    fn an_unknown_key_names_the_nearest_known_one_and_its_line() {
        let message = error(&format!("{DRIVE}[render]\nssp = 3\n"));
        assert!(message.contains("did you mean `spp`?") && message.contains("line 5"), "{message}");
    }

    #[test]
    fn a_dataset_s_own_keys_stand_beside_those_of_every_dataset() {
        let recipe = Recipe::parse(&format!("{DRIVE}version = \"v1.0-mini\"\nscenes = [\"scene-0103\"]\n")).unwrap();
        let drive = recipe.drive.unwrap();
        assert_eq!(drive.options.keys().collect::<Vec<_>>(), ["version"]);
        for (text, expect) in [
            (format!("{DRIVE}verison = \"v1.0-mini\"\n"), "drive: unknown field `verison`"),
            (format!("{DRIVE}verison = \"v1.0-mini\"\n"), "did you mean `version`?"),
            (format!("{DRIVE}secnes = []\n"), "did you mean `scenes`?"),
            (format!("{DRIVE}version = 1\n"), "drive: invalid type"),
            (DRIVE.replace("nuscenes", "nuscene"), "found \"nuscene\"; did you mean `nuscenes`?"),
        ] {
            let message = error(&text);
            assert!(message.contains(expect), "{message}");
        }
    }

    #[test]
    fn only_the_light_that_is_shown_is_followed_and_cleaned() {
        let recipe = |text: &str| Recipe::parse(&format!("{DRIVE}{text}")).unwrap();
        let plain = recipe("");
        assert_eq!((plain.pictures(0).len(), plain.follows_light(), plain.denoising()), (9, true, Denoising::Best));
        let labels = recipe("[output]\nfiles = [\"class\", \"instance\"]\n");
        assert_eq!(labels.pictures(0), [FrameFile::Class, FrameFile::Instance].into());
        assert_eq!((labels.follows_light(), labels.denoising()), (false, Denoising::None));
        let radiance = recipe("[render]\nradiance = true\ndenoise = \"fast\"\n[output]\nfiles = []\n");
        assert_eq!((radiance.pictures(0), radiance.denoising()), ([FrameFile::Radiance].into(), Denoising::Fast));
        assert_eq!(recipe("[render]\nlight = false\n").pictures(0).len(), 8);
        let asked = recipe("[labels]\nglass = \"behind\"\n[output]\nfiles = [\"panoptic\", \"range\"]\n");
        assert_eq!(asked.pictures(0), [FrameFile::Panoptic, FrameFile::Range].into());
        assert_eq!(asked.label_settings().extra, [ExtraLabel::Range].into());
        assert_eq!(
            (asked.label_settings().glass, plain.label_settings()),
            (GlassLabels::Behind, LabelSettings::default())
        );
        assert_eq!(recipe("[render]\ndenoise = false\n").denoising(), Denoising::None);
    }

    #[test]
    fn a_value_out_of_range_says_what_was_expected() {
        for (text, expect) in [
            ("[render]\nscale = 0\n", "render.scale: expected more than 0"),
            ("[render]\nscale = 0.5\nsize = [480, 360]\n", "render.scale or render.size, found both"),
            ("[render]\nsize = [0, 360]\n", "render.size: expected two numbers of 1 to 16384, found [0, 360]"),
            ("[render]\nspp = 0\n", "render.spp: expected 1 to 65536, found 0"),
            ("[render]\nlight = false\nradiance = true\n", "render.radiance"),
            ("[render]\nlight = false\n[output]\nfiles = [\"rgb\"]\n", "output.files"),
            ("[output]\nfiles = [\"rbg\"]\n", "rbg"),
            ("[output]\nformats = [\"citiscapes\"]\n", "did you mean `cityscapes`?"),
            ("[weather]\nwetness = 1.5\n", "weather.wetness: expected 0 to 1, found 1.5"),
        ] {
            let message = error(&format!("{DRIVE}{text}"));
            assert!(message.contains(expect), "{message}");
        }
        assert!(error("seed = 1").contains("neither"));
    }
}
