//! Any bytes as a project file: whatever is wrong with them becomes diagnostics, never a panic, and never takes long.
#![no_main]

use forcewright_contract::project::{Choices, Project};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    // What follows a form feed is a setting of the command line, so that noise reaches that reader too.
    let (text, setting) = text.split_once('\u{c}').unwrap_or((text, ""));
    let set = if setting.is_empty() { Vec::new() } else { vec![setting.to_owned()] };
    let plain = Project::from_text("project.toml", text, &Choices { variant: None, set: set.clone() });
    for variant in plain.variants.iter().take(4) {
        let _ = Project::from_text("project.toml", text, &Choices { variant: Some(variant.clone()), set: set.clone() });
    }
});
