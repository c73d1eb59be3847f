"""Plugin for `pytest --grainbench MODULE:NAME` or `FILE.py:NAME`.

It adds one item for each solver-independent claim, and one for its negative control.
"""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path
from typing import Any

import pytest

from ._binary import run
from ._read import _line
from .worker import load


_NOTHING: pytest.StashKey[bool] = pytest.StashKey()
_COUNT: pytest.StashKey[_Count] = pytest.StashKey()
# Message of the program about a case without a claim for this solver.
_NOT_FAIR = "solver-independent claim"
# Property of a report whose claim was evaluated. Workers of pytest-xdist send it to the process that decides.
_JUDGED = "grainbench-judged"


def pytest_addoption(parser: pytest.Parser) -> None:
    """Adds the options of the plugin."""
    group = parser.getgroup("grainbench", "solvers of grains, judged by grainbench")
    group.addoption("--grainbench", metavar="MODULE:NAME", help="judge the function under @grainbench.solver of this name")
    group.addoption(
        "--grainbench-cases", metavar="CASE,…", default="", help="by these cases alone (CASE, CASE/VARIANT or a folder)"
    )


def pytest_configure(config: pytest.Config) -> None:
    """Checks the name before the collection."""
    target: str | None = config.getoption("--grainbench")
    if target is not None and ":" not in target:
        raise pytest.UsageError(f"--grainbench: expected MODULE:NAME or FILE.py:NAME, found {target!r}")
    config.stash[_COUNT] = _Count()
    config.pluginmanager.register(config.stash[_COUNT], "grainbench-count")


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(session: pytest.Session, config: pytest.Config, items: list[pytest.Item]) -> None:
    """Adds the items before `-k` and `-m` select among them."""
    target: str | None = config.getoption("--grainbench")
    if target is None:
        return
    wanted = [name for name in config.getoption("--grainbench-cases").split(",") if name]
    try:
        solver = load(_absolute(target, config))
        rows = _rows(wanted)
    except (SystemExit, ValueError, FileNotFoundError) as error:
        raise pytest.UsageError(str(error)) from None
    if not any(config.args_source is source for source in (config.ArgsSource.ARGS,)):
        # No other tests were requested.
        items.clear()
    folder = config._tmp_path_factory.mktemp("grainbench") if hasattr(config, "_tmp_path_factory") else None
    judged = _Judged(solver.manifest([sys.executable, "-m", "grainbench.worker", _absolute(target, config)]), folder, config)
    seen: dict[tuple[str, str, str], int] = {}
    for row in rows:
        key = (row.get("folder", row["case"]), row["variant"], row["quantity"])
        place = seen[key] = seen.get(key, -1) + 1
        for control in (None, row["control"]):
            name, words = _name(row, control), {"judged": judged, "control": control, "solvers": row["solvers"]}
            items.append(_Row.from_parent(session, name=name, nodeid=name, key=(*key, place), **words))


@pytest.hookimpl(trylast=True)
def pytest_sessionfinish(session: pytest.Session, exitstatus: int) -> None:
    """Fails if claims were requested and none was evaluated. Controls alone are no result."""
    if session.config.getoption("--grainbench") is None or exitstatus not in (0, 5) or session.config.option.collectonly:
        return
    is_worker = hasattr(session.config, "workerinput")
    if not is_worker and session.config.stash[_COUNT].judged == 0:
        session.exitstatus = pytest.ExitCode.TESTS_FAILED
        session.config.stash[_NOTHING] = True


def pytest_terminal_summary(terminalreporter: Any, config: pytest.Config) -> None:
    """Reports the reason for the failure if all items were skipped."""
    if config.stash.get(_NOTHING, False):
        terminalreporter.write_line("grainbench: no row was judged: the run fails", red=True)


def pytest_report_collectionfinish(config: pytest.Config, items: list[pytest.Item]) -> str | None:
    """Returns the number of claims and controls among the items."""
    rows = sum(isinstance(item, _Row) for item in items)
    return f"grainbench: {rows} rows and controls of {config.getoption('--grainbench')}" if rows else None


def _rows(wanted: list[str]) -> list[dict[str, Any]]:
    """Returns the claims of the cases. A claim of a case folder has the path of the folder."""
    folders = [name for name in wanted if (Path(name) / "claims.toml").is_file()]
    others = [name for name in wanted if name not in folders]
    rows: list[dict[str, Any]] = json.loads(run(["list", "--rows", "--json", *others])) if others or not folders else []
    for folder in folders:
        rows += [row | {"folder": folder} for row in json.loads(run(["list", "--rows", "--json", folder]))]
    return rows


def _absolute(target: str, config: pytest.Config) -> str:
    """Returns the target with an absolute path, because the solver runs in another directory."""
    place, _, name = target.rpartition(":")
    path = Path(config.invocation_params.dir) / place
    return f"{path}:{name}" if place.endswith(".py") else target


def _name(row: dict[str, Any], control: str | None) -> str:
    name = f"{row['case']}/{row['variant']}::{row['quantity']}"
    return name if control is None else f"{name} [control: {control}]"


class _Count:
    """Number of evaluated claims, in this process and in its workers."""

    def __init__(self) -> None:
        self.judged = 0

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Counts the report of a claim."""
        self.judged += report.when == "call" and any(name == _JUDGED for name, _ in report.user_properties)


class _Judged:
    """Results by case; each case runs when its first item runs."""

    def __init__(self, manifest: str, folder: Path | None, config: pytest.Config) -> None:
        import tempfile

        self._folder = folder or Path(tempfile.mkdtemp(prefix="grainbench-"))
        (self._folder / "SOLVER.toml").write_text(manifest, encoding="utf-8")
        places = [str(config.invocation_params.dir), *os.environ.get("PYTHONPATH", "").split(os.pathsep)]
        os.environ["PYTHONPATH"] = os.pathsep.join(place for place in places if place)
        self._results: dict[str, dict[str, Any]] = {}

    def of(self, case: str) -> dict[str, Any]:
        """Returns the results of a case."""
        if case not in self._results:
            words = ["run", case, "--solver", str(self._folder / "SOLVER.toml"), "--json"]
            try:
                out = self._folder / str(len(self._results))
                self._results[case] = json.loads(run([*words, "--out", str(out)]))
            except ValueError as error:
                if _NOT_FAIR not in str(error):
                    raise
                self._results[case] = {"not_asked": str(error)}
        return self._results[case]


class _Row(pytest.Item):
    """Item of a claim or of its control."""

    def __init__(self, *, judged: _Judged, key: tuple[str, str, str, int], control: str | None, solvers: str, **words: Any) -> None:
        super().__init__(**words)
        self._judged, self._key, self._control, self._solvers = judged, key, control, solvers

    def runtest(self) -> None:
        """Passes if the claim passed, or if its control failed as required."""
        case, variant, quantity, place = self._key
        results = self._judged.of(case)
        if "not_asked" in results:
            pytest.skip(results["not_asked"])

        def found(kind: str) -> list[dict[str, Any]]:
            return [row for row in results[kind] if (row["variant"], row["quantity"]) == (variant, quantity)]

        if place >= len(found("verdicts")) and self._solvers != "any":
            pytest.skip(f"a row for solvers of one kind: {self._solvers}")
        if place >= len(found("verdicts")):
            raise _Red("there is no result of this row")
        row = found("verdicts")[place]
        if row["severity"] == "amber":
            pytest.skip(f"{row['verdict']}: {row.get('detail') or ''}")
        if self._control is not None:
            # A control is missing if the result is red and the solver does not support the wrong scene.
            controls = found("controls")
            if place >= len(controls) and row["severity"] == "red":
                pytest.skip("the row is red, and its control cannot be expressed")
            if place >= len(controls):
                raise _Red("there is no result of this control")
            if not controls[place]["turned_red"]:
                raise _Red(f"the row stays green under wrong physics: {self._control}")
            return
        self.user_properties.append((_JUDGED, True))
        if row["severity"] == "red":
            raise _Red(_line(row) + (f"\n{row['detail']}" if row.get("detail") else ""))

    def repr_failure(self, excinfo: Any, style: Any = None) -> Any:
        """Returns the result in words; for other errors, the traceback."""
        if isinstance(excinfo.value, (_Red, ValueError)):
            return str(excinfo.value)
        return super().repr_failure(excinfo, style)

    def reportinfo(self) -> tuple[str, int | None, str]:
        """Returns the place under which the item is listed."""
        return ("grainbench", None, self.name)


class _Red(Exception):
    """Error for a red result."""
