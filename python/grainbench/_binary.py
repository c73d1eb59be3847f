"""Path of the grainbench program, and calls of it."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import sysconfig
from collections.abc import Sequence
from pathlib import Path


def binary() -> str:
    """Returns the path of the program: from `GRAINBENCH`, from the installation of this package, or from `PATH`."""
    named = os.environ.get("GRAINBENCH")
    if named:
        return named
    here = Path(sysconfig.get_path("scripts")) / "grainbench"
    beside = Path(sys.executable).parent / "grainbench"
    for place in (here, beside):
        if place.is_file():
            return str(place)
    found = shutil.which("grainbench")
    if found is None:
        raise FileNotFoundError("expected the program grainbench next to Python or on PATH, found none")
    return found


def run(words: Sequence[str]) -> str:
    """Runs the program and returns its output. Red results are not an error.

    Raises ValueError if the program rejects the call.
    """
    done = subprocess.run([binary(), *words], capture_output=True, text=True, check=False)
    if done.returncode not in (0, 1) or not done.stdout:
        raise ValueError(done.stderr.strip().removeprefix("error: ") or f"grainbench ended with {done.returncode}")
    return done.stdout
