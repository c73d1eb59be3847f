"""Results and records of grainbench as dataframes and arrays."""

from __future__ import annotations

import csv
import html
import importlib.util
import json
import re
from collections import Counter
from pathlib import Path
from typing import Any

import narwhals as nw
import numpy as np

from ._scene import Floats

_BACKENDS = ("pandas", "polars", "pyarrow")
_SHOWN = ("verdict", "case", "variant", "quantity", "value", "expected", "error", "allowed", "detail")


class Results:
    """Results of claims and their negative controls."""

    def __init__(self, results: dict[str, Any]) -> None:
        self.raw = results
        self.verdicts: list[dict[str, Any]] = results["verdicts"]
        self.of_controls: list[dict[str, Any]] = results["controls"]

    @property
    def rows(self) -> Any:
        """Dataframe with one row per claim, of the first installed library: pandas, polars or pyarrow.

        The column `detail` is also split into `first_outside` (s), `as_if` (the mistake that explains a failed result) and
        `reason` (any other text).
        """
        return frame([_with_parts(row) for row in self.verdicts])

    @property
    def controls(self) -> Any:
        """Dataframe with one row per negative control; each control must have failed."""
        return frame(self.of_controls)

    def table(self, *, only_red: bool = False) -> str:
        """Returns one line per result, and one for each control that stayed green.

        With `only_red`, return only red results if there are any.
        """
        rows = [row for row in self.verdicts if not only_red or row["severity"] == "red" or only_red and not self._any_red()]
        lines = [_line(row) for row in rows]
        green = [control for control in self.of_controls if not control["turned_red"]]
        lines += [
            f"control stayed green  {control['case']} · {control['variant']} · {control['quantity']}: {control['wrong_physics']}"
            for control in green
        ]
        count = Counter(row["verdict"] or "not judged" for row in self.verdicts)
        counts = ", ".join(f"{number} {name}" for name, number in ({"pass": 0, "fail": 0} | count).items())
        red = len(self.of_controls) - len(green)
        return "\n".join([*lines, f"{counts}; {red} of {len(self.of_controls)} controls turned red"])

    def _any_red(self) -> bool:
        return any(row["severity"] == "red" for row in self.verdicts)

    def __repr__(self) -> str:
        return self.table()

    def _repr_html_(self) -> str:
        colours = {"green": "#1a7f37", "amber": "#9a6700", "red": "#cf222e"}

        def cell(row: dict[str, Any], name: str) -> str:
            text = html.escape(_shown(row.get(name)))
            style = f' style="color:{colours[row["severity"]]};font-weight:bold"' if name == "verdict" and row["severity"] else ""
            return f"<td{style}>{text}</td>"

        head = "".join(f"<th>{name}</th>" for name in _SHOWN)
        body = "".join("<tr>" + "".join(cell(row, name) for name in _SHOWN) + "</tr>" for row in self.verdicts)
        return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


class Costs(Results):
    """Results of the cost study: one point per solver, target quantity and resolution."""

    @property
    def points(self) -> Any:
        """Dataframe with error, computing time (`wall_seconds`, `cpu_seconds`) and operation counts of each point."""
        return frame(self.raw["points"])

    def table(self, *, only_red: bool = False) -> str:
        """Returns one line per point, with error and wall-clock time."""
        return "\n".join(
            f"{row['solver']:<16} {row['case']} · {row['variant']} · {row['quantity']}: {row['resolution']}, "
            f"error {_shown(row['error'])}, {_shown(row['wall_seconds'])} s"
            for row in self.raw["points"]
        )


class Run:
    """Output of `grainbench simulate`."""

    def __init__(self, folder: Path) -> None:
        with open(folder / "record.json", encoding="utf-8") as file:
            self.raw: dict[str, Any] = json.load(file)
        self.provenance: dict[str, Any] = self.raw["provenance"]
        self.cost: dict[str, Any] = self.raw["cost"]
        with open(folder / "series.csv", encoding="utf-8", newline="") as file:
            names, *rows = csv.reader(file)
        table = np.array(rows, dtype=np.float64).reshape((len(rows), len(names)))
        self.units = {name.split(" (")[0]: name.split(" (")[1].rstrip(")") for name in names if " (" in name}
        """Units of the columns of the series."""
        self.series: dict[str, Floats] = {name.split(" (")[0]: table[:, place] for place, name in enumerate(names)}
        """Columns of the probes, `step` and `time` in SI units, each of shape (samples,)."""
        self.snapshots: list[dict[str, Any]] = _snapshots(folder)
        """Snapshots: `step`, `time` (s), `id` (grains,) and `position`, `velocity`, `spin` (grains, 3), in SI."""


def read(path: str | Path) -> Results | Run:
    """Reads a directory written by grainbench: results of claims, or a simulation.

    Raises ValueError if it contains neither.
    """
    folder = Path(path)
    if (folder / "results.json").is_file():
        with open(folder / "results.json", encoding="utf-8") as file:
            return Results(json.load(file))
    if (folder / "record.json").is_file():
        return Run(folder)
    raise ValueError(f"{folder}: expected `results.json` of claims or `record.json` of a run, found neither")


def frame(rows: list[dict[str, Any]]) -> Any:
    """Returns rows as a dataframe of an installed library. Numbers without a value are missing."""
    backend = next((name for name in _BACKENDS if importlib.util.find_spec(name)), None)
    if backend is None:
        raise ImportError("expected pandas, polars or pyarrow, found none; `raw` has everything without them")
    names = list(dict.fromkeys(name for row in rows for name in row))
    columns = {name: [_plain(row.get(name)) for row in rows] for name in names}
    return nw.from_dict(columns, backend=backend).to_native()  # type: ignore[arg-type]


def _with_parts(row: dict[str, Any]) -> dict[str, Any]:
    """Returns a row with the parts of its detail as columns."""
    detail, _, as_if = (row.get("detail") or "").partition("as if: ")
    outside = re.search(r"(?:first outside at|not a number \(NaN\) from) t = ([-+.\de]+) s", detail)
    reason = detail.replace(outside.group(), "") if outside else detail
    return row | {
        "first_outside": float(outside.group(1)) if outside else None,
        "as_if": as_if or None,
        "reason": reason.strip("; ") or None,
    }


def _plain(value: Any) -> Any:
    """Returns lists and bounds as JSON text, because a column holds values of one type."""
    return json.dumps(value) if isinstance(value, (dict, list)) else value


def _shown(value: Any) -> str:
    if value is None:
        return ""
    return f"{value:.6g}" if isinstance(value, float) else str(_plain(value))


def _line(row: dict[str, Any]) -> str:
    place, verdict = f"{row['case']} · {row['variant']} · {row['quantity']}", row["verdict"] or ""
    if row.get("value") is None:
        return f"{verdict:<12} {place}: {row.get('detail') or ''}"
    parts = f"{_shown(row['value'])} {row['unit']}, expected {_shown(row['expected'])}"
    detail = f"; {row['detail']}" if row.get("detail") else ""
    return f"{verdict:<12} {place}: {parts}, error {_shown(row['error'])}, allowed {_shown(row['allowed'])}{detail}"


def _snapshots(folder: Path) -> list[dict[str, Any]]:
    """Reads the snapshots of a dump; none if they were written in another format."""
    path = folder / "snapshots.dump"
    if not path.is_file():
        return []
    found: list[dict[str, Any]] = []
    with open(path, encoding="utf-8") as file:
        step, time = 0, float("nan")
        for line in file:
            if line.startswith("ITEM: TIMESTEP"):
                step = int(next(file))
            elif line.startswith("ITEM: TIME"):
                time = float(next(file))
            elif line.startswith("ITEM: NUMBER OF"):
                count = int(next(file))
            elif line.startswith("ITEM: ATOMS"):
                names = line.split()[2:]
                rows = [next(file).split() for _ in range(count)]
                table = np.array(rows, dtype=np.float64).reshape((count, len(names)))
                at = {name: place for place, name in enumerate(names)}

                def vector(*wanted: str, table: Floats = table, at: dict[str, int] = at) -> Floats:
                    return table[:, [at[name] for name in wanted]]

                found.append(
                    {
                        "step": step,
                        "time": time,
                        "id": table[:, at["id"]].astype(np.int64),
                        "position": vector("x", "y", "z"),
                        "velocity": vector("vx", "vy", "vz"),
                        "spin": vector("omegax", "omegay", "omegaz"),
                    }
                )
    return found
