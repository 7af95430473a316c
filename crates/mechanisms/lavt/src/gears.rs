//! The planetary gears of a design: whether they run, and what they lose.

use forcewright_base::units::format_number;
use forcewright_elements::gears::interference::{Condition, Margin, Unit, least_shift, mesh_margins, wheel_margins};
use forcewright_elements::gears::planetary::{PlanetarySet, Teeth};
use forcewright_elements::gears::shift::{Place, ShiftWanted};
use forcewright_elements::gears::strength::{SetLoad, set_stresses};
use forcewright_elements::gears::{Kind, Mesh, Wheel, WheelSpec};
use forcewright_elements::hertz::Solid;

use crate::design::{Design, Gears};
use crate::metrics::Measured;
use crate::sizes::{Sizes, envelope_m3};

/// The gears of a design.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Train {
    /// Sun, planets, ring on one centre distance.
    pub set: PlanetarySet,
    /// Least profile shift over that without undercut, of sun and planets, modules.
    pub undercut: f64,
    /// The least room between teeth that must not meet, and what it keeps clear of.
    pub tightest: Tightest,
    /// Part of the power that the meshes lose in mode II.
    loss: f64,
    friction: Option<f64>,
}

/// The least room between teeth, or of what makes a tooth one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tightest {
    /// m; of conditions that are angles, along the tip circle of the planet.
    pub room_m: f64,
    /// The gear or mesh.
    pub place: Place,
    /// What it keeps clear of.
    pub condition: Condition,
}

/// Sun, planet and ring with their numbers of teeth, shifts and tips.
pub(crate) fn wheels(gears: &Gears) -> Result<[Wheel; 3], String> {
    let wheel = |i: usize| {
        // Half of the backlash of a mesh is taken from each of its teeth; the planet is in both.
        Wheel::new(WheelSpec {
            kind: if i == 2 { Kind::Internal } else { Kind::External },
            teeth: gears.teeth[i],
            module_m: gears.module_m,
            rack: gears.rack,
            profile_shift: gears.shift[i],
            tip_shortening: gears.shortening[i],
            thinning_m: 0.5 * gears.backlash_m,
        })
        .map_err(|error| format!("{}: {error}", ["sun", "planet", "ring"][i]))
    };
    Ok([wheel(0)?, wheel(1)?, wheel(2)?])
}

impl Train {
    /// The gears of a design.
    ///
    /// # Errors
    /// Why there are none, in words.
    pub fn of(design: &Design) -> Result<Self, String> {
        let gears = &design.built.gears;
        let [sun, planet, ring] = wheels(gears)?;
        let set = PlanetarySet::new(sun, planet, ring, gears.planets).map_err(|error| error.to_string())?;
        let undercut = [sun, planet].iter().map(|w| w.spec.profile_shift - least_shift(w)).fold(f64::INFINITY, f64::min);
        let loss = match gears.friction {
            Some(friction) => {
                let train = set.train(friction).map_err(|error| error.to_string())?;
                // Without a drag of the clutch, which the statics take for themselves.
                1.0 - train.reduced(1.0, 0.0).map_err(|error| error.to_string())?.1
            }
            None => 0.0,
        };
        Ok(Self { set, undercut, tightest: tightest(&set), loss, friction: gears.friction })
    }

    /// Part of the power that the meshes lose in mode II.
    pub fn mesh_loss(&self) -> f64 {
        self.loss
    }

    /// What would mend undercut and interference: the shifts that a search finds.
    pub(crate) fn advice(gears: &Gears) -> String {
        let [sun, planet, ring] = gears.teeth;
        let usual = ShiftWanted::usual(Teeth { sun, planet, ring }, gears.planets, gears.module_m, gears.backlash_m);
        let wanted = ShiftWanted { rack: gears.rack, least_clearance: gears.rack.clearance(), ..usual };
        match wanted.solve_reachable() {
            Ok(found) => {
                let specs = [found.set.sun_planet.pinion.spec, found.set.planet_ring.pinion.spec, found.set.planet_ring.wheel.spec];
                let list = |of: &dyn Fn(&WheelSpec) -> f64| {
                    let all = ["sun", "planet", "ring"].iter().zip(&specs);
                    all.map(|(name, spec)| format!("{name} = {}", format_number(of(spec), 4))).collect::<Vec<_>>().join(", ")
                };
                format!(
                    "`profile_shift = {{ {} }}` with `tip_shortening = {{ {} }}` runs",
                    list(&|s| s.profile_shift),
                    list(&|s| s.tip_shortening)
                )
            }
            Err(error) => format!("no profile shift was found that runs: {error}; take other numbers of teeth"),
        }
    }

    /// Stresses with a torque at the sun, Pa: the largest at a root, and between flanks.
    fn stresses_pa(&self, design: &Design, sun_nm: f64) -> Option<[f64; 2]> {
        let material = design.gear_material.as_ref()?;
        let solid = Solid { young_modulus_pa: material.young_pa, poisson_ratio: material.poisson };
        let gears = &design.built.gears;
        let load = SetLoad { sun_torque_nm: sun_nm, sharing: gears.sharing, face_width_m: gears.face_m, solids: [solid; 3] };
        let found = set_stresses(&self.set, &load).ok()?;
        let largest = |all: &[f64]| all.iter().copied().fold(0.0, f64::max);
        Some([largest(&found.bending_pa), largest(&found.flanks.map(|f| f.largest_pa))])
    }

    /// The least room in words.
    pub(crate) fn tightest(&self) -> String {
        format!("here {} ({})", self.tightest.condition, self.tightest.place)
    }
}

/// Whether a margin is room between teeth that must not meet, or of a tooth or space that must not be pointed. Undercut is a metric of its own.
fn is_interference(margin: &Margin) -> bool {
    use Condition as C;
    match margin.condition {
        C::TipThickness
        | C::RingRoot
        | C::RingTip
        | C::PinionInterference
        | C::WheelInterference
        | C::PinionFillet
        | C::WheelFillet
        | C::PinionCorner
        | C::WheelCorner
        | C::PinionClearance
        | C::WheelClearance
        | C::Trochoid
        | C::Trimming => true,
        C::Undercut | C::ContactRatio | C::NeighbourGap | C::Assembly | C::Coaxial => false,
    }
}

fn tightest(set: &PlanetarySet) -> Tightest {
    let planet_m = set.planet_ring.pinion.tip_radius_m;
    let meshes = [(Place::PlanetRing, set.planet_ring), (Place::SunPlanet, set.sun_planet)];
    let wheels = [(Place::Sun, set.sun_planet.pinion), (Place::Planet, set.planet_ring.pinion), (Place::Ring, set.planet_ring.wheel)];
    let of_meshes = meshes.into_iter().flat_map(|(place, mesh)| mesh_margins(&mesh, 0.0).map(move |margin| (place, margin)));
    let of_wheels = wheels.into_iter().flat_map(|(place, wheel)| wheel_margins(&wheel, 0.0).map(move |margin| (place, margin)));
    let none = Tightest { room_m: f64::INFINITY, place: Place::PlanetRing, condition: Condition::Trimming };
    of_meshes
        .chain(of_wheels)
        .filter(|(_, margin)| is_interference(margin))
        .map(|(place, Margin { condition, value })| {
            let arm_m = if condition.unit() == Unit::Radian { planet_m } else { 1.0 };
            Tightest { room_m: value * arm_m, place, condition }
        })
        .fold(none, |a, b| if b.room_m < a.room_m { b } else { a })
}

/// Metrics of the gears, and of the room that the whole takes.
pub(crate) fn measure(m: &mut Measured, design: &Design, train: &Train) {
    let set = &train.set;
    m.set("planet_gap", set.neighbour_gap_m());
    for (name, mesh) in [("contact_ratio_sun", &set.sun_planet), ("contact_ratio_ring", &set.planet_ring)] {
        let path = mesh.path();
        m.set(name, path.contact_ratio(path.usable));
    }
    m.set("undercut_margin", train.undercut);
    m.set("interference_margin", train.tightest.room_m);
    let backlash = |mesh: &Mesh| mesh.backlash().circumferential_m;
    m.set("backlash_min", backlash(&set.sun_planet).min(backlash(&set.planet_ring)));
    if let Some([bending_pa, flank_pa]) = design.requirements.as_ref().and_then(|r| train.stresses_pa(design, r.input_nm)) {
        m.set("tooth_bending_stress", bending_pa);
        m.set("flank_pressure", flank_pa);
    }
    m.set("mesh_efficiency", train.friction.map(|_| 1.0 - train.loss));
    let Sizes { envelope_m, .. } = Sizes::of(design, train);
    m.set("outer_diameter", envelope_m[0]);
    m.set("length", envelope_m[1]);
    m.set("envelope_volume", envelope_m3(envelope_m));
}

#[cfg(test)]
mod tests {
    use super::*;
    use forcewright_elements::gears::Rack;

    fn set_of(teeth: [u32; 3], shifts: [f64; 3], planets: u32) -> PlanetarySet {
        let wheel = |i: usize| {
            let kind = if i == 2 { Kind::Internal } else { Kind::External };
            let (teeth, profile_shift) = (teeth[i], shifts[i]);
            Wheel::new(WheelSpec { kind, teeth, module_m: 1.0, rack: Rack::ISO_53_A, profile_shift, tip_shortening: 0.0, thinning_m: 0.02 })
                .expect("a gear")
        };
        PlanetarySet::new(wheel(0), wheel(1), wheel(2), planets).expect("a set")
    }

    /// Tips inside the mate's root circle, with involutes and fillets that keep clear on the line of action; corners that cut into fillets
    /// beside it; pointed tips.
    #[test]
    fn teeth_that_foul_off_the_line_of_action_are_found() {
        let deep = set_of([15, 21, 59], [0.7, 0.9, 1.225], 2);
        let bottom_m = deep.sun_planet.bottom_clearances_m()[0];
        assert!((bottom_m + 0.0425).abs() < 1e-4, "{bottom_m}");
        let found = tightest(&deep);
        assert!(found.room_m <= bottom_m && found.place == Place::SunPlanet, "{found:?}");
        let on_the_line = |margin: &Margin| matches!(margin.condition, Condition::PinionFillet | Condition::WheelFillet);
        let corner = set_of([16, 24, 66], [0.5, 1.0, 1.264], 2);
        assert!(mesh_margins(&corner.sun_planet, 0.0).filter(on_the_line).all(|margin| margin.holds()));
        let found = tightest(&corner);
        assert!((found.room_m + 0.069).abs() < 1e-3 && found.condition == Condition::WheelCorner, "{found:?}");
        let pointed = set_of([8, 20, 48], [1.2, 0.0, 0.7], 4);
        assert!(
            wheel_margins(&pointed.sun_planet.pinion, 0.0).any(|margin| margin.condition == Condition::TipThickness && !margin.holds())
        );
        assert!(tightest(&pointed).room_m < 0.0);
    }
}
