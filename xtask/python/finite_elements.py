"""Compares force curves of beams with those of plane finite elements of the same parts, by CalculiX.

Usage: finite_elements.py JOB.json, with {"binary", "root", "folder", "element", "reference"}: the program, the root of the workspace, a
folder for files, the sides of the elements, and the curves to hold the new ones against (null for none). Writes curves.csv to the folder.
"""

import concurrent.futures
import csv
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

from checks import Failed, NotRun, check, fail_on

MECHANISM = "examples/compliant/lan-table3.toml"
# A cutter of nearly no size leaves corners nearly sharp; a fillet of no radius is no part of the language.
SHARP = ["process.cutter_diameter=0.002 mm", "parts.fillet=0.05 mm"]
# One straight beam between two clamps: its joints are those of both models, so that nothing but the elements can differ.
GUIDE = """schema = 1
mechanism = "compliant"
[material]
use = "POM-C"
young_modulus = "2 GPa"
[parts]
fillet = "0.02 mm"
[design]
thickness = "1 mm"
depth = "10 mm"
[design.nodes]
a = { at = ["0 mm", "0 mm"], support = "clamped" }
b = { at = ["30 mm", "0 mm"], support = "slider", direction = [0, 1] }
[[design.beams]]
name = "s"
between = ["a", "b"]
straight = true
[load]
node = "b"
direction = [0, 1]
travel = "1 mm"
"""
TOTAL = re.compile(r"total force \(fx,fy,fz\) for set (\S+) and time\s+(\S+)\s+(\S+)\s+(\S+)")


class Bench:
    def __init__(self, job):
        self.binary, self.root, self.element = job["binary"], pathlib.Path(job["root"]), job["element"]
        self.folder = pathlib.Path(job["folder"])
        self.ccx = shutil.which("ccx") or shutil.which("ccx.exe")

    def forcewright(self, *arguments):
        # 1 is a requirement that is missed, which is no matter here.
        done = subprocess.run([self.binary, *map(str, arguments)], cwd=self.root, capture_output=True, text=True)
        if done.returncode not in (0, 1):
            raise Failed(*done.stderr.splitlines()[:3])

    def beams(self, name, project, settings):
        """Displacements in mm and forces in N of the beams."""
        out = self.folder / f"{name}-beams"
        self.forcewright("solve", project, "--out", out, *sets(settings))
        with open(out / "curves.csv", encoding="utf-8", newline="") as file:
            rows = list(csv.reader(file))
        place = {head.split(" / ")[0]: index for index, head in enumerate(rows[0])}
        units = {head.split(" / ")[0]: head.split(" / ")[-1] for head in rows[0]}
        if (units["displacement"], units["force"]) != ("mm", "N"):
            raise Failed(f"curves are in {units['displacement']} and {units['force']}")
        return [(float(row[place["displacement"]]), float(row[place["force"]])) for row in rows[1:]]

    def elements(self, name, project, settings, moved, travel, sense):
        """The same of the elements, at every increment: the force of the set of nodes that is moved along y."""
        if self.ccx is None:
            raise NotRun("no ccx (CalculiX) in the path; Debian has it in the package calculix-ccx")
        out = self.folder / f"{name}-elements"
        self.forcewright("export", project, "--format", "inp", "--element", self.element, "--out", out, *sets(settings))
        stem = pathlib.Path(project).stem
        with open(out / "ccx.log", "w", encoding="utf-8") as log:
            threads = {"OMP_NUM_THREADS": "1"}
            done = subprocess.run([self.ccx, stem], cwd=out, stdout=log, stderr=log, env=os.environ | threads)
        if done.returncode != 0:
            raise Failed(f"ccx ended with {done.returncode}; see {out / 'ccx.log'}")
        found = TOTAL.findall((out / f"{stem}.dat").read_text("utf-8"))
        return [(0.0, 0.0)] + [(travel * float(time), sense * float(fy)) for at, time, _, fy in found if at.endswith(moved)]


def sets(settings):
    return [word for setting in settings for word in ("--set", setting)]


def between(curve, displacement):
    """The force of a curve at a displacement, by the cubic through the four stations around."""
    after = next((k for k, point in enumerate(curve) if point[0] >= displacement - 1e-9), len(curve) - 1)
    first = min(max(after - 2, 0), len(curve) - 4)
    four = curve[first : first + 4]
    total = 0.0
    for i, (x, force) in enumerate(four):
        weight = 1.0
        for j, (other, _) in enumerate(four):
            weight *= 1.0 if i == j else (displacement - other) / (x - other)
        total += weight * force
    return total


def range_ratio(curve):
    """The paper's operational range over the travel: from where the force last rises through 95 % of its end."""
    end, force = curve[-1]
    steps = [end * k / 4000 for k in range(4001)]
    forces = [between(curve, x) for x in steps]
    rises = [x for x, low, high in zip(steps[1:], forces, forces[1:]) if low < 0.95 * force <= high]
    return (end - rises[-1]) / end if rises else float("nan")


def difference(curve, other):
    """Largest difference at the stations of a curve, over its force at the end."""
    return max(abs(force - between(other, x)) for x, force in curve) / curve[-1][1]


def say(name, curve):
    print(f"{name}: {curve[-1][1]:.4f} N at {curve[-1][0]:g} mm, range {100 * range_ratio(curve):.2f} %", flush=True)


def check_guide(bench):
    path = bench.folder / "guide.toml"
    path.write_text(GUIDE, "utf-8")
    elements = bench.elements("guide", path, [], "_B", 1.0, 1.0)
    off = difference(elements, bench.beams("guide", path, []))
    print(f"a straight guided beam: off by {100 * off:.2f} % of the force at the end", flush=True)
    fail_on([f"off by {100 * off:.2f} %, 0.5 % allowed"] if off > 0.005 else [])


def curves_of(bench):
    """The mechanism by elements, with fillets and nearly without."""
    with concurrent.futures.ThreadPoolExecutor() as pool:
        tasks = {
            name: pool.submit(bench.elements, name, MECHANISM, settings, "_N5", 13.6, -1.0)
            for name, settings in {"fillets": [], "sharp": SHARP}.items()
        }
    curves = {name: task.result() for name, task in tasks.items()}
    with open(bench.folder / "curves.csv", "w", encoding="utf-8", newline="\n") as file:
        file.write("displacement / mm,force with fillets of 0.5 mm / N,force with fillets of 0.05 mm / N\n")
        for (x, fillets), (_, sharp) in zip(curves["fillets"], curves["sharp"]):
            file.write(f"{x:.6g},{fillets:.7g},{sharp:.7g}\n")
    return curves


def check_mechanism(bench, reference):
    curves = curves_of(bench)
    for joints in ("point", "overlap"):
        beams = bench.beams(joints, MECHANISM, [f"model.joints={joints}"])
        say(f"beams, joints = {joints}", beams)
        for name, curve in curves.items():
            off = difference(curve, beams)
            print(f"  elements, {name}: off by at most {100 * off:.2f} % of their force at the end", flush=True)
    for name, curve in curves.items():
        say(f"elements, {name}", curve)
    if reference is None:
        return
    with open(reference, encoding="utf-8", newline="") as file:
        rows = [row for row in csv.reader(line for line in file if not line.startswith("#"))][1:]
    problems = []
    for column, name in enumerate(("fillets", "sharp"), start=1):
        known = [(float(row[0]), float(row[column])) for row in rows]
        off = difference(known, curves[name])
        print(f"{name}: off by {100 * off:.3f} % from {pathlib.Path(reference).name}", flush=True)
        if off > 0.005:
            problems.append(f"{name}: off by {100 * off:.2f} % from the reference, 0.5 % allowed")
    fail_on(problems)


def main():
    job = json.loads(pathlib.Path(sys.argv[1]).read_text("utf-8"))
    bench = Bench(job)
    bench.folder.mkdir(parents=True, exist_ok=True)
    check("a straight guided beam by CalculiX", lambda: check_guide(bench))
    check("the mechanism of Table 3 by CalculiX", lambda: check_mechanism(bench, job["reference"]))


if __name__ == "__main__":
    main()
