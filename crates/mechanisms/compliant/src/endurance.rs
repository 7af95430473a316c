//! What is asked of the endurance, and fatigue of fibres: what range of stress each face of a beam goes through, and how far that is from
//! what the material endures.

use forcewright_base::units::Unit;
use forcewright_beam::Face;

use crate::analysis::Behaviour;
use crate::design::{Requirements, si};
use crate::material::Endured;
use crate::spec;

impl Requirements {
    /// Keys of the requirements on endurance that it has: no study looks at them.
    pub(crate) fn endurance(&self) -> impl Iterator<Item = &'static str> + use<> {
        [self.fatigue.is_some().then_some("fatigue"), self.hold.is_some().then_some("hold")].into_iter().flatten()
    }
}

/// What is asked of the endurance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FatigueLimit {
    /// Times from rest through the travel and back.
    pub cycles: f64,
    /// Least safety factor.
    pub safety_factor: f64,
}

impl FatigueLimit {
    pub(crate) fn asked(wanted: &spec::FatigueRequirement) -> Option<Self> {
        Some(Self { cycles: si(wanted.cycles.as_ref())?, safety_factor: si(wanted.safety_factor.as_ref())? })
    }
}

/// What is asked of the force under a displacement that is held.
#[derive(Clone, Debug, PartialEq)]
pub struct HoldLimit {
    /// How long, s.
    pub time_s: f64,
    /// The unit in which that was typed.
    pub unit: Unit,
    /// Least force then, relative to that at the beginning.
    pub force_left: f64,
}

impl HoldLimit {
    pub(crate) fn asked(wanted: &spec::HoldRequirement) -> Option<Self> {
        let time = &wanted.time.as_ref()?.value;
        Some(Self { time_s: time.si, unit: time.unit.clone(), force_left: si(wanted.force_left.as_ref())? })
    }
}

/// Places along a beam at which its faces are looked at first, less one.
const PLACES: u32 = 64;

/// Goodman's line: amplitudes that are endured for some number of cycles fall in proportion from that without a mean stress to none at
/// the tensile strength.
///
/// J. Goodman, "Mechanics Applied to Engineering", Longmans 1899; as modified Goodman line in R. G. Budynas, J. K. Nisbett, "Shigley's
/// Mechanical Engineering Design", chapter 6. A mean in compression is taken as none, as there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Goodman {
    /// Amplitude endured without a mean stress, Pa.
    pub reversed_pa: f64,
    /// Tensile strength, Pa.
    pub tensile_pa: f64,
}

impl Goodman {
    /// The line through what a test has shown. `None` if its stress ratio is not known or its mean is not below the tensile strength.
    pub fn through(tested: &Endured, tensile_pa: f64) -> Option<Self> {
        let ratio = tested.stress_ratio?;
        let mean_pa = (tested.amplitude_pa * (1.0 + ratio) / (1.0 - ratio)).max(0.0);
        let reversed_pa = tested.amplitude_pa / (1.0 - mean_pa / tensile_pa);
        (reversed_pa > 0.0 && reversed_pa.is_finite()).then_some(Self { reversed_pa, tensile_pa })
    }

    /// By what amplitude and mean can be multiplied before they reach the line, for a stress between two values, Pa; infinite for none.
    pub fn safety(&self, [low_pa, high_pa]: [f64; 2]) -> f64 {
        let (amplitude_pa, mean_pa) = (0.5 * (high_pa - low_pa), f64::midpoint(low_pa, high_pa));
        1.0 / (amplitude_pa / self.reversed_pa + mean_pa.max(0.0) / self.tensile_pa)
    }
}

/// A fibre on a face of a beam, and what it goes through between the start and the end of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fibre {
    /// Index of the beam.
    pub beam: usize,
    /// Where along it, in [0, 1].
    pub u: f64,
    /// On which face.
    pub face: Face,
    /// Lowest and highest stress, Pa, tension positive.
    pub stress_pa: [f64; 2],
    /// Safety factor by [`Goodman::safety`].
    pub safety: f64,
}

/// The fibre with the least safety among the beams that have a line. Lowest and highest stress are those of rest, of the ends of earlier
/// loads, and of the computed states, at least 129 of a whole path: one that lies between two of them is missed by the square of their
/// distance. The place is refined along the beam.
pub(crate) fn worst(behaviour: &Behaviour, line_of: impl Fn(usize) -> Option<Goodman>) -> Option<Fibre> {
    let beams = behaviour.path.points.first()?.beams.len();
    let at = |beam: usize, line: &Goodman, u: f64| {
        // From rest, without stress, through the ends of earlier loads.
        let mut ranges = [[0.0_f64; 2]; 2];
        let states = behaviour.path.before.iter().chain(&behaviour.path.points);
        for stress_pa in states.filter_map(|p| p.beams.get(beam)).map(|b| b.stress_pa(u)) {
            for (range, stress_pa) in ranges.iter_mut().zip(stress_pa) {
                *range = [range[0].min(stress_pa), range[1].max(stress_pa)];
            }
        }
        let [left, right] = [(Face::Left, ranges[0]), (Face::Right, ranges[1])].map(|(face, stress_pa)| Fibre {
            beam,
            u,
            face,
            stress_pa,
            safety: line.safety(stress_pa),
        });
        lower(left, right)
    };
    let lines = (0..beams).filter_map(|beam| Some((beam, line_of(beam)?)));
    let places = lines.flat_map(|(beam, line)| (0..=PLACES).map(move |i| (beam, line, f64::from(i) / f64::from(PLACES))));
    let (fibre, line) = places
        .map(|(beam, line, u)| (at(beam, &line, u), line))
        .reduce(|best, next| if next.0.safety < best.0.safety { next } else { best })?;
    let step = 1.0 / f64::from(PLACES);
    let (from, to) = ((fibre.u - step).max(0.0), (fibre.u + step).min(1.0));
    let refined = forcewright_base::roots::minimise(|u| at(fibre.beam, &line, u).safety, from, to, 1e-6);
    Some(lower(fibre, at(fibre.beam, &line, refined.x)))
}

/// The one with the lower safety, the first of equals.
fn lower(first: Fibre, second: Fibre) -> Fibre {
    if second.safety < first.safety { second } else { first }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tested(amplitude_pa: f64, stress_ratio: Option<f64>) -> Endured {
        Endured { amplitude_pa, cycles: 1e6, stress_ratio, origin: String::new() }
    }

    #[test]
    fn the_line_goes_through_the_test_and_the_strength() {
        for (amplitude, ratio) in [(31e6, -1.0), (20e6, 0.0), (15e6, 0.3)] {
            let line = Goodman::through(&tested(amplitude, Some(ratio)), 70e6).unwrap();
            let high = 2.0 * amplitude / (1.0 - ratio);
            assert!((line.safety([ratio * high, high]) - 1.0).abs() < 1e-12, "what was endured in the test");
            assert!((line.safety([70e6, 70e6]) - 1.0).abs() < 1e-12, "and what breaks it at once");
            let half = line.safety([0.5 * ratio * high, 0.5 * high]);
            assert!((half - 2.0).abs() < 1e-12, "in proportion");
        }
        assert_eq!(Goodman::through(&tested(31e6, Some(-1.0)), 70e6).map(|l| l.reversed_pa), Some(31e6));
    }

    #[test]
    fn a_mean_in_compression_is_none() {
        let line = Goodman { reversed_pa: 30e6, tensile_pa: 70e6 };
        assert_eq!(line.safety([-60e6, 0.0]).to_bits(), 1.0_f64.to_bits());
        // Pulsating in tension: 1/(1 + 30/70).
        assert!((line.safety([0.0, 60e6]) - 0.7).abs() < 1e-12);
    }

    #[test]
    fn a_test_that_says_too_little_has_no_line() {
        assert_eq!(Goodman::through(&tested(31e6, None), 70e6), None);
        // A mean of 93 MPa in something that breaks at 70 MPa.
        assert_eq!(Goodman::through(&tested(31e6, Some(0.5)), 70e6), None);
    }
}
