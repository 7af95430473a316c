"""Errors, ratios and Markdown of the measurements."""

from statistics import median


def largest_error(values, reference):
    """Largest difference relative to the largest value."""
    return max(abs(a - b) for a, b in zip(values, reference, strict=True)) / max(map(abs, reference))


def error(case, answer, converged):
    """Of the forces; of the derivatives, the worst parameter's."""
    reference = converged[case.model]
    if not case.gradient:
        return largest_error(answer["force_n"], reference["force_n"])
    columns = zip(zip(*answer["jacobian"]), zip(*reference["jacobian"]), strict=True)
    return max(largest_error(column, exact) for column, exact in columns)


def summary(case, result):
    """What is kept of all samples of a case; times in s."""
    kept = {"peer": case.peer, "title": case.title, "model": case.model, "accuracy": case.accuracy, "setting": case.setting()}
    kept |= {"status": result.status, "reason": result.reason, "gradient": case.gradient}
    if result.cpu:
        kept |= {"version": result.version, "error": result.error, "samples": len(result.cpu)}
        kept |= {"cpu_median_s": median(result.cpu), "cpu_min_s": min(result.cpu)}
        kept |= {"wall_median_s": median(result.wall), "wall_min_s": min(result.wall), "first_call_s": median(result.first)}
    if result.process_wall:
        kept |= {"process_wall_s": median(result.process_wall), "process_cpu_s": median(result.process_cpu)}
    return kept


def add_ratios(rows):
    """Processor time relative to ours of the same work, by medians and by minima."""
    ours = {(row["model"], row["accuracy"], row["gradient"], row["title"]): row for row in rows if row["peer"] == "forcewright"}
    names = {"fast": "`CurveSolver`", "general": "`trace`", "gradient": "`trace` and gradients"}
    names |= {"reduced": "reduced model", "multibody": "general multibody engine"}
    for row in rows:
        for name, title in names.items():
            base = ours.get((row["model"], row["accuracy"], row["gradient"], title))
            if base and "cpu_min_s" in base and "cpu_min_s" in row:
                row[f"ratio_to_{name}"] = row["cpu_median_s"] / base["cpu_median_s"]
                row[f"ratio_to_{name}_by_minima"] = row["cpu_min_s"] / base["cpu_min_s"]


def digits(value, suffix=""):
    """Three digits."""
    if value is None:
        return "–"
    return f"{value:.3g}{suffix}" if value < 1000 else f"{value:.0f}{suffix}"


def line(row, ratios):
    head = [row["title"], row["model"], row["accuracy"]]
    if "cpu_min_s" not in row:
        return [*head, f"*{row['status']}*: {row['reason']}", *[""] * (5 + len(ratios))]
    milliseconds = [digits(1e3 * row[key]) for key in ("cpu_median_s", "cpu_min_s", "wall_median_s")]
    process = digits(row["first_call_s"] if row["gradient"] else row.get("process_wall_s"))
    found = f"{row['error']:.1e}" + ("" if row["status"] == "ok" else " **too large**")
    return [*head, row["setting"], found, *milliseconds, process, *(digits(row.get(f"ratio_to_{name}"), "×") for name in ratios)]


def table(heads, lines):
    rows = [heads, ["---"] * len(heads), *lines]
    return "\n".join("| " + " | ".join(row) + " |" for row in rows)


def markdown(results):
    """All tables, ordered by model, accuracy and time."""
    order = lambda row: (row["model"], -float(row["accuracy"]), row.get("cpu_median_s", float("inf")))
    columns = ["setting", "error", "CPU ms", "least", "elapsed ms"]
    parts = []
    moves = lambda row: row["model"] == "motion"
    for belongs, title, ratios, heads in (
        (lambda row: not moves(row) and not row["gradient"], "Force curve", ("fast", "general"), ["process s", "to `CurveSolver`", "to `trace`"]),
        (lambda row: row["gradient"], "Force curve and its derivatives by 13 parameters", ("gradient",), ["first call s", "to ours"]),
        (moves, "The cam in motion", ("reduced", "multibody"), ["process s", "to the reduced model", "to the general engine"]),
    ):
        rows = sorted(filter(belongs, results["cases"]), key=order)
        if rows:
            lines = [line(row, ratios) for row in rows]
            parts.append(f"### {title}\n\n" + table(["tool", "model", "asked", *columns, *heads], lines))
    checks = "; ".join(f"{check['model']}: {check['result']}" for check in results["checks"])
    if checks:
        parts.append(f"Converged curves against SciPy shooting at tolerance 1e-11, largest difference: {checks}.")
    machine = results["machine"]
    parts.append(
        f"{machine['processor']}, {machine['cores']} cores, load {machine['load_before']} before and {machine['load_after']} after; "
        + f"{machine['system']}; {results['date']}; " + ", ".join(results["versions"]) + "."
    )
    return "\n\n".join(parts) + "\n"
