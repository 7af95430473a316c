"""Reads STEP files with OpenCASCADE: those of sample parts, and those that `export` writes for projects.

Usage: solids.py JOB.json, with {"folder", "binary", "root", "projects"}; the folder holds samples.json,
drums.json, springs.json and the files.
"""

import json
import pathlib
import subprocess
import sys

from checks import Failed, check, fail_on


# What STEP files of turned parts and springs may be off from their helices, mm.
SPLINE_ERROR = 1e-7


def check_solid(path, exact_mm3, wanted_faces=None, surface_error_mm=0.0):
    """One closed, valid solid of a volume, and of a number of faces where that is known; its surface may be off."""
    from OCP.BRep import BRep_Tool
    from OCP.BRepCheck import BRepCheck_Analyzer
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps
    from OCP.IFSelect import IFSelect_RetDone
    from OCP.STEPControl import STEPControl_Reader
    from OCP.TopAbs import TopAbs_FACE, TopAbs_SHELL, TopAbs_SOLID
    from OCP.TopExp import TopExp_Explorer

    problems = []

    def need(condition, message):
        if not condition:
            problems.append(message)

    reader = STEPControl_Reader()
    need(reader.ReadFile(str(path)) == IFSelect_RetDone, "cannot be read")
    checked = reader.WS().ModelCheckList()
    need(checked.IsEmpty(True), "entities with remarks")
    reader.TransferRoots()
    shape = reader.OneShape()

    def of_kind(kind):
        explorer, found = TopExp_Explorer(shape, kind), []
        while explorer.More():
            found.append(explorer.Current())
            explorer.Next()
        return found

    need(shape.ShapeType() == TopAbs_SOLID, f"is a {shape.ShapeType()}")
    shells = of_kind(TopAbs_SHELL)
    need((len(of_kind(TopAbs_SOLID)), len(shells)) == (1, 1), f"{len(of_kind(TopAbs_SOLID))} solids, {len(shells)} shells")
    need(all(BRep_Tool.IsClosed_s(shell) for shell in shells), "an open shell")
    need(BRepCheck_Analyzer(shape).IsValid(), "BRepCheck finds it invalid")
    faces = len(of_kind(TopAbs_FACE))
    need(wanted_faces in (None, faces), f"{faces} faces, expected {wanted_faces}")
    # The plain method takes few points on splines of many spans; Gauss and Kronrod's adapts.
    properties = GProp_GProps()
    BRepGProp.VolumePropertiesGK_s(shape, properties, 1e-12, False, True, False, False, False)
    error = properties.Mass() / exact_mm3 - 1
    allowed = 1e-9
    if surface_error_mm:
        surface = GProp_GProps()
        BRepGProp.SurfaceProperties_s(shape, surface, 1e-4)
        allowed += surface_error_mm * surface.Mass() / exact_mm3
    need(abs(error) < allowed, f"volume {properties.Mass()!r}, exactly {exact_mm3!r}: off by {error:.2e}")
    fail_on(problems)


def check_project(project, job):
    """Every part of a project, as its users get it."""
    out = pathlib.Path(job["folder"]) / "projects"
    command = [job["binary"], "export", project, "--format", "step", "--out", str(out), "--json"]
    run = subprocess.run(command, cwd=job["root"], capture_output=True, text=True, timeout=300, check=False)
    if run.returncode not in (0, 1):
        raise Failed(f"export ended with {run.returncode}: {run.stderr.strip()}")
    name, parts = pathlib.Path(project).stem, json.loads(run.stdout)["parts"]
    files = sorted(out.glob(f"{name}*.step"))
    if len(files) != len(parts):
        raise Failed(f"{len(files)} files for {len(parts)} parts")
    for part in parts:
        path = out / (f"{name}-{part['name']}.step" if len(parts) > 1 else f"{name}.step")
        # Grooves and wires are splines near helices.
        is_helical = "sections" in part or "windings" in part
        check_solid(path, 1e9 * part["volume"]["value"], surface_error_mm=SPLINE_ERROR if is_helical else 0.0)


def main():
    job = json.loads(pathlib.Path(sys.argv[1]).read_text("utf-8"))
    folder = pathlib.Path(job["folder"])
    for sample in json.loads((folder / "samples.json").read_text("utf-8")):
        exact_mm3 = sample["area_mm2"] * sample["depth_mm"]
        path = folder / f"{sample['name']}.step"
        check(f"{path.name} by OpenCASCADE", lambda: check_solid(path, exact_mm3, sample["faces"]))
    for drum in json.loads((folder / "drums.json").read_text("utf-8")):
        path = folder / f"{drum['name']}.step"
        check(f"{path.name} by OpenCASCADE", lambda: check_solid(path, drum["volume_mm3"], drum["faces"], SPLINE_ERROR))
    for spring in json.loads((folder / "springs.json").read_text("utf-8")):
        path = folder / f"{spring['name']}.step"
        check(f"{path.name} by OpenCASCADE", lambda: check_solid(path, spring["volume_mm3"], spring["faces"], SPLINE_ERROR))
    for project in job["projects"]:
        check(f"parts of {project} by OpenCASCADE", lambda: check_project(project, job))


if __name__ == "__main__":
    main()
