//! The two kinds of cam, a slider between straight cams and a disc on a shaft, and the keys that only one of them has.

use forcewright_base::diagnostics::{Diagnostic, Diagnostics, Span};
use forcewright_contract::describe::{Located, Origin, Section};

use super::{missing, place_of};
use crate::spec::Spec;

/// A key, where it was typed, and what to do about it.
type Key = (&'static str, Option<Span>, &'static str);

/// Where a key was typed.
pub(super) fn typed<T>(slot: Option<&Located<T>>) -> Option<Span> {
    slot.filter(|s| s.origin == Origin::File).map(|s| s.span)
}

fn table<T>(section: &Section<T>) -> Option<Span> {
    typed(section.present.as_ref())
}

/// E0613: keys that this kind does not have.
fn refuse(keys: &[Key], kind: &str, diagnostics: &mut Diagnostics) {
    for (key, span, help) in keys {
        if let Some(span) = span {
            diagnostics.push(Diagnostic::error("E0613", *span, format!("{kind} has no `{key}`")).label("not used").help(*help));
        }
    }
}

/// A cam with a slider: no key of torque cams, and what it needs.
pub(super) fn of_slider(spec: &Spec, diagnostics: &mut Diagnostics) {
    const TORQUE: &str = "it belongs to torque cams, which have a table `[design.disc]`; remove it or add that";
    let (r, d) = (&spec.requirements, &spec.design);
    let keys: &[Key] = &[
        ("requirements.torque", table(&r.torque), TORQUE),
        ("requirements.torque_profile", typed(r.torque_profile.as_ref()), TORQUE),
        ("requirements.torque_profile_file", typed(r.torque_profile_file.as_ref()), TORQUE),
        ("requirements.turn", typed(r.turn.as_ref()), TORQUE),
        ("requirements.turn_window", typed(r.turn_window.as_ref()), TORQUE),
        ("design.turn", typed(d.turn.as_ref()), TORQUE),
        ("design.guide_friction", typed(d.guide_friction.as_ref()), TORQUE),
        ("design.profile.for_torque", typed(d.profile.for_torque.as_ref()), TORQUE),
        ("design.profile.for_torque_profile", typed(d.profile.for_torque_profile.as_ref()), TORQUE),
        ("design.profile.for_torque_profile_file", typed(d.profile.for_torque_profile_file.as_ref()), TORQUE),
        ("design.profile.for_guide_friction", typed(d.profile.for_guide_friction.as_ref()), TORQUE),
        ("design.bodies.follower_mass", typed(d.bodies.follower_mass.as_ref()), TORQUE),
        ("design.bodies.disc_inertia", typed(d.bodies.disc_inertia.as_ref()), TORQUE),
        ("motion.start_turn", typed(spec.motion.start_turn.as_ref()), TORQUE),
        ("motion.rise_turn", typed(spec.motion.rise_turn.as_ref()), TORQUE),
    ];
    // A value that was refused has been reported: it is not missing as well.
    let sound = !diagnostics.has_errors() && d.present.is_some();
    refuse(keys, "a cam with a slider", diagnostics);
    for (key, there, example) in [("brace_length", d.brace_length.is_some(), "200 mm"), ("stroke", d.stroke.is_some(), "240 mm")] {
        if sound && !there {
            let help = format!("add `{key} = \"{example}\"`, or make it a torque cam by a table `[design.disc]`");
            diagnostics.push(missing(place_of(d), &format!("`{key}`"), &help));
        }
    }
}

/// A torque cam: no key of cams with a slider, and what it needs.
pub(crate) fn of_disc(spec: &Spec, diagnostics: &mut Diagnostics) {
    const BRACE: &str = "a torque cam has no slider and no braces: remove it, or the table `[design.disc]`";
    const TURN: &str = "the disc turns: give `turn`, an angle";
    const START: &str = "the springs are twice `design.disc.start_radius` long at the start: remove it";
    const ERRORS: &str = "errors of the profile are not computed for torque cams: remove the table";
    const LEVEL: &str = "the guides of the rollers lie level, so that weight does no work: remove it";
    const PLATE: &str = "the disc has no base and no braces: remove it";
    const RELEASE: &str = "motions of a disc have a law of time, `start_turn`, `rise_turn`, `duration`, `pause`, `return`: remove it";
    let (r, d, p, m) = (&spec.requirements, &spec.design, &spec.parts, &spec.motion);
    let keys: &[Key] = &[
        ("requirements.force", table(&r.force), "give `requirements.torque`"),
        ("requirements.profile", typed(r.profile.as_ref()), "give `requirements.torque_profile`"),
        ("requirements.profile_file", typed(r.profile_file.as_ref()), "give `requirements.torque_profile_file`"),
        ("requirements.stroke", typed(r.stroke.as_ref()), TURN),
        ("requirements.window", typed(r.window.as_ref()), "give `turn_window`, two angles"),
        ("environment.gravity", typed(spec.environment.gravity.as_ref()), LEVEL),
        ("design.brace_length", typed(d.brace_length.as_ref()), BRACE),
        ("design.stroke", typed(d.stroke.as_ref()), TURN),
        ("design.profile.for_force", typed(d.profile.for_force.as_ref()), "give `for_torque`"),
        ("design.profile.for_profile", typed(d.profile.for_profile.as_ref()), "give `for_torque_profile`"),
        ("design.profile.for_profile_file", typed(d.profile.for_profile_file.as_ref()), "give `for_torque_profile_file`"),
        ("design.profile.for_start_length", typed(d.profile.for_start_length.as_ref()), START),
        ("design.profile.share_right", typed(d.profile.share_right.as_ref()), "both lobes are equal: remove it"),
        ("design.bodies.slider_mass", typed(d.bodies.slider_mass.as_ref()), "give `follower_mass` and `disc_inertia`"),
        ("design.bodies.brace_mass", typed(d.bodies.brace_mass.as_ref()), BRACE),
        ("design.bodies.brace_inertia", typed(d.bodies.brace_inertia.as_ref()), BRACE),
        ("parts.base", typed(p.base.as_ref()), PLATE),
        ("parts.brace_width", typed(p.brace_width.as_ref()), PLATE),
        ("parts.brace_thickness", typed(p.brace_thickness.as_ref()), PLATE),
        ("parts.hole", typed(p.hole.as_ref()), "the hole of the disc is `design.disc.shaft_diameter`"),
        ("errors", table(&spec.errors), ERRORS),
        ("motion.start", typed(m.start.as_ref()), "give `start_turn`, an angle"),
        ("motion.rise", typed(m.rise.as_ref()), "give `rise_turn`, an angle"),
        ("motion.reference_duration", typed(m.reference_duration.as_ref()), RELEASE),
        ("motion.pull", typed(m.pull.as_ref()), RELEASE),
        ("motion.hanging_mass", typed(m.hanging_mass.as_ref()), RELEASE),
        ("motion.hanging_gravity", typed(m.hanging_gravity.as_ref()), RELEASE),
        ("motion.damping", typed(m.damping.as_ref()), RELEASE),
        ("motion.guide", typed(m.guide.as_ref()), BRACE),
    ];
    let sound = !diagnostics.has_errors();
    refuse(keys, "a torque cam", diagnostics);
    if sound && d.turn.is_none() {
        diagnostics.push(missing(place_of(d), "`turn`", "give the turn for which the cam is cut, `turn = \"120 deg\"`"));
    }
    if let Some(law) = m.law.as_ref().filter(|law| law.value == "release") {
        let message = "a torque cam has no `law = \"release\"`";
        diagnostics
            .push(Diagnostic::error("E0613", law.span, message).label("not computed").help("choose a law of time, such as `cycloidal`"));
    }
    if let (Some(section), None, true) = (&m.present, &m.law, sound) {
        diagnostics.push(missing(section.span, "`law`", "say how the disc moves over time, `law = \"cycloidal\"`"));
    }
    let push = d.arrangement.as_ref().is_some_and(|a| a.value == "compression");
    if let (true, Some(span)) = (push, typed(d.disc.shaft_diameter.as_ref())) {
        diagnostics.push(
            Diagnostic::error("E0613", span, "a torque cam for compression springs has no `design.disc.shaft_diameter`")
                .label("not used")
                .help("the rollers and springs are inside a ring: it is held at its rim; remove the key"),
        );
    }
}
