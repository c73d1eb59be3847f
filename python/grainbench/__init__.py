"""How far to trust a solver of grains, and what that trust costs.

A solver is a function of a scene; it is judged by the rows of grainbench that are fair to any solver, each with a control of
wrong physics that must turn it red::

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
