//! Fatigue and creep: judged by data of the material, and not assessed without them.

use forcewright_base::units::{Dimension, Unit, format_number, format_si};
use forcewright_beam::{Drive, Face};
use forcewright_model::{Check, Sense};

use super::{Comparison, Context, PLAUSIBLE, percent, rounded_down};
use crate::endurance::{Fibre, Goodman, worst};
use crate::loads::Control;
use crate::material::Material;

impl Context<'_> {
    /// COMP009: the range of stress that each fibre goes through.
    pub(super) fn fatigue(&self) -> Option<Check> {
        let wanted = self.requirements.fatigue?;
        let materials = &self.design.materials;
        let lines: Vec<Result<Goodman, String>> = materials.iter().map(|m| line(m, wanted.cycles)).collect();
        let found = worst(self.behaviour, |beam| lines.get(*self.design.beam_materials.get(beam)?)?.as_ref().ok().copied());
        let unknown = lines.iter().find_map(|l| l.as_ref().err());
        let safety = found.map(|f| f.safety).filter(|s| s.is_finite());
        let cycles = cycles_text(wanted.cycles);
        let thinner = safety.map(|s| rounded_down(s / wanted.safety_factor, 3)).filter(|t| (PLAUSIBLE..1.0).contains(t));
        let comparison = Comparison {
            code: "COMP009",
            name: "fatigue".to_owned(),
            title: format!("Safety against fatigue at {cycles} cycles{}", found.map_or_else(String::new, |f| self.fibre_text(&f))),
            required: true,
            value: safety,
            limit: Some(wanted.safety_factor),
            sense: Sense::AtLeast,
            dimension: Dimension::Ratio,
            display: Unit::si(Dimension::Ratio),
            scale: None,
            basis: found.map_or_else(|| "Goodman's line".to_owned(), |f| self.line_text(&f)),
            fix: match thinner {
                Some(factor) => format!(
                    "shorten the travel, or make all beams thinner: stress follows the thickness (× {}), and `design.depth` × {} keeps the force",
                    format_number(factor, 3),
                    format_number(1.0 / (factor * factor * factor), 4)
                ),
                None => "shorten the travel, change the shape, or choose another material".to_owned(),
            },
            missing: unknown.cloned().unwrap_or_else(|| self.unreached()),
            partial: !self.behaviour.whole || unknown.is_some(),
            broken: false,
        };
        Some(comparison.judge())
    }

    /// Where the fibre is and what it goes through.
    fn fibre_text(&self, fibre: &Fibre) -> String {
        let name = self.design.beam_names.get(fibre.beam).map_or("?", String::as_str);
        let face = if fibre.face == Face::Left { "left" } else { "right" };
        let unit = &self.design.units.stress;
        let [low, high] = fibre.stress_pa.map(|s| format_number(unit.from_si(s), 4));
        format!(" (beam {name}, u = {}, {face} face, {low} to {high} {}{})", format_number(fibre.u, 3), unit.pretty(), self.so_far())
    }

    /// The line that the fibre is judged by.
    fn line_text(&self, fibre: &Fibre) -> String {
        let unit = &self.design.units.stress;
        let show = |pa: f64| format_si(pa, unit, 4);
        let Some((material, endured)) = self.design.material_of(fibre.beam).and_then(|m| Some((m, m.fatigue.as_ref()?))) else {
            return "Goodman's line".to_owned();
        };
        format!(
            "Goodman's line from the tensile strength {} through an amplitude of {} at {} cycles and a stress ratio of {} ({}); Goodman 1899, Shigley",
            show(material.tensile_pa.unwrap_or(f64::NAN)),
            show(endured.amplitude_pa),
            cycles_text(endured.cycles),
            format_number(endured.stress_ratio.unwrap_or(f64::NAN), 3),
            endured.origin,
        )
    }

    /// COMP010: the force that is left under a displacement that is held.
    pub(super) fn hold(&self) -> Option<Check> {
        let wanted = self.requirements.hold.as_ref()?;
        let time = format_si(wanted.time_s, &wanted.unit, 4);
        let left: Vec<Result<f64, String>> = self.design.materials.iter().map(|m| modulus_left(m, wanted.time_s, &time)).collect();
        let first = left.first().and_then(|l| l.as_ref().ok().copied());
        let alike = left.iter().flatten().all(|l| Some(l.to_bits()) == first.map(f64::to_bits));
        let given = |drive: &Drive| matches!(drive, Drive::Force { .. } | Drive::Moment { .. });
        let weight = self.design.control == Control::Force || self.design.network.before.iter().any(|stage| given(&stage.drive));
        let missing = if weight {
            Some("a force or moment is given: under it a material that creeps gives way further, and no displacement is held".to_owned())
        } else if let Some(unknown) = left.iter().find_map(|l| l.as_ref().err()) {
            Some(unknown.clone())
        } else if alike {
            None
        } else {
            Some("beams that creep differently change what they share; that is not computed".to_owned())
        };
        let comparison = Comparison {
            code: "COMP010",
            name: "hold".to_owned(),
            title: format!("Force left at a displacement held for {time}"),
            required: true,
            value: first.filter(|_| missing.is_none()),
            limit: Some(wanted.force_left),
            sense: Sense::AtLeast,
            dimension: Dimension::Ratio,
            display: percent(),
            scale: None,
            basis: self.design.materials.first().map_or_else(String::new, creep_text),
            fix: "hold it for a shorter time, or choose a material that creeps less: metals do not at room temperature".to_owned(),
            missing: missing.unwrap_or_default(),
            partial: false,
            broken: false,
        };
        Some(comparison.judge())
    }
}

/// `1e6`, `2500`.
fn cycles_text(cycles: f64) -> String {
    if cycles < 1e5 { format_number(cycles, 6) } else { format!("{cycles:e}") }
}

/// How the project calls a material.
fn called(material: &Material) -> String {
    material.name.as_ref().map_or_else(|| "material".to_owned(), |name| format!("material.{name}"))
}

/// What a material endures for so many cycles, or what is not known.
fn line(material: &Material, cycles: f64) -> Result<Goodman, String> {
    let key = called(material);
    let Some(endured) = &material.fatigue else {
        return Err(format!("no stress is known that it endures; give `{key}.fatigue = {{ amplitude = …, cycles = … }}`"));
    };
    if cycles > endured.cycles {
        let (asked, tested) = (cycles_text(cycles), cycles_text(endured.cycles));
        return Err(format!("{asked} cycles are asked for, and what it endures is known for {tested}; give `{key}.fatigue` for more"));
    }
    let Some(tensile_pa) = material.tensile_pa else {
        return Err(format!("the tensile strength is not known; give `{key}.tensile_strength`"));
    };
    let unsound = || format!("the stress that `{key}` endures has no known stress ratio, or a mean at the tensile strength or above");
    Goodman::through(endured, tensile_pa).ok_or_else(unsound)
}

/// Young's modulus after a time, as part of that at its beginning, or why that is not known.
fn modulus_left(material: &Material, time_s: f64, time: &str) -> Result<f64, String> {
    let key = called(material);
    let Some(entry) = material.entry else {
        return Err(format!("nothing is known of the creep of `{key}`, which is not of the catalogue"));
    };
    entry.modulus_left(time_s).ok_or_else(|| match &entry.creep_modulus {
        None => format!("the catalogue has no creep modulus of {}", entry.name),
        Some(creep) => {
            let hours: Vec<String> = creep.values.iter().map(|[t, _]| format!("{} h", format_number(t / 3600.0, 4))).collect();
            format!("the creep modulus of {} is known at {}; {time} lies outside", entry.name, hours.join(" and "))
        }
    })
}

/// What the force that is left rests on.
fn creep_text(material: &Material) -> String {
    match material.entry {
        Some(entry) if !entry.class.creeps() => format!("{}: {} does not creep at room temperature", entry.name, entry.class),
        Some(entry) => {
            let source = entry.creep_modulus.as_ref().map_or("no source", |c| c.source.as_str());
            format!(
                "creep modulus of {} over its Young's modulus, both of the catalogue ({source}), linear in the logarithm of time; force goes with the modulus",
                entry.name
            )
        }
        None => "creep modulus over Young's modulus".to_owned(),
    }
}
