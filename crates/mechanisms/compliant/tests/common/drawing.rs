//! Project texts that are put together, so that the same mechanism can be written in many ways.

#![allow(dead_code, reason = "each test uses its share")]
#![allow(clippy::approx_constant, reason = "1.5707 is what the paper prints")]

use std::fmt::Write as _;

/// A node: name, position in mm, what else stands in its table.
pub(crate) type Node = (&'static str, [f64; 2], String);
/// A beam: name, its two nodes, its bend in rad.
pub(crate) type Beam = (&'static str, [&'static str; 2], Vec<f64>);

/// A mechanism of beams with bends.
#[derive(Clone)]
pub(crate) struct Drawing {
    pub(crate) nodes: Vec<Node>,
    pub(crate) beams: Vec<Beam>,
    pub(crate) load_node: &'static str,
    pub(crate) load_direction: [f64; 2],
    pub(crate) travel: String,
    pub(crate) mirror: Option<String>,
    /// `inextensible` or `reissner`.
    pub(crate) model: &'static str,
}

impl Drawing {
    /// Table 3 by its nodes.
    pub(crate) fn table3() -> Self {
        let clamp = || "support = \"clamped\"".to_owned();
        Self {
            nodes: vec![
                ("n1", [2.5, 0.0], clamp()),
                ("n2", [34.5, 0.0], clamp()),
                ("n3", [30.5, 18.77], String::new()),
                ("n4", [12.44, 24.0], String::new()),
                ("n5", [2.5, 40.0], guide([0.0, 1.0])),
            ],
            beams: vec![
                ("b1", ["n1", "n3"], vec![1.3092, -1.5707]),
                ("b2", ["n2", "n3"], vec![-0.756, 1.5707]),
                ("b3", ["n3", "n4"], vec![0.3013, 1.5707]),
                ("b4", ["n4", "n5"], vec![0.226, -1.148]),
            ],
            load_node: "n5",
            load_direction: [0.0, -1.0],
            travel: "13.6 mm".to_owned(),
            mirror: Some("x = 0".to_owned()),
            model: "reissner",
        }
    }

    /// One straight beam of 100 mm along x, clamped at n1.
    pub(crate) fn straight(end: &str, load_direction: [f64; 2], travel: &str, model: &'static str) -> Self {
        Self {
            nodes: vec![("n1", [0.0, 0.0], "support = \"clamped\"".to_owned()), ("n2", [100.0, 0.0], end.to_owned())],
            beams: vec![("b1", ["n1", "n2"], Vec::new())],
            load_node: "n2",
            load_direction,
            travel: travel.to_owned(),
            mirror: None,
            model,
        }
    }

    /// Every position moved by a map, in mm.
    pub(crate) fn moved(mut self, map: impl Fn([f64; 2]) -> [f64; 2]) -> Self {
        for node in &mut self.nodes {
            node.1 = map(node.1);
        }
        self
    }

    /// The project file, with the section and the material of the paper; ν = 0.35.
    pub(crate) fn text(&self) -> String {
        let mut text = String::from("schema = 1\nmechanism = \"compliant\"\n");
        text.push_str("[requirements.stress]\nsafety_factor = 1.5\n");
        text.push_str(
            "[material]\nyoung_modulus = \"2 GPa\"\npoisson_ratio = 0.35\nyield_stress = \"76 MPa\"\ndensity = \"1400 kg/m^3\"\n",
        );
        text.push_str("[design]\nthickness = \"1 mm\"\ndepth = \"10 mm\"\n[design.nodes]\n");
        for (name, [x, y], rest) in &self.nodes {
            let comma = if rest.is_empty() { "" } else { ", " };
            let _ = writeln!(text, "{name} = {{ at = [\"{x} mm\", \"{y} mm\"]{comma}{rest} }}");
        }
        for (name, [from, to], bend) in &self.beams {
            let shape = if bend.is_empty() { "straight = true".to_owned() } else { format!("bend = {bend:?}") };
            let _ = writeln!(text, "[[design.beams]]\nname = \"{name}\"\nbetween = [\"{from}\", \"{to}\"]\n{shape}");
        }
        if let Some(line) = &self.mirror {
            let _ = writeln!(text, "[layout]\nmirror = \"{line}\"");
        }
        let _ =
            writeln!(text, "[load]\nnode = \"{}\"\ndirection = {:?}\ntravel = \"{}\"", self.load_node, self.load_direction, self.travel);
        let _ = writeln!(text, "[model]\nbeam = \"{}\"", self.model);
        text
    }
}

/// The keys of a slider that keeps its angle.
pub(crate) fn guide([x, y]: [f64; 2]) -> String {
    format!("support = \"slider\", direction = [{x:?}, {y:?}]")
}
