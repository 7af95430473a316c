//! Tests of units and quantities.

use super::spelling::SPELLINGS;
use super::*;

fn length(text: &str) -> Quantity {
    Quantity::parse(text, Dimension::Length).unwrap()
}

/// Of a `±`.
fn half_width(quantity: &Quantity) -> f64 {
    let [lower, upper] = quantity.deviations_si().unwrap();
    assert_eq!((-lower).to_bits(), upper.to_bits());
    upper
}

#[test]
fn every_dimension_has_a_row_and_its_example_reads() {
    for dimension in Dimension::all() {
        assert_eq!(dimension.row().dimension, dimension);
        let example = Quantity::parse(dimension.example(), dimension).unwrap();
        assert!(example.si.is_finite());
        assert!(Unit::parse(dimension.si_symbol()).unwrap().is(dimension), "{dimension:?}");
    }
}

#[test]
fn exact_conversions_from_the_standards() {
    for (text, dimension, si) in [
        ("1 in", Dimension::Length, 0.0254),
        ("1 lbf", Dimension::Force, 4.448_221_615_260_5),
        ("1 kgf", Dimension::Force, 9.806_65),
        ("1 lb", Dimension::Mass, 0.453_592_37),
        ("1 psi", Dimension::Stress, 6_894.757_293_168_361),
        ("1 N/mm^2", Dimension::Stress, 1e6),
        ("1 Wh", Dimension::Energy, 3600.0),
        ("1 g*mm^2", Dimension::Inertia, 1e-9),
        ("1 g/cm^3", Dimension::Density, 1000.0),
        ("60 rpm", Dimension::AngularSpeed, 2.0 * std::f64::consts::PI),
        ("180 deg", Dimension::Angle, std::f64::consts::PI),
        ("5 %", Dimension::Ratio, 0.05),
        ("1 N·mm", Dimension::Torque, 1e-3),
        ("1 μm", Dimension::Length, 1e-6),
    ] {
        let got = Quantity::parse(text, dimension).unwrap().si;
        assert!((got - si).abs() <= 4.0 * f64::EPSILON * si, "{text}: {got} is not {si}");
    }
}

#[test]
fn decimal_units_give_the_same_bits() {
    for (a, b) in [("34.497 mm", "3.4497 cm"), ("0.85 mm", "850 µm"), ("18.77 mm", "1877e-5 m"), ("1e-3 m", "1 mm")] {
        assert_eq!(length(a).si.to_bits(), length(b).si.to_bits(), "{a} and {b}");
    }
}

#[test]
fn torque_is_not_energy() {
    assert!(Quantity::parse("1 J", Dimension::Torque).is_err());
    assert!(Quantity::parse("1 N*m", Dimension::Energy).is_err());
    assert_eq!(Quantity::parse("400 N", Dimension::Torque), Err(QuantityError::WrongDimension("N".to_owned(), Some(Dimension::Force))));
}

#[test]
fn tolerances_in_every_spelling() {
    for text in ["0.85 mm ± 0.02 mm", "0.85 mm +/- 0.02 mm", "0.85 ± 0.02 mm", "0.85 mm ± 20 µm", "0.85mm±0.02mm", "0.85 mm ± 0.02"] {
        let q = length(text);
        assert!((q.si - 0.85e-3).abs() < 1e-18 && (half_width(&q) - 2e-5).abs() < 1e-18, "{text}");
    }
    assert!((half_width(&length("2 mm ± 5 %")) - 1e-4).abs() < 1e-18);
    let ratio = Quantity::parse("0.12 ± 0.03", Dimension::Ratio).unwrap();
    assert!((half_width(&ratio) - 0.03).abs() < 1e-15);
    assert_eq!(length("17.6 mm h7").tolerance, Some(Tolerance::Fit(Fit::parse("h7").unwrap())));
    assert!(Quantity::parse("1 mm ± -2 mm", Dimension::Length).is_err());
    assert!(Quantity::parse("1 mm ± 2 N", Dimension::Length).is_err());
}

#[test]
fn fits_are_read_with_their_diameter() {
    let limits = |text: &str| length(text).deviations_si().unwrap().map(f64::to_bits);
    let wanted = |lower: f64, upper: f64| [lower, upper].map(f64::to_bits);
    assert_eq!(limits("17.6 mm h7"), wanted(-18e-6, 0.0));
    assert_eq!(limits("1.76 cm  h7"), wanted(-18e-6, 0.0));
    assert_eq!(limits("19.4 mm H7"), wanted(0.0, 21e-6));
    // The upper end of a step belongs to it, to the last bit and in every unit.
    assert_eq!(limits("18 mm h7"), wanted(-18e-6, 0.0));
    assert_eq!(limits("0.018 m h7"), wanted(-18e-6, 0.0));
    assert_eq!(limits("18.000001 mm h7"), wanted(-21e-6, 0.0));
    let error = |text: &str| Quantity::parse(text, Dimension::Length).unwrap_err();
    assert_eq!(error("17.6 mm q7"), QuantityError::Fit("q7".to_owned(), FitError::Letters));
    assert_eq!(error("17.6 mm h19"), QuantityError::Fit("h19".to_owned(), FitError::Grade));
    assert!(matches!(error("600 mm h7"), QuantityError::Fit(_, FitError::Diameter(..))));
    assert!(matches!(error("-5 mm h7"), QuantityError::Fit(_, FitError::Diameter(..))));
    // No other quantity has a fit, and a misspelt unit is no fit.
    assert!(matches!(Quantity::parse("17.6 N h7", Dimension::Force), Err(QuantityError::Unit(_))));
    assert!(matches!(error("17.6 mm mm2"), QuantityError::Fit(..)));
    assert!(matches!(error("17.6 mm h7 x"), QuantityError::Unit(_)));
}

#[test]
fn a_number_without_its_unit() {
    let millimetre = Unit::parse("mm").unwrap();
    let read = |text: &str| Quantity::parse_in(text, &millimetre).map(|q| q.si);
    assert_eq!(read(" 1.25 "), Ok(1.25e-3));
    assert_eq!(read("−2e-1"), Ok(-0.2e-3));
    assert_eq!(read("1 mm"), Err(QuantityError::NotANumber));
    assert_eq!(read(""), Err(QuantityError::NotANumber));
    assert_eq!(read("1e400"), Err(QuantityError::NotFinite));
    assert_eq!(read("1,5"), Err(QuantityError::DecimalComma("1.5".to_owned())));
}

#[test]
fn what_is_typed_is_printed() {
    for text in ["0.85 mm ± 0.02 mm", "34.497 mm", "3.4497 cm", "17.6 mm h7", "25 mm JS01", "1.3 in"] {
        assert_eq!(length(text).to_string(), text);
    }
    assert_eq!(Quantity::parse("2 GPa", Dimension::Stress).unwrap().to_string(), "2 GPa");
    assert_eq!(Quantity::parse("400 N*mm", Dimension::Torque).unwrap().to_string(), "400 N·mm");
}

#[test]
fn every_digit_typed_is_printed_back() {
    for text in ["0.123456789012345 mm", "1.00000000000001 m", "123456.789012345 N", "3e-9 N", "-0.1 N", "1200000 N", "1e22 N"] {
        let dimension = if text.ends_with('m') { Dimension::Length } else { Dimension::Force };
        assert_eq!(Quantity::parse(text, dimension).unwrap().to_string(), text);
    }
    assert_eq!(length("-0 mm").to_string(), "0 mm");
    assert_eq!(length("5e-4 mm").to_string(), "0.0005 mm");
}

#[test]
fn units_as_people_misspell_them() {
    for (typed, meant) in [
        ("mmm", "mm"),
        ("Mpa", "MPa"),
        ("GPA", "GPa"),
        ("mpa", "MPa"),
        ("MM", "mm"),
        ("n", "N"),
        ("kn", "kN"),
        ("Kg", "kg"),
        ("Nm", "N*m"),
        ("Nmm", "N*mm"),
        ("NM", "N*m"),
        ("inch", "in"),
        ("degrees", "deg"),
        ("Deg", "deg"),
        ("sec", "s"),
        ("mm2", "mm^2"),
        ("RPM", "rpm"),
        ("PSI", "psi"),
        ("radd", "rad"),
    ] {
        assert_eq!(Unit::parse(typed), Err(UnitError::Unknown(typed.to_owned(), Some(meant))));
    }
    for (typed, meant) in SPELLINGS {
        assert!(Unit::parse(meant).is_ok(), "{typed} suggests {meant}");
        assert!(Unit::parse(typed).is_err() || *typed == "nm", "{typed} is a unit");
    }
}

#[test]
fn durations_of_tests_and_of_lives() {
    let seconds = |text| Quantity::parse(text, Dimension::Time).map(|q| q.si);
    assert_eq!([seconds("1 d"), seconds("24 h"), seconds("1440 min"), seconds("86400 s")], [const { Ok(86_400.0) }; 4]);
}

#[test]
fn nonsense_is_refused() {
    use QuantityError::{DecimalComma, NoUnit, NotANumber, NotFinite};
    let error = |text| Quantity::parse(text, Dimension::Length).unwrap_err();
    assert_eq!(error(""), NotANumber);
    assert_eq!(error("mm"), NotANumber);
    assert_eq!(error("nan mm"), NotFinite);
    assert_eq!(error("-inf mm"), NotFinite);
    assert_eq!(error("1e400 mm"), NotFinite);
    assert_eq!(error("12,5 mm"), DecimalComma("12.5 mm".to_owned()));
    assert_eq!(error("16"), NoUnit);
    assert_eq!(error("16 mmm"), QuantityError::Unit(UnitError::Unknown("mmm".to_owned(), Some("mm"))));
    for text in ["1 m^", "1 m^99", "1 /", "1 m//s", "1e99999999999999999999 m", "1 m*", "1 ^2", "±", "1 ± ", "١ mm"] {
        assert!(Quantity::parse(text, Dimension::Length).is_err(), "{text}");
    }
}

#[test]
fn numbers_for_people() {
    for (value, digits, text) in [
        (9.9996, 4, "10"),
        (48.222_896, 4, "48.22"),
        (0.000_123_456, 3, "0.000123"),
        (1.234e-7, 3, "1.23e-7"),
        (-0.020_09, 3, "-0.0201"),
        (123_456.0, 3, "123456"),
        (2e9, 3, "2e9"),
        (0.0, 3, "0"),
    ] {
        assert_eq!(format_number(value, digits), text);
    }
}
