"""Output of a solver: the grains at each sample."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._scene import Floats, Scene


@dataclass(frozen=True)
class Contacts:
    """Contacts between grains, one row per contact and sample. Pairs without a row have no force."""

    step: NDArray[np.int64]
    """Step of each row in ascending order, shape (rows,)."""
    id: NDArray[np.int64]
    """Ids of the two grains, shape (rows, 2)."""
    force: Floats
    """Force on the first grain (N; N per metre of depth for discs), shape (rows, 3)."""
    torque: Floats | None = None
    """Torque on the first grain about its centre (N m), shape (rows, 3). It is stored, and no claim reads it."""

    def __post_init__(self) -> None:
        rows = np.shape(self.step)[:1]
        shapes = {"step": rows, "id": (*rows, 2), "force": (*rows, 3), "torque": (*rows, 3)}
        for name, shape in shapes.items():
            array = getattr(self, name)
            if array is not None and np.shape(array) != shape:
                raise ValueError(f"{name} of contacts: expected the shape {shape}, found {np.shape(array)}")

    def _arrays(self) -> dict[str, ArrayLike]:
        arrays: dict[str, ArrayLike] = {
            "contact_step": np.asarray(self.step, dtype=np.int64),
            "contact_id": np.asarray(self.id, dtype=np.int64),
            "contact_force": _floats(self.force),
        }
        return arrays if self.torque is None else arrays | {"contact_torque": _floats(self.torque)}


@dataclass(frozen=True)
class Record:
    """Grains at each sample, in the order of the scene."""

    step: NDArray[np.int64]
    """Numbers of completed steps, shape (samples,)."""
    position: Floats
    """Positions (m), shape (samples, grains, 3)."""
    velocity: Floats | None = None
    """Velocities (m/s), shape (samples, grains, 3)."""
    spin: Floats | None = None
    """Angular velocities (rad/s), shape (samples, grains, 3)."""
    id: NDArray[np.int64] | None = None
    """Ids of the grains, shape (grains,) or (samples, grains); by default 1, 2, … in the order of the scene."""
    seconds: float | None = None
    """Time of the solution without start and output (s); None if it was not measured."""
    contacts: Contacts | None = None
    """Contacts between grains at all samples; None if the solver does not report them."""
    wall_force: Mapping[str, Floats] = field(default_factory=dict)
    """Forces of walls on each grain (N; N per metre of depth for discs), by name of the wall, shape (samples, grains, 3)."""

    def __post_init__(self) -> None:
        samples = np.shape(self.step)
        if len(samples) != 1:
            raise ValueError(f"step: expected the shape (samples,), found {samples}")
        shape = np.shape(self.position)
        if len(shape) != 3 or shape[0] != samples[0] or shape[2] != 3:
            raise ValueError(f"position: expected the shape ({samples[0]}, grains, 3), found {shape}")
        for name in ("velocity", "spin"):
            array = getattr(self, name)
            if array is not None and np.shape(array) != shape:
                raise ValueError(f"{name}: expected the shape {shape} of the positions, found {np.shape(array)}")
        if self.id is not None and np.shape(self.id) not in (shape[:2], shape[1:2]):
            raise ValueError(f"id: expected the shape {shape[1:2]} or {shape[:2]}, found {np.shape(self.id)}")
        for name, force in self.wall_force.items():
            if np.shape(force) != shape:
                raise ValueError(f"force of the wall {name}: expected the shape {shape}, found {np.shape(force)}")

    def write(self, folder: str | Path) -> None:
        """Writes `grains.npz` to a directory."""
        ids = np.arange(1, np.shape(self.position)[1] + 1) if self.id is None else self.id
        arrays: dict[str, ArrayLike] = {
            "step": np.asarray(self.step, dtype=np.int64),
            "id": np.asarray(ids, dtype=np.int64),
            "position": _floats(self.position),
        }
        if self.velocity is not None:
            arrays["velocity"] = _floats(self.velocity)
        if self.spin is not None:
            arrays["spin"] = _floats(self.spin)
        arrays |= {f"{name}.force": _floats(force) for name, force in self.wall_force.items()}
        if self.contacts is not None:
            arrays |= self.contacts._arrays()
        with open(Path(folder) / "grains.npz", "wb") as file:
            np.savez(file, **arrays)  # type: ignore[arg-type]


def _floats(array: ArrayLike) -> Floats:
    return np.ascontiguousarray(array, dtype=np.float64)


class Recorder:
    """Recorder of samples. Call `take` after each step; it stores the samples that the scene asks for."""

    def __init__(self, scene: Scene) -> None:
        self._steps = scene.steps
        self._taken: list[int] = []
        self._states: list[tuple[Floats, Floats, Floats]] = []
        self._contacts: list[tuple[Floats, ...]] = []
        self._walls: dict[str, list[Floats]] = {}

    def is_due(self, step: int) -> bool:
        """Returns True if `take` stores the state after `step` steps."""
        return self._steps.is_sample(step)

    def take(
        self,
        step: int,
        position: ArrayLike,
        velocity: ArrayLike,
        spin: ArrayLike,
        *,
        contacts: Sequence[ArrayLike] | None = None,
        wall_force: Mapping[str, ArrayLike] | None = None,
    ) -> None:
        """Stores the grains after `step` steps if a sample is due. Each array has the shape (grains, 3).

        contacts: ids of the two grains (rows, 2), force on the first grain (rows, 3) and, if the solver has it, torque on
        the first grain (rows, 3). wall_force: forces of each wall on the grains (grains, 3), by name of the wall. A solver
        that reports contacts or forces of walls reports them at each sample.
        """
        if not self.is_due(step):
            return
        self._taken.append(step)
        self._states.append((_copy(position), _copy(velocity), _copy(spin)))
        if contacts is not None:
            ids, *vectors = contacts
            self._contacts.append((np.array(ids, dtype=np.float64).reshape((-1, 2)), *(_copy(vector) for vector in vectors)))
        for name, force in (wall_force or {}).items():
            self._walls.setdefault(name, []).append(_copy(force))

    def record(self) -> Record:
        """Returns the stored samples as a record."""
        steps = np.array(self._taken, dtype=np.int64)
        position, velocity, spin = (np.array(part) for part in zip(*self._states, strict=True))
        contacts = None
        if self._contacts:
            if len(self._contacts) != len(steps):
                raise ValueError(f"contacts: expected them at all {len(steps)} samples, found {len(self._contacts)}")
            ids, *vectors = (np.concatenate(part) for part in zip(*self._contacts, strict=True))
            rows = np.repeat(steps, [len(part[0]) for part in self._contacts])
            contacts = Contacts(rows, ids.astype(np.int64), *vectors)
        walls = {name: np.array(forces) for name, forces in self._walls.items()}
        return Record(steps, position, velocity, spin, contacts=contacts, wall_force=walls)


def _copy(array: ArrayLike) -> Floats:
    copied = np.array(array, dtype=np.float64)
    return copied.reshape((-1, 3))
