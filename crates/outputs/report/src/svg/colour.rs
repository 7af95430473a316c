//! Colours: what things are painted with, and the map from values to colours.

use std::fmt::Write as _;

use crate::escape::each;

/// What a thing is painted with. Each has a custom property, so that a page can follow the reader's light or dark setting, and a
/// colour for light paper where the property is not set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Paint {
    /// Text and outlines.
    Ink,
    /// Secondary text.
    Muted,
    /// Grid lines.
    Grid,
    /// The background.
    Paper,
    /// The result.
    Main,
    /// A second result.
    Second,
    /// A third result.
    Third,
    /// A reference.
    Reference,
    /// A limit.
    Limit,
    /// The region that a requirement asks for.
    Band,
    /// A region along the abscissa.
    Span,
    /// Rigid bodies.
    Body,
}

/// Every paint with its property and its colours on light and on dark paper. Hues after Okabe and Ito's palette for all kinds of
/// colour vision, darkened or lightened to 3:1 against the paper and more.
const PAINTS: [(Paint, &str, &str, &str); 12] = [
    (Paint::Ink, "--fw-ink", "#1a1f26", "#e8ecf1"),
    (Paint::Muted, "--fw-muted", "#505a66", "#aab4c0"),
    (Paint::Grid, "--fw-grid", "#dde2e8", "#2e3640"),
    (Paint::Paper, "--fw-paper", "#ffffff", "#161b21"),
    (Paint::Main, "--fw-main", "#0a5ea8", "#63b3f5"),
    (Paint::Second, "--fw-second", "#b35900", "#f0a35c"),
    (Paint::Third, "--fw-third", "#6a3d9a", "#c4a5ee"),
    (Paint::Reference, "--fw-reference", "#6b7480", "#93a0ae"),
    (Paint::Limit, "--fw-limit", "#b3123c", "#ff8095"),
    (Paint::Band, "--fw-band", "#00785a", "#3ccfa4"),
    (Paint::Span, "--fw-span", "#44619d", "#8fa9dd"),
    (Paint::Body, "--fw-body", "#d3dae2", "#333c47"),
];

impl Paint {
    fn row(self) -> (&'static str, &'static str) {
        PAINTS.iter().find(|p| p.0 == self).map_or(("--fw-ink", "#1a1f26"), |p| (p.1, p.2))
    }

    /// Attributes that paint with this colour: the plain one for programs that know no custom properties, and the one for browsers.
    pub(super) fn attributes(self, what: &str) -> String {
        let (property, light) = self.row();
        format!(r#"{what}="{light}" style="{what}:var({property},{light})""#)
    }

    /// The same for fill and stroke together.
    pub(super) fn fill_and_stroke(fill: Self, stroke: Self) -> String {
        let ((f, fl), (s, sl)) = (fill.row(), stroke.row());
        format!(r#"fill="{fl}" stroke="{sl}" style="fill:var({f},{fl});stroke:var({s},{sl})""#)
    }
}

/// Declarations of all properties, for light or for dark paper: `--fw-ink:#1a1f26;…`.
pub fn declarations(dark: bool) -> String {
    each(&PAINTS, |(_, property, light, night)| format!("{property}:{};", if dark { night } else { light }))
}

/// Nine colours of viridis, evenly spaced (Smith and van der Walt's map of the matplotlib project, released to the public domain):
/// perceptually uniform, rising in lightness, so that it reads in grey and with any colour vision.
const VIRIDIS: [[u8; 3]; 9] = [
    [68, 1, 84],
    [71, 44, 122],
    [59, 81, 139],
    [44, 113, 142],
    [33, 144, 141],
    [39, 173, 129],
    [92, 200, 99],
    [170, 220, 50],
    [253, 231, 37],
];

/// How many different colours a scale shows.
pub(super) const LEVELS: u8 = 64;

/// The level of a value on a scale from zero to `max`; its size counts, not its sign.
pub(super) fn level(value: f64, max: f64) -> u8 {
    let part = value.abs() / max;
    if part.is_nan() {
        return 0;
    }
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to 0…LEVELS−1")]
    let level = (part.clamp(0.0, 1.0) * f64::from(LEVELS - 1)).round() as u8;
    level
}

/// The colour of a level, as `#rrggbb`.
pub(super) fn of_level(level: u8) -> String {
    let place = f64::from(level.min(LEVELS - 1)) / f64::from(LEVELS - 1) * (VIRIDIS.len() - 1) as f64;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "place is 0…8")]
    let below = (place.floor() as usize).min(VIRIDIS.len() - 2);
    let part = place - below as f64;
    let mut out = String::from("#");
    for (a, b) in VIRIDIS[below].iter().zip(VIRIDIS[below + 1]) {
        let mixed = f64::from(*a) + part * (f64::from(b) - f64::from(*a));
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between two bytes")]
        let byte = mixed.round() as u8;
        let _ = write!(out, "{byte:02x}");
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    /// WCAG 2.2, relative luminance.
    fn luminance(hex: &str) -> f64 {
        let channel = |at: usize| {
            let c = f64::from(u8::from_str_radix(&hex[at..at + 2], 16).unwrap()) / 255.0;
            if c <= 0.04045 { c / 12.92 } else { forcewright_base::maths::powf((c + 0.055) / 1.055, 2.4) }
        };
        0.2126 * channel(1) + 0.7152 * channel(3) + 0.0722 * channel(5)
    }

    fn contrast(a: &str, b: &str) -> f64 {
        let (a, b) = (luminance(a), luminance(b));
        (a.max(b) + 0.05) / (a.min(b) + 0.05)
    }

    #[test]
    fn every_paint_can_be_seen_on_its_paper() {
        let of = |paint| PAINTS.iter().find(|p| p.0 == paint).unwrap();
        let paper = of(Paint::Paper);
        for row in PAINTS.iter().filter(|p| !matches!(p.0, Paint::Paper | Paint::Grid | Paint::Body)) {
            let least = if matches!(row.0, Paint::Ink | Paint::Muted | Paint::Limit) { 4.5 } else { 3.0 };
            assert!(contrast(row.2, paper.2) >= least && contrast(row.3, paper.3) >= least, "{row:?}");
        }
        let body = of(Paint::Body);
        assert!(contrast(of(Paint::Ink).2, body.2) >= 4.5 && contrast(of(Paint::Ink).3, body.3) >= 4.5);
    }

    #[test]
    fn the_map_rises_in_lightness() {
        let lightness: Vec<f64> = (0..LEVELS).map(|l| luminance(&of_level(l))).collect();
        assert!(lightness.windows(2).all(|w| w[1] > w[0]));
        assert_eq!((of_level(0), of_level(255)), ("#440154".to_owned(), "#fde725".to_owned()));
        assert_eq!((level(f64::NAN, 1.0), level(1.0, 0.0), level(-0.5, 1.0), level(9.0, 1.0)), (0, 63, 32, 63));
    }
}
