//! Helical springs of round wire: rate, stress, and extension springs for a wanted rate, length and reach.
//!
//! Formulas of EN 13906-1 and EN 13906-2 (`en13906-1`, `en13906-2`) and of Budynas & Nisbett, "Shigley's Mechanical Engineering Design",
//! chapter 10 (`budynas-nisbett2011`), which agree: the stress factor of the standards is that of Bergsträsser.
//!
//! ```
//! use forcewright_elements::springs::{self, Wanted};
//!
//! // Two roller axles, 136.5 mm apart at rest and 268 mm at the end; 0.69 N/mm each.
//! let wanted = Wanted { rate_n_per_m: 690.0, rest_length_m: 0.1365, longest_m: 0.268, initial_force_n: 0.0, grade: "SH" };
//! let found = springs::extension_springs(&wanted).expect("some wire fits");
//! let best = &found[0];
//! assert!((best.helix.rate_n_per_m(81.5e9) / 690.0 - 1.0).abs() < 1e-9 && best.utilisation <= 1.0);
//! ```

mod wire;

use std::f64::consts::PI;
use std::fmt;

use forcewright_base::maths::exp;
use forcewright_base::roots;
pub use wire::{Grade, Wire, grade, wire};

/// The coils of a spring of round wire.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Helix {
    /// Wire diameter d, m; above 0.
    pub wire_m: f64,
    /// Mean coil diameter D, m; above the wire diameter.
    pub mean_m: f64,
    /// Number of coils that give, n; above 0.
    pub coils: f64,
}

impl Helix {
    /// Spring index `D / d`.
    pub fn index(&self) -> f64 {
        self.mean_m / self.wire_m
    }

    /// Rate `G d⁴ / (8 D³ n)`, N/m. Shigley, eq. (10–9).
    pub fn rate_n_per_m(&self, shear_modulus_pa: f64) -> f64 {
        let (square, cube) = (self.wire_m * self.wire_m, self.mean_m * self.mean_m * self.mean_m);
        shear_modulus_pa * square * square / (8.0 * cube * self.coils)
    }

    /// Bergsträsser's factor `(w + 0.5) / (w − 0.75)` for the stress at the inside of the coil; that of EN 13906, and Shigley's `K_B`,
    /// eq. (10–5).
    pub fn bergstraesser(&self) -> f64 {
        (self.index() + 0.5) / (self.index() - 0.75)
    }

    /// Wahl's factor `(4w − 1) / (4w − 4) + 0.615 / w`, for the same; Shigley's `K_W`, eq. (10–4). At most 1.4 % larger.
    pub fn wahl(&self) -> f64 {
        let w = self.index();
        (4.0 * w - 1.0) / (4.0 * w - 4.0) + 0.615 / w
    }

    /// Shear stress without a factor, `8 F D / (π d³)`, Pa.
    pub fn nominal_shear_pa(&self, force_n: f64) -> f64 {
        8.0 * force_n * self.mean_m / (PI * self.wire_m * self.wire_m * self.wire_m)
    }

    /// Shear stress at the inside of the coil with Bergsträsser's factor, Pa.
    pub fn shear_pa(&self, force_n: f64) -> f64 {
        self.bergstraesser() * self.nominal_shear_pa(force_n)
    }

    /// Mass of the coils, kg, for a density (kg/m³) and a small pitch.
    pub fn mass_kg(&self, density_kg_per_m3: f64) -> f64 {
        density_kg_per_m3 * 0.25 * PI * self.wire_m * self.wire_m * PI * self.mean_m * self.coils
    }

    /// Initial forces (N) that coils wound on each other usually get, from the least to the largest: shear stresses without a factor of
    /// `231 / exp(0.105 w) ± 6.9 (4 − (w − 3) / 6.5)` N/mm². Shigley, eq. (10–41).
    pub fn usual_initial_forces_n(&self) -> [f64; 2] {
        let w = self.index();
        let (middle_pa, reach_pa) = (231e6 / exp(0.105 * w), 6.9e6 * (4.0 - (w - 3.0) / 6.5));
        [middle_pa - reach_pa, middle_pa + reach_pa].map(|shear_pa| shear_pa.max(0.0) / self.nominal_shear_pa(1.0))
    }

    /// Stresses in a hook (Pa) under a force: bending where it is bent to the middle of the coil with the radius `loop_m`, and shear where it
    /// leaves the coil with the radius `side_m`. Shigley, eqs. (10–34) to (10–37).
    pub fn hook_stresses_pa(&self, force_n: f64, loop_m: f64, side_m: f64) -> [f64; 2] {
        let (d, c1, c2) = (self.wire_m, 2.0 * loop_m / self.wire_m, 2.0 * side_m / self.wire_m);
        let bent = (4.0 * c1 * c1 - c1 - 1.0) / (4.0 * c1 * (c1 - 1.0));
        let bending_pa = 2.0 * bent * self.nominal_shear_pa(force_n) + 4.0 * force_n / (PI * d * d);
        [bending_pa, (4.0 * c2 - 1.0) / (4.0 * c2 - 4.0) * self.nominal_shear_pa(force_n)]
    }
}

/// An extension spring that is wanted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wanted<'a> {
    /// Rate, N/m; above 0.
    pub rate_n_per_m: f64,
    /// Length at rest from the inside of one hook to that of the other, m; above 0.
    pub rest_length_m: f64,
    /// Largest length, m; above that at rest.
    pub longest_m: f64,
    /// Force at which the coils part, N; 0 for coils that only touch.
    pub initial_force_n: f64,
    /// Grade of the wire: a name that [`grade`] knows.
    pub grade: &'a str,
}

/// An extension spring that has the wanted rate and length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExtensionSpring {
    /// Its coils.
    pub helix: Helix,
    /// Length of the coils at rest, `(n + 1) d`, m.
    pub body_m: f64,
    /// Length of each hook from the coils to its inside, m: 0.95 of the inner diameter.
    pub hook_m: f64,
    /// Force at the largest length, N.
    pub longest_force_n: f64,
    /// Shear stress there, with Bergsträsser's factor, Pa.
    pub longest_shear_pa: f64,
    /// That over the permissible one, 0.45 of the least tensile strength. The hooks are not in it: see [`Helix::hook_stresses_pa`].
    pub utilisation: f64,
    /// Whether the initial force is one that coils usually get.
    pub initial_force_is_usual: bool,
    /// Mass of the coils, kg.
    pub mass_kg: f64,
}

/// Why there is no such spring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SpringError {
    /// A number is not what its documentation asks for.
    Wanted,
    /// No such grade.
    Grade,
    /// No stocked wire gives the rate at this length with an index of 4 to 16 and at least 3 coils.
    NoneFits,
    /// Springs fit, but all are overstressed at the largest length.
    NoneHolds {
        /// Stress over the permissible one, of the best.
        utilisation: f64,
        /// Its wire diameter, m.
        wire_m: f64,
    },
}

impl fmt::Display for SpringError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Wanted => {
                write!(f, "rate and lengths must be above 0, the largest length above that at rest, the initial force at least 0")
            }
            Self::Grade => write!(f, "no such grade of spring wire; there are SM, DM, SH and DH"),
            Self::NoneFits => write!(
                f,
                "no wire in stock gives this rate at this length; change the length at rest, or share the rate among more springs"
            ),
            Self::NoneHolds { utilisation, wire_m } => write!(
                f,
                "the best spring (wire of {} mm) has {utilisation:.2} of the permissible stress; stretch it less, lengthen it at rest, or lower the rate",
                1e3 * wire_m
            ),
        }
    }
}

impl std::error::Error for SpringError {}

/// Indices that are wound without trouble. EN 13906-2 goes to 20.
const INDEX: [f64; 2] = [4.0, 16.0];

/// Least number of coils. EN 13906-2, its range of validity.
const LEAST_COILS: f64 = 3.0;

/// Length of a full loop over the inner diameter, the middle of 0.8 … 1.1. EN 13906-2, annex A.
const LOOP: f64 = 0.95;

/// Extension springs of stocked wire with full loops that have the wanted rate and length and hold at the largest length; the lightest
/// first. A wire may have two: a long slim one and a short wide one.
///
/// Static load; fatigue and the hooks are not assessed.
///
/// # Errors
/// [`SpringError`]
pub fn extension_springs(wanted: &Wanted<'_>) -> Result<Vec<ExtensionSpring>, SpringError> {
    let positive = |x: f64| x > 0.0 && x.is_finite();
    let Wanted { rate_n_per_m, rest_length_m, longest_m, initial_force_n, grade: name } = *wanted;
    let lengths_hold = positive(rest_length_m) && longest_m > rest_length_m && longest_m.is_finite();
    if !(positive(rate_n_per_m) && lengths_hold && initial_force_n >= 0.0 && initial_force_n.is_finite()) {
        return Err(SpringError::Wanted);
    }
    let grade = grade(name).ok_or(SpringError::Grade)?;
    let mut fitting: Vec<ExtensionSpring> =
        wire().diameters_m.iter().flat_map(|wire_m| helices(*wire_m, wanted)).filter_map(|helix| stretched(helix, wanted, grade)).collect();
    let least = fitting.iter().min_by(|a, b| a.utilisation.total_cmp(&b.utilisation)).copied().ok_or(SpringError::NoneFits)?;
    fitting.retain(|spring| spring.utilisation <= 1.0);
    if fitting.is_empty() {
        return Err(SpringError::NoneHolds { utilisation: least.utilisation, wire_m: least.helix.wire_m });
    }
    fitting.sort_by(|a, b| a.mass_kg.total_cmp(&b.mass_kg));
    Ok(fitting)
}

/// Coils of a wire with the wanted rate and, with their hooks, the wanted length.
fn helices(wire_m: f64, wanted: &Wanted<'_>) -> Vec<Helix> {
    let with_index = |index: f64| {
        let one = Helix { wire_m, mean_m: index * wire_m, coils: 1.0 };
        Helix { coils: one.rate_n_per_m(wire().shear_modulus_pa.value) / wanted.rate_n_per_m, ..one }
    };
    let excess = |index: f64| {
        let helix = with_index(index);
        body_m(&helix) + 2.0 * hook_m(&helix) - wanted.rest_length_m
    };
    // Coils shrink with the third power of the index, hooks grow: the length is least where 3 n d = 2 · 0.95 D.
    let one = with_index(1.0).coils;
    let least = (3.0 * one / (2.0 * LOOP)).sqrt().sqrt().clamp(INDEX[0], INDEX[1]);
    let between = |a: f64, b: f64| if a < b { roots::root(excess, a, b, 1e-12).ok() } else { None };
    let mut found: Vec<Helix> = [between(INDEX[0], least), between(least, INDEX[1])].into_iter().flatten().map(with_index).collect();
    found.retain(|helix| helix.coils >= LEAST_COILS);
    found
}

fn body_m(helix: &Helix) -> f64 {
    (helix.coils + 1.0) * helix.wire_m
}

fn hook_m(helix: &Helix) -> f64 {
    LOOP * (helix.mean_m - helix.wire_m)
}

fn stretched(helix: Helix, wanted: &Wanted<'_>, grade: &Grade) -> Option<ExtensionSpring> {
    let longest_force_n = wanted.initial_force_n + wanted.rate_n_per_m * (wanted.longest_m - wanted.rest_length_m);
    let longest_shear_pa = helix.shear_pa(longest_force_n);
    let permissible_pa = wire().extension_limit.value * grade.tensile_strength_pa(helix.wire_m)?;
    let [low, high] = helix.usual_initial_forces_n();
    Some(ExtensionSpring {
        helix,
        body_m: body_m(&helix),
        hook_m: hook_m(&helix),
        longest_force_n,
        longest_shear_pa,
        utilisation: longest_shear_pa / permissible_pa,
        initial_force_is_usual: low <= wanted.initial_force_n && wanted.initial_force_n <= high,
        mass_kg: helix.mass_kg(wire().density_kg_per_m3.value),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const INCH: f64 = 0.0254;
    const POUND: f64 = 4.448_221_615_260_5;
    const PSI: f64 = POUND / (INCH * INCH);

    fn near(ours: f64, printed: f64, half_digit: f64) {
        assert!((ours - printed).abs() <= half_digit, "{ours} instead of {printed}");
    }

    /// Shigley, problem 10–3: music wire of 2.5 mm, outer diameter 31 mm, 13 coils, G = 81 kN/mm². Printed: 1.314 N/mm, `K_B` = 1.117, and
    /// 167.9 N at a shear stress of 871.2 N/mm².
    #[test]
    fn a_compression_spring_of_the_book() {
        let helix = Helix { wire_m: 2.5e-3, mean_m: 28.5e-3, coils: 13.0 };
        near(helix.rate_n_per_m(81e9), 1314.0, 0.5);
        near(helix.bergstraesser(), 1.117, 5e-4);
        near(871.2e6 / helix.shear_pa(1.0), 167.9, 0.05);
        // Problem 10–1: Wahl's factor is larger by 1.36 % at an index of 4 and 0.743 % at 12.
        for (index, percent) in [(4.0, 1.36), (12.0, 0.743)] {
            let helix = Helix { wire_m: 1.0, mean_m: index, coils: 1.0 };
            near(100.0 * (helix.wahl() - helix.bergstraesser()) / helix.wahl(), percent, 5e-3);
        }
    }

    /// Mott, "Machine Elements in Mechanical Design", 4th ed., section 19–7 (`mott2004`): wire of 0.072 in, D = 0.553 in, 26.75 lb.
    /// Printed: index 7.68, Wahl's factor 1.19, 120 000 psi, 16.3 coils for 14.0 lb/in with G = 11.5e6 psi.
    #[test]
    fn an_extension_spring_of_mott() {
        let helix = Helix { wire_m: 0.072 * INCH, mean_m: 0.553 * INCH, coils: 16.3 };
        near(helix.index(), 7.68, 5e-3);
        near(helix.wahl(), 1.19, 5e-3);
        near(helix.wahl() * helix.nominal_shear_pa(26.75 * POUND) / PSI, 120_000.0, 500.0);
        near(helix.rate_n_per_m(11.5e6 * PSI) / (POUND / INCH), 14.0, 0.05);
    }

    /// Shigley, example 10–6: hard-drawn wire of 0.035 in, outer diameter 0.248 in, 12.17 coils and G/E more for the hooks, initial tension
    /// 1.19 lbf, hook radii 0.106 and 0.089 in. Printed: 17.91 lbf/in, 15.1 kpsi at the initial tension; at 5.25 lbf 82.0 kpsi in the coils,
    /// 156.9 kpsi of bending and 78.4 kpsi of shear in the hook (with a factor rounded to 1.18).
    #[test]
    fn an_extension_spring_of_shigley() {
        let helix = Helix { wire_m: 0.035 * INCH, mean_m: 0.213 * INCH, coils: 12.17 + 11.6 / 28.7 };
        near(helix.rate_n_per_m(11.6e6 * PSI) / (POUND / INCH), 17.91, 5e-3);
        near(helix.nominal_shear_pa(1.19 * POUND) / PSI, 15_100.0, 50.0);
        near(helix.shear_pa(5.25 * POUND) / PSI, 82_000.0, 50.0);
        let [bending_pa, shear_pa] = helix.hook_stresses_pa(5.25 * POUND, 0.106 * INCH, 0.089 * INCH);
        near(bending_pa / PSI, 156_900.0, 50.0);
        near(shear_pa / PSI * 1.18 / (1.0 + 0.75 / (5.086 - 1.0)), 78_400.0, 100.0);
        // Its initial tension is a usual one: 33 500 / exp(0.105 C) ± 1000 (4 − (C − 3) / 6.5) psi.
        let [low, high] = helix.usual_initial_forces_n();
        let c = helix.index();
        let (middle, reach) = (33_500.0 / exp(0.105 * c), 1000.0 * (4.0 - (c - 3.0) / 6.5));
        near(helix.nominal_shear_pa(low) / PSI, middle - reach, 5e-3 * middle);
        near(helix.nominal_shear_pa(high) / PSI, middle + reach, 5e-3 * middle);
        assert!(low < 1.19 * POUND && 1.19 * POUND < high);
    }

    const WANTED: Wanted<'_> = Wanted { rate_n_per_m: 690.0, rest_length_m: 0.1365, longest_m: 0.268, initial_force_n: 0.0, grade: "SH" };

    /// What is found has rate, length and stress by the formulas written out here, in order, and obeys the limits.
    #[test]
    fn found_springs_are_what_was_wanted() {
        for wanted in [WANTED, Wanted { initial_force_n: 6.0, grade: "SM", ..WANTED }] {
            let found = extension_springs(&wanted).unwrap();
            assert!(found.windows(2).all(|pair| pair[0].mass_kg <= pair[1].mass_kg));
            for spring in &found {
                let Helix { wire_m: d, mean_m, coils } = spring.helix;
                near(81.5e9 * d * d * d * d / (8.0 * mean_m * mean_m * mean_m * coils), 690.0, 1e-6);
                near((coils + 1.0) * d + 2.0 * 0.95 * (mean_m - d), wanted.rest_length_m, 1e-12);
                near(spring.body_m + 2.0 * spring.hook_m, wanted.rest_length_m, 1e-12);
                near(spring.longest_force_n, wanted.initial_force_n + 690.0 * (0.268 - 0.1365), 1e-9);
                let strength_pa = grade(wanted.grade).unwrap().tensile_strength_pa(d).unwrap();
                near(spring.utilisation, spring.helix.shear_pa(spring.longest_force_n) / (0.45 * strength_pa), 1e-12);
                assert!(spring.utilisation <= 1.0 && (4.0..=16.0).contains(&spring.helix.index()) && coils >= 3.0);
                let wire_kg = 7850.0 * PI * d * d / 4.0 * PI * mean_m * coils;
                near(spring.mass_kg, wire_kg, 1e-12);
            }
        }
    }

    /// Both springs of a wire: the long slim one and the short wide one, in a case with both.
    #[test]
    fn a_wire_may_have_two() {
        let found = helices(3e-3, &Wanted { rate_n_per_m: 11_782.0, rest_length_m: 0.0585, longest_m: 0.06, ..WANTED });
        assert_eq!(found.len(), 2, "{found:?}");
        assert!(found[0].index() < found[1].index() && found[0].coils > found[1].coils);
    }

    /// A spring of twice the size from the same steel: rate twice, force four times, the same stress.
    #[test]
    fn scales_as_it_should() {
        let small = Helix { wire_m: 1e-3, mean_m: 8e-3, coils: 20.0 };
        let large = Helix { wire_m: 2e-3, mean_m: 16e-3, coils: 20.0 };
        near(large.rate_n_per_m(8e10) / small.rate_n_per_m(8e10), 2.0, 1e-14);
        near(large.shear_pa(40.0) / small.shear_pa(10.0), 1.0, 1e-14);
    }

    #[test]
    fn faults_are_named() {
        let fault = |wanted: Wanted<'_>| extension_springs(&wanted).unwrap_err();
        assert_eq!(fault(Wanted { grade: "SL", ..WANTED }), SpringError::Grade);
        for wanted in [
            Wanted { rate_n_per_m: 0.0, ..WANTED },
            Wanted { rest_length_m: f64::NAN, ..WANTED },
            Wanted { longest_m: 0.1, ..WANTED },
            Wanted { initial_force_n: -1.0, ..WANTED },
        ] {
            assert_eq!(fault(wanted), SpringError::Wanted);
        }
        assert_eq!(fault(Wanted { rate_n_per_m: 1e9, ..WANTED }), SpringError::NoneFits);
        assert!(matches!(fault(Wanted { longest_m: 5.0, ..WANTED }), SpringError::NoneHolds { utilisation, .. } if utilisation > 1.0));
    }
}
