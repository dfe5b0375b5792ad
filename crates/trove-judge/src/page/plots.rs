//! Plots as SVG.

use std::fmt::Write;

use glam::DVec2;

use super::escape::escape;

/// Width of a histogram's bin, and side of a map, of a plot of curves and of a heat map's cell, pixels.
const BIN_PX: usize = 33;
const MAP_PX: f64 = 320.0;
const CURVES_PX: [f64; 2] = [320.0, 140.0];
const CELL_PX: usize = 30;
/// Width of a capital or digit at the size of the plots' text, to leave room for names, pixels.
const LETTER_PX: f64 = 7.0;
/// Shares of the accent from which the ink on it is the other one, in light and in dark, so that its contrast with the
/// cell is 4.5 at least.
const OTHER_INK: [f64; 2] = [0.615, 0.845];

/// A drawing, and what it is of, for those who do not see it.
#[derive(Clone, Debug)]
pub struct Plot {
    label: String,
    attributes: String,
    content: String,
    is_fluid: bool,
}

impl Plot {
    fn sized(label: &str, width: f64, height: f64, content: String) -> Self {
        let attributes = format!("width=\"{width:.0}\" height=\"{height:.0}\" viewBox=\"0 0 {width:.0} {height:.0}\"");
        Self { label: label.into(), attributes, content, is_fluid: false }
    }

    pub(super) fn label(&self) -> &str {
        &self.label
    }

    /// Whether it is as wide as there is room.
    pub(super) fn is_fluid(&self) -> bool {
        self.is_fluid
    }

    pub(super) fn svg(&self) -> String {
        let Self { label, attributes, content, .. } = self;
        format!("<svg {attributes} role=\"img\" aria-label=\"{}\">{content}</svg>", escape(label))
    }
}

/// A dot in the colour of a class of marks, for a key.
pub(super) fn mark(class: &str) -> String {
    let class = escape(class);
    format!(
        "<svg width=\"12\" height=\"12\" aria-hidden=\"true\"><circle class=\"{class}\" cx=\"6\" cy=\"6\" r=\"5\"/></svg>"
    )
}

/// What a bar is filled with.
#[derive(Clone, Copy, Debug)]
pub enum Fill {
    /// A colour, sRGB.
    Rgb([u8; 3]),
    /// That of a class of marks.
    Class(&'static str),
}

/// A bar from the left.
#[derive(Clone, Copy, Debug)]
pub struct Bar {
    /// Its length, as a share of the room.
    pub share: f64,
    /// Its colour.
    pub fill: Fill,
    /// An interval over it, in shares of the room.
    pub interval: Option<[f64; 2]>,
}

/// Bars below a name and a value.
#[derive(Clone, Debug)]
pub struct BarRow {
    /// What they are of.
    pub name: String,
    /// What they tell, in digits.
    pub value: String,
    /// The bars.
    pub bars: Vec<Bar>,
}

/// Rows of bars over a scale with ticks at some shares of the room.
pub fn bar_rows(label: &str, ticks: &[(f64, &str)], rows: &[BarRow]) -> Plot {
    const TEXT: usize = 18;
    const BAR: usize = 10;
    let (mut svg, mut y) = (String::new(), 0);
    for row in rows {
        let (name, value) = (escape(&row.name), escape(&row.value));
        let (base, height) = (y + TEXT - 4, row.bars.len() * BAR);
        let _ = write!(
            svg,
            "<text y=\"{base}\">{name}</text><text x=\"100%\" y=\"{base}\" text-anchor=\"end\">{value}</text>\
             <rect class=\"track\" y=\"{top}\" width=\"100%\" height=\"{height}\"/>",
            top = y + TEXT
        );
        for (share, _) in ticks {
            let (x, top, end) = (share * 100.0, y + TEXT, y + TEXT + height);
            let _ = write!(svg, "<line class=\"line\" x1=\"{x:.2}%\" x2=\"{x:.2}%\" y1=\"{top}\" y2=\"{end}\"/>");
        }
        for (i, bar) in row.bars.iter().enumerate() {
            let (top, width) = (y + TEXT + i * BAR, bar.share.clamp(0.0, 1.0) * 100.0);
            let fill = match bar.fill {
                Fill::Rgb([r, g, b]) => format!("fill=\"rgb({r},{g},{b})\""),
                Fill::Class(class) => format!("class=\"{class}\""),
            };
            let _ = write!(svg, "<rect {fill} y=\"{top}\" width=\"{width:.2}%\" height=\"{BAR}\"/>");
            if let Some([low, high]) = bar.interval.map(|ends| ends.map(|end| end.clamp(0.0, 1.0) * 100.0)) {
                let middle = top as f64 + BAR as f64 / 2.0;
                // A halo sets it off from bars that are as dark as it is.
                for class in ["whisker halo", "whisker"] {
                    let _ = write!(
                        svg,
                        "<line class=\"{class}\" x1=\"{low:.2}%\" x2=\"{high:.2}%\" y1=\"{middle}\" y2=\"{middle}\"/>"
                    );
                }
            }
        }
        y += TEXT + height + 6;
    }
    for (share, name) in ticks {
        let anchor = match share {
            0.0 => "start",
            1.0 => "end",
            _ => "middle",
        };
        let (x, base, name) = (share * 100.0, y + 12, escape(name));
        let _ = write!(svg, "<text x=\"{x:.2}%\" y=\"{base}\" text-anchor=\"{anchor}\">{name}</text>");
    }
    let attributes = format!("class=\"rows\" width=\"100%\" height=\"{}\"", y + 18);
    Plot { label: label.into(), attributes, content: svg, is_fluid: true }
}

/// A bin of a histogram.
#[derive(Clone, Debug)]
pub struct Bin {
    /// What stands under it.
    pub name: String,
    /// How many are in it.
    pub all: usize,
    /// How many of them are drawn in front.
    pub part: usize,
}

/// How often values fall into each of some bins between 0 and `high`; what is higher falls into the last.
pub fn counts(values: impl IntoIterator<Item = f64>, bins: usize, high: f64) -> Vec<usize> {
    let mut counts = vec![0; bins];
    values.into_iter().for_each(|value| counts[((value / high * bins as f64) as usize).min(bins - 1)] += 1);
    counts
}

/// Bars of all, pale, with a part in front.
pub fn histogram(label: &str, bins: &[Bin]) -> Plot {
    let most = bins.iter().map(|bin| bin.all).max().unwrap_or(0).max(1);
    let mut svg = String::new();
    for (i, bin) in bins.iter().enumerate() {
        let (x, middle) = (i * BIN_PX, i * BIN_PX + BIN_PX / 2);
        for (class, count) in [("pale", bin.all), ("bar", bin.part)] {
            let (height, width) = (100.0 * count as f64 / most as f64, BIN_PX - 4);
            let y = 122.0 - height;
            let _ = write!(
                svg,
                "<rect class=\"{class}\" x=\"{}\" y=\"{y:.1}\" width=\"{width}\" height=\"{height:.1}\"/>",
                x + 2
            );
        }
        if bin.all > 0 {
            let top = 117 - 100 * bin.all / most;
            let _ = write!(svg, "<text x=\"{middle}\" y=\"{top}\" text-anchor=\"middle\">{}</text>", bin.all);
        }
        let name = escape(&bin.name);
        let _ = write!(svg, "<text x=\"{middle}\" y=\"140\" text-anchor=\"middle\">{name}</text>");
    }
    Plot::sized(label, (bins.len() * BIN_PX) as f64, 146.0, svg)
}

/// Curves over the same bins between two values, each with its class of marks; the highest fills the height.
pub fn curves(label: &str, [low, high]: [f64; 2], curves: &[(&str, Vec<f64>)]) -> Plot {
    let [width, height] = CURVES_PX;
    let most = curves.iter().flat_map(|(_, values)| values).fold(f64::MIN_POSITIVE, |most, value| most.max(*value));
    let mut svg = format!("<line class=\"line\" x1=\"0\" x2=\"{width}\" y1=\"{0}\" y2=\"{0}\"/>", height - 18.0);
    for (class, values) in curves {
        let point = |(i, value): (usize, &f64)| {
            let x = (i as f64 + 0.5) / values.len() as f64 * width;
            format!("{x:.1},{:.1}", height - 18.0 - value / most * (height - 22.0))
        };
        let points: Vec<String> = values.iter().enumerate().map(point).collect();
        let _ = write!(svg, "<polyline class=\"curve {class}\" points=\"{}\"/>", points.join(" "));
    }
    let ends = [(low, 0.0, "start"), ((low + high) / 2.0, width / 2.0, "middle"), (high, width, "end")];
    for (value, x, anchor) in ends {
        let _ = write!(svg, "<text x=\"{x}\" y=\"{}\" text-anchor=\"{anchor}\">{value:.0}</text>", height - 4.0);
    }
    Plot::sized(label, width, height, svg)
}

/// A square map of dots, each with its class of marks, in metres east and north; `label` is followed by its side.
pub fn map(label: &str, dots: &[(&str, DVec2)]) -> Plot {
    let low = dots.iter().fold(DVec2::INFINITY, |low, (_, at)| low.min(*at));
    let high = dots.iter().fold(DVec2::NEG_INFINITY, |high, (_, at)| high.max(*at));
    let side_m = (high - low).max_element().max(10.0) * 1.1;
    let corner = (low + high - side_m) / 2.0;
    let mut svg = format!("<rect class=\"frame\" width=\"{MAP_PX}\" height=\"{MAP_PX}\"/>");
    for (class, at) in dots {
        let at = (at - corner) / side_m * MAP_PX;
        let _ = write!(svg, "<circle class=\"{class}\" cx=\"{:.1}\" cy=\"{:.1}\" r=\"3\"/>", at.x, MAP_PX - at.y);
    }
    Plot::sized(&format!("{label} ({side_m:.0} m wide)"), MAP_PX, MAP_PX, svg)
}

/// A cell of a heat map.
#[derive(Clone, Debug)]
pub struct HeatCell {
    /// How much of the accent it has, 0 to 1.
    pub share: f64,
    /// What stands in it.
    pub text: String,
    /// What it says when it is pointed at.
    pub more: String,
}

/// Cells by row and column, `None` where there is nothing; rows and columns have names.
pub fn heat_map(label: &str, rows: &[&str], columns: &[&str], cell: impl Fn(usize, usize) -> Option<HeatCell>) -> Plot {
    let room = |names: &[&str]| names.iter().map(|name| name.chars().count()).max().unwrap_or(0) as f64 * LETTER_PX;
    let (left, top) = ((room(rows) + 8.0) as usize, (room(columns) + 8.0) as usize);
    let mut svg = String::new();
    for (i, name) in columns.iter().enumerate() {
        let (x, y) = (left + i * CELL_PX + CELL_PX / 2 + 4, top - 6);
        let _ = write!(svg, "<text transform=\"translate({x} {y}) rotate(-90)\">{}</text>", escape(name));
    }
    for (i, name) in rows.iter().enumerate() {
        let (x, y) = (left - 6, top + i * CELL_PX + CELL_PX / 2 + 4);
        let _ = write!(svg, "<text x=\"{x}\" y=\"{y}\" text-anchor=\"end\">{}</text>", escape(name));
    }
    for (i, j) in (0..rows.len()).flat_map(|i| (0..columns.len()).map(move |j| (i, j))) {
        let (x, y) = (left + j * CELL_PX, top + i * CELL_PX);
        if let Some(HeatCell { share, text, more }) = cell(i, j) {
            let ink = match share {
                share if share < OTHER_INK[0] => "on-low",
                share if share < OTHER_INK[1] => "on-middle",
                _ => "on-high",
            };
            let (text, more) = (escape(&text), escape(&more));
            let _ = write!(
                svg,
                "<g><title>{more}</title><rect class=\"cell\" x=\"{x}\" y=\"{y}\" width=\"{CELL_PX}\" height=\"{CELL_PX}\" \
                 fill-opacity=\"{share:.3}\"/><text class=\"{ink}\" x=\"{}\" y=\"{}\" text-anchor=\"middle\">{text}</text></g>",
                x + CELL_PX / 2,
                y + CELL_PX / 2 + 4,
            );
        }
        let _ = write!(svg, "<rect class=\"frame\" x=\"{x}\" y=\"{y}\" width=\"{CELL_PX}\" height=\"{CELL_PX}\"/>");
    }
    let [width, height] = [left + columns.len() * CELL_PX, top + rows.len() * CELL_PX];
    Plot::sized(label, width as f64 + 1.0, height as f64 + 1.0, svg)
}
