//! The parts of a design as a page for people, and as a figure of its report.

use forcewright_base::units::{format_number, format_si};
use forcewright_model::{Body, Check, CheckState, Coil, Figure, FigureContent, Part, PartSet, Plate, Section, Sense, Sheet, Turned};
use forcewright_report::study::{StudyColumn, StudyPage, StudyPart, StudySection, page};

use super::Exported;
use crate::{Loaded, VERSION};

/// The parts as a figure.
fn figure(set: &PartSet) -> Figure {
    let several = set.parts.len() > 1;
    let facts: Vec<String> = set.parts.iter().map(|part| in_words(part, several, set)).collect();
    let has_coil = set.parts.iter().any(|part| part.coil().is_some());
    let (title, lead) = match (is_made(set), several) {
        (true, true) if has_coil => ("The parts as they are made", "Turned parts are shown cut along their axis, springs from the side."),
        (true, true) => ("The parts as they are made", "Turned parts are shown cut along their axis."),
        (true, false) if has_coil => ("The part as it is made", "It is shown from the side."),
        (true, false) => ("The part as it is made", "It is shown cut along its axis."),
        (false, true) => ("The parts as they are cut", "They are cut, with holes and fillets; `[parts]` says how large they are."),
        (false, false) => ("The part as it is cut", "It is cut, with holes and fillets; `[parts]` says how large they are."),
    };
    Figure {
        id: "part",
        title: title.to_owned(),
        caption: format!("{lead} {}", facts.join(" ")),
        content: FigureContent::Part(set.clone()),
    }
}

/// Whether there are parts that are not cut out of a plate.
fn is_made(set: &PartSet) -> bool {
    set.parts.iter().any(|part| part.plate().is_none())
}

/// What a maker asks first, in a sentence.
fn in_words(part: &Part, named: bool, set: &PartSet) -> String {
    let name = if named { format!("{}: ", part.name) } else { String::new() };
    let facts = facts(part, set).into_iter().map(|(what, text)| format!("{what} {text}")).collect::<Vec<_>>().join(", ");
    let mut words = if named { format!("{name}{facts}.") } else { format!("Its {facts}.") };
    for note in &part.notes {
        words.push(' ');
        words.push_str(note);
    }
    words
}

/// Name and text of what can be measured on a part.
pub(super) fn facts(part: &Part, set: &PartSet) -> Vec<(&'static str, String)> {
    let (mut all, fillets) = match &part.body {
        Body::Plate(plate) => (plate_facts(plate, set), plate.fillets),
        Body::Turned(turned) => (turned_facts(turned, set), None),
        Body::Coil(coil) => (coil_facts(coil, set), None),
    };
    if let Some(mass_kg) = part.mass_kg() {
        all.push(("mass", format!("{} g", format_number(1e3 * mass_kg, 3))));
    }
    if let Some(fillets) = fillets {
        let length = |m: f64| format_si(m, &set.display, 4);
        let [least, most] = fillets.radius_m;
        // What differs by rounding is one radius.
        let radius = if most - least < 1e-6 * most { length(most) } else { format!("{} to {}", length(least), length(most)) };
        all.push(("fillets", format!("{} of radius {radius}", fillets.count)));
    }
    all
}

fn plate_facts(plate: &Plate, set: &PartSet) -> Vec<(&'static str, String)> {
    let length = |m: f64| format_si(m, &set.display, 4);
    let [width, height] = plate.size_m().map(length);
    vec![
        ("size", format!("{width} × {height}")),
        ("thickness of the plate", length(plate.depth_m)),
        ("cut length", length(plate.cut_length_m())),
        ("area", format!("{} mm²", format_number(1e6 * plate.area_m2(), 4))),
    ]
}

fn turned_facts(turned: &Turned, set: &PartSet) -> Vec<(&'static str, String)> {
    let length = |m: f64| format_si(m, &set.display, 4);
    let mut all = vec![
        ("largest diameter", length(2.0 * turned.largest_radius_m())),
        ("length", length(turned.length_m())),
        ("volume", format!("{} cm³", format_number(1e6 * turned.volume_m3(), 4))),
    ];
    if turned.bore_diameter_m > 0.0 {
        all.push(("bore", length(turned.bore_diameter_m)));
    }
    for grooved in turned.sections.iter().filter_map(Section::grooved) {
        let hand = if grooved.lead_m > 0.0 { "right" } else { "left" };
        let lead = length(grooved.lead_m.abs());
        let grooves = if grooved.starts == 1 { "1 groove".to_owned() } else { format!("{} grooves side by side", grooved.starts) };
        all.push(("grooved section", format!("{grooves}, {hand}-handed, lead {lead}, over {}", length(grooved.length_m))));
    }
    for drilling in &turned.drillings {
        let [diameter, z] = [drilling.diameter_m, drilling.z_m].map(length);
        let angle = format_number(drilling.angle_rad.to_degrees(), 4);
        let text =
            format!("{}: diameter {diameter} at z = {z}, {angle}°, {} deep; not in the solid", drilling.purpose, length(drilling.depth_m));
        all.push(("drilling", text));
    }
    all
}

fn coil_facts(coil: &Coil, set: &PartSet) -> Vec<(&'static str, String)> {
    let length = |m: f64| format_si(m, &set.display, 4);
    let hand = if coil.is_right_handed { "right" } else { "left" };
    let turns = format_number(coil.turns(), 5);
    let mut all = vec![
        ("wire", length(coil.wire_m)),
        ("outer diameter", length(coil.outer_diameter_m())),
        ("inner diameter", length(coil.inner_diameter_m())),
        ("turns", format!("{turns}, {hand}-handed")),
        ("length", length(coil.length_m())),
        ("length of wire", length(coil.wire_length_m())),
    ];
    for (name, end) in ["lower end", "upper end"].into_iter().zip(&coil.ends) {
        let leg = if end.leg_m() > 0.0 { format!(" of {}", length(end.leg_m())) } else { String::new() };
        let bend = end.bend_m().map_or_else(String::new, |m| format!(", bent to a mean radius of {}", length(m)));
        all.push((name, format!("{}{leg}{bend}", end.words())));
    }
    all
}

impl Loaded {
    /// The parts of the design as a figure, `None` where it has none.
    pub fn part_figure(&self) -> Option<Figure> {
        self.understood.parts().ok().map(|set| figure(&set))
    }
}

impl Exported {
    /// `part.html`: the parts with their dimensions, what the process can make of them, and the files that were written.
    /// `input_name` is the project file as the user named it, `command` the command that repeats this run.
    pub fn page(&self, input_name: &str, variant: Option<&str>, command: &str) -> String {
        let set = &self.set;
        let table = |caption: &str, columns: &[(&str, StudyColumn)], rows: Vec<Vec<String>>| StudyPart::Table {
            caption: caption.to_owned(),
            columns: columns.iter().map(|(title, kind)| ((*title).to_owned(), *kind)).collect(),
            rows,
        };
        let mut rows = Vec::new();
        for part in &set.parts {
            let mut row = |what: &str, text: String| rows.push(vec![part.name.clone(), what.to_owned(), text]);
            row("pieces", if part.count == 0 { "in the place of another".to_owned() } else { part.count.to_string() });
            row("material", part.material.clone().unwrap_or_else(|| "not said".to_owned()));
            for (what, text) in facts(part, set) {
                row(what, text);
            }
            if let Some(plate) = part.plate() {
                row("windows", plate.cutouts.len().to_string());
                row("holes", plate.holes.len().to_string());
            }
            part.notes.iter().for_each(|note| row("note", note.clone()));
        }
        let measures = [("Part", StudyColumn::Code), ("What", StudyColumn::Text), ("Value", StudyColumn::Text)];
        let checks = [
            ("What", StudyColumn::Text),
            ("State", StudyColumn::Text),
            ("Found", StudyColumn::Number),
            ("Limit", StudyColumn::Number),
            ("Code", StudyColumn::Code),
        ];
        let files = self.files.iter().map(|(name, bytes)| vec![name.clone(), use_of(name).to_owned(), bytes.len().to_string()]);
        let advice = set.checks.iter().filter_map(|c| Some(StudyPart::Text(format!("{}: {}", c.code, c.advice.as_ref()?))));
        let mut made = vec![table("What the process must be able to make", &checks, set.checks.iter().map(check).collect())];
        made.extend(advice);
        let sheets: Vec<StudyPart> = set.sheets.iter().map(sheet).collect();
        let is_made = is_made(set);
        page(&StudyPage {
            kind: if set.parts.len() == 1 { "Part" } else { "Parts" }.to_owned(),
            title: self.title.clone(),
            facts: vec![("Project file".to_owned(), input_name.to_owned())],
            verdict: self.verdict(),
            sections: [
                StudySection {
                    id: "part",
                    title: if is_made { "As it is made" } else { "As it is cut" },
                    parts: vec![StudyPart::Figure(Box::new(figure(set)))],
                },
                StudySection {
                    id: "measures",
                    title: "Measures",
                    parts: vec![table(if is_made { "Measures of the parts" } else { "Measures of the outline" }, &measures, rows)],
                },
                StudySection { id: "process", title: "Can it be made?", parts: made },
                StudySection { id: "sheets", title: "Sheets", parts: sheets },
                StudySection {
                    id: "files",
                    title: "Files",
                    parts: vec![table(
                        "Files written beside this page; lengths in millimetres",
                        &[("File", StudyColumn::Code), ("For", StudyColumn::Text), ("Bytes", StudyColumn::Number)],
                        files.collect(),
                    )],
                },
            ]
            .into_iter()
            .filter(|section| !section.parts.is_empty())
            .collect(),
            version: VERSION.to_owned(),
            input_name: input_name.to_owned(),
            variant: variant.map(str::to_owned),
            input_sha256: self.input_sha256.clone(),
            command: command.to_owned(),
        })
    }

    /// Whether it can be made, in a sentence.
    fn verdict(&self) -> (CheckState, String) {
        let worst = |state| self.set.checks.iter().any(|c| c.required && c.state == state);
        let nothing = !self.set.checks.iter().any(|c| c.required);
        match (nothing, worst(CheckState::Missed), worst(CheckState::NotAssessed)) {
            (_, true, _) => (CheckState::Missed, "The process cannot make it as it is drawn".to_owned()),
            (true, ..) => (CheckState::NotAssessed, "Nothing is said of the process: `[process]` gives its limits".to_owned()),
            (.., true) => (CheckState::NotAssessed, "Not everything that the process asks for could be assessed".to_owned()),
            _ => (CheckState::Met, "The process can make it, as far as `[process]` asks".to_owned()),
        }
    }
}

fn sheet(sheet: &Sheet) -> StudyPart {
    StudyPart::Table {
        caption: sheet.caption.clone(),
        columns: sheet.columns.iter().map(|c| (c.clone(), StudyColumn::Number)).collect(),
        rows: sheet.rows.clone(),
    }
}

fn check(check: &Check) -> Vec<String> {
    let sign = if check.sense == Sense::AtMost { "≤" } else { "≥" };
    let show = |value: f64| format_si(value, &check.display, 4);
    let dash = || "–".to_owned();
    vec![
        check.title.clone(),
        check.state.word().to_owned(),
        check.value.map_or_else(dash, show),
        check.limit.map_or_else(dash, |l| format!("{sign} {}", show(l))),
        check.code.to_owned(),
    ]
}

/// What a file is for, by its ending.
fn use_of(name: &str) -> &'static str {
    match name.rsplit('.').next().unwrap_or_default() {
        "dxf" => "cutting: closed polylines of lines and arcs",
        "svg" => "laser cutting, true size",
        "step" => "solid model",
        "stl" => "printing: mesh without units",
        "3mf" => "printing: mesh with units",
        "csv" => "inspection, ordering",
        _ => "further work",
    }
}
