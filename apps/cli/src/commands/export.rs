//! `forcewright export`: files for making the parts.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::str::FromStr as _;

use clap::ArgMatches;
use forcewright::base::text::visible;
use forcewright::base::units::{Dimension, Quantity, format_number};
use forcewright::fabricate::{Format, Options};
use forcewright::model::{Body, Section};
use forcewright::{Choices, DiskFiles, Exported, Loaded};

use super::solve::{check_table, repeat_command, show};
use super::{choices, refuse};
use crate::{exit, output};

pub(crate) fn run(matches: &ArgMatches) -> u8 {
    let (Some(file), Some(out)) = (matches.get_one::<PathBuf>("file"), matches.get_one::<PathBuf>("out")) else { return exit::USAGE };
    let as_json = matches.get_flag("json");
    let formats: Vec<Format> = matches.get_many::<Format>("format").map(|all| all.copied().collect()).unwrap_or_default();
    let options = Options { element_m: matches.get_one::<f64>("element").copied(), ..Options::default() };
    let choices = choices(matches);
    let loaded = match Loaded::from_file(&DiskFiles, file, &choices) {
        Ok(loaded) => loaded,
        Err(refused) => return refuse(&refused, as_json),
    };
    output::narrate(&loaded.project.diagnostics.render(&loaded.project.sources, output::colour_on_stderr()));
    let stem = stem(file, &choices);
    let exported = match loaded.export(&stem, &formats, &options) {
        Ok(exported) => exported,
        Err(none) => {
            output::complain(none.code, &none.message, &none.help, as_json);
            return exit::USAGE;
        }
    };
    let list: Vec<&str> = formats.iter().map(|f| f.extension()).collect();
    let command = format!("{} --format {}", repeat_command("export", file, Some(out), &choices), list.join(","));
    let page = exported.page(&file.display().to_string(), choices.variant.as_deref(), &command);
    let mut files = exported.files.clone();
    files.push((format!("{stem}-part.html"), page.into_bytes()));
    if let Err(failed) = output::prepare(out).and_then(|()| output::write_all(out, &files)) {
        return output::write_failed(&failed, as_json);
    }
    if as_json {
        output::print(&output::json_text(&exported.document()));
    } else {
        show(&summary(&exported));
    }
    let names: Vec<&str> = files.iter().map(|(name, _)| name.as_str()).collect();
    output::narrate(&visible(&format!("wrote {} in {}", names.join(", "), out.display())));
    output::narrate("\n");
    if exported.can_be_made() { exit::MET } else { exit::MISSED }
}

/// What files are named after: the project file without its ending, and the variant, whose part is another one.
fn stem(file: &Path, choices: &Choices) -> String {
    let own = file.file_stem().map_or_else(|| "part".to_owned(), |stem| stem.to_string_lossy().into_owned());
    choices.variant.as_ref().map_or(own.clone(), |variant| format!("{own}-{variant}"))
}

/// The formats of a list such as `dxf,step`.
pub(crate) fn parse_format(text: &str) -> Result<Format, String> {
    Format::from_str(text).map_err(|unknown| unknown.to_string())
}

/// A length, m.
pub(crate) fn parse_element(text: &str) -> Result<f64, String> {
    let length = Quantity::parse(text, Dimension::Length).map_err(|_| "is no length such as 0.2mm".to_owned())?;
    if (1e-9..=1.0).contains(&length.si) { Ok(length.si) } else { Err("must lie between 1e-6 mm and 1 m".to_owned()) }
}

fn summary(exported: &Exported) -> String {
    let mut text = String::new();
    let millimetres = |m: f64| format_number(1e3 * m, 5);
    for part in &exported.set.parts {
        let material = part.material.as_ref().map_or_else(String::new, |m| format!(", {m}"));
        let count = |n: usize, what: &str| format!("{n} {what}{}", if n == 1 { "" } else { "s" });
        let mass = part.mass_kg().map_or_else(String::new, |kg| format!(", {} g", format_number(1e3 * kg, 3)));
        match &part.body {
            Body::Plate(plate) => {
                let [width, height] = plate.size_m().map(millimetres);
                let _ = writeln!(text, "{}: {width} × {height} × {} mm{material}", part.name, millimetres(plate.depth_m));
                let _ = writeln!(
                    text,
                    "  area {} mm²{mass}, cut length {} mm, {}, {}",
                    format_number(1e6 * plate.area_m2(), 6),
                    millimetres(plate.cut_length_m()),
                    count(plate.cutouts.len(), "window"),
                    count(plate.holes.len(), "hole")
                );
            }
            Body::Turned(turned) => {
                let diameter = millimetres(2.0 * turned.largest_radius_m());
                let _ = writeln!(text, "{}: diameter {diameter} mm, {} mm long{material}", part.name, millimetres(turned.length_m()));
                let grooved = turned.sections.iter().filter_map(Section::grooved).count();
                let _ = writeln!(
                    text,
                    "  volume {} cm³{mass}, {} grooved, {} not cut into the solid",
                    format_number(1e6 * turned.volume_m3(), 6),
                    count(grooved, "section"),
                    count(turned.drillings.len(), "drilling")
                );
            }
            Body::Coil(coil) => {
                let [wire, outer, long, of_wire] =
                    [coil.wire_m, coil.outer_diameter_m(), coil.length_m(), coil.wire_length_m()].map(millimetres);
                let hand = if coil.is_right_handed { "right" } else { "left" };
                let turns = format_number(coil.turns(), 5);
                let _ = writeln!(text, "{}: wire {wire} mm, diameter {outer} mm, {long} mm long{material}", part.name);
                let _ = writeln!(text, "  {turns} turns, {hand}-handed, length of wire {of_wire} mm{mass}");
            }
        }
        for note in &part.notes {
            let _ = writeln!(text, "  {note}");
        }
    }
    let _ = write!(text, "\n{}", check_table("check", &exported.set.checks));
    for check in &exported.set.checks {
        if let Some(advice) = &check.advice {
            let _ = writeln!(text, "\n{} {}: {advice}", check.code, check.name);
        }
    }
    text
}
