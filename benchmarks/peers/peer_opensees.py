"""OpenSeesPy: `elasticBeamColumn` with the corotational transformation; Euler-Bernoulli beams that stretch (model EA).

Elements are straight between points on the curved beams, their error falls with the square of their size: `richardson=1` computes
the curve on meshes of n and 2 n elements per beam and extrapolates. One displacement-controlled step of the driven node per station.
https://openseespydoc.readthedocs.io
"""

import ctypes
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path

from common import main

if wheel := find_spec("openseespylinux"):
    # The Linux wheel brings a BLAS that its LAPACK does not find by itself.
    ctypes.CDLL(str(Path(wheel.origin).parent / "lib/libblas.so.3"))
import openseespy.opensees as ops


def solve(problem, elements, tolerance):
    places, along, named = problem.mesh(elements)
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    for tag, (x, y) in enumerate(places):
        ops.node(tag, float(x), float(y))
    ops.fix(named["n1"], 1, 1, 1)
    ops.fix(named["n2"], 1, 1, 1)
    ops.fix(named["n5"], 1, 0, 1)
    ops.geomTransf("Corotational", 1)
    tag = 0
    for nodes in along:
        for start, end in zip(nodes[:-1], nodes[1:]):
            # Area, modulus and moment of inertia only enter as EA and EI.
            ops.element("elasticBeamColumn", tag, start, end, problem.axial, 1.0, problem.bending, 1)
            tag += 1
    # The unit load that the control scales: its factor is the force.
    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    ops.load(named["n5"], 0.0, -1.0, 0.0)
    ops.system("ProfileSPD")
    ops.numberer("RCM")
    ops.constraints("Plain")
    ops.test("NormDispIncr", tolerance, 50, 0)
    ops.algorithm("Newton")
    ops.integrator("DisplacementControl", named["n5"], 2, -float(problem.displacements[0]))
    ops.analysis("Static")
    forces = []
    for displacement in problem.displacements:
        if ops.analyze(1) != 0:
            raise RuntimeError(f"no convergence at {displacement} mm")
        forces.append(ops.getTime())
    return forces


def prepare(problem, elements, tolerance, richardson="0"):
    n, tolerance = int(elements), float(tolerance)
    if richardson == "0":
        return lambda: solve(problem, n, tolerance)
    return lambda: [(4 * fine - coarse) / 3 for coarse, fine in zip(solve(problem, n, tolerance), solve(problem, 2 * n, tolerance))]


main(prepare, "openseespy " + version("openseespy"))
