//! Stress in the roots and pressure on the flanks, static and nominal.
//!
//! Bending after Lewis: one pair carries all of the load at the tip; the tooth is a beam of uniform strength inscribed in the real tooth,
//! whose fillet is computed. Without the radial part of the load, stress concentration, and dynamics. Pressure after Hertz: smooth flanks, dry,
//! aligned over the face width, one pair carrying all of the load.

use std::f64::consts::{FRAC_PI_2, PI};

use forcewright_base::maths::{cos, sin_cos};
use forcewright_base::roots;

use super::fillet::{Arc, Trochoid};
use super::planetary::PlanetarySet;
use super::{GearError, Kind, Mesh, Wheel, interference};
use crate::hertz::{self, Solid};

/// Weakest section of a tooth loaded at its tip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToothRoot {
    /// Thickness t of the tooth at the section, m.
    pub thickness_m: f64,
    /// Distance l of the section from where the load meets the middle of the tooth, m.
    pub height_m: f64,
    /// Angle `φ_L` between the load and the section, rad.
    pub load_angle_rad: f64,
    /// Form factor of Lewis `Y = t²/(6 l m) · cos α / cos φ_L`, for the load `T/r` on the reference circle.
    pub form_factor: f64,
}

/// Weakest section of a tooth: where the parabola of a beam of uniform strength, with its vertex where the load at the tip meets the middle of
/// the tooth, touches the fillet. W. Lewis, "Investigation of the strength of gear teeth", Proceedings of the
/// Engineers' Club of Philadelphia 10, 1893 (`lewis1893`).
///
/// # Errors
/// [`GearError::PointedTooth`]; [`GearError::Value`] of a gear whose teeth have no such section.
pub fn tooth_root(wheel: &Wheel) -> Result<ToothRoot, GearError> {
    interference::check_tip(wheel)?;
    let half_pitch_rad = PI / f64::from(wheel.spec.teeth);
    let (tip_rad, half_rad) = (wheel.pressure_angle_rad(wheel.tip_radius_m), wheel.tooth_angle_rad(wheel.tip_radius_m) / 2.0);
    let none = GearError::Value { name: "profile_shift", value: wheel.spec.profile_shift };
    let (load_angle_rad, root) = match wheel.spec.kind {
        Kind::External => {
            let trochoid = Trochoid::new(wheel);
            let end = trochoid.end(wheel).0;
            let load_rad = tip_rad - half_rad;
            (load_rad, weakest(wheel, load_rad, [end, FRAC_PI_2], |theta| trochoid.point(theta), half_pitch_rad))
        }
        Kind::Internal => {
            let arc = Arc::new(wheel).ok_or(none)?;
            let load_rad = tip_rad + half_rad;
            (load_rad, weakest(wheel, load_rad, [0.0, arc.end_rad(wheel)], |normal| arc.point(normal), half_pitch_rad))
        }
    };
    let (thickness_m, height_m) = root.ok_or(none)?;
    let cosines = cos(wheel.spec.rack.pressure_angle_rad) / cos(load_angle_rad);
    let form_factor = thickness_m * thickness_m / (6.0 * height_m * wheel.spec.module_m) * cosines;
    if !(form_factor > 0.0 && form_factor.is_finite()) {
        return Err(none);
    }
    Ok(ToothRoot { thickness_m, height_m, load_angle_rad, form_factor })
}

/// Thickness and height of the section of a fillet with the least `t²/l`.
fn weakest(
    wheel: &Wheel,
    load_angle_rad: f64,
    ends: [f64; 2],
    point: impl Fn(f64) -> (f64, f64),
    half_pitch_rad: f64,
) -> Option<(f64, f64)> {
    const PARTS: i32 = 24;
    let vertex_m = wheel.base_radius_m / cos(load_angle_rad);
    let section = |place: f64| {
        let (radius_m, from_space_rad) = point(place);
        let (sin, cos) = sin_cos(half_pitch_rad - from_space_rad);
        let height_m = match wheel.spec.kind {
            Kind::External => vertex_m - radius_m * cos,
            Kind::Internal => radius_m * cos - vertex_m,
        };
        (2.0 * radius_m * sin, height_m)
    };
    let measure = |place: f64| {
        let (thickness_m, height_m) = section(place);
        if height_m > 0.0 && thickness_m > 0.0 { thickness_m * thickness_m / height_m } else { f64::INFINITY }
    };
    let step = (ends[1] - ends[0]) / f64::from(PARTS);
    let at = |k: i32| ends[0] + f64::from(k.clamp(0, PARTS)) * step;
    let coarse = (0..=PARTS).min_by(|a, b| measure(at(*a)).total_cmp(&measure(at(*b))))?;
    let fine = roots::minimise(measure, at(coarse - 1), at(coarse + 1), 1e-10).x;
    let best = if measure(fine) < measure(at(coarse)) { fine } else { at(coarse) };
    measure(best).is_finite().then(|| section(best))
}

/// Bending stress in the root of a tooth (Pa) at a torque on the gear that one tooth carries (N m) and a face width (m, above 0): `T/(r b m Y)`.
///
/// # Errors
/// [`GearError`]
pub fn bending_stress_pa(wheel: &Wheel, torque_nm: f64, face_width_m: f64) -> Result<f64, GearError> {
    check_load(torque_nm, face_width_m)?;
    let root = tooth_root(wheel)?;
    Ok(torque_nm / (wheel.reference_radius_m * face_width_m * wheel.spec.module_m * root.form_factor))
}

/// Largest Hertzian pressure between two flanks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlankPressure {
    /// At the pitch point, Pa: `Z_H Z_E √(F_t (u ± 1)/(b d₁ u))` of ISO 6336-2.
    pub pitch_pa: f64,
    /// The largest of the pitch point and both ends of the stretch on which one pair carries all, Pa.
    pub largest_pa: f64,
}

/// Pressure on the flanks of a mesh at a torque on the pinion (N m), over a face width (m, above 0).
///
/// # Errors
/// [`GearError`], of an empty path of contact too.
pub fn flank_pressure(mesh: &Mesh, pinion_torque_nm: f64, face_width_m: f64, solids: [Solid; 2]) -> Result<FlankPressure, GearError> {
    check_load(pinion_torque_nm, face_width_m)?;
    mesh.check_touches()?;
    let path = mesh.path();
    let (start_m, end_m) = (path.usable.start_m, path.usable.end_m);
    let load_n_per_m = pinion_torque_nm / mesh.pinion.base_radius_m / face_width_m;
    let pressure_pa = |xi_m: f64| {
        let [pinion_m, wheel_m] = mesh.curvature_radii_m(xi_m);
        let hollow = if mesh.wheel.spec.kind == Kind::Internal { -1.0 } else { 1.0 };
        hertz::line_contact(load_n_per_m, [pinion_m, hollow * wheel_m], solids)
            .map(|contact| contact.pressure_pa)
            .map_err(GearError::Contact)
    };
    let pitch_pa = pressure_pa(path.pitch_m)?;
    let first_pa = pressure_pa((end_m - path.base_pitch_m).clamp(start_m, end_m))?;
    let last_pa = pressure_pa((start_m + path.base_pitch_m).clamp(start_m, end_m))?;
    Ok(FlankPressure { pitch_pa, largest_pa: pitch_pa.max(first_pa).max(last_pa) })
}

/// Stresses in a planetary set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SetStresses {
    /// Bending in the roots of sun, planet, ring, Pa. Teeth of planets bend both ways in turn.
    pub bending_pa: [f64; 3],
    /// Pressure between sun and planet, and between planet and ring.
    pub flanks: [FlankPressure; 2],
}

/// How a set is loaded and what it is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SetLoad {
    /// Torque on the sun, N m; at least 0.
    pub sun_torque_nm: f64,
    /// Load of the planet that carries most over the mean, `K_γ`; at least 1.
    pub sharing: f64,
    /// Face width, m; above 0.
    pub face_width_m: f64,
    /// Materials of sun, planets, ring.
    pub solids: [Solid; 3],
}

/// Stresses in the planet that carries most, `T_s K_γ/N` at the sun. Losses are neglected.
///
/// # Errors
/// [`GearError`]
pub fn set_stresses(set: &PlanetarySet, load: &SetLoad) -> Result<SetStresses, GearError> {
    if !(load.sharing >= 1.0 && load.sharing.is_finite()) {
        return Err(GearError::Value { name: "sharing", value: load.sharing });
    }
    let sun_nm = load.sun_torque_nm * load.sharing / f64::from(set.planets);
    let planet_nm = sun_nm * set.sun_planet.ratio();
    let ring_nm = planet_nm * set.planet_ring.ratio();
    let [sun, planet, ring] = load.solids;
    let bending = |wheel: &Wheel, torque_nm: f64| bending_stress_pa(wheel, torque_nm, load.face_width_m);
    Ok(SetStresses {
        bending_pa: [
            bending(&set.sun_planet.pinion, sun_nm)?,
            bending(&set.planet_ring.pinion, planet_nm)?,
            bending(&set.planet_ring.wheel, ring_nm)?,
        ],
        flanks: [
            flank_pressure(&set.sun_planet, sun_nm, load.face_width_m, [sun, planet])?,
            flank_pressure(&set.planet_ring, planet_nm, load.face_width_m, [planet, ring])?,
        ],
    })
}

fn check_load(torque_nm: f64, face_width_m: f64) -> Result<(), GearError> {
    let checks = [
        ("torque_nm", torque_nm, torque_nm >= 0.0 && torque_nm.is_finite()),
        ("face_width_m", face_width_m, face_width_m > 0.0 && face_width_m.is_finite()),
    ];
    checks.into_iter().find(|(_, _, good)| !good).map_or(Ok(()), |(name, value, _)| Err(GearError::Value { name, value }))
}
