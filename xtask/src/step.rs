//! Steps: run a thing, time it, remember how it ended, and sum up.

use std::io::Read;
use std::path::Path;
use std::process::{Command, ExitCode, Stdio};
use std::time::{Duration, Instant};

/// How a step ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// It did what it should.
    Passed,
    /// It did not; why.
    Failed(String),
    /// It could not be run here; why. Never counted as passed.
    NotRun(String),
}

impl Outcome {
    /// Passed when there is nothing to complain about, otherwise failed with the complaints, one a line.
    pub(crate) fn from_problems(problems: &[String]) -> Self {
        if problems.is_empty() { Self::Passed } else { Self::Failed(problems.join("\n")) }
    }

    fn word(&self) -> &'static str {
        match self {
            Self::Passed => "passed",
            Self::Failed(_) => "FAILED",
            Self::NotRun(_) => "not run",
        }
    }

    fn reason(&self) -> Option<&str> {
        match self {
            Self::Passed => None,
            Self::Failed(reason) | Self::NotRun(reason) => Some(reason),
        }
    }
}

struct Entry {
    name: String,
    outcome: Outcome,
    duration: Duration,
}

/// The steps of one task.
#[derive(Default)]
pub(crate) struct Steps {
    entries: Vec<Entry>,
}

impl Steps {
    /// Runs one step: prints its name first and its end afterwards. Gives whether it passed.
    pub(crate) fn run(&mut self, name: &str, action: impl FnOnce() -> Outcome) -> bool {
        println!("== {name}");
        let start = Instant::now();
        let outcome = action();
        self.record(name, outcome, start.elapsed())
    }

    /// Records a step that was timed elsewhere. Gives whether it passed.
    pub(crate) fn record(&mut self, name: &str, outcome: Outcome, duration: Duration) -> bool {
        println!("   {:<7} {:>7.1} s  {name}", outcome.word(), duration.as_secs_f64());
        for line in outcome.reason().into_iter().flat_map(str::lines) {
            println!("             {line}");
        }
        let passed = outcome == Outcome::Passed;
        self.entries.push(Entry { name: name.to_owned(), outcome, duration });
        passed
    }

    /// Numbers of steps passed, failed and not run.
    pub(crate) fn counts(&self) -> (usize, usize, usize) {
        let count = |word: &str| self.entries.iter().filter(|entry| entry.outcome.word() == word).count();
        (count("passed"), count("FAILED"), count("not run"))
    }

    /// The plain closing line.
    pub(crate) fn closing_line(&self) -> String {
        let (passed, failed, not_run) = self.counts();
        format!("{passed} passed, {failed} failed, {not_run} skipped")
    }

    /// Prints the table of all steps. The exit code is 1 when any failed.
    pub(crate) fn summary(&self, task: &str) -> ExitCode {
        let total: f64 = self.entries.iter().map(|entry| entry.duration.as_secs_f64()).sum();
        println!("\n{task}: {} steps in {total:.1} s", self.entries.len());
        for entry in &self.entries {
            let first_line = entry.outcome.reason().and_then(|reason| reason.lines().next()).map(|line| format!(": {line}"));
            println!(
                "  {:<7} {:>7.1} s  {}{}",
                entry.outcome.word(),
                entry.duration.as_secs_f64(),
                entry.name,
                first_line.unwrap_or_default()
            );
        }
        if self.counts().1 == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
    }
}

/// The command as one would type it, for messages.
pub(crate) fn shown(command: &Command) -> String {
    // Without its folder, which differs from machine to machine.
    let program = Path::new(command.get_program()).file_stem().unwrap_or(command.get_program());
    let words = std::iter::once(program).chain(command.get_args());
    words.map(|word| word.to_string_lossy().into_owned()).collect::<Vec<_>>().join(" ")
}

/// Runs a command whose output people should see as it comes.
pub(crate) fn visible(command: &mut Command) -> Outcome {
    match command.stdin(Stdio::null()).status() {
        Ok(status) if status.success() => Outcome::Passed,
        Ok(status) => Outcome::Failed(format!("`{}` ended with {status}", shown(command))),
        Err(error) => Outcome::Failed(format!("`{}` cannot be started: {error}", shown(command))),
    }
}

/// What a finished command left.
#[derive(Debug)]
pub(crate) struct Finished {
    /// Exit code; `None` after a signal.
    pub(crate) code: Option<i32>,
    /// Everything printed to standard output.
    pub(crate) stdout: String,
    /// Everything printed to standard error.
    pub(crate) stderr: String,
}

impl Finished {
    /// The last lines of standard error, or of standard output when that is empty.
    pub(crate) fn tail(&self) -> String {
        let text = if self.stderr.trim().is_empty() { &self.stdout } else { &self.stderr };
        let lines: Vec<&str> = text.trim_end().lines().collect();
        lines[lines.len().saturating_sub(12)..].join("\n")
    }
}

/// Runs a command to its end, or ends it after `limit`.
///
/// # Errors
/// When it cannot be started, or was not finished in time.
pub(crate) fn captured(command: &mut Command, limit: Duration) -> Result<Finished, String> {
    let name = shown(command);
    let cannot = |error: std::io::Error| format!("`{name}` cannot be run: {error}");
    let mut child = command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().map_err(cannot)?;
    let stdout = read_aside(child.stdout.take());
    let stderr = read_aside(child.stderr.take());
    let start = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait().map_err(cannot)? {
            break status;
        }
        if start.elapsed() > limit {
            child.kill().map_err(cannot)?;
            child.wait().map_err(cannot)?;
            return Err(format!("`{name}` was not finished after {} s", limit.as_secs()));
        }
        std::thread::sleep(Duration::from_millis(5));
    };
    let text = |thread: std::thread::JoinHandle<String>| thread.join().unwrap_or_default();
    Ok(Finished { code: status.code(), stdout: text(stdout), stderr: text(stderr) })
}

/// The standard output of a command that must succeed.
///
/// # Errors
/// When it cannot be started, is not finished in time, or ends with anything but 0.
pub(crate) fn output_of(command: &mut Command, limit: Duration) -> Result<String, String> {
    let finished = captured(command, limit)?;
    match finished.code {
        Some(0) => Ok(finished.stdout),
        code => {
            let code = code.map_or_else(|| "a signal".to_owned(), |code| format!("exit code {code}"));
            Err(format!("`{}` ended with {code}\n{}", shown(command), finished.tail()))
        }
    }
}

fn read_aside(stream: Option<impl Read + Send + 'static>) -> std::thread::JoinHandle<String> {
    std::thread::spawn(move || {
        let mut bytes = Vec::new();
        if let Some(mut stream) = stream {
            // What came before a read error is still worth showing.
            let _ = stream.read_to_end(&mut bytes);
        }
        String::from_utf8_lossy(&bytes).into_owned()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_summary_counts_not_run_as_skipped_and_never_as_passed() {
        let mut steps = Steps::default();
        assert!(steps.run("a", || Outcome::Passed));
        assert!(!steps.run("b", || Outcome::NotRun("no browser".into())));
        assert_eq!(steps.closing_line(), "1 passed, 0 failed, 1 skipped");
        assert_eq!(steps.summary("test"), ExitCode::SUCCESS);
        assert!(!steps.run("c", || Outcome::from_problems(&["one".into(), "two".into()])));
        assert_eq!(steps.closing_line(), "1 passed, 1 failed, 1 skipped");
        assert_eq!(steps.summary("test"), ExitCode::FAILURE);
    }

    #[test]
    fn a_missing_program_is_a_failure_with_its_name() {
        let error = captured(&mut Command::new("no-such-program-here"), Duration::from_secs(1)).unwrap_err();
        assert!(error.contains("no-such-program-here"), "{error}");
    }

    #[cfg(unix)]
    #[test]
    fn exit_codes_output_and_time_limits_are_seen() {
        let mut command = Command::new("sh");
        command.args(["-c", "echo out; echo err >&2; exit 3"]);
        let finished = captured(&mut command, Duration::from_secs(10)).unwrap();
        assert_eq!((finished.code, finished.stdout.as_str(), finished.stderr.as_str()), (Some(3), "out\n", "err\n"));
        assert!(output_of(&mut command, Duration::from_secs(10)).unwrap_err().contains("exit code 3"));
        let mut slow = Command::new("sleep");
        assert!(captured(slow.arg("20"), Duration::from_millis(50)).unwrap_err().contains("not finished"));
    }
}
