"""Bodies of grainbench that deform, in the plane: a plain material point method on taichi's kernel language (MLS-MPM, APIC).

Plane strain, quadratic B-splines; forces and velocity gradients by the affine matrix of a point. Velocities stand half a step
before places: the first step is kicked by half, and a sample has the mean of the velocities before and after it.

There is one field of velocities for all bodies: what meets is welded, and parts only where the grid no longer joins it. That is
right for like bodies that meet head-on, up to when they would part. Where bodies meet that differ, turn or rub, it is refused.

A wall is a condition at the nodes on and behind its plane: velocity into it is taken away, and of that along it as much as
friction times that allows; there is no tension. It acts on all that reaches such a node, from a cell and a half away.

A side that is held is a mirror: nodes beyond it belong to images with reversed velocities (where it slides, reversed across it),
so that a field linear in the distance is kept. With nodes at rest on and beyond it the error would be of first order in a cell.
"""

from math import ceil

import numpy as np
import taichi as ti
from bodies import extent, parts_of, row_of, serve, things_of
from serve import Cannot

ti.init(arch=ti.cpu, default_fp=ti.f64, cpu_max_num_threads=1, offline_cache=False, log_level=ti.WARN)
vec, mat, kinds = ti.types.vector(2, ti.f64), ti.types.matrix(2, 2, ti.f64), ti.types.matrix(2, 2, ti.i32)
Vectors, Vectors2, Matrices = (ti.types.ndarray(dtype=kind, ndim=n) for kind, n in ((vec, 1), (vec, 2), (mat, 1)))
Numbers, Rows = ti.types.ndarray(dtype=ti.f64, ndim=1), ti.types.ndarray(dtype=ti.f64, ndim=2)


@ti.func
def spread(at, top):
    """The first of the nodes around a place in units of cells, what the place lies beyond it, and weights by node and axis."""
    base = ti.max(0, ti.min(ti.floor(at - 0.5, ti.i32), top - 3))
    beyond = at - base
    return base, beyond, 0.5 * (1.5 - beyond) ** 2, 0.75 - (beyond - 1.0) ** 2, 0.5 * (beyond - 0.5) ** 2


@ti.func
def mirrored(node, held, edge):
    """The node that a node stands for, the signs of its velocity, and whether it lies beyond a side that is held."""
    sign, beyond = vec(1.0), False
    for axis, side in ti.static(ti.ndrange(2, 2)):
        if held[axis, side] > 0 and (edge[axis, side] - node[axis]) * (1 - 2 * side) > 0:
            node[axis], beyond = 2 * edge[axis, side] - node[axis], True
            sign[axis] = -sign[axis]
            if held[axis, side] == 2:
                sign[1 - axis] = -sign[1 - axis]
    return node, sign, beyond


@ti.func
def kept(velocity, node, held, edge, walls: ti.template(), moving):
    """The velocity of a node, with what sides and walls take away."""
    for axis, side in ti.static(ti.ndrange(2, 2)):
        if held[axis, side] > 0 and node[axis] == edge[axis, side]:
            velocity[axis] = 0.0
            if held[axis, side] == 2:
                velocity[1 - axis] = 0.0
    for one in range(walls.shape[0]):
        normal, own = vec(walls[one, 0], walls[one, 1]), moving * vec(walls[one, 2], walls[one, 3])
        into = (velocity - own).dot(normal)
        if normal.dot(node) <= walls[one, 4] and into < 0.0:
            along = velocity - own - into * normal
            speed = along.norm()
            velocity = own
            if speed > -walls[one, 5] * into:
                velocity += along * (1.0 + walls[one, 5] * into / speed)
    return velocity


@ti.kernel
def steps(count: int, x: Vectors, v: Vectors, c: Matrices, f: Matrices, stress: Matrices, across: Numbers, law: Rows,
          masses: Rows, field: Vectors2, walls: Rows, held: kinds, edge: kinds, low: vec, gravity: vec, damping: float, h: float,
          kick: float, dt: float, moving: float):
    """Steps of dt, in which forces act for the time kick. Rows of law: bulk and shear modulus, whether in rates, volume, mass."""
    top, unit = ti.Vector([field.shape[0], field.shape[1]]), ti.Matrix.identity(float, 2)
    ti.loop_config(serialize=True)
    for _ in range(count):
        for i, j in ti.ndrange(top[0], top[1]):
            masses[i, j], field[i, j] = 0.0, vec(0.0)
        for p in range(x.shape[0]):
            base, beyond, w0, w1, w2 = spread((x[p] - low) / h, top)
            pull = -kick * law[p, 3] * f[p].determinant() * 4.0 / h**2 * stress[p]
            for i, j in ti.static(ti.ndrange(3, 3)):
                weight, away = (w0, w1, w2)[i][0] * (w0, w1, w2)[j][1], (vec(i, j) - beyond) * h
                momentum = law[p, 4] * ((1.0 - 0.5 * kick * damping) * (v[p] + c[p] @ away) + kick * gravity) + pull @ away
                node = base + ti.Vector([i, j])
                masses[node] = masses[node] + weight * law[p, 4]
                field[node] = field[node] + weight * momentum
        for i, j in ti.ndrange(top[0], top[1]):
            node, sign, beyond = mirrored(ti.Vector([i, j]), held, edge)
            if beyond and masses[i, j] > 0.0:
                masses[node] = masses[node] + masses[i, j]
                field[node] = field[node] + sign * field[i, j]
        for i, j in ti.ndrange(top[0], top[1]):
            if masses[i, j] > 0.0:
                velocity = field[i, j] / (masses[i, j] * (1.0 + 0.5 * kick * damping))
                field[i, j] = kept(velocity, ti.Vector([i, j]), held, edge, walls, moving)
        for i, j in ti.ndrange(top[0], top[1]):
            node, sign, beyond = mirrored(ti.Vector([i, j]), held, edge)
            if beyond and masses[i, j] > 0.0:
                field[i, j] = sign * field[node]
        for p in range(x.shape[0]):
            base, beyond, w0, w1, w2 = spread((x[p] - low) / h, top)
            velocity, gradient = vec(0.0), mat(0.0)
            for i, j in ti.static(ti.ndrange(3, 3)):
                part = (w0, w1, w2)[i][0] * (w0, w1, w2)[j][1] * field[base + ti.Vector([i, j])]
                velocity += part
                gradient += 4.0 / h * part.outer_product(vec(i, j) - beyond)
            x[p] += dt * velocity
            v[p], c[p] = velocity, gradient
            f[p] = (unit + dt * gradient) @ f[p]
            shear, lame, jacobian = law[p, 1], law[p, 0] - 2.0 / 3.0 * law[p, 1], f[p].determinant()
            if law[p, 2] > 0.0:
                turn = ti.math.rotation2d(0.5 * dt * (gradient[1, 0] - gradient[0, 1]))
                rate = lame * gradient.trace() * unit + shear * (gradient + gradient.transpose())
                stress[p] = turn @ stress[p] @ turn.transpose() + dt * rate
                across[p] += dt * lame * gradient.trace()
            else:
                across[p] = lame * ti.log(jacobian) / jacobian
                stress[p] = across[p] * unit + shear / jacobian * (f[p] @ f[p].transpose() - unit)


def walls_of(scene, touching):
    """A row for each wall: its normal, its velocity, its place along the normal, and friction."""
    rows, time = [], scene["steps"]["count"] * scene["steps"]["time_step"]
    for wall in scene["walls"]:
        normal, velocity = np.array(wall["plane"]["normal"]), np.zeros(3)
        for phase in wall["motion"]:
            velocity += phase["velocity"]
            if any(phase["spin"]) or phase["start"] > 0 or phase.get("stop", time) < time or velocity @ normal:
                raise Cannot("walls stay on their nodes here: they move along themselves, at one velocity, or not at all")
        frictions = {friction for one, friction, _ in touching if one is wall}
        if len(frictions) > 1:
            raise Cannot("a wall that is not the same to all bodies")
        rows.append([*normal[:2], *velocity[:2], normal @ wall["plane"]["point"], *frictions])
    return np.array(rows).reshape(-1, 6)


class Run:
    """The points of all bodies, and their grid."""

    def __init__(self, scene):
        self.things, anchor, touching = things_of(scene)
        self.scene, self.h, first = scene, scene["grid"]["cell"], self.things[0]
        self.x = np.vstack([thing.x for thing in self.things])
        laws = [[thing.law["bulk_modulus"], thing.law["shear_modulus"], thing.law["constitutive"] == "hypoelastic",
                 thing.volume / len(thing.x), thing.mass / len(thing.x)] for thing in self.things]
        self.law = np.repeat(np.array(laws, float), [len(thing.x) for thing in self.things], axis=0)
        self.v, self.c = np.zeros_like(self.x), np.zeros((len(self.x), 2, 2))
        self.f, self.stress, self.across = self.c + np.eye(2), self.c.copy(), np.zeros(len(self.x))
        low, high = extent(scene, self.things, anchor)
        self.low, size, walls = anchor + self.h * low, high - low, walls_of(scene, touching)
        walls[:, 4] = np.round((walls[:, 4] - walls[:, :2] @ self.low) / self.h)
        held = [[("free", "sliding", "fixed").index(side) for side in sides] for sides in first.sides[:2]]
        edge = np.round((first.ends - self.low) / self.h).astype(int).T.tolist()
        self.grid = np.zeros(size), np.zeros((*size, 2)), walls, kinds(held), kinds(edge), vec(self.low)

    def go(self, count, kick=1.0, settle=None):
        """Steps, in which forces act for a part of the time; before the clock starts, walls stand still."""
        dt, gravity = self.scene["steps"]["time_step"], vec((settle or self.scene)["gravity"][:2])
        damping = settle["damping"] if settle else self.scene["global_damping"]
        steps(count, self.x, self.v, self.c, self.f, self.stress, self.across, self.law, *self.grid, gravity, damping, self.h,
              kick * dt, dt, float(settle is None))
        if not ((self.x > self.low + self.h) & (self.x < self.low + self.h * (np.array(self.grid[0].shape) - 2))).all():
            raise FloatingPointError("points left the grid")

    def elastic_energy(self):
        """What the points have stored: by the stress where the law is in rates, else by the stretch."""
        bulk, shear, rates, volume, _ = self.law.T
        jacobian, mean = np.linalg.det(self.f), (np.trace(self.stress, axis1=1, axis2=2) + self.across) / 3
        squared, stretch = (self.stress**2).sum(axis=(1, 2)) + self.across**2 - 3 * mean**2, (self.f**2).sum(axis=(1, 2))
        hooke = jacobian * (mean**2 / (2 * bulk) + squared / (4 * shear))
        neo = (bulk / 2 - shear / 3) * np.log(jacobian) ** 2 + shear * (stretch / 2 - 1 - np.log(jacobian))
        return volume @ np.where(rates > 0, hooke, neo)


def samples(scene):
    """Settles, starts the clock, and gives the samples."""
    run, settle, count, every = Run(scene), scene.get("settle"), scene["steps"]["count"], scene["steps"]["sample_every"]
    start = run.x.copy()
    if settle:
        run.go(ceil(settle["duration"] / scene["steps"]["time_step"]), settle=settle)
    for thing, part in zip(run.things, parts_of(run.things)):
        run.v[part], run.c[part] = thing.launch(run.x[part])
    for step in sorted({*range(0, count, every), count}):
        x, v, elastic = run.x.copy(), run.v.copy(), run.elastic_energy()
        stress = np.column_stack([run.stress[:, 0, 0], run.stress[:, 1, 1], run.stress[:, 0, 1], run.across])
        run.go(1, kick=1.0 if step else 0.5)
        v = (v + run.v) / 2 if step else v
        yield step, *row_of(scene, run.things, run.law[:, 4], (start, x, v, stress, elastic))
        run.go(max(min(every, count - step) - 1, 0))


serve(samples)
