//! The report in a browser: finds or installs Chromium and hands over to `python/browser.py`.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

use serde_json::json;

use crate::Workspace;
use crate::python::python_name;
use crate::step::{Outcome, Steps, output_of};
use crate::test::{Solved, emptied, run_script};

const NAMES: [&str; 5] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome"];
const MAC: &str = "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome";
const HOW: &str = "install Chromium (Debian: `apt-get install chromium`), or name one in the variable CHROMIUM";

/// Opens the reports of all solved examples.
pub(crate) fn run(workspace: &Workspace, folder: &Path, solved: &[Solved], steps: &mut Steps) {
    let start = Instant::now();
    let browser = find().map_or_else(install, Ok);
    let browser = match browser {
        Ok(browser) => browser,
        Err(reason) => {
            steps.record("browser: Chromium", Outcome::NotRun(reason), start.elapsed());
            return;
        }
    };
    steps.record(&format!("browser: {}", browser.display()), Outcome::Passed, start.elapsed());
    let pictures = folder.join("report");
    if let Err(error) = emptied(&pictures) {
        steps.record("browser", Outcome::Failed(error), Duration::ZERO);
        return;
    }
    if solved.is_empty() {
        steps.record("browser", Outcome::NotRun("no report to look at".into()), Duration::ZERO);
        return;
    }
    let page = |solved: &Solved| json!({ "name": solved.example.slug(), "file": solved.folder.join("report.html"), "out": pictures.join(solved.example.slug()) });
    let job = json!({ "browser": browser, "pages": solved.iter().map(page).collect::<Vec<_>>() });
    let mut command = Command::new(python_name());
    command.current_dir(&workspace.root).arg("xtask/python/browser.py");
    run_script(&mut command, &folder.join("browser.json"), &job, "browser", Duration::from_mins(20), steps);
    println!("   pictures and PDF files: {}", pictures.display());
}

/// The browser named in `CHROMIUM`, or the first in the path.
fn find() -> Option<PathBuf> {
    if let Some(named) = std::env::var_os("CHROMIUM") {
        return Some(PathBuf::from(named));
    }
    let folders: Vec<PathBuf> = std::env::var_os("PATH").map(|path| std::env::split_paths(&path).collect()).unwrap_or_default();
    let places =
        NAMES.iter().flat_map(|name| folders.iter().map(move |folder| folder.join(format!("{name}{}", std::env::consts::EXE_SUFFIX))));
    places.chain([PathBuf::from(MAC)]).find(|place| place.is_file())
}

/// Installs Debian's Chromium where this is allowed without asking: as root, in containers and on build machines.
fn install() -> Result<PathBuf, String> {
    let is_root = output_of(Command::new("id").arg("-u"), Duration::from_secs(10)).is_ok_and(|id| id.trim() == "0");
    if !is_root {
        return Err(format!("no Chromium here, and no right to install one; {HOW}"));
    }
    let apt = |args: &[&str]| {
        let mut command = Command::new("apt-get");
        command.args(["-o", "DPkg::Lock::Timeout=300"]).args(args).env("DEBIAN_FRONTEND", "noninteractive");
        output_of(&mut command, Duration::from_mins(15)).map_err(|error| format!("{error}\n{HOW}"))
    };
    println!("   no Chromium found; installing Debian's");
    apt(&["update"])?;
    apt(&["install", "-y", "--no-install-recommends", "chromium", "fonts-liberation"])?;
    find().ok_or_else(|| format!("apt-get installed no Chromium; {HOW}"))
}
