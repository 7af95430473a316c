//! `forcewright materials`: the catalogue that `material.use` names.

use std::fmt::Write as _;

use clap::ArgMatches;
use forcewright::base::text::closest;
use forcewright::base::units::format_number;
use forcewright::elements::materials::{self, Material, Property};

use crate::table::{Align, columns};
use crate::{exit, output};

pub(crate) fn run(matches: &ArgMatches) -> u8 {
    let wanted: Vec<&Material> = match matches.get_one::<String>("material") {
        None => materials::catalogue().iter().collect(),
        Some(name) => match materials::find(name) {
            Some(material) => vec![material],
            None => return unknown(name),
        },
    };
    match matches.get_one::<String>("format").map(String::as_str) {
        Some("markdown") => output::print(&markdown(&wanted)),
        _ => output::print(&text(&wanted)),
    }
    exit::MET
}

fn unknown(name: &str) -> u8 {
    let help = closest(name, materials::names()).map_or_else(
        || "`forcewright materials` lists all".to_owned(),
        |near| format!("did you mean `{near}`? `forcewright materials` lists all"),
    );
    let name: String = name.chars().take(60).collect();
    output::complain("E0308", &format!("there is no material `{name}` in the catalogue"), &help, false);
    exit::USAGE
}

/// A value with a letter for its kind: m minimum, t typical, x measured.
fn cell(property: Option<&Property>, scale: f64) -> String {
    property.map_or_else(|| "–".to_owned(), |p| format!("{} {}", format_number(p.value / scale, 4), kind(p)))
}

fn kind(property: &Property) -> &'static str {
    match property.kind {
        materials::ValueKind::Minimum => "m",
        materials::ValueKind::Typical => "t",
        materials::ValueKind::Measured => "x",
    }
}

fn cells(material: &Material) -> [String; 5] {
    [
        cell(material.young_modulus_pa.as_ref(), 1e9),
        cell(material.poisson_ratio.as_ref(), 1.0),
        cell(material.yield_stress_pa.as_ref(), 1e6),
        cell(material.density_kg_per_m3.as_ref(), 1.0),
        material
            .fatigue
            .as_ref()
            .map_or_else(|| "–".to_owned(), |f| format!("{} at {:e}", format_number(f.amplitude_pa / 1e6, 4), f.cycles)),
    ]
}

const LEGEND: &str =
    "m: minimum of a standard; t: typical value of a maker or handbook; x: measured. Half of all parts may lie below a typical value.";

fn text(wanted: &[&Material]) -> String {
    let mut rows =
        vec![["material", "E / GPa", "ν", "yield / MPa", "density / kg/m³", "fatigue / MPa", "also called"].map(str::to_owned).to_vec()];
    for material in wanted {
        let mut row = vec![material.name.clone()];
        row.extend(cells(material));
        row.push(material.aliases.join(", "));
        rows.push(row);
    }
    let right = Align::Right;
    let notes = match wanted {
        [one] => {
            let note = one.note.as_deref().map_or_else(String::new, |n| format!("{}\n", n.trim()));
            format!("sources: {}\n{note}", one.sources.join(", "))
        }
        _ => String::new(),
    };
    format!("{}\n{notes}{LEGEND}\n", columns(&rows, &[Align::Left, right, right, right, right, right, Align::Left]))
}

fn markdown(wanted: &[&Material]) -> String {
    let mut out = format!("# Materials\n\nEntries of `material.use`. {LEGEND} Sources are keys of `REFERENCES.bib`.\n\n");
    out.push_str(
        "| material | also called | E / GPa | ν | yield / MPa | density / kg/m³ | fatigue amplitude / MPa at cycles | sources | note |\n",
    );
    out.push_str("| --- | --- | ---: | ---: | ---: | ---: | ---: | --- | --- |\n");
    for material in wanted {
        let [young, poisson, yield_stress, density, fatigue] = cells(material);
        let _ = writeln!(
            out,
            "| {} | {} | {young} | {poisson} | {yield_stress} | {density} | {fatigue} | {} | {} |",
            material.name,
            material.aliases.join(", "),
            material.sources.join(", "),
            material.note.as_deref().unwrap_or_default().replace('|', "\\|").replace('\n', " "),
        );
    }
    out
}
