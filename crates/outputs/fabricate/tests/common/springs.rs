//! Springs with known lengths of wire.

use std::f64::consts::{PI, TAU};

use forcewright_base::maths;
use forcewright_base::quadrature::GaussLegendre;
use forcewright_model::{Body, Coil, CoilEnd, Part, Winding};

/// A spring and what is known of it without any writer.
pub struct Spring {
    pub part: Part,
    /// Of the middle of the wire: helices by quadrature, bends and legs in closed form, m.
    pub wire_length_m: f64,
    /// Area of the wire times that, m³.
    pub volume_m3: f64,
    /// Circumference of the wire times that, and two ends, m².
    pub surface_m2: f64,
    /// Faces of the solid: two for each turn begun of a winding, bend or leg, and both ends.
    pub faces: usize,
}

/// All springs.
pub fn springs() -> Vec<Spring> {
    let axial = CoilEnd::Axial { bend_m: 1.5e-3, length_m: 3e-3 };
    let closed = vec![
        Winding::even(1.0, 1.55e-3),
        Winding { turns: 0.5, pitch_m: [1.55e-3, 4e-3] },
        Winding::even(4.25, 4e-3),
        Winding { turns: 0.5, pitch_m: [4e-3, 1.55e-3] },
        Winding::even(1.0, 1.55e-3),
    ];
    let tangential = CoilEnd::Tangential { length_m: 15e-3 };
    let radial = [CoilEnd::Outward { bend_m: 2e-3, length_m: 8e-3 }, CoilEnd::Inward { bend_m: 1e-3, length_m: 3e-3 }];
    vec![
        spring("spring-wrap", coil(1e-3, 10.5e-3, vec![Winding::even(8.6, 1.1e-3)], 0.4, [CoilEnd::Cut, axial])),
        spring(
            "spring-left",
            Coil { is_right_handed: false, ..coil(0.8e-3, 6e-3, vec![Winding::even(3.3, 0.9e-3)], -1.2, [axial, CoilEnd::Cut]) },
        ),
        spring("spring-compression", coil(1.5e-3, 8e-3, closed, 0.0, [CoilEnd::Cut; 2])),
        spring("spring-torsion", coil(1e-3, 5e-3, vec![Winding::even(5.5, 1.05e-3)], 1.0, [tangential; 2])),
        spring("spring-radial", Coil { is_right_handed: false, ..coil(0.6e-3, 7e-3, vec![Winding::even(2.25, 1.5e-3)], 2.0, radial) }),
        spring("spring-steep", coil(2e-3, 5e-3, vec![Winding::even(1.3, 40e-3)], 0.7, [CoilEnd::Cut; 2])),
    ]
}

pub fn coil(wire_m: f64, radius_m: f64, windings: Vec<Winding>, start_rad: f64, ends: [CoilEnd; 2]) -> Coil {
    Coil { wire_m, radius_m, windings, is_right_handed: true, start_rad, ends }
}

pub fn part_of(name: &str, coil: Coil) -> Part {
    Part {
        name: name.to_owned(),
        title: format!("Sample {name}"),
        count: 1,
        material: Some("spring wire EN 10270-1 SH".to_owned()),
        density_kg_per_m3: Some(7850.0),
        notes: vec!["Relieve stresses after winding.".to_owned()],
        body: Body::Coil(coil),
    }
}

pub fn spring(name: &str, coil: Coil) -> Spring {
    let rule = GaussLegendre::new(40);
    let mut faces = 2;
    let mut wire_length_m = 0.0;
    for &Winding { turns, pitch_m: [low, high] } in &coil.windings {
        wire_length_m += turns * rule.integrate(|x| maths::hypot(TAU * coil.radius_m, low + (high - low) * x));
        faces += 2 * begun(turns);
    }
    let ends = coil.windings.first().map(|w| w.pitch_m[0]).into_iter().chain(coil.windings.last().map(|w| w.pitch_m[1]));
    for (end, pitch_m) in coil.ends.iter().zip(ends) {
        // Across the tangent to the axis: a right angle less the lead.
        let angle_rad = match end {
            CoilEnd::Axial { .. } => maths::atan2(TAU * coil.radius_m, pitch_m),
            _ => 0.5 * PI,
        };
        wire_length_m += end.leg_m() + end.bend_m().map_or(0.0, |bend_m| bend_m * angle_rad);
        faces += 2 * usize::from(end.bend_m().is_some()) + 2 * usize::from(*end != CoilEnd::Cut);
    }
    let area_m2 = 0.25 * PI * coil.wire_m * coil.wire_m;
    Spring {
        volume_m3: area_m2 * wire_length_m,
        surface_m2: PI * coil.wire_m * wire_length_m + 2.0 * area_m2,
        wire_length_m,
        faces,
        part: part_of(name, coil),
    }
}

fn begun(turns: f64) -> usize {
    let mut whole = 0;
    while turns - whole as f64 > 1e-9 {
        whole += 1;
    }
    whole
}
