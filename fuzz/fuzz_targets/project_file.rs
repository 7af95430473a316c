//! Any bytes as a project file, read and understood by its family: whatever is wrong with them becomes diagnostics that can be shown,
//! never a panic, and never takes long. Nothing is solved.
#![no_main]

use forcewright::{Choices, Loaded};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    // What follows a form feed is a setting of the command line, so that noise reaches that reader too.
    let (text, setting) = text.split_once('\u{c}').unwrap_or((text, ""));
    let set = if setting.is_empty() { Vec::new() } else { vec![setting.to_owned()] };
    let read = |variant: Option<String>| Loaded::from_text("project.toml", text, &Choices { variant, set: set.clone() });
    let refused = match read(None) {
        Ok(loaded) => {
            for variant in loaded.project.variants.iter().take(4) {
                let _ = read(Some(variant.clone()));
            }
            return;
        }
        Err(refused) => refused,
    };
    assert!(refused.errors() > 0, "refused without an error");
    let shown = refused.render(false);
    assert!(!shown.contains(|c: char| c.is_control() && c != '\n' && c != '\t'), "raw control characters are shown");
    for diagnostic in refused.diagnostics.in_file_order() {
        assert!(diagnostic.help.as_ref().is_some_and(|h| !h.is_empty()), "{} has no help", diagnostic.code);
    }
    let _ = read(Some("thin".to_owned()));
});
