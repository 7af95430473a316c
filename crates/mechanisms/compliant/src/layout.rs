//! Copies of the drawn network: how they share force and travel, and where they stand.
//!
//! Copies beside each other carry the same block: their forces add at the same displacement. Layers in series carry each other: their
//! displacements add at the same force. All move alike, so one network is solved for all of them.

use forcewright_base::diagnostics::{Diagnostic, Diagnostics, Span};
use forcewright_base::units::{Dimension, Quantity};
use forcewright_beam::{Image, Network, Reflection, Rotation, Support};
use forcewright_contract::describe::Located;

use crate::design::{Envelope, unit};
use crate::loads::Loads;
use crate::spec::{self, Spec};

/// Copies of the drawn network.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    /// The mirror line, if there is a mirrored half.
    pub mirror: Option<Mirror>,
    /// Rows in the plane, the drawn one with its mirrored half the first.
    pub rows: Option<Rows>,
    /// Planes around an axis along the load.
    pub circle: Option<Circle>,
    /// Equal plates behind each other, on one block.
    pub plates: u32,
    /// Layers in series.
    pub layers: u32,
}

/// Rows that carry one block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rows {
    /// How many.
    pub count: u32,
    /// From each to the next, m.
    pub step_m: [f64; 2],
}

/// Copies in planes that meet in an axis along the load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle {
    /// How many.
    pub count: u32,
    /// Distance of the load node from the axis, m.
    pub radius_m: f64,
    /// Where the axis passes through the drawn plane, m: the drawn network lies on one side of it.
    pub axis_m: [f64; 2],
    /// From the axis to the drawn network, a unit vector.
    pub outward: [f64; 2],
}

/// A mirror line parallel to an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mirror {
    /// x = the value, m.
    X(f64),
    /// y = the value, m.
    Y(f64),
}

impl Mirror {
    /// The mirror image of a point, m.
    pub fn image(self, [x, y]: [f64; 2]) -> [f64; 2] {
        match self {
            Self::X(at) => [2.0 * at - x, y],
            Self::Y(at) => [x, 2.0 * at - y],
        }
    }

    /// Whether a point lies on the line, to within rounding at the size of a network.
    pub fn holds(self, network: &Network, [x, y]: [f64; 2]) -> bool {
        let size = network.beams.iter().map(|b| b.shape.length_m()).fold(0.0, f64::max);
        let off = match self {
            Self::X(at) => x - at,
            Self::Y(at) => y - at,
        };
        off.abs() <= 1e-9 * size
    }

    fn reflection(self) -> Reflection {
        match self {
            Self::X(at) => Reflection { point_m: [at, 0.0], direction: [0.0, 1.0] },
            Self::Y(at) => Reflection { point_m: [0.0, at], direction: [1.0, 0.0] },
        }
    }
}

impl Layout {
    /// How many copies share the force.
    pub fn copies(&self) -> f64 {
        let halves = if self.mirror.is_some() { 2.0 } else { 1.0 };
        halves * f64::from(self.rows.map_or(1, |r| r.count) * self.circle.map_or(1, |c| c.count) * self.plates)
    }

    /// How many layers share the displacement.
    pub fn layers(&self) -> f64 {
        f64::from(self.layers)
    }

    /// How many plates with the drawn network and its mirrored half the whole layout has.
    pub fn plates_each(&self) -> usize {
        [self.rows.map_or(1, |r| r.count), self.circle.map_or(1, |c| c.count), self.plates, self.layers]
            .into_iter()
            .map(|n| n as usize)
            .product()
    }

    /// Whether there is more than the drawn network and its mirrored half.
    pub fn repeats(&self) -> bool {
        self.rows.is_some() || self.circle.is_some() || self.plates > 1 || self.layers > 1
    }

    /// Where the networks of one layer stand in the drawn plane: the drawn one first, with its mirrored half after it, row by row.
    pub fn images(&self) -> Vec<Image> {
        let halves: &[bool] = if self.mirror.is_some() { &[false, true] } else { &[false] };
        let rows = self.rows.unwrap_or(Rows { count: 1, step_m: [0.0; 2] });
        let row = |index: u32| rows.step_m.map(|s| f64::from(index) * s);
        let of = |index: u32| {
            let reflection = move |mirrored: &bool| self.mirror.filter(|_| *mirrored).map(Mirror::reflection);
            halves.iter().map(move |mirrored| Image { reflection: reflection(mirrored), shift_m: row(index) })
        };
        (0..rows.count).flat_map(of).collect()
    }

    /// The copies that the drawn network has beside it: its mirrored half, and the next row with either half of it. What is true of these
    /// neighbours is true of all, but that the mirrored half may also be the one that is nearer to the row before.
    pub(crate) fn neighbours(&self) -> Vec<Image> {
        let reflection = self.mirror.map(Mirror::reflection);
        let mut all: Vec<Image> = reflection.map(Image::from).into_iter().collect();
        if let Some(Rows { step_m, .. }) = self.rows {
            all.push(Image { reflection: None, shift_m: step_m });
            for shift_m in [step_m, step_m.map(|s| -s)].into_iter().filter(|_| reflection.is_some()) {
                all.push(Image { reflection, shift_m });
            }
        }
        all
    }

    /// The box for the drawn network within which every copy in the drawn plane is in a given one: its mirrored half, the rows, and the leg
    /// opposite to it around an axis along x or y. Layers stand at a distance that is not known, each in a box of its own.
    pub(crate) fn for_drawn(&self, whole: Envelope) -> Envelope {
        let opposite = self.circle.filter(|c| c.count % 2 == 0).and_then(|c| match c.outward {
            [_, y] if y.abs() < 1e-12 => Some(Mirror::X(c.axis_m[0])),
            [x, _] if x.abs() < 1e-12 => Some(Mirror::Y(c.axis_m[1])),
            _ => None,
        });
        let rows = self.rows.unwrap_or(Rows { count: 1, step_m: [0.0; 2] });
        let mut common = whole;
        for row in 0..rows.count {
            for mirror in [None, self.mirror.or(opposite)] {
                let seen = |p: [f64; 2]| {
                    let p = [0, 1].map(|k| p[k] - f64::from(row) * rows.step_m[k]);
                    mirror.map_or(p, |m| m.image(p))
                };
                let (a, b) = (seen(whole.low_m), seen(whole.high_m));
                common.low_m = [0, 1].map(|k| common.low_m[k].max(a[k].min(b[k])));
                common.high_m = [0, 1].map(|k| common.high_m[k].min(a[k].max(b[k])));
            }
        }
        common
    }

    /// What it is, in words after a network: `, with its mirrored half, in 2 rows`; empty for the drawn network alone.
    pub(crate) fn words(&self) -> String {
        let mut words = String::new();
        let mut add = |there: bool, text: String| {
            if there {
                words.push_str(", ");
                words.push_str(&text);
            }
        };
        add(self.mirror.is_some(), "with its mirrored half".to_owned());
        add(self.rows.is_some(), format!("in {} rows", self.rows.map_or(1, |r| r.count)));
        add(self.circle.is_some(), format!("{} times around the axis of the load", self.circle.map_or(1, |c| c.count)));
        add(self.plates > 1, format!("in {} plates", self.plates));
        add(self.layers > 1, format!("in {} layers", self.layers));
        words
    }

    /// Distance of the faces of two neighbours around an axis, m, where the network comes as near as `inner_m` to it.
    pub(crate) fn gap_around_m(&self, inner_m: f64, depth_m: f64) -> Option<f64> {
        let half = std::f64::consts::PI / f64::from(self.circle?.count);
        let (sin, cos) = forcewright_base::maths::sin_cos(half);
        // The inner edges of two plates, seen along the axis: a point at the inner radius and half the depth, from the plane half way.
        Some(2.0 * (inner_m * sin - 0.5 * depth_m * cos))
    }
}

/// The mirror line as it was typed: `x = 0` or `y = 2 mm`.
pub(crate) fn parse_mirror(text: &str) -> Option<Mirror> {
    let (axis, value) = text.split_once('=')?;
    let value = value.trim();
    let at = if value == "0" { 0.0 } else { Quantity::parse(value, Dimension::Length).ok()?.si };
    match axis.trim() {
        "x" => Some(Mirror::X(at)),
        "y" => Some(Mirror::Y(at)),
        _ => None,
    }
}

/// How many copies share the force, and layers the displacement, before anything else is understood.
pub(crate) fn shares(spec: &Spec) -> [f64; 2] {
    let layout = &spec.layout;
    let count = |slot: &Option<Located<u32>>| f64::from(slot.as_ref().map_or(1, |c| c.value));
    let halves = if layout.mirror.is_some() { 2.0 } else { 1.0 };
    [halves * count(&layout.array.count) * count(&layout.circular.count) * count(&layout.plates), count(&layout.series)]
}

/// The copies of a network whose loads are known. Faults are reported; the mirror line has been read.
pub(crate) fn resolve(spec: &Spec, mirror: Option<Mirror>, network: &Network, loads: &Loads, diagnostics: &mut Diagnostics) -> Layout {
    let layout = &spec.layout.body;
    let count = |slot: &Option<Located<u32>>| slot.as_ref().map_or(1, |c| c.value);
    let rows = layout.array.present.as_ref().map(|_| Rows { count: count(&layout.array.count), step_m: step_m(layout, loads.direction) });
    let circle = layout.circular.present.as_ref().map(|_| circle(layout, network, loads));
    let found = Layout { mirror, rows, circle, plates: count(&layout.plates), layers: count(&layout.series) };
    check_together(layout, &found, spec, diagnostics);
    check_guided(layout, &found, network, loads, diagnostics);
    found
}

/// From each row to the next: along the load unless another direction is given.
fn step_m(layout: &spec::Layout, along: [f64; 2]) -> [f64; 2] {
    let spacing_m = layout.array.spacing.as_ref().map_or(0.0, |s| s.value.si);
    layout.array.direction.as_ref().map_or(along, |d| unit(d.value)).map(|d| spacing_m * d)
}

/// The axis lies a radius from the load node, on the other side of it than most of the network.
fn circle(layout: &spec::Layout, network: &Network, loads: &Loads) -> Circle {
    let radius_m = layout.circular.radius.as_ref().map_or(0.0, |r| r.value.si);
    let [dx, dy] = loads.direction;
    let at = network.nodes.get(loads.drive.node()).map_or([0.0; 2], |n| n.position_m);
    let aside = |p: [f64; 2]| (p[0] - at[0]) * dy - (p[1] - at[1]) * dx;
    let side = network.nodes.iter().map(|n| aside(n.position_m)).fold(0.0, |s: f64, a| if a.abs() > s.abs() { a } else { s });
    let outward = if side < 0.0 { [-dy, dx] } else { [dy, -dx] };
    Circle {
        count: layout.circular.count.as_ref().map_or(1, |c| c.value),
        radius_m,
        axis_m: [at[0] - radius_m * outward[0], at[1] - radius_m * outward[1]],
        outward,
    }
}

/// What cannot be together.
fn check_together(layout: &spec::Layout, found: &Layout, spec: &Spec, diagnostics: &mut Diagnostics) {
    let mut refuse = |span: Span, message: &str, other: Span, help: &str| {
        diagnostics.push(Diagnostic::error("E0517", span, message).label("this").related(other, "and this").help(help));
    };
    if let Some(circular) = &layout.circular.present {
        if let Some(mirror) = &layout.mirror {
            let help = "leave out `mirror`: with an even `count` every copy has one opposite to it";
            refuse(circular.span, "`circular` and `mirror` exclude each other", mirror.span, help);
        }
        if let Some(array) = &layout.array.present {
            let help = "keep one of them; several plates in each plane are `plates`";
            refuse(circular.span, "`circular` and `array` exclude each other", array.span, help);
        }
    }
    let Some(series) = layout.series.as_ref().filter(|_| found.layers > 1) else { return };
    for load in &spec.load {
        if let Some(turn) = load.value.moment.as_ref().or(load.value.rotation.as_ref()) {
            let help = "use `travel` or `force`, or draw the layers";
            refuse(turn.span, "layers in series turn each other: how they share a turn is not known", series.span, help);
        }
    }
}

/// The copies are joined by a block, which must move along the load without turning: each must be held so.
fn check_guided(layout: &spec::Layout, found: &Layout, network: &Network, loads: &Loads, diagnostics: &mut Diagnostics) {
    if !found.repeats() {
        return;
    }
    let support = network.nodes.get(loads.drive.node()).map(|n| &n.support);
    let [dx, dy] = loads.direction;
    let guided =
        matches!(support, Some(Support::Slider { direction: [x, y], rotation: Rotation::Fixed }) if (x * dy - y * dx).abs() < 1e-9);
    if guided {
        return;
    }
    let sections = [&layout.array.present, &layout.circular.present].into_iter().flatten().map(|s| s.span);
    let counts = [&layout.plates, &layout.series].into_iter().flatten().filter(|c| c.value > 1).map(|c| c.span);
    let Some(span) = sections.chain(counts).next() else { return };
    diagnostics.push(
        Diagnostic::error("E0516", span, "the block that joins the copies could turn or leave the line of the load")
            .label("copies that move alike")
            .help(format!(
                "hold the load node by `support = \"slider\"` with `direction = [{}, {}]`",
                forcewright_base::units::format_number(dx, 4),
                forcewright_base::units::format_number(dy, 4)
            )),
    );
}
