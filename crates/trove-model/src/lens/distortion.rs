//! What lenses do to the picture of a pinhole.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DMat2, DVec2, DVec3};

/// Newton's method has arrived when the picture is hit this well, in focal lengths.
const TOLERANCE: f64 = 1e-10;
const MAX_STEPS: usize = 50;
/// Where growth with the angle is looked for: as tangents up to 86°, and as angles up to behind the camera.
const MOST_TAN: f64 = 15.0;
const SEARCH_STEPS: usize = 3000;

/// A lens's model of distortion, with how far from the axis it can be inverted.
///
/// The two with coefficients are valid only as far as the picture's radius grows with the angle from the axis; what lies beyond is
/// outside the lens's reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Distortion {
    /// A pinhole.
    None,
    /// Radial (rational) and tangential.
    BrownConrady(BrownConrady),
    /// Equidistant with a polynomial of the angle: a fisheye.
    KannalaBrandt(KannalaBrandt),
    /// No lens but a panorama: longitude about the camera's y axis and latitude, in radians in place of focal lengths.
    Equirectangular,
}

/// Brown 1971 with the rational radial factor (1 + k₁r² + k₂r⁴ + k₃r⁶) / (1 + k₄r² + k₅r⁴ + k₆r⁶), as OpenCV has it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BrownConrady {
    k: [f64; 6],
    p: [f64; 2],
    /// Largest tangent of the angle from the axis.
    max_r: f64,
}

/// Kannala and Brandt 2006: radius = θ (1 + k₁θ² + k₂θ⁴ + k₃θ⁶ + k₄θ⁸), θ from the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KannalaBrandt {
    k: [f64; 4],
    /// Largest angle from the axis, at most π.
    max_rad: f64,
}

impl Distortion {
    /// The fisheye whose radius is the angle from its axis.
    pub const EQUIDISTANT: Self = Self::KannalaBrandt(KannalaBrandt { k: [0.0; 4], max_rad: PI });

    /// Brown–Conrady from up to eight coefficients in OpenCV's order k₁ k₂ p₁ p₂ k₃ k₄ k₅ k₆, those left out being 0;
    /// `None` for more, for NaN and infinity.
    pub fn brown_conrady(coefficients: &[f64]) -> Option<Self> {
        let [k1, k2, p1, p2, k3, k4, k5, k6] = padded(coefficients)?;
        let mut model = BrownConrady { k: [k1, k2, k3, k4, k5, k6], p: [p1, p2], max_r: MOST_TAN };
        model.max_r = last_growth(MOST_TAN, |r| model.radius_slope(r));
        Some(Self::BrownConrady(model))
    }

    /// Kannala–Brandt from up to four coefficients k₁ k₂ k₃ k₄, those left out being 0; `None` for more, for NaN and
    /// infinity.
    pub fn kannala_brandt(coefficients: &[f64]) -> Option<Self> {
        let mut model = KannalaBrandt { k: padded(coefficients)?, max_rad: PI };
        model.max_rad = last_growth(PI, |angle| model.radius(angle).1);
        Some(Self::KannalaBrandt(model))
    }

    /// The coefficients in the order in which they are given; none for a pinhole.
    pub fn coefficients(&self) -> Vec<f64> {
        match self {
            Self::None | Self::Equirectangular => Vec::new(),
            Self::BrownConrady(BrownConrady { k, p, .. }) => vec![k[0], k[1], p[0], p[1], k[2], k[3], k[4], k[5]],
            Self::KannalaBrandt(KannalaBrandt { k, .. }) => k.to_vec(),
        }
    }

    /// The model's name in recipes and files.
    pub fn name(&self) -> &'static str {
        match self {
            Self::None => "pinhole",
            Self::BrownConrady(_) => "brown-conrady",
            Self::KannalaBrandt(_) => "kannala-brandt",
            Self::Equirectangular => "equirectangular",
        }
    }

    /// Whether the model is one for more than a half-space: a fisheye or a panorama.
    pub fn sees_behind(&self) -> bool {
        matches!(self, Self::KannalaBrandt(_) | Self::Equirectangular)
    }

    /// Position in focal lengths from the principal point of a direction (of any length) in Camera, in front of the
    /// camera unless the lens sees behind; `None` outside the lens's reach.
    pub(super) fn image_from_direction(&self, v: DVec3) -> Option<DVec2> {
        let flat = v.truncate() / v.z;
        match self {
            Self::None => Some(flat),
            Self::BrownConrady(model) => (flat.length() <= model.max_r).then(|| model.distorted(flat).0),
            Self::KannalaBrandt(model) => {
                let angle = v.truncate().length().atan2(v.z);
                (angle <= model.max_rad).then(|| model.at(angle, v.truncate()))
            }
            Self::Equirectangular => Some(panorama_from_direction(v)),
        }
    }

    /// The same with the angle from the axis brought down to the largest there is.
    pub(super) fn image_onto_rim(&self, v: DVec3) -> DVec2 {
        let across = v.truncate();
        match self {
            Self::None => across / v.z.max(f64::MIN_POSITIVE),
            Self::BrownConrady(model) => {
                let outside = v.z * model.max_r < across.length();
                model.distorted(if outside { across.normalize_or(DVec2::X) * model.max_r } else { across / v.z }).0
            }
            Self::KannalaBrandt(model) => model.at(across.length().atan2(v.z).min(model.max_rad), across),
            Self::Equirectangular => panorama_from_direction(v),
        }
    }

    /// The unit direction in Camera of a position in focal lengths from the principal point.
    pub(super) fn direction_from_image(&self, image: DVec2) -> Option<DVec3> {
        match self {
            Self::None => Some(image.extend(1.0).normalize()),
            Self::BrownConrady(model) => model.undistorted(image).map(|flat| flat.extend(1.0).normalize()),
            Self::KannalaBrandt(model) => model.angle(image.length()).map(|angle| {
                let (sin, cos) = angle.sin_cos();
                (image.normalize_or_zero() * sin).extend(cos)
            }),
            Self::Equirectangular => (image.x.abs() <= PI && image.y.abs() <= FRAC_PI_2).then(|| {
                let ((sin, cos), (down, level)) = (image.x.sin_cos(), image.y.sin_cos());
                DVec3::new(level * sin, down, level * cos)
            }),
        }
    }
}

/// Longitude to the right of ahead and latitude below the horizon, radians.
fn panorama_from_direction(v: DVec3) -> DVec2 {
    DVec2::new(v.x.atan2(v.z), v.y.atan2(v.x.hypot(v.z)))
}

impl BrownConrady {
    /// Radial factor and its derivative by r².
    fn factor(&self, r2: f64) -> (f64, f64) {
        let [k1, k2, k3, k4, k5, k6] = self.k;
        let top = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
        let bottom = 1.0 + r2 * (k4 + r2 * (k5 + r2 * k6));
        let (top_slope, bottom_slope) = (k1 + r2 * (2.0 * k2 + r2 * 3.0 * k3), k4 + r2 * (2.0 * k5 + r2 * 3.0 * k6));
        (top / bottom, (top_slope * bottom - top * bottom_slope) / (bottom * bottom))
    }

    /// Growth of the distorted radius with r.
    fn radius_slope(&self, r: f64) -> f64 {
        let (factor, slope) = self.factor(r * r);
        // A pole of the factor is no growth.
        if factor > 0.0 { factor + 2.0 * r * r * slope } else { -1.0 }
    }

    /// Distorted position and its Jacobian.
    fn distorted(&self, q: DVec2) -> (DVec2, DMat2) {
        let [p1, p2] = self.p;
        let (x, y, r2) = (q.x, q.y, q.length_squared());
        let (factor, slope) = self.factor(r2);
        let image = q * factor
            + DVec2::new(2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x), p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y);
        let across = 2.0 * slope * x * y + 2.0 * p1 * x + 2.0 * p2 * y;
        let jacobian = DMat2::from_cols_array(&[
            factor + 2.0 * slope * x * x + 2.0 * p1 * y + 6.0 * p2 * x,
            across,
            across,
            factor + 2.0 * slope * y * y + 6.0 * p1 * y + 2.0 * p2 * x,
        ]);
        (image, jacobian)
    }

    /// Inverse of [`Self::distorted`] by Newton's method, steps being halved where they would lead away.
    fn undistorted(&self, image: DVec2) -> Option<DVec2> {
        let mut q = image.clamp_length_max(0.9 * self.max_r);
        let (mut at, mut jacobian) = self.distorted(q);
        for _ in 0..MAX_STEPS {
            let miss = image - at;
            if miss.length() < TOLERANCE {
                return (q.length() <= self.max_r && jacobian.determinant() > 0.0).then_some(q);
            }
            let step = jacobian.inverse() * miss;
            let mut share = 1.0;
            loop {
                let next = q + step * share;
                let (there, slope) = self.distorted(next);
                if next.length() <= self.max_r * (1.0 + 1e-9) && (image - there).length() < miss.length() {
                    (q, at, jacobian) = (next, there, slope);
                    break;
                }
                share *= 0.5;
                if share < 1e-4 {
                    return None;
                }
            }
        }
        None
    }
}

impl KannalaBrandt {
    /// Radius in the picture of an angle from the axis, and its derivative.
    fn radius(&self, angle: f64) -> (f64, f64) {
        let ([k1, k2, k3, k4], t2) = (self.k, angle * angle);
        let radius = angle * (1.0 + t2 * (k1 + t2 * (k2 + t2 * (k3 + t2 * k4))));
        (radius, 1.0 + t2 * (3.0 * k1 + t2 * (5.0 * k2 + t2 * (7.0 * k3 + t2 * 9.0 * k4))))
    }

    /// Position of an angle from the axis, on the side of `across`.
    fn at(&self, angle: f64, across: DVec2) -> DVec2 {
        across.normalize_or_zero() * self.radius(angle).0
    }

    /// Inverse of [`Self::radius`]: Newton's method kept within bounds that close in.
    fn angle(&self, radius: f64) -> Option<f64> {
        let (mut low, mut high) = (0.0, self.max_rad);
        if radius > self.radius(high).0 {
            return None;
        }
        let mut angle = radius.min(high);
        for _ in 0..MAX_STEPS {
            let (there, slope) = self.radius(angle);
            let miss = radius - there;
            if miss.abs() < TOLERANCE {
                return Some(angle);
            }
            if miss > 0.0 {
                low = angle;
            } else {
                high = angle;
            }
            let next = angle + miss / slope;
            angle = if next > low && next < high { next } else { 0.5 * (low + high) };
        }
        None
    }
}

/// Coefficients filled up with zeros.
fn padded<const N: usize>(coefficients: &[f64]) -> Option<[f64; N]> {
    let mut all = [0.0; N];
    all.get_mut(..coefficients.len())?.copy_from_slice(coefficients);
    all.iter().all(|c| c.is_finite()).then_some(all)
}

/// The largest argument up to which a function grows from 0 on, at most `end`, by its derivative.
fn last_growth(end: f64, slope: impl Fn(f64) -> f64) -> f64 {
    let step = end / SEARCH_STEPS as f64;
    let Some(first) = (1..=SEARCH_STEPS).map(|i| i as f64 * step).find(|&x| slope(x) <= 0.0) else { return end };
    let (mut grows, mut falls) = (first - step, first);
    for _ in 0..40 {
        let middle = 0.5 * (grows + falls);
        if slope(middle) > 0.0 { grows = middle } else { falls = middle }
    }
    grows
}
