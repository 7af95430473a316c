//! DXF of release 2000 (AC1015) in text: what cutting services and CAD programs read.
//!
//! Group codes and the order of sections are those of Autodesk's DXF Reference. The file is complete: each table, the two layouts and
//! the dictionary of objects are there, so that no reader has to mend it.

use std::fmt::{Display, Write as _};

use forcewright_model::Part;

use crate::coil::{Line, Views};
use crate::shape::{Bulge, Circle, Loop, Point, Shape};
use crate::text::{length, ratio, remarks};

/// Layers with their colours by their number: white (black on paper), red, blue, green.
const LAYERS: [(&str, u8); 5] = [("0", 7), ("OUTLINE", 7), ("CUTOUTS", 1), ("HOLES", 5), ("NOTES", 3)];
/// The layer of the centre line of a turned part.
const CENTRE: (&str, u8) = ("CENTRE", 4);
/// Layers of the views of a spring.
const OF_SPRING: [(&str, u8); 5] = [("0", 7), ("OUTLINE", 7), ("END", 5), CENTRE, ("NOTES", 3)];
/// Height of letters and distance of lines, mm.
const LETTERS: f64 = 2.5;
const LINES: f64 = 5.0;

// Handles of what others refer to; the rest are given out in order.
const BLOCK_RECORDS: &str = "1";
const MODEL_SPACE: &str = "2";
const PAPER_SPACE: &str = "3";
const ROOT: &str = "4";
const GROUPS: &str = "5";
const LAYOUTS: &str = "6";
const MODEL_LAYOUT: &str = "7";
const PAPER_LAYOUT: &str = "8";
const FIRST_FREE: u32 = 0x10;

pub(crate) fn write(part: &Part, shape: &Shape, arc_error: f64) -> String {
    let mut notes = remarks(part);
    notes.push(format!("Splines are drawn as arcs within {} mm.", length(arc_error)));
    let layers: Vec<(&str, u8)> = LAYERS.into_iter().chain(shape.axis.map(|_| CENTRE)).collect();
    document(&notes, shape.extent(), &layers, |dxf| dxf.shape(shape, arc_error))
}

/// The views of a spring, in lines within `chord` mm.
pub(crate) fn write_views(part: &Part, views: &Views, chord: f64) -> String {
    let mut notes = remarks(part);
    notes.push(format!("Side view: what is seen, as chords within {} mm. View from the upper end on its left.", length(chord)));
    document(&notes, views.extent, &OF_SPRING, |dxf| dxf.views(views))
}

/// A file with these notes, and entities within an extent.
fn document(notes: &[String], extent: [Point; 2], layers: &[(&str, u8)], entities: impl FnOnce(&mut Dxf)) -> String {
    let mut body = Dxf { out: String::new(), next: FIRST_FREE };
    body.tables(extent, layers);
    body.blocks();
    body.section("ENTITIES");
    entities(&mut body);
    body.notes(extent, notes);
    body.pair(0, "ENDSEC");
    body.objects();
    body.pair(0, "EOF");
    let mut head = Dxf { out: String::new(), next: FIRST_FREE };
    for note in notes {
        head.pair(999, encoded(note));
    }
    head.header(extent, body.next);
    head.out + &body.out
}

/// Pairs of a group code and a value, a line each.
struct Dxf {
    out: String,
    next: u32,
}

impl Dxf {
    fn pair(&mut self, code: u16, value: impl Display) {
        let _ = write!(self.out, "{code}\n{value}\n");
    }

    fn pairs(&mut self, pairs: &[(u16, &str)]) {
        for (code, value) in pairs {
            self.pair(*code, value);
        }
    }

    /// A point from the group code of its x; y and z follow ten and twenty later.
    fn point(&mut self, code: u16, coordinates: &[f64]) {
        for (code, coordinate) in (code..).step_by(10).zip(coordinates) {
            self.pair(code, length(*coordinate));
        }
    }

    fn handle(&mut self) -> String {
        self.next += 1;
        format!("{:X}", self.next - 1)
    }

    fn section(&mut self, name: &str) {
        self.pairs(&[(0, "SECTION"), (2, name)]);
    }

    fn header(&mut self, extent: [Point; 2], first_free: u32) {
        let [low, high] = extent;
        self.section("HEADER");
        self.pairs(&[(9, "$ACADVER"), (1, "AC1015"), (9, "$DWGCODEPAGE"), (3, "ANSI_1252")]);
        for (name, [x, y]) in [("$EXTMIN", low), ("$EXTMAX", high)] {
            self.pair(9, name);
            self.point(10, &[x, y, 0.0]);
        }
        // Millimetres, metric; four decimals.
        self.pairs(&[(9, "$INSUNITS"), (70, "4"), (9, "$MEASUREMENT"), (70, "1"), (9, "$LUPREC"), (70, "4")]);
        self.pair(9, "$HANDSEED");
        self.pair(5, format!("{first_free:X}"));
        self.pair(0, "ENDSEC");
    }

    fn tables(&mut self, extent: [Point; 2], layers: &[(&str, u8)]) {
        self.section("CLASSES");
        self.pair(0, "ENDSEC");
        self.section("TABLES");
        self.view_table(extent);
        self.table("LTYPE", "AcDbLinetypeTableRecord", &["ByBlock", "ByLayer", "Continuous"], |dxf, _| {
            dxf.pairs(&[(70, "0"), (3, ""), (72, "65"), (73, "0"), (40, "0")]);
        });
        let names: Vec<&str> = layers.iter().map(|(name, _)| *name).collect();
        self.table("LAYER", "AcDbLayerTableRecord", &names, |dxf, index| {
            dxf.pair(70, 0);
            dxf.pair(62, layers[index].1);
            dxf.pairs(&[(6, "Continuous"), (370, "-3")]);
        });
        self.table("STYLE", "AcDbTextStyleTableRecord", &["Standard"], |dxf, _| {
            dxf.pairs(&[(70, "0"), (40, "0"), (41, "1"), (50, "0"), (71, "0"), (42, "2.5"), (3, "txt"), (4, "")]);
        });
        self.table("VIEW", "", &[], |_, _| ());
        self.table("UCS", "", &[], |_, _| ());
        self.table("APPID", "AcDbRegAppTableRecord", &["ACAD"], |dxf, _| dxf.pair(70, 0));
        self.table("DIMSTYLE", "AcDbDimStyleTableRecord", &["Standard"], |dxf, _| dxf.pair(70, 0));
        self.block_records();
        self.pair(0, "ENDSEC");
    }

    /// A table of records with names; what follows the name is written by `rest`.
    fn table(&mut self, kind: &str, class: &str, names: &[&str], rest: impl Fn(&mut Self, usize)) {
        let head = self.handle();
        self.table_head(kind, &head, names.len());
        if kind == "DIMSTYLE" {
            self.pair(100, "AcDbDimStyleTable");
        }
        for (index, name) in names.iter().enumerate() {
            let handle = self.handle();
            // Dimension styles alone have their handle elsewhere, for 5 is taken.
            let code = if kind == "DIMSTYLE" { "105" } else { "5" };
            let _ = write!(self.out, "0\n{kind}\n{code}\n{handle}\n");
            self.pairs(&[(330, &head), (100, "AcDbSymbolTableRecord"), (100, class), (2, name)]);
            rest(self, index);
        }
        self.pair(0, "ENDTAB");
    }

    fn table_head(&mut self, kind: &str, handle: &str, count: usize) {
        self.pairs(&[(0, "TABLE"), (2, kind), (5, handle), (330, "0"), (100, "AcDbSymbolTable")]);
        self.pair(70, count);
    }

    /// The window that is open at first: all of the part.
    fn view_table(&mut self, [low, high]: [Point; 2]) {
        let (width, height) = (high[0] - low[0], high[1] - low[1]);
        self.table("VPORT", "AcDbViewportTableRecord", &["*Active"], |dxf, _| {
            dxf.pair(70, 0);
            dxf.point(10, &[0.0, 0.0]);
            dxf.point(11, &[1.0, 1.0]);
            dxf.point(12, &[0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])]);
            dxf.point(13, &[0.0, 0.0]);
            dxf.point(14, &[10.0, 10.0]);
            dxf.point(15, &[10.0, 10.0]);
            dxf.point(16, &[0.0, 0.0, 1.0]);
            dxf.point(17, &[0.0, 0.0, 0.0]);
            dxf.pair(40, length(1.2 * height.max(width / 1.5)));
            dxf.pairs(&[(41, "1.5"), (42, "50"), (43, "0"), (44, "0"), (50, "0"), (51, "0"), (71, "0"), (72, "100")]);
            dxf.pairs(&[(73, "1"), (74, "3"), (75, "0"), (76, "0"), (77, "0"), (78, "0")]);
        });
    }

    fn block_records(&mut self) {
        self.table_head("BLOCK_RECORD", BLOCK_RECORDS, 2);
        for (handle, name, layout) in [(MODEL_SPACE, "*Model_Space", MODEL_LAYOUT), (PAPER_SPACE, "*Paper_Space", PAPER_LAYOUT)] {
            self.pairs(&[(0, "BLOCK_RECORD"), (5, handle), (330, BLOCK_RECORDS), (100, "AcDbSymbolTableRecord")]);
            self.pairs(&[(100, "AcDbBlockTableRecord"), (2, name), (340, layout)]);
        }
        self.pair(0, "ENDTAB");
    }

    fn blocks(&mut self) {
        self.section("BLOCKS");
        for (owner, name) in [(MODEL_SPACE, "*Model_Space"), (PAPER_SPACE, "*Paper_Space")] {
            let (begin, end) = (self.handle(), self.handle());
            let paper: &[(u16, &str)] = if owner == PAPER_SPACE { &[(67, "1")] } else { &[] };
            self.pairs(&[(0, "BLOCK"), (5, &begin), (330, owner), (100, "AcDbEntity")]);
            self.pairs(paper);
            self.pairs(&[(8, "0"), (100, "AcDbBlockBegin"), (2, name), (70, "0")]);
            self.point(10, &[0.0, 0.0, 0.0]);
            self.pairs(&[(3, name), (1, "")]);
            self.pairs(&[(0, "ENDBLK"), (5, &end), (330, owner), (100, "AcDbEntity")]);
            self.pairs(paper);
            self.pairs(&[(8, "0"), (100, "AcDbBlockEnd")]);
        }
        self.pair(0, "ENDSEC");
    }

    fn shape(&mut self, shape: &Shape, arc_error: f64) {
        self.polyline("OUTLINE", &shape.outline, arc_error);
        for cutout in &shape.cutouts {
            self.polyline("CUTOUTS", cutout, arc_error);
        }
        for hole in &shape.holes {
            self.circle("HOLES", hole);
        }
        if let Some([from, to]) = shape.axis {
            self.line(CENTRE.0, from, to);
        }
    }

    fn views(&mut self, views: &Views) {
        for line in &views.outline {
            self.chain("OUTLINE", line);
        }
        for circle in &views.end {
            self.circle("END", circle);
        }
        for line in &views.centre {
            match line.points[..] {
                [from, to] => self.line(CENTRE.0, from, to),
                _ => self.chain(CENTRE.0, line),
            }
        }
        self.circle(CENTRE.0, &views.mean);
    }

    fn notes(&mut self, [low, _]: [Point; 2], notes: &[String]) {
        for (line, note) in notes.iter().enumerate() {
            self.entity("TEXT", "NOTES", "AcDbText");
            self.point(10, &[low[0], low[1] - LINES * (line as f64 + 1.5), 0.0]);
            self.pair(40, length(LETTERS));
            self.pair(1, encoded(note));
            // The class is named twice: after the text comes its alignment.
            self.pair(100, "AcDbText");
        }
    }

    fn circle(&mut self, layer: &str, circle: &Circle) {
        self.entity("CIRCLE", layer, "AcDbCircle");
        self.point(10, &[circle.centre[0], circle.centre[1], 0.0]);
        self.pair(40, length(circle.radius));
    }

    fn line(&mut self, layer: &str, from: Point, to: Point) {
        self.entity("LINE", layer, "AcDbLine");
        self.point(10, &[from[0], from[1], 0.0]);
        self.point(11, &[to[0], to[1], 0.0]);
    }

    /// An open polyline.
    fn chain(&mut self, layer: &str, line: &Line) {
        self.entity("LWPOLYLINE", layer, "AcDbPolyline");
        self.pair(90, line.points.len());
        self.pairs(&[(70, "0"), (43, "0")]);
        for point in &line.points {
            self.point(10, point);
        }
    }

    fn entity(&mut self, kind: &str, layer: &str, class: &str) {
        let handle = self.handle();
        self.pairs(&[(0, kind), (5, &handle), (330, MODEL_SPACE), (100, "AcDbEntity"), (8, layer), (100, class)]);
    }

    fn polyline(&mut self, layer: &str, boundary: &Loop, arc_error: f64) {
        let bulges = boundary.bulges(arc_error);
        self.entity("LWPOLYLINE", layer, "AcDbPolyline");
        self.pair(90, bulges.len());
        // Closed: the last corner is joined to the first, which is not repeated.
        self.pairs(&[(70, "1"), (43, "0")]);
        let mut from = boundary.edges[0].from;
        for Bulge { to, bulge } in bulges {
            self.point(10, &from);
            if bulge != 0.0 {
                self.pair(42, ratio(bulge));
            }
            from = to;
        }
    }

    fn objects(&mut self) {
        self.section("OBJECTS");
        self.dictionary(ROOT, "0", &[("ACAD_GROUP", GROUPS), ("ACAD_LAYOUT", LAYOUTS)]);
        self.dictionary(GROUPS, ROOT, &[]);
        self.dictionary(LAYOUTS, ROOT, &[("Layout1", PAPER_LAYOUT), ("Model", MODEL_LAYOUT)]);
        self.layout(MODEL_LAYOUT, "Model", MODEL_SPACE);
        self.layout(PAPER_LAYOUT, "Layout1", PAPER_SPACE);
        self.pair(0, "ENDSEC");
    }

    fn dictionary(&mut self, handle: &str, owner: &str, entries: &[(&str, &str)]) {
        self.pairs(&[(0, "DICTIONARY"), (5, handle), (330, owner), (100, "AcDbDictionary"), (281, "1")]);
        for (name, entry) in entries {
            self.pairs(&[(3, name), (350, entry)]);
        }
    }

    fn layout(&mut self, handle: &str, name: &str, block: &str) {
        let is_model = block == MODEL_SPACE;
        self.pairs(&[(0, "LAYOUT"), (5, handle), (330, LAYOUTS), (100, "AcDbPlotSettings"), (1, ""), (2, "none_device"), (4, "")]);
        for margin in 40..=43 {
            self.pair(margin, 0);
        }
        // No paper chosen yet, plotted one to one.
        for code in 44..=49 {
            self.pair(code, 0);
        }
        self.pairs(&[(140, "0"), (141, "0"), (142, "1"), (143, "1"), (70, if is_model { "1024" } else { "0" })]);
        self.pairs(&[(72, "1"), (73, "0"), (74, "5"), (7, ""), (75, "16"), (147, "1"), (148, "0"), (149, "0")]);
        self.pairs(&[(100, "AcDbLayout"), (1, name), (70, "1"), (71, if is_model { "0" } else { "1" })]);
        self.point(10, &[0.0, 0.0]);
        self.point(11, &[420.0, 297.0]);
        self.point(12, &[0.0, 0.0, 0.0]);
        self.point(14, &[0.0, 0.0, 0.0]);
        self.point(15, &[0.0, 0.0, 0.0]);
        self.pair(146, 0);
        self.point(13, &[0.0, 0.0, 0.0]);
        self.point(16, &[1.0, 0.0, 0.0]);
        self.point(17, &[0.0, 1.0, 0.0]);
        self.pairs(&[(76, "0"), (330, block)]);
    }
}

/// Text in the seven bits that every reader understands: one line, other characters by their numbers, without control codes.
fn encoded(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            // A caret and two percent signs begin codes.
            '^' => out.push_str("^ "),
            '%' if out.ends_with('%') => out.push_str(" %"),
            ' '..='~' if c != '\\' => out.push(c),
            c if c.is_control() => out.push(' '),
            c if u32::from(c) > 0xffff => out.push('?'),
            c => {
                let _ = write!(out, "\\U+{:04X}", u32::from(c));
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::encoded;

    #[test]
    fn texts_are_one_line_of_plain_characters() {
        assert_eq!(encoded("Ø 4 ± 0.1\nµ"), "\\U+00D8 4 \\U+00B1 0.1 \\U+00B5");
        assert_eq!(encoded("a\\b ^I 5%%d 🙂"), "a\\U+005Cb ^ I 5% %d ?");
    }
}
