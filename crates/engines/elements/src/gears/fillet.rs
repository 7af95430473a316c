//! Fillets at the roots: the trochoid of a rack on an external gear, an arc in the spaces of a ring.

use std::f64::consts::{FRAC_PI_2, PI};

use forcewright_base::maths::{acos, atan2, cos, hypot, sin_cos, tan};
use forcewright_base::roots;

use super::{Kind, Wheel};

/// Trochoid that the rounded tip of the rack leaves on an external gear.
///
/// `θ` is the angle of the common normal to the pitch line, from the pressure angle (end of the straight flank) to π/2 (bottom). The normal
/// passes through the pitch point, where the rack rolls on the reference circle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Trochoid {
    reference_radius_m: f64,
    /// Fillet radius, m.
    radius_m: f64,
    /// Centre of the arc below the pitch line of the rack, m.
    depth_m: f64,
    /// Centre of the arc beside the middle of the tooth of the rack, m.
    aside_m: f64,
    pressure_angle_rad: f64,
}

impl Trochoid {
    pub(super) fn new(wheel: &Wheel) -> Self {
        let spec = &wheel.spec;
        let (rack, m) = (spec.rack, spec.module_m);
        let alpha_rad = rack.pressure_angle_rad;
        let straight = rack.dedendum - rack.root_radius;
        Self {
            reference_radius_m: wheel.reference_radius_m,
            radius_m: rack.root_radius * m,
            depth_m: (straight - spec.profile_shift) * m,
            aside_m: (PI / 4.0 - straight * tan(alpha_rad) - rack.root_radius / cos(alpha_rad)) * m + spec.thinning_m / 2.0,
            pressure_angle_rad: alpha_rad,
        }
    }

    /// Radius (m) and angle from the middle of the space (rad) of the point with the normal `θ`.
    pub(super) fn point(&self, theta_rad: f64) -> (f64, f64) {
        let (sin, cos) = sin_cos(theta_rad);
        let across_m = (self.radius_m + self.depth_m / sin) * cos;
        let height_m = self.reference_radius_m - self.depth_m - self.radius_m * sin;
        let rolled_rad = (self.aside_m - self.depth_m * cos / sin) / self.reference_radius_m;
        (hypot(across_m, height_m), rolled_rad + atan2(across_m, height_m))
    }

    /// Where the fillet ends on an undercut flank: its `θ` and tangent length `√(r_F² − r_b²)`, m.
    fn crossing(&self, wheel: &Wheel) -> (f64, f64) {
        let base_m = wheel.base_radius_m;
        let half_pitch_rad = PI / f64::from(wheel.spec.teeth);
        let end = self.pressure_angle_rad;
        let tangent_m = |radius_m: f64| ((radius_m - base_m) * (radius_m + base_m)).max(0.0).sqrt();
        let at_base = roots::root(|theta| self.point(theta).0 - base_m, end, FRAC_PI_2, 1e-13);
        // Positive where the fillet lies inside the tooth that the involute bounds.
        let into_tooth = |theta: f64| {
            let (radius_m, angle_rad) = self.point(theta);
            angle_rad - (half_pitch_rad - wheel.tooth_angle_rad(radius_m) / 2.0)
        };
        match at_base.and_then(|base| roots::root(into_tooth, end, base, 1e-13)) {
            Ok(theta) => (theta, tangent_m(self.point(theta).0)),
            Err(_) => at_base.map_or((end, 0.0), |theta| (theta, 0.0)),
        }
    }

    /// `θ` where the fillet ends, and the tangent length there, m.
    pub(super) fn end(&self, wheel: &Wheel) -> (f64, f64) {
        let straight_m = straight_tangent_m(wheel);
        if straight_m >= 0.0 { (self.pressure_angle_rad, straight_m) } else { self.crossing(wheel) }
    }
}

/// Depth to which the flank of the rack is straight, `h_fP − ρ_fP (1 − sin α)`, modules.
pub(super) fn straight_depth(wheel: &Wheel) -> f64 {
    let rack = wheel.spec.rack;
    rack.dedendum - rack.root_radius * (1.0 - sin_cos(rack.pressure_angle_rad).0)
}

/// Tangent length at the point that the end of the straight flank of the rack generates, m; below 0 if that end cuts beyond the base circle.
pub(super) fn straight_tangent_m(wheel: &Wheel) -> f64 {
    let spec = &wheel.spec;
    let sin = sin_cos(spec.rack.pressure_angle_rad).0;
    wheel.reference_radius_m * sin - (straight_depth(wheel) - spec.profile_shift) * spec.module_m / sin
}

/// Arc in the corners of the spaces of a ring.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arc {
    /// Its radius, m: that of the rack, or the largest that has room.
    pub(super) radius_m: f64,
    /// Distance of its centre from that of the ring, m.
    pub(super) centre_m: f64,
    /// Angle of its centre from the middle of the space, rad.
    pub(super) aside_rad: f64,
    /// Tangent length where it leaves the flank, m.
    pub(super) tangent_m: f64,
}

impl Arc {
    /// None if the flanks meet before the root circle.
    pub(super) fn new(ring: &Wheel) -> Option<Self> {
        let base_m = ring.base_radius_m;
        let half_pitch_rad = PI / f64::from(ring.spec.teeth);
        // A curve at a constant distance from an involute is an involute of the same base circle.
        let aside_rad = |radius_m: f64| {
            let centre_m = ring.root_radius_m - radius_m;
            half_pitch_rad - ring.tooth_angle_rad(centre_m) / 2.0 - radius_m / base_m
        };
        let wanted_m = ring.spec.rack.root_radius * ring.spec.module_m;
        let most_m = wanted_m.min(ring.root_radius_m - base_m);
        if most_m < 0.0 || aside_rad(0.0) < 0.0 {
            return None;
        }
        let radius_m =
            if aside_rad(most_m) >= 0.0 { most_m } else { roots::root(aside_rad, 0.0, most_m, 1e-12 * ring.spec.module_m).ok()? };
        let centre_m = ring.root_radius_m - radius_m;
        let tangent_m = radius_m + ((centre_m - base_m) * (centre_m + base_m)).max(0.0).sqrt();
        Some(Self { radius_m, centre_m, aside_rad: aside_rad(radius_m).max(0.0), tangent_m })
    }

    /// Radius (m) and angle from the middle of the space (rad) of a point whose normal makes an angle with the radius of the centre.
    pub(super) fn point(&self, normal_rad: f64) -> (f64, f64) {
        let (sin, cos) = sin_cos(normal_rad);
        let (across_m, height_m) = (self.radius_m * sin, self.centre_m + self.radius_m * cos);
        (hypot(across_m, height_m), self.aside_rad + atan2(across_m, height_m))
    }

    /// Normal where the arc leaves the flank.
    pub(super) fn end_rad(&self, ring: &Wheel) -> f64 {
        // The normal is tangent to the base circle.
        FRAC_PI_2 - acos((ring.base_radius_m / self.centre_m).min(1.0)).min(FRAC_PI_2)
    }
}

/// Tangent length `√(r² − r_b²)` where the involute ends towards the root, m: at the fillet. 0 if nothing is left above the base circle.
pub(super) fn form_tangent_m(wheel: &Wheel) -> f64 {
    match wheel.spec.kind {
        Kind::External => Trochoid::new(wheel).end(wheel).1,
        Kind::Internal => Arc::new(wheel).map_or_else(|| pointed_tangent_m(wheel), |arc| arc.tangent_m),
    }
}

/// Radius where the flanks of a tooth meet, m.
pub(super) fn pointed_tooth_m(wheel: &Wheel) -> f64 {
    match wheel.spec.kind {
        Kind::External => hypot(wheel.base_radius_m, pointed_tangent_m(wheel)),
        // The teeth of a ring grow outwards: `inv α = −half the angle at the base`.
        Kind::Internal => wheel.base_radius_m / cos(super::inverse_involute((-wheel.tooth_angle_rad(wheel.base_radius_m) / 2.0).max(0.0))),
    }
}

/// Tangent length where the flanks of a tooth of an external gear, or of a space of a ring, meet, m.
pub(super) fn pointed_tangent_m(wheel: &Wheel) -> f64 {
    let at_base_rad = wheel.tooth_angle_rad(wheel.base_radius_m);
    let wide_rad = match wheel.spec.kind {
        Kind::External => at_base_rad,
        Kind::Internal => 2.0 * PI / f64::from(wheel.spec.teeth) - at_base_rad,
    };
    // Flanks of the involute close at `inv α_R = half the angle at the base`.
    let angle_rad = super::inverse_involute((wide_rad / 2.0).max(0.0));
    wheel.base_radius_m * tan(angle_rad)
}

/// The same fillets are drawn by [`super::profile`], from formulas of its own.
#[cfg(test)]
mod tests {
    use super::*;
    use crate::gears::{Rack, ToothProfile, WheelSpec};
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(1000) })]

        /// Ends of involutes and places of fillets, undercut or not.
        #[test]
        fn fillets_are_those_that_are_drawn(
            ring: bool, teeth in 6..120u32, profile_shift in -0.6..1.4_f64, radius in 0.02..0.38_f64, dedendum in 1.0..1.4_f64, degrees in 15.0..25.0_f64,
            tip_shortening in 0.0..0.3_f64, thin in 0.0..0.1_f64,
        ) {
            let module_m = 0.5e-3;
            let rack = Rack { pressure_angle_rad: degrees.to_radians(), addendum: 1.0, dedendum, root_radius: radius };
            let kind = if ring { Kind::Internal } else { Kind::External };
            let spec = WheelSpec { kind, teeth, module_m, rack, profile_shift, tip_shortening, thinning_m: thin * module_m };
            let Ok(wheel) = Wheel::new(spec) else { return Ok(()) };
            let Ok(drawn) = ToothProfile::new(&wheel, None) else { return Ok(()) };
            let form_m = hypot(wheel.base_radius_m, form_tangent_m(&wheel));
            prop_assert!((form_m / drawn.form_radius_m() - 1.0).abs() < 1e-10, "{} {}", form_m, drawn.form_radius_m());
            prop_assert_eq!(drawn.is_undercut(), !ring && straight_tangent_m(&wheel) < 0.0);
            let (trochoid, arc) = (Trochoid::new(&wheel), Arc::new(&wheel));
            let ends = match (&arc, ring) {
                (Some(arc), true) => [arc.end_rad(&wheel), 0.0],
                _ => [trochoid.end(&wheel).0, FRAC_PI_2],
            };
            for k in 1..16 {
                let place = ends[0] + (ends[1] - ends[0]) * f64::from(k) / 16.0;
                let (radius_m, angle_rad) = match (&arc, ring) {
                    (Some(arc), true) => arc.point(place),
                    _ => trochoid.point(place),
                };
                let half_rad = drawn.half_angle_rad(radius_m);
                let own_rad = PI / f64::from(teeth) - angle_rad;
                prop_assert!(half_rad.is_some_and(|half_rad| (half_rad - own_rad).abs() < 1e-9), "{} {:?} {}", k, half_rad, own_rad);
            }
        }
    }
}
