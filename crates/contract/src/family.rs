//! What a family of mechanisms provides: typed inside ([`Mechanism`]), erased at the edge ([`Family`]).

use std::marker::PhantomData;

use forcewright_base::diagnostics::{Diagnostics, Explanation};
use forcewright_model::{Citation, Duty, Figure, NoPart, Outcome, ParameterRow, PartSet, Statement, Status, StatusKind};

use forcewright_study::evaluator::Evaluator;
use forcewright_study::task::Task;

use crate::describe::Describe;
use crate::numbers::{Number, numbers_of};
use crate::objective::{self, Objectives};
use crate::project::Project;
use crate::reproduction::Reproduction;
use crate::studies::{Free, Purpose, Studies};
use crate::synthesis::{Skeleton, Synthesiser};
use crate::{paths, read, schema};

/// Called with the finished fraction of the work; returns whether to go on.
pub type Progress<'a> = &'a mut dyn FnMut(f64) -> bool;

/// A family, for the people who write one.
pub trait Mechanism: Sync + 'static {
    /// The project file as typed: slots with units, places and origins.
    type Spec: Describe + Default + Sync;
    /// The same resolved: plain SI numbers, references checked, catalogue values in place.
    type Design: Sync;

    /// Name in project files: `compliant`.
    const ID: &'static str;
    /// Name for people.
    const TITLE: &'static str;

    /// Turns what was typed into a design. Whatever is wrong goes into `diagnostics`; `None` if it cannot be built. Values taken from a
    /// catalogue are written into the specification with their origin, so that reports can tell.
    fn resolve(spec: &mut Self::Spec, diagnostics: &mut Diagnostics) -> Option<Self::Design>;

    /// Analyses a design. A pure function of it; a solver's failure is in the outcome's status.
    fn analyse(design: &Self::Design, progress: Progress<'_>) -> Analysis;

    /// What is made of a design, and whether its process can make it.
    ///
    /// # Errors
    /// [`NoPart`] where it cannot be made as it is drawn.
    fn parts(design: &Self::Design) -> Result<PartSet, NoPart>;

    /// The sections of the project file that studies read.
    fn studies(spec: &Self::Spec) -> &Studies;

    /// The design compiled for studies of some of its numbers: what it does, as the measures that its requirements limit, at any values of
    /// them. What cannot vary goes into `diagnostics`.
    fn evaluator(spec: &Self::Spec, design: &Self::Design, free: &[Free], diagnostics: &mut Diagnostics) -> Option<Box<dyn Evaluator>>;

    /// The search that `[optimise]` asks for, over some numbers. What cannot vary, or is no objective, goes into `diagnostics`.
    fn task(spec: &Self::Spec, design: &Self::Design, free: &[Free], purpose: Purpose, diagnostics: &mut Diagnostics) -> Option<Task>;

    /// What `[optimise]` can make small or large.
    fn objectives() -> &'static [Objectives];

    /// What completes a file that has requirements but no design; `None` if the family has no synthesis.
    fn skeleton() -> Option<Skeleton> {
        None
    }

    /// The synthesis that a file asks for, which was completed by the skeleton. What is missing for it goes into `diagnostics`.
    fn synthesiser(_spec: &Self::Spec, _design: &Self::Design, _diagnostics: &mut Diagnostics) -> Option<Box<dyn Synthesiser>> {
        None
    }

    /// Codes of this family: its errors and its checks.
    fn explanations() -> &'static [Explanation];

    /// The papers whose numbers this family reproduces.
    fn reproductions() -> &'static [Reproduction];
}

/// What a family computes from a design.
#[derive(Clone, Debug)]
pub struct Analysis {
    /// Status, metrics, checks, curves.
    pub outcome: Outcome,
    /// Figures for the report.
    pub figures: Vec<Figure>,
    /// Which equations were solved and how.
    pub model: Vec<Statement>,
    /// What is not modelled.
    pub limits: Vec<Statement>,
    /// The same in the measures of all families; `None` if it could not begin.
    pub duty: Option<Duty>,
}

impl Analysis {
    /// One that could not begin: a status that says why, and what is known of the design without it.
    pub fn refused<M: Mechanism>(title: &str, message: String, [model, limits]: [Vec<Statement>; 2], sources: Vec<Citation>) -> Self {
        let outcome = Outcome {
            mechanism: M::ID,
            title: title.to_owned(),
            status: Status { kind: StatusKind::NotConverged, message, advice: None },
            error_estimate: None,
            metrics: Vec::new(),
            checks: Vec::new(),
            curves: Vec::new(),
            counters: Vec::new(),
            sources,
            warnings: Vec::new(),
        };
        Self { outcome, figures: Vec::new(), model, limits, duty: None }
    }
}

/// A family, for programs that know none in particular.
pub trait Family: Sync {
    /// Name in project files.
    fn id(&self) -> &'static str;
    /// Name for people.
    fn title(&self) -> &'static str;
    /// JSON schema of its project files.
    fn json_schema(&self) -> serde_json::Value;
    /// Table of its parameters in Markdown, and of its objectives.
    fn parameter_table(&self) -> String;
    /// Paths of its parameters, members as `*`.
    fn parameter_paths(&self) -> Vec<String>;
    /// Understands a project. Everything wrong is added to its diagnostics; `None` if it cannot be used.
    fn understand(&self, project: &mut Project) -> Option<Box<dyn Understood>>;
    /// See [`Mechanism::objectives`].
    fn objectives(&self) -> &'static [Objectives];
    /// See [`Mechanism::skeleton`].
    fn skeleton(&self) -> Option<Skeleton>;
    /// Codes of this family.
    fn explanations(&self) -> &'static [Explanation];
    /// The papers whose numbers it reproduces.
    fn reproductions(&self) -> &'static [Reproduction];
}

/// A project that was understood: ready to be solved.
pub trait Understood: Sync {
    /// Analyses it.
    fn analyse(&self, progress: Progress<'_>) -> Analysis;
    /// See [`Mechanism::parts`].
    ///
    /// # Errors
    /// [`NoPart`] where it cannot be made as it is drawn.
    fn parts(&self) -> Result<PartSet, NoPart>;
    /// Its parameters as typed.
    fn parameters(&self) -> Vec<ParameterRow>;
    /// Its numbers, by their paths.
    fn numbers(&self) -> &[Number];
    /// What studies are asked for.
    fn studies(&self) -> &Studies;
    /// See [`Mechanism::evaluator`].
    fn evaluator(&self, free: &[Free], diagnostics: &mut Diagnostics) -> Option<Box<dyn Evaluator>>;
    /// See [`Mechanism::task`].
    fn task(&self, free: &[Free], purpose: Purpose, diagnostics: &mut Diagnostics) -> Option<Task>;
    /// See [`Mechanism::synthesiser`].
    fn synthesiser(&self, diagnostics: &mut Diagnostics) -> Option<Box<dyn Synthesiser>>;
}

/// Makes a [`Family`] of a [`Mechanism`].
pub struct Entry<M>(PhantomData<fn() -> M>);

impl<M> Entry<M> {
    /// The entry of a family's list.
    #[allow(clippy::new_without_default, reason = "only ever written in a constant list")]
    pub const fn new() -> Self {
        Self(PhantomData)
    }
}

struct Ready<M: Mechanism> {
    spec: M::Spec,
    design: M::Design,
    parameters: Vec<ParameterRow>,
    numbers: Vec<Number>,
}

impl<M: Mechanism> Understood for Ready<M> {
    fn analyse(&self, progress: Progress<'_>) -> Analysis {
        M::analyse(&self.design, progress)
    }

    fn parts(&self) -> Result<PartSet, NoPart> {
        M::parts(&self.design)
    }

    fn parameters(&self) -> Vec<ParameterRow> {
        self.parameters.clone()
    }

    fn numbers(&self) -> &[Number] {
        &self.numbers
    }

    fn studies(&self) -> &Studies {
        M::studies(&self.spec)
    }

    fn evaluator(&self, free: &[Free], diagnostics: &mut Diagnostics) -> Option<Box<dyn Evaluator>> {
        M::evaluator(&self.spec, &self.design, free, diagnostics)
    }

    fn task(&self, free: &[Free], purpose: Purpose, diagnostics: &mut Diagnostics) -> Option<Task> {
        M::task(&self.spec, &self.design, free, purpose, diagnostics)
    }

    fn synthesiser(&self, diagnostics: &mut Diagnostics) -> Option<Box<dyn Synthesiser>> {
        M::synthesiser(&self.spec, &self.design, diagnostics)
    }
}

impl<M: Mechanism> Family for Entry<M> {
    fn id(&self) -> &'static str {
        M::ID
    }

    fn title(&self) -> &'static str {
        M::TITLE
    }

    fn json_schema(&self) -> serde_json::Value {
        schema::json_schema(M::ID, M::TITLE, &mut M::Spec::default())
    }

    fn parameter_table(&self) -> String {
        schema::markdown(&mut M::Spec::default()) + &objective::markdown(M::objectives())
    }

    fn parameter_paths(&self) -> Vec<String> {
        paths::keys_of(&mut M::Spec::default())
    }

    fn understand(&self, project: &mut Project) -> Option<Box<dyn Understood>> {
        let mut spec: M::Spec = read::read(&project.tree, project.root, &mut project.diagnostics);
        let design = M::resolve(&mut spec, &mut project.diagnostics);
        // A file of data that is not there is as one that `extends` names.
        project.file_missing |= project.diagnostics.in_file_order().iter().any(|d| d.code == "E0101" || d.code == "E0104");
        if project.diagnostics.has_errors() {
            return None;
        }
        let (mut parameters, mut numbers) = (paths::rows_of(&mut spec), numbers_of(&mut spec));
        parameters.retain(|row| !M::studies(&spec).lack(&row.path));
        numbers.retain(|number| !Studies::hold(&number.path));
        Some(Box::new(Ready::<M> { design: design?, spec, parameters, numbers }))
    }

    fn objectives(&self) -> &'static [Objectives] {
        M::objectives()
    }

    fn skeleton(&self) -> Option<Skeleton> {
        M::skeleton()
    }

    fn explanations(&self) -> &'static [Explanation] {
        M::explanations()
    }

    fn reproductions(&self) -> &'static [Reproduction] {
        M::reproductions()
    }
}
