//! Building a mechanism: bodies, joints, drivers, forces; checked once, then read-only.

use crate::body::{Body, BodyId, Point, Pose};
use crate::error::ModelError;
use crate::forces::{Element, Force};
use crate::frames::{Frames, Marker};
use crate::motion::Motion;
use crate::path::{Follows, Path, Side};
use crate::rows::{Constraint, ContactRows};

/// A joint or driver of a model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct JointId(pub(crate) usize);

/// A roller on a path of a cam.
#[derive(Debug, Clone)]
pub struct Contact {
    /// Centre of the roller, a point of the body that turns.
    pub roller: Point,
    /// Radius of the roller, m, > 0.
    pub radius_m: f64,
    /// The body that carries the path.
    pub cam: BodyId,
    /// The path, in the cam's frame.
    pub path: Path,
    /// Whether it is the surface or the path of the roller's centre.
    pub follows: Follows,
    /// The side of the surface on which the roller is.
    pub side: Side,
    /// Whether the roller rolls without slip; else it slides without friction.
    pub rolling: bool,
    /// Where on the path to look for the contact: a guess of the parameter.
    pub start: f64,
}

/// A mechanism while it is described. Names serve messages; every method returns a handle.
///
/// ```
/// use forcewright_multibody::{Body, GROUND, Model};
/// let mut model = Model::new();
/// model.gravity_m_per_s2 = [0.0, -9.81];
/// let bob = model.body("bob", Body::rod(1.0, 0.5).placed(0.0, 0.0, -1.0));
/// model.revolute("pivot", GROUND.at(0.0, 0.0), bob.at(0.0, 0.0));
/// let system = model.build()?;
/// assert_eq!((system.coordinates(), system.rows()), (3, 2));
/// # Ok::<(), forcewright_multibody::ModelError>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct Model {
    /// Acceleration of gravity, m/s²; zero by default.
    pub gravity_m_per_s2: [f64; 2],
    bodies: Vec<(String, Body)>,
    joints: Vec<(String, Joint)>,
    forces: Vec<(String, Force)>,
}

/// What was asked for, in the user's frames.
#[derive(Debug, Clone)]
enum Joint {
    Revolute(Point, Point),
    Prismatic(Point, Point, f64, f64),
    Along(Point, Point, f64, Motion),
    Angle(BodyId, BodyId, f64, Motion),
    Rod(Point, Point, f64),
    Contact(Contact),
    Parameter(JointId, Motion),
    Skate(Point, f64),
}

impl Model {
    /// Nothing yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a body.
    pub fn body(&mut self, name: impl Into<String>, body: Body) -> BodyId {
        self.bodies.push((name.into(), body));
        BodyId(u32::try_from(self.bodies.len()).unwrap_or(u32::MAX))
    }

    fn joint(&mut self, name: impl Into<String>, joint: Joint) -> JointId {
        self.joints.push((name.into(), joint));
        JointId(self.joints.len() - 1)
    }

    /// Two points coincide: a pin.
    pub fn revolute(&mut self, name: impl Into<String>, a: Point, b: Point) -> JointId {
        self.joint(name, Joint::Revolute(a, b))
    }

    /// `a` slides along the line through `b` with a direction fixed to the body of `b`, rad; the body of `a` keeps the angle
    /// `angle_rad` to the body of `b`.
    pub fn prismatic(&mut self, name: impl Into<String>, a: Point, b: Point, direction_rad: f64, angle_rad: f64) -> JointId {
        self.joint(name, Joint::Prismatic(a, b, direction_rad, angle_rad))
    }

    /// A pin in a slot: `a` stays on the line through `b` with a direction fixed to the body of `b`, rad, and turns freely.
    pub fn slot(&mut self, name: impl Into<String>, a: Point, b: Point, direction_rad: f64) -> JointId {
        let normal = direction_rad + std::f64::consts::FRAC_PI_2;
        self.joint(name, Joint::Along(a, b, normal, Motion::Constant(0.0)))
    }

    /// Two points keep their distance, m, > 0: a rod or taut cable without mass.
    pub fn rod(&mut self, name: impl Into<String>, a: Point, b: Point, length_m: f64) -> JointId {
        self.joint(name, Joint::Rod(a, b, length_m))
    }

    /// `θ_a = ratio·θ_b + offset`: gears, a belt, or with ratio 1 a fixed angle.
    pub fn gear(&mut self, name: impl Into<String>, a: BodyId, b: BodyId, ratio: f64, offset_rad: f64) -> JointId {
        self.joint(name, Joint::Angle(a, b, ratio, Motion::Constant(offset_rad)))
    }

    /// A roller on a cam.
    pub fn contact(&mut self, name: impl Into<String>, contact: Contact) -> JointId {
        self.joint(name, Joint::Contact(contact))
    }

    /// A point does not move along a direction fixed to its body, rad: a skate or an ideal wheel seen from above.
    pub fn skate(&mut self, name: impl Into<String>, at: Point, direction_rad: f64) -> JointId {
        self.joint(name, Joint::Skate(at, direction_rad))
    }

    /// Drives the displacement of `a` from `b` along a direction fixed to the body of `b`, rad; the motion in m.
    pub fn drive_along(&mut self, name: impl Into<String>, a: Point, b: Point, direction_rad: f64, motion: Motion) -> JointId {
        self.joint(name, Joint::Along(a, b, direction_rad, motion))
    }

    /// Drives the angle of `a` from `b`; the motion in rad.
    pub fn drive_angle(&mut self, name: impl Into<String>, a: BodyId, b: BodyId, motion: Motion) -> JointId {
        self.joint(name, Joint::Angle(a, b, 1.0, motion))
    }

    /// Drives the parameter of a contact along its path.
    pub fn drive_parameter(&mut self, name: impl Into<String>, contact: JointId, motion: Motion) -> JointId {
        self.joint(name, Joint::Parameter(contact, motion))
    }

    /// Adds a spring, damper or load.
    pub fn force(&mut self, name: impl Into<String>, force: Force) {
        self.forces.push((name.into(), force));
    }

    /// Checks everything and computes what does not change.
    ///
    /// # Errors
    /// [`ModelError`] names the first part with a value that is not finite or out of range, or with a body or joint of another model.
    pub fn build(self) -> Result<System, ModelError> {
        if !self.gravity_m_per_s2.iter().all(|g| g.is_finite()) {
            return Err(ModelError::not_finite("gravity", "acceleration"));
        }
        for (name, body) in &self.bodies {
            check_body(name, body)?;
        }
        let contacts: Vec<usize> =
            self.joints.iter().enumerate().filter(|(_, (_, joint))| matches!(joint, Joint::Contact(_))).map(|(k, _)| k).collect();
        let mut system = System {
            mass: Vec::new(),
            gravity: self.gravity_m_per_s2,
            centres: self.bodies.iter().map(|(_, body)| body.centre_m).collect(),
            body_names: self.bodies.iter().map(|(name, _)| name.clone()).collect(),
            joint_names: self.joints.iter().map(|(name, _)| name.clone()).collect(),
            constraints: Vec::new(),
            first_rows: Vec::new(),
            rows: 0,
            contacts,
            elements: Vec::new(),
            guess: Vec::new(),
            length_m: 1.0,
            coordinate_scale: Vec::new(),
            row_scale: Vec::new(),
            velocity_rows: Vec::new(),
        };
        for (_, body) in &self.bodies {
            system.mass.extend([body.mass_kg, body.mass_kg, body.inertia_kg_m2]);
        }
        system.set_guess(&self);
        for (name, joint) in &self.joints {
            let constraint = system.constraint(name, joint)?;
            system.first_rows.push(system.rows);
            system.rows += constraint.rows();
            system.constraints.push(constraint);
        }
        for (name, force) in &self.forces {
            let element = system.element(name, force)?;
            system.elements.push(element);
        }
        system.set_scales();
        Ok(system)
    }
}

fn check_body(name: &str, body: &Body) -> Result<(), ModelError> {
    let Body { mass_kg, inertia_kg_m2, centre_m, pose } = *body;
    for (what, value) in [("mass", mass_kg), ("inertia", inertia_kg_m2)] {
        if !(value >= 0.0 && value.is_finite()) {
            return Err(ModelError::out_of_range(name, what, value, "0 or more"));
        }
    }
    if [centre_m[0], centre_m[1], pose.x_m, pose.y_m, pose.angle_rad].iter().all(|v| v.is_finite()) {
        Ok(())
    } else {
        Err(ModelError::not_finite(name, "centre of mass or pose"))
    }
}

/// A mechanism that was checked. Read-only and free of state: any number of threads may use it.
///
/// Coordinates are, per body, centre of mass and angle (x, y, θ), then one path parameter per contact. Take them from
/// [`System::guess`] or [`System::assemble`] and read them by [`System::pose`], [`System::position_m`] and [`System::parameter`].
#[derive(Debug, Clone)]
pub struct System {
    /// Diagonal of the mass matrix of the bodies.
    pub(crate) mass: Vec<f64>,
    pub(crate) gravity: [f64; 2],
    pub(crate) centres: Vec<[f64; 2]>,
    body_names: Vec<String>,
    joint_names: Vec<String>,
    pub(crate) constraints: Vec<Constraint>,
    pub(crate) first_rows: Vec<usize>,
    pub(crate) rows: usize,
    /// Joints that are contacts, in order.
    contacts: Vec<usize>,
    pub(crate) elements: Vec<Element>,
    guess: Vec<f64>,
    /// A length that is typical of the mechanism, m.
    pub(crate) length_m: f64,
    /// Size of a coordinate that matters: a length, 1 rad, or a parameter over that length.
    pub(crate) coordinate_scale: Vec<f64>,
    pub(crate) row_scale: Vec<f64>,
    pub(crate) velocity_rows: Vec<bool>,
}

impl System {
    /// Number of coordinates: three per body and one per contact.
    pub fn coordinates(&self) -> usize {
        self.mass.len() + self.contacts.len()
    }

    /// Number of constraint rows, drivers included.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Coordinates of the poses and parameters given when the model was described.
    pub fn guess(&self) -> &[f64] {
        &self.guess
    }

    /// Place of a body's frame in given coordinates; the ground's for a body of another model.
    ///
    /// # Panics
    /// If there are fewer values than [`System::coordinates`].
    pub fn pose(&self, q: &[f64], body: BodyId) -> Pose {
        let Some(k) = body.column().filter(|k| *k < self.mass.len()) else { return Pose::default() };
        let frames = self.frames_at(q);
        let origin = frames.place(&self.marker(body.at(0.0, 0.0))).r;
        Pose { x_m: origin[0], y_m: origin[1], angle_rad: q[k + 2] }
    }

    /// Ground coordinates of a point, m; those of the ground's point for a body of another model.
    ///
    /// # Panics
    /// If there are fewer values than [`System::coordinates`].
    pub fn position_m(&self, q: &[f64], point: Point) -> [f64; 2] {
        let pose = self.pose(q, point.body);
        let (s, c) = forcewright_base::maths::sin_cos(pose.angle_rad);
        [pose.x_m + c * point.x_m - s * point.y_m, pose.y_m + s * point.x_m + c * point.y_m]
    }

    /// Path parameter of a contact in given coordinates; none if the joint is no contact.
    ///
    /// # Panics
    /// If there are fewer values than [`System::coordinates`].
    pub fn parameter(&self, q: &[f64], contact: JointId) -> Option<f64> {
        self.parameter_coordinate(contact).map(|index| q[index])
    }

    /// Which coordinate is the path parameter of a contact; none if the joint is no contact.
    pub fn parameter_coordinate(&self, contact: JointId) -> Option<usize> {
        self.contact_index(contact).map(|index| self.mass.len() + index)
    }

    pub(crate) fn contact_index(&self, contact: JointId) -> Option<usize> {
        self.contacts.iter().position(|k| *k == contact.0)
    }

    /// Where a body's coordinates begin; none for the ground.
    pub fn first_coordinate(&self, body: BodyId) -> Option<usize> {
        body.column().filter(|k| *k < self.mass.len())
    }

    /// Rows of a joint or driver among the multipliers; none for one of another model.
    pub fn joint_rows(&self, joint: JointId) -> Option<std::ops::Range<usize>> {
        let first = *self.first_rows.get(joint.0)?;
        Some(first..first + self.constraints[joint.0].rows())
    }

    /// Name of a row: joint and what of it.
    pub fn row_name(&self, row: usize) -> String {
        let joint = self.first_rows.partition_point(|first| *first <= row).saturating_sub(1);
        let (Some(name), Some(constraint)) = (self.joint_names.get(joint), self.constraints.get(joint)) else { return String::new() };
        let parts = constraint.row_names();
        format!("{name}: {}", parts.get(row - self.first_rows[joint]).unwrap_or(&"?"))
    }

    /// Name of a coordinate: body and what of it, or the path parameter of a contact.
    pub fn coordinate_name(&self, coordinate: usize) -> String {
        match self.body_names.get(coordinate / 3) {
            Some(name) => format!("{name}: {}", ["x", "y", "angle"][coordinate % 3]),
            None => match self.contacts.get(coordinate - self.mass.len()) {
                Some(joint) => format!("{}: path parameter", self.joint_names[*joint]),
                None => String::new(),
            },
        }
    }

    pub(crate) fn new_frames(&self) -> Frames {
        Frames::new(self.mass.len() / 3, self.contacts.len())
    }

    pub(crate) fn frames_at(&self, q: &[f64]) -> Frames {
        let mut frames = self.new_frames();
        frames.set_positions(q);
        frames
    }

    /// The point relative to its body's centre of mass. The body must be one of the model.
    pub(crate) fn marker(&self, point: Point) -> Marker {
        let centre = (point.body.0 as usize).checked_sub(1).map_or([0.0; 2], |k| self.centres[k]);
        Marker { body: point.body, p: [point.x_m - centre[0], point.y_m - centre[1]] }
    }

    fn set_guess(&mut self, model: &Model) {
        for (_, body) in &model.bodies {
            let Pose { x_m, y_m, angle_rad } = body.pose;
            let (s, c) = forcewright_base::maths::sin_cos(angle_rad);
            let [px, py] = body.centre_m;
            self.guess.extend([x_m + c * px - s * py, y_m + s * px + c * py, angle_rad]);
        }
        for (_, joint) in &model.joints {
            if let Joint::Contact(contact) = joint {
                self.guess.push(contact.start);
            }
        }
    }

    fn checked_body(&self, name: &str, body: BodyId) -> Result<BodyId, ModelError> {
        if body.0 as usize <= self.body_names.len() { Ok(body) } else { Err(ModelError::Unknown { part: name.to_owned() }) }
    }

    fn checked_marker(&self, name: &str, point: Point) -> Result<Marker, ModelError> {
        self.checked_body(name, point.body)?;
        if point.x_m.is_finite() && point.y_m.is_finite() { Ok(self.marker(point)) } else { Err(ModelError::not_finite(name, "point")) }
    }

    fn pair(&self, name: &str, a: Point, b: Point) -> Result<(Marker, Marker), ModelError> {
        self.distinct(name, a.body, b.body)?;
        Ok((self.checked_marker(name, a)?, self.checked_marker(name, b)?))
    }

    fn distinct(&self, name: &str, a: BodyId, b: BodyId) -> Result<(), ModelError> {
        self.checked_body(name, a)?;
        self.checked_body(name, b)?;
        if a == b { Err(ModelError::SameBody { part: name.to_owned() }) } else { Ok(()) }
    }

    fn constraint(&self, name: &str, joint: &Joint) -> Result<Constraint, ModelError> {
        let unit = |angle: f64| finite(name, "direction", angle).map(unit);
        Ok(match joint {
            Joint::Revolute(a, b) => {
                let (a, b) = self.pair(name, *a, *b)?;
                Constraint::Pin { a, b }
            }
            Joint::Prismatic(a, b, direction, angle) => {
                let (a, b) = self.pair(name, *a, *b)?;
                let [c, s] = unit(*direction)?;
                Constraint::Prismatic { a, b, normal: [-s, c], angle: finite(name, "angle", *angle)? }
            }
            Joint::Along(a, b, direction, motion) => {
                let (a, b) = self.pair(name, *a, *b)?;
                Constraint::Along { a, b, direction: unit(*direction)?, motion: checked_motion(name, motion)? }
            }
            Joint::Angle(a, b, ratio, motion) => {
                self.distinct(name, *a, *b)?;
                let motion = checked_motion(name, motion)?;
                Constraint::Angle { a: *a, b: *b, ratio: finite(name, "ratio", *ratio)?, motion }
            }
            Joint::Rod(a, b, length) => {
                let (a, b) = self.pair(name, *a, *b)?;
                Constraint::Rod { a, b, length: positive(name, "length", *length)? }
            }
            Joint::Contact(contact) => Constraint::Contact(Box::new(self.contact(name, contact)?)),
            Joint::Parameter(contact, motion) => {
                let unknown = || ModelError::Unknown { part: name.to_owned() };
                let index = self.contact_index(*contact).ok_or_else(unknown)?;
                Constraint::Parameter { index, motion: checked_motion(name, motion)? }
            }
            Joint::Skate(at, direction) => Constraint::Skate { at: self.checked_marker(name, *at)?, direction: unit(*direction)? },
        })
    }

    fn contact(&self, name: &str, contact: &Contact) -> Result<ContactRows, ModelError> {
        self.distinct(name, contact.roller.body, contact.cam)?;
        let radius_m = positive(name, "radius", contact.radius_m)?;
        let side = contact.side.sign();
        let rows = ContactRows {
            centre: self.checked_marker(name, contact.roller)?,
            cam: self.marker(contact.cam.at(0.0, 0.0)),
            path: contact.path.clone(),
            offset_m: if contact.follows == Follows::Surface { side * radius_m } else { 0.0 },
            radius_m,
            cam_side: -side,
            rolling: contact.rolling,
            // Contacts before this one.
            index: self.constraints.iter().filter(|c| matches!(c, Constraint::Contact(_))).count(),
        };
        let speed = rows.speed(finite(name, "start", contact.start)?);
        if speed.is_finite() && speed != 0.0 { Ok(rows) } else { Err(ModelError::not_finite(name, "tangent of the path at the start")) }
    }

    fn element(&self, name: &str, force: &Force) -> Result<Element, ModelError> {
        Ok(match force {
            Force::Spring { a, b, law } => {
                let (a, b) = self.pair(name, *a, *b)?;
                Element::Spring { a, b, law: law.clone() }
            }
            Force::Damper { a, b, damping_n_s_per_m } => {
                let (a, b) = self.pair(name, *a, *b)?;
                Element::Damper { a, b, damping: not_negative(name, "damping", *damping_n_s_per_m)? }
            }
            Force::TorsionSpring { a, b, law } => {
                self.distinct(name, *a, *b)?;
                Element::TorsionSpring { a: *a, b: *b, law: law.clone() }
            }
            Force::TorsionDamper { a, b, damping_nm_s_per_rad } => {
                self.distinct(name, *a, *b)?;
                Element::TorsionDamper { a: *a, b: *b, damping: not_negative(name, "damping", *damping_nm_s_per_rad)? }
            }
            Force::Push { at, load } => Element::Push { at: self.checked_marker(name, *at)?, load: load.clone() },
            Force::Torque { on, from, torque } => {
                self.distinct(name, *on, *from)?;
                Element::Torque { on: *on, from: *from, torque: torque.clone() }
            }
        })
    }

    /// A typical length: the largest extent of what stands on bodies, else the spread of the guess. It does not depend on where the
    /// mechanism stands.
    fn set_scales(&mut self) {
        let reach = |marker: &Marker| if marker.body.0 == 0 { 0.0 } else { forcewright_base::maths::hypot(marker.p[0], marker.p[1]) };
        let mut length = 0.0_f64;
        for constraint in &self.constraints {
            length = length.max(match constraint {
                Constraint::Pin { a, b } | Constraint::Along { a, b, .. } | Constraint::Prismatic { a, b, .. } => reach(a).max(reach(b)),
                Constraint::Rod { a, b, length } => reach(a).max(reach(b)).max(*length),
                Constraint::Contact(contact) => contact.radius_m.max(reach(&contact.centre)),
                Constraint::Skate { at, .. } => reach(at),
                Constraint::Angle { .. } | Constraint::Parameter { .. } => 0.0,
            });
        }
        for k in 0..2 {
            let (low, high) = self.guess[..self.mass.len()]
                .iter()
                .skip(k)
                .step_by(3)
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(*x), high.max(*x)));
            length = length.max(if high > low { high - low } else { 0.0 });
        }
        self.length_m = if length > 0.0 && length.is_finite() { length } else { 1.0 };
        let length = self.length_m;
        self.coordinate_scale = (0..self.mass.len()).map(|k| if k % 3 == 2 { 1.0 } else { length }).collect();
        for constraint in &self.constraints {
            if let Constraint::Contact(contact) = constraint {
                let u = self.guess[self.coordinate_scale.len()];
                self.coordinate_scale.push(length / contact.speed(u).abs());
            }
        }
        for constraint in &self.constraints {
            for row in 0..constraint.rows() {
                let parameter = |index: &usize| self.coordinate_scale[self.mass.len() + index];
                self.row_scale.push(match constraint {
                    Constraint::Parameter { index, .. } => parameter(index),
                    _ if constraint.is_angle_row(row) => 1.0,
                    _ => length,
                });
                self.velocity_rows.push(constraint.is_velocity_row(row));
            }
        }
    }
}

fn unit(angle_rad: f64) -> [f64; 2] {
    let (s, c) = forcewright_base::maths::sin_cos(angle_rad);
    [c, s]
}

fn finite(name: &str, what: &'static str, value: f64) -> Result<f64, ModelError> {
    if value.is_finite() { Ok(value) } else { Err(ModelError::not_finite(name, what)) }
}

fn positive(name: &str, what: &'static str, value: f64) -> Result<f64, ModelError> {
    if value > 0.0 && value.is_finite() { Ok(value) } else { Err(ModelError::out_of_range(name, what, value, "above 0")) }
}

fn not_negative(name: &str, what: &'static str, value: f64) -> Result<f64, ModelError> {
    if value >= 0.0 && value.is_finite() { Ok(value) } else { Err(ModelError::out_of_range(name, what, value, "0 or more")) }
}

fn checked_motion(name: &str, motion: &Motion) -> Result<Motion, ModelError> {
    if motion.at(0.0).iter().all(|v| v.is_finite()) { Ok(motion.clone()) } else { Err(ModelError::not_finite(name, "motion at time 0")) }
}
