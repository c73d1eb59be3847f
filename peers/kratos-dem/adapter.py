"""Scenes of grainbench in Kratos DEM 10.4: linear springs by pair, dashpots where Kratos' own relation holds, Hertz, planes.

The model is built in memory. Velocity Verlet leaves positions and velocities at the same time, so samples are taken as they are.
A plane is one triangle (in the plane: one edge), so that no grain crosses a seam, where its tangential spring would start anew.
"""

import csv
import json
import os
from math import hypot, sqrt

import numpy as np
from KratosMultiphysics import *
from KratosMultiphysics.DEMApplication import *
from KratosMultiphysics.DEMApplication.DEM_analysis_stage import DEMAnalysisStage
from serve import Cannot, hertz, mean_velocity, reach, serve

STATE = "x y z vx vy vz omegax omegay omegaz".split()
LAW = {"linear": "DEM_D_Linear_Custom_Constants", "hertz-mindlin": "DEM_D_Hertz_viscous_Coulomb"}


def bearer(thing):
    """What one material of Kratos stands for: a material of the scene and the mass of its grains; of a wall, none."""
    return thing["material"], thing.get("mass", 0.0)


def damping_ratio(law, masses):
    """The damping ratio of Kratos for the scene's dashpots: c_n = 2 zeta sqrt(m k_n) and c_t = 2 zeta sqrt(m k_t)."""
    mass = 1 / sum(1 / one for one in masses if one)
    stiffness = law["normal_stiffness"], law["tangential_stiffness"]
    by_mass = law["normal_damping"], law["tangential_damping"]
    normal, tangential = (law["stiffness_damping"] * k + gamma * mass for k, gamma in zip(stiffness, by_mass))
    ratio = normal / (2 * sqrt(mass * stiffness[0]))
    if law["friction"] and abs(2 * ratio * sqrt(mass * stiffness[1]) - tangential) > 1e-9 * (normal + tangential):
        raise Cannot("the tangential dashpot is the normal one by the root of k_s / k_n here")
    return ratio


def materials(scene):
    """Kratos' materials and their relations, the numbers of materials, and the damping ratio of each pair of them."""
    bearers = sorted({bearer(thing) for thing in scene["grains"] + scene["walls"]})
    numbers = {one: number for number, one in enumerate(bearers, 1)}
    density = {bearer(grain): grain["mass"] / volume(grain, scene["dimension"]) for grain in scene["grains"]}
    laws = {frozenset(law["between"]): law for law in scene["laws"]}
    is_hertz = any(law["law"] == "hertz-mindlin" for law in scene["laws"])
    young, poisson = hertz(scene)[1:] if is_hertz else (1.0, 0.0)
    relations, ratios = [], {}
    for a in bearers:
        for b in bearers:
            law = laws.get(frozenset((a[0], b[0])))
            if law is None or numbers[a] > numbers[b] or not a[1] + b[1]:
                continue
            pair = numbers[a], numbers[b]
            words = dict(COEFFICIENT_OF_RESTITUTION=law.get("restitution", 1.0))
            if not is_hertz:
                ratios[pair] = damping_ratio(law, (a[1], b[1]))
                words |= dict(K_NORMAL=law["normal_stiffness"], K_TANGENTIAL=law["tangential_stiffness"])
            words |= dict(STATIC_FRICTION=law["friction"], DYNAMIC_FRICTION=law["friction"], FRICTION_DECAY=500.0)
            words |= dict(ROLLING_FRICTION=0.0, ROLLING_FRICTION_WITH_WALLS=0.0)
            words |= dict(DEM_DISCONTINUUM_CONSTITUTIVE_LAW_NAME=LAW[law["law"]])
            words |= dict(DEM_ROLLING_FRICTION_MODEL_NAME="DEMRollingFrictionModelBounded")
            relations.append(dict(material_ids_list=pair, Variables=words, Tables={}))
    listed = []
    for one, number in numbers.items():
        words = dict(PARTICLE_DENSITY=density.get(one, 1.0), YOUNG_MODULUS=young, POISSON_RATIO=poisson, COMPUTE_WEAR=False)
        listed.append(dict(material_name=f"{number}", material_id=number, Variables=words, Tables={}))
    return dict(materials=listed, material_relations=relations, material_assignation_table=[]), numbers, ratios


def volume(grain, dimension):
    """The volume of a sphere, or of a disc a metre deep."""
    return np.pi * grain["radius"] ** 2 * (4 / 3 * grain["radius"] if dimension == 3 else 1.0)


def corners(one, scene):
    """A triangle, or an edge in the plane, that covers all of a plane that the grains can reach."""
    places = np.array([grain["position"] for grain in scene["grains"]])
    normal, point = np.array(one["plane"]["normal"]), np.array(one["plane"]["point"])
    middle = (places.min(axis=0) + places.max(axis=0)) / 2
    far = reach(scene) + np.linalg.norm(places - middle, axis=1).max() + abs((middle - point) @ normal)
    middle = middle - ((middle - point) @ normal) * normal
    if scene["dimension"] == 2:
        along = np.array([normal[1], -normal[0], 0.0])
        return [middle + far * along, middle - far * along]
    first = np.cross(normal, np.eye(3)[abs(normal).argmin()])
    first /= np.linalg.norm(first)
    second = np.cross(normal, first)
    return [middle + 2 * far * (c * first + s * second) for c, s in ((1, 0), (-0.5, sqrt(0.75)), (-0.5, -sqrt(0.75)))]


class Stage(DEMAnalysisStage):
    """A run of Kratos whose grains, walls and materials come from a scene rather than from files."""

    def __init__(self, scene):
        self.scene = scene
        self.table, self.numbers, self.ratios = materials(scene)
        dt = scene["steps"]["time_step"]
        words = dict(Dimension=scene["dimension"], do_print_results_option=False, dem_inlet_option=False)
        words |= dict(NeighbourSearchFrequency=1, BoundingBoxOption=False)
        words |= dict(zip(("GravityX", "GravityY", "GravityZ"), scene["gravity"]))
        words |= dict(TranslationalIntegrationScheme="Velocity_Verlet", RotationalIntegrationScheme="Direct_Integration")
        words |= dict(MaxTimeStep=dt, FinalTime=dt * scene["steps"]["count"], problem_name="scene")
        words["solver_settings"] = dict(strategy="sphere_strategy", RemoveBallsInitiallyTouchingWalls=False)
        super().__init__(Model(), Parameters(json.dumps(words)))

    def ReadMaterialsFile(self):
        """The materials, after the parts that they are given to."""
        self.DEM_material_parameters = Parameters(json.dumps(self.table))

    def SetMaterials(self):
        """Materials, then grains and walls, which name theirs."""
        super().SetMaterials()
        self.fill()

    def ReadModelParts(self, *_):
        """Nothing is read."""

    def fill(self):
        """Grains and walls."""
        flat = self.scene["dimension"] == 2
        properties = self.spheres_model_part.GetProperties()
        for number, grain in enumerate(self.scene["grains"], 1):
            node = self.spheres_model_part.CreateNewNode(number, *grain["position"])
            node.SetSolutionStepValue(RADIUS, grain["radius"])
            kind = "CylinderParticle2D" if flat else "SphericParticle3D"
            self.spheres_model_part.CreateNewElement(kind, number, [number], properties[self.numbers[bearer(grain)]])
        first = len(self.scene["grains"]) + 1
        self.walls = []
        for count, one in enumerate(self.scene["walls"], 1):
            part = self.rigid_face_model_part.CreateSubModelPart(f"wall {count}")
            ends = corners(one, self.scene)
            for offset, end in enumerate(ends):
                part.CreateNewNode(first + offset, *(float(c) for c in end))
            nodes = list(range(first, first + len(ends)))
            number = self.numbers[bearer(one)]
            self.rigid_face_model_part.AddProperties(properties[number])
            part.CreateNewCondition("RigidEdge2D2N" if flat else "RigidFace3D3N", count, nodes, properties[number])
            first += len(ends)
            part.SetValue(PROPERTIES_ID, number)
            if one["motion"]:
                part.SetValue(RIGID_BODY_MOTION, True)
                part.SetValue(VELOCITY_STOP_TIME, 1e300)
            self.walls.append((part, one))

    def start(self):
        """Initial velocities, moments of inertia, dashpots, and grains that are driven."""
        self.Initialize()
        for node, grain in zip(self.spheres_model_part.Nodes, self.scene["grains"]):
            if abs(node.GetSolutionStepValue(NODAL_MASS) / grain["mass"] - 1) > 1e-12:
                raise Cannot("its masses are other than those of spheres or discs of one density")
            node.SetSolutionStepValue(PARTICLE_MOMENT_OF_INERTIA, grain["inertia"])
            node.SetSolutionStepValue(VELOCITY, grain["velocity"])
            node.SetSolutionStepValue(ANGULAR_VELOCITY, grain["spin"])
        for (a, b), ratio in self.ratios.items():
            for one, other in ((a, b), (b, a)):
                self.spheres_model_part.GetProperties()[one].GetSubProperties(other).SetValue(DAMPING_GAMMA, ratio)
        for group in self.scene["driven"]:
            for number in group["grains"]:
                node = self.spheres_model_part.GetNode(number)
                node.SetSolutionStepValue(VELOCITY, group["velocity"])
                node.SetSolutionStepValue(ANGULAR_VELOCITY, [0.0, 0.0, 0.0])
                for what in (VELOCITY_X, VELOCITY_Y, VELOCITY_Z, ANGULAR_VELOCITY_X, ANGULAR_VELOCITY_Y, ANGULAR_VELOCITY_Z):
                    node.Fix(what)

    def move(self, time, dt):
        """The walls over the step that ends now."""
        for part, one in self.walls:
            if one["motion"]:
                part.SetValue(LINEAR_VELOCITY, mean_velocity(one, time - dt, time))
        self._GetSolver().Predict()

    def state(self):
        """Places, velocities and spins of all grains."""
        part, utils = self.spheres_model_part, VariableUtils()
        places = utils.GetCurrentPositionsVector(part.Nodes, 3)
        vectors = [utils.GetSolutionStepValuesVector(part.Nodes, what, 0, 3) for what in (VELOCITY, ANGULAR_VELOCITY)]
        return np.hstack([np.array(vector).reshape(-1, 3) for vector in (places, *vectors)])


def run(scene, out):
    """Steps through the scene and leaves the grains at every sample."""
    os.chdir(out)
    stage = Stage(scene)
    stage.start()
    solver, steps, moves = stage._GetSolver(), scene["steps"], any(one["motion"] for one in scene["walls"])
    with open("grains.csv", "w", newline="") as file:
        table = csv.writer(file)
        table.writerow(["step", "id", *STATE])
        for step in range(steps["count"] + 1):
            if step:
                solver._UpdateTimeInModelParts(step * steps["time_step"])
                solver.InitializeSolutionStep()
                if moves:
                    stage.move(step * steps["time_step"], steps["time_step"])
                solver.SolveSolutionStep()
            if step % steps["sample_every"] == 0 or step == steps["count"]:
                table.writerows([step, number, *row] for number, row in enumerate(stage.state().tolist(), 1))


Logger.GetDefaultOutput().SetSeverity(Logger.Severity.WARNING)
serve(run)
