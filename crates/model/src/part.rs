//! What is made: the only thing that exporters see. Lengths in metres.

use forcewright_base::units::Unit;
use forcewright_curves::Profile;

use crate::{Check, Coil, Turned};

/// A piece that is made: what it is called, what it is made of, and its body.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Short name, fit for a file name: `monolith`.
    pub name: String,
    /// What it is, for people.
    pub title: String,
    /// How many of it the mechanism has; 0 of one that takes the place of another, as a drum for printing.
    pub count: usize,
    /// What it is made of; `None` if nothing was said.
    pub material: Option<String>,
    /// Density of that, kg/m³; `None` if it is not known.
    pub density_kg_per_m3: Option<f64>,
    /// What the maker must know, a sentence each.
    pub notes: Vec<String>,
    /// Its shape.
    pub body: Body,
}

/// The shape of a part, after the way it is made.
#[derive(Clone, Debug, PartialEq)]
pub enum Body {
    /// Cut or printed in one piece, of constant thickness.
    Plate(Plate),
    /// Made on a lathe.
    Turned(Turned),
    /// Wound of wire.
    Coil(Coil),
}

/// A plate of constant thickness, cut or printed in one piece.
#[derive(Clone, Debug, PartialEq)]
pub struct Plate {
    /// Its extent out of the plane, m.
    pub depth_m: f64,
    /// The outer boundary, counterclockwise.
    pub outline: Profile,
    /// Boundaries of what is cut out, clockwise.
    pub cutouts: Vec<Profile>,
    /// Round holes through the plate.
    pub holes: Vec<Hole>,
    /// Arcs in re-entrant corners; `None` if it has none.
    pub fillets: Option<Fillets>,
    /// How it is held and moved, for finite elements; else what keeps that from being said.
    pub trial: Result<Trial, String>,
}

/// A part in its machine: what a program of finite elements must know besides the outline.
#[derive(Clone, Debug, PartialEq)]
pub struct Trial {
    /// Young's modulus, Pa.
    pub young_pa: f64,
    /// Poisson's ratio, in (−1, 0.5).
    pub poisson: f64,
    /// Where it is held and moved.
    pub grips: Vec<Grip>,
}

/// A region whose material is as good as rigid: screwed to the ground, or part of what moves the part.
#[derive(Clone, Debug, PartialEq)]
pub struct Grip {
    /// Name of its node or body.
    pub name: String,
    /// Its corners, convex, counterclockwise, m.
    pub corners_m: Vec<[f64; 2]>,
    /// By how much it is moved without turning at the end of the path, m; zero where it is held.
    pub displacement_m: [f64; 2],
}

impl Grip {
    /// Whether it stays where it is.
    pub fn is_held(&self) -> bool {
        self.displacement_m.iter().all(|x| x.abs() <= 0.0)
    }
}

impl Part {
    /// Its plate, if it is one.
    pub fn plate(&self) -> Option<&Plate> {
        match &self.body {
            Body::Plate(plate) => Some(plate),
            Body::Turned(_) | Body::Coil(_) => None,
        }
    }

    /// Its turned body, if it is one.
    pub fn turned(&self) -> Option<&Turned> {
        match &self.body {
            Body::Turned(turned) => Some(turned),
            Body::Plate(_) | Body::Coil(_) => None,
        }
    }

    /// Its coil, if it is one.
    pub fn coil(&self) -> Option<&Coil> {
        match &self.body {
            Body::Coil(coil) => Some(coil),
            Body::Plate(_) | Body::Turned(_) => None,
        }
    }

    /// Its volume, m³: exact, but for the drillings of a turned part, which are not taken off.
    pub fn volume_m3(&self) -> f64 {
        match &self.body {
            Body::Plate(plate) => plate.area_m2() * plate.depth_m,
            Body::Turned(turned) => turned.volume_m3(),
            Body::Coil(coil) => coil.volume_m3(),
        }
    }

    /// Its mass, kg, if its density is known.
    pub fn mass_kg(&self) -> Option<f64> {
        let density_kg_per_m3 = self.density_kg_per_m3?;
        Some(match &self.body {
            // In this order, to which rounding clings.
            Body::Plate(plate) => density_kg_per_m3 * plate.area_m2() * plate.depth_m,
            Body::Turned(turned) => density_kg_per_m3 * turned.volume_m3(),
            Body::Coil(coil) => density_kg_per_m3 * coil.volume_m3(),
        })
    }
}

impl Plate {
    /// Area of the plate in its plane, m².
    pub fn area_m2(&self) -> f64 {
        let holes = self.holes.iter().map(|h| 0.25 * std::f64::consts::PI * h.diameter_m * h.diameter_m);
        self.outline.area_m2() + self.cutouts.iter().map(Profile::area_m2).sum::<f64>() - holes.sum::<f64>()
    }

    /// Length of all cuts, m: the outline, what is cut out, the holes.
    pub fn cut_length_m(&self) -> f64 {
        let holes = self.holes.iter().map(|h| std::f64::consts::PI * h.diameter_m);
        self.outline.length_m() + self.cutouts.iter().map(Profile::length_m).sum::<f64>() + holes.sum::<f64>()
    }

    /// Width and height in the plane, m.
    pub fn size_m(&self) -> [f64; 2] {
        let bounds = self.outline.bounds();
        [0, 1].map(|k| bounds.max_m[k] - bounds.min_m[k])
    }
}

/// Arcs in the re-entrant corners of a plate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fillets {
    /// How many.
    pub count: usize,
    /// Smallest and largest radius, m.
    pub radius_m: [f64; 2],
}

/// A place of a plate to look at.
#[derive(Clone, Debug, PartialEq)]
pub struct PartMark {
    /// Where, m.
    pub at_m: [f64; 2],
    /// What is there: `thinnest wall 0.5 mm`.
    pub text: String,
}

/// A table that goes with the parts: places to inspect, springs to order. Numbers carry their units in the heading.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sheet {
    /// Short name, fit for a file name: `inspection`.
    pub name: String,
    /// What it shows.
    pub caption: String,
    /// Headings: `x / mm`.
    pub columns: Vec<String>,
    /// Rows of cells, as many as headings.
    pub rows: Vec<Vec<String>>,
}

impl Sheet {
    /// As a CSV file.
    pub fn csv(&self) -> String {
        let line = |cells: &[String]| {
            let quoted = |c: &String| if c.contains([',', '"', '\n']) { format!("\"{}\"", c.replace('"', "\"\"")) } else { c.clone() };
            cells.iter().map(quoted).collect::<Vec<_>>().join(",")
        };
        let rows = self.rows.iter().map(|row| line(row));
        std::iter::once(line(&self.columns)).chain(rows).map(|l| l + "\n").collect()
    }
}

/// The parts of a mechanism.
#[derive(Clone, Debug)]
pub struct PartSet {
    /// One of each kind.
    pub parts: Vec<Part>,
    /// Where the wall is thinnest and the gap narrowest.
    pub marks: Vec<PartMark>,
    /// Tables that go with them.
    pub sheets: Vec<Sheet>,
    /// The unit in which people are shown lengths.
    pub display: Unit,
    /// Whether the process can make them.
    pub checks: Vec<Check>,
}

impl PartSet {
    /// How many pieces they are.
    pub fn pieces(&self) -> usize {
        self.parts.iter().map(|part| part.count).sum()
    }

    /// Mass of all pieces whose density is known, kg, and the names of the others.
    pub fn mass_kg(&self) -> (f64, Vec<&str>) {
        let used = || self.parts.iter().filter(|part| part.count > 0);
        let known = used().filter_map(|part| Some(part.count as f64 * part.mass_kg()?)).sum();
        (known, used().filter(|part| part.mass_kg().is_none()).map(|part| part.name.as_str()).collect())
    }
}

/// Why a mechanism has no parts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NoPart {
    /// Stable code; `explain` knows it.
    pub code: &'static str,
    /// What is wrong, with the names of the project.
    pub message: String,
    /// What would help.
    pub help: String,
}

/// A round hole through a plate.
#[derive(Clone, Debug, PartialEq)]
pub struct Hole {
    /// Middle, m.
    pub centre_m: [f64; 2],
    /// Diameter, m.
    pub diameter_m: f64,
    /// What it is for: `M3 clearance`.
    pub purpose: String,
}
