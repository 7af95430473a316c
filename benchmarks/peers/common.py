"""What the scripts of all tools share: the mechanism, meshes on its curved beams, the clock, the output.

A script is called as `peer_x.py PROBLEM SAMPLES key=value...`; PROBLEM is the JSON of `peer_curve problem`, the keys are the options
of its function `curve`. It prints one line of JSON: the forces of one curve, the time of a first call, and the times of SAMPLES
further ones. Every call starts from rest. Units here are mm, N and MPa, so that displacements and forces are numbers near 1.
"""

import json
import sys
import time

import numpy as np

GAUSS = np.polynomial.legendre.leggauss(12)


class Problem:
    """The mechanism: nodes, beams, stiffnesses of the one section, displacements of the driven node (downwards)."""

    def __init__(self, data):
        self.nodes = {name: 1e3 * np.array(place) for name, place in data["nodes_m"].items()}
        self.ends = [(beam["start"], beam["end"]) for beam in data["beams"]]
        self.angles = np.array([beam["angle_rad"] for beam in data["beams"]])
        self.lengths = 1e3 * np.array([beam["length_m"] for beam in data["beams"]])
        self.thickness = 1e3 * data["thickness_m"]
        self.bending, self.axial, self.shear = 1e6 * data["bending_n_m2"], data["axial_n"], data["shear_n"]
        self.displacements = 1e3 * np.array(data["stations_m"])
        # The cam in motion, SI.
        self.motion = data["motion"]
        # The scripts know this topology: two clamped beams meet in n3, two more lead to the guide at n5, which cannot turn.
        assert self.ends == [("n1", "n3"), ("n2", "n3"), ("n3", "n4"), ("n4", "n5")]
        assert data["load_node"] == "n5" and np.allclose(data["direction"], [0, -1])

    def flexibilities(self, model):
        """1/EI, 1/EA, 1/GA of a beam model: 0 where it is rigid."""
        axial, shear = {"inextensible": (0, 0), "EA": (1 / self.axial, 0), "EA+GA": (1 / self.axial, 1 / self.shear)}[model]
        return 1 / self.bending, axial, shear

    def angle(self, beam, u):
        """Angle at rest at u in [0, 1]."""
        return np.polyval(self.angles[beam][::-1], u)

    def points(self, beam, u):
        """Exact points of a beam at rest at ascending u, the first of which is 0."""
        places = [self.nodes[self.ends[beam][0]]]
        for a, b in zip(u[:-1], u[1:]):
            angle = self.angle(beam, (a + b) / 2 + (b - a) / 2 * GAUSS[0])
            places.append(places[-1] + self.lengths[beam] * (b - a) / 2 * np.array([GAUSS[1] @ np.cos(angle), GAUSS[1] @ np.sin(angle)]))
        return np.array(places)

    def mesh(self, intervals):
        """Points with equal arc lengths between them: coordinates, their indices along each beam, indices of the named nodes."""
        places, named, along = list(self.nodes.values()), {name: i for i, name in enumerate(self.nodes)}, []
        for beam, (start, end) in enumerate(self.ends):
            inner = self.points(beam, np.linspace(0, 1, intervals + 1))[1:-1]
            along.append([named[start], *range(len(places), len(places) + len(inner)), named[end]])
            places.extend(inner)
        return np.array(places), along, named


def main(prepare, version):
    """Runs a script. `prepare(problem, **options)` returns the function that is timed: one curve, from rest, as its forces."""
    with open(sys.argv[1]) as file:
        problem = Problem(json.load(file))
    options = dict(word.split("=") for word in sys.argv[3:])
    start = time.perf_counter()
    curve = prepare(problem, **options)
    result = curve()
    first = time.perf_counter() - start
    cpu, wall = [], []
    for _ in range(int(sys.argv[2])):
        start, processor = time.perf_counter(), time.process_time()
        result = curve()
        cpu.append(time.process_time() - processor)
        wall.append(time.perf_counter() - start)
    answer = result if isinstance(result, dict) else {"force_n": [float(force) for force in result]}
    print(json.dumps({"version": version, "first_s": first, "cpu_s": cpu, "wall_s": wall, **answer}))
