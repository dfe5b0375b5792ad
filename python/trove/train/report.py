"""What an experiment leaves behind: tables, loss curves, and how many real pictures frames replace."""

from pathlib import Path
from typing import Any

from trove.train import learning, table
from trove.train.experiment import Experiment


def write(experiment: Experiment, rows: list[str], results: list[dict[str, Any]], out: Path) -> None:
    """Writes `table.md`, `table.tex` and `curves.svg`, and with counts `learning.md` and `learning.svg`, into `out`.

    A ladder has a section for every rung and one in which every row is at its best; the LaTeX table and the learning
    curves are of the latter.
    """
    what, text = (experiment.names, experiment.measure), ""
    totals = sorted({result["total"] for result in results})
    best = table.at_its_best(results) if len(totals) > 1 and experiment.inner else results
    sections = [(f"{total} steps", [r for r in results if r["total"] == total]) for total in totals]
    sections = [*sections, ("every row at its best", best)] if len(totals) > 1 else [("", results)]
    for title, part in sections:
        summaries = {row: table.summary(runs) for row in rows if (runs := [r for r in part if r["row"] == row])}
        text += (f"## {title}\n\n" if title else "") + table.markdown(*what, summaries, experiment.compare) + "\n"
    spent = {(r["row"], r["fold"], r["seed"]): r["seconds"] for r in results}
    text += f"{len(spent)} networks were trained in {sum(spent.values()) / 3600:.1f} hours of their jobs.\n"
    (out / "table.md").write_text(text)
    (out / "table.tex").write_text(table.latex(*what, summaries))
    (out / "curves.svg").write_text(table.curves(results))
    lines = learning.lines(experiment.lines, best)
    if lines:
        (out / "learning.md").write_text(learning.markdown(lines, experiment.compare_lines, experiment.measure))
        (out / "learning.svg").write_text(learning.picture(lines, experiment.measure))
