//! Springs side by side between the axles of the two rollers.

/// What a spring does over its length.
#[derive(Clone, Debug, PartialEq)]
pub enum SpringLaw {
    /// A straight line through the rest length.
    Linear {
        /// N/m.
        rate_n_per_m: f64,
        /// Length without force, m.
        rest_m: f64,
    },
    /// Straight pieces of force over length, N and m, the ends continued with their slope.
    Table(Vec<[f64; 2]>),
}

/// One spring.
#[derive(Clone, Debug, PartialEq)]
pub struct Spring {
    /// Its force over its length.
    pub law: SpringLaw,
    /// How far its adjusting screw stretches it, m: it acts as if it were longer by this.
    pub stretch_m: f64,
    /// kg.
    pub mass_kg: f64,
}

/// Springs side by side. Forces are those that do work on the mechanism: tension of extension springs, thrust of compression springs;
/// both are counted positive while the spring stores energy.
#[derive(Clone, Debug, PartialEq)]
pub struct Bank {
    springs: Vec<Spring>,
    /// +1 for extension springs, −1 for compression springs.
    sense: f64,
    /// Sum of all straight springs: rate, N/m, and force at length zero, N.
    straight: [f64; 2],
    /// Those with a table.
    tables: Vec<Table>,
}

/// Force, its slope, and energy over length.
#[derive(Clone, Debug, PartialEq)]
struct Table {
    /// Length, m; force, N; energy since the first knot, J.
    knots: Vec<[f64; 3]>,
    stretch_m: f64,
}

impl Table {
    fn at(&self, length_m: f64) -> [f64; 3] {
        let x = length_m + self.stretch_m;
        let last = self.knots.len() - 2;
        let i = self.knots.partition_point(|k| k[0] <= x).clamp(1, last + 1) - 1;
        let ([a, fa, e], [b, fb, _]) = (self.knots[i], self.knots[i + 1]);
        let (slope, over) = ((fb - fa) / (b - a), x - a);
        [fa + slope * over, slope, e + over * (fa + 0.5 * slope * over)]
    }
}

impl Bank {
    /// Springs side by side; tables have at least two knots of rising length.
    ///
    /// `extension` says whether they are stretched (else compressed) while they store energy. Forces in tables are tensions or thrusts
    /// accordingly.
    pub fn new(springs: Vec<Spring>, extension: bool) -> Self {
        let sense = if extension { 1.0 } else { -1.0 };
        let mut straight = [0.0; 2];
        let mut tables = Vec::new();
        for spring in &springs {
            match &spring.law {
                SpringLaw::Linear { rate_n_per_m, rest_m } => {
                    straight[0] += rate_n_per_m;
                    straight[1] += rate_n_per_m * (spring.stretch_m - rest_m);
                }
                SpringLaw::Table(points) => {
                    let mut energy = 0.0;
                    let mut knots: Vec<[f64; 3]> = Vec::with_capacity(points.len());
                    for &[length, force] in points {
                        // The force stored with: falling length stores energy in a compression spring.
                        let signed = sense * force;
                        if let Some(&[before, f, _]) = knots.last() {
                            energy += f64::midpoint(f, signed) * (length - before);
                        }
                        knots.push([length, signed, energy]);
                    }
                    tables.push(Table { knots, stretch_m: spring.stretch_m });
                }
            }
        }
        Self { springs, sense, straight, tables }
    }

    /// The springs.
    pub fn springs(&self) -> &[Spring] {
        &self.springs
    }

    /// +1 for extension springs, −1 for compression springs.
    pub fn sense(&self) -> f64 {
        self.sense
    }

    /// Tension along the line between the axles, N, and its slope over the length, N/m; thrust is negative.
    pub fn tension_n(&self, length_m: f64) -> [f64; 2] {
        let [rate, at_zero] = self.straight;
        let mut sum = [at_zero + rate * length_m, rate];
        for table in &self.tables {
            let [force, slope, _] = table.at(length_m);
            sum[0] += force;
            sum[1] += slope;
        }
        sum
    }

    /// Energy stored from one length to another, J.
    pub fn energy_j(&self, from_m: f64, to_m: f64) -> f64 {
        let [rate, at_zero] = self.straight;
        let straight = (to_m - from_m) * (at_zero + rate * f64::midpoint(from_m, to_m));
        straight + self.tables.iter().map(|t| t.at(to_m)[2] - t.at(from_m)[2]).sum::<f64>()
    }

    /// Whether the force is a straight line of the length.
    pub fn is_straight(&self) -> bool {
        self.tables.is_empty()
    }

    /// Lengths at which the slope changes, m.
    pub fn kinks_m(&self) -> impl Iterator<Item = f64> + '_ {
        self.tables.iter().flat_map(|t| t.knots.iter().map(|k| k[0] - t.stretch_m))
    }

    /// Mass of all, kg.
    pub fn mass_kg(&self) -> f64 {
        self.springs.iter().map(|s| s.mass_kg).sum()
    }

    /// Length without force, m; `None` if no single length has it.
    pub fn rest_m(&self) -> Option<f64> {
        let [rate, at_zero] = self.straight;
        (self.is_straight() && rate > 0.0).then(|| -at_zero / rate)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn linear(rate: f64, rest: f64, stretch: f64) -> Spring {
        Spring { law: SpringLaw::Linear { rate_n_per_m: rate, rest_m: rest }, stretch_m: stretch, mass_kg: 0.09 }
    }

    #[test]
    fn unequal_springs_add_and_a_screw_shortens_the_rest_length() {
        let bank = Bank::new(vec![linear(683.0, 0.136, 0.0), linear(682.0, 0.136, 0.0014)], true);
        let [force, rate] = bank.tension_n(0.2);
        assert!((force - (683.0 * 0.064 + 682.0 * 0.0654)).abs() < 1e-12 && (rate - 1365.0).abs() < 1e-12);
        assert!((bank.rest_m().expect("straight") - (0.136 - 0.0014 * 682.0 / 1365.0)).abs() < 1e-15);
        let stored = 683.0 * 0.064 * 0.064 / 2.0 + 682.0 * (0.0654 * 0.0654 - 0.0014 * 0.0014) / 2.0;
        assert!((bank.energy_j(0.136, 0.2) - stored).abs() < 1e-13);
    }

    /// A table of two points is a straight spring; energy is the integral of the force.
    #[test]
    fn a_table_agrees_with_the_line_that_it_tabulates() {
        let table = Spring { law: SpringLaw::Table(vec![[0.1, 0.0], [0.2, 50.0], [0.3, 150.0]]), stretch_m: 0.0, mass_kg: 0.0 };
        let bank = Bank::new(vec![table], true);
        assert!((bank.tension_n(0.15)[0] - 25.0).abs() < 1e-13);
        assert!((bank.energy_j(0.1, 0.3) - 12.5).abs() < 1e-14);
        let thrust = Spring { law: SpringLaw::Table(vec![[0.1, 50.0], [0.2, 0.0]]), stretch_m: 0.0, mass_kg: 0.0 };
        let bank = Bank::new(vec![thrust], false);
        assert!((bank.tension_n(0.15)[0] + 25.0).abs() < 1e-13, "thrust is negative tension");
        assert!((bank.energy_j(0.2, 0.1) - 2.5).abs() < 1e-14);
    }
}
