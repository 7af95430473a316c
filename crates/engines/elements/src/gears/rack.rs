//! The basic rack.

/// Basic rack tooth profile: the rack that fills the spaces of a gear without shift. Lengths in modules.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rack {
    /// Pressure angle `α_P`, rad; between 0 and π/4.
    pub pressure_angle_rad: f64,
    /// Addendum `h_aP`, modules; above 0.
    pub addendum: f64,
    /// Dedendum `h_fP`, modules; above the addendum by the bottom clearance.
    pub dedendum: f64,
    /// Fillet radius `ρ_fP` at the root of the rack, modules; at most what the bottom clearance and the land leave room for.
    pub root_radius: f64,
}

impl Rack {
    /// ISO 53, profile A: 20°, 1, 1.25, 0.38 modules.
    pub const ISO_53_A: Self = Self { pressure_angle_rad: std::f64::consts::PI / 9.0, addendum: 1.0, dedendum: 1.25, root_radius: 0.38 };
    /// ISO 53, profile B: 20°, 1, 1.25, 0.30 modules.
    pub const ISO_53_B: Self = Self { root_radius: 0.30, ..Self::ISO_53_A };
    /// ISO 53, profile C: 20°, 1, 1.25, 0.25 modules.
    pub const ISO_53_C: Self = Self { root_radius: 0.25, ..Self::ISO_53_A };
    /// ISO 53, profile D: 20°, 1, 1.4, 0.39 modules.
    pub const ISO_53_D: Self = Self { dedendum: 1.4, root_radius: 0.39, ..Self::ISO_53_A };

    /// Bottom clearance `c_P`, modules.
    pub fn clearance(&self) -> f64 {
        self.dedendum - self.addendum
    }
}
