//! What forbids a gear or a mesh: undercut, pointed teeth, and teeth that meet where they should not. Each is a margin: at least 0 is good.
//!
//! Trochoid and trimming interference assume teeth of full thickness; thinner teeth have more room.

use std::fmt;

use forcewright_base::maths::{acos, asin, sin, sin_cos};

use super::mesh::radius_m;
use super::{GearError, Kind, Mesh, Wheel, corner, fillet, involute};

/// What a margin is in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// m.
    Metre,
    /// rad.
    Radian,
    /// A ratio.
    One,
}

/// What a margin keeps clear of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Condition {
    /// The rack cuts into the involute of an external gear.
    Undercut,
    /// The tip of a tooth is too thin.
    TipThickness,
    /// The spaces of a ring are pointed before they reach the root circle.
    RingRoot,
    /// The tip of a ring is below its base circle, where there is no involute.
    RingTip,
    /// The tip of the wheel passes the point where the line of action touches the base circle of the pinion.
    PinionInterference,
    /// The tip of the pinion passes the point where the line of action touches the base circle of the external wheel.
    WheelInterference,
    /// The tip of the wheel meets the fillet of the pinion on the line of action. Necessary, not sufficient: see [`Condition::PinionCorner`].
    PinionFillet,
    /// The tip of the pinion meets the fillet of the wheel on the line of action.
    WheelFillet,
    /// The corner at the tip of the wheel cuts into the fillet of the pinion, anywhere on its way.
    PinionCorner,
    /// The corner at the tip of the pinion cuts into the fillet of the wheel, anywhere on its way.
    WheelCorner,
    /// The tip of the pinion does not clear the root of the wheel by enough.
    PinionClearance,
    /// The tip of the wheel does not clear the root of the pinion by enough.
    WheelClearance,
    /// The tips of a pinion and a ring foul each other beside the line of action.
    Trochoid,
    /// A pinion and its ring do not go together radially.
    Trimming,
    /// Too few teeth are in contact.
    ContactRatio,
    /// Planets beside each other are too close.
    NeighbourGap,
    /// The teeth are not there for planets at equal angles.
    Assembly,
    /// No shifts bring both meshes to one centre distance.
    Coaxial,
}

impl Condition {
    /// Unit of the margin.
    pub fn unit(self) -> Unit {
        match self {
            Self::Trochoid | Self::Trimming => Unit::Radian,
            Self::ContactRatio | Self::Assembly => Unit::One,
            _ => Unit::Metre,
        }
    }

    /// The margin, as an equation.
    pub fn equation(self) -> &'static str {
        match self {
            Self::Undercut => "m (x − h_F + ½ z sin²α), h_F = h_fP − ρ_fP (1 − sin α)",
            Self::TipThickness => "s_a − least",
            Self::RingRoot => "width of the space at the root circle",
            Self::RingTip => "r_a2 − r_b2",
            Self::PinionInterference => "ξ of the tip of the wheel: a sin α' − √(r_a2² − r_b2²), of a ring √(r_a2² − r_b2²) − a sin α'",
            Self::WheelInterference => "a sin α' − √(r_a1² − r_b1²)",
            Self::PinionFillet => "ξ of the tip of the wheel − √(r_F1² − r_b1²)",
            Self::WheelFillet => "√(r_F2² − r_b2²) from the tip of the pinion, along the line of action",
            Self::PinionCorner => "least of R (ψ_corner + ψ(R)) over the way of the wheel's tip corner, along the circle about the pinion",
            Self::WheelCorner => "least of R (ψ_corner + ψ(R)) over the way of the pinion's tip corner, along the circle about the wheel",
            Self::PinionClearance => "a − r_a1 − r_f2, of a ring r_f2 − a − r_a1, − least",
            Self::WheelClearance => "a − r_a2 − r_f1, of a ring r_a2 − a − r_f1, − least",
            Self::Trochoid => "θ₁ z₁/z₂ + inv α' − inv α_a2 − θ₂",
            Self::Trimming => "θ₁ + inv α_a1 − inv α' − (z₂/z₁)(θ₂ + inv α_a2 − inv α')",
            Self::ContactRatio => "ε − least",
            Self::NeighbourGap => "2 a sin(π/N) − 2 r_a − least",
            Self::Assembly => "−((z_s + z_r) mod N)",
            Self::Coaxial => "a cos α' − difference of base radii",
        }
    }

    /// Where the equation comes from.
    pub fn source(self) -> &'static str {
        match self {
            Self::Trochoid => "SDP/SI, Elements of Metric Gear Technology, eqs. (5-6) to (5-8)",
            Self::Trimming => "SDP/SI, Elements of Metric Gear Technology, eqs. (5-9) and (5-10)",
            Self::PinionCorner | Self::WheelCorner => "geometry; docs/theory/gears.md, eq. (5)",
            Self::NeighbourGap | Self::Assembly | Self::RingRoot | Self::Coaxial => "geometry; docs/theory/gears.md",
            _ => "geometry of the involute; ISO 21771-1",
        }
    }
}

impl fmt::Display for Condition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Undercut => "undercut",
            Self::TipThickness => "thin tip",
            Self::RingRoot => "pointed spaces of the ring",
            Self::RingTip => "tip of the ring below its base circle",
            Self::PinionInterference => "involute interference at the pinion",
            Self::WheelInterference => "involute interference at the wheel",
            Self::PinionFillet => "tip of the wheel in the fillet of the pinion",
            Self::WheelFillet => "tip of the pinion in the fillet of the wheel",
            Self::PinionCorner => "tip corner of the wheel in the fillet of the pinion",
            Self::WheelCorner => "tip corner of the pinion in the fillet of the wheel",
            Self::PinionClearance => "clearance at the tip of the pinion",
            Self::WheelClearance => "clearance at the tip of the wheel",
            Self::Trochoid => "trochoid interference",
            Self::Trimming => "trimming interference",
            Self::ContactRatio => "contact ratio",
            Self::NeighbourGap => "gap between planets",
            Self::Assembly => "assembly of equally spaced planets",
            Self::Coaxial => "one centre distance for both meshes",
        })
    }
}

/// How far a gear or mesh is from what is forbidden.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Margin {
    /// What it keeps clear of.
    pub condition: Condition,
    /// At least 0 is good; in [`Condition::unit`].
    pub value: f64,
}

impl Margin {
    fn new(condition: Condition, value: f64) -> Self {
        Self { condition, value }
    }

    /// Whether it holds.
    pub fn holds(&self) -> bool {
        self.value >= 0.0
    }
}

/// Least profile shift without undercut by the rack, modules: `x = h_F − ½ z sin²α` with `h_F = h_fP − ρ_fP (1 − sin α)`, the depth to which the
/// flank of the rack is straight.
pub fn least_shift(wheel: &Wheel) -> f64 {
    let sin = sin_cos(wheel.spec.rack.pressure_angle_rad).0;
    fillet::straight_depth(wheel) - 0.5 * f64::from(wheel.spec.teeth) * sin * sin
}

/// Radius where the involute ends towards the root, m: at the fillet of the rack, which on an undercut gear cuts the involute above its end;
/// in a ring at the arc in the corners of its spaces.
pub fn form_radius_m(wheel: &Wheel) -> f64 {
    radius_m(wheel, fillet::form_tangent_m(wheel))
}

/// Radius where the flanks of a tooth of an external gear, or of a space of a ring, meet, m.
pub fn pointed_radius_m(wheel: &Wheel) -> f64 {
    radius_m(wheel, fillet::pointed_tangent_m(wheel))
}

/// Thickness of a tooth along its tip circle, m; below 0 if it is pointed below.
pub fn tip_thickness_m(wheel: &Wheel) -> f64 {
    wheel.tip_radius_m * wheel.tooth_angle_rad(wheel.tip_radius_m)
}

/// That the teeth are not pointed below their tips.
///
/// # Errors
/// [`GearError::PointedTooth`]
pub fn check_tip(wheel: &Wheel) -> Result<(), GearError> {
    if tip_thickness_m(wheel) >= 0.0 { Ok(()) } else { Err(GearError::PointedTooth { radius_m: fillet::pointed_tooth_m(wheel) }) }
}

/// Margins of one gear, with the least thickness of its tips (m).
pub fn wheel_margins(wheel: &Wheel, least_tip_m: f64) -> impl Iterator<Item = Margin> + use<> {
    let tip = Margin::new(Condition::TipThickness, tip_thickness_m(wheel) - least_tip_m);
    let (first, second) = match wheel.spec.kind {
        Kind::External => {
            let shift = wheel.spec.profile_shift - least_shift(wheel);
            (Margin::new(Condition::Undercut, shift * wheel.spec.module_m), None)
        }
        Kind::Internal => {
            let pitch_rad = 2.0 * std::f64::consts::PI / f64::from(wheel.spec.teeth);
            let space_m = wheel.root_radius_m * (pitch_rad - wheel.tooth_angle_rad(wheel.root_radius_m));
            let base = Margin::new(Condition::RingTip, wheel.tip_radius_m - wheel.base_radius_m);
            (base, Some(Margin::new(Condition::RingRoot, space_m)))
        }
    };
    [Some(tip), Some(first), second].into_iter().flatten()
}

/// Margins of a mesh, with the least bottom clearance (m).
pub fn mesh_margins(mesh: &Mesh, least_clearance_m: f64) -> impl Iterator<Item = Margin> + use<> {
    let path = mesh.path();
    let [pinion_m, wheel_m] = mesh.bottom_clearances_m();
    let external = mesh.wheel.spec.kind == Kind::External;
    let margin = |condition, value| Some(Margin::new(condition, value));
    let [pinion_corner, wheel_corner] = corner_rooms_m(mesh);
    [
        margin(Condition::PinionInterference, path.tips.start_m - path.interference.start_m),
        if external { margin(Condition::WheelInterference, path.interference.end_m - path.tips.end_m) } else { None },
        margin(Condition::PinionFillet, path.tips.start_m - path.forms.start_m),
        margin(Condition::WheelFillet, path.forms.end_m - path.tips.end_m),
        pinion_corner.map(|value| Margin::new(Condition::PinionCorner, value)),
        wheel_corner.map(|value| Margin::new(Condition::WheelCorner, value)),
        margin(Condition::PinionClearance, pinion_m - least_clearance_m),
        margin(Condition::WheelClearance, wheel_m - least_clearance_m),
        if external { None } else { trochoid_rad(mesh).map(|value| Margin::new(Condition::Trochoid, value)) },
        if external { None } else { margin(Condition::Trimming, trimming_rad(mesh)) },
    ]
    .into_iter()
    .flatten()
}

/// Least room between the tip corner of the wheel and the fillet of the pinion, and between that of the pinion and the fillet of the wheel,
/// along the circle about the gear with the fillet, m. None where the corner does not come as deep as the fillet.
///
/// The flank of the corner is in contact, as if the involutes went on beyond the path of contact. A corner that begins contact at the end of
/// the fillet has a room of 0. The root circle is left to [`Mesh::bottom_clearances_m`]. Derived in `docs/theory/gears.md`, eq. (5).
pub fn corner_rooms_m(mesh: &Mesh) -> [Option<f64>; 2] {
    corner::rooms_m(mesh)
}

/// Tip radius that a mate of the pinion may have before it passes the pinion's interference point, m: the largest of an external wheel, the
/// smallest of a ring.
pub fn wheel_tip_limit_m(mesh: &Mesh) -> f64 {
    radius_m(&mesh.wheel, mesh.centre_distance_m * sin(mesh.pressure_angle_rad))
}

/// Margin against fouling of the tips of a pinion and a ring, rad. None where the tip circles do not cross, and of an external mesh.
///
/// SDP/SI, "Elements of Metric Gear Technology", eqs. (5-6) to (5-8): while the tip of the pinion crosses the tip circle of the ring,
/// `θ₁ z₁/z₂ + inv α' − inv α_a2 ≥ θ₂`.
pub fn trochoid_rad(mesh: &Mesh) -> Option<f64> {
    let (a, tip1, tip2) = (mesh.centre_distance_m, mesh.pinion.tip_radius_m, mesh.wheel.tip_radius_m);
    if mesh.wheel.spec.kind == Kind::External || a + tip1 <= tip2 {
        return None;
    }
    let angle = |cosine: f64| acos(cosine.clamp(-1.0, 1.0));
    let working = involute(mesh.pressure_angle_rad);
    let theta1 = angle((tip2 * tip2 - tip1 * tip1 - a * a) / (2.0 * a * tip1)) + involute(mesh.pinion.pressure_angle_rad(tip1)) - working;
    let theta2 = angle((a * a + tip2 * tip2 - tip1 * tip1) / (2.0 * a * tip2));
    Some(theta1 / mesh.ratio() + working - involute(mesh.wheel.pressure_angle_rad(tip2)) - theta2)
}

/// Margin against trimming: whether a pinion can be put into its ring radially, rad; infinite of an external mesh.
///
/// SDP/SI, "Elements of Metric Gear Technology", eqs. (5-9) and (5-10):
/// `θ₁ + inv α_a1 − inv α' ≥ (z₂/z₁)(θ₂ + inv α_a2 − inv α')`.
pub fn trimming_rad(mesh: &Mesh) -> f64 {
    if mesh.wheel.spec.kind == Kind::External {
        return f64::INFINITY;
    }
    let tips = [mesh.pinion.pressure_angle_rad(mesh.pinion.tip_radius_m), mesh.wheel.pressure_angle_rad(mesh.wheel.tip_radius_m)];
    let cosines = sin_cos(tips[0]).1 / sin_cos(tips[1]).1;
    let u = mesh.ratio();
    let angle = |square: f64| asin(square.clamp(0.0, 1.0).sqrt());
    let theta1 = angle((1.0 - cosines * cosines) / (1.0 - 1.0 / (u * u)));
    let theta2 = angle((1.0 / (cosines * cosines) - 1.0) / (u * u - 1.0));
    let working = involute(mesh.pressure_angle_rad);
    theta1 + involute(tips[0]) - working - u * (theta2 + involute(tips[1]) - working)
}
