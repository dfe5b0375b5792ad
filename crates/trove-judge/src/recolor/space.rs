//! Colour spaces in which lightness and the two opponent colours hardly depend on each other.

use std::sync::LazyLock;

/// A space to move colours in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Space {
    /// CIE 1976 L\*a\*b\* under D65.
    Lab,
    /// lαβ of Ruderman et al. 1998, which Reinhard et al. 2001 use.
    LAlphaBeta,
}

/// Linear Rec. 709 to XYZ (IEC 61966-2-1), each row divided by the white's.
const XYZ_FROM_RGB: [[f32; 3]; 3] = [
    [0.412391 / 0.950456, 0.357584 / 0.950456, 0.180481 / 0.950456],
    [0.212639, 0.715169, 0.072192],
    [0.019331 / 1.089058, 0.119195 / 1.089058, 0.950532 / 1.089058],
];
/// Linear Rec. 709 to cones, equations 2 and 3 of Reinhard et al. 2001 multiplied.
const LMS_FROM_RGB: [[f32; 3]; 3] = [[0.3811, 0.5783, 0.0402], [0.1967, 0.7244, 0.0782], [0.0241, 0.1288, 0.8444]];
const RGB_FROM_XYZ: [[f32; 3]; 3] = inverse(&XYZ_FROM_RGB);
const RGB_FROM_LMS: [[f32; 3]; 3] = inverse(&LMS_FROM_RGB);
/// Below it L\*a\*b\* is linear: (6/29)³.
const LINEAR_BELOW: f32 = 216.0 / 24389.0;
/// Black has no logarithm; this is an eighth of the darkest 8-bit grey.
const LEAST_CONE: f32 = 4e-5;

/// Linear values of the 8-bit sRGB codes.
static LINEAR: LazyLock<[f32; 256]> = LazyLock::new(|| {
    std::array::from_fn(|code| {
        let v = code as f32 / 255.0;
        if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
    })
});

/// Codes of linear values in 4096ths, which in the dark are finer than codes are apart.
static CODES: LazyLock<Vec<u8>> = LazyLock::new(|| {
    let encoded = |i: u32| {
        // Steps are even in the square root.
        let v = (i as f32 / 4095.0).powi(2);
        let s = if v <= 0.003_130_8 { v * 12.92 } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 };
        (s * 255.0).round() as u8
    };
    (0..4096).map(encoded).collect()
});

/// Linear Rec. 709 of 8-bit sRGB.
pub(crate) fn linear(code: [u8; 3]) -> [f32; 3] {
    code.map(|c| LINEAR[usize::from(c)])
}

impl Space {
    /// From 8-bit sRGB.
    pub fn from_srgb(self, code: [u8; 3]) -> [f32; 3] {
        let rgb = linear(code);
        match self {
            Self::Lab => {
                let [x, y, z] = times(&XYZ_FROM_RGB, rgb)
                    .map(|t| if t > LINEAR_BELOW { cube_root(t) } else { t * (841.0 / 108.0) + 4.0 / 29.0 });
                [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
            }
            Self::LAlphaBeta => {
                let [l, m, s] = times(&LMS_FROM_RGB, rgb).map(|t| t.max(LEAST_CONE).log10());
                [(l + m + s) / 3f32.sqrt(), (l + m - 2.0 * s) / 6f32.sqrt(), (l - m) / 2f32.sqrt()]
            }
        }
    }

    /// To 8-bit sRGB, the nearest colour that it has.
    pub fn to_srgb(self, [a, b, c]: [f32; 3]) -> [u8; 3] {
        let rgb = match self {
            Self::Lab => {
                let y = (a + 16.0) / 116.0;
                let xyz = [y + b / 500.0, y, y - c / 200.0]
                    .map(|f| if f > 6.0 / 29.0 { f * f * f } else { (f - 4.0 / 29.0) * (108.0 / 841.0) });
                times(&RGB_FROM_XYZ, xyz)
            }
            Self::LAlphaBeta => {
                let (l, alpha, beta) = (a / 3f32.sqrt(), b / 6f32.sqrt(), c / 2f32.sqrt());
                let lms = [l + alpha + beta, l + alpha - beta, l - 2.0 * alpha].map(|t| 10f32.powf(t));
                times(&RGB_FROM_LMS, lms)
            }
        };
        rgb.map(|v| CODES[(v.clamp(0.0, 1.0).sqrt() * 4095.0 + 0.5) as usize])
    }
}

fn times(m: &[[f32; 3]; 3], v: [f32; 3]) -> [f32; 3] {
    m.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

/// By Cramer's rule.
const fn inverse(m: &[[f32; 3]; 3]) -> [[f32; 3]; 3] {
    let mut cofactors = [[0.0f64; 3]; 3];
    let mut i = 0;
    while i < 9 {
        let (r, c) = (i / 3, i % 3);
        let (r1, r2, c1, c2) = ((r + 1) % 3, (r + 2) % 3, (c + 1) % 3, (c + 2) % 3);
        cofactors[r][c] = m[r1][c1] as f64 * m[r2][c2] as f64 - m[r1][c2] as f64 * m[r2][c1] as f64;
        i += 1;
    }
    let [a, b, c] = m[0];
    let determinant = a as f64 * cofactors[0][0] + b as f64 * cofactors[0][1] + c as f64 * cofactors[0][2];
    let mut inverse = [[0.0f32; 3]; 3];
    i = 0;
    while i < 9 {
        inverse[i / 3][i % 3] = (cofactors[i % 3][i / 3] / determinant) as f32;
        i += 1;
    }
    inverse
}

/// The cube root of a positive number to about 1e-6: a guess from the exponent, then two steps of Halley's.
fn cube_root(x: f32) -> f32 {
    let mut y = f32::from_bits(x.to_bits() / 3 + 709_921_077);
    for _ in 0..2 {
        let cube = y * y * y;
        y *= (cube + 2.0 * x) / (2.0 * cube + x);
    }
    y
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_come_back() {
        for space in [Space::Lab, Space::LAlphaBeta] {
            for code in (0..4096u32).map(|i| [(i * 37 % 256) as u8, (i * 101 % 256) as u8, (i * 211 % 256) as u8]) {
                let back = space.to_srgb(space.from_srgb(code));
                let off = code.iter().zip(back).map(|(a, b)| a.abs_diff(b)).max();
                assert!(off <= Some(1), "{space:?} {code:?} {back:?}");
            }
        }
    }

    #[test]
    fn known_colours_are_where_published_tables_have_them() {
        // Lindbloom's calculator, sRGB under D65.
        for (code, lab) in [
            ([255, 0, 0], [53.24, 80.09, 67.20]),
            ([0, 255, 0], [87.73, -86.18, 83.18]),
            ([0, 0, 255], [32.30, 79.19, -107.86]),
            ([0, 255, 255], [91.11, -48.09, -14.13]),
            ([255, 0, 255], [60.32, 98.23, -60.82]),
            ([255, 255, 0], [97.14, -21.55, 94.48]),
            ([128; 3], [53.585, 0.0, 0.0]),
            ([255; 3], [100.0, 0.0, 0.0]),
            ([0; 3], [0.0; 3]),
        ] {
            let found = Space::Lab.from_srgb(code);
            assert!(found.iter().zip(lab).all(|(a, b): (&f32, f32)| (a - b).abs() < 0.02), "{code:?}: {found:?}");
        }
    }

    #[test]
    fn l_alpha_beta_is_that_of_the_paper() {
        // The way back as Reinhard et al. 2001 print it; the four digits of the way there bring two.
        let printed = [[4.4679f32, -3.5873, 0.1193], [-1.2186, 2.3809, -0.1624], [0.0497, -0.2439, 1.2045]];
        for (found, printed) in RGB_FROM_LMS.iter().flatten().zip(printed.iter().flatten()) {
            assert!((found - printed).abs() < 0.02, "{found} {printed}");
        }
        // Greys have no colour, and l is √3 times the logarithm of what they reflect.
        for code in [8u8, 60, 128, 255] {
            let [l, alpha, beta] = Space::LAlphaBeta.from_srgb([code; 3]);
            let wanted = 3f32.sqrt() * LINEAR[usize::from(code)].log10();
            assert!((l - wanted).abs() < 2e-3 && alpha.abs() < 2e-3 && beta.abs() < 2e-3, "{code}: {l} {alpha} {beta}");
        }
        // Equations 5 and 6 for the cones' responses to red: 0.3811, 0.1967, 0.0241.
        let [l, alpha, beta] = Space::LAlphaBeta.from_srgb([255, 0, 0]);
        for (found, printed) in [(l, -1.58375), (alpha, 0.86173), (beta, 0.20311)] {
            assert!((found - printed).abs() < 1e-3, "{found} {printed}");
        }
    }

    #[test]
    fn cube_roots_are_right() {
        for i in 1..1000 {
            let x = i as f32 / 800.0;
            assert!((cube_root(x) / x.cbrt() - 1.0).abs() < 1e-6);
        }
    }
}
