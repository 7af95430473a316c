//! ISO 286 fits: which parameters take them, what studies make of them, and how they are written.

use forcewright_base::diagnostics::{Diagnostics, Span};
use forcewright_base::units::Tolerance;
use forcewright_contract::edit::{with_settings, with_values};
use forcewright_contract::scatter::Scattering;
use forcewright_contract::schema;

use crate::toy::{Toy, read_files, read_text};

/// A toy whose only beam has a pin.
fn text(pin: &str, rest: &str) -> String {
    format!(
        "schema = 1\nmechanism = \"toy\"\n[design]\nthickness = \"1 mm\"\n[design.nodes]\na = {{}}\nb = {{}}\n\
         [[design.beams]]\nname = \"leaf\"\nbetween = [\"a\", \"b\"]\npin = \"{pin}\" # ground\n{rest}"
    )
}

const PIN: &str = "design.beams.leaf.pin";

#[test]
fn a_diameter_takes_a_fit_and_prints_it_as_typed() {
    for pin in ["17.6 mm h7", "19.4 mm H7", "25 mm js01"] {
        let mut reading = read_text(&text(pin, ""));
        assert!(reading.found.is_empty(), "{}", reading.shown);
        assert_eq!(reading.row(PIN), pin);
        let numbers = reading.numbers();
        let number = numbers.iter().find(|n| n.path == PIN).unwrap();
        assert!(matches!(number.tolerance, Some(Tolerance::Fit(_))));
        // The value of an analysis is the nominal one.
        let nominal: f64 = pin.split(' ').next().unwrap().parse().unwrap();
        assert!((number.si - nominal / 1e3).abs() < 1e-17);
    }
}

#[test]
fn elsewhere_a_fit_is_refused_with_its_place_and_a_way_out() {
    let typed = text("10 mm", "").replace("thickness = \"1 mm\"", "thickness = \"17.6 mm h7\"");
    let reading = read_text(&typed);
    assert_eq!(reading.found, ["E0320 a.toml:4:13 \"17.6 mm h7\""]);
    assert!(
        reading.help[0].contains("a fit needs a diameter") && reading.help[0].contains("\"17.6 mm ± 0.009 mm\""),
        "{}",
        reading.help[0]
    );
    for thickness in ["17.6 mm q7", "900 mm h7"] {
        let reading = read_text(&typed.replace("17.6 mm h7", thickness));
        assert!(reading.found[0].starts_with("E0320 a.toml:4:13"), "{:?}", reading.found);
    }
    // A freedom is no diameter, whatever it belongs to.
    let optimise =
        "[optimise]\nobjective = { minimise = \"mass\" }\nvariables = { \"design.beams.leaf.pin\" = { within = \"1 mm h7\" } }\n";
    let mut reading = read_text(&text("17.6 mm h7", optimise));
    let numbers = reading.numbers();
    let mut said = Diagnostics::default();
    assert!(reading.toy.studies.optimise.free(&numbers, &mut said).is_empty());
    assert_eq!(said.in_file_order()[0].code, "E0320");
}

#[test]
fn a_fit_that_does_not_exist_is_refused_with_the_reason() {
    for (pin, code, why) in [
        ("17.6 mm q7", "E0209", "no position with these letters"),
        ("17.6 mm h19", "E0209", "grades go from 01, 0 and 1 to 18"),
        ("17.6 mm t6", "E0209", "above 24 mm up to 500 mm"),
        ("600 mm h7", "E0209", "up to 500 mm"),
        ("17.6 mm j9", "E0209", "not tabulated"),
        ("17.6 mm h7 ± 0.01 mm", "E0203", ""),
        ("17.6 h7", "E0203", ""),
        // The zone leaves what the parameter may be.
        ("0.02 mm c11", "E0207", ""),
    ] {
        let reading = read_text(&text(pin, ""));
        let start = format!("{code} a.toml:11:7 \"{pin}\"");
        assert!(reading.found == [start.as_str()] && reading.shown.contains(why), "{pin}: {:?} {}", reading.found, reading.shown);
    }
}

/// The scatter of a text that has one.
fn scattering(text: &str) -> Scattering {
    let mut reading = read_text(text);
    assert!(reading.found.is_empty(), "{}", reading.shown);
    let numbers = reading.numbers();
    let mut said = Diagnostics::default();
    let found = reading.toy.studies.tolerance.scattering(&numbers, Span::default(), &mut said);
    found.unwrap_or_else(|| panic!("{said:?}"))
}

#[test]
fn scatter_is_centred_in_the_zone_and_the_nominal_value_stays() {
    // 17.6 mm h7: from 17.582 mm to 17.6 mm.
    for (form, quantile) in [("normal", None), ("uniform", Some([17.582e-3, 17.6e-3])), ("triangular", Some([17.582e-3, 17.6e-3]))] {
        let found = scattering(&text("17.6 mm h7", &format!("[tolerance]\ndistribution = \"{form}\"\n")));
        assert!((found.free[0].number.si - 17.6e-3).abs() < 1e-17);
        let own = &found.population.marginals()[0];
        assert!((own.mean() - 17.591e-3).abs() < 1e-15 && (own.half_width() - 9e-6).abs() < 1e-15, "{form}: {own:?}");
        if let Some([low, high]) = quantile {
            assert!((own.quantile(0.0) - low).abs() < 1e-15 && (own.quantile(1.0) - high).abs() < 1e-15, "{form}: {own:?}");
        } else {
            // The limits are three standard deviations away.
            assert!((own.sd() - 3e-6).abs() < 1e-15 && (own.cdf(17.6e-3) - 0.998_650_101_968_369_9).abs() < 1e-9, "{own:?}");
        }
    }
    // Wholly on one side of the nominal value, and a hole.
    let found = scattering(&text("50 mm g6", ""));
    assert!((found.population.marginals()[0].mean() - (50e-3 - 17e-6)).abs() < 1e-15);
    let found = scattering(&text("30 mm P7", ""));
    assert!((found.population.marginals()[0].mean() - (30e-3 - 24.5e-6)).abs() < 1e-15);
}

#[test]
fn words_of_the_section_win_over_a_fit() {
    let section = |words: &str| format!("[tolerance.parameters]\n\"design.beams.leaf.pin\" = {{ {words} }}\n");
    let found = scattering(&text("17.6 mm h7", &section("half_width = \"0.1 mm\"")));
    let own = &found.population.marginals()[0];
    assert!((own.mean() - 17.6e-3).abs() < 1e-15 && (own.half_width() - 1e-4).abs() < 1e-15);
    let found = scattering(&text("17.6 mm h7", &section("distribution = \"uniform\"")));
    let own = &found.population.marginals()[0];
    assert!((own.mean() - 17.591e-3).abs() < 1e-15 && (own.quantile(1.0) - 17.6e-3).abs() < 1e-15);
}

#[test]
fn a_new_diameter_keeps_its_fit_and_stays_where_the_fit_exists() {
    let variables = |range: &str| {
        let optimise = "[optimise]\nobjective = { minimise = \"mass\" }\n[optimise.variables]\n";
        format!("{optimise}\"design.beams.leaf.pin\" = {{ range = {range} }}\n")
    };
    // t6 begins above 24 mm: a search is kept there, and what it finds can be read again.
    let typed = text("26 mm t6", &variables("[\"20 mm\", \"700 mm\"]"));
    let mut reading = read_text(&typed);
    assert!(reading.found.is_empty(), "{}", reading.shown);
    let numbers = reading.numbers();
    let mut said = Diagnostics::default();
    let free = reading.toy.studies.optimise.free(&numbers, &mut said);
    assert!(said.is_empty() && free[0].lower > 24e-3 && free[0].lower < 24.01e-3 && (free[0].upper - 0.5).abs() < 1e-15, "{free:?}");
    let index = numbers.iter().position(|n| n.path == PIN).unwrap();
    for (si, written) in [(free[0].lower, "24.002 mm t6"), (31.234_567_89e-3, "31.23457 mm t6"), (free[0].upper, "500 mm t6")] {
        let after = with_values(&typed, &numbers, &[(index, si)], None).unwrap();
        assert_eq!(after, typed.replace("26 mm t6", written));
        let mut read = read_text(&after);
        assert!(read.found.is_empty(), "{}", read.shown);
        // The deviations are those of the new diameter.
        let new = read.numbers().into_iter().find(|n| n.path == PIN).unwrap();
        assert_eq!(new.tolerance, numbers[index].tolerance);
    }
    // A step further on the same grade is wider.
    let width = |typed: &str| {
        let found = scattering(&text(typed, ""));
        2.0 * found.population.marginals()[0].half_width()
    };
    assert!((width("30 mm t6") - 13e-6).abs() < 1e-12 && (width("30.001 mm t6") - 16e-6).abs() < 1e-12);
}

#[test]
fn a_setting_replaces_diameter_and_fit() {
    let typed = text("17.6 mm h7", "");
    for (value, shown) in [("18.5 mm h6", "18.5 mm h6"), ("18.5 mm", "18.5 mm"), ("18.5 mm ± 0.01 mm", "18.5 mm ± 0.01 mm")] {
        let setting = format!("{PIN}={value}");
        let mut reading = read_files(&[("a.toml", &typed)], None, &[&setting]);
        assert!(reading.found.is_empty(), "{}", reading.shown);
        assert_eq!(reading.row(PIN), shown);
        let written = with_settings(&typed, &[setting], None).unwrap();
        assert_eq!(written, typed.replace("17.6 mm h7", shown));
    }
    let reading = read_files(&[("a.toml", &typed)], None, &["design.beams.leaf.pin=18.5 mm h77"]);
    assert!(reading.found[0].starts_with("E0209 --set:1:23"), "{:?}", reading.found);
}

#[test]
fn schema_and_table_say_which_parameters_take_a_fit() {
    let schema = schema::json_schema("toy", "Toy", &mut Toy::default());
    let beam = &schema["properties"]["design"]["properties"]["beams"]["items"]["properties"];
    assert_eq!(beam["pin"]["examples"][1], "17.6 mm h7");
    assert_eq!(beam["thickness"]["examples"].as_array().unwrap().len(), 1);
    let table = schema::markdown(&mut Toy::default());
    let row = |path: &str| table.lines().find(|l| l.starts_with(&format!("| `{path}`"))).unwrap().to_owned();
    assert!(row("design.beams.*.pin").contains("`\"17.6 mm h7\"`") && !row("design.beams.*.thickness").contains("h7"));
}

/// A table of a setting whose keys are paths keeps them whole.
#[test]
fn a_setting_with_dotted_keys_is_written_as_it_was_meant() {
    let setting = r#"optimise.variables={ "design.thickness" = { range = ["1 mm", "2 mm"] } }"#.to_owned();
    let written = with_settings(&text("4 mm", ""), &[setting], None).unwrap();
    assert!(written.contains("[optimise.variables.\"design.thickness\"]\nrange = [\"1 mm\", \"2 mm\"]"), "{written}");
    let document: toml_edit::DocumentMut = written.parse().unwrap();
    assert!(document["optimise"]["variables"]["design.thickness"]["range"].is_array());
}

/// Any length takes a general tolerance: `±` of ISO 2768-1, written back as typed.
#[test]
fn a_length_takes_a_general_tolerance() {
    for (typed, half_mm) in [
        ("17.6 mm ISO 2768-m", 0.2),
        ("17.6 mm ISO 2768-1-f", 0.1),
        ("1.76 cm ISO2768-c", 0.5),
        ("17.6 mm iso  2768-m", 0.2),
        ("17.6 mm ISO-2768-m", 0.2),
    ] {
        let mut reading = read_text(&text("10 mm", "").replace("thickness = \"1 mm\"", &format!("thickness = \"{typed}\"")));
        assert!(reading.found.is_empty(), "{}", reading.shown);
        let numbers = reading.numbers();
        let number = numbers.iter().find(|n| n.path == "design.thickness").unwrap();
        let Some(Tolerance::General(_)) = number.tolerance else { panic!("{:?}", number.tolerance) };
        let [low, high] = number.tolerance.unwrap().deviations_si(number.si).unwrap();
        assert!((high - half_mm / 1e3).abs() < 1e-15 && (low + high).abs() < 1e-18, "{typed}");
        assert!(reading.row("design.thickness").ends_with(&format!("ISO 2768-{}", typed.chars().last().unwrap())));
    }
    for (typed, code, why) in [
        ("17.6 mm ISO 2768-q", "E0209", "the classes of ISO 2768-1 are f (fine)"),
        ("17.6 mm ISO 2768-mK", "E0209", "second letter is of ISO 2768-2"),
        ("0.4 mm ISO 2768-m", "E0209", "for lengths from 0.5 mm to 4000 mm"),
        ("2 mm ISO 2768-v", "E0209", "for lengths above 3 mm to 4000 mm"),
        ("17.6 ISO 2768-m", "E0208", "write \"17.6 mm ISO 2768-m\""),
    ] {
        let reading = read_text(&text("10 mm", "").replace("thickness = \"1 mm\"", &format!("thickness = \"{typed}\"")));
        let start = format!("{code} a.toml:4:13");
        assert!(reading.found.len() == 1 && reading.found[0].starts_with(&start), "{typed}: {:?}", reading.found);
        assert!(reading.shown.contains(why), "{typed}: {}", reading.shown);
    }
}
