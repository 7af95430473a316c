//! Rigid bodies, points on them, and where they are.

/// A body of a model, or the ground.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct BodyId(pub(crate) u32);

/// The frame that does not move; it may stand wherever a body may.
pub const GROUND: BodyId = BodyId(0);

impl BodyId {
    /// A point fixed to the body, by its coordinates in the body's frame, m.
    pub fn at(self, x_m: f64, y_m: f64) -> Point {
        Point { body: self, x_m, y_m }
    }

    /// Column of the body's first coordinate; none for the ground.
    pub(crate) fn column(self) -> Option<usize> {
        (self.0 as usize).checked_sub(1).map(|k| 3 * k)
    }
}

/// A point fixed to a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// The body that carries it.
    pub body: BodyId,
    /// Coordinate along the body's x axis, m.
    pub x_m: f64,
    /// Coordinate along the body's y axis, m.
    pub y_m: f64,
}

/// Place of a body's frame in the ground frame.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pose {
    /// Origin, m.
    pub x_m: f64,
    /// Origin, m.
    pub y_m: f64,
    /// Angle of the body's x axis, rad, not reduced to a turn.
    pub angle_rad: f64,
}

/// A rigid body: what it weighs and where it is believed to be before [`crate::System::assemble`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Body {
    /// Mass, kg, ≥ 0. A body without mass needs constraints that carry it.
    pub mass_kg: f64,
    /// Moment of inertia about the centre of mass, kg·m², ≥ 0.
    pub inertia_kg_m2: f64,
    /// Centre of mass in the body's frame, m.
    pub centre_m: [f64; 2],
    /// Where its frame is: exact for a free body, a guess where joints decide.
    pub pose: Pose,
}

impl Body {
    /// A body whose frame stands in its centre of mass, at the origin of the ground.
    pub fn new(mass_kg: f64, inertia_kg_m2: f64) -> Self {
        Self { mass_kg, inertia_kg_m2, centre_m: [0.0; 2], pose: Pose::default() }
    }

    /// A slender uniform rod whose frame stands at one end, with the x axis along the rod; inertia `m L²/12` about its middle.
    pub fn rod(mass_kg: f64, length_m: f64) -> Self {
        Self::new(mass_kg, mass_kg * length_m * length_m / 12.0).centre(0.5 * length_m, 0.0)
    }

    /// Sets the centre of mass in the body's frame, m.
    pub fn centre(mut self, x_m: f64, y_m: f64) -> Self {
        self.centre_m = [x_m, y_m];
        self
    }

    /// Sets the place of the body's frame, m and rad.
    pub fn placed(mut self, x_m: f64, y_m: f64, angle_rad: f64) -> Self {
        self.pose = Pose { x_m, y_m, angle_rad };
        self
    }
}
