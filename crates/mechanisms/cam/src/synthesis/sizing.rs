//! Sizes in closed form: every combination of what there is, with its cam cut and looked at.

use std::sync::Arc;

use forcewright_base::maths;
use forcewright_elements::springs::{Helix, Wanted, extension_springs};

use crate::cut::{Cut, CutSide, Purpose, SIDES};
use crate::law::ForceLaw;
use crate::mechanism::{Bodies, Drive, Mechanism, Sense, SpringMass};
use crate::path::{Flaws, SidePath, corner};
use crate::springs::{Bank, Spring, SpringLaw};

/// Springs that there are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Offer {
    /// One of a catalogue.
    Spring { rate_n_per_m: f64, rest_m: f64, most_m: f64, mass_kg: f64 },
    /// Any that may be stretched to so many times its rest length.
    Free { extension: f64 },
}

/// What is asked for.
#[derive(Clone, Debug)]
pub(super) struct Asked {
    pub law: ForceLaw,
    pub band: f64,
    pub stroke_m: f64,
    pub window_m: Option<[f64; 2]>,
    pub hysteresis: Option<f64>,
    /// Width and height.
    pub room_m: [f64; 2],
    pub arm_m: f64,
    /// Along the travel, m/s²: the springs have weight.
    pub gravity_m_per_s2: f64,
    pub offers: Vec<Offer>,
    pub most_springs: u32,
    pub rollers_m: Vec<f64>,
    /// Grade of the wire of which free springs are wound.
    pub grade: String,
}

/// A size that keeps to all.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Size {
    pub count: f64,
    pub rate_n_per_m: f64,
    pub rest_m: f64,
    pub most_m: f64,
    pub spring_kg: f64,
    /// How a free spring is wound.
    pub helix: Option<Helix>,
    pub start_m: f64,
    pub brace_m: f64,
    pub roller_m: f64,
    pub width_m: f64,
    pub height_m: f64,
    pub hysteresis: f64,
}

/// Thickness of the mechanism, for the room: plate, springs on either side, m.
const DEPTH_M: f64 = 0.05;
/// Two designs with the same springs and rollers are different if their room differs by this part.
const DIFFERENT: f64 = super::DIFFERENT;
/// Lengths of the braces over how far out the rollers go.
const BRACES: [f64; 6] = [1.08, 1.15, 1.25, 1.4, 1.65, 2.0];
/// Springs stretched at the start, relative to their rest length.
const PRELOADS: [f64; 9] = [0.0, 0.01, 0.02, 0.04, 0.07, 0.12, 0.2, 0.3, 0.45];
/// How far inside its limits a size is kept.
const INSIDE: f64 = 0.99;
/// Places at which the forces both ways are compared.
const PROBES: usize = 9;
/// Rest lengths tried of free springs, over the radius of the roller.
const RESTS: [f64; 12] = [2.6, 3.2, 4.0, 5.0, 6.3, 8.0, 10.0, 12.5, 16.0, 20.0, 25.0, 32.0];

impl Size {
    /// Room that it takes, m³.
    pub(super) fn cost_m3(&self) -> f64 {
        self.width_m * self.height_m * DEPTH_M
    }

    /// Whether another one is nearly the same.
    pub(super) fn is_near(&self, other: &Self) -> bool {
        let near = |a: f64, b: f64| (a / b - 1.0).abs() < DIFFERENT;
        near(self.roller_m, other.roller_m) && near(self.width_m, other.width_m) && near(self.height_m, other.height_m)
    }
}

/// Numbers of free springs side by side that are tried: in pairs on either side of the plate, so that nothing tilts.
const COUNTS: [u32; 7] = [1, 2, 4, 6, 8, 12, 16];

/// The size with the fewest springs that can be wound, as they are wound; a spring of a catalogue is there.
pub(super) fn wound(asked: &Asked, size: Size) -> Option<Size> {
    if !asked.offers.iter().any(|offer| matches!(offer, Offer::Free { .. })) {
        return Some(size);
    }
    COUNTS.iter().filter(|n| **n <= asked.most_springs).map(|n| f64::from(*n)).find_map(|count| {
        let rate_n_per_m = four_digits_up(size.rate_n_per_m / count);
        let wanted = Wanted { rate_n_per_m, rest_length_m: size.rest_m, longest_m: size.most_m, initial_force_n: 0.0, grade: &asked.grade };
        let lightest = *extension_springs(&wanted).ok()?.first()?;
        looked_at(asked, Size { count, rate_n_per_m, spring_kg: lightest.mass_kg, helix: Some(lightest.helix), ..size })
    })
}

/// Every size that keeps to what is asked; free springs are one, and not yet wound.
pub(super) fn sizes(asked: &Asked) -> Vec<Size> {
    let work_j = asked.law.work_j(asked.stroke_m);
    let mut found = Vec::new();
    for offer in &asked.offers {
        for roller_d in &asked.rollers_m {
            let roller_m = 0.5 * roller_d;
            match *offer {
                Offer::Spring { rate_n_per_m, rest_m, most_m, mass_kg } => {
                    for count in 1..=asked.most_springs {
                        let spring = [f64::from(count), rate_n_per_m, rest_m, most_m, mass_kg];
                        found.extend(with_springs(asked, spring, roller_m, work_j));
                    }
                }
                Offer::Free { extension } => {
                    for rest in RESTS {
                        let rest_m = rounded(rest * roller_m, 1e-3);
                        for preload in PRELOADS {
                            let (start, end) = (preload * rest_m, INSIDE * (extension - 1.0) * rest_m);
                            let rate = 2.0 * work_j / (end * end - start * start);
                            if start < 0.8 * end {
                                let spring = [1.0, four_digits_up(rate), rest_m, extension * rest_m, 0.0];
                                found.extend(braced(asked, spring, (roller_m, rounded_up(rest_m + start, 1e-4))));
                            }
                        }
                    }
                }
            }
        }
    }
    found
}

/// A rate that people can order: the springs end a little shorter.
fn four_digits_up(rate: f64) -> f64 {
    let place = maths::powf(10.0, maths::log10(rate).floor() - 3.0);
    (rate / place - 1e-9).ceil() * place
}

fn rounded(value: f64, step: f64) -> f64 {
    (value / step).round() * step
}

fn rounded_up(value: f64, step: f64) -> f64 {
    (value / step - 1e-9).ceil() * step
}

/// Springs with the least preload that avoids the undercut.
fn with_springs(asked: &Asked, spring: [f64; 5], roller_m: f64, work_j: f64) -> Option<Size> {
    let [count, rate, rest, most, _] = spring;
    let total = count * rate;
    // Springs that end too long whatever the preload.
    let end = |start: f64| (start * start + 2.0 * work_j / total).sqrt();
    if rest + end(0.0) > most {
        return None;
    }
    PRELOADS.iter().find_map(|preload| {
        let start_m = rounded_up(rest * (1.0 + preload), 1e-4);
        if rest + end(start_m - rest) > most {
            return None;
        }
        braced(asked, spring, (roller_m, start_m))
    })
}

/// The shortest braces with which everything is kept.
fn braced(asked: &Asked, spring: [f64; 5], (roller_m, start_m): (f64, f64)) -> Option<Size> {
    let [count, rate, rest, most, mass] = spring;
    let total = count * rate;
    let work = asked.law.work_j(asked.stroke_m);
    let deformed = ((start_m - rest) * (start_m - rest) + 2.0 * work / total).sqrt();
    let out_m = 0.5 * (rest + deformed);
    // The rollers must pass each other and their axle at the start.
    if 0.5 * start_m < 1.1 * roller_m || 2.0 * (out_m + roller_m) > asked.room_m[0] || rest + deformed > most {
        return None;
    }
    BRACES.iter().find_map(|factor| {
        let brace_m = rounded_up(factor * out_m, 1e-3);
        let size = Size {
            count,
            rate_n_per_m: rate,
            rest_m: rest,
            most_m: most,
            spring_kg: mass,
            helix: None,
            start_m,
            brace_m,
            roller_m,
            width_m: 2.0 * (out_m + roller_m),
            height_m: f64::NAN,
            hysteresis: f64::NAN,
        };
        looked_at(asked, size)
    })
}

/// The size with its height and hysteresis, if it keeps to everything.
fn looked_at(asked: &Asked, size: Size) -> Option<Size> {
    let spring = Spring {
        law: SpringLaw::Linear { rate_n_per_m: size.count * size.rate_n_per_m, rest_m: size.rest_m },
        stretch_m: 0.0,
        mass_kg: size.count * size.spring_kg,
    };
    let springs = Bank::new(vec![spring], true);
    let purpose = Purpose {
        law: asked.law.clone(),
        springs: springs.clone(),
        start_length_m: size.start_m,
        sides: [CutSide { brace_m: size.brace_m, share: 0.5 }; SIDES],
        friction: 0.0,
        stroke_m: asked.stroke_m,
    };
    let cut = Arc::new(Cut::new(purpose).ok()?);
    if corner(&cut, 0, size.roller_m * 1.001).is_some() {
        return None;
    }
    let height_m = cut.rise_m() + asked.stroke_m + 2.0 * size.roller_m;
    if height_m > asked.room_m[1] {
        return None;
    }
    let bodies = Bodies { slider_kg: 0.0, brace_kg: 0.0, brace_kg_m2: 0.0, roller_kg: 0.0, roller_kg_m2: 0.0, springs: SpringMass::Bar };
    let mechanism = Mechanism {
        paths: [0, 1].map(|side| SidePath::new(Arc::clone(&cut), side, size.roller_m, &Flaws::default())),
        brace_m: [size.brace_m; SIDES],
        roller_m: size.roller_m,
        arm_m: asked.arm_m,
        springs,
        bodies,
        gravity_m_per_s2: asked.gravity_m_per_s2,
        rise_m: cut.rise_m(),
    };
    let [from, to] = asked.window_m.unwrap_or([0.0, asked.stroke_m]);
    let (mut lost, mut kept, mut worst) = (0.0, 0.0, 0.0_f64);
    for i in 0..PROBES {
        let s = from + (to - from) * i as f64 / (PROBES - 1) as f64;
        let pose = mechanism.pose([s, 0.0]).ok()?;
        let [up, down] = [Sense::Up, Sense::Down].map(|sense| mechanism.forces(&pose, &Drive::rest(s), sense).force_n);
        let wanted = asked.law.force_n(s)[0];
        worst = worst.max((up / wanted - 1.0).abs()).max((down / wanted - 1.0).abs());
        lost += up - down;
        kept += 0.5 * (up + down);
    }
    let hysteresis = lost / kept;
    let keeps = worst <= INSIDE * asked.band && asked.hysteresis.is_none_or(|h| hysteresis <= INSIDE * h);
    keeps.then_some(Size { height_m, hysteresis, ..size })
}
