//! STEP (ISO 10303-21) after AP214: one solid with exact faces.
//!
//! Each edge of a plate's boundary becomes a wall: a plane, part of a cylinder, or an extruded B-spline. Walls share their edges with each other
//! and with the two caps, so the shell is closed by construction.
//!
//! The plain volume of Open CASCADE takes at most 61 points along an edge, too few for splines of many spans; its adaptive one agrees
//! with the exact volume.

use std::fmt::{Display, Write as _};

use forcewright_curves::Spline;
use forcewright_curves::vector::{norm, sub};
use forcewright_model::Part;

use crate::shape::{Curve, Edge, Loop, MM_PER_M, Point, Shape};
use crate::text::{length, ratio};

pub(crate) fn write(part: &Part, shape: &Shape) -> String {
    document(part, |step| step.faces(shape))
}

/// The file of a part whose solid has these faces.
pub(crate) fn document(part: &Part, faces: impl FnOnce(&mut Step) -> Vec<Entity>) -> String {
    let mut step = Step { out: String::new(), last: 0 };
    let (name, title) = (quoted(&part.name), quoted(&part.title));
    let material = part.material.as_ref().map_or_else(|| "''".to_owned(), |material| quoted(&format!("Material: {material}")));
    let context = step.add("APPLICATION_CONTEXT('core data for automotive mechanical design processes')");
    step.add(format_args!("APPLICATION_PROTOCOL_DEFINITION('international standard','automotive_design',2000,{context})"));
    let product_context = step.add(format_args!("PRODUCT_CONTEXT('',{context},'mechanical')"));
    let product = step.add(format_args!("PRODUCT({name},{name},{title},({product_context}))"));
    step.add(format_args!("PRODUCT_RELATED_PRODUCT_CATEGORY('part','',({product}))"));
    let formation = step.add(format_args!("PRODUCT_DEFINITION_FORMATION('',{material},{product})"));
    let definition_context = step.add(format_args!("PRODUCT_DEFINITION_CONTEXT('part definition',{context},'design')"));
    let definition = step.add(format_args!("PRODUCT_DEFINITION('design','',{formation},{definition_context})"));
    let of_shape = step.add(format_args!("PRODUCT_DEFINITION_SHAPE('','',{definition})"));
    let units = step.units();
    let frame = step.frame(&[0.0; 3], [0.0, 0.0, 1.0], [1.0, 0.0]);
    let faces = faces(&mut step);
    let shell = step.add(format_args!("CLOSED_SHELL('',({}))", faces.join(",")));
    let solid = step.add(format_args!("MANIFOLD_SOLID_BREP({name},{shell})"));
    let representation = step.add(format_args!("ADVANCED_BREP_SHAPE_REPRESENTATION({name},({frame},{solid}),{units})"));
    step.add(format_args!("SHAPE_DEFINITION_REPRESENTATION({of_shape},{representation})"));
    // Without a time, for the same part is the same file.
    format!(
        "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION(({title}),'2;1');\n\
         FILE_NAME({name},'',(''),(''),'Forcewright','Forcewright','');\n\
         FILE_SCHEMA(('AUTOMOTIVE_DESIGN {{ 1 0 10303 214 1 1 1 1 }}'));\nENDSEC;\nDATA;\n{}ENDSEC;\nEND-ISO-10303-21;\n",
        step.out
    )
}

/// The entities, numbered from 1.
pub(crate) struct Step {
    out: String,
    last: usize,
}

/// Kinds of bounds of a face.
pub(crate) const OUTER: &str = "FACE_OUTER_BOUND";
pub(crate) const INNER: &str = "FACE_BOUND";

/// The number of an entity, as it is referred to.
pub(crate) type Entity = String;

/// An edge of the solid: its curve with both ends.
#[derive(Clone, Debug)]
struct Rim {
    edge: Entity,
    curve: Entity,
}

/// What one boundary gives to the solid: walls, and the edges below and above with the material to their left.
pub(crate) struct Ring {
    pub(crate) walls: Vec<Entity>,
    pub(crate) bottom: Vec<Entity>,
    pub(crate) top: Vec<Entity>,
}

impl Step {
    pub(crate) fn add(&mut self, entity: impl Display) -> Entity {
        self.last += 1;
        let _ = writeln!(self.out, "#{}={entity};", self.last);
        format!("#{}", self.last)
    }

    /// Millimetres and radians; points nearer than 10⁻⁷ mm are one.
    fn units(&mut self) -> Entity {
        let mm = self.add("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))");
        let radian = self.add("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))");
        let steradian = self.add("(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())");
        let distance = "'distance_accuracy_value','confusion accuracy'";
        let accuracy = self.add(format_args!("UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-07),{mm},{distance})"));
        self.add(format_args!(
            "(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT(({accuracy}))\
             GLOBAL_UNIT_ASSIGNED_CONTEXT(({mm},{radian},{steradian}))REPRESENTATION_CONTEXT('','3D'))"
        ))
    }

    pub(crate) fn point(&mut self, point: &[f64; 3]) -> Entity {
        self.add(format_args!("CARTESIAN_POINT('',({}))", reals(point, length)))
    }

    fn direction(&mut self, direction: [f64; 3]) -> Entity {
        self.add(format_args!("DIRECTION('',({}))", reals(&direction, ratio)))
    }

    /// A frame by its origin, its third axis, and its first axis in the plane of the part.
    fn frame(&mut self, origin: &[f64; 3], axis: [f64; 3], first: Point) -> Entity {
        self.frame_in_space(origin, axis, [first[0], first[1], 0.0])
    }

    /// A frame by its origin, its third axis and its first axis.
    pub(crate) fn frame_in_space(&mut self, origin: &[f64; 3], axis: [f64; 3], first: [f64; 3]) -> Entity {
        let (origin, axis, first) = (self.point(origin), self.direction(axis), self.direction(first));
        self.add(format_args!("AXIS2_PLACEMENT_3D('',{origin},{axis},{first})"))
    }

    pub(crate) fn line(&mut self, from: &[f64; 3], direction: [f64; 3]) -> Entity {
        let (from, direction) = (self.point(from), self.direction(direction));
        let vector = self.add(format_args!("VECTOR('',{direction},1.)"));
        self.add(format_args!("LINE('',{from},{vector})"))
    }

    /// A face of plane, walls or caps, from its bounds.
    pub(crate) fn face(&mut self, bounds: &[Entity], surface: &str, is_along: bool) -> Entity {
        self.add(format_args!("ADVANCED_FACE('',({}),{surface},{})", bounds.join(","), logical(is_along)))
    }

    /// A closed chain of edges, each with whether it is passed forwards.
    pub(crate) fn bound(&mut self, chain: &[(&str, bool)], kind: &str) -> Entity {
        let oriented = |(edge, is_forward): &(&str, bool)| self.add(format_args!("ORIENTED_EDGE('',*,*,{edge},{})", logical(*is_forward)));
        let oriented: Vec<Entity> = chain.iter().map(oriented).collect();
        let chain = self.add(format_args!("EDGE_LOOP('',({}))", oriented.join(",")));
        self.add(format_args!("{kind}('',{chain},.T.)"))
    }

    /// All faces: the walls, then the bottom and the top.
    fn faces(&mut self, shape: &Shape) -> Vec<Entity> {
        let (mut faces, mut bottom, mut top) = (Vec::new(), Vec::new(), Vec::new());
        for (index, boundary) in shape.loops().enumerate() {
            let ring = self.ring(&boundary, [0.0, shape.depth]);
            let kind = if index == 0 { OUTER } else { INNER };
            bottom.push(self.under(&ring, kind));
            top.push(self.over(&ring, kind));
            faces.extend(ring.walls);
        }
        faces.push(self.flat(&bottom, 0.0, -1.0));
        faces.push(self.flat(&top, shape.depth, 1.0));
        faces
    }

    /// The lower edges of walls as a bound of what lies there; seen from below everything runs backwards.
    pub(crate) fn under(&mut self, ring: &Ring, kind: &str) -> Entity {
        let chain: Vec<(&str, bool)> = ring.bottom.iter().rev().map(|edge| (edge.as_str(), false)).collect();
        self.bound(&chain, kind)
    }

    /// The upper edges of walls as a bound of what lies there.
    pub(crate) fn over(&mut self, ring: &Ring, kind: &str) -> Entity {
        let chain: Vec<(&str, bool)> = ring.top.iter().map(|edge| (edge.as_str(), true)).collect();
        self.bound(&chain, kind)
    }

    /// A face across z at a height, seen from above (`axis` 1) or below (−1).
    pub(crate) fn flat(&mut self, bounds: &[Entity], z: f64, axis: f64) -> Entity {
        let frame = self.frame(&[0.0, 0.0, z], [0.0, 0.0, axis], [1.0, 0.0]);
        let plane = self.add(format_args!("PLANE('',{frame})"));
        self.face(bounds, &plane, true)
    }

    /// The walls above a boundary between two heights.
    pub(crate) fn ring(&mut self, boundary: &Loop, [low, high]: [f64; 2]) -> Ring {
        let count = boundary.edges.len();
        let mut corners = Vec::with_capacity(count);
        for edge in &boundary.edges {
            let ends = [low, high].map(|z| {
                let point = self.point(&[edge.from[0], edge.from[1], z]);
                self.add(format_args!("VERTEX_POINT('',{point})"))
            });
            let line = self.line(&[edge.from[0], edge.from[1], low], [0.0, 0.0, 1.0]);
            let upright = self.add(format_args!("EDGE_CURVE('',{},{},{line},.T.)", ends[0], ends[1]));
            corners.push((ends, upright));
        }
        let mut ring = Ring { walls: Vec::new(), bottom: Vec::new(), top: Vec::new() };
        for (k, edge) in boundary.edges.iter().enumerate() {
            let ((here, left), (next, right)) = (&corners[k], &corners[(k + 1) % count]);
            let bottom = self.rim(edge, low, &here[0], &next[0]);
            let top = self.rim(edge, high, &here[1], &next[1]);
            let bound = self.bound(&[(&bottom.edge, true), (right, true), (&top.edge, false), (left, false)], OUTER);
            let (surface, is_along) = self.wall(edge, low, &bottom.curve);
            ring.walls.push(self.face(&[bound], &surface, is_along));
            ring.bottom.push(bottom.edge);
            ring.top.push(top.edge);
        }
        ring
    }

    /// The curve of an edge at a height, and the edge between two vertices.
    fn rim(&mut self, edge: &Edge, z: f64, from: &str, to: &str) -> Rim {
        let (curve, is_along) = match &edge.curve {
            Curve::Line => {
                let [x, y] = heading(edge);
                (self.line(&[edge.from[0], edge.from[1], z], [x, y, 0.0]), true)
            }
            Curve::Arc { centre, radius, sweep_rad } => {
                let frame = self.frame(&[centre[0], centre[1], z], [0.0, 0.0, 1.0], first_axis(edge, *centre, *sweep_rad));
                (self.add(format_args!("CIRCLE('',{frame},{})", real(&length(*radius)))), *sweep_rad > 0.0)
            }
            Curve::Spline(spline) => (self.spline(spline, z), true),
        };
        let edge = self.add(format_args!("EDGE_CURVE('',{from},{to},{curve},{})", logical(is_along)));
        Rim { edge, curve }
    }

    fn spline(&mut self, spline: &Spline, z: f64) -> Entity {
        let control: Vec<Entity> =
            spline.control_m.iter().map(|point| self.point(&[point[0] * MM_PER_M, point[1] * MM_PER_M, z])).collect();
        let (mut knots, mut counts): (Vec<f64>, Vec<usize>) = (Vec::new(), Vec::new());
        for &knot in &spline.knots {
            match counts.last_mut() {
                Some(count) if knots.last() == Some(&knot) => *count += 1,
                _ => {
                    knots.push(knot);
                    counts.push(1);
                }
            }
        }
        let counts: Vec<String> = counts.iter().map(usize::to_string).collect();
        self.add(format_args!(
            "B_SPLINE_CURVE_WITH_KNOTS('',3,({}),.UNSPECIFIED.,.F.,.F.,({}),({}),.UNSPECIFIED.)",
            control.join(","),
            counts.join(","),
            reals(&knots, ratio)
        ))
    }

    /// The surface above an edge, and whether its own normal points out of the material, to the right of the edge.
    fn wall(&mut self, edge: &Edge, z: f64, bottom: &str) -> (Entity, bool) {
        match &edge.curve {
            Curve::Line => {
                let [x, y] = heading(edge);
                let frame = self.frame(&[edge.from[0], edge.from[1], z], [y, -x, 0.0], [x, y]);
                (self.add(format_args!("PLANE('',{frame})")), true)
            }
            Curve::Arc { centre, radius, sweep_rad } => {
                let frame = self.frame(&[centre[0], centre[1], z], [0.0, 0.0, 1.0], first_axis(edge, *centre, *sweep_rad));
                (self.add(format_args!("CYLINDRICAL_SURFACE('',{frame},{})", real(&length(*radius)))), *sweep_rad > 0.0)
            }
            Curve::Spline(_) => {
                let up = self.direction([0.0, 0.0, 1.0]);
                let vector = self.add(format_args!("VECTOR('',{up},1.)"));
                (self.add(format_args!("SURFACE_OF_LINEAR_EXTRUSION('',{bottom},{vector})")), true)
            }
        }
    }
}

/// Unit vector from the begin of an edge to its end.
fn heading(edge: &Edge) -> Point {
    let chord = sub(edge.to, edge.from);
    let length = norm(chord);
    [chord[0] / length, chord[1] / length]
}

/// Unit vector from the middle of an arc to the end where its angle begins to grow, so that it does not pass the seam of its cylinder.
fn first_axis(edge: &Edge, centre: Point, sweep_rad: f64) -> Point {
    let spoke = sub(if sweep_rad > 0.0 { edge.from } else { edge.to }, centre);
    let length = norm(spoke);
    [spoke[0] / length, spoke[1] / length]
}

/// A number with the point that STEP asks of reals.
pub(crate) fn real(digits: &str) -> String {
    if digits.contains('.') { digits.to_owned() } else { format!("{digits}.") }
}

fn reals(values: &[f64], digits: fn(f64) -> String) -> String {
    values.iter().map(|&value| real(&digits(value))).collect::<Vec<_>>().join(",")
}

fn logical(value: bool) -> &'static str {
    if value { ".T." } else { ".F." }
}

/// A string after ISO 10303-21, 6.4.3: apostrophes and backslashes doubled, other characters by their numbers.
fn quoted(text: &str) -> String {
    let mut out = String::from("'");
    for c in text.chars() {
        match c {
            '\'' => out.push_str("''"),
            '\\' => out.push_str("\\\\"),
            ' '..='~' => out.push(c),
            c if c.is_control() => out.push(' '),
            c => {
                let number = u32::from(c);
                let _ = if number > 0xffff { write!(out, "\\X4\\{number:08X}\\X0\\") } else { write!(out, "\\X2\\{number:04X}\\X0\\") };
            }
        }
    }
    out.push('\'');
    out
}

#[cfg(test)]
mod tests {
    use super::quoted;

    #[test]
    fn strings_are_plain_characters_between_apostrophes() {
        assert_eq!(quoted("maker's a\\b"), "'maker''s a\\\\b'");
        assert_eq!(quoted("Ø\n🙂"), "'\\X2\\00D8\\X0\\ \\X4\\0001F642\\X0\\'");
    }
}
