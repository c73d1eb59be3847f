"""What adapters share: answering a run a line, and what none of them expresses."""

import json
import os
import sys
import traceback
from math import hypot


class Cannot(Exception):
    """The scene cannot be expressed."""


def refuse(scene):
    """What a manifest has no word for."""
    if scene["global_damping"]:
        raise Cannot("its global damping is not proportional to the mass")
    if scene.get("domain") is not None and any(scene["domain"]["periodic"]):
        raise Cannot("periodic along all axes or none")
    if any(law["cohesion"] or law["rolling_friction"] for law in scene["laws"]):
        raise Cannot("neither cohesion nor rolling resistance here")
    if any("restitution" in law and law["law"] == "linear" for law in scene["laws"]):
        raise Cannot("a dashpot by the coefficient of restitution is another one here")
    if any(any(phase["spin"]) for one in scene["walls"] for phase in one["motion"]):
        raise Cannot("walls that turn are not expressed here")


def reach(scene):
    """How far a grain can get in the run, and a few radii."""
    time = scene["steps"]["count"] * scene["steps"]["time_step"]
    fastest = max(hypot(*grain["velocity"]) + hypot(*grain["spin"]) * grain["radius"] for grain in scene["grains"])
    fastest += max((hypot(*group["velocity"]) for group in scene["driven"]), default=0.0)
    fastest += sum(hypot(*phase["velocity"]) for wall in scene["walls"] for phase in wall["motion"])
    return fastest * time + hypot(*scene["gravity"]) * time**2 / 2 + 4 * max(grain["radius"] for grain in scene["grains"])


def near(scene, wall):
    """The grains that can get to a wall."""
    normal, point, far = wall["plane"]["normal"], wall["plane"]["point"], reach(scene)
    height = lambda grain: sum(n * (x - p) for n, x, p in zip(normal, grain["position"], point))
    return [grain for grain in scene["grains"] if height(grain) < grain["radius"] + far]


def hertz(scene):
    """Hertz's law of the contacts that can come about, one for all; E and nu of two equal materials that have its E* and G*.

    E* = E / (2 (1 - nu^2)) and G* = E / (4 (2 - nu) (1 + nu)), so that nu = (E* - 4 G*) / (E* - 2 G*).
    """
    grains = scene["grains"]
    pairs = {frozenset((a["material"], b["material"])) for at, a in enumerate(grains) for b in grains[:at]}
    pairs |= {frozenset((wall["material"], grain["material"])) for wall in scene["walls"] for grain in near(scene, wall)}
    laws = [law for law in scene["laws"] if frozenset(law["between"]) in pairs]
    if any(law["law"] != "hertz-mindlin" for law in laws) or len(laws) != 1:
        raise Cannot("one law of Hertz for all contacts that can come about")
    (law,) = laws
    if law["normal_damping"] or law["tangential_damping"]:
        raise Cannot("dashpots of Hertz's law by the coefficient of restitution")
    normal, shear = law["effective_modulus"], law["effective_shear_modulus"]
    poisson = (normal - 4 * shear) / (normal - 2 * shear)
    return law, 2 * (1 - poisson**2) * normal, poisson


def mean_velocity(wall, start, end):
    """The velocity of a wall over a step: of a phase that begins or ends within it, its share."""
    velocity = [0.0, 0.0, 0.0]
    for phase in wall["motion"]:
        share = max(min(end, phase.get("stop", float("inf"))) - max(start, phase["start"]), 0.0) / (end - start)
        velocity = [before + share * part for before, part in zip(velocity, phase["velocity"])]
    return velocity


def serve(run, refuse=refuse):
    """Runs a scene a line until there are no more; answers go to the descriptor 5, for programs print where they like.

    `refuse` raises `Cannot` where the scene calls for what the manifest has no word for and the program does not have.
    """
    answers = os.fdopen(5, "w")
    for line in sys.stdin:
        request = json.loads(line)
        try:
            with open(request["scene"]) as file:
                scene = json.load(file)
            refuse(scene)
            run(scene, request["out"])
            answer = {"ran": {}}
        except Cannot as reason:
            answer = {"cannot": str(reason)}
        except Exception as error:
            traceback.print_exc()
            answer = {"failed": {"why": f"{type(error).__name__}: {error}", "when": None, "where": None}}
        print(json.dumps(answer), file=answers, flush=True)
