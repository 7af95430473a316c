//! The long story behind every code of this family.

use forcewright_base::diagnostics::Explanation;

const fn code(code: &'static str, title: &'static str, text: &'static str) -> Explanation {
    Explanation { code, title, text }
}

/// Checks `LAVT…`, errors of the design `E08…`, warnings `W08…`.
pub(crate) const CODES: &[Explanation] = &[
    code(
        "LAVT001",
        "Torque at which it shifts",
        "Torque at the output at which the spring reaches the bore and mode I ends: R τ_t/(1 − R), with τ_t = EI δ_b/(r (r + δ_b)). It must lie above what the hand needs to close on nothing - friction, glove - or the fingers are slow from the beginning. A spring that slips first is judged by the torque at which it slips. Judged as drawn, and over the range of friction and the corners of the tolerances.",
    ),
    code(
        "LAVT002",
        "Torque at the output",
        "Torque at the output with the required torque at the input, τ_in/R − τ_b less losses, as far as the bore holds. A spring that slips before it shifts, or a bore that lets go, limits it to less. Judged as drawn, and over the range of friction and the corners of the tolerances: a hub that is tighter, or whose friction is larger, slips later and takes more.",
    ),
    code(
        "LAVT003",
        "Speed in mode I over mode II",
        "1/R = 1 + Z_ring/Z_sun. The paper prints ω_I/ω_II ≥ 5; its reason, not to lose the sense of control while grasping, asks for at most 5.",
    ),
    code(
        "LAVT004",
        "Efficiency",
        "Power at the output over power at the input in mode II, 1 − R τ_b/τ_in, less losses. The slip of the spring on the hub costs the torque τ_b at any load. Judged as drawn, and over the range of friction and the corners of the tolerances.",
    ),
    code("LAVT005", "Limit on a metric", "A limit of `[requirements.limits]`, on any metric by its name."),
    code(
        "LAVT006",
        "Shifts before it slips",
        "The spring must reach the bore (τ_t) before it slips on the hub (τ_b). With finite turns τ_b = M_A (1 − exp(−2π (N_A − 0.2) μ)): less than the moment M_A of the interference, and a free end costs 0.2 turn. With δ_a = δ_b, configuration 1 of the paper, no friction is enough: what was built is a torque limiter. The paper's eq. (25) does not see it.",
    ),
    code(
        "LAVT007",
        "Shifts with the least friction and the worst gaps",
        "The same at the corners of the tolerances of wire, spring, hub and bore, with the least friction. What counts is δ_a − δ_b = (hub − bore)/2 + wire: the diameter of the spring cancels. A tenth of a millimetre decides.",
    ),
    code(
        "LAVT008",
        "Bore holds the input torque",
        "In mode II the ring pulls on the bore with τ_in (1 − R)/R. The bore has bent the coil to its own curvature, so only what exceeds τ_t presses on it: τ_S − τ_t ≤ (τ_b − τ_t) exp(2π N_B μ). The paper's eq. (28) takes the whole of τ_b and promises four times as much; a curved beam in frictional contact confirms the smaller value. Judged as designed, and at the worst corner of the tolerances with the least friction.",
    ),
    code(
        "LAVT009",
        "Hub holds the input torque in the opening direction",
        "When the hand opens, the torque tightens the spring on the hub, which holds M_A (exp(2π N_A μ) − 1), eq. (29), and mode I stays. Only needed if the hand opens against the full torque; usually it does not, and the check is advice.",
    ),
    code(
        "LAVT010",
        "Stress of the wire",
        "Largest bending stress on the hub or in the bore, with the factor of the curved wire, against 0.7 of the least tensile strength (EN 13906-3). Without `requirements.safety_factor` a factor of 1 is asked for, as advice.",
    ),
    code(
        "LAVT011",
        "Coil is supported up to the ring",
        "A coil between the bore and its end at the ring carries the whole torque of the clutch alone: 4257 MPa at 400 N·mm in the paper's design. So the bore must reach up to the ring, `unsupported_turns = 0`.",
    ),
    code(
        "LAVT012",
        "Planets keep clear of each other",
        "Gap between the tip circles of neighbouring planets, 2 a sin(π/N) − 2 r_a; half a module is kept.",
    ),
    code(
        "LAVT013",
        "Teeth are not undercut",
        "Profile shift of sun and planets above the least without undercut, x = h − (z/2) sin² α with the depth h of the straight flank of the rack. Undercut teeth are weaker and have a shorter flank; they run.",
    ),
    code(
        "LAVT014",
        "Teeth do not interfere",
        "The least room between flanks, fillets, roots and tips of planet, ring and sun: involute, trochoid and trimming interference, corners of tips in fillets, bottom clearance; and the thickness of tips and of spaces of the ring, which must not be pointed. The paper's unshifted 12, 18, 48 teeth meet at the ring. Shift the profiles or shorten the tips.",
    ),
    code(
        "LAVT015",
        "Contact ratio",
        "Length of the path of contact between tips, form circles and interference points over the base pitch. Below 1 a pair of teeth lets go before the next one meets; 1.1 is kept for errors of making.",
    ),
    code(
        "LAVT016",
        "Bending of the teeth",
        "Lewis' bending stress at the root, the whole load at the tip of one tooth of the most loaded planet, without dynamics or stress concentration, against `material.gears.bending_strength`.",
    ),
    code(
        "LAVT017",
        "Pressure between flanks",
        "Hertz pressure at the pitch point of the most loaded planet against `material.gears.flank_strength`.",
    ),
    code(
        "E0801",
        "Gears without a common axis",
        "Sun, planets and ring turn about one axis if the ring has as many teeth as the sun and twice a planet; profile shifts make up for one or two.",
    ),
    code(
        "E0802",
        "Planets that cannot be put in",
        "Equally spaced planets go between sun and ring if the teeth of both together are a multiple of their number. The paper asks for (sun + planet), which is too strict for even numbers.",
    ),
    code(
        "E0803",
        "Spring loose on the hub",
        "The hub must be larger than the inner diameter of the free spring: its interference makes the friction.",
    ),
    code(
        "E0804",
        "Spring already in the bore",
        "The bore must be larger than the outer diameter of the free spring: the gap sets the torque of the shift.",
    ),
    code(
        "E0805",
        "Coil that cannot be wound",
        "Mean diameter over wire diameter below 4: the wire breaks in coiling, and thin-wire mechanics do not hold.",
    ),
    code(
        "E0806",
        "Wire that is not known",
        "The grade is not in the catalogue, its diameter is outside of the standard, or no stiffness is given.",
    ),
    code(
        "E0807",
        "Hand or motor that is not complete",
        "A lever and a table of levers exclude each other; the first column of a table must rise; a voltage must end above zero; an object must go into the open hand.",
    ),
    code(
        "E0808",
        "More turns in the bore than off the hub",
        "`free_turns` counts all turns off the hub, which open together until the bore is reached; those in the bore are among them.",
    ),
    code(
        "LAVT018",
        "Shifts back when the load is gone",
        "In mode II the bore lets go when the output falls below τ_t/(1 − R) − τ_b. If that is below zero, a hand that has grasped stays slow even without load while the motor pushes, until the torque at the input falls below that of the shift. A hub that is much tighter than the bore is wide grips well and does this; it is a choice, so the check is advice.",
    ),
    code(
        "LAVT019",
        "Teeth go in",
        "Backlash of both meshes at the distance at which sun and planets, with full teeth, have no play. Profile shifts must bring both meshes to one distance: for ring = sun + 2 planet, x_ring = x_sun + 2 x_planet is near it.",
    ),
    code(
        "LAVT020",
        "Walls beside holes",
        "Material between the hole of a gear and the roots of its teeth, and between the holes for the pins and the middle one of the carrier; a module is kept.",
    ),
    code(
        "LAVT021",
        "Speed of the motor",
        "Largest speed of the motor in the simulated closing against `motor.max_speed`, which its maker gives for brushes and bearings. Before the object is touched a motor turns almost as its voltage over its torque constant has it; only a lower voltage, or another motor, turns more slowly.",
    ),
    code(
        "LAVT022",
        "Force of the grasp",
        "Force on the object in the end of the simulated closing against `hand.force`. A motor that stalls, or a clutch that slips, stays below it; the times and energies are then those of the weaker grasp, so that a search must keep to it.",
    ),
    code(
        "E0820",
        "Part that cannot be made",
        "A gear whose teeth cannot be drawn - pointed, without flank, below the base circle - a bore that leaves no wall, or a friction ring without room for its bolts.",
    ),
    code(
        "E0830",
        "Run of the bench that cannot be used",
        "The torque at the input varies within a turn, so its mean is taken over whole turns: each mass needs at least one, counted upwards, with at least four rows in each turn; a quarter of a turn between rows is the most. Masses are not negative. Leave `turn` out of `[measurements.bench]` if turns were not recorded; then the mean is that of all rows.",
    ),
    code(
        "E0831",
        "Too few masses",
        "A line with an interval needs three masses; the shift between both modes is found with three in each.",
    ),
    code(
        "E0840",
        "A synthesis lacks a requirement",
        "A synthesis needs `requirements.input_torque` and the friction of the spring, `synthesise.friction = \"0.15 ± 0.03\"`, with its range: designs keep to everything at both ends of it. Without a range half of what is found would slip.",
    ),
    code("E0841", "A range of the grid that cannot be", "A range in `[synthesise]` ends before it begins, or has more than 2000 values."),
    code(
        "E0842",
        "No tolerance of a diameter",
        "`synthesise.tolerances.hub` and `bore` are ISO fits, `\"h7\"`, or half widths, `\"0.01 mm\"`. They are written behind the diameters of the files, and their corners are kept.",
    ),
    code(
        "E0843",
        "Strength of a wire that is not known",
        "EN 10270-1 has strengths for 0.3 mm to 20 mm, and they depend on the diameter. Leave other wires out of `synthesise.wire_diameters`, or give `material.spring.tensile_strength` for all.",
    ),
    code(
        "E0844",
        "A limit that cannot be known",
        "A limit in `[requirements.limits]` is on a metric that no design of this file has, as motor, hand or materials are missing. Nothing could ever be found, so the synthesis does not begin.",
    ),
    code(
        "E0845",
        "The paper's model in a synthesis",
        "With `model.source = \"paper\"` a synthesis would propose designs that slip: at a friction of 0.2 seven of ten springs that the paper's equations pass fail by the corrected ones, at 0.12 nine of ten. Leave it out; the files written may have it, to compare.",
    ),
    code(
        "W0801",
        "The corrected model does not confirm it",
        "The project uses the paper's model. The corrected one - finite turns on the hub, a bore that only what exceeds τ_t presses on - finds that the design slips. Use `model.source = \"corrected\"` for a design.",
    ),
    code(
        "W0802",
        "What happens depends on the friction",
        "At one end of the range of friction the transmission does something else than at the other.",
    ),
    code(
        "W0803",
        "Friction without a range",
        "Friction is given as one number. Nobody knows it that well, and the design depends on it: give a range.",
    ),
    code(
        "W0830",
        "The bench shows what the model does not",
        "The bench measured mode II at an input torque at which the model says that the spring slips, even at the upper end of the range of friction. The model takes spring, hub and bore to be coaxial and of the diameters that are typed: measure them, and look at the torque that varies once per turn. The prototypes of the paper do it too.",
    ),
    code(
        "W0811",
        "Shifts before it touches",
        "On its way to the object the hand already needs more than mode I carries: the finger's inertia when the voltage jumps, its swing on the soft coil, glove or friction. The rest of the way is five times slower. A ramp of the voltage, a lighter finger or a later transition avoids it.",
    ),
    code(
        "W0812",
        "Does not reach the object",
        "Motor and finger come to rest before the object is touched: glove and friction take more than the transmission gives, or the clutch slips.",
    ),
    code(
        "W0813",
        "Closing not finished",
        "The simulated closing did not come to rest within 30 s after the last change of the voltage, or what sticks and slips changed more than 2000 times: without damping, a slow drive pulls a finger in steps. Metrics of the grasp are then missing rather than guessed.",
    ),
    code(
        "W0814",
        "Weaker than wanted",
        "The motor stalls, or the clutch slips, below `hand.force` (or the force of the required output torque): the voltage over the resistance or the limit of the current is too small, or losses take the rest.",
    ),
];
