"""Time at equal error: two renderers' curves of error over time."""

import math


def time_at(curve, error):
    """Seconds after which a curve, points of (seconds, error), has come down to `error`: the least of all its segments,
    straight lines in the logarithms of both; None where it never comes there."""
    points = sorted(curve)
    found = [seconds for seconds, reached in points if reached <= error]
    for (t0, e0), (t1, e1) in zip(points, points[1:], strict=False):
        if e0 > error >= e1:
            share = math.log(e0 / error) / math.log(e0 / e1)
            found.append(math.exp(math.log(t0) + share * math.log(t1 / t0)))
    return min(found, default=None)


def ratio(ours, others):
    """How many times as long the others take as we do, for the errors that both reach.

    `others` is a list of curves, the best of which counts at each error. Returns (geometric mean, least, largest) over
    the errors of all points in the range in which both curves lie. Where one lies below the other all along, it is
    taken at the lowest error of the upper one, which bounds it.
    """
    points = [point for curve in others for point in curve]
    highest = min(max(e for _, e in ours), max(e for _, e in points))
    lowest = max(min(e for _, e in ours), min(e for _, e in points))
    if lowest > highest:
        highest = lowest
    errors = [e for _, e in [*ours, *points] if lowest * (1 - 1e-9) <= e <= highest * (1 + 1e-9)]
    found = []
    for error in errors:
        slow = [t for t in (time_at(curve, error) for curve in others) if t is not None]
        fast = time_at(ours, error)
        if slow and fast is not None:
            found.append(min(slow) / fast)
    return math.exp(sum(map(math.log, found)) / len(found)), min(found), max(found)
