//! Between flank and root circle: what the rounded tip of a rack leaves on an external gear, an arc on a ring.

use std::f64::consts::{FRAC_PI_2, PI};

use forcewright_base::maths::{atan2, sin};
use forcewright_base::roots;
use forcewright_curves::vector::{norm, rotate};

use super::piece::{Arc, Curve, Piece, Region, Trochoid, first_length_m, rounding_centre};
use crate::gears::{GearError, Wheel, WheelSpec};

/// What lies below the flank.
pub(super) struct Root {
    /// Length of the tangent to the base circle from where the flank begins, m.
    pub(super) form_length_m: f64,
    pub(super) undercut: bool,
    /// Smallest radius of curvature of the fillet, m.
    pub(super) fillet_radius_m: f64,
    /// Fillet and arc of the root circle, those that have a length, towards the root.
    pub(super) pieces: Vec<Piece>,
}

fn no_value(name: &'static str, value: f64) -> GearError {
    GearError::Value { name, value }
}

/// Rounding to be forgiven in lengths, relative to the module.
const ROUNDING: f64 = 1e-12;

fn arc_of_root(wheel: &Wheel, from_rad: f64) -> Option<Piece> {
    let half_pitch_rad = PI / f64::from(wheel.spec.teeth);
    let arc = Arc { centre_m: [0.0; 2], radius_m: wheel.root_radius_m, angles_rad: [from_rad, half_pitch_rad] };
    (half_pitch_rad - from_rad > ROUNDING).then_some(Piece { region: Region::Root, curve: Curve::Arc(arc) })
}

/// The root of an external gear, by a rack whose teeth are thicker by what those of the gear are thinner.
pub(super) fn external(wheel: &Wheel, half_base_rad: f64) -> Result<Root, GearError> {
    let WheelSpec { module_m, rack, teeth, profile_shift, thinning_m, .. } = wheel.spec;
    let alpha_rad = rack.pressure_angle_rad;
    let half_thickness = PI / 4.0 + 0.5 * thinning_m / module_m;
    let [below, mut aside] = rounding_centre(alpha_rad, rack.dedendum, rack.root_radius, half_thickness);
    if aside < -ROUNDING || below < 0.0 {
        return Err(no_value("root_radius", rack.root_radius));
    }
    aside = aside.max(0.0);
    let half_pitch_rad = PI / f64::from(teeth);
    let mut trochoid = Trochoid {
        radius_m: wheel.reference_radius_m,
        rounding_m: rack.root_radius * module_m,
        centre_m: [(profile_shift - below) * module_m, aside * module_m],
        angles_rad: [alpha_rad, FRAC_PI_2],
        half_pitch_rad,
    };
    if !trochoid.is_regular() {
        return Err(no_value("root_radius", rack.root_radius));
    }
    // Where the rounding of the rack begins.
    let height_m = trochoid.centre_m[0] - trochoid.rounding_m * sin(alpha_rad);
    let first_m = first_length_m(wheel.reference_radius_m, alpha_rad, height_m);
    let undercut = first_m < 0.0;
    let mut form_length_m = first_m;
    if undercut {
        trochoid.angles_rad[0] = crossing(wheel, &trochoid, half_base_rad)?;
        let radius_m = norm(trochoid.in_space(trochoid.angles_rad[0]).point_m);
        form_length_m = length_at_m(wheel, radius_m);
    }
    waist(&trochoid)?;
    let mut pieces = Vec::new();
    if trochoid.has_length() {
        pieces.push(Piece { region: Region::Fillet, curve: Curve::Trochoid(trochoid) });
    }
    pieces.extend(arc_of_root(wheel, half_pitch_rad - trochoid.polar_rad(FRAC_PI_2)));
    // Least at the root circle: ρ + η²/(r − η).
    let [eta, _] = trochoid.centre_m;
    let fillet_radius_m = trochoid.rounding_m + eta * eta / (trochoid.radius_m - eta);
    Ok(Root { form_length_m, undercut, fillet_radius_m, pieces })
}

/// √(r² − `r_b`²).
pub(super) fn length_at_m(wheel: &Wheel, radius_m: f64) -> f64 {
    (radius_m * radius_m - wheel.base_radius_m * wheel.base_radius_m).max(0.0).sqrt()
}

/// β at which the envelope cuts the involute. It rises all the way from the root circle (`dr²/dβ = −2 r g cos β`), so there is one β at the base
/// circle, where it has cut into the tooth, and beyond the crossing it has left the tooth: it ends on the other branch of the involute.
fn crossing(wheel: &Wheel, trochoid: &Trochoid, half_base_rad: f64) -> Result<f64, GearError> {
    let [lowest, highest] = trochoid.angles_rad;
    let radius_m = |beta: f64| norm(trochoid.in_space(beta).point_m);
    let none = |_| GearError::NoFlank { form_radius_m: radius_m(lowest), tip_radius_m: wheel.tip_radius_m };
    let base_m = wheel.base_radius_m;
    let at_base = roots::root(|beta| radius_m(beta) - base_m, lowest, highest, 0.0).map_err(none)?;
    let into_tooth_rad = |beta: f64| {
        let w = length_at_m(wheel, radius_m(beta));
        let involute_rad = trochoid.half_pitch_rad - (half_base_rad - w / base_m + atan2(w, base_m));
        trochoid.polar_rad(beta) - involute_rad
    };
    roots::root(into_tooth_rad, lowest, at_base, 0.0).map_err(none)
}

/// Places of the fillet at which the thickness of the tooth is looked at.
const LOOKS: u32 = 64;

/// Whether something is left of the tooth between the fillets.
fn waist(trochoid: &Trochoid) -> Result<(), GearError> {
    let [from, to] = trochoid.angles_rad;
    let left_rad = |beta: f64| trochoid.half_pitch_rad - trochoid.polar_rad(beta);
    let at = |k: u32| from + (to - from) * f64::from(k) / f64::from(LOOKS);
    let thinnest = (0..=LOOKS).map(at).min_by(|a, b| left_rad(*a).total_cmp(&left_rad(*b))).unwrap_or(from);
    let step = (to - from) / f64::from(LOOKS);
    let least = roots::minimise(left_rad, (thinnest - step).max(from), (thinnest + step).min(to), 1e-12);
    if least.value.min(left_rad(thinnest)) <= 0.0 {
        return Err(GearError::CutOff { radius_m: norm(trochoid.in_space(least.x).point_m) });
    }
    Ok(())
}

/// The root of a ring: an arc that touches flank and root circle, smaller than asked for where the space has no room for it. The ring's space is
/// the tooth of the external wheel; lines parallel to an involute are the same involute turned, so the centre of the arc lies on one.
pub(super) fn ring(wheel: &Wheel, half_base_rad: f64) -> Result<Root, GearError> {
    let half_pitch_rad = PI / f64::from(wheel.spec.teeth);
    let half_space_rad = half_pitch_rad - half_base_rad;
    let (base_m, root_m) = (wheel.base_radius_m, wheel.root_radius_m);
    // Polar angle of the centre from the middle of the space, for a radius of the arc.
    let centre_rad = |rho: f64| {
        let w = length_at_m(wheel, root_m - rho);
        half_space_rad - (w + rho) / base_m + atan2(w, base_m)
    };
    if centre_rad(0.0) <= 0.0 {
        return Err(GearError::PointedSpace { radius_m: point_of_involutes_m(wheel, half_space_rad, root_m) });
    }
    let asked_m = wheel.spec.rack.root_radius * wheel.spec.module_m;
    // Its centre lies outside the base circle; the angle falls with its radius: dδ/dρ = −(1 − sin α)/r_b.
    let widest_m = asked_m.min(root_m - base_m);
    let fillet_radius_m = if centre_rad(widest_m) >= 0.0 { widest_m } else { roots::root(centre_rad, 0.0, widest_m, 0.0).unwrap_or(0.0) };
    let aside_rad = centre_rad(fillet_radius_m).max(0.0);
    let form_length_m = length_at_m(wheel, root_m - fillet_radius_m) + fillet_radius_m;
    let mut pieces = Vec::new();
    if fillet_radius_m > ROUNDING * root_m {
        let towards_rad = half_pitch_rad - aside_rad;
        let tangent_rad = half_space_rad - form_length_m / base_m;
        let arc = Arc {
            centre_m: rotate([root_m - fillet_radius_m, 0.0], towards_rad),
            radius_m: fillet_radius_m,
            angles_rad: [half_pitch_rad - tangent_rad - FRAC_PI_2, towards_rad],
        };
        pieces.push(Piece { region: Region::Fillet, curve: Curve::Arc(arc) });
    }
    pieces.extend(arc_of_root(wheel, half_pitch_rad - aside_rad));
    Ok(Root { form_length_m, undercut: false, fillet_radius_m, pieces })
}

/// Radius at which two involutes meet that stand `half_rad` from the middle at the base circle, m; at most `far_m`.
pub(super) fn point_of_involutes_m(wheel: &Wheel, half_rad: f64, far_m: f64) -> f64 {
    let base_m = wheel.base_radius_m;
    let left_rad = |radius_m: f64| {
        let w = length_at_m(wheel, radius_m);
        half_rad - w / base_m + atan2(w, base_m)
    };
    roots::root(left_rad, base_m, far_m, 0.0).unwrap_or(far_m)
}
