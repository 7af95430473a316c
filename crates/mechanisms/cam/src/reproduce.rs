//! The paper's numbers beside ours. The printed ones are data (`reference/sanchez2022.toml`); ours are computed in the run.

mod bench;
mod dynamics;

use forcewright_base::diagnostics::Span;
use forcewright_contract::family::Progress;
use forcewright_contract::project::{Choices, Project};
use forcewright_contract::read;
use forcewright_contract::reproduction::{Reproduction, ReproductionRow, rows};

use crate::design::{self, Design};
use crate::mechanism::{Drive, Mechanism, Sense};
use crate::path::{SidePath, curvature_per_m};
use crate::spec::Spec;
use crate::springs::SpringLaw;

/// The papers of this family.
pub(crate) const ALL: &[Reproduction] = &[Reproduction {
    key: "sanchez2022",
    title: "Sánchez-Salinas et al. 2022: constant-force mechanism of cams, rollers and springs",
    run: sanchez2022,
}];

const ROWS: &str = include_str!("../../../../reference/sanchez2022.toml");
const PROTOTYPE: &str = include_str!("../../../../examples/cam/sanchez-2-springs.toml");

/// Table 2, N/m.
const RATES: [f64; 6] = [683.0, 682.0, 681.0, 686.0, 686.0, 679.0];
/// The paper's A and half rest length, m.
const A_M: f64 = 9.058e-3;
const X0_M: f64 = 0.068;
/// Rate of two springs for which the cam was cut, N/m.
const NOMINAL: f64 = 1380.0;

/// The prototype; the text is embedded and tested, so a failure gives rows that cannot agree.
fn prototype() -> Option<Design> {
    let project = Project::from_text("embedded", PROTOTYPE, &Choices { variant: None, set: Vec::new() });
    let mut diagnostics = project.diagnostics;
    let mut spec: Spec = read::read(&project.tree, Span::default(), &mut diagnostics);
    design::resolve(&mut spec, &mut diagnostics)
}

/// The prototype as several rows use it.
struct Prototype {
    design: Design,
}

impl Prototype {
    /// With springs of these rates and this rolling friction.
    fn with(&self, rates: &[f64], friction: f64) -> Design {
        let mut design = self.design.clone();
        let spring = design.built.springs[0].clone();
        let one = |rate: &f64| {
            let law = SpringLaw::Linear { rate_n_per_m: *rate, rest_m: 2.0 * X0_M };
            crate::springs::Spring { law, ..spring.clone() }
        };
        design.built.springs = rates.iter().map(one).collect();
        design.built.arm_m = friction * design.built.roller_m;
        design
    }

    /// The mechanism of a variant; rows that need it cannot agree without it.
    fn mechanism(design: &Design) -> Option<Mechanism> {
        Some(design.mechanism(&design.cut().ok()?))
    }

    /// The number of a row, in its unit.
    fn value(&self, id: &str) -> f64 {
        let (name, number) = id.rsplit_once('_').and_then(|(a, n)| Some((a, n.parse::<u32>().ok()?))).unwrap_or((id, 0));
        let springs = number as usize;
        let count = f64::from(number);
        match name {
            "force_nominal" => 4.0 * 0.5 * count * NOMINAL * A_M,
            "a_from_force" => 1e3 * 50.0 / (4.0 * NOMINAL),
            "rate_sum" => 1e-3 * RATES[..springs].iter().sum::<f64>(),
            "force_theory" => self.rest_force(&RATES[..springs], 0.1),
            "lies_across" => 1e3 * self.lies_across(),
            "rho" => 1e3 * self.rho_m(),
            "travel_lost" => 1e3 * self.corner(f64::from(number) * 1e-3).map_or(0.0, |c| c.travel_m),
            "corner_x" => 1e3 * self.corner(0.016).map_or(f64::NAN, |c| c.at[0]),
            "corner_y" => 1e3 * self.corner(0.016).map_or(f64::NAN, |c| c.at[1]),
            "cusp_x" => 1e3 * self.cusp_x_m(),
            "mean_speed" => 0.1 / 0.125,
            _ => self.bench(id).or_else(|| self.dynamic(id)).unwrap_or(f64::NAN),
        }
    }

    /// Force at rest without friction, N.
    fn rest_force(&self, rates: &[f64], travel_m: f64) -> f64 {
        let mechanism = Self::mechanism(&self.with(rates, 0.0));
        mechanism.and_then(|m| m.instant(&Drive::rest(travel_m), Sense::Frictionless).ok()).map_or(f64::NAN, |i| i.force_n)
    }

    /// The travel at which a brace would lie across, x = l, m.
    fn lies_across(&self) -> f64 {
        let far = self.design.built.brace_m[0] - X0_M;
        far * far / (2.0 * A_M)
    }

    fn path(&self, roller_m: f64) -> Option<SidePath> {
        let mut design = self.design.clone();
        (design.cut_roller_m, design.built.roller_m) = (roller_m, roller_m);
        Self::mechanism(&design).map(|m| m.paths[0].clone())
    }

    /// Radius of curvature of the path at its start, m.
    fn rho_m(&self) -> f64 {
        self.path(0.016).map_or(f64::NAN, |p| 1.0 / curvature_per_m(&p.designed(0.0), 1.0))
    }

    fn corner(&self, roller_m: f64) -> Option<crate::path::Corner> {
        self.path(roller_m)?.corner().copied()
    }

    fn cusp_x_m(&self) -> f64 {
        self.path(0.016).and_then(|p| Some(p.designed(p.corner()?.lambda_m).at[0])).unwrap_or(f64::NAN)
    }
}

fn sanchez2022(progress: Progress<'_>) -> Vec<ReproductionRow> {
    let prototype = prototype().map(|design| Prototype { design });
    rows(ROWS, progress, |id| prototype.as_ref().map_or(f64::NAN, |p| p.value(id)))
}
