"""Reads the files of sample parts with tools that know nothing of this project.

Usage: parts.py JOB.json, with {"folder", "without_packages": reason or null}; the folder holds
samples.json, drums.json, springs.json, and a file per format.
"""

import cmath
import json
import math
import pathlib
import re
import sys
import xml.etree.ElementTree
import zipfile

from checks import Failed, NotRun, check, fail_on

SVG = "{http://www.w3.org/2000/svg}"
# Points on each element of a path.
POINTS = 600


class Findings(list):
    def need(self, condition, message):
        if not condition:
            self.append(message)

    def near(self, what, value, exact, tolerance):
        self.need(abs(value - exact) <= tolerance, f"{what} is {value!r}, exactly {exact!r}: off by {value - exact:.3e}, allowed {tolerance:.3e}")


# Points of the plane are complex numbers.


def arc_of_svg(start, end, radius, large, sweep):
    """Middle and angles of an arc, after SVG 2, appendix B.2.4, for circles."""
    half = (start - end) / 2
    factor = math.sqrt(max(radius**2 / abs(half) ** 2 - 1, 0))
    middle = (start + end) / 2 + (-1 if large == sweep else 1) * factor * complex(half.imag, -half.real)
    turn = cmath.phase((end - middle) / (start - middle))
    turn += math.tau if sweep and turn < 0 else -math.tau if not sweep and turn > 0 else 0
    return middle, turn


def points_of_path(text):
    """Points of a closed path, y upwards, and how many curves of each kind it has."""
    words = re.findall(r"[A-Z]|-?[0-9.]+", text)
    points, kinds, place, here = [], {}, 0, 0j
    while place < len(words):
        kind = words[place]
        count = {"M": 2, "L": 2, "A": 7, "C": 6, "Z": 0}[kind]
        numbers = [float(word) for word in words[place + 1 : place + 1 + count]]
        place += 1 + count
        kinds[kind] = kinds.get(kind, 0) + 1
        shares = [step / POINTS for step in range(POINTS)]
        if kind == "Z":
            continue
        end = complex(*numbers[-2:])
        if kind == "L":
            points += [here + share * (end - here) for share in shares]
        elif kind == "A":
            middle, turn = arc_of_svg(here, end, numbers[0], numbers[3], numbers[4])
            points += [middle + (here - middle) * cmath.exp(1j * turn * share) for share in shares]
        elif kind == "C":
            p, q = complex(*numbers[:2]), complex(*numbers[2:4])
            points += [(1 - t) ** 3 * here + 3 * (1 - t) ** 2 * t * p + 3 * (1 - t) * t**2 * q + t**3 * end for t in shares]
        here = end
    return [point.conjugate() for point in points], kinds


def area_of(points):
    return sum((a.conjugate() * b).imag for a, b in zip(points, points[1:] + points[:1])) / 2


def read_svg(sample, folder):
    root = xml.etree.ElementTree.parse(folder / f"{sample['name']}.svg").getroot()
    groups = {group.get("id"): group for group in root.iter(SVG + "g")}
    paths = [points_of_path(path.get("d")) for name in ("outline", "cutouts") for path in groups[name]]
    circles = [(complex(float(c.get("cx")), -float(c.get("cy"))), float(c.get("r"))) for c in groups["holes"]]
    return root, paths, circles


def check_svg(sample, folder):
    root, paths, circles = read_svg(sample, folder)
    found = Findings()
    left, top, width, height = map(float, root.get("viewBox").split())
    found.need((root.get("width"), root.get("height")) == (f"{width:.3f}mm", f"{height:.3f}mm"), f"not of true size: {root.attrib}")
    found.need(root.findtext(SVG + "title") == sample["title"], f"title is {root.findtext(SVG + 'title')!r}")
    found.need(len(paths) == 1 + sample["cutouts"], f"{len(paths)} paths")
    found.need([2 * radius for _, radius in circles] == sample["holes"], f"holes {circles}")
    for points, _ in paths:
        inside = all(left <= p.real <= left + width and top <= -p.imag <= top + height for p in points)
        found.need(inside, "a path leaves the drawing")
    area = sum(area_of(points) for points, _ in paths) - sum(math.pi * radius**2 for _, radius in circles)
    # Arcs as chords: a share of φ²/6 of what is between them, with φ below π/POINTS.
    found.near("area", area, sample["area_mm2"], 1e-5 * sample["area_mm2"])
    fail_on(found)


def area_of_bulges(corners):
    """Area in straight lines, and what arcs add: r²/2 (φ − sin φ), with the bulge tan(φ/4)."""
    area = 0.0
    for (x, y, bulge), (u, v, _) in zip(corners, corners[1:] + corners[:1]):
        area += (x * v - u * y) / 2
        if bulge:
            angle = 4 * math.atan(bulge)
            radius = math.hypot(u - x, v - y) / (2 * math.sin(angle / 2))
            area += radius**2 / 2 * (angle - math.sin(angle))
    return area


def distances(points, polylines):
    """Distance of each point from the nearest line or arc."""
    import numpy

    points = numpy.array(points)
    nearest = numpy.full(len(points), numpy.inf)
    for corners in polylines:
        for (x, y, bulge), (u, v, _) in zip(corners, corners[1:] + corners[:1]):
            start, end = complex(x, y), complex(u, v)
            share = numpy.clip(((points - start) / (end - start)).real, 0, 1)
            distance = abs(points - start - share * (end - start))
            if bulge:
                angle = 4 * math.atan(bulge)
                middle = (start + end) / 2 + 1j * (end - start) / (2 * math.tan(angle / 2))
                turn = numpy.angle((points - middle) / (start - middle)) * math.copysign(1, angle)
                ends = numpy.minimum(abs(points - start), abs(points - end))
                distance = numpy.where(turn % math.tau <= abs(angle), abs(abs(points - middle) - abs(start - middle)), ends)
            nearest = numpy.minimum(nearest, distance)
    return nearest


def check_dxf(sample, folder, reason):
    if reason:
        raise NotRun(reason)
    import ezdxf
    from ezdxf.lldxf.encoding import decode_dxf_unicode

    document = ezdxf.readfile(folder / f"{sample['name']}.dxf")
    found = Findings()
    audit = document.audit()
    found += [f"audit: {entry.message}" for entry in [*audit.errors, *audit.fixes]]
    header = {name: document.header.get(name) for name in ("$ACADVER", "$INSUNITS", "$MEASUREMENT")}
    found.need(header == {"$ACADVER": "AC1015", "$INSUNITS": 4, "$MEASUREMENT": 1}, f"header {header}")
    layers = {"OUTLINE": "LWPOLYLINE", "CUTOUTS": "LWPOLYLINE", "HOLES": "CIRCLE", "NOTES": "TEXT"}
    on = {layer: [entity for entity in document.modelspace() if entity.dxf.layer == layer] for layer in layers}
    found.need(sum(map(len, on.values())) == len(document.modelspace()), "entities on other layers")
    for layer, kind in layers.items():
        found.need(layer in document.layers, f"no layer {layer}")
        found.need(all(entity.dxftype() == kind for entity in on[layer]), f"{layer}: {[entity.dxftype() for entity in on[layer]]}")
    found.need((len(on["OUTLINE"]), len(on["CUTOUTS"])) == (1, sample["cutouts"]), "not a polyline for each profile")
    polylines = on["OUTLINE"] + on["CUTOUTS"]
    found.need(all(polyline.closed for polyline in polylines), "an open polyline")
    found.need([2 * circle.dxf.radius for circle in on["HOLES"]] == sample["holes"], "holes differ")
    notes = [decode_dxf_unicode(text.dxf.text) for text in on["NOTES"]]
    found.need(notes and notes[0] == sample["title"].replace("%%", "% %"), f"first note is {notes[:1]}")
    found.need(f"Splines are drawn as arcs within {sample['arc_error_mm']} mm." in notes, "no note of the error of arcs")
    corners = [list(polyline.get_points("xyb")) for polyline in polylines]
    area = sum(map(area_of_bulges, corners)) - sum(math.pi * circle.dxf.radius**2 for circle in on["HOLES"])
    _, paths, circles = read_svg(sample, folder)
    has_splines = any("C" in kinds for _, kinds in paths)
    found.near("area", area, sample["area_mm2"], (1e-4 if has_splines else 1e-10) * sample["area_mm2"])
    # What the drawing holds exactly is followed as closely as was promised.
    worst = max(distances(points, corners).max() for points, _ in paths)
    found.need(worst <= (sample["arc_error_mm"] if has_splines else 1e-9), f"{worst} mm from the SVG")
    centres = [complex(circle.dxf.center.x, circle.dxf.center.y) for circle in on["HOLES"]]
    found.need(all(abs(a - b) < 1e-9 for a, (b, _) in zip(centres, circles)), "holes are elsewhere than in the SVG")
    fail_on(found)


def loaded_mesh(sample, folder, extension, found):
    """A mesh that must be whole, in one piece, and of the right genus."""
    import trimesh

    scene = trimesh.load_scene(folder / f"{sample['name']}.{extension}")
    mesh = scene.to_mesh()
    if extension == "3mf":
        found.need(scene.units in ("mm", "millimeter"), f"units {scene.units}")
    found.need(mesh.is_watertight, "not watertight")
    found.need(mesh.is_winding_consistent, "winding differs from triangle to triangle")
    found.need(mesh.area_faces.min() > 0, "a triangle without area")
    parts = trimesh.graph.connected_components(mesh.face_adjacency, engine="networkx")
    found.need(len(parts) == 1, f"{len(parts)} parts")
    return mesh


def check_mesh(sample, folder, extension, reason):
    if reason:
        raise NotRun(reason)
    import numpy

    found = Findings()
    mesh = loaded_mesh(sample, folder, extension, found)
    holes = sample["cutouts"] + len(sample["holes"])
    found.need(mesh.euler_number == 2 - 2 * holes, f"Euler number {mesh.euler_number} with {holes} holes")
    found.need(numpy.allclose(mesh.bounds[:, 2], [0, sample["depth_mm"]], rtol=1e-7), f"between z = {mesh.bounds[:, 2]}")
    # Corners are rounded to single precision: 4·10⁻⁶ mm at 100 mm.
    strip = (sample["facet_error_mm"] + 1e-5) * sample["boundary_mm"]
    found.near("volume", float(mesh.volume), sample["area_mm2"] * sample["depth_mm"], strip * sample["depth_mm"])
    fail_on(found)


def check_drum_mesh(drum, folder, extension, reason):
    if reason:
        raise NotRun(reason)
    import numpy

    found = Findings()
    mesh = loaded_mesh(drum, folder, extension, found)
    found.need(mesh.euler_number == (0 if drum["has_bore"] else 2), f"Euler number {mesh.euler_number}")
    found.need(numpy.allclose(mesh.bounds[:, 2], [0, drum["length_mm"]], rtol=1e-7), f"between z = {mesh.bounds[:, 2]}")
    reach = numpy.linalg.norm(mesh.vertices[:, :2], axis=1).max()
    found.near("radius", float(reach), drum["radius_mm"], 1e-5)
    # Facets lie within the chord error; corners are rounded to single precision.
    found.near("volume", float(mesh.volume), drum["volume_mm3"], (drum["facet_error_mm"] + 1e-5) * float(mesh.area))
    fail_on(found)


def check_drum_dxf(drum, folder, reason):
    if reason:
        raise NotRun(reason)
    import ezdxf

    document = ezdxf.readfile(folder / f"{drum['name']}.dxf")
    found = Findings()
    audit = document.audit()
    found += [f"audit: {entry.message}" for entry in [*audit.errors, *audit.fixes]]
    on = {layer: [e for e in document.modelspace() if e.dxf.layer == layer] for layer in ("OUTLINE", "CENTRE", "NOTES")}
    found.need(sum(map(len, on.values())) == len(document.modelspace()), "entities on other layers")
    found.need("CENTRE" in document.layers, "no layer CENTRE")
    found.need([e.dxftype() for e in on["OUTLINE"] + on["CENTRE"]] == ["LWPOLYLINE", "LINE"], "not one outline and one centre line")
    area = area_of_bulges(list(on["OUTLINE"][0].get_points("xyb")))
    found.near("area of the half section", area, drum["half_section_mm2"], 1e-9 * drum["half_section_mm2"])
    fail_on(found)


def check_drum_svg(drum, folder):
    root = xml.etree.ElementTree.parse(folder / f"{drum['name']}.svg").getroot()
    groups = {group.get("id"): group for group in root.iter(SVG + "g")}
    points, _ = points_of_path(groups["outline"][0].get("d"))
    found = Findings()
    found.near("area of the half section", area_of(points), drum["half_section_mm2"], 1e-5 * drum["half_section_mm2"])
    found.near("length", max(p.real for p in points) - min(p.real for p in points), drum["length_mm"], 1e-9)
    ends = [float(groups["centre"][0].get(name)) for name in ("x1", "y1", "x2", "y2")]
    found.need(ends[:2] == [0, 0] and ends[3] == 0 and abs(ends[2] - drum["length_mm"]) < 1e-9, f"centre line {ends}")
    fail_on(found)


def check_spring_mesh(spring, folder, extension, reason):
    if reason:
        raise NotRun(reason)
    import numpy

    found = Findings()
    mesh = loaded_mesh(spring, folder, extension, found)
    found.need(mesh.euler_number == 2, f"Euler number {mesh.euler_number}")
    for name, bound in zip(("low_mm", "high_mm"), mesh.bounds):
        off = float(abs(bound - numpy.array(spring[name])).max())
        found.need(off <= spring["facet_error_mm"] + 1e-5, f"{name}: {bound} for {spring[name]}")
    # Facets lie within the chord error, most of them inside; corners are rounded to single precision.
    error = float(mesh.volume) - spring["volume_mm3"]
    allowed = (spring["facet_error_mm"] + 1e-5) * spring["surface_mm2"]
    found.need(-allowed < error < 1e-5 * spring["surface_mm2"], f"volume {mesh.volume} for {spring['volume_mm3']}")
    fail_on(found)


def check_spring_dxf(spring, folder, reason):
    if reason:
        raise NotRun(reason)
    import ezdxf

    document = ezdxf.readfile(folder / f"{spring['name']}.dxf")
    found = Findings()
    audit = document.audit()
    found += [f"audit: {entry.message}" for entry in [*audit.errors, *audit.fixes]]
    layers = ("OUTLINE", "END", "CENTRE", "NOTES")
    on = {layer: [e for e in document.modelspace() if e.dxf.layer == layer] for layer in layers}
    found.need(sum(map(len, on.values())) == len(document.modelspace()), "entities on other layers")
    found.need(all(layer in document.layers for layer in layers), "a layer is missing")
    found.need({e.dxftype() for e in on["OUTLINE"]} == {"LWPOLYLINE"}, "no lines of the side view")
    found.need(not any(e.closed for e in on["OUTLINE"]), "a closed line in the side view")
    diameters = [2 * e.dxf.radius for e in on["END"]]
    wanted = [spring["outer_mm"], spring["inner_mm"]]
    found.need(all(abs(a - b) < 1e-9 for a, b in zip(diameters, wanted)) and len(diameters) == 2, f"diameters {diameters}")
    corners = [point for e in on["OUTLINE"] for point in e.get_points("xy")]
    # The side view: z to the right, x upwards.
    for axis, of in ((0, 2), (1, 0)):
        low, high = min(c[axis] for c in corners), max(c[axis] for c in corners)
        found.near("least coordinate", low, spring["low_mm"][of], 2.1 * spring["arc_error_mm"])
        found.near("greatest coordinate", high, spring["high_mm"][of], 2.1 * spring["arc_error_mm"])
    fail_on(found)


def check_spring_svg(spring, folder):
    root = xml.etree.ElementTree.parse(folder / f"{spring['name']}.svg").getroot()
    groups = {group.get("id"): group for group in root.iter(SVG + "g")}
    found = Findings()
    radii = [float(circle.get("r")) for circle in groups["end"]]
    wanted = [spring["outer_mm"], spring["inner_mm"]]
    found.need(len(radii) == 2 and all(abs(2 * r - d) < 1e-9 for r, d in zip(radii, wanted)), f"radii {radii}")
    numbers = [pair.split() for path in groups["outline"] for pair in path.get("d")[1:].split("L")]
    across = [-float(y) for _, y in numbers]
    along = [float(x) for x, _ in numbers]
    for name, values, of in (("along", along, 2), ("across", across, 0)):
        found.near(f"least {name}", min(values), spring["low_mm"][of], 2.1 * spring["arc_error_mm"])
        found.near(f"greatest {name}", max(values), spring["high_mm"][of], 2.1 * spring["arc_error_mm"])
    fail_on(found)


def check_package(sample, folder):
    with zipfile.ZipFile(folder / f"{sample['name']}.3mf") as package:
        found = Findings()
        names = package.namelist()
        found.need(names == ["[Content_Types].xml", "_rels/.rels", "3D/3dmodel.model"], f"holds {names}")
        found.need(package.testzip() is None, f"wrong checksum of {package.testzip()}")
        found.need(all(entry.date_time == (1980, 1, 1, 0, 0, 0) for entry in package.infolist()), "dates differ from day to day")
        for name in names:
            xml.etree.ElementTree.fromstring(package.read(name))
        fail_on(found)


def main():
    job = json.loads(pathlib.Path(sys.argv[1]).read_text("utf-8"))
    folder, reason = pathlib.Path(job["folder"]), job["without_packages"]
    samples = json.loads((folder / "samples.json").read_text("utf-8"))
    if not samples:
        raise Failed("no samples")
    for sample in samples:
        name = sample["name"]
        check(f"{name}.svg", lambda: check_svg(sample, folder))
        check(f"{name}.dxf by ezdxf", lambda: check_dxf(sample, folder, reason))
        for extension in ("stl", "3mf"):
            check(f"{name}.{extension} by trimesh", lambda: check_mesh(sample, folder, extension, reason))
        check(f"{name}.3mf as a package", lambda: check_package(sample, folder))
    for drum in json.loads((folder / "drums.json").read_text("utf-8")):
        name = drum["name"]
        check(f"{name}.svg", lambda: check_drum_svg(drum, folder))
        check(f"{name}.dxf by ezdxf", lambda: check_drum_dxf(drum, folder, reason))
        for extension in ("stl", "3mf"):
            check(f"{name}.{extension} by trimesh", lambda: check_drum_mesh(drum, folder, extension, reason))
        check(f"{name}.3mf as a package", lambda: check_package(drum, folder))
    for spring in json.loads((folder / "springs.json").read_text("utf-8")):
        name = spring["name"]
        check(f"{name}.svg", lambda: check_spring_svg(spring, folder))
        check(f"{name}.dxf by ezdxf", lambda: check_spring_dxf(spring, folder, reason))
        for extension in ("stl", "3mf"):
            check(f"{name}.{extension} by trimesh", lambda: check_spring_mesh(spring, folder, extension, reason))
        check(f"{name}.3mf as a package", lambda: check_package(spring, folder))


if __name__ == "__main__":
    main()
