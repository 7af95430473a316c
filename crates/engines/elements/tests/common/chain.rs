//! A cable of nodes and springs on two drums with Coulomb friction, written apart from the library.
//!
//! The chain runs from a termination on the output drum over the input drum to the second termination. A node on a drum sticks to it, or
//! slides with a friction force of μΔθ times the mean of the tensions next to it. Each displacement is reached in small steps; in a step
//! the set of sliding nodes is searched for (an active set): with the set given, all equations are linear.

use forcewright_elements::wrap::{DriveSpec, Hold};

/// What a node does.
#[derive(Clone, Copy, PartialEq)]
enum Contact {
    Stick,
    /// Slides; with the sign of the velocity along the chain.
    Slide(f64),
}

/// A node: where it may stick.
struct Node {
    on_input: bool,
    /// μΔθ.
    friction: f64,
    contact: Contact,
    /// Position along the chain less its place on the drum.
    held_m: f64,
    /// Whether it slid in the last movement.
    slid: bool,
}

pub(crate) struct Chain {
    nodes: Vec<Node>,
    /// Springs: between node i − 1 and i; the first and the last end at a termination.
    stiffness_n_per_m: Vec<f64>,
    preload_n: f64,
    positions_m: Vec<f64>,
    displacement_m: f64,
    friction_j: f64,
    /// Number of nodes of: first output wrap, input wrap (in one or two parts), second output wrap.
    counts: [usize; 3],
    angles_rad: [f64; 3],
    /// Node on the input drum that is fastened to it.
    fixed: Option<usize>,
}

impl Chain {
    pub(crate) fn new(spec: &DriveSpec, per_wrap: usize) -> Self {
        let (input_rad, before_fix) = match spec.hold {
            Hold::Friction { wrap_rad } => (wrap_rad, None),
            Hold::Fixed { wraps_rad: [a, b] } => (a + b, Some(a)),
        };
        let angles_rad = [spec.output_wraps_rad[0], input_rad, spec.output_wraps_rad[1]];
        let mut chain = Self {
            nodes: Vec::new(),
            stiffness_n_per_m: Vec::new(),
            preload_n: spec.preload_n,
            positions_m: Vec::new(),
            displacement_m: 0.0,
            friction_j: 0.0,
            counts: [per_wrap; 3],
            angles_rad,
            fixed: None,
        };
        let mut pending_m = 0.0;
        for (part, drum) in [spec.output, spec.input, spec.output].into_iter().enumerate() {
            let step_rad = angles_rad[part] / per_wrap as f64;
            // Nodes in the middle of their arc: half an arc of cable before the first and after the last.
            for i in 0..per_wrap {
                let length_m = drum.radius_m * step_rad;
                pending_m += if i == 0 { 0.5 * length_m } else { length_m };
                chain.stiffness_n_per_m.push(spec.axial_stiffness_n / pending_m);
                pending_m = 0.0;
                let contact = Contact::Stick;
                chain.nodes.push(Node { on_input: part == 1, friction: drum.friction * step_rad, contact, held_m: 0.0, slid: false });
            }
            pending_m += 0.5 * drum.radius_m * step_rad + spec.spans_m.get(part).copied().unwrap_or(0.0);
        }
        chain.stiffness_n_per_m.push(spec.axial_stiffness_n / pending_m);
        if let Some(a) = before_fix {
            let fraction = a / input_rad;
            let nearest = (0..per_wrap).min_by(|&i, &j| {
                let off = |i: usize| ((i as f64 + 0.5) / per_wrap as f64 - fraction).abs();
                off(i).total_cmp(&off(j))
            });
            chain.fixed = nearest.map(|i| per_wrap + i);
        }
        chain.positions_m = vec![0.0; chain.nodes.len()];
        chain
    }

    fn tension_n(&self, spring: usize) -> f64 {
        let at = |i: Option<usize>| i.and_then(|i| self.positions_m.get(i)).copied().unwrap_or(0.0);
        self.preload_n + self.stiffness_n_per_m[spring] * (at(Some(spring)) - at(spring.checked_sub(1)))
    }

    /// Tensions of the two free spans.
    pub(crate) fn tensions_n(&self) -> [f64; 2] {
        [self.tension_n(self.counts[0]), self.tension_n(self.counts[0] + self.counts[1])]
    }

    pub(crate) fn force_n(&self) -> f64 {
        let [a, b] = self.tensions_n();
        a - b
    }

    pub(crate) fn friction_j(&self) -> f64 {
        self.friction_j
    }

    /// Angle over which nodes slid since rest or the last call of [`Chain::go_to`], from a span, on the output (0) or input drum (1); and the
    /// distance of the nodes.
    pub(crate) fn slip_rad(&self, side: usize, drum: usize) -> [f64; 2] {
        let (first, second) = (self.counts[0], self.counts[0] + self.counts[1]);
        let slid = |nodes: &mut dyn Iterator<Item = usize>| nodes.take_while(|&i| self.nodes[i].slid).count();
        let (count, part) = match (side, drum) {
            (0, 0) => (slid(&mut (0..first).rev()), 0),
            (0, _) => (slid(&mut (first..second)), 1),
            (_, 0) => (slid(&mut (second..self.nodes.len())), 2),
            _ => (slid(&mut (first..second).rev()), 1),
        };
        let distance = self.angles_rad[part] / self.counts[part] as f64;
        [count as f64 * distance, distance]
    }

    /// Moves the input drum to a displacement in equal steps.
    pub(crate) fn go_to(&mut self, displacement_m: f64, steps: u32) {
        let from_m = self.displacement_m;
        for node in &mut self.nodes {
            node.slid = false;
        }
        for step in 1..=steps {
            self.step(from_m + (displacement_m - from_m) * f64::from(step) / f64::from(steps));
        }
    }

    fn step(&mut self, displacement_m: f64) {
        self.displacement_m = displacement_m;
        for node in &mut self.nodes {
            node.contact = Contact::Stick;
        }
        for trial in 0..20_000 {
            self.solve();
            // One node at a time where changing all at once goes in circles.
            if !self.change_contacts(trial > 200) {
                self.finish();
                return;
            }
        }
        panic!("no set of sliding nodes was found");
    }

    /// Place of the drum under a node.
    fn drum_m(&self, node: &Node) -> f64 {
        if node.on_input { self.displacement_m } else { 0.0 }
    }

    /// Positions for the present contacts, by elimination in a tridiagonal system.
    fn solve(&mut self) {
        let n = self.nodes.len();
        let (mut upper, mut right) = (vec![0.0; n], vec![0.0; n]);
        for i in 0..n {
            let node = &self.nodes[i];
            let (before, after) = (self.stiffness_n_per_m[i], self.stiffness_n_per_m[i + 1]);
            // after · (x_{i+1} − x_i) − before · (x_i − x_{i−1}) = friction.
            let (a, b, c, d) = match node.contact {
                Contact::Stick => (0.0, 1.0, 0.0, node.held_m + self.drum_m(node)),
                Contact::Slide(sign) => {
                    // Friction acts against the sliding: T_after − T_before = sign · μΔθ · mean tension.
                    let f = 0.5 * sign * node.friction;
                    (before * (1.0 + f), -before * (1.0 + f) - after * (1.0 - f), after * (1.0 - f), 2.0 * f * self.preload_n)
                }
            };
            let (left_upper, left_right) = if i == 0 { (0.0, 0.0) } else { (upper[i - 1], right[i - 1]) };
            let pivot = b - a * left_upper;
            upper[i] = c / pivot;
            right[i] = (d - a * left_right) / pivot;
        }
        for i in (0..n).rev() {
            let next = if i + 1 < n { self.positions_m[i + 1] } else { 0.0 };
            self.positions_m[i] = right[i] - upper[i] * next;
        }
    }

    /// Nodes that stick with too much friction begin to slide; nodes that slide against their friction stick again.
    fn change_contacts(&mut self, one: bool) -> bool {
        let mut changed = false;
        for i in 0..self.nodes.len() {
            if self.fixed == Some(i) {
                continue;
            }
            let (before, after) = (self.tension_n(i), self.tension_n(i + 1));
            let node = &self.nodes[i];
            let limit = node.friction * 0.5 * (before + after);
            let slid_m = self.positions_m[i] - self.drum_m(node) - node.held_m;
            let next = match node.contact {
                Contact::Stick if (after - before).abs() > limit * (1.0 + 1e-8) => Contact::Slide((after - before).signum()),
                Contact::Slide(sign) if slid_m * sign < -1e-16 => Contact::Stick,
                contact => contact,
            };
            changed |= next != node.contact;
            self.nodes[i].contact = next;
            if one && changed {
                break;
            }
        }
        changed
    }

    fn finish(&mut self) {
        for i in 0..self.nodes.len() {
            let force_n = self.tension_n(i + 1) - self.tension_n(i);
            let drum_m = self.drum_m(&self.nodes[i]);
            let node = &mut self.nodes[i];
            if let Contact::Slide(_) = node.contact {
                let held_m = self.positions_m[i] - drum_m;
                self.friction_j += (force_n * (held_m - node.held_m)).abs();
                node.slid |= (held_m - node.held_m).abs() > 0.0;
                node.held_m = held_m;
            }
        }
    }
}
