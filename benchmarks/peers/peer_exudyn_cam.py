"""Exudyn: the cam in motion. Slider, brace and roller as rigid bodies (nine coordinates), joints as constraints, an implicit integrator.

The roller's centre keeps to its path and its angle to the length of the path by one constraint of two rows, a user function with its
Jacobian: ideal, as ours. (Exudyn's contact of circles with curves has a stiffness instead, and follows straight pieces.)
Of its integrators the trapezoidal rule with index 2 takes the least time to the same error, less than the generalised-alpha method.
https://exudyn.readthedocs.io
"""

import math

import exudyn as exu
import numpy as np
from common import GAUSS, main
from exudyn.itemInterface import (
    MarkerBodyPosition, MarkerNodeCoordinate, MarkerNodeCoordinates, NodePointGround, NodeRigidBody2D,
    ObjectConnectorCoordinate, ObjectConnectorCoordinateSpringDamper, ObjectConnectorCoordinateVector, ObjectJointRevolute2D,
    ObjectRigidBody2D, SensorObject,
)

# Pieces of the table of the path's length, cubic between them: far finer than any error asked for.
PIECES = 2000


class Way:
    """The roller's path, y over x, and its length from the start of the motion."""

    def __init__(self, motion):
        self.l, self.x0, self.k = motion["brace_m"], motion["start_x_m"], motion["bend_per_m"]
        self.rise = math.sqrt(self.l**2 - self.x0**2)
        self.start = motion["roller_at_m"][0]
        self.step = 0.4 * (self.l - self.start) / PIECES
        knots = self.start - 50 * self.step + self.step * np.arange(PIECES + 1)
        inside = knots[:-1, None] + self.step / 2 * (1 + GAUSS[0])
        pieces = self.step / 2 * np.hypot(1, 2 * self.k * (inside - self.x0) + inside / np.sqrt(self.l**2 - inside**2)) @ GAUSS[1]
        total = np.concatenate([[0], np.cumsum(pieces)])
        self.first, self.lengths = float(knots[0]), (total - total[50]).tolist()

    def height(self, x):
        return self.k * (x - self.x0) ** 2 + self.rise - math.sqrt(self.l**2 - x**2)

    def slope(self, x):
        return 2 * self.k * (x - self.x0) + x / math.sqrt(self.l**2 - x**2)

    def length(self, x):
        """Hermite's cubic."""
        i = int((x - self.first) / self.step)
        t, h = (x - self.first) / self.step - i, self.step
        (a, b), at = self.lengths[i : i + 2], self.first + i * h
        va, vb = math.hypot(1, self.slope(at)), math.hypot(1, self.slope(at + h))
        u = 1 - t
        return a * (1 + 2 * t) * u * u + b * t * t * (3 - 2 * t) + h * t * u * (va * u - vb * t)


def build(motion, way):
    system = exu.SystemContainer().AddSystem()
    (x, y), height, l, r = motion["roller_at_m"], motion["start_height_m"], motion["brace_m"], motion["roller_m"]

    def body(at, angle, mass, inertia):
        node = system.AddNode(NodeRigidBody2D(referenceCoordinates=[*at, angle]))
        return node, system.AddObject(ObjectRigidBody2D(mass=mass, inertia=inertia, nodeNumber=node))

    slider, slider_body = body([0, height], 0, motion["slider_kg"] / 2, 1e-3)
    _, brace_body = body([x / 2, (y + height) / 2], math.atan2(y - height, x), motion["brace_kg"], motion["brace_kg_m2"])
    roller, roller_body = body([x, y], 0, motion["roller_kg"], motion["roller_kg_m2"])
    ground = system.AddMarker(MarkerNodeCoordinate(nodeNumber=system.AddNode(NodePointGround()), coordinate=0))

    def point(of, at=(0, 0, 0)):
        return system.AddMarker(MarkerBodyPosition(bodyNumber=of, localPosition=list(at)))

    def held(coordinate, **drive):
        marker = system.AddMarker(MarkerNodeCoordinate(nodeNumber=slider, coordinate=coordinate))
        return system.AddObject(ObjectConnectorCoordinate(markerNumbers=[ground, marker], **drive))

    held(0)
    held(2)
    rise, duration = motion["rise_m"], motion["duration_s"]
    full = 2 * math.pi / duration
    drive = held(
        1,
        offsetUserFunction=lambda system, t, item, offset: rise * (t / duration - math.sin(full * t) / (2 * math.pi)),
        offsetUserFunction_t=lambda system, t, item, offset: rise / duration * (1 - math.cos(full * t)),
    )
    system.AddObject(ObjectJointRevolute2D(markerNumbers=[point(slider_body), point(brace_body, (-l / 2, 0, 0))]))
    system.AddObject(ObjectJointRevolute2D(markerNumbers=[point(brace_body, (l / 2, 0, 0)), point(roller_body)]))
    # Both ends of the springs move: twice their rate at half their way, counted from where the roller begins.
    system.AddObject(ObjectConnectorCoordinateSpringDamper(
        markerNumbers=[ground, system.AddMarker(MarkerNodeCoordinate(nodeNumber=roller, coordinate=0))],
        stiffness=2 * motion["rate_n_per_m"], offset=motion["rest_m"] / 2 - x))

    # Coordinates of the slider, then of the roller.
    def rows(system, t, item, q, v, velocity_level):
        if velocity_level:
            slope = way.slope(q[3])
            return [v[4] - slope * v[3], v[5] + math.hypot(1, slope) / r * v[3]]
        return [q[4] - way.height(q[3]), q[5] + way.length(q[3]) / r]

    def jacobian(system, t, item, q, v, velocity_level):
        slope = way.slope(q[3])
        return np.array([[0.0, 0, 0, -slope, 1, 0], [0.0, 0, 0, math.hypot(1, slope) / r, 0, 1]])

    system.AddObject(ObjectConnectorCoordinateVector(
        markerNumbers=[system.AddMarker(MarkerNodeCoordinates(nodeNumber=node)) for node in (slider, roller)],
        scalingMarker0=np.zeros((2, 3)), scalingMarker1=np.array([[0.0, 1, 0], [0, 0, 1]]),
        constraintUserFunction=rows, jacobianUserFunction=jacobian))
    sensor = system.AddSensor(SensorObject(objectNumber=drive, storeInternal=True, outputVariableType=exu.OutputVariableType.Force))
    system.Assemble()
    return system, sensor


def solve(motion, way, steps, tolerance):
    system, sensor = build(motion, way)
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps = steps
    settings.timeIntegration.endTime = motion["duration_s"]
    settings.timeIntegration.verboseMode = 0
    settings.timeIntegration.newton.useModifiedNewton = True
    settings.timeIntegration.newton.relativeTolerance = tolerance
    settings.timeIntegration.newton.absoluteTolerance = tolerance
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = motion["duration_s"] / motion["instants"]
    settings.parallel.numberOfThreads = 1
    settings.show.statistics = False
    system.SolveDynamic(settings, solverType=exu.DynamicSolverType.TrapezoidalIndex2)
    history = np.array(system.GetSensorStoredData(sensor))
    rows = [int(np.abs(history[:, 0] - motion["duration_s"] * (i + 1) / motion["instants"]).argmin()) for i in range(motion["settling"], motion["instants"])]
    # The other half needs as much.
    return 2 * np.abs(history[rows, 1])


def prepare(problem, steps, tolerance):
    way, count = Way(problem.motion), int(steps) * problem.motion["instants"]
    return lambda: solve(problem.motion, way, count, float(tolerance))


main(prepare, "exudyn " + exu.__version__)
