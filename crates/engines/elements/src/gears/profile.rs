//! The tooth as it is drawn: tip, involute flank with or without relief, fillet, root. Theory: `docs/theory/gears-profiles.md`.
//!
//! The tooth is centred on the x axis; its boundary is given on the side that faces counterclockwise, the other side is its mirror image.
//! External gears have the fillet that a rack with a rounded tip leaves, undercut included; rings have an arc that touches flank and root
//! circle. Teeth thinner for backlash have both flanks moved by half of it, with the same root and tip circles.
//!
//! ```
//! use forcewright_elements::gears::{Kind, Rack, ToothProfile, Wheel, WheelSpec};
//!
//! let spec = WheelSpec {
//!     kind: Kind::External,
//!     teeth: 12,
//!     module_m: 0.5e-3,
//!     rack: Rack::ISO_53_A,
//!     profile_shift: 0.0,
//!     tip_shortening: 0.0,
//!     thinning_m: 0.0,
//! };
//! let tooth = ToothProfile::new(&Wheel::new(spec)?, None)?;
//! // Twelve teeth without shift are undercut; at least 17.1 of this rack would not be.
//! assert!(tooth.is_undercut());
//! let outline = tooth.outline(1e-7)?;
//! assert!(outline.error_m <= 1e-7 && outline.profile.segments.len() == 12 * 6);
//! # Ok::<(), forcewright_elements::gears::GearError>(())
//! ```

mod outline;
mod piece;
mod root;

pub use outline::GearOutline;
pub use piece::{Piece, Region};

use piece::{Arc, Curve, Flank, Relief};
use root::{Root, length_at_m, point_of_involutes_m};

use super::{GearError, Kind, Wheel};

/// How a relieved flank leaves the involute.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReliefShape {
    /// With the length along the line of action: a slight kink where it begins.
    Linear,
    /// With the square of that length: no kink.
    Parabolic,
}

/// Tip relief: material taken off the flank near the tip, measured along the line of action. ISO 21771-1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TipRelief {
    /// Taken off at the tip circle, `C_αa`, m; at least 0.
    pub amount_m: f64,
    /// Radius at which it begins, m; between form and tip radius.
    pub start_radius_m: f64,
    /// How it grows.
    pub shape: ReliefShape,
}

impl TipRelief {
    /// Relief over a length (m, above 0) along the line of action up to the tip circle.
    ///
    /// # Errors
    /// A length that is not above 0, or longer than the involute up to the tip circle.
    pub fn over_length(wheel: &Wheel, amount_m: f64, length_m: f64, shape: ReliefShape) -> Result<Self, GearError> {
        let tip_m = length_at_m(wheel, wheel.tip_radius_m);
        let start_m = match wheel.spec.kind {
            Kind::External => tip_m - length_m,
            Kind::Internal => tip_m + length_m,
        };
        if !(length_m > 0.0 && length_m.is_finite() && start_m >= 0.0) {
            return Err(GearError::Value { name: "length_m", value: length_m });
        }
        let start_radius_m = forcewright_base::maths::hypot(wheel.base_radius_m, start_m);
        Ok(Self { amount_m, start_radius_m, shape })
    }
}

/// The tooth of a gear as exact pieces of curves.
#[derive(Clone, Debug, PartialEq)]
pub struct ToothProfile {
    wheel: Wheel,
    pieces: Vec<Piece>,
    form_radius_m: f64,
    fillet_radius_m: f64,
    undercut: bool,
}

impl ToothProfile {
    /// The tooth of a gear.
    ///
    /// # Errors
    /// [`GearError::PointedTooth`], [`GearError::PointedSpace`], [`GearError::TipBelowBase`], [`GearError::NoFlank`], [`GearError::CutOff`];
    /// [`GearError::Value`] for a `root_radius` that the rack has no room for and for relief out of its range.
    pub fn new(wheel: &Wheel, relief: Option<TipRelief>) -> Result<Self, GearError> {
        let base_m = wheel.base_radius_m;
        let half_base_rad = 0.5 * wheel.tooth_angle_rad(base_m);
        let (outwards, below) = match wheel.spec.kind {
            Kind::External => (1.0, root::external(wheel, half_base_rad)?),
            Kind::Internal => (-1.0, ring_root(wheel, half_base_rad)?),
        };
        let Root { form_length_m, undercut, fillet_radius_m, pieces: lower } = below;
        let form_radius_m = forcewright_base::maths::hypot(base_m, form_length_m);
        if (wheel.tip_radius_m - form_radius_m) * outwards <= 0.0 {
            return Err(GearError::NoFlank { form_radius_m, tip_radius_m: wheel.tip_radius_m });
        }
        let tip_m = length_at_m(wheel, wheel.tip_radius_m);
        let mut flank = Flank { outwards, base_radius_m: base_m, half_base_rad, lengths_m: [tip_m, form_length_m], relief: None };
        let mut pieces = Vec::with_capacity(5);
        if let Some(relief) = relief {
            let start_m = relief_start_m(wheel, &relief, form_radius_m)?;
            flank.lengths_m[0] = start_m;
            let TipRelief { amount_m, shape, .. } = relief;
            let relief = Relief { start_m, end_m: tip_m, amount_m, parabolic: shape == ReliefShape::Parabolic };
            let relieved = Flank { lengths_m: [tip_m, start_m], relief: Some(relief), ..flank };
            pieces.push(Piece { region: Region::Relief, curve: Curve::Flank(relieved) });
        }
        pieces.push(Piece { region: Region::Flank, curve: Curve::Flank(flank) });
        let half_tip_rad = pieces[0].half_angle_rad(wheel.tip_radius_m);
        if half_tip_rad <= 0.0 {
            return Err(GearError::PointedTooth { radius_m: pointed_at_m(wheel, half_base_rad) });
        }
        let tip = Arc { centre_m: [0.0; 2], radius_m: wheel.tip_radius_m, angles_rad: [0.0, half_tip_rad] };
        pieces.insert(0, Piece { region: Region::Tip, curve: Curve::Arc(tip) });
        pieces.extend(lower);
        Ok(Self { wheel: *wheel, pieces, form_radius_m, fillet_radius_m, undercut })
    }

    /// The gear.
    pub fn wheel(&self) -> &Wheel {
        &self.wheel
    }

    /// Pieces from the middle of the tip to the middle of the root, on the side that faces counterclockwise; those without length are left
    /// out. All share their tangents, but for the corner at the tip, that of an undercut, the start of linear relief, and the corners of a
    /// rack or ring without rounding.
    pub fn pieces(&self) -> &[Piece] {
        &self.pieces
    }

    /// Radius at which the involute begins above the fillet, m. ISO 21771-1 calls twice of it the root form diameter.
    pub fn form_radius_m(&self) -> f64 {
        self.form_radius_m
    }

    /// Smallest radius of curvature of the fillet, m; 0 where flank and root circle meet in a corner.
    pub fn fillet_radius_m(&self) -> f64 {
        self.fillet_radius_m
    }

    /// Whether the rack has cut away part of the involute.
    pub fn is_undercut(&self) -> bool {
        self.undercut
    }

    /// Half of the angle that the drawn tooth takes at a radius, m, rad: on the involute half of [`Wheel::tooth_angle_rad`], on the fillet what
    /// that leaves. Absent outside the circles of tip and root.
    pub fn half_angle_rad(&self, radius_m: f64) -> Option<f64> {
        let sides = self.pieces.iter().filter(|piece| !matches!(piece.region, Region::Tip | Region::Root));
        let (low, high) = (self.wheel.tip_radius_m.min(self.wheel.root_radius_m), self.wheel.tip_radius_m.max(self.wheel.root_radius_m));
        if !(low..=high).contains(&radius_m) {
            return None;
        }
        // Rounding at joints: the piece that misses the radius least.
        let miss = |piece: &Piece| {
            let [tip, root] = piece.radii_m();
            (tip.min(root) - radius_m).max(radius_m - tip.max(root))
        };
        sides.min_by(|a, b| miss(a).max(0.0).total_cmp(&miss(b).max(0.0))).map(|piece| piece.half_angle_rad(radius_m))
    }

    /// The whole outline, with splines within a distance (m, above 0) of the exact tooth.
    ///
    /// # Errors
    /// [`GearError::Outline`] for a distance that is not above 0, or too small for as many pieces as a spline may have.
    pub fn outline(&self, tolerance_m: f64) -> Result<GearOutline, GearError> {
        outline::outline(self, tolerance_m)
    }
}

/// The root of a ring, if its teeth have an involute up to their tips.
fn ring_root(wheel: &Wheel, half_base_rad: f64) -> Result<Root, GearError> {
    let Wheel { tip_radius_m, base_radius_m, .. } = *wheel;
    if tip_radius_m <= base_radius_m {
        return Err(GearError::TipBelowBase { tip_radius_m, base_radius_m });
    }
    root::ring(wheel, half_base_rad)
}

/// Where the flanks of a tooth without relief meet.
fn pointed_at_m(wheel: &Wheel, half_base_rad: f64) -> f64 {
    let tip_m = wheel.tip_radius_m;
    match wheel.spec.kind {
        Kind::External => point_of_involutes_m(wheel, half_base_rad, tip_m),
        // The angle of a ring's tooth grows outwards: ψ_b + inv α = 0.
        Kind::Internal => point_of_involutes_m(wheel, -half_base_rad, wheel.root_radius_m),
    }
}

/// Length of the tangent to the base circle where relief begins, m.
fn relief_start_m(wheel: &Wheel, relief: &TipRelief, form_radius_m: f64) -> Result<f64, GearError> {
    let TipRelief { amount_m, start_radius_m, .. } = *relief;
    let (low, high) = (form_radius_m.min(wheel.tip_radius_m), form_radius_m.max(wheel.tip_radius_m));
    if !(start_radius_m > low && start_radius_m < high) {
        return Err(GearError::Value { name: "start_radius_m", value: start_radius_m });
    }
    let start_m = length_at_m(wheel, start_radius_m);
    let length_m = (length_at_m(wheel, wheel.tip_radius_m) - start_m).abs();
    // Steeper, and the flank would turn towards the root.
    if !(amount_m >= 0.0 && amount_m < 0.5 * length_m) {
        return Err(GearError::Value { name: "amount_m", value: amount_m });
    }
    Ok(start_m)
}
