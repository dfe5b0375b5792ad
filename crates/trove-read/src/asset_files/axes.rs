//! The six directions of a file's axes.

use glam::{Mat3, Vec3};

/// A direction along a file's axis: `+x` … `-z`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[allow(missing_docs)] // the names are the definition
pub enum Axis {
    PlusX,
    MinusX,
    PlusY,
    MinusY,
    PlusZ,
    MinusZ,
}

impl Axis {
    /// All six.
    pub const ALL: [Self; 6] = [Self::PlusX, Self::MinusX, Self::PlusY, Self::MinusY, Self::PlusZ, Self::MinusZ];

    /// As `library.toml` writes it.
    pub fn name(self) -> &'static str {
        ["+x", "-x", "+y", "-y", "+z", "-z"][self as usize]
    }

    /// The direction of a name; a missing sign is a plus.
    pub fn from_name(name: &str) -> Option<Self> {
        let name = name.to_lowercase();
        Self::ALL.into_iter().find(|a| a.name() == name || a.name().strip_prefix('+') == Some(&name))
    }

    pub(super) fn direction(self) -> Vec3 {
        [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z][self as usize]
    }

    pub(super) fn is_along(self, other: Self) -> bool {
        self as usize / 2 == other as usize / 2
    }

    /// The four directions at right angles to this one.
    pub(super) fn across(self) -> impl Iterator<Item = Self> {
        Self::ALL.into_iter().filter(move |a| !a.is_along(self))
    }

    /// `asset_from_file`: turns a file's axes so that `front` becomes x and `up` z.
    pub(super) fn turn(front: Self, up: Self) -> Mat3 {
        let (x, z) = (front.direction(), up.direction());
        Mat3::from_cols(x, z.cross(x), z).transpose()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pair_of_axes_turns_into_forward_and_up() {
        for up in Axis::ALL {
            for front in up.across() {
                let turn = Axis::turn(front, up);
                assert!((turn.determinant() - 1.0).abs() < 1e-6);
                assert_eq!((turn * front.direction(), turn * up.direction()), (Vec3::X, Vec3::Z));
            }
        }
        assert_eq!(Axis::from_name("Z"), Some(Axis::PlusZ));
        assert_eq!(Axis::from_name("-X"), Some(Axis::MinusX));
        assert_eq!(Axis::from_name("up"), None);
    }
}
