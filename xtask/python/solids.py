"""Reads the STEP files of sample parts with OpenCASCADE.

Usage: solids.py JOB.json, with {"folder"}; the folder holds samples.json and the files.
"""

import json
import pathlib
import sys

from checks import check, fail_on


def check_solid(sample, folder):
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
    need(reader.ReadFile(str(folder / f"{sample['name']}.step")) == IFSelect_RetDone, "cannot be read")
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
    need(faces == sample["faces"], f"{faces} faces, expected {sample['faces']}")
    # The plain method takes few points on splines of many spans; Gauss and Kronrod's adapts.
    properties = GProp_GProps()
    BRepGProp.VolumePropertiesGK_s(shape, properties, 1e-12, False, True, False, False, False)
    exact = sample["area_mm2"] * sample["depth_mm"]
    error = properties.Mass() / exact - 1
    need(abs(error) < 1e-9, f"volume {properties.Mass()!r}, exactly {exact!r}: off by {error:.2e}")
    fail_on(problems)


def main():
    job = json.loads(pathlib.Path(sys.argv[1]).read_text("utf-8"))
    folder = pathlib.Path(job["folder"])
    for sample in json.loads((folder / "samples.json").read_text("utf-8")):
        check(f"{sample['name']}.step by OpenCASCADE", lambda: check_solid(sample, folder))


if __name__ == "__main__":
    main()
