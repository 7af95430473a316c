//! One gear: its circles and the thickness of its teeth.

use std::f64::consts::PI;

use forcewright_base::maths::{acos, cos, tan};

use super::{GearError, Rack, involute};

/// Teeth outside or inside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Teeth on the outside: sun, planet.
    External,
    /// Teeth on the inside: ring.
    Internal,
}

/// What a gear is made to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WheelSpec {
    /// Teeth outside or inside.
    pub kind: Kind,
    /// Number of teeth z; at least 4.
    pub teeth: u32,
    /// Module m, m; above 0.
    pub module_m: f64,
    /// The rack that the teeth follow.
    pub rack: Rack,
    /// Profile shift coefficient x, modules; positive moves the teeth outwards, on a ring too.
    pub profile_shift: f64,
    /// By how much the teeth are shorter at their tips than `h_aP`, modules; at least 0.
    pub tip_shortening: f64,
    /// By how much a tooth is thinner on the reference circle, for backlash, m; at least 0.
    pub thinning_m: f64,
}

/// A gear with its circles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wheel {
    /// What it is made to.
    pub spec: WheelSpec,
    /// Reference radius `r = m z / 2`, m.
    pub reference_radius_m: f64,
    /// Base radius `r_b = r cos α`, m.
    pub base_radius_m: f64,
    /// Tip radius `r_a`, m: the outermost of an external gear, the innermost of a ring.
    pub tip_radius_m: f64,
    /// Root radius `r_f`, m.
    pub root_radius_m: f64,
}

impl Wheel {
    /// The gear of `spec`.
    ///
    /// # Errors
    /// A number out of its range.
    pub fn new(spec: WheelSpec) -> Result<Self, GearError> {
        let WheelSpec { kind, teeth, module_m, rack, profile_shift, tip_shortening, thinning_m } = spec;
        let checks = [
            ("teeth", f64::from(teeth), teeth >= 4),
            ("module_m", module_m, module_m > 0.0),
            ("pressure_angle_rad", rack.pressure_angle_rad, rack.pressure_angle_rad > 0.0 && rack.pressure_angle_rad < PI / 4.0),
            ("addendum", rack.addendum, rack.addendum > 0.0),
            ("dedendum", rack.dedendum, rack.dedendum > 0.0),
            ("root_radius", rack.root_radius, rack.root_radius >= 0.0),
            ("profile_shift", profile_shift, true),
            ("tip_shortening", tip_shortening, tip_shortening >= 0.0),
            ("thinning_m", thinning_m, thinning_m >= 0.0),
        ];
        if let Some((name, value, _)) = checks.into_iter().find(|(_, value, good)| !(*good && value.is_finite())) {
            return Err(GearError::Value { name, value });
        }
        let reference_radius_m = module_m * f64::from(teeth) / 2.0;
        // Towards the tip: outwards, or inwards on a ring.
        let outwards = match kind {
            Kind::External => 1.0,
            Kind::Internal => -1.0,
        };
        let shifted_m = reference_radius_m + profile_shift * module_m;
        let (tip_radius_m, root_radius_m) =
            (shifted_m + outwards * (rack.addendum - tip_shortening) * module_m, shifted_m - outwards * rack.dedendum * module_m);
        let smallest_m = tip_radius_m.min(root_radius_m);
        if smallest_m <= 0.0 || (tip_radius_m - root_radius_m) * outwards <= 0.0 {
            return Err(GearError::Value { name: "profile_shift", value: profile_shift });
        }
        let base_radius_m = reference_radius_m * cos(rack.pressure_angle_rad);
        Ok(Self { spec, reference_radius_m, base_radius_m, tip_radius_m, root_radius_m })
    }

    /// Pressure angle `acos(r_b / r)` of the flank at a radius (m); 0 below the base circle.
    pub fn pressure_angle_rad(&self, radius_m: f64) -> f64 {
        acos((self.base_radius_m / radius_m).min(1.0))
    }

    /// Angle that a tooth takes at a radius (m) on or above the base circle, rad; below 0 beyond where its flanks meet.
    pub fn tooth_angle_rad(&self, radius_m: f64) -> f64 {
        let WheelSpec { kind, teeth, rack, profile_shift, thinning_m, .. } = self.spec;
        let alpha_rad = rack.pressure_angle_rad;
        let fall_rad = 2.0 * (involute(self.pressure_angle_rad(radius_m)) - involute(alpha_rad));
        let shift_rad = 4.0 * profile_shift * tan(alpha_rad) / f64::from(teeth);
        let thinner_rad = thinning_m / self.reference_radius_m;
        let pitch_rad = 2.0 * PI / f64::from(teeth);
        match kind {
            Kind::External => pitch_rad / 2.0 + shift_rad - fall_rad - thinner_rad,
            Kind::Internal => pitch_rad / 2.0 - shift_rad + fall_rad - thinner_rad,
        }
    }
}
