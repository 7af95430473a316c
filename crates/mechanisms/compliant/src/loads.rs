//! What happens to the mechanism: one load, or several in order.

use forcewright_base::diagnostics::{Diagnostic, Diagnostics, Span};
use forcewright_base::units::Quantity;
use forcewright_beam::{Drive, Stage};
use forcewright_contract::describe::{Located, Member, member_path};

use crate::design::unit;
use crate::layout::{self, Mirror};
use crate::spec::{self, Spec};

/// What grows along the path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Control {
    /// The displacement of the load node.
    Travel,
    /// The force on it.
    Force,
}

/// All loads of a project.
pub(crate) struct Loads {
    /// Those before the last one.
    pub before: Vec<Stage>,
    /// The last one.
    pub drive: Drive,
    /// Its direction, a unit vector.
    pub direction: [f64; 2],
    /// What grows.
    pub control: Control,
    /// Its largest value on the drawn network, m or N.
    pub end: f64,
    /// Where its value stands in the project: `load.travel`.
    pub key: String,
}

/// One of the four things that a load can prescribe.
#[derive(Clone, Copy)]
enum Kind {
    Travel,
    Force,
    Moment,
    Rotation,
}

impl Kind {
    fn key(self) -> &'static str {
        match self {
            Self::Travel => "travel",
            Self::Force => "force",
            Self::Moment => "moment",
            Self::Rotation => "rotation",
        }
    }

    fn turns(self) -> bool {
        matches!(self, Self::Moment | Self::Rotation)
    }
}

/// The values given in a load.
fn values(load: &spec::Load) -> Vec<(Kind, &Located<Quantity>)> {
    let all = [(Kind::Travel, &load.travel), (Kind::Force, &load.force), (Kind::Moment, &load.moment), (Kind::Rotation, &load.rotation)];
    all.into_iter().filter_map(|(kind, slot)| Some((kind, slot.as_ref()?))).collect()
}

/// The quantity of the last load, if it is of that kind.
pub(crate) fn last_travel(spec: &Spec) -> Option<&Located<Quantity>> {
    spec.load.last()?.value.travel.as_ref()
}

/// The force of the last load, if it is one.
pub(crate) fn last_force(spec: &Spec) -> Option<&Located<Quantity>> {
    spec.load.last()?.value.force.as_ref()
}

/// Reads all loads; `nodes` are the indices of their nodes. `None` after errors.
pub(crate) fn resolve(spec: &Spec, nodes: &[Option<usize>], place: Span, diagnostics: &mut Diagnostics) -> Option<Loads> {
    let Some((last, earlier)) = spec.load.split_last() else {
        // A `load` that was not understood has been reported.
        if !diagnostics.has_errors() {
            diagnostics.push(
                Diagnostic::error("E0302", place, "nothing happens: `load` is empty")
                    .help("add `[load]` with `node`, `direction` and `travel`"),
            );
        }
        return None;
    };
    // Forces, moments and travels are those of the whole layout.
    let shares = layout::shares(spec);
    let read: Vec<Option<(Drive, f64)>> = (spec.load.iter().zip(nodes)).map(|(load, node)| one(load, *node, shares, diagnostics)).collect();
    let (kind, _) = values(&last.value).into_iter().next()?;
    if kind.turns() {
        let span = values(&last.value).first().map_or(last.name.span, |(_, value)| value.span);
        diagnostics.push(
            Diagnostic::error(
                "E0306",
                span,
                format!("a `{}` as the last load is part of the language but not of this version", kind.key()),
            )
            .label("not available yet as the last load")
            .help("give it as an earlier stage: `[[load]]` above a `[[load]]` with `travel` or `force`"),
        );
        return None;
    }
    let mut read = read.into_iter().collect::<Option<Vec<_>>>()?;
    let (drive, end) = read.pop()?;
    debug_assert_eq!(read.len(), earlier.len());
    Some(Loads {
        before: read.into_iter().map(|(drive, to)| Stage { drive, to }).collect(),
        drive,
        direction: last.value.direction.as_ref().map(|d| unit(d.value))?,
        control: if matches!(kind, Kind::Force) { Control::Force } else { Control::Travel },
        end,
        key: format!("{}.{}", member_path("load", &last.name.value), kind.key()),
    })
}

/// One load: what it prescribes on the drawn network, and how far.
fn one(load: &Member<spec::Load>, node: Option<usize>, [copies, layers]: [f64; 2], diagnostics: &mut Diagnostics) -> Option<(Drive, f64)> {
    let sound = !diagnostics.has_errors();
    let given = values(&load.value);
    let (kind, value) = match given[..] {
        [] => {
            // A value that was given but not understood has been reported.
            if sound {
                diagnostics.push(
                    Diagnostic::error("E0302", load.name.span, "this load says nothing")
                        .label("how far?")
                        .help("give one of `travel = \"5 mm\"`, `force = \"2 N\"`, and before the last load also `moment` or `rotation`"),
                );
            }
            return None;
        }
        [one] => one,
        [(first, one), (second, other), ..] => {
            diagnostics.push(
                Diagnostic::error("E0305", other.span, format!("`{}` and `{}` exclude each other", first.key(), second.key()))
                    .label("the second of two")
                    .related(one.span, "the first")
                    .help("keep one; the other is the result, or another `[[load]]`"),
            );
            return None;
        }
    };
    let direction = match (&load.value.direction, kind.turns()) {
        (Some(direction), true) => {
            diagnostics.push(
                Diagnostic::error("E0305", direction.span, format!("`direction` is given, but a `{}` has none", kind.key()))
                    .label("not needed")
                    .help("remove it; counter-clockwise is positive"),
            );
            return None;
        }
        (None, false) => {
            if sound {
                diagnostics.push(
                    Diagnostic::error("E0302", load.name.span, format!("`{}` needs a `direction`", kind.key()))
                        .label("in which direction?")
                        .help("add, for example, `direction = [0, -1]`"),
                );
            }
            return None;
        }
        (Some(direction), false) => unit(direction.value),
        (None, true) => [0.0; 2],
    };
    let (node, si) = (node?, value.value.si);
    Some(match kind {
        Kind::Travel => (Drive::Displacement { node, direction }, si / layers),
        Kind::Force => (Drive::Force { node, direction }, si / copies),
        Kind::Moment => (Drive::Moment { node }, si / copies),
        Kind::Rotation => (Drive::Rotation { node }, si),
    })
}

/// Both halves move alike only if the last load moves along the mirror line, and nothing pulls a node across the line or turns it there.
pub(crate) fn check_mirror(
    spec: &Spec,
    loads: &Loads,
    mirror: (Mirror, Span),
    on_line: impl Fn(usize) -> bool,
    diagnostics: &mut Diagnostics,
) {
    let (mirror, line) = mirror;
    let drives = loads.before.iter().map(|s| &s.drive).chain([&loads.drive]);
    let last = spec.load.len().saturating_sub(1);
    for (index, (drive, load)) in drives.zip(&spec.load).enumerate() {
        let fault = match drive {
            Drive::Displacement { direction, .. } | Drive::Force { direction, .. } => {
                let across = if matches!(mirror, Mirror::X(_)) { direction[0] } else { direction[1] };
                (across.abs() > 1e-9 && (index == last || on_line(drive.node()))).then_some("the load does not move along the mirror line")
            }
            Drive::Rotation { .. } | Drive::Moment { .. } => on_line(drive.node()).then_some("the load turns a node on the mirror line"),
        };
        if let Some(fault) = fault {
            let span = load.value.direction.as_ref().map(|d| d.span).or(load.value.node.as_ref().map(|n| n.span)).unwrap_or(line);
            let label = if load.value.direction.is_some() { "this direction" } else { "this node" };
            diagnostics.push(
                Diagnostic::error("E0508", span, fault).label(label).related(line, "mirrored here").help(
                    "both halves move alike only along the line; change the load, or draw the whole mechanism without `layout.mirror`",
                ),
            );
        }
    }
}
