"""Many grains on planes: linear springs with dashpots and Coulomb friction, by leap-frog."""

from itertools import product

import numpy as np

import grainbench as gb


@gb.solver(dimension=[2, 3], laws=["linear"], effects=["friction", "contact-damping"])
def grains(scene: gb.Scene, steps: gb.Steps) -> gb.Record:
    count, walls, dt = len(scene.mass), scene.walls, steps.time_step
    mass, inertia, x, v, spin = scene.mass[:, None], scene.inertia[:, None], scene.position, scene.velocity, scene.spin
    skin = 0.3 * scene.radius.min()
    # Walls follow the grains and have no radius. `skin` is the gap up to which pairs are listed.
    radius, inverse = (np.append(part, np.zeros(len(walls))) for part in (scene.radius, 1 / scene.mass))
    names, material = np.unique(scene.material + [wall.material for wall in walls], return_inverse=True)
    keys = ["normal_stiffness", "tangential_stiffness", "normal_damping", "tangential_damping", "stiffness_damping", "friction"]
    laws = [scene.laws.get(frozenset(pair)) for pair in product(names, names)]
    table = np.array([[getattr(law, key, 0.0) for key in keys] for law in laws])
    planes = [[wall.geometry["point"], wall.geometry["normal"]] for wall in walls]
    points, normals = np.array(planes).reshape(-1, 2, 3).transpose(1, 0, 2)
    still, pairs, springs, start = np.zeros((len(walls), 3)), np.zeros((0, 2), dtype=int), np.zeros((0, 3)), np.inf

    def dot(one, other):
        return (one * other).sum(axis=1, keepdims=True)

    def search():
        """Lists pairs of a grain `a` with a later grain or a wall `b`, and the springs of pairs listed before."""
        cell = np.floor((x - x.min(axis=0)) / (2 * scene.radius.max() + skin)).astype(int) + 1
        stride = np.cumprod([1, *cell.max(axis=0) + 2])[:3]
        order = np.argsort(cell @ stride)
        found = [np.argwhere(((x[:, None] - points) * normals).sum(axis=2) < scene.radius[:, None] + skin) + [0, count]]
        for there in (cell @ stride + np.dot(shift, stride) for shift in product((-1, 0, 1), repeat=3)):
            first, last = (np.searchsorted(cell @ stride, there, side, order) for side in ("left", "right"))
            a, end = np.repeat(np.arange(count), last - first), np.cumsum(last - first)
            b = order[np.arange(len(a)) + np.repeat(last - end, last - first)]
            reach = radius[a] + radius[b] + skin
            found.append(np.stack([a, b], axis=1)[(a < b) & (dot(x[a] - x[b], x[a] - x[b])[:, 0] < reach * reach)])
        found = np.vstack(found)
        found, kept = found[np.lexsort(found.T)], np.zeros((len(found), 3))
        new, old = found @ [1, len(radius)], pairs @ [1, len(radius)]
        kept[np.isin(new, old)] = springs[np.isin(old, new)]
        return found, kept

    def loads(step):
        nonlocal springs, pairs, start
        if np.abs(x - start).max() > 0.25 * skin:
            (pairs, springs), start = search(), x
        a, b = pairs.T
        k, kt, c, ct, beta, mu = table[material[a] * len(names) + material[b]].T
        c, ct = c / (inverse[a] + inverse[b]), ct / (inverse[a] + inverse[b])
        is_wall, arms, normal = (b >= count)[:, None], radius[pairs.T][:, :, None], np.vstack([x, normals])[b]
        place, speed, turn = np.vstack([x, points]), np.vstack([v, still]), np.vstack([spin, still])
        apart = place[a] - place[b]
        distance = np.where(is_wall, dot(apart, normal), np.sqrt(dot(apart, apart)))
        n = np.where(is_wall, normal, apart / np.where(distance == 0, 1, distance))
        overlap = arms[0] + arms[1] - distance
        slip = speed[a] - speed[b] - np.cross(arms[0] * turn[a] + arms[1] * turn[b], n)
        closing = dot(slip, n)
        slip = slip - closing * n
        push = k[:, None] * overlap - (c + beta * k)[:, None] * closing
        # The spring turns with its contact and keeps its length.
        along = springs - dot(springs, n) * n
        along = along * np.sqrt(dot(springs, springs) / np.maximum(dot(along, along), 1e-300))
        spring, drag = along + kt[:, None] * step * slip, (ct + beta * kt)[:, None] * slip
        friction = -spring - drag
        size = np.sqrt(dot(friction, friction))
        factor = np.minimum(1, mu[:, None] * np.maximum(push, 0) / np.where(size == 0, 1, size))
        friction, touches = factor * friction, overlap > 0
        springs = np.where(touches, np.where(factor < 1, -friction - drag, spring), 0)
        force, moment = np.where(touches, push * n + friction, 0), np.where(touches, -np.cross(n, friction), 0)
        forces, torques = np.zeros((2, count + len(walls), 3))
        np.add.at(forces, a, force), np.add.at(forces, b, -force)
        np.add.at(torques, a, arms[0] * moment), np.add.at(torques, b, arms[1] * moment)
        return 0.5 * dt * (forces[:count] / mass + scene.gravity), 0.5 * dt * torques[:count] / inertia, force

    recorder, (kick, turn, force) = gb.Recorder(scene), loads(0.0)
    for step in range(steps.count + 1):
        if step > 0:
            v, spin, x = v + kick, spin + turn, x + dt * (v + kick)
            kick, turn, force = loads(dt)
            v, spin = v + kick, spin + turn
        if recorder.is_due(step):
            (a, b), on_grains, is_pair = pairs.T, np.zeros((len(walls), count, 3)), pairs[:, 1] < count
            on_grains[b[~is_pair] - count, a[~is_pair]] = force[~is_pair]
            wall_force = {wall.name: forces for wall, forces in zip(walls, on_grains)}
            recorder.take(step, x, v, spin, contacts=(pairs[is_pair] + 1, force[is_pair]), wall_force=wall_force)
    return recorder.record()
