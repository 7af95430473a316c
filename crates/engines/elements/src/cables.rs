//! Cables for drives: stiffness, strength and the drum they need, each number with its source.
//!
//! The data are in `data/cables.toml`, by construction; sources are keys of `REFERENCES.bib`. What no source gives is absent, and a check
//! that needs it is then *not assessed*.
//!
//! ```
//! use forcewright_elements::cables;
//!
//! let cable = cables::find("7x19 stainless").expect("in the catalogue");
//! // 2 mm: 170 kN, and a drum of at least 36 mm.
//! assert!((cable.axial_stiffness_n(0.002).expect("sourced") / 170.2e3 - 1.0).abs() < 1e-3);
//! assert!((cable.least_drum_m(0.002).expect("sourced") - 0.036).abs() < 1e-12);
//! ```

mod file;

use std::sync::LazyLock;

use crate::materials::Property;

const DATA: &str = include_str!("../data/cables.toml");

static CATALOGUE: LazyLock<Catalogue> =
    LazyLock::new(|| file::read(DATA).expect("the embedded data are read in full by a test of this crate"));

/// What the data file holds.
#[derive(Clone, Debug, PartialEq)]
struct Catalogue {
    constructions: Vec<Construction>,
    bent: Bent,
}

/// Strength of a bent steel cable.
#[derive(Clone, Debug, PartialEq)]
pub struct Bent {
    /// (Drum over cable diameter, part of the breaking force that is left), ascending.
    pub strength_left: Vec<[f64; 2]>,
    /// Key of `REFERENCES.bib`.
    pub source: String,
}

/// A way to make a cable.
#[derive(Clone, Debug, PartialEq)]
pub struct Construction {
    /// The name that reports print: `"7x19 stainless"`.
    pub name: String,
    /// Other names under which [`find`] knows it.
    pub aliases: Vec<String>,
    /// Number of wires; absent for fibres.
    pub wires: Option<f64>,
    /// Diameter of the cable over that of a wire; absent for fibres.
    pub wires_across: Option<f64>,
    /// Axial stiffness AE over the square of the nominal diameter, Pa.
    pub stiffness_over_square_pa: Option<Property>,
    /// Breaking force over the square of the nominal diameter, Pa.
    pub strength_over_square_pa: Option<Property>,
    /// Mass per length over the square of the nominal diameter, kg/m³.
    pub mass_over_square_kg_per_m3: Option<Property>,
    /// Drum over cable diameter below which life is short.
    pub least_ratio: Option<Property>,
    /// Drum over cable diameter to aim for.
    pub desired_ratio: Option<Property>,
    /// What a user should know before trusting the numbers.
    pub note: Option<String>,
    /// Sizes that a maker lists, by diameter.
    pub sizes: Vec<Size>,
}

/// A size that a maker lists.
#[derive(Clone, Debug, PartialEq)]
pub struct Size {
    /// Nominal diameter, m.
    pub diameter_m: f64,
    /// Breaking force, N.
    pub breaking_force_n: Property,
    /// Mass per length, kg/m.
    pub mass_kg_per_m: Option<Property>,
}

impl Construction {
    /// Axial stiffness AE of a diameter (m), N; absent without a source.
    pub fn axial_stiffness_n(&self, diameter_m: f64) -> Option<f64> {
        self.stiffness_over_square_pa.as_ref().map(|property| property.value * diameter_m * diameter_m)
    }

    /// The listed size of a diameter (m), within 0.5 % of it.
    pub fn size(&self, diameter_m: f64) -> Option<&Size> {
        self.sizes.iter().find(|size| (size.diameter_m - diameter_m).abs() <= 5e-3 * size.diameter_m)
    }

    /// Breaking force of a diameter (m), N: of the listed size, else by the square of the diameter; absent without a source.
    ///
    /// ```
    /// let cable = forcewright_elements::cables::find("7x19 galvanised").expect("in the catalogue");
    /// assert_eq!((cable.breaking_force_n(0.004), cable.breaking_force_n(0.0045)), (Some(11.2e3), None));
    /// ```
    pub fn breaking_force_n(&self, diameter_m: f64) -> Option<f64> {
        let listed = self.size(diameter_m).map(|size| size.breaking_force_n.value);
        listed.or_else(|| self.strength_over_square_pa.as_ref().map(|property| property.value * diameter_m * diameter_m))
    }

    /// Diameter of a wire, m, by the geometry of the construction; absent for fibres.
    pub fn wire_m(&self, diameter_m: f64) -> Option<f64> {
        self.wires_across.map(|across| diameter_m / across)
    }

    /// Area of the metal, m², of wires of one diameter; absent for fibres.
    pub fn metal_m2(&self, diameter_m: f64) -> Option<f64> {
        let wire_m = self.wire_m(diameter_m)?;
        Some(self.wires? * 0.25 * std::f64::consts::PI * wire_m * wire_m)
    }

    /// Least diameter of a drum, m, to the groove; absent without a source.
    pub fn least_drum_m(&self, diameter_m: f64) -> Option<f64> {
        self.least_ratio.as_ref().map(|ratio| ratio.value * diameter_m)
    }

    /// Mass per length, kg/m: of the listed size, else by the square of the diameter; absent without a source.
    ///
    /// ```
    /// let cable = forcewright_elements::cables::find("7x7 stainless").expect("in the catalogue");
    /// assert!((cable.mass_kg_per_m(1e-3).expect("known") - 3.84e-3).abs() < 1e-12);
    /// ```
    pub fn mass_kg_per_m(&self, diameter_m: f64) -> Option<f64> {
        let listed = self.size(diameter_m).and_then(|size| size.mass_kg_per_m.as_ref()).map(|property| property.value);
        listed.or_else(|| self.mass_over_square_kg_per_m3.as_ref().map(|property| property.value * diameter_m * diameter_m))
    }

    /// All numbers with their sources.
    pub fn properties(&self) -> impl Iterator<Item = &Property> {
        let own = [
            &self.stiffness_over_square_pa,
            &self.strength_over_square_pa,
            &self.mass_over_square_kg_per_m3,
            &self.least_ratio,
            &self.desired_ratio,
        ];
        let listed = self.sizes.iter().flat_map(|size| std::iter::once(&size.breaking_force_n).chain(&size.mass_kg_per_m));
        own.into_iter().flatten().chain(listed)
    }

    fn answers_to(&self, query: &str) -> bool {
        std::iter::once(&self.name).chain(&self.aliases).any(|name| folded(name) == query)
    }
}

/// All constructions, in the order of the data file.
pub fn catalogue() -> &'static [Construction] {
    &CATALOGUE.constructions
}

/// The construction with this name or alias. Case, spaces, punctuation and × for x do not matter.
pub fn find(name: &str) -> Option<&'static Construction> {
    let query = folded(name);
    catalogue().iter().find(|construction| construction.answers_to(&query))
}

fn folded(name: &str) -> String {
    name.replace('×', "x").chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect()
}

/// Bending stress in a wire of a cable on a drum, `E δ/D`, Pa: modulus of the wire (Pa), its diameter δ (m), and the diameter D of the drum to
/// the middle of the cable (m). Shigley, chapter 17, wire rope (`budynas-nisbett2011`), there with the softer modulus of the rope; with that of the wire
/// an upper bound, as wires slide on each other.
///
/// ```
/// // 2 mm 7×19: wires of 0.133 mm on a drum of 50 mm.
/// let stress_pa = forcewright_elements::cables::wire_bending_stress_pa(190e9, 0.002 / 15.0, 0.052);
/// assert!((stress_pa / 487e6 - 1.0).abs() < 1e-3);
/// ```
pub fn wire_bending_stress_pa(young_modulus_pa: f64, wire_m: f64, drum_m: f64) -> f64 {
    young_modulus_pa * wire_m / drum_m
}

/// Breaking force over the largest tension; absent if the tension is not above 0 or the force is negative or not finite.
///
/// ```
/// assert_eq!(forcewright_elements::cables::safety_factor(2000.0, 400.0), Some(5.0));
/// ```
pub fn safety_factor(breaking_force_n: f64, tension_n: f64) -> Option<f64> {
    (tension_n > 0.0 && breaking_force_n >= 0.0 && breaking_force_n.is_finite()).then(|| breaking_force_n / tension_n)
}

/// Part of the breaking force that a steel cable keeps when it is bent over a drum, by the ratio of the diameters: Carl Stahl Sava's table
/// (`sava-pulleys`), straight in between. Absent below its least ratio of 1; above 40 the last value.
///
/// ```
/// use forcewright_elements::cables;
///
/// assert_eq!((cables::strength_left(20.0), cables::strength_left(0.5)), (Some(0.91), None));
/// ```
pub fn strength_left(ratio: f64) -> Option<f64> {
    let table = &CATALOGUE.bent.strength_left;
    let Some(next) = table.iter().position(|[at, _]| *at >= ratio) else {
        return table.last().filter(|[at, _]| ratio > *at).map(|[_, left]| *left);
    };
    let [after, there] = table[next];
    if after <= ratio {
        return Some(there);
    }
    let [before, here] = *table.get(next.checked_sub(1)?)?;
    Some(here + (there - here) * (ratio - before) / (after - before))
}

/// The table behind [`strength_left`].
pub fn bent() -> &'static Bent {
    &CATALOGUE.bent
}

#[cfg(test)]
mod tests {
    use super::*;

    const REFERENCES: &str = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../REFERENCES.bib"));

    fn near(ours: f64, exact: f64, relative: f64) {
        assert!((ours / exact - 1.0).abs() < relative, "{ours} instead of {exact}");
    }

    #[test]
    fn every_entry_is_plausible_and_its_sources_known() {
        assert!(catalogue().len() >= 7);
        for construction in catalogue() {
            let name = &construction.name;
            for property in construction.properties() {
                assert!(property.value > 0.0, "{name}");
                for key in property.source_keys() {
                    assert!(REFERENCES.contains(&format!("{{{key},")), "{name}: `{key}` is not in REFERENCES.bib");
                }
            }
            // On the area of the metal a cable is softer than its wire, and not by more than two thirds.
            if let (Some(stiffness_n), Some(metal_m2)) = (construction.axial_stiffness_n(1.0), construction.metal_m2(1.0)) {
                assert!((65e9..205e9).contains(&(stiffness_n / metal_m2)), "{name}: {} Pa", stiffness_n / metal_m2);
            }
            if let (Some(least), Some(desired)) = (&construction.least_ratio, &construction.desired_ratio) {
                assert!(least.value < desired.value, "{name}");
            }
            // What the factor says is what is listed, within the play of makers; wires are spread over the helix, so that it is more than their section.
            if let Some(factor) = &construction.mass_over_square_kg_per_m3 {
                for size in &construction.sizes {
                    if let Some(mass) = &size.mass_kg_per_m {
                        let ratio = mass.value / (factor.value * size.diameter_m * size.diameter_m);
                        assert!((0.98..1.09).contains(&ratio), "{name}: {ratio}");
                    }
                }
                let wires = 7850.0 * construction.metal_m2(1.0).unwrap();
                assert!((0.8..1.2).contains(&(factor.value / wires)), "{name}: {}", factor.value / wires);
            }
            assert!(construction.sizes.windows(2).all(|pair| pair[0].diameter_m < pair[1].diameter_m), "{name}");
            for size in &construction.sizes {
                // Steel wire of 1 to 2.4 GPa, braids of HMPE up to 1 GPa of the full circle.
                let over_square_pa = size.breaking_force_n.value / (size.diameter_m * size.diameter_m);
                assert!((500e6..1300e6).contains(&over_square_pa), "{name}: {over_square_pa}");
                // 0.36 to 0.5 of the square is metal of 7850 kg/m³.
                if let Some(mass) = &size.mass_kg_per_m {
                    let density = mass.value / (size.diameter_m * size.diameter_m);
                    assert!((2900.0..4200.0).contains(&density), "{name}: {density}");
                }
            }
        }
        assert!(REFERENCES.contains(&format!("{{{},", bent().source)));
    }

    /// The maker's formula, stretch in per cent = load in lbf times factor over the square of the diameter in inches, at a load.
    #[test]
    fn stiffness_is_that_of_the_stretch_formula() {
        let (inch_m, pound_n) = (0.0254, 4.448_221_615);
        for (name, factor) in [
            ("7x7 stainless", 1.20e-5),
            ("7x19 stainless", 1.62e-5),
            ("1x19 stainless", 7.79e-6),
            ("7x7 galvanised", 1.07e-5),
            ("7x19 galvanised", 1.40e-5),
            ("1x19 galvanised", 6.98e-6),
        ] {
            let percent = 100.0 * factor / (0.125 * 0.125);
            let ours = 100.0 * 100.0 * pound_n / find(name).unwrap().axial_stiffness_n(0.125 * inch_m).unwrap();
            near(ours, percent, 1e-4);
        }
    }

    /// Wires of 1570 N/mm² times the stranding factor, as the seller states the formula.
    #[test]
    fn strength_is_that_of_the_wires() {
        for (name, factor) in [("7x7 stainless", 0.838), ("7×19", 0.8), ("1X19", 0.88)] {
            let construction = find(name).unwrap();
            near(construction.breaking_force_n(0.0021).unwrap(), 1570e6 * factor * construction.metal_m2(0.0021).unwrap(), 2e-4);
        }
        let listed = find("7x7").unwrap();
        near(listed.breaking_force_n(0.001_587_5).unwrap(), 480.0 * 4.448_221_615, 1e-9);
        near(find("7x19 galvanised").unwrap().mass_kg_per_m(0.004).unwrap(), 0.061, 1e-12);
        assert_eq!(find("7x19 galvanised").unwrap().breaking_force_n(0.0045), None);
        let braid = find("dyneema").unwrap();
        assert_eq!((braid.axial_stiffness_n(0.002), braid.wire_m(0.002), braid.mass_kg_per_m(0.002)), (None, None, None));
        assert_eq!(find("string"), None);
    }

    #[test]
    fn bent_cables_keep_what_the_table_says() {
        for (ratio, left) in [(1.0, 0.5), (3.0, 0.70), (40.0, 0.95), (100.0, 0.95), (12.5, 0.875)] {
            near(strength_left(ratio).unwrap(), left, 1e-12);
        }
        assert_eq!((strength_left(0.99), strength_left(f64::NAN)), (None, None));
        assert_eq!((safety_factor(1.0, 0.0), safety_factor(f64::NAN, 1.0), safety_factor(1.0, -1.0)), (None, None, None));
    }

    #[test]
    fn names_are_unique() {
        let names: Vec<String> =
            catalogue().iter().flat_map(|c| std::iter::once(&c.name).chain(&c.aliases)).map(|name| folded(name)).collect();
        for (i, name) in names.iter().enumerate() {
            assert!(!names[..i].contains(name), "`{name}` twice");
        }
    }

    #[test]
    fn faults_are_named() {
        for (old, new, expected) in [
            ("wires = 49", "wires = \"many\"", "7x7 stainless: `wires`"),
            ("least_ratio = ", "least = ", "unknown key `least`"),
            ("\"0.0625 in\"", "\"0.0625 N\"", "`0.0625 N`"),
            ("[bent]", "[curved]", "unknown key `curved`"),
            ("[1, 0.50], [2, 0.65]", "[2, 0.50], [1, 0.65]", "bent: ratios are not ascending"),
            ("breaking_force = { value = \"480 lbf\"", "force = { value = \"480 lbf\"", "unknown key `force`"),
        ] {
            let message = file::read(&DATA.replacen(old, new, 1)).unwrap_err();
            assert!(message.contains(expected), "{message}");
        }
    }
}
