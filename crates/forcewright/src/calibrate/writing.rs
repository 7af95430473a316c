//! The project file with a variant that has what was found.

use std::path::Path;

use forcewright_base::diagnostics::{Diagnostic, Diagnostics};
use forcewright_contract::calibration::{OfBench, per};
use forcewright_contract::edit::{self, EditError};
use forcewright_contract::project::{Choices, Files};
use forcewright_model::Axis;
use forcewright_study::calibrate::BenchParameter;

use crate::optimise::{Changed, way};
use crate::{Loaded, Refused};

/// Name of the variant, where none was chosen.
const NAME: &str = "calibrated";
/// Digits of what was found of the bench: as many as of any number that is written.
const DIGITS: usize = 7;

/// What is written: numbers of the design by their paths, SI, and of the bench.
pub(super) struct Found<'a> {
    pub(super) design: Vec<(String, f64)>,
    pub(super) bench: Vec<(&'a OfBench, f64)>,
    pub(super) measurement: &'a str,
    pub(super) axes: &'a [Axis; 2],
}

impl Found<'_> {
    /// Keys below the measurement's table, and the text, of each number of the bench.
    fn texts(&self) -> impl Iterator<Item = (Vec<&str>, String)> {
        self.bench.iter().map(|(of, si)| {
            let keys = of.path.strip_prefix("bench.").unwrap_or(of.path).split('.').collect();
            let written = |value: f64, symbol: &str| {
                let plain: f64 = format!("{value:.*e}", DIGITS - 1).parse().unwrap_or(value);
                format!("{plain} {symbol}")
            };
            let text = match of.which {
                BenchParameter::OffsetX => written(self.axes[0].display.from_si(*si), self.axes[0].display.symbol()),
                BenchParameter::OffsetY => written(self.axes[1].display.from_si(*si), self.axes[1].display.symbol()),
                BenchParameter::Compliance => {
                    let [x, y] = self.axes.each_ref().map(|axis| &axis.display);
                    written(*si * y.to_si(1.0) / x.to_si(1.0), &per(x.symbol(), y.symbol()))
                }
            };
            (keys, text)
        })
    }
}

impl Loaded {
    /// The variant that gets the estimates: the one that was chosen, which they were found with, else a new one.
    pub(super) fn variant_of_estimates(&self) -> String {
        let taken = &self.project.variants;
        let numbered = (2_u32..).map(|n| format!("{NAME}-{n}"));
        let new = || std::iter::once(NAME.to_owned()).chain(numbered).find(|name| !taken.contains(name));
        self.project.choices.variant.clone().or_else(new).unwrap_or_else(|| NAME.to_owned())
    }

    /// The project file for the place `target`, with a variant that has what was found, and read again.
    pub(super) fn with_estimates(&self, (files, target): (&dyn Files, &Path), variant: &str, found: &Found<'_>) -> Result<String, Refused> {
        let text = self.text_with(target, variant, found).map_err(|error| {
            let mut diagnostics = Diagnostics::default();
            diagnostics.push(
                Diagnostic::error("E0318", self.project.root, error.to_string())
                    .label("in this file")
                    .help("write `variants` and `measurements` as tables of their own: `[variants.thin]`, `[measurements.curve]`"),
            );
            self.refused(diagnostics)
        })?;
        let choices = Choices { variant: Some(variant.to_owned()), set: Vec::new() };
        Self::from_file(&Changed { files, path: target, text: &text }, target, &choices)?;
        Ok(text)
    }

    fn text_with(&self, target: &Path, variant: &str, found: &Found<'_>) -> Result<String, EditError> {
        let numbers = self.understood.numbers();
        let place = |path: &str| numbers.iter().position(|n| n.path == path);
        let changed: Vec<(usize, f64)> = found.design.iter().filter_map(|(path, si)| Some((place(path)?, *si))).collect();
        let original = self.project.sources.iter().next().map_or_else(String::new, |s| s.text.to_string());
        let set = edit::with_settings(&original, &self.project.choices.set, self.project.choices.variant.as_deref())?;
        let mut text = edit::with_variant(&set, numbers, &changed, variant)?;
        for (keys, value) in found.texts() {
            let path: Vec<&str> = ["variants", variant, "measurements", found.measurement].into_iter().chain(keys).collect();
            text = edit::with_text_at(&text, &path, &value)?;
        }
        match way(target, Path::new(&self.name())) {
            Some(way) => edit::with_base_from(&text, &way),
            None => Ok(text),
        }
    }
}
