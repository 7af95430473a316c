//! Two gears in mesh: working pressure angle, backlash, path of contact, sliding, losses.

use std::f64::consts::{FRAC_PI_2, PI};

use forcewright_base::maths::{acos, atan2, cbrt, cos, sin, tan};

use super::{GearError, Kind, Wheel, fillet, involute};

/// Angle (rad, 0 to π/2) with a value of the involute function; NaN of a negative or infinite value.
///
/// Newton's method in `t = tan α`: `t − atan t` is convex, so from above it falls on the root without overshoot.
pub fn inverse_involute(value: f64) -> f64 {
    if !(value >= 0.0 && value.is_finite()) {
        return f64::NAN;
    }
    if value < 1e-300 {
        return 0.0;
    }
    // Above the root: `t − atan t > t − π/2`, and `t − atan t ≥ t³ / (3 (1 + t²))`.
    let narrow = cbrt(3.0 * value);
    let mut t = (value + FRAC_PI_2).min(narrow + 3.0 * value);
    for _ in 0..60 {
        let angle_rad = atan2(t, 1.0);
        let next = t - (t - angle_rad - value) * (1.0 + t * t) / (t * t);
        if !(next < t && next > 0.0) {
            break;
        }
        t = next;
    }
    atan2(t, 1.0)
}

/// A pinion with teeth outside and its mate.
///
/// Points of the line of action are given by `ξ`, m: the distance from where it touches the base circle of the pinion, positive towards the
/// tip of the pinion. It is the radius of curvature of the pinion's flank.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mesh {
    /// The gear with its teeth outside; of an internal mesh the one inside.
    pub pinion: Wheel,
    /// Its mate: an external gear or a ring.
    pub wheel: Wheel,
    /// Centre distance a, m.
    pub centre_distance_m: f64,
    /// Working pressure angle α', rad.
    pub pressure_angle_rad: f64,
}

/// A part of the line of action, `ξ` in m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// Nearer to the root of the pinion.
    pub start_m: f64,
    /// Nearer to the tip of the pinion.
    pub end_m: f64,
}

impl Span {
    /// Length, m; below 0 if the ends are in the wrong order.
    pub fn length_m(self) -> f64 {
        self.end_m - self.start_m
    }

    fn and(self, other: Self) -> Self {
        Self { start_m: self.start_m.max(other.start_m), end_m: self.end_m.min(other.end_m) }
    }
}

/// Path of contact and what bounds it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Path {
    /// Between the tip circles.
    pub tips: Span,
    /// Between the points where the line of action touches the base circles; of a ring only the pinion's bounds it.
    pub interference: Span,
    /// Between where the involutes of both gears end towards their roots.
    pub forms: Span,
    /// What is left: teeth touch here.
    pub usable: Span,
    /// Pitch point.
    pub pitch_m: f64,
    /// Base pitch `p_b = π m cos α`, m.
    pub base_pitch_m: f64,
}

impl Path {
    /// Contact ratio `ε = length / p_b` of a part of the line; 0 if it is empty.
    pub fn contact_ratio(&self, span: Span) -> f64 {
        span.length_m().max(0.0) / self.base_pitch_m
    }

    /// Part of the tips' path between the interference points.
    pub fn between_interference_points(&self) -> Span {
        self.tips.and(self.interference)
    }

    /// Contact ratios before and after the pitch point while the pinion drives: approach and recess. One is below 0 if the pitch point lies
    /// outside the path.
    pub fn approach_recess(&self) -> [f64; 2] {
        [(self.pitch_m - self.usable.start_m) / self.base_pitch_m, (self.usable.end_m - self.pitch_m) / self.base_pitch_m]
    }

    /// Mean of `|ξ − ξ_C|` over the path, each pair carrying an equal share of the load while several touch, m.
    ///
    /// With less than one pair in contact on average, the mean over the time of contact. 0 if the path is empty.
    pub fn mean_sliding_arm_m(&self) -> f64 {
        let (length_m, pitch_m) = (self.usable.length_m(), self.base_pitch_m);
        if length_m <= 0.0 {
            return 0.0;
        }
        let integral = |from_m: f64, to_m: f64| {
            let antiderivative = |s: f64| s * s.abs() / 2.0;
            antiderivative(to_m - self.pitch_m) - antiderivative(from_m - self.pitch_m)
        };
        let start_m = self.usable.start_m;
        if length_m < pitch_m {
            return integral(start_m, self.usable.end_m) / length_m;
        }
        // The path repeats with the base pitch: `whole + 1` pairs on the first part of each pitch, `whole` on the rest.
        let whole = (length_m / pitch_m).floor();
        let first_m = length_m - whole * pitch_m;
        let (mut k, mut sum) = (0.0, 0.0);
        while k <= whole {
            let from_m = start_m + k * pitch_m;
            sum += integral(from_m, from_m + first_m) / (whole + 1.0);
            if k < whole {
                sum += integral(from_m + first_m, from_m + pitch_m) / whole;
            }
            k += 1.0;
        }
        sum / pitch_m
    }
}

/// Play between the teeth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Backlash {
    /// Along the working pitch circles, `j_wt`, m; below 0 if the teeth do not go in.
    pub circumferential_m: f64,
    /// Between the flanks, `j_bn = j_wt cos α'`, m.
    pub normal_m: f64,
    /// Of the pinion while the wheel stands, rad.
    pub pinion_rad: f64,
    /// Of the wheel while the pinion stands, rad.
    pub wheel_rad: f64,
}

impl Mesh {
    /// Two gears at a centre distance (m, above 0).
    ///
    /// # Errors
    /// [`GearError::Mates`], or [`GearError::CentreDistance`] if the base circles leave no room for a line of action.
    pub fn new(pinion: Wheel, wheel: Wheel, centre_distance_m: f64) -> Result<Self, GearError> {
        check_mates(&pinion, &wheel)?;
        let least_m = wheel.base_radius_m + sign(&wheel) * pinion.base_radius_m;
        if !(centre_distance_m > least_m && centre_distance_m.is_finite()) {
            return Err(GearError::CentreDistance { centre_distance_m, least_m });
        }
        Ok(Self { pinion, wheel, centre_distance_m, pressure_angle_rad: acos(least_m / centre_distance_m) })
    }

    /// Two gears so near that teeth of full thickness have no play: `inv α' = inv α + 2 tan α (x₁ + x₂)/(z₁ + z₂)`, with differences
    /// `x₂ − x₁` and `z₂ − z₁` for a ring. Their `thinning_m` is what makes their backlash. ISO 21771-1.
    ///
    /// # Errors
    /// [`GearError::Mates`], or [`GearError::CentreDistance`] if the shifts have no centre distance.
    pub fn without_backlash(pinion: Wheel, wheel: Wheel) -> Result<Self, GearError> {
        check_mates(&pinion, &wheel)?;
        let shifts = wheel.spec.profile_shift + sign(&wheel) * pinion.spec.profile_shift;
        let teeth = f64::from(wheel.spec.teeth) + sign(&wheel) * f64::from(pinion.spec.teeth);
        let alpha_rad = pinion.spec.rack.pressure_angle_rad;
        let least_m = wheel.base_radius_m + sign(&wheel) * pinion.base_radius_m;
        let working_rad = inverse_involute(involute(alpha_rad) + 2.0 * tan(alpha_rad) * shifts / teeth);
        Self::new(pinion, wheel, least_m / cos(working_rad))
    }

    /// `x₁ + x₂`, or `x₂ − x₁` of a ring, with which teeth of full thickness have no play at this centre distance; modules.
    pub fn shifts_without_backlash(&self) -> f64 {
        let teeth = f64::from(self.wheel.spec.teeth) + self.sign() * f64::from(self.pinion.spec.teeth);
        let alpha_rad = self.pinion.spec.rack.pressure_angle_rad;
        (involute(self.pressure_angle_rad) - involute(alpha_rad)) * teeth / (2.0 * tan(alpha_rad))
    }

    /// Working pitch radii `r_w = r_b / cos α'`, m.
    pub fn pitch_radii_m(&self) -> [f64; 2] {
        let cos = cos(self.pressure_angle_rad);
        [self.pinion.base_radius_m / cos, self.wheel.base_radius_m / cos]
    }

    /// Teeth of the wheel over teeth of the pinion.
    pub fn ratio(&self) -> f64 {
        f64::from(self.wheel.spec.teeth) / f64::from(self.pinion.spec.teeth)
    }

    /// Backlash from the thickness of the teeth on the working pitch circles.
    pub fn backlash(&self) -> Backlash {
        let radii_m = self.pitch_radii_m();
        let pitch_m = 2.0 * PI * radii_m[0] / f64::from(self.pinion.spec.teeth);
        let teeth_m = radii_m[0] * self.pinion.tooth_angle_rad(radii_m[0]) + radii_m[1] * self.wheel.tooth_angle_rad(radii_m[1]);
        let circumferential_m = pitch_m - teeth_m;
        Backlash {
            circumferential_m,
            normal_m: circumferential_m * cos(self.pressure_angle_rad),
            pinion_rad: circumferential_m / radii_m[0],
            wheel_rad: circumferential_m / radii_m[1],
        }
    }

    /// Distance between the tip of the pinion and the root of the wheel, and between the tip of the wheel and the root of the pinion, m.
    pub fn bottom_clearances_m(&self) -> [f64; 2] {
        let (a, pinion, wheel) = (self.centre_distance_m, &self.pinion, &self.wheel);
        match wheel.spec.kind {
            Kind::External => [a - pinion.tip_radius_m - wheel.root_radius_m, a - wheel.tip_radius_m - pinion.root_radius_m],
            Kind::Internal => [wheel.root_radius_m - a - pinion.tip_radius_m, wheel.tip_radius_m - a - pinion.root_radius_m],
        }
    }

    /// Path of contact. An undercut gear takes part down to where its fillet cuts the involute.
    pub fn path(&self) -> Path {
        let reach_m = self.centre_distance_m * sin(self.pressure_angle_rad);
        let (pinion_tip_m, wheel_tip_m) =
            (tangent_m(&self.pinion, self.pinion.tip_radius_m), tangent_m(&self.wheel, self.wheel.tip_radius_m));
        let (pinion_form_m, wheel_form_m) = (fillet::form_tangent_m(&self.pinion), fillet::form_tangent_m(&self.wheel));
        let (tips, interference, forms) = match self.wheel.spec.kind {
            Kind::External => (
                Span { start_m: reach_m - wheel_tip_m, end_m: pinion_tip_m },
                Span { start_m: 0.0, end_m: reach_m },
                Span { start_m: pinion_form_m, end_m: reach_m - wheel_form_m },
            ),
            Kind::Internal => (
                Span { start_m: wheel_tip_m - reach_m, end_m: pinion_tip_m },
                Span { start_m: 0.0, end_m: f64::INFINITY },
                Span { start_m: pinion_form_m, end_m: wheel_form_m - reach_m },
            ),
        };
        Path {
            tips,
            interference,
            forms,
            usable: tips.and(interference).and(forms),
            pitch_m: self.pitch_radii_m()[0] * sin(self.pressure_angle_rad),
            base_pitch_m: PI * self.pinion.spec.module_m * cos(self.pinion.spec.rack.pressure_angle_rad),
        }
    }

    /// Radii of curvature of both flanks at a point of the line of action (`ξ`, m); that of a ring is hollow but counted positive.
    pub fn curvature_radii_m(&self, xi_m: f64) -> [f64; 2] {
        let reach_m = self.centre_distance_m * sin(self.pressure_angle_rad);
        match self.wheel.spec.kind {
            Kind::External => [xi_m, reach_m - xi_m],
            Kind::Internal => [xi_m, reach_m + xi_m],
        }
    }

    /// Radii on both gears of a point of the line of action (`ξ`, m), m.
    pub fn radii_m(&self, xi_m: f64) -> [f64; 2] {
        let [pinion_m, wheel_m] = self.curvature_radii_m(xi_m);
        [radius_m(&self.pinion, pinion_m), radius_m(&self.wheel, wheel_m)]
    }

    /// Radii on pinion and wheel between which their flanks touch, m: each from the start of the path to its end.
    pub fn active_radii_m(&self) -> [[f64; 2]; 2] {
        let usable = self.path().usable;
        let (start, end) = (self.radii_m(usable.start_m), self.radii_m(usable.end_m));
        [[start[0], end[0]], [start[1], end[1]]]
    }

    /// Roll angles `ρ / r_b` of both flanks at a point of the line of action (`ξ`, m), rad.
    pub fn roll_angles_rad(&self, xi_m: f64) -> [f64; 2] {
        let [pinion_m, wheel_m] = self.curvature_radii_m(xi_m);
        [pinion_m / self.pinion.base_radius_m, wheel_m / self.wheel.base_radius_m]
    }

    /// Specific sliding `ζ = (v_own − v_other)/v_own` of both flanks at a point of the line of action (`ξ`, m); −∞ at the root of an
    /// involute. ISO 21771-1.
    pub fn specific_sliding(&self, xi_m: f64) -> [f64; 2] {
        let [pinion_m, wheel_m] = self.curvature_radii_m(xi_m);
        // Speeds along the flanks: curvature times angular speed.
        let ratio = wheel_m / (pinion_m * self.ratio());
        [1.0 - ratio, 1.0 - 1.0 / ratio]
    }

    /// Largest amount of specific sliding on both flanks, at the ends of the path.
    pub fn largest_sliding(&self) -> f64 {
        let usable = self.path().usable;
        [usable.start_m, usable.end_m].into_iter().flat_map(|xi_m| self.specific_sliding(xi_m)).fold(0.0, |most, zeta| most.max(zeta.abs()))
    }

    /// Loss of power over power, per unit of friction coefficient: `H_V = (1 ± 1/u) ⟨|ξ − ξ_C|⟩ / r_b1`, below for a ring.
    ///
    /// Coulomb friction of one coefficient, the load shared equally by the pairs in contact. For a contact ratio of 1 to 2 with the pitch
    /// point on the path it is `π (u ± 1)/(z₁ u) (1 − ε + ε₁² + ε₂²)`. Derived in `docs/theory/gears.md`, eq. (2); cf. Niemann and Winter,
    /// "Maschinenelemente", volume 2, and ISO/TR 14179-2.
    ///
    /// 0 of gears that do not touch, which says nothing about them: [`super::planetary::PlanetarySet::train`] refuses these.
    pub fn loss_factor(&self) -> f64 {
        (1.0 + self.sign() / self.ratio()) * self.path().mean_sliding_arm_m() / self.pinion.base_radius_m
    }

    /// That the path of contact is not empty.
    pub(super) fn check_touches(&self) -> Result<(), GearError> {
        let path = self.path();
        let length_m = path.usable.length_m();
        if length_m > 0.0 { Ok(()) } else { Err(GearError::Value { name: "contact_ratio", value: length_m / path.base_pitch_m }) }
    }

    fn sign(&self) -> f64 {
        sign(&self.wheel)
    }
}

/// Length of the tangent from a radius (m) to the base circle, m; 0 below it.
pub(super) fn tangent_m(wheel: &Wheel, radius_m: f64) -> f64 {
    ((radius_m - wheel.base_radius_m) * (radius_m + wheel.base_radius_m)).max(0.0).sqrt()
}

/// Radius with a length (m) of the tangent to the base circle, m.
pub(super) fn radius_m(wheel: &Wheel, tangent_m: f64) -> f64 {
    forcewright_base::maths::hypot(wheel.base_radius_m, tangent_m)
}

/// Sign of the pinion in sums over a mesh: + with an external gear, − with a ring.
fn sign(wheel: &Wheel) -> f64 {
    match wheel.spec.kind {
        Kind::External => 1.0,
        Kind::Internal => -1.0,
    }
}

fn check_mates(pinion: &Wheel, wheel: &Wheel) -> Result<(), GearError> {
    let (ours, theirs) = (&pinion.spec, &wheel.spec);
    let near = |a: f64, b: f64| (a - b).abs() <= 1e-12 * a.abs();
    let fault = if ours.kind == Kind::Internal {
        "the pinion must have its teeth outside"
    } else if !near(ours.module_m, theirs.module_m) {
        "their modules differ"
    } else if !near(ours.rack.pressure_angle_rad, theirs.rack.pressure_angle_rad) {
        "their pressure angles differ"
    } else if theirs.kind == Kind::Internal && theirs.teeth <= ours.teeth {
        "a ring needs more teeth than its pinion"
    } else {
        return Ok(());
    };
    Err(GearError::Mates { name: fault })
}
