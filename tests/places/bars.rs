//! What has to be seen of each place's buildings, as measured, and why it is not all of them. A bar is raised when a place
//! gets better, and never lowered.
//!
//! The IoU is of footprints: what hangs over open ground counts where it is mapped, since mappers draw some buildings with
//! their eaves and some without. Roads give way to houses, so that what is `cut` lies where somebody drove, or where a low
//! building stands on a road. What is `incomplete` lacks something else: in Neukölln three sheds of which little is more
//! than 4 m² are not built.

use crate::cover::Bar;

/// Twelve touching houses, courts, and towers of parts, one of which hangs over; no road comes near.
pub(crate) const TOWN: Bar = Bar { iou: 0.997, cut: 0, incomplete: 0, modelled: 0.0, inside_m2: 0.0 };
/// The recorded road cuts way 458698383.
pub(crate) const BOSTON: Bar = Bar { iou: 0.997, cut: 1, incomplete: 1, modelled: 0.3, inside_m2: 0.0 };
/// Its rectangular buildings are sheds, for which there is no model. Old dense blocks, through whose low wings lead ways into yards. Four rays meet the backs of a roof's boards and of a
/// downpipe.
pub(crate) const NEUKOLLN: Bar = Bar { iou: 0.987, cut: 3, incomplete: 3, modelled: 0.0, inside_m2: 0.64 };
pub(crate) const TAIPEI: Bar = Bar { iou: 0.994, cut: 1, incomplete: 0, modelled: 0.1, inside_m2: 0.0 };
/// Footprints are the reader's own here, since the extract is PBF.
pub(crate) const MONACO: Bar = Bar { iou: 0.995, cut: 0, incomplete: 0, modelled: 0.3, inside_m2: 0.0 };
