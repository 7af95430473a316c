#!/usr/bin/env python3
"""The same force curve by other tools and by ours, in one run, with ratios: see README.md beside this file.

Needs Rust and Python 3.11 or newer; the tools are installed in a virtual environment under the target folder.
"""

import argparse
import datetime
import json
import os
import platform
import subprocess
import sys
import time
import venv
from dataclasses import dataclass, field
from pathlib import Path

import cases
import tables

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
ONE_THREAD = {name: "1" for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS")}
# No process needs a tenth of this, s.
PATIENCE = 600
WORKS = ("beams", "motion")
# Both references must agree to this.
AGREEMENT = 1e-8


@dataclass
class Result:
    """Everything measured of a case."""

    status: str = "ok"
    reason: str = ""
    version: str = ""
    error: float = 0.0
    cpu: list = field(default_factory=list)
    wall: list = field(default_factory=list)
    first: list = field(default_factory=list)
    process_wall: list = field(default_factory=list)
    process_cpu: list = field(default_factory=list)


def say(text):
    print(text, file=sys.stderr, flush=True)


class NotRun(Exception):
    """The tool is not there."""


class Tools:
    """Our binary, the Python of the peers, and the problem that all solve."""

    def __init__(self):
        say("building ours")
        command = ["cargo", "build", "--quiet", "--release", "--package", "forcewright-benchmarks", "--example", "peer_curve"]
        subprocess.run(command, cwd=ROOT, check=True)
        metadata = ["cargo", "metadata", "--format-version", "1", "--no-deps"]
        target = Path(json.loads(subprocess.check_output(metadata, cwd=ROOT))["target_directory"])
        self.folder = target / "peers"
        self.folder.mkdir(parents=True, exist_ok=True)
        self.binary = target / "release/examples" / ("peer_curve.exe" if os.name == "nt" else "peer_curve")
        self.problem = self.folder / "problem.json"
        self.problem.write_bytes(subprocess.check_output([self.binary, "problem"]))
        self.converged = json.loads(self.problem.read_text())["converged"]
        self.python = self.environment()

    def environment(self):
        """The Python of a virtual environment with the pinned packages; made anew when pins or Python change."""
        folder, pins = self.folder / "venv", (HERE / "requirements.txt").read_text()
        python = folder / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
        wanted, done = f"{sys.version}\n{pins}", folder / "installed.txt"
        if done.exists() and done.read_text() == wanted:
            return python
        say("installing the peers")
        try:
            venv.create(folder, clear=True, with_pip=True)
        except (OSError, subprocess.CalledProcessError) as failure:
            say(f"no virtual environment: {failure}")
            return python
        pip = [python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-input", "--retries", "1"]
        if subprocess.run([*pip, "--requirement", HERE / "requirements.txt"], stdout=sys.stderr).returncode == 0:
            done.write_text(wanted)
        else:
            # What can be had alone; what is missing then is reported by those who need it.
            for pin in pins.splitlines():
                subprocess.run([*pip, "--no-deps", pin], stdout=sys.stderr, stderr=subprocess.DEVNULL)
        return python

    def call(self, case, samples):
        """The answer of one process, its elapsed time and its processor time, s."""
        program = [self.binary] if case.method else [self.python, HERE / case.script]
        if not program[0].exists():
            raise NotRun(f"there is no {program[0].name}")
        before, start = os.times(), time.perf_counter()
        done = subprocess.run(
            [*program, *case.arguments(self.problem, samples)], capture_output=True, text=True, timeout=PATIENCE, env={**os.environ, **ONE_THREAD}
        )
        wall, after = time.perf_counter() - start, os.times()
        if done.returncode != 0:
            last = (done.stderr.strip().splitlines() or [f"exit code {done.returncode}"])[-1]
            missing = any(f"{name}:" in done.stderr for name in ("ModuleNotFoundError", "ImportError", "OSError"))
            raise NotRun(last) if missing else RuntimeError(last)
        cpu = after.children_user + after.children_system - before.children_user - before.children_system
        # Some tools greet or say goodbye on standard output.
        return json.loads(next(text for text in done.stdout.splitlines() if text.startswith("{"))), wall, cpu


def measure(tools, case, result, samples, alone):
    """One round of a case; `alone` also runs a process that does nothing but one curve."""
    try:
        answer, _, _ = tools.call(case, samples)
        if alone:
            _, wall, cpu = tools.call(case, 0)
            result.process_wall.append(wall)
            result.process_cpu.append(cpu)
    except NotRun as missing:
        result.status, result.reason = "not run", str(missing)
        return
    except (RuntimeError, subprocess.TimeoutExpired) as failure:
        result.status, result.reason = "failed", str(failure)
        return
    result.version = answer["version"]
    result.cpu += answer["wall_s"] if None in answer["cpu_s"] else answer["cpu_s"]
    result.wall += answer["wall_s"]
    result.first.append(answer["first_s"])
    result.error = tables.error(case, answer, tools.converged)
    if result.error > float(case.accuracy):
        result.status, result.reason = "failed", f"error {result.error:.1e}"


def compare(tools, wanted, rounds, samples):
    """All cases, interleaved over the rounds, so that what else the machine does hits all alike."""
    results = {id(case): Result() for case in wanted}
    for round_ in range(rounds):
        for case in wanted:
            # Compiling the derivatives takes half a minute: fewer rounds, and no process alone.
            if results[id(case)].status != "ok" or (case.gradient and round_ > rounds // 3):
                continue
            say(f"round {round_ + 1} of {rounds}: {case.title}, {case.model}, {case.accuracy}")
            measure(tools, case, results[id(case)], samples, alone=round_ < 3 and not case.gradient)
    return [tables.summary(case, results[id(case)]) for case in wanted]


def check_references(tools):
    """Our converged curves against an independent one for each beam model."""
    found = []
    for case in cases.CHECKS:
        say(f"independent reference: {case.model}")
        try:
            difference = tables.error(case, tools.call(case, 0)[0], tools.converged)
            status = "ok" if difference <= AGREEMENT else "failed"
            found.append({"model": case.model, "status": status, "difference": difference, "result": f"{difference:.1e}"})
        except NotRun as missing:
            found.append({"model": case.model, "status": "not run", "result": f"not run ({missing})"})
        except (RuntimeError, subprocess.TimeoutExpired) as failure:
            found.append({"model": case.model, "status": "failed", "result": f"failed ({failure})"})
    return found


def search(tools, methods, samples):
    """Prints the settings that reach each accuracy in the least time; see `cases.Method`."""
    for method in methods:
        for accuracy in method.pinned:
            best = (float("inf"), None)
            for tolerance in method.tolerances:
                for cost, settings in coarsest(tools, method, accuracy, tolerance, samples):
                    say(f"{method.title}, {accuracy}: {settings}: {1e3 * cost:.2f} ms")
                    best = min(best, (cost, settings), key=lambda found: found[0])
            print(f"{method.title}, {accuracy}: {best[1]}, {1e3 * best[0]:.2f} ms", flush=True)


def coarsest(tools, method, accuracy, tolerance, samples):
    """Time and settings of the coarsest mesh that is accurate enough, if there is one; of all such among `method.meshes`."""

    def attempt(mesh):
        settings = {method.mesh: mesh, "tolerance": tolerance} if method.mesh else {"tolerance": tolerance}
        case = method.case(accuracy, settings, method in cases.GRADIENTS)
        try:
            answer, _, _ = tools.call(case, samples)
        except RuntimeError:
            return None
        good = tables.error(case, answer, tools.converged) <= float(accuracy)
        return (min(answer["cpu_s"]), settings) if good else None

    if method.meshes:
        return [found for mesh in method.meshes if (found := attempt(mesh))]
    fine, coarse = 1, 0
    while not (found := attempt(fine)):
        coarse, fine = fine, 2 * fine
        if fine > method.finest:
            return []
    while fine - coarse > 1:
        middle = (coarse + fine) // 2
        if better := attempt(middle):
            fine, found = middle, better
        else:
            coarse = middle
    return [found]


def load():
    return f"{os.getloadavg()[0]:.1f}" if hasattr(os, "getloadavg") else "unknown"


def processor():
    info = Path("/proc/cpuinfo")
    names = [text.split(":")[1].strip() for text in info.read_text().splitlines() if text.startswith("model name")] if info.exists() else []
    return names[0] if names else platform.processor() or platform.machine()


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="2 rounds of 3 samples instead of 5 of 7")
    parser.add_argument("--peer", choices=cases.PEERS, help="only this one beside ours")
    parser.add_argument("--work", choices=WORKS, help="only the force curve (and its derivatives) of beams, or only the cam in motion")
    parser.add_argument("--search", action="store_true", help="find the settings pinned in cases.py anew, and measure nothing else")
    arguments = parser.parse_args()
    rounds, samples = (2, 3) if arguments.quick else (5, 7)
    work = lambda one: WORKS[one.model == cases.MOTION_MODEL]
    chosen = lambda one: (arguments.peer in (None, one.peer) or one.peer == "forcewright") and arguments.work in (None, work(one))
    tools = Tools()
    if arguments.search:
        search(tools, [method for method in cases.METHODS + cases.GRADIENTS + cases.MOTIONS if chosen(method)], 3)
        return 0
    before = load()
    checks = check_references(tools) if arguments.work != "motion" else []
    everything = cases.CURVES + cases.DERIVATIVES + cases.IN_MOTION
    rows = compare(tools, [case for case in everything if chosen(case)], rounds, samples)
    tables.add_ratios(rows)
    machine = {"processor": processor(), "cores": os.cpu_count(), "load_before": before, "load_after": load(), "system": platform.platform()}
    rust = subprocess.check_output(["rustc", "--version"], text=True, cwd=ROOT).strip()
    versions = [*dict.fromkeys(row["version"] for row in rows if "version" in row), f"Python {platform.python_version()}", rust]
    results = {"date": datetime.date.today().isoformat(), "rounds": rounds, "samples": samples, "machine": machine}
    results |= {"versions": versions, "checks": checks, "cases": rows}
    (tools.folder / "results.json").write_text(json.dumps(results, indent=1) + "\n")
    print(tables.markdown(results))
    missing = sorted({row["title"] for row in rows if row["status"] == "not run"})
    failed = sorted({f"{row['title']} ({row['reason']})" for row in rows if row["status"] == "failed"})
    failed += [f"reference {check['model']}" for check in checks if check["status"] == "failed"]
    print(f"not run: {', '.join(missing) or 'none'}\nfailed: {', '.join(failed) or 'none'}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
