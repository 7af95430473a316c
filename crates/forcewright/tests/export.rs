//! Parts of designs: measured back from their files, and what is no part.

use forcewright::base::maths;
use forcewright::curves::fit::Oriented;
use forcewright::curves::walls::thickness_along;
use forcewright::curves::{Profile, Segment};
use forcewright::fabricate::{Format, Options};
use forcewright::model::{CheckState, NoPart};
use forcewright::{Choices, Exported, Loaded};

fn loaded(name: &str, set: &[&str]) -> Loaded {
    let example = forcewright::gallery::find(name).expect("in the gallery");
    let choices = Choices { set: set.iter().map(|s| (*s).to_owned()).collect(), ..Choices::default() };
    Loaded::from_text(name, example.text, &choices).unwrap_or_else(|e| panic!("{}", e.render(false)))
}

fn export(name: &str, set: &[&str], formats: &[Format]) -> Result<Exported, NoPart> {
    loaded(name, set).export("part", formats, &Options::default())
}

/// The closed polylines of a drawing, m: lines and arcs by their bulges (the tangent of a quarter of the angle of an arc).
fn polylines(dxf: &[u8]) -> Vec<Profile> {
    let text = std::str::from_utf8(dxf).expect("text");
    let mut lines = text.lines().map(str::trim);
    let mut all: Vec<Vec<[f64; 3]>> = Vec::new();
    let mut inside = false;
    while let (Some(code), Some(value)) = (lines.next(), lines.next()) {
        let number = || value.parse::<f64>().expect("a number");
        match code {
            "0" => {
                inside = value == "LWPOLYLINE";
                if inside {
                    all.push(Vec::new());
                }
            }
            "10" if inside => all.last_mut().expect("begun").push([1e-3 * number(), 0.0, 0.0]),
            "20" if inside => all.last_mut().and_then(|p| p.last_mut()).expect("begun")[1] = 1e-3 * number(),
            "42" if inside => all.last_mut().and_then(|p| p.last_mut()).expect("begun")[2] = number(),
            _ => {}
        }
    }
    all.iter().map(|corners| polyline(corners)).collect()
}

fn polyline(corners: &[[f64; 3]]) -> Profile {
    let next = |i: usize| corners[(i + 1) % corners.len()];
    let segment = |(i, [x, y, bulge]): (usize, &[f64; 3])| {
        let [to_x, to_y, _] = next(i);
        if *bulge == 0.0 {
            return Segment::Line { to_m: [to_x, to_y] };
        }
        // The middle lies (1 − b²)/(4b) chords to the left of the middle of the chord.
        let off = (1.0 - bulge * bulge) / (4.0 * bulge);
        let centre_m = [0.5 * (x + to_x) - off * (to_y - y), 0.5 * (y + to_y) + off * (to_x - x)];
        Segment::Arc { to_m: [to_x, to_y], centre_m, counterclockwise: *bulge > 0.0 }
    };
    Profile { start_m: [corners[0][0], corners[0][1]], segments: corners.iter().enumerate().map(segment).collect() }
}

/// The axes of the beams of Table 3 (η(u) = c0 + c1·u + c2·u² from their nodes), computed here by Simpson's rule.
fn table3_axes() -> Vec<Box<dyn Fn(f64) -> Oriented>> {
    let nodes = [[2.5e-3, 0.0], [34.5e-3, 0.0], [30.5e-3, 18.77e-3], [12.44e-3, 24e-3], [2.5e-3, 40e-3]];
    #[expect(clippy::approx_constant, reason = "as printed")]
    let beams = [(0, 2, [1.3092, -1.5707]), (1, 2, [-0.756, 1.5707]), (2, 3, [0.3013, 1.5707]), (3, 4, [0.226, -1.148])];
    let integral = |bend: [f64; 2], u: f64| {
        let f = |s: f64| maths::sin_cos(bend[0] * s + bend[1] * s * s);
        let n = 2000;
        let weight = |i: usize| {
            if i == 0 || i == n {
                1.0
            } else if i % 2 == 1 {
                4.0
            } else {
                2.0
            }
        };
        let h = u / n as f64;
        (0..=n).fold([0.0, 0.0], |[x, y], i| {
            let (sin, cos) = f(h * i as f64);
            [x + weight(i) * cos * h / 3.0, y + weight(i) * sin * h / 3.0]
        })
    };
    beams
        .into_iter()
        .map(|(from, to, bend)| {
            let (a, b): ([f64; 2], [f64; 2]) = (nodes[from], nodes[to]);
            let chord = [b[0] - a[0], b[1] - a[1]];
            let own = integral(bend, 1.0);
            let length = maths::hypot(chord[0], chord[1]) / maths::hypot(own[0], own[1]);
            let c0 = maths::atan2(chord[1], chord[0]) - maths::atan2(own[1], own[0]);
            Box::new(move |u: f64| {
                let (p, (sin, cos)) = (integral(bend, u), maths::sin_cos(c0));
                let (ty, tx) = maths::sin_cos(c0 + bend[0] * u + bend[1] * u * u);
                Oriented {
                    point_m: [a[0] + length * (cos * p[0] - sin * p[1]), a[1] + length * (sin * p[0] + cos * p[1])],
                    tangent: [tx, ty],
                }
            }) as Box<dyn Fn(f64) -> Oriented>
        })
        .collect()
}

/// The thickness of every beam measured in the drawing gives the force of the design: w³ within 1 %, and far better.
#[test]
fn the_drawing_has_the_thickness_that_gives_the_force() {
    let exported = export("compliant/lan-table3", &[], &[Format::Dxf]).expect("a part");
    assert_eq!((exported.set.parts.len(), exported.files.len()), (1, 1));
    let profiles = polylines(&exported.files[0].1);
    // Ground and block apart from windows: four beams a half close windows between them.
    assert_eq!(profiles.len(), 1 + exported.set.parts[0].plate().expect("a plate").cutouts.len());
    let mut measured = Vec::new();
    for axis in table3_axes() {
        for section in thickness_along(&profiles, axis.as_ref(), &[0.2, 0.35, 0.5, 0.65, 0.8]) {
            let thickness = section.expect("the axis lies in the part").thickness_m();
            assert!((thickness - 1e-3).abs() < 3e-6, "{thickness}");
            measured.push(thickness);
        }
    }
    let mean = measured.iter().sum::<f64>() / measured.len() as f64;
    let force = |set: &[&str]| {
        let report = loaded("compliant/lan-table3", set).solve("", "", &mut |_| true);
        report.outcome.metric("force_at_end").expect("reached").value
    };
    let (wanted, found) = (force(&[]), force(&[&format!("design.thickness={mean:e} m")]));
    assert!((found / wanted - 1.0).abs() < 1e-2, "{found} for {wanted}");
    // The area of the drawing is that of the part: arcs stand for splines within a micrometre.
    let area: f64 = profiles.iter().map(Profile::area_m2).sum();
    let part = &exported.set.parts[0];
    assert!((area / part.plate().expect("a plate").area_m2() - 1.0).abs() < 1e-4, "{area}");
    // Beams of 1 mm, two pads of 6 mm × 6 mm, the foot of 5 mm × 6 mm between the halves and the block of 11 mm × 6 mm; the joints of
    // beams, each a few square thicknesses in all, are what is left.
    let length = |axis: &dyn Fn(f64) -> Oriented| {
        let at = |i: i32| axis(f64::from(i) / 200.0).point_m;
        (0..200).map(|i| maths::hypot(at(i + 1)[0] - at(i)[0], at(i + 1)[1] - at(i)[1])).sum::<f64>()
    };
    let beams: f64 = 2.0 * 1e-3 * table3_axes().iter().map(|axis| length(axis.as_ref())).sum::<f64>();
    let solid = 6e-3 * (2.0 * 6e-3 + 5e-3 + 11e-3);
    assert!((area - beams - solid).abs() < 4e-6, "{area} {beams} {solid}");
}

#[test]
fn faces_of_the_solid_are_few() {
    let exported = export("compliant/lan-table3", &[], &[Format::Step]).expect("a part");
    let text = String::from_utf8(exported.files[0].1.clone()).expect("text");
    let faces = text.matches("ADVANCED_FACE(").count();
    // Two caps; eight beams with at most six faces each; four pads or blocks.
    assert!(faces <= 2 + 8 * 6 + 5 * 4, "{faces}");
    assert_eq!(text.matches("MANIFOLD_SOLID_BREP(").count(), 1);
}

#[test]
fn every_format_is_written_and_the_same_each_time() {
    let all = export("compliant/lan-sub-cfm", &["parts.hole=2 mm", "parts.pad=[\"6 mm\", \"6 mm\"]"], &Format::ALL).expect("a part");
    let names: Vec<&str> = all.files.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["part.dxf", "part.svg", "part.step", "part.stl", "part.3mf", "part.inp"]);
    let again = export("compliant/lan-sub-cfm", &["parts.hole=2 mm", "parts.pad=[\"6 mm\", \"6 mm\"]"], &Format::ALL).expect("a part");
    assert_eq!(all.files, again.files);
    assert_eq!(all.set.parts[0].plate().expect("a plate").holes.len(), 3, "two clamps, one block");
}

/// What a program of finite elements is told: the pads of both halves held, the block moved, the material of the file.
#[test]
fn finite_elements_are_held_and_moved_as_the_project_says() {
    let text = |set: &[&str]| {
        let exported = export("compliant/lan-table3", set, &[Format::Inp]).expect("a part");
        String::from_utf8(exported.files[0].1.clone()).expect("text")
    };
    let whole = text(&[]);
    let sets: Vec<&str> = whole.lines().filter_map(|line| line.strip_prefix("*NSET, NSET=")).collect();
    assert_eq!(sets, ["GRIP1_N1", "GRIP2_N2", "GRIP3_N2_MIRRORED", "GRIP4_N5"]);
    // Poisson's ratio of the catalogue, 0.35: 2000 · 1.7/1.35² and 0.35/1.35.
    let line = whole.lines().skip_while(|line| *line != "*ELASTIC").nth(1).expect("constants");
    let constants: Vec<f64> = line.split(", ").map(|word| word.parse().expect("a number")).collect();
    for (constant, want) in constants.iter().zip([3400.0 / 1.8225, 0.35 / 1.35]) {
        assert!((constant - want).abs() < 1e-11, "{line}");
    }
    assert!(whole.contains("*BOUNDARY\nGRIP1_N1, 1, 2\nGRIP2_N2, 1, 2\nGRIP3_N2_MIRRORED, 1, 2\n*STEP, NLGEOM"));
    assert!(whole.contains("GRIP4_N5, 1, 1, 0\nGRIP4_N5, 2, 2, -13.6\n"));
    // A force has no increments of its own: only the mesh.
    let example = forcewright::gallery::find("compliant/lan-table3").expect("in the gallery");
    let pushed = example.text.replace("travel = \"13.6 mm\"", "force = \"5 N\"");
    let loaded = Loaded::from_text("pushed.toml", &pushed, &Choices::default()).unwrap_or_else(|e| panic!("{}", e.render(false)));
    let exported = loaded.export("part", &[Format::Inp], &Options::default()).expect("a part");
    let weight = String::from_utf8(exported.files[0].1.clone()).expect("text");
    assert!(weight.contains("** Only the mesh: only a single travel is passed on") && !weight.contains("*STEP"));
}

#[test]
fn what_the_process_cannot_make_is_missed() {
    let state = |set: &[&str], code: &str| {
        let exported = export("compliant/lan-table3", set, &[]).expect("a part");
        let check = exported.set.checks.iter().find(|c| c.code == code).expect("checked").clone();
        (check.state, check.value, exported.can_be_made())
    };
    let (open, thinnest, made) = state(&[], "COMP011");
    assert_eq!((open, made), (CheckState::NotAssessed, true));
    assert!((thinnest.expect("a wall") - 1e-3).abs() < 1e-6, "{thinnest:?}");
    assert_eq!(state(&["process.wall_min=0.8 mm"], "COMP011").0, CheckState::Met);
    let (missed, _, made) = state(&["process.wall_min=1.2 mm"], "COMP011");
    assert_eq!((missed, made), (CheckState::Missed, false));
    assert_eq!(state(&["process.gap_min=40 mm"], "COMP012").0, CheckState::Missed);
}

#[test]
fn a_fillet_smaller_than_the_cutter_is_refused() {
    let example = forcewright::gallery::find("compliant/lan-table3").expect("in the gallery");
    let choices = Choices { set: vec!["parts.fillet=0.4 mm".to_owned()], ..Choices::default() };
    let refused = Loaded::from_text("a.toml", example.text, &choices).err().expect("a cutter of 1 mm");
    assert_eq!(refused.diagnostics.in_file_order().iter().map(|d| d.code).collect::<Vec<_>>(), ["E0519"]);
}

#[test]
fn no_part_says_why() {
    let why = |name: &str, set: &[&str]| export(name, set, &[Format::Dxf]).expect_err("no part");
    let large = why("compliant/lan-table3", &["parts.fillet=20 mm"]);
    assert!(
        large.code == "E0518" && large.message.contains("fillet of radius 20 mm") && large.message.contains("the largest that does"),
        "{}",
        large.message
    );
    let hinged = why("compliant/lan-table3", &["design.nodes.n1.support=\"pinned\""]);
    assert!(hinged.message.contains("n1") && hinged.message.contains("bearing"), "{}", hinged.message);
    let hole = why("compliant/lan-table3", &["parts.hole=9 mm", "parts.pad=[\"10 mm\", \"8 mm\"]"]);
    assert!(hole.message.contains("does not fit"), "{}", hole.message);
}

/// Every example is a part in one piece, but for the one with a hinge and the one whose tip turns, which say so.
#[test]
fn every_example_is_a_part_or_says_why_not() {
    for example in forcewright::gallery::EXAMPLES.iter().filter(|e| e.text.contains("mechanism = \"compliant\"")) {
        let Ok(loaded) = Loaded::from_text(example.name, example.text, &Choices::default()) else { continue };
        match loaded.export("part", &[Format::Dxf], &Options::default()) {
            Ok(exported) => assert_eq!(exported.set.parts.len(), 1, "{}", example.name),
            Err(none) => {
                let why = [("slider-crank", "hinge"), ("two-directions", "turns on its support")];
                let known = why.iter().any(|(name, word)| example.name.ends_with(name) && none.message.contains(word));
                assert!(known, "{}: {none:?}", example.name);
            }
        }
    }
}

/// Two bars of Williams' toggle meet at the apex: each as long as its axis, with a pad of six thicknesses at its foot. Fillets at the
/// pads add 2·(1 − π/4)·r² each, about, and the joint at the apex a fraction of a square thickness.
#[test]
fn halves_that_meet_on_the_mirror_line_are_one_part() {
    let exported = export("compliant/williams-toggle", &[], &[Format::Dxf]).expect("a part");
    let part = &exported.set.parts[0];
    let plate = part.plate().expect("a plate");
    let inch = 0.0254;
    let (w, length) = (0.243 * inch, maths::hypot(12.943, 0.386) * inch);
    let fillets = 2.0 * 2.0 * (1.0 - std::f64::consts::FRAC_PI_4) * 0.25 * w * w;
    let area = 2.0 * (length * w + 36.0 * w * w) + fillets;
    assert!((plate.area_m2() - area).abs() < 0.1 * w * w, "{} {area}", plate.area_m2());
    assert!((plate.size_m()[0] - 2.0 * (12.943 * inch + 6.0 * w)).abs() < 1e-9);
    assert!(part.notes.iter().any(|n| n.contains("`apex`")), "{:?}", part.notes);
}

/// Measures and page: what is told is what is in the file, and each format is written once.
#[test]
fn the_page_tells_what_is_cut() {
    let exported = export("compliant/lan-table3", &[], &[Format::Dxf, Format::Svg, Format::Dxf]).expect("a part");
    let names: Vec<&str> = exported.files.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["part.dxf", "part.svg"]);
    let part = &exported.set.parts[0];
    let plate = part.plate().expect("a plate");
    let length: f64 = polylines(&exported.files[0].1).iter().map(Profile::length_m).sum();
    assert!((plate.cut_length_m() / length - 1.0).abs() < 1e-4, "{length}");
    // POM-C has 1410 kg/m³.
    assert!((part.mass_kg().expect("a density") / (plate.area_m2() * 10e-3 * 1410.0) - 1.0).abs() < 1e-12);
    let fillets = plate.fillets.expect("a cutter of 1 mm");
    assert!(fillets.radius_m.iter().all(|r| (r - 0.5e-3).abs() < 1e-9), "{fillets:?}");
    // Names may be broken at their dots.
    let page = exported.page("lan-table3.toml", None, "forcewright export lan-table3.toml").replace("<wbr />", "");
    for text in ["part.svg", "<svg", "thinnest wall", "cut length", "75 mm", "mass"] {
        assert!(page.contains(text), "{text}");
    }
}

/// Drums have no plane model of finite elements: that is said, and what to do instead; the other formats are written.
#[test]
fn turned_parts_have_no_plane_model() {
    let text = include_str!("../../../examples/capstan/longval.toml");
    let loaded = Loaded::from_text("longval.toml", text, &Choices::default()).map_err(|e| e.render(false)).expect("a drive");
    let refused = loaded.export("drive", &[Format::Inp], &Options::default()).map(|_| ()).expect_err("drums are turned");
    assert_eq!(refused.code, "E0327");
    assert!(refused.help.contains("step") && !refused.help.contains("report"), "{}", refused.help);
    assert!(loaded.export("drive", &[Format::Svg], &Options::default()).is_ok());
}

/// The spring of a transmission: as long, wide and heavy in its drawing as in the table by which it is ordered.
#[test]
fn springs_are_as_they_are_ordered() {
    let exported = export("lavt/butin-2", &[], &[Format::Step]).expect("parts");
    let spring = exported.set.parts.iter().find(|part| part.name == "spring").expect("a spring");
    let coil = spring.coil().expect("a coil");
    let sheet = exported.set.sheets.iter().find(|sheet| sheet.name == "spring").expect("its table");
    let told = |what: &str| -> f64 {
        sheet.rows.iter().find(|row| row[0] == what).and_then(|row| row[1].parse().ok()).unwrap_or_else(|| panic!("no {what}"))
    };
    // Six digits are told.
    let mut all = vec![
        ("length of wire / mm", 1e3 * coil.wire_length_m()),
        ("inner diameter, free / mm", 1e3 * coil.inner_diameter_m()),
        ("wire diameter / mm", 1e3 * coil.wire_m),
        ("turns", coil.turns()),
        ("length of the body / mm", 1e3 * (coil.rise_m() + coil.wire_m)),
    ];
    all.extend(spring.mass_kg().map(|kg| ("mass / g", 1e3 * kg)));
    for (what, value) in all {
        assert!((value / told(what) - 1.0).abs() < 2e-4, "{what}: {value}");
    }
    let hand = sheet.rows.iter().find(|row| row[0] == "hand").map(|row| row[1].as_str());
    assert_eq!(hand, Some(if coil.is_right_handed { "right" } else { "left" }));
    let file = exported.files.iter().find(|(name, _)| name == "part-spring.step").map(|(_, bytes)| bytes).expect("a file");
    assert!(std::str::from_utf8(file).is_ok_and(|text| text.contains("RATIONAL_B_SPLINE_SURFACE")));
    let document = exported.document();
    let part = document["parts"].as_array().and_then(|parts| parts.iter().find(|part| part["name"] == "spring")).expect("told");
    assert_eq!(part["ends"][1]["kind"], "leg along the axis");
}
