//! Section 3 of the paper: force loops, Tables 2 and 3, Figs. 4 to 10.

use super::{NOMINAL, Prototype, RATES};
use crate::analysis::{Behaviour, measure};
use crate::mechanism::{Drive, Sense};

/// Loop areas of Table 3, N·m, and of nylon rollers with six springs; means up and down, N.
const AREAS: [f64; 4] = [0.406, 0.555, 1.069, 1.220];
const MEANS: [[f64; 2]; 3] = [[49.67, 48.27], [98.94, 96.62], [148.27, 144.17]];
/// Area measured over 40 … 210 mm with two springs, N·m.
const PART_AREA: f64 = 0.259;
/// The paper's rolling friction.
const FRICTION: f64 = 0.002;
/// Where the paper takes its smaller loops, m.
const PART_M: [f64; 2] = [0.04, 0.21];

impl Prototype {
    /// Numbers of the loops; `None` for an id of another section.
    pub(super) fn bench(&self, id: &str) -> Option<f64> {
        let parts: Vec<&str> = id.split('_').collect();
        let springs = |text: &str| text.parse::<usize>().ok().filter(|n| [2, 4, 6].contains(n));
        Some(match parts.as_slice() {
            ["loop", metric @ .., n] => self.whole(springs(n)?, FRICTION, &metric.join("_"))?,
            ["friction", "nylon"] => FRICTION * AREAS[3] / self.whole(6, FRICTION, "loop_area")?,
            ["friction", "part"] => FRICTION * PART_AREA / self.part(RATES[0] + RATES[1], 0.0, FRICTION)?,
            ["friction", n] => {
                let n = springs(n)?;
                FRICTION * AREAS[n / 2 - 1] / self.whole(n, FRICTION, "loop_area")?
            }
            ["travel", "implied", n] => {
                let row = springs(n)? / 2 - 1;
                1e3 * AREAS[row] / (MEANS[row][0] - MEANS[row][1])
            }
            ["area", "part"] => self.part(NOMINAL, 0.0, FRICTION)?,
            ["area", "part", "twice"] => self.part(NOMINAL, 0.0, 2.0 * FRICTION)?,
            ["area", "part", "longer"] => self.part(NOMINAL, 0.5e-3, FRICTION)?,
            ["area", "part", "bench"] => self.part(RATES[0] + RATES[1], 0.0, 0.002_25)?,
            ["rest", "length", at] => self.rest_length_effect(at.parse::<f64>().ok()? * 1e-3)?,
            _ => return None,
        })
    }

    /// A metric over the stroke as the bench passes it, without the first half millimetre, where the roller turns about a corner.
    fn whole(&self, springs: usize, friction: f64, metric: &str) -> Option<f64> {
        let mut design = self.with(&RATES[..springs], friction);
        design.window_m = None;
        (design.motion, design.requirements) = (None, None);
        let behaviour = Behaviour::of(&design).ok()?;
        let measured = measure(&design, &behaviour);
        measured.get(metric)
    }

    /// Loop area over 40 … 210 mm, N·m, of springs that are longer by so much.
    fn part(&self, rate: f64, longer_m: f64, friction: f64) -> Option<f64> {
        let mut design = self.with(&[rate], friction);
        design.window_m = Some(PART_M);
        (design.motion, design.requirements) = (None, None);
        design.built.springs[0].stretch_m = -longer_m;
        let behaviour = Behaviour::of(&design).ok()?;
        measure(&design, &behaviour).get("loop_area")
    }

    /// Change of the force at a travel by springs that are 0.5 mm longer, %.
    fn rest_length_effect(&self, travel_m: f64) -> Option<f64> {
        let force = |longer_m: f64| {
            let mut design = self.with(&[NOMINAL], 0.0);
            design.built.springs[0].stretch_m = -longer_m;
            Some(Self::mechanism(&design)?.instant(&Drive::rest(travel_m), Sense::Frictionless).ok()?.force_n)
        };
        Some(100.0 * (force(0.5e-3)? / force(0.0)? - 1.0))
    }
}
