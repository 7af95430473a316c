//! Records as people hand them in: copied rows, two curves in one file, points far off, commas, filters too slow. Each is told, not
//! called explained.

use std::fmt::Write as _;

use super::super::{Noise, STRIP, calibrated, codes, csv, strip_csv, strip_n};

/// The strip with one number that is looked for.
fn one_parameter() -> String {
    let project = STRIP.replace(", \"bench.offset.y\" = {}", "");
    assert_ne!(project, STRIP);
    project
}

fn message(project: &str, data: &str, code: &str) -> String {
    let found = calibrated(project, data).unwrap();
    let warnings = found.diagnostics.warnings();
    warnings.iter().find(|w| w.code == code).map_or_else(|| panic!("no {code}: {:?}", codes(&found)), |w| w.message.clone())
}

fn refused(project: &str, data: &str) -> String {
    calibrated(project, data).map(|found| found.verdict()).expect_err("a mistake")
}

/// Rows written twice, or a table pasted twice, give the estimates and the intervals of the table itself, to the bit, and no narrower ones.
#[test]
fn copies_count_once() {
    let once = strip_csv(187.0, 0.001, 3);
    let (header, rows) = once.split_once('\n').unwrap();
    let copies = [
        rows.lines().fold(String::new(), |text, line| format!("{text}{line}\n{line}\n{line}\n")),
        format!("{rows}{rows}"),
        format!("{rows}{rows}{}", rows.lines().take(30).fold(String::new(), |text, line| format!("{text}{line}\n"))),
    ];
    let plain = calibrated(STRIP, &once).unwrap();
    assert!(codes(&plain).is_empty() && plain.copied_rows == 0, "{:?}", codes(&plain));
    for text in copies {
        let found = calibrated(STRIP, &format!("{header}\n{text}")).unwrap();
        assert_eq!(found.rows(), plain.rows());
        assert_eq!((found.fit.noise, found.fit.degrees, found.points.x.len()), (plain.fit.noise, plain.fit.degrees, 81));
        assert_eq!((codes(&found), found.copied_rows), (vec!["W0910"], text.lines().count() - 81));
        assert_eq!(found.document()["copied_rows"], text.lines().count() - 81);
    }
    // In another order nothing says that they are copies: they count, and are told of from a twentieth on.
    let with = |n: usize| {
        let again = |i: usize| if i % 16 == 1 && i / 16 < n { rows.lines().nth(i - 1).unwrap_or_default() } else { "" };
        rows.lines().enumerate().fold(format!("{header}\n"), |text, (i, line)| format!("{text}{line}\n{}\n", again(i)))
    };
    let said = message(STRIP, &with(5), "W0910");
    assert!(said.contains("5 of 86 points repeat another one exactly, and count as if"), "{said}");
    assert!(!codes(&calibrated(STRIP, &with(4)).unwrap()).contains(&"W0910"));
    // The last row of the way there and the first of the way back are two measurements.
    let turn = format!("{once}{}", rows.lines().rev().fold(String::new(), |text, line| format!("{text}{line}\n")));
    assert_eq!(calibrated(STRIP, &turn).unwrap().points.x.len(), 162);
}

/// Four rows that are one: no interval of no width, but what is needed.
#[test]
fn one_row_four_times_determines_nothing() {
    let said = refused(&one_parameter(), "travel / mm,force / N\n0.1,0.02\n0.1,0.02\n0.1,0.02\n0.1,0.02\n");
    assert!(said.contains("E0904") && said.contains("1 of 1 point can be compared, 3 are needed; 3 more rows are copies"), "{said}");
    let said = refused(&one_parameter(), "travel / mm,force / N\n0.1,0.02\n0.2,0.05\n0.1,0.02\n0.2,0.05\n0.2,0.05\n0.1,0.02\n");
    assert!(said.contains("E0904") && said.contains("2 different points are too few"), "{said}");
}

/// Thirteen points at one place tell a modulus, and nothing of whether it explains a curve.
#[test]
fn points_at_one_place_are_not_judged() {
    let mut noise = Noise(4);
    let data = csv("travel / mm,force / N", (0..13).map(|_| [0.15, strip_n(0.15, 187.0) + 0.001 * noise.normal()]));
    let found = calibrated(&one_parameter(), &data).unwrap();
    assert!(!found.sound() && codes(&found) == ["W0909"] && found.document()["residuals"]["judged"] == false, "{:?}", codes(&found));
    assert!(found.verdict().contains("too few places to judge"), "{}", found.verdict());
    assert!(found.residual_verdict().contains("they lie at 1 place only"), "{}", found.residual_verdict());
    assert!(message(&one_parameter(), &data, "W0909").ends_with("13 at 1 place"));
}

/// Every other row of another curve: not explained, in words that say what it may be.
#[test]
fn two_curves_row_by_row_are_told() {
    let mut noise = Noise(5);
    let rows = (1..=44).map(|i| {
        let x = f64::from(i) * 0.004;
        [x, strip_n(x, if i % 2 == 0 { 160.0 } else { 210.0 }) + 0.0002 * noise.normal()]
    });
    let data = csv("travel / mm,force / N", rows);
    let found = calibrated(&one_parameter(), &data).unwrap();
    assert!(!found.sound() && codes(&found).contains(&"W0905"), "{} {:?}", found.verdict(), codes(&found));
    let said = found.residual_verdict();
    assert!(said.contains("signs alternate, as of two curves in one file, or of rows that ring"), "{said}");
    assert!(
        said.contains("44 runs of signs") && said.contains("of so many") && found.document()["residuals"]["alternates"] == true,
        "{said}"
    );
}

/// Points on one side are the sign test, and are printed as that.
#[test]
fn the_sign_test_has_its_name() {
    let mut noise = Noise(6);
    let rows = (1..=20).map(|i| {
        let x = f64::from(i) * 0.01;
        [x, strip_n(x, 150.0) - 0.01 + 0.001 * noise.normal()]
    });
    let bound = one_parameter().replace("100 GPa", "180 GPa");
    let said = calibrated(&bound, &csv("travel / mm,force / N", rows)).unwrap().residual_verdict();
    assert!(said.contains("20 of 20 on one side (sign test), p < 0.0001") && !said.contains("runs"), "{said}");
}

/// One reading that is far off the others draws the estimate to itself: it is told with its place and size, and changes no verdict.
#[test]
fn a_point_far_off_is_told() {
    let mut noise = Noise(7);
    let rows: Vec<[f64; 2]> = (1..=20)
        .map(|i| {
            let x = f64::from(i) * 0.01;
            [x, strip_n(x, 187.0) + 0.0005 * noise.normal() + if i == 13 { 0.006 } else { 0.0 }]
        })
        .collect();
    let data = csv("travel / mm,force / N", rows.iter().copied());
    let said = message(&one_parameter(), &data, "W0911");
    assert!(said.starts_with("1 of 20 points lies far off the others: at 0.13 mm, 0.00") && said.ends_with(" N above the curve"), "{said}");
    let found = calibrated(&one_parameter(), &data).unwrap();
    assert!(found.sound() && found.document()["far"][0]["x"].as_f64().is_some_and(|x| (x - 0.13e-3).abs() < 1e-12));
    assert!(found.page("a.toml", "").contains("lies far off the others"));
    let robust = calibrated(&one_parameter().replace("[calibrate]\n", "[calibrate]\nloss = \"tukey\"\n"), &data).unwrap();
    assert!(!codes(&robust).contains(&"W0911"), "{:?}", codes(&robust));
    assert!(robust.hardly_counting().unwrap().contains("1 of 20 points hardly counts, with a weight below 0.1, as it lies far off"));
}

/// Modulus, depth and thickness of a strip: their product with a cube is all that is known; two directions say one thing together.
#[test]
fn directions_that_share_parameters_are_told_together() {
    let all = "\"bench.offset.y\" = {}, \"design.depth\" = {}, \"design.thickness\" = {}";
    let said = message(&STRIP.replace("\"bench.offset.y\" = {}", all), &strip_csv(187.0, 0.001, 3), "W0902");
    let wanted =
        "of `material.young_modulus`, `design.thickness` and `design.depth` the measurement determines no more than one combination";
    let sorted = |text: &str| {
        let mut words: Vec<String> = text.split([' ', ',']).filter(|w| !w.is_empty()).map(str::to_owned).collect();
        words.sort();
        words
    };
    assert_eq!(sorted(&said), sorted(wanted), "{said}");
    // Errors twenty times as large as the force leave its product open too: then neither is known. Signs + − − + tell nothing of a line.
    let rows =
        (0..32).map(|i| [f64::from(i) * 3e-4, strip_n(f64::from(i) * 3e-4, 187.0) + if i % 4 == 0 || i % 4 == 3 { 0.02 } else { -0.02 }]);
    let free = STRIP.replace("{ range = [\"100 GPa\", \"300 GPa\"] }", "{}").replace("\"bench.offset.y\" = {}", "\"design.depth\" = {}");
    let said = message(&free, &csv("travel / mm,force / N", rows), "W0902");
    let [a, b] = ["material.young_modulus", "design.depth"].map(|name| format!("`{name}`"));
    let neither = |a: &str, b: &str| said.starts_with(&format!("the measurement determines neither {a} nor {b}: "));
    assert!((neither(&a, &b) || neither(&b, &a)) && !said.contains('%'), "{said}");
}

/// A file of decimal commas is one mistake, with the key that mends it; of other mistakes the first few are told.
#[test]
fn a_file_of_decimal_commas_is_one_mistake() {
    let german = strip_csv(187.0, 0.001, 1).lines().enumerate().fold(String::new(), |mut text, (i, line)| {
        let (x, y) = line.split_once(',').unwrap();
        let _ = if i == 0 { writeln!(text, "{x};{y}") } else { writeln!(text, "{};{}", x.replace('.', ","), y.replace('.', ",")) };
        text
    });
    let said = refused(STRIP, &german);
    assert!(said.matches("error[").count() == 1 && said.contains("error[E0912]") && said.contains("bench.csv:1:1"), "{said}");
    assert!(
        said.contains("162 numbers of this file have decimal commas") && said.contains("write `decimal = \"comma\"` beside `file`"),
        "{said}"
    );
    let explained = forcewright::explanations().find(|e| e.code == "E0912").unwrap();
    assert!(explained.text.contains("decimal = \"comma\""));
    assert!(calibrated(&STRIP.replace("y = \"force / N\"", "y = \"force / N\"\ndecimal = \"comma\""), &german).is_ok());
    // One is a slip of its own.
    let said = refused(STRIP, &strip_csv(187.0, 0.001, 1).replace("travel / mm,", "travel / mm;").replacen("0.002500000,", "0,0025;", 1));
    assert!(!said.contains("E0912"), "{said}");
    let short = strip_csv(187.0, 0.001, 1)
        .lines()
        .enumerate()
        .fold(String::new(), |text, (i, line)| format!("{text}{}\n", if i == 0 { line } else { line.split_once(',').unwrap().0 }));
    let said = refused(STRIP, &short);
    assert!(said.matches("error[E0112]").count() == 6 && said.contains("… and 76 more like these"), "{said}");
    assert!(said.contains("1 value, 2 are expected"), "{said}");
}

/// A filter that is slower than the record is long moves it elsewhere: refused, with the least cut-off, which will do.
#[test]
fn filters_slower_than_the_record_are_refused() {
    let rows = strip_csv(187.0, 0.001, 1);
    let with = |cut_off: &str| {
        STRIP.replace("y = \"force / N\"", &format!("y = \"force / N\"\nfilter = {{ cut_off = \"{cut_off}\", rate = \"10 Hz\" }}"))
    };
    let said = refused(&with("0.05 Hz"), &rows);
    assert!(said.contains("error[E0905]") && said.contains("0.41 periods of the record's 81 rows"), "{said}");
    let (_, least) = said.split_once("write at least `cut_off = \"").unwrap();
    let least = least.split('"').next().unwrap();
    let value: f64 = least.strip_suffix(" Hz").unwrap().parse().unwrap();
    assert!((0.35..0.4).contains(&value), "{least}");
    let found = calibrated(&with(least), &rows).unwrap();
    let plain = calibrated(STRIP, &rows).unwrap();
    let [a, b] = [&found, &plain].map(|f| &f.fit.parameters[0]);
    assert!((a.estimate.value - b.estimate.value).abs() < 3.0 * b.error && found.points.left_out <= 1, "{a:?} {b:?}");
    let few: String = rows.lines().take(6).fold(String::new(), |text, line| format!("{text}{line}\n"));
    assert!(refused(&with("4 Hz"), &few).contains("too short for this filter"));
}

/// A value whose square no number holds is refused at its place.
#[test]
fn values_beyond_all_squares_are_refused() {
    let rows = strip_csv(187.0, 0.001, 1);
    let line = rows.lines().nth(9).unwrap();
    let huge = rows.replace(line, &format!("{},1e200", line.split_once(',').unwrap().0));
    let said = refused(STRIP, &huge);
    assert!(said.contains("error[E0204]") && said.contains("bench.csv:10:13"), "{said}");
    assert!(calibrated(STRIP, &huge.replace("1e200", "1e20")).unwrap().fit.noise.is_finite());
}

/// Which curve is compared stands where another one is offered.
#[test]
fn the_curve_of_the_family_is_named() {
    let example = forcewright::gallery::find("longval").unwrap().text;
    let study = "\n[measurements.curve]\nfile = \"bench.csv\"\nx = \"torque / N*m\"\ny = \"turn / mrad\"\n[calibrate]\nparameters = { \"design.friction\" = {} }\n";
    let said = refused(&format!("{example}{study}"), "torque / N*m,turn / mrad\n1,0.1\n2,0.2\n3,0.3\n4,0.4\n");
    assert!(said.contains("E0201") && said.contains("tangent stiffness at the output over torque at the output: write"), "{said}");
    for code in ["E0904", "E0908"] {
        let text = forcewright::explanations().find(|e| e.code == code).unwrap().text;
        assert!(text.contains("the tangent stiffness over the torque") && text.contains("cable drive"), "{text}");
    }
}

/// The document has the curves as they are drawn: between measured points too, and through them.
#[test]
fn curves_between_points_are_in_the_document() {
    let found = calibrated(STRIP, &strip_csv(187.0, 0.001, 1)).unwrap();
    let document = found.document();
    let drawn = &document["curve"]["branches"][0]["drawn"];
    let [x, before, after] =
        ["x", "before", "after"].map(|key| drawn[key].as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect::<Vec<_>>());
    assert!(x.len() == 400 && before.len() == 400 && after.len() == 400);
    assert!(x.iter().zip(&before).skip(1).all(|(x, y)| (y / strip_n(1e3 * x, 200.0) - 1.0).abs() < 1e-3));
    assert!((after[399] - found.fit.after[80]).abs() < 1e-12);
}
