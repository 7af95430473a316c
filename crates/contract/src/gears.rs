//! Gears as parts that a family's `parts.rs` hands out: a plate with the drawn teeth outside, or a ring with them inside.

use forcewright_base::maths::hypot;
use forcewright_base::units::{Dimension, Unit, format_number, format_si};
use forcewright_curves::Profile;
use forcewright_elements::gears::{GearError, GearOutline, Kind, ToothProfile, WheelSpec};
use forcewright_model::{Body, Fillets, Hole, Part, Plate};

/// A gear that is made of a plate.
#[derive(Clone, Debug)]
pub struct GearPart<'a> {
    /// Short name, fit for a file name: `sun`.
    pub name: &'a str,
    /// What it is, for people.
    pub title: &'a str,
    /// Its teeth. Tooth 0 is centred on the x axis.
    pub tooth: &'a ToothProfile,
    /// Thickness of the plate, m.
    pub thickness_m: f64,
    /// Largest distance between the splines of the outline and the exact teeth, m; above 0.
    pub chord_error_m: f64,
    /// Radius of a ring on its outside, m, above its root radius; `None` for an external gear.
    pub outer_radius_m: Option<f64>,
    /// Bore and bolt holes, in the material within the root circle of a gear, or outside that of a ring.
    pub holes: Vec<Hole>,
    /// What it is made of, with its density, kg/m³.
    pub material: Option<(&'a str, Option<f64>)>,
    /// Unit in which people are told lengths.
    pub display: &'a Unit,
}

/// Why no finite elements of it are of use.
const RIGID: &str = "the parts of a gear train are taken as rigid";

impl GearPart<'_> {
    /// The part.
    ///
    /// # Errors
    /// [`GearError::Outline`] for an error of chords that cannot be kept; [`GearError::Value`] for `outer_radius_m`, and for `holes` with the
    /// diameter of one that leaves no material between it and the teeth or the outside.
    pub fn part(self) -> Result<Part, GearError> {
        let outer_m = self.checked_outer_m()?;
        self.check_holes(outer_m)?;
        let outline = self.tooth.outline(self.chord_error_m)?;
        let notes = self.notes(&outline);
        let (outline, cutouts) = match outer_m {
            Some(radius_m) => (Profile::circle([0.0; 2], radius_m), vec![outline.profile]),
            None => (outline.profile, Vec::new()),
        };
        // Those of an external gear are no arcs; the notes tell of them.
        let radius_m = self.tooth.fillet_radius_m();
        let arcs = Fillets { count: 2 * self.tooth.wheel().spec.teeth as usize, radius_m: [radius_m; 2] };
        let fillets = (outer_m.is_some() && radius_m > 0.0).then_some(arcs);
        let (material, density_kg_per_m3) = self.material.map_or((None, None), |(name, density)| (Some(name.to_owned()), density));
        let plate = Plate { depth_m: self.thickness_m, outline, cutouts, holes: self.holes, fillets, trial: Err(RIGID.to_owned()) };
        Ok(Part {
            name: self.name.to_owned(),
            title: self.title.to_owned(),
            count: 1,
            material,
            density_kg_per_m3,
            notes,
            body: Body::Plate(plate),
        })
    }

    fn checked_outer_m(&self) -> Result<Option<f64>, GearError> {
        let wheel = self.tooth.wheel();
        match (wheel.spec.kind, self.outer_radius_m) {
            (Kind::External, None) => Ok(None),
            (Kind::Internal, Some(radius_m)) if radius_m > wheel.root_radius_m && radius_m.is_finite() => Ok(Some(radius_m)),
            (_, given) => Err(GearError::Value { name: "outer_radius_m", value: given.unwrap_or(0.0) }),
        }
    }

    fn check_holes(&self, outer_m: Option<f64>) -> Result<(), GearError> {
        let root_m = self.tooth.wheel().root_radius_m;
        let lies_in_material = |hole: &&Hole| {
            let (far_m, radius_m) = (hypot(hole.centre_m[0], hole.centre_m[1]), 0.5 * hole.diameter_m);
            radius_m > 0.0 && outer_m.map_or(far_m + radius_m < root_m, |outer_m| far_m - radius_m > root_m && far_m + radius_m < outer_m)
        };
        match self.holes.iter().find(|hole| !lies_in_material(hole)) {
            Some(hole) => Err(GearError::Value { name: "holes", value: hole.diameter_m }),
            None => Ok(()),
        }
    }

    fn notes(&self, outline: &GearOutline) -> Vec<String> {
        let wheel = self.tooth.wheel();
        let WheelSpec { teeth, module_m, rack, profile_shift, .. } = wheel.spec;
        let length = |value_m: f64| format_si(value_m, self.display, 5);
        let micrometre = Unit::parse("µm").unwrap_or_else(|_| Unit::si(Dimension::Length));
        let mut notes = vec![
            format!(
                "{teeth} teeth, module {}, pressure angle {}°, profile shift {} modules; diameters: tip {}, root {}.",
                length(module_m),
                format_number(rack.pressure_angle_rad.to_degrees(), 4),
                format_number(profile_shift, 4),
                length(2.0 * wheel.tip_radius_m),
                length(2.0 * wheel.root_radius_m)
            ),
            format!(
                "Outline: {} segments per tooth, splines within {} of the exact teeth; smallest radius of the fillets {}.",
                outline.segments_per_tooth,
                format_si(outline.error_m, &micrometre, 2),
                length(self.tooth.fillet_radius_m())
            ),
            "The origin is the middle of the gear; a tooth is centred on the x axis.".to_owned(),
        ];
        if self.tooth.is_undercut() {
            notes.push(format!(
                "The teeth are undercut: their involute begins at a diameter of {}.",
                length(2.0 * self.tooth.form_radius_m())
            ));
        }
        notes
    }
}
