//! `[scenario.surface]` as it is typed. Defaults are not written into projects without a scenario: the sentences name them.

use forcewright_base::units::{Dimension, Quantity};
use forcewright_contract::data::DataFile;
use forcewright_contract::describe::{Describe, Located, Param, Section, Slot, Visitor, Word};

/// What a stage does with the mechanism.
#[derive(Debug, Default)]
pub(crate) struct Scenario {
    pub surface: Section<Surface>,
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
/// Above any pair of materials.
const LARGEST_FRICTION: f64 = 2.0;

impl Describe for Scenario {
    fn describe(&mut self, v: &mut dyn Visitor) {
        self.surface.describe(
            v,
            &Param::new("surface", "A stage carries the mechanism sideways; a tip on its guided block follows a surface.").required(),
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
