"""Exudyn: `ObjectBeamGeometricallyExact2D`, geometrically exact beams that stretch and shear (model EA+GA).

`nodes=2` are linear elements, `nodes=3` quadratic ones. The curve is one static solution with a load step per station and a
coordinate constraint as drive, whose force is read. Sparse solver and modified Newton method: together about twice as fast here as
dense solver and full Newton method, the defaults.
https://exudyn.readthedocs.io
"""

import exudyn as exu
import numpy as np
from common import GAUSS, main
from exudyn.itemInterface import (
    MarkerNodeCoordinate, NodePointGround, NodeRigidBody2D, ObjectBeamGeometricallyExact2D, ObjectConnectorCoordinate, SensorObject,
)


def reference_length(points):
    """Length of the line or parabola through the nodes of an element, in their order along it."""
    if len(points) == 2:
        return float(np.linalg.norm(points[1] - points[0]))
    tangents = [(x - 0.5) * points[0] - 2 * x * points[1] + (x + 0.5) * points[2] for x in GAUSS[0]]
    return float(GAUSS[1] @ np.linalg.norm(tangents, axis=1))


def solve(problem, elements, order, tolerance):
    places, along, named = problem.mesh(order * elements)
    system = exu.SystemContainer().AddSystem()
    nodes = [system.AddNode(NodeRigidBody2D(referenceCoordinates=[x, y, 0.0])) for x, y in places]
    for beam in along:
        for first in range(0, len(beam) - 1, order):
            own = beam[first : first + order + 1]
            system.AddObject(ObjectBeamGeometricallyExact2D(
                nodeNumbers=[nodes[i] for i in own], length=reference_length(places[own]), massPerLength=1e-3, crossSectionInertia=1e-4,
                bendingStiffness=problem.bending, axialStiffness=problem.axial, shearStiffness=problem.shear,
                includeReferenceRotations=False))
    ground = system.AddMarker(MarkerNodeCoordinate(nodeNumber=system.AddNode(NodePointGround()), coordinate=0))

    def hold(name, coordinate, **drive):
        marker = system.AddMarker(MarkerNodeCoordinate(nodeNumber=nodes[named[name]], coordinate=coordinate))
        return system.AddObject(ObjectConnectorCoordinate(markerNumbers=[ground, marker], **drive))

    for name, coordinate in [("n1", 0), ("n1", 1), ("n1", 2), ("n2", 0), ("n2", 1), ("n2", 2), ("n5", 0), ("n5", 2)]:
        hold(name, coordinate)
    travel = problem.displacements[-1]
    drive = hold("n5", 1, offsetUserFunction=lambda system, time, item, offset: -travel * time)
    sensor = system.AddSensor(SensorObject(objectNumber=drive, storeInternal=True, outputVariableType=exu.OutputVariableType.Force))
    system.Assemble()
    settings = exu.SimulationSettings()
    settings.staticSolver.numberOfLoadSteps = len(problem.displacements)
    settings.staticSolver.adaptiveStep = False
    settings.staticSolver.verboseMode = 0
    settings.staticSolver.newton.relativeTolerance = tolerance
    settings.staticSolver.newton.absoluteTolerance = tolerance
    settings.staticSolver.newton.useModifiedNewton = True
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = 1e-9
    settings.linearSolver.solverType = exu.LinearSolverType.EigenSparse
    settings.parallel.numberOfThreads = 1
    settings.show.statistics = False
    system.SolveStatic(settings)
    history = np.array(system.GetSensorStoredData(sensor))
    return np.abs(history[history[:, 0] > 1e-9, 1])


def prepare(problem, elements, tolerance, nodes):
    return lambda: solve(problem, int(elements), int(nodes) - 1, float(tolerance))


main(prepare, "exudyn " + exu.__version__)
