"""Tests of a solver function with the solver-independent claims."""

from __future__ import annotations

import json
import os
import socket
import socketserver
import sys
import tempfile
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from ._binary import run
from ._read import Results
from ._serve import answer
from ._solver import Solver

# Relays requests of grainbench to the process of the function, and its answers back. All its imports are fast.
_RELAY = """
import os, socket, sys, threading
far = socket.socket(socket.AF_UNIX); far.connect(sys.argv[1])
def back():
    while data := far.recv(65536):
        sys.stdout.buffer.write(data); sys.stdout.buffer.flush()
    os._exit(1)
threading.Thread(target=back, daemon=True).start()
for line in sys.stdin.buffer:
    far.sendall(line)
"""


class _Server(socketserver.ForkingMixIn, socketserver.UnixStreamServer):
    """Server with one forked process per connection, so that the function may be a closure or a notebook cell."""

    solver: Solver
    max_children = 1024


class _Handler(socketserver.StreamRequestHandler):
    server: _Server

    def handle(self) -> None:
        # Only answers go to grainbench. Output of the function goes to the standard error.
        os.dup2(2, 1)
        for line in self._lines():
            self.wfile.write((answer(self.server.solver, line) + "\n").encode())
            self.wfile.flush()

    def _lines(self) -> Iterator[str]:
        """Yields the requests. If grainbench closes the connection during a run, this process ends too."""
        pending: list[bytes] = []
        ready = threading.Condition()

        def listen() -> None:
            for line in self.rfile:
                with ready:
                    pending.append(line)
                    ready.notify()
            os._exit(0)

        threading.Thread(target=listen, daemon=True).start()
        while True:
            with ready:
                while not pending:
                    ready.wait()
                line = pending.pop(0)
            yield line.decode()


@contextmanager
def _served(solver: Solver) -> Iterator[Path]:
    """Serves the function from this process and yields the path of its manifest."""
    with tempfile.TemporaryDirectory(prefix="grainbench-") as folder:
        address = os.path.join(folder, "socket")
        with _Server(address, _Handler) as server:
            server.solver = solver
            thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.05}, daemon=True)
            thread.start()
            manifest = Path(folder) / "SOLVER.toml"
            manifest.write_text(solver.manifest([sys.executable, "-I", "-S", "-c", _RELAY, address]), encoding="utf-8")
            try:
                yield manifest
            finally:
                server.shutdown()
                thread.join()


class Judgement(Results):
    """Results and controls of a solver function. It prints as a table."""

    @property
    def passed(self) -> bool:
        """True if at least one result is green, none is red, each control failed as required, and the run was not interrupted."""
        severities = {row["severity"] for row in self.verdicts}
        controls = all(control["turned_red"] for control in self.of_controls)
        return "green" in severities and "red" not in severities and controls and not self.raw.get("red_because")

    def require(self) -> Judgement:
        """Returns the judgement if it passed; otherwise raises an AssertionError with the red results."""
        if not self.passed:
            raise AssertionError("\n" + self.table(only_red=True))
        return self


def judge(solver: Solver, cases: Sequence[str] = (), *, controls: bool = True) -> Judgement:
    """Tests a solver with the claims of some cases (`CASE` or `CASE/VARIANT`); with all cases by default.

    Raises ValueError if a case does not exist or a declaration of the solver is wrong.
    """
    if not isinstance(solver, Solver):
        raise TypeError(f"expected a function under @grainbench.solver, found {type(solver).__name__}")
    if not hasattr(socket, "AF_UNIX") or not hasattr(os, "fork"):
        raise OSError("expected a system with fork and Unix sockets; a SOLVER.toml works on every system")
    with _served(solver) as manifest, tempfile.TemporaryDirectory(prefix="grainbench-") as out:
        words = ["judge", str(manifest), *cases, "--json", "--out", os.path.join(out, "out")]
        results: dict[str, Any] = json.loads(run(words if controls else [*words, "--no-controls"]))
    return Judgement(results)
