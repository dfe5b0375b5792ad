"""Metrics from pixel counts."""

import numpy as np


def iou(confusion: np.ndarray) -> np.ndarray:
    """IoU of every class from counts (truth, prediction); NaN for classes neither present nor predicted."""
    both = np.diag(confusion).astype(float)
    union = confusion.sum(0) + confusion.sum(1) - both
    shares: np.ndarray = np.divide(both, union, out=np.full_like(both, np.nan), where=union > 0)
    return shares
