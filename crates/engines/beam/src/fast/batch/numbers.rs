//! The numbers of four designs, and the constants of their beams.

use forcewright_base::maths;

use crate::fast::kernel::{Beams, Tables};
use crate::fast::lanes::Lane;
use crate::fast::stress::StressModel;
use crate::network::{Network, Theory};
use crate::section::Section;

/// One beam of four designs.
#[derive(Clone, Debug, Default)]
pub(super) struct BeamNumbers {
    /// From its start to its end, m.
    chord_m: [Lane; 2],
    /// Where the shape is given: its length, m.
    length_m: Lane,
    /// Coefficients of the angle, rad; the first is 0 where the chord decides on it.
    angle_rad: Vec<Lane>,
    young_pa: Lane,
    thickness_m: Lane,
    depth_m: Lane,
    /// E A/(κ G A), 0 where shear is rigid.
    shear: Lane,
}

impl BeamNumbers {
    pub(super) fn clear(&mut self) {
        self.angle_rad.clear();
        // The stress model and the direction need one.
        self.angle_rad.push(Lane::ZERO);
    }

    /// Fills in one design. `angle_rad` with the first coefficient, and a length where the shape is given.
    pub(super) fn set(&mut self, lane: usize, chord_m: [f64; 2], length_m: f64, angle_rad: impl Iterator<Item = f64>, section: &Section) {
        for (own, value) in self.chord_m.iter_mut().zip(chord_m) {
            own.0[lane] = value;
        }
        self.length_m.0[lane] = length_m;
        for coefficient in &mut self.angle_rad {
            coefficient.0[lane] = 0.0;
        }
        for (k, value) in angle_rad.enumerate() {
            if k == self.angle_rad.len() {
                self.angle_rad.push(Lane::ZERO);
            }
            self.angle_rad[k].0[lane] = value;
        }
        self.young_pa.0[lane] = section.young_pa;
        self.thickness_m.0[lane] = section.thickness_m;
        self.depth_m.0[lane] = section.depth_m;
        self.shear.0[lane] = section.poisson.map_or(0.0, |nu| 2.4 * (1.0 + nu));
    }

    /// The coefficients of the angle of one design, given the direction of the whole as cosine and sine.
    pub(super) fn angle_rad(&self, lane: usize, [cos, sin]: [Lane; 2], out: &mut Vec<f64>) {
        out.clear();
        out.extend(self.angle_rad.iter().map(|c| c.0[lane]));
        out[0] += maths::atan2(sin.0[lane], cos.0[lane]);
    }
}

/// What depends on the numbers alone.
#[derive(Clone, Debug, Default)]
pub(super) struct Constants<const Q: usize> {
    pub(super) beams: Vec<Beams<Q>>,
    pub(super) stress: Vec<StressModel>,
    /// Cosine and sine of the direction that the chord gives to the angle.
    pub(super) turned: Vec<[Lane; 2]>,
    /// Unit of length, m, and of force, N.
    pub(super) length_m: Lane,
    pub(super) force_n: Lane,
    /// Positive where every beam surely reaches from node to node, and the angles are in the range of the sine.
    pub(super) closed: Lane,
}

/// Largest angle at rest, rad: that of the sine in lanes.
const LARGEST_ANGLE: f64 = 50.0;
/// Chord by length below which the general path is asked.
const SHORTEST_CHORD: f64 = 1e-3;

impl<const Q: usize> Constants<Q> {
    /// `spanned` whether lengths and directions follow from the chords.
    pub(super) fn compute<const M: usize, const E: usize>(
        &mut self,
        tables: &Tables<M, Q, E>,
        numbers: &[BeamNumbers],
        spanned: bool,
        theory: Theory,
    ) {
        self.beams.resize_with(numbers.len(), Beams::default);
        self.turned.resize(numbers.len(), [Lane::ZERO; 2]);
        self.closed = Lane::splat(f64::INFINITY);
        self.length_m = Lane::ZERO;
        let mut stiffness = Lane::ZERO;
        for ((own, beams), turned) in numbers.iter().zip(&mut self.beams).zip(&mut self.turned) {
            let (length_m, direction, closed) = close(tables, own, spanned, beams);
            (beams.length, *turned) = (length_m, direction);
            self.closed = self.closed.min(closed);
            self.length_m = self.length_m.max(length_m);
            stiffness = stiffness.max(own.bending_stiffness());
        }
        let unit = Lane::splat(1.0) / self.length_m;
        self.force_n = stiffness * unit * unit;
        self.stress.resize(numbers.len(), StressModel::default());
        for (((own, beams), stress), turned) in numbers.iter().zip(&mut self.beams).zip(&mut self.stress).zip(&self.turned) {
            let length_m = beams.length;
            beams.length = length_m * unit;
            beams.bending = own.bending_stiffness() / (stiffness * beams.length);
            beams.soft = theory == Theory::Reissner;
            for q in 0..Q {
                beams.weight[q] = -(beams.length * tables.weight[q]);
            }
            let area = own.thickness_m * own.depth_m;
            let bending_pa = own.young_pa * own.thickness_m * 0.5 / length_m;
            if beams.soft {
                beams.axial = self.force_n / (own.young_pa * area);
                beams.shear = beams.axial * own.shear;
                *stress = StressModel::in_lanes(bending_pa, self.force_n / area, &own.angle_rad, *turned);
            } else {
                *stress = StressModel::in_lanes(bending_pa, Lane::ZERO, &[], *turned);
            }
        }
    }
}

impl BeamNumbers {
    /// E I, N·m².
    fn bending_stiffness(&self) -> Lane {
        let w = self.thickness_m;
        self.young_pa * w * w * w * self.depth_m * (1.0 / 12.0)
    }
}

/// The direction at rest at the points, the length in m, the direction of the whole, and whether it is safe.
#[inline]
fn close<const M: usize, const Q: usize, const E: usize>(
    tables: &Tables<M, Q, E>,
    numbers: &BeamNumbers,
    spanned: bool,
    beams: &mut Beams<Q>,
) -> (Lane, [Lane; 2], Lane) {
    let (mut reach, mut widest) = ([Lane::ZERO; 2], Lane::ZERO);
    for q in 0..Q {
        let (u, w) = (tables.u[q], tables.weight[q]);
        let angle = numbers.angle_rad.iter().rev().fold(Lane::ZERO, |sum, c| sum * u + *c);
        widest = widest.max(angle.abs());
        (beams.sin[q], beams.cos[q]) = angle.sin_cos_turned();
        reach[0] += beams.cos[q] * w;
        reach[1] += beams.sin[q] * w;
    }
    let one = Lane::splat(1.0);
    let narrow = Lane::where_above(Lane::splat(LARGEST_ANGLE), widest, one, -one);
    let [x, y] = numbers.chord_m;
    if !spanned {
        let gap = [x - reach[0] * numbers.length_m, y - reach[1] * numbers.length_m];
        let allowed = numbers.length_m * (0.5 * Network::LARGEST_GAP);
        let closed = Lane::where_above(allowed, gap[0].abs().max(gap[1].abs()), one, -one);
        return (numbers.length_m, [one, Lane::ZERO], narrow.min(closed));
    }
    let (distance, short) = ((x * x + y * y).sqrt(), (reach[0] * reach[0] + reach[1] * reach[1]).sqrt());
    let inverse = one / (distance * short);
    let (cos, sin) = ((x * reach[0] + y * reach[1]) * inverse, (y * reach[0] - x * reach[1]) * inverse);
    for q in 0..Q {
        let (c, s) = (beams.cos[q], beams.sin[q]);
        (beams.cos[q], beams.sin[q]) = (cos * c - sin * s, sin * c + cos * s);
    }
    (distance / short, [cos, sin], narrow.min(short - SHORTEST_CHORD))
}
