"""Makes a solid of an exported plane mesh: wedges of 15 nodes over half the depth, for CalculiX.

Usage: extrude_inp.py PLANE.inp SOLID.inp YOUNG_MPA POISSON LAYERS INCREMENTS

The plane amid the depth is one of symmetry. Of a mirrored part only the half with x > 0 is kept (the halves meet in rigid pads), so that the
total force of the moved set is a quarter of that of the part.
"""

import pathlib
import sys


def read(path):
    """Nodes, triangles, sets of nodes by name, lines of data below every other keyword."""
    nodes, triangles, sets, others, keyword = {}, [], {}, {}, ""
    for line in pathlib.Path(path).read_text("utf-8").splitlines():
        if line.startswith("**"):
            continue
        if line.startswith("*"):
            keyword = line
            continue
        words = [word.strip() for word in line.split(",") if word.strip()]
        if keyword.startswith("*NODE, "):
            nodes[int(words[0])] = (float(words[1]), float(words[2]))
        elif keyword.startswith("*ELEMENT"):
            triangles.append([int(word) for word in words[1:]])
        elif keyword.startswith("*NSET"):
            sets.setdefault(keyword.split("=")[1], []).extend(int(word) for word in words)
        else:
            others.setdefault(keyword, []).append(words)
    return nodes, triangles, sets, others


def extruded(plane, young_mpa, poisson, layers, increments):
    nodes, triangles, sets, others = read(plane)
    depth = float(next(data for keyword, data in others.items() if keyword.startswith("*SOLID SECTION"))[0][0])
    triangles = [t for t in triangles if sum(nodes[n][0] for n in t[:3]) > 0]
    used = sorted({n for t in triangles for n in t})
    corners = {n for t in triangles for n in t[:3]}
    count = max(nodes)

    def levels(n):
        """Nodes amid the sides of triangles have none amid the height of a layer."""
        return range(0, 2 * layers + 1, 1 if n in corners else 2)

    def number(n, level):
        return level * count + n

    lines = ["*NODE, NSET=ALL"]
    for n in used:
        x, y = nodes[n]
        lines += [f"{number(n, level)}, {x}, {y}, {0.5 * depth * level / (2 * layers)}" for level in levels(n)]
    lines.append("*ELEMENT, TYPE=C3D15, ELSET=PART")
    for layer in range(layers):
        low, amid, high = 2 * layer, 2 * layer + 1, 2 * layer + 2
        for k, t in enumerate(triangles):
            at = [(n, level) for part in (t[:3], t[3:]) for level in (low, high) for n in part] + [(n, amid) for n in t[:3]]
            numbers = [str(number(*place)) for place in at]
            lines += [f"{layer * len(triangles) + k + 1}, " + ", ".join(numbers[:9]) + ",", ", ".join(numbers[9:])]
    lines += ["*MATERIAL, NAME=MATERIAL", "*ELASTIC", f"{young_mpa}, {poisson}", "*SOLID SECTION, ELSET=PART, MATERIAL=MATERIAL"]
    kept = set(used)
    for name, members in sets.items():
        lines += [f"*NSET, NSET={name}"] + [f"{number(n, level)}," for n in members if n in kept for level in levels(n)]
    lines += ["*NSET, NSET=AMID"] + [f"{number(n, 0)}," for n in used] + ["*BOUNDARY", "AMID, 3"]
    bounds = others["*BOUNDARY"]
    lines += [f"{words[0]}, 1, 3" for words in bounds if len(words) == 3]
    moved = [words for words in bounds if len(words) == 4]
    lines += ["*STEP, NLGEOM, INC=1000", "*STATIC, DIRECT", f"{1 / increments}, 1", "*BOUNDARY"]
    lines += [", ".join(words) for words in moved] + [f"{name}, 3, 3" for name in sorted({words[0] for words in moved})]
    for name in sorted({words[0] for words in moved}):
        lines += [f"*NODE PRINT, NSET={name}, TOTALS=YES", "RF"]
    return "\n".join([*lines, "*END STEP", ""])


def main():
    plane, solid, young_mpa, poisson, layers, increments = sys.argv[1:]
    pathlib.Path(solid).write_text(extruded(plane, float(young_mpa), float(poisson), int(layers), int(increments)), "utf-8")


if __name__ == "__main__":
    main()
