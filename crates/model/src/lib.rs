//! Pure data between the mechanisms that compute and the outputs that draw and write. Layer 1: values are SI, each with the unit in
//! which people are shown it.

mod check;
mod coil;
mod curve;
mod duty;
mod figure;
mod outcome;
mod part;
mod report;
mod scene;
mod study;
mod turned;

pub use check::{Check, CheckState, Sense};
pub use coil::{Coil, CoilEnd, CoilError, Winding, WireKind, WireLine, WirePiece, WireStation};
pub use curve::{Axis, Branch, Curve};
pub use duty::{Action, Duty, Stated};
pub use figure::{
    BarRow, Bars, Figure, FigureContent, Film, Frame, HorizontalBand, HorizontalLine, Marker, Plot, Series, Stroke, VerticalSpan,
};
pub use outcome::{Counter, Metric, Outcome, Status, StatusKind, Warning};
pub use part::{Body, Fillets, Grip, Hole, NoPart, Part, PartMark, PartSet, Plate, Sheet, Trial};
pub use report::{Citation, ParameterRow, Report, Statement};
pub use scene::{ColourScale, Item, Look, Role, Scene, SupportKind};
pub use study::{Study, StudyColumn, StudyTable};
pub use turned::{Drilling, Groove, GrooveError, Grooved, Section, Turned, TurnedError};
