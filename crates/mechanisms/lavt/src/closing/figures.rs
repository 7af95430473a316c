//! Curves and figures of a hand that closes, beside reductions of one speed.

use std::fmt::Write as _;

use forcewright_base::units::{Dimension, Unit, format_number, format_si};
use forcewright_model::{Axis, Branch, Curve, Figure, FigureContent, HorizontalLine, Marker, Plot, Series, Stroke, VerticalSpan};

use super::{ClosingSettings, Ending, Grasp, Instant, OneSpeed, Phase, as_fast, as_strong, grasp_one_speed};
use crate::analysis::Behaviour;
use crate::design::{Design, Hand, Motor};

/// Closings that are compared.
pub(crate) struct Closings<'a> {
    design: &'a Design,
    hand: &'a Hand,
    grasp: &'a Grasp,
    /// Name, words, look, reduction and closing of those with one speed.
    others: Vec<(&'static str, String, Stroke, Grasp)>,
}

type Quantity = fn(&Closings<'_>, &Instant) -> f64;

fn axis(name: &'static str, label: &str, dimension: Dimension, display: Unit) -> Axis {
    Axis { name, label: label.to_owned(), dimension, display }
}

impl<'a> Closings<'a> {
    /// `None` where nothing closes.
    pub(crate) fn of(design: &'a Design, behaviour: &'a Behaviour) -> Option<Self> {
        let (grasp, hand) = (behaviour.grasp.as_ref()?, design.hand.as_ref()?);
        let settings = ClosingSettings::default();
        let mut others = Vec::new();
        let mut add = |name, words: String, stroke, one: OneSpeed| {
            others.extend(grasp_one_speed(design, &one, &settings).map(|g| (name, words, stroke, g)));
        };
        add("as_fast", "one speed, as fast: 1 to 1".to_owned(), Stroke::Second, as_fast(&behaviour.statics));
        let strong_nm = grasp.force_n().map(|n| n / crate::analysis::finger_force_n(hand, 1.0)).filter(|nm| *nm > 0.0);
        if let (Some(output_nm), true) = (strong_nm, behaviour.statics.grip_nm.is_some()) {
            let one = as_strong(&behaviour.statics, output_nm);
            add("as_strong", format!("one speed, as strong: {} to 1", format_number(one.reduction, 3)), Stroke::Third, one);
        }
        Some(Self { design, hand, grasp, others })
    }

    fn quantities(&self) -> [(&'static str, &'static str, Axis, Quantity); 4] {
        let si = Unit::si;
        let units = &self.design.units;
        let opening = axis("opening", "Opening left", Dimension::Length, units.length.clone());
        [
            ("closing_current", "Current", axis("current", "Current of the motor", Dimension::Current, si(Dimension::Current)), |_, i| {
                i.current_a
            }),
            (
                "closing_speed",
                "Speed of the input",
                axis("input_speed", "Speed of the transmission's input", Dimension::AngularSpeed, si(Dimension::AngularSpeed)),
                |_, i| i.input_rad_per_s,
            ),
            ("closing_opening", "Opening", opening, |c, i| c.hand.opening_m.unwrap_or(0.0) - i.way_m),
            (
                "closing_force",
                "Force on the object",
                axis("force", "Force on the object", Dimension::Force, units.force.clone()),
                |_, i| i.force_n,
            ),
        ]
    }

    fn time() -> Axis {
        axis("time", "Time", Dimension::Time, Unit::si(Dimension::Time))
    }

    /// A trace with one state for each time, the last where there are two.
    fn line(&self, grasp: &Grasp, quantity: Quantity) -> (Vec<f64>, Vec<f64>) {
        let next = grasp.trace.iter().skip(1).map(|i| i.time_s).chain([f64::INFINITY]);
        let kept = grasp.trace.iter().zip(next).filter(|(i, next_s)| i.time_s < *next_s);
        kept.map(|(i, _)| (i.time_s, quantity(self, i))).unzip()
    }

    /// Traces over time, for scripts.
    pub(crate) fn curves(&self) -> Vec<Curve> {
        let branch = |name: &str, grasp: &Grasp, quantity| {
            let (x, y) = self.line(grasp, quantity);
            Branch { name: name.to_owned(), x, y }
        };
        let one = |(name, _, y, quantity): (&'static str, _, Axis, Quantity)| {
            let mut branches = vec![branch("two_speed", self.grasp, quantity)];
            branches.extend(self.others.iter().map(|(name, _, _, grasp)| branch(name, grasp, quantity)));
            Curve { name, x: Self::time(), y, branches }
        };
        self.quantities().into_iter().map(one).collect()
    }

    /// Figures of a report.
    pub(crate) fn figures(&self) -> Vec<Figure> {
        let end_s = self.grasp.last().map_or(0.0, |l| l.time_s);
        // A slower reduction may take very long: twice the time of the transmission tells enough.
        let shown_s = 2.0 * end_s;
        let one = |(id, title, y, quantity): (&'static str, &str, Axis, Quantity)| {
            let series = |label: &str, stroke, grasp: &Grasp| {
                let (x, y) = self.line(grasp, quantity);
                let shown = x.partition_point(|t| *t <= shown_s);
                Series { label: label.to_owned(), x: x[..shown].to_vec(), y: y[..shown].to_vec(), stroke }
            };
            let mut lines: Vec<Series> = self.others.iter().map(|(_, words, stroke, grasp)| series(words, *stroke, grasp)).collect();
            lines.push(series("two speeds", Stroke::Main, self.grasp));
            let mut plot = Plot {
                x: Self::time(),
                y,
                series: lines,
                bands: Vec::new(),
                levels: self.levels(id),
                spans: self.spans(end_s),
                markers: Vec::new(),
                from_zero: true,
            };
            if id == "closing_opening" {
                plot.markers.extend(self.touch());
            }
            Figure { id, title: format!("{title} as the hand closes"), caption: self.caption(id), content: FigureContent::Plot(plot) }
        };
        self.quantities().into_iter().map(one).collect()
    }

    fn motor(&self) -> Option<&Motor> {
        self.design.motor.as_ref()
    }

    fn levels(&self, id: &str) -> Vec<HorizontalLine> {
        let (at, label) = match id {
            "closing_force" => (super::target_n(self.design), "wanted"),
            "closing_current" => (self.motor().map_or(f64::INFINITY, |m| m.limit_a), "limit"),
            "closing_speed" => {
                (self.motor().and_then(|m| Some(m.max_rad_per_s? / m.reduction)).unwrap_or(f64::INFINITY), "limit of the motor")
            }
            _ => return Vec::new(),
        };
        if at.is_finite() { vec![HorizontalLine { at, label: label.to_owned(), stroke: Stroke::Limit }] } else { Vec::new() }
    }

    /// What the transmission does, as spans; those too short to be seen join the one before.
    fn spans(&self, end_s: f64) -> Vec<VerticalSpan> {
        let mut spans: Vec<VerticalSpan> = Vec::new();
        let phases = &self.grasp.phases;
        for (i, (from_s, phase)) in phases.iter().enumerate() {
            let to_s = phases.get(i + 1).map_or(end_s, |(next_s, _)| *next_s);
            match spans.last_mut() {
                Some(last) if to_s - from_s < 0.01 * end_s || last.label == phase.word() => last.to = to_s,
                None if to_s - from_s < 0.01 * end_s && *phase == Phase::Stands => {}
                _ => spans.push(VerticalSpan { from: *from_s, to: to_s, label: phase.word().to_owned(), hatched: false }),
            }
        }
        spans
    }

    fn touch(&self) -> Option<Marker> {
        let time_s = self.grasp.touch_s?;
        let note = format!("touches the object after {} s", format_number(time_s, 3));
        Some(Marker { x: time_s, y: self.hand.object_width_m, label: "touch".to_owned(), note })
    }

    fn caption(&self, id: &str) -> String {
        let grasp = self.grasp;
        let number = |x: f64| format_number(x, 3);
        let force = |n: f64| format_si(n, &self.design.units.force, 3);
        let mut text = String::new();
        match id {
            "closing_current" => {
                let _ = write!(text, "Largest current {} A", number(grasp.peak_a()));
                for (_, words, _, other) in &self.others {
                    let _ = write!(text, "; {words}: {} A", number(other.peak_a()));
                }
                let _ = write!(text, ".");
            }
            "closing_speed" => {
                let e = &grasp.energies;
                let lost = [
                    (e.joule, "heat of the winding"),
                    (e.motor, "motor and its reduction"),
                    (e.hub + e.bore, "slip of the clutch"),
                    (e.output, "losses behind it"),
                ];
                let _ = write!(text, "Of {} J in the end with two speeds the object keeps {} J", number(e.electric), number(e.object));
                for (joules, what) in lost {
                    let _ = write!(text, "; {what}: {} J", number(joules));
                }
                for (_, words, _, other) in self.others.iter().filter(|o| o.3.ending == Ending::Reached) {
                    let _ = write!(text, "; to the same force with {words}: {} J", number(other.energies.electric));
                }
                text.push('.');
            }
            "closing_opening" => {
                match (grasp.touch_s, grasp.shift_s) {
                    (Some(touch_s), Some(shift_s)) if shift_s > touch_s => {
                        let wound_s = number(shift_s - touch_s);
                        let _ = write!(text, "After the touch the finger waits {wound_s} s for the coil to wind up: the dead turns.");
                    }
                    (Some(_), Some(_)) => text.push_str("It shifts before it touches the object, and closes slowly from there on."),
                    (Some(_), None) => text.push_str("It never shifts."),
                    (None, _) => text.push_str("It does not reach the object."),
                }
                for (_, words, _, other) in &self.others {
                    if let Some(touch_s) = other.touch_s {
                        let _ = write!(text, " Touch after {} s with {words}.", number(touch_s));
                    }
                }
                text.push_str(" Waves are the finger swinging on the coil.");
            }
            _ => {
                let end = |g: &Grasp| match g.ending {
                    Ending::Reached => {
                        format!("{} reached after {} s", force(g.force_n().unwrap_or(0.0)), number(g.last().map_or(0.0, |l| l.time_s)))
                    }
                    Ending::Stalled => format!("stalls at {}", force(g.force_n().unwrap_or(0.0))),
                    Ending::Slips => format!("slips at {}", force(g.force_n().unwrap_or(0.0))),
                    Ending::Touched => "up to the touch".to_owned(),
                    Ending::Unfinished => "not finished".to_owned(),
                };
                let _ = write!(text, "Two speeds: {}", end(grasp));
                for (_, words, _, other) in &self.others {
                    let _ = write!(text, "; {words}: {}", end(other));
                }
                text.push('.');
            }
        }
        text
    }
}
