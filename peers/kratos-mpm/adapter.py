"""Bodies of grainbench that deform, in the plane, in Kratos MPM 10.4, by its explicit scheme of central differences.

The model is built in memory: quadrilaterals with linear shape functions as the grid, and one of one material point for each place
of a body. Velocities and places are those of one time. `HyperElasticNeoHookeanPlaneStrain2DLaw` is the neo-Hookean law of scenes.
For hypoelastic bodies `LinearElasticIsotropicPlaneStrain2DLaw` stands in, which is the same in first order of the strain alone.

Damping in proportion to the mass is a body force that is set at every step. There is one field of velocities for all bodies: what
meets is welded. Sides that are held, and walls, are nodes that are kept from moving. So walls have no friction and hold both
ways: only bodies that start on them and are pressed to them are expressed. Friction, and walls by penalty, are of its implicit
schemes alone, in which a disc that slides or rolls turned points inside out, lost them, or made the matrix singular.
"""

import json
from math import ceil

import numpy as np
from bodies import extent, parts_of, row_of, serve, things_of
from KratosMultiphysics import *
from KratosMultiphysics.MPMApplication import *
from KratosMultiphysics.MPMApplication.mpm_explicit_solver import MPMExplicitSolver
from serve import Cannot

LAWS = {"hypoelastic": LinearElasticIsotropicPlaneStrain2DLaw, "neo-hookean": HyperElasticNeoHookeanPlaneStrain2DLaw}
MOVES = DISPLACEMENT_X, DISPLACEMENT_Y


def resting(scene, touching):
    """Refuses walls but those that bodies rest on without friction; gives the axis and the place of each."""
    for wall, friction, thing in touching:
        normal, point = (np.array(wall["plane"][word][:2]) for word in ("normal", "point"))
        gap = min((thing.ends - point) @ np.abs(normal) * normal.sum())
        if friction or wall["motion"]:
            raise Cannot("walls have no friction here and stand still")
        if abs(gap) > 1e-6 * scene["grid"]["cell"] or thing.velocity @ normal or normal @ scene["gravity"][:2] >= 0:
            raise Cannot("a wall holds both ways here: bodies start on it, and gravity presses them to it")
    axes = [int(np.argmax(np.abs(wall["plane"]["normal"]))) for wall in scene["walls"]]
    return [(axis, wall["plane"]["point"][axis], wall["plane"]["normal"][axis]) for axis, wall in zip(axes, scene["walls"])]


class Solver(MPMExplicitSolver):
    """Kratos' explicit solver, whose grid and bodies come from a scene rather than from files."""

    def __init__(self, scene):
        self.scene, self.h, self.time, self.gravity = scene, scene["grid"]["cell"], 0.0, np.zeros(2)
        self.things, self.anchor, touching = things_of(scene)
        self.walls, first = resting(scene, touching), self.things[0]
        words = dict(domain_size=2, model_part_name="MPM_Material", analysis_type="linear")
        words["time_stepping"] = dict(time_step=scene["steps"]["time_step"])
        super().__init__(Model(), Parameters(json.dumps(words)))
        self.AddVariables()
        self.ImportModelPart()
        self.PrepareModelPart()
        self.AddDofs()
        held = [(axis, first.ends[end, axis], first.sides[axis][end]) for axis in range(2) for end in range(2)]
        for axis, place, side in [one for one in held if one[2] != "free"] + [(*one[:2], "sliding") for one in self.walls]:
            for node in self.grid_model_part.Nodes:
                if abs((node.X, node.Y)[axis] - place) < 1e-6 * self.h:
                    for what in MOVES if side == "fixed" else MOVES[axis : axis + 1]:
                        node.Fix(what)
        self.Initialize()
        self.Check()
        self.part, self.info = self.material_point_model_part, self.material_point_model_part.ProcessInfo
        bodies = [self.part.GetSubModelPart(f"body {number}") for number in range(len(self.things))]
        self.points = [point for body in bodies for point in body.Elements]
        self.mass = np.array([point.CalculateOnIntegrationPoints(MP_MASS, self.info)[0] for point in self.points])

    def _ModelPartReading(self):
        """The grid, and a quadrilateral for each point of each body."""
        low, high = extent(self.scene, self.things, self.anchor)
        for axis, place, normal in self.walls:
            (low if normal > 0 else high)[axis] = round((place - self.anchor[axis]) / self.h)
        grid, (wide, tall) = self.grid_model_part, (high - low).tolist()
        grid.CreateNewProperties(0)
        for number in range((wide + 1) * (tall + 1)):
            place = self.anchor + self.h * (low + [number % (wide + 1), number // (wide + 1)])
            grid.CreateNewNode(number + 1, *place.tolist(), 0.0)
        for number in range(wide * tall):
            corner = number % wide + number // wide * (wide + 1) + 1
            nodes = [corner, corner + 1, corner + wide + 2, corner + wide + 1]
            grid.CreateNewElement("Element2D4N", number + 1, nodes, grid.GetProperties()[0])
        element, node = wide * tall + 1, (wide + 1) * (tall + 1) + 1
        for number, thing in enumerate(self.things):
            part = self.initial_mesh_model_part.CreateSubModelPart(f"body {number}")
            properties = part.CreateNewProperties(number + 1)
            bulk, shear = thing.law["bulk_modulus"], thing.law["shear_modulus"]
            properties.SetValue(CONSTITUTIVE_LAW, LAWS[thing.law["constitutive"]]())
            properties.SetValue(YOUNG_MODULUS, 9 * bulk * shear / (3 * bulk + shear))
            properties.SetValue(POISSON_RATIO, (3 * bulk - 2 * shear) / (6 * bulk + 2 * shear))
            properties.SetValue(DENSITY, thing.mass / len(thing.x) / np.prod(thing.span))
            properties.SetValue(THICKNESS, 1.0)
            properties.SetValue(MATERIAL_POINTS_PER_ELEMENT, 1)
            for place in thing.x:
                for corner in ((-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)):
                    part.CreateNewNode(node, *(place + thing.span * corner).tolist(), 0.0)
                    node += 1
                part.CreateNewElement("Element2D4N", element, list(range(node - 4, node)), properties)
                element += 1

    def get(self, what):
        """A vector of all points; of places and velocities, what lies in the plane."""
        rows = np.array([[*point.CalculateOnIntegrationPoints(what, self.info)[0]] for point in self.points])
        return rows if what is MP_CAUCHY_STRESS_VECTOR else rows[:, :2]

    def put(self, what, rows):
        """Sets a vector of all points."""
        for point, row in zip(self.points, rows.tolist()):
            point.SetValuesOnIntegrationPoints(what, [Array3([*row, 0.0])], self.info)

    def go(self, count, load, damping):
        """Steps under a gravity and a damping; where gravity changes, the acceleration of points does."""
        gravity = np.array(load["gravity"][:2])
        self.put(MP_ACCELERATION, self.get(MP_ACCELERATION) + gravity - self.gravity)
        self.gravity = gravity
        for step in range(count):
            if step == 0 or damping:
                self.put(MP_VOLUME_ACCELERATION, gravity - damping * self.get(MP_VELOCITY))
            self.time = self.AdvanceInTime(self.time)
            self.InitializeSolutionStep()
            self.Predict()
            if not self.SolveSolutionStep():
                raise ArithmeticError("a step was not solved")
            self.FinalizeSolutionStep()
            if self.part.NumberOfElements() != len(self.points):
                raise FloatingPointError("points left the grid, or are nowhere")


def samples(scene):
    """Settles, starts the clock, and gives the samples."""
    run, settle, count, done = Solver(scene), scene.get("settle"), scene["steps"]["count"], 0
    start = run.get(MP_COORD)
    if settle:
        run.go(ceil(settle["duration"] / scene["steps"]["time_step"]), settle, settle["damping"])
    x = run.get(MP_COORD)
    run.put(MP_VELOCITY, np.vstack([thing.launch(x[part])[0] for thing, part in zip(run.things, parts_of(run.things))]))
    for step in sorted({*range(0, count, scene["steps"]["sample_every"]), count}):
        run.go(step - done, scene, scene["global_damping"])
        done, elastic = step, EnergyCalculationUtility.CalculateAllEnergies(run.part)[2]
        sample = start, *(run.get(what) for what in (MP_COORD, MP_VELOCITY, MP_CAUCHY_STRESS_VECTOR)), elastic
        yield step, *row_of(scene, run.things, run.mass, sample)


Logger.GetDefaultOutput().SetSeverity(Logger.Severity.WARNING)
serve(samples)
