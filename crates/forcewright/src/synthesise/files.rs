//! Files of a synthesis: what was read once, and the user's text with and without a design.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use forcewright_contract::project::{FileError, Files};

/// Files as they were read: editing them meanwhile does not mix two projects.
#[derive(Clone)]
pub(super) struct Known(pub BTreeMap<PathBuf, Result<String, FileError>>);

impl Files for Known {
    fn read(&self, path: &Path) -> Result<String, FileError> {
        self.0.get(path).cloned().unwrap_or(Err(FileError::NotFound))
    }
}

impl Known {
    /// With a text at a path.
    pub(super) fn with(&self, path: &Path, text: &str) -> Self {
        let mut all = self.0.clone();
        all.insert(path.to_owned(), Ok(text.to_owned()));
        Self(all)
    }
}

/// Reads files and keeps them.
pub(super) struct Recorder<'a> {
    files: &'a dyn Files,
    read: RefCell<BTreeMap<PathBuf, Result<String, FileError>>>,
}

impl<'a> Recorder<'a> {
    pub(super) fn new(files: &'a dyn Files) -> Self {
        Self { files, read: RefCell::default() }
    }

    /// Another text in the place of a file.
    pub(super) fn put(&self, path: &Path, text: String) {
        self.read.borrow_mut().insert(path.to_owned(), Ok(text));
    }

    pub(super) fn known(self) -> Known {
        Known(self.read.into_inner())
    }
}

impl Files for Recorder<'_> {
    fn read(&self, path: &Path) -> Result<String, FileError> {
        if let Some(known) = self.read.borrow().get(path) {
            return known.clone();
        }
        let text = self.files.read(path);
        self.read.borrow_mut().insert(path.to_owned(), text.clone());
        text
    }
}

/// A shortened text with empty lines where lines are gone, so that places in it are those of the whole.
pub(super) fn aligned(whole: &str, shortened: &str) -> String {
    let mut left = shortened.lines().peekable();
    let mut out: Vec<&str> = whole.lines().map(|line| left.next_if(|next| *next == line).unwrap_or("")).collect();
    // What was not found in its place stands at the end.
    out.extend(left);
    out.join("\n") + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;
    use forcewright_contract::edit::without_tables;

    #[test]
    fn lines_keep_their_places() {
        let whole =
            "schema = 1\n[design]\nthickness = \"1 mm\"\n\n[material]\nuse = \"POM-C\"\n[[design.beams]]\nname = \"b\"\n[process]\n";
        let (bare, gone) = without_tables(whole, &["design", "load"]).unwrap();
        assert_eq!(gone, ["design"]);
        assert!(!bare.contains("beams") && !bare.contains("thickness"), "{bare}");
        let aligned = aligned(whole, &bare);
        for line in ["schema = 1", "[material]", "use = \"POM-C\"", "[process]"] {
            let place = |text: &str| text.lines().position(|l| l == line);
            assert_eq!(place(&aligned), place(whole), "{line}");
        }
    }
}
