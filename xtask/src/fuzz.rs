//! Noise for the readers, with cargo-fuzz when it is installed.

use std::process::{Command, ExitCode};
use std::time::Duration;

use crate::Workspace;
use crate::metadata::cargo;
use crate::step::{Outcome, Steps, captured, output_of, visible};

const TARGET: &str = "project_file";

/// The command `fuzz`.
pub(crate) fn run(workspace: &Workspace, seconds: u64) -> Result<ExitCode, String> {
    let limit = Duration::from_mins(1);
    let installed = captured(cargo(workspace).args(["fuzz", "--version"]), limit).is_ok_and(|finished| finished.code == Some(0));
    let mut steps = Steps::default();
    if !installed {
        steps.run("fuzz", || {
            Outcome::NotRun("cargo-fuzz is not installed: `cargo install cargo-fuzz`; it also needs a C++ compiler".into())
        });
        return Ok(steps.summary("fuzz"));
    }
    let folder = workspace.root.join("fuzz");
    let rustc = output_of(Command::new(std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into())).arg("--version"), limit)?;
    std::fs::create_dir_all(folder.join("corpus").join(TARGET)).map_err(|error| format!("fuzz/corpus: {error}"))?;
    let mut command = cargo(workspace);
    command.args(["fuzz", "run", TARGET, &format!("corpus/{TARGET}"), &format!("seeds/{TARGET}"), "--"]);
    command.args([
        format!("-max_total_time={seconds}"),
        format!("-dict={TARGET}.dict"),
        "-timeout=10".into(),
        "-rss_limit_mb=2048".into(),
        "-max_len=16384".into(),
    ]);
    command.current_dir(folder);
    if !rustc.contains("nightly") {
        // The sanitizers are unstable options of the compiler.
        command.env("RUSTC_BOOTSTRAP", "1");
    }
    steps.run(&format!("fuzz {TARGET} for {seconds} s"), || visible(&mut command));
    Ok(steps.summary("fuzz"))
}
