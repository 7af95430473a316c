//! Sections 4 and 5 of the paper: Figs. 14 to 16.

use super::{NOMINAL, Prototype, RATES};
use crate::analysis::{Behaviour, measure};
use crate::design::Design;
use crate::mechanism::{Drive, Sense, SpringMass};
use crate::motion::{Law, Motion};

/// How the springs' mass is taken into account in Fig. 14.
#[derive(Clone, Copy)]
enum Masses {
    /// Half of each spring on each roller.
    Halves,
    /// As a bar.
    Bar,
    /// One mass of a roller with its springs, kg, by their number.
    Given([f64; 3]),
}

/// As printed, and as measured with two and six springs.
const PRINTED: Masses = Masses::Given([0.38; 3]);
const ROUNDED: Masses = Masses::Given([0.29, 0.38, 0.47]);

impl Prototype {
    /// Numbers of the motions and errors; `None` for an id of another section.
    pub(super) fn dynamic(&self, id: &str) -> Option<f64> {
        let (name, last) = id.rsplit_once('_')?;
        let springs = last.parse::<usize>().ok().filter(|n| [2, 4, 6].contains(n)).unwrap_or(2);
        let (slow, still) = ("peak_force_ratio_to", "peak_force_ratio");
        Some(match name {
            "peak" => 100.0 * self.peak(springs, Masses::Halves, slow)?,
            "peak_rounded" => 100.0 * self.peak(springs, ROUNDED, slow)?,
            "peak_rest" => 100.0 * self.peak(springs, ROUNDED, still)?,
            "peak_bar" => 100.0 * self.peak(springs, Masses::Bar, slow)?,
            "peak_printed" => 100.0 * self.peak(springs, PRINTED, slow)?,
            "dead_weight" => 100.0 * Self::dead_weight(),
            "fastest" => Self::lift(0.0, 0.125).at(0.5)[1],
            "turn_rigid" => 100.0 * self.tilted(false)?,
            "turn_free" => 100.0 * self.tilted(true)?,
            "narrow" => 100.0 * self.turned(-1.0)?,
            "wide" => 100.0 * self.turned(1.0)?,
            _ => return None,
        })
    }

    /// Eq. (17): 100 mm from an ordinate s2 of the slider.
    fn lift(start_m: f64, duration_s: f64) -> Motion {
        let law = Law::Cycloidal;
        Motion { law, start_m, rise_m: 0.1, duration_s, pause_s: 0.0, returns: false, reference_s: Some(1.0) }
    }

    /// Travel of an ordinate s2 of the paper, m.
    fn travel_m(&self, s2_m: f64) -> Option<f64> {
        Some(s2_m - self.design.cut().ok()?.rise_m())
    }

    fn peak(&self, springs: usize, masses: Masses, metric: &str) -> Option<f64> {
        let mut design = self.with(&RATES[..springs], 0.0);
        design.motion = Some(Self::lift(self.travel_m(0.22)?, 0.125));
        match masses {
            Masses::Halves => design.built.bodies.springs = SpringMass::Halves,
            Masses::Bar => design.built.bodies.springs = SpringMass::Bar,
            Masses::Given(rollers) => {
                design.built.bodies.roller_kg = rollers[springs / 2 - 1];
                design.built.springs.iter_mut().for_each(|s| s.mass_kg = 0.0);
            }
        }
        let behaviour = Behaviour::of(&design).ok()?;
        measure(&design, &behaviour).get(metric)
    }

    /// Rise of the force on a dead weight in the same motion: its largest acceleration over gravity.
    fn dead_weight() -> f64 {
        Self::lift(0.0, 0.125).at(0.25)[2] / 9.81
    }

    /// Largest rise of the force over 100 mm by a tilt of 5°, from s2 = 212 mm.
    fn tilted(&self, free: bool) -> Option<f64> {
        let mut design = self.with(&[NOMINAL], 0.0);
        design.built.tilt_rad = 5.0_f64.to_radians();
        design.free_guide = free;
        let start = self.travel_m(0.212)?;
        design.window_m = Some([start, start + 0.1]);
        (design.motion, design.requirements) = (None, None);
        let behaviour = Behaviour::of(&design).ok()?;
        let [_, most] = Behaviour::extent(&behaviour.window, |s| s.still.force_n);
        Some(most / self.level() - 1.0)
    }

    /// Change of the force at s2 = 320 mm by profiles that are turned by 0.4°.
    fn turned(&self, sense: f64) -> Option<f64> {
        let mut design = self.with(&[NOMINAL], 0.0);
        design.built.turn_rad = [sense * 0.4_f64.to_radians(); 2];
        let force = force_at(&design, self.travel_m(0.32)?)?;
        Some(force / self.level() - 1.0)
    }

    fn level(&self) -> f64 {
        self.design.purpose.law.force_n(0.0)[0]
    }
}

fn force_at(design: &Design, travel_m: f64) -> Option<f64> {
    Some(Prototype::mechanism(design)?.instant(&Drive::rest(travel_m), Sense::Frictionless).ok()?.force_n)
}
