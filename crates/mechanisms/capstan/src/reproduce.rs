//! The paper's numbers beside ours. The others are data (`reference/longval.toml`); ours are computed in the run.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use forcewright_base::diagnostics::Span;
use forcewright_contract::family::Progress;
use forcewright_contract::project::{Choices, Project};
use forcewright_contract::read;
use forcewright_contract::reproduction::{Reproduction, ReproductionRow, rows};
use forcewright_elements::grooves::{Groove, Pressure};

use crate::design::{self, Design, Source};
use crate::geometry::{Drive, GeometryError, Layout};
use crate::spec::Spec;
use crate::statics::{Loaded, Place, Statics};
use crate::whole::whole;

/// The papers of this family.
pub(crate) const ALL: &[Reproduction] =
    &[Reproduction { key: "longval", title: "Longval & Gosselin: grooved multi-helix high-stiffness capstan drive", run: longval }];

const ROWS: &str = include_str!("../../../../reference/longval.toml");
const DRIVE: &str = include_str!("../../../../examples/capstan/longval.toml");

/// Cable of the numbers, N.
const PRELOAD_N: f64 = 200.0;
const AXIAL_STIFFNESS_N: f64 = 50e3;

/// The example with the cable and the friction of the numbers; the text is embedded and tested, so a failure gives rows that cannot agree.
fn example() -> Option<Design> {
    let project = Project::from_text("embedded", DRIVE, &Choices { variant: None, set: Vec::new() });
    let mut diagnostics = project.diagnostics;
    let mut spec: Spec = read::read(&project.tree, Span::default(), &mut diagnostics);
    let mut design = design::resolve(&mut spec, &mut diagnostics)?;
    // The numbers are those of smooth drums without the helix.
    design.built.groove_factor = 1.0;
    design.built.helix_correction = false;
    for cable in &mut design.built.cables {
        (cable.axial_stiffness_n, cable.preload_n) = (AXIAL_STIFFNESS_N, PRELOAD_N);
    }
    Some(design)
}

fn longval(progress: Progress<'_>) -> Vec<ReproductionRow> {
    let example = example();
    rows(ROWS, progress, |id| example.as_ref().and_then(|design| value(design, id)).unwrap_or(f64::NAN))
}

/// The number of a row, in its unit.
fn value(design: &Design, id: &str) -> Option<f64> {
    let (name, number) = id.rsplit_once('_').and_then(|(name, n)| Some((name, n.parse::<u32>().ok()?))).unwrap_or((id, 0));
    if let Some(section) = id.strip_prefix("groove_") {
        return groove(section);
    }
    let number = f64::from(number);
    match name {
        "discrete" => {
            let statics = statics(design, Source::Corrected, f64::INFINITY)?;
            Some(statics.turned(1e-6 * number / statics.levers_m()[1]).ok()?.force_n)
        }
        "gross_simple" => gross_n(design, Source::Paper, number),
        "gross" | "gross_exact" => gross_n(design, Source::Corrected, number),
        "gain" => {
            let mut grooved = design.clone();
            grooved.built.friction *= FRAC_PI_2;
            let tangent = |design: &Design| Some(at(design, Source::Corrected, number)?.tangent_n_per_m);
            Some(tangent(&grooved)? / tangent(design)?)
        }
        "gamma" => Some(drive(design, number, 5)?.tangent_angle_rad()),
        "span" => Some(1e3 * drive(design, number, 5)?.free_span_m()),
        "wrap" => Some(drive(design, number, 5)?.input_wrap_rad()),
        "landing" => Some(drive(design, number, 5)?.landing_pitches()),
        "fleet" => Some(drive(design, number, 5)?.shared_fleet_rad(0).ok()?.abs().to_degrees()),
        "aligned_3" | "aligned_5" => aligned(design, name.ends_with('3'), number),
        "ratio" => drive(design, 65.0, 5)?.aligning_ratio(4).ok(),
        _ => state(design, name, number),
    }
}

/// A number of the state at `T_ℓ/T_p`, in per cent.
fn state(design: &Design, name: &str, percent: f64) -> Option<f64> {
    let (source, name) = name.strip_prefix("paper_").map_or((Source::Corrected, name), |name| (Source::Paper, name));
    let statics = statics(design, source, f64::INFINITY)?;
    let loaded = at(design, source, percent)?;
    Some(match name {
        "taut" => loaded.tensions_n[0][0],
        "slip" => loaded.slip_rad[0][1][1],
        "k" | "k_exact" => 1e-3 * loaded.tangent_n_per_m,
        "secant" | "secant_exact" => 1e-3 * loaded.secant_n_per_m,
        "kt_out" => statics.torsional(loaded.tangent_n_per_m, 1),
        "kt_in" => statics.torsional(loaded.tangent_n_per_m, 0),
        _ => return None,
    })
}

/// Statics on wraps of the output without end, and 3 extra turns on the input or the wrap given, rad.
fn statics(design: &Design, source: Source, input_wrap_rad: f64) -> Option<Statics> {
    let geometry = design.built.geometry().ok()?;
    let input_wrap_rad = if input_wrap_rad.is_finite() { input_wrap_rad } else { geometry.input_wrap_rad() };
    let endless = vec![[f64::INFINITY; 2]; design.built.cables.len()];
    let place = Place {
        input_wraps_rad: [0.5 * input_wrap_rad; 2],
        output_wraps_rad: endless,
        ..design.built.place(&geometry, design.built.middle_rad())
    };
    Statics::new(&design.built, &place, source).ok()
}

fn at(design: &Design, source: Source, percent: f64) -> Option<Loaded> {
    let statics = statics(design, source, f64::INFINITY)?;
    statics.under(2.0 * 1e-2 * percent * PRELOAD_N * statics.levers_m()[1]).ok()
}

/// Force of gross slip with so many turns on the input, N.
fn gross_n(design: &Design, source: Source, turns: f64) -> Option<f64> {
    let geometry = design.built.geometry().ok()?;
    let statics = statics(design, source, TAU * turns - 2.0 * geometry.tangent_angle_rad())?;
    Some(statics.gross_slip_nm()? / statics.levers_m()[1])
}

fn layout(design: &Design, distance_mm: f64) -> Layout {
    Layout { centre_distance_m: 1e-3 * distance_mm, ..design.built.layout() }
}

/// The drive at a centre distance, with an output so many times as large as the input; the cable on the lines where it lands.
fn drive(design: &Design, distance_mm: f64, ratio: u32) -> Option<Drive> {
    let layout = layout(design, distance_mm);
    let of_ratio = Layout { output_radius_m: layout.input_radius_m * f64::from(ratio), starts: ratio, ..layout };
    match Drive::new(of_ratio.clone()) {
        Err(GeometryError::Lines { nearest, .. }) => {
            Drive::new(Layout { cables: vec![[0, i32::try_from(nearest).ok()?]], ..of_ratio }).ok()
        }
        drive => drive.ok(),
    }
}

/// The k-th centre distance at which both spans are in line, over r₁.
fn aligned(design: &Design, three: bool, k: f64) -> Option<f64> {
    let drive = drive(design, 65.0, if three { 3 } else { 5 })?;
    let apart = i64::from(drive.layout().extra_turns) + 1 + whole(k);
    let all = drive.aligned_distances(0.06, 0.4).ok()?;
    Some(all.iter().find(|a| a.lines_apart == apart)?.centre_distance_m / drive.layout().input_radius_m)
}

/// μ′/μ of a section.
fn groove(section: &str) -> Option<f64> {
    let round = |half_angle_rad: f64, pressure| Groove::Round { half_angle_rad, pressure };
    let groove = match section {
        "uniform" => round(FRAC_PI_2, Pressure::Uniform),
        "sin" => round(FRAC_PI_2, Pressure::Cosine),
        "sin2" => round(FRAC_PI_2, Pressure::CosinePower(2.0)),
        "sin3" => round(FRAC_PI_2, Pressure::CosinePower(3.0)),
        "uniform_arc120" => round(PI / 3.0, Pressure::Uniform),
        "cos_arc120" => round(PI / 3.0, Pressure::Cosine),
        "v60" => Groove::Vee { half_angle_rad: PI / 6.0 },
        "v90" => Groove::Vee { half_angle_rad: PI / 4.0 },
        "en81_b90_g30" => Groove::Undercut { undercut_rad: FRAC_PI_2, opening_rad: PI / 6.0 },
        _ => return None,
    };
    groove.friction_factor().ok()
}
