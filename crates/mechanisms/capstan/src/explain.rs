//! The long story behind every code of this family.

use forcewright_base::diagnostics::Explanation;

const fn code(code: &'static str, title: &'static str, text: &'static str) -> Explanation {
    Explanation { code, title, text }
}

/// Checks `CAPS…`, errors of the design `E07…`, warnings `W07…`.
pub(crate) const CODES: &[Explanation] = &[
    code(
        "CAPS001",
        "cables hold the torque",
        "The torque at which the cables slip over the whole input drum, against `requirements.torque`. Slip zones grow from both spans; where they meet, the ratio of the tensions is exp(μΘ) and nothing more is held (Longval & Gosselin, eq. 7, with both sides compatible: docs/theory/capstan.md). It is exactly in proportion to the preload. Cables that are fastened to the input drum do not slip as a whole; their slack side becomes loose instead.",
    ),
    code(
        "CAPS002",
        "stiffness",
        "Tangent stiffness dτ/dφ at the output under `requirements.torque`, input held, loaded from rest. Slip makes it smaller than that of the free spans, which no friction and no preload can exceed: K ≤ Σ AE/L_f. More preload, more friction, shorter spans, more cables help, in this order of effort.",
    ),
    code(
        "CAPS003",
        "lost motion",
        "After the required torque one way and the other, the output rests at two places at zero torque; their distance is the lost motion. For small torques it is (r₁ + r₂)q²/(2μ AE T_p) along the cable, q half the force: it falls with preload, friction and stiffness. The paper's model has no unloading.",
    ),
    code(
        "CAPS004",
        "limit on a metric",
        "A metric against `requirements.limits`. A metric that has no value is not assessed; the check says what is missing. A limit that is missed says what moves the metric. Load of the shafts, resonance, reflected inertia and backdriving have checks of their own, CAPS015 to CAPS018.",
    ),
    code(
        "CAPS005",
        "strength of the cables",
        "Breaking force over the largest tension under the required torque. A steel cable on a drum keeps only part of its strength (Carl Stahl Sava's table, by D/d); that is taken off. With `requirements.safety_factor` it is required; without, it is held against 1, where the cable breaks. A thicker cable on the same drums is bent more: the advice counts that. Practice asks for 3 to 8, more where people depend on it.",
    ),
    code(
        "CAPS006",
        "drum over cable diameter",
        "A cable that is bent sharply tires early: the ratio of the smaller drum's diameter, to the middle of the cable, to that of the cable, against the least ratio of its construction. For steel 7×19 that is 18, for 7×7 28, for braided fibre 8 (docs/reference/cables.md).",
    ),
    code(
        "CAPS007",
        "slack side stays taut",
        "The smallest tension under the required torque, in the middle of the travel and at its ends. A cable without tension leaves its groove. A cable that is fastened to the input drum does not slip as a whole; for it this is the limit, and required.",
    ),
    code(
        "CAPS008",
        "slip ends before the terminations",
        "At the end of the travel the wrap before a termination is shortest, `output_anchor_wrap`. If slip reaches the termination there, the drive is stiffer than elsewhere, and the anchor feels changes of the tension.",
    ),
    code(
        "CAPS009",
        "fleet angle",
        "The angle between a span and its groove. It is zero where (1 + R) inv γ = kπ, with the second group of grooves turned by their own phase, or with the right ratio of radii; otherwise the cable climbs one flank. Smooth drums have no grooves: there it is the angle of the helix, which pitch and input drum make. Against 1.5°, makers' rule for smooth running.",
    ),
    code(
        "CAPS010",
        "turns do not touch",
        "The smallest gap between the surfaces of neighbouring turns, of one cable or of two, on both drums and between passing spans, over the whole travel.",
    ),
    code(
        "CAPS011",
        "grooves do not run into each other",
        "The axial distance of different grooves against the width of a groove at the surface. A second group with a phase of its own cuts between the lines of the first; where both are on the same stretch of the drum, they need room.",
    ),
    code(
        "CAPS012",
        "radius of the seat",
        "A seat narrower than the cable pinches it, one that is too wide flattens it: 0.53 of the diameter is usual; at 0.6 a steel cable endures two thirds as many bends (Feyrer 2015).",
    ),
    code(
        "CAPS013",
        "drums clear each other",
        "The gap between both drums on the line of centres, to the surface of the cables, or of the lands where `groove.depth` makes them stand higher than the cable.",
    ),
    code(
        "CAPS014",
        "slip ends before the pin",
        "A cable that is fastened to the input drum in the middle of its wrap unwinds towards the pin on one side as the drive turns: at the ends of the travel only (Θ − Rτ)/2 of the wrap Θ is left there. Where the angle |ln(T/T_p)|/μ that slip needs is larger, the pin carries part of the change of the tension.",
    ),
    code(
        "CAPS015",
        "load of the shafts",
        "The largest load of a shaft by the cables, at rest or under the required torque, against `requirements.limits.shaft_load`: what its bearings and the frame carry. The load at rest is 2 ΣT_p sin γ; under a torque √((ΣT₀ + T₁)² sin²γ + F² cos²γ).",
    ),
    code(
        "CAPS016",
        "resonance",
        "The torsional frequency against `requirements.limits.torsional_frequency` (input held) or `torsional_frequency_free`: √(K/J)/2π with the tangent stiffness under the required torque. Not assessed without `[inertia]`.",
    ),
    code(
        "CAPS017",
        "reflected inertia",
        "What is felt at the output, J_out + R² J_in, against `requirements.limits.reflected_inertia_output`. Not assessed without `inertia.input` and `inertia.output`.",
    ),
    code(
        "CAPS018",
        "backdriving",
        "The torque at the output that turns the drive with the input free, or the efficiency backwards, against `requirements.limits.backdrive_torque_output` or `efficiency_backward`. Bearings under the load of the cables, bending of the cables and drags make it; not assessed while one of them is not known.",
    ),
    code(
        "CAPS020",
        "wall of a drum",
        "What is left between the bore and the deepest place of a drum: the bottom of the grooves, the slot of an undercut, or the relief between two groups. It is held against the diameter of the cable, a rule of thumb; `parts.input_bore` and `parts.output_bore` set the bores.",
    ),
    code(
        "CAPS021",
        "land between grooves",
        "The width of the land between neighbouring grooves at the surface, against `parts.least_wall`, the least wall that the process leaves. Without it against 0.2 mm, which is our choice for turned metal and not required; printers need about two widths of their nozzle.",
    ),
    code(
        "CAPS022",
        "pin on the input drum",
        "A cable that is fastened to the input drum must lie over its pin at both ends of the travel: the wrap, 2π(n + 1) − 2γ, must be at least the turn of the input, R times the travel of the output.",
    ),
    code(
        "E0701",
        "no such drive",
        "The drums overlap, or a number of the geometry is out of its range. The centre distance must be larger than both radii to the middle of the cable together. A `groove.depth` whose lands reach the other drum is E0702.",
    ),
    code(
        "E0702",
        "the section of the grooves",
        "`profile = \"round\"` needs `seat_angle` (or, with `pressure = \"table\"`, a `pressure_table` of ascending angles from the bottom), `\"v\"` needs `angle`, `\"undercut\"` needs `seat_angle` and `undercut`, `\"flat\"` nothing. Keys of another section are refused.",
    ),
    code(
        "E0703",
        "a cable that is not complete",
        "A cable needs a diameter and an axial stiffness: from the catalogue, `use = \"steel 7x19 1.5 mm\"`, or typed. The catalogue leaves out what no source gives: the stiffness of braids must be measured. All cables of a drive have one diameter, as their grooves have.",
    ),
    code(
        "E0704",
        "groove lines",
        "`lines` are the groove lines of a cable's two ends on the output, counted from 0. A cable with n extra turns comes back n + 1 lines further (one or more besides where the spans are long). No two cables begin on the same line.",
    ),
    code(
        "E0705",
        "the paper's model and unequal cables",
        "The model of Longval & Gosselin gives both sides the same change of tension; with cables of different preload or stiffness that says nothing about how they share the torque.",
    ),
    code(
        "E0706",
        "preload",
        "Bedding in, creep and a change of the temperature leave no preload, or what they leave is not known: a change of temperature needs the expansion of drums and frame and that of the cables.",
    ),
    code(
        "E0707",
        "a travel that unwinds a fastened cable",
        "With `input_hold = \"fastened\"` the cable is pinned in the middle of its wrap on the input. While the output turns by its travel τ, the input turns by Rτ, and the pin moves towards one span and away from the other: (Θ − Rτ)/2 of the wrap Θ is left at the ends. It must be above 0: less travel, more `extra_turns`, a smaller ratio, or `input_hold = \"friction\"`.",
    ),
    code(
        "E0708",
        "too many cables",
        "All cables lie side by side on the one helix of the input drum, and each pair of neighbours is looked at over the travel: more than 32 are refused.",
    ),
    code(
        "E0730",
        "no such drum",
        "The drums cannot be turned as drawn: grooves that leave no land between, a bore that leaves no wall, a groove deeper than the drum. The message names the number; `[parts]` and `design.groove` set it.",
    ),
    code(
        "E0731",
        "two groups of grooves on one stretch",
        "A `groove_phase` turns the grooves of the second ends against those of the first. Where both lie on the same stretch of the output drum they would cut through each other. More `extra_turns` or less travel separates the stretches; without a phase, at a centre distance where the spans are in line, there is one set of grooves for both.",
    ),
    code(
        "E0720",
        "a synthesis needs more",
        "A synthesis of a cable drive needs `requirements.torque` at the output, and in `[synthesise]` the `ratio`, the `travel` of the output and the `friction` of the cable on the drums. The envelope, cables, drums, turns and bearings that it may use stand there too.",
    ),
    code(
        "E0721",
        "no such cable for a synthesis",
        "Each of `synthesise.constructions` is one of the catalogue of which stiffness, strength and least drum are known in one of `synthesise.cable_diameters`. Galvanised cables have the strengths of listed sizes only; strand does not belong on drums; of braids the stiffness must be measured.",
    ),
    code(
        "E0722",
        "not part of a synthesis",
        "A synthesis computes with the corrected model at the temperature of assembly. Add the paper's model or a change of temperature to the files written, and look at what `solve` says.",
    ),
    code(
        "E0723",
        "a limit that a synthesis cannot test",
        "A limit on a metric that has no value for any design of the synthesis can never be met: backdriving and efficiency need `bending_loss` and the `bearings` of `[synthesise]`, frequencies and reflected inertia need `[inertia]`. The message names the keys that are missing.",
    ),
    code(
        "W0701",
        "a groove with much friction",
        "A factor near π/2 needs a full half circle under uniform pressure. Seats of 120 to 150° that are worn in give 1.17 to 1.36.",
    ),
    code(
        "W0702",
        "slip reaches a termination",
        "The cable slips over the whole of a wrap: on the output drum up to its anchor, or on the input drum up to the pin to which it is fastened.",
    ),
    code(
        "W0703",
        "backdriving is not assessed",
        "The torque that turns the output with the input free comes from the bearings under the load of the cables and from bending the cables. Give `design.bearings` and `bending_loss`: nothing is guessed.",
    ),
    code(
        "W0704",
        "the cable lands beside its groove",
        "More than a quarter of a pitch. Another centre distance, a phase of the second group, or other radii bring it in line.",
    ),
    code(
        "W0705",
        "helices and ratio do not fit",
        "With as many helices as the ratio of the radii, to the nearest whole number, neighbouring lines on the output are about as far apart as on the input.",
    ),
    code("W0706", "a loose cable", "The slack side carries nothing: the cable leaves its groove, and the taut side works alone."),
];
