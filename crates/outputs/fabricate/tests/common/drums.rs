//! Turned parts with known volumes.

use std::f64::consts::{PI, TAU};

use forcewright_base::quadrature::GaussLegendre;
use forcewright_model::{Body, Drilling, Groove, GrooveError, Grooved, Part, Section, Turned};

use super::point_and_slope;

/// A turned part and what is known of it without any writer.
pub struct Drum {
    pub part: Part,
    /// By quadrature, m³.
    pub volume_m3: f64,
    /// At least the area of all it is bounded by, m².
    pub surface_m2: f64,
    /// Faces of the solid: a cylinder has two, a grooved section one for each segment of each groove.
    pub faces: usize,
}

/// All drums.
///
/// # Panics
/// Never: their grooves are sound.
pub fn drums() -> Vec<Drum> {
    made().expect("sound grooves")
}

fn made() -> Result<Vec<Drum>, GrooveError> {
    let round = |radius_m: f64, spacing_m: f64| Groove::round(radius_m, spacing_m, 1.05e-3, 0.8e-3);
    let five = grooved(0.04, 13e-3, 5, 0.3, round(0.025, 2.6e-3)?);
    let one_left = grooved(0.022, -2.5e-3, 1, -1.0, round(0.01, 2.5e-3)?);
    let vee = grooved(0.02, 5e-3, 2, 0.0, Groove::vee(0.012, 2.5e-3, 0.7, 0.2e-3, 1e-3)?);
    let sharp = grooved(0.01, -4e-3, 2, 4.0, Groove::vee(0.012, 2e-3, 1.5, 0.0, 0.6e-3)?);
    let undercut = grooved(0.016, 3e-3, 1, 1.0, Groove::undercut(0.015, 3e-3, [1.1e-3, 0.9e-3], [0.6e-3, 0.5e-3])?);
    let steep = grooved(0.05, -0.1, 3, 0.5, Groove::round(0.02, 0.1 / 3.0, 2e-3, 2.5e-3)?);
    let groups =
        [grooved(0.012, 6e-3, 2, 0.0, round(0.018, 3e-3)?), plain(0.002, 0.0165), grooved(0.012, 6e-3, 2, 0.7, round(0.018, 3e-3)?)];
    Ok(vec![
        drum("drum-five", 0.008, vec![plain(0.003, 0.029), five, plain(0.004, 0.02), plain(0.002, 0.027)]),
        drum("drum-left", 0.0, vec![one_left]),
        drum("drum-vee", 0.006, vec![plain(0.002, 0.01), vee, plain(0.003, 0.015)]),
        drum("drum-sharp", 0.0, vec![plain(0.001, 0.013), sharp]),
        drum("drum-undercut", 0.01, vec![undercut]),
        drum("drum-steep", 0.005, vec![steep]),
        drum("drum-groups", 0.0, groups.to_vec()),
    ])
}

fn plain(length_m: f64, radius_m: f64) -> Section {
    Section::Plain { length_m, radius_m }
}

pub fn grooved(length_m: f64, lead_m: f64, starts: u32, phase_rad: f64, groove: Groove) -> Section {
    Section::Grooved(Grooved { length_m, lead_m, starts, phase_rad, groove })
}

pub fn turned(name: &str, bore_diameter_m: f64, sections: Vec<Section>) -> Part {
    let drilling = Drilling { z_m: 0.001, angle_rad: 0.5, diameter_m: 0.0012, depth_m: 0.004, purpose: "end of the cable".to_owned() };
    Part {
        name: name.to_owned(),
        title: format!("Sample {name}"),
        count: 1,
        material: Some("steel".to_owned()),
        density_kg_per_m3: Some(7850.0),
        notes: vec!["Break all edges.".to_owned()],
        body: Body::Turned(Turned { bore_diameter_m, sections, drillings: vec![drilling] }),
    }
}

fn drum(name: &str, bore_diameter_m: f64, sections: Vec<Section>) -> Drum {
    let bore_m2 = 0.25 * PI * bore_diameter_m * bore_diameter_m;
    let (mut volume_m3, mut surface_m2, mut faces) = (0.0, 0.0, sections.len() + 1 + if bore_diameter_m > 0.0 { 2 } else { 0 });
    for section in &sections {
        volume_m3 += section.length_m() * (area_m2(section) - bore_m2);
        // Grooves are at most this much longer than lands, in both directions.
        surface_m2 += 4.0 * TAU * section.radii_m()[1] * (section.length_m() + section.radii_m()[1]);
        faces += match section {
            Section::Plain { .. } => 2,
            Section::Grooved(grooved) => usize::try_from(grooved.starts).unwrap_or(0) * grooved.groove.segments.len(),
        };
    }
    Drum { part: turned(name, bore_diameter_m, sections), volume_m3, surface_m2, faces }
}

/// ½∮ρ² dφ around a section, with φ = 2π(z − ζ)/lead along the profile of each groove.
pub fn area_m2(section: &Section) -> f64 {
    let rule = GaussLegendre::new(24);
    match section {
        Section::Plain { radius_m, .. } => PI * radius_m * radius_m,
        Section::Grooved(grooved) => {
            let along = |(from, segment): ([f64; 2], &forcewright_curves::Segment)| {
                rule.integrate(|t| {
                    let (point, slope) = point_and_slope(segment, from, t);
                    point[1] * point[1] * slope[0]
                })
            };
            let turn_per_m = TAU / grooved.lead_m.abs();
            0.5 * f64::from(grooved.starts) * turn_per_m * grooved.groove.spans().map(along).sum::<f64>()
        }
    }
}
