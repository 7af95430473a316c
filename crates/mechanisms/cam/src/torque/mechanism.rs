//! The forces in a torque cam at one instant: disc, two rollers, their followers on level guides, springs.
//!
//! Both lobes are equal and half a turn apart, so one roller tells both, and the shaft carries a torque and no force. The roller is on the
//! right of the shaft; the disc turns counterclockwise by θ. Each roller with its follower gives one equation along the guide for the force N
//! between roller and cam; the torque follows from what the cam takes (`docs/theory/cam.md`, eqs. 14, 15 and 18).

use std::sync::Arc;

use forcewright_base::maths;

use super::cut::Cut;
use crate::mechanism::{Sense, SpringMass};
use crate::path::{Circle, Place, Vector, beside, corner_of, frame};
use crate::springs::Bank;

/// Masses and inertias.
#[derive(Clone, Copy, Debug)]
pub struct Bodies {
    /// Disc, shaft and what turns with them, kg m².
    pub disc_kg_m2: f64,
    /// What moves on its guide with each roller, kg.
    pub follower_kg: f64,
    /// Each roller with its axle, kg.
    pub roller_kg: f64,
    /// What of it rolls, about its axis, kg m².
    pub roller_kg_m2: f64,
    /// How the springs' mass moves.
    pub springs: SpringMass,
}

/// Corner of an undercut cam: below it the roller turns about it.
#[derive(Clone, Copy, Debug)]
pub struct Corner {
    /// λ where the roller comes to it, m.
    pub lambda_m: f64,
    /// Turn there, rad.
    pub turn_rad: f64,
    /// The corner itself in the coordinates of the disc, m.
    pub at: Vector,
}

/// The mechanism, ready for instants.
#[derive(Clone, Debug)]
pub struct Mechanism {
    /// What the disc was cut for.
    pub cut: Arc<Cut>,
    /// Radius of the rollers for which it was cut, m.
    pub cut_roller_m: f64,
    /// Where it is undercut.
    pub corner: Option<Corner>,
    /// Radius of the rollers, m.
    pub roller_m: f64,
    /// Arm of the rolling resistance, m.
    pub arm_m: f64,
    /// Friction between followers and guides.
    pub guide_friction: f64,
    /// The springs as mounted.
    pub springs: Bank,
    /// Masses.
    pub bodies: Bodies,
}

/// Where everything is.
#[derive(Clone, Copy, Debug)]
pub struct Pose {
    /// Turn θ of the disc, rad.
    pub turn_rad: f64,
    /// λ of the path, m.
    pub lambda_m: f64,
    /// The path's point in the coordinates of the disc.
    pub place: Place,
    /// Distance ρ of the rollers' centres from the shaft's middle, m, with its first two derivatives over the turn.
    pub radius_m: [f64; 3],
    /// Times the path was evaluated.
    pub evaluations: u32,
}

/// Motion of the disc: angular speed, rad/s, and acceleration, rad/s².
pub type Drive = [f64; 2];

/// Forces at one instant; those of a roller are the same for both.
#[derive(Clone, Copy, Debug)]
pub struct Instant {
    /// On the shaft in the direction of the turn, N·m: what turns it.
    pub torque_nm: f64,
    /// Between cam and roller along the normal, pushing, N.
    pub normal_n: f64,
    /// Between them along the path, N: positive in the direction in which the path is passed, on the roller.
    pub tangential_n: f64,
    /// Across the guide of a follower, N: positive in the direction of the turn, on the guide.
    pub guide_n: f64,
    /// Tension of all springs, N.
    pub spring_n: f64,
    /// Distance of the axles, m.
    pub spring_m: f64,
}

/// A turn at which no roller stands on the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NotAssembled {
    /// By how much the roller misses its guide at the nearest place, m.
    pub gap_m: f64,
}

/// Why forces are not known at a turn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stop {
    /// There is no position.
    NotAssembled(NotAssembled),
    /// Friction locks the rollers: no torque turns the disc that way.
    Locks(Sense),
}

/// Steps of Newton's method for a position.
const MOST_STEPS: u32 = 60;

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

impl Mechanism {
    /// Where the cam is undercut for a roller of this radius.
    pub fn corner_of(cut: &Cut, roller_m: f64) -> Option<Corner> {
        let (lambda_m, at) = corner_of(|l| cut.place(l), cut.range_m(), roller_m, cut.sense())?;
        Some(Corner { lambda_m, turn_rad: cut.at(lambda_m)[0].value(), at })
    }

    /// Rolling friction μ = arm over radius.
    pub fn friction(&self) -> f64 {
        self.arm_m / self.roller_m
    }

    /// The path as it is made, in the coordinates of the disc: about the corner where there is one, and beside the designed one for a
    /// roller of another radius.
    pub fn at(&self, lambda_m: f64) -> Place {
        match &self.corner {
            Some(corner) if lambda_m < corner.lambda_m => {
                Circle::continuing(&self.beside(corner.lambda_m), corner.lambda_m, self.roller_m, self.cut.sense()).at(lambda_m)
            }
            _ => self.beside(lambda_m),
        }
    }

    /// The designed path, beside it for a roller of another radius.
    fn beside(&self, lambda_m: f64) -> Place {
        let swell_m = self.roller_m - self.cut_roller_m;
        if swell_m == 0.0 { self.cut.place(lambda_m) } else { beside(self.cut.point(lambda_m), [swell_m, 0.0, 0.0], self.cut.sense()) }
    }

    /// Finds the place of the path that a turn of the disc brings under the right roller.
    ///
    /// # Errors
    /// [`NotAssembled`] where there is none.
    pub fn pose(&self, turn_rad: f64) -> Result<Pose, NotAssembled> {
        let (sin, cos) = maths::sin_cos(turn_rad);
        // Turned with the disc: on the guide the second coordinate is zero.
        let turned = |[x, y]: Vector| [cos * x - sin * y, sin * x + cos * y];
        let scale = 2.0 * self.cut.purpose().start_radius_m;
        let mut lambda = self.cut.expected_m(turn_rad);
        let (mut place, mut gap) = (self.at(lambda), f64::INFINITY);
        let mut evaluations = 1;
        while evaluations < MOST_STEPS {
            let at = turned(place.at);
            gap = at[1];
            let change = (gap / turned(place.slope)[1]).clamp(-0.05 * scale, 0.05 * scale);
            if !change.is_finite() || change.abs() < 2e-16 * scale || gap.abs() < 4.0 * f64::EPSILON * at[0].abs() {
                break;
            }
            lambda -= change;
            place = self.at(lambda);
            evaluations += 1;
        }
        let radius = turned(place.at)[0];
        if gap.abs() < 1e-12 * scale && radius > 0.0 {
            let radius_m = Self::radius(radius, turned(place.slope), turned(place.bend));
            return Ok(Pose { turn_rad, lambda_m: lambda, place, radius_m, evaluations });
        }
        Err(NotAssembled { gap_m: gap })
    }

    /// ρ and its derivatives over θ from those of the path over λ, turned onto the guide.
    fn radius(radius: f64, slope: Vector, bend: Vector) -> [f64; 3] {
        let (first, turn) = (slope[0], -slope[1] / radius);
        // x″ = ρ_λλ − ρ θ_λ², y″ = −(2 ρ_λ θ_λ + ρ θ_λλ).
        let second = bend[0] + radius * turn * turn;
        let turning = -(bend[1] + 2.0 * first * turn) / radius;
        [radius, first / turn, (second - first / turn * turning) / (turn * turn)]
    }

    /// Forces at rest at a position that was found.
    pub fn at_rest(&self, pose: &Pose, sense: Sense) -> Instant {
        self.forces(pose, [0.0; 2], sense)
    }

    /// Forces in a motion of the disc at a position that was found. Friction acts against the turn that the sense says; where it locks the
    /// rollers there are no forces, and they are not numbers.
    pub fn forces(&self, pose: &Pose, [speed, acceleration]: Drive, sense: Sense) -> Instant {
        let b = &self.bodies;
        let [radius, first, second] = pose.radius_m;
        let spring_m = 2.0 * radius;
        let [spring_n, _] = self.springs.tension_n(spring_m);
        let [along, normal] = frame(&pose.place, self.cut.sense());
        let (sin, cos) = maths::sin_cos(pose.turn_rad);
        let turned = |[x, y]: Vector| [cos * x - sin * y, sin * x + cos * y];
        let ([t_r, t_a], [n_r, n_a]) = (turned(along), turned(normal));
        // Where the disc stands still, a finite acceleration needs no ρ″.
        let outwards = if speed == 0.0 && acceleration == 0.0 { 0.0 } else { first * acceleration + second * speed * speed };
        let spring_kg = match b.springs {
            SpringMass::Bar => self.springs.mass_kg() / 6.0,
            SpringMass::Halves => self.springs.mass_kg() / 2.0,
        };
        let needed = spring_n + (b.follower_kg + b.roller_kg + spring_kg) * outwards;
        let spin = self.spin(pose, [t_r, t_a], [speed, acceleration]);
        let rim = b.roller_kg_m2 * spin / self.roller_m * self.springs.sense();
        let way = match sense {
            Sense::Up => 1.0,
            Sense::Down => -1.0,
            Sense::Frictionless => 0.0,
        };
        // N (n − μ t) + rim t along the guide, and friction μ_g of what is across it, against the way of the follower.
        let out = way * self.springs.sense();
        let solve = |friction: f64, guide: f64| {
            let (a_r, a_a) = (n_r - friction * t_r, n_a - friction * t_a);
            let one = |sign: f64| {
                let normal = (needed - rim * t_r + out * guide * sign * rim * t_a) / (a_r - out * guide * sign * a_a);
                (normal, normal * a_a + rim * t_a)
            };
            let (up, down) = (one(1.0), one(-1.0));
            if up.1 >= 0.0 { Some(up) } else { Some(down).filter(|(_, across)| *across <= 0.0) }
        };
        let (mut friction, guide) = (way * self.friction(), self.guide_friction);
        let mut found = solve(friction, guide);
        if way != 0.0 && found.is_none_or(|(normal, _)| normal < 0.0) {
            // Either the cam would have to pull without friction as well, and resistance acts the other way; or friction alone turns its
            // force round: no torque moves the disc, it locks.
            let pulls = solve(0.0, 0.0).is_some_and(|(normal, _)| normal < 0.0);
            friction = -friction;
            found = if pulls { solve(friction, guide) } else { None };
        }
        let (normal_n, across) = found.unwrap_or([f64::NAN; 2].into());
        let torque_nm = b.disc_kg_m2 * acceleration + 2.0 * (radius * across + b.roller_kg_m2 * spin);
        Instant { torque_nm, normal_n, tangential_n: rim - friction * normal_n, guide_n: across, spring_n, spring_m }
    }

    /// Angular acceleration of the right roller, rad/s²: it turns with the disc, and rolls on it by the length of its path.
    fn spin(&self, pose: &Pose, along: Vector, [speed, acceleration]: Drive) -> f64 {
        if self.bodies.roller_kg_m2 == 0.0 || (speed == 0.0 && acceleration == 0.0) {
            return 0.0;
        }
        let [radius, first, second] = pose.radius_m;
        // The path over the turn, turned onto the guide: (ρ′, −ρ), then (ρ″ − ρ, −2ρ′).
        let length = maths::hypot(first, radius);
        let rate = dot(along, [second - radius, -2.0 * first]);
        acceleration - self.springs.sense() * (length * acceleration + rate * speed * speed) / self.roller_m
    }
}
