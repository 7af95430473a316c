//! Figures of a report: plots and scenes, as data.

use crate::{Axis, PartSet, Scene};

/// How a line is drawn; never colour alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stroke {
    /// The result: solid, accent colour.
    Main,
    /// A second result: solid, another colour.
    Second,
    /// A third result: dash-dotted, another colour.
    Third,
    /// A reference: dashed, grey.
    Reference,
    /// A limit: dashed, warning colour.
    Limit,
}

/// One line of a plot. Values are SI; the plot's axes say how they are shown.
#[derive(Clone, Debug)]
pub struct Series {
    /// Text in the legend.
    pub label: String,
    /// Abscissae, SI.
    pub x: Vec<f64>,
    /// Ordinates, SI.
    pub y: Vec<f64>,
    /// How it is drawn.
    pub stroke: Stroke,
}

/// A region between two ordinates: a force band.
#[derive(Clone, Debug)]
pub struct HorizontalBand {
    /// Lower edge, SI.
    pub from: f64,
    /// Upper edge, SI.
    pub to: f64,
    /// Where along x it applies, SI; `None` is everywhere.
    pub extent: Option<(f64, f64)>,
    /// Text in the legend.
    pub label: String,
}

/// A level: an allowable stress.
#[derive(Clone, Debug)]
pub struct HorizontalLine {
    /// Ordinate, SI.
    pub at: f64,
    /// Text at the line.
    pub label: String,
    /// How it is drawn.
    pub stroke: Stroke,
}

/// A region between two abscissae: the usable stroke.
#[derive(Clone, Debug)]
pub struct VerticalSpan {
    /// Left edge, SI.
    pub from: f64,
    /// Right edge, SI.
    pub to: f64,
    /// Text above it.
    pub label: String,
}

/// A marked point.
#[derive(Clone, Debug)]
pub struct Marker {
    /// Abscissa, SI.
    pub x: f64,
    /// Ordinate, SI.
    pub y: f64,
    /// Short text beside it: `c`.
    pub label: String,
    /// What it is, for the legend below the plot: `c = 6.97 mm: F reaches 95 % of its end value`.
    pub note: String,
}

/// A plot of lines over a common abscissa.
#[derive(Clone, Debug)]
pub struct Plot {
    /// Abscissa.
    pub x: Axis,
    /// Ordinate.
    pub y: Axis,
    /// Lines, back to front.
    pub series: Vec<Series>,
    /// Regions between ordinates.
    pub bands: Vec<HorizontalBand>,
    /// Levels.
    pub levels: Vec<HorizontalLine>,
    /// Regions between abscissae.
    pub spans: Vec<VerticalSpan>,
    /// Marked points.
    pub markers: Vec<Marker>,
    /// Whether the ordinate axis must include zero.
    pub from_zero: bool,
}

/// What a figure shows.
#[derive(Clone, Debug)]
pub enum FigureContent {
    /// Lines over axes.
    Plot(Plot),
    /// A drawing.
    Scene(Scene),
    /// Plates as they are cut.
    Part(PartSet),
}

/// A figure with its words.
#[derive(Clone, Debug)]
pub struct Figure {
    /// Stable identifier: `force`.
    pub id: &'static str,
    /// Heading.
    pub title: String,
    /// What to see in it.
    pub caption: String,
    /// The picture.
    pub content: FigureContent,
}
