//! Names of a family's metrics, and the limits that a project sets on them: stable, so that requirements, studies and scripts agree.

use forcewright_base::diagnostics::{Diagnostic, Diagnostics};
use forcewright_base::units::{Dimension, Quantity, Unit};
use forcewright_model::Metric;

use crate::describe::{Describe, Located, Origin, Param, Section, Slot, Visitor};

/// What is said once about a metric.
#[derive(Debug)]
pub struct MetricInfo {
    /// Stable name.
    pub name: &'static str,
    /// Quantity.
    pub dimension: Dimension,
    /// One sentence.
    pub doc: &'static str,
    /// Whether the command line prints it.
    pub key: bool,
}

/// An entry of a family's list.
pub const fn metric(name: &'static str, dimension: Dimension, key: bool, doc: &'static str) -> MetricInfo {
    MetricInfo { name, dimension, doc, key }
}

/// A family's list of metrics, in the order of results.
pub trait Metrics: Default + std::fmt::Debug {
    /// The list.
    const ALL: &'static [MetricInfo];
}

/// Values of a family's metrics, in the order of its list, SI.
#[derive(Debug)]
pub struct Values<M> {
    values: Vec<Option<f64>>,
    family: std::marker::PhantomData<M>,
}

impl<M> Clone for Values<M> {
    fn clone(&self) -> Self {
        Self { values: self.values.clone(), family: std::marker::PhantomData }
    }
}

impl<M: Metrics> Values<M> {
    /// Nothing measured yet.
    pub fn none() -> Self {
        Self { values: vec![None; M::ALL.len()], family: std::marker::PhantomData }
    }

    /// A metric by name.
    pub fn get(&self, name: &str) -> Option<f64> {
        self.value(M::ALL.iter().position(|m| m.name == name)?)
    }

    /// A metric by its index.
    pub fn value(&self, index: usize) -> Option<f64> {
        self.values.get(index).copied().flatten()
    }

    /// Notes a metric; one that is not a number is absent.
    pub fn set(&mut self, name: &str, value: impl Into<Option<f64>>) {
        if let Some(index) = M::ALL.iter().position(|m| m.name == name) {
            self.values[index] = value.into().filter(|v| v.is_finite());
        }
    }
}

/// The metrics that have a value, as outputs see them: `value` and `display` take the index into the list.
pub fn results<M: Metrics>(value: impl Fn(usize) -> Option<f64>, display: impl Fn(usize) -> Unit) -> Vec<Metric> {
    let one = |(index, info): (usize, &MetricInfo)| {
        let MetricInfo { name, dimension, doc, key } = *info;
        Some(Metric { name, value: value(index)?, dimension, display: display(index), doc, key })
    };
    M::ALL.iter().enumerate().filter_map(one).collect()
}

/// Bounds on the metrics of a family, in the order of its list: `[requirements.limits]`.
#[derive(Debug)]
pub struct Limits<M> {
    /// One per metric.
    pub bounds: Vec<Section<Bounds>>,
    family: std::marker::PhantomData<M>,
}

impl<M: Metrics> Default for Limits<M> {
    fn default() -> Self {
        let bounds = M::ALL.iter().map(|info| Section { present: None, body: Bounds { dimension: info.dimension, min: None, max: None } });
        Self { bounds: bounds.collect(), family: std::marker::PhantomData }
    }
}

/// A smallest and a largest value of a metric.
#[derive(Debug)]
pub struct Bounds {
    dimension: Dimension,
    /// Smallest value.
    pub min: Slot<Quantity>,
    /// Largest value.
    pub max: Slot<Quantity>,
}

impl Default for Bounds {
    fn default() -> Self {
        Self { dimension: Dimension::Ratio, min: None, max: None }
    }
}

impl<M: Metrics> Describe for Limits<M> {
    fn describe(&mut self, v: &mut dyn Visitor) {
        for (info, bounds) in M::ALL.iter().zip(&mut self.bounds) {
            bounds.describe(v, &Param::new(info.name, info.doc));
        }
    }
}

impl Describe for Bounds {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.quantity(&Param::new("min", "Smallest value.").of(self.dimension), &mut self.min);
        v.quantity(&Param::new("max", "Largest value.").of(self.dimension), &mut self.max);
    }
}

/// A limit on a metric, SI.
#[derive(Clone, Debug, PartialEq)]
pub struct Limit {
    /// Index into the family's list.
    pub metric: usize,
    /// Smallest value.
    pub min: Option<f64>,
    /// Largest value.
    pub max: Option<f64>,
    /// The unit that was typed.
    pub unit: Unit,
}

impl Limit {
    /// Name of the metric in its family's list.
    pub fn name<M: Metrics>(&self) -> &'static str {
        M::ALL[self.metric].name
    }
}

impl<M: Metrics> Limits<M> {
    /// The limits that were given. An empty table, or a least value above the largest, is an error; tables whose values were refused
    /// say nothing.
    pub fn resolve(&self, diagnostics: &mut Diagnostics) -> Vec<Limit> {
        let sound = !diagnostics.has_errors();
        let mut limits = Vec::new();
        for (metric, bounds) in self.bounds.iter().enumerate() {
            let Some(section) = &bounds.present else { continue };
            let (min, max) = (bounds.min.as_ref().map(|l| &l.value), bounds.max.as_ref().map(|l| &l.value));
            let Some(unit) = min.or(max).map(|q| q.unit.clone()) else {
                if sound {
                    let empty = Diagnostic::error("E0302", section.span, "this limit says nothing").label("from this table");
                    diagnostics.push(empty.help("give `min` or `max`"));
                }
                continue;
            };
            check_order("", bounds.min.as_ref(), bounds.max.as_ref(), diagnostics);
            limits.push(Limit { metric, min: min.map(|q| q.si), max: max.map(|q| q.si), unit });
        }
        limits
    }
}

/// A least value above the largest one is met by nothing. `of` is the path of the table, with its dot.
pub fn check_order(of: &str, min: Option<&Located<Quantity>>, max: Option<&Located<Quantity>>, diagnostics: &mut Diagnostics) {
    let (Some(min), Some(max)) = (min, max) else { return };
    if min.value.si <= max.value.si {
        return;
    }
    let message = format!("nothing is at least {} and at most {}", min.value, max.value);
    let error = Diagnostic::error("E0204", max.span, message).label("less than the least value");
    diagnostics.push(if min.origin == Origin::File {
        error.related(min.span, "the least value").help("exchange the two, or remove one")
    } else {
        error.help(format!("give `{of}min` as well: without it, it is {}", min.value))
    });
}
