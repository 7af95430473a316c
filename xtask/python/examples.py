"""Reads schema, project files and results with tools that know nothing of this project.

Usage: examples.py JOB.json, with {"schemas": {family: file}, "examples": [{"file", "results"}], "without_jsonschema": reason or null}
"""

import csv
import hashlib
import json
import math
import pathlib
import re
import sys

from checks import Failed, NotRun, check, fail_on

STATES = {"met", "missed", "not assessed"}


def validator(path, reason):
    """The validator of a schema file, after the schema itself was validated."""
    if reason:
        raise NotRun(reason)
    import jsonschema

    schema = json.loads(pathlib.Path(path).read_text("utf-8"))
    if "2020-12" not in schema.get("$schema", ""):
        raise Failed(f"$schema is {schema.get('$schema')!r}, not draft 2020-12")
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator(schema)


def merged(path, seen=()):
    """The project file with what it extends: the child wins."""
    try:
        import tomllib
    except ImportError:
        raise NotRun("Python is older than 3.11 and has no tomllib") from None
    path = path.resolve()
    if path in seen:
        raise Failed(f"{path.name} extends itself")
    data = tomllib.loads(path.read_text("utf-8"))
    if "extends" not in data:
        return data
    base = merged(path.parent / data.pop("extends"), (*seen, path))
    return over(base, data)


def over(base, child):
    if not (isinstance(base, dict) and isinstance(child, dict)):
        return child
    return base | {key: over(base[key], value) if key in base else value for key, value in child.items()}


def check_file(example, validators):
    data = merged(pathlib.Path(example["file"]))
    if data.get("mechanism") not in validators:
        raise Failed(f"no schema for mechanism {data.get('mechanism')!r}")
    known = validators[data["mechanism"]]
    if known is None:
        raise NotRun("the schema was not validated")
    errors = sorted(known.iter_errors(data), key=lambda error: [str(part) for part in error.absolute_path])
    fail_on([f"{'.'.join(map(str, error.absolute_path)) or '(file)'}: {error.message}"[:300] for error in errors])


def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)


def refuse(word):
    raise Failed(f"{word} is no JSON")


def no_results():
    raise NotRun("no example was solved")


def check_result(example):
    """The shape of result.json, as the documentation promises it."""
    # Python would read NaN and Infinity, which are no JSON.
    text = (pathlib.Path(example["results"]) / "result.json").read_text("utf-8")
    result = json.loads(text, parse_constant=refuse)
    problems = []

    def need(condition, message):
        if not condition:
            problems.append(message)

    need(result.get("schema") == 1, f"schema is {result.get('schema')!r}")
    for key in ("forcewright", "mechanism", "title"):
        need(isinstance(result.get(key), str) and result[key], f"{key} is {result.get(key)!r}")
    need(re.fullmatch(r"[0-9a-f]{64}", str(result.get("input_sha256"))), f"input_sha256 is {result.get('input_sha256')!r}")
    need(isinstance(result.get("status"), dict) and isinstance(result["status"].get("kind"), str), f"status is {result.get('status')!r}")
    need(result.get("metrics"), "no metrics")
    for name, metric in result.get("metrics", {}).items():
        need(isinstance(metric, dict) and "unit" in metric and (metric.get("value") is None or is_number(metric["value"])), f"metric {name}: {metric}")
    for item in result.get("checks", []):
        known = isinstance(item, dict) and re.fullmatch(r"[A-Z]+[0-9]{3}", str(item.get("code"))) and item.get("state") in STATES
        need(known, f"check {item}")
    need(result.get("checks"), "no checks")
    need(result.get("curves"), "no curves")
    for curve in result.get("curves", []):
        need(curve.get("name") and all(curve.get(axis, {}).get(key) is not None for axis in "xy" for key in ("name", "unit")), f"axes of curve {curve.get('name')}")
        need(curve.get("branches"), f"curve {curve.get('name')} has no branches")
        for branch in curve.get("branches", []):
            x, y = branch.get("x", []), branch.get("y", [])
            good = len(x) == len(y) >= 2 and all(map(is_number, x)) and all(map(is_number, y))
            need(good, f"curve {curve.get('name')}, branch {branch.get('name')}: {len(x)} and {len(y)} values, or some are no numbers")
    for key in ("sources", "warnings"):
        need(isinstance(result.get(key), list), f"{key} is {result.get(key)!r}")
    need(result.get("sources"), "no sources")
    fail_on(problems)


def stands_alone(example):
    """Whether the project is this one file."""
    return not re.search(r"^\s*(?:extends|(?:.*[\s{,])?(?:[\w.]*_)?file)\s*=", pathlib.Path(example["file"]).read_text("utf-8"), re.M)


def check_sum(example):
    """The sum of a project of one file is that of the file, so that anybody can verify it."""
    result = json.loads((pathlib.Path(example["results"]) / "result.json").read_text("utf-8"))
    found = hashlib.sha256(pathlib.Path(example["file"]).read_bytes()).hexdigest()
    if found != result.get("input_sha256"):
        raise Failed(f"input_sha256 is {result.get('input_sha256')}, the file's is {found}")


def check_curves(example):
    """The shape of curves.csv: one head, equal rows, numbers throughout a column."""
    with open(pathlib.Path(example["results"]) / "curves.csv", encoding="utf-8", newline="") as stream:
        rows = [row for row in csv.reader(stream, strict=True) if row and not row[0].startswith("#")]
    if len(rows) < 3:
        raise Failed(f"{len(rows)} rows")
    head, *rows = rows
    problems = []
    if not all(head) or len(set(head)) != len(head):
        problems.append(f"head: {head}")
    if any(is_text_number(field) for field in head):
        problems.append(f"the first row is no head: {head}")
    problems += [f"row {number}: {len(row)} fields, not {len(head)}" for number, row in enumerate(rows, 2) if len(row) != len(head)]
    if not problems:
        columns = [[row[place] for row in rows if row[place]] for place in range(len(head))]
        numeric = [sum(map(is_text_number, column)) for column in columns]
        problems += [f"column {name}: {count} of {len(column)} are finite numbers" for name, column, count in zip(head, columns, numeric) if 0 < count < len(column)]
        if sum(count > 0 for count in numeric) < 2:
            problems.append("fewer than two columns of numbers")
    fail_on(problems)


def is_text_number(text):
    try:
        return math.isfinite(float(text))
    except ValueError:
        return False


def main():
    job = json.loads(pathlib.Path(sys.argv[1]).read_text("utf-8"))
    reason = job["without_jsonschema"]
    validators = {}
    for family, path in job["schemas"].items():
        validators[family] = check(f"schema of {family} is valid (draft 2020-12)", lambda path=path: validator(path, reason))
    for example in job["examples"]:
        name = example["file"]
        check(f"{name} against the schema", lambda: check_file(example, validators))
        check(f"{name}: result.json", lambda: check_result(example))
        if stands_alone(example):
            check(f"{name}: input_sha256 is the file's", lambda: check_sum(example))
        check(f"{name}: curves.csv", lambda: check_curves(example))
    if not job["examples"]:
        check("results", no_results)


if __name__ == "__main__":
    main()
