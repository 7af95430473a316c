"""What is compared: tools, beam models, accuracies, and the pinned mesh of each tool."""

from dataclasses import dataclass, field

ACCURACIES = ("1e-3", "1e-5")
MODELS = ("inextensible", "EA", "EA+GA")
# Of the derivatives, which are compared at one accuracy only.
GRADIENT_ACCURACY = "1e-5"
GRADIENT_MODEL = "EA+GA"
# The cam in motion.
MOTION_MODEL = "motion"
MOTION_ACCURACIES = ("1e-3", "1e-4", "1e-5")


@dataclass(frozen=True)
class Case:
    """One tool that computes one curve, or the curve and its derivatives, to one accuracy."""

    peer: str
    title: str
    model: str
    accuracy: str
    # Ours: the word for the method. Others: the script and its options.
    method: str = ""
    script: str = ""
    options: dict = field(default_factory=dict)
    gradient: bool = False

    def arguments(self, problem, samples):
        if self.method:
            return [self.method, self.model, self.accuracy, str(samples)]
        return [problem, str(samples), *(f"{key}={value}" for key, value in self.options.items())]

    def setting(self):
        """The mesh and tolerance, in words."""
        if self.model == MOTION_MODEL and self.method:
            return "exact at every instant"
        if self.method:
            return f"accuracy {self.accuracy}"
        names = {"elements": "elements per beam", "intervals": "intervals per beam", "steps": "step(s) per instant"}
        words = [f"{self.options[key]} {name}" for key, name in names.items() if key in self.options]
        return ", ".join([*words, f"tolerance {self.options['tolerance']}"])


@dataclass(frozen=True)
class Method:
    """One way to use a peer, and the settings that reach each accuracy at the least processor time.

    `pinned` follows the rule of `run.py --search`: for each tolerance of `tolerances`, the coarsest mesh (doubled from 1, then
    bisected) that keeps the error below the accuracy; of these the one that took least time. Of `solve_bvp`, Exudyn's 2-node
    elements and JAX at 1e-5 fewer settings were tried. `mesh` is the option that is the mesh. Of a solver that refines its mesh,
    whose first mesh does not tell the cost, all `meshes` are tried.
    """

    peer: str
    title: str
    script: str
    model: str
    fixed: dict
    mesh: str
    finest: int
    tolerances: tuple
    pinned: dict
    meshes: tuple = ()

    def case(self, accuracy, settings, gradient=False):
        return Case(self.peer, self.title, self.model, accuracy, script=self.script, options={**self.fixed, **settings}, gradient=gradient)


NEWTON = ("1e-1", "1e-2", "1e-3", "1e-5")

METHODS = [
    Method("exudyn", "Exudyn, 2-node elements", "peer_exudyn.py", "EA+GA", {"nodes": 2}, "elements", 512, NEWTON, {
        "1e-3": {"elements": 42, "tolerance": "1e-3"},
        "1e-5": {"elements": 410, "tolerance": "1e-5"},
    }),
    Method("exudyn", "Exudyn, 3-node elements", "peer_exudyn.py", "EA+GA", {"nodes": 3}, "elements", 64, NEWTON, {
        "1e-3": {"elements": 5, "tolerance": "1e-5"},
        "1e-5": {"elements": 14, "tolerance": "1e-5"},
    }),
    Method("opensees", "OpenSeesPy", "peer_opensees.py", "EA", {}, "elements", 512, NEWTON, {
        "1e-3": {"elements": 31, "tolerance": "1e-1"},
        "1e-5": {"elements": 314, "tolerance": "1e-2"},
    }),
    Method("opensees", "OpenSeesPy, Richardson", "peer_opensees.py", "EA", {"richardson": 1}, "elements", 64, NEWTON, {
        "1e-3": {"elements": 4, "tolerance": "1e-2"},
        "1e-5": {"elements": 12, "tolerance": "1e-5"},
    }),
    Method("scipy", "SciPy `solve_bvp`", "peer_scipy_bvp.py", "EA+GA", {"model": "EA+GA"}, "intervals", 64,
           ("1e-1", "1e-2", "1e-3", "1e-4"), {
        "1e-3": {"intervals": 6, "tolerance": "1e-1"},
        "1e-5": {"intervals": 8, "tolerance": "1e-3"},
    }, meshes=(2, 4, 6, 8, 12, 16, 24)),
    Method("scipy", "SciPy shooting, `solve_ivp`", "peer_scipy_shooting.py", "EA+GA", {"model": "EA+GA"}, "", 0,
           ("1e-2", "1e-3", "1e-4", "1e-5", "5e-6", "2e-6", "1e-6"), {
        "1e-3": {"tolerance": "1e-2"},
        "1e-5": {"tolerance": "2e-6"},
    }),
    Method("jax", "JAX shooting, compiled", "peer_jax.py", "EA+GA", {"model": "EA+GA"}, "intervals", 64, NEWTON, {
        "1e-3": {"intervals": 5, "tolerance": "1e-1"},
        "1e-5": {"intervals": 14, "tolerance": "1e-2"},
    }),
]

# The mesh whose derivatives are good to GRADIENT_ACCURACY of the largest by the same parameter.
GRADIENTS = [
    Method("jax", f"JAX, `{name}`", "peer_jax.py", GRADIENT_MODEL, {"model": GRADIENT_MODEL, "gradient": mode}, "intervals", 64, ("1e-4",), {
        GRADIENT_ACCURACY: {"intervals": 32, "tolerance": "1e-4"},
    })
    for mode, name in (("forward", "jacfwd"), ("reverse", "jacrev"))
]

# The cam in motion: steps per instant at which forces are compared.
MOTIONS = [
    Method("exudyn", "Exudyn, trapezoidal rule", "peer_exudyn_cam.py", MOTION_MODEL, {}, "steps", 32, ("1e-3", "1e-4", "1e-5", "1e-6"), {
        "1e-3": {"steps": 1, "tolerance": "1e-4"},
        "1e-4": {"steps": 2, "tolerance": "1e-4"},
        "1e-5": {"steps": 5, "tolerance": "1e-6"},
    }),
]

OURS = [
    Case("forcewright", title, model, accuracy, method=method)
    for model in MODELS
    for accuracy in ACCURACIES
    for method, title in (("fast", "`CurveSolver`"), ("fast-new", "`CurveSolver`, made anew"), ("general", "`trace`"))
]
OUR_GRADIENT = Case("forcewright", "`trace` and gradients", GRADIENT_MODEL, GRADIENT_ACCURACY, method="gradient", gradient=True)

CURVES = OURS + [method.case(accuracy, method.pinned[accuracy]) for method in METHODS for accuracy in ACCURACIES]
DERIVATIVES = [OUR_GRADIENT] + [method.case(GRADIENT_ACCURACY, method.pinned[GRADIENT_ACCURACY], True) for method in GRADIENTS]
IN_MOTION = [
    Case("forcewright", title, MOTION_MODEL, accuracy, method=method)
    for accuracy in MOTION_ACCURACIES
    for method, title in (("motion-reduced", "reduced model"), ("motion-multibody", "general multibody engine"))
] + [method.case(accuracy, method.pinned[accuracy]) for method in MOTIONS for accuracy in MOTION_ACCURACIES]
PEERS = list(dict.fromkeys(method.peer for method in METHODS))
# An independent curve for each beam model: no tool is judged by itself alone.
CHECKS = [
    Case("scipy", "SciPy shooting", model, "1e-8", script="peer_scipy_shooting.py", options={"model": model, "tolerance": "1e-11"})
    for model in MODELS
]
