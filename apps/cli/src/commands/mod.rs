//! One file per command.

pub(crate) mod calibrate;
pub(crate) mod check;
pub(crate) mod compare;
pub(crate) mod completions;
pub(crate) mod explain;
pub(crate) mod export;
pub(crate) mod front;
pub(crate) mod materials;
pub(crate) mod merge;
pub(crate) mod new;
pub(crate) mod optimise;
pub(crate) mod pareto;
pub(crate) mod reproduce;
pub(crate) mod schema;
pub(crate) mod solve;
pub(crate) mod sweep;
pub(crate) mod synthesise;
pub(crate) mod tolerance;

use clap::ArgMatches;
use forcewright::base::diagnostics::MOST_SHOWN;
use forcewright::{Choices, Refused};
use serde_json::json;

use crate::{exit, output};

/// What `forcewright` prints without a command: where to start.
pub(crate) fn welcome() -> u8 {
    output::print(
        "forcewright: passive force-shaping mechanisms of robots\n\n\
         Start here:\n  \
           forcewright new --list                         examples to start from\n  \
           forcewright new lan-table3                     a project file to edit\n  \
           forcewright solve lan-table3.toml --out out    the curve, the checks, and a report\n  \
           forcewright sweep lan-table3.toml --vary design.thickness=0.9mm..1.1mm:5    a table of designs\n  \
           forcewright synthesise FILE --out out          designs from requirements alone, the best first\n  \
           forcewright optimise FILE --out out            a better design, within ranges and requirements\n  \
           forcewright pareto FILE --out out              designs between several goals, to choose from\n  \
           forcewright tolerance tolerance-lan-thin.toml  the yield under the scatter of making\n  \
           forcewright calibrate FILE --out out           numbers of the design from a measured curve\n  \
           forcewright export lan-table3.toml --out out   DXF and STEP of the part\n  \
           forcewright compare A.toml B.toml              mechanisms of any family in one sheet\n  \
           forcewright reproduce lan2010                  the paper's numbers beside ours\n  \
           forcewright materials                          what `material.use` can name\n  \
           forcewright explain COMP002                    what a check or an error means\n\n\
         forcewright --help lists every command.\n",
    );
    exit::MET
}

fn choices(matches: &ArgMatches) -> Choices {
    Choices {
        variant: matches.get_one::<String>("variant").cloned(),
        set: matches.get_many::<String>("set").map(|v| v.cloned().collect()).unwrap_or_default(),
    }
}

/// Reports a refused project; the exit code for it.
fn refuse(refused: &Refused, json: bool) -> u8 {
    if json {
        output::print(&output::json_text(&output::refusal(&json!(diagnostics_json(refused)))));
    }
    output::narrate(&refused.render(output::colour_on_stderr()));
    let count = refused.errors();
    output::narrate(&format!("{count} error{}; `forcewright explain CODE` tells more about a code\n", if count == 1 { "" } else { "s" }));
    if refused.file_missing { exit::IO } else { exit::USAGE }
}

/// The first of the diagnostics, as many as are shown to people.
fn diagnostics_json(refused: &Refused) -> Vec<serde_json::Value> {
    refused.diagnostics.in_file_order().into_iter().take(MOST_SHOWN).map(|d| diagnostic_json(d, &refused.sources)).collect()
}

fn diagnostic_json(
    diagnostic: &forcewright::base::diagnostics::Diagnostic,
    sources: &forcewright::base::diagnostics::Sources,
) -> serde_json::Value {
    use forcewright::base::diagnostics::Severity;
    let severity = match diagnostic.severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
    };
    let mut out = json!({ "code": diagnostic.code, "severity": severity, "message": diagnostic.message });
    if let Some((span, source)) = diagnostic.span.and_then(|s| Some((s, sources.get(s.source)?)))
        && let Some((line, column)) = sources.line_column(span)
    {
        out["file"] = json!(source.name);
        out["line"] = json!(line);
        out["column"] = json!(column);
    }
    if let Some(help) = &diagnostic.help {
        out["help"] = json!(help);
    }
    out
}
