//! Gradients of outputs at the points of a path.

use forcewright_base::maths;

use super::{
    Axis, Gradient, GradientError, Output,
    closure::ChordSensitivity,
    design::arm_moments,
    field::{self, BeamRhs, Field, Place, Sensitivity},
    seed::{Seed, polished_place, position_slope, stress_slope},
};
use crate::{
    assembly::{Resolution, System},
    clearance::Reflection,
    counters::Counters,
    model::{Model, swing},
    network::is_zero,
    overlap::Zones,
    path::Path,
    state::{BeamState, Face, PeakStress, Point},
};

/// Computes gradients at points of one path; see [`Path::gradients`].
#[derive(Debug)]
pub struct Gradients<'p> {
    pub(super) model: &'p Model,
    pub(super) zones: &'p Zones,
    path: &'p Path,
    stage: Stage<'p>,
    /// For points beyond limit points, where the resolution may be another.
    beyond: Stage<'p>,
    pub(super) closures: Vec<ChordSensitivity>,
    /// What the loads before the drive left behind, and how it depends on the design.
    origins: Vec<(Origin, Design)>,
    counters: Counters,
}

/// Something that a load found when it began.
#[derive(Debug, Clone, PartialEq)]
enum Origin {
    /// The value of an unknown that is held ever since.
    Held(usize),
    /// The displacement along a force of the drive.
    AlongDrive,
}

/// Derivatives by the design, dimensionless.
#[derive(Debug, Clone)]
pub(super) struct Design {
    /// By the pieces.
    pub(super) pieces: Vec<Sensitivity>,
    /// By the positions of the nodes at rest.
    pub(super) shift: Vec<[f64; 2]>,
}

impl Design {
    fn new(model: &Model) -> Self {
        let piece = |b: &crate::model::BeamModel| Sensitivity::new(b.info.shape.angle_rad().len());
        Self { pieces: model.beams.iter().map(piece).collect(), shift: vec![[0.0; 2]; model.drawn_nodes] }
    }

    fn add(&mut self, other: &Self, factor: f64) {
        for (a, b) in self.pieces.iter_mut().zip(&other.pieces) {
            a.add(b, factor);
        }
        for (a, b) in self.shift.iter_mut().zip(&other.shift) {
            a.iter_mut().zip(b).for_each(|(a, b)| *a += factor * b);
        }
    }
}

/// How an output depends on the state and the design.
struct Dependence {
    /// By the state.
    rhs: Vec<f64>,
    /// By the design, the state held.
    design: Design,
    /// SI unit of the derivatives.
    unit: f64,
}

/// One load with its equations linearised at one state.
#[derive(Debug)]
struct Stage<'p> {
    model: &'p Model,
    resolution: &'p Resolution,
    system: System<'p>,
    state: Vec<f64>,
    tangent: Vec<f64>,
    newton_steps: u64,
}

impl Path {
    /// Prepares gradients at points of this path.
    ///
    /// ```
    /// use forcewright_beam::{Beam, Drive, Network, Node, Output, Parameter, Section, Settings, Shape, Support, trace};
    /// // A cantilever of 0.1 m, its end pushed 20 mm sideways.
    /// let section = Section { young_pa: 2e9, thickness_m: 1e-3, depth_m: 1e-2, poisson: None };
    /// let nodes = vec![
    ///     Node { position_m: [0.0, 0.0], support: Support::Clamped },
    ///     Node { position_m: [0.1, 0.0], support: Support::Free },
    /// ];
    /// let beams = vec![Beam::new(0, 1, Shape::new(vec![0.0], 0.1)?, section)];
    /// let network = Network::new(nodes, beams, Drive::Displacement { node: 1, direction: [0.0, 1.0] });
    /// let path = trace(&network, &[0.02], &Settings::default(), &mut |_| true)?;
    /// let gradient = &path.gradients()?.at(&path.points[0], &[Output::Force])?[0];
    /// // Force is proportional to depth.
    /// let by_depth = gradient.by(Parameter::Depth(0)).unwrap_or_default();
    /// assert!((by_depth * section.depth_m / path.points[0].force - 1.0).abs() < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`GradientError::ClosedLoop`], or [`GradientError::LimitPoint`] if a load before the drive ends at one.
    pub fn gradients(&self) -> Result<Gradients<'_>, GradientError> {
        let (model, [resolution, beyond]) = self.equations();
        let mut closures = Vec::with_capacity(model.spans.len());
        for (beam, (_, line)) in model.spans.iter().enumerate() {
            closures.push(line.shape.chord_sensitivity().map_err(|_| GradientError::ClosedLoop { beam })?);
        }
        let mut gradients = Gradients {
            path: self,
            model,
            zones: self.zones(),
            stage: Stage::new(model, resolution),
            beyond: Stage::new(model, beyond),
            closures,
            origins: Vec::new(),
            counters: Counters::default(),
        };
        gradients.find_origins(&self.before, resolution)?;
        Ok(gradients)
    }
}

/// Axes closer than this part of the unit of length cross: their distance has no derivative.
pub(crate) const NO_DISTANCE: f64 = 1e-9;
/// A Newton step from a point of the path, rad and units of length, is below this.
const LARGEST_RESIDUE: f64 = 1e-5;

impl<'p> Gradients<'p> {
    /// Work done so far: one evaluation and one factorisation per call of [`Gradients::at`], and one per load before the drive.
    pub fn counters(&self) -> Counters {
        self.counters + self.stage.counters() + self.beyond.counters()
    }

    /// The gradients of some outputs at a point of the path: one of [`Path::points`] or [`Path::whole`], or from [`Path::at`].
    ///
    /// # Errors
    /// [`GradientError`] if an output names what does not exist, the point is not of this path, or it is a limit point.
    pub fn at(&mut self, point: &Point, outputs: &[Output]) -> Result<Vec<Gradient>, GradientError> {
        Ok(self.with_rates(point, outputs)?.into_iter().map(|(gradient, _)| gradient).collect())
    }

    /// Gradients, and derivatives by the control along the path.
    pub(super) fn with_rates(&mut self, point: &Point, outputs: &[Output]) -> Result<Vec<(Gradient, f64)>, GradientError> {
        let resolution = self.path.resolution_of(point).ok_or(GradientError::ForeignPoint)?;
        outputs.iter().try_for_each(|output| self.check(output))?;
        let elsewhere = !std::ptr::eq(resolution, self.stage.resolution);
        if elsewhere {
            std::mem::swap(&mut self.stage, &mut self.beyond);
        }
        let gradients = self.at_own(point, outputs);
        if elsewhere {
            std::mem::swap(&mut self.stage, &mut self.beyond);
        }
        gradients
    }

    fn at_own(&mut self, point: &Point, outputs: &[Output]) -> Result<Vec<(Gradient, f64)>, GradientError> {
        self.stage.linearise(point)?;
        let model = self.model;
        let state = std::mem::take(&mut self.stage.state);
        let fields = fields(model, self.stage.resolution, &state);
        let gradients = outputs.iter().map(|output| self.differentiate(*output, point, &fields, &state)).collect();
        drop(fields);
        self.stage.state = state;
        Ok(gradients)
    }

    fn check(&self, output: &Output) -> Result<(), GradientError> {
        let beams = self.model.spans.len();
        if let Output::Gap { first, second, .. } = *output {
            // Both are positions, and may be asked for where these may.
            return [first, second].into_iter().try_for_each(|(beam, u)| self.check(&Output::Position { beam, u, axis: Axis::X }));
        }
        match *output {
            Output::Stress { beam, .. }
            | Output::PeakStress { beam: Some(beam) }
            | Output::FacePeakStress { beam, .. }
            | Output::Position { beam, .. }
                if beam >= beams =>
            {
                Err(GradientError::NoBeam { beam })
            }
            Output::Stress { u, .. } | Output::Position { u, .. } if !(0.0..=1.0).contains(&u) => Err(GradientError::NotOnBeam { u }),
            Output::NodeDisplacement { node, .. } | Output::NodeRotation { node } if node >= self.model.drawn_nodes => {
                Err(GradientError::NoNode { node })
            }
            _ => Ok(()),
        }
    }

    /// How the values at which loads began depend on the design, one load after the other.
    fn find_origins(&mut self, before: &[Point], resolution: &'p Resolution) -> Result<(), GradientError> {
        let mut loads: Vec<&'p Model> = Vec::new();
        let mut load = Some(self.model);
        while let Some(model) = load {
            loads.push(model);
            load = model.before.as_deref();
        }
        loads.reverse();
        for (pair, point) in loads.windows(2).zip(before) {
            let [earlier, later] = pair else { continue };
            let mut stage = Stage::new(earlier, resolution);
            stage.linearise(point)?;
            let mut rhs = vec![0.0; stage.state.len()];
            let origin = if later.kinematic {
                rhs[later.driven()] = 1.0;
                Origin::Held(later.driven())
            } else {
                later.pull.iter().for_each(|(place, factor)| rhs[*place] += factor);
                Origin::AlongDrive
            };
            let state = std::mem::take(&mut stage.state);
            let fields = fields(earlier, resolution, &state);
            let mut design = Design::new(earlier);
            let held = stage.system.solve_state(&mut rhs);
            stage.contract(&fields, &state, &rhs, -1.0, &mut design);
            self.add_origins(&mut design, earlier, &held, 1.0);
            // The displacement along an earlier force is of no further use.
            self.origins.retain(|(origin, _)| matches!(origin, Origin::Held(_)));
            self.origins.push((origin, design));
            drop(fields);
            self.counters = self.counters + stage.counters();
        }
        Ok(())
    }

    /// Adds the part of values that earlier loads left behind: `held` are derivatives by the unknowns that `model` does not solve for.
    fn add_origins(&self, design: &mut Design, model: &Model, held: &[f64], factor: f64) {
        for (origin, by_design) in &self.origins {
            if let Origin::Held(place) = origin
                && let Some(by_value) = place.checked_sub(model.solved).and_then(|i| held.get(i))
            {
                design.add(by_design, factor * by_value);
            }
        }
    }

    fn differentiate(&mut self, output: Output, point: &Point, fields: &[Field], state: &[f64]) -> (Gradient, f64) {
        let mut parts = self.dependence(output, point, fields, state);
        let kinematic = self.model.kinematic;
        let rate = match output {
            Output::Force => {
                if kinematic {
                    point.stiffness
                } else {
                    1.0
                }
            }
            Output::Displacement => {
                if kinematic {
                    1.0
                } else {
                    1.0 / point.stiffness
                }
            }
            _ => {
                let along: f64 = parts.rhs.iter().zip(&self.stage.tangent).map(|(by, change)| by * change).sum();
                along * parts.unit / self.model.control_unit()
            }
        };
        match output {
            // Under a kinematic drive the displacement is the control, under a force drive the force is.
            Output::Force if kinematic => self.along_tangent(&mut parts, fields, state, 1.0),
            Output::Displacement if !kinematic => {
                self.along_tangent(&mut parts, fields, state, -1.0);
                for (_, start) in self.origins.iter().filter(|(origin, _)| *origin == Origin::AlongDrive) {
                    parts.design.add(start, -1.0);
                }
            }
            Output::Force | Output::Displacement => {}
            _ => {
                let held = self.stage.system.solve_state(&mut parts.rhs);
                self.stage.contract(fields, state, &parts.rhs, -1.0, &mut parts.design);
                self.add_origins(&mut parts.design, self.model, &held, 1.0);
            }
        }
        (self.in_si(&parts.design, parts.unit), rate)
    }

    /// The derivative of ∂ℒ/∂p along the path.
    fn along_tangent(&self, parts: &mut Dependence, fields: &[Field], state: &[f64], factor: f64) {
        self.stage.contract(fields, state, &self.stage.tangent, factor, &mut parts.design);
        let held = self.stage.system.rows_beyond(&self.stage.tangent);
        self.add_origins(&mut parts.design, self.model, &held, factor);
    }

    fn dependence(&self, output: Output, point: &Point, fields: &[Field], state: &[f64]) -> Dependence {
        let model = self.model;
        let mut parts = Dependence { rhs: vec![0.0; state.len()], design: Design::new(model), unit: 1.0 };
        match output {
            Output::Force => parts.unit = model.reaction_unit(),
            Output::Displacement => parts.unit = model.displacement_unit(),
            Output::Stiffness => self.add_stiffness(&mut parts, fields, state),
            Output::Stress { beam, u, face } => {
                let (piece, inner, v) = point.beams[beam].piece_at(u);
                self.add_stress(&mut parts, &point.beams[beam], fields, (beam, piece, v, face, 1.0));
                let index = model.spans[beam].0.start + piece;
                let slope = stress_slope(inner, v, face, fields[index].constants.axial > 0.0);
                parts.design.pieces[index].add_sliding(&fields[index].info.range, u, slope);
            }
            Output::PeakStress { beam } => {
                let beam = beam.or_else(|| point.peak_stress().map(|p| p.0)).unwrap_or(0);
                self.add_peak(&mut parts, &point.beams[beam], fields, (beam, point.beams[beam].peak_stress()));
            }
            Output::FacePeakStress { beam, face } => {
                self.add_peak(&mut parts, &point.beams[beam], fields, (beam, point.beams[beam].peak_stress_of_face(face)));
            }
            Output::Position { beam, u, axis } => {
                parts.unit = model.length_m;
                self.add_position(&mut parts, point, fields, state, (beam, u, axis.unit()));
            }
            Output::Gap { first, second, reflection } => self.add_gap(&mut parts, point, fields, state, (first, second, reflection)),
            Output::NodeDisplacement { node, axis } => {
                parts.unit = model.length_m;
                self.add_translation(&mut parts, node, axis.unit());
            }
            Output::NodeRotation { node } => {
                if let Some(place) = model.nodes[node].rotation {
                    parts.rhs[place] = 1.0;
                }
            }
        }
        parts
    }

    fn add_translation(&self, parts: &mut Dependence, node: usize, axis: [f64; 2]) {
        for (place, direction) in &self.model.nodes[node].translations {
            parts.rhs[*place] += field::dot(*direction, axis);
        }
    }

    /// A place in a rigid part: from where it ends, by the vector between them at rest, turned with the end.
    fn add_rigid_part(&self, parts: &mut Dependence, state: &[f64], piece: usize, at: (usize, f64, f64), axis: [f64; 2]) {
        let (beam, u, edge) = at;
        let (model, line) = (self.model, &self.model.spans[beam].1);
        let (here, there) = (line.shape.point_m(u), line.shape.point_m(edge));
        let rest = [0, 1].map(|i| (here[i] - there[i]) / model.length_m);
        let end = usize::from(u > edge);
        let turn = model.beams[piece].ends[end];
        let rotation = Model::rotation(turn, state);
        let moved = swing(rest, rotation);
        if let Some(place) = turn {
            parts.rhs[place] += field::dot(axis, field::turned([rest[0] + moved[0], rest[1] + moved[1]]));
        }
        let back = swing(axis, -rotation);
        let seen = [axis[0] + back[0], axis[1] + back[1]];
        let (sum, length) = (&mut parts.design.pieces[piece], line.shape.length_m() / model.length_m);
        for (target, moment) in sum.angles.iter_mut().zip(arm_moments(line, edge, u)) {
            *target += length * field::dot(seen, field::turned(moment));
        }
        sum.beam_length += field::dot(seen, rest);
        // Where the edge moves, the vector grows shorter.
        let (sin, cos) = maths::sin_cos(line.shape.angle_at(edge));
        sum.range[end] -= length * field::dot(seen, [cos, sin]);
    }

    /// The place on the axis, in units of length along a direction: the start of the beam, all pieces before, and the last piece up to it.
    fn add_position(&self, parts: &mut Dependence, point: &Point, fields: &[Field], state: &[f64], at: (usize, f64, [f64; 2])) {
        let (beam, place, axis) = at;
        let model = self.model;
        let span = model.spans[beam].0.clone();
        let [from, to] = point.beams[beam].flexible();
        let u = place.clamp(from, to);
        if place < from || place > to {
            let piece = if place < from { span.start } else { span.end - 1 };
            self.add_rigid_part(parts, state, piece, (beam, place, u), axis);
        }
        let first = &model.beams[span.start];
        let shift = &mut parts.design.shift[first.nodes[0]];
        *shift = [0, 1].map(|i| shift[i] + axis[i]);
        self.add_translation(parts, first.nodes[0], axis);
        let (arm, turn) = (first.arms[0], model.nodes[first.nodes[0]].rotation);
        if !is_zero(arm) {
            let moved = swing(arm, Model::rotation(turn, state));
            let now = [arm[0] + moved[0], arm[1] + moved[1]];
            if let Some(place) = turn {
                parts.rhs[place] += field::dot(axis, field::turned(now));
            }
            let back = swing(axis, -Model::rotation(turn, state));
            let by_arm = &mut parts.design.pieces[span.start].arms[0];
            *by_arm = [0, 1].map(|i| by_arm[i] + axis[i] + back[i]);
        }
        let (last, _, v) = point.beams[beam].piece_at(u);
        for (number, piece) in point.beams[beam].pieces().iter().enumerate().take(last + 1) {
            let index = span.start + number;
            let mut seed = Seed::new(&fields[index], piece, parts.design.pieces[index].angles.len());
            seed.add_position(if number == last { v } else { 1.0 }, axis);
            self.take(parts, index, seed.close());
        }
        let index = span.start + last;
        let slope = position_slope(&fields[index], &point.beams[beam].pieces()[last], v, axis);
        parts.design.pieces[index].add_sliding(&fields[index].info.range, u, slope);
    }

    /// The distance of two places less half of both thicknesses.
    fn add_gap(
        &self,
        parts: &mut Dependence,
        point: &Point,
        fields: &[Field],
        state: &[f64],
        (first, second, reflection): ((usize, f64), (usize, f64), Option<Reflection>),
    ) {
        let unit = self.model.length_m;
        parts.unit = unit;
        let (a, b) = (point.beams[first.0].shape_m(first.1), point.beams[second.0].shape_m(second.1));
        let b = reflection.map_or(b, |r| r.image(b));
        let apart = [b[0] - a[0], b[1] - a[1]];
        let distance = maths::hypot(apart[0], apart[1]);
        if distance > NO_DISTANCE * unit {
            let along = apart.map(|d| d / distance);
            self.add_position(parts, point, fields, state, (first.0, first.1, along.map(|c| -c)));
            // A reflection is its own transpose.
            let seen = reflection.map_or(along, |r| r.turn(along));
            self.add_position(parts, point, fields, state, (second.0, second.1, seen));
        }
        for (beam, u) in [first, second] {
            let (piece, inner, v) = point.beams[beam].piece_at(u);
            let half = 0.5 * inner.info.section_at(v).thickness_m / unit;
            let sum = &mut parts.design.pieces[self.model.spans[beam].0.start + piece];
            sum.thickness -= half;
            sum.add_thickness(&Place::new(&inner.info, v), -half);
            let taper = inner.info.thickness_m.map_or(0.0, |[a, b]| b - a);
            sum.add_sliding(&inner.info.range, u, -0.5 * taper / unit);
        }
    }

    /// The place of a largest stress does not matter, as far as it is one.
    fn add_peak(&self, parts: &mut Dependence, state: &BeamState, fields: &[Field], (beam, peak): (usize, PeakStress)) {
        let (piece, inner, v) = state.piece_at(peak.u);
        let v = polished_place(inner, v, peak.face, fields[0].constants.axial > 0.0);
        let sign = if peak.tension { 1.0 } else { -1.0 };
        self.add_stress(parts, state, fields, (beam, piece, v, peak.face, sign));
    }

    fn add_stress(&self, parts: &mut Dependence, state: &BeamState, fields: &[Field], at: (usize, usize, f64, Face, f64)) {
        let (beam, piece, v, face, sign) = at;
        let index = self.model.spans[beam].0.start + piece;
        let mut seed = Seed::new(&fields[index], &state.pieces()[piece], parts.design.pieces[index].angles.len());
        seed.add_stress(v, face, sign, self.model.force_n);
        self.take(parts, index, seed.close());
    }

    fn add_stiffness(&self, parts: &mut Dependence, fields: &[Field], state: &[f64]) {
        let model = self.model;
        parts.unit = model.reaction_unit() / model.displacement_unit();
        // The tangent under a force drive is dx/dF.
        let scale = if model.kinematic { 1.0 } else { self.stage.system.stiffness(&self.stage.tangent) };
        let by_displacement: Vec<f64> = self.stage.tangent.iter().map(|t| scale * t).collect();
        for (piece, field) in fields.iter().enumerate() {
            let change = self.stage.resolution.coordinates(model, piece, &by_displacement);
            let mut rhs = BeamRhs::new(self.stage.resolution.basis.bubbles);
            let mut sum = Sensitivity::new(parts.design.pieces[piece].angles.len());
            field.add_curvature(&change, &mut sum, &mut rhs);
            self.take(parts, piece, (rhs, sum));
            self.stage.add_arm_curvature(parts, piece, state, &by_displacement);
        }
    }

    /// Adds the part of one piece.
    fn take(&self, parts: &mut Dependence, piece: usize, (rhs, explicit): (BeamRhs, Sensitivity)) {
        let bubbles = self.stage.resolution.basis.bubbles;
        let first = self.model.unknowns + piece * bubbles;
        for (target, value) in parts.rhs[first..first + bubbles].iter_mut().zip(&rhs.bubbles) {
            *target += value;
        }
        let values = [rhs.ends[0], rhs.ends[1], rhs.force[0], rhs.force[1]];
        for (place, value) in self.model.beams[piece].places().iter().zip(values) {
            if let Some(place) = place {
                parts.rhs[*place] += value;
            }
        }
        parts.design.pieces[piece].add(&explicit, 1.0);
    }
}

/// All pieces at a state.
fn fields<'a>(model: &'a Model, resolution: &'a Resolution, state: &'a [f64]) -> Vec<Field<'a>> {
    let field = |(index, piece): (usize, &'a crate::model::BeamModel)| {
        let at = resolution.coordinates(model, index, state);
        Field::new(&resolution.basis, &resolution.rest[index], piece.constants, &piece.info, at)
    };
    model.beams.iter().enumerate().map(field).collect()
}

/// An arm of a piece that turns: what turns it, and where it is now.
struct Arm {
    end: usize,
    sign: f64,
    turn: usize,
    rotation: f64,
    now: [f64; 2],
}

impl<'p> Stage<'p> {
    fn new(model: &'p Model, resolution: &'p Resolution) -> Self {
        let system = System::new(model, resolution);
        Self { model, resolution, system, state: Vec::new(), tangent: Vec::new(), newton_steps: 0 }
    }

    fn counters(&self) -> Counters {
        Counters {
            newton_iterations: self.newton_steps,
            residual_evaluations: self.system.evaluations,
            factorisations: self.system.factorisations,
            ..Counters::default()
        }
    }

    /// Linearises the equations at a point and finds the tangent there.
    fn linearise(&mut self, point: &Point) -> Result<(), GradientError> {
        if point.state.len() != self.resolution.initial.len() {
            return Err(GradientError::ForeignPoint);
        }
        self.state.clone_from(&point.state);
        let control = point.control / self.model.control_unit();
        let limit = GradientError::LimitPoint { control: point.control };
        self.system.linearise(&self.state, control).map_err(|_| limit)?;
        self.system.newton_step();
        self.newton_steps += 1;
        let mut motions = self.model.nodes.iter().flat_map(|n| n.translations.iter().map(|t| t.0).chain(n.rotation));
        // Written so that NaN fails.
        if !motions.all(|i| self.system.change[i].abs() < LARGEST_RESIDUE) {
            return Err(GradientError::ForeignPoint);
        }
        self.system.tangent();
        self.tangent.clone_from(&self.system.change);
        Ok(())
    }

    /// Adds `factor` times change · ∂²ℒ/∂x∂p.
    fn contract(&self, fields: &[Field], state: &[f64], change: &[f64], factor: f64, design: &mut Design) {
        for (piece, field) in fields.iter().enumerate() {
            let own = self.resolution.coordinates(self.model, piece, change);
            let sum = &mut design.pieces[piece];
            field.add_mixed(&own, factor, sum);
            for arm in self.arms(piece, state) {
                // ±F·(R − 1) a by a, along the change: ±[(R − 1)ᵀ Ḟ + φ̇ (dR/dφ)ᵀ F].
                let force = self.resolution.coordinates(self.model, piece, state).force;
                let back = swing(own.force, -arm.rotation);
                let turned = turned_back(force, arm.rotation);
                for axis in 0..2 {
                    sum.arms[arm.end][axis] += factor * arm.sign * (back[axis] + change[arm.turn] * turned[axis]);
                }
            }
        }
    }

    /// The part of arms in the second derivative along `change` of the Lagrangian, by state and design.
    fn add_arm_curvature(&self, parts: &mut Dependence, piece: usize, state: &[f64], change: &[f64]) {
        let first = self.model.beams[piece].force;
        let force = self.resolution.coordinates(self.model, piece, state).force;
        let force_change = self.resolution.coordinates(self.model, piece, change).force;
        for arm in self.arms(piece, state) {
            let turn = change[arm.turn];
            let slope = field::turned(arm.now);
            let by_turn = -2.0 * turn * field::dot(force_change, arm.now) - turn * turn * field::dot(force, slope);
            parts.rhs[arm.turn] += arm.sign * by_turn;
            let back = swing(force, -arm.rotation);
            let now = [force[0] + back[0], force[1] + back[1]];
            let turned = turned_back(force_change, arm.rotation);
            for axis in 0..2 {
                parts.rhs[first + axis] -= arm.sign * turn * turn * arm.now[axis];
                parts.design.pieces[piece].arms[arm.end][axis] += arm.sign * (2.0 * turn * turned[axis] - turn * turn * now[axis]);
            }
        }
    }

    fn arms(&self, piece: usize, state: &[f64]) -> Vec<Arm> {
        let beam = &self.model.beams[piece];
        let mut arms = Vec::new();
        for (end, sign) in [-1.0, 1.0].into_iter().enumerate() {
            if let Some(turn) = self.model.nodes[beam.nodes[end]].rotation {
                let (arm, rotation) = (beam.arms[end], state[turn]);
                let moved = swing(arm, rotation);
                arms.push(Arm { end, sign, turn, rotation, now: [arm[0] + moved[0], arm[1] + moved[1]] });
            }
        }
        arms
    }
}

/// (dR/dφ)ᵀ F: the force turned back by a quarter turn and the rotation.
fn turned_back(force: [f64; 2], rotation: f64) -> [f64; 2] {
    let quarter = [force[1], -force[0]];
    let back = swing(quarter, -rotation);
    [quarter[0] + back[0], quarter[1] + back[1]]
}
