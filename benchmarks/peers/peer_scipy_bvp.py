"""SciPy, collocation: `solve_bvp` on all four beams at once, forces and moments as states; beams that stretch and shear.

`intervals` of the first mesh, refined by the solver where `tolerance` asks for it; mesh and solution are the start of the next
station. The Jacobians are given: without them the solver forms differences and takes longer.
"""

import numpy as np
import scipy
from common import main
from scipy.integrate import solve_bvp

X, Y, ANGLE, MOMENT, H, V = range(6)


def prepare(problem, model, intervals, tolerance):
    bend, stretch, slide = problem.flexibilities(model)
    rest, nodes = problem.angles, problem.nodes
    length, slope, curvature = problem.lengths[:, None], rest[:, 1:2], 2 * rest[:, 2:3]
    ends = rest.sum(axis=1)

    def strained(y):
        """Stretch, shear and direction along the beams."""
        c, s = np.cos(y[:, ANGLE]), np.sin(y[:, ANGLE])
        return 1 + stretch * (y[:, H] * c + y[:, V] * s), slide * (y[:, V] * c - y[:, H] * s), c, s

    def change(u, flat):
        y = flat.reshape(4, 6, -1)
        along, across, c, s = strained(y)
        d = np.zeros_like(y)
        d[:, X], d[:, Y] = length * (along * c - across * s), length * (along * s + across * c)
        d[:, ANGLE] = slope + curvature * u + length * bend * y[:, MOMENT]
        d[:, MOMENT] = d[:, Y] * y[:, H] - d[:, X] * y[:, V]
        return d.reshape(24, -1)

    def jacobian(u, flat):
        y = flat.reshape(4, 6, -1)
        along, across, c, s = strained(y)
        axial, lateral = y[:, H] * c + y[:, V] * s, y[:, V] * c - y[:, H] * s
        j = np.zeros((4, 6, 6, len(u)))
        j[:, X, ANGLE] = length * (-along * s - across * c + stretch * lateral * c + slide * axial * s)
        j[:, Y, ANGLE] = length * (along * c - across * s + stretch * lateral * s - slide * axial * c)
        j[:, X, H], j[:, Y, V] = length * (stretch * c * c + slide * s * s), length * (stretch * s * s + slide * c * c)
        j[:, X, V] = j[:, Y, H] = length * (stretch - slide) * s * c
        j[:, ANGLE, MOMENT] = length * bend
        j[:, MOMENT] = j[:, Y] * y[:, None, H] - j[:, X] * y[:, None, V]
        j[:, MOMENT, H] += length * (along * s + across * c)
        j[:, MOMENT, V] -= length * (along * c - across * s)
        full = np.zeros((4, 6, 4, 6, len(u)))
        full[range(4), :, range(4)] = j
        return full.reshape(24, 24, -1)

    def conditions(displacement):
        def at_ends(first, last):
            a, b = first.reshape(4, 6), last.reshape(4, 6)
            turn = b[:, ANGLE] - ends
            clamped = [a[0, :2] - nodes["n1"], a[1, :2] - nodes["n2"], a[[0, 1], ANGLE] - rest[[0, 1], 0]]
            joined = [b[0, :2] - b[1, :2], a[2, :2] - b[0, :2], a[3, :2] - b[2, :2]]
            turned = [turn[0] - turn[1], a[2, ANGLE] - rest[2, 0] - turn[0], a[3, ANGLE] - rest[3, 0] - turn[2]]
            balanced = [b[0, MOMENT:] + b[1, MOMENT:] - a[2, MOMENT:], b[2, MOMENT:] - a[3, MOMENT:]]
            guided = [b[3, :2] - nodes["n5"] + [0, displacement], turn[3]]
            return np.hstack(clamped + joined + turned + balanced + guided)

        return at_ends

    # The conditions are linear: their Jacobians are columns of differences.
    zero, unit = np.zeros(24), np.eye(24)
    by_first = np.transpose([conditions(0)(e, zero) - conditions(0)(zero, zero) for e in unit])
    by_last = np.transpose([conditions(0)(zero, e) - conditions(0)(zero, zero) for e in unit])

    def curve():
        mesh = np.linspace(0, 1, int(intervals) + 1)
        at_rest = np.zeros((4, 6, len(mesh)))
        for beam in range(4):
            at_rest[beam, :2], at_rest[beam, ANGLE] = problem.points(beam, mesh).T, problem.angle(beam, mesh)
        state, forces = at_rest.reshape(24, -1), []
        for displacement in problem.displacements:
            solution = solve_bvp(change, conditions(displacement), mesh, state, tol=float(tolerance),
                                 fun_jac=jacobian, bc_jac=lambda first, last: (by_first, by_last))
            if solution.status != 0:
                raise RuntimeError(f"no convergence at {displacement} mm: {solution.message}")
            mesh, state = solution.x, solution.y
            forces.append(-state.reshape(4, 6, -1)[3, V, -1])
        return forces

    return curve


main(prepare, "scipy " + scipy.__version__)
