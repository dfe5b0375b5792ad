"""Labels as people draw them: rendered ones are finer than anybody draws."""

import numpy as np
from scipy.ndimage import distance_transform_edt, label, maximum_filter, minimum_filter

from trove.train.labels import CROWNS

# People leave out most of what is smaller than ten pixels of a picture 240 wide: frames have about three times as many
# such parts as CamVid and IDD-Lite, poles and trees apart.
_LEAST_SHARE = 10 / 240**2


def as_drawn(ids: np.ndarray, target: str) -> np.ndarray:
    """Labels (H, W) in a target's ids as an annotator would have drawn them."""
    if target in CROWNS:
        ids = _outlined_crowns(ids, *CROWNS[target])
    return _without_specks(ids)


def _outlined_crowns(ids: np.ndarray, tree: int, sky: int, building: int) -> np.ndarray:
    """A crown is one surface: sky and houses seen between twigs are tree.

    Trees are closed by a hundredth of the width on each side.
    """
    side = 2 * (ids.shape[1] // 100) + 1
    closed = minimum_filter(maximum_filter(ids == tree, side), side)
    behind = (ids == sky) | (ids == building)
    return np.where(closed & behind, np.uint8(tree), ids)


def _without_specks(ids: np.ndarray) -> np.ndarray:
    """What is too small to draw has the label of what is nearest to it."""
    specks = np.zeros(ids.shape, bool)
    for each in np.unique(ids):
        parts, _ = label(ids == each, np.ones((3, 3)))
        small = np.bincount(parts.flat) < _LEAST_SHARE * ids.shape[1] ** 2
        small[0] = False
        specks |= small[parts]
    if specks.all():
        return ids
    down, across = distance_transform_edt(specks, return_distances=False, return_indices=True)
    nearest: np.ndarray = ids[down, across]
    return nearest
