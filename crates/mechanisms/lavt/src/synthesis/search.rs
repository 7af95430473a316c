//! The search: every gear set with every spring of the grid, gears and springs apart.
//!
//! Why nothing is lost stands in `docs/theory/lavt-synthesis.md`; a test compares with the statics of every combination.

use std::cell::Cell;

use forcewright_contract::synthesis::Watch;

use super::asked::Asked;
use super::front::{Objectives, Point, front};
use super::gears::{Book, Class, Sound, classes, design, face_m, geared, plate_m, wall_m};
use super::springs::{Factors, Seat};
use crate::analysis::{Behaviour, measure};
use crate::design::{Built, Design};
use crate::sizes::{envelope_m3, length_m, outer_m};

/// Designs held in a class before those that others beat are dropped.
const MOST_HELD: usize = 1 << 17;
/// Full analyses for limits on metrics in one search at most.
const MOST_MEASURED: u64 = 50_000;

/// What was found, and what it took.
#[derive(Clone, Debug, Default)]
pub(super) struct Found {
    /// Designs of which no other is better in everything, the smallest first.
    pub front: Vec<Point>,
    /// The gear sets that they point to.
    pub sets: Vec<Sound>,
    /// Gear sets and springs in the grid.
    pub raw: [f64; 2],
    /// Gear sets that can be put together and keep the speed.
    pub assembled: usize,
    /// Of those for which there are springs: such that run and have room, such that have no room, and such that no profile shift mends.
    pub sound: usize,
    pub large: usize,
    pub blocked: usize,
    /// Springs that keep all that does not depend on gears.
    pub springs: u64,
    /// Designs that keep everything, before limits on metrics.
    pub feasible: u64,
    /// For each speed: R, springs that fit, gear sets that run, the smallest volume and the largest output torque.
    pub speeds: Vec<Speed>,
    /// Whether so many were analysed for limits that the rest was given up.
    pub cut: bool,
    pub interrupted: bool,
}

/// What there is for a ratio.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Speed {
    pub ratio: f64,
    pub module: usize,
    pub springs: u64,
    pub sets: usize,
    pub least_m3: f64,
    pub most_output_nm: f64,
    pub least_friction: f64,
}

/// A column of the grid of springs that a class takes: a seat with turns on the hub and the least turns in the bore.
pub(super) struct Column<'a> {
    pub class: usize,
    pub seat: &'a Seat,
    pub hub: usize,
    /// Turns in the bore from this place to before the other.
    pub bore: [usize; 2],
}

/// Every seat of the grid that the wire endures, in order; `false` from either ends it.
fn seats(asked: &Asked, watch: &dyn Fn(f64) -> bool, mut each: impl FnMut(&Seat) -> bool) -> bool {
    let rows = asked.wires.len() * asked.radii_m.len();
    for wire in 0..asked.wires.len() {
        for radius in 0..asked.radii_m.len() {
            if !watch((wire * asked.radii_m.len() + radius) as f64 / rows as f64) {
                return false;
            }
            for gap in 0..asked.gaps_m.len() {
                for difference in 0..asked.differences_m.len() {
                    if let Some(seat) = Seat::new(asked, [wire, radius, gap, difference]).filter(|s| s.lasts(asked))
                        && !each(&seat)
                    {
                        return false;
                    }
                }
            }
        }
    }
    true
}

/// Every column that some class takes; how many springs keep what does not depend on gears, and whether it came to the end. `false` ends it.
pub(super) fn walk(
    asked: &Asked,
    classes: &[Class],
    watch: &dyn Fn(f64) -> bool,
    mut each: impl FnMut(&Column<'_>) -> bool,
) -> (u64, bool) {
    let factors = Factors::new(asked);
    let mut springs = 0;
    let mut held_nm: Vec<f64> = Vec::new();
    let whole = seats(asked, watch, |seat| {
        for hub in 0..asked.hub_turns.len() {
            if !seat.shifts(factors.slip[0][hub]) {
                continue;
            }
            springs += asked.bore_turns.len() as u64;
            // More turns in the bore hold more.
            held_nm.clear();
            held_nm.extend(factors.grip.iter().map(|grip| seat.held_nm(factors.slip[0][hub], *grip)));
            for (index, class) in classes.iter().enumerate() {
                if !seat.suits(class, factors.slip[2][hub]) {
                    continue;
                }
                let from = held_nm.partition_point(|nm| *nm < class.needed_nm);
                let long = |bore: &usize| long_m(asked, class, seat, [hub, *bore]) > asked.envelope_m[1];
                let to = (from..held_nm.len()).find(long).unwrap_or(held_nm.len());
                if from < to && has_room(asked, class, seat) && !each(&Column { class: index, seat, hub, bore: [from, to] }) {
                    return false;
                }
            }
        }
        true
    });
    (springs, whole)
}

/// Whether a spring has room whatever the ring: in the envelope, and in a chassis whose diameter is given.
fn has_room(asked: &Asked, class: &Class, seat: &Seat) -> bool {
    let wall_m = wall_m(asked, class.module);
    let is_walled = asked.template.making.chassis_m.is_none_or(|chassis_m| chassis_m >= seat.bore_m + 2.0 * wall_m);
    is_walled && outer_m(0.0, seat.bore_m, wall_m, asked.template.making.chassis_m) <= asked.envelope_m[0]
}

/// Length with these turns on the hub and in the bore, m.
pub(super) fn long_m(asked: &Asked, class: &Class, seat: &Seat, [hub, bore]: [usize; 2]) -> f64 {
    let turns = asked.hub_turns[hub] + asked.free_turns + asked.bore_turns[bore];
    length_m([face_m(asked, class.module), plate_m(asked, class.module)], turns, seat.wire_m)
}

/// Gear sets of a class that run and have room, and how many more run.
pub(super) fn running(asked: &Asked, book: &Book, class: &Class) -> (Vec<Sound>, usize) {
    let mut all: Vec<Sound> = class.sets.iter().filter_map(|set| book.sound(asked, *set)).collect();
    let run = all.len();
    all.retain(|sound| {
        outer_m(sound.ring_root_m, 0.0, wall_m(asked, class.module), asked.template.making.chassis_m) <= asked.envelope_m[0]
    });
    let large = run - all.len();
    (all, large)
}

/// A class with what was found for it.
#[derive(Default)]
struct Held {
    /// Gear sets that run: where they begin in the list, and how many.
    sets: Option<[usize; 2]>,
    points: Vec<Point>,
    springs: u64,
    most_output_nm: f64,
    least_friction: f64,
}

struct Search<'a> {
    asked: &'a Asked,
    book: &'a Book,
    classes: Vec<Class>,
    factors: Factors,
    held: Vec<Held>,
    found: Found,
    /// Whether every gear set of a class is set beside the others.
    every: bool,
    measured: u64,
}

/// Every design that keeps everything, and those that no other one beats.
pub(super) fn search(asked: &Asked, book: &Book, watch: Watch<'_>) -> Found {
    taken(asked, book, !asked.limits.is_empty(), watch).end(watch)
}

/// What the grid has, not yet compared.
fn taken<'a>(asked: &'a Asked, book: &'a Book, every: bool, watch: Watch<'_>) -> Search<'a> {
    let (classes, assembled) = classes(asked, book, &|| watch(0.0));
    let held = classes.iter().map(|_| Held { least_friction: f64::INFINITY, ..Held::default() }).collect();
    let found = Found { raw: asked.raw(), assembled, ..Found::default() };
    let mut search = Search { asked, book, classes: classes.clone(), factors: Factors::new(asked), held, found, every, measured: 0 };
    let at = Cell::new(0.0);
    let seen = |part: f64| {
        at.set(part);
        watch(part)
    };
    let (springs, whole) = walk(asked, &classes, &seen, |column| {
        let known = search.held[column.class].sets.is_some();
        search.take(column);
        // Profile shifts take a while.
        known || watch(at.get())
    });
    search.found.springs = springs;
    search.found.interrupted = !whole;
    search
}

/// Every design that keeps everything, also with gear sets that cannot be the smallest.
#[cfg(test)]
pub(super) fn everything(asked: &Asked, book: &Book) -> (Vec<Point>, Vec<Sound>) {
    let mut search = taken(asked, book, true, &|_| true);
    let points = search.held.iter_mut().flat_map(|held| std::mem::take(&mut held.points)).collect();
    (points, search.found.sets)
}

impl Search<'_> {
    /// Gear sets of a class, once.
    fn sets(&mut self, class: usize) -> [usize; 2] {
        if let Some(known) = self.held[class].sets {
            return known;
        }
        let (all, large) = running(self.asked, self.book, &self.classes[class]);
        let here = [self.found.sets.len(), all.len()];
        self.found.sound += all.len();
        self.found.large += large;
        self.found.blocked += self.classes[class].sets.len() - all.len() - large;
        self.found.sets.extend(all);
        self.held[class].sets = Some(here);
        here
    }

    fn take(&mut self, column: &Column<'_>) {
        let [first, count] = self.sets(column.class);
        if count == 0 {
            return;
        }
        let springs = (column.bore[1] - column.bore[0]) as u64;
        self.found.feasible += springs * count as u64;
        // Of sets with the same ratio and width the smallest is nowhere worse; a limit on a metric may speak against it.
        let all = first..first + count;
        let smallest = all.clone().min_by(|a, b| self.found.sets[*a].ring_m.total_cmp(&self.found.sets[*b].ring_m)).unwrap_or(first);
        let wanted = if self.every { all } else { smallest..smallest + 1 };
        for bore in column.bore[0]..column.bore[1] {
            for set in wanted.clone() {
                let objectives = self.objectives(column, bore, set);
                let held = &mut self.held[column.class];
                held.most_output_nm = held.most_output_nm.max(-objectives[1]);
                held.least_friction = held.least_friction.min(objectives[3]);
                held.points.push(Point { objectives, place: place(column, bore), set: u32::try_from(set).unwrap_or(u32::MAX) });
            }
        }
        let held = &mut self.held[column.class];
        held.springs += springs;
        if held.points.len() > MOST_HELD {
            self.thin(column.class);
        }
    }

    fn objectives(&self, column: &Column<'_>, bore: usize, set: usize) -> Objectives {
        let (asked, class, seat) = (self.asked, &self.classes[column.class], column.seat);
        let (slip, grip) = (&self.factors.slip, self.factors.grip[bore]);
        let [hub_exponents, bore_exponents] = &self.factors.exponents;
        let output_nm = class.driven_nm - seat.hub_nm * slip[1][column.hub];
        let needed_nm = class.needed_nm;
        let friction = seat.friction_left(needed_nm, hub_exponents[column.hub], bore_exponents[bore]);
        let gap_m = seat.gap_left_m(needed_nm, slip[0][column.hub], grip);
        let outer_m = outer_m(self.found.sets[set].ring_root_m, seat.bore_m, wall_m(asked, class.module), asked.template.making.chassis_m);
        let length_m = long_m(asked, class, seat, [column.hub, bore]);
        [envelope_m3([outer_m, length_m]), -output_nm, -class.ratio * output_nm / asked.input_nm, friction, -gap_m]
    }

    /// Drops what others beat.
    fn thin(&mut self, class: usize) {
        let points = std::mem::take(&mut self.held[class].points);
        self.held[class].points = self.front_of(points);
    }

    fn front_of(&mut self, points: Vec<Point>) -> Vec<Point> {
        let (asked, found, measured) = (self.asked, &mut self.found, &mut self.measured);
        front(points, |point| {
            if asked.limits.is_empty() {
                return true;
            }
            if *measured >= MOST_MEASURED {
                found.cut = true;
                return false;
            }
            *measured += 1;
            keeps_limits(asked, &designed(asked, &found.sets[point.set as usize], point.place))
        })
    }

    fn end(mut self, watch: Watch<'_>) -> Found {
        let mut all = Vec::new();
        for class in 0..self.classes.len() {
            if !self.found.interrupted {
                self.found.interrupted = !watch(1.0);
            }
            self.thin(class);
            let held = &mut self.held[class];
            if let (Some(least), Some([_, sets])) = (held.points.first(), held.sets) {
                self.found.speeds.push(Speed {
                    ratio: self.classes[class].ratio,
                    module: self.classes[class].module,
                    springs: held.springs,
                    sets,
                    least_m3: least.objectives[0],
                    most_output_nm: held.most_output_nm,
                    least_friction: held.least_friction,
                });
            }
            all.append(&mut held.points);
        }
        // Limits were looked at within the classes.
        self.found.front = front(all, |_| true);
        self.found
    }
}

fn place(column: &Column<'_>, bore: usize) -> [u16; 6] {
    let [wire, radius, gap, difference] = column.seat.place;
    // Axes of the grid have at most two thousand values.
    [wire, radius, gap, difference, column.hub, bore].map(|i| u16::try_from(i).unwrap_or(u16::MAX))
}

/// The transmission of a point.
pub(super) fn built(asked: &Asked, sound: &Sound, place: [u16; 6]) -> Built {
    Built { gears: geared(asked, sound), ..asked.spring(place.map(usize::from)) }
}

/// Its design, as its file will have it.
pub(super) fn designed(asked: &Asked, sound: &Sound, place: [u16; 6]) -> Design {
    let built = built(asked, sound, place);
    let mut design = design(asked, &built, built.gears);
    let wire = usize::from(place[0]);
    if let Some(scatter) = asked.scatter(&built, wire) {
        design.scatter = scatter;
    }
    design.wire.tensile_pa = asked.wires[wire].tensile_pa;
    design
}

/// Whether limits on metrics are kept.
fn keeps_limits(asked: &Asked, design: &Design) -> bool {
    let Ok(behaviour) = Behaviour::of(design) else { return false };
    let measured = measure(design, &behaviour);
    asked.limits.iter().all(|limit| {
        measured.value(limit.metric).is_some_and(|x| limit.min.is_none_or(|min| x >= min) && limit.max.is_none_or(|max| x <= max))
    })
}
