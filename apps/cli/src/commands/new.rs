//! `forcewright new`: a project file from the gallery.

use std::path::PathBuf;

use clap::ArgMatches;
use forcewright::base::text::closest;
use forcewright::gallery::{self, EXAMPLES, Example};

use crate::table::{Align, columns};
use crate::{exit, output};

pub(crate) fn run(matches: &ArgMatches) -> u8 {
    if matches.get_flag("list") {
        let rows: Vec<Vec<String>> = EXAMPLES.iter().map(|e| vec![e.name.to_owned(), e.title().to_owned()]).collect();
        output::print(&columns(&rows, &[Align::Left, Align::Left]));
        return exit::MET;
    }
    let Some(name) = matches.get_one::<String>("example") else { return exit::USAGE };
    let Some(example) = gallery::find(name) else {
        let short = EXAMPLES.iter().filter_map(|e| e.name.rsplit('/').next());
        let near = closest(name, EXAMPLES.iter().map(|e| e.name).chain(short));
        let help = near.map_or_else(
            || "`forcewright new --list` names them".to_owned(),
            |n| format!("did you mean `{n}`? `forcewright new --list` names them all"),
        );
        output::narrate(&format!("error[E0121]: there is no example `{name}`\n  = help: {help}\n"));
        return exit::USAGE;
    };
    let folder = matches.get_one::<PathBuf>("dir").cloned().unwrap_or_default();
    if let Err(error) = std::fs::create_dir_all(&folder) {
        return output::write_failed(&folder, &error);
    }
    // What an example extends comes with it.
    let mut wanted: Vec<&Example> = vec![example];
    while let Some(base) = wanted.last().and_then(|e| e.base()) {
        wanted.push(base);
    }
    let force = matches.get_flag("force");
    let mut files = Vec::new();
    for (index, file) in wanted.iter().enumerate() {
        let path = folder.join(file.file_name());
        // A base that is already there, unchanged, is what was asked for.
        let same = std::fs::read_to_string(&path).is_ok_and(|text| text == file.text);
        if path.exists() && !force && !(same && index > 0) {
            output::narrate(&format!(
                "error[E0122]: `{}` exists already\n  = help: choose another folder with --dir, or overwrite it with --force\n",
                path.display()
            ));
            return exit::IO;
        }
        files.push((path, file.text));
    }
    for (path, text) in &files {
        if let Err(error) = output::write(path, text) {
            return output::write_failed(path, &error);
        }
        output::narrate(&format!("wrote {}\n", path.display()));
    }
    if let Some((path, _)) = files.first() {
        output::narrate(&format!("next: forcewright solve {} --out out\n", path.display()));
    }
    exit::MET
}
