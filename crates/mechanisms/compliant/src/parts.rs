//! From a design to the plate that is cut: beams with their thickness, fillets, pads where it is held, blocks, holes.

use forcewright_base::maths;
use forcewright_base::units::{Dimension, Unit, format_number, format_si};
use forcewright_beam::{Beam, Image, Joint as BeamJoint, Rotation, Support};
use forcewright_curves::outline::{AxisPoint, Block, Cap, HalfWidth, Joint, Network, Node, Outline, OutlineError, Region, Strip, Tag};
use forcewright_curves::walls::{Narrow, narrowest_gap, thinnest_wall};
use forcewright_curves::{Profile, Segment};
use forcewright_model::{Body, Check, CheckState, Fillets, Grip, Hole, NoPart, Part, PartMark, PartSet, Plate, Sense, Trial};

use crate::analysis::Behaviour;
use crate::checks::rounded_down;
use crate::design::Design;
use crate::layout::Mirror;
use crate::loads::Control;
use crate::pads;
use crate::scene::hull;

/// Splines of a part follow the sides of its beams within this, m: a hundredth of what a good machine holds.
const TOLERANCE_M: f64 = 1e-7;
/// Size of a pad without its hole, in thicknesses of the thickest beam that ends there.
const PAD_THICKNESSES: f64 = 6.0;
/// Places along a beam at which it is looked for in a pad.
const PROBES: usize = 400;
/// Directions into the ground: along the axes.
const AXES: [[f64; 2]; 4] = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];

/// How the plate is made, SI.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Making {
    /// Diameter of the cutter, m.
    pub cutter_m: Option<f64>,
    /// Thinnest wall that can be made, m.
    pub wall_min_m: Option<f64>,
    /// Narrowest gap that can be made, m.
    pub gap_min_m: Option<f64>,
    /// Radius of the fillets where beams meet each other or a pad, m.
    pub fillet_m: Option<f64>,
    /// Size of pads, along the edge where the beam ends and away from the beam, m.
    pub pad_m: Option<[f64; 2]>,
    /// Diameter of the holes in pads and blocks, m.
    pub hole_m: Option<f64>,
}

impl Making {
    /// Whether the file says how large pads, holes or fillets are.
    pub(crate) fn is_drawn(&self) -> bool {
        self.pad_m.is_some() || self.hole_m.is_some() || self.fillet_m.is_some()
    }

    /// Size of a pad at the end of a beam of a thickness, along its edge and away from the beam, m.
    pub(crate) fn pad_size_m(&self, thickness_m: f64) -> [f64; 2] {
        self.pad_m.unwrap_or([PAD_THICKNESSES * thickness_m + 2.0 * self.hole_m.unwrap_or(0.0); 2])
    }

    /// Radius of the fillets, m: as given, or else that of the cutter, or half a thickness.
    fn fillet_m(&self, thickness_m: f64) -> f64 {
        self.fillet_m.or(self.cutter_m.map(|d| 0.5 * d)).unwrap_or(0.5 * thickness_m)
    }
}

/// What a design that is no part lacks.
fn no_part(message: impl Into<String>, help: impl Into<String>) -> NoPart {
    NoPart { code: "E0518", message: message.into(), help: help.into() }
}

/// The plates of a design, and whether they can be made.
///
/// One plate is the drawn network with its mirrored half; rows, planes, plates and layers of a layout are more of the same.
///
/// # Errors
/// [`NoPart`] where it cannot be cut in one piece: hinges, fillets that do not fit, beams that overlap.
pub(crate) fn parts(design: &Design) -> Result<PartSet, NoPart> {
    let drawing = Drawing::new(design)?;
    drawing.covers()?;
    let network = drawing.network();
    let outline = network.outline(TOLERANCE_M).map_err(|e| drawing.explain(&e))?;
    let holes = drawing.holes(&outline)?;
    let mut profiles = outline.profiles();
    profiles.extend(holes.iter().map(|h| Profile::circle(h.centre_m, 0.5 * h.diameter_m).reversed()));
    let narrow = [("thinnest wall", thinnest_wall(&profiles)), ("narrowest gap", narrowest_gap(&profiles))];
    let marks = narrow.iter().filter_map(|(what, found)| {
        let found = found.as_ref()?;
        Some(PartMark { at_m: middle(found), text: format!("{what} {}", format_si(found.width_m, &design.units.length, 4)) })
    });
    let (parts, marks) = (drawing.parts(&outline, &holes), marks.collect());
    let mut checks = checks(design, narrow.map(|(_, found)| found));
    if let Ok(behaviour) = Behaviour::of(design, &mut |_| true) {
        checks.extend(pads::check(design, &behaviour.trusted(design), true));
    }
    Ok(PartSet { parts, marks, sheets: Vec::new(), display: design.units.length.clone(), checks })
}

/// A pad or a rigid body: where the material is as good as rigid.
pub(crate) struct Solid {
    /// What it is called after: its node or body.
    pub(crate) name: String,
    pub(crate) corners_m: Vec<[f64; 2]>,
    /// Where a hole may be, m: the middle.
    middle_m: [f64; 2],
    /// The network's node, and the copy it belongs to; a solid across the mirror line belongs to both.
    pub(crate) node: usize,
    pub(crate) copies: Vec<usize>,
}

/// The drawn network and its mirrored half with their pads and blocks.
pub(crate) struct Drawing<'a> {
    design: &'a Design,
    /// The drawn network and its mirrored half.
    pub(crate) images: Vec<Image>,
    pub(crate) solids: Vec<Solid>,
    /// Places of free nodes, m, with the network's node.
    nodes: Vec<[f64; 2]>,
    /// Per copy and beam: what its ends run into.
    pub(crate) ends: Vec<Vec<[Joint; 2]>>,
}

/// An axis-parallel box.
#[derive(Clone, Copy, Debug)]
struct Frame {
    low: [f64; 2],
    high: [f64; 2],
}

impl Frame {
    fn corners(&self) -> Vec<[f64; 2]> {
        let ([x0, y0], [x1, y1]) = (self.low, self.high);
        vec![[x0, y0], [x1, y0], [x1, y1], [x0, y1]]
    }
}

/// The axis along which a pad lies behind a drawn node, away from the beams that end there, and the thickness of the thickest of them, m.
/// `None` where no beam ends.
pub(crate) fn way_out(design: &Design, node: usize, at_m: [f64; 2]) -> Option<([f64; 2], f64)> {
    let mut away = [0.0; 2];
    let mut thickest_m = 0.0_f64;
    for beam in &design.network.beams {
        for (end, sign) in [(0.0, -1.0), (1.0, 1.0)] {
            let (joint, place) = if sign < 0.0 { (beam.start, design.start_m(beam)) } else { (beam.end, design.end_m(beam)) };
            if joint == node && maths::hypot(place[0] - at_m[0], place[1] - at_m[1]) <= 1e-9 * beam.shape.length_m() {
                let (sin, cos) = maths::sin_cos(beam.shape.angle_at(end));
                away = [away[0] + sign * cos, away[1] + sign * sin];
                thickest_m = thickest_m.max(beam.thickness_at(end));
            }
        }
    }
    // The first of equals.
    let dot = |a: &[f64; 2]| a[0] * away[0] + a[1] * away[1];
    let out = AXES.into_iter().reduce(|best, next| if dot(&next) > dot(&best) + 1e-9 { next } else { best })?;
    (thickest_m > 0.0).then_some((out, thickest_m))
}

impl<'a> Drawing<'a> {
    /// # Errors
    /// [`NoPart`] where hinges or different materials make several pieces of it, or a block has no width.
    pub(crate) fn new(design: &'a Design) -> Result<Self, NoPart> {
        one_piece(design)?;
        let layout = &design.layout;
        let count = if layout.mirror.is_some() { 2 } else { 1 };
        let images: Vec<Image> = layout.images().into_iter().take(count).collect();
        let mut drawing = Self { design, images, solids: Vec::new(), nodes: Vec::new(), ends: Vec::new() };
        for node in 0..design.network.nodes.len() {
            drawing.add_solid(node)?;
        }
        drawing.ends = (0..count).map(|copy| (0..design.network.beams.len()).map(|beam| drawing.joints(copy, beam)).collect()).collect();
        Ok(drawing)
    }

    /// The solid of a node that is held or a body, in each copy.
    fn add_solid(&mut self, node: usize) -> Result<(), NoPart> {
        let design = self.design;
        let body = design.bodies.iter().find(|b| b.node == node);
        let held = !matches!(design.network.nodes[node].support, Support::Free);
        if body.is_none() && !held {
            return Ok(());
        }
        let mut members: Vec<usize> = match body {
            Some(body) => body.members.clone(),
            None => (0..design.drawn.len()).filter(|d| design.drawn[*d].node == node).collect(),
        };
        // Where no beam ends a body is only looked at, or pushed by something else.
        if members.iter().any(|d| self.pad(node, design.drawn[*d].position_m).is_some()) {
            members.retain(|d| self.pad(node, design.drawn[*d].position_m).is_some());
        }
        let name = body.map_or_else(|| design.node_names[node].clone(), |b| b.name.clone());
        let frames: Vec<Frame> = members.iter().filter_map(|d| self.pad(node, design.drawn[*d].position_m)).collect();
        let corners: Vec<[f64; 2]> = frames.iter().flat_map(Frame::corners).collect();
        let Some(frame) = frames.first() else { return Ok(()) };
        // Of a pad its own middle; of a body that of all its corners.
        let middle = |all: &[[f64; 2]]| {
            let bound = |k: usize, f: fn(f64, f64) -> f64, start: f64| all.iter().map(|p| p[k]).fold(start, f);
            [0, 1].map(|k| f64::midpoint(bound(k, f64::min, f64::INFINITY), bound(k, f64::max, f64::NEG_INFINITY)))
        };
        let alone = if body.is_none() { frame.corners() } else { hull(corners) };
        let own = design.drawn[members[0]].position_m;
        if let Some(mirror) = design.layout.mirror.filter(|m| members.iter().all(|d| m.holds(&design.network, design.drawn[*d].position_m)))
        {
            self.on_the_line(mirror, body.is_some(), Solid { name, middle_m: middle(&alone), corners_m: alone, node, copies: vec![0, 1] })?;
            return Ok(());
        }
        // The load moves both halves by one block.
        let loaded = node == design.load_node;
        if design.layout.mirror.is_some_and(|mirror| loaded || alone.iter().any(|p| beyond(mirror, own, *p))) {
            let clipped = self.clipped(&alone, own);
            let both: Vec<[f64; 2]> = clipped.iter().flat_map(|p| self.images.iter().map(|i| i.of(*p))).collect();
            let corners_m = hull(both);
            self.solids.push(Solid { name, middle_m: middle(&corners_m), corners_m, node, copies: vec![0, 1] });
            return Ok(());
        }
        for (copy, image) in self.images.iter().enumerate() {
            let corners_m: Vec<[f64; 2]> = alone.iter().map(|p| image.of(*p)).collect();
            self.solids.push(Solid { name: name.clone(), middle_m: middle(&corners_m), corners_m, node, copies: vec![copy] });
        }
        Ok(())
    }

    /// A solid all of whose nodes are on the mirror line: a pad that goes along the line is that of both halves. Of one that would go
    /// across it, into the other half, nothing is left: there the halves are each other's continuation, and where a load is put on needs
    /// no pad.
    fn on_the_line(&mut self, mirror: Mirror, is_body: bool, solid: Solid) -> Result<(), NoPart> {
        if !is_body && mirror.holds(&self.design.network, solid.middle_m) {
            self.solids.push(solid);
            return Ok(());
        }
        let held = matches!(self.design.network.nodes[solid.node].support, Support::Clamped);
        if is_body || held {
            let what = if is_body { "body" } else { "clamped node" };
            return Err(no_part(
                format!("the {what} `{}` lies on the mirror line, where both halves end in it: it has no width between them", solid.name),
                "draw the beams up to the sides of the block: nodes beside the line, half the width of the block away from it",
            ));
        }
        Ok(())
    }

    /// Corners with those that are nearest to the mirror line, or beyond it, moved onto it.
    fn clipped(&self, corners: &[[f64; 2]], own: [f64; 2]) -> Vec<[f64; 2]> {
        let Some(mirror) = self.design.layout.mirror else { return corners.to_vec() };
        let off = |p: &[f64; 2]| match mirror {
            Mirror::X(at) => (p[0] - at).abs(),
            Mirror::Y(at) => (p[1] - at).abs(),
        };
        let crosses = corners.iter().any(|p| beyond(mirror, own, *p));
        let nearest_m = corners.iter().map(off).fold(f64::INFINITY, f64::min);
        let moves = |p: &[f64; 2]| beyond(mirror, own, *p) || (!crosses && off(p) <= nearest_m * (1.0 + 1e-9));
        let onto = |p: &[f64; 2]| match (mirror, moves(p)) {
            (Mirror::X(at), true) => [at, p[1]],
            (Mirror::Y(at), true) => [p[0], at],
            _ => *p,
        };
        corners.iter().map(onto).collect()
    }

    /// The pad at a drawn node: the beams that end there leave its edge, which passes through the node along an axis.
    /// `None` where no beam ends.
    fn pad(&self, node: usize, at_m: [f64; 2]) -> Option<Frame> {
        let (out, thickest_m) = way_out(self.design, node, at_m)?;
        let [along_m, deep_m] = self.design.making.pad_size_m(thickest_m);
        let ends = [0.0, deep_m].map(|d| [at_m[0] + d * out[0], at_m[1] + d * out[1]]);
        let across = [0.5 * along_m * out[1].abs(), 0.5 * along_m * out[0].abs()];
        Some(Frame {
            low: [0, 1].map(|k| ends[0][k].min(ends[1][k]) - across[k]),
            high: [0, 1].map(|k| ends[0][k].max(ends[1][k]) + across[k]),
        })
    }

    /// What the ends of a beam of a copy run into.
    fn joints(&mut self, copy: usize, beam: usize) -> [Joint; 2] {
        let design = self.design;
        let beam = &design.network.beams[beam];
        [(beam.start, design.start_m(beam)), (beam.end, design.end_m(beam))].map(|(node, place)| {
            if let Some(solid) = self.solids.iter().position(|s| s.node == node && s.copies.contains(&copy)) {
                return Joint::Block(solid);
            }
            let at = self.images[copy].of(place);
            let near = |p: &[f64; 2]| maths::hypot(p[0] - at[0], p[1] - at[1]) <= 1e-9 * beam.shape.length_m();
            Joint::Node(self.nodes.iter().position(near).unwrap_or_else(|| {
                self.nodes.push(at);
                self.nodes.len() - 1
            }))
        })
    }

    fn network(&self) -> Network<'_> {
        self.network_with(self.fillet_m())
    }

    fn network_with(&self, fillet_m: f64) -> Network<'_> {
        let beams = &self.design.network.beams;
        let strips = self
            .images
            .iter()
            .zip(&self.ends)
            .flat_map(|(image, ends)| beams.iter().zip(ends).map(move |(beam, ends)| strip(self.design, beam, *image, *ends)));
        Network {
            nodes: self.nodes.iter().map(|p| Node { point_m: *p, fillet_m, cap: Cap::Square }).collect(),
            blocks: self.solids.iter().map(|s| Block { corners_m: s.corners_m.clone(), corner_radius_m: 0.0, fillet_m }).collect(),
            strips: strips.collect(),
        }
    }

    /// Radius of the fillets, m.
    fn fillet_m(&self) -> f64 {
        let thinnest_m = self.design.network.beams.iter().map(|b| b.thickness_at(0.5)).fold(f64::INFINITY, f64::min);
        self.design.making.fillet_m(thinnest_m)
    }

    /// What is said of fillets that make a beam stiffer than the one that was computed: those larger than its thickness.
    fn long_fillets(&self) -> Option<String> {
        let fillet_m = self.fillet_m();
        let beams = self.design.network.beams.iter().zip(&self.design.beam_names);
        let ends = |b: &Beam| b.thickness_at(0.0).min(b.thickness_at(1.0));
        let (thin, name) = beams.reduce(|a, b| if ends(b.0) / b.0.shape.length_m() < ends(a.0) / a.0.shape.length_m() { b } else { a })?;
        let show = |m: f64| format_si(m, &self.design.units.length, 3);
        let reach = 100.0 * fillet_m / thin.shape.length_m();
        (fillet_m > ends(thin) * (1.0 + 1e-9)).then(|| {
            format!(
                "Fillets of {} are larger than beam `{name}` is thick ({}): they hold up to {} % of its length at each end, and the force computed without them is too small.",
                show(fillet_m),
                show(ends(thin)),
                format_number(reach, 2)
            )
        })
    }

    /// Pads and bodies leave the beams as long as they were drawn: none may cover more of one than its corner of a thickness.
    fn covers(&self) -> Result<(), NoPart> {
        for (image, ends) in self.images.iter().zip(&self.ends) {
            for ((beam, name), ends) in self.design.network.beams.iter().zip(&self.design.beam_names).zip(ends) {
                for (end, joint) in ends.iter().enumerate() {
                    let Joint::Block(solid) = joint else { continue };
                    let solid = &self.solids[*solid];
                    let polygon = Profile::polygon(&solid.corners_m);
                    let start = self.design.start_m(beam);
                    let inside = |i: &usize| {
                        let u = *i as f64 / PROBES as f64;
                        let p = beam.shape.point_m(if end == 0 { u } else { 1.0 - u });
                        polygon.contains(image.of([start[0] + p[0], start[1] + p[1]]))
                    };
                    let last = (0..=PROBES).rev().find(inside).unwrap_or(0);
                    let covered_m = beam.shape.length_m() * last as f64 / PROBES as f64;
                    if covered_m > beam.thickness_at(end as f64) + beam.shape.length_m() / PROBES as f64 {
                        return Err(no_part(
                            format!(
                                "the pad or block `{}` would cover {} of beam `{name}`",
                                solid.name,
                                format_si(covered_m, &self.design.units.length, 3)
                            ),
                            "make `parts.pad` smaller, turn the end of the beam, or give the beam a node and a body of its own",
                        ));
                    }
                }
            }
        }
        Ok(())
    }

    /// A hole in the middle of every pad and block, if they have holes.
    fn holes(&self, outline: &Outline) -> Result<Vec<Hole>, NoPart> {
        let Some(diameter_m) = self.design.making.hole_m else { return Ok(Vec::new()) };
        let millimetres = Unit::parse("mm").unwrap_or_else(|_| Unit::si(Dimension::Length));
        let mut holes = Vec::new();
        for solid in &self.solids {
            let circle = Profile::circle(solid.middle_m, 0.5 * diameter_m);
            let fits = outline.regions.iter().any(|region| {
                let all = || std::iter::once(&region.outer).chain(&region.windows).map(|b| &b.profile);
                region.outer.profile.contains(solid.middle_m)
                    && all().all(|p| p.distance_to(&circle).is_none_or(|n| n.distance_m >= 0.25 * diameter_m))
            });
            if !fits {
                return Err(no_part(
                    format!(
                        "a hole of {} does not fit into `{}`: there must be material around it, as wide as a quarter of it",
                        format_si(diameter_m, &millimetres, 4),
                        solid.name
                    ),
                    "make `parts.hole` smaller, or `parts.pad` larger than one and a half holes in both directions",
                ));
            }
            holes.push(Hole { centre_m: solid.middle_m, diameter_m, purpose: format!("in {}", solid.name) });
        }
        Ok(holes)
    }

    fn parts(&self, outline: &Outline, holes: &[Hole]) -> Vec<Part> {
        let design = self.design;
        let layout = &design.layout;
        let depth_m = design.network.beams.iter().map(|b| b.section.depth_m).fold(0.0, f64::max);
        let each = layout.plates_each();
        let alone = outline.regions.len() == 1;
        let mut notes = if each > 1 { vec![format!("{each} of these make the mechanism.")] } else { Vec::new() };
        // The load node of a mirrored half has a block unless both halves meet in it.
        let meets = layout.mirror.is_some() && !self.solids.iter().any(|s| s.node == design.load_node);
        if meets {
            notes.push(format!(
                "Both halves meet at `{}`, where the load is put on: there is no block.",
                design.node_names[design.load_node]
            ));
        }
        let named = |index: usize| if alone { "part".to_owned() } else { format!("part-{}", index + 1) };
        notes.extend(self.long_fillets());
        let material = design.beam_materials.first().and_then(|m| design.materials.get(*m));
        let all = outline.regions.iter().enumerate().map(|(index, region)| Part {
            name: named(index),
            title: design.title.clone(),
            count: each,
            material: material.map(|m| m.origin.clone()),
            density_kg_per_m3: material.and_then(|m| m.density_kg_per_m3),
            notes: notes.clone(),
            body: Body::Plate(Plate {
                depth_m,
                outline: region.outer.profile.clone(),
                cutouts: region.windows.iter().map(|w| w.profile.clone()).collect(),
                holes: holes.iter().filter(|h| region.outer.profile.contains(h.centre_m)).cloned().collect(),
                fillets: fillets(region),
                trial: self.trial(&region.outer.profile),
            }),
        });
        all.collect()
    }

    /// The largest radius below a given one with which the fillets of all joints fit, m, to three digits; `None` if none does.
    fn largest_fillet_m(&self, radius_m: f64) -> Option<f64> {
        let fits = |m: f64| self.network_with(m).outline(TOLERANCE_M).is_ok();
        let (mut fitting, mut too_large) = (0.0, radius_m);
        while too_large - fitting > 1e-3 * too_large && too_large > 1e-3 * radius_m {
            let middle = f64::midpoint(fitting, too_large);
            if fits(middle) { fitting = middle } else { too_large = middle }
        }
        (fitting > 0.0).then_some(rounded_down(fitting, 3))
    }

    /// How the piece of that outline is held and moved, in the words of finite elements: else why not.
    fn trial(&self, outline: &Profile) -> Result<Trial, String> {
        let design = self.design;
        let network = &design.network;
        let section = network.beams.first().ok_or("it has no beams")?.section;
        let poisson = section.poisson.filter(|nu| *nu < 0.5).ok_or("the file gives no Poisson's ratio below 0.5")?;
        if design.control != Control::Travel || !network.before.is_empty() {
            return Err("only a single travel is passed on, no forces and no loads before it".to_owned());
        }
        let moved = |node: usize| match network.nodes[node].support {
            Support::Clamped => Ok(Some([0.0; 2])),
            Support::Free if node != design.load_node => Ok(None),
            // The guide leads where the direction of the load has the travel as its share.
            Support::Slider { direction: guide, .. } if node == design.load_node => {
                let share = guide[0] * design.direction[0] + guide[1] * design.direction[1];
                Ok(Some(guide.map(|g| g * design.load_end / share)))
            }
            _ => Err(format!("`{}` is neither clamped nor moved along a guide", design.node_names[node])),
        };
        let mut grips = Vec::new();
        for solid in &self.solids {
            let Some(displacement_m) = moved(solid.node)? else { continue };
            if !outline.contains(solid.middle_m) {
                continue;
            }
            let copy = if solid.copies.first() == Some(&0) { "" } else { "_mirrored" };
            grips.push(Grip { name: format!("{}{copy}", solid.name), corners_m: hull(solid.corners_m.clone()), displacement_m });
        }
        if grips.iter().all(Grip::is_held) {
            return Err("nothing that moves is part of it".to_owned());
        }
        Ok(Trial { young_pa: section.young_pa, poisson, grips })
    }

    /// An error of the outline with the names of the project.
    fn explain(&self, error: &OutlineError) -> NoPart {
        let show = |m: f64| format_si(m, &self.design.units.length, 4);
        let at = |[x, y]: &[f64; 2]| format!("({}, {})", show(*x), show(*y));
        let (mut message, mut help) = (error.to_string(), "move a node, change the shape, or make the beams thinner there");
        match error {
            OutlineError::Fillet { joint, strips: [a, b], radius_m, largest_m } => {
                let fits = if *largest_m > 0.0 {
                    format!("the largest that does there has {}", show(*largest_m))
                } else {
                    "no other does".to_owned()
                };
                let beams = if a == b {
                    format!("at beam `{}`", self.beam(*a))
                } else {
                    format!("between `{}` and `{}`", self.beam(*a), self.beam(*b))
                };
                message = format!("a fillet of radius {} does not fit {beams} at `{}`; {fits}", show(*radius_m), self.joint(joint));
                if let Some(all_m) = self.largest_fillet_m(*radius_m) {
                    message = format!("{message}, and all joints take {}", show(all_m));
                }
                help = "set `parts.fillet`, take a smaller cutter, or let the beams meet at a larger angle";
            }
            OutlineError::Overlap { tags: [a, b], at_m } => {
                message = format!("{} and {} run into each other at {}", self.tag(a), self.tag(b), at(at_m));
                help = "move a node, change the shape, or make `parts.pad` smaller";
            }
            OutlineError::TightBend { strip, u, radius_m } => {
                message = format!(
                    "beam `{}` bends with a radius of {} at u = {u:.3}: less than half its thickness",
                    self.beam(*strip),
                    show(*radius_m)
                );
            }
            OutlineError::NoMeeting { strip, block } => {
                message = format!("beam `{}` does not leave the pad or block `{}`", self.beam(*strip), self.joint(&Joint::Block(*block)));
                help = "make `parts.pad` smaller, or let the beam leave its node across the edge of the pad";
            }
            OutlineError::NotSimple => "beams cross over each other".clone_into(&mut message),
            OutlineError::Strip { strip, what } => message = format!("beam `{}`: {what}", self.beam(*strip)),
            OutlineError::Block { block } => {
                message = format!("the pad or block `{}` has no area", self.joint(&Joint::Block(*block)));
                help = "move its nodes apart, or make `parts.pad` larger";
            }
            _ => {}
        }
        no_part(message, help)
    }

    fn joint(&self, joint: &Joint) -> String {
        match *joint {
            Joint::Block(b) => self.solids.get(b).map_or_else(|| "?".to_owned(), |s| s.name.clone()),
            Joint::Node(n) => self.nodes.get(n).map_or_else(|| "?".to_owned(), |p| self.node_at(*p)),
        }
    }

    fn tag(&self, tag: &Tag) -> String {
        match *tag {
            Tag::Side { strip, .. } => format!("beam `{}`", self.beam(strip)),
            Tag::Fillet { joint } => format!("a fillet at `{}`", self.joint(&joint)),
            Tag::Round { node } | Tag::Step { node } | Tag::Cap { node } => format!("the beams at `{}`", self.joint(&Joint::Node(node))),
            Tag::Edge { block, .. } | Tag::Corner { block, .. } => format!("the pad or block `{}`", self.joint(&Joint::Block(block))),
        }
    }

    fn beam(&self, strip: usize) -> String {
        let count = self.design.beam_names.len().max(1);
        self.design.beam_names.get(strip % count).cloned().unwrap_or_default()
    }

    fn node_at(&self, at: [f64; 2]) -> String {
        let near = |p: [f64; 2]| maths::hypot(p[0] - at[0], p[1] - at[1]) < 1e-9;
        let found = self.design.drawn.iter().find(|d| self.images.iter().any(|i| near(i.of(d.position_m))));
        found.map_or_else(|| "?".to_owned(), |d| d.name.clone())
    }
}

/// Whether a point lies on the other side of a mirror line than its owner, or on the line.
fn beyond(mirror: Mirror, own: [f64; 2], p: [f64; 2]) -> bool {
    let off = |p: [f64; 2]| match mirror {
        Mirror::X(at) => p[0] - at,
        Mirror::Y(at) => p[1] - at,
    };
    off(own) * off(p) <= 0.0
}

/// A beam of a copy as a band of material.
fn strip<'a>(design: &Design, beam: &'a Beam, image: Image, ends: [Joint; 2]) -> Strip<'a> {
    let start = design.start_m(beam);
    let zero = image.of([0.0, 0.0]);
    let hand = if image.reflection.is_some() { -1.0 } else { 1.0 };
    let length_m = beam.shape.length_m();
    let axis = move |u: f64| {
        let p = beam.shape.point_m(u);
        let (sin, cos) = maths::sin_cos(beam.shape.angle_at(u));
        let tip = image.of([cos, sin]);
        AxisPoint {
            point_m: image.of([start[0] + p[0], start[1] + p[1]]),
            tangent: [tip[0] - zero[0], tip[1] - zero[1]],
            curvature_per_m: hand * beam.shape.slope_at(u) / length_m,
        }
    };
    let half_width = if beam.profile.is_empty() {
        HalfWidth::Constant(0.5 * beam.section.thickness_m)
    } else {
        HalfWidth::Linear(beam.profile.iter().map(|p| [p[0], 0.5 * p[1]]).collect())
    };
    Strip { axis: Box::new(axis), length_m, half_width, ends }
}

/// Hinges and free rotation are no part of one piece.
fn one_piece(design: &Design) -> Result<(), NoPart> {
    let mut kinds = design.beam_materials.clone();
    kinds.sort_unstable();
    kinds.dedup();
    if kinds.len() > 1 {
        return Err(no_part(
            "beams of different materials are not cut from one plate",
            "give all beams one material, or make them by projects of their own",
        ));
    }
    let beams = design.network.beams.iter().zip(&design.beam_names);
    let hinged = beams.clone().find(|(b, _)| b.start_joint == BeamJoint::Hinged || b.end_joint == BeamJoint::Hinged);
    if let Some((_, name)) = hinged {
        return Err(no_part(
            format!("beam `{name}` is hinged: a hinge is not cut in one piece"),
            "draw the beam without `hinged`, or make the parts on both sides of the hinge by projects of their own",
        ));
    }
    let turns = |s: &Support| matches!(s, Support::Pinned | Support::Slider { rotation: Rotation::Free, .. });
    if let Some(node) = design.network.nodes.iter().position(|n| turns(&n.support)) {
        return Err(no_part(
            format!("node `{}` turns on its support: a bearing is not cut in one piece", design.node_names[node]),
            "clamp it, or let a slider keep its angle",
        ));
    }
    Ok(())
}

/// Half way between the two faces of a narrow place, m.
fn middle(narrow: &Narrow) -> [f64; 2] {
    [0, 1].map(|k| f64::midpoint(narrow.at_m[0][k], narrow.at_m[1][k]))
}

/// The arcs of a piece of material that are fillets.
fn fillets(region: &Region) -> Option<Fillets> {
    let mut found: Option<Fillets> = None;
    for boundary in std::iter::once(&region.outer).chain(&region.windows) {
        let mut from = boundary.profile.start_m;
        for (segment, tag) in boundary.profile.segments.iter().zip(&boundary.tags) {
            if let (Segment::Arc { centre_m, .. }, Tag::Fillet { .. }) = (segment, tag) {
                let radius_m = maths::hypot(from[0] - centre_m[0], from[1] - centre_m[1]);
                let so_far = found.unwrap_or(Fillets { count: 0, radius_m: [f64::INFINITY, 0.0] });
                let [least, most] = so_far.radius_m;
                found = Some(Fillets { count: so_far.count + 1, radius_m: [least.min(radius_m), most.max(radius_m)] });
            }
            from = segment.end_m();
        }
    }
    found
}

/// COMP011 and COMP012: what the process leaves standing, and what it can cut out.
fn checks(design: &Design, [wall, gap]: [Option<Narrow>; 2]) -> Vec<Check> {
    let making = &design.making;
    let gap_min_m = making.gap_min_m.or(making.cutter_m);
    let one = |code, name: &str, what: &str, found: Option<Narrow>, limit: Option<f64>, fix: &str, missing: &str| {
        let value = found.map(|n| n.width_m);
        let margin = value.zip(limit).map(|(v, l)| Check::margin_of(v, l, Sense::AtLeast, l));
        let at = found.map_or_else(String::new, |n| {
            // Rounding is nothing to show.
            let whole = |m: f64| if m.abs() < 1e-9 { 0.0 } else { m };
            let [x, y] = middle(&n).map(|m| format_si(whole(m), &design.units.length, 4));
            format!(" (at {x}, {y})")
        });
        let state = match (value, limit) {
            (Some(v), Some(l)) if v >= l * (1.0 - 1e-6) => CheckState::Met,
            (Some(_), Some(_)) => CheckState::Missed,
            _ => CheckState::NotAssessed,
        };
        Check {
            code,
            name: name.to_owned(),
            title: format!("{what}{at}"),
            required: limit.is_some(),
            state,
            value,
            limit,
            sense: Sense::AtLeast,
            dimension: Dimension::Length,
            display: design.units.length.clone(),
            margin,
            basis: "smallest circle between two faces of the outline, holes included".to_owned(),
            advice: match state {
                CheckState::Met => None,
                CheckState::Missed => Some(fix.to_owned()),
                CheckState::NotAssessed => Some(missing.to_owned()),
            },
        }
    };
    vec![
        one(
            "COMP011",
            "wall",
            "Thinnest wall",
            wall,
            making.wall_min_m,
            "make the beam there thicker, or the hole smaller",
            "give `process.wall_min`, the thinnest wall that the process leaves",
        ),
        one(
            "COMP012",
            "gap",
            "Narrowest gap",
            gap,
            gap_min_m,
            "move the nodes or pads apart there, or take a smaller cutter",
            "give `process.cutter_diameter` or `process.gap_min`, the narrowest gap that the process cuts",
        ),
    ]
}
