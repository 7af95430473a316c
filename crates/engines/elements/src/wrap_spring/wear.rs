//! Wear of the hub, and the force that walks a slipping coil along it.

use std::f64::consts::{PI, TAU};

use super::{WrapSpring, WrapSpringError, not_negative, positive};
use forcewright_base::maths::{atan2, sin};

/// Wear of a hub on which the coil slips in the opening sense.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HubWear {
    /// Work of friction, `τ_b φ`, J.
    pub work_j: f64,
    /// Worn volume by Archard's law, m³.
    pub volume_m3: f64,
    /// Depth under a turn in uniform contact next to the free end, where the pressure of such contact is largest, m. The point force with which
    /// the end itself presses is not in it.
    pub depth_m: f64,
}

/// What friction can do to a coil along its axis. These are bounds of our own: the paper only says that there is a force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxialWalk {
    /// Lead angle of the coil on the hub, rad.
    pub lead_rad: f64,
    /// Largest axial force of friction, N.
    pub force_n: f64,
    /// Largest axial travel per turn of slip, m: one pitch, when the coil slides along its own wire like a screw in its nut.
    pub travel_per_turn_m: f64,
    /// By how much that force stretches the free turns, m.
    pub stretch_m: f64,
    /// By how much the coil becomes shorter while it opens to the bore: pitch times dead turns, m.
    pub dead_travel_m: f64,
}

impl WrapSpring {
    /// Wear of the hub after slip by an angle (rad, at least 0) in the opening sense at a coefficient of friction above 0.
    ///
    /// Archard's law `V = k F s` (`archard1953`), with `k` in m²/N (the dimensional coefficient, over hardness). The coil presses with
    /// `∫p ds = τ_b/(μ r)`, hence `V = k τ_b φ/μ`. Uniform contact presses most next to the free end, with `M_A/r²` over length; each point of
    /// the hub under that turn is rubbed over `r φ`, and over the width of the track (m): `k M_A φ/(r w)`. The track is the width of contact, at
    /// most the pitch. The free end presses with a point force of `1.19 M_A/r` besides (`docs/theory/wrap-spring.md`, Ends), which rubs a
    /// groove of its own and is not in the depth.
    ///
    /// # Errors
    /// [`WrapSpringError::Value`]
    pub fn hub_wear(&self, friction: f64, slip_rad: f64, wear_m2_per_n: f64, track_m: f64) -> Result<HubWear, WrapSpringError> {
        positive("friction", friction)?;
        not_negative("slip_rad", slip_rad)?;
        not_negative("wear_m2_per_n", wear_m2_per_n)?;
        positive("track_m", track_m)?;
        let work_j = self.hub_slip_nm(friction) * slip_rad;
        Ok(HubWear {
            work_j,
            volume_m3: wear_m2_per_n * work_j / friction,
            depth_m: wear_m2_per_n * self.hub_moment_nm * slip_rad / (self.hub_radius_m() * track_m),
        })
    }

    /// The screw effect, bounded, for a pitch (m, at least 0), a coefficient of friction (at least 0) and the shear modulus of the wire (Pa).
    ///
    /// Friction opposes the slip. A coil that stands still while the hub turns under it gets forces around the axis only. Where wire moves
    /// along itself, as when the coil opens and a slip zone grows, friction acts along the wire: at most `τ_b/r` over the hub, with the axial
    /// part `τ_b sin α/r`. What keeps the coil in place has to carry that. It stretches the `N_f` free turns as an extension spring, rate
    /// `G d⁴/(64 r³ N_f)`.
    ///
    /// # Errors
    /// [`WrapSpringError::Value`]
    pub fn axial_walk(&self, friction: f64, pitch_m: f64, shear_modulus_pa: f64) -> Result<AxialWalk, WrapSpringError> {
        not_negative("friction", friction)?;
        not_negative("pitch_m", pitch_m)?;
        positive("shear_modulus_pa", shear_modulus_pa)?;
        let hub_m = self.hub_radius_m();
        let lead_rad = atan2(pitch_m, TAU * hub_m);
        let force_n = self.hub_slip_nm(friction) * sin(lead_rad) / hub_m;
        let (d, r) = (self.dimensions.wire_m, self.dimensions.neutral_radius_m);
        // Axial compliance of N turns, 64 r³ N/(G d⁴).
        let compliance_m_per_n = 64.0 * r * r * r * self.dimensions.free_turns / (shear_modulus_pa * d * d * d * d);
        Ok(AxialWalk {
            lead_rad,
            force_n,
            travel_per_turn_m: pitch_m,
            stretch_m: force_n * compliance_m_per_n,
            dead_travel_m: pitch_m * self.dead_turns(),
        })
    }

    /// Largest force of the coil on the hub over its length under uniform contact in the opening sense, next to the free end, N/m: `M_A/r²`.
    /// What presses in [`crate::hertz`]. The free end itself presses with a point force of `1.19 M_A/r`: `docs/theory/wrap-spring.md`, Ends.
    pub fn hub_load_n_per_m(&self) -> f64 {
        self.hub_moment_nm / (self.hub_radius_m() * self.hub_radius_m())
    }

    /// Heat of one turn of slip on the hub, J: `2π τ_b`.
    ///
    /// # Errors
    /// [`WrapSpringError::Value`]
    pub fn slip_work_per_turn_j(&self, friction: f64) -> Result<f64, WrapSpringError> {
        not_negative("friction", friction)?;
        Ok(2.0 * PI * self.hub_slip_nm(friction))
    }
}
