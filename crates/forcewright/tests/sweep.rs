//! Tables of many designs: their numbers against closed forms and single solves, their files against truncation at every byte.
#![allow(clippy::unwrap_used, reason = "helpers of tests: what is not there fails the test")]

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use forcewright::model::{CheckState, StatusKind};
use forcewright::sweep::{Axis, Formats, Outputs, PartFile, Plan, Row, Sampling, Shard, Started, Sweep, SweepError, Tally, merge};
use forcewright::{Choices, DiskFiles, Loaded};

const CSV: Formats = Formats { csv: true, npy: false };
const BOTH: Formats = Formats { csv: true, npy: true };

fn go_on() -> AtomicBool {
    AtomicBool::new(false)
}

fn example(name: &str) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a.toml");
    std::fs::write(&file, forcewright::gallery::find(name).unwrap().text).unwrap();
    (folder, file)
}

fn sweep_of(file: &Path, vary: &[&str], metrics: &[&str]) -> Result<Sweep, SweepError> {
    let axes = vary.iter().map(|text| Axis::parse(text)).collect::<Result<Vec<_>, _>>()?;
    let plan = Plan::new(axes, Sampling::default(), false)?;
    let metrics: Vec<String> = metrics.iter().map(|m| (*m).to_owned()).collect();
    Sweep::new(&DiskFiles, file, &Choices::default(), plan, &metrics, &go_on())
}

fn rows(sweep: &Sweep, threads: usize) -> Vec<Row> {
    let mut rows = Vec::new();
    let count = sweep
        .run(0..sweep.len(), threads, &go_on(), &mut |row| {
            rows.push(row);
            Ok(())
        })
        .unwrap();
    assert_eq!((count, rows.len() as u64), (sweep.len(), sweep.len()));
    rows
}

fn call_error(error: SweepError) -> (&'static str, String) {
    match error {
        SweepError::Call(call) => (call.code, call.message.clone()),
        other => panic!("{other}"),
    }
}

/// Force, stiffness and energy of an inextensible beam are E·I times a function of its shape, I = t·w³/12, and stress is E·w times one.
#[test]
fn numbers_follow_depth_and_thickness() {
    let (_folder, file) = example("lan-table3");
    let metrics = ["force_at_end", "stiffness_initial", "stress_max", "energy_at_end"];
    let sweep =
        sweep_of(&file, &["model.beam=inextensible", "design.thickness=0.8mm..1.2mm:3", "design.depth=5mm,10mm,15mm"], &metrics).unwrap();
    let rows = rows(&sweep, 0);
    let close = |a: f64, b: f64, tolerance: f64| assert!((a / b - 1.0).abs() < tolerance, "{a} {b}");
    let at = |thickness: usize, depth: usize, metric: usize| rows[3 * thickness + depth].metrics[metric].unwrap();
    for (thickness, w) in [0.8, 1.0, 1.2].into_iter().enumerate() {
        for (depth, t) in [5.0, 10.0, 15.0].into_iter().enumerate() {
            for metric in [0, 1, 3] {
                close(at(thickness, depth, metric), at(1, 1, metric) * t / 10.0 * w * w * w, 1e-8);
                // The depth multiplies every term of the equations alike.
                close(at(thickness, depth, metric), at(thickness, 0, metric) * t / 5.0, 1e-13);
            }
            close(at(thickness, depth, 2), at(thickness, 0, 2), 1e-13);
        }
    }
}

/// 3·E·I/L³ for small deflections, with Young's modulus from the catalogue.
#[test]
fn a_cantilever_has_the_stiffness_of_the_textbook() {
    let (_folder, file) = example("cantilever");
    let vary = ["model.beam=inextensible", "design.nodes.tip.at.x=50mm..70mm:3", "design.thickness=0.4mm,0.5mm", "load.travel=0.01mm"];
    let sweep = sweep_of(&file, &vary, &["stiffness_initial", "force_at_end"]).unwrap();
    let young_pa = forcewright::elements::materials::catalogue().iter().find(|m| m.name == "C75S").unwrap();
    let young_pa = young_pa.young_modulus_pa.as_ref().unwrap().value;
    let mut rows = rows(&sweep, 1).into_iter();
    for length_m in [0.05, 0.06, 0.07_f64] {
        for thickness_m in [0.4e-3, 0.5e-3_f64] {
            let inertia_m4 = 0.01 * thickness_m * thickness_m * thickness_m / 12.0;
            let expected = 3.0 * young_pa * inertia_m4 / (length_m * length_m * length_m);
            let row = rows.next().unwrap();
            assert!((row.metrics[0].unwrap() / expected - 1.0).abs() < 1e-8, "{row:?} {expected}");
            assert!((row.metrics[1].unwrap() / (expected * 1e-5) - 1.0).abs() < 1e-6, "{row:?}");
        }
    }
}

#[test]
fn a_row_is_what_a_single_solve_gives() {
    let (_folder, file) = example("lan-table3");
    let sweep = sweep_of(&file, &["design.nodes.n3.at.x=30mm,30.5mm", "requirements.travel=6mm,9mm"], &[]).unwrap();
    for (at, row) in rows(&sweep, 2).iter().enumerate() {
        let choices = Choices { variant: None, set: sweep.plan().settings(at as u64) };
        let loaded = Loaded::from_file(&DiskFiles, &file, &choices).map_err(|e| e.render(false)).unwrap();
        let outcome = loaded.solve("", "", &mut |_| true).outcome;
        assert_eq!(row.design, at as u64 + 1);
        assert_eq!(row.status, Some(outcome.status.kind));
        assert_eq!(row.requirements == Some(CheckState::Met), outcome.requirements_met(), "{row:?}");
        assert_eq!(row.error_estimate, outcome.error_estimate);
        let required: Vec<_> = outcome.checks.iter().filter(|c| c.required).map(|c| Some(c.state)).collect();
        assert_eq!(row.checks, required);
        let numbers = sweep.columns().iter().filter(|c| outcome.metric(&c.name).is_some()).count();
        assert_eq!((numbers, row.metrics.iter().flatten().count()), (outcome.metrics.len(), outcome.metrics.len()));
        // The line holds every bit.
        let header: Vec<String> = sweep.header().trim_end().split(',').map(str::to_owned).collect();
        let line = sweep.line(row);
        for metric in &outcome.metrics {
            let place = header.iter().position(|h| h.split(" / ").next() == Some(metric.name)).unwrap();
            let cell: f64 = line.split(',').nth(place).unwrap().parse().unwrap();
            assert_eq!(cell.to_bits(), (metric.value + 0.0).to_bits(), "{}", metric.name);
        }
    }
}

#[test]
fn failures_are_rows_with_their_reason() {
    let (_folder, file) = example("lan-table3");
    let vary = ["load.travel=13.6mm,-1mm,60mm", "load.direction=[0, -1],[0, 1]", "model.beam=inextensible"];
    let sweep = sweep_of(&file, &vary, &["force_at_end"]).unwrap();
    let rows = rows(&sweep, 2);
    assert_eq!(rows[0].status, Some(StatusKind::Complete));
    for refused in &rows[2..4] {
        assert!(refused.status.is_none() && refused.requirements.is_none() && refused.metrics == [None], "{refused:?}");
        assert!(refused.message.starts_with("E0204: "), "{refused:?}");
    }
    let beyond = &rows[5];
    assert_eq!((beyond.status, beyond.metrics.as_slice()), (Some(StatusKind::NoEquilibriumBeyond), [None].as_slice()));
    assert!(beyond.requirements != Some(CheckState::Met) && !beyond.message.is_empty(), "{beyond:?}");
    let mut tally = Tally::new();
    for row in &rows {
        tally.add(&sweep, row);
    }
    assert_eq!((tally.designs, tally.with_status("refused")), (6, 2));
}

#[test]
fn mistakes_of_the_call_end_it_before_anything_is_computed() {
    let (_folder, file) = example("lan-table3");
    for (vary, code, help) in [
        ("design.thicknes=1mm,2mm", "E0301", "did you mean `thickness`?"),
        ("design.thickness=1mm,2N", "E0201", "length"),
        ("design.thickness=1,2", "E0208", "mm"),
        ("model.beam=reissner,inextensibel", "E0303", "did you mean \"inextensible\"?"),
        ("design.nodes.n3.at.z=1mm,2mm", "E0304", "`x` and `y`"),
        ("design.beams.b11.bend.1=1,2", "E0302", "did you mean `b1`?"),
        // Not one of the designs can be used.
        ("design.thickness=-2mm..-1mm:5", "E0204", "10 mm"),
    ] {
        let Err(SweepError::Project(refused)) = sweep_of(&file, &[vary, "design.depth=9mm,10mm"], &[]) else { panic!("{vary}") };
        let shown = refused.render(false);
        assert!(shown.contains(code) && shown.contains("--vary:1:"), "{shown}");
        assert!(code == "E0204" || shown.contains(help), "{shown}");
    }
    let Err(error) = sweep_of(&file, &["design.depth=9mm,10mm"], &["force_at_edn"]) else { panic!() };
    let SweepError::Call(call) = &error else { panic!("{error}") };
    assert_eq!((call.code, call.help.as_deref()), ("E0133", Some("did you mean `force_at_end`?")));
}

#[test]
fn rows_come_in_order_and_stop_where_they_are_told_to() {
    let (_folder, file) = example("cantilever");
    let sweep = sweep_of(&file, &["load.travel=1mm..5mm:40"], &["force_at_end"]).unwrap();
    let text = |threads| rows(&sweep, threads).iter().map(|row| sweep.line(row)).collect::<String>();
    let one = text(1);
    assert!(one == text(2) && one == text(5));
    // A stop in the middle, after which only rows that were begun are handed on; and an error of whoever takes them.
    let sweep = sweep_of(&file, &["load.travel=1mm..5mm:4000"], &["force_at_end"]).unwrap();
    let stop = go_on();
    let mut seen = Vec::new();
    let count = sweep.run(3..4000, 2, &stop, &mut |row| {
        seen.push(row.design);
        stop.fetch_or(row.design == 9, Ordering::Relaxed);
        Ok(())
    });
    let count = count.unwrap();
    assert!((6..100).contains(&count), "{count}");
    assert_eq!(seen, (4..4 + count).collect::<Vec<_>>());
    let failed = sweep.run(0..4000, 2, &go_on(), &mut |row| if row.design < 5 { Ok(()) } else { Err(std::io::Error::other("full")) });
    assert_eq!(failed.unwrap_err().to_string(), "full");
}

fn open(outputs: &Outputs, sweep: &Sweep, shard: Shard) -> PartFile {
    match outputs.start(sweep, shard).unwrap() {
        Started::Open(part) => part,
        Started::Complete(_) => panic!("complete already"),
    }
}

/// Goes on where the part ends, with rows computed before.
fn go_on_with(part: &mut PartFile, sweep: &Sweep, rows: &[Row]) {
    let next = usize::try_from(part.next()).unwrap();
    for row in &rows[next..] {
        part.append(sweep, row).unwrap();
    }
}

#[test]
fn a_part_cut_at_any_byte_becomes_the_same_table() {
    let (folder, file) = example("cantilever");
    let sweep = sweep_of(&file, &["load.travel=1mm,-1mm,5mm"], &["force_at_end"]).unwrap();
    let rows = rows(&sweep, 1);
    let outputs = Outputs::new(&folder.path().join("t.csv"), BOTH, false);
    let path = outputs.part(Shard::WHOLE);
    go_on_with(&mut open(&outputs, &sweep, Shard::WHOLE), &sweep, &rows);
    let whole = std::fs::read(&path).unwrap();
    open(&outputs, &sweep, Shard::WHOLE).finish(&sweep, &outputs, Shard::WHOLE).unwrap();
    let finished: Vec<Vec<u8>> = outputs.files().iter().map(|f| std::fs::read(f).unwrap()).collect();
    assert!(finished[0].starts_with(sweep.header().as_bytes()) && whole.ends_with(&finished[0]));
    assert!(!path.exists(), "the part is taken away");
    let head = whole.len() - finished[0].len() + sweep.header().len();
    for cut in 0..=whole.len() {
        // What a lost page of a disk leaves behind the rows must not matter either.
        for rest in [&b""[..], b"\0\0\0", b"2,\xff\xff\r\n"] {
            if !rest.is_empty() && cut < head {
                continue;
            }
            std::fs::write(&path, [&whole[..cut], rest].concat()).unwrap();
            let mut part = open(&outputs, &sweep, Shard::WHOLE);
            go_on_with(&mut part, &sweep, &rows);
            assert!(std::fs::read(&path).unwrap() == whole, "cut at {cut}");
            if cut % 211 == 0 {
                part.finish(&sweep, &outputs, Shard::WHOLE).unwrap();
                let again: Vec<Vec<u8>> = outputs.files().iter().map(|f| std::fs::read(f).unwrap()).collect();
                assert!(again == finished, "cut at {cut}");
            }
        }
    }
}

#[test]
fn files_of_another_sweep_are_refused_and_a_complete_table_is_left_alone() {
    let (folder, file) = example("cantilever");
    let at = folder.path().join("t.csv");
    let sweep = sweep_of(&file, &["load.travel=1mm,5mm"], &["force_at_end"]).unwrap();
    let other = sweep_of(&file, &["load.travel=1mm,4mm"], &["force_at_end"]).unwrap();
    assert_ne!(sweep.document()["fingerprint"], other.document()["fingerprint"]);
    let outputs = Outputs::new(&at, CSV, false);
    let forced = Outputs::new(&at, CSV, true);
    let mut part = open(&outputs, &sweep, Shard::WHOLE);
    // Nobody else writes it meanwhile.
    assert_eq!(call_error(outputs.start(&sweep, Shard::WHOLE).unwrap_err()).0, "E0135");
    go_on_with(&mut part, &sweep, &rows(&sweep, 1));
    drop(part);
    assert_eq!(call_error(outputs.start(&other, Shard::WHOLE).unwrap_err()).0, "E0132");
    let tally = open(&outputs, &sweep, Shard::WHOLE).finish(&sweep, &outputs, Shard::WHOLE).unwrap();
    let Started::Complete(found) = outputs.start(&sweep, Shard::WHOLE).unwrap() else { panic!("computed again") };
    assert!(found == tally && tally.designs == 2);
    let before = std::fs::read(&at).unwrap();
    assert_eq!(call_error(outputs.start(&other, Shard::WHOLE).unwrap_err()).0, "E0132");
    assert_eq!(std::fs::read(&at).unwrap(), before);
    let mut part = open(&forced, &other, Shard::WHOLE);
    go_on_with(&mut part, &other, &rows(&other, 1));
    part.finish(&other, &forced, Shard::WHOLE).unwrap();
    assert_ne!(std::fs::read(&at).unwrap(), before);
    // The project's text belongs to the sweep: even a comment makes it another one.
    let text = std::fs::read_to_string(&file).unwrap();
    std::fs::write(&file, format!("{text}# changed\n")).unwrap();
    let changed = sweep_of(&file, &["load.travel=1mm,4mm"], &["force_at_end"]).unwrap();
    assert_eq!(call_error(outputs.start(&changed, Shard::WHOLE).unwrap_err()).0, "E0132");
}

#[test]
fn merged_parts_are_the_whole() {
    let (folder, file) = example("cantilever");
    let sweep = sweep_of(&file, &["load.travel=1mm..5mm:5", "design.depth=5mm,10mm"], &["force_at_end", "flat_start"]).unwrap();
    let rows = rows(&sweep, 2);
    let whole = Outputs::new(&folder.path().join("whole.csv"), BOTH, false);
    let mut part = open(&whole, &sweep, Shard::WHOLE);
    go_on_with(&mut part, &sweep, &rows);
    let tally = part.finish(&sweep, &whole, Shard::WHOLE).unwrap();
    let outputs = Outputs::new(&folder.path().join("m.csv"), BOTH, false);
    let mut parts = Vec::new();
    for index in [2, 4, 1, 3] {
        let shard = Shard { index, of: 4 };
        let mut part = open(&outputs, &sweep, shard);
        let (next, end) = (usize::try_from(part.next()).unwrap(), usize::try_from(shard.range(10).end).unwrap());
        for row in &rows[next..end] {
            part.append(&sweep, row).unwrap();
        }
        part.finish(&sweep, &outputs, shard).unwrap();
        parts.push(outputs.part(shard));
    }
    let error = |parts: &[PathBuf]| call_error(merge(&outputs, parts).unwrap_err());
    assert!(error(&parts[..3]).1.contains("part 3 of 4 is missing"));
    assert!(error(&[&parts[..], &parts[..1]].concat()).1.contains("the same part"));
    assert!(error(std::slice::from_ref(&file)).1.contains("no part of a sweep"));
    assert!(!outputs.files()[0].exists());
    let last = std::fs::read(&parts[3]).unwrap();
    for cut in [1, 20] {
        std::fs::write(&parts[3], &last[..last.len() - cut]).unwrap();
        assert!(error(&parts).1.contains("of its 2 rows"), "{}", error(&parts).1);
    }
    std::fs::write(&parts[3], &last).unwrap();
    let other = sweep_of(&file, &["load.travel=1mm..5mm:5", "design.depth=5mm,11mm"], &["force_at_end", "flat_start"]).unwrap();
    let strange = Outputs::new(&folder.path().join("other.csv"), CSV, false);
    drop(open(&strange, &other, Shard { index: 3, of: 4 }));
    assert!(error(&[&parts[..3], &[strange.part(Shard { index: 3, of: 4 })]].concat()).1.contains("two sweeps"));
    let merged = merge(&outputs, &parts).unwrap();
    assert_eq!(merged.tally, tally);
    for (a, b) in whole.files().iter().zip(outputs.files()) {
        assert!(std::fs::read(a).unwrap() == std::fs::read(&b).unwrap(), "{}", b.display());
    }
}

/// The format as `numpy.lib.format` documents it: magic, version, length, a Python literal padded to 64 bytes, the numbers.
#[test]
fn the_array_holds_the_bits_of_the_table() {
    let (folder, file) = example("cantilever");
    let vary = ["model.beam=reissner,inextensible", "load.travel=1mm,-1mm,5mm"];
    let sweep = sweep_of(&file, &vary, &["force_at_end", "envelope_margin"]).unwrap();
    let rows = rows(&sweep, 1);
    let outputs = Outputs::new(folder.path(), Formats { csv: false, npy: true }, false);
    let mut part = open(&outputs, &sweep, Shard::WHOLE);
    go_on_with(&mut part, &sweep, &rows);
    part.finish(&sweep, &outputs, Shard::WHOLE).unwrap();
    assert!(!folder.path().join("sweep.csv").exists());
    let bytes = std::fs::read(folder.path().join("sweep.npy")).unwrap();
    assert_eq!(&bytes[..8], b"\x93NUMPY\x01\x00");
    let length = usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    assert!((10 + length).is_multiple_of(64) && bytes[9 + length] == b'\n');
    let header = std::str::from_utf8(&bytes[10..10 + length]).unwrap();
    let document: serde_json::Value = serde_json::from_slice(&std::fs::read(folder.path().join("sweep.json")).unwrap()).unwrap();
    let columns = document["columns"].as_array().unwrap();
    let wide = columns.iter().filter(|c| c["npy"].is_u64()).count();
    assert_eq!(header.trim_end(), format!("{{'descr': '<f8', 'fortran_order': False, 'shape': (6, {wide}), }}"));
    let numbers: Vec<f64> = bytes[10 + length..].chunks_exact(8).map(|b| f64::from_le_bytes(b.try_into().unwrap())).collect();
    assert_eq!(numbers.len(), 6 * wide);
    let place = |name: &str| usize::try_from(columns.iter().find(|c| c["name"] == name).unwrap()["npy"].as_u64().unwrap()).unwrap();
    for (at, row) in rows.iter().enumerate() {
        let cell = |name: &str| numbers[at * wide + place(name)];
        assert_eq!(cell("design").to_bits(), ((at + 1) as f64).to_bits());
        assert_eq!(cell("model.beam").to_bits(), ((at / 3) as f64).to_bits());
        assert_eq!(cell("load.travel").to_bits(), [1e-3_f64, -1e-3, 5e-3][at % 3].to_bits());
        let words = &columns.iter().find(|c| c["name"] == "status").unwrap()["words"];
        assert_eq!(words.as_array().unwrap().iter().position(|w| w == row.status_word()), Some([0, 6, 0][at % 3]));
        assert_eq!(cell("status").to_bits(), [0.0_f64, 6.0, 0.0][at % 3].to_bits());
        assert_eq!(cell("force_at_end").is_nan(), at % 3 == 1);
        assert!(row.metrics[0].is_none_or(|force| force.to_bits() == cell("force_at_end").to_bits()));
        assert!(cell("envelope_margin").is_nan(), "this design has no envelope");
    }
}
