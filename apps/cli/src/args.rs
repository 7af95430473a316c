//! The command line's grammar.

use clap::builder::PossibleValuesParser;
use clap::{Arg, ArgAction, Command, ValueHint};

const EXIT_CODES: &str = "Exit codes: 0 requirements met, 1 a requirement missed or not assessed, 2 error in the file or the call, 3 travel or accuracy not reached, 4 input/output, 130 interrupted.";

/// The whole command.
pub(crate) fn command() -> Command {
    Command::new("forcewright")
        .version(forcewright::VERSION)
        .about("Passive force-shaping mechanisms of robots: a force curve in, a mechanism out.")
        .after_help(EXIT_CODES)
        .disable_help_subcommand(true)
        .subcommand(new())
        .subcommand(check())
        .subcommand(solve())
        .subcommand(synthesise())
        .subcommand(optimise())
        .subcommand(pareto())
        .subcommand(sweep())
        .subcommand(merge())
        .subcommand(tolerance())
        .subcommand(compare())
        .subcommand(calibrate())
        .subcommand(export())
        .subcommand(reproduce())
        .subcommand(explain())
        .subcommand(materials())
        .subcommand(schema())
        .subcommand(completions())
}

fn file() -> Arg {
    Arg::new("file").value_name("FILE").required(true).value_hint(ValueHint::FilePath).value_parser(clap::value_parser!(std::path::PathBuf))
}

fn choices(command: Command) -> Command {
    command.arg(Arg::new("variant").long("variant").value_name("NAME").help("Use a variant of the file")).arg(
        Arg::new("set")
            .long("set")
            .value_name("KEY=VALUE")
            .action(ArgAction::Append)
            .help("Replace one value for this run, such as design.thickness=\"0.9 mm\" (may be repeated)"),
    )
}

/// Where results go: a folder, if nothing else is said.
fn out(help: &'static str) -> Arg {
    Arg::new("out")
        .long("out")
        .value_name("DIR")
        .value_hint(ValueHint::DirPath)
        .value_parser(clap::value_parser!(std::path::PathBuf))
        .help(help)
}

fn json() -> Arg {
    Arg::new("json").long("json").action(ArgAction::SetTrue).help("Print one JSON document to standard output")
}

fn new() -> Command {
    Command::new("new")
        .about("Write a project file from the gallery")
        .arg(Arg::new("example").value_name("EXAMPLE").required_unless_present("list").help("Name of an example, such as lan-table3"))
        .arg(Arg::new("list").long("list").action(ArgAction::SetTrue).help("List the examples"))
        .arg(
            Arg::new("dir")
                .long("dir")
                .value_name("DIR")
                .default_value(".")
                .value_hint(ValueHint::DirPath)
                .value_parser(clap::value_parser!(std::path::PathBuf))
                .help("Where to write it"),
        )
        .arg(Arg::new("force").long("force").action(ArgAction::SetTrue).help("Overwrite existing files"))
}

fn check() -> Command {
    let command = Command::new("check")
        .about("Read project files and check units, names and rules; nothing is solved")
        .arg(file().num_args(1..).help("Project files; every variant is checked too"))
        .arg(json());
    choices(command).after_help(EXIT_CODES)
}

fn solve() -> Command {
    let command = Command::new("solve")
        .about("Analyse a project and check its requirements")
        .arg(file().help("Project file"))
        .arg(out("Write report.html, result.json, curves.csv and the figures into this folder"))
        .arg(json());
    choices(command).after_help(EXIT_CODES)
}

const SYNTHESISE_HELP: &str = "\
The file says what is wanted and not how: [requirements], [material] where the family has one, and [synthesise] with what may be used and
how large it may be. What the file says of a design is not used. By `mechanism`:

  compliant  a force band over a stroke, and the thinnest beam that can be made: shapes of a catalogue are sized for it
  cam        a force over the stroke: springs of a catalogue or free ones, and the cam that goes with them
  capstan    torque, stiffness and lost motion at a ratio: drums, turns and cables of a catalogue, with the smallest preload
  lavt       torques, speed drop and efficiency, and the friction with its range: all gear sets and springs of a grid

Each design is analysed in full; they are ranked by the room that they take.

Writes FILE-1-SHAPE.toml, …, each of which `forcewright solve` finds to meet everything, report.html and result.json. If nothing meets
everything: the nearest design, and for each limit the nearest value that would do.

Ctrl-C ends the work and keeps what was found.

Exit codes: 0 a design meets all requirements, 1 none does (the nearest is written where there is one), 2 error in the file or the call, 4 input/output, 130 interrupted, best kept.";

fn synthesise() -> Command {
    Command::new("synthesise")
        .about("Design from requirements alone: ranked project files, or the limit that blocks")
        .arg(file().help("Project file with requirements, material and [synthesise]"))
        .arg(
            Arg::new("out")
                .long("out")
                .value_name("DIR")
                .required(true)
                .value_hint(ValueHint::DirPath)
                .value_parser(clap::value_parser!(std::path::PathBuf))
                .help("Write the project files, report.html and result.json into this folder"),
        )
        .arg(
            Arg::new("set")
                .long("set")
                .value_name("KEY=VALUE")
                .action(ArgAction::Append)
                .help("Replace one value for this run, such as synthesise.candidates=3 (may be repeated)"),
        )
        .arg(json())
        .after_help(SYNTHESISE_HELP)
}

const OPTIMISE_HELP: &str = "\
The section [optimise] of the file says what is made small or large and which numbers may change; requirements that
the search sees are kept, others are named and checked at the end. The first search starts from the design of the
file, further ones are spread over the ranges, later ones near the best. The same seed gives the same result.

Writes FILE-optimised.toml (comments kept), report.html and result.json.

--front KEY=SPEC searches once for each value of a key, such as requirements.stress.safety_factor=1..2:5 (a range with its count) or =1,1.5,2
(a list), each point from the designs of the others too. Writes FILE-front-01.toml, …, front.csv, report.html and result.json; exit code 0
if every point meets all requirements, 1 if one does not.

Ctrl-C ends the search and keeps the best design so far.

Exit codes: 0 the new design meets all requirements, 1 it does not (it is written all the same), 2 error in the file or the call, 3 no design could be computed, 4 input/output, 130 interrupted, best kept.";

fn optimise() -> Command {
    let number = |name: &'static str, help: &'static str| Arg::new(name).long(name).value_name("N").help(help);
    let command = Command::new("optimise")
        .about("Search for a better design: a new project file, and a report of the search")
        .arg(file().help("Project file with a section [optimise]"))
        .arg(out("Write the new project file, report.html and result.json into this folder").required(true))
        .arg(number("front", "The best goal over values of a key: a Pareto front").value_name("KEY=SPEC"))
        .arg(number("starts", "Searches, instead of `starts` of the file").value_parser(clap::value_parser!(u32).range(1..=100_000)))
        .arg(number("seed", "Seed of the starts after the first, instead of `seed` of the file").value_parser(clap::value_parser!(u32)))
        .arg(json());
    choices(command).after_help(OPTIMISE_HELP)
}

const COMPARE_HELP: &str = "\
Every file is analysed in full. The sheet has what it gives (force or torque), over which travel or turn, how much that varies, how stiff it is,
what part of the work is lost, the box around it, the mass and number of its parts, and whether it does what its file asks for; report.html
says of each number what it is. A dash stands where there is no such number, or it is not known.

--lever LENGTH compares forces with torques, all as what the first file gives: torque = force × lever.

Exit codes: 0 all meet the requirements of their files, 1 one does not, 2 error in a file or the call, 3 travel or accuracy not reached, 4 input/output, 130 interrupted.";

fn compare() -> Command {
    Command::new("compare")
        .about("Mechanisms of any family side by side, in one sheet of common measures")
        .arg(file().num_args(2..=8).help("Project files, two to eight"))
        .arg(
            Arg::new("lever")
                .long("lever")
                .value_name("LENGTH")
                .allow_hyphen_values(true)
                .help("Arm that makes a torque of a force, such as \"40 mm\""),
        )
        .arg(out("Write report.html and result.json into this folder"))
        .arg(json())
        .after_help(COMPARE_HELP)
}

const PARETO_HELP: &str = "\
The section [pareto] of the file names two or three metrics as goals, and what may change: ranges, ranges in steps, whole numbers, and values or
words of a list. Every design is analysed in full; all its requirements and checks are kept. The same seed gives the same result.

Writes FILE-pareto-001.toml, … (comments kept; at most 24, spread over the front), front.csv with every design of the front, report.html, in
which each point leads to its design and its file, and result.json. If nothing keeps every limit: the nearest design.

Ctrl-C ends the search and keeps the front so far.

Exit codes: 0 designs keep every limit, 1 none does (the nearest is written), 2 error in the file or the call, 3 no design could be computed, 4 input/output, 130 interrupted, front kept.";

fn pareto() -> Command {
    let number = |name: &'static str, help: &'static str| Arg::new(name).long(name).value_name("N").help(help);
    let up_to = |least: i64| clap::value_parser!(u32).range(least..=10_000);
    let command = Command::new("pareto")
        .about("Search for designs of which none is better in every goal: project files to choose from")
        .arg(file().help("Project file with a section [pareto]"))
        .arg(out("Write the project files, front.csv, report.html and result.json into this folder").required(true))
        .arg(number("population", "Designs of a generation, instead of `population` of the file").value_parser(up_to(4)))
        .arg(number("generations", "Generations, instead of `generations` of the file").value_parser(up_to(0)))
        .arg(number("seed", "Seed of the random numbers, instead of `seed` of the file").value_parser(clap::value_parser!(u32)))
        .arg(json());
    choices(command).after_help(PARETO_HELP)
}

const EXPORT_HELP: &str = "\
Formats: dxf (closed polylines with arcs, for cutting), svg (true size), step (solid), stl and 3mf (meshes), inp (plane finite elements for
CalculiX and Abaqus: quadratic triangles of plane stress between the pads, held and moved as the project says). Lengths are in millimetres.

FILE-part.html shows the part with its measures and lists the files. With --variant the names say FILE-VARIANT.

The section [parts] of the file says how large pads, holes and fillets are; [process] says what can be made.

Exit codes: 0 written, 1 written but the process cannot make it, 2 error in the file or the call, or a design that is no part in one piece, 4 input/output.";

fn export() -> Command {
    let command = Command::new("export")
        .about("Files for making the part: DXF, SVG, STEP, STL, 3MF; for finite elements: INP")
        .arg(file().help("Project file"))
        .arg(
            Arg::new("format")
                .long("format")
                .value_name("FORMATS")
                .value_delimiter(',')
                .default_value("dxf,step")
                .value_parser(crate::commands::export::parse_format)
                .help("Formats, separated by commas: dxf, svg, step, stl, 3mf, inp"),
        )
        .arg(
            Arg::new("element")
                .long("element")
                .value_name("LENGTH")
                .value_parser(crate::commands::export::parse_element)
                .help("inp: sides of the elements, such as 0.2mm; without it a quarter of the thinnest wall"),
        )
        .arg(
            Arg::new("out")
                .long("out")
                .value_name("DIR")
                .required(true)
                .value_hint(ValueHint::DirPath)
                .value_parser(clap::value_parser!(std::path::PathBuf))
                .help("Write the files into this folder"),
        )
        .arg(json());
    choices(command).after_help(EXPORT_HELP)
}

const SWEEP_HELP: &str = "\
Values of --vary:
  KEY=0.8mm..1.2mm:9          so many, evenly spaced, both ends included
  KEY=0.8mm,1mm,1.2mm         a list of quantities, numbers or words
  KEY=sobol(0.8mm..1.2mm)     a space-filling sample, with --points
KEY is a path as for --set; design.nodes.n3.at.x and design.beams.b1.bend.2 are single numbers.
Several --vary make the full grid, the first slowest. Values in the table are SI, with the unit in the header.

With --out, rows are appended to OUT.part. After an interruption of any kind the same command goes on there and ends with the same files.

Exit codes: 0 some design meets all requirements, 1 none does, 2 error in the file or the call, 3 no design was computed to its end, 4 input/output, 130 interrupted, rows kept.";

fn sweep() -> Command {
    let option = |name: &'static str, value: &'static str, help: &'static str| Arg::new(name).long(name).value_name(value).help(help);
    let command = Command::new("sweep")
        .about("Analyse many designs: a table of results over values of some keys")
        .arg(file().help("Project file"))
        .arg(
            option("vary", "KEY=SPEC", "Values of a key, such as design.thickness=0.8mm..1.2mm:9 (may be repeated)")
                .required(true)
                .action(ArgAction::Append),
        )
        .arg(
            out("Write PATH and its JSON if it ends in .csv or .npy; else PATH is a folder, for sweep.csv and sweep.json")
                .value_name("PATH")
                .value_hint(ValueHint::AnyPath),
        )
        .arg(
            option("metrics", "NAMES", "Only these metrics, in this order, such as force_at_end,stress_max")
                .value_delimiter(',')
                .action(ArgAction::Append),
        )
        .arg(formats())
        .arg(option("points", "N", "Points of the sample, for sobol(…)").value_parser(clap::value_parser!(u64).range(1..)))
        .arg(option("seed", "N", "Seed of the sample").value_parser(clap::value_parser!(u64)).default_value("0"))
        .arg(option("shard", "I/N", "Compute one of N parts, which `forcewright merge` joins"))
        .arg(
            option("threads", "N", "Designs computed at once; without it, as many as the machine has processors")
                .value_parser(clap::value_parser!(u16).range(1..)),
        )
        .arg(Arg::new("force").long("force").action(ArgAction::SetTrue).help("Overwrite files of another sweep"))
        .arg(Arg::new("yes").long("yes").action(ArgAction::SetTrue).help("Confirm a sweep of more than ten million designs"))
        .arg(json());
    choices(command).after_help(SWEEP_HELP)
}

fn formats() -> Arg {
    Arg::new("format")
        .long("format")
        .value_name("FORMATS")
        .value_delimiter(',')
        .action(ArgAction::Append)
        .value_parser(["csv", "npy"])
        .default_value("csv")
        .help("What to write: csv, npy (an array of doubles for NumPy), or csv,npy")
}

fn merge() -> Command {
    let part = file().id("part").value_name("PART").num_args(1..).help("The files OUT.i-of-n.part, in any order");
    Command::new("merge")
        .about("Join the parts of a sweep that were computed with --shard: the same files as in one run")
        .arg(file().id("out").value_name("OUT").help("OUT.csv, or a folder for sweep.csv"))
        .arg(part)
        .arg(formats())
        .arg(Arg::new("force").long("force").action(ArgAction::SetTrue).help("Overwrite files of another sweep"))
        .arg(json())
        .after_help("Exit codes: 0 some design meets all requirements, 1 none does, 2 the parts do not make a whole, 3 no design was computed to its end, 4 input/output.")
}

fn tolerance() -> Command {
    let count = |name: &'static str, help: &'static str| {
        Arg::new(name).long(name).value_name("N").value_parser(clap::value_parser!(u32)).help(help)
    };
    let command = Command::new("tolerance")
        .about("Draw designs from the scatter of making (± and [tolerance]): yield, causes, needed tolerances")
        .arg(file().help("Project file"))
        .arg(out("Write report.html and result.json into this folder"))
        .arg(count("samples", "Designs drawn; without it those of the file").value_parser(clap::value_parser!(u32).range(64..=100_000_000)))
        .arg(
            count("linear", "Designs of the linearised yield, beside them; without it 16384")
                .value_parser(clap::value_parser!(u32).range(64..=100_000_000)),
        )
        .arg(count("seed", "Seed of the draws; without it that of the file"))
        .arg(json());
    choices(command).after_help(
        "Exit codes: 0 target yield met, 1 missed, 2 error in the file or the call, 3 the nominal design has no curve, 4 input/output, 130 interrupted.",
    )
}

const CALIBRATE_HELP: &str = "\
[measurements.NAME] of the file names a CSV file and its columns; [calibrate] says which numbers are looked for, such as
parameters = { \"material.young_modulus\" = { range = [\"1 GPa\", \"4 GPa\"] }, \"bench.offset\" = {} }.

Writes calibrated.toml (the file, comments kept, with a variant `calibrated` that has the estimates; with --variant NAME they go into that
one), report.html and result.json.

Ctrl-C ends the search, or what is left of the intervals, and keeps the best parameters so far.

Exit codes: 0 all is determined and explained, 1 something is not, 2 error in the file or the call, 3 the design has no curve or the search did not come to its end, 4 input/output, 130 interrupted, best kept.";

fn calibrate() -> Command {
    let command = Command::new("calibrate")
        .about("Fit numbers of the design to a measured curve: values with intervals, what is not determined, what is not explained")
        .arg(file().help("Project file with sections [measurements] and [calibrate]"))
        .arg(out("Write calibrated.toml, report.html and result.json into this folder"))
        .arg(json());
    choices(command).after_help(CALIBRATE_HELP)
}

fn reproduce() -> Command {
    let papers: Vec<&'static str> = forcewright::reproductions().map(|r| r.key).collect();
    Command::new("reproduce")
        .about("Compute a paper's numbers and print them beside the paper's, with the difference and its reason")
        .arg(
            Arg::new("paper").value_name("PAPER").value_parser(PossibleValuesParser::new(papers)).help("Key of the paper; without it, all"),
        )
        .arg(Arg::new("format").long("format").value_parser(["text", "markdown", "json"]).default_value("text").help("How to print it"))
}

fn explain() -> Command {
    Command::new("explain")
        .about("Explain the code of a check, an error or a warning")
        .arg(Arg::new("code").value_name("CODE").required_unless_present("all").help("Such as COMP002 or E0201"))
        .arg(Arg::new("all").long("all").action(ArgAction::SetTrue).help("Print every code, as Markdown"))
}

fn materials() -> Command {
    Command::new("materials")
        .about("List the catalogue of materials, with the kind and source of each value")
        .arg(Arg::new("material").value_name("MATERIAL").help("Name of an entry, such as POM-C; without it, all"))
        .arg(Arg::new("format").long("format").value_parser(["text", "markdown"]).default_value("text").help("How to print it"))
}

fn schema() -> Command {
    let ids: Vec<&'static str> = forcewright::FAMILIES.iter().map(|f| f.id()).collect();
    Command::new("schema")
        .about("Print the schema of project files, for editors and as documentation")
        .arg(
            Arg::new("mechanism")
                .value_name("MECHANISM")
                .value_parser(PossibleValuesParser::new(ids))
                .help("Family; may be left out while there is only one"),
        )
        .arg(
            Arg::new("format")
                .long("format")
                .value_parser(["json", "markdown", "paths"])
                .default_value("json")
                .help("JSON schema, table of parameters, or list of paths"),
        )
}

fn completions() -> Command {
    Command::new("completions")
        .about("Print completions for a shell")
        .arg(Arg::new("shell").value_name("SHELL").required(true).value_parser(clap::value_parser!(clap_complete::Shell)))
}

#[cfg(test)]
mod tests {
    #[test]
    fn grammar_is_sound() {
        super::command().debug_assert();
    }
}
