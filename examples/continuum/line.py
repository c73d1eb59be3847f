"""Column or bar as a chain of masses and springs in one dimension, with central differences."""
import csv, json, math, sys

scene, out = json.load(open(sys.argv[1])), sys.argv[2]
(body,) = scene["bodies"]
axis = 1 if any(scene["gravity"]) else 0
low, high = (body["shape"]["box"][side][axis] for side in ("low", "high"))
(material,) = scene["deformable"]
modulus = material["bulk_modulus"] + 4 / 3 * material["shear_modulus"]
count = round((high - low) / scene["grid"]["cell"])
h = (high - low) / count
mass = [body["density"] * h * (0.5 if at in (0, count) else 1.0) for at in range(count + 1)]
wave = body.get("wave", {"amplitude": 0.0, "wave_number": 0.0})
u = [0.0] * (count + 1)
v = [wave["amplitude"] * math.sin(wave["wave_number"] * at * h) for at in range(count + 1)]
steps, dt = scene["steps"], scene["steps"]["time_step"]


def forces():
    stress = [modulus * (b - a) / h for a, b in zip(u, u[1:])]
    pull = [right - left for left, right in zip([0.0] + stress, stress + [0.0])]
    return stress, [f + m * scene["gravity"][axis] for f, m in zip(pull, mass)]


def push(time):
    """Updates the velocities over a time by forces and damping; a fixed end does not move."""
    for at in range(held, count + 1):
        v[at] = (v[at] + time * force[at] / mass[at]) / (1 + scene["global_damping"] * time)


def at_point(stress, at):
    """Returns the stress at a position, interpolated between the centres of springs."""
    place = (at[axis] - low) / h - 0.5
    left = min(max(math.floor(place), 0), count - 2)
    return stress[left] + (place - left) * (stress[left + 1] - stress[left])


held = 1 if body["sides"][axis][0] != "free" else 0
with open(f"{out}/series.csv", "w", newline="") as file:
    table = csv.writer(file)
    name = {probe["of"]: probe["name"] for probe in scene["probes"] if "at" not in probe}[body["name"]]
    points = [(probe["name"], probe["at"]) for probe in scene["probes"] if "at" in probe]
    along = "xy"[axis]
    table.writerow([f"{name}.{along}", f"{name}.v{along}"] + [f"{point}.sigma_{along}{along}" for point, _ in points])
    for step in range(steps["count"] + 1):
        stress, force = forces()
        # The second half of the kick gives a sample velocities and positions of the same time.
        push(dt / 2 if step else 0.0)
        if step % steps["sample_every"] == 0 or step == steps["count"]:
            total = sum(mass)
            place = sum(m * (low + at * h + x) for at, (m, x) in enumerate(zip(mass, u))) / total
            speed = sum(m * w for m, w in zip(mass, v)) / total
            table.writerow([place, speed] + [at_point(stress, at) for _, at in points])
        push(dt / 2)
        u = [x + dt * w for x, w in zip(u, v)]
