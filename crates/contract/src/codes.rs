//! The long story behind every code of the project file. Families add their own.

use forcewright_base::diagnostics::Explanation;

const fn code(code: &'static str, title: &'static str, text: &'static str) -> Explanation {
    Explanation { code, title, text }
}

/// Codes that do not depend on the family: `E01xx` files and syntax, `E02xx` values, `E03xx` keys and names, `W…` warnings.
pub const CODES: &[Explanation] = &[
    code(
        "E0101",
        "a file cannot be read",
        "The file does not exist, or the system refuses to read it. Exit code 4.\n\nPaths in `extends` and of files of data (`target_file = \"wanted.csv\"`) are relative to the file that names them.",
    ),
    code(
        "E0102",
        "not UTF-8 text",
        "Project files are UTF-8. The message names the first byte that is not. Editors call the setting \"encoding\".",
    ),
    code(
        "E0103",
        "file too large",
        "A project file has a few kilobytes; at most 1 MiB is read. Measured data belongs into CSV files that the project names.",
    ),
    code("E0104", "not a file", "The path names a directory, a pipe or a device. Exit code 4."),
    code(
        "E0105",
        "not valid TOML",
        "Project files are written in TOML 1.0: `[table]` headers, `key = value` lines, texts in quotes, `#` comments.\n\nExample:\n\n    [design]\n    thickness = \"1 mm\"     # a text, because it has a unit\n\nThe most frequent causes are a missing quote and a bracket that is not closed.",
    ),
    code(
        "E0106",
        "a key is given twice",
        "TOML allows each key once per table. Keep one. To keep two values at hand, use `[variants.name]`.",
    ),
    code(
        "E0107",
        "nested too deep",
        "Brackets or dotted keys nest deeper than any project file needs. Look for a bracket that is not closed.",
    ),
    code(
        "E0108",
        "files extend one another in a circle",
        "A file may extend another, which may extend a third, at most 16 in a row, but the chain must end. Remove one `extends`.",
    ),
    code(
        "E0110",
        "no such variant",
        "`--variant NAME` chooses one of the tables `[variants.NAME]` of the file (or of a file that it extends).",
    ),
    code(
        "E0111",
        "a setting is not understood",
        "`--set KEY=VALUE` replaces one value for this run. KEY is the dotted path of the project file, members of lists by name:\n\n    --set design.thickness=\"0.9 mm\"\n    --set design.beams.b1.bend=\"[1.2, -1.5]\"\n\nA single number of a list or a point is named by its place, counted from 1, or by `x` and `y`:\n\n    --set design.beams.b1.bend.2=-1.5\n    --set design.nodes.n3.at.x=\"30 mm\"\n\nThe value is read as in the file; quotes that the shell takes away do no harm.",
    ),
    code(
        "E0112",
        "a table of data is not understood",
        "Data that a project names stands in a CSV file:\n\n    # measured on the bench\n    travel / mm, force / N\n    2.0, 5.1\n    4.0, 7.3\n\nThe first line that is no comment names the columns, each with its unit behind `/`. Below it stand numbers with decimal points, as many in each line as the header has columns. Columns are separated by commas, or by semicolons where the header has one. A record of `[measurements]` may have decimal commas, with `decimal = \"comma\"` beside its file and semicolons between columns. The message names line and column in the file.",
    ),
    code(
        "E0201",
        "wrong quantity",
        "The unit is known, but it is the unit of something else: a force where a length is needed, a torque where an energy is needed (N·m and J are kept apart on purpose).",
    ),
    code(
        "E0202",
        "not a number",
        "A quantity starts with a decimal number with a point: `12.5 mm`, `2e-5 m`. Decimal commas are refused, because `1,234` means different numbers in different countries.",
    ),
    code(
        "E0203",
        "unknown unit",
        "Units are products and quotients of known symbols: `mm`, `N/mm`, `kg*m^2`, `N·m/rad`. Capitals matter: `MPa`, `mN`.",
    ),
    code(
        "E0204",
        "out of range",
        "The value is a number of the right kind, but outside of what the parameter can mean. The message names the range in the unit typed.",
    ),
    code("E0205", "not a finite number", "`nan`, `inf` and numbers beyond 1.8e308 cannot be computed with."),
    code(
        "E0206",
        "wrong kind of value",
        "A text where a list is needed, a table where a number is needed, and the like. Values with units are texts in quotes; counts and coefficients are bare numbers.",
    ),
    code(
        "E0207",
        "not a tolerance",
        "After `±` (or `+/-`) stands a positive half width in the same quantity, or a percentage: `0.85 mm ± 0.02 mm`, `0.85 mm ± 2 %`. Lengths also take general tolerances, `30 mm ISO 2768-m`, and diameters ISO 286 fits, `17.6 mm h7`.",
    ),
    code(
        "E0208",
        "unit missing",
        "Every number with a dimension carries its unit, in quotes: `thickness = \"1 mm\"`. Bare numbers are dimensionless. So nobody has to guess.",
    ),
    code(
        "E0209",
        "not a fit of ISO 286, nor a tolerance of ISO 2768",
        "A fit is a position and a grade of ISO 286-1: `h7`, `js6`, `JS9`; capitals are positions of holes, small letters of shafts. Positions from `a` to `zc` (without `cd`, `ef`, `fg`) and grades 01, 0 and 1 to 18 are known for diameters up to 500 mm. Not every position exists at every diameter and with every grade: `t6` begins above 24 mm, `J9` does not exist.\n\nThe fit stands behind the nominal diameter: `17.6 mm h7` is made between 17.582 mm and 17.6 mm. An analysis takes the nominal diameter; a tolerance study scatters about the middle of the zone. Where no fit says what is meant, write a half width: `17.591 mm ± 0.009 mm`.\n\nAny length takes a general tolerance of ISO 2768-1, table 1, as well: `30 mm ISO 2768-m` is `30 mm ± 0.2 mm`. Its classes are f, m, c and v; the letter of form and position behind them (`mK`) says nothing about a length.",
    ),
    code(
        "E0301",
        "unknown key",
        "The key is not part of the language at this place. The help names the nearest known one. Keys that only comment belong into `#` comments.",
    ),
    code(
        "E0302",
        "a key is missing",
        "The table needs this key. What it means is said in the help and in the parameter table of the documentation (`forcewright schema`).",
    ),
    code("E0303", "unknown word", "The parameter takes one of a closed set of words; the help lists them."),
    code(
        "E0304",
        "unknown name",
        "A name refers to a member (a node, a beam) that the file does not define, or a path to an entry that a list does not have: `bend.3` of two numbers.",
    ),
    code("E0305", "two keys exclude each other", "Only one of the two can be given, because both say the same thing. Keep one."),
    code(
        "E0306",
        "not available in this version",
        "The key is part of the language, but this version of the program cannot do it yet. It is refused rather than ignored, because ignoring it would give another mechanism.",
    ),
    code("E0307", "a name is given twice", "Members of a list are called by name in paths and reports, so names are unique."),
    code(
        "E0308",
        "unknown material",
        "`material.use` names an entry of the catalogue. Without `use`, give `young_modulus`, `poisson_ratio` and `yield_stress` yourself.",
    ),
    code("E0309", "unknown mechanism", "`mechanism` names one of the families of this program; the help lists them."),
    code(
        "E0311",
        "wrong number of entries",
        "A list is too short or too long: a point has two coordinates, a beam joins two nodes, and no collection has more than 500 members.",
    ),
    code(
        "E0312",
        "a study's number is not found",
        "`[optimise.variables]`, `[tolerance.parameters]`, the members of `[tolerance.groups]` and `[calibrate.parameters]` name numbers by their paths, as `--set` does, or many at once by a pattern:\n\n    \"design.thickness\"         one number\n    \"design.nodes.n3.at\"       both coordinates of a point\n    \"design.nodes.n3.at.x\"     one of them\n    \"design.beams.*.bend\"      every bend coefficient of every beam\n    \"design.beams.b*.bend.1\"   the first of every beam whose name begins with b\n\nA pattern that means no number is an error, because it is nearly always a slip. What a study may change is said in the help: a search changes the design and the motor that is chosen for it; scatter, what it is made of and its errors too; a calibration, also losses, surroundings, bodies, and numbers of the bench (`bench.offset`, `bench.compliance`). What is required, and how it is loaded, stays in all of them.",
    ),
    code(
        "E0313",
        "a study cannot change this number",
        "The number exists, but the family does not know what the design becomes when it changes; the label says why. Common causes: a node of a rigid body, which moves as one with the others; a node at which a beam ends that is given by `angle` or `through`, which would no longer meet it (give it by `bend`, whose shape follows the nodes); a thickness that no beam has.\n\nTake the number out of the study, or describe the design so that it can move.",
    ),
    code(
        "E0315",
        "not an objective",
        "`[optimise]` has one `objective`: `{ minimise = … }` or `{ maximise = … }` with a name of the section Objectives of `docs/reference/<family>-parameters.md`, which `forcewright schema <family> --format markdown` prints. Some have one sense only: a deviation is made small, a usable stroke is made large.",
    ),
    code(
        "E0317",
        "the study is not described",
        "The command needs a section of the project file that says what is asked for. A search for a better design needs at least\n\n    [optimise]\n    objective = { maximise = \"flat_ratio\" }\n    [optimise.variables]\n    \"design.nodes.n3.at\"  = { within = \"5 mm\" }\n    \"design.beams.*.bend\" = { range = [-3, 3] }\n\nExamples are printed by `forcewright new`.",
    ),
    code(
        "E0318",
        "the result cannot be written into the file",
        "The design found is written into a copy of the project file, with its comments, each number in its own unit. One of the numbers has no place there: the message names its path, and something else, such as a text or a list of another shape, stands where it would go. Write that part of the design as the examples do.",
    ),
    code(
        "E0320",
        "a fit of a number that is no diameter",
        "ISO 286 fits such as `h7` are deviations of diameters of shafts and holes. The parameter is another length, for which a fit would be a guess. Write the half width: `17.6 mm ± 0.009 mm`.",
    ),
    code(
        "E0920",
        "goals of a trade-off",
        "`[pareto]` has two or three goals: metrics of the family, as in `requirements.limits`, each named once, in `minimise` or in `maximise`:\n\n    [pareto]\n    maximise = [\"stiffness_tangent_output\"]\n    minimise = [\"shaft_load\"]\n\nWith one goal, `forcewright optimise` finds more with less work. A design whose analysis does not give one of them (an efficiency without friction) has no values, and every other design beats it.",
    ),
    code(
        "E0921",
        "values of a trade-off",
        "`[pareto.vary]` says for each path which values it may have:\n\n    \"design.input_diameter\" = { range = [\"10 mm\", \"20 mm\"] }                     # any\n    \"design.output_diameter\" = { range = [\"80 mm\", \"160 mm\"], step = \"5 mm\" }   # in steps\n    \"design.gears.sun\" = { range = [12, 24] }                                   # whole numbers\n    \"design.cables.1.use\" = { among = [\"steel 7x7 0.54 mm\", \"steel 7x19 1 mm\"] }\n\nPaths are those of `--set`, without patterns; they name keys of `[design]` or of another section that says what is built, never `mechanism`, `requirements`, or the sections of studies.",
    ),
    code(
        "W0101",
        "a section is not used",
        "The section is part of the language, but this family does not use it (such as `[environment]` of compliant mechanisms). It does not change any result.",
    ),
];
