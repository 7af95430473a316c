//! The forces in the mechanism at one instant: slider, two braces, two rollers, springs, by Newton and Euler.
//!
//! The position follows from that of the slider's joint; velocities and accelerations follow by differentiating. Each side then gives
//! two equations for the tension of its brace and the force between roller and cam, and the slider gives the force that moves it and
//! the one that guides it. At rest this is eq. (1) of Sánchez-Salinas et al.; without friction it is the reduced Lagrangian of
//! `docs/theory/cam.md`, eq. (8), term by term.

use crate::cut::SIDES;
use crate::path::{Place, SidePath, Vector, frame, length};
use crate::springs::Bank;

/// How the mass of the springs moves with the rollers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpringMass {
    /// As a bar between the axles: a sixth of it rides with each roller outwards, half of it along the travel.
    Bar,
    /// Half of it sits on each roller, as the measured masses of the paper imply.
    Halves,
}

/// Masses and inertias of one mechanism.
#[derive(Clone, Copy, Debug)]
pub struct Bodies {
    /// Slider, kg.
    pub slider_kg: f64,
    /// Each brace, kg.
    pub brace_kg: f64,
    /// Each brace about its middle, kg m².
    pub brace_kg_m2: f64,
    /// Each roller with its axle, kg.
    pub roller_kg: f64,
    /// What of it rolls, about its axis, kg m².
    pub roller_kg_m2: f64,
    /// How the springs' mass moves.
    pub springs: SpringMass,
}

/// The mechanism, ready for instants.
#[derive(Clone, Debug)]
pub struct Mechanism {
    /// Right and left path.
    pub paths: [SidePath; SIDES],
    /// Length of each brace, m.
    pub brace_m: [f64; SIDES],
    /// Radius of the rollers, m.
    pub roller_m: f64,
    /// Arm of the rolling resistance, m.
    pub arm_m: f64,
    /// The springs as mounted.
    pub springs: Bank,
    /// Masses.
    pub bodies: Bodies,
    /// Against the travel, m/s².
    pub gravity_m_per_s2: f64,
    /// Height of the slider's joint where s = 0, m.
    pub rise_m: f64,
}

/// Which way the rollers roll, for friction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sense {
    /// The slider moves along its travel.
    Up,
    /// It moves back.
    Down,
    /// No friction.
    Frictionless,
}

/// Motion of the slider's joint: travel s and the way sideways, with their derivatives over time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Drive {
    /// s and to the right, m.
    pub at: Vector,
    /// m/s.
    pub velocity: Vector,
    /// m/s².
    pub acceleration: Vector,
}

impl Drive {
    /// At rest at a travel on the axis.
    pub fn rest(travel_m: f64) -> Self {
        Self { at: [travel_m, 0.0], ..Self::default() }
    }
}

/// Where everything is.
#[derive(Clone, Copy, Debug)]
pub struct Pose {
    /// Travel s of the slider, m.
    pub travel_m: f64,
    /// λ of each side, m.
    pub lambda_m: [f64; SIDES],
    /// By how much it is beyond the λ of the mechanism as it was designed, m.
    pub beyond_m: [f64; SIDES],
    /// The paths' points.
    pub places: [Place; SIDES],
    /// The slider's joint in the coordinates of each side, m.
    pub joints: [Vector; SIDES],
    /// Times a path was evaluated.
    pub evaluations: u32,
}

/// Why there is no position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NotAssembled {
    /// Which side.
    pub side: usize,
    /// By how much its brace is too long or too short at the nearest place, m.
    pub gap_m: f64,
}

/// Why forces are not known at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stop {
    /// There is no position.
    NotAssembled(NotAssembled),
    /// Friction locks the rollers: no force moves the slider that way.
    Locks(Sense),
}

impl From<NotAssembled> for Stop {
    fn from(why: NotAssembled) -> Self {
        Self::NotAssembled(why)
    }
}

/// Forces of one side; not numbers where friction locks the rollers.
#[derive(Clone, Copy, Debug, Default)]
pub struct SideForces {
    /// Between cam and roller along the normal, pushing, N.
    pub normal_n: f64,
    /// Between them along the path, N: positive in the direction of the travel, on the roller.
    pub tangential_n: f64,
    /// Tension of the brace at the roller, N.
    pub brace_n: f64,
}

/// Forces at one instant.
#[derive(Clone, Copy, Debug)]
pub struct Instant {
    /// On the slider along its travel, N: what pulls it.
    pub force_n: f64,
    /// On the slider to the right, N: what guides it.
    pub guide_n: f64,
    /// Right and left.
    pub sides: [SideForces; SIDES],
    /// Tension of all springs, N.
    pub spring_n: f64,
    /// Distance of the axles, m.
    pub spring_m: f64,
}

/// Steps for a position.
const MOST_STEPS: u32 = 40;
/// A step this small, relative to the springs' length at the start, needs no new evaluation of the path: its Taylor series is exact.
const NEAR: f64 = 1e-13;

/// Position of a roller.
#[derive(Clone, Copy, Debug)]
struct SidePose {
    lambda_m: f64,
    beyond_m: f64,
    place: Place,
}

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn cross(a: Vector, b: Vector) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn sum(terms: &[(f64, Vector)]) -> Vector {
    terms.iter().fold([0.0; 2], |s, (k, v)| [s[0] + k * v[0], s[1] + k * v[1]])
}

/// Kinematics of one side.
#[derive(Clone, Copy, Debug)]
struct Motion {
    /// Unit vectors: along the path, normal away from the cam, from the roller to the joint.
    along: Vector,
    normal: Vector,
    brace: Vector,
    /// Of the roller's centre.
    roller_acceleration: Vector,
    /// Of the joint, in the coordinates of the side.
    joint_acceleration: Vector,
    /// Of the brace's rotation, rad/s².
    turning: f64,
    /// Sign of the roller's way along the path for travel along `Up`.
    rolls: f64,
}

/// Forces that a side needs for its weight and its motion, N.
#[derive(Clone, Copy, Debug)]
struct Needs {
    /// At the roller, from the cam along its normal with friction, and from the brace along it.
    at_roller: Vector,
    /// At the joint, beside the tension of the brace.
    at_joint: Vector,
    /// What holds the rolling rim back along the path.
    rim_n: f64,
}

impl Mechanism {
    /// Whether both sides are the same and the joint is on the axis, so that one side tells both.
    pub(crate) fn symmetric(&self, sideways: [f64; 3]) -> bool {
        sideways.iter().all(|x| *x == 0.0)
            && self.brace_m[0].to_bits() == self.brace_m[1].to_bits()
            && self.paths[0].is_like(&self.paths[1])
    }

    /// Rolling friction μ = arm over radius.
    pub fn friction(&self) -> f64 {
        self.arm_m / self.roller_m
    }

    /// Finds the rollers below the slider's joint at (s, sideways).
    ///
    /// # Errors
    /// [`NotAssembled`] if a brace does not reach its path there.
    pub fn pose(&self, at: Vector) -> Result<Pose, NotAssembled> {
        self.pose_near(at, None)
    }

    /// The same from a position nearby on the same curve.
    ///
    /// # Errors
    /// [`NotAssembled`] as [`Self::pose`].
    #[inline]
    pub fn pose_near(&self, at: Vector, near: Option<&Pose>) -> Result<Pose, NotAssembled> {
        let height = at[0] + self.rise_m;
        let joints = [[at[1], height], [-at[1], height]];
        let mut evaluations = 0;
        let right = self.side_pose(0, joints[0], at[0], near, &mut evaluations)?;
        let left = if self.symmetric([at[1], 0.0, 0.0]) { right } else { self.side_pose(1, joints[1], at[0], near, &mut evaluations)? };
        Ok(Pose {
            travel_m: at[0],
            lambda_m: [right.lambda_m, left.lambda_m],
            beyond_m: [right.beyond_m, left.beyond_m],
            places: [right.place, left.place],
            joints,
            evaluations,
        })
    }

    /// Where to look for λ: as far from where it was meant to be as it was nearby, and what the joint's way from there does besides.
    #[inline]
    fn guess_m(&self, side: usize, joint: Vector, expected_m: f64, near: Option<&Pose>) -> f64 {
        let Some(pose) = near else { return expected_m };
        // Where it was meant to be, as on a cam without flaws.
        if pose.beyond_m[side].abs() < NEAR * expected_m {
            return expected_m;
        }
        let (place, before) = (&pose.places[side], pose.joints[side]);
        let arm = sum(&[(1.0, place.at), (-1.0, before)]);
        let way = sum(&[(1.0, joint), (-1.0, before)]);
        let meant = self.paths[side].cut().expected_slope(pose.travel_m, pose.lambda_m[side] - pose.beyond_m[side]);
        let more = dot(arm, way) / dot(arm, place.slope) - meant * way[1];
        let close = more.abs() < pose.beyond_m[side].abs() + 1e-3 * self.brace_m[side];
        expected_m + pose.beyond_m[side] + if close { more } else { 0.0 }
    }

    /// Solves |path(λ) − joint| = brace by Halley's method.
    #[inline]
    fn side_pose(
        &self,
        side: usize,
        joint: Vector,
        travel_m: f64,
        near: Option<&Pose>,
        evaluations: &mut u32,
    ) -> Result<SidePose, NotAssembled> {
        let brace_m = self.brace_m[side];
        let path = &self.paths[side];
        let expected_m = path.cut().expected_m(travel_m);
        let scale = path.cut().purpose().start_length_m;
        let mut lambda = self.guess_m(side, joint, expected_m, near);
        let mut place = path.at(lambda);
        let mut miss = f64::INFINITY;
        let mut arm = [0.0; 2];
        *evaluations += 1;
        for _ in 0..MOST_STEPS {
            arm = sum(&[(1.0, place.at), (-1.0, joint)]);
            // Half the difference of the squares: the gap times the length of the brace, to first order.
            miss = 0.5 * (dot(arm, arm) - brace_m * brace_m);
            // The root with the roller below the joint: the other crossing is above it.
            let found = |lambda: f64, place: Place| {
                if arm[1] < 0.0 {
                    Ok(SidePose { lambda_m: lambda, beyond_m: lambda - expected_m, place })
                } else {
                    Err(self.apart(side, arm))
                }
            };
            if miss.abs() < 4.0 * f64::EPSILON * brace_m * brace_m {
                return found(lambda, place);
            }
            let slope = dot(arm, place.slope);
            let newton = miss / slope;
            let bent = 0.5 * newton * (dot(place.slope, place.slope) + dot(arm, place.bend)) / slope;
            // Where the crossing is nearly a touch, Newton's step alone.
            let change = (if bent.abs() < 0.1 { newton / (1.0 - bent) } else { newton }).clamp(-0.1 * scale, 0.1 * scale);
            if !change.is_finite() {
                break;
            }
            if change.abs() < NEAR * scale {
                place.at = sum(&[(1.0, place.at), (-change, place.slope)]);
                place.slope = sum(&[(1.0, place.slope), (-change, place.bend)]);
                return found(lambda - change, place);
            }
            lambda -= change;
            place = path.at(lambda);
            *evaluations += 1;
        }
        // The last digits may move to and fro.
        let close = miss.abs() < 1e-13 * brace_m * brace_m && arm[1] < 0.0;
        if close { Ok(SidePose { lambda_m: lambda, beyond_m: lambda - expected_m, place }) } else { Err(self.apart(side, arm)) }
    }

    fn apart(&self, side: usize, arm: Vector) -> NotAssembled {
        NotAssembled { side, gap_m: length(arm) - self.brace_m[side] }
    }

    /// Forces at an instant of a motion.
    ///
    /// # Errors
    /// [`NotAssembled`] if there is no position.
    pub fn instant(&self, drive: &Drive, sense: Sense) -> Result<Instant, NotAssembled> {
        Ok(self.forces(&self.pose(drive.at)?, drive, sense))
    }

    /// Forces at a position that was found; not numbers where friction locks the rollers in that sense.
    pub fn forces(&self, pose: &Pose, drive: &Drive, sense: Sense) -> Instant {
        let [instant] = self.forces_in(pose, drive, [sense]);
        instant
    }

    /// The same for several senses of friction, which share all but the last equations.
    pub fn forces_in<const N: usize>(&self, pose: &Pose, drive: &Drive, senses: [Sense; N]) -> [Instant; N] {
        let symmetric = self.symmetric([drive.at[1], drive.velocity[1], drive.acceleration[1]]);
        let right = self.motion(0, pose, drive);
        let left = if symmetric { right } else { self.motion(1, pose, drive) };
        let motions = [right, left];
        let [pr, pl] = [pose.places[0].at, pose.places[1].at];
        let apart = [-(pr[0] + pl[0]), pl[1] - pr[1]];
        let spring_m = length(apart);
        let [spring_n, _] = self.springs.tension_n(spring_m);
        let pull = [spring_n / spring_m * apart[0], spring_n / spring_m * apart[1]];
        let right = self.needs(0, &motions, pull);
        let left = if symmetric { right } else { self.needs(1, &motions, [pull[0], -pull[1]]) };
        let slider = self.bodies.slider_kg;
        senses.map(|sense| {
            let (on_right, from_right) = self.side_forces(&motions[0], &right, sense);
            let (on_left, from_left) = if symmetric { (on_right, from_right) } else { self.side_forces(&motions[1], &left, sense) };
            let force_n = from_right[1] + from_left[1] + slider * (drive.acceleration[0] + self.gravity_m_per_s2);
            let guide_n = from_right[0] - from_left[0] + slider * drive.acceleration[1];
            Instant { force_n, guide_n, sides: [on_right, on_left], spring_n, spring_m }
        })
    }

    fn motion(&self, side: usize, pose: &Pose, drive: &Drive) -> Motion {
        let sign = if side == 0 { 1.0 } else { -1.0 };
        let place = &pose.places[side];
        let [along, normal] = frame(place, self.springs.sense());
        let joint = pose.joints[side];
        let arm = sum(&[(1.0, place.at), (-1.0, joint)]);
        let length = self.brace_m[side];
        let brace = [-arm[0] / length, -arm[1] / length];
        let to_side = |v: Vector| [sign * v[1], v[0]];
        let (joint_velocity, joint_acceleration) = (to_side(drive.velocity), to_side(drive.acceleration));
        let gear = dot(arm, place.slope);
        let rate = dot(arm, joint_velocity) / gear;
        let relative = sum(&[(rate, place.slope), (-1.0, joint_velocity)]);
        let rate2 = (dot(arm, joint_acceleration) - dot(arm, place.bend) * rate * rate - dot(relative, relative)) / gear;
        let roller_acceleration = sum(&[(rate2, place.slope), (rate * rate, place.bend)]);
        let turning = cross(brace, sum(&[(1.0, joint_acceleration), (-1.0, roller_acceleration)])) / length;
        let rolls = (arm[1] / gear).signum();
        Motion { along, normal, brace, roller_acceleration, joint_acceleration, turning, rolls }
    }

    /// What a side needs of contact and brace, whichever way friction acts.
    fn needs(&self, side: usize, motions: &[Motion; SIDES], pull: Vector) -> Needs {
        let m = &motions[side];
        let b = &self.bodies;
        let length = self.brace_m[side];
        let up = [0.0, self.gravity_m_per_s2];
        // The brace: the force across it at the roller turns it about the joint.
        let middle = sum(&[(0.5, m.roller_acceleration), (0.5, m.joint_acceleration), (1.0, up)]);
        let lever = [-0.5 * length * m.brace[0], -0.5 * length * m.brace[1]];
        let across = (b.brace_kg_m2 * m.turning + b.brace_kg * cross(lever, middle)) / length;
        let across_brace = [-across * m.brace[1], across * m.brace[0]];
        // The springs' mass.
        let other = motions[1 - side].roller_acceleration;
        let mirrored = [-other[0], other[1]];
        let spring_kg = self.springs.mass_kg();
        let spring_inertia = match b.springs {
            SpringMass::Bar => sum(&[(spring_kg / 3.0, m.roller_acceleration), (spring_kg / 6.0, mirrored), (0.5 * spring_kg, up)]),
            SpringMass::Halves => sum(&[(0.5 * spring_kg, m.roller_acceleration), (0.5 * spring_kg, up)]),
        };
        // Rolling: the rim's inertia holds the centre back along the path.
        let rim_n = b.roller_kg_m2 / (self.roller_m * self.roller_m) * dot(m.roller_acceleration, m.along);
        let at_roller = sum(&[
            (b.roller_kg, m.roller_acceleration),
            (b.roller_kg, up),
            (1.0, spring_inertia),
            (rim_n, m.along),
            (-1.0, pull),
            (-1.0, across_brace),
        ]);
        Needs { at_roller, at_joint: sum(&[(b.brace_kg, middle), (1.0, across_brace)]), rim_n }
    }

    /// Forces of a side, and what its brace needs from the joint.
    fn side_forces(&self, m: &Motion, needs: &Needs, sense: Sense) -> (SideForces, Vector) {
        let friction = match sense {
            Sense::Up => m.rolls * self.friction(),
            Sense::Down => -m.rolls * self.friction(),
            Sense::Frictionless => 0.0,
        };
        // N (n − μ t) + T b = needed.
        let solve = |friction: f64| {
            let contact = sum(&[(1.0, m.normal), (-friction, m.along)]);
            let over = 1.0 / cross(contact, m.brace);
            (friction, cross(needs.at_roller, m.brace) * over, cross(contact, needs.at_roller) * over)
        };
        let pushing = solve(friction);
        let (friction, normal_n, brace_n) = match pushing {
            // The cam would have to pull without friction as well: then resistance acts the other way.
            (_, normal, _) if normal < 0.0 && friction != 0.0 && solve(0.0).1 < 0.0 => solve(-friction),
            // Friction alone turns the force of the cam round: no force moves the slider, it locks.
            (_, normal, _) if normal < 0.0 && friction != 0.0 => (friction, f64::NAN, f64::NAN),
            _ => pushing,
        };
        let tangential_n = -friction * normal_n - needs.rim_n;
        (SideForces { normal_n, tangential_n, brace_n }, sum(&[(1.0, needs.at_joint), (brace_n, m.brace)]))
    }
}
