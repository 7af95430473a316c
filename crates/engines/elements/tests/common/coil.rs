//! A rod wound to a coil, with unilateral frictional contact on a hub and in a bore, written apart from the library.
//!
//! A planar rod on the unit circle with EI = 1 and a tensile compliance ε (0 for a rod that keeps its length): polar angle θ from the free end on the hub to the end at S, radial
//! and tangential displacement w and v, rotation β, and in a section the moment M (positive where it opens the coil), the shear force Q
//! (radial) and the tension T. Small displacements against the radius:
//!
//! ```text
//! w' = v − β,  v' = −w + εT,  β' = −M,  M' = −Q,  Q' = T − p,  T' = −Q − f
//! ```
//!
//! with the radial and tangential forces p and f. The torque about the centre is τ = M − T, τ' = f. Contact is at nodes with forces on them;
//! between nodes the equations are solved exactly. What is unknown (the state at each node and its two forces) is found from one banded
//! system, and which nodes touch, stick or slip by an active set.

use std::f64::consts::TAU;

use forcewright_base::maths::sin_cos;

/// What holds the end at S.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum End {
    /// A torque only; the end is free to move.
    Torque,
    /// Clamped to S at a radial displacement, along the circle.
    Held { w: f64 },
}

/// A coil. Lengths are in mean radii of the free coil.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rod {
    pub hub_interference: f64,
    pub hub_turns: f64,
    pub free_turns: f64,
    pub bore_opening: f64,
    pub bore_turns: f64,
    pub friction: f64,
    /// `EI/(EA r²)`: 1/(4ρ²) for round wire. Without it nodes that touch cannot move against each other, and sticking is not determined.
    pub compliance: f64,
    pub nodes_per_turn: u32,
    pub end: End,
}

/// Torques in units of EI over the radius.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Torques {
    /// Beyond the hub.
    pub hub: f64,
    /// At S.
    pub end: f64,
    /// By how much the turn behind the hub lies off centre: half of its range of radial displacements.
    pub off_centre: f64,
}

#[derive(Clone, Copy, PartialEq, Debug)]
enum Contact {
    Open,
    /// Without friction.
    Smooth,
    /// At a tangential displacement.
    Stick(f64),
    /// With the sign of the friction force along θ.
    Slip(f64),
}

#[derive(Clone, Copy, PartialEq)]
enum Surface {
    None,
    Hub,
    Bore,
}

/// How the rotation of the end at S is fixed.
#[derive(Clone, Copy)]
enum Gauge {
    /// No tangential displacement of the end.
    Displacement,
    /// A rotation of S.
    Rotation(f64),
}

/// Unknowns per node: w, β, v, M, Q, T, p, f.
const SIZE: usize = 8;

impl Rod {
    /// Number of arcs between nodes in some turns.
    fn count(&self, turns: f64) -> usize {
        let wanted = turns * f64::from(self.nodes_per_turn);
        (0_u16..u16::MAX).find(|n| f64::from(*n) + 0.5 > wanted).map(usize::from).expect("a mesh of usual size")
    }

    fn surfaces(&self) -> Vec<Surface> {
        let [hub, free, bore] = [self.hub_turns, self.free_turns, self.bore_turns].map(|turns| self.count(turns));
        let held_end = matches!(self.end, End::Held { .. });
        (0..=hub + free + bore)
            .map(|i| match i {
                i if i == hub + free + bore && held_end => Surface::None,
                i if i <= hub => Surface::Hub,
                i if bore > 0 && i >= hub + free => Surface::Bore,
                _ => Surface::None,
            })
            .collect()
    }

    /// Where everything that touches slips: friction opens (`sense` 1) or closes (−1) the coil.
    pub(crate) fn limit(&self, sense: f64) -> Torques {
        let surfaces = self.surfaces();
        let mut contacts: Vec<Contact> =
            surfaces.iter().map(|s| if *s == Surface::None { Contact::Open } else { Contact::Slip(sense) }).collect();
        for _ in 0..300 {
            let y = self.solve(&surfaces, &contacts, Gauge::Displacement);
            if !self.update_normal(&surfaces, &mut contacts, &y, |_| Contact::Slip(sense)) {
                return self.torques(&y);
            }
        }
        panic!("the contact does not settle: {self:?}");
    }

    /// Torques while S turns in the opening sense by equal steps up to an angle (rad), from a coil put on the hub without friction.
    pub(crate) fn open(&self, angle: f64, steps: u32) -> Vec<Torques> {
        let surfaces = self.surfaces();
        let mut contacts: Vec<Contact> =
            surfaces.iter().map(|s| if *s == Surface::Hub { Contact::Smooth } else { Contact::Open }).collect();
        let mut y = self.solve(&surfaces, &contacts, Gauge::Rotation(0.0));
        while self.update_normal(&surfaces, &mut contacts, &y, |_| Contact::Smooth) {
            y = self.solve(&surfaces, &contacts, Gauge::Rotation(0.0));
        }
        for (i, contact) in contacts.iter_mut().enumerate().filter(|(_, contact)| **contact == Contact::Smooth) {
            *contact = Contact::Stick(y[SIZE * i + 2]);
        }
        let at = |step: u32| -angle * f64::from(step) / f64::from(steps);
        (1..=steps)
            .map(|step| {
                y = self.turn(&surfaces, &mut contacts, &y, [at(step - 1), at(step)], 6);
                self.torques(&y)
            })
            .collect()
    }

    /// Turns S from one angle to another: at once, or by halves where the contact does not settle.
    fn turn(&self, surfaces: &[Surface], contacts: &mut Vec<Contact>, last: &[f64], [from, to]: [f64; 2], halvings: u32) -> Vec<f64> {
        let before = contacts.clone();
        if let Some(y) = self.step(surfaces, contacts, last, to) {
            return y;
        }
        assert!(halvings > 0, "friction does not settle at {to}: {self:?}");
        *contacts = before;
        let middle = 0.5 * (from + to);
        let y = self.turn(surfaces, contacts, last, [from, middle], halvings - 1);
        self.turn(surfaces, contacts, &y, [middle, to], halvings - 1)
    }

    /// The next state of equilibrium after S has turned, if it is found: normal contact first, then sticking and slipping.
    fn step(&self, surfaces: &[Surface], contacts: &mut [Contact], last: &[f64], rotation: f64) -> Option<Vec<f64>> {
        let mut turns = vec![0_u32; contacts.len()];
        for _ in 0..250 {
            let y = self.solve(surfaces, contacts, Gauge::Rotation(rotation));
            let close = |i: usize| {
                turns[i] += 1;
                if turns[i] > 3 { Contact::Slip(1.0) } else { Contact::Stick(last[SIZE * i + 2]) }
            };
            if self.update_normal(surfaces, contacts, &y, close) {
                continue;
            }
            let mut changed = false;
            for (i, contact) in contacts.iter_mut().enumerate() {
                let (v, p, f) = (y[SIZE * i + 2], y[SIZE * i + 6], y[SIZE * i + 7]);
                match *contact {
                    Contact::Stick(_) if f.abs() > self.friction * p.abs() + 1e-8 * self.hub_interference => {
                        *contact = Contact::Slip(f.signum());
                    }
                    // A node at the border of the slip zone may come and go for ever: it is left slipping after a while.
                    Contact::Slip(sign) if sign * (v - last[SIZE * i + 2]) > 1e-7 * self.hub_interference && turns[i] < 3 => {
                        *contact = Contact::Stick(last[SIZE * i + 2]);
                        turns[i] += 1;
                    }
                    _ => continue,
                }
                changed = true;
            }
            if !changed {
                return Some(y);
            }
        }
        None
    }

    /// Opens nodes that are pulled and closes those that penetrate, the worst of each row of neighbours (all at once would not settle);
    /// whether any changed.
    fn update_normal(&self, surfaces: &[Surface], contacts: &mut [Contact], y: &[f64], mut closed: impl FnMut(usize) -> Contact) -> bool {
        let violation = |i: usize, contact: Contact| {
            let (w, p) = (y[SIZE * i], y[SIZE * i + 6]);
            let (depth, pull) = match surfaces[i] {
                Surface::None => return 0.0,
                Surface::Hub => (self.hub_interference - w, -p),
                Surface::Bore => (w - self.bore_opening, p),
            };
            (if contact == Contact::Open { depth } else { pull }) / self.hub_interference
        };
        let amounts: Vec<f64> = contacts.iter().enumerate().map(|(i, contact)| violation(i, *contact)).collect();
        let was_open: Vec<bool> = contacts.iter().map(|contact| *contact == Contact::Open).collect();
        let mut changed = false;
        let mut i = 0;
        while i < amounts.len() {
            let run = i;
            while i < amounts.len() && amounts[i] > 1e-8 && was_open[i] == was_open[run] {
                i += 1;
            }
            if let Some(worst) = (run..i).max_by(|a, b| amounts[*a].total_cmp(&amounts[*b])) {
                contacts[worst] = if was_open[worst] { closed(worst) } else { Contact::Open };
                changed = true;
            } else {
                i += 1;
            }
        }
        changed
    }

    fn torques(&self, y: &[f64]) -> Torques {
        // Behind the forces on the node.
        let at = |i: usize| y[SIZE * i + 3] - (y[SIZE * i + 5] - y[SIZE * i + 7]);
        let (hub, nodes) = (self.count(self.hub_turns), y.len() / SIZE);
        let turn = (hub..=hub + self.count(self.free_turns.min(1.0))).map(|i| y[SIZE * i]);
        let (low, high) = turn.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), w| (low.min(w), high.max(w)));
        Torques { hub: at(hub), end: at(nodes - 1), off_centre: 0.5 * (high - low) }
    }

    fn solve(&self, surfaces: &[Surface], contacts: &[Contact], gauge: Gauge) -> Vec<f64> {
        let (last, across) = (surfaces.len() - 1, transfer(TAU / f64::from(self.nodes_per_turn), self.compliance));
        let mut system = Banded::new(SIZE * surfaces.len(), 10, 9);
        // The end on the hub is free: M = Q = T = 0.
        for k in 0..3 {
            system.add(k, 3 + k, 1.0);
        }
        for (i, contact) in contacts.iter().enumerate() {
            let (row, column) = (3 + SIZE * i, SIZE * i);
            let (place, inward) = match surfaces[i] {
                Surface::Bore => (self.bore_opening, -1.0),
                _ => (self.hub_interference, 1.0),
            };
            if *contact == Contact::Open {
                system.add(row, column + 6, 1.0);
            } else {
                system.add(row, column, 1.0);
                system.right[row] = place;
            }
            match contact {
                Contact::Stick(v) => {
                    system.add(row + 1, column + 2, 1.0);
                    system.right[row + 1] = *v;
                }
                Contact::Slip(sign) => {
                    system.add(row + 1, column + 7, 1.0);
                    system.add(row + 1, column + 6, -sign * inward * self.friction);
                }
                Contact::Open | Contact::Smooth => system.add(row + 1, column + 7, 1.0),
            }
            if i < last {
                for (k, line) in across.iter().enumerate() {
                    let row = row + 2 + k;
                    for (j, value) in line.iter().enumerate() {
                        system.add(row, column + j, -value);
                    }
                    // Behind the node the forces are Q − p and T − f.
                    system.add(row, column + 6, line[4]);
                    system.add(row, column + 7, line[5]);
                    system.add(row, column + SIZE + k, 1.0);
                }
            }
        }
        self.hold_end(&mut system, last, gauge);
        system.solve()
    }

    fn hold_end(&self, system: &mut Banded, last: usize, gauge: Gauge) {
        let (row, column) = (5 + SIZE * last, SIZE * last);
        match self.end {
            End::Torque => {
                for (k, (force, load)) in [(4, 6), (5, 7)].into_iter().enumerate() {
                    system.add(row + k, column + force, 1.0);
                    system.add(row + k, column + load, -1.0);
                }
            }
            End::Held { w } => {
                system.add(row, column + 1, 1.0);
                system.add(row, column + 2, -1.0);
                system.add(row + 1, column, 1.0);
                system.right[row + 1] = w;
            }
        }
        match gauge {
            Gauge::Displacement => system.add(row + 2, column + 2, 1.0),
            Gauge::Rotation(beta) => {
                system.add(row + 2, column + 1, 1.0);
                system.right[row + 2] = beta;
            }
        }
    }
}

/// (w, β, v, M, Q, T) after an unloaded arc of an angle, from that before it.
fn transfer(t: f64, e: f64) -> [[f64; 6]; 6] {
    let (s, c) = sin_cos(t);
    [
        [c, -s, s, 1.0 - c, -0.5 * (1.0 + e) * (s - t * c), c - 1.0 + 0.5 * (1.0 + e) * t * s],
        [0.0, 1.0, 0.0, -t, 1.0 - c, t - s],
        [-s, 1.0 - c, c, s - t, 1.0 - c - 0.5 * (1.0 + e) * t * s, t - s - 0.5 * (s - t * c) + 0.5 * e * (s + t * c)],
        [0.0, 0.0, 0.0, 1.0, -s, c - 1.0],
        [0.0, 0.0, 0.0, 0.0, c, s],
        [0.0, 0.0, 0.0, 0.0, -s, c],
    ]
}

/// A banded system, solved by elimination with row pivots.
struct Banded {
    size: usize,
    lower: usize,
    width: usize,
    rows: Vec<f64>,
    right: Vec<f64>,
}

impl Banded {
    fn new(size: usize, lower: usize, upper: usize) -> Self {
        let width = 2 * lower + upper + 1;
        Self { size, lower, width, rows: vec![0.0; size * width], right: vec![0.0; size] }
    }

    fn index(&self, row: usize, column: usize) -> usize {
        row * self.width + column + self.lower - row
    }

    fn add(&mut self, row: usize, column: usize, value: f64) {
        let index = self.index(row, column);
        self.rows[index] += value;
    }

    fn solve(mut self) -> Vec<f64> {
        let reach = self.width - self.lower - 1;
        for k in 0..self.size {
            let (below, right) = ((k + self.lower).min(self.size - 1), (k + reach).min(self.size - 1));
            let size_of = |i: usize| self.rows[self.index(i, k)].abs();
            let pivot = (k..=below).max_by(|a, b| size_of(*a).total_cmp(&size_of(*b))).expect("a row");
            assert!(size_of(pivot) > 0.0, "singular at {k}");
            if pivot != k {
                for column in k..=right {
                    let (a, b) = (self.index(k, column), self.index(pivot, column));
                    self.rows.swap(a, b);
                }
                self.right.swap(k, pivot);
            }
            let start = self.index(k, k);
            let line: Vec<f64> = self.rows[start..=self.index(k, right)].to_vec();
            for i in k + 1..=below {
                let first = self.index(i, k);
                let factor = self.rows[first] / line[0];
                if factor.abs() > 0.0 {
                    self.rows[first..].iter_mut().zip(&line).for_each(|(x, y)| *x -= factor * y);
                    self.right[i] -= factor * self.right[k];
                }
            }
        }
        for k in (0..self.size).rev() {
            let right = (k + reach).min(self.size - 1);
            let sum: f64 = (k + 1..=right).map(|j| self.rows[self.index(k, j)] * self.right[j]).sum();
            self.right[k] = (self.right[k] - sum) / self.rows[self.index(k, k)];
        }
        self.right
    }
}
