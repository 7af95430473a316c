//! The springs as mounted.

use forcewright_base::diagnostics::{Diagnostic, Diagnostics};
use forcewright_base::units::Quantity;
use forcewright_contract::describe::Located;

use super::{exclude, missing, place_of, si};
use crate::spec::Spec;
use crate::springs::{Spring, SpringLaw};

/// The springs; `None` after an error.
pub(crate) fn mounted(spec: &Spec, diagnostics: &mut Diagnostics) -> Option<Vec<Spring>> {
    let springs = &spec.design.springs;
    exclude(&springs.rates, &springs.rate, ["rates", "rate"], diagnostics);
    exclude(&springs.rates, &springs.curve, ["rates", "curve"], diagnostics);
    exclude(&springs.rate, &springs.curve, ["rate", "curve"], diagnostics);
    let count = springs.count.as_ref().map_or(1, |c| c.value);
    if let (Some(rates), Some(count)) = (&springs.rates, &springs.count)
        && count.origin == forcewright_contract::describe::Origin::File
        && rates.value.len() != count.value as usize
    {
        diagnostics.push(
            Diagnostic::error("E0305", count.span, format!("`rates` lists {} springs, `count` says {}", rates.value.len(), count.value))
                .label("another number")
                .related(rates.span, "the rates")
                .help("leave `count` out"),
        );
    }
    let place = place_of(springs);
    // A value that was refused has been reported: it is not missing as well.
    let sound = !diagnostics.has_errors();
    if springs.curve.is_none() && springs.rest_length.is_none() && springs.present.is_some() && sound {
        diagnostics.push(missing(place, "`rest_length`", "give the length of the springs without force, `rest_length = \"136 mm\"`"));
    }
    let laws: Vec<SpringLaw> = if let Some(curve) = &springs.curve {
        vec![SpringLaw::Table(table_of(curve, diagnostics)?); count as usize]
    } else {
        let rates: Vec<f64> = match (&springs.rates, &springs.rate) {
            (Some(rates), _) => rates.value.iter().map(|q| q.si).collect(),
            (None, Some(rate)) => vec![rate.value.si; count as usize],
            (None, None) => {
                if springs.present.is_some() && sound {
                    diagnostics.push(missing(
                        place,
                        "`rates`",
                        "give the rate of each, `rates = [\"0.683 N/mm\", \"0.682 N/mm\"]`, or `rate` and `count`",
                    ));
                }
                return None;
            }
        };
        let rest_m = si(&springs.rest_length)?;
        rates.into_iter().map(|rate_n_per_m| SpringLaw::Linear { rate_n_per_m, rest_m }).collect()
    };
    let stretch_m = si(&springs.adjust.turns).unwrap_or(0.0) * si(&springs.adjust.pitch).unwrap_or(0.0);
    let mass_kg = si(&springs.mass).unwrap_or(0.0);
    Some(laws.into_iter().map(|law| Spring { law, stretch_m, mass_kg }).collect())
}

/// A curve of force over length: at least two points of rising length.
pub(super) fn table_of(curve: &Located<Vec<Located<[Quantity; 2]>>>, diagnostics: &mut Diagnostics) -> Option<Vec<[f64; 2]>> {
    let points: Vec<[f64; 2]> = curve.value.iter().map(|p| p.value.each_ref().map(|q| q.si)).collect();
    let fault = points.windows(2).position(|p| p[0][0] >= p[1][0]);
    if points.len() >= 2 && fault.is_none() {
        return Some(points);
    }
    let span = fault.and_then(|i| curve.value.get(i + 1)).map_or(curve.span, |p| p.span);
    diagnostics.push(
        Diagnostic::error("E0608", span, "a spring's curve needs at least two points of rising length")
            .label("here")
            .help("list length and force in the order of the length"),
    );
    None
}
