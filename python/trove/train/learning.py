"""Learning curves: what rows are worth by the number of real pictures, and how many of them frames replace."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from trove.train.table import interval, mean

# Draws of the bootstrap, and the quantiles of a 95 % interval.
_DRAWS, _QUANTILES = 2000, (0.025, 0.975)


@dataclass(frozen=True)
class Line:
    """A curve: numbers of real pictures (N,), the measure of every (fold, seed) in percent (N, runs)."""

    counts: np.ndarray
    means: np.ndarray
    runs: list[tuple[str, int]]


def lines(stars: dict[str, list[tuple[str, str]]], results: list[dict[str, Any]]) -> dict[str, Line]:
    """The curve of every row with a star, over the folds and seeds that have all of its points; none without any."""
    found = {}
    for star, rows in stars.items():
        points = [{(r["fold"], r["seed"]): r for r in results if r["row"] == row} for row, _ in rows]
        runs = [run for run in points[0] if all(run in point for point in points)] if points else []
        if runs:
            counts = [np.mean([p[run]["images"][name] for run in runs]) for p, (_, name) in zip(points, rows)]
            means = [[mean(point[run]["outer"]) for run in runs] for point in points]
            found[star] = Line(np.array(counts), np.array(means), runs)
    return found


def as_good_as(counts: np.ndarray, means: np.ndarray, reached: float) -> float:
    """How many real pictures reach a measure, on straight lines between the points of a curve over the logarithm.

    The smallest number if fewer may do, infinity if the curve never gets there.
    """
    if reached <= means[0]:
        return float(counts[0])
    for i in range(1, len(counts)):
        if means[i] >= reached:
            share = (reached - means[i - 1]) / (means[i] - means[i - 1])
            return float(counts[i - 1] * (counts[i] / counts[i - 1]) ** share)
    return float("inf")


def replaced(line: Line, than: Line) -> list[tuple[float, float, float]]:
    """How many real pictures without frames are as good as each point of `line`, and the bounds of a 95 % interval.

    The interval is a bootstrap over the folds and seeds that both have.
    """
    both = [run for run in line.runs if run in than.runs]
    a = line.means[:, [line.runs.index(run) for run in both]]
    b = than.means[:, [than.runs.index(run) for run in both]]
    random = np.random.default_rng(1)
    draws = [random.integers(len(both), size=len(both)) for _ in range(_DRAWS)]
    found = []
    for i in range(len(line.counts)):
        drawn = [as_good_as(than.counts, b[:, d].mean(1), a[i, d].mean()) for d in draws]
        low, high = np.quantile(drawn, _QUANTILES, method="nearest")
        found.append((as_good_as(than.counts, b.mean(1), a[i].mean()), float(low), float(high)))
    return found


def markdown(curves: dict[str, Line], compare: dict[str, str], measure: str) -> str:
    """Tables of the curves, and of how many real pictures each point of a compared one replaces."""
    text = ""
    for star, line in curves.items():
        text += f"| {star} | " + " | ".join(f"{count:.0f}" for count in line.counts) + " |\n"
        text += "|---" * (len(line.counts) + 1) + "|\n"
        text += f"| {measure} | " + " | ".join(_spread(values) for values in line.means) + " |\n"
        than = curves.get(compare.get(star, ""))
        if than is not None and set(line.runs) & set(than.runs):
            text += f"| as good as {compare[star]} with | " + " | ".join(
                f"{_number(n, than)} ({_number(low, than)} to {_number(high, than)})"
                for n, low, high in replaced(line, than)
            )
            text += " |\n"
        text += "\n"
    return text


def _spread(values: np.ndarray) -> str:
    half = interval(values)
    return f"{values.mean():.2f}" + ("" if np.isnan(half) else f" ± {half:.2f}")


def _number(count: float, than: Line) -> str:
    if np.isinf(count):
        return f"more than {than.counts[-1]:.0f}"
    return f"at most {count:.0f}" if count == than.counts[0] else f"{count:.0f}"


_WIDTH, _HEIGHT, _LEFT, _BOTTOM = 720, 400, 56, 350


def picture(curves: dict[str, Line], measure: str) -> str:
    """The curves as an SVG image: `measure` over the number of real pictures, which has a logarithmic axis."""
    counts = np.concatenate([line.counts for line in curves.values()])
    means = np.concatenate([line.means.mean(1) for line in curves.values()])
    least, most = np.floor(means.min() - 1), np.ceil(means.max() + 1)
    span = max(float(np.log(counts.max() / counts.min())), 1e-9)

    def x(count: float) -> float:
        return _LEFT + 20 + (_WIDTH - _LEFT - 40) * float(np.log(count / counts.min())) / span

    def y(value: float) -> float:
        return _BOTTOM - (_BOTTOM - 20) * float((value - least) / (most - least))

    parts = [f'<path d="M{_LEFT} 20V{_BOTTOM}H{_WIDTH - 10}" fill="none" stroke="#888"/>']
    parts += [
        f'<text x="{x(count):.1f}" y="{_BOTTOM + 18}" text-anchor="middle">{count}</text>'
        for count in sorted({round(float(c)) for c in counts})
    ]
    for value in np.arange(least, most + 1, max(1, (most - least) // 8)):
        parts.append(f'<text x="{_LEFT - 6}" y="{y(value) + 4:.1f}" text-anchor="end">{value:.0f}</text>')
        parts.append(f'<path d="M{_LEFT} {y(value):.1f}H{_WIDTH - 10}" stroke="#ddd"/>')
    for i, (star, line) in enumerate(curves.items()):
        colour = f"hsl({(210 + 137 * i) % 360},60%,42%)"
        ends = [(x(c), y(values.mean())) for c, values in zip(line.counts, line.means)]
        points = " ".join(f"{a:.1f},{b:.1f}" for a, b in ends)
        parts.append(f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="2"/>')
        parts += [f'<circle cx="{a:.1f}" cy="{b:.1f}" r="3" fill="{colour}"/>' for a, b in ends]
        parts.append(
            f'<text x="{_WIDTH - 16}" y="{_BOTTOM - 14 - 18 * i}" text-anchor="end" fill="{colour}">{star}</text>'
        )
    parts.append(f'<text x="{_WIDTH / 2}" y="{_BOTTOM + 40}" text-anchor="middle">real pictures</text>')
    parts.append(f'<text x="8" y="14">{measure}, %</text>')
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {_WIDTH} {_HEIGHT}" font-family="sans-serif" '
        f'font-size="13"><rect width="{_WIDTH}" height="{_HEIGHT}" fill="#fff"/>{"".join(parts)}</svg>\n'
    )
