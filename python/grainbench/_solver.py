"""A function as a solver, with what it declares that it can."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from ._record import Record
from ._scene import Scene, Steps

Function = Callable[[Scene, Steps], Record]


class Cannot(Exception):
    """A scene cannot be expressed; the reason stands in the row."""


class Broken(Exception):
    """A run broke: when, where and why."""

    def __init__(self, why: str, when: Any = None, where: Any = None) -> None:
        super().__init__(why)
        self.why, self.when, self.where = why, when, where


@dataclass(frozen=True)
class Solver:
    """A function, and what it declares."""

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
        """`SOLVER.toml` of the function behind a command that takes a run a line."""
        # A list of strings and numbers is written in TOML as in JSON.
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
    """Makes a solver of a function of a scene and its steps.

    What is not declared is not asked for: such a row reads `unsupported`, with the reason.

    dimension: 2, 3 or both. laws: `linear`, `hertz-mindlin`, `coulomb`. walls: `plane`, `segment`, `rectangle`, `round`, `mesh`.
    effects: `friction`, `contact-damping`, `rolling-resistance`, … as `grainbench scene CASE` names them; gravity is everybody's.
    driven: whether grains can be driven. seconds and memory_mib: what a run may take. critical_fraction: time steps, as parts of the
    critical one, at which it is seen how the error falls and what it costs.
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
