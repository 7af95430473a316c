//! The direction of dependencies: down only, mechanisms and outputs blind to their peers.
//!
//! | layer | folders | may see |
//! | --- | --- | --- |
//! | 0 | `crates/base` | nothing |
//! | 1 | `crates/engines/*`, `crates/model` | base and `curves`; engines also `elements` |
//! | 2 | `crates/contract`, `crates/outputs/*` | contract: layers 0 and 1; outputs: base, model and `curves` |
//! | 3 | `crates/mechanisms/*` | layers 0 to 2 without outputs |
//! | 4 | `crates/forcewright` | layers 0 to 3 |
//! | 5 | `apps/*`, `benchmarks` | layers 0 to 4 |
//! | – | `xtask` | none of them |

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::process::ExitCode;

use crate::Workspace;
use crate::metadata::{self, Package};

/// Libraries of user interfaces and servers; a name stands for its relatives too: `clap` for `clap_complete`.
const ONLY_IN_APPS: [&str; 5] = ["axum", "clap", "indicatif", "pyo3", "tokio"];

/// Where a crate belongs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Room<'a> {
    Base,
    Engine(&'a str),
    Model,
    Contract,
    Output(&'a str),
    Mechanism(&'a str),
    Library,
    App(&'a str),
    Tasks,
}

impl<'a> Room<'a> {
    fn of(folder: &'a str) -> Option<Self> {
        match folder.split('/').collect::<Vec<_>>().as_slice() {
            ["crates", "base"] => Some(Self::Base),
            ["crates", "engines", name] => Some(Self::Engine(name)),
            ["crates", "model"] => Some(Self::Model),
            ["crates", "contract"] => Some(Self::Contract),
            ["crates", "outputs", name] => Some(Self::Output(name)),
            ["crates", "mechanisms", name] => Some(Self::Mechanism(name)),
            ["crates", "forcewright"] => Some(Self::Library),
            ["apps", name] => Some(Self::App(name)),
            // Benches measure from outside, as an application would.
            ["benchmarks"] => Some(Self::App("benchmarks")),
            ["xtask"] => Some(Self::Tasks),
            _ => None,
        }
    }

    /// The layer; the tasks stand outside.
    fn layer(self) -> Option<u8> {
        match self {
            Self::Base => Some(0),
            Self::Engine(_) | Self::Model => Some(1),
            Self::Contract | Self::Output(_) => Some(2),
            Self::Mechanism(_) => Some(3),
            Self::Library => Some(4),
            Self::App(_) => Some(5),
            Self::Tasks => None,
        }
    }

    /// The rule that forbids this room to depend on `other`, if one does.
    fn forbids(self, other: Self) -> Option<&'static str> {
        let (Some(above), Some(below)) = (self.layer(), other.layer()) else {
            return Some("the project's tasks and the product do not see each other");
        };
        match (self, other) {
            (Self::Engine(_), Self::Engine("curves" | "elements")) | (Self::Model | Self::Output(_), Self::Engine("curves")) => None,
            (Self::Engine(_), Self::Engine(_)) => Some("of its peers an engine may use only `curves` and `elements`"),
            (Self::Engine(_), Self::Model) => Some("engines are physics: what outputs understand is not theirs"),
            (Self::Model, Self::Engine(_)) => Some("the model is pure data and sees only the base and `curves`"),
            (Self::Mechanism(_), Self::Mechanism(_)) => Some("mechanisms are blind to each other"),
            (Self::Mechanism(_), Self::Output(_)) => Some("mechanisms are blind to outputs"),
            (Self::Output(_), Self::Output(_)) => Some("outputs are blind to each other"),
            (Self::Output(_), Self::Contract | Self::Engine(_)) => Some("outputs see only the model, the base and `curves`"),
            (Self::Contract, Self::Output(_)) => Some("the contract is blind to outputs"),
            (Self::App(_), Self::App(_)) => Some("applications are blind to each other"),
            _ if above <= below => Some("dependencies point down only"),
            _ => None,
        }
    }

    fn heading(self) -> &'static str {
        match self.layer() {
            Some(0) => "0 base",
            Some(1) => "1 engines and model",
            Some(2) => "2 contract and outputs",
            Some(3) => "3 mechanisms",
            Some(4) => "4 library",
            Some(_) => "5 applications",
            None => "outside",
        }
    }
}

/// Everything that is wrong with the direction of the dependencies.
pub(crate) fn violations(packages: &[Package]) -> Vec<String> {
    let rooms: BTreeMap<&str, Room<'_>> =
        packages.iter().filter_map(|package| Some((package.name.as_str(), Room::of(&package.folder)?))).collect();
    let mut found = Vec::new();
    for package in packages {
        let Some(&room) = rooms.get(package.name.as_str()) else {
            found.push(format!("{}: no layer is known for the folder `{}`; see xtask/src/layers.rs", package.name, package.folder));
            continue;
        };
        for dependency in &package.dependencies {
            if let Some(&other) = rooms.get(dependency.as_str()) {
                if let Some(rule) = room.forbids(other) {
                    found.push(format!("{} → {dependency}: {rule}", package.name));
                }
            } else if !matches!(room, Room::App(_)) && is_only_for_apps(dependency) {
                found.push(format!("{} → {dependency}: command lines, Python and servers belong in apps/", package.name));
            }
        }
    }
    found
}

fn is_only_for_apps(dependency: &str) -> bool {
    ONLY_IN_APPS.iter().any(|name| dependency.strip_prefix(name).is_some_and(|rest| rest.is_empty() || rest.starts_with(['-', '_'])))
}

/// Crate table and graph for `ARCHITECTURE.md`.
pub(crate) fn markdown(packages: &[Package]) -> String {
    let mut by_layer: BTreeMap<(bool, u8), (&str, Vec<&Package>)> = BTreeMap::new();
    for package in packages {
        if let Some(room) = Room::of(&package.folder) {
            let key = (room.layer().is_none(), room.layer().unwrap_or_default());
            by_layer.entry(key).or_insert((room.heading(), Vec::new())).1.push(package);
        }
    }
    let mut text = String::from("| layer | crate | folder | what it is |\n| --- | --- | --- | --- |\n");
    for (heading, members) in by_layer.values() {
        for package in members {
            let _ = writeln!(text, "| {heading} | `{}` | `{}` | {} |", package.name, package.folder, package.description);
        }
    }
    text.push_str("\nAn arrow means \"uses\"; what follows from other arrows is left out.\n\n```mermaid\nflowchart TD\n");
    for ((outside, layer), (heading, members)) in by_layer.iter().rev() {
        if !outside {
            let _ = writeln!(text, "  subgraph layer{layer} [\"{heading}\"]");
            for package in members {
                let _ = writeln!(text, "    {}[\"{}\"]", package.name, short(package));
            }
            text.push_str("  end\n");
        }
    }
    for package in packages {
        for dependency in direct(package, packages) {
            let _ = writeln!(text, "  {} --> {dependency}", package.name);
        }
    }
    text.push_str("```\n");
    text
}

/// The crate's folder without what every folder has in common.
fn short(package: &Package) -> &str {
    package.folder.strip_prefix("crates/").unwrap_or(&package.folder)
}

/// Dependencies that do not already follow from another dependency.
fn direct<'a>(package: &'a Package, packages: &'a [Package]) -> Vec<&'a str> {
    let find = |name: &str| packages.iter().find(|package| package.name == name);
    let of_workspace = |package: &'a Package| package.dependencies.iter().map(String::as_str).filter(|name| find(name).is_some());
    let reaches = |from: &'a str, goal: &str| {
        let mut open = vec![from];
        let mut seen = vec![from];
        while let Some(name) = open.pop() {
            for next in find(name).into_iter().flat_map(&of_workspace) {
                if next == goal {
                    return true;
                }
                if !seen.contains(&next) {
                    seen.push(next);
                    open.push(next);
                }
            }
        }
        false
    };
    of_workspace(package).filter(|&name| !of_workspace(package).any(|other| other != name && reaches(other, name))).collect()
}

/// The command `layers`.
pub(crate) fn run(workspace: &Workspace, as_markdown: bool) -> Result<ExitCode, String> {
    let metadata = metadata::read(workspace)?;
    if as_markdown {
        print!("{}", markdown(&metadata.packages));
        return Ok(ExitCode::SUCCESS);
    }
    let found = violations(&metadata.packages);
    for line in &found {
        println!("{line}");
    }
    if found.is_empty() {
        println!("layers: {} crates, dependencies point down only", metadata.packages.len());
        return Ok(ExitCode::SUCCESS);
    }
    println!("layers: {} forbidden; the rules are in ARCHITECTURE.md and xtask/src/layers.rs", found.len());
    Ok(ExitCode::FAILURE)
}

#[cfg(test)]
mod tests {
    use super::*;

    const FOLDERS: [&str; 15] = [
        "apps/cli",
        "apps/studio",
        "crates/base",
        "crates/contract",
        "crates/engines/beam",
        "crates/engines/curves",
        "crates/engines/elements",
        "crates/engines/study",
        "crates/forcewright",
        "crates/mechanisms/cam",
        "crates/mechanisms/compliant",
        "crates/model",
        "crates/outputs/fabricate",
        "crates/outputs/report",
        "xtask",
    ];

    /// All rooms, named by their folders, with the one arrow.
    fn graph(from: &str, to: &str) -> Vec<Package> {
        let package = |folder: &&str| Package {
            name: (*folder).to_owned(),
            description: "A room.".into(),
            folder: (*folder).to_owned(),
            dependencies: if *folder == from { vec![to.to_owned()] } else { Vec::new() },
        };
        FOLDERS.iter().map(package).collect()
    }

    /// Every arrow that is allowed, from the table of `ARCHITECTURE.md`; written out, not computed.
    fn allowed(from: &str) -> Vec<&'static str> {
        let engines = ["crates/engines/beam", "crates/engines/curves", "crates/engines/elements", "crates/engines/study"];
        let below_mechanisms = [&["crates/base", "crates/contract", "crates/model"][..], &engines].concat();
        let below_library = [
            &below_mechanisms[..],
            &["crates/mechanisms/cam", "crates/mechanisms/compliant", "crates/outputs/fabricate", "crates/outputs/report"],
        ]
        .concat();
        match from {
            "crates/base" | "xtask" => vec![],
            "crates/engines/beam" | "crates/engines/study" => vec!["crates/base", "crates/engines/curves", "crates/engines/elements"],
            "crates/engines/curves" => vec!["crates/base", "crates/engines/elements"],
            "crates/engines/elements" | "crates/model" => vec!["crates/base", "crates/engines/curves"],
            "crates/contract" => [&["crates/base", "crates/model"][..], &engines].concat(),
            "crates/outputs/fabricate" | "crates/outputs/report" => vec!["crates/base", "crates/engines/curves", "crates/model"],
            "crates/mechanisms/cam" | "crates/mechanisms/compliant" => below_mechanisms,
            "crates/forcewright" => below_library,
            "apps/cli" | "apps/studio" => [&below_library[..], &["crates/forcewright"]].concat(),
            other => panic!("{other} is not in the table"),
        }
    }

    #[test]
    fn every_possible_arrow_is_judged_as_in_the_table() {
        let mut forbidden = 0;
        for from in FOLDERS {
            for to in FOLDERS.into_iter().filter(|to| *to != from) {
                let found = violations(&graph(from, to));
                assert_eq!(found.is_empty(), allowed(from).contains(&to), "{from} → {to}: {found:?}");
                forbidden += found.len();
            }
        }
        assert_eq!(forbidden, 137);
    }

    #[test]
    fn interfaces_and_servers_stay_in_apps() {
        for library in ["clap", "clap_complete", "indicatif", "pyo3", "axum", "tokio", "tokio-util"] {
            for folder in FOLDERS {
                assert_eq!(violations(&graph(folder, library)).is_empty(), folder.starts_with("apps/"), "{folder} → {library}");
            }
        }
        assert!(violations(&graph("crates/base", "libm")).is_empty());
        assert!(violations(&graph("crates/base", "clapper")).is_empty());
    }

    #[test]
    fn a_folder_without_a_layer_is_an_error() {
        let stray = Package { name: "stray".into(), description: String::new(), folder: "crates/stray".into(), dependencies: vec![] };
        let found = violations(&[stray]);
        assert!(found.len() == 1 && found[0].contains("crates/stray"), "{found:?}");
    }

    #[test]
    fn the_graph_leaves_out_what_follows_from_other_arrows() {
        let mut packages = graph("crates/model", "crates/base");
        for package in &mut packages {
            if package.name == "crates/contract" {
                package.dependencies = vec!["crates/base".into(), "crates/model".into(), "toml".into()];
            }
        }
        let text = markdown(&packages);
        assert!(text.contains("  crates/contract --> crates/model\n"), "{text}");
        assert!(text.contains("  crates/model --> crates/base\n"), "{text}");
        assert!(!text.contains("  crates/contract --> crates/base\n"), "{text}");
        assert!(!text.contains("--> toml"), "{text}");
        assert!(text.contains("| 3 mechanisms | `crates/mechanisms/cam` |"), "{text}");
    }
}
