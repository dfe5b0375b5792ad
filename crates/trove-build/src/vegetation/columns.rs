//! Sums over the columns of a grid.

use glam::DVec2;
use trove_model::Bounds;

/// What was seen of vegetation above one square of the ground.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Column {
    /// Points, each weighted for its distance from the sensor.
    pub mass: f64,
    /// The share of them within reach of a bush's twigs.
    pub low_mass: f64,
    /// The highest above the ground, metres.
    pub top_m: f64,
    /// The highest beam cut it off.
    pub cut: bool,
}

/// Columns side by side.
#[derive(Clone, Debug)]
pub(super) struct Columns {
    origin: DVec2,
    cell_m: f64,
    width: usize,
    height: usize,
    cells: Vec<Column>,
}

impl Columns {
    /// Empty columns of `cell_m` width.
    pub(super) fn new(bounds: Bounds, cell_m: f64) -> Self {
        let size = (bounds.size_m() / cell_m).ceil().max(DVec2::ONE);
        let (width, height) = (size.x as usize, size.y as usize);
        Self { origin: bounds.min, cell_m, width, height, cells: vec![Column::default(); width * height] }
    }

    /// Adds a point at some height above the ground; what is `low` counts for bushes.
    pub(super) fn add(&mut self, p: DVec2, above_m: f64, mass: f64, low: bool, cut: bool) {
        let cell = ((p - self.origin) / self.cell_m).floor();
        if cell.cmplt(DVec2::ZERO).any() || cell.x as usize >= self.width || cell.y as usize >= self.height {
            return;
        }
        let column = &mut self.cells[cell.y as usize * self.width + cell.x as usize];
        column.mass += mass;
        column.low_mass += if low { mass } else { 0.0 };
        column.top_m = column.top_m.max(above_m);
        column.cut |= cut;
    }

    /// Every column with something in it, with its centre, row by row.
    pub(super) fn filled(&self) -> impl Iterator<Item = (DVec2, &Column)> {
        let centre = |i: usize| DVec2::new((i % self.width) as f64, (i / self.width) as f64) + 0.5;
        let filled = self.cells.iter().enumerate().filter(|(_, c)| c.mass > 0.0);
        filled.map(move |(i, c)| (self.origin + centre(i) * self.cell_m, c))
    }

    /// Sums and highest top over the columns within `radius_m` of a point.
    pub(super) fn around(&self, p: DVec2, radius_m: f64) -> Column {
        let low = ((p - radius_m - self.origin) / self.cell_m).floor().max(DVec2::ZERO);
        let high = ((p + radius_m - self.origin) / self.cell_m).ceil().max(DVec2::ZERO);
        let mut sum = Column::default();
        for y in low.y as usize..(high.y as usize).min(self.height) {
            for x in low.x as usize..(high.x as usize).min(self.width) {
                let centre = self.origin + (DVec2::new(x as f64, y as f64) + 0.5) * self.cell_m;
                if centre.distance(p) <= radius_m {
                    let column = &self.cells[y * self.width + x];
                    sum.mass += column.mass;
                    sum.low_mass += column.low_mass;
                    sum.top_m = sum.top_m.max(column.top_m);
                    sum.cut |= column.cut;
                }
            }
        }
        sum
    }
}
