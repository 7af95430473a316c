//! The calibration as a page for people.

use forcewright_base::units::format_number;
use forcewright_model::CheckState;
use forcewright_report::study::{StudyColumn, StudyPage, StudyPart, StudySection, page};

use super::Calibrated;

/// What the tests of the residuals are.
const TESTS: &str = "Two tests look for what is systematic: whether points on one side of the curve stand together (runs of signs), or next \
                     to all lie on one (sign test), and whether a smooth line through what is left explains more of it than chance would (lack of fit). p is the chance that \
                     scatter alone looks like this; below 0.005 in either test something is called not explained. So it is below 0.0002 the other \
                     way round: more runs, or a smaller ratio, than errors that know nothing of each other make.";

/// A correlation; one of two parameters is not shown as the whole that only that with itself is.
fn shown(r: f64, own: bool) -> String {
    let most = if r.abs() > 0.9999 { "0.9999" } else { "0.999" };
    match r {
        r if own || r.abs() < 0.9995 => format!("{:.3}", r + 0.0),
        r if r > 0.0 => format!("> {most}"),
        _ => format!("< -{most}"),
    }
}

impl Calibrated {
    /// `report.html`. `input_name` is the file as the user named it, `command` the command that repeats this run.
    pub fn page(&self, input_name: &str, command: &str) -> String {
        let warnings = self.diagnostics.warnings().iter().map(|w| (w.code.to_owned(), w.message.clone())).collect();
        let figures = |all: Vec<forcewright_model::Figure>| all.into_iter().map(|f| StudyPart::Figure(Box::new(f))).collect();
        let mut left: Vec<StudyPart> = figures(vec![self.residuals()]);
        left.insert(0, StudyPart::Text(self.residual_verdict()));
        if let Some(far) = self.hardly_counting().or_else(|| self.far_off().map(|far| format!("{far}."))) {
            left.insert(1, StudyPart::Text(far));
        }
        left.push(StudyPart::Text(TESTS.to_owned()));
        left.push(StudyPart::Text(self.neighbours()));
        let sections = vec![
            StudySection { id: "parameters", title: "Parameters", parts: self.parameter_parts() },
            StudySection { id: "warnings", title: "Warnings", parts: vec![StudyPart::Warnings(warnings)] },
            StudySection { id: "curve", title: "Measured and computed", parts: figures(vec![self.overlay()]) },
            StudySection { id: "residuals", title: "What the parameters leave", parts: left },
            StudySection { id: "correlations", title: "What goes together", parts: self.correlation_parts() },
        ];
        page(&StudyPage {
            kind: "Calibration".to_owned(),
            title: self.before.outcome.title.clone(),
            facts: vec![
                ("Mechanism".to_owned(), self.before.family.clone()),
                ("Project file".to_owned(), input_name.to_owned()),
                (
                    "Measurement".to_owned(),
                    format!("{}, {} points, {} left out", self.measurement, self.points.x.len(), self.points.left_out),
                ),
                ("Degrees of freedom".to_owned(), format_number(self.fit.degrees, 5)),
            ],
            verdict: (if self.sound() { CheckState::Met } else { CheckState::Missed }, self.verdict()),
            sections,
            version: self.before.version.clone(),
            input_name: input_name.to_owned(),
            variant: self.before.variant.clone(),
            input_sha256: self.before.input_sha256.clone(),
            command: command.to_owned(),
        })
    }

    fn parameter_parts(&self) -> Vec<StudyPart> {
        let share = format!("{} %", format_number(100.0 * self.confidence.level(), 3));
        let what = format!(
            "These numbers were changed until the computed curve came as near as possible to the measured points. An interval of {share} \
             contains the true value in {share} of measurements like this one, {}",
            if let Some(why) = self.unknown() {
                format!("but here intervals are unknown: {why}. What stands below are the bounds.")
            } else if self.fit.residuals.unexplained {
                "if nothing systematic is left. Here something is: the estimates absorb what they can of it, and the intervals are too narrow."
                    .to_owned()
            } else if !self.fit.residuals.judged {
                "provided that nothing systematic is left, which so few points cannot tell.".to_owned()
            } else {
                "provided that nothing systematic is left, of which there is no sign below.".to_owned()
            }
        );
        let columns = [
            ("Parameter".to_owned(), StudyColumn::Code),
            ("Before".to_owned(), StudyColumn::Number),
            ("Estimate".to_owned(), StudyColumn::Number),
            (format!("Interval of {share}"), StudyColumn::Number),
            ("The same, by likelihood".to_owned(), StudyColumn::Number),
            ("Remark".to_owned(), StudyColumn::Text),
        ];
        let caption = "Estimates with their intervals: Student's, which takes the curve for linear in the parameters near the estimates, and \
                       that of the profile likelihood, which does not. Where they differ, believe the second";
        let rows = self.rows().into_iter().map(Vec::from).collect();
        let mut parts = vec![StudyPart::Text(what), StudyPart::Table { caption: caption.to_owned(), columns: columns.into(), rows }];
        if self.text.is_some() {
            let variant = &self.variant;
            parts.push(StudyPart::Text(format!(
                "`calibrated.toml` is the project file with a variant `{variant}` that has the estimates: \
                 `forcewright solve calibrated.toml --variant {variant}`."
            )));
        }
        parts
    }

    fn correlation_parts(&self) -> Vec<StudyPart> {
        if self.fit.parameters.len() < 2 {
            return Vec::new();
        }
        let what =
            "Near 1 or −1, an error of one estimate is made up for by one of the other: each alone is less certain than both together.";
        vec![StudyPart::Text(what.to_owned()), self.correlation_table()]
    }

    fn correlation_table(&self) -> StudyPart {
        let n = self.fit.parameters.len();
        let names: Vec<String> = self.fit.parameters.iter().map(|p| p.parameter.name.clone()).collect();
        let mut columns = vec![("Correlation of".to_owned(), StudyColumn::Code)];
        columns.extend(names.iter().map(|name| (name.clone(), StudyColumn::Number)));
        let row = |i: usize| {
            let cells = (0..n).map(|j| shown(self.fit.correlations[i * n + j], i == j));
            std::iter::once(names[i].clone()).chain(cells).collect()
        };
        StudyPart::Table { caption: "Correlations of the errors of the estimates".to_owned(), columns, rows: (0..n).map(row).collect() }
    }
}
