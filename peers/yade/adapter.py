"""Scenes of grainbench in Yade 2023.02: linear springs, dashpots where one number fits all, Hertz, planes along the axes.

Yade's velocities stand half a step before its positions: they are started there and averaged for samples. Discs are spheres that
cannot leave the plane, with the disc's mass and moment of inertia.
"""

import csv
import os
from math import atan, sqrt

from serve import Cannot, hertz, mean_velocity, near, serve
from yade import O, Vector3
from yade.utils import sphere, wall
from yade.wrapper import *

AXES = "xyz"


def plane_axis(shape):
    """The axis (0, 1, 2) along which a plane's normal lies, and its sense."""
    normal = shape["normal"]
    for axis in range(3):
        if abs(abs(normal[axis]) - 1) < 1e-12:
            return axis, 1 if normal[axis] > 0 else -1
    raise Cannot("its walls stand along the axes")


def dashpots(law):
    """c_n and c_s of a grain's material by its mass, and of a wall's (N s/m).

    Two materials are in series here, and zero stands for rigid. So dashpots in units of the mass come out as those of the
    reduced mass, the grain's own at a wall; those in units of the stiffness are twice the pair's.
    """
    by_mass, beta = (law["normal_damping"], law["tangential_damping"]), law["stiffness_damping"]
    if any(by_mass) and beta:
        raise Cannot("dashpots in units of the mass or of the stiffness, not both")
    of_stiffness = [2 * beta * law[name] for name in ("normal_stiffness", "tangential_stiffness")]
    return lambda mass: [gamma * mass for gamma in by_mass] if any(by_mass) else of_stiffness


def hertzian(scene, bearers, walls):
    """Hertz's law, whose walls have the radius of the sphere: R/2 stands for R, and moduli larger by the root of 2 make it up.

    A coefficient `en` alone brings a shear dashpot along, which `es` of 1 takes away and `betas` of 0 does not.
    """
    law, young, poisson = hertz(scene)
    if walls and len(scene["grains"]) > 1:
        raise Cannot("spheres that meet a plane have other moduli here than spheres that meet one another")
    words = dict(density=1, young=young * (sqrt(2) if walls else 1), poisson=poisson, frictionAngle=atan(law["friction"]))
    material = O.materials.append(FrictMat(label="all", **words))
    dashpot = dict(en=law["restitution"], es=1) if "restitution" in law else {}
    physics = Ip2_FrictMat_FrictMat_MindlinPhys(**dashpot)
    return {bearer: material for bearer in bearers}, [physics], [Law2_ScGeom_MindlinPhys_Mindlin()]


def engines(scene, reached):
    """The contact law, and a material by the name of the scene's and the mass: none of a wall."""
    laws = {frozenset(law["between"]): law for law in scene["laws"]}
    bearers = {(grain["material"], grain["mass"]) for grain in scene["grains"]}
    bearers |= {(one["material"], 0.0) for one in scene["walls"]}
    if any(law["law"] == "hertz-mindlin" for law in laws.values()):
        return hertzian(scene, bearers, reached)
    dampings = ("stiffness_damping", "normal_damping", "tangential_damping")
    if any(law[name] for law in laws.values() for name in dampings):
        if len(laws) != 1:
            raise Cannot("dashpots belong to a material: one law for all contacts")
        (law,) = laws.values()
        of_mass = dashpots(law)
        words = dict(density=1, frictionAngle=atan(law["friction"]))
        words |= dict(kn=2 * law["normal_stiffness"], ks=2 * law["tangential_stiffness"])
        materials = {}
        for name, mass in bearers:
            normal, tangential = of_mass(mass)
            materials[name, mass] = O.materials.append(ViscElMat(label=f"{name} {mass}", cn=normal, cs=tangential, **words))
        return materials, [Ip2_ViscElMat_ViscElMat_ViscElPhys()], [Law2_ScGeom_ViscElPhys_Basic()]
    own = {name: O.materials.append(FrictMat(label=name, density=1)) for name, _ in sorted(bearers)}
    tables = {"kn": [], "ks": [], "frictAngle": []}
    for law in laws.values():
        pair = [own[name] for name in law["between"] * (3 - len(law["between"]))][:2]
        tables["kn"].append((*pair, law["normal_stiffness"]))
        tables["ks"].append((*pair, law["tangential_stiffness"]))
        tables["frictAngle"].append((*pair, atan(law["friction"])))
    matches = {name: MatchMaker(matches=rows) for name, rows in tables.items()}
    materials = {(name, mass): own[name] for name, mass in bearers}
    return materials, [Ip2_FrictMat_FrictMat_FrictPhys(**matches)], [Law2_ScGeom_FrictPhys_CundallStrack()]


def build(scene):
    """Bodies and engines; gives the grains' bodies, the walls' and the driven ones' velocities."""
    O.reset()
    is_hertz = any(law["law"] == "hertz-mindlin" for law in scene["laws"])
    reached = [one for one in scene["walls"] if not is_hertz or near(scene, one)]
    materials, physics, law = engines(scene, reached)
    grains = []
    for grain in scene["grains"]:
        body = sphere(Vector3(*grain["position"]), grain["radius"], material=materials[grain["material"], grain["mass"]])
        body.state.mass, body.state.inertia = grain["mass"], Vector3(1, 1, 1) * grain["inertia"]
        body.state.vel, body.state.angVel = Vector3(*grain["velocity"]), Vector3(*grain["spin"])
        if scene["dimension"] == 2:
            body.state.blockedDOFs = "zXY"
        grains.append(O.bodies.append(body))
    for group in scene["driven"]:
        for number in group["grains"]:
            state = O.bodies[grains[number - 1]].state
            state.blockedDOFs, state.vel, state.angVel = "xyzXYZ", Vector3(*group["velocity"]), Vector3(0, 0, 0)
    walls = []
    for one in reached:
        axis, sense = plane_axis(one["plane"])
        plane = wall(one["plane"]["point"][axis], axis, sense, material=materials[one["material"], 0.0])
        walls.append((O.bodies.append(plane), one))
    smallest = min(grain["radius"] for grain in scene["grains"])
    O.engines = [
        ForceResetter(),
        InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()], verletDist=0.05 * smallest),
        InteractionLoop([Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()], physics, law),
        NewtonIntegrator(gravity=Vector3(*scene["gravity"]), damping=0),
    ]
    return grains, walls


def start(grains, gravity, dt):
    """Velocities half a step before the start: forces are found without moving anything."""
    O.dt = 1e-300
    O.step()
    for number in grains:
        state = O.bodies[number].state
        free = state.blockedDOFs != "xyzXYZ"
        if free and state.mass > 0:
            state.vel = state.vel - (O.forces.f(number) / state.mass + gravity) * (0.5 * dt)
            turn = O.forces.t(number) * (0.5 * dt)
            state.angVel = state.angVel - Vector3(*(turn[axis] / state.inertia[axis] for axis in range(3)))
            for axis, name in enumerate(AXES):
                if name in state.blockedDOFs:
                    state.vel[axis] = 0
                if name.upper() in state.blockedDOFs:
                    state.angVel[axis] = 0
    O.dt = dt


def move(walls, time, dt):
    """The walls' velocities over the step that follows."""
    for number, one in walls:
        O.bodies[number].state.vel = Vector3(*mean_velocity(one, time, time + dt))


def advance(steps):
    """Waiting for `O.run` takes until the next look at it, some 40 ms; a step from here costs microseconds."""
    if steps > 20000:
        O.run(steps, True)
    else:
        for _ in range(steps):
            O.step()


def run(scene, out):
    """Steps through the scene and leaves the grains at every sample."""
    grains, walls = build(scene)
    steps, dt = scene["steps"], scene["steps"]["time_step"]
    start(grains, Vector3(*scene["gravity"]), dt)
    states = [O.bodies[number].state for number in grains]
    phases = [phase for _, one in walls for phase in one["motion"]]
    moments = {phase[key] for phase in phases for key in ("start", "stop") if key in phase}
    within = {int(moment / dt) + after for moment in moments for after in (0, 1)}
    turns = {step for step in within if step <= steps["count"]}
    stops = sorted({*range(0, steps["count"], steps["sample_every"]), steps["count"], *turns})
    taken = 0
    with open(os.path.join(out, "grains.csv"), "w", newline="") as file:
        table = csv.writer(file)
        table.writerow("step id x y z vx vy vz omegax omegay omegaz".split())
        for stop in stops:
            if stop > taken:
                advance(stop - taken)
            is_sample = stop % steps["sample_every"] == 0 or stop == steps["count"]
            before = [(Vector3(s.pos), Vector3(s.vel), Vector3(s.angVel)) for s in states]
            move(walls, stop * dt, dt)
            O.step()
            taken = stop + 1
            if is_sample:
                for number, ((x, v, w), state) in enumerate(zip(before, states), 1):
                    table.writerow([stop, number, *x, *(0.5 * (v + state.vel)), *(0.5 * (w + state.angVel))])


serve(run)
