"""One grain on planes: linear springs with dashpots and Coulomb friction, by the leap-frog scheme of Cundall and Strack."""
import csv, json, sys

def plus(a, b, factor=1.0): return [x + factor * y for x, y in zip(a, b)]
def dot(a, b): return sum(x * y for x, y in zip(a, b))
def cross(a, b): return [a[1]*b[2] - a[2]*b[1], a[2]*b[0] - a[0]*b[2], a[0]*b[1] - a[1]*b[0]]

scene = json.load(open(sys.argv[1]))
if len(scene["grains"]) != 1:
    print("it moves one grain")
    sys.exit(64)
(grain,), (law,), steps = scene["grains"], scene["laws"], scene["steps"]
mass, radius, inertia, dt = grain["mass"], grain["radius"], grain["inertia"], steps["time_step"]
x, v, spin = grain["position"], grain["velocity"], grain["spin"]
stiffness = law["normal_stiffness"], law["tangential_stiffness"]
dashpot = [law[name] * mass + law["stiffness_damping"] * k for name, k in zip(("normal_damping", "tangential_damping"), stiffness)]
springs = {wall["name"]: [0.0] * 3 for wall in scene["walls"]}

def forces(step):
    force, torque = [mass * g for g in scene["gravity"]], [0.0] * 3
    for wall in scene["walls"]:
        n, point = wall["plane"]["normal"], wall["plane"]["point"]
        overlap, arm = radius - dot(plus(x, point, -1), n), [-radius * part for part in n]
        if overlap <= 0:
            springs[wall["name"]] = [0.0] * 3
            continue
        push = stiffness[0] * overlap - dashpot[0] * dot(v, n)
        slip = plus(v, cross(spin, arm))
        slip = plus(slip, n, -dot(slip, n))
        spring, drag = plus(springs[wall["name"]], slip, stiffness[1] * step), [dashpot[1] * part for part in slip]
        friction, most = plus([-part for part in spring], drag, -1), law["friction"] * max(push, 0.0)
        factor = min(1.0, most / (dot(friction, friction) ** 0.5 or 1.0))
        friction = [factor * part for part in friction]
        springs[wall["name"]] = spring if factor == 1.0 else plus([-part for part in friction], drag, -1)
        force, torque = plus(plus(force, n, push), friction), plus(torque, cross(arm, friction))
    return force, torque

table, kick = csv.writer(open(sys.argv[2] + "/grains.csv", "w", newline="")), (dt / mass / 2, dt / inertia / 2)
table.writerow("step id x y z vx vy vz omegax omegay omegaz".split())
force, torque = forces(0.0)
for step in range(steps["count"] + 1):
    if step % steps["sample_every"] == 0 or step == steps["count"]:
        table.writerow([step, 1, *x, *v, *spin])
    v, spin = plus(v, force, kick[0]), plus(spin, torque, kick[1])
    x = plus(x, v, dt)
    force, torque = forces(dt)
    v, spin = plus(v, force, kick[0]), plus(spin, torque, kick[1])
