//! The drums as they are made, against the geometry that says where the cables lie.

use std::f64::consts::{PI, TAU};

use forcewright_base::maths::{acos, atan2, cos, hypot, sin};
use forcewright_capstan::Capstan;
use forcewright_capstan::geometry::{Belt, Drive, Drum, Group, Hand, Layout, Piece, Setting, Surface, preload_travel_m};
use forcewright_contract::family::{Entry, Family as _};
use forcewright_contract::project::{Choices, Project};
use forcewright_model::{CheckState, Grooved, NoPart, Part, PartSet, Section, Sheet, Turned};

const EXAMPLE: &str = include_str!("../../../../examples/capstan/longval.toml");
const CABLE: f64 = 0.0015;
const DRUMS: [Drum; 2] = [Drum::Input, Drum::Output];

/// The parts of the example with changes, and with more tables.
fn try_parts(edits: &[(&str, &str)], more: &str) -> Result<PartSet, NoPart> {
    let text = edits.iter().fold(EXAMPLE.to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "{from} is not in the example");
        text.replacen(from, to, 1)
    });
    let mut project = Project::from_text("test.toml", &format!("{text}\n{more}"), &Choices::default());
    let understood = Entry::<Capstan>::new().understand(&mut project);
    let found: Vec<_> = project.diagnostics.in_file_order().iter().map(|d| format!("{} {} {:?}", d.code, d.message, d.help)).collect();
    understood.unwrap_or_else(|| panic!("{found:#?}")).parts()
}

fn parts_of(edits: &[(&str, &str)], more: &str) -> PartSet {
    try_parts(edits, more).expect("drums")
}

/// The drive of the example.
fn example(hand: Hand, belt: Belt) -> Layout {
    Layout {
        input_radius_m: 0.010,
        output_radius_m: 0.050,
        centre_distance_m: 0.065,
        belt,
        pitch_m: 0.002,
        hand,
        starts: 5,
        extra_turns: 3,
        second_phase_rad: 0.0,
        travel_rad: 270.0_f64.to_radians(),
        guard_rad: [270.0_f64.to_radians(); 2],
        rope_diameter_m: CABLE,
        surface: Surface::Grooved,
        setting: Setting::Shared,
        cables: vec![[0, 4]],
    }
}

fn turned<'a>(set: &'a PartSet, name: &str) -> &'a Turned {
    set.parts.iter().find(|p| p.name == name).and_then(Part::turned).expect("a drum of this name")
}

fn drums(set: &PartSet) -> [&Turned; 2] {
    ["input-drum", "output-drum"].map(|name| turned(set, name))
}

fn grooved(turned: &Turned) -> Vec<(f64, &Grooved)> {
    turned.steps_m().into_iter().zip(&turned.sections).filter_map(|(z_m, section)| Some((z_m, section.grooved()?))).collect()
}

/// z of the lower end of a drum of one section in the drive.
fn foot_m(drive: &Drive, drum: Drum, margin_m: f64) -> f64 {
    drive.band(drum).from_m - margin_m
}

/// A length modulo a spacing, next to 0.
fn beside(m: f64, spacing_m: f64) -> f64 {
    m - spacing_m * (m / spacing_m).round()
}

/// Radius of the surface of a grooved section at an angle and a height above its lower end, by its description alone.
fn surface_m(section: &Grooved, angle: f64, z_m: f64) -> f64 {
    let middle_m = z_m - (angle - section.phase_rad) * section.lead_m / TAU;
    let spacing_m = section.lead_m.abs() / f64::from(section.starts);
    let start_m = section.groove.start_m[0];
    let zeta = start_m + (middle_m - start_m).rem_euclid(spacing_m);
    for (from, segment) in section.groove.spans() {
        let to = segment.end_m();
        if zeta > to[0] || to[0] - from[0] <= 0.0 {
            continue;
        }
        let forcewright_curves::Segment::Arc { centre_m, .. } = segment else {
            return from[1] + (to[1] - from[1]) * (zeta - from[0]) / (to[0] - from[0]);
        };
        let radius_m = hypot(from[0] - centre_m[0], from[1] - centre_m[1]);
        return centre_m[1] - ((radius_m - zeta + centre_m[0]) * (radius_m + zeta - centre_m[0])).max(0.0).sqrt();
    }
    section.groove.start_m[1]
}

/// Both hands and belts, as projects and as layouts.
fn variants() -> Vec<(PartSet, Drive)> {
    let mut all = Vec::new();
    for (hand, name) in [(Hand::Right, "right"), (Hand::Left, "left")] {
        for (belt, belt_name) in [(Belt::Crossed, "crossed"), (Belt::Open, "open")] {
            let flat = Drive::new(Layout { surface: Surface::Flat, ..example(hand, belt) }).expect("in range");
            let second = i32::try_from(flat.nearest_lines_apart()).expect("small");
            let belt_line = format!("belt = \"{belt_name}\"\nhand = \"{name}\"");
            let lines = format!("lines = [0, {second}]");
            let set = parts_of(&[("belt = \"crossed\"", &belt_line), ("lines = [0, 4]", &lines)], "");
            let drive = Drive::new(Layout { cables: vec![[0, second]], ..example(hand, belt) }).expect("in range");
            all.push((set, drive));
        }
    }
    all
}

#[test]
fn grooves_lie_where_the_geometry_says() {
    for (set, drive) in variants() {
        for (drum, body) in DRUMS.into_iter().zip(drums(&set)) {
            let foot_m = foot_m(&drive, drum, drive.layout().pitch_m);
            let sections = grooved(body);
            let [(_, section)] = sections[..] else { panic!("one grooved section") };
            let spacing_m = section.lead_m.abs() / f64::from(section.starts);
            for line in 0..section.starts {
                for i in 0..60 {
                    let angle = -7.0 + 0.37 * f64::from(i);
                    let z_m = drive.groove_z_m(drum, Group::First, f64::from(line), angle) - foot_m;
                    let middle_m = z_m - (angle - section.phase_rad) * section.lead_m / TAU;
                    assert!(beside(middle_m, spacing_m).abs() < 1e-12, "{drum:?}, line {line}: {middle_m}");
                }
            }
            assert!((body.length_m() - drive.drum_length_m(drum, [0.002; 2]).expect("margins")).abs() < 1e-12);
            assert_eq!(section.lead_m > 0.0, drive.hand(drum) == Hand::Right);
        }
    }
}

/// At 13 places of the travel the centre line on a drum, turned back with it, lies half a cable above the bottom of a groove.
#[test]
fn cables_lie_on_the_bottom_of_the_grooves_over_the_travel() {
    for (set, drive) in variants() {
        let bodies = drums(&set);
        for i in 0..=12 {
            let output_rad = drive.layout().travel_rad * f64::from(i) / 12.0;
            let turned_rad = drive.turned_rad(output_rad).expect("on the travel");
            let line = drive.centre_line(0, output_rad).expect("a cable");
            for piece in &line.pieces {
                let Piece::Helix(helix) = piece else { continue };
                let index = usize::from(helix.drum == Drum::Output);
                let foot_m = foot_m(&drive, helix.drum, drive.layout().pitch_m);
                let (_, section) = grooved(bodies[index])[0];
                for k in 0..=40 {
                    let [x, y, z] = piece.point_m(f64::from(k) / 40.0);
                    let angle = atan2(y, x - helix.axis_m) - turned_rad[index];
                    let above_m = hypot(x - helix.axis_m, y) - surface_m(section, angle, z - foot_m);
                    // The deviation of a span shifts the cable off the middle of the output's groove: only along the flank.
                    let spacing_m = section.lead_m.abs() / f64::from(section.starts);
                    let middle_m = beside(z - foot_m - (angle - section.phase_rad) * section.lead_m / TAU, spacing_m);
                    assert!(middle_m.abs() < 1e-9, "{:?}: {middle_m:e} m beside the groove", helix.drum);
                    assert!((above_m - 0.5 * CABLE).abs() < 1e-9, "{:?}: {above_m:e} m above the bottom", helix.drum);
                }
            }
        }
    }
}

/// Points of the cable's surface along its whole way on both drums are outside of the material.
#[test]
fn the_cable_does_not_enter_the_drums() {
    for (set, drive) in variants() {
        let bodies = drums(&set);
        let line = drive.centre_line(0, 0.4 * drive.layout().travel_rad).expect("a cable");
        let turned_rad = drive.turned_rad(0.4 * drive.layout().travel_rad).expect("on the travel");
        let mut nearest_m = f64::INFINITY;
        for piece in &line.pieces {
            let Piece::Helix(helix) = piece else { continue };
            let index = usize::from(helix.drum == Drum::Output);
            let foot_m = foot_m(&drive, helix.drum, drive.layout().pitch_m);
            let (_, section) = grooved(bodies[index])[0];
            for k in 0..=200 {
                let share = f64::from(k) / 200.0;
                let (centre, along) = (piece.point_m(share), piece.tangent(share));
                let reach = hypot(centre[0] - helix.axis_m, centre[1]);
                let out = [(centre[0] - helix.axis_m) / reach, centre[1] / reach, 0.0];
                let side =
                    [along[1] * out[2] - along[2] * out[1], along[2] * out[0] - along[0] * out[2], along[0] * out[1] - along[1] * out[0]];
                for u in 0..72 {
                    let (s, c) = (sin(TAU * f64::from(u) / 72.0), cos(TAU * f64::from(u) / 72.0));
                    let p: [f64; 3] = std::array::from_fn(|j| centre[j] + 0.5 * CABLE * (c * out[j] + s * side[j]));
                    let angle = atan2(p[1], p[0] - helix.axis_m) - turned_rad[index];
                    let gap_m = hypot(p[0] - helix.axis_m, p[1]) - surface_m(section, angle, p[2] - foot_m);
                    nearest_m = nearest_m.min(gap_m);
                }
            }
        }
        // It touches, and no more.
        assert!(nearest_m.abs() < 1e-9, "{nearest_m:e}");
    }
}

/// The closed form of the seat that a maker knows: a segment of a circle of 0.53 of the cable's diameter, 150° wide.
#[test]
fn volumes_and_inertia_are_those_of_segments() {
    let set = parts_of(&[], "[parts]\ninput_bore = \"6 mm\"\noutput_bore = \"12 mm\"\ndensity = \"7850 kg/m^3\"");
    let (seat, half) = (0.53 * CABLE, 75.0_f64.to_radians());
    let depth = seat * (1.0 - cos(half));
    let area = 0.5 * seat * seat * (2.0 * half - sin(2.0 * half));
    // Centroid of a segment below the middle of its circle, 4R sin³φ/(3(2φ − sin 2φ)).
    let below = 4.0 * seat * sin(half) * sin(half) * sin(half) / (3.0 * (2.0 * half - sin(2.0 * half)));
    for ((body, r), (bore, spacing)) in drums(&set).into_iter().zip([0.010, 0.050]).zip([(0.006, 0.002), (0.012, 0.002)]) {
        let surface = r - 0.5 * CABLE + depth;
        let centroid = surface - depth + seat - below;
        let square = PI * (surface * surface - 0.25 * bore * bore) - TAU * centroid * area / spacing;
        let exact = square * body.length_m();
        assert!((body.volume_m3() / exact - 1.0).abs() < 1e-12, "{} for {exact}", body.volume_m3());
        // Quadrature of the half section: ∫ 2πr·r² over it, by midpoints along the axis.
        let (_, section) = grooved(body)[0];
        let steps = 200_000;
        let sum: f64 = (0..steps)
            .map(|i| {
                let ring = surface_m(section, 0.3, spacing * (f64::from(i) + 0.5) / f64::from(steps));
                ring * ring * ring * ring
            })
            .sum();
        let moment = 0.5 * PI * (sum / f64::from(steps) - bore * bore * bore * bore / 16.0) * body.length_m();
        assert!((body.polar_moment_m5() / moment - 1.0).abs() < 1e-8, "{} for {moment}", body.polar_moment_m5());
        assert!((2.0 * body.largest_radius_m() - 2.0 * surface).abs() < 1e-15);
    }
    let rows = &sheet(&set, "assembly").rows;
    let value = |what: &str| number(&rows.iter().find(|row| row[1].starts_with(what)).expect("a row")[2]);
    for (name, body) in ["input", "output"].into_iter().zip(drums(&set)) {
        let mass_g = 7850e3 * body.volume_m3();
        assert!((value(&format!("Mass of the {name}")) / mass_g - 1.0).abs() < 1e-4);
        assert!((value(&format!("Moment of inertia of the {name}")) / (7850e6 * body.polar_moment_m5()) - 1.0).abs() < 1e-4);
        let part = set.parts.iter().find(|p| p.name == format!("{name}-drum")).expect("a part");
        assert!((1e3 * part.mass_kg().expect("a density") / mass_g - 1.0).abs() < 1e-12);
    }
}

/// A left-handed drive is the mirror image: leads of the other sign, all else the same.
#[test]
fn hands_are_mirror_images() {
    let right = parts_of(&[], "");
    let left = parts_of(&[("belt = \"crossed\"", "belt = \"crossed\"\nhand = \"left\"")], "");
    for (a, b) in drums(&right).into_iter().zip(drums(&left)) {
        let ((_, x), (_, y)) = (grooved(a)[0], grooved(b)[0]);
        assert!((x.lead_m + y.lead_m).abs() < 1e-18 && x.groove == y.groove);
        assert!((a.length_m() - b.length_m()).abs() < 1e-15 && (a.volume_m3() / b.volume_m3() - 1.0).abs() < 1e-13);
        for (p, q) in a.drillings.iter().zip(&b.drillings) {
            assert!((p.z_m + q.z_m - a.length_m()).abs() < 1e-12 && (p.angle_rad - q.angle_rad).abs() < 1e-12, "{p:?} {q:?}");
        }
        // The surface at mirrored heights.
        for i in 0..200 {
            let (angle, z_m) = (0.31 * f64::from(i), a.length_m() * f64::from(i) / 200.0);
            assert!((surface_m(x, angle, z_m) - surface_m(y, angle, a.length_m() - z_m)).abs() < 1e-9);
        }
    }
}

fn sheet<'a>(set: &'a PartSet, name: &str) -> &'a Sheet {
    set.sheets.iter().find(|s| s.name == name).expect("a table of this name")
}

fn number(cell: &str) -> f64 {
    cell.parse().unwrap_or_else(|_| panic!("{cell} is no number"))
}

#[test]
fn tables_follow_from_the_geometry() {
    for (set, drive) in variants() {
        for (drum, name) in DRUMS.into_iter().zip(["grooves-input", "grooves-output"]) {
            let table = sheet(&set, name);
            let foot_m = foot_m(&drive, drum, drive.layout().pitch_m);
            let mut starts = Vec::new();
            for row in &table.rows {
                let (line, angle, z, radius) = (number(&row[1]), number(&row[2]), number(&row[3]), number(&row[4]));
                let exact = drive.groove_z_m(drum, Group::First, line, angle.to_radians()) - foot_m;
                // Half of the last digits of both.
                let rounding = 0.05e-3 + 0.5e-4_f64.to_radians() * 1e3 * drive.lead_m(drum) / TAU + 1e-9;
                assert!((z - 1e3 * exact).abs() < rounding, "{name}: {z} for {}", 1e3 * exact);
                assert!((radius - 1e3 * (drive.radius_m(drum) - 0.5 * CABLE)).abs() < 0.5e-4);
                starts.push(row[1].clone());
            }
            starts.dedup();
            assert_eq!(starts.len(), if drum == Drum::Input { 1 } else { 5 });
            // From end to end of the drum.
            assert!((number(&table.rows[0][3])).abs() < 1e-4);
            let last = number(&table.rows[table.rows.len() - 1][3]);
            assert!((last - 1e3 * drive.drum_length_m(drum, [0.002; 2]).expect("margins")).abs() < 1e-4);
        }
        let foot_m = foot_m(&drive, Drum::Output, drive.layout().pitch_m);
        let holes = sheet(&set, "drillings");
        for (row, anchor) in holes.rows.iter().zip(drive.anchors(0).expect("a cable")) {
            let [x, y, z] = anchor.point_m;
            let angle = atan2(y, x - drive.layout().centre_distance_m).rem_euclid(TAU).to_degrees();
            assert!((number(&row[2]) - angle).abs() < 1e-4, "{} for {angle}", row[2]);
            assert!((number(&row[3]) - 1e3 * (z - foot_m)).abs() < 1e-4);
            assert!((number(&row[4]) - 1.8).abs() < 1e-9, "1.2 diameters of the cable");
        }
        assert_eq!(holes.rows.len(), 2);
        check_assembly(&set, &drive);
    }
}

fn check_assembly(set: &PartSet, drive: &Drive) {
    let stiffness = number(&sheet(set, "cables").rows[0][7]);
    let length_m = drive.cable_length_m(0).expect("a cable");
    let cut_mm = 1e3 * drive.cut_length_m(0, [20.0 * CABLE; 2], 200.0, stiffness).expect("in range");
    let order = &sheet(set, "cables").rows[0];
    assert!((number(&order[3]) - cut_mm).abs() < 1e-3 && (number(&order[4]) - 1e3 * length_m).abs() < 1e-4, "{order:?}");
    let rows = &sheet(set, "assembly").rows;
    let value = |what: &str| number(&rows.iter().find(|row| row[1].contains(what)).unwrap_or_else(|| panic!("no row with {what}"))[2]);
    assert!((value("Distance of the axes") - 65.0).abs() < 1e-9);
    let elongation_mm = 1e3 * preload_travel_m(length_m, 200.0, stiffness).expect("in range");
    assert!((value("it becomes longer by") - elongation_mm).abs() < 1e-3);
    assert!((value("with a screw") - elongation_mm).abs() < 1.1e-3, "a turn is a millimetre");
    assert!((value("cut to") - cut_mm).abs() < 1e-3);
    assert!((value("(guard wrap)") - 270.0).abs() < 1e-4);
    assert!((value("(travel and guard wrap)") - 540.0).abs() < 1e-4);
    let cos_gamma = (0.010 + drive.layout().belt.sign() * 0.050) / 0.065;
    assert!((value("wind it on, anticlockwise") - (1440.0 - 2.0 * acos(cos_gamma).to_degrees())).abs() < 1e-4);
    let low_m = DRUMS.map(|drum| foot_m(drive, drum, drive.layout().pitch_m));
    assert!((value("Lower end face") - 1e3 * (low_m[1] - low_m[0])).abs() < 1e-4);
    for (drum, what, low_m) in
        [(Drum::Input, "its groove crosses", low_m[0]), (Drum::Output, "start 0 of its first group crosses", low_m[1])]
    {
        let z_m = drive.groove_z_m(drum, Group::First, 0.0, value(what).to_radians());
        let off_m = beside(z_m - low_m, drive.lead_m(drum));
        assert!(off_m.abs() < 1e-6 * drive.lead_m(drum), "{off_m:e}");
    }
}

/// With a phase of its own the second group needs a stretch of its own.
#[test]
fn two_groups_have_two_stretches_or_none() {
    let phase = ("starts = 5", "starts = 5\ngroove_phase = \"3 deg\"");
    let none = try_parts(&[phase], "").expect_err("the groups overlap");
    assert_eq!(none.code, "E0731");
    assert!(none.help.contains("extra_turns") && none.help.contains("centre distance"), "{}", none.help);
    // As many turns more as the refusal asks for.
    let more: i32 = none.help.split_whitespace().nth(1).and_then(|n| n.parse().ok()).expect("a number");
    let turns = format!("extra_turns = {}", 3 + more);
    let lines = format!("lines = [0, {}]", 4 + more);
    let edits = [phase, ("extra_turns = 3", turns.as_str()), ("lines = [0, 4]", lines.as_str())];
    let set = parts_of(&edits, "");
    let [_, output] = drums(&set);
    assert_eq!(output.sections.len(), 3);
    assert!(matches!(output.sections[1], Section::Plain { .. }));
    let layout = example(Hand::Right, Belt::Crossed);
    let extra_turns = u32::try_from(3 + more).expect("positive");
    let drive = Drive::new(Layout { second_phase_rad: 3.0_f64.to_radians(), extra_turns, cables: vec![[0, 4 + more]], ..layout })
        .expect("in range");
    let foot_m = foot_m(&drive, Drum::Output, 0.002);
    let bands = drive.output_bands(0).expect("a cable");
    for ((z_m, section), (group, band)) in grooved(output).into_iter().zip([Group::First, Group::Second].into_iter().zip(bands)) {
        assert!(z_m + foot_m < band.from_m && band.to_m < z_m + foot_m + section.length_m);
        for i in 0..50 {
            let angle = 0.41 * f64::from(i);
            let above_m = drive.groove_z_m(Drum::Output, group, 0.0, angle) - foot_m - z_m;
            let middle_m = beside(above_m - (angle - section.phase_rad) * section.lead_m / TAU, 0.002);
            assert!(middle_m.abs() < 1e-12, "{group:?}: {middle_m:e}");
        }
    }
    // A phase of a whole spacing of lines is none.
    let whole = parts_of(&[("starts = 5", "starts = 5\ngroove_phase = \"72 deg\""), ("lines = [0, 4]", "lines = [0, 3]")], "");
    assert_eq!(drums(&whole)[1].sections.len(), 1);
}

#[test]
fn printed_grooves_are_wider_on_all_sides() {
    let set = parts_of(&[], "[parts]\nprint_clearance = \"0.1 mm\"");
    assert_eq!(
        set.parts.iter().map(|p| p.name.as_str()).collect::<Vec<_>>(),
        ["input-drum", "output-drum", "input-drum-print", "output-drum-print"]
    );
    for name in ["input-drum", "output-drum"] {
        let (plain, printed) = (turned(&set, name), turned(&set, &format!("{name}-print")));
        let ((_, a), (_, b)) = (grooved(plain)[0], grooved(printed)[0]);
        assert_eq!((a.phase_rad.to_bits(), a.lead_m.to_bits(), a.starts), (b.phase_rad.to_bits(), b.lead_m.to_bits(), b.starts));
        assert!((plain.largest_radius_m() - printed.largest_radius_m()).abs() < 1e-15);
        // Along the normals of the seat, which meet in its middle.
        let middle_m = a.groove.radii_m()[0] + 0.53 * CABLE;
        for i in -6..=6 {
            let lean = f64::from(i) * 0.17;
            let [x, y] = [(0.53 * CABLE + 1e-4) * sin(lean), middle_m - (0.53 * CABLE + 1e-4) * cos(lean)];
            let angle = b.phase_rad - x * TAU / b.lead_m;
            assert!((surface_m(b, angle, 0.0) - y).abs() < 1e-12, "{lean}");
        }
        let part = set.parts.iter().find(|p| p.name == format!("{name}-print")).expect("a part");
        assert!(part.title.contains("for printing"), "{}", part.title);
        let note = part.notes.iter().find(|n| n.starts_with("For printing")).expect("a note");
        // The edge of the printed groove leans by acos((R − t)/R), R and t wider by the clearance.
        let seat = 0.53 * CABLE;
        let edge = acos((seat - seat * (1.0 - cos(75.0_f64.to_radians()))) / (seat + 1e-4)).to_degrees();
        let told = number(note.split("up to ").nth(1).and_then(|n| n.split('°').next()).expect("an angle"));
        assert!((told - edge).abs() < 0.15, "{told} for {edge}");
    }
    assert_eq!(parts_of(&[], "").parts.len(), 2);
}

#[test]
fn other_sections_fit_the_cable_too() {
    let round = "groove = { profile = \"round\", seat_angle = \"150 deg\", pressure = \"cosine\", pitch = \"2 mm\" }";
    let clearance = "[parts]\nprint_clearance = \"0.05 mm\"";
    let vee = parts_of(&[(round, "groove = { profile = \"v\", angle = \"45 deg\", pitch = \"3 mm\" }")], clearance);
    // Half a diameter from both flanks: the middle of the cable lies r/sin above the tip, wherever the surface is.
    for (body, r) in drums(&vee).into_iter().zip([0.010, 0.050]) {
        let tip = body.sections[0].radii_m()[0];
        assert!((r - tip - 0.5 * CABLE / sin(22.5_f64.to_radians())).abs() < 1e-12);
    }
    // Flanks that are parallel at the clearance: a rounded tip about the sharp one.
    let printed = turned(&vee, "input-drum-print");
    assert!((turned(&vee, "input-drum").sections[0].radii_m()[0] - printed.sections[0].radii_m()[0] - 5e-5).abs() < 1e-12);
    let slot = "groove = { profile = \"undercut\", seat_angle = \"150 deg\", undercut = \"90 deg\", pitch = \"2 mm\" }";
    for (body, r) in drums(&parts_of(&[(round, slot)], clearance)).into_iter().zip([0.010, 0.050]) {
        assert!((body.sections[0].radii_m()[0] - (r - 0.5 * CABLE - 0.25 * CABLE)).abs() < 1e-12);
    }
    let flat = parts_of(&[(round, "groove = { profile = \"flat\", pitch = \"2 mm\" }")], clearance);
    assert_eq!(flat.parts.len(), 2);
    for (body, r) in drums(&flat).into_iter().zip([0.010, 0.050]) {
        assert!(matches!(body.sections[..], [Section::Plain { radius_m, .. }] if (radius_m - (r - 0.5 * CABLE)).abs() < 1e-15));
    }
}

#[test]
fn what_cannot_be_turned_is_refused() {
    let bore = try_parts(&[], "[parts]\ninput_bore = \"19 mm\"").expect_err("no wall");
    assert_eq!(bore.code, "E0730");
    assert!(bore.message.contains("input drum"), "{}", bore.message);
    let narrow = try_parts(&[("pitch = \"2 mm\"", "pitch = \"1.5 mm\"")], "").expect_err("no land");
    assert_eq!(narrow.code, "E0730");
    assert!(narrow.help.contains("pitch"), "{}", narrow.help);
}

#[test]
fn checks_say_what_is_known() {
    let hold = ("friction = 0.15", "friction = 0.15\ninput_hold = \"fastened\"");
    let set = parts_of(&[hold], "[parts]\ninput_bore = \"6 mm\"\noutput_bore = \"96 mm\"");
    let state = |name: &str| set.checks.iter().find(|c| c.name == name).map(|c| (c.state, c.value));
    let (wall, value) = state("input_wall").expect("a bore");
    assert_eq!(wall, CheckState::Met);
    assert!((value.expect("a wall") - (0.010 - 0.5 * CABLE - 0.003)).abs() < 1e-12);
    assert_eq!(state("output_wall").expect("a bore").0, CheckState::Missed);
    // p − 2√(ρ² − (ρ − t)²) of the seat, against 0.2 mm, which nobody asked for.
    let land = set.checks.iter().find(|c| c.name == "input_land").expect("grooves");
    assert_eq!((land.state, land.required, land.limit), (CheckState::Met, false, Some(0.2e-3)));
    let asked = parts_of(&[], "[parts]\nleast_wall = \"0.8 mm\"");
    let land = asked.checks.iter().find(|c| c.name == "input_land").expect("grooves");
    assert_eq!((land.state, land.required), (CheckState::Missed, true));
    let advice = land.advice.clone().expect("missed");
    let pitch = advice.split("of at least ").nth(1).and_then(|t| t.split(',').next()).expect("a pitch").to_owned();
    let wider = parts_of(&[("pitch = \"2 mm\"", &format!("pitch = \"{pitch}\""))], "[parts]\nleast_wall = \"0.8 mm\"");
    for name in ["input_land", "output_land"] {
        let land = wider.checks.iter().find(|c| c.name == name).expect("grooves");
        assert!(land.value.is_some_and(|m| (0.8e-3..0.81e-3).contains(&m)), "{advice}: {land:?}");
    }
    // 4 turns less 2γ, 1394.8°, against 5 · 270°.
    let (pin, value) = state("pin").expect("fastened");
    assert_eq!(pin, CheckState::Met);
    assert!((value.expect("a wrap") - (4.0 * TAU - 2.0 * acos(60.0 / 65.0))).abs() < 1e-12);
    // The pin lies in the groove, and under the cable at both ends of the travel: on the drum the wrap moves by R times it.
    let [hole] = &drums(&set)[0].drillings[..] else { panic!("one pin") };
    let (_, section) = grooved(drums(&set)[0])[0];
    assert!((surface_m(section, hole.angle_rad, hole.z_m) - (0.010 - 0.5 * CABLE)).abs() < 1e-9);
    let drive = Drive::new(example(Hand::Right, Belt::Crossed)).expect("in range");
    for output_rad in [0.0, drive.layout().travel_rad] {
        let Piece::Helix(wrap) = drive.centre_line(0, output_rad).expect("a cable").pieces[2] else { panic!("on the input") };
        let from_m = wrap.start_m - foot_m(&drive, Drum::Input, 0.002);
        assert!(from_m < hole.z_m && hole.z_m < from_m + wrap.rise_m, "{hole:?} at {output_rad}");
    }
}
