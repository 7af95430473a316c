//! `forcewright check`: reads projects and every variant of them; nothing is solved.

use std::path::PathBuf;

use clap::ArgMatches;
use forcewright::base::text::visible;
use forcewright::{DiskFiles, Loaded};
use serde_json::json;

use super::{choices, diagnostic_json, diagnostics_json, refuse};
use crate::{exit, output};

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
            match Loaded::from_file(&DiskFiles, file, &choice) {
                Err(refused) => {
                    worst = worst.max(refuse(&refused, false));
                    let list = diagnostics_json(&refused);
                    documents.push(json!({ "file": name.to_string(), "variant": choice.variant, "ok": false, "diagnostics": list }));
                    // The variants of a broken file repeat its errors.
                    if index == 1 {
                        break;
                    }
                }
                Ok(loaded) => {
                    let sources = &loaded.project.sources;
                    let list: Vec<_> = loaded.project.diagnostics.warnings().into_iter().map(|d| diagnostic_json(d, sources)).collect();
                    if index == 1 {
                        output::narrate(&loaded.project.diagnostics.render(sources, output::colour_on_stderr()));
                    }
                    documents.push(json!({ "file": name.to_string(), "variant": choice.variant, "ok": true, "diagnostics": list }));
                    if !json {
                        output::print(&format!("{}: ok\n", visible(&what)));
                    }
                    if index == 1 && choice.variant.is_none() {
                        selection.extend(
                            loaded.project.variants.iter().map(|v| forcewright::Choices { variant: Some(v.clone()), ..choice.clone() }),
                        );
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
