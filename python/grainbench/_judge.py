"""Tests of solvers and of output with claims, the cost study, and resolved scenes."""

from __future__ import annotations

import json
import os
import socket
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from ._binary import run
from ._read import Costs, Results
from ._record import Record
from ._scene import Scene
from ._solver import Solver


class Judgement(Results):
    """Results and controls of a solver or of output. It prints as a table."""

    page: Path | None = None
    """Page of the report; None without `out`."""

    @property
    def passed(self) -> bool:
        """True if the program ends with exit code 0: something was judged, nothing is red, and each control failed as required."""
        return bool(self.raw["passed"])

    def require(self) -> Judgement:
        """Returns the judgement if it passed; otherwise raises an AssertionError with the red results."""
        if not self.passed:
            raise AssertionError("\n" + self.table(only_red=True))
        return self


def judge(
    solver: Solver | str | Path,
    cases: Sequence[str] = (),
    *,
    controls: bool = True,
    out: str | Path | None = None,
    progress: bool | None = None,
) -> Judgement:
    """Tests a solver with the claims of some cases (`CASE`, `CASE/VARIANT` or a folder); with all cases by default.

    solver: a function under `@grainbench.solver`, a name, or the path of a `SOLVER.toml`. out: directory for the page and
    the result files, which is replaced. progress: True shows a progress bar; None shows it on a terminal.

    Raises ValueError if a case does not exist or a declaration of the solver is wrong.
    """
    with _manifest(solver) as name:
        words = ["judge", name, *cases] + ([] if controls else ["--no-controls"])
        return _judged(words, out, progress)


def conform(solver: Solver | str | Path, *, out: str | Path | None = None, progress: bool | None = None) -> Judgement:
    """Tests the conformance properties of a solver: conservation, symmetries, free flight, order and determinism."""
    with _manifest(solver) as name:
        return _judged(["conform", name], out, progress)


def cost(
    solver: Solver | str | Path,
    cases: Sequence[str],
    *,
    out: str | Path | None = None,
    progress: bool | None = None,
) -> Costs:
    """Measures the error of a solver against its computing time, at several time steps.

    With `out`, finished points stay in this directory, and a repeated call continues after an interruption.
    """
    with _manifest(solver) as name:
        return Costs(_results(["cost", *cases, "--solver", name], out, progress))


def check(
    scene: str | Path,
    dump: str | Path | Sequence[str | Path] | Record,
    *,
    set: Mapping[str, object] | None = None,
    time_step: float | None = None,
    out: str | Path | None = None,
    progress: bool | None = None,
) -> Judgement:
    """Judges output of any program for a case or a scene file.

    dump: files in a format of `grainbench check`, or a record with the `time_step` (s) of its run. set: changed keys of the
    scene, such as `{"contacts.floor.friction": 0.5}`.
    """
    with tempfile.TemporaryDirectory(prefix="grainbench-") as folder:
        if isinstance(dump, Record):
            dump.write(folder)
            files: list[str] = [os.path.join(folder, "grains.npz")]
        else:
            files = [str(file) for file in ([dump] if isinstance(dump, (str, Path)) else dump)]
        words = ["check", str(scene), *_changes(set), "--dump", *files]
        if time_step is not None:
            words += ["--time-step", repr(time_step)]
        return _judged(words, out, progress)


def scene(name: str | Path, *, set: Mapping[str, object] | None = None, time_step: float | None = None) -> Scene:
    """Returns the resolved scene of a case (`CASE` or `CASE/VARIANT`) or a scene file, as a solver receives it.

    set: changed keys of the scene. time_step: time step (s).
    """
    words = ["scene", str(name), *_changes(set)]
    return Scene._of(run(words if time_step is None else [*words, "--time-step", repr(time_step)]), str(name))


def _changes(set: Mapping[str, object] | None) -> list[str]:
    def value(given: object) -> str:
        return given if isinstance(given, str) else json.dumps(given)

    return [word for key, given in (set or {}).items() for word in ("--set", f"{key}={value(given)}")]


@contextmanager
def _manifest(solver: Solver | str | Path) -> Iterator[str]:
    """Yields the name of a solver or the path of its manifest, and serves a function meanwhile."""
    if isinstance(solver, (str, Path)):
        yield str(solver)
        return
    if not isinstance(solver, Solver):
        raise TypeError(f"expected a function under @grainbench.solver, found {type(solver).__name__}")
    if not hasattr(socket, "AF_UNIX") or not hasattr(os, "fork"):
        raise OSError("expected a system with fork and Unix sockets; a SOLVER.toml works on every system")
    from ._server import served

    with served(solver) as manifest:
        yield str(manifest)


def _judged(words: Sequence[str], out: str | Path | None, progress: bool | None) -> Judgement:
    judgement = Judgement(_results(words, out, progress))
    judgement.page = None if out is None else Path(out) / "index.html"
    return judgement


def _results(words: Sequence[str], out: str | Path | None, progress: bool | None) -> dict[str, Any]:
    """Runs a command and returns its results. Without `out`, its report is removed."""
    with tempfile.TemporaryDirectory(prefix="grainbench-") as folder:
        place = os.path.join(folder, "out") if out is None else str(out)
        results: dict[str, Any] = json.loads(run([*words, "--json", "--out", place], progress=progress))
    return results
