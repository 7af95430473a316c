//! Names of the formats.

use std::fmt;
use std::str::FromStr;

/// A kind of file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Format {
    /// Drawing exchange format, for cutting.
    Dxf,
    /// Scalable vector graphics of true size, for laser cutters and paper.
    Svg,
    /// ISO 10303-21 after AP214, for CAD and milling.
    Step,
    /// Triangles, for printing.
    Stl,
    /// Triangles with their unit, for printing.
    ThreeMf,
    /// Input of `CalculiX` and Abaqus, for finite elements.
    Inp,
}

impl Format {
    /// All of them.
    pub const ALL: [Self; 6] = [Self::Dxf, Self::Svg, Self::Step, Self::Stl, Self::ThreeMf, Self::Inp];

    /// Its name, for people.
    pub fn name(self) -> &'static str {
        match self {
            Self::Dxf => "DXF",
            Self::Svg => "SVG",
            Self::Step => "STEP",
            Self::Stl => "STL",
            Self::ThreeMf => "3MF",
            Self::Inp => "INP",
        }
    }

    /// What file names end with, without the dot.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Dxf => "dxf",
            Self::Svg => "svg",
            Self::Step => "step",
            Self::Stl => "stl",
            Self::ThreeMf => "3mf",
            Self::Inp => "inp",
        }
    }

    /// Media type as registered with IANA.
    pub fn media_type(self) -> &'static str {
        match self {
            Self::Dxf => "image/vnd.dxf",
            Self::Svg => "image/svg+xml",
            Self::Step => "model/step",
            Self::Stl => "model/stl",
            Self::ThreeMf => "model/3mf",
            // Nothing is registered.
            Self::Inp => "text/plain",
        }
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// What was typed is the name of no format.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownFormat(String);

impl fmt::Display for UnknownFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let known: Vec<&str> = Format::ALL.iter().map(|format| format.extension()).collect();
        write!(f, "no format `{}`; known are {}", forcewright_base::text::visible(&self.0), known.join(", "))
    }
}

impl std::error::Error for UnknownFormat {}

impl FromStr for Format {
    type Err = UnknownFormat;

    /// Understands extensions in any case, with or without the dot: `step`, `STP`, `.3mf`.
    fn from_str(text: &str) -> Result<Self, UnknownFormat> {
        let word = text.trim();
        let word = word.strip_prefix('.').unwrap_or(word).to_ascii_lowercase();
        let word = if word == "stp" { "step" } else { &word };
        Self::ALL.into_iter().find(|format| format.extension() == word).ok_or_else(|| UnknownFormat(text.to_owned()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_are_found_by_what_people_type() {
        for format in Format::ALL {
            assert_eq!(format.extension().parse(), Ok(format));
            assert_eq!(format!(" .{format} ").parse(), Ok(format));
        }
        assert_eq!("stp".parse(), Ok(Format::Step));
        let error = "dwg".parse::<Format>().unwrap_err();
        assert_eq!(error.to_string(), "no format `dwg`; known are dxf, svg, step, stl, 3mf, inp");
        assert!("".parse::<Format>().is_err());
    }
}
