//! The path of a roller's centre on the cam as it was made: what it was cut for, moved and with its errors, and where the cam is
//! undercut the corner on which the roller turns.

use std::sync::{Arc, OnceLock};

use forcewright_base::maths;

use crate::cut::{Cut, SIDES};
use crate::jet::Jet;

/// A plane vector.
pub type Vector = [f64; 2];

/// A deviation along the normal of a cam, over the arc length of the roller's path.
pub trait NormalError: Send + Sync + std::fmt::Debug {
    /// Deviation outwards (away from the cam), m, and its first two derivatives over the arc length.
    fn at(&self, arc_m: f64) -> [f64; 3];
}

/// A point of a path with its derivatives over λ.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// Outwards and along the travel, m.
    pub at: Vector,
    /// First derivative.
    pub slope: Vector,
    /// Second derivative, 1/m.
    pub bend: Vector,
}

/// Corner of an undercut cam: below it the roller turns about it.
#[derive(Clone, Copy, Debug)]
pub struct Corner {
    /// λ where the roller comes to it, m.
    pub lambda_m: f64,
    /// Travel s there, m.
    pub travel_m: f64,
    /// The corner itself in the coordinates of the cut, m.
    pub at: Vector,
}

/// The path of one side.
#[derive(Clone, Debug)]
pub struct SidePath {
    cut: Arc<Cut>,
    side: usize,
    roller_m: f64,
    corner: Option<Corner>,
    /// Of the path as designed: found when an error first asks for it, and shared by all copies.
    arc: Arc<OnceLock<ArcLength>>,
    error: Option<Arc<dyn NormalError>>,
    /// Cosine and sine of the angle by which it is turned about the origin, towards the axis.
    turn: Vector,
    /// By how much it is shifted afterwards, m.
    shift_m: Vector,
    /// By how much it lies further from the cam than it was meant, m.
    swell_m: f64,
    /// How the roller turns about the corner, before the path is turned and shifted.
    circle: Option<Circle>,
}

/// A circle that continues the path below its corner without a kink.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Circle {
    /// λ where it begins, m.
    lambda_m: f64,
    /// The corner, m.
    centre: Vector,
    /// From the corner to the roller's centre where it begins, m.
    from: Vector,
    /// Angle over λ, rad/m.
    rate: f64,
}

/// What a small error of the profile does to a point of the path at its λ.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sway {
    /// Arc length at which the error counts, m.
    pub arc_m: f64,
    /// Change of the point per error, and per slope of the error over the arc length, m.
    pub at: [Vector; 2],
    /// Change of the first derivative over λ.
    pub slope: [Vector; 2],
}

/// Arc length of the path as designed, by λ: only errors of the profile need it.
#[derive(Debug)]
pub(crate) struct ArcLength {
    /// λ, m; arc length, m; its slope.
    rows: Vec<[f64; 3]>,
}

/// What is wrong with a side.
#[derive(Clone, Debug, Default)]
pub struct Flaws {
    /// Angle by which the profile is turned about the origin, counted outwards to inwards, rad.
    pub turn_rad: f64,
    /// By how much it is shifted outwards and along the travel, m.
    pub shift_m: Vector,
    /// By how much the roller's centre runs further out than the one for which the cam was cut, along the normal: a larger roller, m.
    pub swell_m: f64,
    /// Deviation of the profile along its normal.
    pub error: Option<Arc<dyn NormalError>>,
}

/// Rows of the table of arc length.
const ARC_ROWS: usize = 512;
/// Places looked at for an undercut.
const LOOKS: usize = 400;

impl SidePath {
    /// The path of a roller of this radius on a side of the cam.
    pub fn new(cut: Arc<Cut>, side: usize, roller_m: f64, flaws: &Flaws) -> Self {
        Self::flawless(cut, side, roller_m).with(flaws)
    }

    /// Both paths of a cam for rollers of this radius, as they were meant. What takes time is done here once for all cams that are made
    /// to these paths: see [`Self::with`].
    pub fn both(cut: &Arc<Cut>, roller_m: f64) -> [Self; SIDES] {
        let right = Self::flawless(Arc::clone(cut), 0, roller_m);
        let [a, b] = &cut.purpose().sides;
        let left = if a == b { Self { side: 1, ..right.clone() } } else { Self::flawless(Arc::clone(cut), 1, roller_m) };
        [right, left]
    }

    fn flawless(cut: Arc<Cut>, side: usize, roller_m: f64) -> Self {
        let corner = corner(&cut, side, roller_m);
        Self {
            cut,
            side,
            roller_m,
            corner,
            arc: Arc::default(),
            error: None,
            turn: [1.0, 0.0],
            shift_m: [0.0; 2],
            swell_m: 0.0,
            circle: None,
        }
        .with(&Flaws::default())
    }

    /// The same path with these flaws instead of its own.
    #[must_use]
    pub fn with(&self, flaws: &Flaws) -> Self {
        let (sin, cos) = maths::sin_cos(flaws.turn_rad);
        let mut made = Self {
            error: flaws.error.clone(),
            turn: [cos, sin],
            shift_m: flaws.shift_m,
            swell_m: flaws.swell_m,
            circle: None,
            ..self.clone()
        };
        made.circle = made.corner.map(|corner| made.circle_from(corner.lambda_m));
        made
    }

    /// Length of the path as it was designed and a tenth beyond, m: on it errors of the profile are given.
    pub fn length_m(&self) -> f64 {
        self.arc().rows.last().map_or(0.0, |row| row[1])
    }

    pub(crate) fn arc(&self) -> &ArcLength {
        self.arc.get_or_init(|| ArcLength::of(&self.cut, self.side))
    }

    /// Where the cam is undercut; `None` if it is not.
    pub fn corner(&self) -> Option<&Corner> {
        self.corner.as_ref()
    }

    /// Deviation of the profile along its normal, m; `None` where it has none.
    pub fn error_m(&self, lambda_m: f64) -> Option<f64> {
        self.error.as_ref().map(|error| error.at(self.arc().at(lambda_m))[0])
    }

    /// What it was cut for.
    pub fn cut(&self) -> &Cut {
        &self.cut
    }

    pub(crate) fn shared_cut(&self) -> &Arc<Cut> {
        &self.cut
    }

    /// Whether two sides are alike.
    pub fn is_like(&self, other: &Self) -> bool {
        let purpose = self.cut.purpose();
        let same = |a: &Vector, b: &Vector| a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits());
        purpose.sides[0] == purpose.sides[1]
            && self.swell_m.to_bits() == other.swell_m.to_bits()
            && self.error.is_none()
            && other.error.is_none()
            && same(&self.turn, &other.turn)
            && same(&self.shift_m, &other.shift_m)
    }

    /// The point of the path as it is made.
    #[inline]
    pub fn at(&self, lambda_m: f64) -> Place {
        let place = match &self.circle {
            Some(circle) if lambda_m < circle.lambda_m => circle.at(lambda_m),
            _ => self.on_profile(lambda_m),
        };
        let [x, y] = self.turned(place.at);
        Place { at: [x + self.shift_m[0], y + self.shift_m[1]], slope: self.turned(place.slope), bend: self.turned(place.bend) }
    }

    fn turned(&self, [x, y]: Vector) -> Vector {
        let [cos, sin] = self.turn;
        [cos * x - sin * y, sin * x + cos * y]
    }

    /// What a further small error of the profile would do.
    pub(crate) fn sway(&self, lambda_m: f64) -> Sway {
        let on_circle = self.circle.filter(|circle| lambda_m < circle.lambda_m);
        let lambda = on_circle.map_or(lambda_m, |circle| circle.lambda_m);
        let designed = self.designed(lambda);
        let sense = self.cut.purpose().springs.sense();
        let [along, normal] = frame(&designed, sense);
        let speed = length(designed.slope);
        // The normal turns as the tangent does.
        let stretch = along[0] * designed.bend[0] + along[1] * designed.bend[1];
        let turning = [designed.bend[0] - along[0] * stretch, designed.bend[1] - along[1] * stretch];
        let turning = [sense * turning[1] / speed, -sense * turning[0] / speed];
        let (mut at, mut slope) = ([normal, [0.0; 2]], [turning, normal.map(|n| n * speed)]);
        if on_circle.is_some() {
            // The corner follows the end of the profile and lies behind it along the normal there.
            let own = length(self.on_profile(lambda).slope);
            let back = (self.roller_m + self.swell_m) * speed / own;
            (at[1], slope) = (along.map(|t| back * t), [[0.0; 2]; 2]);
        }
        Sway { arc_m: self.arc().at(lambda), at: at.map(|v| self.turned(v)), slope: slope.map(|v| self.turned(v)) }
    }

    /// The path on the profile with its errors.
    #[inline]
    fn on_profile(&self, lambda_m: f64) -> Place {
        match &self.error {
            None if self.swell_m == 0.0 => self.designed(lambda_m),
            None => self.deviating(lambda_m, [self.swell_m, 0.0, 0.0]),
            Some(error) => {
                let [e, slope, bend] = error.at(self.arc().at(lambda_m));
                self.deviating(lambda_m, [e + self.swell_m, slope, bend])
            }
        }
    }

    /// The path as it was meant, also where the cam that it needs is undercut.
    #[inline]
    pub fn designed(&self, lambda_m: f64) -> Place {
        let p = self.cut.at(self.side, lambda_m);
        place([p.x, p.y])
    }

    /// The roller turns about the corner: the circle that continues the path without a kink. The corner lies where the profile with its
    /// errors ends, a roller's radius behind the path.
    fn circle_from(&self, lambda_m: f64) -> Circle {
        let sense = self.cut.purpose().springs.sense();
        Circle::continuing(&self.on_profile(lambda_m), lambda_m, self.roller_m + self.swell_m, sense)
    }

    /// The path with a deviation along its normal, given with its derivatives over the arc length.
    fn deviating(&self, lambda_m: f64, error: [f64; 3]) -> Place {
        let p = self.cut.at(self.side, lambda_m);
        beside([p.x, p.y], error, self.cut.purpose().springs.sense())
    }
}

/// A path shifted along its normal, by a deviation given with its derivatives over the arc length.
pub(crate) fn beside([x, y]: [Jet; 2], [e0, e1, e2]: [f64; 3], sense: f64) -> Place {
    let lower = |j: Jet| Jet([j.derivative(1), j.derivative(2), 0.5 * j.derivative(3), 0.0]);
    let (dx, dy) = (lower(x), lower(y));
    let speed = (dx * dx + dy * dy).sqrt();
    // e as a series in λ: its arguments are arc lengths.
    let [v, dv] = [speed.value(), speed.derivative(1)];
    let e = Jet([e0, e1 * v, 0.5 * (e2 * v * v + e1 * dv), 0.0]);
    let [nx, ny] = [dy / speed * sense, dx / speed * -sense];
    place([x + e * nx, y + e * ny])
}

/// A place of a path given by its coordinates.
pub(crate) fn place([x, y]: [Jet; 2]) -> Place {
    let pick = |order: usize| [x.derivative(order), y.derivative(order)];
    Place { at: pick(0), slope: pick(1), bend: pick(2) }
}

impl Circle {
    /// About the corner, a roller's radius behind the path, where a path ends at λ.
    pub(crate) fn continuing(join: &Place, lambda_m: f64, radius_m: f64, sense: f64) -> Self {
        let [_, normal] = frame(join, sense);
        let from = [radius_m * normal[0], radius_m * normal[1]];
        let sign = (from[0] * join.slope[1] - from[1] * join.slope[0]).signum();
        let centre = [join.at[0] - from[0], join.at[1] - from[1]];
        Self { lambda_m, centre, from, rate: length(join.slope) / radius_m * sign }
    }

    pub(crate) fn at(&self, lambda_m: f64) -> Place {
        let Self { centre, from, rate, .. } = *self;
        let (sin, cos) = maths::sin_cos(rate * (lambda_m - self.lambda_m));
        let arm = [cos * from[0] - sin * from[1], sin * from[0] + cos * from[1]];
        Place {
            at: [centre[0] + arm[0], centre[1] + arm[1]],
            slope: [-rate * arm[1], rate * arm[0]],
            bend: [-rate * rate * arm[0], -rate * rate * arm[1]],
        }
    }
}

/// Length of a vector whose square neither overflows nor vanishes.
pub(crate) fn length([x, y]: Vector) -> f64 {
    (x * x + y * y).sqrt()
}

/// Curvature of the path at a point, 1/m: positive where the cam is convex there.
pub fn curvature_per_m(place: &Place, sense: f64) -> f64 {
    let [dx, dy] = place.slope;
    let speed = length(place.slope);
    sense * (dx * place.bend[1] - dy * place.bend[0]) / (speed * speed * speed)
}

/// Unit vectors along the path and from the cam to the roller.
pub fn frame(place: &Place, sense: f64) -> [Vector; 2] {
    let [dx, dy] = place.slope;
    let over = 1.0 / length(place.slope);
    let along = [dx * over, dy * over];
    [along, [sense * along[1], -sense * along[0]]]
}

/// The last place at which the roller is larger than the path's radius of curvature: below it the cam that would be needed does not
/// exist (1 − r κ < 0).
pub(crate) fn corner(cut: &Cut, side: usize, roller_m: f64) -> Option<Corner> {
    let place = |lambda: f64| {
        let p = cut.at(side, lambda);
        place([p.x, p.y])
    };
    let (lambda_m, at) = corner_of(place, cut.range_m(), roller_m, cut.purpose().springs.sense())?;
    Some(Corner { lambda_m, travel_m: cut.at(side, lambda_m).s.value(), at })
}

/// The same of any path: λ, and the corner itself. A path that is hollow towards its roller (κ < 0) is never undercut.
pub(crate) fn corner_of(place: impl Fn(f64) -> Place, [from, to]: [f64; 2], roller_m: f64, sense: f64) -> Option<(f64, Vector)> {
    let left = |lambda: f64| 1.0 - roller_m * curvature_per_m(&place(lambda), sense);
    let at = |i: usize| from + (to - from) * i as f64 / LOOKS as f64;
    // Closer together next to the start, where curvature is largest.
    let dense = |i: usize| from + (at(1) - from) * i as f64 / LOOKS as f64;
    let looks: Vec<f64> = (0..LOOKS).map(dense).chain((1..=LOOKS).map(at)).collect();
    let last = looks.iter().rposition(|l| left(*l) < 0.0)?;
    let lambda_m = match looks.get(last + 1) {
        Some(next) => forcewright_base::roots::root(left, looks[last], *next, 1e-16).ok()?,
        None => to,
    };
    let p = place(lambda_m);
    let [_, normal] = frame(&p, sense);
    let at = [p.at[0] - roller_m * normal[0], p.at[1] - roller_m * normal[1]];
    Some((lambda_m, at))
}

impl ArcLength {
    pub(crate) fn of(cut: &Cut, side: usize) -> Self {
        let [from, to] = cut.range_m();
        let end = to + 0.1 * (to - from);
        let speed = |lambda: f64| {
            let p = cut.at(side, lambda);
            length([p.x.derivative(1), p.y.derivative(1)])
        };
        let gauss = forcewright_base::quadrature::GaussLegendre::new(5);
        let mut rows = vec![[from, 0.0, speed(from)]];
        for i in 1..=ARC_ROWS {
            let (a, b) = (rows[i - 1][0], from + (end - from) * i as f64 / ARC_ROWS as f64);
            let length = gauss.integrate(|t| speed(a + (b - a) * t)) * (b - a);
            rows.push([b, rows[i - 1][1] + length, speed(b)]);
        }
        Self { rows }
    }

    pub(crate) fn at(&self, lambda_m: f64) -> f64 {
        let i = self.rows.partition_point(|r| r[0] <= lambda_m).clamp(1, self.rows.len() - 1);
        let ([a, sa, va], [b, sb, vb]) = (self.rows[i - 1], self.rows[i]);
        let h = b - a;
        let t = (lambda_m - a) / h;
        let u = 1.0 - t;
        sa * (1.0 + 2.0 * t) * u * u + sb * t * t * (3.0 - 2.0 * t) + h * t * u * (va * u - vb * t)
    }
}
