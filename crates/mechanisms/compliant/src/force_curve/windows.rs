//! Intervals of a curve: the longest that keeps to a band, and the one of a given length that deviates least.
//!
//! Both ends of an interval move to the right only, from knot to knot; in between everything is monotone or smooth, so that ends are
//! roots of one cubic, and only stretches whose bound is better than the best so far are looked into.

use forcewright_base::roots;

use super::{ForceCurve, Interval, SLACK};

/// The longest interval so far.
struct Longest(Option<Interval>);

impl Longest {
    fn length(&self) -> f64 {
        self.0.map_or(0.0, |i| i.length())
    }

    fn offer(&mut self, start: f64, end: f64) {
        if end - start > self.length() {
            self.0 = Some(Interval { start, end });
        }
    }
}

/// Windows whose start and end each stay between two knots.
struct Cell {
    /// Smallest and largest start.
    starts: [f64; 2],
    /// Stretches of start and end.
    stretches: [usize; 2],
    /// Forces at smallest and largest start.
    at_start: [f64; 2],
    /// Forces at the ends of those windows.
    at_end: [f64; 2],
    /// Largest and smallest force at the knots between start and end.
    inner: (f64, f64),
}

/// Deviation of an extent from a level, or (level free) from its own middle, relative.
fn deviation((hi, lo): (f64, f64), nominal: Option<f64>) -> f64 {
    match nominal {
        Some(level) => (hi / level - 1.0).abs().max((lo / level - 1.0).abs()),
        // Half width β of the narrowest band with a free level: (max − min)/(max + min).
        None if hi + lo > 0.0 => (hi - lo) / (hi + lo),
        None => f64::INFINITY,
    }
}

impl Cell {
    fn extent(&self, at_start: f64, at_end: f64) -> (f64, f64) {
        let (hi, lo) = self.inner;
        (hi.max(at_start).max(at_end), lo.min(at_start).min(at_end))
    }

    /// No window of the cell has a smaller extent: both of its ends are monotone.
    fn least_extent(&self) -> (f64, f64) {
        let ([a0, a1], [b0, b1]) = (self.at_start, self.at_end);
        let (hi, lo) = self.inner;
        (hi.max(a0.min(a1)).max(b0.min(b1)), lo.min(a0.max(a1)).min(b0.max(b1)))
    }

    /// No window of the cell deviates less.
    fn bound(&self, nominal: Option<f64>) -> f64 {
        let (hi, lo) = self.least_extent();
        match nominal {
            Some(level) if level > 0.0 => (hi / level - 1.0).max(1.0 - lo / level),
            Some(_) => 0.0,
            // An extent of both signs is wider than its middle is high.
            None if lo <= 0.0 => 1.0,
            None => ((hi - lo) / (hi + lo)).max(0.0),
        }
    }
}

impl ForceCurve {
    /// Longest interval on which lo ≤ F ≤ hi.
    pub fn longest_within(&self, lo: f64, hi: f64) -> Option<Interval> {
        let band = lo - SLACK * lo.abs()..=hi + SLACK * hi.abs();
        let mut longest = Longest(None);
        let mut open: Option<f64> = None;
        for stretch in 0..self.stretches() {
            let (left, right) = (&self.knots[stretch], &self.knots[stretch + 1]);
            let above = left.force_n.min(right.force_n) > *band.end();
            let below = left.force_n.max(right.force_n) < *band.start();
            if above || below {
                open = None;
                continue;
            }
            let [from, to] = [left, right].map(|knot| {
                if band.contains(&knot.force_n) {
                    return knot.at;
                }
                self.place(stretch, if knot.force_n < lo { lo } else { hi })
            });
            let start = if band.contains(&left.force_n) { open.unwrap_or(from) } else { from };
            longest.offer(start, to);
            open = band.contains(&right.force_n).then_some(start);
        }
        longest.0
    }

    /// Longest interval of positive force with max F/min F ≤ (1 + β)/(1 − β), the level free.
    pub fn longest_flat(&self, band: f64) -> Option<Interval> {
        let ratio = (1.0 + band) / (1.0 - band);
        // From knot to knot first: whatever is no longer than that is not looked at closely.
        let mut reached = Vec::with_capacity(self.knots.len());
        let mut between_knots = 0.0_f64;
        self.each_reach(ratio, |from, to| {
            reached.push(to);
            between_knots = between_knots.max(self.knots[to].at - self.knots[from].at);
        });
        let mut longest = Longest(None);
        for (start, pair) in reached.windows(2).enumerate() {
            let bound = self.knots[(pair[1] + 1).min(self.stretches())].at - self.knots[start].at;
            if bound >= between_knots.max(longest.length()) {
                self.longest_from(start, pair[0], ratio, &mut longest);
            }
        }
        longest.0
    }

    /// Every knot, and the last one after it up to which the ratio is kept: itself, where its force is not positive.
    fn each_reach(&self, ratio: f64, mut visit: impl FnMut(usize, usize)) {
        let mut to = 0;
        for from in 0..self.knots.len() {
            to = to.max(from);
            to = self.reach(to, self.extremes(from, to), ratio);
            visit(from, to);
        }
    }

    /// The last knot up to which the ratio is kept by an interval that has reached a knot with the largest and smallest force so far.
    fn reach(&self, mut to: usize, (mut hi, mut lo): (f64, f64), ratio: f64) -> usize {
        while let Some(next) = self.knots.get(to + 1) {
            (hi, lo) = (hi.max(next.force_n), lo.min(next.force_n));
            if lo.is_nan() || lo <= 0.0 || hi > ratio * lo * (1.0 + SLACK) {
                break;
            }
            to += 1;
        }
        to
    }

    /// Intervals that start in a stretch; from its beginning they reach a knot, and the next one not.
    fn longest_from(&self, stretch: usize, reached: usize, ratio: f64, longest: &mut Longest) {
        let (left, right) = (&self.knots[stretch], &self.knots[stretch + 1]);
        if left.force_n.max(right.force_n) <= 0.0 {
            return;
        }
        let rising = right.force_n > left.force_n;
        // Where start and end are on stretches of the same direction, the force at the end is this multiple of that at the start.
        let factor = if rising { ratio } else { 1.0 / ratio };
        let reached_first = |a: f64, b: f64| if rising { a <= b } else { a >= b };
        let (mut start, mut force) = if left.force_n > 0.0 { (left.at, left.force_n) } else { (self.place(stretch, 0.0), 0.0) };
        let last_force = right.force_n.max(0.0);
        let mut to = reached;
        while to < self.stretches() {
            let (hi, lo) = self.extremes(stretch + 1, to);
            let next = self.knots[to + 1].force_n;
            // Not finite without anything inside.
            let pin = if rising { lo } else { hi };
            let same = (next > self.knots[to].force_n) == rising;
            if !same || reached_first(pin, force) {
                // Something inside decides about the end: a later start is a shorter interval.
                let (hi, lo) = (hi.max(force), lo.min(force));
                let level = if next > self.knots[to].force_n { ratio * lo } else { hi / ratio };
                longest.offer(start, self.place(to, level));
                return;
            }
            // The end follows the start, until the start is at the end of its stretch, the end at that of its own, or something inside
            // decides.
            let own = if reached_first(last_force, pin) { last_force } else { pin };
            let by_next = next / factor;
            let passes_next = reached_first(by_next, own);
            let until = if passes_next { by_next } else { own };
            let stop = self.place(stretch, until);
            self.follow([stretch, to], [start, stop], (factor, force, until), longest);
            if !passes_next {
                return;
            }
            (start, force) = (stop, until);
            let (hi, lo) = self.extremes(stretch + 1, to + 1);
            to = self.reach(to + 1, (hi.max(force), lo.min(force)), ratio);
        }
        longest.offer(start, self.end());
    }

    /// Intervals between two starts in one stretch whose ends follow in another: the force there is `factor` times that at the start,
    /// which goes from `force` to `until`.
    fn follow(&self, stretches: [usize; 2], starts: [f64; 2], (factor, force, until): (f64, f64, f64), longest: &mut Longest) {
        let ends = [force, until].map(|f| self.place(stretches[1], factor * f));
        longest.offer(starts[0], ends[0]);
        longest.offer(starts[1], ends[1]);
        if ends[1] - starts[0] <= longest.length() {
            return;
        }
        // The length grows as long as the end is faster than the start.
        let [from, to] = stretches.map(|s| self.of_stretch(s));
        let faster = |start: f64, end: f64| factor * from.slope(start).abs() - to.slope(end).abs();
        if faster(starts[0], ends[0]) > 0.0 && faster(starts[1], ends[1]) < 0.0 {
            let end = |start: f64| self.place(stretches[1], factor * from.force(start));
            if let Ok(start) = roots::root(|s| faster(s, end(s)), starts[0], starts[1], 1e-12 * self.end()) {
                longest.offer(start, end(start));
            }
        }
    }

    /// The window of a given length that deviates least: from a level, or (level free) from the middle of its own extent; and that
    /// deviation, relative.
    pub fn best_window(&self, length: f64, nominal: Option<f64>) -> Option<(Interval, f64)> {
        if length > self.end() - self.start() || self.stretches() == 0 {
            return None;
        }
        let (mut best, mut at) = (f64::INFINITY, self.start());
        let mut offer = |found: f64, start: f64| {
            if found < best {
                (best, at) = (found, start);
            }
            best
        };
        self.each_cell(length, |cell| {
            for side in 0..2 {
                offer(deviation(cell.extent(cell.at_start[side], cell.at_end[side]), nominal), cell.starts[side]);
            }
        });
        // Where the start is left and the end right of an optimum.
        self.each_cell(length, |cell| {
            if cell.bound(nominal) < offer(f64::INFINITY, 0.0) {
                let (found, start) = self.refined(cell, length, nominal);
                offer(found, start);
            }
        });
        Some((Interval { start: at, end: at + length }, best))
    }

    /// The least deviation inside a cell, and the start of its window.
    fn refined(&self, cell: &Cell, length: f64, nominal: Option<f64>) -> (f64, f64) {
        let [from, to] = cell.stretches.map(|s| self.of_stretch(s));
        let of = |start: f64| deviation(cell.extent(from.force(start), to.force(start + length)), nominal);
        let [low, high] = cell.starts;
        let Some(level) = nominal else {
            let found = roots::minimise(of, low, high, 1e-10 * self.end());
            return (found.value, found.x);
        };
        // Both ends are monotone, and what they deviate is the larger of both: least where they are on different sides of the level, or
        // on the same, by the same amount, one on its way out, the other on its way back.
        let same = (cell.at_start[1] > cell.at_start[0]) == (cell.at_end[1] > cell.at_end[0]);
        let side = if same { 1.0 } else { -1.0 };
        let balance = |start: f64| (from.force(start) - level) + side * (to.force(start + length) - level);
        roots::root(balance, low, high, 1e-15 * self.end()).map_or((f64::INFINITY, low), |start| (of(start), start))
    }

    /// All windows of a length, in cells.
    fn each_cell(&self, length: f64, mut visit: impl FnMut(&Cell)) {
        let last = self.end() - length;
        let (mut from, mut to) = (0, 0);
        let mut start = self.start();
        let mut forces = None;
        while from < self.stretches() {
            while to + 1 < self.stretches() && self.knots[to + 1].at - length <= start {
                to += 1;
            }
            let by_end = if to + 1 < self.stretches() { self.knots[to + 1].at - length } else { last };
            let next = self.knots[from + 1].at.min(by_end).min(last).max(start);
            let [first, second] = [from, to].map(|s| self.of_stretch(s));
            let [before, after] = [start, next].map(|s| [first.force(s), second.force(s + length)]);
            let before = forces.unwrap_or(before);
            visit(&Cell {
                starts: [start, next],
                stretches: [from, to],
                at_start: [before[0], after[0]],
                at_end: [before[1], after[1]],
                inner: self.extremes(from + 1, to),
            });
            if next >= last || last.is_nan() {
                return;
            }
            (start, forces) = (next, Some(after));
            while from < self.stretches() && self.knots[from + 1].at <= start {
                from += 1;
            }
        }
    }
}
