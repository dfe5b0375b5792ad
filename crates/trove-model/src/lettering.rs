//! Capital letters and digits of strokes, for what is written on signs.

use glam::{Vec2, vec2};

/// Strokes through points of a grid 4 wide and 6 high, `xy` each, strokes apart by commas.
const GLYPHS: [(char, &str); 44] = [
    ('A', "00 26 40,12 32"),
    ('B', "00 06 36 45 44 33 03,33 42 41 30 00"),
    ('C', "45 36 16 05 01 10 30 41"),
    ('D', "00 06 26 45 41 20 00"),
    ('E', "46 06 00 40,03 33"),
    ('F', "46 06 00,03 33"),
    ('G', "45 36 16 05 01 10 30 41 43 23"),
    ('H', "00 06,40 46,03 43"),
    ('I', "20 26"),
    ('J', "46 41 30 10 01"),
    ('K', "00 06,46 03 40"),
    ('L', "06 00 40"),
    ('M', "00 06 23 46 40"),
    ('N', "00 06 40 46"),
    ('O', "05 16 36 45 41 30 10 01 05"),
    ('P', "00 06 36 45 44 33 03"),
    ('Q', "05 16 36 45 41 30 10 01 05,22 40"),
    ('R', "00 06 36 45 44 33 03,23 40"),
    ('S', "45 36 16 05 04 13 33 42 41 30 10 01"),
    ('T', "06 46,26 20"),
    ('U', "06 01 10 30 41 46"),
    ('V', "06 20 46"),
    ('W', "06 10 23 30 46"),
    ('X', "00 46,06 40"),
    ('Y', "06 23 46,23 20"),
    ('Z', "06 46 00 40"),
    ('0', "05 16 36 45 41 30 10 01 05"),
    ('1', "14 26 20"),
    ('2', "05 16 36 45 44 00 40"),
    ('3', "05 16 36 45 44 33 13,33 42 41 30 10 01"),
    ('4', "30 36 02 42"),
    ('5', "46 06 03 33 42 41 30 10 01"),
    ('6', "45 36 16 05 01 10 30 41 42 33 03"),
    ('7', "06 46 10"),
    ('8', "13 04 05 16 36 45 44 33 13 02 01 10 30 41 42 33"),
    ('9', "01 10 30 41 45 36 16 05 04 13 43"),
    ('!', "26 22,20 20"),
    ('-', "13 33"),
    ('.', "20 20"),
    ('_', "00 40"),
    ('\'', "26 25"),
    ('/', "00 46"),
    ('&', "40 04 05 16 25 24 02 01 10 20 42"),
    ('Ø', "05 16 36 45 41 30 10 01 05,00 46"),
];

/// Capitals with a mark: the letter below it and the mark's strokes, above the grid or (cedilla) below the letter's foot.
const MARKED: [(&str, &str, &str); 9] = [
    ("ÁÉÍÓÚÝĆŃŚŹ", "AEIOUYCNSZ", "17 38"),
    ("ÀÈÌÒÙ", "AEIOU", "18 37"),
    ("ÂÊÎÔÛ", "AEIOU", "17 28 37"),
    ("ÄËÏÖÜŸ", "AEIOUY", "17 17,37 37"),
    ("ÃÑÕ", "ANO", "07 18 27 38"),
    ("ŠČŽŘĚŇ", "SCZREN", "18 27 38"),
    ("ÅŮ", "AU", "17 28 37 17"),
    ("ÇŞ", "CS", "20 21"),
    ("ĀĒĪŌŪ", "AEIOU", "17 37"),
];

/// Width of a letter and the gap after it, in heights.
const ADVANCE: f32 = 5.6 / 6.0;

/// A line of writing in capitals as strokes, its middle at the origin, one unit high.
pub struct Lettering {
    strokes: Vec<[Vec2; 2]>,
    letters: usize,
    is_complete: bool,
}

impl Lettering {
    /// Letters that are not in the table stay blank; small letters become capitals.
    pub fn new(text: &str) -> Self {
        let text: Vec<char> = text.to_uppercase().chars().collect();
        let width = width(text.len());
        let mut strokes = Vec::new();
        let mut is_complete = true;
        for (i, &letter) in text.iter().enumerate() {
            let origin = vec2(ADVANCE * i as f32 - width / 2.0, -0.5);
            let lines = lines(letter);
            is_complete &= lines.is_some();
            for line in lines.iter().flatten().flat_map(|part| part.split(',')) {
                let points: Vec<Vec2> = line.split(' ').map(|xy| origin + point(xy)).collect();
                strokes.extend(points.windows(2).map(|w| [w[0], w[1]]));
            }
        }
        Self { strokes, letters: text.len(), is_complete }
    }

    /// Whether every letter of the text could be written.
    pub fn is_complete(&self) -> bool {
        self.is_complete
    }

    /// From the first letter's left to the last one's right, in heights.
    pub fn width(&self) -> f32 {
        width(self.letters)
    }

    /// Distance to the nearest stroke, in heights.
    pub fn distance(&self, p: Vec2) -> f32 {
        let to = |&[a, b]: &[Vec2; 2]| {
            let t = ((p - a).dot(b - a) / (b - a).length_squared().max(1e-9)).clamp(0.0, 1.0);
            p.distance(a.lerp(b, t))
        };
        self.strokes.iter().map(to).fold(f32::INFINITY, f32::min)
    }
}

fn width(letters: usize) -> f32 {
    (ADVANCE * letters as f32 - 1.6 / 6.0).max(0.0)
}

/// Strokes of a letter and of its mark; none for a blank, `None` for what cannot be written.
fn lines(letter: char) -> Option<Vec<&'static str>> {
    let plain = |letter: char| GLYPHS.iter().find(|g| g.0 == letter).map(|g| g.1);
    if letter == ' ' {
        return Some(Vec::new());
    }
    if let Some(lines) = plain(letter) {
        return Some(vec![lines]);
    }
    let marked = |&(whole, base, mark): &(&str, &str, &'static str)| {
        let below = base.chars().nth(whole.chars().position(|c| c == letter)?)?;
        Some(vec![plain(below)?, mark])
    };
    MARKED.iter().find_map(marked)
}

fn point(xy: &str) -> Vec2 {
    let digit = |i: usize| f32::from(xy.as_bytes().get(i).map_or(0, |b| b.saturating_sub(b'0'))) / 6.0;
    vec2(digit(0), digit(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_letter_has_strokes_inside_its_box_and_no_two_are_alike() {
        for (letter, _) in GLYPHS {
            let Lettering { strokes, .. } = Lettering::new(&letter.to_string());
            assert!(!strokes.is_empty(), "{letter}");
            assert!(strokes.iter().flatten().all(|p| p.x.abs() < 0.34 && p.y.abs() < 0.51), "{letter}");
        }
        assert!(Lettering::new("T").distance(vec2(0.0, 0.0)) < 1e-6);
        assert!(Lettering::new("O").distance(vec2(0.0, 0.0)) > 0.3);
    }

    #[test]
    fn names_are_written_in_capitals_with_their_marks_or_known_to_be_incomplete() {
        assert!(Lettering::new("Allée de l'Été").is_complete() && Lettering::new("Weserstraße").is_complete());
        assert_eq!(Lettering::new("Maß").width(), Lettering::new("MASS").width());
        assert!(Lettering::new("é").distance(vec2(0.0, 0.75)) < 0.1);
        assert!(!Lettering::new("長安西路").is_complete());
    }
}
