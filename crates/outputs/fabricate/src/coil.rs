//! A spring that was checked.

mod drawing;
mod mesh;
mod sight;
mod solid;

use forcewright_model::{Coil, WireLine, WireStation};

use crate::error::{Error, Place, Problem};
use crate::shape::MM_PER_M;

pub(crate) use drawing::{Line, Views, views};
pub(crate) use mesh::mesh;
pub(crate) use solid::write;

/// A coil that can be made, with the middle of its wire in metres.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Wound<'a> {
    coil: &'a Coil,
    line: WireLine,
    /// Radius of the wire, mm.
    radius: f64,
}

impl<'a> Wound<'a> {
    /// # Errors
    /// When it cannot be made ([`Coil::check`]).
    pub(crate) fn new(coil: &'a Coil) -> Result<Self, Error> {
        coil.check().map_err(|error| Error { place: Place::Part, problem: Problem::Coil(error) })?;
        Ok(Self { coil, line: coil.line(), radius: 0.5 * coil.wire_m * MM_PER_M })
    }

    /// The lower or the upper end of the wire.
    fn end(&self, is_upper: bool) -> Option<WireStation> {
        let pieces = self.line.pieces();
        if is_upper { pieces.last().map(|piece| piece.at(1.0)) } else { pieces.first().map(|piece| piece.at(0.0)) }
    }
}

/// A point in mm.
fn millimetres(point_m: [f64; 3]) -> [f64; 3] {
    point_m.map(|m| m * MM_PER_M)
}

/// The middle of the wire, mm.
fn middle(station: &WireStation) -> [f64; 3] {
    millimetres(station.point_m)
}
