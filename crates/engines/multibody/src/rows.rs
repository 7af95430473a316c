//! Constraint rows: values, Jacobian, derivative by time, and the right-hand side of the accelerations.
//!
//! A holonomic or rheonomic row is `c(q, t) = 0`, a nonholonomic one `B(q) q̇ = 0`; with `D` for both Jacobians velocities satisfy
//! `D q̇ = −∂c/∂t` and accelerations `D q̈ = γ` (Haug 1989, chapter 3; Sánchez-Salinas et al. 2022, eqs. (23)–(25)).

mod contact;
mod joints;

use crate::body::BodyId;
use crate::frames::{Frames, Marker};
use crate::motion::Motion;
pub(crate) use contact::ContactRows;

/// What one joint or driver asks for.
#[derive(Debug, Clone)]
pub(crate) enum Constraint {
    /// Two points coincide.
    Pin { a: Marker, b: Marker },
    /// Displacement of `a` from `b` along a direction fixed to `b` is a function of time.
    Along { a: Marker, b: Marker, direction: [f64; 2], motion: Motion },
    /// `a` slides along a line of `b` and keeps its angle to it.
    Prismatic { a: Marker, b: Marker, normal: [f64; 2], angle: f64 },
    /// `θ_a − ratio·θ_b` is a function of time.
    Angle { a: BodyId, b: BodyId, ratio: f64, motion: Motion },
    /// Two points keep their distance.
    Rod { a: Marker, b: Marker, length: f64 },
    /// A roller on a path.
    Contact(Box<ContactRows>),
    /// The parameter of a contact is a function of time.
    Parameter { index: usize, motion: Motion },
    /// A point does not move along a direction fixed to its body.
    Skate { at: Marker, direction: [f64; 2] },
}

impl Constraint {
    /// Names of its rows.
    pub(crate) fn row_names(&self) -> &'static [&'static str] {
        match self {
            Self::Pin { .. } => &["x", "y"],
            Self::Along { .. } => &["displacement"],
            Self::Prismatic { .. } => &["line", "angle"],
            Self::Angle { .. } => &["angle"],
            Self::Rod { .. } => &["length"],
            Self::Contact(contact) if contact.rolling => &["path x", "path y", "rolling"],
            Self::Contact(_) => &["path x", "path y"],
            Self::Parameter { .. } => &["parameter"],
            Self::Skate { .. } => &["sideways"],
        }
    }

    pub(crate) fn rows(&self) -> usize {
        self.row_names().len()
    }

    /// Whether a row of it constrains velocities only.
    pub(crate) fn is_velocity_row(&self, row: usize) -> bool {
        matches!(self, Self::Skate { .. }) || (matches!(self, Self::Contact(_)) && row == 2)
    }

    /// Whether a row is an angle; else it is a length, or a parameter.
    pub(crate) fn is_angle_row(&self, row: usize) -> bool {
        matches!(self, Self::Angle { .. }) || (matches!(self, Self::Prismatic { .. }) && row == 1)
    }

    /// Writes its rows.
    fn evaluate(&self, frames: &Frames, time_s: f64, out: &mut Sink<'_>) {
        match self {
            Self::Pin { a, b } => joints::pin(a, b, frames, out),
            Self::Along { a, b, direction, motion } => joints::along(a, b, *direction, motion.at(time_s), frames, out),
            Self::Prismatic { a, b, normal, angle } => {
                joints::along(a, b, *normal, [0.0; 3], frames, out);
                joints::angle((a.body, b.body, 1.0), [*angle, 0.0, 0.0], frames, &mut out.after(1));
            }
            Self::Angle { a, b, ratio, motion } => joints::angle((*a, *b, *ratio), motion.at(time_s), frames, out),
            Self::Rod { a, b, length } => joints::rod(a, b, *length, frames, out),
            Self::Contact(contact) => contact.evaluate(frames, out),
            Self::Parameter { index, motion } => {
                let [f, f1, f2] = motion.at(time_s);
                out.row(0, frames.parameters[*index][0] - f, -f1, f2);
                out.parameter(0, *index, 1.0);
            }
            Self::Skate { at, direction } => joints::skate(at, *direction, frames, out),
        }
    }
}

/// Where one constraint writes.
pub(crate) struct Sink<'a> {
    columns: usize,
    first_parameter: usize,
    value: &'a mut [f64],
    jacobian: &'a mut [f64],
    by_time: &'a mut [f64],
    gamma: &'a mut [f64],
}

impl Sink<'_> {
    #[inline]
    fn row(&mut self, row: usize, value: f64, by_time: f64, gamma: f64) {
        self.value[row] = value;
        self.by_time[row] = by_time;
        self.gamma[row] = gamma;
    }

    #[inline]
    fn body(&mut self, row: usize, body: BodyId, entries: [f64; 3]) {
        if let Some(column) = body.column() {
            let at = row * self.columns + column;
            for (target, entry) in self.jacobian[at..at + 3].iter_mut().zip(entries) {
                *target += entry;
            }
        }
    }

    #[inline]
    fn parameter(&mut self, row: usize, index: usize, entry: f64) {
        self.jacobian[row * self.columns + self.first_parameter + index] += entry;
    }

    /// The rows after some.
    fn after(&mut self, rows: usize) -> Sink<'_> {
        Sink {
            columns: self.columns,
            first_parameter: self.first_parameter,
            value: &mut self.value[rows..],
            jacobian: &mut self.jacobian[rows * self.columns..],
            by_time: &mut self.by_time[rows..],
            gamma: &mut self.gamma[rows..],
        }
    }
}

/// All rows at an instant, in the order of the joints, or those that are kept.
#[derive(Debug, Clone, Default)]
pub(crate) struct Rows {
    /// Number of coordinates.
    pub(crate) columns: usize,
    /// Value; 0 for velocity rows.
    pub(crate) value: Vec<f64>,
    /// Jacobian, row by row.
    pub(crate) jacobian: Vec<f64>,
    /// Partial derivative by time.
    pub(crate) by_time: Vec<f64>,
    /// Right-hand side of the accelerations.
    pub(crate) gamma: Vec<f64>,
}

impl Rows {
    pub(crate) fn len(&self) -> usize {
        self.value.len()
    }

    /// Evaluates all constraints.
    pub(crate) fn evaluate(&mut self, constraints: &[Constraint], columns: usize, total: usize, frames: &Frames, time_s: f64) {
        self.columns = columns;
        for field in [&mut self.value, &mut self.by_time, &mut self.gamma] {
            field.resize(total, 0.0);
        }
        self.jacobian.clear();
        self.jacobian.resize(total * columns, 0.0);
        let mut out = Sink {
            columns,
            first_parameter: columns - frames.parameters.len(),
            value: &mut self.value,
            jacobian: &mut self.jacobian,
            by_time: &mut self.by_time,
            gamma: &mut self.gamma,
        };
        let mut first = 0;
        for constraint in constraints {
            constraint.evaluate(frames, time_s, &mut out.after(first));
            first += constraint.rows();
        }
    }

    /// Keeps some of the rows, in rising order.
    pub(crate) fn keep(&mut self, kept: &[usize]) {
        if kept.len() == self.len() {
            return;
        }
        for (to, &from) in kept.iter().enumerate() {
            self.value[to] = self.value[from];
            self.by_time[to] = self.by_time[from];
            self.gamma[to] = self.gamma[from];
            self.jacobian.copy_within(from * self.columns..(from + 1) * self.columns, to * self.columns);
        }
        for field in [&mut self.value, &mut self.by_time, &mut self.gamma] {
            field.truncate(kept.len());
        }
        self.jacobian.truncate(kept.len() * self.columns);
    }

    /// One row of the Jacobian.
    pub(crate) fn row(&self, row: usize) -> &[f64] {
        &self.jacobian[row * self.columns..(row + 1) * self.columns]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Body, Contact, Follows, GROUND, Model, Path, PathPoint, Side, System};
    use forcewright_base::maths;

    /// y = 0.3 + 0.1 x² − 0.2 x³ with x = u, seen as a general curve.
    fn cubic(u: f64) -> PathPoint {
        PathPoint {
            point_m: [u, 0.3 + u * u * (0.1 - 0.2 * u)],
            first: [1.0, 0.2 * u - 0.6 * u * u],
            second: [0.0, 0.2 - 1.2 * u],
            third: [0.0, -1.2],
        }
    }

    /// Every kind of row between moving bodies whose frames are not at their centres of mass.
    fn everything() -> System {
        let mut model = Model::new();
        let a = model.body("a", Body::new(1.0, 0.1).centre(0.1, -0.2).placed(0.3, 0.4, 0.5));
        let b = model.body("b", Body::new(2.0, 0.2).centre(-0.3, 0.1).placed(-0.2, 0.1, -0.7));
        let motion = || Motion::Harmonic { mean: 0.1, amplitude: 0.3, rate_rad_per_s: 2.0, phase_rad: 0.4 };
        model.revolute("pin", a.at(0.2, 0.1), b.at(-0.1, 0.3));
        model.prismatic("slide", a.at(0.2, 0.1), b.at(-0.1, 0.3), 0.6, 0.2);
        model.drive_along("along", a.at(0.0, 0.1), b.at(0.5, 0.0), 1.1, motion());
        model.drive_angle("angle", a, b, motion());
        model.gear("gear", a, b, -2.5, 0.1);
        model.rod("rod", a.at(0.4, 0.0), b.at(0.0, -0.6), 0.7);
        model.slot("slot", a.at(0.4, 0.0), GROUND.at(0.1, 0.2), 0.3);
        model.skate("skate", b.at(0.2, 0.3), 0.8);
        let contact = |path, follows, side| Contact {
            roller: a.at(0.1, 0.3),
            radius_m: 0.15,
            cam: b,
            path,
            follows,
            side,
            rolling: true,
            start: 0.4,
        };
        let first = model.contact("surface", contact(Path::curve(cubic), Follows::Surface, Side::Left));
        model.contact("centre", contact(Path::curve(cubic), Follows::Centre, Side::Right));
        let circle = Path::Circle { centre_m: [0.1, 0.2], radius_m: 0.6 };
        model.contact("circle", contact(circle, Follows::Surface, Side::Left));
        model.drive_parameter("parameter", first, motion());
        model.build().unwrap()
    }

    fn at(system: &System, q: &[f64], v: &[f64], time_s: f64) -> Rows {
        let mut frames = system.frames_at(q);
        frames.set_velocities(v);
        let mut rows = Rows::default();
        rows.evaluate(&system.constraints, system.coordinates(), system.rows, &frames, time_s);
        rows
    }

    /// Rows and their rates.
    type Sample = (Rows, Vec<f64>);

    /// Along q + v s + a s²/2 the first two derivatives of every row follow from D, ∂c/∂t and γ; compared with differences of order 4.
    #[test]
    fn jacobian_and_gamma_are_the_derivatives_of_the_rows() {
        let system = everything();
        let n = system.coordinates();
        let wave = |k: usize, phase: f64| maths::sin(1.7 * k as f64 + phase);
        let (v, a): (Vec<f64>, Vec<f64>) = ((0..n).map(|k| wave(k, 0.3)).collect(), (0..n).map(|k| wave(k, 2.1)).collect());
        let (time, h) = (0.37, 1e-3);
        let on = |s: f64| {
            let q: Vec<f64> = (0..n).map(|k| system.guess()[k] + s * (v[k] + 0.5 * s * a[k])).collect();
            let velocity: Vec<f64> = (0..n).map(|k| v[k] + s * a[k]).collect();
            let rows = at(&system, &q, &velocity, time + s);
            let rate: Vec<f64> = (0..rows.len()).map(|r| dot(rows.row(r), &velocity) + rows.by_time[r]).collect();
            (rows, rate)
        };
        let [far_back, back, here, ahead, far_ahead] = [-2.0 * h, -h, 0.0, h, 2.0 * h].map(on);
        let difference =
            |get: &dyn Fn(&Sample) -> f64| (8.0 * (get(&ahead) - get(&back)) - (get(&far_ahead) - get(&far_back))) / (12.0 * h);
        for row in 0..system.rows() {
            if !system.velocity_rows[row] {
                let rate = difference(&|s| s.0.value[row]);
                assert!((rate - here.1[row]).abs() < 1e-10, "{}: rate {rate} {}", system.row_name(row), here.1[row]);
            }
            let acceleration = difference(&|s| s.1[row]);
            let want = dot(here.0.row(row), &a) - here.0.gamma[row];
            assert!((acceleration - want).abs() < 1e-9, "{}: acceleration {acceleration} {want}", system.row_name(row));
        }
    }

    fn dot(a: &[f64], b: &[f64]) -> f64 {
        a.iter().zip(b).map(|(a, b)| a * b).sum()
    }

    /// The rolling row is the velocity of the roller's material point at the contact relative to the cam's, along the tangent, if the
    /// centre keeps to its path. Built here from the velocities of two bodies.
    #[test]
    fn rolling_is_equal_velocity_at_the_contact() {
        let mut model = Model::new();
        let roller = model.body("roller", Body::new(1.0, 0.1).placed(0.3, 0.4, 0.5));
        let cam = model.body("cam", Body::new(2.0, 0.2).centre(-0.3, 0.1).placed(-0.2, 0.1, -0.7));
        let contact = Contact {
            roller: roller.at(0.0, 0.0),
            radius_m: 0.15,
            cam,
            path: Path::curve(cubic),
            follows: Follows::Surface,
            side: Side::Left,
            rolling: true,
            start: 0.4,
        };
        model.contact("contact", contact);
        let system = model.build().unwrap();
        let q = system.assemble(0.0, system.guess(), &[]).unwrap().q;
        // Any velocities that satisfy the first two rows.
        let mut v = vec![0.0, 0.0, 0.9, 0.2, -0.4, 1.3, 0.7];
        let rows = at(&system, &q, &v, 0.0);
        v[0] = -dot(rows.row(0), &v);
        v[1] = -dot(rows.row(1), &v);
        let slip = dot(rows.row(2), &v);
        let u = q[6];
        let surface = cubic(u);
        let mut frames = system.frames_at(&q);
        frames.set_velocities(&v);
        let on_cam = frames.place(&system.marker(cam.at(surface.point_m[0], surface.point_m[1])));
        let arm = [on_cam.r[0] - q[0], on_cam.r[1] - q[1]];
        assert!((maths::hypot(arm[0], arm[1]) - 0.15).abs() < 1e-14);
        let on_roller = [v[0] - v[2] * arm[1], v[1] + v[2] * arm[0]];
        let length = maths::hypot(surface.first[0], surface.first[1]);
        let tangent = frames.body(cam).turned([surface.first[0] / length, surface.first[1] / length]);
        let want = (on_roller[0] - on_cam.v[0]) * tangent[0] + (on_roller[1] - on_cam.v[1]) * tangent[1];
        assert!((slip - want).abs() < 1e-14 && want.abs() > 0.1, "{slip} {want}");
    }
}
