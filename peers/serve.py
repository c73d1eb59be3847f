"""What adapters share: answering a run a line, and what none of them expresses."""

import json
import os
import sys
import traceback


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
    if any("restitution" in law for law in scene["laws"]):
        raise Cannot("a dashpot by the coefficient of restitution is another one here")
    if any(any(phase["spin"]) for one in scene["walls"] for phase in one["motion"]):
        raise Cannot("walls that turn are not expressed here")


def mean_velocity(wall, start, end):
    """The velocity of a wall over a step: of a phase that begins or ends within it, its share."""
    velocity = [0.0, 0.0, 0.0]
    for phase in wall["motion"]:
        share = max(min(end, phase.get("stop", float("inf"))) - max(start, phase["start"]), 0.0) / (end - start)
        velocity = [before + share * part for before, part in zip(velocity, phase["velocity"])]
    return velocity


def serve(run):
    """Runs a scene a line until there are no more; answers go to the descriptor 5, for programs print where they like."""
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
