//! Toothed belts and spur gears, as far as a comparison with a cable drive needs them: stiffness, backlash, strength.
//!
//! Steel spur gears with full-depth teeth of 20° without profile shift and solid bodies. Mesh stiffness is that of ISO 6336-1:2006, method B
//! (`iso6336-1`, clause 9), bending that of Lewis, contact that of Hertz at the pitch point (`budynas-nisbett2011`, chapter 14, all factors 1).
//!
//! ```
//! use forcewright_elements::transmissions::GearPair;
//!
//! let pair = GearPair { module_m: 1e-3, teeth: [20, 100] };
//! assert!((pair.contact_ratio() - 1.7).abs() < 0.03);
//! // About 20 N/(mm µm), as ISO 6336-1 has it for method C.
//! assert!((pair.mesh_pa(100e3) - 20e9).abs() < 1e9);
//! ```

mod file;

use std::f64::consts::PI;
use std::sync::LazyLock;

use forcewright_base::maths::{cos, powf, sin};

use crate::materials::Property;

/// Pressure angle, rad: 20°.
const PRESSURE_RAD: f64 = PI / 9.0;
/// Elastic coefficient of steel on steel, 191·10³ √N/m (`budynas-nisbett2011`, table 14-8).
const STEEL_SQRT_PA: f64 = 191e3;
/// Least face width over the circular pitch, the rule of `budynas-nisbett2011`, section 14-1: 3 to 5.
const FACE_PITCHES: f64 = 3.0;
/// Below this force per width mesh stiffness falls with the fourth root of it, N/m (`iso6336-1`, clause 9).
const FULL_N_PER_M: f64 = 100e3;
/// Modules of the first row of ISO 54, m.
pub const MODULES_M: [f64; 13] = [0.5e-3, 0.6e-3, 0.8e-3, 1e-3, 1.25e-3, 1.5e-3, 2e-3, 2.5e-3, 3e-3, 4e-3, 5e-3, 6e-3, 8e-3];
/// Least number of teeth that a rack cuts without undercut at 20°: 2/sin² 20°, rounded up.
pub const LEAST_TEETH: u32 = 18;

/// A profile of toothed belts.
#[derive(Clone, Debug, PartialEq)]
pub struct Belt {
    /// `AT5`.
    pub name: String,
    /// Of its teeth, m.
    pub pitch_m: f64,
    /// That one tooth carries at a standstill, N per m of width.
    pub tooth_n_per_m: Property,
    /// Teeth in mesh that count at most.
    pub teeth: Property,
    /// Of the smallest pulley.
    pub least_teeth: Property,
    /// Widths that there are, ascending.
    pub sizes: Vec<BeltSize>,
}

/// A width of a belt.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BeltSize {
    /// m.
    pub width_m: f64,
    /// That a strand may carry, N.
    pub tension_n: f64,
    /// At which it breaks, N.
    pub breaking_n: f64,
    /// Force over strain of a strand, N.
    pub stiffness_n: f64,
}

/// What gears are made of.
#[derive(Clone, Debug, PartialEq)]
pub struct GearSteel {
    /// Allowable bending stress at the root, Pa.
    pub bending_pa: Property,
    /// Allowable contact stress, Pa.
    pub contact_pa: Property,
    /// Key of the work that has the form factors.
    pub lewis_source: String,
    /// (teeth, Lewis form factor), ascending.
    lewis: Vec<[f64; 2]>,
}

struct Data {
    belts: Vec<Belt>,
    steel: GearSteel,
}

static DATA: LazyLock<Data> = LazyLock::new(|| {
    file::read(include_str!("../data/transmissions.toml")).expect("the embedded data are read in full by a test of this crate")
});

/// All belts, in the order of the data file.
pub fn belts() -> &'static [Belt] {
    &DATA.belts
}

/// The steel of gears.
pub fn steel() -> &'static GearSteel {
    &DATA.steel
}

/// Two spur gears, pinion and wheel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GearPair {
    /// m, above 0.
    pub module_m: f64,
    /// Of pinion and wheel; at least [`LEAST_TEETH`].
    pub teeth: [u32; 2],
}

impl GearPair {
    /// Pitch radii, m.
    pub fn radii_m(&self) -> [f64; 2] {
        self.teeth.map(|z| 0.5 * self.module_m * f64::from(z))
    }

    /// Base radii, m.
    pub fn base_m(&self) -> [f64; 2] {
        self.radii_m().map(|r| r * cos(PRESSURE_RAD))
    }

    /// Distance of the axes, m.
    pub fn distance_m(&self) -> f64 {
        self.radii_m().iter().sum()
    }

    /// Transverse contact ratio `ε_α` with tips a module above the pitch circles.
    pub fn contact_ratio(&self) -> f64 {
        let (radii, base) = (self.radii_m(), self.base_m());
        let reach = |i: usize| {
            let tip_m = radii[i] + self.module_m;
            ((tip_m - base[i]) * (tip_m + base[i])).sqrt()
        };
        (reach(0) + reach(1) - self.distance_m() * sin(PRESSURE_RAD)) / (PI * self.module_m * cos(PRESSURE_RAD))
    }

    /// Mesh stiffness `c_γα` along the line of action, Pa (force per width and displacement; `1 N/(mm µm)` is `1e9 Pa`), under a force per width (N/m).
    ///
    /// `q′ = 0.04723 + 0.15551/z₁ + 0.25791/z₂` µm mm/N, `c′ = 0.8 C_R C_B/q′` with `C_R = 1` of a solid body and `C_B = 0.975` of the basic rack of
    /// ISO 53, `c_γα = c′ (0.75 ε_α + 0.25)`; below 100 N/mm times `(F/100 b)^¼`.
    pub fn mesh_pa(&self, force_n_per_m: f64) -> f64 {
        let [z1, z2] = self.teeth.map(f64::from);
        let q = 0.04723 + 0.15551 / z1 + 0.25791 / z2;
        let light = powf((force_n_per_m / FULL_N_PER_M).clamp(0.0, 1.0), 0.25);
        1e9 * 0.8 * 0.975 / q * (0.75 * self.contact_ratio() + 0.25) * light
    }

    /// Least backlash along the line of action that is recommended for gears and housings of iron, m: `⅔ (0.06 + 0.0005 a + 0.03 m)` in mm
    /// (`iso-tr-10064-2`, annex A).
    pub fn backlash_m(&self) -> f64 {
        2.0 / 3.0 * (0.06e-3 + 0.0005 * self.distance_m() + 0.03 * self.module_m)
    }

    /// Least face width for a force at the pitch circle (N): of bending `F/(m Y σ)`, of contact `F C²/(d₁ I σ²)` with
    /// `I = ½ cos φ sin φ u/(u + 1)`, and three circular pitches, m.
    pub fn width_m(&self, force_n: f64) -> f64 {
        let steel = steel();
        let bending = force_n / (self.module_m * steel.lewis(self.teeth[0]) * steel.bending_pa.value);
        let u = f64::from(self.teeth[1]) / f64::from(self.teeth[0]);
        let geometry = 0.5 * cos(PRESSURE_RAD) * sin(PRESSURE_RAD) * u / (u + 1.0);
        let ratio = STEEL_SQRT_PA / steel.contact_pa.value;
        let contact = force_n / (2.0 * self.radii_m()[0] * geometry) * ratio * ratio;
        bending.max(contact).max(FACE_PITCHES * PI * self.module_m)
    }
}

impl GearSteel {
    /// Lewis form factor Y, straight between the tabled numbers of teeth.
    pub fn lewis(&self, teeth: u32) -> f64 {
        let z = f64::from(teeth);
        let next = self.lewis.iter().position(|[at, _]| *at >= z);
        match next {
            None => self.lewis.last().map_or(0.0, |[_, y]| *y),
            Some(0) => self.lewis[0][1],
            Some(i) => {
                let ([a, ya], [b, yb]) = (self.lewis[i - 1], self.lewis[i]);
                ya + (yb - ya) * (z - a) / (b - a)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const REFERENCES: &str = include_str!("../../../../REFERENCES.bib");

    #[test]
    fn data_have_sources() {
        for belt in belts() {
            for property in [&belt.tooth_n_per_m, &belt.teeth, &belt.least_teeth] {
                assert!(property.value > 0.0);
                assert!(property.source_keys().all(|key| REFERENCES.contains(&format!("{{{key},"))), "{}", belt.name);
            }
            assert!(belt.sizes.windows(2).all(|p| p[0].width_m < p[1].width_m && p[0].stiffness_n < p[1].stiffness_n));
            // Cords stretch by 0.4 % at what they may carry.
            for size in &belt.sizes {
                let strain = size.tension_n / size.stiffness_n;
                assert!((strain - 0.004).abs() < 1e-12, "{} {}: {strain}", belt.name, size.width_m);
                assert!((3.5..4.2).contains(&(size.breaking_n / size.tension_n)), "{} {}", belt.name, size.width_m);
            }
        }
        for key in ["iso6336-1", "iso-tr-10064-2", "budynas-nisbett2011", &steel().lewis_source] {
            assert!(REFERENCES.contains(&format!("{{{key},")), "{key}");
        }
        assert!(steel().lewis.windows(2).all(|p| p[0][0] < p[1][0] && p[0][1] < p[1][1]));
    }

    /// Contact ratio against the length of the line of action drawn point by point: from where one tip meets it to where the other does.
    #[test]
    fn gears_are_those_of_their_geometry() {
        let pair = GearPair { module_m: 2e-3, teeth: [20, 60] };
        let (radii, a) = (pair.radii_m(), pair.distance_m());
        // Points of the line of action at s from the pitch point; their distance from an axis.
        let (s0, c0) = (sin(PRESSURE_RAD), cos(PRESSURE_RAD));
        let from = |s: f64, centre: f64| forcewright_base::maths::hypot(s * c0, radii[0] + s * s0 - centre);
        let end = |centre: f64, tip: f64, sign: f64| {
            let (mut low, mut high) = (0.0, 0.02);
            for _ in 0..80 {
                let middle = 0.5 * (low + high);
                if from(sign * middle, centre) < tip { low = middle } else { high = middle }
            }
            low
        };
        let length = end(0.0, radii[0] + 2e-3, 1.0) + end(a, radii[1] + 2e-3, -1.0);
        assert!((pair.contact_ratio() - length / (PI * 2e-3 * c0)).abs() < 1e-12);
        // ISO's own rule of thumb: c′ of 14 and c_γ of 20 N/(mm µm), within a fifth.
        assert!((pair.mesh_pa(200e3) / 20e9 - 1.0).abs() < 0.2, "{}", pair.mesh_pa(200e3));
        assert!((pair.mesh_pa(1e3) / pair.mesh_pa(200e3) - powf(0.01, 0.25)).abs() < 1e-12);
        // The report tables 0.10 mm for a module of 2 mm and 50 mm.
        let small = GearPair { module_m: 2e-3, teeth: [20, 30] };
        assert!((small.backlash_m() - 0.1e-3).abs() < 5e-6);
        // `budynas-nisbett2011`, example 14-1's tooth: Y of 16 teeth is 0.296.
        assert!((steel().lewis(16) - 0.296).abs() < 1e-12 && (steel().lewis(23) - 0.334).abs() < 1e-12);
        // The width holds the stress: both written out the other way round.
        let (force_n, width_m) = (5000.0, pair.width_m(5000.0));
        let bending = force_n / (width_m * 2e-3 * 0.322);
        let geometry = 0.5 * s0 * c0 * 3.0 / 4.0;
        let contact = STEEL_SQRT_PA * (force_n / (width_m * 0.04 * geometry)).sqrt();
        assert!((bending <= 216.2e6 * (1.0 + 1e-9)) && (contact <= 732.8e6 * (1.0 + 1e-9)));
        assert!((bending / 216.2e6).max(contact / 732.8e6) > 1.0 - 1e-9);
        assert!((pair.width_m(1.0) - 6e-3 * PI).abs() < 1e-12);
    }
}
