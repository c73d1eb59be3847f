"""Answers to run requests, one per line."""

from __future__ import annotations

import json
import time
import traceback
from typing import Any

from ._record import Record
from ._scene import Scene
from ._solver import Broken, Cannot, Solver


def answer(solver: Solver, line: str) -> str:
    """Does a requested run, writes its files to the requested directory, and returns its outcome as JSON."""
    request = json.loads(line)
    return json.dumps(_run(solver, request["scene"], request["out"]))


def _run(solver: Solver, scene_file: str, out: str) -> dict[str, Any]:
    try:
        scene = Scene.read(scene_file)
        start = time.perf_counter()
        record = solver(scene, scene.steps)
        seconds = time.perf_counter() - start
        if not isinstance(record, Record):
            return _failed(f"expected a Record from {solver.name}, found {type(record).__name__}")
        record.write(out)
        return {"ran": {"seconds": seconds if record.seconds is None else record.seconds}}
    except Cannot as reason:
        return {"cannot": str(reason) or "it gave no reason"}
    except Broken as broken:
        return {"failed": {"when": broken.when, "where": broken.where, "why": broken.why}}
    except Exception as error:  # Any error belongs to the solver, and its result reports it.
        traceback.print_exc()
        last = traceback.extract_tb(error.__traceback__)[-1]
        return _failed(f"{type(error).__name__}: {error}", f"{last.filename}:{last.lineno}")


def _failed(why: str, where: str | None = None) -> dict[str, Any]:
    return {"failed": {"when": None, "where": where, "why": why}}
