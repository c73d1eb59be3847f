"""Bodies that deform, for programs that move points on one grid: their points, what one grid can express, and what is left."""

import csv
import os
from itertools import combinations
from math import isclose

import numpy as np
import serve as lines
from serve import Cannot


class Thing:
    """A body or a grain, in the plane: its extent, and what its points have in common."""

    def __init__(self, one, scene):
        self.law = next((each for each in scene["deformable"] if each["material"] == one["material"]), None)
        if self.law is None or self.law["constitutive"] not in ("hypoelastic", "neo-hookean"):
            raise Cannot("a material of another law than the hypoelastic and the neo-Hookean")
        self.wave, self.sides = one.get("wave"), one.get("sides", [["free"] * 2] * 2)
        shape = one.get("shape") or {"annulus": dict(centre=one["position"], inner=0.0, outer=one["radius"])}
        self.ring = shape.get("annulus")
        if self.ring:
            self.ends = np.add(self.ring["centre"][:2], self.ring["outer"] * np.array([[-1.0], [1.0]]))
            self.volume = np.pi * (self.ring["outer"] ** 2 - self.ring["inner"] ** 2)
        else:
            self.ends = np.array([shape["box"][end][:2] for end in ("low", "high")])
            self.volume = np.prod(self.ends[1] - self.ends[0])
        self.velocity, self.spin = np.array(one["velocity"][:2]), one.get("spin", [0.0] * 3)[2]
        self.mass = one["mass"] if "mass" in one else one["density"] * self.volume
        self.fastest = np.abs(self.velocity).max() + abs(self.spin) * np.ptp(self.ends[:, 0])
        self.fastest += self.wave["amplitude"] if self.wave else 0.0

    def fill(self, grid, anchor):
        """Points and what each spans: evenly spaced in a box; of something round, those of the grid's lattice that lie within."""
        low, size, gap = self.ends[0], self.ends[1] - self.ends[0], grid["cell"] / grid["points"]
        if self.ring:
            low = anchor + gap * np.floor((low - anchor) / gap)
            size = gap * np.ceil((self.ends[1] - low) / gap)
        counts = np.maximum(1, np.round(size / gap)).astype(int)
        axes = [start + side * (np.arange(n) + 0.5) / n for start, side, n in zip(low, size, counts)]
        self.x, self.span = np.stack(np.meshgrid(*axes, indexing="ij"), -1).reshape(-1, 2), size / counts
        if self.ring:
            away = np.linalg.norm(self.x - self.ends.mean(axis=0), axis=1)
            self.x = self.x[(away <= self.ring["outer"]) & (away >= self.ring["inner"])]

    def launch(self, x):
        """Velocities at the start of the clock, and their gradients."""
        skew = self.spin * np.array([[0.0, -1.0], [1.0, 0.0]])
        v, c = self.velocity + (x - x.mean(axis=0)) @ skew.T, np.tile(skew, (len(x), 1, 1))
        if self.wave:
            number, phase = self.wave["wave_number"], self.wave["wave_number"] * (x[:, 0] - self.ends[0, 0])
            v[:, 0] += self.wave["amplitude"] * np.sin(phase)
            c[:, 0, 0] += self.wave["amplitude"] * number * np.cos(phase)
        return v, c


def things_of(scene):
    """Bodies, then grains, filled; a place that is a node; and each wall with each thing, the friction between them."""
    if "grid" not in scene or scene["driven"] or any((scene.get("domain") or {}).get("periodic", ())):
        raise Cannot("neither grains that keep their shape, nor driven ones, nor periodic axes here")
    things = [Thing(one, scene) for one in scene.get("bodies", []) + scene["grains"]]
    if len(things) > 1 and any(side != "free" for thing in things for axis in thing.sides for side in axis):
        raise Cannot("a side is held for all bodies here, not for one of several")
    friction = {frozenset(law["between"]): law["friction"] for law in scene["laws"]}
    for a, b in combinations(things, 2):
        (x, y), (vx, vy) = (b.ends - a.ends).mean(axis=0), b.velocity - a.velocity
        aside = abs(x * vy - y * vx) > 1e-9 * np.hypot(x, y) * np.hypot(vx, vy)
        like = a.law is b.law and isclose(a.mass * b.volume, b.mass * a.volume)
        if aside or not like or a.spin or b.spin or friction.get(frozenset((a.law["material"],))) != 0.0:
            raise Cannot("bodies that touch are welded here: only like ones that meet head-on are expressed")
    touching = []
    for wall in scene["walls"]:
        if "plane" not in wall or max(np.abs(wall["plane"]["normal"])) < 1 - 1e-12:
            raise Cannot("a wall other than a plane along the axes")
        for thing in things:
            touching.append((wall, friction.get(frozenset((wall["material"], thing.law["material"]))), thing))
    if any(one is None for _, one, _ in touching):
        raise Cannot("a wall that a body may not touch")
    first, h = things[0], scene["grid"]["cell"]
    anchor = first.ends.mean(axis=0) if first.ring else first.ends[0].copy()
    for axis in range(2):
        kept = [wall["plane"]["point"][axis] for wall in scene["walls"] if abs(wall["plane"]["normal"][axis]) > 0.5]
        kept += [first.ends[end, axis] for end in range(2) if first.sides[axis][end] != "free"]
        anchor[axis] = [*kept, anchor[axis]][0]
        if any(abs((place - anchor[axis]) / h - round((place - anchor[axis]) / h)) > 1e-6 for place in kept):
            raise Cannot("walls and sides that are held lie on nodes here: a whole number of cells from each other")
    for thing in things:
        thing.fill(scene["grid"], anchor)
    return things, anchor, touching


def extent(scene, things, anchor):
    """Numbers of the first and the last node along each axis, counted from the anchor, that points can come near."""
    time, h = scene["steps"]["count"] * scene["steps"]["time_step"], scene["grid"]["cell"]
    x, phases = np.vstack([thing.x for thing in things]), [phase for wall in scene["walls"] for phase in wall["motion"]]
    speed = max(thing.fastest for thing in things) + sum(np.abs(phase["velocity"]).sum() for phase in phases)
    reach = speed * time + np.abs(scene["gravity"][:2]) * time**2 / 2 + 3 * h
    low, high = (x.min(axis=0) - reach - anchor) / h, (x.max(axis=0) + reach - anchor) / h
    return np.floor(low).astype(int), np.ceil(high).astype(int)


def parts_of(things):
    """Which points are whose."""
    ends = np.cumsum([0] + [len(thing.x) for thing in things])
    return [slice(*part) for part in zip(ends, ends[1:])]


def motion(x, v, mass):
    """Place, velocity, spin and moment of inertia of a body."""
    place, velocity = x.mean(axis=0), v.mean(axis=0)
    (ax, ay), (ux, uy) = (x - place).T, (v - velocity).T
    inertia = mass @ (ax**2 + ay**2)
    return [*place, *velocity, mass @ (ax * uy - ay * ux) / inertia, inertia]


def row_of(scene, things, mass, sample):
    """A row of the series, and the motions of the grains. Stresses are xx, yy, xy and, where it is known, zz."""
    start, x, v, stress, elastic = sample
    parts, bodies, row = parts_of(things), scene.get("bodies", []), {}
    names = [body["name"] for body in bodies] + [f"grain {grain['id']}" for grain in scene["grains"]]
    motions = [motion(x[part], v[part], mass[part]) for part in parts]
    kinetic, height = mass @ (v**2).sum(axis=1) / 2, -mass @ x @ scene["gravity"][:2]
    turning = sum(inertia * spin**2 / 2 for *_, spin, inertia in motions)
    energies = dict(kinetic_energy=kinetic - turning, rotational_energy=turning, elastic_energy=elastic)
    energies |= dict(gravitational_energy=height, total_energy=kinetic + elastic + height)
    row = {name: energies[name.split(".")[-1]] for name in scene["columns"] if name.split(".")[-1] in energies}
    for probe in scene.get("probes", []):
        part, found, words = parts[names.index(probe["of"])], motions[names.index(probe["of"])], "x y vx vy omega"
        if "at" in probe:
            away = np.linalg.norm(start[part] - probe["at"][:2], axis=1)
            near = part.start + np.flatnonzero(away < away.min() + 1e-6 * scene["grid"]["cell"])
            found = np.hstack([x - start, v, stress])[near].mean(axis=0)
            words = "ux uy vx vy sigma_xx sigma_yy sigma_xy sigma_zz"
        row |= {f"{probe['name']}.{word}": value for word, value in zip(words.split(), found)}
    return row, motions[len(bodies) :]


def serve(samples):
    """Answers requests; `samples` gives, for a scene, a step, a row of the series and motions of grains at a time."""

    def run(scene, out):
        with open(os.path.join(out, "series.csv"), "w") as series, open(os.path.join(out, "grains.csv"), "w") as grains:
            series, grains = csv.writer(series), csv.writer(grains)
            grains.writerow("step id x y z vx vy vz omegax omegay omegaz".split())
            for step, row, motions in samples(scene):
                series.writerows([[step, *row.values()]] if step else [["step", *row], [0, *row.values()]])
                for number, (x, y, vx, vy, spin, _) in enumerate(motions, 1):
                    grains.writerow([step, number, x, y, 0, vx, vy, 0, 0, 0, spin])

    # `things_of` says what cannot be expressed.
    lines.serve(run, refuse=lambda scene: None)
