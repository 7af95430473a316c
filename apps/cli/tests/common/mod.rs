//! Running the real program, with a limit of time.
#![allow(dead_code, reason = "each test file uses a part of it")]
#![allow(clippy::unwrap_used, reason = "a test that cannot run its program fails")]

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Far above what any call may take.
const LIMIT: Duration = Duration::from_secs(20);

/// The example that everybody starts from.
pub(crate) const EXAMPLE: &str = include_str!("../../../../examples/compliant/lan-table3.toml");

/// A strip clamped at one end and kept parallel at the other: with small deflections F = 12EIδ/L³ and σ = 6E(w/2)δ/L².
pub(crate) const GUIDED: &str = r#"# A guided strip.
schema = 1
mechanism = "compliant"
title = "A guided strip"

[requirements]
stress = { safety_factor = 2 }       # keep

[material]
use = "C75S"
young_modulus = "200 GPa"
yield_stress = "600 MPa"

[design]
thickness = "0.5 mm"   # in the plane
depth = '10 mm'

[design.nodes]
a = { at = ["0 mm", "0 mm"], support = "clamped" }
b = { at = ["100 mm", "0 mm"], support = "parallel" } # guided

[[design.beams]]
name = "strip"
between = ["a", "b"]
straight = true

[load]
node = "b"
direction = [0, 1]
travel = "0.1 mm"

[model]
beam = "inextensible"

[optimise]
objective = { maximise = "force_at_end" }
variables = { "design.thickness" = { range = ["0.2 mm", "80 mm"] } }
"#;

/// What a run gave.
#[derive(Debug)]
pub(crate) struct Run {
    /// Exit code; `None` after a signal.
    pub(crate) code: Option<i32>,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
    pub(crate) took: Duration,
}

impl Run {
    /// The one JSON document on standard output.
    pub(crate) fn json(&self) -> serde_json::Value {
        serde_json::from_str(&self.stdout).unwrap_or_else(|e| panic!("{e} in\n{}", self.stdout))
    }

    /// Asserts an error of the file or the call, told in full.
    pub(crate) fn assert_refused(&self, what: &str) {
        assert!(matches!(self.code, Some(2 | 4)), "{what}: {:?}\n{}", self.code, self.stderr);
        assert!(self.stderr.contains("error[E"), "{what}: {}", self.stderr);
        self.assert_plain(what);
    }

    /// Asserts that nothing could move the cursor of a terminal.
    pub(crate) fn assert_plain(&self, what: &str) {
        let raw = |c: char| c.is_control() && c != '\n' && c != '\t';
        assert!(!self.stderr.contains(raw) && !self.stdout.contains(raw), "{what}: {:?} {:?}", self.stderr, self.stdout);
    }
}

/// Runs the program in a folder; killed, and failed, after the limit.
pub(crate) fn run<S: AsRef<std::ffi::OsStr>>(folder: &Path, arguments: &[S]) -> Run {
    let streams = tempfile::tempdir().unwrap();
    let (out, err) = (streams.path().join("out"), streams.path().join("err"));
    let started = Instant::now();
    let mut child = Command::new(env!("CARGO_BIN_EXE_forcewright"))
        .args(arguments)
        .current_dir(folder)
        .stdin(Stdio::null())
        .stdout(std::fs::File::create(&out).unwrap())
        .stderr(std::fs::File::create(&err).unwrap())
        .spawn()
        .unwrap();
    let status = loop {
        if let Some(status) = child.try_wait().unwrap() {
            break status;
        }
        if started.elapsed() > LIMIT {
            child.kill().unwrap();
            child.wait().unwrap();
            let arguments: Vec<_> = arguments.iter().map(|a| a.as_ref().to_string_lossy().chars().take(80).collect::<String>()).collect();
            panic!("{arguments:?} took more than {LIMIT:?}");
        }
        std::thread::sleep(Duration::from_millis(2));
    };
    let read = |path: PathBuf| String::from_utf8_lossy(&std::fs::read(path).unwrap()).into_owned();
    Run { code: status.code(), stdout: read(out), stderr: read(err), took: started.elapsed() }
}

/// An empty folder with the example in `a.toml`.
pub(crate) fn folder() -> tempfile::TempDir {
    folder_with(EXAMPLE.as_bytes())
}

/// An empty folder with these bytes in `a.toml`.
pub(crate) fn folder_with(bytes: &[u8]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("a.toml"), bytes).unwrap();
    folder
}

/// A number of a JSON document; not a number where it is none.
pub(crate) fn number(value: &serde_json::Value) -> f64 {
    value.as_f64().unwrap_or(f64::NAN)
}

/// Asserts that a value is the wanted one up to a relative difference.
pub(crate) fn assert_near(found: f64, wanted: f64, relative: f64, what: &str) {
    assert!((found / wanted - 1.0).abs() < relative, "{what}: {found}, wanted {wanted}");
}

/// Everything in a folder, sorted.
pub(crate) fn listing(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// Seeded noise (splitmix64): the same in every run.
pub(crate) struct Noise(pub(crate) u64);

impl Noise {
    pub(crate) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Less than `n`.
    pub(crate) fn below(&mut self, n: usize) -> usize {
        usize::try_from(self.next() % u64::try_from(n.max(1)).unwrap()).unwrap()
    }
}
