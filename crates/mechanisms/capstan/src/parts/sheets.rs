//! Tables that go with the drums: paths of the tool, drillings, cables to order, and assembly step by step.

use std::f64::consts::TAU;

use forcewright_base::units::format_number;
use forcewright_model::{NoPart, Sheet};

use super::drum::{Made, index_of, name_of, no_drum, phase_rad};
use crate::design::Design;
use crate::geometry::{Belt, Drive, Drum, GeometryError, Group, Hand, Tensioner, preload_travel_m};

/// Steps of the tool's paths, rad.
const STEP_RAD: f64 = 0.25 * TAU;
/// Lead of the screw whose turns are told, m.
const SCREW_M: f64 = 1e-3;

fn refused(error: GeometryError) -> NoPart {
    no_drum(&error)
}

/// A length in mm to a tenth of a micrometre.
fn mm(m: f64) -> String {
    format!("{:.4}", 1e3 * m)
}

/// An angle in degrees, to 2 µm at a radius of a metre.
fn degrees(rad: f64) -> String {
    format!("{:.4}", rad.to_degrees())
}

fn sheet(name: &str, caption: &str, columns: &[&str], rows: Vec<Vec<String>>) -> Sheet {
    Sheet { name: name.to_owned(), caption: caption.to_owned(), columns: columns.iter().map(|&c| c.to_owned()).collect(), rows }
}

/// All tables. `made` are both drums, input first.
pub(super) fn sheets(design: &Design, geometry: &Drive, made: &[Made], inertia: &[Option<[f64; 2]>]) -> Result<Vec<Sheet>, NoPart> {
    let mut all = Vec::new();
    for drum in made.iter().filter(|drum| drum.groove.is_some()) {
        all.push(tool_paths(design, geometry, drum).map_err(refused)?);
    }
    all.push(drillings(made));
    all.push(cables(design, geometry).map_err(refused)?);
    all.push(assembly(design, geometry, made, inertia).map_err(refused)?);
    Ok(all)
}

/// Places of every groove of a drum, a quarter of a turn apart at most.
fn tool_paths(design: &Design, geometry: &Drive, made: &Made) -> Result<Sheet, GeometryError> {
    let least_m = geometry.radius_m(made.drum) - 0.5 * design.built.cable_m();
    let mut rows = Vec::new();
    for stretch in &made.stretches {
        let group = if stretch.group == Group::First { "first" } else { "second" };
        for path in geometry.groove_paths(made.drum, stretch.group, stretch.band, STEP_RAD)? {
            for [angle_rad, z_m] in path.points {
                rows.push(vec![group.to_owned(), path.start.to_string(), degrees(angle_rad), mm(z_m - made.foot_m), mm(least_m)]);
            }
        }
    }
    let name = name_of(made.drum);
    let caption = format!(
        "Grooves of the {name} drum, {} mm of z in a turn: angle from the x axis towards y, z above the lower end face, radius where the cable lies lowest.",
        mm(geometry.hand(made.drum).sign() * geometry.lead_m(made.drum))
    );
    Ok(sheet(&format!("grooves-{name}"), &caption, &["group", "start", "angle / deg", "z / mm", "radius / mm"], rows))
}

/// Holes that are not in the solids.
fn drillings(made: &[Made]) -> Sheet {
    let rows = made.iter().flat_map(|drum| {
        drum.body.drillings.iter().map(|d| {
            let numbers = [degrees(d.angle_rad), mm(d.z_m), mm(d.diameter_m), mm(d.depth_m)];
            [name_of(drum.drum).to_owned(), d.purpose.clone()].into_iter().chain(numbers).collect()
        })
    });
    let columns = ["drum", "for", "angle / deg", "z / mm", "diameter / mm", "depth / mm"];
    sheet("drillings", "Holes towards the axis, which are not in the solids; angles and z as for the grooves.", &columns, rows.collect())
}

/// Cables to order and to cut.
fn cables(design: &Design, geometry: &Drive) -> Result<Sheet, GeometryError> {
    let mut rows = Vec::new();
    for (index, cable) in design.built.cables.iter().enumerate() {
        let unknown = |value: Option<f64>, scale: f64| value.map_or_else(|| "–".to_owned(), |v| format_number(scale * v, 5));
        rows.push(vec![
            (index + 1).to_string(),
            cable.construction.map_or_else(|| "as typed".to_owned(), |c| c.name.clone()),
            format_number(1e3 * cable.diameter_m, 5),
            mm(cut_length_m(design, geometry, index)?),
            mm(geometry.cable_length_m(index)?),
            mm(design.making.anchor_m),
            format_number(cable.preload_n, 5),
            format_number(cable.axial_stiffness_n, 5),
            unknown(cable.breaking_n, 1.0),
            unknown(cable.mass_kg_per_m, 1e3),
        ]);
    }
    let columns = [
        "cable",
        "construction",
        "diameter / mm",
        "cut length / mm",
        "between the anchors under preload / mm",
        "within each anchor / mm",
        "preload / N",
        "axial stiffness / N",
        "breaking force / N",
        "mass / g/m",
    ];
    let caption = "Cables to order; the cut length is that without tension, with what both anchors hold.";
    Ok(sheet("cables", caption, &columns, rows))
}

fn cut_length_m(design: &Design, geometry: &Drive, index: usize) -> Result<f64, GeometryError> {
    let cable = &design.built.cables[index];
    geometry.cut_length_m(index, [design.making.anchor_m; 2], cable.preload_n, cable.axial_stiffness_n)
}

/// Rows of the assembly, numbered as they come.
struct Steps {
    rows: Vec<Vec<String>>,
}

impl Steps {
    fn push(&mut self, what: impl Into<String>, value: String, unit: &str) {
        let number = (self.rows.len() + 1).to_string();
        self.rows.push(vec![number, what.into(), value, unit.to_owned()]);
    }
}

fn assembly(design: &Design, geometry: &Drive, made: &[Made], inertia: &[Option<[f64; 2]>]) -> Result<Sheet, GeometryError> {
    let mut steps = Steps { rows: Vec::new() };
    place(design, geometry, made, &mut steps);
    // From below, so that no cable is led over one that lies already.
    let mut order: Vec<usize> = (0..design.built.cables.len()).collect();
    order.sort_by_key(|&i| design.built.cables[i].lines[0]);
    for index in order {
        wind(design, geometry, made, index, &mut steps)?;
    }
    let travel = design.built.travel_rad;
    steps.push("Turn the output several times over its travel; then draw every cable to its preload again", degrees(travel), "deg");
    for (made, inertia) in made.iter().zip(inertia) {
        let Some([mass_kg, inertia_kg_m2]) = inertia else { continue };
        let name = name_of(made.drum);
        steps.push(format!("Mass of the {name} drum, without drillings"), format_number(1e3 * mass_kg, 5), "g");
        steps.push(format!("Moment of inertia of the {name} drum about its axis"), format_number(1e6 * inertia_kg_m2, 5), "kg mm²");
    }
    let caption = "Assembly, in this order. The output stands at the start of its travel; angles are seen against z, from the line from the input's to the output's axis.";
    Ok(sheet("assembly", caption, &["step", "what", "value", "unit"], steps.rows))
}

/// Both drums in their places.
fn place(design: &Design, geometry: &Drive, made: &[Made], steps: &mut Steps) {
    steps.push("Distance of the axes", mm(design.built.distance_m), "mm");
    if let [input, output] = made {
        let what = "Lower end face of the output drum above that of the input drum";
        steps.push(what, mm(output.foot_m - input.foot_m), "mm");
    }
    for drum in made {
        let name = name_of(drum.drum);
        steps.push(format!("Turn the {name} drum: its x axis stands at"), degrees(0.0), "deg");
        for stretch in drum.stretches.iter().filter(|_| drum.groove.is_some()) {
            let which = match (drum.drum, stretch.group) {
                (Drum::Input, _) => "its groove".to_owned(),
                (_, Group::First) => "start 0 of its first group".to_owned(),
                (_, Group::Second) => "start 0 of its second group".to_owned(),
            };
            let what = format!("To be seen then: {which} crosses z = {} mm of the {name} drum at", mm(stretch.band.from_m - drum.foot_m));
            steps.push(what, degrees(phase_rad(geometry, drum.drum, stretch.group, stretch.band.from_m)), "deg");
        }
    }
    if made.iter().any(|drum| drum.groove.is_some()) {
        let what = "Fine setting: turning the input drum in its coupling by this moves its groove up by 0.1 mm";
        let angle = -geometry.hand(Drum::Input).sign() * TAU * 1e-4 / design.built.pitch_m;
        steps.push(what, degrees(angle), "deg");
    }
}

/// One cable from end 0 to end 1.
fn wind(design: &Design, geometry: &Drive, made: &[Made], index: usize, steps: &mut Steps) -> Result<(), GeometryError> {
    let built = &design.built;
    let cable = &built.cables[index];
    let who = format!("Cable {}", index + 1);
    let [first, second] = geometry.anchors(index)?;
    let foot_m = made.iter().find(|m| index_of(m.drum) == 1).map_or(0.0, |m| m.foot_m);
    let grooved = made.iter().any(|drum| drum.groove.is_some());
    let starts = i64::from(built.starts);
    let groove = |end: usize| {
        if grooved { format!(" in start {}", i64::from(cable.lines[end]).rem_euclid(starts)) } else { String::new() }
    };
    let sense = if built.belt == Belt::Crossed { "clockwise" } else { "anticlockwise" };
    let rising = if built.hand == Hand::Right { "upwards" } else { "downwards" };
    let [first_wrap, second_wrap] = geometry.output_wraps_rad(0.0)?;
    let length_m = geometry.cable_length_m(index)?;
    let elongation_m = preload_travel_m(length_m, cable.preload_n, cable.axial_stiffness_n)?;
    let turns = Tensioner::Screw { lead_m: SCREW_M }.turn_rad(elongation_m)? / TAU;
    steps.push(format!("{who}: cut to"), mm(cut_length_m(design, geometry, index)?), "mm");
    steps.push(
        format!("{who}: fix end 0 in its hole on the output drum, z = {} mm, at", mm(first.z_m - foot_m)),
        degrees(first.angle_rad.rem_euclid(TAU)),
        "deg",
    );
    steps.push(
        format!("{who}: lay it on the output drum{}, {sense} and {rising}, over (guard wrap)", groove(0)),
        degrees(first_wrap),
        "deg",
    );
    steps.push(
        format!("{who}: lead it to the input drum and wind it on, anticlockwise and {rising}, over"),
        degrees(geometry.input_wrap_rad()),
        "deg",
    );
    let what =
        format!("{who}: lead it back and wind it on the output drum{}, {sense} and {rising}, over (travel and guard wrap)", groove(1));
    steps.push(what, degrees(second_wrap), "deg");
    steps.push(
        format!("{who}: fix end 1 in its hole or tensioner, z = {} mm, at", mm(second.z_m - foot_m)),
        degrees(second.angle_rad.rem_euclid(TAU)),
        "deg",
    );
    let preload = format_number(cable.preload_n, 5);
    steps.push(format!("{who}: draw it to its preload of {preload} N; it becomes longer by"), mm(elongation_m), "mm");
    steps.push(format!("{who}: that is, with a screw that moves by 1 mm in a turn"), format!("{turns:.3}"), "turns");
    Ok(())
}
