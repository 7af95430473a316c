//! Figures of a report: plots and scenes, as data.

use crate::{Axis, Item, PartSet, Scene};

/// How a line is drawn; never colour alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stroke {
    /// The result: solid, accent colour.
    Main,
    /// A second result: solid, another colour.
    Second,
    /// A third result: dash-dotted, another colour.
    Third,
    /// A result beside the third: dotted, in its colour.
    Fourth,
    /// A reference: dashed, grey.
    Reference,
    /// A limit: dashed, warning colour.
    Limit,
    /// A region whose edge the points go around: tinted, without a line.
    Area,
    /// Points that were measured: a dot each, joined by nothing.
    Points,
    /// The same of a second record: open dots.
    OpenPoints,
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
    /// Hatched, where nothing goes; else tinted.
    pub hatched: bool,
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

/// A picture that moves, one frame at a time, as the reader chooses; all frames share one scale.
#[derive(Clone, Debug)]
pub struct Film {
    /// What passes from frame to frame: the travel.
    pub axis: Axis,
    /// What is the same in all frames, behind what moves; words, colours and unit of all of them.
    pub stage: Scene,
    /// The frames, in the order of the axis.
    pub frames: Vec<Frame>,
    /// Index of the one that is seen at first, and where only one can be.
    pub chosen: usize,
}

/// What is seen at one place of a film's axis.
#[derive(Clone, Debug)]
pub struct Frame {
    /// The place, SI.
    pub at: f64,
    /// What else to know of it: `F = 50.2 N`.
    pub note: String,
    /// What moves, back to front.
    pub items: Vec<Item>,
}

impl Film {
    /// The chosen frame as a picture of its own.
    pub fn still(&self) -> Scene {
        let mut scene = self.stage.clone();
        if let Some(frame) = self.frames.get(self.chosen) {
            scene.items.extend(frame.items.iter().cloned());
        }
        scene
    }
}

/// A bar chart: what each of some causes does, downwards and upwards from zero.
#[derive(Clone, Debug)]
pub struct Bars {
    /// What the bars measure.
    pub axis: Axis,
    /// What the bars of a row mean, with their look, top to bottom.
    pub series: Vec<(String, Stroke)>,
    /// Rows, top to bottom.
    pub rows: Vec<BarRow>,
}

/// One cause.
#[derive(Clone, Debug)]
pub struct BarRow {
    /// Its name.
    pub label: String,
    /// Both ends of each bar, SI, in the order of the series; the first belongs to the lower value of the cause.
    pub ends: Vec<[f64; 2]>,
}

/// What a figure shows.
#[derive(Clone, Debug)]
pub enum FigureContent {
    /// Lines over axes.
    Plot(Plot),
    /// Bars beside names.
    Bars(Bars),
    /// A drawing.
    Scene(Scene),
    /// A drawing that moves.
    Film(Film),
    /// Plates as they are cut.
    Part(PartSet),
}

impl FigureContent {
    /// The picture of a mechanism, if it is one; of a film the chosen frame.
    pub fn still(&self) -> Option<Scene> {
        match self {
            Self::Scene(scene) => Some(scene.clone()),
            Self::Film(film) => Some(film.still()),
            Self::Plot(_) | Self::Bars(_) | Self::Part(_) => None,
        }
    }
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
