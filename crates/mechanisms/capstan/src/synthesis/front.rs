//! What can be had at all: drives of the grid of which none is better in stiffness, width, moment of inertia and load of the shafts together.
//!
//! A pass of its own over a thinned grid, since the search for the least room leaves out what is stiff and large. Each drive stands with its
//! least and with its largest preload. A drive whose bounds are dominated is dominated: nothing is placed in space in vain.

use forcewright_base::units::{format_number, format_si};
use forcewright_contract::synthesis::Watch;
use forcewright_model::{StudyColumn, StudyTable};

use super::sizing::{
    Asked, Frame, Merits, Prepared, Size, cost_m3, distances, has_room, keeps_limits, least_size, merits, placed, preload_range,
};
use super::write;

/// Drives of the thinned grid at most.
const MOST_FRAMES: usize = 30_000;
/// Distances for each number of turns.
const DISTANCES: usize = 3;
/// Arrangements placed, and full analyses for limits on metrics, at most.
const MOST_PLACED: u64 = 1_500;
const MOST_MEASURED: u64 = 150;
/// Rows of the table.
const ROWS: usize = 16;

/// What was found.
#[derive(Clone, Debug, Default)]
pub(super) struct Front {
    pub members: Vec<(Size, Merits)>,
    /// Drives of the thinned grid that were looked at.
    pub tried: usize,
    pub placed: u64,
    measured: u64,
    /// Whether the limits above, or an interruption, ended it.
    pub cut: bool,
}

impl Front {
    /// Whether a member is at least as good in everything.
    fn covers(&self, merits: &Merits) -> bool {
        self.members.iter().any(|(_, m)| m.covers(merits))
    }

    fn add(&mut self, size: Size, merits: Merits) {
        if !self.covers(&merits) {
            self.members.retain(|(_, m)| !merits.covers(m));
            self.members.push((size, merits));
        }
    }

    /// A drive with one of its preloads, where its bounds say that it may belong to it.
    fn consider(&mut self, asked: &Asked, frame: &Frame, preload_n: f64) {
        let Some(bound) = merits(asked, &least_size(asked, frame, preload_n)) else { return };
        if self.covers(&bound) {
            return;
        }
        if self.placed >= MOST_PLACED || self.measured >= MOST_MEASURED {
            self.cut = true;
            return;
        }
        self.placed += 1;
        let Some(size) = placed(asked, frame, asked.envelope_m[1]).map(|(between, width_m)| Size {
            between,
            width_m,
            cost_m3: cost_m3(asked, frame, width_m),
            ..least_size(asked, frame, preload_n)
        }) else {
            return;
        };
        self.measured += u64::from(!asked.limits.is_empty());
        if let Some(merits) = merits(asked, &size).filter(|_| keeps_limits(asked, &size)) {
            self.add(size, merits);
        }
    }
}

/// Every how manieth drum keeps the grid below its most.
fn stride(asked: &Asked, places: usize) -> usize {
    let all = asked.ropes.len() * asked.most_cables as usize * places * asked.inputs_m.len();
    all.div_ceil(MOST_FRAMES).max(1)
}

/// The set, of the sizes known and of the thinned grid.
pub(super) fn front(asked: &Asked, known: &[Size], watch: Watch<'_>) -> Front {
    let mut found = Front::default();
    for size in known {
        if let Some(merits) = merits(asked, size) {
            found.add(*size, merits);
        }
    }
    let near = |turns: u32| distances(asked, turns).into_iter().take(DISTANCES).collect::<Vec<_>>();
    let places: Vec<(u32, i32, f64)> =
        (0..=asked.most_turns).flat_map(|turns| near(turns).into_iter().map(move |(apart, d)| (turns, apart, d))).collect();
    let stride = stride(asked, places.len());
    let kinds = asked.ropes.len() * asked.most_cables as usize;
    for kind in 0..kinds {
        let (rope, cables) =
            (kind / asked.most_cables as usize, (1..=asked.most_cables).nth(kind % asked.most_cables as usize).unwrap_or(1));
        for (i, (turns, apart, per_radius)) in places.iter().enumerate() {
            if !watch((kind as f64 + i as f64 / places.len() as f64) / kinds as f64) {
                found.cut = true;
                return found;
            }
            // Another drum of the series for each place, so that all are met.
            for input_m in asked.inputs_m.iter().skip(i % stride).step_by(stride) {
                let frame = Frame { rope, cables, turns: *turns, apart: *apart, input_m: *input_m, distance_m: per_radius * input_m };
                found.tried += 1;
                if !has_room(asked, &frame) {
                    continue;
                }
                let Some(range) = Prepared::new(asked, &frame).and_then(|p| preload_range(asked, &p, true, &mut 0)) else { continue };
                for preload_n in range.map(|i| asked.preloads_n[i]) {
                    found.consider(asked, &frame, preload_n);
                }
            }
        }
    }
    found.members.sort_by(|a, b| a.1.stiffness_nm_per_rad.total_cmp(&b.1.stiffness_nm_per_rad));
    found
}

/// Members evenly over the stiffness, with the best of each kind of merit.
fn shown(front: &Front) -> Vec<&(Size, Merits)> {
    let all = &front.members;
    let best = |of: &dyn Fn(&Merits) -> f64| (0..all.len()).min_by(|a, b| of(&all[*a].1).total_cmp(&of(&all[*b].1)));
    let mut chosen: Vec<usize> = [best(&|m| m.width_m), best(&|m| m.inertia_m5), best(&|m| m.shaft_load_n)].into_iter().flatten().collect();
    let last = all.len().saturating_sub(1);
    chosen.extend((0..ROWS.min(all.len())).map(|i| i * last / (ROWS - 1)));
    chosen.sort_unstable();
    chosen.dedup();
    chosen.into_iter().map(|i| &all[i]).collect()
}

/// The set as a table.
pub(super) fn table(asked: &Asked, front: &Front) -> StudyTable {
    let units = &asked.template.units;
    let rows = shown(front).into_iter().map(|(size, m)| {
        let f = &size.frame;
        vec![
            format!("{} × {}", f.cables, write::cable(&asked.ropes[f.rope])),
            format_si(2.0 * f.input_m, &units.length, 4),
            f.turns.to_string(),
            format_si(size.preload_n, &units.force, 4),
            format_si(m.stiffness_nm_per_rad, &units.stiffness, 4),
            format_si(m.width_m, &units.length, 4),
            format!("{} kg·m²", format_number(write::density(asked) * m.inertia_m5, 3)),
            format_si(m.shaft_load_n, &units.force, 4),
            format!("{} cm³", format_number(1e6 * size.cost_m3, 3)),
        ]
    });
    let rows: Vec<Vec<String>> = rows.collect();
    let cut = if front.cut { "; cut short, there may be more" } else { "" };
    let head = ["Cables", "Input drum", "Extra turns", "Preload", "Stiffness", "Width", "Drums, at the output", "Shaft load", "Room"];
    let column = |(i, name): (usize, &str)| if i == 0 { StudyColumn::Text(name.to_owned()) } else { StudyColumn::Number(name.to_owned()) };
    StudyTable {
        caption: format!(
            "What can be had: {} of {} drives of a thinned grid, and of those proposed, that meet everything and that none of them betters in stiffness, width, inertia and shaft load together; {} shown, by stiffness{cut}",
            front.members.len(),
            front.tried,
            rows.len()
        ),
        columns: head.into_iter().enumerate().map(column).collect(),
        rows,
    }
}
