"""The results in the paper's format."""

from typing import Any

import numpy as np

from trove.train.confusion import iou

# 97.5 % quantile of Student's t for 1 to 10 degrees of freedom.
_STUDENT = [12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228]


def interval(values: np.ndarray) -> float:
    """Half the width of the 95 % interval of the mean over runs; NaN for one run."""
    n = len(values)
    return float("nan") if n < 2 else _STUDENT[min(n - 2, 9)] * float(np.std(values, ddof=1)) / n**0.5


def by_class(measured: list[Any]) -> np.ndarray:
    """Percent of each class: the IoU of pixel counts (truth, prediction), or what is measured by class already."""
    values = np.array(measured)
    return 100 * iou(values) if values.ndim == 2 else values


def mean(measured: list[Any]) -> float:
    """The mean over classes, percent."""
    return float(np.nanmean(by_class(measured)))


def at_its_best(results: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Of every row and fold the results with as many steps as do best on the inner share in the mean over seeds."""
    found = []
    for row, fold in dict.fromkeys((r["row"], r["fold"]) for r in results):
        runs = [r for r in results if (r["row"], r["fold"]) == (row, fold)]
        score = {total: np.mean([mean(r["inner"]) for r in runs if r["total"] == total]) for total in _totals(runs)}
        found += [r for r in runs if r["total"] == max(score, key=lambda total: score[total])]
    return found


def _totals(results: list[dict[str, Any]]) -> list[int]:
    return sorted({result["total"] for result in results})


def summary(results: list[dict[str, Any]]) -> dict[str, Any]:
    """Means over the folds and seeds of one row, percent: `classes`, their `mean` and its interval `half`, `accuracy`.

    `means` are those of each (fold, seed).
    """
    found = [np.array(result["outer"]) for result in results]
    classes = np.array([by_class(result["outer"]) for result in results])
    means = np.nanmean(classes, axis=1)
    accuracy = [100 * np.trace(c) / c.sum() if c.ndim == 2 else np.nan for c in found]
    return {
        "classes": np.nanmean(classes, axis=0),
        "mean": float(means.mean()),
        "half": interval(means),
        "accuracy": float(np.mean(accuracy)),
        "means": {(result.get("fold", ""), result["seed"]): float(m) for result, m in zip(results, means)},
    }


def _rows(summaries: dict[str, dict[str, Any]]) -> list[list[str]]:
    rows = []
    for row, s in summaries.items():
        half = "" if np.isnan(s["half"]) else f" ± {s['half']:.2f}"
        rows.append([row, *map(_number, s["classes"]), _number(s["mean"]) + half, _number(s["accuracy"])])
    return rows


def markdown(classes: list[str], measure: str, summaries: dict[str, dict[str, Any]], compare: dict[str, str]) -> str:
    """A Markdown table with a line for every gain requested, and one of the means by fold; `measure` is what the mean over
    classes is called."""
    text = _table(["trained on", *classes, measure, "accuracy"], _rows(summaries))
    for better, than in compare.items():
        if better in summaries and than in summaries:
            # Folds and seeds pair the runs: the same seed begins with the same weights.
            a, b = summaries[better]["means"], summaries[than]["means"]
            both = [which for which in a if which in b]
            if not both:
                continue
            apart = {which: a[which] - b[which] for which in both}
            text += f"\n{better} against {than}: {_gain(np.array([*apart.values()]))} {measure}"
            folds = by_fold(apart)
            if len(folds) > 1:
                text += f"; with folds alone as independent {_gain(np.array([*folds.values()]))}: "
                text += ", ".join(f"{fold} {gain:+.2f}" for fold, gain in folds.items())
    means = {row: by_fold(s["means"]) for row, s in summaries.items()}
    names = list(dict.fromkeys(fold for each in means.values() for fold in each))
    if len(names) > 1:
        rows = [[row, *(_number(each.get(name, np.nan)) for name in names)] for row, each in means.items()]
        text += "\n\n" + _table(["trained on", *names], rows)
    return text.rstrip("\n") + "\n"


def _table(head: list[str], rows: list[list[str]]) -> str:
    return "".join("| " + " | ".join(line) + " |\n" for line in [head, ["---"] * len(head), *rows])


def by_fold(values: dict[tuple[str, int], float]) -> dict[str, float]:
    """The mean over seeds of each fold."""
    folds = list(dict.fromkeys(fold for fold, _ in values))
    return {name: float(np.mean([value for (fold, _), value in values.items() if fold == name])) for name in folds}


def _gain(apart: np.ndarray) -> str:
    half = interval(apart)
    told = "" if np.isnan(half) else f" (95 % interval {apart.mean() - half:+.2f} to {apart.mean() + half:+.2f})"
    return f"{apart.mean():+.2f}{told}"


def _number(value: float) -> str:
    return "–" if np.isnan(value) else f"{value:.2f}"


def latex(classes: list[str], measure: str, summaries: dict[str, dict[str, Any]]) -> str:
    """The same as a LaTeX tabular."""
    head = ["Training", *classes, measure, "Acc."]
    lines = [" & ".join(line).replace("_", r"\_").replace("±", r"$\pm$") + r" \\" for line in [head, *_rows(summaries)]]
    body = "\n".join([lines[0], r"\hline", *lines[1:]])
    return f"\\begin{{tabular}}{{l{'r' * (len(head) - 1)}}}\n\\hline\n{body}\n\\hline\n\\end{{tabular}}\n"


def curves(results: list[dict[str, Any]]) -> str:
    """The loss curves as an SVG image, one line per run."""
    most = max((point[2] for r in results for point in r["curve"]), default=1.0)
    parts = []
    for i, result in enumerate(results):
        last = max((point[1] for point in result["curve"]), default=1)
        points = " ".join(f"{40 + 700 * p[1] / last:.1f},{20 + 360 * (1 - p[2] / most):.1f}" for p in result["curve"])
        hue = 360 * i // max(len(results), 1)
        parts.append(
            f'<polyline points="{points}" fill="none" stroke="hsl({hue},60%,45%)"><title>{result["row"]} seed {result["seed"]}</title></polyline>'
        )
    axes = '<path d="M40 20V380H740" fill="none" stroke="#888"/>'
    return f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 760 400">{axes}{"".join(parts)}</svg>\n'
