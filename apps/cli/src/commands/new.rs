//! `forcewright new`: a project file from the gallery.

use std::path::PathBuf;

use clap::ArgMatches;
use forcewright::base::text::{closest, visible};
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
        output::complain("E0121", &format!("there is no example `{}`", name.chars().take(60).collect::<String>()), &help, false);
        return exit::USAGE;
    };
    let folder = matches.get_one::<PathBuf>("dir").cloned().unwrap_or_default();
    if let Err(failed) = output::prepare(&folder) {
        return output::write_failed(&failed, false);
    }
    // What an example extends, and the data that it names, come with it.
    let mut wanted: Vec<&Example> = vec![example];
    while let Some(base) = wanted.last().and_then(|e| e.base()) {
        wanted.push(base);
    }
    let force = matches.get_flag("force");
    let mut files = Vec::new();
    let projects = wanted.iter().map(|e| (e.file_name(), e.text));
    let data = wanted.iter().flat_map(|e| e.data()).map(|(name, text)| (name.to_owned(), text));
    for (index, (name, text)) in projects.chain(data).enumerate() {
        let path = folder.join(&name);
        // A base, or a table of data, that is already there, unchanged, is what was asked for.
        let same = std::fs::read_to_string(&path).is_ok_and(|found| found == text);
        if path.exists() && !force && !(same && index > 0) {
            let message = format!("`{}` exists already", path.display());
            output::complain("E0122", &message, "choose another folder with --dir, or overwrite it with --force", false);
            return exit::IO;
        }
        files.push((name, text.to_owned()));
    }
    if let Err(failed) = output::write_all(&folder, &files) {
        return output::write_failed(&failed, false);
    }
    for (name, _) in &files {
        output::narrate(&visible(&format!("wrote {}", folder.join(name).display())));
        output::narrate("\n");
    }
    if let Some((name, _)) = files.first() {
        output::narrate(&visible(&format!("next: forcewright solve {} --out out", folder.join(name).display())));
        output::narrate("\n");
    }
    exit::MET
}
