//! `[scenario.surface]` as it is typed. Defaults are not written into projects without a scenario: the sentences name them.

use forcewright_base::units::{Dimension, Quantity};
use forcewright_contract::data::DataFile;
use forcewright_contract::describe::{Describe, Located, Param, Section, Slot, Visitor, Word};

/// What a stage does with the mechanism.
#[derive(Debug, Default)]
pub(crate) struct Scenario {
    pub surface: Section<Surface>,
    pub lateral: Section<Lateral>,
}

/// A motion of the tip across the load.
#[derive(Debug, Default)]
pub(crate) struct Lateral {
    pub travel: Slot<[Quantity; 2]>,
    pub window: Slot<[Quantity; 2]>,
    pub axial: Slot<[Quantity; 2]>,
    pub places: Slot<u32>,
    pub levels: Slot<u32>,
}

/// A surface that the tip is drawn along.
#[derive(Debug, Default)]
pub(crate) struct Surface {
    pub profile_file: Slot<DataFile>,
    pub profile: Slot<Vec<Located<[Quantity; 2]>>>,
    pub join: Slot<&'static str>,
    pub preload: Slot<Quantity>,
    pub guide_friction: Slot<Quantity>,
    pub guide_span: Slot<Quantity>,
    pub overhang: Slot<Quantity>,
    pub tip_friction: Slot<Quantity>,
    pub tip_radius: Slot<Quantity>,
    pub there_and_back: Slot<bool>,
}

/// How heights are joined.
const JOINS: &[Word] = &[
    Word { word: "linear", doc: "straight from point to point" },
    Word { word: "smooth", doc: "monotone cubics: a continuous slope, no height beyond those of two neighbours" },
];
/// Points of a profile in the project file.
const MOST_POINTS: usize = 200;
const LARGEST_M: f64 = 10.0;
/// A range of displacements is at least a tenth of a micrometre long.
pub(super) const SHORTEST_M: f64 = 1e-7;
/// Displacements of a map in either direction.
const MOST_PLACES: f64 = 101.0;
/// Above any pair of materials.
const LARGEST_FRICTION: f64 = 2.0;

impl Describe for Scenario {
    fn describe(&mut self, v: &mut dyn Visitor) {
        self.surface
            .describe(v, &Param::new("surface", "A stage carries the mechanism sideways; a tip on its guided block follows a surface."));
        self.lateral.describe(
            v,
            &Param::new("lateral", "The guide of the tip, along the load, is also moved across the load: axial and lateral force over a map of both displacements."),
        );
    }
}

impl Describe for Surface {
    fn describe(&mut self, v: &mut dyn Visitor) {
        let doc = "The surface from a CSV file: transverse position and height, with units in the header, `position / mm, height / mm`.";
        v.file(&Param::new("profile_file", doc), &mut self.profile_file);
        v.points(
            &Param::new("profile", "The surface by points of ascending position, each with its height towards the mechanism.")
                .of(Dimension::Length),
            MOST_POINTS,
            &mut self.profile,
        );
        v.choice(&Param::new("join", "How the points are joined; without it linear."), JOINS, &mut self.join);
        v.quantity(
            &Param::new("preload", "Displacement Δ of the mechanism where the height is zero; negative: a gap.")
                .of(Dimension::Length)
                .within(-LARGEST_M, LARGEST_M)
                .required(),
            &mut self.preload,
        );
        v.quantity(
            &Param::new("guide_friction", "Coulomb coefficient of the linear bearings of the block; without it 0.")
                .within(0.0, LARGEST_FRICTION),
            &mut self.guide_friction,
        );
        v.quantity(
            &Param::new("guide_span", "Distance of the two bearings; without it the transverse force loads them without a couple.")
                .of(Dimension::Length)
                .above(1e-6, LARGEST_M),
            &mut self.guide_span,
        );
        v.quantity(
            &Param::new("overhang", "From the nearer bearing to the tip.").of(Dimension::Length).within(0.0, LARGEST_M),
            &mut self.overhang,
        );
        v.quantity(
            &Param::new("tip_friction", "Coulomb coefficient between tip and surface; without it 0.").within(0.0, LARGEST_FRICTION),
            &mut self.tip_friction,
        );
        v.quantity(
            &Param::new("tip_radius", "Radius of the round tip; without it a sharp point.").of(Dimension::Length).within(0.0, 1.0),
            &mut self.tip_radius,
        );
        v.flag(&Param::new("return", "Whether the stage also comes back; without it, it does not."), &mut self.there_and_back);
    }
}

impl Describe for Lateral {
    fn describe(&mut self, v: &mut dyn Visitor) {
        let range = |key, doc| Param::new(key, doc).of(Dimension::Length);
        v.point(
            &range(
                "travel",
                "Least and largest lateral displacement δ, counted along the load's direction turned by 90° counter-clockwise.",
            )
            .within(-LARGEST_M, LARGEST_M)
            .required(),
            &mut self.travel,
        );
        v.point(
            &range("window", "The part of `travel` that metrics look at; without it the whole.").within(-LARGEST_M, LARGEST_M),
            &mut self.window,
        );
        v.point(
            &range("axial", "Least and largest displacement Δ along the load, at which the tip is moved across.")
                .within(0.0, LARGEST_M)
                .required(),
            &mut self.axial,
        );
        let count = |key, doc| Param::new(key, doc).within(2.0, MOST_PLACES);
        v.count(&count("places", "Number of lateral displacements in equal steps over `travel`; without it 11."), &mut self.places);
        v.count(&count("levels", "Number of displacements along the load in equal steps over `axial`; without it 5."), &mut self.levels);
    }
}
