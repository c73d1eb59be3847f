"""Benchmarks for the accuracy and the computing cost of solvers for granular mechanics.

A solver is a function of a scene. grainbench tests it with the solver-independent claims. Each claim has a negative control with
wrong physics, for which it must fail::

    import grainbench as gb

    @gb.solver(dimension=[2, 3], laws=["linear"], effects=["friction"])
    def mine(scene: gb.Scene, steps: gb.Steps) -> gb.Record:
        ...

    gb.judge(mine, ["incline-disc", "backspin"])
"""

from ._judge import Judgement, judge
from ._read import Results, Run, read
from ._record import Record, Recorder
from ._scene import Law, Scene, Steps, Wall
from ._solver import Broken, Cannot, Solver, solver

__all__ = [
    "Broken",
    "Cannot",
    "Judgement",
    "Law",
    "Record",
    "Recorder",
    "Results",
    "Run",
    "Scene",
    "Solver",
    "Steps",
    "Wall",
    "judge",
    "read",
    "solver",
]
