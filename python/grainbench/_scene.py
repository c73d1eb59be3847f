"""Resolved scene that a solver receives, as arrays in SI units."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Steps:
    """Time step, number of steps, and steps between samples."""

    time_step: float
    """Δt (s)."""
    count: int
    """Number of steps."""
    sample_every: int
    """Steps between samples. The first sample is at the start and the last at the end."""
    critical_time_step: float | None
    """Critical time step 2√(m_min/k_max) (s); None if the scene has none."""

    def is_sample(self, step: int) -> bool:
        """Returns True if a sample is due after `step` steps."""
        return step % self.sample_every == 0 or step == self.count

    @property
    def samples(self) -> NDArray[np.int64]:
        """Steps of all samples, shape (samples,)."""
        steps = list(range(0, self.count, self.sample_every))
        return np.array([*steps, self.count], dtype=np.int64)


@dataclass(frozen=True)
class Law:
    """Contact law of two materials. Parameters that the law does not use are zero."""

    kind: str
    """`linear`, `hertz-mindlin` or `coulomb`."""
    normal_stiffness: float
    """Normal stiffness k_n of linear springs (N/m)."""
    tangential_stiffness: float
    """Tangential stiffness k_s of linear springs (N/m)."""
    effective_modulus: float
    """Effective Young's modulus E* of Hertz contacts (Pa)."""
    effective_shear_modulus: float
    """Effective shear modulus G* of Mindlin contacts (Pa)."""
    friction: float
    """Friction coefficient μ."""
    cohesion: float
    """Cohesion c (N) with |F_s| ≤ μ F_n + c."""
    stiffness_damping: float
    """Damping time β (s) of the dashpots β k_n and β k_s."""
    normal_damping: float
    """Normal damping rate γ_n (1/s) of the dashpot γ_n m_eff."""
    tangential_damping: float
    """Tangential damping rate γ_t (1/s) of the dashpot γ_t m_eff."""
    restitution: float
    """Coefficient of restitution e; 1 if the scene has none."""
    rolling_friction: float
    """Rolling friction coefficient μ_r; the rolling moment is at most μ_r R_eff F_n."""
    rolling_damping: float
    """Damping ratio of the rolling spring."""

    @classmethod
    def _of(cls, law: dict[str, Any]) -> Law:
        numbers = [name for name in cls.__dataclass_fields__ if name != "kind"]
        usual = {"restitution": 1.0}
        return cls(kind=law["law"], **{name: float(law.get(name, usual.get(name, 0.0))) for name in numbers})


@dataclass(frozen=True)
class Wall:
    """Wall in its initial state."""

    name: str
    material: str
    shape: str
    """`plane`, `segment`, `rectangle`, `round` or `mesh`."""
    geometry: dict[str, Floats]
    """Geometry of the shape, with lengths in m.

    A plane has `point` (3,) and `normal` (3,) out of the solid; a segment `ends` (2, 3); a rectangle `corner` (3,) and
    `edges` (2, 3); a round wall `axis` (2, 3) and `radii` (2,); a mesh `triangles` (n, 3, 3).
    """
    centre: Floats
    """Centre of rotation (m), shape (3,). It moves with the wall."""
    motion: list[dict[str, Any]]
    """Superposed motions with `velocity` (m/s), `spin` (rad/s) and `start` (s).

    A motion that ends before the run also has `stop` (s).
    """

    @classmethod
    def _of(cls, wall: dict[str, Any]) -> Wall:
        shape = next(name for name in ("plane", "segment", "rectangle", "round", "mesh") if name in wall)
        said = wall[shape]
        parts = {"segment": {"ends": said}, "mesh": {"triangles": said}}.get(shape, said)
        geometry = {name: np.array(part, dtype=np.float64) for name, part in parts.items()}
        centre = np.array(wall["centre"], dtype=np.float64)
        return cls(wall["name"], wall["material"], shape, geometry, centre, wall["motion"])


@dataclass(frozen=True)
class Scene:
    """Resolved scene in SI units; masses of discs are per metre of depth.

    Vectors have three components. Two-dimensional scenes use x and y for positions, and z for spins.
    """

    title: str
    dimension: int
    grain_shape: str
    """`disc` or `sphere`."""
    effects: list[str]
    """Effects that the scene needs, such as `friction` or `contact-damping`."""
    gravity: Floats
    """Gravitational acceleration (m/s²), shape (3,)."""
    global_damping: float
    """Global damping rate α (1/s), with a force −α m v and a torque −α I ω on each grain."""
    domain: dict[str, Any] | None
    """Box with corners `low` and `high` (m) and the `periodic` axes; None without a box."""
    radius: Floats
    """Radii (m), shape (grains,)."""
    mass: Floats
    """Masses (kg), shape (grains,)."""
    inertia: Floats
    """Moments of inertia (kg m²), shape (grains,)."""
    position: Floats
    """Initial positions (m), shape (grains, 3)."""
    velocity: Floats
    """Initial velocities (m/s), shape (grains, 3)."""
    spin: Floats
    """Initial angular velocities (rad/s), shape (grains, 3)."""
    material: list[str]
    """Material of each grain."""
    walls: list[Wall]
    laws: dict[frozenset[str], Law]
    """Contact laws by pair of materials; see `law`."""
    driven: list[dict[str, Any]]
    """Groups with prescribed motion: `grains` by number from 1, and `velocity` (m/s)."""
    steps: Steps
    raw: dict[str, Any]
    """Complete content of the file; `grainbench scene --schema=resolved` describes it."""

    def law(self, first: str, second: str) -> Law:
        """Returns the contact law of two materials."""
        return self.laws[frozenset((first, second))]

    @classmethod
    def read(cls, path: str | Path) -> Scene:
        """Reads a resolved scene, as `grainbench scene CASE` prints it."""
        return cls._of(Path(path).read_text(encoding="utf-8"), str(path))

    @classmethod
    def _of(cls, text: str, name: str) -> Scene:
        raw = json.loads(text)
        if raw.get("format") != 1:
            raise ValueError(f"{name}: expected the format 1 of a resolved scene, found {raw.get('format')!r}")
        grains = raw["grains"]

        def column(name: str) -> Floats:
            values = np.array([grain[name] for grain in grains], dtype=np.float64)
            return values.reshape((len(grains), 3)) if name in ("position", "velocity", "spin") else values

        return cls(
            title=raw["title"],
            dimension=raw["dimension"],
            grain_shape=raw["grain_shape"],
            effects=raw["effects"],
            gravity=np.array(raw["gravity"], dtype=np.float64),
            global_damping=raw["global_damping"],
            domain=raw.get("domain"),
            radius=column("radius"),
            mass=column("mass"),
            inertia=column("inertia"),
            position=column("position"),
            velocity=column("velocity"),
            spin=column("spin"),
            material=[grain["material"] for grain in grains],
            walls=[Wall._of(wall) for wall in raw["walls"]],
            laws={frozenset(law["between"]): Law._of(law) for law in raw["laws"]},
            driven=raw["driven"],
            steps=Steps(
                time_step=raw["steps"]["time_step"],
                count=raw["steps"]["count"],
                sample_every=raw["steps"]["sample_every"],
                critical_time_step=raw["steps"].get("critical_time_step"),
            ),
            raw=raw,
        )
