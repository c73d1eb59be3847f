"""The program that this package comes with."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import sysconfig
from collections.abc import Sequence
from pathlib import Path


def binary() -> str:
    """The program `grainbench`: what `GRAINBENCH` names, what was installed with this package, or what `PATH` finds."""
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
        raise FileNotFoundError("expected the program grainbench beside Python or on PATH, found none")
    return found


def run(words: Sequence[str]) -> str:
    """What the program prints. Rows that are red are no error here; what cannot be done is."""
    done = subprocess.run([binary(), *words], capture_output=True, text=True, check=False)
    if done.returncode not in (0, 1) or not done.stdout:
        raise ValueError(done.stderr.strip().removeprefix("error: ") or f"grainbench ended with {done.returncode}")
    return done.stdout
