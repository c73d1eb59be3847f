"""One grain on planes: linear springs with dashpots and Coulomb friction, by leap-frog."""

import numpy as np

import grainbench as gb


def cross(a, b):
    return a[[1, 2, 0]] * b[[2, 0, 1]] - a[[2, 0, 1]] * b[[1, 2, 0]]


@gb.solver(dimension=[2, 3], laws=["linear"], effects=["friction", "contact-damping"])
def sphere(scene: gb.Scene, steps: gb.Steps) -> gb.Record:
    if len(scene.mass) != 1:
        raise gb.Cannot("it moves one grain")
    mass, inertia, radius, dt = scene.mass[0], scene.inertia[0], scene.radius[0], steps.time_step
    x, v, spin = scene.position[0], scene.velocity[0], scene.spin[0]
    springs = {wall.name: np.zeros(3) for wall in scene.walls}

    def loads(step):
        force, torque = mass * scene.gravity, np.zeros(3)
        for wall in scene.walls:
            law, n = scene.law(scene.material[0], wall.material), wall.geometry["normal"]
            overlap, arm = radius - (x - wall.geometry["point"]) @ n, -radius * n
            if overlap <= 0:
                springs[wall.name] = np.zeros(3)
                continue
            k, kt = law.normal_stiffness, law.tangential_stiffness
            c, ct = law.normal_damping * mass, law.tangential_damping * mass
            push = k * overlap - (c + law.stiffness_damping * k) * (v @ n)
            slip = v + cross(spin, arm)
            slip = slip - (slip @ n) * n
            spring, drag = springs[wall.name] + slip * step * kt, (ct + law.stiffness_damping * kt) * slip
            friction = -spring - drag
            factor = min(1.0, law.friction * max(push, 0.0) / ((friction @ friction) ** 0.5 or 1.0))
            friction, springs[wall.name] = factor * friction, spring if factor == 1.0 else -factor * friction - drag
            force, torque = force + push * n + friction, torque + cross(arm, friction)
        return 0.5 * dt / mass * force, 0.5 * dt / inertia * torque

    recorder, (kick, turn) = gb.Recorder(scene), loads(0.0)
    recorder.take(0, x, v, spin)
    for step in range(1, steps.count + 1):
        v, spin, x = v + kick, spin + turn, x + dt * (v + kick)
        kick, turn = loads(dt)
        v, spin = v + kick, spin + turn
        recorder.take(step, x, v, spin)
    return recorder.record()
