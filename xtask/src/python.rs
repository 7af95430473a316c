//! Python with pinned packages, for tools that know nothing of this project.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

use crate::Workspace;
use crate::step::{Outcome, Steps, output_of};
use crate::test::emptied;

/// A set of packages.
pub(crate) struct Packages {
    /// File of the pins, below the workspace's root.
    requirements: &'static str,
    /// Folder of the environment.
    folder: &'static str,
    /// The packages that matter, for people.
    what: &'static str,
    /// How long installing may take.
    limit: Duration,
}

/// What every test needs.
pub(crate) const TOOLS: Packages = Packages {
    requirements: "xtask/python/requirements.txt",
    folder: "venv",
    what: "jsonschema, ezdxf and trimesh",
    limit: Duration::from_mins(5),
};

/// A CAD kernel: some hundred megabytes.
pub(crate) const CAD: Packages =
    Packages { requirements: "xtask/python/requirements-cad.txt", folder: "venv-cad", what: "OpenCASCADE", limit: Duration::from_mins(20) };

impl Packages {
    /// The Python of an environment with the packages, made in `folder` if need be, and the step that says so. Without them, the plain
    /// Python and the reason for checks that are not run.
    pub(crate) fn python(&self, workspace: &Workspace, folder: &Path, steps: &mut Steps) -> (PathBuf, Option<String>) {
        let start = Instant::now();
        let name = format!("python: environment with {}", self.what);
        match self.environment(workspace, folder) {
            Ok(python) => {
                steps.record(&name, Outcome::Passed, start.elapsed());
                (python, None)
            }
            Err(reason) => {
                steps.record(&name, Outcome::NotRun(reason), start.elapsed());
                (PathBuf::from(python_name()), Some(format!("no environment with {}", self.what)))
            }
        }
    }

    /// The environment, made once and made anew when the pins change.
    fn environment(&self, workspace: &Workspace, folder: &Path) -> Result<PathBuf, String> {
        let requirements = workspace.root.join(self.requirements);
        let pins = std::fs::read_to_string(&requirements).map_err(|error| format!("{}: {error}", requirements.display()))?;
        let folder = folder.join(self.folder);
        let python = if cfg!(windows) { folder.join("Scripts/python.exe") } else { folder.join("bin/python") };
        let done = folder.join("installed.txt");
        if python.exists() && std::fs::read_to_string(&done).is_ok_and(|installed| installed == pins) {
            return Ok(python);
        }
        emptied(&folder)?;
        let cannot = |error: String| format!("{} could not be installed\n{error}", self.what);
        output_of(Command::new(python_name()).args(["-m", "venv"]).arg(&folder), self.limit).map_err(cannot)?;
        let pip = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-input", "--requirement"];
        output_of(Command::new(&python).args(pip).arg(&requirements), self.limit).map_err(cannot)?;
        std::fs::write(&done, pins).map_err(|error| format!("{}: {error}", done.display()))?;
        Ok(python)
    }
}

/// The name under which Python 3 is found.
pub(crate) fn python_name() -> &'static str {
    if cfg!(windows) { "python" } else { "python3" }
}
