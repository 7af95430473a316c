//! Round numbers for axes.

use forcewright_base::maths;
use forcewright_base::units::format_number;

/// Values beyond this are drawn at it: differences of two doubles must stay finite.
const LARGEST: f64 = 1e300;

/// Round numbers on an axis, and the range that they cover.
#[derive(Clone, Debug)]
pub struct Ticks {
    /// Lower end of the axis; a tick.
    pub low: f64,
    /// Upper end of the axis; a tick.
    pub high: f64,
    /// The values, ascending.
    pub values: Vec<f64>,
    /// Their texts, with a true minus sign.
    pub labels: Vec<String>,
}

/// A number brought into the range that can be drawn.
pub(super) fn sane(value: f64) -> Option<f64> {
    value.is_finite().then(|| value.clamp(-LARGEST, LARGEST))
}

/// Smallest step of the form 1, 2 or 5 times a power of ten that is not below `raw`; its mantissa and exponent.
fn nice_step(raw: f64) -> (f64, i32) {
    let exponent = maths::log10(raw).floor().clamp(-300.0, 300.0);
    // In range by the clamp.
    #[allow(clippy::cast_possible_truncation, reason = "clamped to ±300")]
    let exponent = exponent as i32;
    let head = raw / maths::powi(10.0, exponent);
    [1.0, 2.0, 5.0].into_iter().find(|m| head <= m * (1.0 + 1e-9)).map_or((1.0, exponent + 1), |m| (m, exponent))
}

/// A round length not above `raw`: for scale bars.
pub(super) fn round_below(raw: f64) -> f64 {
    if !(raw > 1e-290 && raw < 1e290) {
        return 1.0;
    }
    let (mantissa, exponent) = nice_step(raw);
    let above = scaled(mantissa, exponent);
    if above <= raw * (1.0 + 1e-9) {
        return above;
    }
    match mantissa {
        m if m > 4.0 => scaled(2.0, exponent),
        m if m > 1.5 => scaled(1.0, exponent),
        _ => scaled(5.0, exponent - 1),
    }
}

/// `m · 10^e`, the double nearest to that decimal.
fn scaled(mantissa: f64, exponent: i32) -> f64 {
    if exponent < 0 { mantissa / maths::powi(10.0, -exponent) } else { mantissa * maths::powi(10.0, exponent) }
}

/// Ticks that cover `low..=high` with about `target` steps of 1, 2 or 5 times a power of ten. Any input is answered: a range without
/// extent is widened, one that is not a number becomes 0 to 1.
pub fn cover(low: f64, high: f64, target: usize) -> Ticks {
    let (mut low, mut high) = match (sane(low), sane(high)) {
        (Some(a), Some(b)) => (a.min(b), a.max(b)),
        _ => (0.0, 1.0),
    };
    let size = low.abs().max(high.abs());
    if size < 1e-290 {
        (low, high) = (0.0, 1.0);
    } else if high - low <= size * 1e-9 {
        let middle = 0.5 * low + 0.5 * high;
        (low, high) = (middle - 0.05 * size, middle + 0.05 * size);
    }
    let (mantissa, exponent) = nice_step((high - low) / target.clamp(1, 50) as f64);
    let step = scaled(mantissa, exponent);
    let (first, last) = ((low / step + 1e-9).floor(), (high / step - 1e-9).ceil());
    let last = if last > first { last } else { first + 1.0 };
    let mut values = Vec::new();
    let mut index = first;
    while index <= last && values.len() < 200 {
        values.push(scaled(index * mantissa, exponent) + 0.0);
        index += 1.0;
    }
    let labels = labels(&values, exponent);
    Ticks { low: first * step, high: last * step, values, labels }
}

/// Texts of tick values whose step has the decimal exponent given.
fn labels(values: &[f64], exponent: i32) -> Vec<String> {
    let largest = values.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let plain = (-4..=6).contains(&exponent) && largest < 1e7;
    let decimals = usize::try_from(-exponent).unwrap_or(0);
    let text = |v: &f64| {
        if plain {
            return format!("{v:.decimals$}");
        }
        // Enough digits to tell neighbours apart.
        let digits = (maths::log10(largest.max(1e-300)).floor() - f64::from(exponent) + 1.0).clamp(1.0, 15.0);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to 1…15")]
        let digits = digits as usize;
        if v.abs() < scaled(0.5, exponent) { "0".to_owned() } else { format_number(*v, digits) }
    };
    values.iter().map(text).map(|t| t.replace('-', "−")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(low: f64, high: f64) {
        let ticks = cover(low, high, 6);
        let slack = 1e-6 * (ticks.high - ticks.low);
        assert!(ticks.low <= low.max(-1e300) + slack && ticks.high >= high.min(1e300) - slack, "{low} {high}: {ticks:?}");
        assert!((2..=16).contains(&ticks.values.len()), "{low} {high}: {ticks:?}");
        assert!(ticks.values.windows(2).all(|w| w[1] > w[0]), "{ticks:?}");
        let mut labels = ticks.labels.clone();
        labels.dedup();
        assert_eq!(labels.len(), ticks.values.len(), "{ticks:?}");
        assert!(ticks.values.iter().all(|v| v.is_finite()));
    }

    #[test]
    fn ticks_are_round_and_cover() {
        let ticks = cover(0.0, 13.6, 7);
        assert_eq!(ticks.labels, ["0", "2", "4", "6", "8", "10", "12", "14"]);
        let ticks = cover(-0.05, 0.11, 4);
        assert_eq!(ticks.labels, ["−0.05", "0.00", "0.05", "0.10", "0.15"]);
        for (low, high) in [
            (0.0, 9.74),
            (-3.2, 7.1),
            (9.2, 10.2),
            (0.0, 1e-300),
            (1e299, 1e300),
            (-1e300, 1e300),
            (-1.7e308, 1.7e308),
            (1e-12, 3e-12),
            (1e9, 1.0001e9),
            (5.0, 5.0),
            (0.0, 0.0),
            (48.2e6, 48.3e6),
        ] {
            check(low, high);
        }
    }

    #[test]
    fn nonsense_gets_an_axis() {
        for (low, high) in [(f64::NAN, 1.0), (0.0, f64::INFINITY), (f64::INFINITY, f64::NEG_INFINITY), (3.0, 1.0)] {
            assert!(cover(low, high, 5).values.len() >= 2);
        }
        assert!(cover(0.0, 1.0, 0).values.len() >= 2);
    }

    #[test]
    fn scale_bars_are_round() {
        for (raw, want) in [(0.013, 0.01), (0.049, 0.02), (0.05, 0.05), (1.99, 1.0), (7.0, 5.0), (30.0, 20.0)] {
            assert!((round_below(raw) - want).abs() < 1e-12 * want, "{raw}: {}", round_below(raw));
        }
        assert!((round_below(f64::NAN) - 1.0).abs() < 1e-12);
    }
}
