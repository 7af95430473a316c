//! Where bodies are and how they move, computed once per evaluation, and the view of it that user functions get.

use forcewright_base::maths;

use crate::body::{BodyId, Point, Pose};
use crate::model::{JointId, System};

/// One body at an instant: centre of mass, direction, velocities.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Frame {
    pub(crate) r: [f64; 2],
    pub(crate) angle: f64,
    pub(crate) cos: f64,
    pub(crate) sin: f64,
    pub(crate) v: [f64; 2],
    pub(crate) w: f64,
}

const AT_REST: Frame = Frame { r: [0.0; 2], angle: 0.0, cos: 1.0, sin: 0.0, v: [0.0; 2], w: 0.0 };

impl Frame {
    /// A vector of the body's frame in the ground frame.
    #[inline]
    pub(crate) fn turned(&self, p: [f64; 2]) -> [f64; 2] {
        [self.cos * p[0] - self.sin * p[1], self.sin * p[0] + self.cos * p[1]]
    }
}

/// A point fixed to a body, relative to its centre of mass.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Marker {
    pub(crate) body: BodyId,
    pub(crate) p: [f64; 2],
}

/// A marker at an instant.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Place {
    /// From the centre of mass, in the ground frame.
    pub(crate) arm: [f64; 2],
    pub(crate) r: [f64; 2],
    pub(crate) v: [f64; 2],
    /// Acceleration of the point without that of the body's coordinates: −ω² arm.
    pub(crate) bias: [f64; 2],
}

/// All bodies and path parameters at an instant. The ground is the first.
#[derive(Debug, Clone)]
pub(crate) struct Frames {
    pub(crate) bodies: Vec<Frame>,
    /// Path parameter and its rate, per contact.
    pub(crate) parameters: Vec<[f64; 2]>,
}

impl Frames {
    pub(crate) fn new(bodies: usize, parameters: usize) -> Self {
        Self { bodies: vec![AT_REST; bodies + 1], parameters: vec![[0.0; 2]; parameters] }
    }

    pub(crate) fn set_positions(&mut self, q: &[f64]) {
        let bodies = self.bodies.len() - 1;
        for (frame, q) in self.bodies[1..].iter_mut().zip(q.chunks_exact(3)) {
            let (sin, cos) = maths::sin_cos(q[2]);
            *frame = Frame { r: [q[0], q[1]], angle: q[2], cos, sin, ..AT_REST };
        }
        for (parameter, &u) in self.parameters.iter_mut().zip(&q[3 * bodies..]) {
            *parameter = [u, 0.0];
        }
    }

    pub(crate) fn set_velocities(&mut self, v: &[f64]) {
        let bodies = self.bodies.len() - 1;
        for (frame, v) in self.bodies[1..].iter_mut().zip(v.chunks_exact(3)) {
            frame.v = [v[0], v[1]];
            frame.w = v[2];
        }
        for (parameter, &rate) in self.parameters.iter_mut().zip(&v[3 * bodies..]) {
            parameter[1] = rate;
        }
    }

    #[inline]
    pub(crate) fn body(&self, id: BodyId) -> &Frame {
        &self.bodies[id.0 as usize]
    }

    #[inline]
    pub(crate) fn place(&self, marker: &Marker) -> Place {
        let frame = self.body(marker.body);
        let arm = frame.turned(marker.p);
        let w = frame.w;
        Place {
            arm,
            r: [frame.r[0] + arm[0], frame.r[1] + arm[1]],
            v: [frame.v[0] - w * arm[1], frame.v[1] + w * arm[0]],
            bias: [-w * w * arm[0], -w * w * arm[1]],
        }
    }
}

/// What functions of the state (loads, events) may look at.
#[derive(Debug, Clone, Copy)]
pub struct Snapshot<'a> {
    /// Time, s.
    pub time_s: f64,
    pub(crate) system: &'a System,
    pub(crate) frames: &'a Frames,
}

impl Snapshot<'_> {
    /// Place of a body's frame; the ground's for a body of another model.
    pub fn pose(&self, body: BodyId) -> Pose {
        let Some(frame) = self.frames.bodies.get(body.0 as usize) else { return Pose::default() };
        let origin = self.position_m(body.at(0.0, 0.0));
        Pose { x_m: origin[0], y_m: origin[1], angle_rad: frame.angle }
    }

    /// Angular velocity of a body, rad/s.
    pub fn rate_rad_per_s(&self, body: BodyId) -> f64 {
        self.frames.bodies.get(body.0 as usize).map_or(0.0, |frame| frame.w)
    }

    /// Where a point is in the ground frame, m.
    pub fn position_m(&self, point: Point) -> [f64; 2] {
        self.place(point).r
    }

    /// Velocity of a point, m/s.
    pub fn velocity_m_per_s(&self, point: Point) -> [f64; 2] {
        self.place(point).v
    }

    /// Parameter of a contact's path and its rate, per s; none if the joint is no contact.
    pub fn parameter(&self, contact: JointId) -> Option<[f64; 2]> {
        self.system.contact_index(contact).and_then(|index| self.frames.parameters.get(index).copied())
    }

    fn place(&self, point: Point) -> Place {
        let body = if (point.body.0 as usize) < self.frames.bodies.len() { point.body } else { crate::GROUND };
        self.frames.place(&self.system.marker(Point { body, ..point }))
    }
}
