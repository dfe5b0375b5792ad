//! What stands in the plan of a facade: the rules of its openings, the wall that they cut, its tags.

use glam::{Vec2, Vec3, vec2};
use serde::Deserialize;
use trove_model::{Course, FacadeDesign, Filling, Fixtures, Interior, Opening, SurfaceKind};

use super::facade::Style;
use super::wall::{Finish, Grid};

/// A facade to paint: a `[[facade]]` of a file of plans. Lengths are metres, colours linear RGB.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct FacadePlan {
    /// Unique in its library.
    pub(crate) id: String,
    #[serde(default)]
    pub(crate) kind: FacadeKind,
    /// Words that say what it is; the builder asks for facades by them.
    #[serde(default)]
    pub(crate) tags: Vec<String>,
    /// Decides which window gets which curtain, where rain has run down.
    #[serde(default)]
    pub(crate) seed: u32,
    /// Bays and storeys in the texture.
    #[serde(default = "four")]
    cells: [u32; 2],
    bay_m: f32,
    storey_m: f32,
    finish: FinishPlan,
    /// Of the wall.
    color: [f32; 3],
    /// How much rain and soot show, 0 to 1.
    #[serde(default)]
    worn: f32,
    /// Openings of a bay, for each of the texture's bays in turn.
    #[serde(default)]
    bays: Vec<Vec<OpeningPlan>>,
    #[serde(default)]
    stagger: usize,
    frame: Option<[f32; 3]>,
    frame_m: Option<f32>,
    bar_m: Option<f32>,
    recess_m: Option<f32>,
    glass: Option<[f32; 3]>,
    #[serde(default)]
    interior: InteriorPlan,
    trim: Option<[f32; 3]>,
    #[serde(default)]
    sill_m: [f32; 2],
    #[serde(default)]
    lintel_m: [f32; 2],
    #[serde(default)]
    surround_m: [f32; 2],
    #[serde(default)]
    courses: Vec<CoursePlan>,
    #[serde(default)]
    pier_m: [f32; 2],
    #[serde(default)]
    cornice_m: [f32; 2],
    shutters: Option<[f32; 3]>,
    #[serde(default)]
    arcade_m: f32,
    /// What the wall's colour is multiplied by, one for each building.
    #[serde(default)]
    paints: Vec<[f32; 3]>,
    #[serde(default)]
    fixtures: FixturesPlan,
}

/// Where a facade is.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum FacadeKind {
    #[default]
    Facade,
    FacadeGroundFloor,
}

impl From<FacadeKind> for SurfaceKind {
    fn from(kind: FacadeKind) -> Self {
        match kind {
            FacadeKind::Facade => Self::Facade,
            FacadeKind::FacadeGroundFloor => Self::FacadeGroundFloor,
        }
    }
}

/// What the wall is made of; panels with their width and height.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
enum FinishPlan {
    Brick,
    Plaster,
    Concrete([f32; 2]),
    Metal([f32; 2]),
    Corrugated,
    Tiles,
    Boards,
}

impl From<FinishPlan> for Finish {
    fn from(finish: FinishPlan) -> Self {
        match finish {
            FinishPlan::Brick => Self::Brick,
            FinishPlan::Plaster => Self::Plaster,
            FinishPlan::Concrete(panel_m) => Self::Concrete(panel_m),
            FinishPlan::Metal(panel_m) => Self::Metal(panel_m),
            FinishPlan::Corrugated => Self::Corrugated,
            FinishPlan::Tiles => Self::Tiles,
            FinishPlan::Boards => Self::Boards,
        }
    }
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct OpeningPlan {
    #[serde(default)]
    filling: FillingPlan,
    /// Its low left corner from that of its bay and storey.
    low_m: [f32; 2],
    size_m: [f32; 2],
    /// Panes across and up.
    #[serde(default = "one")]
    panes: [u32; 2],
}

#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
enum FillingPlan {
    #[default]
    Window,
    Door,
    GlassDoor,
    Roller,
}

impl From<OpeningPlan> for Opening {
    fn from(plan: OpeningPlan) -> Self {
        let filling = match plan.filling {
            FillingPlan::Window => Filling::Window,
            FillingPlan::Door => Filling::Door,
            FillingPlan::GlassDoor => Filling::GlassDoor,
            FillingPlan::Roller => Filling::Roller,
        };
        let [low_m, size_m] = [plan.low_m, plan.size_m].map(Vec2::from_array);
        Self { filling, low_m, size_m, panes: plan.panes }
    }
}

#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
enum InteriorPlan {
    #[default]
    Home,
    Office,
    Shop,
    Bare,
}

impl From<InteriorPlan> for Interior {
    fn from(interior: InteriorPlan) -> Self {
        match interior {
            InteriorPlan::Home => Self::Home,
            InteriorPlan::Office => Self::Office,
            InteriorPlan::Shop => Self::Shop,
            InteriorPlan::Bare => Self::Bare,
        }
    }
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct CoursePlan {
    /// Lower and upper edge above the storey's floor.
    between_m: [f32; 2],
    #[serde(default)]
    out_m: f32,
    color: [f32; 3],
}

/// Shares of the openings that have something before them, 0 to 1.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct FixturesPlan {
    balconies: f32,
    glass_balconies: f32,
    conditioners: f32,
    cages: f32,
    laundry: f32,
    awnings: f32,
    signs: f32,
    blades: f32,
    oriels: f32,
    lamps: f32,
    fire_escapes: f32,
    scaffold: bool,
}

impl From<FixturesPlan> for Fixtures {
    fn from(plan: FixturesPlan) -> Self {
        let FixturesPlan {
            balconies,
            glass_balconies,
            conditioners,
            cages,
            laundry,
            awnings,
            signs,
            blades,
            oriels,
            lamps,
            fire_escapes,
            scaffold,
        } = plan;
        Self {
            balconies,
            glass_balconies,
            conditioners,
            cages,
            laundry,
            awnings,
            signs,
            blades,
            oriels,
            lamps,
            fire_escapes,
            scaffold,
        }
    }
}

fn four() -> [u32; 2] {
    [4, 4]
}

fn one() -> [u32; 2] {
    [1, 1]
}

impl FacadePlan {
    /// The key of a value that no facade can have, with what was expected and what it is.
    pub(crate) fn check(&self) -> Result<(), (&'static str, &'static str, String)> {
        let wrong = |key, expected, found: &dyn std::fmt::Debug| Err((key, expected, format!("{found:?}")));
        if self.cells.iter().any(|n| !(1..=16).contains(n)) {
            return wrong("cells", "two numbers from 1 to 16", &self.cells);
        }
        for (key, length_m) in [("bay_m", self.bay_m), ("storey_m", self.storey_m)] {
            if !(1.0..=20.0).contains(&length_m) {
                return wrong(key, "metres from 1 to 20", &length_m);
            }
        }
        if let FinishPlan::Concrete(panel_m) | FinishPlan::Metal(panel_m) = self.finish
            && panel_m.iter().any(|m| !(0.2..=20.0).contains(m))
        {
            return wrong("finish", "panels of 0.2 to 20 metres", &panel_m);
        }
        if !(0.0..=1.0).contains(&self.worn) {
            return wrong("worn", "a number from 0 to 1", &self.worn);
        }
        let (cell_m, thin) = (vec2(self.bay_m, self.storey_m), 1e-3);
        for opening in self.bays.iter().flatten() {
            let [low, size] = [opening.low_m, opening.size_m].map(Vec2::from_array);
            let inside = low.cmpge(Vec2::ZERO).all() && (low + size).cmple(cell_m + thin).all();
            if !(inside && size.cmpgt(Vec2::splat(0.05)).all()) {
                return wrong("bays", "openings inside their bay and storey", opening);
            }
            if opening.panes.iter().any(|n| !(1..=40).contains(n)) {
                return wrong("bays", "1 to 40 panes across and up", opening);
            }
        }
        let lengths = [self.sill_m, self.lintel_m, self.surround_m, self.pier_m, self.cornice_m];
        let keys = ["sill_m", "lintel_m", "surround_m", "pier_m", "cornice_m"];
        for (key, pair) in keys.into_iter().zip(lengths) {
            if pair.iter().any(|m| !(0.0..=5.0).contains(m)) {
                return wrong(key, "metres from 0 to 5", &pair);
            }
        }
        let single = [self.frame_m, self.bar_m, self.recess_m, Some(self.arcade_m)];
        for (key, value) in ["frame_m", "bar_m", "recess_m", "arcade_m"].into_iter().zip(single) {
            if value.is_some_and(|m| !(0.0..=10.0).contains(&m)) {
                return wrong(key, "metres from 0 to 10", &value);
            }
        }
        for course in &self.courses {
            let [low, high] = course.between_m;
            if !(0.0 <= low && low <= high && high <= self.storey_m + thin && (0.0..=5.0).contains(&course.out_m)) {
                return wrong("courses", "a band within the storey", course);
            }
        }
        let own = [Some(self.color), self.frame, self.glass, self.trim, self.shutters];
        let mut colors = own.into_iter().flatten().chain(self.courses.iter().map(|c| c.color));
        if let Some(color) = colors.find(|c| c.iter().any(|v| !(0.0..=1.0).contains(v))) {
            return wrong("color", "colours from 0 to 1", &color);
        }
        if let Some(paint) = self.paints.iter().find(|c| c.iter().any(|v| !(0.0..=10.0).contains(v))) {
            return wrong("paints", "factors from 0 to 10", paint);
        }
        Ok(())
    }

    /// The facade's rules with the wall that they cut.
    pub(super) fn style(&self) -> Style {
        let color = |own: Option<[f32; 3]>, default: Vec3| own.map_or(default, Vec3::from_array);
        let plain = FacadeDesign::default();
        let course =
            |c: &CoursePlan| Course { between_m: c.between_m, out_m: c.out_m, color: Vec3::from_array(c.color) };
        let design = FacadeDesign {
            bays: self.bays.iter().map(|bay| bay.iter().copied().map(Opening::from).collect()).collect(),
            stagger: self.stagger,
            frame: color(self.frame, plain.frame),
            frame_m: self.frame_m.unwrap_or(plain.frame_m),
            bar_m: self.bar_m.unwrap_or(plain.bar_m),
            recess_m: self.recess_m.unwrap_or(plain.recess_m),
            glass: color(self.glass, plain.glass),
            interior: self.interior.into(),
            trim: color(self.trim, plain.trim),
            sill_m: self.sill_m,
            lintel_m: self.lintel_m,
            surround_m: self.surround_m,
            courses: self.courses.iter().map(course).collect(),
            pier_m: self.pier_m,
            cornice_m: self.cornice_m,
            shutters: self.shutters.map(Vec3::from_array),
            arcade_m: self.arcade_m,
            paints: self.paints.iter().copied().map(Vec3::from_array).collect(),
            fixtures: self.fixtures.into(),
            ..plain
        };
        let grid = Grid { cells: self.cells, cell_m: vec2(self.bay_m, self.storey_m), detail: 1 };
        let color = Vec3::from_array(self.color);
        Style { grid, finish: self.finish.into(), color, worn: self.worn, design }
    }
}
