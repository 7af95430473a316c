"""JAX: shooting with six unknowns as in `peer_scipy_shooting.py`, the whole curve compiled; beams that stretch and shear.

`intervals` of the classical Runge-Kutta method per beam, Newton's method with the forward-mode Jacobian, double precision, one thread.
`gradient=forward` or `reverse` also returns the derivatives of all forces by the 13 parameters of `peer_curve`, by `jacfwd` or `jacrev`
of the converged states, which are differentiated implicitly (one more Newton step, whose matrix is a constant).
"""

import os

os.environ["XLA_FLAGS"] = "--xla_cpu_multi_thread_eigen=false intra_op_parallelism_threads=1"

import jax
import jax.numpy as jnp
import numpy as np
from common import GAUSS, main
from jax import lax

jax.config.update("jax_enable_x64", True)


def closed(angles, chord):
    """Coefficients and length of a beam with given bend coefficients that spans a chord."""
    u = jnp.asarray((GAUSS[0] + 1) / 2)
    angle, weights = angles[0] * u + angles[1] * u**2, jnp.asarray(GAUSS[1] / 2)
    x, y = weights @ jnp.cos(angle), weights @ jnp.sin(angle)
    # The turn from the unit beam's chord to the given one.
    turn = jnp.arctan2(chord[1] * x - chord[0] * y, chord[0] * x + chord[1] * y)
    return jnp.array([turn, angles[0], angles[1]]), jnp.hypot(*chord) / jnp.hypot(x, y)


def prepare(problem, model, intervals, tolerance, gradient=""):
    bend0, stretch0, slide0 = problem.flexibilities(model)
    n, tolerance, step = int(intervals), float(tolerance), 1 / int(intervals)
    fixed = {name: jnp.array(place) for name, place in problem.nodes.items()}
    free, bends = np.array([problem.nodes["n3"], problem.nodes["n4"]]), problem.angles[:, 1:]
    parameters = jnp.array([*free.ravel(), *bends.ravel(), problem.thickness])

    def design(p):
        """Angles, lengths and flexibilities of 13 parameters."""
        place = {**fixed, "n3": p[0:2], "n4": p[2:4]}
        beams = [closed(p[4 + 2 * i : 6 + 2 * i], place[end] - place[start]) for i, (start, end) in enumerate(problem.ends)]
        thick = p[12] / problem.thickness
        return jnp.stack([b[0] for b in beams]), jnp.stack([b[1] for b in beams]), (bend0 / thick**3, stretch0 / thick, slide0 / thick)

    def beam(angles, length, flexibility, x, y, angle, moment, h, v):
        bend, stretch, slide = flexibility

        def moment_at(s):
            return moment - (s[0] - x) * v + (s[1] - y) * h

        def change(u, s):
            c, sn = jnp.cos(s[2]), jnp.sin(s[2])
            along, across = 1 + stretch * (h * c + v * sn), slide * (v * c - h * sn)
            slope = angles[1] + 2 * angles[2] * u + length * bend * moment_at(s)
            return jnp.stack([length * (along * c - across * sn), length * (along * sn + across * c), slope])

        def advance(s, i):
            u = i * step
            k1 = change(u, s)
            k2 = change(u + step / 2, s + step / 2 * k1)
            k3 = change(u + step / 2, s + step / 2 * k2)
            k4 = change(u + step, s + step * k3)
            return s + step / 6 * (k1 + 2 * k2 + 2 * k3 + k4), None

        s, _ = lax.scan(advance, jnp.stack([x, y, angle]), jnp.arange(n, dtype=float))
        return s, moment_at(s)

    def gap(z, displacement, beams):
        angles, lengths, flex = beams
        ends, start = angles.sum(axis=1), jnp.stack([fixed["n1"], fixed["n2"]])
        both = jax.vmap(beam, in_axes=(0, 0, None, 0, 0, 0, 0, 0, 0))
        (a, b), moments = both(angles[:2], lengths[:2], flex, start[:, 0], start[:, 1], angles[:2, 0], z[2::3], z[0::3], z[1::3])
        turn, h, v = a[2] - ends[0], z[0] + z[3], z[1] + z[4]
        c, moment = beam(angles[2], lengths[2], flex, a[0], a[1], angles[2, 0] + turn, moments.sum(), h, v)
        d, _ = beam(angles[3], lengths[3], flex, c[0], c[1], angles[3, 0] + c[2] - ends[2], moment, h, v)
        # Rotations in units of 0.1 rad, to weigh as much as mm.
        joint = jnp.stack([a[0] - b[0], a[1] - b[1], 10 * (turn - b[2] + ends[1])])
        return jnp.concatenate([joint, d[:2] - fixed["n5"] + jnp.array([0, displacement]), 10 * (d[2:] - ends[3])])

    stations = jnp.array(problem.displacements)

    def states(beams):
        def station(carry, displacement):
            now, before = carry

            def correct(s):
                z, _, count = s
                r = gap(z, displacement, beams)
                return z - jnp.linalg.solve(jax.jacfwd(gap)(z, displacement, beams), r), jnp.abs(r).max(), count + 1

            go_on = lambda s: (s[1] > tolerance) & (s[2] < 25)
            z, _, _ = lax.while_loop(go_on, correct, (2 * now - before, jnp.inf, 0))
            return (z, now), z

        return lax.scan(station, (jnp.zeros(6), jnp.zeros(6)), stations)[1]

    def forces(p):
        beams = design(p)
        converged = states(lax.stop_gradient(beams))

        def implicit(z, displacement):
            matrix = lax.stop_gradient(jax.jacfwd(gap)(z, displacement, beams))
            return z - jnp.linalg.solve(matrix, gap(z, displacement, beams))

        z = jax.vmap(implicit)(converged, stations) if gradient else converged
        return -(z[:, 1] + z[:, 4])

    if not gradient:
        compiled = jax.jit(forces)
        return lambda: compiled(parameters).block_until_ready()
    derive = {"forward": jax.jacfwd, "reverse": jax.jacrev}[gradient]
    compiled = jax.jit(lambda p: (forces(p), derive(forces)(p)))
    # In SI units: N/m for lengths.
    unit = np.array([1e3] * 4 + [1] * 8 + [1e3])
    answer = lambda f, j: {"force_n": f.tolist(), "jacobian": (np.asarray(j) * unit).tolist()}
    return lambda: answer(*jax.block_until_ready(compiled(parameters)))


main(prepare, "jax " + jax.__version__)
