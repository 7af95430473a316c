//! Gear sets: which can be put together and run, with which profile shifts, and what they ask of a spring.

use std::collections::BTreeMap;
use std::sync::Mutex;

use forcewright_elements::gears::planetary::Teeth;
use forcewright_elements::gears::shift::ShiftWanted;
use forcewright_model::CheckState;

use super::asked::{Asked, clean};
use super::springs::INSIDE;
use crate::analysis::{Behaviour, measure};
use crate::checks::{LEAST_CONTACT_RATIO, LEAST_GAP, checks};
use crate::design::{Built, Design, Gears};
use crate::sizes::ring_m;

/// What gears must keep to, whatever the spring.
const GEAR_CHECKS: [&str; 6] = ["LAVT012", "LAVT013", "LAVT014", "LAVT015", "LAVT016", "LAVT017"];

/// Largest shift and shortening that a file may have, modules.
const MOST_SHIFT: f64 = 4.0;

/// Numbers of teeth, planets, and which module.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct GearSet {
    pub sun: u32,
    pub planet: u32,
    pub number: u32,
    pub module: usize,
}

/// A gear set that runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sound {
    pub set: GearSet,
    /// Of sun, planet, ring, modules.
    pub shift: [f64; 3],
    pub shortening: [f64; 3],
    pub ring_root_m: f64,
    /// Diameter over the ring, m.
    pub ring_m: f64,
    /// Part of the power that the meshes lose in mode II.
    pub loss: f64,
}

/// Gear sets that ask the same of a spring.
#[derive(Clone, Debug)]
pub(super) struct Class {
    pub ratio: f64,
    pub module: usize,
    pub sets: Vec<GearSet>,
    /// Parts lost in mode I and II, and torques, N·m.
    proportional: [f64; 2],
    constant_nm: [f64; 2],
    /// `τ_t` from and to, N·m.
    pub transition_nm: [f64; 2],
    /// Largest `τ_b`, N·m.
    pub most_slip_nm: f64,
    /// Torque on the spring with the input torque, N·m.
    pub needed_nm: f64,
    /// Output torque with the input torque and a hub that does not slip, N·m.
    pub driven_nm: f64,
}

impl GearSet {
    fn teeth(self) -> Teeth {
        Teeth::standard(self.sun, self.planet)
    }

    /// R.
    pub(super) fn ratio(self) -> f64 {
        self.teeth().reduction()
    }
}

/// Every gear set of the grid that can be put together and is slow enough in mode I, in order.
pub(super) fn assembled(asked: &Asked) -> impl Iterator<Item = GearSet> + '_ {
    let span = |[from, to]: [u32; 2]| from..=to;
    (0..asked.modules_m.len())
        .flat_map(move |module| span(asked.suns).map(move |sun| (module, sun)))
        .flat_map(move |(module, sun)| span(asked.planets).map(move |planet| (module, sun, planet)))
        .flat_map(move |(module, sun, planet)| span(asked.numbers).map(move |number| GearSet { sun, planet, number, module }))
        .filter(|set| set.teeth().fit_equally(set.number) && 1.0 / set.ratio() <= asked.speed_drop)
}

/// A set in the template of a design: as its file will have it.
pub(super) fn geared(asked: &Asked, sound: &Sound) -> Gears {
    let module_m = asked.modules_m[sound.set.module];
    Gears {
        teeth: [sound.set.sun, sound.set.planet, sound.set.teeth().ring],
        planets: sound.set.number,
        module_m,
        shift: sound.shift,
        shortening: sound.shortening,
        face_m: face_m(asked, sound.set.module),
        backlash_m: asked.backlash_m,
        friction: asked.flank_friction,
        sharing: 1.0,
        rack: asked.template.built.gears.rack,
    }
}

/// Width of the gears, m.
pub(super) fn face_m(asked: &Asked, module: usize) -> f64 {
    clean(asked.face_ratio * asked.modules_m[module])
}

/// Wall of the ring outside of its roots, m.
pub(super) fn wall_m(asked: &Asked, module: usize) -> f64 {
    asked.template.making.wall_m(asked.modules_m[module])
}

/// Thickness of the plates, m.
pub(super) fn plate_m(asked: &Asked, module: usize) -> f64 {
    asked.template.making.plate_m(asked.modules_m[module])
}

/// The template with this spring and these gears.
pub(super) fn design(asked: &Asked, built: &Built, gears: Gears) -> Design {
    let mut design = asked.template.clone();
    design.built = Built { gears, ..*built };
    design
}

/// Shifts and shortened tips of sun, planet, ring, modules.
type Shifts = [[f64; 3]; 2];

/// Shifts with the least sliding; with the room between planets that is asked for, or whatever it is.
fn shifts(asked: &Asked, set: GearSet, with_room: bool) -> Option<Shifts> {
    let module_m = asked.modules_m[set.module];
    let wanted = ShiftWanted {
        rack: asked.template.built.gears.rack,
        least_gap_m: if with_room { LEAST_GAP * module_m * (1.0 + INSIDE) } else { -f64::from(set.planet) * module_m },
        ..ShiftWanted::usual(set.teeth(), set.number, module_m, asked.backlash_m)
    };
    // Where the usual contact ratio cannot be had, that which is asked for.
    let reached = wanted.solve().or_else(|_| ShiftWanted { least_contact_ratio: LEAST_CONTACT_RATIO * (1.0 + INSIDE), ..wanted }.solve());
    let found = reached.ok()?.set;
    let wheels = [found.sun_planet.pinion, found.planet_ring.pinion, found.planet_ring.wheel];
    Some([wheels.map(|w| clean(w.spec.profile_shift)), wheels.map(|w| clean(w.spec.tip_shortening))])
}

/// A set with these shifts, if it runs.
fn runs(asked: &Asked, set: GearSet, [shift, shortening]: Shifts) -> Option<Sound> {
    if shift.iter().chain(&shortening).any(|x| x.abs() > MOST_SHIFT) {
        return None;
    }
    let mut sound = Sound { set, shift, shortening, ring_root_m: 0.0, ring_m: 0.0, loss: 0.0 };
    let design = design(asked, &asked.template.built, geared(asked, &sound));
    let behaviour = Behaviour::of(&design).ok()?;
    let found = checks(&design, &behaviour, &measure(&design, &behaviour));
    if found.iter().any(|c| c.state == CheckState::Missed && GEAR_CHECKS.contains(&c.code)) {
        return None;
    }
    sound.ring_root_m = behaviour.train.set.planet_ring.wheel.root_radius_m;
    sound.ring_m = ring_m(sound.ring_root_m, wall_m(asked, set.module));
    sound.loss = behaviour.train.mesh_loss();
    Some(sound)
}

/// Gear sets whose shifts were looked for: each once, those of the same teeth together, as planets only ask for room.
#[derive(Debug, Default)]
pub(super) struct Book {
    sets: Mutex<BTreeMap<GearSet, Option<Sound>>>,
    /// By sun and planet, and by module where there is backlash: else all is in proportion to it.
    shifts: Mutex<BTreeMap<[usize; 3], Option<Shifts>>>,
}

/// What is in a map, or what is found now.
fn known<K: Ord + Copy, V: Copy>(map: &Mutex<BTreeMap<K, V>>, key: K, find: impl FnOnce() -> V) -> V {
    if let Some(known) = map.lock().ok().and_then(|all| all.get(&key).copied()) {
        return known;
    }
    let found = find();
    if let Ok(mut all) = map.lock() {
        all.insert(key, found);
    }
    found
}

impl Book {
    /// A set with profile shifts with which it runs; `None` where there are none.
    pub(super) fn sound(&self, asked: &Asked, set: GearSet) -> Option<Sound> {
        known(&self.sets, set, || {
            let module = if asked.backlash_m > 0.0 { set.module + 1 } else { 0 };
            let free = known(&self.shifts, [set.sun as usize, set.planet as usize, module], || shifts(asked, set, false))?;
            runs(asked, set, free).or_else(|| runs(asked, set, shifts(asked, set, true)?))
        })
    }
}

impl Class {
    fn new(asked: &Asked, set: GearSet, mesh_loss: f64) -> Self {
        let ratio = set.ratio();
        let leverage = (1.0 - ratio) / ratio;
        let [one, two] = asked.template.built.losses;
        let proportional = [one.proportional.unwrap_or(0.0), two.proportional.unwrap_or(mesh_loss)];
        let constant_nm = [one.constant_nm, two.constant_nm];
        let spring_nm = |output_nm: f64| leverage * (output_nm + constant_nm[0]) / (1.0 - proportional[0]);
        let [from_nm, to_nm] = asked.transition_nm;
        let driven_nm = (1.0 - proportional[1]) * asked.input_nm / ratio - constant_nm[1];
        let least_nm = asked.output_nm.max(asked.efficiency * asked.input_nm / ratio) * (1.0 + INSIDE);
        Self {
            ratio,
            module: set.module,
            sets: vec![set],
            proportional,
            constant_nm,
            transition_nm: [if from_nm > 0.0 { spring_nm(from_nm) * (1.0 + INSIDE) } else { 0.0 }, spring_nm(to_nm) * (1.0 - INSIDE)],
            most_slip_nm: driven_nm - least_nm,
            needed_nm: leverage * asked.input_nm * (1.0 + INSIDE),
            driven_nm,
        }
    }

    /// Output torque at which mode I ends, N·m, for a torque on the spring.
    pub(super) fn mode_1_nm(&self, transition_nm: f64) -> f64 {
        let leverage = (1.0 - self.ratio) / self.ratio;
        ((1.0 - self.proportional[0]) * transition_nm / leverage - self.constant_nm[0]).max(0.0)
    }
}

/// Classes of the sets of a grid, and how many sets there are that can be put together. With friction between flanks only of sets that run,
/// as each loses another part.
pub(super) fn classes(asked: &Asked, book: &Book, go_on: &dyn Fn() -> bool) -> (Vec<Class>, usize) {
    let mut all: BTreeMap<(usize, u64, u64), Class> = BTreeMap::new();
    let mut count = 0;
    for set in assembled(asked) {
        count += 1;
        let mut loss = 0.0;
        if asked.flank_friction.is_some() && Class::new(asked, set, 0.0).most_slip_nm > 0.0 {
            if !go_on() {
                break;
            }
            let Some(sound) = book.sound(asked, set) else { continue };
            loss = sound.loss;
        }
        let class = Class::new(asked, set, loss);
        if class.most_slip_nm > 0.0 && class.transition_nm[0] < class.needed_nm {
            let key = (set.module, class.ratio.to_bits(), class.proportional[1].to_bits());
            all.entry(key).and_modify(|c| c.sets.push(set)).or_insert(class);
        }
    }
    (all.into_values().collect(), count)
}
