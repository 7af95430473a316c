//! What `cargo metadata` says about the workspace.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use serde_json::Value;

use crate::Workspace;
use crate::step::output_of;

/// One package of the workspace.
#[derive(Clone, Debug)]
pub(crate) struct Package {
    /// Its name.
    pub(crate) name: String,
    /// The sentence in its manifest.
    pub(crate) description: String,
    /// Its folder relative to the workspace's root, with forward slashes.
    pub(crate) folder: String,
    /// Names of what it needs to be built and run; what only its tests need is left out.
    pub(crate) dependencies: Vec<String>,
}

/// The workspace as cargo sees it.
#[derive(Clone, Debug)]
pub(crate) struct Metadata {
    /// Its packages, by folder.
    pub(crate) packages: Vec<Package>,
    /// Where cargo builds.
    pub(crate) target: PathBuf,
}

/// The cargo that runs this, or the one in the path.
pub(crate) fn cargo(workspace: &Workspace) -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.current_dir(&workspace.root);
    command
}

/// Asks cargo.
///
/// # Errors
/// When cargo cannot be run or says something unexpected.
pub(crate) fn read(workspace: &Workspace) -> Result<Metadata, String> {
    let mut command = cargo(workspace);
    let text = output_of(command.args(["metadata", "--format-version", "1", "--no-deps"]), Duration::from_mins(5))?;
    let value: Value = serde_json::from_str(&text).map_err(|error| format!("cargo metadata: {error}"))?;
    parse(&value)
}

fn parse(value: &Value) -> Result<Metadata, String> {
    let text = |value: &Value, key: &str| value[key].as_str().map(str::to_owned).ok_or_else(|| format!("cargo metadata has no `{key}`"));
    let root = PathBuf::from(text(value, "workspace_root")?);
    let mut packages = Vec::new();
    for package in value["packages"].as_array().ok_or("cargo metadata has no `packages`")? {
        let manifest = PathBuf::from(text(package, "manifest_path")?);
        let folder = manifest.parent().and_then(|folder| folder.strip_prefix(&root).ok()).unwrap_or(Path::new(""));
        let dependencies = package["dependencies"].as_array().into_iter().flatten();
        let mut dependencies: Vec<String> = dependencies
            .filter(|dependency| dependency["kind"] != "dev")
            .map(|dependency| text(dependency, "name"))
            .collect::<Result<_, _>>()?;
        dependencies.sort();
        dependencies.dedup();
        packages.push(Package {
            name: text(package, "name")?,
            description: package["description"].as_str().unwrap_or_default().to_owned(),
            folder: folder.to_string_lossy().replace('\\', "/"),
            dependencies,
        });
    }
    packages.sort_by(|a, b| a.folder.cmp(&b.folder));
    Ok(Metadata { packages, target: PathBuf::from(text(value, "target_directory")?) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normal_and_build_dependencies_are_read_and_those_of_tests_are_not() {
        let value = serde_json::json!({
            "workspace_root": "/w", "target_directory": "/t",
            "packages": [{ "name": "a", "description": "An a.", "manifest_path": "/w/crates/a/Cargo.toml", "dependencies": [
                { "name": "n", "kind": null }, { "name": "b", "kind": "build" }, { "name": "d", "kind": "dev" }, { "name": "n", "kind": null },
            ] }],
        });
        let metadata = parse(&value).unwrap();
        assert_eq!(metadata.packages[0].folder, "crates/a");
        assert_eq!(metadata.packages[0].dependencies, ["b", "n"]);
        assert_eq!(metadata.target, Path::new("/t"));
        assert!(parse(&serde_json::json!({})).is_err());
    }
}
