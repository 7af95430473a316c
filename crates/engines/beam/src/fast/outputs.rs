//! Outputs at the states of a curve, from the fast path or from the general one.

use forcewright_base::maths;

use super::curve::Response;
use super::line::{BeamAt, Seed, THICKNESS};
use super::states::{FastState, FastStates};
use crate::clearance::Reflection;
use crate::gradient::{Axis, Derivatives, GradientError, Gradients, NO_DISTANCE, Output, Parameter, gap_m};
use crate::path::Path;
use crate::state::{Face, PeakStress, Point};

/// A curve with states on it, from [`crate::CurveSolver::solve_with_states`].
#[derive(Debug)]
pub struct CurveStates<'s> {
    response: &'s Response,
    source: Source<'s>,
}

#[derive(Debug)]
enum Source<'s> {
    Fast(&'s FastStates, Box<Room>),
    General(Result<Box<Gradients<'s>>, GradientError>, &'s GeneralStates),
}

/// Buffers.
#[derive(Debug, Default)]
struct Room {
    seed: Seed,
    columns: Vec<f64>,
}

/// States of a path; those it did not reach are missing.
#[derive(Debug)]
pub(super) struct GeneralStates {
    pub(super) path: Path,
    pub(super) points: Vec<Option<Point>>,
    pub(super) parameters: Vec<Parameter>,
}

impl<'s> CurveStates<'s> {
    pub(super) fn fast(response: &'s Response, states: &'s FastStates) -> Self {
        Self { response, source: Source::Fast(states, Box::default()) }
    }

    pub(super) fn general(response: &'s Response, states: &'s GeneralStates) -> Self {
        Self { response, source: Source::General(states.path.gradients().map(Box::new), states) }
    }

    /// The curve.
    pub fn response(&self) -> &'s Response {
        self.response
    }

    /// How many states there are, those included that the path did not reach.
    pub fn count(&self) -> usize {
        match &self.source {
            Source::Fast(states, _) => states.count,
            Source::General(_, states) => states.points.len(),
        }
    }

    /// Outputs at a state with their derivatives by the displacement and by the parameters of the curve.
    ///
    /// A largest stress is differentiated where it is. The value of a [`Output::Gap`] is the distance of the surfaces at the places given.
    ///
    /// # Errors
    /// [`GradientError`] if the state or what an output names does not exist, or if the general path has no derivative there.
    pub fn derivatives(&mut self, state: usize, outputs: &[Output], into: &mut Derivatives) -> Result<(), GradientError> {
        match &mut self.source {
            Source::Fast(states, room) => {
                let at = states.get(state)?;
                into.clear();
                room.seed.forget();
                outputs.iter().try_for_each(|output| states.differentiate(at, *output, room, into))
            }
            Source::General(gradients, states) => {
                let point = states.get(state)?;
                let gradients = gradients.as_mut().map_err(|error| *error)?;
                gradients.derivatives(point, outputs, &states.parameters, into)
            }
        }
    }

    /// The axis of a beam at a state, m: at `places + 1` even places from its start to its end the position and its derivative by u.
    ///
    /// Positions are integrated between the places and are right to about the sixth power of their distance: for pictures, and to see
    /// where a beam comes near to something. [`CurveStates::derivatives`] gives a position to the accuracy of the state.
    ///
    /// # Errors
    /// [`GradientError`] if the state or the beam does not exist.
    pub fn line_m(&self, state: usize, beam: usize, places: usize, into: &mut Vec<[[f64; 2]; 2]>) -> Result<(), GradientError> {
        match &self.source {
            Source::Fast(states, _) => {
                Seed::line_m(states.get(state)?.beams.get(beam).ok_or(GradientError::NoBeam { beam })?, places, into);
            }
            Source::General(_, states) => {
                let at = states.get(state)?.beams.get(beam).ok_or(GradientError::NoBeam { beam })?;
                into.clear();
                into.extend((0..=places).map(|i| {
                    const STEP: f64 = 1e-4;
                    let u = i as f64 / places as f64;
                    let ends = [(u - STEP).max(0.0), (u + STEP).min(1.0)];
                    let [before, after] = ends.map(|u| at.shape_m(u));
                    [at.shape_m(u), [0, 1].map(|axis| (after[axis] - before[axis]) / (ends[1] - ends[0]))]
                }));
            }
        }
        Ok(())
    }

    /// The stress of a beam on a face at a place and a state, Pa; tension is positive.
    ///
    /// # Errors
    /// [`GradientError::NoState`], [`GradientError::NoBeam`] or [`GradientError::NotOnBeam`].
    pub fn stress_pa(&self, state: usize, beam: usize, u: f64, face: Face) -> Result<f64, GradientError> {
        match &self.source {
            Source::Fast(states, _) => Ok(states.get(state)?.on_beam(beam, u)?.stress_pa(u, face)[0]),
            Source::General(_, states) if (0.0..=1.0).contains(&u) => {
                let at = states.get(state)?.beams.get(beam).ok_or(GradientError::NoBeam { beam })?;
                Ok(at.stress_pa(u)[usize::from(face == Face::Right)])
            }
            Source::General(..) => Err(GradientError::NotOnBeam { u }),
        }
    }

    /// The largest stress of a beam at a state, of one face or of both, with its place.
    ///
    /// # Errors
    /// [`GradientError::NoState`] or [`GradientError::NoBeam`].
    pub fn peak_stress(&self, state: usize, beam: usize, face: Option<Face>) -> Result<PeakStress, GradientError> {
        match &self.source {
            Source::Fast(states, _) => {
                let at = states.get(state)?.beams.get(beam).ok_or(GradientError::NoBeam { beam })?;
                Ok(face.map_or_else(|| at.peak(&states.samples), |face| at.peak_of_face(&states.samples, face)))
            }
            Source::General(_, states) => {
                let at = states.get(state)?.beams.get(beam).ok_or(GradientError::NoBeam { beam })?;
                Ok(face.map_or_else(|| at.peak_stress(), |face| at.peak_stress_of_face(face)))
            }
        }
    }
}

impl GeneralStates {
    fn get(&self, state: usize) -> Result<&Point, GradientError> {
        self.points.get(state).and_then(Option::as_ref).ok_or(GradientError::NoState { state })
    }
}

fn unit(axis: Axis) -> [f64; 2] {
    match axis {
        Axis::X => [1.0, 0.0],
        Axis::Y => [0.0, 1.0],
    }
}

impl FastState {
    fn beam(&self, beam: usize) -> Result<&BeamAt, GradientError> {
        self.beams.get(beam).ok_or(GradientError::NoBeam { beam })
    }

    /// A beam with a place on it.
    fn on_beam(&self, beam: usize, u: f64) -> Result<&BeamAt, GradientError> {
        if (0.0..=1.0).contains(&u) { self.beam(beam) } else { self.beam(beam).and(Err(GradientError::NotOnBeam { u })) }
    }
}

impl FastStates {
    fn get(&self, state: usize) -> Result<&FastState, GradientError> {
        self.states[..self.count].get(state).ok_or(GradientError::NoState { state })
    }

    /// Adds an output with its derivatives.
    fn differentiate(&self, at: &FastState, output: Output, room: &mut Room, into: &mut Derivatives) -> Result<(), GradientError> {
        let count = self.parameters.len();
        let Room { seed, columns } = room;
        columns.clear();
        columns.resize(count + 1, 0.0);
        let value = match output {
            Output::Force => {
                columns.copy_from_slice(&at.force_by);
                at.force_n
            }
            Output::Stiffness => {
                columns.copy_from_slice(&at.stiffness_by);
                at.stiffness_n_per_m
            }
            Output::Displacement => {
                columns[count] = 1.0;
                at.displacement_m
            }
            Output::Stress { beam, u, face } => {
                let beam = at.on_beam(beam, u)?;
                seed.start(beam);
                seed.add_stress(beam, u, face, 1.0);
                beam.add_columns(seed, columns);
                beam.stress_pa(u, face)[0]
            }
            Output::PeakStress { beam } => {
                let (beam, peak) = match beam {
                    Some(beam) => (at.beam(beam)?, at.beam(beam)?.peak(&self.samples)),
                    None => self.largest(at).ok_or(GradientError::NoBeam { beam: 0 })?,
                };
                add_peak(beam, peak, seed, columns)
            }
            Output::FacePeakStress { beam, face } => {
                let beam = at.beam(beam)?;
                add_peak(beam, beam.peak_of_face(&self.samples, face), seed, columns)
            }
            Output::Position { beam, u, axis } => {
                let [x, y] = self.add_position((beam, at.on_beam(beam, u)?), u, unit(axis), seed, columns);
                if axis == Axis::X { x } else { y }
            }
            Output::Gap { first, second, reflection } => self.add_gap(at, (first, second, reflection), seed, columns)?,
            Output::NodeDisplacement { node, axis } => {
                let place = usize::from(axis == Axis::Y);
                at.add_node(node, place, columns)?
            }
            Output::NodeRotation { node } => at.add_node(node, 2, columns)?,
        };
        into.value.push(value);
        into.by_control.push(columns[count]);
        into.by_parameter.extend_from_slice(&columns[..count]);
        Ok(())
    }

    /// The beam with the largest stress, the first of equals.
    fn largest<'a>(&self, at: &'a FastState) -> Option<(&'a BeamAt, PeakStress)> {
        let peaks = at.beams.iter().map(|beam| (beam, beam.peak(&self.samples)));
        peaks.reduce(|best, next| if next.1.stress_pa > best.1.stress_pa { next } else { best })
    }

    /// Adds the position along an axis; returns the place, m.
    fn add_position(&self, (index, beam): (usize, &BeamAt), u: f64, axis: [f64; 2], seed: &mut Seed, columns: &mut [f64]) -> [f64; 2] {
        seed.start(beam);
        seed.prepare_line((index, beam), &self.rule, u);
        seed.add_position(beam, axis);
        beam.add_columns(seed, columns);
        seed.position_m(beam)
    }

    /// Adds the distance of two places less half of both thicknesses, as [`Output::Gap`] means it.
    fn add_gap(
        &self,
        at: &FastState,
        (first, second, reflection): ((usize, f64), (usize, f64), Option<Reflection>),
        seed: &mut Seed,
        columns: &mut [f64],
    ) -> Result<f64, GradientError> {
        let beams = [at.on_beam(first.0, first.1)?, at.on_beam(second.0, second.1)?];
        let mut places = [[0.0; 2]; 2];
        for ((beam, (index, u)), place) in beams.iter().zip([first, second]).zip(&mut places) {
            seed.prepare_line((index, beam), &self.rule, u);
            *place = seed.position_m(beam);
        }
        let (gap, apart) = gap_m(places, beams.map(|b| b.thickness_m), reflection);
        let distance = maths::hypot(apart[0], apart[1]);
        let longest = at.beams.iter().fold(0.0_f64, |m, b| m.max(b.length_m));
        if distance > NO_DISTANCE * longest {
            let along = apart.map(|d| d / distance);
            self.add_position((first.0, beams[0]), first.1, along.map(|c| -c), seed, columns);
            // A reflection is its own transpose.
            self.add_position((second.0, beams[1]), second.1, reflection.map_or(along, |r| r.turn(along)), seed, columns);
        }
        for beam in beams {
            seed.start(beam);
            seed.values[THICKNESS] = -0.5 * beam.thickness_m;
            beam.add_columns(seed, columns);
        }
        Ok(gap)
    }
}

impl FastState {
    /// Adds a motion of a node, x, y or its rotation.
    fn add_node(&self, node: usize, place: usize, columns: &mut [f64]) -> Result<f64, GradientError> {
        let value = self.nodes.get(node).ok_or(GradientError::NoNode { node })?;
        for (target, by) in columns.iter_mut().zip(&self.nodes_by[node * self.force_by.len()..]) {
            *target += by[place];
        }
        Ok(value[place])
    }
}

/// Adds a largest stress where it is.
fn add_peak(beam: &BeamAt, peak: PeakStress, seed: &mut Seed, columns: &mut [f64]) -> f64 {
    seed.start(beam);
    seed.add_stress(beam, peak.u, peak.face, if peak.tension { 1.0 } else { -1.0 });
    beam.add_columns(seed, columns);
    peak.stress_pa
}
