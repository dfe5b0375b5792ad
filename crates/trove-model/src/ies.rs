//! Tables of luminous intensity in the form of ANSI/IES LM-63 (1986 to 2019), photometric type C.

use std::fmt;
use std::str::FromStr;

use crate::Beam;

/// The year from which on the factor of ballast and lamp is no longer one.
const FACTOR_OF_BALLAST_AND_LAMP_UNTIL: u32 = 1995;
/// Light that ends at a table's edge is gone this far beyond it, degrees.
const EDGE_DEG: f32 = 0.05;

/// What is wrong in the text of an IES file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct IesFault {
    /// Counted from 1.
    pub line: usize,
    /// What should stand there.
    pub expected: String,
    /// What does.
    pub found: String,
    /// What to do.
    pub remedy: String,
}

impl fmt::Display for IesFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { line, expected, found, remedy } = self;
        write!(f, "line {line}: expected {expected}, found {found}; {remedy}")
    }
}

impl std::error::Error for IesFault {}

/// What follows the word TILT.
enum Tilt {
    None,
    Included,
}

/// Candelas into the directions of a lamp's mesh: the street's side, C = 90°, is along +x, the nadir along −z.
pub(crate) fn candelas(text: &str) -> Result<Beam, IesFault> {
    let (tilt_line, tilt) = tilt(text)?;
    let mut numbers = Numbers::after(text, tilt_line);
    if let Tilt::Included = tilt {
        // A lamp that burns tilted gives less; the table was measured as it hangs.
        numbers.number::<u8>("how the lamp lies in the luminaire, 1 to 3")?;
        let pairs = numbers.count("the number of tilts")?;
        numbers.take(2 * pairs, "a tilt or its factor")?;
    }
    numbers.number::<f32>("the number of lamps")?;
    numbers.number::<f32>("lumens of a lamp, or -1")?;
    let multiplier = numbers.positive("the candelas' multiplier")?;
    let vertical = numbers.count("the number of vertical angles")?;
    let horizontal = numbers.count("the number of horizontal angles")?;
    let at = numbers.line();
    let photometric_type = numbers.number::<u8>("the photometric type")?;
    if photometric_type != 1 {
        let name = ["1, type C", "2, type B", "3, type A"].get(usize::from(photometric_type).wrapping_sub(1));
        let found = name.map_or(photometric_type.to_string(), |name| (*name).to_owned());
        return Err(fault(at, "1, photometric type C", found, "convert the file to type C"));
    }
    numbers.take(4, "the unit and the luminaire's size")?;
    let ballast = numbers.positive("the ballast's factor")?;
    let ballast_and_lamp = numbers.number::<f32>("the factor of ballast and lamp, or a number for later use")?;
    numbers.number::<f32>("watts")?;
    let scale = multiplier * ballast * if is_old(text) { ballast_and_lamp } else { 1.0 };

    let at = numbers.line();
    let gammas_deg = numbers.angles(vertical, 180.0, "a vertical angle")?;
    if gammas_deg[0] != 0.0 && gammas_deg[0] != 90.0 {
        let found = gammas_deg[0].to_string();
        return Err(fault(at, "vertical angles from 0 or 90 on", found, "correct the first vertical angle"));
    }
    let at = numbers.line();
    let planes_deg = numbers.angles(horizontal, 360.0, "a horizontal angle")?;
    let symmetry = Symmetry::of(&planes_deg).ok_or_else(|| {
        let found = format!("{} to {}", planes_deg[0], planes_deg[horizontal - 1]);
        let expected = "horizontal angles of 0 alone, 0 to 90, 0 to 180, 90 to 270 or 0 to 360";
        fault(at, expected, found, "export the file again")
    })?;
    let at = numbers.line();
    // A row for each plane.
    let values = numbers.take(vertical * horizontal, "candelas")?;
    if let Some(bad) = values.iter().find(|value| **value < 0.0 || !(**value * scale).is_finite()) {
        return Err(fault(at, "candelas of at least 0", bad, "correct the number in the table that begins there"));
    }
    if values.iter().all(|value| *value * scale <= 0.0) {
        return Err(fault(at, "candelas of which one is above 0", "none", "leave the lamp without a table"));
    }
    numbers.end()?;

    let around = symmetry.expanded(&planes_deg);
    let mut rows: Vec<(f32, Vec<f32>)> = (0..vertical)
        .map(|v| (gammas_deg[v] - 90.0, around.iter().map(|(_, plane)| values[plane * vertical + v] * scale).collect()))
        .collect();
    // Beyond a table there is no light.
    let dark = vec![0.0; around.len()];
    if gammas_deg[0] > 0.0 {
        rows.insert(0, (rows[0].0 - EDGE_DEG, dark.clone()));
    }
    if gammas_deg[vertical - 1] < 180.0 {
        rows.push((rows[rows.len() - 1].0 + EDGE_DEG, dark));
    }
    let (elevations_deg, shares): (Vec<f32>, Vec<Vec<f32>>) = rows.into_iter().unzip();
    let azimuths_deg = around.iter().map(|(azimuth_deg, _)| *azimuth_deg).collect();
    let damaged = || fault(at, "angles that grow and finite candelas", "others", "export the file again");
    Beam::new(azimuths_deg, elevations_deg, shares.concat()).ok_or_else(damaged)
}

/// The line of the word TILT and what follows it.
fn tilt(text: &str) -> Result<(usize, Tilt), IesFault> {
    let mut lines = 0;
    for (i, line) in text.lines().enumerate() {
        lines = i + 1;
        let Some(value) = line.trim().strip_prefix("TILT") else { continue };
        let Some(value) = value.trim_start().strip_prefix('=') else { continue };
        return match value.trim().to_ascii_uppercase().as_str() {
            "NONE" => Ok((lines, Tilt::None)),
            "INCLUDE" => Ok((lines, Tilt::Included)),
            _ => Err(fault(lines, "TILT=NONE or TILT=INCLUDE", value.trim(), "put the tilts into this file, or NONE")),
        };
    }
    Err(fault(lines.max(1), "a line TILT=NONE or TILT=INCLUDE", "none", "check that this is an IES file (LM-63)"))
}

/// Whether the form is from a year in which the twelfth number was a factor.
fn is_old(text: &str) -> bool {
    let first = text.lines().next().unwrap_or_default().trim();
    let year = first.rsplit('-').next().and_then(|year| year.parse::<u32>().ok());
    // IESNA91 and what has no such line are older.
    year.is_none_or(|year| year <= FACTOR_OF_BALLAST_AND_LAMP_UNTIL)
}

fn fault(line: usize, expected: impl ToString, found: impl ToString, remedy: impl ToString) -> IesFault {
    let [expected, found, remedy] = [expected.to_string(), found.to_string(), remedy.to_string()];
    IesFault { line, expected, found, remedy }
}

/// Which planes a table leaves out, since they are like others.
#[derive(Clone, Copy)]
enum Symmetry {
    /// 0° alone.
    Around,
    /// 0° to 90°.
    Quarters,
    /// 0° to 180°: the street's side is like the houses'.
    AlongTheStreet,
    /// 90° to 270°: up the street is like down the street.
    AcrossTheStreet,
    /// 0° to 360°.
    None,
}

impl Symmetry {
    fn of(planes_deg: &[f32]) -> Option<Self> {
        match (planes_deg.first()?, planes_deg.last()?) {
            (0.0, 0.0) => Some(Self::Around),
            (0.0, 90.0) => Some(Self::Quarters),
            (0.0, 180.0) => Some(Self::AlongTheStreet),
            (90.0, 270.0) => Some(Self::AcrossTheStreet),
            (0.0, 360.0) => Some(Self::None),
            _ => None,
        }
    }

    /// Where the planes of the same light are.
    fn alike_deg(self, c: f32) -> Vec<f32> {
        match self {
            Self::Around => vec![0.0, 360.0],
            Self::Quarters => vec![c, 180.0 - c, 180.0 + c, 360.0 - c],
            Self::AlongTheStreet => vec![c, 360.0 - c],
            Self::AcrossTheStreet => vec![c, 540.0 - c],
            Self::None => vec![c],
        }
    }

    /// Azimuths from −180° to 180° that grow, each with the index of its plane.
    fn expanded(self, planes_deg: &[f32]) -> Vec<(f32, usize)> {
        let alike = planes_deg.iter().enumerate().flat_map(|(plane, &c)| {
            // Also a turn on, so that the ends of the whole meet: C = −90° to 270°.
            let turns = self.alike_deg(c).into_iter().flat_map(|c| [c - 360.0, c]);
            turns.map(move |c| (c - 90.0, plane))
        });
        let mut around: Vec<(f32, usize)> = alike.collect();
        around.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        around.dedup_by_key(|(azimuth_deg, _)| *azimuth_deg);
        // One plane beyond each end, so that what lies between is blended.
        let first = around.partition_point(|(azimuth_deg, _)| *azimuth_deg <= -180.0).saturating_sub(1);
        let last = around.partition_point(|(azimuth_deg, _)| *azimuth_deg < 180.0).min(around.len() - 1);
        around[first..=last].to_vec()
    }
}

/// The numbers of a text, parted by spaces, commas or ends of lines.
struct Numbers<'a> {
    words: Vec<(usize, &'a str)>,
    next: usize,
    last_line: usize,
}

impl<'a> Numbers<'a> {
    fn after(text: &'a str, line: usize) -> Self {
        let lines = text.lines().enumerate().skip(line);
        let words = |(i, line): (usize, &'a str)| {
            let words = line.split(|c: char| c.is_whitespace() || c == ',').filter(|word| !word.is_empty());
            words.map(move |word| (i + 1, word))
        };
        Self { words: lines.flat_map(words).collect(), next: 0, last_line: text.lines().count() }
    }

    /// The line of the next number.
    fn line(&self) -> usize {
        self.words.get(self.next).map_or(self.last_line, |(line, _)| *line)
    }

    fn number<T: FromStr>(&mut self, what: &str) -> Result<T, IesFault> {
        let Some((line, word)) = self.words.get(self.next) else {
            let remedy = "the file is cut off, or a number of angles is wrong: export it again";
            return Err(fault(self.last_line, what, "the end of the file", remedy));
        };
        self.next += 1;
        word.parse().map_err(|_| fault(*line, what, format!("{word:?}"), "correct the number"))
    }

    /// Numbers that are finite.
    fn take(&mut self, count: usize, what: &str) -> Result<Vec<f32>, IesFault> {
        (0..count).map(|_| self.finite(what)).collect()
    }

    fn finite(&mut self, what: &str) -> Result<f32, IesFault> {
        let line = self.line();
        let number: f32 = self.number(what)?;
        if number.is_finite() { Ok(number) } else { Err(fault(line, what, number, "correct the number")) }
    }

    fn positive(&mut self, what: &str) -> Result<f32, IesFault> {
        let line = self.line();
        let number = self.finite(what)?;
        if number > 0.0 {
            Ok(number)
        } else {
            Err(fault(line, format!("{what} above 0"), number, "correct the number"))
        }
    }

    /// A number of numbers: there are at least so many left.
    fn count(&mut self, what: &str) -> Result<usize, IesFault> {
        let line = self.line();
        let count: usize = self.number(what)?;
        let left = self.words.len() - self.next;
        if (1..=left).contains(&count) {
            return Ok(count);
        }
        let remedy = "the file is cut off, or the number is wrong: export it again";
        Err(fault(line, format!("{what}, from 1 to the {left} numbers that follow"), count, remedy))
    }

    fn angles(&mut self, count: usize, most: f32, what: &str) -> Result<Vec<f32>, IesFault> {
        let mut angles: Vec<f32> = Vec::new();
        for _ in 0..count {
            let line = self.line();
            let angle = self.finite(what)?;
            if !(0.0..=most).contains(&angle) || angles.last().is_some_and(|before| *before >= angle) {
                let expected = format!("{what} from 0 to {most} that is above the one before");
                return Err(fault(line, expected, angle, "correct the angle"));
            }
            angles.push(angle);
        }
        Ok(angles)
    }

    fn end(&self) -> Result<(), IesFault> {
        let remedy = "correct the numbers of angles: there are more candelas than they tell";
        self.words
            .get(self.next)
            .map_or(Ok(()), |(line, word)| Err(fault(*line, "the end of the table", format!("{word:?}"), remedy)))
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use proptest::prelude::*;

    use super::*;

    /// A file with this line of angles and candelas.
    fn file(form: &str, tilt: &str, sizes: &str, table: &str) -> String {
        format!(
            "{form}\n[TEST] ours\n[LAMP] a lamp\nTILT={tilt}\n1 -1 2.0 {sizes} 1 2 0.3 0.6 0\n0.5 0.8 60\n{table}\n"
        )
    }

    /// Of a file with its vertical angles 0, 45 and 90.
    fn at(text: &str, c_deg: f32, gamma_deg: f32) -> f32 {
        let (a, g) = ((c_deg - 90.0).to_radians(), gamma_deg.to_radians());
        candelas(text).unwrap().share(Vec3::new(a.cos() * g.sin(), a.sin() * g.sin(), -g.cos()))
    }

    fn near(found: f32, expected: f32) {
        assert!((found - expected).abs() < 1e-3 * expected.max(1.0), "{found} instead of {expected}");
    }

    #[test]
    fn planes_that_a_table_leaves_out_are_like_those_that_it_has() {
        let form = "IESNA:LM-63-2002";
        let round = file(form, "NONE", "3 1", "0 45 90\n0\n100 200 10");
        for c_deg in [0.0, 77.0, 200.0, 359.0] {
            near(at(&round, c_deg, 45.0), 200.0);
            near(at(&round, c_deg, 22.5), 150.0);
        }
        let quarter = file(form, "NONE", "3 2", "0 45 90\n0 90\n100 200 10\n100 400 20");
        let half = file(form, "NONE", "3 3", "0 45 90\n0 90 180\n100 200 10 100 400 20 100, 300, 30");
        let street = file(form, "NONE", "3 3", "0 45 90\n90 180 270\n100 200 10 100 400 20 100 300 30");
        let whole = file(form, "NONE", "3 4", "0 45 90\n0 90 200 360\n1 200 1 1 400 1 1 300 1 1 200 1");
        for (text, expected) in [
            (&quarter, [(0.0, 200.0), (90.0, 400.0), (180.0, 200.0), (270.0, 400.0), (315.0, 300.0), (225.0, 300.0)]),
            (&half, [(0.0, 200.0), (90.0, 400.0), (180.0, 300.0), (270.0, 400.0), (225.0, 350.0), (315.0, 300.0)]),
            (&street, [(90.0, 200.0), (180.0, 400.0), (0.0, 400.0), (270.0, 300.0), (45.0, 300.0), (315.0, 350.0)]),
            (&whole, [(0.0, 200.0), (45.0, 300.0), (90.0, 400.0), (145.0, 350.0), (200.0, 300.0), (280.0, 250.0)]),
        ] {
            expected.into_iter().for_each(|(c_deg, candelas)| near(at(text, c_deg, 45.0), candelas));
        }
        // Nothing beyond the last vertical angle.
        assert_eq!(at(&round, 30.0, 91.0), 0.0);
        near(at(&round, 30.0, 90.0), 10.0);
    }

    #[test]
    fn factors_and_tilts_are_those_of_the_form_s_year() {
        let table = "0 45 90\n0\n100 200 10";
        for (form, factor) in
            [("IESNA:LM-63-1995", 0.8), ("IESNA91", 0.8), ("IESNA:LM-63-2002", 1.0), ("IES:LM-63-2019", 1.0)]
        {
            near(at(&file(form, "NONE", "3 1", table), 0.0, 0.0), 100.0 * factor);
            let tilted = "INCLUDE\n1\n3\n0 45 90\n1 0.9 0.8";
            near(at(&file(form, tilted, "3 1", table), 0.0, 45.0), 200.0 * factor);
        }
    }

    #[test]
    fn the_flux_of_even_light_is_that_of_a_sphere() {
        let even = file("IESNA:LM-63-2002", "NONE", "2 1", "0 180\n0\n50 50");
        near(candelas(&even).unwrap().flux(), 4.0 * std::f32::consts::PI * 50.0);
        let upper = file("IESNA:LM-63-2002", "NONE", "2 1", "90 180\n0\n50 50");
        near(candelas(&upper).unwrap().flux() / 100.0, 2.0 * std::f32::consts::PI / 2.0);
    }

    #[test]
    fn faults_tell_line_expectation_and_remedy() {
        let good = file("IESNA:LM-63-2002", "NONE", "3 1", "0 45 90\n0\n100 200 10");
        assert!(candelas(&good).is_ok());
        for (old, new, line, expected) in [
            ("TILT=NONE", "TILT=lamp.tlt", 4, "TILT=NONE"),
            ("TILT=NONE", "", 9, "a line TILT"),
            ("3 1 1 2", "3 1 2 2", 5, "photometric type C"),
            ("3 1 1 2", "3 0 1 2", 5, "number of horizontal angles"),
            ("3 1 1 2", "3 900 1 2", 5, "number of horizontal angles"),
            ("2.0", "two", 5, "multiplier"),
            ("0 45 90\n0\n", "0 90 45\n0\n", 7, "vertical angle"),
            ("0 45 90\n0\n", "0 45 90\n30\n", 8, "horizontal angles of 0 alone"),
            ("100 200 10", "100 -200 10", 9, "at least 0"),
            ("100 200 10", "0 0 0", 9, "one is above 0"),
            ("100 200 10", "100 200", 9, "candelas"),
            ("100 200 10", "100 200 10 5", 9, "the end"),
            ("100 200 10", "100 NaN 10", 9, "candelas"),
        ] {
            let text = good.replacen(old, new, 1);
            let fault = candelas(&text).expect_err(new);
            assert!(fault.line == line && fault.expected.contains(expected), "{new:?}: {fault}");
            assert!(!fault.remedy.is_empty());
        }
    }

    proptest! {
        #[test]
        fn damaged_files_are_faults_or_tables(
            words in prop::collection::vec((0usize..33, 0usize..8), 0..4),
            bytes in prop::collection::vec((0usize..2000, any::<u8>()), 0..2),
            cut in 0usize..400,
        ) {
            let form = "IESNA:LM-63-1995";
            let good = file(form, "INCLUDE\n1\n2\n0 90\n1 1", "3 2", "0 45 90\n0 90\n100 200 10 100 400 20");
            let mut parts: Vec<&str> = good.split_inclusive([' ', '\n']).collect();
            for (at, word) in words {
                // Among the numbers.
                let at = parts.len() - 1 - at;
                parts[at] = ["0 ", "1 ", "-1 ", "2 ", "nan ", "3e38 ", "18446744073709551615 ", "90 "][word];
            }
            let mut damaged = parts.concat().into_bytes();
            let length = damaged.len();
            bytes.into_iter().for_each(|(at, byte)| damaged[at % length] = byte);
            damaged.truncate(length - cut.saturating_sub(350));
            if let Ok(beam) = candelas(&String::from_utf8_lossy(&damaged)) {
                prop_assert!(beam.most() > 0.0);
            }
        }
    }
}
