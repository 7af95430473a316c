//! The bench: force at the input over its turns for masses at the output, and what it says of both modes, the shift and the friction.
//!
//! The torque at the output is set by the mass, that at the input is measured: so the input torque is fitted over that of the output, and
//! `τ_out = (1 − λ) τ_in − c` follows from its slope and intercept. Theory: `docs/theory/lavt.md`.

mod figure;
mod found;
mod runs;
pub(crate) mod section;
mod words;

use forcewright_base::diagnostics::{Diagnostic, Diagnostics};
use forcewright_study::regression::{Broken, Line, TwoLines, broken_line};
use forcewright_study::sampling::Confidence;

use crate::spec::Spec;

pub(crate) use figure::{curves, figure};
pub use found::{Friction, Known, Mode, Shift};
pub use runs::{Run, Wave};
pub(crate) use words::{measure, statements, warnings};

/// Confidence of every interval.
pub(crate) const CONFIDENCE: Confidence = Confidence::P95;
/// Least loads of a fit.
const LEAST_LOADS: usize = 3;

/// What a bench measured.
#[derive(Clone, Debug)]
pub struct Bench {
    /// Runs in the order of their masses.
    pub runs: Vec<Run>,
    /// Lines of input torque over output torque.
    pub lines: Lines,
    /// R.
    pub ratio: f64,
    /// Losses of mode I and mode II; absent where the mode was not measured.
    pub modes: [Option<Mode>; 2],
    /// Where it shifts; absent where only one mode was measured.
    pub shift: Option<Shift>,
}

/// What the lines through the runs are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lines {
    /// Both modes.
    Both(TwoLines),
    /// One mode, 0 or 1.
    One(usize, Line),
    /// A line that becomes steeper: no transmission does that.
    Upward,
}

/// Which mode a run belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// 0: mode I; 1: mode II.
    Mode(usize),
    /// Between the lines of both modes: the plateau.
    Plateau,
    /// On neither line, and not between them.
    Neither,
}

impl Bench {
    /// Fits what was measured with a transmission of this ratio; absent with too few loads.
    pub fn of(runs: Vec<Run>, ratio: f64) -> Option<Self> {
        let points: Vec<[f64; 2]> = runs.iter().map(|r| [r.output_nm, r.input_nm]).collect();
        let lines = match broken_line(&points, CONFIDENCE)? {
            Broken::Two(two) if two.lines[1].slope < two.lines[0].slope => Lines::Both(two),
            Broken::Two(_) => Lines::Upward,
            // Nearer to 1 or to R, by their ratio.
            Broken::One(line) => Lines::One(usize::from(line.slope < ratio.sqrt()), line),
        };
        let modes = [0, 1].map(|mode| found::mode_of(&lines, mode, ratio));
        let shift = found::shift_of(&lines);
        Some(Self { runs, lines, ratio, modes, shift })
    }

    /// Which mode a run belongs to.
    pub fn part(&self, index: usize) -> Part {
        match &self.lines {
            Lines::One(mode, _) => Part::Mode(*mode),
            Lines::Upward => Part::Neither,
            Lines::Both(two) if index < two.first_to() => Part::Mode(0),
            Lines::Both(two) if index >= two.second_from => Part::Mode(1),
            Lines::Both(two) => {
                let Run { output_nm, input_nm, .. } = self.runs[index];
                let [one, other] = two.lines.map(|l| l.at(output_nm));
                if one < input_nm && input_nm < other { Part::Plateau } else { Part::Neither }
            }
        }
    }

    /// Whether means are those of whole turns.
    pub fn over_turns(&self) -> bool {
        self.runs.iter().all(|r| r.turns.is_some())
    }
}

/// Reads and fits the bench of a project; `None` without one or after an error.
pub(crate) fn bench_of(spec: &Spec, ratio: f64, diagnostics: &mut Diagnostics) -> Option<Bench> {
    let section = &spec.bench;
    let file = section.file.as_ref()?;
    let runs = runs::read(section, diagnostics)?;
    let mut loads: Vec<f64> = runs.iter().map(|r| r.output_nm).collect();
    loads.dedup_by(|a, b| a.to_bits() == b.to_bits());
    let fitted = (loads.len() >= LEAST_LOADS).then(|| Bench::of(runs, ratio)).flatten();
    if fitted.is_none() {
        let message = match loads.len() {
            1 => "one mass: too few for a line".to_owned(),
            few if few < LEAST_LOADS => format!("{few} masses: too few for a line"),
            enough => format!("no line can be laid through the runs of {enough} masses"),
        };
        diagnostics.push(
            Diagnostic::error("E0831", file.span, message)
                .label("measured here")
                .help("hang at least three masses on the output, and three in each mode for the shift between them"),
        );
    }
    fitted
}
