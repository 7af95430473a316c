//! From `±` and `[tolerance]` to the joint distribution of a design's numbers.

use forcewright_base::diagnostics::{Diagnostic, Diagnostics, Explanation, Span};
use forcewright_study::sampling::{Correlation, Distribution, Form, Population};

use crate::numbers::Number;
use crate::read::deferred_quantities;
use crate::studies::{Free, Scatter, Tolerance, chosen};

/// Sections whose numbers scatter: what is made, what it is made of, how far making misses it, and the motor that drives it.
const ROOTS: [&str; 4] = ["design", "material", "errors", "motor"];
/// Most numbers that scatter at once: each takes two coordinates of a point.
const MOST: usize = 128;

/// Codes of the scatter of making.
pub const CODES: &[Explanation] = &[
    Explanation {
        code: "E0319",
        title: "nothing scatters",
        text: "A tolerance study draws designs from the scatter of their numbers, and this file gives none. Write a `±` behind a quantity of the design or its material:\n\n    thickness = \"1 mm ± 0.02 mm\"\n\nor name numbers, by their paths or patterns of paths, in the section of the study:\n\n    [tolerance.parameters]\n    \"design.nodes.*.at\" = { half_width = \"0.05 mm\" }\n    \"design.beams.*.bend\" = { half_width = 0.01 }",
    },
    Explanation {
        code: "E0321",
        title: "no half width",
        text: "A parameter of `[tolerance.parameters]` takes its half width from `half_width`, or, without it, from the `±` or the fit behind the number. This number has none of them, or `half_width` is not one value that is not negative.",
    },
    Explanation {
        code: "E0322",
        title: "numbers cannot scatter together like this",
        text: "Members of a group of `[tolerance.groups]` scatter by themselves, each is in one group only, and a group has at least two. Of n numbers any two of which have the same correlation, it cannot be below −1/(n − 1): three numbers cannot all go against one another.",
    },
    Explanation {
        code: "E0323",
        title: "too many numbers scatter",
        text: "A study draws at most 128 numbers at once. Use narrower patterns, or leave out what matters little: the tornado of a smaller study tells.",
    },
];

/// Numbers that scatter, and how.
#[derive(Clone, Debug)]
pub struct Scattering {
    /// The numbers, with the values that the language allows.
    pub free: Vec<Free>,
    /// Their joint distribution, in the same order.
    pub population: Population,
}

/// A number that scatters: lower and upper deviation from its nominal value, and the form of its distribution between them.
#[derive(Clone, Copy)]
struct Own {
    deviations: [f64; 2],
    form: Form,
}

impl Tolerance {
    /// The numbers that scatter, in the order of the design: those with a `±` or a fit, and those that the section names, whose words win. `place`
    /// is pointed at where there are none. `None` after an error.
    pub fn scattering(&self, numbers: &[Number], place: Span, diagnostics: &mut Diagnostics) -> Option<Scattering> {
        let before = diagnostics.errors();
        let form = form_of(self.distribution.as_ref().map_or("normal", |d| d.value));
        let mut found: Vec<Option<Own>> = numbers.iter().map(|number| typed(number, form)).collect();
        for member in &self.parameters {
            for index in chosen(&member.name, &ROOTS, numbers, diagnostics) {
                let own = member.value.own(&numbers[index], form, member.name.span, diagnostics);
                found[index] = own.or(found[index]);
            }
        }
        let scattering: Vec<usize> = (0..numbers.len()).filter(|i| found[*i].is_some()).collect();
        if diagnostics.errors() == before && scattering.is_empty() {
            diagnostics.push(
                Diagnostic::error("E0319", place, "nothing of this design scatters")
                    .label("in this file")
                    .help("write a `±` behind a quantity, `thickness = \"1 mm ± 0.02 mm\"`, or name numbers in `[tolerance.parameters]`"),
            );
        }
        if scattering.len() > MOST {
            diagnostics.push(
                Diagnostic::error("E0323", place, format!("{} numbers scatter, of which a study can draw {MOST}", scattering.len()))
                    .label("in this file")
                    .help("use narrower patterns in `[tolerance.parameters]`, or fewer `±`"),
            );
        }
        if diagnostics.errors() > before {
            return None;
        }
        let marginals = scattering.iter().filter_map(|i| {
            let own = found[*i]?;
            let [lower, upper] = own.deviations;
            Distribution::from_deviations(numbers[*i].si, lower, upper, own.form).ok()
        });
        let free = |i: &usize| Free { number: numbers[*i].clone(), lower: numbers[*i].range.min, upper: numbers[*i].range.max };
        let population = self.grouped(Population::independent(marginals.collect()), &scattering, numbers, diagnostics);
        (diagnostics.errors() == before).then(|| Scattering { free: scattering.iter().map(free).collect(), population })
    }

    /// The groups of the section.
    fn grouped(&self, mut population: Population, scattering: &[usize], numbers: &[Number], diagnostics: &mut Diagnostics) -> Population {
        for group in &self.groups {
            let (Some(patterns), Some(correlation)) = (&group.value.members, &group.value.correlation) else { continue };
            let mut members = Vec::new();
            for pattern in &patterns.value {
                for index in chosen(pattern, &ROOTS, numbers, diagnostics) {
                    match scattering.iter().position(|i| *i == index) {
                        Some(member) if !members.contains(&member) => members.push(member),
                        Some(_) => {}
                        // Of a pattern, those that scatter; a number by its name must.
                        None if pattern.value.contains('*') || pattern.value != numbers[index].path => {}
                        None => diagnostics.push(
                            Diagnostic::error("E0322", pattern.span, format!("`{}` does not scatter", numbers[index].path))
                                .label("of this group")
                                .help("write a `±` behind it, or name it in `[tolerance.parameters]`"),
                        ),
                    }
                }
            }
            let mut refuse = |why: String, help: &str| {
                diagnostics.push(Diagnostic::error("E0322", group.name.span, why).label("this group").help(help));
            };
            if members.len() < 2 {
                refuse(format!("the group `{}` has {} numbers that scatter", group.name.value, members.len()), "a group has at least two");
                continue;
            }
            let joined = Correlation::common(members.len(), correlation.value.si)
                .map_err(|e| e.to_string())
                .and_then(|c| population.clone().correlate(&members, c).map_err(|_| "a number is in two groups".to_owned()));
            match joined {
                Ok(joined) => population = joined,
                Err(why) => refuse(format!("the group `{}`: {why}", group.name.value), "put all that is correlated into one group"),
            }
        }
        population
    }
}

impl Scatter {
    /// How a number scatters by these words.
    fn own(&self, number: &Number, usual: Form, place: Span, diagnostics: &mut Diagnostics) -> Option<Own> {
        let form = self.distribution.as_ref().map_or(usual, |d| form_of(d.value));
        let Some(slot) = &self.half_width else {
            if let Some(own) = typed(number, form) {
                return Some(own);
            }
            diagnostics.push(
                Diagnostic::error("E0321", place, format!("how far does `{}` scatter?", number.path))
                    .label("this parameter")
                    .related(number.span, "its value, without `±`")
                    .help("give `half_width`, or write a `±` behind the number"),
            );
            return None;
        };
        match deferred_quantities(slot, number.dimension, diagnostics)?[..] {
            [half_width] if half_width >= 0.0 => Some(Own { deviations: [-half_width, half_width], form }),
            _ => {
                diagnostics.push(
                    Diagnostic::error("E0321", slot.span, "a half width is one value that is not negative")
                        .label("this half width")
                        .help("write it as `half_width = \"0.05 mm\"`"),
                );
                None
            }
        }
    }
}

/// How a number scatters by its own `±` or fit: about the middle of the zone, which need not be the nominal value.
fn typed(number: &Number, form: Form) -> Option<Own> {
    let deviations = number.tolerance?.deviations_si(number.si)?;
    rooted(number).then_some(Own { deviations, form })
}

fn rooted(number: &Number) -> bool {
    number.path.split('.').next().is_some_and(|root| ROOTS.contains(&root))
}

fn form_of(word: &str) -> Form {
    match word {
        "uniform" => Form::Uniform,
        "triangular" => Form::Triangular,
        _ => Form::Normal,
    }
}
