"""Server that lets grainbench call a function of this process. It needs `fork` and Unix sockets."""

from __future__ import annotations

import os
import socketserver
import sys
import tempfile
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

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
def served(solver: Solver) -> Iterator[Path]:
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
