"""The scene that a solver is given: everything definite, in SI, as arrays."""

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
    """Time step, number of steps, and when samples are taken."""

    time_step: float
    """Δt (s)."""
    count: int
    """How many steps."""
    sample_every: int
    """Steps between samples. There is one at the start, and one at the end."""
    critical_time_step: float | None
    """2√(m_min/k_max) (s), where there is one."""

    def is_sample(self, step: int) -> bool:
        """Whether a sample is taken after so many steps."""
        return step % self.sample_every == 0 or step == self.count

    @property
    def samples(self) -> NDArray[np.int64]:
        """The steps of all samples, shape (samples,)."""
        steps = list(range(0, self.count, self.sample_every))
        return np.array([*steps, self.count], dtype=np.int64)


@dataclass(frozen=True)
class Law:
    """The law of a contact between two materials. Keys that a law does not have are zero."""

    kind: str
    """`linear`, `hertz-mindlin` or `coulomb`."""
    normal_stiffness: float
    """k_n (N/m), of linear springs."""
    tangential_stiffness: float
    """k_s (N/m), of linear springs."""
    effective_modulus: float
    """E* (Pa), of Hertz's law."""
    effective_shear_modulus: float
    """G* (Pa), of Mindlin's."""
    friction: float
    """μ."""
    cohesion: float
    """c (N): |F_s| ≤ μ F_n + c."""
    stiffness_damping: float
    """β (s): dashpots β k_n and β k_s."""
    normal_damping: float
    """γ_n (1/s): a dashpot γ_n m_eff."""
    tangential_damping: float
    """γ_t (1/s): a dashpot γ_t m_eff."""
    restitution: float
    """e; 1 where the scene gives none."""
    rolling_friction: float
    """μ_r: a moment of at most μ_r R_eff F_n."""
    rolling_damping: float
    """Damping ratio of the rolling spring."""

    @classmethod
    def _of(cls, law: dict[str, Any]) -> Law:
        numbers = [name for name in cls.__dataclass_fields__ if name != "kind"]
        usual = {"restitution": 1.0}
        return cls(kind=law["law"], **{name: float(law.get(name, usual.get(name, 0.0))) for name in numbers})


@dataclass(frozen=True)
class Wall:
    """A wall, at the start."""

    name: str
    material: str
    shape: str
    """`plane`, `segment`, `rectangle`, `round` or `mesh`."""
    geometry: dict[str, Floats]
    """Of a plane `point` (3,) (m) and `normal` (3,), out of the solid; of a segment `ends` (2, 3); of a rectangle `corner` (3,) and
    `edges` (2, 3); of a round one `axis` (2, 3) and `radii` (2,); of a mesh `triangles` (n, 3, 3)."""
    centre: Floats
    """Centre of rotation (m), shape (3,); it moves with the wall."""
    motion: list[dict[str, Any]]
    """Phases that add up: `velocity` (m/s), `spin` (rad/s), `start` (s) and, where it ends before the run, `stop` (s)."""

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
    """A scene. Lengths in m, times in s, masses in kg (of discs per metre of depth), angles in rad; vectors have three components, of
    which scenes in the plane use x and y for places and z for spins."""

    title: str
    dimension: int
    grain_shape: str
    """`disc` or `sphere`."""
    effects: list[str]
    """What the scene calls for: `friction`, `contact-damping`, …"""
    gravity: Floats
    """(m/s²), shape (3,)."""
    global_damping: float
    """α (1/s): a force −α m v and a torque −α I ω on every grain."""
    domain: dict[str, Any] | None
    """`low` and `high` (m), and which axes are `periodic`, where there is a box."""
    radius: Floats
    """(m), shape (grains,)."""
    mass: Floats
    """(kg), shape (grains,)."""
    inertia: Floats
    """(kg m²), shape (grains,)."""
    position: Floats
    """(m), shape (grains, 3)."""
    velocity: Floats
    """(m/s), shape (grains, 3)."""
    spin: Floats
    """(rad/s), shape (grains, 3)."""
    material: list[str]
    """Of each grain."""
    walls: list[Wall]
    laws: dict[frozenset[str], Law]
    """By the materials of a contact: see `law`."""
    driven: list[dict[str, Any]]
    """Groups that are moved whatever the forces on them: `grains` by their numbers from 1, `velocity` (m/s)."""
    steps: Steps
    raw: dict[str, Any]
    """All that the file says: `grainbench schema --resolved`."""

    def law(self, first: str, second: str) -> Law:
        """The law between two materials."""
        return self.laws[frozenset((first, second))]

    @classmethod
    def read(cls, path: str | Path) -> Scene:
        """Reads a scene as `grainbench scene CASE` prints it."""
        with open(path, encoding="utf-8") as file:
            raw = json.load(file)
        if raw.get("format") != 1:
            raise ValueError(f"{path}: expected the format 1 of a resolved scene, found {raw.get('format')!r}")
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
