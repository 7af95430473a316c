//! Input of `CalculiX` and Abaqus: the plane of the part in quadratic triangles under plane stress, held and moved by its grips.
//!
//! Elements are those of plane strain with the constants that make their stresses those of plane stress, E(1 + 2ν)/(1 + ν)² and ν/(1 + ν):
//! `CalculiX` makes solids of plane elements, and its own plane stress is exact only for plates that are thin against the elements; at ten
//! times their size it is nearly plane strain.

use std::fmt::Write as _;

use forcewright_curves::Profile;
use forcewright_curves::walls::thinnest_wall;
use forcewright_model::{Part, Plate, Trial};

use crate::elements::{self, Elements, Region};
use crate::error::{Error, Place};
use crate::shape::{MM_PER_M, Shape};
use crate::text::{length, ratio, remarks};

/// Equal increments of the path.
const INCREMENTS: usize = 34;
/// Elements through the thinnest wall, where no size is given.
const THROUGH: f64 = 4.0;
/// Longest line of a list.
const PER_LINE: usize = 12;
/// Longest remark: lines of the format end there.
const LONGEST: usize = 120;

/// The file. All in mm, N and megapascal.
pub(crate) fn write(part: &Part, plate: &Plate, shape: &Shape, element_m: Option<f64>) -> Result<String, Error> {
    let grips: &[forcewright_model::Grip] = plate.trial.as_ref().map_or(&[], |trial| &trial.grips);
    let regions: Vec<Region> =
        grips.iter().map(|grip| Region { corners: grip.corners_m.iter().map(|p| p.map(|x| x * MM_PER_M)).collect() }).collect();
    let size = MM_PER_M * element_m.unwrap_or_else(|| default_size_m(plate));
    let elements = elements::mesh(shape, &regions, size).map_err(|problem| Error { place: Place::Part, problem })?;
    let mut out = String::from("*HEADING\n");
    let plain = |text: &str| text.chars().map(|c| if c.is_ascii_graphic() || c == ' ' { c } else { '?' }).take(LONGEST).collect::<String>();
    for remark in remarks(part) {
        let _ = writeln!(out, "** {}", plain(&remark));
    }
    let _ = writeln!(out, "** Units: mm, N, MPa. Sides of elements: about {} mm.", length(size));
    add_elements(&elements, &mut out);
    match &plate.trial {
        Ok(trial) => add_trial(trial, shape.depth, &elements, &mut out),
        Err(why) => {
            let _ = writeln!(out, "** Only the mesh: {}.", plain(why));
        }
    }
    Ok(out)
}

/// A quarter of the thinnest wall, or a fiftieth of the part where it has no two faces opposite each other, m.
fn default_size_m(plate: &Plate) -> f64 {
    let holes = plate.holes.iter().map(|hole| Profile::circle(hole.centre_m, 0.5 * hole.diameter_m).reversed());
    let profiles: Vec<Profile> = std::iter::once(&plate.outline).chain(&plate.cutouts).cloned().chain(holes).collect();
    let bounds = plate.outline.bounds();
    let extent_m = (bounds.max_m[0] - bounds.min_m[0]).max(bounds.max_m[1] - bounds.min_m[1]);
    thinnest_wall(&profiles).map_or(extent_m / 50.0, |wall| (wall.width_m / THROUGH).min(extent_m / 50.0))
}

fn add_elements(elements: &Elements, out: &mut String) {
    out.push_str("*NODE, NSET=ALL\n");
    for (index, [x, y]) in elements.nodes.iter().enumerate() {
        let _ = writeln!(out, "{}, {}, {}, 0", index + 1, length(*x), length(*y));
    }
    out.push_str("*ELEMENT, TYPE=CPE6, ELSET=PART\n");
    for (index, nodes) in elements.triangles.iter().enumerate() {
        let _ = writeln!(out, "{}, {}", index + 1, nodes.map(|node| (node + 1).to_string()).join(", "));
    }
}

/// Material, sets of nodes, and the path: grips that are moved go straight, in equal increments.
fn add_trial(trial: &Trial, depth: f64, elements: &Elements, out: &mut String) {
    let (young, nu) = (1e-6 * trial.young_pa, trial.poisson);
    let _ = writeln!(
        out,
        "** Plane stress by elements of plane strain: E(1 + 2 nu)/(1 + nu)^2 and nu/(1 + nu).\n\
         ** For plane strain (plates much deeper than thick and bent hard) write {}, {} instead.\n\
         *MATERIAL, NAME=MATERIAL\n*ELASTIC\n{}, {}",
        length(young),
        length(nu),
        length(young * (1.0 + 2.0 * nu) / ((1.0 + nu) * (1.0 + nu))),
        length(nu / (1.0 + nu))
    );
    let _ = writeln!(out, "*SOLID SECTION, ELSET=PART, MATERIAL=MATERIAL\n{}", length(depth));
    let mut held = String::new();
    let (mut moved, mut printed) = (String::new(), String::new());
    for ((grip, nodes), index) in trial.grips.iter().zip(&elements.gripped).zip(1..) {
        // A grip of another piece, or one that no beam leaves.
        if nodes.is_empty() {
            continue;
        }
        let set = set_name(&grip.name, index);
        let _ = writeln!(out, "*NSET, NSET={set}");
        for line in nodes.chunks(PER_LINE) {
            let _ = writeln!(out, "{},", line.iter().map(|node| (node + 1).to_string()).collect::<Vec<_>>().join(", "));
        }
        let [x, y] = grip.displacement_m.map(|m| length(MM_PER_M * m));
        if grip.is_held() {
            let _ = writeln!(held, "{set}, 1, 2");
        } else {
            let _ = writeln!(moved, "{set}, 1, 1, {x}\n{set}, 2, 2, {y}");
        }
        let _ = writeln!(printed, "*NODE PRINT, NSET={set}, TOTALS=YES\nRF");
    }
    if !held.is_empty() {
        let _ = write!(out, "*BOUNDARY\n{held}");
    }
    let step = ratio(1.0 / INCREMENTS as f64);
    let _ = write!(out, "*STEP, NLGEOM, INC={}\n*STATIC, DIRECT\n{step}, 1\n*BOUNDARY\n{moved}{printed}", INCREMENTS + 1);
    out.push_str("** For pictures add: *NODE FILE with U, *EL FILE with S.\n*END STEP\n");
}

/// A name that the format allows, and that no other grip has.
fn set_name(name: &str, index: usize) -> String {
    let plain = name.chars().map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_uppercase() } else { '_' }).take(40);
    format!("GRIP{index}_{}", plain.collect::<String>())
}
