"""Path of the grainbench program, and calls of it."""

from __future__ import annotations

import os
import re
import shutil
import struct
import subprocess
import sys
import sysconfig
import threading
from collections.abc import Sequence
from pathlib import Path

# Control sequences of a terminal.
_CONTROL = re.compile(r"\x1b\[[0-9;?]*[A-Za-z]")


def binary() -> str:
    """Returns the path of the program: from `GRAINBENCH`, from the installation of this package, or from `PATH`."""
    named = os.environ.get("GRAINBENCH")
    if named:
        return named
    name = "grainbench.exe" if os.name == "nt" else "grainbench"
    here = Path(sysconfig.get_path("scripts")) / name
    beside = Path(sys.executable).parent / name
    for place in (here, beside):
        if place.is_file():
            return str(place)
    found = shutil.which("grainbench")
    if found is None:
        raise FileNotFoundError("expected the program grainbench next to Python or on PATH, found none")
    return found


def run(words: Sequence[str], *, progress: bool | None = False) -> str:
    """Runs the program and returns its output. Red results are not an error.

    `progress` shows the program's progress bar with the remaining time on the standard error; None shows it on a terminal.

    Raises ValueError if the program rejects the call.
    """
    wanted = sys.stderr.isatty() if progress is None else progress
    command = [binary(), *words]
    if wanted and os.name == "posix":
        code, output, errors = _with_progress(command)
    else:
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        code, output, errors = done.returncode, done.stdout, done.stderr
    if code not in (0, 1) or not output:
        raise ValueError(errors.strip().removeprefix("error: ") or f"grainbench ended with {code}")
    return output


def _with_progress(command: Sequence[str]) -> tuple[int, str, str]:
    """Runs a command whose standard error is a terminal, and shows its text. Returns exit code, output and messages."""
    import fcntl
    import pty
    import termios

    main, side = pty.openpty()
    size = shutil.get_terminal_size()
    fcntl.ioctl(side, termios.TIOCSWINSZ, struct.pack("HHHH", size.lines, size.columns, 0, 0))
    shown: list[str] = []

    def show() -> None:
        # At the end of the program, reading fails on Linux and returns nothing on macOS.
        try:
            while data := os.read(main, 65536):
                shown.append(data.decode(errors="replace"))
                sys.stderr.write(shown[-1])
                sys.stderr.flush()
        except OSError:
            pass

    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=side, text=True) as program:
        os.close(side)
        reader = threading.Thread(target=show, daemon=True)
        reader.start()
        output, _ = program.communicate()
        reader.join()
    os.close(main)
    lines = re.split(r"[\r\n]+", _CONTROL.sub("", "".join(shown)))
    errors = [line for line in lines if line.startswith("error: ")]
    return program.returncode, output, "\n".join(errors)
