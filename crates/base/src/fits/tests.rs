//! Limits of size against published tables, and laws of the system that the data must obey.

use super::*;

/// Lower and upper deviation in µm.
fn limits(fit: &str, diameter_mm: f64) -> Option<[f64; 2]> {
    Some(Fit::parse(fit).unwrap().deviations_m(diameter_mm / 1e3).ok()?.map(|deviation| (deviation * 1e6 * 1e4).round() / 1e4))
}

#[test]
fn limits_as_published() {
    for (fit, diameter_mm, wanted) in [
        // Mechanical engineering handbooks, the preferred fits.
        ("H7", 20.0, [0.0, 21.0]),
        ("h6", 20.0, [-13.0, 0.0]),
        ("g6", 50.0, [-25.0, -9.0]),
        ("k6", 30.0, [2.0, 15.0]),
        ("P7", 30.0, [-35.0, -14.0]),
        ("H7", 50.0, [0.0, 25.0]),
        ("s6", 50.0, [43.0, 59.0]),
        ("g6", 25.0, [-20.0, -7.0]),
        ("p6", 25.0, [22.0, 35.0]),
        ("H11", 100.0, [0.0, 220.0]),
        ("c11", 100.0, [-390.0, -170.0]),
        ("N9", 8.0, [-36.0, 0.0]),
        ("P9", 8.0, [-51.0, -15.0]),
        ("JS9", 8.0, [-18.0, 18.0]),
        ("k5", 40.0, [2.0, 13.0]),
        ("j6", 40.0, [-5.0, 11.0]),
        ("J7", 40.0, [-11.0, 14.0]),
        ("K7", 40.0, [-18.0, 7.0]),
        ("M7", 40.0, [-25.0, 0.0]),
        ("N7", 40.0, [-33.0, -8.0]),
        ("R7", 40.0, [-50.0, -25.0]),
        ("S7", 40.0, [-59.0, -34.0]),
        ("u6", 60.0, [87.0, 106.0]),
        // Corrected by ISO 286-2:1988/Cor. 1:2006.
        ("A13", 330.0, [1200.0, 2090.0]),
        ("E8", 100.0, [72.0, 126.0]),
        ("R10", 24.0, [-112.0, -28.0]),
        ("f9", 300.0, [-186.0, -56.0]),
        // The exception of ISO 286-1, Table 3.
        ("M6", 300.0, [-41.0, -9.0]),
        ("M6", 250.0, [-37.0, -8.0]),
        ("k8", 30.0, [0.0, 33.0]),
        ("k3", 30.0, [0.0, 4.0]),
        ("h01", 2.0, [-0.3, 0.0]),
        ("js01", 2.0, [-0.15, 0.15]),
        ("K9", 2.0, [-25.0, 0.0]),
    ] {
        assert_eq!(limits(fit, diameter_mm), Some(wanted), "{diameter_mm} mm {fit}");
    }
}

/// Every fit that can be written.
fn all() -> impl Iterator<Item = Fit> {
    let letters = 0..=SHAFTS.len();
    letters
        .flat_map(|letter| [false, true].into_iter().flat_map(move |hole| (0..GRADES.len()).map(move |grade| Fit { hole, letter, grade })))
}

/// A diameter inside each step, and at its end.
fn diameters_mm() -> impl Iterator<Item = f64> {
    let below = [0.0].into_iter().chain(FINE_STEPS_MM);
    [0.5, 1.0].into_iter().chain(below.zip(FINE_STEPS_MM).flat_map(|(from, to)| [f64::midpoint(from, to), to]))
}

#[test]
fn what_is_written_is_read() {
    for fit in all() {
        assert_eq!(Fit::parse(&fit.to_string()), Ok(fit));
        assert!(Fit::looks_like(&fit.to_string()));
    }
    for (text, why) in
        [("", FitError::Letters), ("7", FitError::Grade), ("Js7", FitError::Letters), ("w7", FitError::Letters), ("h19", FitError::Grade)]
    {
        let found = Fit::parse(text);
        assert!(found == Err(why) || (text == "7" && found == Err(FitError::Letters)), "{text}: {found:?}");
    }
    for text in ["mm", "h", "7", "", "h123", "abc1", "h7 ", "m^3", "é7"] {
        assert!(!Fit::looks_like(text), "{text}");
    }
}

#[test]
fn every_zone_has_the_width_of_its_grade_and_finer_steps_change_nothing_else() {
    for fit in all() {
        for d in diameters_mm() {
            let Some([lower, upper]) = limits(&fit.to_string(), d) else { continue };
            let main = STEPS_MM.iter().position(|up_to| d <= *up_to).unwrap();
            assert!((upper - lower - f64::from(TOLERANCE[fit.grade][main]) / 10.0).abs() < 1e-3, "{d} mm {fit}: {lower} {upper}");
        }
    }
}

#[test]
fn tolerances_grow_with_grade_and_diameter() {
    for (row, finer) in TOLERANCE[1..].iter().zip(&TOLERANCE) {
        assert!(row.iter().zip(finer).all(|(wide, narrow)| wide > narrow));
    }
    assert!(TOLERANCE.iter().all(|row| row.windows(2).all(|w| w[0] <= w[1])));
    // From IT6 on, five grades are a factor of ten: ISO 286-1, 4.1.2; IT 6 to 10 at 3 to 6 mm are rounded otherwise.
    for (fine, coarse) in TOLERANCE[IT6..].iter().zip(&TOLERANCE[IT6 + 5..]) {
        assert!(fine.iter().zip(coarse).all(|(f, c)| (10 * f - c).abs() * 15 <= *c), "{fine:?} {coarse:?}");
    }
}

#[test]
fn positions_follow_one_another_and_the_diameter() {
    let defined = |values: &[i32]| values.iter().copied().filter(|v| *v != NONE).collect::<Vec<_>>();
    for (letter, values) in SHAFTS {
        let values = defined(values);
        assert!(values.windows(2).all(|w| w[0] <= w[1]), "{letter} falls with the diameter");
    }
    for d in diameters_mm() {
        let lower = |letters: &&str| limits(&format!("{letters}6"), d).map(|l| l[0]);
        let order =
            ["a", "b", "c", "d", "e", "f", "g", "h", "j", "k", "m", "n", "p", "r", "s", "t", "u", "v", "x", "y", "z", "za", "zb", "zc"];
        let found: Vec<f64> = order.iter().filter_map(lower).collect();
        assert!(found.len() >= 19 && found.windows(2).all(|w| w[0] < w[1]), "{d} mm: {found:?}");
    }
}

#[test]
fn a_hole_with_a_finer_shaft_fits_as_a_shaft_with_a_hole_h() {
    // What Δ is for (ISO 286-1, 4.3.2.3 b): H7/p6 and P7/h6 have the same interference.
    for (letters, grades) in [("k", 5..=8), ("m", 5..=8), ("n", 5..=8), ("p", 5..=7), ("s", 5..=7), ("u", 5..=7), ("zc", 5..=7)] {
        for grade in grades {
            for d in diameters_mm().filter(|d| *d > 3.0) {
                let hole = limits(&format!("{}{grade}", letters.to_uppercase()), d).unwrap();
                let shaft = Fit::parse(&format!("{letters}{}", grade - 1)).unwrap();
                let own = SHAFTS[shaft.letter].1;
                let step = |steps: &[f64]| steps.iter().position(|up_to| d <= *up_to).unwrap();
                let main = step(&STEPS_MM);
                let own = own[if own.len() == STEPS_MM.len() { main } else { step(&FINE_STEPS_MM) }];
                let widths = [grade, grade - 1].map(|g| f64::from(TOLERANCE[g + 1][main]) / 10.0);
                let wanted = -f64::from(own) + widths[0] - widths[1];
                // The standard rounds Δ and makes one exception.
                let exception = if letters == "m" && grade == 6 && main == 10 { 2.0 } else { 0.0 };
                assert!((hole[1] - wanted - exception).abs() <= 0.5, "{d} mm {letters}{grade}: {} {wanted}", hole[1]);
            }
        }
    }
}

#[test]
fn diameters_of_a_fit_have_no_gap_and_hold_exactly_those_with_limits() {
    for fit in all() {
        let all = fit.diameters_m();
        for d in diameters_mm() {
            let inside = all.is_some_and(|[from, to]| d / 1e3 > from && d / 1e3 <= to);
            assert_eq!(limits(&fit.to_string(), d).is_some(), inside, "{d} mm {fit}: {all:?}");
        }
    }
    for (fit, wanted) in [("h7", [0.0, 0.5]), ("h14", [1e-3, 0.5]), ("b11", [1e-3, 0.5]), ("t6", [0.024, 0.5]), ("K9", [0.0, 0.003])] {
        assert_eq!(Fit::parse(fit).unwrap().diameters_m(), Some(wanted), "{fit}");
    }
    for fit in ["j4", "j9", "J5", "P2"] {
        assert_eq!(Fit::parse(fit).unwrap().diameters_m(), None, "{fit}");
    }
    for d in [0.0, -1.0, f64::NAN, f64::INFINITY, 500.1] {
        assert!(matches!(Fit::parse("h7").unwrap().deviations_m(d / 1e3), Err(FitError::Diameter(..))), "{d}");
    }
    let words = Fit::parse("t6").unwrap().deviations_m(0.02).unwrap_err().to_string();
    assert_eq!(words, "`t6` is tabulated for diameters above 24 mm up to 500 mm");
    assert_eq!(Fit::parse("j9").unwrap().deviations_m(0.02).unwrap_err().to_string(), "`j9` is not tabulated in ISO 286");
}
