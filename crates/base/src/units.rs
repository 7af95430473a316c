//! Units at the door: text such as `"1.38 N/mm"` becomes an SI number that remembers the unit it was typed in.
//!
//! A unit is a product of powers of known symbols. Besides the SI bases it carries the angle (so that N·m/rad is not N·m) and an
//! energy mark (so that a torque in N·m is never taken for an energy in J). Decimal prefixes are kept as powers of ten and joined to
//! the digits before they are read, so `"34.5 mm"` and `"3.45 cm"` give the same bits.

mod spelling;

use std::borrow::Cow;
use std::fmt;

use crate::fits::{Fit, FitError};
use crate::general::{General, GeneralError};

/// Exponents of kg, m, s, A, K, rad and of the energy mark.
type Exponents = [i8; 7];

const fn exponents(kg: i8, m: i8, s: i8, a: i8, k: i8, rad: i8, energy: i8) -> Exponents {
    [kg, m, s, a, k, rad, energy]
}

/// What a quantity is. A closed set: each has one SI unit and one set of exponents.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// Pure number, or `%`.
    Ratio,
    /// Length, m.
    Length,
    /// Angle, rad.
    Angle,
    /// Force, N.
    Force,
    /// Stress, pressure or elastic modulus, Pa.
    Stress,
    /// Torque, N·m. Never an energy.
    Torque,
    /// Energy or work, J. Never a torque.
    Energy,
    /// Force per length, N/m.
    Stiffness,
    /// Torque per angle, N·m/rad.
    RotationalStiffness,
    /// Mass, kg.
    Mass,
    /// Density, kg/m³.
    Density,
    /// Moment of inertia, kg·m².
    Inertia,
    /// Duration, s.
    Time,
    /// Speed, m/s.
    Speed,
    /// Angular speed, rad/s.
    AngularSpeed,
    /// Acceleration, m/s².
    Acceleration,
    /// Viscous damping: force per speed, N·s/m.
    Damping,
    /// Mass per length, kg/m.
    LineDensity,
    /// Difference of temperatures, K.
    TemperatureDifference,
    /// Coefficient of thermal expansion, 1/K.
    ThermalExpansion,
    /// Frequency, Hz.
    Frequency,
    /// Volume, m³.
    Volume,
    /// Power, W.
    Power,
    /// Voltage, V.
    Voltage,
    /// Electric current, A.
    Current,
    /// Electric resistance, Ω.
    Resistance,
    /// Electric charge, A·s.
    Charge,
    /// Torque per current, N·m/A; the same number as V·s/rad.
    TorqueConstant,
}

struct DimensionRow {
    dimension: Dimension,
    name: &'static str,
    exponents: Exponents,
    si: &'static str,
    example: &'static str,
    accepted: &'static str,
}

const DIMENSIONS: &[DimensionRow] = &[
    row(Dimension::Ratio, "a pure number", exponents(0, 0, 0, 0, 0, 0, 0), "1", "5 %", "%, or a bare number"),
    row(Dimension::Length, "a length", exponents(0, 1, 0, 0, 0, 0, 0), "m", "16 mm", "µm, mm, cm, m, in"),
    row(Dimension::Angle, "an angle", exponents(0, 0, 0, 0, 0, 1, 0), "rad", "30 deg", "deg, rad, turn"),
    row(Dimension::Force, "a force", exponents(1, 1, -2, 0, 0, 0, 0), "N", "9.7 N", "mN, N, kN, kgf, lbf"),
    row(Dimension::Stress, "a stress or modulus", exponents(1, -1, -2, 0, 0, 0, 0), "Pa", "76 MPa", "Pa, kPa, MPa, GPa, N/mm^2, psi, bar"),
    row(Dimension::Torque, "a torque", exponents(1, 2, -2, 0, 0, 0, 0), "N*m", "400 N*mm", "N*mm, N*m, kgf*cm, lbf*in"),
    row(Dimension::Energy, "an energy", exponents(1, 2, -2, 0, 0, 0, 1), "J", "12 mJ", "mJ, J, kJ, Wh"),
    row(Dimension::Stiffness, "a stiffness", exponents(1, 0, -2, 0, 0, 0, 0), "N/m", "1.38 N/mm", "N/m, N/mm, lbf/in"),
    row(
        Dimension::RotationalStiffness,
        "a rotational stiffness",
        exponents(1, 2, -2, 0, 0, -1, 0),
        "N*m/rad",
        "800 N*m/rad",
        "N*m/rad, N*mm/deg",
    ),
    row(Dimension::Mass, "a mass", exponents(1, 0, 0, 0, 0, 0, 0), "kg", "90 g", "mg, g, kg, lb"),
    row(Dimension::Density, "a density", exponents(1, -3, 0, 0, 0, 0, 0), "kg/m^3", "1410 kg/m^3", "kg/m^3, g/cm^3"),
    row(Dimension::Inertia, "a moment of inertia", exponents(1, 2, 0, 0, 0, 0, 0), "kg*m^2", "2e-5 kg*m^2", "kg*m^2, g*mm^2"),
    row(Dimension::Time, "a duration", exponents(0, 0, 1, 0, 0, 0, 0), "s", "0.125 s", "ms, s, min, h, d"),
    row(Dimension::Speed, "a speed", exponents(0, 1, -1, 0, 0, 0, 0), "m/s", "20 mm/s", "mm/s, m/s"),
    row(Dimension::AngularSpeed, "an angular speed", exponents(0, 0, -1, 0, 0, 1, 0), "rad/s", "3000 rpm", "rad/s, deg/s, rpm"),
    row(Dimension::Acceleration, "an acceleration", exponents(0, 1, -2, 0, 0, 0, 0), "m/s^2", "9.81 m/s^2", "m/s^2, mm/s^2"),
    row(Dimension::Damping, "a damping", exponents(1, 0, -1, 0, 0, 0, 0), "N*s/m", "20 N*s/m", "N*s/m, N*s/mm"),
    row(Dimension::LineDensity, "a mass per length", exponents(1, -1, 0, 0, 0, 0, 0), "kg/m", "9 g/m", "g/m, kg/m"),
    row(Dimension::TemperatureDifference, "a difference of temperatures", exponents(0, 0, 0, 0, 1, 0, 0), "K", "20 K", "K"),
    row(Dimension::ThermalExpansion, "a thermal expansion", exponents(0, 0, 0, 0, -1, 0, 0), "1/K", "12e-6 1/K", "1/K"),
    row(Dimension::Frequency, "a frequency", exponents(0, 0, -1, 0, 0, 0, 0), "Hz", "40 Hz", "Hz, kHz"),
    row(Dimension::Volume, "a volume", exponents(0, 3, 0, 0, 0, 0, 0), "m^3", "12 cm^3", "mm^3, cm^3, m^3"),
    row(Dimension::Power, "a power", POWER, "W", "24 W", "mW, W, kW"),
    row(Dimension::Voltage, "a voltage", VOLTAGE, "V", "7.2 V", "mV, V"),
    row(Dimension::Current, "a current", exponents(0, 0, 0, 1, 0, 0, 0), "A", "1.5 A", "mA, A"),
    row(Dimension::Resistance, "a resistance", RESISTANCE, "ohm", "2.1 ohm", "ohm, Ω, mohm, kohm"),
    row(Dimension::Charge, "a charge", CHARGE, "A*s", "1000 mAh", "mAh, Ah, A*s"),
    row(Dimension::TorqueConstant, "a torque constant", exponents(1, 2, -2, -1, 0, 0, 0), "N*m/A", "9.5 N*mm/A", "N*m/A, N*mm/A"),
];

const fn row(
    dimension: Dimension,
    name: &'static str,
    exponents: Exponents,
    si: &'static str,
    example: &'static str,
    accepted: &'static str,
) -> DimensionRow {
    DimensionRow { dimension, name, exponents, si, example, accepted }
}

impl Dimension {
    fn row(self) -> &'static DimensionRow {
        // Every variant has a row (tested); the first row is only the compiler's way out.
        DIMENSIONS.iter().find(|r| r.dimension == self).unwrap_or(&DIMENSIONS[0])
    }

    /// All dimensions.
    pub fn all() -> impl Iterator<Item = Self> {
        DIMENSIONS.iter().map(|r| r.dimension)
    }

    /// Name with its article, as used in messages: `"a force"`.
    pub fn name(self) -> &'static str {
        self.row().name
    }

    /// Symbol of the SI unit in which values are held: `"N/m"`; `"1"` for pure numbers.
    pub fn si_symbol(self) -> &'static str {
        self.row().si
    }

    /// An example a user could copy: `"1.38 N/mm"`.
    pub fn example(self) -> &'static str {
        self.row().example
    }

    /// Common units of this dimension, for messages and documentation.
    pub fn accepted(self) -> &'static str {
        self.row().accepted
    }

    /// Dimension of a set of exponents, if it is one of ours.
    fn of(exponents: Exponents) -> Option<Self> {
        DIMENSIONS.iter().find(|r| r.exponents == exponents).map(|r| r.dimension)
    }
}

/// A unit as typed, with its conversion to SI: `si = value · mantissa · 10^power`.
#[derive(Clone, Debug, PartialEq)]
pub struct Unit {
    symbol: Cow<'static, str>,
    exponents: Exponents,
    mantissa: f64,
    power: i32,
}

/// Why a unit was not understood.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum UnitError {
    /// A symbol that is no unit; the second field is the nearest known one.
    Unknown(String, Option<&'static str>),
    /// Not a product of powers.
    Syntax(String),
}

impl fmt::Display for UnitError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unknown(symbol, Some(near)) => write!(f, "`{symbol}` is not a unit; did you mean `{near}`?"),
            Self::Unknown(symbol, None) => write!(f, "`{symbol}` is not a unit"),
            Self::Syntax(text) => write!(f, "`{text}` is not a unit; write products and quotients such as `N*mm` or `kg/m^3`"),
        }
    }
}

struct Atom {
    symbol: &'static str,
    mantissa: f64,
    power: i32,
    exponents: Exponents,
}

const fn atom(symbol: &'static str, mantissa: f64, power: i32, exponents: Exponents) -> Atom {
    Atom { symbol, mantissa, power, exponents }
}

const MASS: Exponents = exponents(1, 0, 0, 0, 0, 0, 0);
const LENGTH: Exponents = exponents(0, 1, 0, 0, 0, 0, 0);
const TIME: Exponents = exponents(0, 0, 1, 0, 0, 0, 0);
const ANGLE: Exponents = exponents(0, 0, 0, 0, 0, 1, 0);
const FORCE: Exponents = exponents(1, 1, -2, 0, 0, 0, 0);
const STRESS: Exponents = exponents(1, -1, -2, 0, 0, 0, 0);
const ENERGY: Exponents = exponents(1, 2, -2, 0, 0, 0, 1);
const POWER: Exponents = exponents(1, 2, -3, 0, 0, 0, 1);
const VOLTAGE: Exponents = exponents(1, 2, -3, -1, 0, 0, 1);
const RESISTANCE: Exponents = exponents(1, 2, -3, -2, 0, 0, 1);
const CHARGE: Exponents = exponents(0, 0, 1, 1, 0, 0, 0);

/// Conversion factors: SI brochure (9th ed.) and NIST SP 811 (2008), appendix B; all exact but `deg`, `turn`, `rpm` and `psi`.
const ATOMS: &[Atom] = &[
    atom("1", 1.0, 0, [0; 7]),
    atom("%", 1.0, -2, [0; 7]),
    atom("m", 1.0, 0, LENGTH),
    atom("dm", 1.0, -1, LENGTH),
    atom("cm", 1.0, -2, LENGTH),
    atom("mm", 1.0, -3, LENGTH),
    atom("µm", 1.0, -6, LENGTH),
    atom("um", 1.0, -6, LENGTH),
    atom("nm", 1.0, -9, LENGTH),
    atom("km", 1.0, 3, LENGTH),
    atom("in", 254.0, -4, LENGTH),
    atom("ft", 3048.0, -4, LENGTH),
    atom("rad", 1.0, 0, ANGLE),
    atom("mrad", 1.0, -3, ANGLE),
    atom("deg", std::f64::consts::PI / 180.0, 0, ANGLE),
    atom("°", std::f64::consts::PI / 180.0, 0, ANGLE),
    atom("turn", 2.0 * std::f64::consts::PI, 0, ANGLE),
    atom("rev", 2.0 * std::f64::consts::PI, 0, ANGLE),
    atom("rpm", std::f64::consts::PI / 30.0, 0, exponents(0, 0, -1, 0, 0, 1, 0)),
    atom("kg", 1.0, 0, MASS),
    atom("g", 1.0, -3, MASS),
    atom("mg", 1.0, -6, MASS),
    atom("t", 1.0, 3, MASS),
    atom("lb", 45_359_237.0, -8, MASS),
    atom("s", 1.0, 0, TIME),
    atom("ms", 1.0, -3, TIME),
    atom("µs", 1.0, -6, TIME),
    atom("us", 1.0, -6, TIME),
    atom("min", 60.0, 0, TIME),
    atom("h", 3600.0, 0, TIME),
    atom("d", 86_400.0, 0, TIME),
    atom("N", 1.0, 0, FORCE),
    atom("mN", 1.0, -3, FORCE),
    atom("µN", 1.0, -6, FORCE),
    atom("uN", 1.0, -6, FORCE),
    atom("cN", 1.0, -2, FORCE),
    atom("daN", 1.0, 1, FORCE),
    atom("kN", 1.0, 3, FORCE),
    atom("MN", 1.0, 6, FORCE),
    atom("kgf", 980_665.0, -5, FORCE),
    atom("gf", 980_665.0, -8, FORCE),
    atom("lbf", 44_482_216_152_605.0, -13, FORCE),
    atom("ozf", 2_780_138_509_537_812.5, -16, FORCE),
    atom("Pa", 1.0, 0, STRESS),
    atom("kPa", 1.0, 3, STRESS),
    atom("MPa", 1.0, 6, STRESS),
    atom("GPa", 1.0, 9, STRESS),
    atom("bar", 1.0, 5, STRESS),
    atom("psi", 6_894.757_293_168_361, 0, STRESS),
    atom("ksi", 6_894.757_293_168_361, 3, STRESS),
    atom("J", 1.0, 0, ENERGY),
    atom("mJ", 1.0, -3, ENERGY),
    atom("µJ", 1.0, -6, ENERGY),
    atom("uJ", 1.0, -6, ENERGY),
    atom("kJ", 1.0, 3, ENERGY),
    atom("Wh", 3600.0, 0, ENERGY),
    atom("W", 1.0, 0, POWER),
    atom("mW", 1.0, -3, POWER),
    atom("kW", 1.0, 3, POWER),
    atom("A", 1.0, 0, exponents(0, 0, 0, 1, 0, 0, 0)),
    atom("mA", 1.0, -3, exponents(0, 0, 0, 1, 0, 0, 0)),
    atom("V", 1.0, 0, VOLTAGE),
    atom("mV", 1.0, -3, VOLTAGE),
    atom("ohm", 1.0, 0, RESISTANCE),
    atom("Ω", 1.0, 0, RESISTANCE),
    atom("mohm", 1.0, -3, RESISTANCE),
    atom("kohm", 1.0, 3, RESISTANCE),
    atom("Ah", 3600.0, 0, CHARGE),
    atom("mAh", 3600.0, -3, CHARGE),
    atom("Hz", 1.0, 0, exponents(0, 0, -1, 0, 0, 0, 0)),
    atom("kHz", 1.0, 3, exponents(0, 0, -1, 0, 0, 0, 0)),
    atom("K", 1.0, 0, exponents(0, 0, 0, 0, 1, 0, 0)),
];

impl Unit {
    /// The SI unit of a dimension.
    pub fn si(dimension: Dimension) -> Self {
        let row = dimension.row();
        Self { symbol: Cow::Borrowed(row.si), exponents: row.exponents, mantissa: 1.0, power: 0 }
    }

    /// Reads a unit such as `mm`, `N/mm`, `N·mm`, `kg*m^2`, `m/s²`. Empty text is the pure number.
    ///
    /// # Errors
    /// [`UnitError`] for an unknown symbol or a malformed product.
    pub fn parse(text: &str) -> Result<Self, UnitError> {
        let symbol = text.trim();
        let mut unit = Self { symbol: Cow::Owned(symbol.to_owned()), exponents: [0; 7], mantissa: 1.0, power: 0 };
        if symbol.is_empty() {
            return Ok(unit);
        }
        // U+03BC (Greek mu) is typed as often as U+00B5 (micro sign).
        let plain = symbol.replace('μ', "µ").replace('²', "^2").replace('³', "^3").replace(['·', '⋅', '×'], "*");
        let syntax = || UnitError::Syntax(symbol.to_owned());
        let mut sign = 1_i8;
        let mut rest = plain.as_str();
        loop {
            let end = rest.find(['*', '/']).unwrap_or(rest.len());
            let factor = rest[..end].trim();
            let (name, exponent) = match factor.split_once('^') {
                None => (factor, 1),
                Some((name, digits)) => (name.trim(), digits.trim().parse::<i8>().map_err(|_| syntax())?),
            };
            if name.is_empty() || !(-6..=6).contains(&exponent) {
                return Err(syntax());
            }
            unit.multiply(find_atom(name)?, sign * exponent).ok_or_else(syntax)?;
            match rest[end..].chars().next() {
                None => return Ok(unit),
                Some(operator) => {
                    // `a/b*c` is read left to right, as in the brochure's `a/b·c` is ambiguous but calculators do.
                    sign = if operator == '/' { -1 } else { 1 };
                    rest = &rest[end + 1..];
                }
            }
        }
    }

    fn multiply(&mut self, atom: &Atom, exponent: i8) -> Option<()> {
        for (mine, theirs) in self.exponents.iter_mut().zip(atom.exponents) {
            *mine = mine.checked_add(theirs.checked_mul(exponent)?)?;
        }
        self.power = self.power.checked_add(atom.power * i32::from(exponent))?;
        for _ in 0..exponent.unsigned_abs() {
            if exponent > 0 {
                self.mantissa *= atom.mantissa;
            } else {
                self.mantissa /= atom.mantissa;
            }
        }
        Some(())
    }

    /// The unit as typed.
    pub fn symbol(&self) -> &str {
        &self.symbol
    }

    /// The symbol as printed for people: `N·mm`, `m/s²`, nothing for a pure number.
    pub fn pretty(&self) -> String {
        match self.symbol.as_ref() {
            "1" => String::new(),
            symbol => symbol.replace('*', "·").replace("^2", "²").replace("^3", "³"),
        }
    }

    /// The dimension, if it is one that the project file knows.
    pub fn dimension(&self) -> Option<Dimension> {
        Dimension::of(self.exponents)
    }

    /// Whether values in this unit are of the given dimension.
    pub fn is(&self, dimension: Dimension) -> bool {
        self.exponents == dimension.row().exponents
    }

    /// Value in SI of `value` in this unit.
    pub fn to_si(&self, value: f64) -> f64 {
        value * self.mantissa * crate::maths::powi(10.0, self.power)
    }

    /// Value in this unit of an SI value.
    pub fn from_si(&self, si: f64) -> f64 {
        // Dividing by an exact power of ten gives the decimal that was typed back; multiplying by its inverse may not.
        let scaled = si / self.mantissa;
        if self.power < 0 { scaled * crate::maths::powi(10.0, -self.power) } else { scaled / crate::maths::powi(10.0, self.power) }
    }

    /// The shortest decimal in this unit that is read back as the same SI value, to the last bit.
    fn decimal(&self, si: f64) -> String {
        if self.mantissa.to_bits() == 1.0_f64.to_bits() {
            // Shortest digits of the SI value; the unit only moves the point.
            let shortest = format!("{si:e}");
            if let Some((head, Ok(exponent))) = shortest.split_once('e').map(|(head, e)| (head, e.parse::<i32>())) {
                return place_point(head, exponent - self.power);
            }
        }
        let value = self.from_si(si);
        let same = |text: &String| self.decimal_to_si(text).is_some_and(|back| back.to_bits() == si.to_bits());
        let rounded = (12..=17).map(|digits| format_number(value, digits));
        // The division above has rounded: what was typed lies a few units of the seventeenth digit away.
        let scientific = format!("{value:.16e}");
        let (head, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
        let digits = head.replace('.', "").parse::<i64>().unwrap_or(0);
        let exponent = exponent.parse::<i32>().unwrap_or(0);
        let beside = (1..=64).flat_map(|step| [digits - step, digits + step]).map(|digits| place_point(&digits.to_string(), exponent));
        rounded.chain(beside).find(same).unwrap_or_else(|| format_number(value, 12))
    }

    /// SI value of a decimal in this unit; exact to the last bit when the unit is a power of ten times the SI unit.
    fn decimal_to_si(&self, digits: &str) -> Option<f64> {
        let (head, exponent) = match digits.split_once(['e', 'E']) {
            Some((head, exponent)) => (head, exponent.parse::<i32>().ok()?),
            None => (digits, 0),
        };
        let si = format!("{head}e{}", exponent.checked_add(self.power)?).parse::<f64>().ok()?;
        Some(if self.mantissa.to_bits() == 1.0_f64.to_bits() { si } else { si * self.mantissa })
    }
}

fn find_atom(name: &str) -> Result<&'static Atom, UnitError> {
    ATOMS.iter().find(|a| a.symbol == name).ok_or_else(|| {
        UnitError::Unknown(name.to_owned(), spelling::suggestion(name, || ATOMS.iter().map(|a| a.symbol).filter(|s| *s != "1")))
    })
}

/// How far a made value may lie from the typed one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tolerance {
    /// `±`: half width in SI units.
    Symmetric(f64),
    /// ISO 286 fit on a diameter, such as `h7`.
    Fit(Fit),
    /// General tolerance of a length, such as `ISO 2768-m`.
    General(General),
}

impl Tolerance {
    /// Lower and upper deviation from a nominal value, both SI. Those of a fit follow from the diameter; `None` where it has none.
    pub fn deviations_si(&self, nominal_si: f64) -> Option<[f64; 2]> {
        match self {
            Self::Symmetric(half) => Some([-half, *half]),
            Self::Fit(fit) => fit.deviations_m(nominal_si).ok(),
            Self::General(general) => general.half_width_m(nominal_si).ok().map(|half| [-half, half]),
        }
    }

    /// What stands behind a value and its unit, with so many digits of a half width: ` ± 0.02 mm`, ` h7`, ` ISO 2768-m`.
    pub fn suffix(&self, unit: &Unit, digits: usize) -> String {
        match self {
            Self::Symmetric(half) => format!(" ± {}", format_si(*half, unit, digits)),
            Self::Fit(fit) => format!(" {fit}"),
            Self::General(general) => format!(" {general}"),
        }
    }

    /// The values for which one with a name is given, SI, and whether the first is only a bound; `None` where there is no such limit.
    pub fn nominals_si(&self) -> Option<([f64; 2], bool)> {
        match self {
            Self::Symmetric(_) => None,
            Self::Fit(fit) => fit.diameters_m().map(|all| (all, true)),
            Self::General(general) => Some((general.lengths_m(), general.begins_above())),
        }
    }

    /// Of the tolerances of its kind that have names, the coarsest whose zone about a nominal value is no wider than this, both SI.
    pub fn coarsest(&self, nominal_si: f64, width_si: f64) -> Option<Self> {
        match self {
            Self::Symmetric(_) => None,
            Self::Fit(fit) => fit.coarsest(nominal_si, width_si).map(Self::Fit),
            Self::General(_) => General::coarsest(nominal_si, 0.5 * width_si).map(Self::General),
        }
    }
}

/// A number with the unit and tolerance it was typed with. SI inside.
#[derive(Clone, Debug, PartialEq)]
pub struct Quantity {
    /// Value in SI.
    pub si: f64,
    /// The unit typed; results of this quantity are printed in it.
    pub unit: Unit,
    /// The tolerance typed, if any.
    pub tolerance: Option<Tolerance>,
}

/// Why a text is not a quantity of the dimension asked for.
#[derive(Clone, Debug, PartialEq)]
pub enum QuantityError {
    /// Empty text, or text that does not start with a number.
    NotANumber,
    /// `nan`, `inf`, or too large for a double.
    NotFinite,
    /// A decimal comma; the field is the text with a point.
    DecimalComma(String),
    /// A number without unit where one is needed.
    NoUnit,
    /// See [`UnitError`].
    Unit(UnitError),
    /// A known unit of another dimension, named if it is one of ours.
    WrongDimension(String, Option<Dimension>),
    /// The part after `±` is not a positive quantity of the same dimension.
    Tolerance(String),
    /// What stands as a fit is none, or none of this diameter: as typed, and why.
    Fit(String, FitError),
    /// What stands as a general tolerance is none, or none of this length: as typed, and why.
    General(String, GeneralError),
}

impl Quantity {
    /// A value in its SI unit, without tolerance.
    pub fn from_si(si: f64, dimension: Dimension) -> Self {
        Self { si, unit: Unit::si(dimension), tolerance: None }
    }

    /// Reads `"0.85 mm"`, `"0.85 mm ± 0.02 mm"`, `"0.85 ± 0.02 mm"`, `"17.6 mm h7"`, `"30 mm ISO 2768-m"`, `"5 %"`, `"0.12 +/- 0.03"`.
    ///
    /// # Errors
    /// [`QuantityError`] says what is wrong; the caller knows the place.
    pub fn parse(text: &str, dimension: Dimension) -> Result<Self, QuantityError> {
        let normal = text.trim().replace('−', "-").replace("+/-", "±").replace("+-", "±");
        let Some((nominal, deviation)) = normal.split_once('±') else {
            return Self::parse_nominal(&normal, dimension);
        };
        let (tolerance_digits, tolerance_unit) = split_number(deviation.trim()).map_err(|_| tolerance_error(deviation))?;
        let (digits, unit_text) = split_number(nominal.trim())?;
        // `0.85 ± 0.02 mm`: the unit is written once, for both.
        let shared = unit_text.is_empty() && !tolerance_unit.is_empty() && tolerance_unit != "%";
        let mut quantity =
            if shared { Self::build(digits, tolerance_unit, dimension)? } else { Self::build(digits, unit_text, dimension)? };
        let half = if tolerance_unit == "%" && unit_text != "%" {
            tolerance_digits.parse::<f64>().map_err(|_| tolerance_error(deviation))? / 100.0 * quantity.si.abs()
        } else if tolerance_unit.is_empty() {
            quantity.unit.decimal_to_si(tolerance_digits).ok_or_else(|| tolerance_error(deviation))?
        } else {
            Self::build(tolerance_digits, tolerance_unit, dimension).map_err(|_| tolerance_error(deviation))?.si
        };
        if !(half > 0.0 && half.is_finite()) {
            return Err(tolerance_error(deviation));
        }
        quantity.tolerance = Some(Tolerance::Symmetric(half));
        Ok(quantity)
    }

    fn parse_nominal(text: &str, dimension: Dimension) -> Result<Self, QuantityError> {
        let (digits, unit_text) = split_number(text)?;
        if let Some((unit, class)) = General::split(unit_text) {
            if dimension != Dimension::Length {
                return Err(QuantityError::General(unit_text[unit.len()..].to_owned(), GeneralError::Quantity));
            }
            let mut quantity = Self::build(digits, unit.trim_end(), dimension)?;
            let found = General::parse(class).and_then(|general| general.half_width_m(quantity.si).map(|_| general));
            let wrong = |why| QuantityError::General(unit_text[unit.len()..].to_owned(), why);
            quantity.tolerance = Some(Tolerance::General(found.map_err(wrong)?));
            return Ok(quantity);
        }
        if dimension == Dimension::Length
            && let Some((unit, word)) = unit_text.rsplit_once(char::is_whitespace)
            && Fit::looks_like(word)
        {
            let mut quantity = Self::build(digits, unit, dimension)?;
            let found = Fit::parse(word).and_then(|fit| fit.deviations_m(quantity.si).map(|_| fit));
            quantity.tolerance = Some(Tolerance::Fit(found.map_err(|why| QuantityError::Fit(word.to_owned(), why))?));
            return Ok(quantity);
        }
        Self::build(digits, unit_text, dimension)
    }

    fn build(digits: &str, unit_text: &str, dimension: Dimension) -> Result<Self, QuantityError> {
        let unit = Unit::parse(unit_text).map_err(QuantityError::Unit)?;
        if !unit.is(dimension) {
            return Err(if unit_text.is_empty() {
                QuantityError::NoUnit
            } else {
                QuantityError::WrongDimension(unit_text.to_owned(), unit.dimension())
            });
        }
        let si = unit.decimal_to_si(digits).ok_or(QuantityError::NotANumber)?;
        if !si.is_finite() {
            return Err(QuantityError::NotFinite);
        }
        // Adding zero makes a plain zero of a negative one, which no length or force is.
        Ok(Self { si: si + 0.0, unit, tolerance: None })
    }

    /// Reads a number that stands without its unit, such as a cell of a column.
    ///
    /// # Errors
    /// [`QuantityError`]: no number, or something behind it.
    pub fn parse_in(text: &str, unit: &Unit) -> Result<Self, QuantityError> {
        let normal = text.trim().replace('−', "-");
        let (digits, rest) = split_number(&normal)?;
        if !rest.is_empty() {
            return Err(QuantityError::NotANumber);
        }
        let si = unit.decimal_to_si(digits).ok_or(QuantityError::NotANumber)?;
        if !si.is_finite() {
            return Err(QuantityError::NotFinite);
        }
        Ok(Self { si: si + 0.0, unit: unit.clone(), tolerance: None })
    }

    /// The value in the unit typed, without unit.
    pub fn value(&self) -> f64 {
        self.unit.from_si(self.si)
    }

    /// Lower and upper deviation that the tolerance allows, SI, if there is one.
    pub fn deviations_si(&self) -> Option<[f64; 2]> {
        self.tolerance?.deviations_si(self.si)
    }
}

impl fmt::Display for Quantity {
    /// As typed: value, unit, tolerance.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&with_symbol(self.unit.decimal(self.si), &self.unit))?;
        self.tolerance.map_or(Ok(()), |tolerance| f.write_str(&tolerance.suffix(&self.unit, 12)))
    }
}

fn tolerance_error(text: &str) -> QuantityError {
    QuantityError::Tolerance(text.trim().to_owned())
}

/// Splits leading decimal digits from the unit that follows.
fn split_number(text: &str) -> Result<(&str, &str), QuantityError> {
    let bytes = text.as_bytes();
    let mut at = usize::from(matches!(bytes.first(), Some(b'+' | b'-')));
    let digits = |from: usize| bytes[from..].iter().take_while(|b| b.is_ascii_digit()).count();
    let whole = digits(at);
    at += whole;
    let mut fraction = 0;
    if bytes.get(at) == Some(&b'.') {
        fraction = digits(at + 1);
        at += 1 + fraction;
    }
    if whole + fraction == 0 {
        let word = text.trim_start_matches(['+', '-']).to_ascii_lowercase();
        let infinite = word.starts_with("nan") || word.starts_with("inf");
        return Err(if infinite { QuantityError::NotFinite } else { QuantityError::NotANumber });
    }
    if matches!(bytes.get(at), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(at + 1), Some(b'+' | b'-')));
        let exponent = digits(at + 1 + sign);
        if exponent > 0 {
            at += 1 + sign + exponent;
        }
    }
    if bytes.get(at) == Some(&b',') && bytes.get(at + 1).is_some_and(u8::is_ascii_digit) {
        return Err(QuantityError::DecimalComma(text.replacen(',', ".", 1)));
    }
    Ok((&text[..at], text[at..].trim()))
}

/// A value for people: in the given unit, with at most `digits` significant digits, no trailing zeros.
pub fn format_si(si: f64, unit: &Unit, digits: usize) -> String {
    with_symbol(format_number(unit.from_si(si), digits), unit)
}

fn with_symbol(number: String, unit: &Unit) -> String {
    match unit.pretty() {
        symbol if symbol.is_empty() => number,
        symbol => format!("{number} {symbol}"),
    }
}

/// A number for people: at most `digits` significant digits, no trailing zeros, exponent form outside 1e-4…1e7, a true minus sign is
/// not used so that numbers can be copied.
pub fn format_number(value: f64, digits: usize) -> String {
    if value.abs() == 0.0 {
        return "0".to_owned();
    }
    if !value.is_finite() {
        return if value.is_nan() { "not a number".to_owned() } else { format!("{value}") };
    }
    let digits = digits.clamp(1, 17);
    // Round first: 9.9996 with four digits has one more place before the point.
    let scientific = format!("{value:.*e}", digits - 1);
    let (head, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent = exponent.parse::<i32>().unwrap_or(0);
    let trim = |text: &str| {
        if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text.to_owned() }
    };
    if !(-4..7).contains(&exponent) {
        return format!("{}e{exponent}", trim(head));
    }
    let decimals = usize::try_from(i32::try_from(digits).unwrap_or(17) - 1 - exponent).unwrap_or(0);
    trim(&format!("{value:.decimals$}"))
}

/// `head · 10^exponent`, with one digit before the point of `head`, as people write it.
fn place_point(head: &str, exponent: i32) -> String {
    let (sign, head) = head.strip_prefix('-').map_or(("", head), |h| ("-", h));
    let digits = head.replace('.', "");
    let digits = match digits.trim_end_matches('0') {
        "" => return "0".to_owned(),
        digits => digits,
    };
    let (first, rest) = digits.split_at(1);
    let whole = usize::try_from(exponent).unwrap_or(0) + 1;
    match exponent {
        0..7 if digits.len() <= whole => format!("{sign}{digits}{}", "0".repeat(whole - digits.len())),
        0..7 => format!("{sign}{}.{}", &digits[..whole], &digits[whole..]),
        -4..0 => format!("{sign}0.{}{digits}", "0".repeat(usize::try_from(-exponent - 1).unwrap_or(0))),
        _ if rest.is_empty() => format!("{sign}{first}e{exponent}"),
        _ => format!("{sign}{first}.{rest}e{exponent}"),
    }
}

#[cfg(test)]
mod tests;
