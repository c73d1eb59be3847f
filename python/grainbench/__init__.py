"""Benchmarks for the accuracy and the computing cost of solvers for granular mechanics.

A solver is a function of a scene. grainbench tests it with the solver-independent claims. Each claim has a negative control with
wrong physics, for which it must fail::

    import grainbench as gb

    @gb.solver(dimension=[2, 3], laws=["linear"], effects=["friction"])
    def mine(scene: gb.Scene, steps: gb.Steps) -> gb.Record:
        ...

    gb.judge(mine, ["incline-disc", "backspin"])
"""

from ._judge import Judgement, check, conform, cost, judge, scene
from ._read import Costs, Results, Run, read
from ._record import Contacts, Record, Recorder
from ._scene import Law, Scene, Steps, Wall
from ._solver import Broken, Cannot, Solver, solver

__all__ = [
    "Broken",
    "Cannot",
    "Contacts",
    "Costs",
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
    "check",
    "conform",
    "cost",
    "judge",
    "read",
    "scene",
    "solver",
]
