//! Files for making parts: what laser cutters, CAD programs and printers read.
//!
//! [`write()`] turns a [`Part`] into the bytes of a file. It is a pure function: no clock, no files, the same bytes every time and on every
//! machine. All files are in millimetres, with the origin and the axes of the part; a plate fills `0 ≤ z ≤ depth`, a turned part stands
//! on the plane z = 0 around the z axis, a spring lies around it.
//!
//! # Plates
//!
//! | format | lines, arcs, holes | splines | holds besides |
//! | --- | --- | --- | --- |
//! | [`Format::Dxf`], AC1015 | exact: closed polylines with bulges, circles | arcs with common tangents, within [`Options::arc_error_m`] | layers OUTLINE, CUTOUTS, HOLES; texts on NOTES |
//! | [`Format::Svg`], true size | exact: arcs, circles | exact: cubic Béziers | title and description |
//! | [`Format::Step`], AP214 | exact: planes, cylinders | exact: extruded B-splines | one closed solid, product name |
//! | [`Format::Stl`], binary | chords within [`Options::facet_error_m`] | the same | nothing |
//! | [`Format::ThreeMf`] | chords within [`Options::facet_error_m`] | the same | unit, title |
//! | [`Format::Inp`] | sides of quadratic triangles, their three nodes on the boundary | the same | material, grips, one step |
//!
//! Exact means to the digits written: 10⁻¹² mm. Corners of the two meshes lie on the boundary, rounded to single precision, which is
//! what STL holds; both formats hold the same closed mesh.
//!
//! # Turned parts
//!
//! | format | cylinders, planes | helical grooves | holds besides |
//! | --- | --- | --- | --- |
//! | [`Format::Dxf`] | half section at the angle 0: z to the right, radii upwards; exact | the same: profile repeated | layers OUTLINE, CENTRE; texts on NOTES |
//! | [`Format::Svg`] | the same | the same | title and description, centre line |
//! | [`Format::Step`] | exact | a strip of B-splines of degree 5 for each segment of each groove, within 10⁻⁷ mm | one closed solid, product name |
//! | [`Format::Stl`], [`Format::ThreeMf`] | chords within [`Options::facet_error_m`] | facets within the same | as for plates |
//! | [`Format::Inp`] | [`Problem::OnlyPlates`] | | |
//!
//! # Springs
//!
//! A spring lies around the z axis; the middle of its wire begins to wind at z = 0.
//!
//! | format | windings, bends | straight legs | holds besides |
//! | --- | --- | --- | --- |
//! | [`Format::Dxf`] | side view with hidden lines left out, z to the right, x upwards, as chords within [`Options::arc_error_m`] | the same | the cylinders around and inside on END; axis, mean diameter and, from the end, the middles of legs on CENTRE; texts on NOTES |
//! | [`Format::Svg`] | the same | the same | title and description |
//! | [`Format::Step`] | half tubes of a turn at most: exact circles across (rational), B-splines of degree 5 along, within 10⁻⁷ mm | exact | plane circular ends, one closed solid, product name |
//! | [`Format::Stl`], [`Format::ThreeMf`] | facets within [`Options::facet_error_m`] | the same | as for plates |
//! | [`Format::Inp`] | [`Problem::OnlyPlates`] | | |
//!
//! Facets of neighbouring turns may meet where the gap between them is less than twice the error of facets.
//!
//! Drillings are told in the texts of the drawings and cut into no solid. Corners of meshes between those of a profile's chords lie on the
//! chords. A mesh has at most ten million corners ([`Problem::TooManyCorners`]).
//!
//! A part is checked before anything is written ([`Error`]): boundaries that are open, run the wrong way, cross or touch each other, or
//! lie outside the outline make no part; neither do the bodies that [`Turned::check`] and
//! [`Coil::check`] refuse.

mod cap;
mod coil;
mod dxf;
mod elements;
mod error;
mod format;
mod inp;
mod mesh;
mod shape;
mod step;
mod stl;
mod svg;
mod text;
mod three_mf;
mod turned;
mod zip;

pub use error::{Boundary, Error, Place, Problem};
pub use format::{Format, UnknownFormat};

use forcewright_model::{Body, Coil, Part, Plate, Turned};

/// How closely curves are followed where a format cannot hold them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Largest distance between a spline and the arcs that stand for it in DXF, m; 10⁻⁹ to 10⁻².
    pub arc_error_m: f64,
    /// Largest distance between a curve and the chords that stand for it in STL and 3MF, m; 10⁻⁹ to 10⁻².
    pub facet_error_m: f64,
    /// Length of the sides of finite elements, m; 10⁻⁹ to 1. Without it, a quarter of the thinnest wall.
    pub element_m: Option<f64>,
}

impl Default for Options {
    /// Arcs within 0.001 mm, facets within 0.005 mm, elements as the thinnest wall has them.
    fn default() -> Self {
        Self { arc_error_m: 1e-6, facet_error_m: 5e-6, element_m: None }
    }
}

/// The bytes of a file that describes the part.
///
/// # Errors
/// When the part is none that could be made, or an option is out of its range: what is wrong, and where.
pub fn write(part: &Part, format: Format, options: &Options) -> Result<Vec<u8>, Error> {
    let element_m = options.element_m.unwrap_or(1e-2);
    for (name, value, largest) in
        [("arc_error_m", options.arc_error_m, 1e-2), ("facet_error_m", options.facet_error_m, 1e-2), ("element_m", element_m, 1.0)]
    {
        if !(1e-9..=largest).contains(&value) {
            return Err(Error { place: Place::Options, problem: Problem::Option { name, value, largest } });
        }
    }
    match &part.body {
        Body::Plate(plate) => write_plate(part, plate, format, options),
        Body::Turned(turned) => write_turned(part, turned, format, options),
        Body::Coil(coil) => write_coil(part, coil, format, options),
    }
}

fn write_plate(part: &Part, plate: &Plate, format: Format, options: &Options) -> Result<Vec<u8>, Error> {
    let shape = shape::Shape::new(plate)?;
    if matches!(format, Format::Stl | Format::ThreeMf) {
        let mesh = mesh::extruded(&shape, options.facet_error_m * shape::MM_PER_M)?;
        return Ok(if format == Format::Stl { stl::write(part, &mesh) } else { three_mf::write(part, &mesh) });
    }
    cap::check(&shape)?;
    let text = match format {
        Format::Dxf => dxf::write(part, &shape, options.arc_error_m * shape::MM_PER_M),
        Format::Svg => svg::write(part, &shape),
        Format::Inp => inp::write(part, plate, &shape, options.element_m)?,
        _ => step::write(part, &shape),
    };
    Ok(text.into_bytes())
}

fn write_turned(part: &Part, turned: &Turned, format: Format, options: &Options) -> Result<Vec<u8>, Error> {
    let stack = turned::Stack::new(turned)?;
    let mesh = || turned::mesh(&stack, options.facet_error_m * shape::MM_PER_M);
    let drawing = || shape::Shape::half_section(turned).and_then(|shape| cap::check(&shape).map(|()| shape));
    match format {
        Format::Stl => Ok(stl::write(part, &mesh()?)),
        Format::ThreeMf => Ok(three_mf::write(part, &mesh()?)),
        Format::Step => Ok(turned::write(part, &stack).into_bytes()),
        Format::Dxf => Ok(dxf::write(part, &drawing()?, options.arc_error_m * shape::MM_PER_M).into_bytes()),
        Format::Svg => Ok(svg::write(part, &drawing()?).into_bytes()),
        Format::Inp => Err(Error { place: Place::Part, problem: Problem::OnlyPlates { format } }),
    }
}

fn write_coil(part: &Part, coil: &Coil, format: Format, options: &Options) -> Result<Vec<u8>, Error> {
    let wound = coil::Wound::new(coil)?;
    let mesh = || coil::mesh(&wound, options.facet_error_m * shape::MM_PER_M);
    let chord = options.arc_error_m * shape::MM_PER_M;
    match format {
        Format::Stl => Ok(stl::write(part, &mesh()?)),
        Format::ThreeMf => Ok(three_mf::write(part, &mesh()?)),
        Format::Step => Ok(coil::write(part, &wound).into_bytes()),
        Format::Dxf => Ok(dxf::write_views(part, &coil::views(&wound, chord), chord).into_bytes()),
        Format::Svg => Ok(svg::write_views(part, &coil::views(&wound, chord)).into_bytes()),
        Format::Inp => Err(Error { place: Place::Part, problem: Problem::OnlyPlates { format } }),
    }
}
