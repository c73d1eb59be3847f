"""Many grains on planes: linear springs with dashpots and Coulomb friction, by leap-frog."""

import numpy as np

import grainbench as gb


@gb.solver(dimension=[2, 3], laws=["linear"], effects=["friction", "contact-damping"], driven=True)
def grains(scene: gb.Scene, steps: gb.Steps) -> gb.Record:
    count, walls, dt = len(scene.mass), scene.walls, steps.time_step
    mass, inertia, x, v, spin = scene.mass[:, None], scene.inertia[:, None], scene.position, scene.velocity, scene.spin
    is_free = np.ones((count, 1))
    for group in scene.driven:
        moved = np.array(group["grains"]) - 1
        is_free[moved], v[moved], spin[moved] = 0, group["velocity"], 0
    # Possible contacts of a grain `a` with a later grain or a wall `b`. Walls follow the grains and have no radius.
    pairs = [(a, b) for a in range(count) for b in range(a + 1, count + len(walls))]
    a, b = np.array(pairs, dtype=int).reshape(-1, 2).T
    material, radius = scene.material + [wall.material for wall in walls], np.append(scene.radius, np.zeros(len(walls)))
    laws = [scene.law(material[one], material[other]) for one, other in pairs]
    keys = ["normal_stiffness", "tangential_stiffness", "normal_damping", "tangential_damping", "stiffness_damping", "friction"]
    k, kt, c, ct, beta, mu = (np.array([getattr(law, key) for law in laws]) for key in keys)
    inverse = np.append(1 / scene.mass, np.zeros(len(walls)))
    c, ct = c / (inverse[a] + inverse[b]), ct / (inverse[a] + inverse[b])
    planes = [[wall.geometry["point"], wall.geometry["normal"]] for wall in walls]
    points, normals = np.array(planes).reshape(-1, 2, 3).transpose(1, 0, 2)
    still, is_wall = np.zeros((len(walls), 3)), (b >= count)[:, None]
    normal = np.vstack([np.zeros((count, 3)), normals])[b]
    arms, springs = np.stack([radius[a], radius[b]])[:, :, None], np.zeros((len(pairs), 3))

    def dot(one, other):
        return (one * other).sum(axis=1, keepdims=True)

    def loads(step):
        nonlocal springs
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
        half = 0.5 * dt * is_free
        return half * (forces[:count] / mass + scene.gravity), half * torques[:count] / inertia

    recorder, (kick, turn) = gb.Recorder(scene), loads(0.0)
    recorder.take(0, x, v, spin)
    for step in range(1, steps.count + 1):
        v, spin, x = v + kick, spin + turn, x + dt * (v + kick)
        kick, turn = loads(dt)
        v, spin = v + kick, spin + turn
        recorder.take(step, x, v, spin)
    return recorder.record()
