"""Worker `python -m grainbench.worker MODULE:NAME` or `FILE.py:NAME`: a solver that keeps running between runs.

The key `worker` of a `SOLVER.toml` names this command. `--in DIR` before the name sets the working directory. `--manifest`
prints the `SOLVER.toml` of the function, with this directory, instead.
"""

from __future__ import annotations

import importlib
import importlib.util
import os
import sys
from pathlib import Path

from ._serve import answer
from ._solver import Solver


def load(target: str) -> Solver:
    """Returns the solver `MODULE:NAME` or `FILE.py:NAME`."""
    place, colon, name = target.rpartition(":")
    if not colon:
        raise SystemExit(f"expected MODULE:NAME or FILE.py:NAME, found {target!r}")
    if place.endswith(".py"):
        path = Path(place).resolve()
        spec = importlib.util.spec_from_file_location(path.stem, path)
        if spec is None or spec.loader is None or not path.is_file():
            raise SystemExit(f"expected a file of Python, found {place!r}")
        module = importlib.util.module_from_spec(spec)
        sys.modules[path.stem] = module
        sys.path.insert(0, str(path.parent))
        spec.loader.exec_module(module)
    else:
        sys.path.insert(0, os.getcwd())
        module = importlib.import_module(place)
    found = getattr(module, name, None)
    if not isinstance(found, Solver):
        raise SystemExit(f"expected a function under @grainbench.solver as {name!r} of {place}, found {type(found).__name__}")
    return found


def main() -> None:
    """Answers requests until the input ends, or prints the manifest. Output of the solver goes to the standard error."""
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)
    match sys.argv[1:]:
        case ["--manifest", target]:
            worker = [sys.executable, "-m", "grainbench.worker", "--in", os.getcwd(), target]
            print(load(target).manifest(worker), end="", file=answers, flush=True)
            return
        case ["--in", folder, target]:
            os.chdir(folder)
        case [target]:
            pass
        case _:
            raise SystemExit("usage: python -m grainbench.worker [--manifest | --in DIR] MODULE:NAME")
    solver = load(target)
    for line in sys.stdin:
        print(answer(solver, line), file=answers, flush=True)


if __name__ == "__main__":
    main()
