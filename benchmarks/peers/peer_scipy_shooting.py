"""SciPy, shooting: `solve_ivp` (DOP853) along each beam, `root` on six unknowns, the end loads of both clamped beams.

What a user writes who has no beam code, and how the paper solved it. All beam models; at `tolerance=1e-11` it is the independent
reference of the comparison. Predicted linearly from station to station.
"""

from math import cos, sin

import numpy as np
import scipy
from common import main
from scipy.integrate import solve_ivp
from scipy.optimize import root


def prepare(problem, model, tolerance):
    bend, stretch, slide = problem.flexibilities(model)
    rest, lengths, nodes, tolerance = problem.angles, problem.lengths, problem.nodes, float(tolerance)
    ends = rest.sum(axis=1)

    def beam(i, x, y, angle, moment, h, v):
        """From the state at the start, with the constant force (h, v), to that at the end: x, y, angle, moment."""
        length, slope, curvature = lengths[i], rest[i][1], 2 * rest[i][2]

        def change(u, state):
            c, s = cos(state[2]), sin(state[2])
            along, across = 1 + stretch * (h * c + v * s), slide * (v * c - h * s)
            dx, dy = length * (along * c - across * s), length * (along * s + across * c)
            return dx, dy, slope + curvature * u + length * bend * state[3], dy * h - dx * v

        return solve_ivp(change, (0, 1), (x, y, angle, moment), method="DOP853", rtol=tolerance, atol=10 * tolerance).y[:, -1]

    def gap(unknown, displacement):
        h1, v1, m1, h2, v2, m2 = unknown
        a = beam(0, *nodes["n1"], rest[0][0], m1, h1, v1)
        b = beam(1, *nodes["n2"], rest[1][0], m2, h2, v2)
        turn = a[2] - ends[0]
        c = beam(2, a[0], a[1], rest[2][0] + turn, a[3] + b[3], h1 + h2, v1 + v2)
        d = beam(3, c[0], c[1], rest[3][0] + c[2] - ends[2], c[3], h1 + h2, v1 + v2)
        x, y = d[:2] - nodes["n5"]
        # Rotations in units of 0.1 rad, to weigh as much as mm.
        return [a[0] - b[0], a[1] - b[1], 10 * (turn - b[2] + ends[1]), x, y + displacement, 10 * (d[2] - ends[3])]

    def curve():
        before = now = np.zeros(6)
        forces = []
        for displacement in problem.displacements:
            solution = root(gap, 2 * now - before, args=(displacement,), tol=tolerance)
            if not solution.success and np.abs(solution.fun).max() > 100 * tolerance:
                raise RuntimeError(f"no convergence at {displacement} mm: {solution.message}")
            before, now = now, solution.x
            forces.append(-(now[1] + now[4]))
        return forces

    return curve


main(prepare, "scipy " + scipy.__version__)
