//! `[synthesise]` of the project file: the room and the means of what is to be designed.

use forcewright_base::units::{Dimension, Quantity};
use forcewright_contract::describe::{Describe, Param, Section, Slot, Visitor};

/// The room and the means.
#[derive(Debug, Default)]
pub(crate) struct Synthesise {
    pub room: Slot<[Quantity; 2]>,
    pub depth: Section<Depth>,
    pub thickness_min: Slot<Quantity>,
    pub plates: Slot<u32>,
    pub rows: Slot<u32>,
    pub series: Slot<u32>,
    pub candidates: Slot<u32>,
}

/// Depths of one plate.
#[derive(Debug, Default)]
pub(crate) struct Depth {
    pub min: Slot<Quantity>,
    pub max: Slot<Quantity>,
}

/// Most plates, as in `[layout]`.
pub(crate) const MOST_PLATES: u32 = 100;
/// Most rows and layers: each number of them is tried.
pub(crate) const MOST_ROWS: u32 = 10;
pub(crate) const MOST_LAYERS: u32 = 6;
/// Most files.
const MOST_CANDIDATES: f64 = 50.0;
const LARGEST_M: f64 = 10.0;

// Defaults stand in `Asked::of` and not here: a file without this section has no row of it in its report.
impl Describe for Synthesise {
    fn describe(&mut self, v: &mut dyn Visitor) {
        let length = |key, doc| Param::new(key, doc).of(Dimension::Length).above(0.0, LARGEST_M);
        v.point(
            &length(
                "room",
                "Width and height that the whole takes over the travel, with its pads and blocks, the height along the load; without it any.",
            ),
            &mut self.room,
        );
        self.depth.describe(v, &Param::new("depth", "Out-of-plane depth of one plate, such as the sheets there are."));
        v.quantity(
            &length("thickness_min", "Thinnest beam that your process leaves; needed by `forcewright synthesise`."),
            &mut self.thickness_min,
        );
        v.count(
            &Param::new("plates", "Most equal plates behind each other; 1 without it.").within(1.0, f64::from(MOST_PLATES)),
            &mut self.plates,
        );
        v.count(
            &Param::new("rows", "Most rows on one block, where one is not strong enough; 1 without it.").within(1.0, f64::from(MOST_ROWS)),
            &mut self.rows,
        );
        v.count(
            &Param::new("series", "Most layers in series, where one does not move far enough; 1 without it.")
                .within(1.0, f64::from(MOST_LAYERS)),
            &mut self.series,
        );
        v.count(&Param::new("candidates", "Most designs written; 5 without it.").within(1.0, MOST_CANDIDATES), &mut self.candidates);
    }
}

impl Describe for Depth {
    fn describe(&mut self, v: &mut dyn Visitor) {
        let side = |key, doc| Param::new(key, doc).of(Dimension::Length).above(0.0, LARGEST_M);
        v.quantity(&side("min", "Smallest; without it twice the thickness of the beams."), &mut self.min);
        v.quantity(&side("max", "Largest; 50 mm without it."), &mut self.max);
    }
}
