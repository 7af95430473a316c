//! Planetary sets of a sun, planets on a carrier and a ring: teeth, assembly, ratios, torques, efficiency.

use std::f64::consts::PI;
use std::ops::RangeInclusive;

use forcewright_base::maths::sin;

use super::{GearError, Kind, Mesh, Wheel};

/// Numbers of teeth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Teeth {
    /// Of the sun.
    pub sun: u32,
    /// Of a planet.
    pub planet: u32,
    /// Of the ring.
    pub ring: u32,
}

impl Teeth {
    /// The set that is coaxial without profile shift: `z_r = z_s + 2 z_p`; of more teeth than a `u32` holds, the most it holds.
    pub fn standard(sun: u32, planet: u32) -> Self {
        Self { sun, planet, ring: sun.saturating_add(planet.saturating_mul(2)) }
    }

    /// By how many teeth the ring differs from `z_s + 2 z_p`; profile shift must make up for it.
    pub fn excess(&self) -> i64 {
        i64::from(self.ring) - i64::from(self.sun) - 2 * i64::from(self.planet)
    }

    /// `R = z_s/(z_s + z_r)`: turns of the carrier per turn of the sun while the ring stands. Butin et al. (2023), eq. (9).
    pub fn reduction(&self) -> f64 {
        f64::from(self.sun) / (f64::from(self.sun) + f64::from(self.ring))
    }

    /// Least angle from one place for a planet to the next, `2π/(z_s + z_r)`, rad.
    ///
    /// Turn the carrier by it while the ring stands: the sun turns by one pitch, so its teeth look as before, and another planet goes in where
    /// the first was.
    pub fn place_rad(&self) -> f64 {
        2.0 * PI / (f64::from(self.sun) + f64::from(self.ring))
    }

    /// Whether planets fit at equal angles: `(z_s + z_r) mod N = 0`. N is at least 1.
    pub fn fit_equally(&self, planets: u32) -> bool {
        planets > 0 && (u64::from(self.sun) + u64::from(self.ring)).is_multiple_of(u64::from(planets))
    }

    /// Angles (rad) of the places nearest to equal spacing, ascending from 0; equal if [`Teeth::fit_equally`].
    pub fn nearest_places_rad(&self, planets: u32) -> impl Iterator<Item = f64> + use<> {
        let places = u64::from(self.sun) + u64::from(self.ring);
        let step_rad = self.place_rad();
        (0..planets).map(move |k| {
            // Beyond 64 bits with the largest numbers of teeth and planets.
            let place = (2 * u128::from(k) * u128::from(places) + u128::from(planets)) / (2 * u128::from(planets));
            place as f64 * step_rad
        })
    }
}

/// What a search for teeth runs over.
#[derive(Clone, Debug, PartialEq)]
pub struct TeethSearch {
    /// Teeth of the sun; at least 4.
    pub sun: RangeInclusive<u32>,
    /// Teeth of a planet; at least 4.
    pub planet: RangeInclusive<u32>,
    /// Number of planets; at least 1.
    pub planets: RangeInclusive<u32>,
    /// Teeth of the ring beside `z_s + 2 z_p`.
    pub excess: RangeInclusive<i32>,
    /// Reduction `R = z_s/(z_s + z_r)`, from and to.
    pub reduction: [f64; 2],
    /// Most teeth of the ring.
    pub most_ring: u32,
    /// Least distance between the tips of neighbours of standard teeth at the mean centre distance, modules; −∞ to allow all. One planet has
    /// no neighbours.
    pub least_gap: f64,
    /// Only sets whose planets fit at equal angles.
    pub equal_angles: bool,
}

/// A set that a search found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TeethFound {
    /// Numbers of teeth.
    pub teeth: Teeth,
    /// Number of planets.
    pub planets: u32,
    /// Distance between the tips of neighbours at equal angles, of unshifted teeth with an addendum of one, modules. Infinite for one planet.
    pub gap: f64,
}

impl TeethSearch {
    /// All sets, in the order sun, planet, ring, planets.
    pub fn sets(&self) -> impl Iterator<Item = TeethFound> + '_ {
        self.sun
            .clone()
            .flat_map(move |sun| self.planet.clone().map(move |planet| (sun, planet)))
            .flat_map(move |(sun, planet)| {
                self.excess.clone().filter_map(move |excess| {
                    let ring = planet.checked_mul(2)?.checked_add(sun)?.checked_add_signed(excess)?;
                    Some(Teeth { sun, planet, ring })
                })
            })
            .flat_map(move |teeth| self.planets.clone().map(move |planets| (teeth, planets)))
            .filter_map(move |(teeth, planets)| self.found(teeth, planets))
    }

    fn found(&self, teeth: Teeth, planets: u32) -> Option<TeethFound> {
        // Mean of both meshes' reference centre distances.
        let mean = (f64::from(teeth.sun) + f64::from(teeth.ring)) / 4.0;
        let gap = gap(mean, planets, f64::from(teeth.planet) / 2.0 + 1.0);
        let reduction = teeth.reduction();
        let good = planets > 0
            && teeth.ring <= self.most_ring
            && teeth.ring > teeth.planet
            && (self.reduction[0]..=self.reduction[1]).contains(&reduction)
            && gap >= self.least_gap
            && (!self.equal_angles || teeth.fit_equally(planets));
        good.then_some(TeethFound { teeth, planets, gap })
    }
}

/// Gap between neighbours on a circle; all lengths in one unit. Infinite for one planet.
fn gap(centre_distance: f64, planets: u32, tip_radius: f64) -> f64 {
    if planets <= 1 {
        return f64::INFINITY;
    }
    2.0 * centre_distance * sin(PI / f64::from(planets)) - 2.0 * tip_radius
}

/// A sun, equal planets and a ring on one centre distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanetarySet {
    /// Sun and planet.
    pub sun_planet: Mesh,
    /// Planet and ring.
    pub planet_ring: Mesh,
    /// Number of planets.
    pub planets: u32,
}

impl PlanetarySet {
    /// The set at the centre distance at which sun and planet of full thickness have no play.
    ///
    /// # Errors
    /// [`GearError`] if a pair does not mesh. That planet and ring have no play there either is not asked for: see [`PlanetarySet::coaxial_error_m`].
    pub fn new(sun: Wheel, planet: Wheel, ring: Wheel, planets: u32) -> Result<Self, GearError> {
        let sun_planet = Mesh::without_backlash(sun, planet)?;
        Self::at(sun_planet, ring, planets)
    }

    /// The set of a mesh of sun and planet.
    ///
    /// # Errors
    /// [`GearError`] if the planet does not mesh with the ring, or without planets.
    pub fn at(sun_planet: Mesh, ring: Wheel, planets: u32) -> Result<Self, GearError> {
        if ring.spec.kind == Kind::External || sun_planet.wheel.spec.kind == Kind::Internal {
            return Err(GearError::Mates { name: "a planetary set has a sun and planets with teeth outside and a ring" });
        }
        if planets == 0 {
            return Err(GearError::Value { name: "planets", value: 0.0 });
        }
        let planet_ring = Mesh::new(sun_planet.wheel, ring, sun_planet.centre_distance_m)?;
        Ok(Self { sun_planet, planet_ring, planets })
    }

    /// Numbers of teeth.
    pub fn teeth(&self) -> Teeth {
        Teeth {
            sun: self.sun_planet.pinion.spec.teeth,
            planet: self.planet_ring.pinion.spec.teeth,
            ring: self.planet_ring.wheel.spec.teeth,
        }
    }

    /// By how much the centre distance of the set exceeds that at which planet and ring of full thickness have no play, m; 0 if it is
    /// coaxial. Below 0 the planet has play in the ring, above 0 it does not go in.
    ///
    /// # Errors
    /// [`GearError::CentreDistance`] if the shifts of planet and ring have no centre distance.
    pub fn coaxial_error_m(&self) -> Result<f64, GearError> {
        let free = Mesh::without_backlash(self.planet_ring.pinion, self.planet_ring.wheel)?;
        Ok(self.planet_ring.centre_distance_m - free.centre_distance_m)
    }

    /// Distance between the tip circles of neighbouring planets at equal angles, m; below 0 they clash. Infinite for one planet.
    pub fn neighbour_gap_m(&self) -> f64 {
        self.gap_m(2.0 * PI / f64::from(self.planets))
    }

    /// The same of planets at the nearest places where they fit, [`Teeth::nearest_places_rad`].
    pub fn nearest_neighbour_gap_m(&self) -> f64 {
        let angles = self.teeth().nearest_places_rad(self.planets);
        let following = self.teeth().nearest_places_rad(self.planets).skip(1).chain([2.0 * PI]);
        angles.zip(following).map(|(from, to)| self.gap_m(to - from)).fold(f64::INFINITY, f64::min)
    }

    fn gap_m(&self, between_rad: f64) -> f64 {
        if self.planets == 1 {
            return f64::INFINITY;
        }
        2.0 * (self.sun_planet.centre_distance_m * sin(between_rad / 2.0) - self.planet_ring.pinion.tip_radius_m)
    }

    /// Efficiency with the carrier held, of both meshes one after the other: `(1 − μ H_V,sp)(1 − μ H_V,pr)`, from the coefficient of friction
    /// of the flanks. Bearings and oil are not in it. Only [`PlanetarySet::train`] looks whether the teeth touch and each mesh passes power on.
    pub fn basic_efficiency(&self, friction: f64) -> f64 {
        let [outer, inner] = self.mesh_efficiencies(friction);
        outer * inner
    }

    fn mesh_efficiencies(&self, friction: f64) -> [f64; 2] {
        [&self.sun_planet, &self.planet_ring].map(|mesh| 1.0 - friction * mesh.loss_factor())
    }

    /// Its gears as a train with losses.
    ///
    /// # Errors
    /// [`GearError::Value`] of an empty path of contact, and of a coefficient of friction that is negative, not finite, or takes all of the
    /// power of a mesh or more.
    pub fn train(&self, friction: f64) -> Result<Train, GearError> {
        if !(friction >= 0.0 && friction.is_finite()) {
            return Err(GearError::Value { name: "friction", value: friction });
        }
        for mesh in [&self.sun_planet, &self.planet_ring] {
            mesh.check_touches()?;
        }
        if !self.mesh_efficiencies(friction).into_iter().all(|efficiency| efficiency > 0.0) {
            return Err(GearError::Value { name: "friction", value: friction });
        }
        Train::new(self.teeth(), self.basic_efficiency(friction))
    }
}

/// A shaft of a planetary set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Member {
    /// Sun.
    Sun,
    /// Carrier of the planets.
    Carrier,
    /// Ring.
    Ring,
}

impl Member {
    fn index(self) -> usize {
        match self {
            Self::Sun => 0,
            Self::Carrier => 1,
            Self::Ring => 2,
        }
    }
}

/// Planetary set reduced to its ratio and its efficiency with the carrier held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Train {
    teeth: Teeth,
    basic_efficiency: f64,
}

/// Speeds and torques of a train with one shaft held, or turning as a block. In the order sun, carrier, ring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flow {
    /// Speeds per speed of the input.
    pub speeds: [f64; 3],
    /// Torques on the train per torque of the input; they add up to 0.
    pub torques: [f64; 3],
    /// Power out over power in; below 0 if the train locks itself in this direction.
    pub efficiency: f64,
}

impl Train {
    /// A train with an efficiency from sun to ring while the carrier is held, above 0 to 1.
    ///
    /// # Errors
    /// [`GearError::Value`]
    pub fn new(teeth: Teeth, basic_efficiency: f64) -> Result<Self, GearError> {
        if teeth.sun == 0 || teeth.ring == 0 {
            return Err(GearError::Value { name: "teeth", value: 0.0 });
        }
        if !(basic_efficiency > 0.0 && basic_efficiency <= 1.0) {
            return Err(GearError::Value { name: "basic_efficiency", value: basic_efficiency });
        }
        Ok(Self { teeth, basic_efficiency })
    }

    /// Ring over sun.
    fn ratio(&self) -> f64 {
        f64::from(self.teeth.ring) / f64::from(self.teeth.sun)
    }

    /// Torques on sun, carrier, ring per torque on the sun, when the power that rolls in the meshes flows from the sun to the ring or back:
    /// `T_r = (z_r/z_s) η₀^w T_s`, `T_c = −T_s − T_r`, w = ±1. Derived in `docs/theory/gears.md`, eq. (7); cf. H. W. Müller, "Epicyclic Drive
    /// Trains", Wayne State University Press 1982.
    fn torques(&self, sun_to_ring: bool) -> [f64; 3] {
        let ring = self.ratio() * if sun_to_ring { self.basic_efficiency } else { 1.0 / self.basic_efficiency };
        [1.0, -(1.0 + ring), ring]
    }

    /// Speeds and torques with one shaft held and another driven; the third is the output.
    ///
    /// # Errors
    /// [`GearError::Mates`] if the shaft held is the one driven.
    pub fn flow(&self, held: Member, input: Member) -> Result<Flow, GearError> {
        if held == input {
            return Err(GearError::Mates { name: "the shaft that is held cannot be driven" });
        }
        let (held, input) = (held.index(), input.index());
        let output = 3 - held - input;
        // Willis: the speeds less that of the carrier are as with the carrier held. Two solutions span all: a block, and the carrier held.
        let (block, rolling) = ([1.0, 1.0, 1.0], [1.0, 0.0, -1.0 / self.ratio()]);
        // The one in which the held shaft stands.
        let mut speeds = [0, 1, 2].map(|k| block[k] * rolling[held] - rolling[k] * block[held]);
        let driven = speeds[input];
        speeds = speeds.map(|speed| speed / driven);
        let mut torques = [true, false].map(|sun_to_ring| self.torques(sun_to_ring));
        for row in &mut torques {
            let driven = row[input];
            *row = row.map(|torque| torque / driven);
        }
        // The right one has the flow of rolling power that it assumes: torque of the sun times its speed against the carrier.
        let from_sun = |row: &[f64; 3]| row[0] * (speeds[0] - speeds[1]) >= 0.0;
        let torques = if from_sun(&torques[0]) { torques[0] } else { torques[1] };
        Ok(Flow { speeds, torques, efficiency: -torques[output] * speeds[output] })
    }

    /// Sun driven, carrier driving, the ring locked to the carrier: all turns as a block, nothing rolls.
    ///
    /// The lock passes `(z_r/z_s)` times the torque of the sun from ring to carrier.
    pub fn block(&self) -> Flow {
        Flow { speeds: [1.0; 3], torques: [1.0, -1.0, 0.0], efficiency: 1.0 }
    }

    /// Torque that holds the ring, locked to carrier or housing, per torque on the sun: `(1 − R)/R` without losses.
    pub fn ring_torque(&self) -> f64 {
        self.ratio()
    }

    /// The largest input torque (N m) at which a lock of ring and carrier that slips at a torque (N m) still holds: `R τ_t/(1 − R)`.
    /// Butin et al. (2023), section 3.3, mode I.
    pub fn block_limit_nm(&self, slip_nm: f64) -> f64 {
        slip_nm / self.ring_torque()
    }

    /// Output torque at the carrier (N m) and efficiency with the ring held by the housing, the sun driven by a torque (N m, above 0), while a
    /// clutch between ring and carrier drags (N m, at least 0).
    ///
    /// Mode II of Butin et al. (2023), `τ_out = τ_in/R − τ_b`, with losses of the teeth.
    ///
    /// # Errors
    /// [`GearError::Value`]
    pub fn reduced(&self, input_nm: f64, drag_nm: f64) -> Result<(f64, f64), GearError> {
        for (name, value, good) in [("input_nm", input_nm, input_nm > 0.0), ("drag_nm", drag_nm, drag_nm >= 0.0)] {
            if !(good && value.is_finite()) {
                return Err(GearError::Value { name, value });
            }
        }
        let flow = self.flow(Member::Ring, Member::Sun)?;
        let output_nm = -flow.torques[1] * input_nm - drag_nm;
        Ok((output_nm, output_nm * flow.speeds[1] / input_nm))
    }
}
