//! The long story behind every code of this family.

use forcewright_base::diagnostics::Explanation;

const fn code(code: &'static str, title: &'static str, text: &'static str) -> Explanation {
    Explanation { code, title, text }
}

/// Checks `COMP…`, errors of the design `E05…`, of what studies ask of it `E03…`, warnings `W05…`.
pub(crate) const CODES: &[Explanation] = &[
    code(
        "COMP001",
        "force band",
        "The project asks for a force that stays within `requirements.force.band` of a level over a stroke of `requirements.travel`. The check slides a window of that length over the travel, takes the largest |F/level − 1| inside it, and reports the smallest value found. Without `nominal` the level is free and the value is (max − min)/(max + min), the half width of the narrowest band around the window.\n\nA miss whose own level is the problem is mended by `design.depth`, to which the force is proportional; a miss with a free level needs another shape.\n\nCompanion: COMP003, which fixes the band and asks for the stroke.",
    ),
    code(
        "COMP002",
        "stress",
        "Largest stress over all beams, both faces, and the whole travel, against the yield stress over `requirements.stress.safety_factor`, or against `requirements.stress.max`; without either against the yield stress itself, where it is known. σ = (E·w/2L)·d(ψ − η)/du (Lan, Wang & Chen 2010, eq. (5)); the geometrically exact model adds the axial stress N/A.\n\nBending stress follows the thickness w at equal deflection, force follows w³·t. So a thinner and deeper beam carries the same force with less stress: w × 0.85 and t × 1.628 is the paper's own example.\n\nNot assessed where the yield stress is not known.",
    ),
    code(
        "COMP003",
        "usable stroke",
        "Longest displacement interval on which the force stays inside the band (`band_start` to `band_end` around a nominal force, `flat_start` to `flat_end` with a free level), against `requirements.travel`.",
    ),
    code(
        "COMP004",
        "least stiffness",
        "Smallest slope dF/dΔ over the travel against `requirements.stiffness.min`, 0 by default. Where the slope is negative, a device driven by a force (a weight, a soft actuator) jumps; driven by a stiff displacement it does not, and a small negative slope can be allowed on purpose, as in the paper's mechanism (−0.02 N/mm).\n\nThe slope is computed from the tangent of the equilibrium equations, not by differences.",
    ),
    code("COMP005", "largest stiffness", "Largest slope dF/dΔ over the travel against `requirements.stiffness.max`."),
    code(
        "COMP006",
        "limit on a metric",
        "`[requirements.limits]` bounds any metric by its name. A metric that the design does not have is *not assessed*, which does not count as met.",
    ),
    code(
        "COMP007",
        "envelope",
        "Smallest distance of the surfaces of the beams to the sides of `requirements.envelope`, at rest and over the travel; negative where a beam sticks out. The copies in the drawn plane count: mirrored half, rows, and of legs around an axis the one opposite to the drawn one. With `of = \"drawn\"` it is the drawn network alone. Layers in series are each in the box by themselves, since their distance is not known. Blocks and clamps are not looked at.\n\nA beam is all that is within half its thickness of its axis, as for `clearance_min`: its ends are round, and a beam that ends on a side sticks out by half its thickness there. Draw the side half a thickness behind the clamps. The design box of Lan, Wang & Chen 2010 (Table 1, constraint (ii)) holds the axes, with n1, n2 and n5 on its sides; to ask for the same, widen it by half the thickness.",
    ),
    code(
        "COMP008",
        "layers in series move alike",
        "Layers in series carry the same force and share the displacement. That all move alike is an equilibrium, but a stable one only while the force of a layer rises with its displacement: where it falls, one layer runs ahead and the others spring back, smoothly or with a jump. Found by following the layers slowly from minimum to minimum of their energy Σ W(δᵢ) at Σ δᵢ = Δ, with an imperfection of a millionth of the travel; the value is the displacement at which they differ by more than 1 % of the travel of one.\n\nBeyond, the force stays between the smallest and the largest that the curve of one layer has there, but positions jump and the way back differs from the way forth: the report shows both. The metrics are those of layers that move alike. Shapes whose force never falls (`stiffness = { min = \"0 N/mm\" }`) do not part.",
    ),
    code(
        "COMP009",
        "fatigue",
        "`requirements.fatigue = { cycles = 1e6, safety_factor = 1.3 }` asks for so many ways from rest through the travel and back. Every fibre, on both faces of every beam and at all places along it, goes through a range of stress between the lowest and the highest that it has on the way: amplitude σ_a, half of it, and mean σ_m. The check reports the smallest n of 1/n = σ_a/S_e + max(σ_m, 0)/R_m: Goodman's line (J. Goodman, Mechanics Applied to Engineering, 1899; the modified Goodman line of Budynas & Nisbett, Shigley's Mechanical Engineering Design, chapter 6). R_m is the tensile strength, S_e the amplitude endured without a mean stress, by the same line from the amplitude and stress ratio of the data. A mean in compression counts as none.\n\nData are those of the catalogue or `material.fatigue = { amplitude = \"31 MPa\", cycles = 1e6, ratio = -1 }` and `material.tensile_strength`. Fewer cycles than tested are judged by the stress endured in the test. Not assessed without an endured stress, for more cycles than it is known for, and without a tensile strength.\n\nData are of smooth specimens: notches, milled or printed surfaces, corners of joints, temperature and the scatter of lives are not in them, and a typical value is that of half of the parts. The safety factor is for these.",
    ),
    code(
        "COMP010",
        "force left under a lasting displacement",
        "`requirements.hold = { time = \"1000 h\", force_left = \"40 %\" }`: a displacement is held at room temperature for that time. Plastics creep, and of the force at that displacement there is left about E_c(t)/E, the creep modulus (stress over the strain after a time, ISO 899-1) over Young's modulus. At all displacements alike: force goes with the modulus as long as all beams are of one material. The catalogue has creep moduli at some times; between two the modulus is taken as linear in the logarithm of time, outside it is not assessed. Both moduli are those of the catalogue, also where the project overrides `young_modulus`.\n\nStrictly what a held displacement needs is the relaxation modulus, which is a little lower than the creep modulus: by less than 2 % for a modulus that halves in three decades of time (a power law t⁻ⁿ has sin(nπ)/(nπ)). Creep moduli are measured at small strain; at high stress plastics creep more.\n\nMetals do not creep at room temperature: all of the force is left. Springs under high stress still settle by some per cent, which is not in this. Not assessed: materials without data, beams that creep differently, and given forces, under which a displacement grows instead.",
    ),
    code(
        "COMP011",
        "thinnest wall of the part",
        "The diameter of the smallest circle that fits into the material between two faces of the outline, holes included, against `process.wall_min`. Beams are as thick there as the design says; walls between a hole and an edge count too.",
    ),
    code(
        "COMP012",
        "narrowest gap of the part",
        "The diameter of the smallest circle that fits into what is cut out, between two faces of the outline, against `process.gap_min`, or the diameter of the cutter. Corners sharper than the cutter are filled by fillets before.",
    ),
    code(
        "COMP013",
        "pads against what moves",
        "Smallest distance, at rest and over the travel, of the surfaces of beams and blocks to the pads and blocks of the part: those where nodes are held and where rigid bodies are, as large as `[parts]` says. A beam is not compared with what it ends in, nor a block with another one that moves like it; the mirrored half and the neighbouring rows count. Negative where they overlap: the part would stop there, before the end of its travel.\n\nRequired where the file has a section `[parts]`, and of every part that is exported; otherwise a further check with pads of the usual size. Looked at in 33 states, with 32 chords per beam and the thickness of its thickest place.",
    ),
    code(
        "E0501",
        "position of a node unknown",
        "A node has `at`, or it is joined by a beam with `angle` and `length` to a node whose position is known.",
    ),
    code(
        "E0502",
        "a beam does not fit between its nodes",
        "A beam given by `angle` and `length` must end where its node is; a beam joins two different nodes, and not two of one rigid body. Printed nodes and shapes are usually rounded and do not close exactly: give one of the two and let the other follow. With `bend`, c0 and the length follow from the nodes, so such a beam always closes.",
    ),
    code(
        "E0503",
        "impossible shape",
        "The bend coefficients make the beam close on itself, so that it cannot span its two nodes, or the nodes lie on each other.\n\nPoints of `through` give the smooth shape with as many bend coefficients as there are points, whose axis meets all of them in order: one point gives an arc. Between two points the curve must run forward from the one to the other, less than a quarter turn off; points that zigzag need coefficients that cancel each other, and are refused.",
    ),
    code("E0504", "slider and direction", "A slider needs the direction in which it moves; only sliders have a direction and a rotation."),
    code(
        "E0505",
        "the network can move freely",
        "A part of the network could move as a rigid body without any beam bending. Clamp or pin one of its nodes, or join it to the rest.",
    ),
    code(
        "E0506",
        "the load cannot move its node",
        "The support of a loaded node does not allow a motion along the `direction` of the load, or holds its angle where a load would turn it.",
    ),
    code("E0507", "not a mirror line", "Mirror lines are parallel to an axis: `x = 0`, `y = 2 mm`."),
    code("E0508", "the load leaves the mirror line", "The two halves move alike only if the load moves along the mirror line."),
    code("E0509", "the network cannot be solved as described", "The engine refuses a value or a combination; the message says which."),
    code(
        "E0511",
        "something on the mirror line",
        "A node on the mirror line can neither leave it nor turn, because the mirrored half pulls the other way. The half that is solved must be held accordingly: a slider along the line with fixed rotation, or clamped. A beam on the line would be counted twice.",
    ),
    code(
        "E0512",
        "too little of a beam is left to bend",
        "With `model.joints = \"overlap\"` a beam is rigid as far as it lies inside the other beams at its nodes. Of this one less than a twentieth is left: the beams are too thick for their length, or leave a node nearly side by side, where the blocks that they form grow long.",
    ),
    code(
        "E0513",
        "a node is moved twice the same way",
        "Loads are carried out in order, and each is held at its end: what has been moved stays there. A second load cannot move the same node along the same direction, nor at another angle than a right one, nor turn it twice. Forces and moments may act on one node as often as they like.",
    ),
    code(
        "E0510",
        "a loose node",
        "No beam ends at this node, or at any node of this body. Within a body a node that no beam ends at is welcome: it can be loaded, like the end of a lever.",
    ),
    code(
        "E0514",
        "a node is named twice by bodies",
        "`[design.bodies]` joins nodes into rigid bodies, such as `block = { nodes = [\"n5\", \"n7\"] }`. A node is in one body at most, and once: two bodies that share a node would be one body.",
    ),
    code(
        "E0515",
        "a body is held or loaded at two places",
        "A body that keeps its angle (`clamped`, `parallel`, a slider that does not turn) only shifts: all of its nodes move alike, and it may be held as a whole and loaded at any of them. A body that can turn moves otherwise at each of its nodes. There, one node is the reference: the one with the support, else the one that is loaded. A support or a load at another node, or a second support, is not available; moments and rotations may be written at any node.\n\nWays out: load the node that is held, or keep the body from turning, or draw a part of the body as a short thick beam of a stiff material.",
    ),
    code(
        "E0314",
        "a node does not lie on its line",
        "A node with `on = { line = [[\"x\", \"y\"], [\"x\", \"y\"]] }` stays on the straight line between these two points when a study moves it: one number, from 0 at the first end to 1 at the other, stands for both coordinates. So the line has two ends, which differ, and `at` lies between them, to a millionth of its length.\n\nWhere `[optimise.variables]` gives ranges to the coordinates, the node also stays within those.",
    ),
    code(
        "E0316",
        "the load does not suit a study",
        "Optimisation and tolerance analysis compare force curves over the same displacements, from rest. So the project has one load, and it prescribes a displacement: `travel`. Designs that are driven by a force, a moment or a rotation, or that are loaded before, are analysed by `solve` and by `sweep`.",
    ),
    code(
        "W0501",
        "a beam is not slender",
        "Beam theory neglects what happens near the ends of a beam. Below a length of about ten times the thickness its error is no longer small; compare with a solid model.",
    ),
    code(
        "W0502",
        "a beam is strongly curved",
        "In a curved beam the stress at the inner face is larger than in a straight one, by about a third of thickness over radius. The computed stress is that of a straight beam; the metric `stress_inner_face` has the correction, and `requirements.limits.stress_inner_face` limits it. Designs of `forcewright synthesise` keep such a limit.",
    ),
    code(
        "W0503",
        "the mechanism would jump under a dead force",
        "The curve has a local maximum: a device that is loaded by a growing force and not by a displacement jumps from there to the next place with the same force.",
    ),
    code(
        "W0504",
        "stress beyond yield",
        "Beyond the yield stress the material is no longer linear; the real force is lower and the part keeps a deformation.",
    ),
    code(
        "W0505",
        "few stations for this curve",
        "Forces at the stations are accurate as stated, but values found between them (limits of ranges, extrema) are interpolated and less accurate.",
    ),
    code(
        "W0506",
        "the computed state is unstable",
        "With the displacement of the load held, the network could still lower its energy by moving sideways: at the named displacement the path bifurcates, as a straight column does at its buckling load. The computed curve is an equilibrium, but a real part, which is never perfectly symmetric, leaves it. Give the design a small imperfection (a bend, a shifted node) to follow the branch that the part takes.",
    ),
    code(
        "W0508",
        "beams cross",
        "The axes of two beams, of a beam with itself, or of a beam with the mirror line (and so with the other half) intersect. In a plane part that is contact, which is not modelled: the curve holds only up to the named displacement. Only axes are tested; beams of finite thickness touch a little earlier.",
    ),
    code(
        "E0518",
        "no part in one piece",
        "The drawn beams, pads and blocks make no plate that can be cut in one piece: something turns on a hinge or a bearing, a fillet does not fit between two beams, or material runs into other material. The message names the place.\n\nWhere the halves of a mirrored layout meet at the load node they are joined directly. A clamped node or a rigid body on the mirror line would need a pad or a block without width: draw the beams up to its sides.",
    ),
    code(
        "E0519",
        "a fillet smaller than the cutter",
        "A cutter leaves at least its own radius in an inner corner. `parts.fillet` may be larger than that, or left out.",
    ),
    code(
        "E0516",
        "copies that cannot move alike",
        "Rows, planes around an axis, plates and layers are joined by a block. They move alike only if that block moves along the load without turning; so the load node must be held as it is there: a slider along the load with fixed rotation.",
    ),
    code(
        "E0517",
        "parts of a layout that exclude each other",
        "`circular` turns the drawn network round an axis along the load; its copies include the opposite one, so a mirrored half or rows beside it would stand in the way of each other. Layers in series carry each other's block, which a moment or a rotation would turn by an amount that depends on the others.",
    ),
    code(
        "W0515",
        "copies run into each other",
        "Rows, mirrored halves or planes around an axis are so near to each other that their beams would overlap, at rest or on the way. Contact is not modelled. Give `array` a larger `spacing`, `circular` a larger `radius` or fewer copies, or make the plates less deep. `clearance_min` is how far they are apart.",
    ),
    code(
        "W0514",
        "layers in series part",
        "Where the force of a layer falls with its displacement, layers in series do not move alike: one runs ahead. See `explain COMP008`.",
    ),
    code(
        "W0510",
        "the whole would sway without a guide",
        "A mirrored mechanism is solved as one half, which moves symmetrically. Free to move sideways and to turn, with the displacement along the load held, the block between the halves stays in the middle only while its stiffness against both is positive: k_xx of the sideways motion, k_θθ of the rotation, and k_xx·k_θθ − k_xθ². From the named displacement on it is not: a part whose block runs in a guide follows the curve, one without a guide tips over to a side.\n\nThe metric `lateral_stiffness_min` is twice the half's k_xx − k_xθ²/k_θθ. A block that joins two load nodes beside the line is taken as rigid and as pushed at their height.",
    ),
    code(
        "W0509",
        "a material that no beam is of",
        "`[material.<name>]` describes a material for beams that say `material = \"<name>\"`. None does: perhaps the name is misspelt, or the line at the beam is missing.",
    ),
    code(
        "W0511",
        "a requirement that a study does not look at",
        "Studies compute what they need many thousand times, and leave out what would need the whole analysis. A search checks such a requirement at its end, in the full analysis of the design found. A tolerance analysis does not count it: its yield is that of all other requirements. `solve` checks everything.",
    ),
    code(
        "E0520",
        "not the profile of a surface",
        "`scenario.surface.profile`, or the file of `profile_file`, gives the height of a surface at ascending transverse positions, at least two. Each position stands once: a tip climbs no vertical step, so write the slope that the edge has, or give the tip a `tip_radius` and the step a width.",
    ),
    code(
        "E0521",
        "a scenario that the design cannot play",
        "Along a surface the mechanism follows its force curve from rest. So there is one load, it prescribes a displacement (`travel`), and its node is held as the linear bearings of the tip hold it: `support = \"slider\"` along the load, without turning.\n\nA lateral motion, `[scenario.lateral]`, takes along the guide of the tip. It too has one load that prescribes a displacement, on a node with `support = \"slider\"` along the load; that may turn (`rotation = \"free\"`). Copies must all go the same way: mirrored halves, legs around an axis and layers in series do not, so draw the whole mechanism.",
    ),
    code(
        "W0520",
        "the tip locks",
        "Where the surface rises steeply, friction in the bearings and at the tip grows with the transverse force faster than that force lifts the tip. With the friction μ of the tip and the drag m of the guide (the coefficient of its bearings times 1 + 2a/b for two of them at a distance b, the tip a beyond) the steepest rise is tan α = (1 − m·μ)/(m + μ); beyond it no transverse force moves the stage, however large. Curves end there, metrics of the contact have no value, and limits from above on them are missed.",
    ),
    code(
        "W0521",
        "the tip does not touch",
        "The surface lies lower than the tip of the unloaded mechanism reaches. The contact force is zero there; smallest force, mean and spread are those of the way in contact, at whose ends the force goes to zero.",
    ),
    code(
        "W0522",
        "the surface is too high",
        "Preload and height add up to more displacement than the path of the mechanism has: beyond its `travel`, beyond the place at which a real part leaves the path, or beyond that at which layers in series part. The metrics of the contact have no value.",
    ),
    code(
        "W0523",
        "the mechanism lets go of the surface",
        "The force over the displacement changes its sign: the mechanism would pull its tip away and come to rest in another shape. The metrics of the contact have no value.",
    ),
    code(
        "W0524",
        "the map of a lateral motion has gaps",
        "At every lateral displacement δ the tip is first moved across the load, free along it, and then pushed along it. The message names the first δ at which that does not lead to every Δ of the map: the mechanism snaps, a beam is pulled straight, or the states become unstable although both displacements are held, so that a real part leaves the computed shape. Metrics of the map have no value where a place of its window is missing; figures show what was reached.\n\nStrips that carry a tip whose angle is held must be parallel: others lock, and buckle.",
    ),
];
