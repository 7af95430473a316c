//! The table on disk: a part that grows row by row and survives being killed, and the whole that it becomes.
//!
//! A part is a line of JSON that says which sweep it belongs to, the header, and rows of CSV. Whatever was cut short at its end is cut
//! away when the sweep goes on. The whole is written beside its place and renamed into it.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, BufRead, BufReader, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::table::{lead, line, split};
use super::{Column, Row, Shard, Sweep, SweepError, Tally, npy, refused_call};

/// Which files the whole table becomes. Beside them stands a JSON document with columns, units and counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Formats {
    /// Comma-separated values: `OUT.csv`.
    pub csv: bool,
    /// An array for `numpy`, `OUT.npy`: doubles, one column per number or word; words as their place in the document's list, what is
    /// missing as NaN.
    pub npy: bool,
}

/// Where the table goes.
#[derive(Clone, Debug)]
pub struct Outputs {
    folder: PathBuf,
    stem: String,
    formats: Formats,
    force: bool,
}

/// How a table stands when a sweep starts.
#[derive(Debug)]
pub enum Started {
    /// It is there already, of this very sweep.
    Complete(Tally),
    /// It is begun, or continued.
    Open(PartFile),
}

fn at<T>(path: &Path, result: io::Result<T>) -> Result<T, SweepError> {
    result.map_err(|error| SweepError::File { path: path.to_owned(), error })
}

fn reading<T>(path: &Path, result: io::Result<T>) -> Result<T, SweepError> {
    result.map_err(|error| SweepError::Unreadable { path: path.to_owned(), error })
}

impl Outputs {
    /// Outputs named by a path: `table.csv` (or `.npy`) names the files, anything else the folder of `sweep.csv`. With `force`, files of
    /// another sweep are overwritten.
    pub fn new(path: &Path, formats: Formats, force: bool) -> Self {
        let named = path.extension().is_some_and(|e| e == "csv" || e == "npy") && !path.is_dir();
        let stem = path.file_stem().filter(|_| named).map_or_else(|| "sweep".to_owned(), |s| s.to_string_lossy().into_owned());
        let folder = if named { path.parent().unwrap_or(Path::new("")).to_owned() } else { path.to_owned() };
        Self { folder, stem, formats, force }
    }

    fn place(&self, ending: &str) -> PathBuf {
        self.folder.join(format!("{}.{ending}", self.stem))
    }

    /// The files that the whole table becomes.
    pub fn files(&self) -> Vec<PathBuf> {
        let wanted = [("csv", self.formats.csv), ("npy", self.formats.npy), ("json", true)];
        wanted.iter().filter(|(_, wanted)| *wanted).map(|(ending, _)| self.place(ending)).collect()
    }

    /// The file that grows meanwhile: `table.part`, or `table.2-of-4.part`.
    pub fn part(&self, shard: Shard) -> PathBuf {
        if shard == Shard::WHOLE { self.place("part") } else { self.place(&format!("{}-of-{}.part", shard.index, shard.of)) }
    }

    /// Opens the part of a shard, to begin it or to go on where it ends.
    ///
    /// # Errors
    /// E0132 for files of another sweep, E0135 if another process writes them, and what the system says.
    pub fn start(&self, sweep: &Sweep, shard: Shard) -> Result<Started, SweepError> {
        let folder = if self.folder.as_os_str().is_empty() { Path::new(".") } else { &self.folder };
        at(folder, std::fs::create_dir_all(folder))?;
        let part = self.part(shard);
        if shard == Shard::WHOLE
            && let Some(tally) = self.standing(sweep.document())?
            && !part.exists()
        {
            return Ok(Started::Complete(tally));
        }
        PartFile::open(part, sweep, shard, self.force).map(Started::Open)
    }

    /// The counts of the whole table, if all its files are there and of this sweep.
    fn standing(&self, document: &Value) -> Result<Option<Tally>, SweepError> {
        let files = self.files();
        let present: Vec<&PathBuf> = files.iter().filter(|f| f.exists()).collect();
        let text = std::fs::read_to_string(self.place("json")).unwrap_or_default();
        let found: Value = serde_json::from_str(&text).unwrap_or_default();
        if found["fingerprint"] == document["fingerprint"] {
            return Ok((present.len() == files.len()).then(|| tally_of(&found)));
        }
        match present.first() {
            Some(file) if !self.force => Err(another(file, "it was not written by this sweep")),
            _ => Ok(None),
        }
    }

    /// Writes the whole table from its complete parts, in order, and takes the parts away if asked.
    fn write(&self, document: &Value, columns: &[Column], parts: &[PathBuf], tally: &Tally) -> Result<(), SweepError> {
        let mut csv = self.formats.csv.then(|| Staged::new(self.place("csv"))).transpose()?;
        let mut array = self.formats.npy.then(|| Staged::new(self.place("npy"))).transpose()?;
        let header = line(columns.iter().map(Column::header));
        if let Some(csv) = &mut csv {
            csv.put(|out| out.write_all(header.as_bytes()))?;
        }
        if let Some(array) = &mut array {
            let wide = columns.iter().filter(|c| c.value("").is_some()).count();
            array.put(|out| npy::header(tally.designs, wide, out))?;
        }
        for part in parts {
            let mut reader = BufReader::new(reading(part, File::open(part))?);
            let mut text = Vec::new();
            for row in 0_u64.. {
                text.clear();
                if reading(part, reader.read_until(b'\n', &mut text))? == 0 {
                    break;
                }
                // The document and the header.
                if row < 2 {
                    continue;
                }
                if let Some(csv) = &mut csv {
                    csv.put(|out| out.write_all(&text))?;
                }
                if let Some(array) = &mut array {
                    let cells = split(&text).unwrap_or_default();
                    let mut values = columns.iter().zip(&cells).filter_map(|(column, cell)| column.value(cell));
                    array.put(|out| values.try_for_each(|v| npy::number(v, out)))?;
                }
            }
        }
        let mut about = Staged::new(self.place("json"))?;
        let text = format!("{:#}\n", with_tally(document, tally));
        about.put(|out| out.write_all(text.as_bytes()))?;
        // The document first: with it, whoever finds only some of the others knows that they are of this sweep.
        for staged in [Some(about), csv, array].into_iter().flatten() {
            staged.persist()?;
        }
        Ok(())
    }
}

/// A file beside its place.
struct Staged {
    path: PathBuf,
    beside: PathBuf,
    out: BufWriter<File>,
}

impl Staged {
    fn new(path: PathBuf) -> Result<Self, SweepError> {
        let mut beside = path.clone().into_os_string();
        beside.push(".new");
        let beside = PathBuf::from(beside);
        if path.is_dir() {
            return Err(SweepError::File { path, error: io::ErrorKind::IsADirectory.into() });
        }
        let out = BufWriter::new(at(&beside, File::create(&beside))?);
        Ok(Self { path, beside, out })
    }

    fn put(&mut self, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), SweepError> {
        let result = write(&mut self.out);
        at(&self.beside, result)
    }

    fn persist(mut self) -> Result<(), SweepError> {
        let synced = self.out.flush().and_then(|()| self.out.get_ref().sync_all());
        at(&self.beside, synced)?;
        drop(self.out);
        at(&self.path, std::fs::rename(&self.beside, &self.path))
    }
}

fn another(file: &Path, why: &str) -> SweepError {
    refused_call(
        "E0132",
        format!("`{}` belongs to something else: {why}", file.display()),
        "choose another --out, or overwrite it with --force",
    )
}

fn with_tally(document: &Value, tally: &Tally) -> Value {
    let mut document = document.clone();
    document["counts"] = tally.json();
    document
}

fn tally_of(document: &Value) -> Tally {
    let counts = &document["counts"];
    let number = |value: &Value| value.as_u64().unwrap_or(0);
    let mut tally = Tally::new();
    for (word, count) in &mut tally.status {
        *count = number(&counts["status"][word.as_str()]);
    }
    tally.designs = number(&document["designs"]);
    (tally.met, tally.missed, tally.not_assessed) = (number(&counts["met"]), number(&counts["missed"]), number(&counts["not_assessed"]));
    tally
}

/// The part of a table that is being written.
#[derive(Debug)]
pub struct PartFile {
    path: PathBuf,
    file: File,
    columns: Vec<Column>,
    tally: Tally,
    first: u64,
}

impl PartFile {
    fn open(path: PathBuf, sweep: &Sweep, shard: Shard, force: bool) -> Result<Self, SweepError> {
        let mut file = at(&path, OpenOptions::new().read(true).write(true).create(true).truncate(false).open(&path))?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                let message = format!("another process writes `{}`", path.display());
                return Err(refused_call("E0135", message, "wait for it, stop it, or choose another --out"));
            }
            // Some file systems have no locks.
            Err(TryLockError::Error(error)) if error.kind() == io::ErrorKind::Unsupported => {}
            Err(TryLockError::Error(error)) => return Err(SweepError::File { path, error }),
        }
        let mut document = sweep.document().clone();
        document["shard"] = json!([shard.index, shard.of]);
        let head = format!("{document}\n{}", sweep.header());
        let mut found = Vec::new();
        at(&path, (&file).take(head.len() as u64).read_to_end(&mut found))?;
        let begun = found == head.as_bytes();
        // A head that was cut short is that of this sweep as far as it goes.
        if !begun && !head.as_bytes().starts_with(&found) && !force {
            return Err(another(&path, "it was begun with other values, another project or another version"));
        }
        let designs = shard.range(sweep.len());
        let mut tally = Tally::new();
        let mut good = head.len() as u64;
        if begun {
            let mut reader = BufReader::new(&file);
            let mut text = Vec::new();
            while tally.designs < designs.end - designs.start {
                text.clear();
                at(&path, reader.read_until(b'\n', &mut text))?;
                let design = designs.start + tally.designs;
                let Some(cells) = split(&text).filter(|cells| cells.len() == sweep.columns().len()) else { break };
                if !cells.starts_with(&lead(sweep.plan(), design + 1, &sweep.plan().values(design))) {
                    break;
                }
                tally.count(sweep.columns(), &cells);
                good += text.len() as u64;
            }
            at(&path, file.set_len(good))?;
        } else {
            at(&path, file.set_len(0).and_then(|()| file.rewind()).and_then(|()| file.write_all(head.as_bytes())))?;
        }
        at(&path, file.seek(SeekFrom::Start(good)))?;
        Ok(Self { path, file, columns: sweep.columns().to_vec(), tally, first: designs.start })
    }

    /// The first design that has no row yet, from 0.
    pub fn next(&self) -> u64 {
        self.first + self.tally.designs
    }

    /// Its rows so far.
    pub fn tally(&self) -> &Tally {
        &self.tally
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Appends the next row. What a kill leaves of it is cut away when the sweep goes on.
    ///
    /// # Errors
    /// What the system says.
    pub fn append(&mut self, sweep: &Sweep, row: &Row) -> io::Result<()> {
        let cells = row.cells(sweep.plan());
        self.tally.count(&self.columns, &cells);
        self.file.write_all(line(cells).as_bytes())
    }

    /// Ends a complete part: that of a shard stays for `merge`, the only one becomes the whole table.
    ///
    /// # Errors
    /// What the system says.
    pub fn finish(self, sweep: &Sweep, outputs: &Outputs, shard: Shard) -> Result<Tally, SweepError> {
        at(&self.path, self.file.sync_all())?;
        if shard == Shard::WHOLE {
            if cfg!(windows) {
                // There a lock also keeps its owner from reading through another handle.
                at(&self.path, self.file.unlock())?;
            }
            outputs.write(sweep.document(), sweep.columns(), std::slice::from_ref(&self.path), &self.tally)?;
            drop(self.file);
            at(&self.path, std::fs::remove_file(&self.path))?;
        }
        Ok(self.tally)
    }
}

/// What parts were joined to.
#[derive(Debug)]
pub struct Merged {
    /// What the table is.
    pub document: Value,
    /// Its rows.
    pub tally: Tally,
}

/// A part as it was found.
struct Found {
    path: PathBuf,
    document: Value,
    shard: Shard,
}

/// Joins the parts of one sweep, in any order, to the table that the sweep would have written in one run: the same bytes. The parts stay.
///
/// # Errors
/// E0134 unless they are all the parts of one sweep, each complete; E0132 for outputs of another sweep; and what the system says.
pub fn merge(outputs: &Outputs, parts: &[PathBuf]) -> Result<Merged, SweepError> {
    let refuse = |message: String, help: &str| refused_call("E0134", message, help);
    let mut found = parts.iter().map(|path| read_head(path)).collect::<Result<Vec<_>, _>>()?;
    found.sort_by_key(|f| f.shard.index);
    let Some(first) = found.first() else { return Err(refuse("no parts are named".to_owned(), "name the files `OUT.1-of-4.part`, …")) };
    let (document, of) = (first.document.clone(), first.shard.of);
    for pair in found.windows(2) {
        let [a, b] = pair else { continue };
        let (one, other) = (a.path.display(), b.path.display());
        if a.document != b.document || a.shard.of != b.shard.of {
            return Err(refuse(format!("`{one}` and `{other}` are of two sweeps"), "name the parts of one sweep"));
        }
        if a.shard.index == b.shard.index {
            return Err(refuse(format!("`{one}` and `{other}` are the same part"), "name each part once"));
        }
    }
    if let Some(missing) =
        (1..=of).zip(found.iter().map(|f| Some(f.shard.index)).chain(std::iter::repeat(None))).find(|(i, f)| Some(*i) != *f)
    {
        return Err(refuse(format!("part {} of {of} is missing", missing.0), "name all parts; `--shard i/n` computes one"));
    }
    let columns: Option<Vec<Column>> = document["columns"].as_array().and_then(|all| all.iter().map(Column::from_json).collect());
    let (Some(columns), Some(total)) = (columns, document["designs"].as_u64()) else {
        return Err(refuse(format!("`{}` is no part of a sweep", found[0].path.display()), "name files `OUT.i-of-n.part`"));
    };
    let mut tally = Tally::new();
    for part in &found {
        check_rows(part, &columns, total, &mut tally)?;
    }
    let folder = if outputs.folder.as_os_str().is_empty() { Path::new(".") } else { &outputs.folder };
    at(folder, std::fs::create_dir_all(folder))?;
    outputs.standing(&document)?;
    let paths: Vec<PathBuf> = found.into_iter().map(|f| f.path).collect();
    outputs.write(&document, &columns, &paths, &tally)?;
    Ok(Merged { document: with_tally(&document, &tally), tally })
}

/// Most bytes of the line that says which sweep a part belongs to.
const LONGEST_HEAD: u64 = 4 * 1024 * 1024;

fn read_head(path: &Path) -> Result<Found, SweepError> {
    let mut text = Vec::new();
    reading(path, File::open(path).and_then(|f| BufReader::new(f).take(LONGEST_HEAD).read_until(b'\n', &mut text)))?;
    let mut document: Value = serde_json::from_slice(&text).unwrap_or_default();
    let shard = document.as_object_mut().and_then(|d| d.remove("shard")).unwrap_or_default();
    match (shard[0].as_u64(), shard[1].as_u64()) {
        (Some(index), Some(of)) if (1..=of).contains(&index) => Ok(Found { path: path.to_owned(), document, shard: Shard { index, of } }),
        _ => Err(refused_call("E0134", format!("`{}` is no part of a sweep", path.display()), "name files `OUT.i-of-n.part`")),
    }
}

/// Whether a part has every row of its shard, whole and in order, and nothing else.
fn check_rows(part: &Found, columns: &[Column], total: u64, tally: &mut Tally) -> Result<(), SweepError> {
    let path = &part.path;
    let mut reader = BufReader::new(reading(path, File::open(path))?);
    let mut text = Vec::new();
    reading(path, reader.read_until(b'\n', &mut text))?;
    text.clear();
    reading(path, reader.read_until(b'\n', &mut text))?;
    let mut good = split(&text).is_some_and(|cells| cells.iter().eq(columns.iter().map(Column::header).collect::<Vec<_>>().iter()));
    let designs = part.shard.range(total);
    let mut design = designs.start;
    while good {
        text.clear();
        if reading(path, reader.read_until(b'\n', &mut text))? == 0 {
            break;
        }
        let cells = split(&text).unwrap_or_default();
        good = design < designs.end && cells.len() == columns.len() && cells.first() == Some(&(design + 1).to_string());
        if good {
            design += 1;
            tally.count(columns, &cells);
        }
    }
    if good && design == designs.end {
        return Ok(());
    }
    let count = designs.end - designs.start;
    let message = format!("`{}` has {} of its {count} rows", path.display(), design - designs.start);
    Err(refused_call("E0134", message, "run the command that made it again: it goes on where it ended"))
}
