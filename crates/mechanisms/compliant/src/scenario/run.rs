//! Forces of a tip that is drawn along a surface, without inertia.
//!
//! The tip moves in the sense σ = ±1 along a way of angle α; the surface pushes it by N along its normal and by the friction μN against the
//! motion. On the block along its guide: A = N(cos α − σμ sin α) from the surface, F(Δ) from the mechanism, and the friction m|T| of the
//! bearings against its motion, where T = N(sin α + σμ cos α) is what they and the stage take sideways and m is the drag of the guide.
//! With e = 1 where the block retracts, −1 where it comes out, A = F + e·m|T|, so
//!
//! N = F/(cos α − σμ sin α − e·m|sin α + σμ cos α|).
//!
//! Where that is not positive no force moves the tip: it locks. At a constant height the friction of the bearings is anywhere between both
//! signs; it stays what it was until the stage turns, when T passes zero and the block finds its balance without friction.

use forcewright_base::maths::hypot;
use forcewright_base::roots;

use super::Surface;
use super::path::Stretch;
use crate::force_curve::ForceCurve;

/// Stations of a pass, at least.
const STATIONS: f64 = 512.0;
/// Part of a pass below which a constant height is not shown.
const SHORTEST_FLAT: f64 = 1e-6;

/// Forces at a position. SI.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Contact {
    /// Position of the tip along the surface.
    pub position_m: f64,
    /// Displacement Δ of the mechanism: not positive where the tip does not touch.
    pub delta_m: f64,
    /// Force F(Δ) of the mechanism; zero where the tip does not touch, as the forces below.
    pub elastic_n: f64,
    /// Contact force along the guide, A.
    pub axial_n: f64,
    /// Contact force along the normal of the surface, N.
    pub normal_n: f64,
    /// Force of the stage on the mechanism, T: positive towards larger positions.
    pub transverse_n: f64,
}

/// What the forces are at a constant height, between the full friction of the bearings in both senses. SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flat {
    /// Where it begins and ends, m.
    pub extent_m: [f64; 2],
    /// Least and largest contact force, N.
    pub axial_n: [f64; 2],
}

/// Why the stage goes no further.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Why {
    /// No transverse force moves the tip up the slope.
    Locks,
    /// The force over the displacement is known no further.
    Beyond,
    /// The mechanism no longer pushes the tip out.
    LetsGo,
}

/// Where the stage goes no further.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stop {
    /// Position, m.
    pub position_m: f64,
    /// Slope of the tip's way there, in the sense of the motion.
    pub slope: f64,
    /// Why.
    pub why: Why,
}

/// Once along the surface.
#[derive(Clone, Debug, Default)]
pub struct Pass {
    /// States in the order of the motion; at a corner two at one position.
    pub states: Vec<Contact>,
    /// Work of the stage, J.
    pub work_j: f64,
    /// Way in contact, m.
    pub contact_m: f64,
    /// Integral of the contact force over the way, N·m.
    pub axial_j: f64,
    /// Smallest and largest contact force in contact, N.
    pub axial_n: [f64; 2],
    /// Largest transverse force, N.
    pub transverse_n: f64,
    /// Where the tip first leaves the surface, m.
    pub lifts_at_m: Option<f64>,
}

/// What happens along a surface.
#[derive(Clone, Debug)]
pub struct SurfaceRun {
    /// Towards larger positions.
    pub forth: Pass,
    /// Back again, where that is asked for and the stage came to the end.
    pub back: Option<Pass>,
    /// Where the stage goes no further.
    pub stop: Option<Stop>,
    /// Stretches of constant height at which friction leaves the force open.
    pub flats: Vec<Flat>,
}

impl SurfaceRun {
    /// Draws the tip along the surface; the force over the displacement is known up to `reach_m`.
    pub fn of(surface: &Surface, curve: &ForceCurve, reach_m: f64) -> Self {
        let driver = Driver { surface, curve, reach_m };
        let (forth, stop) = driver.pass(1.0);
        let back = (surface.there_and_back && stop.is_none()).then(|| driver.pass(-1.0));
        let (back, stop_back) = back.map_or((None, None), |(pass, stop)| (Some(pass), stop));
        Self { forth, back, stop: stop.or(stop_back), flats: driver.flats() }
    }

    /// There, and back where the stage comes back.
    pub fn passes(&self) -> impl Iterator<Item = &Pass> {
        [Some(&self.forth), self.back.as_ref()].into_iter().flatten()
    }

    /// Smallest and largest contact force, N; `None` where the stage does not come to its end or the tip never touches.
    pub fn axial_n(&self) -> Option<[f64; 2]> {
        let whole = self.stop.is_none() && self.passes().any(|p| p.contact_m > 0.0);
        let touching = self.passes().filter(|p| p.contact_m > 0.0);
        let both = touching.fold([f64::INFINITY, f64::NEG_INFINITY], |[lo, hi], p| [lo.min(p.axial_n[0]), hi.max(p.axial_n[1])]);
        whole.then_some(both)
    }

    /// Mean of the contact force over the way in contact, N; `None` as [`Self::axial_n`].
    pub fn mean_n(&self) -> Option<f64> {
        self.axial_n()?;
        let (force, way) = self.passes().fold((0.0, 0.0), |(f, w), p| (f + p.axial_j, w + p.contact_m));
        Some(force / way)
    }

    /// Largest transverse force, N; `None` as [`Self::axial_n`].
    pub fn transverse_n(&self) -> Option<f64> {
        self.axial_n()?;
        Some(self.passes().map(|p| p.transverse_n).fold(0.0, f64::max))
    }

    /// Work of the stage, J.
    pub fn work_j(&self) -> f64 {
        self.passes().map(|p| p.work_j).sum()
    }

    /// Where the tip first leaves the surface, m.
    pub fn lifts_at_m(&self) -> Option<f64> {
        self.passes().find_map(|p| p.lifts_at_m)
    }
}

/// How the tip moves: σ along the surface, e of the block along its guide.
#[derive(Clone, Copy)]
struct Motion {
    along: f64,
    retracting: f64,
}

struct Driver<'a> {
    surface: &'a Surface,
    curve: &'a ForceCurve,
    reach_m: f64,
}

impl Driver<'_> {
    /// The forces at a position of a stretch.
    fn contact(&self, stretch: &Stretch, x: f64, motion: Motion) -> Result<Contact, Stop> {
        let touch = self.surface.path.within(stretch, x);
        let delta_m = self.surface.preload_m + touch.height_m;
        let free = Contact { position_m: x, delta_m, ..Contact::default() };
        // A displacement that is zero but for rounding.
        if delta_m <= 1e-12 * self.reach_m {
            return Ok(free);
        }
        let stop = |why| Err(Stop { position_m: x, slope: motion.along * touch.slope, why });
        if delta_m > self.reach_m * (1.0 + 1e-12) {
            return stop(Why::Beyond);
        }
        let elastic_n = self.curve.force(delta_m);
        if elastic_n <= 0.0 {
            return stop(Why::LetsGo);
        }
        let steep = hypot(1.0, touch.slope);
        let (sin, cos) = (touch.slope / steep, 1.0 / steep);
        let friction = motion.along * self.surface.tip_friction;
        let (up, aside) = (cos - friction * sin, sin + friction * cos);
        let share = up - motion.retracting * self.surface.guide_drag() * aside.abs();
        let normal_n = elastic_n / share;
        if share <= 0.0 || !normal_n.is_finite() {
            return stop(Why::Locks);
        }
        Ok(Contact { elastic_n, axial_n: normal_n * up, normal_n, transverse_n: normal_n * aside, ..free })
    }

    /// Positions of a stretch in the order of the motion: equal parts, and where the tip leaves or reaches the surface.
    fn stations(&self, stretch: &Stretch, along: f64) -> Vec<f64> {
        let (from, to) = if along > 0.0 { (stretch.from_m, stretch.to_m) } else { (stretch.to_m, stretch.from_m) };
        let [first, last] = self.surface.path.profile().extent_m();
        // Equal stretches have equally many parts, whatever the rounding of their lengths.
        let parts = (STATIONS * (to - from).abs() / (last - first) - 1e-6).ceil().max(2.0);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most the stations of a pass")]
        let parts = parts as usize;
        let mut all: Vec<f64> = (0..parts).map(|i| from + (to - from) * i as f64 / parts as f64).collect();
        all.push(to);
        let delta = |x: f64| self.surface.preload_m + self.surface.path.within(stretch, x).height_m;
        if let Some(i) = all.windows(2).position(|p| (delta(p[0]) > 0.0) != (delta(p[1]) > 0.0))
            && let Ok(touches) = roots::root(delta, all[i], all[i + 1], 1e-15)
        {
            all.insert(i + 1, touches);
        }
        all
    }

    /// Once along the surface, in a sense.
    fn pass(&self, along: f64) -> (Pass, Option<Stop>) {
        let mut pass = Pass { axial_n: [f64::INFINITY, f64::NEG_INFINITY], ..Pass::default() };
        let stretches = self.surface.path.stretches();
        let mut motion = Motion { along, retracting: 0.0 };
        let ordered: Box<dyn Iterator<Item = &Stretch>> =
            if along > 0.0 { Box::new(stretches.iter()) } else { Box::new(stretches.iter().rev()) };
        let mut stop = None;
        for stretch in ordered {
            if stretch.rise.abs() > 0.0 {
                motion.retracting = along * stretch.rise;
            }
            stop = self.follow(stretch, motion, &mut pass);
            if stop.is_some() {
                break;
            }
        }
        if pass.contact_m <= 0.0 {
            pass.axial_n = [0.0; 2];
        }
        (pass, stop)
    }

    /// Along one stretch.
    fn follow(&self, stretch: &Stretch, motion: Motion, pass: &mut Pass) -> Option<Stop> {
        let stations = self.stations(stretch, motion.along);
        let at = |x: f64| self.contact(stretch, x, motion);
        let mut left = match at(stations[0]) {
            Ok(contact) => contact,
            Err(stop) => return Some(stop),
        };
        pass.states.push(left);
        // Stations and middles, for the extremes.
        let mut values = vec![left];
        let mut ended = None;
        for pair in stations.windows(2) {
            let (x, mut to) = (pair[0], pair[1]);
            let failed = [f64::midpoint(x, to), to].into_iter().find(|x| at(*x).is_err());
            if let Some(failed) = failed {
                let (good, stop) = self.last_before(stretch, motion, [x, failed]);
                ended = stop;
                to = good;
            }
            if let (Ok(middle), Ok(right)) = (at(f64::midpoint(x, to)), at(to)) {
                pass.add([left, middle, right]);
                values.extend([middle, right]);
                left = right;
            }
            if ended.is_some() {
                break;
            }
        }
        // The force vanishes where the tip leaves: that place belongs to the contact.
        let touching: Vec<Contact> = values.into_iter().filter(|v| v.delta_m > -1e-9 * self.reach_m).collect();
        pass.extremes(&touching, |x| at(x).ok());
        ended
    }

    /// The last position with a contact before one without, and why there is none beyond.
    fn last_before(&self, stretch: &Stretch, motion: Motion, [mut good, mut failed]: [f64; 2]) -> (f64, Option<Stop>) {
        let mut stop = self.contact(stretch, failed, motion).err();
        // Halved until nothing lies between.
        for _ in 0..64 {
            let middle = f64::midpoint(good, failed);
            match self.contact(stretch, middle, motion) {
                Ok(_) => good = middle,
                Err(earlier) => (failed, stop) = (middle, Some(earlier)),
            }
        }
        (good, stop)
    }

    /// Constant heights at which the friction of the bearings leaves the force open.
    fn flats(&self) -> Vec<Flat> {
        let [first, last] = self.surface.path.profile().extent_m();
        let open = self.surface.guide_drag() * self.surface.tip_friction;
        let long = |s: &&Stretch| s.rise.abs() <= 0.0 && s.to_m - s.from_m > SHORTEST_FLAT * (last - first);
        let one = |s: &Stretch| {
            let rest = self.contact(s, f64::midpoint(s.from_m, s.to_m), Motion { along: 1.0, retracting: 0.0 }).ok()?;
            let band = Flat { extent_m: [s.from_m, s.to_m], axial_n: [rest.elastic_n / (1.0 + open), rest.elastic_n / (1.0 - open)] };
            (open > 0.0 && open < 1.0 && rest.elastic_n > 0.0).then_some(band)
        };
        self.surface.path.stretches().iter().filter(long).filter_map(one).collect()
    }
}

impl Pass {
    /// Adds the way between two states, with the one in the middle: integrals by Simpson's rule.
    fn add(&mut self, [left, middle, right]: [Contact; 3]) {
        let way = right.position_m - left.position_m;
        let integral = |f: fn(&Contact) -> f64| way / 6.0 * (f(&left) + 4.0 * f(&middle) + f(&right));
        self.work_j += integral(|c| c.transverse_n);
        if middle.delta_m > 0.0 {
            self.contact_m += way.abs();
            self.axial_j += integral(|c| c.axial_n).abs();
        } else if way.abs() > 0.0 && self.lifts_at_m.is_none() {
            self.lifts_at_m = Some(left.position_m);
        }
        self.states.push(right);
    }

    /// Extremes of a stretch, refined where they lie between its states.
    fn extremes(&mut self, states: &[Contact], at: impl Fn(f64) -> Option<Contact>) {
        let refined = |value: fn(&Contact) -> f64| -> Option<f64> {
            let best = (0..states.len()).reduce(|b, i| if value(&states[i]) > value(&states[b]) { i } else { b })?;
            let own = value(&states[best]);
            if best == 0 || best + 1 == states.len() {
                return Some(own);
            }
            let (l, r) = (states[best - 1].position_m, states[best + 1].position_m);
            let lost = |x: f64| at(x).map_or(f64::NAN, |c| -value(&c));
            let found = roots::minimise(lost, l.min(r), l.max(r), 1e-9 * (r - l).abs());
            Some(if -found.value > own { -found.value } else { own })
        };
        if let (Some(largest), Some(least), Some(aside)) =
            (refined(|c| c.axial_n), refined(|c| -c.axial_n), refined(|c| c.transverse_n.abs()))
        {
            self.axial_n = [self.axial_n[0].min(-least), self.axial_n[1].max(largest)];
            self.transverse_n = self.transverse_n.max(aside);
        }
    }
}
