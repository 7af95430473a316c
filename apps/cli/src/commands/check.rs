//! `forcewright check`: reads projects and every variant of them; nothing is solved.

use std::path::{Path, PathBuf};

use clap::ArgMatches;
use forcewright::base::diagnostics::{Diagnostics, Sources};
use forcewright::base::text::visible;
use forcewright::{Choices, DiskFiles, Loaded, Refused, SynthesisTask};
use serde_json::json;

use super::{choices, diagnostic_json, diagnostics_json, refuse};
use crate::{exit, output};

/// What was said of a file that is understood.
struct Read {
    said: Diagnostics,
    sources: Sources,
    variants: Vec<String>,
}

fn read(file: &Path, choices: &Choices, asks_for_design: bool) -> Result<Read, Refused> {
    if asks_for_design {
        let task = SynthesisTask::from_file(&DiskFiles, file, &choices.set)?;
        let (said, sources) = task.diagnostics();
        return Ok(Read { said: said.clone(), sources: sources.clone(), variants: Vec::new() });
    }
    let project = Loaded::from_file(&DiskFiles, file, choices)?.project;
    Ok(Read { said: project.diagnostics, sources: project.sources, variants: project.variants })
}

pub(crate) fn run(matches: &ArgMatches) -> u8 {
    let json = matches.get_flag("json");
    let mut worst = exit::MET;
    let mut documents = Vec::new();
    for file in matches.get_many::<PathBuf>("file").into_iter().flatten() {
        let name = file.display();
        let mut selection = vec![choices(matches)];
        let mut index = 0;
        while let Some(choice) = selection.get(index).cloned() {
            index += 1;
            let what = choice.variant.as_ref().map_or_else(|| name.to_string(), |v| format!("{name}, variant {v}"));
            let asks = choice.variant.is_none() && SynthesisTask::is_asked(&DiskFiles, file, &choice.set);
            match read(file, &choice, asks) {
                Err(refused) => {
                    worst = worst.max(refuse(&refused, false));
                    let list = diagnostics_json(&refused);
                    documents.push(json!({ "file": name.to_string(), "variant": choice.variant, "ok": false, "diagnostics": list }));
                    // The variants of a broken file repeat its errors.
                    if index == 1 {
                        break;
                    }
                }
                Ok(Read { said, sources, variants }) => {
                    let list: Vec<_> = said.warnings().into_iter().map(|d| diagnostic_json(d, &sources)).collect();
                    if index == 1 {
                        output::narrate(&said.render(&sources, output::colour_on_stderr()));
                    }
                    documents.push(json!({ "file": name.to_string(), "variant": choice.variant, "ok": true, "diagnostics": list }));
                    if !json {
                        let next = if asks { "; it asks for a design: `forcewright synthesise`" } else { "" };
                        output::print(&format!("{}: ok{next}\n", visible(&what)));
                    }
                    if index == 1 && choice.variant.is_none() {
                        selection.extend(variants.iter().map(|v| Choices { variant: Some(v.clone()), ..choice.clone() }));
                    }
                }
            }
        }
    }
    if json {
        let document = json!({ "schema": 1, "forcewright": forcewright::VERSION, "checked": documents });
        output::print(&output::json_text(&document));
    }
    worst
}
