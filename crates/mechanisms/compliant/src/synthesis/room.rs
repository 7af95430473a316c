//! The room that a sized shape takes over its travel: beams, pads and blocks of all its copies.
//!
//! Places of a shape grow with its size λ, what lies around them with the thickness w: every distance here is the largest of some forms
//! a·λ + b·w + c, so that the largest thickness or size of a room is known at once.

use forcewright_beam::{Point, Support};

use super::catalogue::{Solved, Stop};
use super::sizing::Asked;
use crate::bodies::DrawnNode;
use crate::design::Design;
use crate::parts::way_out;

/// Width over that of the block of a bar that joins copies: it is pressed lengthwise only, by the force for which thinner beams bend.
const BAR: f64 = 0.5;

/// Copies of a shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Copies {
    /// Rows that carry one block.
    pub rows: u32,
    /// Whether they stand beside each other, and not behind each other along the load.
    pub beside: bool,
    /// Layers in series.
    pub layers: u32,
}

impl Copies {
    /// All that may be tried, the fewest copies first; with as many, the fewest layers.
    pub(crate) fn all(rows: u32, layers: u32) -> Vec<Self> {
        let of = |rows| [true, false].into_iter().take(if rows > 1 { 2 } else { 1 }).map(move |beside| (rows, beside));
        let one_layer: Vec<(u32, bool)> = (1..=rows).flat_map(of).collect();
        let mut all: Vec<Self> =
            (1..=layers).flat_map(|layers| one_layer.iter().map(move |&(rows, beside)| Self { rows, beside, layers })).collect();
        all.sort_by_key(|c| (c.rows * c.layers, c.layers));
        all
    }

    /// How many there are in the plane.
    pub(crate) fn count(self) -> u32 {
        self.rows * self.layers
    }

    /// Copies along x and y in one layer.
    fn along(self) -> [f64; 2] {
        let rows = f64::from(self.rows);
        if self.beside { [rows, 1.0] } else { [1.0, rows] }
    }
}

/// The end of a beam that is held, or is part of a block, over a travel: a pad or a block is made there. At the size of the file.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pad {
    /// The box of its places, m.
    pub low_m: [f64; 2],
    /// The other corner.
    pub high_m: [f64; 2],
    /// The axis along which the pad lies behind it.
    out: [f64; 2],
    /// Thickness of the thickest beam there over that of the design.
    thickness: f64,
    /// Whether the load is put on there.
    pub loaded: bool,
}

impl Pad {
    /// Those of a design in a state.
    pub(super) fn of(design: &Design, point: &Point, thickness_m: f64) -> Vec<Self> {
        let solid =
            |node: usize| design.bodies.iter().any(|b| b.node == node) || !matches!(design.network.nodes[node].support, Support::Free);
        let pad = |drawn: &DrawnNode| {
            let (out, thickest_m) = way_out(design, drawn.node, drawn.position_m)?;
            let at_m = design.moved_m(drawn, point);
            let loaded = drawn.node == design.load_node;
            Some(Self { low_m: at_m, high_m: at_m, out, thickness: thickest_m / thickness_m, loaded })
        };
        design.drawn.iter().filter(|d| solid(d.node)).filter_map(pad).collect()
    }

    /// With its places in another state.
    pub(super) fn and(&self, other: &Self) -> Self {
        let low_m = [0, 1].map(|k| self.low_m[k].min(other.low_m[k]));
        Self { low_m, high_m: [0, 1].map(|k| self.high_m[k].max(other.high_m[k])), ..*self }
    }

    /// How far it reaches from its place along an axis, to the lower or the upper side.
    fn reach(&self, asked: &Asked, axis: usize, upper: bool) -> Form {
        let [along, deep] = pad_size(asked, self.thickness);
        let out = if upper { self.out[axis] } else { -self.out[axis] };
        if out > 0.5 {
            deep
        } else if out < -0.5 {
            Form::default()
        } else {
            along.times(0.5)
        }
    }
}

/// Along its edge and away from the beam.
fn pad_size(asked: &Asked, thickness: f64) -> [Form; 2] {
    let given = asked.making.pad_m.map(|size| size.map(|fixed_m| Form { fixed_m, ..Form::default() }));
    let at = |thickness_m: f64| asked.making.pad_size_m(thickness_m)[0];
    given.unwrap_or([Form { size_m: 0.0, thickness: thickness * (at(1.0) - at(0.0)), fixed_m: at(0.0) }; 2])
}

/// a·λ + b·w + c.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Form {
    size_m: f64,
    thickness: f64,
    fixed_m: f64,
}

impl Form {
    fn at(self, scale: f64, thickness_m: f64) -> f64 {
        self.size_m * scale + self.thickness * thickness_m + self.fixed_m
    }

    fn times(self, factor: f64) -> Self {
        Self { size_m: factor * self.size_m, thickness: factor * self.thickness, fixed_m: factor * self.fixed_m }
    }

    fn plus(self, other: Self) -> Self {
        Self { size_m: self.size_m + other.size_m, thickness: self.thickness + other.thickness, fixed_m: self.fixed_m + other.fixed_m }
    }
}

/// The largest of the values of some forms.
fn largest(forms: &[Form], scale: f64, thickness_m: f64) -> f64 {
    forms.iter().map(|f| f.at(scale, thickness_m)).fold(f64::NEG_INFINITY, f64::max)
}

/// The room of a shape up to a stop, for copies of it.
pub(crate) struct Room {
    copies: Copies,
    /// Of one copy, per axis: how far it reaches below and above the origin.
    sides: [[Vec<Form>; 2]; 2],
    /// The same of its beams alone.
    beams: [[Form; 2]; 2],
    /// Of all, per axis: the extent is the largest of these.
    extents: [Vec<Form>; 2],
    /// What is left between copies.
    gap: Form,
    /// Per direction, against and along the load: what is in the way of a bar along the mirror line. Layers and rows are joined there.
    blocked: [Vec<Form>; 2],
}

impl Room {
    pub(super) fn of(asked: &Asked, shape: &Solved, stop: &Stop, copies: Copies) -> Self {
        let half = 0.5 * shape.thickest;
        let place = |[low, high]: [f64; 2], upper: bool| Form { size_m: if upper { high } else { -low }, ..Form::default() };
        let beams = [0, 1].map(|axis| {
            let ends = [stop.low_m[axis], stop.high_m[axis]];
            [false, true].map(|upper| Form { thickness: half, ..place(ends, upper) })
        });
        let side = |axis: usize, upper: bool| -> Vec<Form> {
            let pad = |p: &Pad| place([p.low_m[axis], p.high_m[axis]], upper).plus(p.reach(asked, axis, upper));
            std::iter::once(beams[axis][usize::from(upper)]).chain(stop.pads.iter().map(pad)).collect()
        };
        // Both sides of the mirror line x = 0 alike.
        let beside = [side(0, false), side(0, true)].concat();
        let sides = [[beside.clone(), beside.clone()], [side(1, false), side(1, true)]];
        let gap = Form { size_m: 0.0, thickness: 1.0, fixed_m: asked.gap_min_m };
        let bar = pad_size(asked, stop.pads.iter().filter(|p| p.loaded).map(|p| p.thickness).fold(1.0, f64::max))[1];
        let [across, along] = copies.along();
        let layers = f64::from(copies.layers);
        // A layer comes down onto the one that carries it by the travel of that one.
        let between = gap.plus(bar).plus(Form { size_m: stop.travel_m, ..Form::default() });
        let joined = if across > 1.0 { bar } else { Form::default() };
        let others = [gap.times(across - 1.0), gap.times(layers * (along - 1.0)).plus(between.times(layers - 1.0)).plus(joined)];
        let extent = |axis: usize| {
            let times = if axis == 0 { across } else { layers * along };
            let [low, high] = &sides[axis];
            low.iter().flat_map(|l| high.iter().map(move |h| l.plus(*h).times(times).plus(others[axis]))).collect()
        };
        let extents = [extent(0), extent(1)];
        let blocked = [true, false].map(|against| Self::in_the_way(asked, shape, stop, against));
        Self { copies, sides, beams, extents, gap, blocked }
    }

    /// How far others reach into the way of a bar along the mirror line, against or along the load from the block: more than 0 is in it.
    fn in_the_way(asked: &Asked, shape: &Solved, stop: &Stop, against: bool) -> Vec<Form> {
        let bar = Form { size_m: BAR * shape.block_m, thickness: 0.0, fixed_m: asked.gap_min_m };
        let beams = bar.plus(Form { size_m: -stop.inside_m[usize::from(!against)], thickness: 0.5 * shape.thickest, fixed_m: 0.0 });
        let blocks = stop.pads.iter().filter(|p| p.loaded);
        let [low, high] = blocks.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], p| [l.min(p.low_m[1]), h.max(p.high_m[1])]);
        let behind = |p: &&Pad| !p.loaded && if against { p.high_m[1] > low } else { p.low_m[1] < high };
        let pad = |p: &Pad| {
            // The half that is drawn may lie on either side of the line.
            let left = p.high_m[0] < 0.0;
            let near_m = if left { -p.high_m[0] } else { p.low_m[0] };
            bar.plus(Form { size_m: -near_m, ..Form::default() }).plus(p.reach(asked, 0, left))
        };
        std::iter::once(beams).chain(stop.pads.iter().filter(behind).map(pad)).collect()
    }

    /// The copies that it is of.
    pub(super) fn copies(&self) -> Copies {
        self.copies
    }

    /// Width and height, m.
    pub(super) fn extent_m(&self, scale: f64, thickness_m: f64) -> [f64; 2] {
        [0, 1].map(|axis| largest(&self.extents[axis], scale, thickness_m))
    }

    /// The thickest beam for a room of this width and height, m: less than 0 where there is none.
    pub(super) fn thickest_m(&self, scale: f64, room_m: [f64; 2]) -> f64 {
        let most = |f: &Form, room_m: f64| {
            let left_m = room_m - f.at(scale, 0.0);
            if f.thickness > 0.0 || left_m < 0.0 { left_m / f.thickness.max(f64::MIN_POSITIVE) } else { f64::INFINITY }
        };
        let all = |axis: usize| self.extents[axis].iter().map(move |f| most(f, room_m[axis]));
        all(0).chain(all(1)).fold(f64::INFINITY, f64::min)
    }

    /// The largest size for a room of this width and height with beams of a thickness: less than 0 where there is none.
    pub(super) fn largest_scale(&self, thickness_m: f64, room_m: [f64; 2]) -> f64 {
        let all = |axis: usize| {
            self.extents[axis].iter().filter(|f| f.size_m > 0.0).map(move |f| (room_m[axis] - f.at(0.0, thickness_m)) / f.size_m)
        };
        all(0).chain(all(1)).fold(f64::INFINITY, f64::min)
    }

    /// Whether what joins the copies has its way: rows beside each other and layers are joined above their blocks, rows along the load
    /// through them.
    pub(super) fn joins(&self, scale: f64, thickness_m: f64) -> bool {
        let is_free = |way: usize| largest(&self.blocked[way], scale, thickness_m) <= 0.0;
        let (above, through) = (self.copies.layers > 1 || self.copies.rows > 1, self.copies.rows > 1 && !self.copies.beside);
        (!above || is_free(0)) && (!through || is_free(1))
    }

    /// From each row to the next, m.
    pub(super) fn spacing_m(&self, scale: f64, thickness_m: f64) -> f64 {
        let axis = usize::from(!self.copies.beside);
        let own: f64 = self.sides[axis].iter().map(|side| largest(side, scale, thickness_m)).sum();
        own + self.gap.at(scale, thickness_m)
    }

    /// The box for the beams of all rows of one layer in the coordinates of the drawing, m: pads and blocks, which keep their places and lie
    /// further out, have theirs beside it, and what a room has to spare is shared out evenly.
    pub(super) fn envelope_m(&self, scale: f64, thickness_m: f64, room_m: [f64; 2]) -> [[f64; 2]; 2] {
        let taken_m = self.extent_m(scale, thickness_m);
        let rows_m = f64::from(self.copies.rows - 1) * self.spacing_m(scale, thickness_m);
        // Rows beside each other go up the x axis, those along the load down the y axis.
        let further = if self.copies.beside { [[0.0, rows_m], [0.0, 0.0]] } else { [[0.0, 0.0], [rows_m, 0.0]] };
        [0, 1].map(|axis| {
            let shares = if axis == 0 { 2.0 } else { 2.0 * f64::from(self.copies.layers) };
            let spare_m = (room_m[axis] - taken_m[axis]) / shares;
            let reach = |k: usize| self.beams[axis][k].at(scale, thickness_m) + further[axis][k] + spare_m;
            [-reach(0), reach(1)]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parts::Making;
    use crate::synthesis::catalogue;
    use crate::synthesis::sizing::tests::ASKED;

    const SCALE: f64 = 1.3;
    const THICKNESS_M: f64 = 1.2e-3;
    const GAP_M: f64 = 0.4e-3;
    /// Along the edge, and away from the beam.
    const PAD_M: [f64; 2] = [9e-3, 7e-3];

    /// The box of all beams and of all that there is in one layer, each row put in its place: least and largest x and y, m.
    fn boxes(room: &Room, shape: &Solved, stop: &Stop) -> [[[f64; 2]; 2]; 2] {
        let copies = room.copies();
        let step_m = room.spacing_m(SCALE, THICKNESS_M);
        let mut all = [[[f64::INFINITY, f64::NEG_INFINITY]; 2]; 2];
        let mut add = |kind: usize, axis: usize, low: f64, high: f64| {
            let shift = |row: u32| f64::from(row) * if copies.beside { [step_m, 0.0] } else { [0.0, -step_m] }[axis];
            for shift_m in (0..copies.rows).map(shift) {
                for of in &mut all[kind..] {
                    of[axis] = [of[axis][0].min(low + shift_m), of[axis][1].max(high + shift_m)];
                }
            }
        };
        let half_m = 0.5 * THICKNESS_M * shape.thickest;
        for axis in [0, 1] {
            add(0, axis, SCALE * stop.low_m[axis] - half_m, SCALE * stop.high_m[axis] + half_m);
            for pad in &stop.pads {
                let (low, high) = (SCALE * pad.low_m[axis], SCALE * pad.high_m[axis]);
                let (below, above) = match pad.out[axis] {
                    out if out > 0.5 => (0.0, PAD_M[1]),
                    out if out < -0.5 => (PAD_M[1], 0.0),
                    _ => (0.5 * PAD_M[0], 0.5 * PAD_M[0]),
                };
                add(1, axis, low - below, high + above);
                if axis == 0 {
                    add(1, axis, -high - above, below - low);
                }
            }
        }
        all
    }

    /// Rows, pads and all are in the room that is told, which is no larger than it must be; and the box of the beams leaves out of a larger
    /// room just what is beyond them.
    #[test]
    fn the_room_is_that_of_all_copies_put_in_their_places() {
        let asked = Asked { making: Making { pad_m: Some(PAD_M), ..Making::default() }, gap_min_m: GAP_M, ..ASKED };
        for shape in catalogue::all() {
            let stop = shape.stops.last().expect("it moves");
            for (rows, beside, layers) in [(1, true, 1), (3, true, 1), (2, false, 1), (1, true, 3), (2, false, 2)] {
                let copies = Copies { rows, beside, layers };
                let room = Room::of(&asked, shape, stop, copies);
                let said = format!("{} {copies:?}", shape.topology.name);
                let [beams, all] = boxes(&room, shape, stop);
                let size_m = |of: [f64; 2]| of[1] - of[0];
                // A bar across rows beside each other, and between layers a bar, a gap and the way of the lower one.
                let bar_m = PAD_M[1];
                let joined_m = if beside && rows > 1 { bar_m } else { 0.0 };
                let between_m = bar_m + GAP_M + THICKNESS_M + SCALE * stop.travel_m;
                let layers_m = f64::from(layers) * size_m(all[1]) + f64::from(layers - 1) * between_m + joined_m;
                let told_m = room.extent_m(SCALE, THICKNESS_M);
                let close = |a: f64, b: f64| (a - b).abs() < 1e-12;
                assert!(close(told_m[0], size_m(all[0])) && close(told_m[1], layers_m), "{said}: {told_m:?}, {all:?}, {layers_m}");
                let spare_m = [4e-3, 6e-3];
                let envelope = room.envelope_m(SCALE, THICKNESS_M, [0, 1].map(|k| told_m[k] + spare_m[k]));
                for (axis, share) in [(0, 2.0), (1, 2.0 * f64::from(layers))] {
                    let [below, above] = [beams[axis][0] - envelope[axis][0], envelope[axis][1] - beams[axis][1]];
                    assert!(close(below, spare_m[axis] / share) && close(above, spare_m[axis] / share), "{said}: {below}, {above}");
                }
                // The thickest beam and the largest size just fit.
                let larger_m = [0, 1].map(|k| told_m[k] + spare_m[k]);
                let (thickest_m, largest) = (room.thickest_m(SCALE, larger_m), room.largest_scale(THICKNESS_M, larger_m));
                for [width_m, height_m] in [room.extent_m(SCALE, thickest_m), room.extent_m(largest, THICKNESS_M)] {
                    let left_m = (larger_m[0] - width_m).min(larger_m[1] - height_m);
                    assert!(left_m.abs() < 1e-12 || thickest_m.is_infinite(), "{said}: {left_m}");
                }
            }
        }
    }
}
