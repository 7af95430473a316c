//! Mass of the beams with its derivatives.

use forcewright_beam::{Beam, Network};

use super::knobs::{Knob, Knobs};
use crate::analysis::volume_m3;
use crate::design::Design;

/// Density of the material of each beam, kg/m³; `None` if one is not known.
pub(super) fn densities(design: &Design) -> Option<Vec<f64>> {
    (0..design.network.beams.len()).map(|beam| design.material_of(beam)?.density_kg_per_m3).collect()
}

/// Mass of the drawn beams, kg: `Σ ρ w̄ t L` with the mean thickness `w̄`, the depth t and the arc length L. Adds `factor` times its
/// derivatives to a row; nothing to a row without columns.
pub(super) fn drawn_mass_kg(network: &Network, densities: &[f64], knobs: &Knobs, factor: f64, row: &mut [f64]) -> f64 {
    let mut mass = 0.0;
    for (index, (beam, density)) in network.beams.iter().zip(densities).enumerate() {
        let volume = volume_m3(beam);
        mass += density * volume;
        if row.is_empty() {
            continue;
        }
        let length_m = beam.shape.length_m();
        let [by_length, by_depth] = [volume / length_m, volume / beam.section.depth_m];
        // A beam with nearly no chord has no length that follows from it; a search rejects such designs.
        let closure = beam.shape.chord_sensitivity().ok();
        let by_chord = |axis: usize| closure.as_ref().map_or(0.0, |c| by_length * c.length_by_chord[axis]);
        for (knob, out) in knobs.each.iter().zip(row.iter_mut()) {
            // The chord leads from the start to the end.
            let by_node = |node: usize, axis: usize| by_chord(axis) * (sign(beam.end == node) - sign(beam.start == node));
            *out += factor
                * density
                * match knob {
                    Knob::NodeX(node) => by_node(*node, 0),
                    Knob::NodeY(node) => by_node(*node, 1),
                    Knob::NodeOn { node, from, to } => (0..2).map(|axis| (to[axis] - from[axis]) * by_node(*node, axis)).sum(),
                    Knob::Bend { beam: own, k } if *own == index => {
                        closure.as_ref().and_then(|c| c.length_by_bend_m.get(k - 1)).map_or(0.0, |by_bend| by_length * by_bend)
                    }
                    Knob::Thickness(some) if some.contains(&index) && beam.profile.is_empty() => length_m * beam.section.depth_m,
                    Knob::ThicknessAt { beam: own, place } if *own == index => share(beam, *place) * length_m * beam.section.depth_m,
                    Knob::Depth => by_depth,
                    _ => 0.0,
                };
        }
    }
    mass
}

fn sign(present: bool) -> f64 {
    f64::from(u8::from(present))
}

/// Part of the mean thickness that follows the thickness at a place: half of the way to both of its neighbours.
fn share(beam: &Beam, place: usize) -> f64 {
    let Some([here, _]) = beam.profile.get(place) else { return 0.0 };
    let at = |neighbour: Option<usize>| neighbour.and_then(|i| beam.profile.get(i)).map_or(*here, |p| p[0]);
    0.5 * (at(place.checked_add(1)) - at(place.checked_sub(1)))
}
