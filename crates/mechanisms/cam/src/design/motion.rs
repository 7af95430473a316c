//! Motions of the slider as typed.

use forcewright_base::diagnostics::{Diagnostic, Diagnostics, Span};
use forcewright_base::units::Quantity;
use forcewright_contract::describe::Located;

use super::kind::typed;
use super::{Built, missing, place_of, si};
use crate::cut::Purpose;
use crate::motion::{Law, Motion};
use crate::release::Release;
use crate::spec::Spec;

/// The word of the law by which nothing is prescribed.
const RELEASE: &str = "release";

fn is_released(spec: &Spec) -> bool {
    spec.motion.law.as_ref().is_some_and(|law| law.value == RELEASE)
}

fn need(
    spec: &Spec,
    slot: Option<&Located<Quantity>>,
    name: &str,
    [keys, example]: [&str; 2],
    diagnostics: &mut Diagnostics,
) -> Option<f64> {
    if slot.is_none() {
        let help = format!("it has {keys}; add `{name} = \"{example}\"`");
        diagnostics.push(missing(place_of(&spec.motion), &format!("`{name}`"), &help));
    }
    slot.map(|l| l.value.si)
}

/// E0610: keys that the law does not use.
fn refuse(spec: &Spec, keys: &[(&str, Option<Span>)], help: &str, diagnostics: &mut Diagnostics) {
    let law = spec.motion.law.as_ref().map_or("", |law| law.value);
    for (key, span) in keys {
        if let Some(span) = span {
            diagnostics.push(
                Diagnostic::error("E0610", *span, format!("a motion by the law `{law}` has no `{key}`")).label("not used").help(help),
            );
        }
    }
}

/// A motion by a law of time.
pub(super) fn prescribed(spec: &Spec, diagnostics: &mut Diagnostics) -> Option<Motion> {
    let motion = &spec.motion;
    let law = match motion.law.as_ref()?.value {
        RELEASE => return None,
        "polynomial" => Law::Polynomial,
        "uniform" => Law::Uniform,
        _ => Law::Cycloidal,
    };
    let others = [
        ("pull", typed(motion.pull.as_ref())),
        ("hanging_mass", typed(motion.hanging_mass.as_ref())),
        ("hanging_gravity", typed(motion.hanging_gravity.as_ref())),
        ("damping", typed(motion.damping.as_ref())),
    ];
    refuse(spec, &others, "it belongs to `law = \"release\"`", diagnostics);
    let keys = "`start`, `rise` and `duration`";
    let start = need(spec, motion.start.as_ref(), "start", [keys, "30 mm"], diagnostics);
    let rise = need(spec, motion.rise.as_ref(), "rise", [keys, "100 mm"], diagnostics);
    let duration = need(spec, motion.duration.as_ref(), "duration", [keys, "0.5 s"], diagnostics);
    Some(Motion {
        law,
        start_m: start?,
        rise_m: rise?,
        duration_s: duration?,
        pause_s: si(&motion.pause).unwrap_or(0.0),
        returns: motion.back.as_ref().is_some_and(|b| b.value),
        reference_s: si(&motion.reference_duration),
    })
}

/// A motion of the disc of a torque cam: the travel is its turn.
pub(crate) fn turned(spec: &Spec, turn_rad: f64, diagnostics: &mut Diagnostics) -> Option<Motion> {
    let motion = &spec.motion;
    motion.present.as_ref()?;
    let law = match motion.law.as_ref()?.value {
        "polynomial" => Law::Polynomial,
        "uniform" => Law::Uniform,
        _ => Law::Cycloidal,
    };
    let keys = "`start_turn`, `rise_turn` and `duration`";
    let start = need(spec, motion.start_turn.as_ref(), "start_turn", [keys, "10 deg"], diagnostics);
    let rise = need(spec, motion.rise_turn.as_ref(), "rise_turn", [keys, "90 deg"], diagnostics);
    let duration = need(spec, motion.duration.as_ref(), "duration", [keys, "0.5 s"], diagnostics);
    let (start, rise) = (start?, rise?);
    let inside = |turn: f64| turn >= -1e-9 && turn <= turn_rad * (1.0 + 1e-9);
    if !inside(start) || !inside(start + rise) {
        let place = motion.rise_turn.as_ref().map_or_else(Span::default, |r| r.span);
        diagnostics.push(
            Diagnostic::error("E0605", place, "the motion leaves the turn for which the disc is cut")
                .label("here")
                .related(spec.design.turn.as_ref().map_or_else(Span::default, |s| s.span), "the turn")
                .help("shorten `rise_turn`, or move `start_turn`"),
        );
    }
    Some(Motion {
        law,
        start_m: start,
        rise_m: rise,
        duration_s: duration?,
        pause_s: si(&motion.pause).unwrap_or(0.0),
        returns: motion.back.as_ref().is_some_and(|b| b.value),
        reference_s: None,
    })
}

/// A release.
pub(super) fn released(spec: &Spec, diagnostics: &mut Diagnostics) -> Option<Release> {
    let motion = &spec.motion;
    if !is_released(spec) {
        return None;
    }
    let others = [
        ("rise", typed(motion.rise.as_ref())),
        ("reference_duration", typed(motion.reference_duration.as_ref())),
        ("pause", typed(motion.pause.as_ref())),
        ("return", typed(motion.back.as_ref())),
    ];
    refuse(spec, &others, "where it goes follows from the forces: leave it out", diagnostics);
    let keys = "`start` and `duration`";
    let start = need(spec, motion.start.as_ref(), "start", [keys, "200 mm"], diagnostics);
    let duration = need(spec, motion.duration.as_ref(), "duration", [keys, "1 s"], diagnostics);
    Some(Release {
        pull_n: si(&motion.pull).unwrap_or(0.0),
        weight_kg: si(&motion.hanging_mass).unwrap_or(0.0),
        weight_m_per_s2: si(&motion.hanging_gravity)?,
        damping_n_s_per_m: si(&motion.damping).unwrap_or(0.0),
        sideways_m: None,
        start_m: start?,
        duration_s: duration?,
        stops_m: [0.0, si(&spec.design.stroke)?],
    })
}

/// E0605: a motion begins and ends in the stroke.
pub(super) fn check_ends(spec: &Spec, purpose: &Purpose, ends_m: Option<[f64; 2]>, diagnostics: &mut Diagnostics) {
    let inside = |s: f64| s >= -1e-9 && s <= purpose.stroke_m * (1.0 + 1e-9);
    if ends_m.is_none_or(|ends| ends.into_iter().all(inside)) {
        return;
    }
    // Something that is let go goes where the forces take it: only its start can lie outside.
    let (rise, start) = (spec.motion.rise.as_ref().filter(|_| !is_released(spec)), spec.motion.start.as_ref());
    let place = rise.or(start).map_or_else(Span::default, |r| r.span);
    let help = match rise {
        Some(_) => "shorten `rise`, or move `start`".to_owned(),
        None => format!("let `start` be at most {}", spec.design.stroke.as_ref().map_or_else(String::new, |s| s.value.to_string())),
    };
    diagnostics.push(
        Diagnostic::error("E0605", place, "the motion leaves the stroke for which the cam is cut")
            .label("here")
            .related(spec.design.stroke.as_ref().map_or_else(Span::default, |s| s.span), "the stroke")
            .help(help),
    );
}

/// E0611: what is let go needs a mass.
pub(super) fn check_mass(spec: &Spec, built: &Built, release: Option<&Release>, diagnostics: &mut Diagnostics) {
    let Some(release) = release else { return };
    let b = &built.bodies;
    let springs: f64 = built.springs.iter().map(|s| s.mass_kg).sum();
    // What hangs on a cable does not hold a free slider back sideways.
    let free = spec.motion.guide.as_ref().is_some_and(|g| g.value == "free");
    let hanging = if free { 0.0 } else { release.weight_kg };
    if b.slider_kg + b.brace_kg + b.roller_kg + springs + hanging > 0.0 {
        return;
    }
    let place = spec.motion.law.as_ref().map_or_else(Span::default, |law| law.span);
    diagnostics.push(
        Diagnostic::error("E0611", place, "what is let go has no mass, so that its acceleration is not defined")
            .label("released")
            .help("give `design.bodies.slider_mass`, or the mass of braces, rollers or springs"),
    );
}
