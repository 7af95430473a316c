//! From what was typed to a torque cam: references checked, catalogue values in place, SI numbers.

use std::sync::Arc;

use forcewright_base::diagnostics::{Diagnostic, Diagnostics, Span};
use forcewright_base::units::{Dimension, Unit, format_si};

use super::cut::{Cut, CutError, Purpose};
use super::mechanism::{Bodies, Mechanism};
use super::{outline, room};
use crate::design::profile::{LawSlots, TORQUE, compensated, law_and_springs};
use crate::design::{
    self, DisplayUnits, Material, Requirements, Wanted, materials_of, of_disc, place_of, required, rolling_arm, si, unit_or, window_within,
};
use crate::mechanism::SpringMass;
use crate::motion::Motion;
use crate::spec::Spec;
use crate::springs::{Bank, Spring};

/// A torque cam, ready to be analysed. SI units.
#[derive(Clone, Debug)]
pub struct Design {
    /// The project's title.
    pub title: String,
    /// What the disc was cut for.
    pub purpose: Purpose,
    /// Radius of the rollers for which it was cut, m.
    pub cut_roller_m: f64,
    /// The mechanism as it is built.
    pub built: Built,
    /// How the disc moves, where that is asked for: a motion whose travel is the turn, rad.
    pub motion: Option<Motion>,
    /// Diameter of the hole for the shaft, m.
    pub shaft_m: Option<f64>,
    /// Pitch of the screw that stretches the springs, m.
    pub adjust_pitch_m: Option<f64>,
    /// How the parts are made.
    pub making: Making,
    /// Materials of cam and roller.
    pub materials: [Option<Material>; 2],
    /// Friction that is there between roller and cam.
    pub friction: Option<f64>,
    /// What it must do: the force is a torque, the stroke a turn; `None` if the project asks for nothing.
    pub requirements: Option<Requirements>,
    /// Where means are taken, from and to, rad; by default the turn without undercut.
    pub window_rad: Option<[f64; 2]>,
    /// Units in which people are shown results; the travel is the turn.
    pub units: DisplayUnits,
}

/// The mechanism as it is built.
#[derive(Clone, Debug)]
pub struct Built {
    /// Radius of the rollers, m.
    pub roller_m: f64,
    /// Arm of the rolling resistance, m.
    pub arm_m: f64,
    /// Friction between followers and guides.
    pub guide_friction: f64,
    /// Thickness of the cam, m, if known.
    pub thickness_m: Option<f64>,
    /// The springs.
    pub springs: Vec<Spring>,
    /// Whether they are extension springs.
    pub extension: bool,
    /// Lengths at which they are solid and over-extended, m.
    pub lengths_m: [Option<f64>; 2],
    /// Masses.
    pub bodies: Bodies,
}

/// How the parts are made, SI.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(clippy::struct_field_names, reason = "identifiers carry their units")]
pub struct Making {
    /// Largest distance between the cam's arcs and its exact profile, m.
    pub chord_error_m: f64,
    /// Wall outside the profile of a ring, m.
    pub wall_m: f64,
    /// Diameter of the axles, m.
    pub pin_m: f64,
}

impl Design {
    /// Thickness of the cam, m: as given, or as it is drawn without.
    pub(crate) fn drawn_thickness_m(&self) -> f64 {
        self.built.thickness_m.unwrap_or(0.5 * self.cut_roller_m)
    }

    /// The mechanism on a disc that was cut.
    pub fn mechanism(&self, cut: &Arc<Cut>) -> Mechanism {
        let built = &self.built;
        Mechanism {
            cut: Arc::clone(cut),
            cut_roller_m: self.cut_roller_m,
            corner: Mechanism::corner_of(cut, self.cut_roller_m),
            roller_m: built.roller_m,
            arm_m: built.arm_m,
            guide_friction: built.guide_friction,
            springs: Bank::new(built.springs.clone(), built.extension),
            bodies: built.bodies,
        }
    }
}

/// Reads a torque cam from what was typed. Everything wrong goes into `diagnostics`.
pub(crate) fn resolve(spec: &mut Spec, diagnostics: &mut Diagnostics) -> Option<Design> {
    of_disc(spec, diagnostics);
    let materials = materials_of(spec, diagnostics);
    let extension = spec.design.arrangement.as_ref().is_none_or(|a| a.value == "tension");
    let purpose = purpose_of(spec, extension, diagnostics);
    let springs = design::springs::mounted(spec, diagnostics);
    let arm = rolling_arm(spec, diagnostics);
    let requirements = requirements_of(spec, diagnostics);
    if diagnostics.has_errors() {
        return None;
    }
    let purpose = purpose?;
    let cut = match Cut::new(purpose.clone()) {
        Ok(cut) => Arc::new(cut),
        Err(error) => {
            diagnostics.push(cannot_be_cut(&error, spec, extension));
            return None;
        }
    };
    let words = ["the turn", "the turn of the disc", "turn"];
    let window_rad = window_within(&spec.requirements.turn_window, (&spec.design.turn, purpose.turn_rad), words, diagnostics);
    let motion = design::motion::turned(spec, purpose.turn_rad, diagnostics);
    let roller_m = 0.5 * si(&spec.design.roller_diameter)?;
    let units = display_units(spec);
    let design = Design {
        title: spec.header.title.as_ref().map_or_else(|| "Torque cam".to_owned(), |t| t.value.clone()),
        purpose,
        cut_roller_m: roller_m,
        built: built_of(spec, springs?, extension, (roller_m, arm?)),
        motion,
        shaft_m: si(&spec.design.disc.shaft_diameter),
        adjust_pitch_m: si(&spec.design.springs.adjust.pitch),
        making: Making {
            chord_error_m: si(&spec.parts.chord_error)?,
            wall_m: si(&spec.parts.wall).unwrap_or(2.0 * roller_m),
            pin_m: si(&spec.parts.pin_diameter).unwrap_or(0.5 * roller_m),
        },
        materials,
        friction: si(&spec.design.friction),
        requirements,
        window_rad,
        units,
    };
    fits(spec, &design, &cut, diagnostics);
    if diagnostics.has_errors() { None } else { Some(design) }
}

fn purpose_of(spec: &Spec, extension: bool, diagnostics: &mut Diagnostics) -> Option<Purpose> {
    let profile = &spec.design.profile;
    let slots = LawSlots { level: &profile.for_torque, typed: &profile.for_torque_profile, file: &profile.for_torque_profile_file };
    let (law, springs) = law_and_springs(spec, extension, (&slots, &TORQUE), diagnostics);
    Some(Purpose {
        law: law?,
        springs: springs?,
        start_radius_m: si(&spec.design.disc.start_radius)?,
        friction: compensated(spec, si(&profile.for_friction)?),
        guide_friction: compensated(spec, si(&profile.for_guide_friction)?),
        turn_rad: si(&spec.design.turn)?,
    })
}

fn requirements_of(spec: &Spec, diagnostics: &mut Diagnostics) -> Option<Requirements> {
    let requirements = &spec.requirements;
    let wanted = Wanted {
        slots: LawSlots {
            level: &requirements.torque.nominal,
            typed: &requirements.torque_profile,
            file: &requirements.torque_profile_file,
        },
        words: &TORQUE,
        present: requirements.torque.present.as_ref().map(|p| p.span),
        band: &requirements.torque.band,
        total: &requirements.turn,
        keys: ["torque", "torque_profile", "torque_profile_file"],
        example: "2 N*m",
    };
    required(spec, &wanted, diagnostics)
}

fn built_of(spec: &Spec, springs: Vec<Spring>, extension: bool, (roller_m, arm_m): (f64, f64)) -> Built {
    let design = &spec.design;
    let bodies = &design.bodies;
    let or0 = |slot| si(slot).unwrap_or(0.0);
    Built {
        roller_m,
        arm_m,
        guide_friction: or0(&design.guide_friction),
        thickness_m: si(&design.cam_thickness),
        springs,
        extension,
        lengths_m: [si(&design.springs.min_length), si(&design.springs.max_length)],
        bodies: Bodies {
            disc_kg_m2: or0(&bodies.disc_inertia),
            follower_kg: or0(&bodies.follower_mass),
            roller_kg: or0(&bodies.roller_mass),
            roller_kg_m2: or0(&bodies.roller_inertia),
            springs: match spec.model.spring_mass.as_ref().map(|m| m.value) {
                Some("halves") => SpringMass::Halves,
                _ => SpringMass::Bar,
            },
        },
    }
}

/// What finds no room.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Misfit {
    /// The rollers meet in the middle.
    Meet,
    /// Nothing leads from the end of a lobe to the start of the other.
    Open,
    /// The hole for the shaft cuts through the outline.
    Shaft {
        /// How near the outline comes to the middle, m.
        least_m: f64,
    },
}

/// Whether rollers, outline and shaft find room on a disc that was cut.
pub(super) fn misfit(design: &Design, cut: &Arc<Cut>) -> Option<Misfit> {
    let mechanism = design.mechanism(cut);
    let [from, to] = cut.range_m();
    let least = [from, to].into_iter().map(|l| cut.at(l)[1].value()).fold(f64::INFINITY, f64::min);
    if least < design.cut_roller_m {
        return Some(Misfit::Meet);
    }
    let start = outline::start_m(&mechanism);
    let Some(closing) = outline::closing(&mechanism, start, to) else { return Some(Misfit::Open) };
    let [least_m, _] = outline::reach_m(&mechanism, [start, to], &closing);
    design.shaft_m.filter(|d| 0.5 * d >= least_m).map(|_| Misfit::Shaft { least_m })
}

/// E0607, E0614, E0615: rollers, outline and shaft find room.
fn fits(spec: &Spec, design: &Design, cut: &Arc<Cut>, diagnostics: &mut Diagnostics) {
    let Some(misfit) = misfit(design, cut) else { return };
    let length = |m: f64| format_si(m, &design.units.length, 4);
    let place = |slot: Option<Span>| slot.unwrap_or_else(|| place_of(&spec.design));
    diagnostics.push(match misfit {
        Misfit::Meet => {
            let at = place(spec.design.roller_diameter.as_ref().map(|r| r.span));
            Diagnostic::error("E0607", at, "the rollers run into each other").label("where they come closest to the shaft").help(
                if design.built.extension {
                    "choose a larger `start_radius` or smaller rollers"
                } else {
                    "choose a larger `start_radius`, smaller rollers or a shorter turn"
                },
            )
        }
        Misfit::Open => {
            let at = place(spec.design.turn.as_ref().map(|t| t.span));
            Diagnostic::error("E0614", at, "the outline does not find back from the end of a lobe to the start of the other")
                .label("two lobes and what joins them share a whole turn")
                .help(room::advice(design))
        }
        Misfit::Shaft { least_m } => {
            let at = place(spec.design.disc.shaft_diameter.as_ref().map(|t| t.span));
            let shaft = length(design.shaft_m.unwrap_or(0.0));
            Diagnostic::error("E0615", at, format!("a hole of {shaft} for the shaft cuts through the outline of the disc"))
                .label("too large")
                .help(format!(
                    "the outline comes as near as {} to the middle: choose a thinner shaft or a larger `start_radius`",
                    length(least_m)
                ))
        }
    });
}

fn cannot_be_cut(error: &CutError, spec: &Spec, extension: bool) -> Diagnostic {
    let place = place_of(&spec.design.profile);
    let shown = |turn_rad: &f64| {
        let unit = unit_or(spec.design.turn.as_ref(), "deg", Dimension::Angle);
        format_si(*turn_rad, &unit, 4)
    };
    match error {
        CutError::Meets { turn_rad } => {
            Diagnostic::error("E0607", place, "the rollers run into each other").label("for this torque and these springs").help(format!(
                "they meet at a turn of {}; stay well below it, or choose stiffer springs or a larger `start_radius`",
                shown(turn_rad)
            ))
        }
        CutError::Locks { turn_rad } => Diagnostic::error("E0602", place, "with the friction that is compensated the disc locks")
            .label("for this torque and these springs")
            .help(format!("it does from a turn of {} on; compensate less friction, or shorten the turn", shown(turn_rad))),
        CutError::SpringsGiveNoForce { turn_rad } => {
            let help = if *turn_rad == 0.0 {
                let side = if extension { "at least" } else { "at most" };
                format!("the springs must be tense at the start: twice `start_radius` must be {side} their rest length")
            } else {
                format!(
                    "they do not store the work of a turn of {}; choose springs whose force does not fall, or a shorter turn",
                    shown(turn_rad)
                )
            };
            Diagnostic::error("E0603", place, "these springs cannot do the work that is asked for")
                .label("for this torque and these springs")
                .help(help)
        }
    }
}

fn display_units(spec: &Spec) -> DisplayUnits {
    let design = &spec.design;
    let torque = spec.requirements.torque.nominal.as_ref().or(design.profile.for_torque.as_ref());
    let rate = design.profile.for_rate.as_ref().or(design.springs.rate.as_ref());
    let turn = unit_or(design.turn.as_ref(), "deg", Dimension::Angle);
    DisplayUnits {
        travel: turn.clone(),
        length: unit_or(design.disc.start_radius.as_ref(), "mm", Dimension::Length),
        force: Unit::si(Dimension::Force),
        torque: unit_or(torque, "N*m", Dimension::Torque),
        stiffness: unit_or(rate, "N/mm", Dimension::Stiffness),
        angle: turn,
        time: unit_or(spec.motion.duration.as_ref(), "s", Dimension::Time),
    }
}
