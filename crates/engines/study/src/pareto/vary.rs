//! New designs from old ones.

use forcewright_base::maths::powf;

use super::{Kind, Settings};
use crate::random::Random;

/// Parents that differ by less than this part of the range are the same.
const SAME: f64 = 1e-14;

/// A value of each variable at a point of the unit cube.
pub(super) fn placed(kinds: &[Kind], point: &[f64]) -> Vec<f64> {
    kinds.iter().zip(point).map(|(kind, u)| kind.at(*u)).collect()
}

impl Kind {
    /// The ends between which operators work: half a step beyond the outer ones of whole numbers, so that each value has as much room.
    fn ends(&self) -> [f64; 2] {
        match self {
            Self::Real { lower, upper } => [*lower, *upper],
            Self::Whole { lower, upper } => [*lower as f64 - 0.5, *upper as f64 + 0.5],
            Self::Choice { count } => [-0.5, *count as f64 - 0.5],
        }
    }

    /// The value that is meant by a number.
    pub(super) fn rounded(&self, value: f64) -> f64 {
        match self {
            Self::Real { lower, upper } => value.max(*lower).min(*upper),
            Self::Whole { lower, upper } => value.round().max(*lower as f64).min(*upper as f64),
            Self::Choice { count } => value.round().max(0.0).min(*count as f64 - 1.0),
        }
    }

    /// The value at a part of the range, 0 to 1.
    fn at(&self, part: f64) -> f64 {
        let [lower, upper] = self.ends();
        self.rounded(lower + part * (upper - lower))
    }

    /// Whether it has one value only.
    fn fixed(&self) -> bool {
        match self {
            Self::Real { lower, upper } => upper <= lower,
            Self::Whole { lower, upper } => upper <= lower,
            Self::Choice { count } => *count < 2,
        }
    }
}

/// Two children of two parents, mutated.
pub(super) fn children(kinds: &[Kind], parents: [&[f64]; 2], settings: &Settings, random: &mut Random) -> [Vec<f64>; 2] {
    let mut children = parents.map(<[f64]>::to_vec);
    if random.unit() < settings.crossover {
        for (i, kind) in kinds.iter().enumerate() {
            let pair = [parents[0][i], parents[1][i]];
            let crossed = match kind {
                // A choice has no values between.
                Kind::Choice { .. } => pair,
                _ => simulated_binary(kind.ends(), pair, settings.crossover_index, random).map(|v| kind.rounded(v)),
            };
            let crossed = if random.unit() < 0.5 { [crossed[1], crossed[0]] } else { crossed };
            (children[0][i], children[1][i]) = (crossed[0], crossed[1]);
        }
    }
    for child in &mut children {
        mutate(kinds, child, settings, random);
    }
    children
}

/// Changes about one variable: each with the probability 1/n.
pub(super) fn mutate(kinds: &[Kind], x: &mut [f64], settings: &Settings, random: &mut Random) {
    let part = 1.0 / kinds.iter().filter(|k| !k.fixed()).count().max(1) as f64;
    for (kind, value) in kinds.iter().zip(x) {
        if kind.fixed() || random.unit() >= part {
            continue;
        }
        *value = match kind {
            // Any of the others.
            Kind::Choice { count } => {
                let other = random.below(count - 1) as f64;
                if other >= *value { other + 1.0 } else { other }
            }
            Kind::Real { .. } => kind.rounded(polynomial(kind.ends(), *value, settings.mutation_index, random)),
            Kind::Whole { .. } => {
                let new = kind.rounded(polynomial(kind.ends(), *value, settings.mutation_index, random));
                // A change too small to be one is a step of one.
                let side = if random.unit() < 0.5 { -1.0 } else { 1.0 };
                let step = kind.rounded(*value + side);
                let step = if (step - *value).abs() < 0.5 { kind.rounded(*value - side) } else { step };
                if (new - *value).abs() < 0.5 { step } else { new }
            }
        };
    }
}

/// Simulated binary crossover of one variable (K. Deb, R. B. Agrawal, "Simulated binary crossover for continuous search space", Complex
/// Systems 9 (1995) 115–148), in the form with bounds of Deb's programs: the density of the spread is cut off where a child would leave
/// the range, and scaled. Every variable takes part with probability 1/2.
fn simulated_binary([lower, upper]: [f64; 2], [a, b]: [f64; 2], index: f64, random: &mut Random) -> [f64; 2] {
    // Numbers are drawn whether they are used or not, so that the stream does not depend on rounding.
    let (takes_part, u) = (random.unit() < 0.5, random.unit());
    let (low, high) = (a.min(b), a.max(b));
    if !takes_part || high - low <= SAME * (upper - lower) {
        return [a, b];
    }
    let spread = |room: f64| {
        let beta = 1.0 + 2.0 * room / (high - low);
        let alpha = 2.0 - powf(beta, -(index + 1.0));
        let power = 1.0 / (index + 1.0);
        if u * alpha <= 1.0 { powf(u * alpha, power) } else { powf(1.0 / (2.0 - u * alpha), power) }
    };
    let one = 0.5 * (low + high - spread(low - lower) * (high - low));
    let other = 0.5 * (low + high + spread(upper - high) * (high - low));
    let [one, other] = [one, other].map(|v| v.max(lower).min(upper));
    if a <= b { [one, other] } else { [other, one] }
}

/// Polynomial mutation (K. Deb, M. Goyal, "A combined genetic adaptive search (`GeneAS`) for engineering design", Computer Science and
/// Informatics 26(4) (1996) 30–45), in the form with bounds of Deb's programs.
fn polynomial([lower, upper]: [f64; 2], value: f64, index: f64, random: &mut Random) -> f64 {
    let (u, width) = (random.unit(), upper - lower);
    let power = 1.0 / (index + 1.0);
    let step = if u < 0.5 {
        let rest = 1.0 - (value - lower) / width;
        powf(2.0 * u + (1.0 - 2.0 * u) * powf(rest, index + 1.0), power) - 1.0
    } else {
        let rest = 1.0 - (upper - value) / width;
        1.0 - powf(2.0 * (1.0 - u) + 2.0 * (u - 0.5) * powf(rest, index + 1.0), power)
    };
    (value + step * width).max(lower).min(upper)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Far from the ends children lie as far from the middle of their parents on either side, and the spread β has the distribution of
    /// the paper: P(β ≤ 1) = 1/2 and, for β > 1, P = 1 − β^−(η+1)/2. Half of the pairs do not take part.
    #[test]
    fn crossover_has_the_spread_of_the_paper() {
        let mut random = Random::new(1);
        let (mut below_one, mut below_two, mut taken) = (0.0, 0.0, 0.0);
        for _ in 0..40_000 {
            let [a, b] = simulated_binary([-1e6, 1e6], [1.0, 3.0], 2.0, &mut random);
            assert!((a + b - 4.0).abs() < 1e-9);
            let beta = (b - a) / 2.0;
            if (beta - 1.0).abs() < 1e-12 {
                continue;
            }
            taken += 1.0;
            below_one += f64::from(u8::from(beta <= 1.0));
            below_two += f64::from(u8::from(beta <= 2.0));
        }
        // Five standard deviations of a part of 20 000 are 0.018.
        assert!((taken / 40_000.0_f64 - 0.5).abs() < 0.0125);
        assert!((below_one / taken - 0.5_f64).abs() < 0.018);
        assert!((below_two / taken - (1.0 - 0.5 / 8.0_f64)).abs() < 0.009);
    }

    #[test]
    fn nothing_leaves_its_range_and_every_value_is_reached() {
        let kinds = [
            Kind::Real { lower: -1.0, upper: 2.0 },
            Kind::Whole { lower: 3, upper: 7 },
            Kind::Choice { count: 4 },
            Kind::Whole { lower: 2, upper: 2 },
        ];
        let mut random = Random::new(2);
        let (mut parents, mut whole, mut choice) = ([vec![-1.0, 3.0, 0.0, 2.0], vec![2.0, 7.0, 3.0, 2.0]], [0; 5], [0; 4]);
        for _ in 0..4000 {
            parents = children(&kinds, [&parents[0], &parents[1]], &Settings::default(), &mut random);
            for x in &parents {
                assert!((-1.0..=2.0).contains(&x[0]) && (3.0..=7.0).contains(&x[1]) && (0.0..=3.0).contains(&x[2]));
                assert!(x[1..].iter().all(|v| v.fract().abs() < 1e-12) && (x[3] - 2.0).abs() < 1e-12);
                (3..=7_u8).filter(|v| (x[1] - f64::from(*v)).abs() < 0.1).for_each(|v| whole[usize::from(v - 3)] += 1);
                (0..=3_u8).filter(|v| (x[2] - f64::from(*v)).abs() < 0.1).for_each(|v| choice[usize::from(v)] += 1);
            }
        }
        assert!(whole.iter().chain(&choice).all(|count| *count > 100), "{whole:?} {choice:?}");
        // Each value of a whole number has as much of the unit interval.
        assert_eq!(placed(&kinds[1..3], &[0.19, 0.74]), [3.0, 2.0]);
        assert_eq!(placed(&kinds[1..3], &[0.21, 0.76]), [4.0, 3.0]);
    }

    /// Mutation in the middle of a range: as often up as down, the mean size of a step is 1/(η + 2) of the room on its side, to first order.
    #[test]
    fn mutation_is_even_and_small() {
        let mut random = Random::new(3);
        let steps: Vec<f64> = (0..40_000).map(|_| polynomial([0.0, 1.0], 0.5, 20.0, &mut random) - 0.5).collect();
        let up = steps.iter().filter(|s| **s > 0.0).count();
        assert!(up.abs_diff(20_000) < 500, "{up}");
        // E|δ| of δ = 1 − v^(1/21), v even in (0, 1): 1 − 21/22.
        let mean = steps.iter().map(|s| s.abs()).sum::<f64>() / 40_000.0;
        assert!((mean * 22.0 - 1.0).abs() < 0.03, "{mean}");
    }
}
