//! The body's surfaces, made once for everyone.

use trove_model::HumanBody;

use super::fabric::Fabrics;
use super::outfit::Cutter;
use super::pattern::Pattern;

/// The body's surfaces with few triangles, shared by all.
#[derive(Clone, Debug)]
pub(super) struct Stock<'a> {
    pub body: &'a HumanBody,
    pub cutter: Cutter,
    pub skin: Pattern,
    pub tights: Pattern,
    pub skirt: Pattern,
    pub fabrics: Fabrics,
}
