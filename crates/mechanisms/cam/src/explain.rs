//! The long story behind every code of this family.

use forcewright_base::diagnostics::Explanation;

const fn code(code: &'static str, title: &'static str, text: &'static str) -> Explanation {
    Explanation { code, title, text }
}

/// Checks `CAM…`, errors of the design `E06…`, warnings `W06…`.
pub(crate) const CODES: &[Explanation] = &[
    code(
        "CAM001",
        "force band",
        "The force on the slider, moving up and moving back, stays within `requirements.force.band` of the required level, or of the required profile, over the window. The value is the largest |F/F_required − 1|.\n\nFriction spreads the two directions apart by about μ(1 + f²)A/Δ on either side (`docs/theory/cam.md`), more at the end of the stroke than at its start; a rest length that is wrong by dL changes the force by −dL/(2Δ), most at the start.",
    ),
    code(
        "CAM002",
        "stroke",
        "The travel for which the cam is cut, as far as the mechanism can be assembled, against `requirements.stroke`.",
    ),
    code(
        "CAM003",
        "undercut",
        "The cam is the path of the rollers' centres offset by their radius r. Where the path's radius of curvature ϱ is smaller than r there is no such cam: its offset has a cusp, and below it the roller turns about the corner that is left (1 − r/ϱ < 0; R. L. Norton, Cam Design and Manufacturing Handbook, chapter 7). The travel below is lost for the wanted force; `undercut_travel` says how much.\n\nThe path of a constant-force cam is curved most at its start, where the springs have no force yet: ϱ(x0) = (1 + tan²α0)^{3/2}/(1/A + l²/(l² − x0²)^{3/2}) with A = F/4K. Smaller rollers, longer braces and springs that are already stretched at the start (`for_start_length`) remove it. The mechanism of Sánchez-Salinas et al. is undercut over its first 0.52 mm.",
    ),
    code(
        "CAM004",
        "hysteresis",
        "(Mean up − mean down)/mean of the force over the window, against `requirements.hysteresis`. With rolling resistance alone it is about 2μ times the mean of (1 + f²)A/Δ; it does not depend on the springs' rate.",
    ),
    code(
        "CAM005",
        "springs not over-extended",
        "Largest length of the springs over the stroke against `design.springs.max_length`. Beyond, an extension spring is deformed for good.",
    ),
    code(
        "CAM006",
        "springs not solid",
        "Smallest length of the springs over the stroke against `design.springs.min_length`. Below, the coils of a compression spring touch.",
    ),
    code(
        "CAM007",
        "rollers stay on the cam",
        "The cam only pushes. The normal force between roller and cam must stay above zero: at rest in both directions, and in the motion, where the rollers' inertia takes from it.",
    ),
    code(
        "CAM008",
        "a pulling cable stays taut",
        "In a quick motion the slider has to be braked before its end. A cable cannot do that: where the force falls below zero it goes slack and the motion is another one. For what pulls by a rod this is of no matter; it is therefore not required.",
    ),
    code(
        "CAM009",
        "friction needed for rolling",
        "Tangential over normal force between roller and cam, the largest over stroke and directions. More than the friction that is there (`design.friction`), and the rollers slide instead of rolling.",
    ),
    code(
        "CAM010",
        "pressure between roller and cam",
        "Largest pressure of the line contact between roller and cam over the window (Hertz; K. L. Johnson, Contact Mechanics, 1985): p² = w E*/(π R) with the load per width w, 1/R = 1/r + 1/(ϱ − r), 1/E* = (1 − ν₁²)/E₁ + (1 − ν₂²)/E₂. Nothing yields below about 1.79 times the yield stress, a little below the surface. On the corner of an undercut cam there is no line contact and no such pressure: begin the window beyond it.\n\n`contact_life` is by the surface strength of steels after their hardness (`material.cam.brinell`); see docs/theory/elements.md.",
    ),
    code(
        "CAM011",
        "force error of the arcs",
        "A cam is cut along arcs that share their tangents, within `parts.chord_error` of the exact profile. The force follows the slope of the deviation: δF = d(P δL)/ds, with P the force of the springs and δL the lengthening of the springs by it. The check compares the largest |δF|/F with a tenth of the force band.",
    ),
    code(
        "CAM012",
        "limit on a metric",
        "`[requirements.limits]` bounds any metric by its name. A metric that the design does not have is *not assessed*, which does not count as met.",
    ),
    code(
        "CAM013",
        "the cable of the hanging mass stays taut",
        "After a release the hanging mass pulls the slider by a cable. Where the slider would accelerate faster than the mass falls, the cable is slack and the mass falls freely; where it becomes taut again both go on with one speed, the momentum is kept and energy is lost (`docs/theory/cam.md`, eq. 12). The motion is computed through all of it; the jerks are hard on a cable.",
    ),
    code(
        "CAM014",
        "torque band",
        "Torque cam: the torque on the shaft, turned against the springs and back, stays within `requirements.torque.band` of the required level, or of the required profile, over `turn_window`. The value is the largest |T/T_required − 1|.\n\nRolling friction spreads the two directions apart by about μ(1 + tan²φ)/tan φ on either side, φ the pressure angle (`docs/theory/cam.md`, eq. 17): least where the path rises at 45°.",
    ),
    code(
        "CAM015",
        "turn",
        "Torque cam: the turn for which the disc is cut, as far as the rollers stand on it, against `requirements.turn`.",
    ),
    code(
        "E0601",
        "the path leaves the reach of a brace",
        "A roller is never further from the axis than its brace is long. With soft springs, or much force over a long stroke, it would have to be. The message names the stroke up to which there is a path.",
    ),
    code(
        "E0602",
        "friction locks the rollers",
        "With `for_friction` the cam is cut so that the force is right in spite of friction in one direction. Where the path is steep against the braces, so much friction locks the rollers: no path gives the force.",
    ),
    code(
        "E0603",
        "springs give no force",
        "The springs have to store the work of the wanted force. Extension springs that are shorter at the start than without force, compression springs that are longer, cannot; nor can springs whose force falls on the way.",
    ),
    code(
        "E0604",
        "a force profile cannot be cut",
        "A profile is a list of travels in rising order with forces above zero. Where the force were zero or less, the springs would have to relax, and the path would turn back.",
    ),
    code(
        "E0605",
        "the motion leaves the stroke",
        "`motion.start` and `motion.start + motion.rise` must lie within `design.stroke`, for which the cam is cut.",
    ),
    code(
        "E0606",
        "the window does not lie in the stroke",
        "`requirements.window` is a smaller and a larger travel within `design.stroke`.",
    ),
    code(
        "E0607",
        "the rollers run into each other",
        "With compression springs the rollers come closer over the stroke. Their centres must stay a roller's radius away from the axis.",
    ),
    code("E0608", "a spring's curve is not one", "A curve of a spring is at least two pairs of length and force, the lengths rising."),
    code(
        "E0609",
        "the cam cannot be drawn",
        "The profile could not be fitted with arcs within `parts.chord_error`, or the cam cannot be cut at all.",
    ),
    code(
        "E0610",
        "a key that the law of the motion does not use",
        "A motion by a law of time has `start`, `rise`, `duration`, and for a repetition `pause` and `return`. After a release the motion follows from `pull`, `hanging_mass` and `damping`; it has `start` and `duration`.",
    ),
    code(
        "E0611",
        "what is let go has no mass",
        "The acceleration of a released slider is force over mass. Give masses in `[design.bodies]`, or hang a mass on it.",
    ),
    code(
        "E0613",
        "a key of the other kind of cam",
        "There are two kinds of cam. With a table `[design.disc]` it is a torque cam: a disc on a shaft with `turn`, `for_torque`, `requirements.torque`. Without it, rollers on straight cams move a slider: `brace_length`, `stroke`, `for_force`, `requirements.force`. A key of the other kind would have no effect, and is refused. Torque cams have no release, no errors of making and no weight.",
    ),
    code(
        "E0614",
        "the outline of the disc does not close",
        "Two equal lobes share a whole turn. From the end of a lobe the outline goes over a nose and straight into a seat, in which the roller of the other lobe rests at the start; no roller uses that part, but it needs room beside the rollers. The message names turns, rollers and a `start_radius` that were tried and leave it.",
    ),
    code(
        "E0615",
        "the shaft does not fit",
        "The hole of `design.disc.shaft_diameter` must lie inside the outline of the disc, which comes nearest to the middle at the seats of the rollers or on the straight part before them. The metric `hub_wall` says how much is left.",
    ),
    code(
        "E0616",
        "a synthesis that does not know torque cams",
        "`synthesise` composes cams with a slider only. Begin with a torque cam that can be cut: `solve` analyses it, `optimise` searches for a better one with `start_radius`, rollers and springs as variables, `tolerance` computes its scatter, and `sweep` analyses any number of them over any keys.",
    ),
    code(
        "E0630",
        "a synthesis needs more",
        "A synthesis of a cam mechanism needs the force (`requirements.force` with its band, or a profile) and the stroke (`requirements.stroke`). What it may use stands in `[synthesise]`: the room, the springs of a catalogue, rollers, the rolling resistance.",
    ),
    code(
        "E0631",
        "a row of the springs' file is no spring",
        "Each row of `synthesise.springs_file` is an extension spring: rate, rest length, largest length above it, and mass.",
    ),
    code(
        "E0632",
        "measured points that are not those of the cam",
        "`errors.measured_profile` takes points on the surface of the cam that was made. They are brought to the designed profile by a rigid motion, found by iterative closest points with Tukey's weights (docs/theory/curves.md); what is left along the normal is smoothed and laid on the exact path. Too few points, points all on one short piece, or points far from the design cannot be used. Give coordinates near those of the drawing: x to the right of the axis, y along the travel, the origin where the path of the rollers starts.",
    ),
    code(
        "W0601",
        "the window holds the undercut",
        "Below the undercut travel the roller turns about a corner, and the force is not the one that was wanted. Begin the window beyond it, or remove the undercut (CAM003).",
    ),
    code(
        "W0602",
        "springs are slack",
        "Springs shorter than their rest length (extension) or longer (compression) are computed with their straight line continued; real ones have no force there.",
    ),
    code(
        "W0603",
        "the slider needs its guide",
        "The force across the travel grows with the distance from the axis in the direction of that distance: a slider without a guide leaves the axis. Guides carry `guide_force_max`.",
    ),
    code(
        "W0606",
        "the window reaches beyond what was measured",
        "A measured profile is known where its points are. Outside, the deviation of the last point is kept, and the force is that of a cam that is shifted there: it says nothing about the cam that was made. Measure the whole profile, or choose a shorter `requirements.window`.",
    ),
    code(
        "W0605",
        "points that do not belong to the profile",
        "Measured points farther than 4.685 robust standard deviations from the design are taken as outliers: dust, burrs, slips of the probe. They do not count. The report lists how many, and how far the rest is from the design.",
    ),
    code(
        "W0608",
        "friction holds the mechanism",
        "Where the path of a torque cam rises less than friction takes (tan φ ≤ μ), the springs do not turn the disc back by themselves: the torque on the way down is not above zero. Less rolling friction, a smaller `start_radius` or more torque help. With a slider it is the force on the way back; there less friction or larger rollers help.",
    ),
    code(
        "W0609",
        "friction locks the start of the travel",
        "Where the path stands nearly across the pull of a brace (or the guide of a disc's roller), rolling resistance turns the force of the cam round: no force, or torque, moves the mechanism from there. At the start of a cam whose springs are not stretched this is so over a short way, μ²A/2 for a constant force; preload, larger rollers or less friction make it shorter. The curves begin where the mechanism moves. Where it locks later, the analysis ends there and says so.",
    ),
    code(
        "W0610",
        "a limit that a search does not see",
        "`[requirements.limits]` names a metric that the design has no value of, such as one of a motion without `[motion]`, or a pressure without materials. A search cannot keep to it, and goes on without it; the design that is found is checked against all requirements. `solve` says why the value is missing.",
    ),
    code(
        "W0604",
        "the rollers slide",
        "More tangential force than friction gives. Sliding rollers wear, and their friction is larger than computed.",
    ),
];
