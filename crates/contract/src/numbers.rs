//! The numbers of a design that a study can change, by their paths.
//!
//! A path is that of the project file; a coordinate is `.x` or `.y` of its point, a member of a list its place counted from 1:
//! `design.thickness`, `design.nodes.n3.at.x`, `design.beams.b1.bend.2`.

use forcewright_base::diagnostics::Span;
use forcewright_base::units::{Dimension, Quantity, Tolerance, Unit};

use crate::describe::{Along, Describe, Form, Located, Members, Param, Range, Slot, Visitor, member_path};

/// A number of a design.
#[derive(Clone, Debug)]
pub struct Number {
    /// Where it is found.
    pub path: String,
    /// Its quantity.
    pub dimension: Dimension,
    /// The unit that it was typed in.
    pub unit: Unit,
    /// Its value, SI.
    pub si: f64,
    /// Values that the language allows, SI; with a fit, diameters for which it is defined.
    pub range: Range,
    /// The tolerance typed, if any.
    pub tolerance: Option<Tolerance>,
    /// Where it stands.
    pub span: Span,
    /// What it is part of.
    pub part: Part,
}

/// What a number is part of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Part {
    /// It stands alone.
    Whole,
    /// A member of a list of bare numbers, by its index.
    Entry(usize),
    /// A member of a list of quantities, by its index.
    Item(usize),
    /// A coordinate of a point: 0 is x, 1 is y.
    Coordinate(usize),
    /// A coordinate of one of several points: index of the point, and coordinate.
    OfPoints(usize, usize),
    /// A value at a place from 0 to 1: index of the pair, and its place.
    AtPlace(usize, f64),
}

impl Part {
    /// Names at the end of the path that lead inside the value: the rest is the path of its key.
    pub(crate) fn depth(self) -> usize {
        match self {
            Self::Whole => 0,
            Self::Entry(_) | Self::Item(_) | Self::Coordinate(_) | Self::AtPlace(..) => 1,
            Self::OfPoints(..) => 2,
        }
    }
}

/// The values that a number may have without losing the fit or general tolerance that it was typed with.
fn allowed(range: Range, tolerance: Option<Tolerance>) -> Range {
    tolerance.and_then(|t| t.nominals_si()).map_or(range, |([from, up_to], above)| {
        let low = if from >= range.min { Range { min: from, above, ..range } } else { range };
        Range { max: range.max.min(up_to), ..low }
    })
}

/// Every number that was given, defaulted or taken from a catalogue, in the order of the description.
pub fn numbers_of(design: &mut dyn Describe) -> Vec<Number> {
    let mut collector = Collector { prefix: String::new(), found: Vec::new() };
    design.describe(&mut collector);
    collector.found
}

/// Whether a path is meant by a pattern: `*` stands for one part of the path, or for some letters of it, and a pattern that ends early
/// means everything below.
pub fn matches(pattern: &str, path: &str) -> bool {
    let mut parts = path.split('.');
    pattern.split('.').all(|wanted| parts.next().is_some_and(|part| part_matches(wanted, part)))
}

fn part_matches(wanted: &str, part: &str) -> bool {
    let Some((head, tail)) = wanted.split_once('*') else { return wanted == part };
    let Some(rest) = part.strip_prefix(head) else { return false };
    tail.is_empty() || (0..=rest.len()).any(|at| rest.get(at..).is_some_and(|r| part_matches(tail, r)))
}

struct Collector {
    prefix: String,
    found: Vec<Number>,
}

impl Collector {
    fn note(&mut self, param: &Param, part: Part, quantity: &Quantity, span: Span) {
        let axis = |at: usize| if at == 0 { "x" } else { "y" };
        let inside = match part {
            Part::Whole => String::new(),
            Part::Entry(index) | Part::Item(index) | Part::AtPlace(index, _) => format!(".{}", index + 1),
            Part::Coordinate(at) => format!(".{}", axis(at)),
            Part::OfPoints(index, at) => format!(".{}.{}", index + 1, axis(at)),
        };
        self.found.push(Number {
            path: format!("{}{}{inside}", self.prefix, param.key),
            dimension: param.dimension,
            unit: quantity.unit.clone(),
            si: quantity.si,
            range: allowed(param.range, quantity.tolerance),
            tolerance: quantity.tolerance,
            span,
            part,
        });
    }

    fn inside(&mut self, part: &str, body: impl FnOnce(&mut Self)) {
        let before = self.prefix.len();
        self.prefix.push_str(part);
        self.prefix.push('.');
        body(self);
        self.prefix.truncate(before);
    }
}

impl Visitor for Collector {
    fn quantity(&mut self, param: &Param, slot: &mut Slot<Quantity>) {
        if let Some(located) = slot {
            self.note(param, Part::Whole, &located.value, located.span);
        }
    }
    fn numbers(&mut self, param: &Param, slot: &mut Slot<Vec<f64>>) {
        let Some(located) = slot else { return };
        for (index, value) in located.value.iter().enumerate() {
            self.note(param, Part::Entry(index), &Quantity::from_si(*value, param.dimension), located.span);
        }
    }
    fn quantities(&mut self, param: &Param, _: usize, slot: &mut Slot<Vec<Quantity>>) {
        let Some(located) = slot else { return };
        for (index, quantity) in located.value.iter().enumerate() {
            self.note(param, Part::Item(index), quantity, located.span);
        }
    }
    fn point(&mut self, param: &Param, slot: &mut Slot<[Quantity; 2]>) {
        let Some(located) = slot else { return };
        for (axis, quantity) in located.value.iter().enumerate() {
            self.note(param, Part::Coordinate(axis), quantity, located.span);
        }
    }
    fn points(&mut self, param: &Param, _: usize, slot: &mut Slot<Vec<Located<[Quantity; 2]>>>) {
        let Some(located) = slot else { return };
        for (index, point) in located.value.iter().enumerate() {
            for (axis, quantity) in point.value.iter().enumerate() {
                self.note(param, Part::OfPoints(index, axis), quantity, point.span);
            }
        }
    }
    fn along(&mut self, param: &Param, _: usize, slot: &mut Slot<Along>) {
        let Some(located) = slot else { return };
        match &located.value {
            Along::Constant(quantity) => self.note(param, Part::Whole, quantity, located.span),
            Along::Places(places) => {
                for (index, (u, quantity)) in places.iter().enumerate() {
                    self.note(param, Part::AtPlace(index, *u), quantity, located.span);
                }
            }
        }
    }
    fn section(&mut self, param: &Param, _: &mut Slot<()>, body: &mut dyn FnMut(&mut dyn Visitor)) {
        self.inside(param.key, |collector| body(collector));
    }
    fn members(&mut self, param: &Param, _: Form, members: &mut dyn Members) {
        for (index, name) in members.names().into_iter().enumerate() {
            self.inside(&member_path(param.key, &name), |collector| members.describe(index, collector));
        }
    }
    fn tables(&mut self, _: &Param, members: &mut dyn Members) {
        for (index, name) in members.names().into_iter().enumerate() {
            self.inside(&name, |collector| members.describe(index, collector));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_mean_parts_of_paths() {
        let path = "design.beams.b12.bend.2";
        for pattern in ["design.beams.*.bend", "design.beams.b*.bend.2", "design.*.b*2.bend", "design", "design.beams.b12.bend.*"] {
            assert!(matches(pattern, path), "{pattern}");
        }
        for pattern in ["design.beams.*.arc", "design.beams.c*.bend", "design.beams.*.bend.1", "design.beams.*.bend.2.x", "beams", "*.b12"]
        {
            assert!(!matches(pattern, path), "{pattern}");
        }
    }
}
