//! Profile shifts of a planetary set that keep clear of everything that is forbidden.
//!
//! The shifts of sun and planet are free. They give the centre distance, this the shift of the ring, and clearances, fillets and thin tips say
//! by how much the teeth must be shorter. Among what is left the shifts with the least specific sliding are chosen.
//!
//! ```
//! use forcewright_elements::gears::{planetary::Teeth, shift::ShiftWanted};
//!
//! // A sun of 12 teeth is undercut without shift.
//! let wanted = ShiftWanted::usual(Teeth::standard(12, 18), 3, 0.5e-3, 20e-6);
//! let shifted = wanted.solve()?;
//! assert!(shifted.set.sun_planet.pinion.spec.profile_shift > 0.298);
//! assert!(wanted.margins(&shifted.set).all(|(_, margin)| margin.holds()));
//!
//! let teeth_lose = shifted.set.train(0.1)?.reduced(0.1, 0.0)?.1;
//! assert!(teeth_lose > 0.95 && teeth_lose < 0.98);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use std::fmt;

use forcewright_base::maths::{acos, cos, hypot, sin, tan};
use forcewright_base::roots;

use super::interference::{Condition, Margin, Unit, least_shift, mesh_margins, wheel_margins};
use super::mesh::tangent_m;
use super::planetary::{PlanetarySet, Teeth};
use super::{GearError, Kind, Mesh, Rack, Wheel, WheelSpec, corner, fillet, inverse_involute, involute};

/// Shifts of external gears that are tried, modules.
const SHIFTS: [f64; 2] = [-0.8, 1.4];
/// Steps of the grid on each axis.
const GRID: i32 = 24;
/// What limits are kept by, modules: rounding must not turn them.
const SPARE: f64 = 1e-9;

/// What a set with profile shift must keep to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShiftWanted {
    /// Numbers of teeth.
    pub teeth: Teeth,
    /// Number of planets; at least 1.
    pub planets: u32,
    /// Module, m; above 0.
    pub module_m: f64,
    /// Rack of all gears.
    pub rack: Rack,
    /// Backlash of both meshes along their working pitch circles, m; at least 0. The teeth of all gears are thinner for it.
    pub backlash_m: f64,
    /// Least thickness of the tips, modules; at least 0. Usual are 0.2, and 0.4 for hardened teeth.
    pub least_tip: f64,
    /// Least distance of tips from roots, modules.
    pub least_clearance: f64,
    /// Least contact ratio of both meshes; usual is 1.2.
    pub least_contact_ratio: f64,
    /// Least distance between the tips of neighbouring planets, m.
    pub least_gap_m: f64,
    /// Whether planets are to stand at equal angles.
    pub equal_angles: bool,
    /// Whether planets must go into the ring radially; else trimming is no fault.
    pub radial_assembly: bool,
}

/// Where a margin belongs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// The sun.
    Sun,
    /// A planet.
    Planet,
    /// The ring.
    Ring,
    /// Mesh of sun (the pinion) and planet (the wheel).
    SunPlanet,
    /// Mesh of planet (the pinion) and ring (the wheel).
    PlanetRing,
    /// The set.
    Set,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Sun => "sun",
            Self::Planet => "planet",
            Self::Ring => "ring",
            Self::SunPlanet => "sun and planet",
            Self::PlanetRing => "planet and ring",
            Self::Set => "set",
        })
    }
}

/// Why there are no such shifts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ShiftError {
    /// A number is not what its documentation asks for.
    Gear(GearError),
    /// Some condition fails whatever the shifts.
    Blocked {
        /// Where it fails with the shifts that come nearest to keeping all.
        place: Place,
        /// What fails there most, and by how much.
        margin: Margin,
        /// What else fails there: relief of the one worsens the other.
        against: Option<(Place, Margin)>,
    },
}

impl fmt::Display for ShiftError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Gear(error) => error.fmt(f),
            Self::Blocked { place, margin, against } => {
                f.write_str("no profile shift helps: ")?;
                write_lack(f, *place, margin)?;
                if let Some((place, margin)) = against {
                    f.write_str(", and ")?;
                    write_lack(f, *place, margin)?;
                }
                f.write_str("; take other numbers of teeth or ask for less")
            }
        }
    }
}

fn write_lack(f: &mut fmt::Formatter<'_>, place: Place, margin: &Margin) -> fmt::Result {
    let unit = match margin.condition.unit() {
        Unit::Metre => " m",
        Unit::Radian => " rad",
        Unit::One => "",
    };
    if margin.value.is_finite() {
        write!(f, "{} ({place}) misses by {:.3e}{unit}", margin.condition, -margin.value)
    } else {
        write!(f, "{} ({place}) is not to be had", margin.condition)
    }
}

impl std::error::Error for ShiftError {}

impl From<GearError> for ShiftError {
    fn from(error: GearError) -> Self {
        Self::Gear(error)
    }
}

/// A set with profile shifts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShiftedSet {
    /// Its gears, with shifts and shortened tips.
    pub set: PlanetarySet,
    /// Contact ratios of sun with planet and planet with ring.
    pub contact_ratios: [f64; 2],
    /// Largest specific sliding of all flanks.
    pub largest_sliding: f64,
}

impl ShiftWanted {
    /// A set with rack, clearances and tips as usual: ISO 53 A, tips of 0.2 modules, the clearance of the rack, a contact ratio of 1.2, planets
    /// at equal angles.
    pub fn usual(teeth: Teeth, planets: u32, module_m: f64, backlash_m: f64) -> Self {
        let rack = Rack::ISO_53_A;
        Self {
            teeth,
            planets,
            module_m,
            rack,
            backlash_m,
            least_tip: 0.2,
            least_clearance: rack.clearance(),
            least_contact_ratio: 1.2,
            least_gap_m: 0.0,
            equal_angles: true,
            radial_assembly: true,
        }
    }

    /// The shifts with the least specific sliding among those that keep all conditions, from a grid and a search with halved steps about its
    /// best point. Same numbers, same answer.
    ///
    /// # Errors
    /// [`ShiftError::Blocked`] if the search found none; it then has the condition that fails most where all come nearest to holding.
    pub fn solve(&self) -> Result<ShiftedSet, ShiftError> {
        self.search(Goal::Sliding)
    }

    /// As [`ShiftWanted::solve`], but where that is refused, the shifts with the largest contact ratio of the mesh that has less, if it is
    /// at least 1.
    ///
    /// # Errors
    /// [`ShiftError::Blocked`] if the search found none of these either.
    pub fn solve_reachable(&self) -> Result<ShiftedSet, ShiftError> {
        match self.solve() {
            Err(ShiftError::Blocked { .. }) => {
                Self { least_contact_ratio: self.least_contact_ratio.min(1.0), ..*self }.search(Goal::Contact)
            }
            other => other,
        }
    }

    fn search(&self, goal: Goal) -> Result<ShiftedSet, ShiftError> {
        self.check()?;
        if self.equal_angles && !self.teeth.fit_equally(self.planets) {
            let rest = (u64::from(self.teeth.sun) + u64::from(self.teeth.ring)) % u64::from(self.planets);
            return Err(blocked(Place::Set, Condition::Assembly, -(rest as f64)));
        }
        let low = [self.lowest(self.teeth.sun)?, self.lowest(self.teeth.planet)?];
        for (shift, place) in low.into_iter().zip([Place::Sun, Place::Planet]) {
            if shift >= SHIFTS[1] {
                return Err(blocked(place, Condition::Undercut, (SHIFTS[1] - shift) * self.module_m));
            }
        }
        let step = low.map(|least| (SHIFTS[1] - least) / f64::from(GRID));
        let mut best = self.judge(low, goal);
        for i in 0..=GRID {
            for j in 0..=GRID {
                best = better(best, self.judge([low[0] + f64::from(i) * step[0], low[1] + f64::from(j) * step[1]], goal));
            }
        }
        let best = self.refine(best, low, step, goal);
        match (best.outcome, self.set_of(best.shifts)) {
            (Outcome::Good { .. }, Some(set)) => {
                Ok(ShiftedSet { set, contact_ratios: contact_ratios(&set), largest_sliding: largest_sliding(&set) })
            }
            (Outcome::Bad { place, margin, against, .. }, _) => Err(ShiftError::Blocked { place, margin, against }),
            // Not reached: what was judged good is there.
            (Outcome::Good { .. }, None) => Err(blocked(Place::Set, Condition::Coaxial, 0.0)),
        }
    }

    /// All margins of a set of these teeth and racks.
    pub fn margins(&self, set: &PlanetarySet) -> impl Iterator<Item = (Place, Margin)> + use<> {
        let (tip_m, clearance_m) = (self.least_tip * self.module_m, self.least_clearance * self.module_m);
        let wheels = [(Place::Sun, set.sun_planet.pinion), (Place::Planet, set.planet_ring.pinion), (Place::Ring, set.planet_ring.wheel)];
        let meshes = [(Place::SunPlanet, set.sun_planet), (Place::PlanetRing, set.planet_ring)];
        let gap = Margin { condition: Condition::NeighbourGap, value: self.gap_m(set) - self.least_gap_m };
        let (least_ratio, radial) = (self.least_contact_ratio, self.radial_assembly);
        let of_wheels = wheels.into_iter().flat_map(move |(place, wheel)| wheel_margins(&wheel, tip_m).map(move |margin| (place, margin)));
        let of_meshes = meshes.into_iter().flat_map(move |(place, mesh)| {
            let path = mesh.path();
            let ratio = Margin { condition: Condition::ContactRatio, value: path.usable.length_m() / path.base_pitch_m - least_ratio };
            mesh_margins(&mesh, clearance_m)
                .filter(move |margin| radial || margin.condition != Condition::Trimming)
                .chain([ratio])
                .map(move |margin| (place, margin))
        });
        // Cheap ones that often fail come first.
        [(Place::Set, gap)].into_iter().chain(of_wheels).chain(of_meshes)
    }

    fn gap_m(&self, set: &PlanetarySet) -> f64 {
        if self.equal_angles { set.neighbour_gap_m() } else { set.nearest_neighbour_gap_m() }
    }

    fn check(&self) -> Result<(), GearError> {
        let numbers = [
            ("planets", f64::from(self.planets), self.planets >= 1),
            ("backlash_m", self.backlash_m, self.backlash_m >= 0.0),
            ("least_tip", self.least_tip, self.least_tip >= 0.0),
            ("least_clearance", self.least_clearance, true),
            ("least_contact_ratio", self.least_contact_ratio, self.least_contact_ratio >= 0.0),
            ("least_gap_m", self.least_gap_m, true),
            ("ring", f64::from(self.teeth.ring), self.teeth.ring > self.teeth.planet),
        ];
        if let Some((name, value, _)) = numbers.into_iter().find(|(_, value, good)| !(*good && value.is_finite())) {
            return Err(GearError::Value { name, value });
        }
        for teeth in [self.teeth.sun, self.teeth.planet, self.teeth.ring] {
            Wheel::new(self.spec(Kind::External, teeth, SHIFTS[1], 0.0))?;
        }
        Ok(())
    }

    fn spec(&self, kind: Kind, teeth: u32, profile_shift: f64, thinning_m: f64) -> WheelSpec {
        WheelSpec { kind, teeth, module_m: self.module_m, rack: self.rack, profile_shift, tip_shortening: 0.0, thinning_m }
    }

    /// Least shift without undercut, within what is tried.
    fn lowest(&self, teeth: u32) -> Result<f64, GearError> {
        let wheel = Wheel::new(self.spec(Kind::External, teeth, SHIFTS[1], 0.0))?;
        Ok((least_shift(&wheel) + SPARE).max(SHIFTS[0]))
    }

    /// Halves the steps about the best point until they no longer matter.
    fn refine(&self, mut best: Judged, low: [f64; 2], mut step: [f64; 2], goal: Goal) -> Judged {
        while step[0].max(step[1]) > 1e-5 {
            let centre = best.shifts;
            for (i, j) in [(-1.0, 0.0), (1.0, 0.0), (0.0, -1.0), (0.0, 1.0), (-1.0, -1.0), (1.0, 1.0), (-1.0, 1.0), (1.0, -1.0)] {
                let within = |value: f64, least: f64| value.clamp(least, SHIFTS[1].max(least));
                let shifts = [within(centre[0] + i * step[0], low[0]), within(centre[1] + j * step[1], low[1])];
                best = better(best, self.judge(shifts, goal));
            }
            if same(best.shifts, centre) {
                step = step.map(|length| length / 2.0);
            }
        }
        best
    }

    /// Builds the set of two shifts and looks at all margins.
    fn judge(&self, shifts: [f64; 2], goal: Goal) -> Judged {
        let bad = |place, margin, lacking, against| Judged { shifts, outcome: Outcome::Bad { place, margin, lacking, against } };
        let Some(set) = self.set_of(shifts) else {
            let margin = Margin { condition: Condition::Coaxial, value: f64::NEG_INFINITY };
            return bad(Place::Set, margin, f64::NEG_INFINITY, None);
        };
        let ring_teeth = f64::from(self.teeth.ring);
        let scaled = |margin: &Margin| match margin.condition.unit() {
            Unit::Metre => margin.value / self.module_m,
            Unit::Radian => margin.value * ring_teeth / 2.0,
            Unit::One => margin.value,
        };
        // The two that fail most.
        let mut failing: [Option<(Place, Margin, f64)>; 2] = [None; 2];
        for (place, margin) in self.margins(&set) {
            let value = scaled(&margin);
            let worse = |than: &Option<(Place, Margin, f64)>| than.as_ref().is_none_or(|(_, _, least)| value < *least);
            if value >= 0.0 {
                continue;
            }
            if worse(&failing[0]) {
                failing = [Some((place, margin, value)), failing[0]];
            } else if worse(&failing[1]) {
                failing[1] = Some((place, margin, value));
            }
        }
        if let Some((place, margin, lacking)) = failing[0] {
            return bad(place, margin, lacking, failing[1].map(|(place, margin, _)| (place, margin)));
        }
        let [first, second] = contact_ratios(&set);
        let cost = match goal {
            Goal::Sliding => largest_sliding(&set),
            Goal::Contact => -first.min(second),
        };
        Judged { shifts, outcome: Outcome::Good { cost } }
    }

    /// The set of these shifts of sun and planet, with a ring and tips that suit; none if there is no centre distance.
    fn set_of(&self, shifts: [f64; 2]) -> Option<PlanetarySet> {
        let m = self.module_m;
        let alpha_rad = self.rack.pressure_angle_rad;
        let [sun_teeth, planet_teeth, ring_teeth] = [self.teeth.sun, self.teeth.planet, self.teeth.ring].map(f64::from);
        let slope = 2.0 * tan(alpha_rad);
        let outer_rad = inverse_involute(involute(alpha_rad) + slope * (shifts[0] + shifts[1]) / (sun_teeth + planet_teeth));
        let centre_m = 0.5 * m * (sun_teeth + planet_teeth) * cos(alpha_rad) / cos(outer_rad);
        let base_m = 0.5 * m * (ring_teeth - planet_teeth) * cos(alpha_rad);
        if centre_m.is_nan() || centre_m <= base_m {
            return None;
        }
        let inner_rad = acos(base_m / centre_m);
        let ring_shift = shifts[1] + (involute(inner_rad) - involute(alpha_rad)) * (ring_teeth - planet_teeth) / slope;
        // A thickness on the reference circle grows by cos α / cos α' to the working one.
        let [outer_m, inner_m] = [outer_rad, inner_rad].map(|rad| self.backlash_m * cos(rad) / cos(alpha_rad));
        let planet_thinning_m = outer_m.min(inner_m) / 2.0;
        let sun = Wheel::new(self.spec(Kind::External, self.teeth.sun, shifts[0], outer_m - planet_thinning_m)).ok()?;
        let planet = Wheel::new(self.spec(Kind::External, self.teeth.planet, shifts[1], planet_thinning_m)).ok()?;
        let ring = Wheel::new(self.spec(Kind::Internal, self.teeth.ring, ring_shift, inner_m - planet_thinning_m)).ok()?;
        let limits = self.tip_limits_m([&sun, &planet, &ring], centre_m, [outer_rad, inner_rad]);
        let [sun, planet, ring] =
            [(sun, limits[0]), (planet, limits[1]), (ring, limits[2])].map(|(wheel, limit)| self.shortened(&wheel, limit));
        PlanetarySet::at(Mesh::new(sun?, planet?, centre_m).ok()?, ring?, self.planets).ok()
    }

    /// Largest tip radii of sun and planet, smallest of the ring, that clear roots and fillets, m.
    fn tip_limits_m(&self, [sun, planet, ring]: [&Wheel; 3], centre_m: f64, [outer_rad, inner_rad]: [f64; 2]) -> [f64; 3] {
        let clearance_m = self.least_clearance * self.module_m;
        let (outer_m, inner_m) = (centre_m * sin(outer_rad), centre_m * sin(inner_rad));
        let straight = |wheel: &Wheel| fillet::straight_tangent_m(wheel).max(0.0);
        let reach = |wheel: &Wheel, tangent_m: f64| hypot(wheel.base_radius_m, tangent_m.max(0.0));
        let ring_form_m = fillet::form_tangent_m(ring);
        let sun_m = (centre_m - planet.root_radius_m - clearance_m).min(reach(sun, outer_m - straight(planet)));
        let planet_m = (centre_m - sun.root_radius_m - clearance_m)
            .min(ring.root_radius_m - centre_m - clearance_m)
            .min(reach(planet, outer_m - straight(sun)))
            .min(reach(planet, ring_form_m - inner_m));
        [
            corner_limit_m(planet, sun, sun_m, centre_m, outer_rad),
            corner_limit_m(sun, planet, planet_m, centre_m, outer_rad),
            (centre_m + planet.root_radius_m + clearance_m).max(reach(ring, inner_m + straight(planet))),
        ]
    }

    /// The gear with a tip within a limit (m) and thick enough.
    fn shortened(&self, wheel: &Wheel, limit_m: f64) -> Option<Wheel> {
        let spare_m = SPARE * self.module_m;
        let full_m = wheel.tip_radius_m;
        let outwards = match wheel.spec.kind {
            Kind::External => 1.0,
            Kind::Internal => -1.0,
        };
        let within_m = if (full_m - limit_m) * outwards > 0.0 { limit_m - outwards * spare_m } else { full_m };
        let excess_m = |radius_m: f64| radius_m * wheel.tooth_angle_rad(radius_m) - self.least_tip * self.module_m;
        let tip_m = if excess_m(within_m) >= 0.0 {
            within_m
        } else {
            let low_m = wheel.reference_radius_m.max(wheel.root_radius_m + outwards * spare_m);
            let thick_m = roots::root(excess_m, low_m, within_m, 1e-3 * spare_m).ok()?;
            thick_m - outwards * spare_m
        };
        let tip_shortening = ((full_m - tip_m) * outwards / self.module_m).max(0.0);
        Wheel::new(WheelSpec { tip_shortening, ..wheel.spec }).ok().filter(|short| tangent_m(short, short.tip_radius_m) > 0.0)
    }
}

/// What is best among the sets that keep all conditions.
#[derive(Clone, Copy, Debug)]
enum Goal {
    /// The least specific sliding.
    Sliding,
    /// The largest contact ratio of the mesh that has less.
    Contact,
}

/// Shifts of sun and planet with what came of them.
#[derive(Clone, Copy, Debug)]
struct Judged {
    shifts: [f64; 2],
    outcome: Outcome,
}

#[derive(Clone, Copy, Debug)]
enum Outcome {
    Good {
        /// Less is better.
        cost: f64,
    },
    Bad {
        place: Place,
        margin: Margin,
        /// The margin over the module, to compare unlike ones.
        lacking: f64,
        against: Option<(Place, Margin)>,
    },
}

/// Largest tip radius of an external gear within a limit (m) whose corner stays out of the fillet of an external mate, m.
///
/// To 1e-4 modules, on the good side. Where the corner comes no deeper than the straight part of the rack it is taken to clear; if it does not,
/// the margin says so.
fn corner_limit_m(mate: &Wheel, gear: &Wheel, limit_m: f64, centre_m: f64, working_rad: f64) -> f64 {
    const HALVINGS: u32 = 12;
    let most_m = limit_m.min(gear.tip_radius_m);
    let clears = |tip_radius_m: f64| {
        let short = Wheel { tip_radius_m, ..*gear };
        corner::room_m(mate, &short, centre_m, working_rad).is_none_or(|room_m| room_m >= 0.0)
    };
    let rack = mate.spec.rack;
    let rounded_m = (rack.dedendum - fillet::straight_depth(mate)) * mate.spec.module_m;
    let mut good_m = centre_m - mate.root_radius_m - rounded_m;
    if good_m >= most_m || clears(most_m) {
        return limit_m;
    }
    let mut bad_m = most_m;
    for _ in 0..HALVINGS {
        let middle_m = 0.5 * (good_m + bad_m);
        if clears(middle_m) { good_m = middle_m } else { bad_m = middle_m }
    }
    good_m
}

/// The second if it is better.
fn better(first: Judged, second: Judged) -> Judged {
    let second_wins = match (first.outcome, second.outcome) {
        (Outcome::Good { cost: a }, Outcome::Good { cost: b }) => b < a,
        (Outcome::Good { .. }, Outcome::Bad { .. }) => false,
        (Outcome::Bad { .. }, Outcome::Good { .. }) => true,
        (Outcome::Bad { lacking: a, .. }, Outcome::Bad { lacking: b, .. }) => b > a,
    };
    if second_wins { second } else { first }
}

fn contact_ratios(set: &PlanetarySet) -> [f64; 2] {
    [&set.sun_planet, &set.planet_ring].map(|mesh| {
        let path = mesh.path();
        path.contact_ratio(path.usable)
    })
}

fn largest_sliding(set: &PlanetarySet) -> f64 {
    set.sun_planet.largest_sliding().max(set.planet_ring.largest_sliding())
}

fn same(a: [f64; 2], b: [f64; 2]) -> bool {
    a.map(f64::to_bits) == b.map(f64::to_bits)
}

fn blocked(place: Place, condition: Condition, value: f64) -> ShiftError {
    ShiftError::Blocked { place, margin: Margin { condition, value }, against: None }
}
