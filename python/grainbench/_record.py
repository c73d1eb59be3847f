"""Output of a solver: the grains at each sample."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._scene import Floats, Scene


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

    def take(self, step: int, position: ArrayLike, velocity: ArrayLike, spin: ArrayLike) -> None:
        """Stores the grains after `step` steps if a sample is due. Each array has the shape (grains, 3)."""
        if self._steps.is_sample(step):
            self._taken.append(step)
            self._states.append((_copy(position), _copy(velocity), _copy(spin)))

    def record(self) -> Record:
        """Returns the stored samples as a record."""
        position, velocity, spin = (np.array(part) for part in zip(*self._states, strict=True))
        return Record(np.array(self._taken, dtype=np.int64), position, velocity, spin)


def _copy(array: ArrayLike) -> Floats:
    copied = np.array(array, dtype=np.float64)
    return copied.reshape((-1, 3))
