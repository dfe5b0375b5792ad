//! How facades are divided, and what fills their bays: rules that a flat texture and built walls follow alike.

use glam::{Vec2, Vec3};

/// What an opening in a wall is closed with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Filling {
    /// Panes in a frame, with a room behind.
    Window,
    /// A leaf of panels.
    Door,
    /// A leaf with a pane.
    GlassDoor,
    /// A door that rolls up.
    Roller,
}

/// A hole in the wall of a bay.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Opening {
    /// What it is closed with.
    pub filling: Filling,
    /// Its low left corner from the low left corner of its bay and storey, metres.
    pub low_m: Vec2,
    /// Width and height, metres.
    pub size_m: Vec2,
    /// Panes across and up.
    pub panes: [u32; 2],
}

impl Opening {
    /// Whether one can step out of it.
    pub fn is_french(&self) -> bool {
        self.filling == Filling::Window && self.low_m.y < 0.35
    }

    /// Whether it shows goods, on a ground floor with some interior.
    pub fn is_shop(&self, interior: Interior) -> bool {
        interior == Interior::Shop && self.filling == Filling::Window && self.size_m.x >= 1.6
    }
}

/// What is seen behind windows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[allow(missing_docs)] // the names are the definition
pub enum Interior {
    Home,
    Office,
    Shop,
    /// Dark and empty.
    Bare,
}

/// A band along every storey.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Course {
    /// Lower and upper edge above the storey's floor, metres.
    pub between_m: [f32; 2],
    /// How far it stands out of the wall, metres; 0: it is painted.
    pub out_m: f32,
    /// Its colour, linear RGB.
    pub color: Vec3,
}

/// What stands in front of some openings, each as the share of the openings that have it, 0 to 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Fixtures {
    /// Balconies with bars.
    pub balconies: f32,
    /// Balconies with panes.
    pub glass_balconies: f32,
    /// Outside halves of air conditioners.
    pub conditioners: f32,
    /// Cages of bars around windows.
    pub cages: f32,
    /// Poles with laundry.
    pub laundry: f32,
    /// Awnings of cloth.
    pub awnings: f32,
    /// Shops' signs over the opening.
    pub signs: f32,
    /// Signs that stand out into the street.
    pub blades: f32,
    /// Bays that stand out of the wall with windows on three sides.
    pub oriels: f32,
    /// Lamps beside doors.
    pub lamps: f32,
    /// Iron stairs before a front, as a share of the fronts.
    pub fire_escapes: f32,
    /// Whether a scaffold stands before it.
    pub scaffold: bool,
}

/// The rules of a facade.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FacadeDesign {
    /// Tag of the surface of the wall between the openings, of the kind `Wall`.
    pub wall: String,
    /// Multiplies that surface's colour.
    pub wall_tint: Vec3,
    /// Openings of a bay, for each of the texture's bays in turn; every storey is alike but for `stagger`.
    pub bays: Vec<Vec<Opening>>,
    /// Bays that the pattern moves on by with every storey.
    pub stagger: usize,
    /// Colour of window frames and glass doors.
    pub frame: Vec3,
    /// Width of frames, metres.
    pub frame_m: f32,
    /// Width of the bars between panes, metres.
    pub bar_m: f32,
    /// How deep glass and leaves lie behind the wall, metres.
    pub recess_m: f32,
    /// What the glass tints things behind it, linear RGB.
    pub glass: Vec3,
    /// What is behind it.
    pub interior: Interior,
    /// Colour of sills, lintels, surrounds.
    pub trim: Vec3,
    /// Height and projection of sills, metres; zeros: none.
    pub sill_m: [f32; 2],
    /// Height and projection of lintels, metres; zeros: none.
    pub lintel_m: [f32; 2],
    /// Width and projection of surrounds, metres; zeros: none.
    pub surround_m: [f32; 2],
    /// Bands along every storey.
    pub courses: Vec<Course>,
    /// Width and projection of piers between the bays, metres; zeros: none.
    pub pier_m: [f32; 2],
    /// Height and projection of the cornice under the eaves, metres; zeros: none.
    pub cornice_m: [f32; 2],
    /// Colour of shutters; `None`: none.
    pub shutters: Option<Vec3>,
    /// Depth of a walk behind columns, metres, at whose back the openings are; 0: none.
    pub arcade_m: f32,
    /// Colours to draw from that multiply the wall's; empty: as it is.
    pub paints: Vec<Vec3>,
    /// What stands in front.
    pub fixtures: Fixtures,
}

impl Default for FacadeDesign {
    /// A white wall without openings.
    fn default() -> Self {
        Self {
            wall: String::new(),
            wall_tint: Vec3::ONE,
            bays: Vec::new(),
            stagger: 0,
            frame: Vec3::splat(0.6),
            frame_m: 0.06,
            bar_m: 0.04,
            recess_m: 0.14,
            glass: Vec3::ONE,
            interior: Interior::Home,
            trim: Vec3::splat(0.35),
            sill_m: [0.0; 2],
            lintel_m: [0.0; 2],
            surround_m: [0.0; 2],
            courses: Vec::new(),
            pier_m: [0.0; 2],
            cornice_m: [0.0; 2],
            shutters: None,
            arcade_m: 0.0,
            paints: Vec::new(),
            fixtures: Fixtures::default(),
        }
    }
}

impl FacadeDesign {
    /// The openings of a bay on a storey, both counted as in the texture.
    pub fn openings(&self, bay: usize, storey: usize) -> &[Opening] {
        match self.bays.len() {
            0 => &[],
            n => &self.bays[(bay + storey * self.stagger) % n],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_staggered_pattern_moves_on_with_every_storey() {
        let opening = Opening { filling: Filling::Window, low_m: Vec2::ONE, size_m: Vec2::ONE, panes: [1, 1] };
        let design = FacadeDesign { bays: vec![vec![opening], vec![]], stagger: 1, ..FacadeDesign::default() };
        assert_eq!(design.openings(0, 0).len(), 1);
        assert_eq!(design.openings(0, 1).len(), 0);
        assert_eq!(design.openings(3, 1).len(), 1);
        assert!(FacadeDesign::default().openings(3, 1).is_empty());
    }
}
