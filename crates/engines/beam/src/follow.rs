//! The whole path: along its arc through all limit points, with what happens there.

use std::sync::Arc;

use crate::{
    arclength::{ArcKnot, Border},
    assembly::Resolution,
    counters::Counters,
    error::Status,
    model::Model,
    network::Settings,
    path::{Approach, DEGREES, same_end},
    stability::{Bifurcation, Fold, Jump},
    state::Point,
    stepping::{CLOSEST_LOOK, Interrupted, Knot, LARGEST_TURN, SMALLEST_STEP, Stepper, larger, next_step},
};

/// Sum of the largest change of each step after which a path is given up: 60 rad, or ten lengths of the longest beam.
const LONGEST_WAY: f64 = 60.0;
/// Steps towards a limit point become useless: the last ones, within this change, are dropped before turning to the arc length.
const TAKEN_BACK: f64 = 0.05;

/// A path as knots.
#[derive(Debug)]
pub(crate) struct Course {
    knots: Vec<ArcKnot>,
    status: Status,
    /// Control, displacement, force and largest stress, SI, at each limit point and at the end: what two resolutions are compared by.
    marks: Vec<[f64; 4]>,
    /// Control at which the arc length took over, SI.
    turned_at: f64,
}

/// The answer of this module.
#[derive(Debug, Default)]
pub(crate) struct Followed {
    pub(crate) whole: Vec<Point>,
    pub(crate) status: Status,
    pub(crate) folds: Vec<Fold>,
    pub(crate) jumps: Vec<Jump>,
    pub(crate) bifurcations: Vec<Bifurcation>,
    /// That of the points.
    pub(crate) resolution: Option<Arc<Resolution>>,
}

/// Whether stepping along the control ended where the path may go on.
fn is_stuck(status: &Status) -> bool {
    matches!(status, Status::NoEquilibriumBeyond { .. } | Status::StepTooSmall { .. })
}

/// Where stepping along the control ended.
#[derive(Debug)]
pub(crate) struct Start<'a> {
    pub(crate) model: &'a Model,
    pub(crate) resolution: &'a Arc<Resolution>,
    pub(crate) knots: &'a [Knot],
    pub(crate) status: Status,
}

/// Bifurcations only, for a path that is not followed any further.
pub(crate) fn bifurcations(start: &Start, budget: u64, counters: &mut Counters) -> Vec<Bifurcation> {
    if start.knots.windows(2).all(|k| k[0].instability == k[1].instability) {
        return Vec::new();
    }
    let mut go_on = |_: f64| true;
    let mut stepper = Stepper::new(start.model, start.resolution, budget, counters, &mut go_on);
    let mut knots = stepper.along_arc(start.knots);
    if is_stuck(&start.status) {
        stepper.take_back(&mut knots);
    }
    stepper.bifurcations(&mut Border::default(), &knots)
}

/// Follows a path from where stepping along the control ended, at increasing resolution.
pub(crate) fn follow(
    start: &Start,
    stations: &[f64],
    settings: &Settings,
    counters: &mut Counters,
    progress: &mut dyn FnMut(f64) -> bool,
) -> Followed {
    let model = start.model;
    let (mut course, resolution) = resolved_course(start, stations, settings, counters, progress);
    // What is known is reported even if the budget for finding it is spent.
    let mut stepper = Stepper::new(model, &resolution, u64::MAX, counters, progress);
    let mut border = Border::default();
    if course.knots.is_empty() {
        return Followed { status: course.status, ..Followed::default() };
    }
    let jumps = stepper.land(&mut border, &mut course.knots);
    let bifurcations = stepper.bifurcations(&mut border, &course.knots);
    let mut followed = Followed { bifurcations, status: course.status, resolution: Some(Arc::clone(&resolution)), ..Followed::default() };
    let places = stepper.points_along(&mut border, &course.knots, stations, &mut followed.whole);
    followed.name_folds_and_jumps(model, &course.knots, &places, &jumps);
    followed
}

/// The course at the first resolution that agrees with the one before.
fn resolved_course(
    start: &Start,
    stations: &[f64],
    settings: &Settings,
    counters: &mut Counters,
    progress: &mut dyn FnMut(f64) -> bool,
) -> (Course, Arc<Resolution>) {
    let (model, budget) = (start.model, settings.iteration_limit);
    let goal = stations.last().copied().unwrap_or(0.0) / model.control_unit();
    let mut border = Border::default();
    let mut resolution = Arc::clone(start.resolution);
    let mut course = Stepper::new(model, &resolution, budget, counters, progress).walk(&mut border, start, goal);
    let mut estimate = f64::INFINITY;
    let cut_short = |status: &Status| matches!(status, Status::Stopped { .. } | Status::IterationLimit { .. });
    let turned_at = course.turned_at;
    let mut walk_again = |degree: usize, border: &mut Border, counters: &mut Counters| {
        let Approach { resolution, failed, .. } = Approach::new(model, degree, budget, counters, &mut |_| true);
        if let Some(status) = failed {
            return Err(status);
        }
        let run = Stepper::new(model, &resolution, budget, counters, &mut |_| true).run(&[turned_at]);
        let again = Start { model, resolution: &resolution, knots: &run.knots, status: run.status };
        let next = Stepper::new(model, &resolution, budget, counters, progress).walk(border, &again, goal);
        if cut_short(&next.status) { Err(next.status) } else { Ok((next, resolution)) }
    };
    let more = is_stuck(&start.status) && !cut_short(&course.status);
    for &degree in DEGREES.iter().filter(|d| more && **d > start.resolution.degree) {
        match walk_again(degree, &mut border, counters) {
            Ok((next, finer)) => {
                estimate = difference(&course, &next);
                (course, resolution) = (next, finer);
            }
            Err(status) => course.status = status,
        }
        if cut_short(&course.status) || estimate <= settings.accuracy {
            break;
        }
    }
    if more && estimate.is_infinite() && start.resolution.degree == DEGREES[DEGREES.len() - 1] {
        // There is no finer one: compared with the one before instead.
        if let Ok((before, _)) = walk_again(DEGREES[DEGREES.len() - 2], &mut border, counters) {
            estimate = difference(&before, &course);
        }
    }
    if is_stuck(&start.status) && course.status == Status::Complete && estimate > settings.accuracy {
        course.status = Status::NotResolved { error_estimate: estimate, accuracy: settings.accuracy };
    }
    (course, resolution)
}

/// Largest difference of the marks of two courses relative to the largest of their kind.
fn difference(coarse: &Course, fine: &Course) -> f64 {
    let complete = matches!(fine.status, Status::Complete) && matches!(coarse.status, Status::Complete);
    if coarse.marks.len() != fine.marks.len() || !(complete || same_end(&coarse.status, &fine.status)) {
        return f64::INFINITY;
    }
    let mut worst = 0.0_f64;
    for kind in 0..4 {
        let largest = fine.marks.iter().fold(f64::MIN_POSITIVE, |m, v| m.max(v[kind].abs()));
        for (a, b) in coarse.marks.iter().zip(&fine.marks) {
            worst = larger(worst, (a[kind] - b[kind]).abs() / largest);
        }
    }
    worst
}

impl Followed {
    fn name_folds_and_jumps(&mut self, model: &Model, knots: &[ArcKnot], places: &[usize], jumps: &[(usize, usize)]) {
        for (knot, &index) in knots.iter().zip(places) {
            if knot.fold
                && let Some(p) = self.whole.get(index)
            {
                self.folds.push(Fold { index, control: p.control, displacement: p.displacement, force: p.force });
            }
        }
        for &(from, to) in jumps {
            let (from, to) = (places[from], places[to]);
            let (Some(a), Some(b)) = (self.whole.get(from), self.whole.get(to)) else { continue };
            let by_drive = if model.kinematic { 0.0 } else { a.control * (b.displacement - a.displacement) };
            let dead: f64 = model.dead.iter().map(|(place, force)| force * (b.state[*place] - a.state[*place])).sum();
            let work = by_drive + dead * model.force_n * model.length_m;
            self.jumps.push(Jump {
                from,
                to,
                control: a.control,
                displacement_before: a.displacement,
                displacement_after: b.displacement,
                force_before: a.force,
                force_after: b.force,
                released_j: a.energy_j - b.energy_j + work,
            });
        }
    }
}

impl Stepper<'_> {
    /// Drops the knots crowded before a limit point; returns a first step for the arc length.
    fn take_back(&self, knots: &mut Vec<ArcKnot>) -> f64 {
        let last = knots[knots.len() - 1].state.clone();
        let distance = |knot: &ArcKnot| self.size(&knot.state.iter().zip(&last).map(|(a, b)| a - b).collect::<Vec<f64>>());
        let back = TAKEN_BACK.min(0.3 * distance(&knots[0]));
        let keep = knots.iter().rposition(|k| distance(k) >= back).unwrap_or(0);
        knots.truncate(keep + 1);
        back
    }

    /// Follows the path up to the goal: from a limit point, or from where an earlier course turned to the arc length.
    fn walk(mut self, border: &mut Border, start: &Start, goal: f64) -> Course {
        let unit = self.system.model.control_unit();
        let mut course = Course { knots: self.along_arc(start.knots), status: start.status, marks: Vec::new(), turned_at: 0.0 };
        let Some(last) = course.knots.last() else { return course };
        let turned = start.status == Status::Complete && last.control < goal;
        if !turned && !is_stuck(&start.status) {
            return course;
        }
        let mut step = if turned { TAKEN_BACK } else { self.take_back(&mut course.knots) };
        course.turned_at = course.knots[course.knots.len() - 1].control * unit;
        let mut way = 0.0;
        loop {
            let last = &course.knots[course.knots.len() - 1];
            let control = last.control * unit;
            step = step.min(LARGEST_TURN / self.size(&last.rate).max(1e-3));
            if let Some(beam) = self.pulled_straight(&last.state) {
                course.status = Status::PulledStraight { control, beam };
                return course;
            }
            match self.go_on(border, &mut course, step, goal) {
                Ok(None) => return course,
                Ok(Some(distance)) => {
                    way += step * self.size(&course.knots[course.knots.len() - 1].rate);
                    step = next_step(step, step, distance);
                    if !(self.progress)((way / LONGEST_WAY).clamp(0.0, 1.0)) {
                        course.status = Status::Stopped { control };
                        return course;
                    }
                }
                Err(Interrupted::OutOfBudget) => {
                    course.status = Status::IterationLimit { control, limit: self.budget };
                    return course;
                }
                Err(_) => {
                    self.counters.rejected_steps += 1;
                    step *= 0.5;
                    if step < SMALLEST_STEP * TAKEN_BACK {
                        course.status = Status::StepTooSmall { control };
                        return course;
                    }
                }
            }
            if way > LONGEST_WAY {
                course.status = Status::TooLong { control };
                return course;
            }
        }
    }

    /// One step, with a knot at a limit point on the way. Nothing if the goal was reached.
    fn go_on(&mut self, border: &mut Border, course: &mut Course, step: f64, goal: f64) -> Result<Option<f64>, Interrupted> {
        let (next, distance) = self.step_along(border, &course.knots, step)?;
        let here = &course.knots[course.knots.len() - 1];
        if next.control_rate == 0.0 {
            return Err(Interrupted::Rejected);
        }
        let straight_on = here.control_rate * next.control_rate > 0.0;
        if straight_on && next.instability[0] != here.instability[1] && step * self.size(&here.rate) > CLOSEST_LOOK * LARGEST_TURN {
            return Err(Interrupted::Rejected);
        }
        let mut marks = Vec::new();
        let mut stretch = vec![here.clone()];
        if here.control_rate * next.control_rate < 0.0 {
            let limit = self.limit_between(border, here, &next).ok_or(Interrupted::Rejected)?;
            if !(limit.way > here.way && limit.way < next.way) {
                return Err(Interrupted::Rejected);
            }
            marks.push(limit.clone());
            stretch.push(limit);
        }
        stretch.push(next);
        let crossing = stretch.windows(2).position(|k| k[0].control < goal && k[1].control >= goal);
        if let Some(crossing) = crossing {
            let end = self.knot_at(border, &stretch[crossing], &stretch[crossing + 1], goal).ok_or(Interrupted::Rejected)?;
            stretch.truncate(crossing + 1);
            marks.truncate(crossing);
            marks.push(end.clone());
            stretch.push(end);
            course.status = Status::Complete;
        }
        for mark in &marks {
            // Solved again for its reaction.
            let Some(point) = self.settle(border, mark) else { return Err(Interrupted::Rejected) };
            let [displacement, force] = self.displacement_and_force(mark);
            let stress_pa = point.peak_stress().map_or(0.0, |(_, peak)| peak.stress_pa);
            course.marks.push([mark.control * self.system.model.control_unit(), displacement, force, stress_pa]);
        }
        course.knots.extend(stretch.into_iter().skip(1));
        Ok(if crossing.is_some() { None } else { Some(distance) })
    }

    /// Finds where a slowly driven device comes to rest after each limit point, and puts knots there. Returns pairs of knots.
    fn land(&mut self, border: &mut Border, knots: &mut Vec<ArcKnot>) -> Vec<(usize, usize)> {
        let mut jumps = Vec::new();
        let mut cursor = 0;
        while let Some(from) = (cursor.max(1)..knots.len()).find(|&i| knots[i].fold && knots[i - 1].control_rate > 0.0) {
            let level = knots[from].control;
            if knots[from].instability[0] > 0 {
                // It has left the path before.
                break;
            }
            let landing = (from + 1..knots.len().saturating_sub(1)).find_map(|i| {
                let (a, b) = (&knots[i], &knots[i + 1]);
                let rises = a.control < level && level <= b.control;
                let knot = if rises { self.knot_at(border, a, b, level)? } else { return None };
                (knot.instability[0] == 0).then_some((i + 1, knot))
            });
            let Some((place, knot)) = landing else { break };
            if knot.way < knots[place].way {
                knots.insert(place, knot);
            }
            jumps.push((from, place));
            cursor = place + 1;
        }
        jumps
    }

    /// The equilibrium at a knot, in SI units.
    fn settle(&mut self, border: &mut Border, knot: &ArcKnot) -> Option<Point> {
        let control = self.solve_at(border, knot)?;
        let rate = knot.control_rate.abs().max(1e-100) * knot.control_rate.signum();
        let tangent: Vec<f64> = knot.rate.iter().map(|r| r / rate).collect();
        let state = self.state.clone();
        let mut point = self.point(&state, &tangent, control * self.system.model.control_unit());
        if knot.fold {
            point.instability = knot.instability[0].min(knot.instability[1]);
        }
        Some(point)
    }

    /// A point with its stretch, and at a station with the number asked for, not its neighbour after a division and a multiplication.
    fn labelled(&self, mut point: Point, branch: usize, station: Option<f64>) -> Point {
        point.branch = branch;
        if let Some(station) = station {
            point.control = station;
            *(if self.system.model.kinematic { &mut point.displacement } else { &mut point.force }) = station;
        }
        point
    }

    /// All knots and all stations between them as points in path order. Returns the place of each knot.
    fn points_along(&mut self, border: &mut Border, knots: &[ArcKnot], stations: &[f64], points: &mut Vec<Point>) -> Vec<usize> {
        let unit = self.system.model.control_unit();
        let mut places = Vec::with_capacity(knots.len());
        let mut branch = 0;
        for (i, knot) in knots.iter().enumerate() {
            places.push(points.len());
            if let Some(point) = self.settle(border, knot) {
                let station = stations.iter().find(|s| (**s / unit).to_bits() == knot.control.to_bits());
                points.push(self.labelled(point, branch, station.copied()));
            }
            branch += usize::from(knot.fold);
            let Some(next) = knots.get(i + 1) else { break };
            let (low, high) = (knot.control.min(next.control), knot.control.max(next.control));
            let inside = |s: &&f64| **s / unit > low && **s / unit < high;
            let mut between: Vec<f64> = stations.iter().filter(inside).copied().collect();
            if next.control < knot.control {
                between.reverse();
            }
            for station in between {
                let found = self.knot_at(border, knot, next, station / unit);
                if let Some(point) = found.and_then(|k| self.settle(border, &k)) {
                    points.push(self.labelled(point, branch, Some(station)));
                }
            }
        }
        places
    }
}
