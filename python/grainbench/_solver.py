"""Solver function with its declared capabilities."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from ._record import Record
from ._scene import Scene, Steps

Function = Callable[[Scene, Steps], Record]


class Cannot(Exception):
    """Error for a scene that the solver does not support. Its text is the reason in the result."""


class Broken(Exception):
    """Error for a failed run, with time, place and reason."""

    def __init__(self, why: str, when: Any = None, where: Any = None) -> None:
        super().__init__(why)
        self.why, self.when, self.where = why, when, where


@dataclass(frozen=True)
class Solver:
    """Solver function and its declarations."""

    function: Function
    name: str
    dimension: tuple[int, ...]
    laws: tuple[str, ...]
    walls: tuple[str, ...]
    effects: tuple[str, ...]
    driven: bool
    version: str | None
    seconds: int
    memory_mib: int | None
    critical_fraction: tuple[float, ...]

    def __call__(self, scene: Scene, steps: Steps) -> Record:
        return self.function(scene, steps)

    def manifest(self, worker: Sequence[str]) -> str:
        """Returns the `SOLVER.toml` for a command that reads one run request per line."""
        # Lists of strings and numbers are written in TOML as in JSON.
        import json

        def line(key: str, value: Any) -> str:
            return f"{key} = {json.dumps(value)}"

        lines = [line("name", self.name)]
        if self.version is not None:
            lines.append(line("version", ["echo", self.version]))
        lines += [line("worker", list(worker)), "", "[can]"]
        lines += [line("dimension", self.dimension), line("laws", self.laws), line("walls", self.walls)]
        lines += [line("effects", self.effects), line("driven", self.driven), ""]
        if self.critical_fraction:
            lines += ["[knobs]", line("critical-fraction", self.critical_fraction), ""]
        lines += ["[output]", 'grains = { path = "grains.npz", format = "npz" }', ""]
        lines += ["[limits]", line("seconds", self.seconds)]
        if self.memory_mib is not None:
            lines.append(line("memory_mib", self.memory_mib))
        return "\n".join(lines) + "\n"


def solver(
    dimension: Sequence[int],
    laws: Sequence[str],
    walls: Sequence[str] = ("plane",),
    effects: Sequence[str] = (),
    *,
    driven: bool = False,
    name: str | None = None,
    version: str | None = None,
    seconds: int = 600,
    memory_mib: int | None = None,
    critical_fraction: Sequence[float] = (),
) -> Callable[[Function], Solver]:
    """Makes a solver from a function of a scene and its steps.

    Claims that need an undeclared capability are `unsupported`, with the reason.

    dimension: 2, 3 or both. laws: `linear`, `hertz-mindlin`, `coulomb`. walls: `plane`, `segment`, `rectangle`, `round`,
    `mesh`. effects: `friction`, `contact-damping`, `rolling-resistance`, … as `grainbench scene CASE` names them. Each
    solver must support gravity. driven: True if grains can have a prescribed motion. seconds, memory_mib: limits of a
    run. critical_fraction: time steps of the cost-accuracy study, as fractions of the critical one.
    """

    def make(function: Function) -> Solver:
        own = name if name is not None else getattr(function, "__name__", "solver").replace("_", "-").strip("-") or "solver"
        return Solver(
            function,
            own,
            tuple(dimension),
            tuple(laws),
            tuple(walls),
            tuple(effects),
            driven,
            version,
            seconds,
            memory_mib,
            tuple(critical_fraction),
        )

    return make
