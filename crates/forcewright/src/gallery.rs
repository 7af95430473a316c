//! The gallery: example projects that come with the library.

/// An example project.
#[derive(Clone, Copy, Debug)]
pub struct Example {
    /// Name: family and file, `compliant/lan-table3`.
    pub name: &'static str,
    /// The project file.
    pub text: &'static str,
}

macro_rules! examples {
    ($($name:literal),* $(,)?) => {
        &[$(Example { name: $name, text: include_str!(concat!("../../../examples/", $name, ".toml")) }),*]
    };
}

/// Every example, in the order in which to look at them.
pub const EXAMPLES: &[Example] = examples![
    "compliant/cantilever",
    "compliant/tapered-spring",
    "compliant/parallel-guide",
    "compliant/preloaded-guide",
    "compliant/folded-guide",
    "compliant/gripper-finger",
    "compliant/slider-crank",
    "compliant/constant-force-pair",
    "compliant/bistable-arch",
    "compliant/williams-toggle",
    "compliant/lan-table3",
    "compliant/lan-thin",
    "compliant/lan-sub-cfm",
    "compliant/lan-end-effector",
    "compliant/lan-two-layers",
    "compliant/lan-circular",
    "compliant/lan-end-effector-surface",
    "compliant/two-directions",
    "compliant/optimise-lan-box",
    "compliant/optimise-lan-equal-forces",
    "compliant/tolerance-lan-thin",
    "compliant/calibrate-lan-solid",
    "cam/sanchez-2-springs",
    "cam/sanchez-4-springs",
    "cam/sanchez-6-springs",
    "cam/no-undercut",
    "cam/rising-force",
    "cam/compensated",
    "cam/push-springs",
    "cam/measured-profile",
    "cam/bench-press",
    "cam/weight-release",
    "cam/torque-cam",
    "cam/calibrate-sanchez",
    "capstan/longval",
    "capstan/haptic-handle",
    "capstan/quadruped-leg",
    "capstan/pointing-stage",
    "capstan/calibrate-longval",
    "capstan/pareto-handle",
    "lavt/butin-1",
    "lavt/butin-2",
    "lavt/butin-3",
    "lavt/bench",
    "lavt/prosthetic-hand",
    "lavt/calibrate-butin-2",
    "lavt/pareto-gears",
];

macro_rules! data {
    ($family:literal: $($name:literal),* $(,)?) => {
        &[$(($name, include_str!(concat!("../../../examples/", $family, "/", $name)))),*]
    };
}

/// Tables of data that examples name: file names and texts.
const DATA: &[&[(&str, &str)]] = &[
    data!["compliant": "cam-5mm.csv", "cam-3mm.csv", "lan-solid.csv"],
    data!["cam": "measured-cam.csv", "loop.csv"],
    data!["capstan": "stiffness.csv"],
    data!["lavt": "bench.csv", "butin-2-lines.csv"],
];

/// An example by its name, with or without its family.
pub fn find(name: &str) -> Option<&'static Example> {
    let plain = name.trim_end_matches(".toml");
    EXAMPLES.iter().find(|e| e.name == plain || e.name.rsplit('/').next() == Some(plain))
}

impl Example {
    /// The file's name: `lan-table3.toml`.
    pub fn file_name(&self) -> String {
        format!("{}.toml", self.name.rsplit('/').next().unwrap_or(self.name))
    }

    /// The title that the file gives itself.
    pub fn title(&self) -> &'static str {
        let line = self.text.lines().find_map(|l| l.strip_prefix("title = \""));
        line.and_then(|l| l.split('"').next()).unwrap_or("")
    }

    /// The tables of data that it names, in its variants too: file names and texts.
    pub fn data(&self) -> impl Iterator<Item = (&'static str, &'static str)> {
        DATA.iter().copied().flatten().filter(|(name, _)| self.text.contains(&format!("\"{name}\""))).copied()
    }

    /// The example that this one extends, if it does.
    pub fn base(&self) -> Option<&'static Self> {
        let line = self.text.lines().find_map(|l| l.strip_prefix("extends = \""))?;
        find(line.split('"').next()?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_example_file_is_in_the_gallery_and_has_a_title() {
        let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
        let (mut files, mut data) = (Vec::new(), Vec::new());
        for family in std::fs::read_dir(root).unwrap() {
            let family = family.unwrap();
            for file in std::fs::read_dir(family.path()).unwrap() {
                let file = file.unwrap().file_name().into_string().unwrap();
                if let Some(stem) = file.strip_suffix(".toml") {
                    files.push(format!("{}/{stem}", family.file_name().into_string().unwrap()));
                } else {
                    data.push(file);
                }
            }
        }
        files.sort();
        let mut listed: Vec<String> = EXAMPLES.iter().map(|e| e.name.to_owned()).collect();
        listed.sort();
        assert_eq!(files, listed);
        assert!(EXAMPLES.iter().all(|e| !e.title().is_empty()));
        data.sort();
        let mut named: Vec<&str> = EXAMPLES.iter().flat_map(|e| e.data().map(|(name, _)| name)).collect();
        named.sort_unstable();
        named.dedup();
        assert_eq!(data, named, "tables of data that no example names");
        assert_eq!(find("lan-thin").and_then(Example::base).map(|e| e.name), Some("compliant/lan-table3"));
    }
}
