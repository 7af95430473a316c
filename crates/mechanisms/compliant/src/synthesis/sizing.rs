//! From a shape to its sizes, in closed form.
//!
//! A shape drawn λ times as large as in its file, with beams of thickness w and depth t, n plates behind each other, has
//! F = n·E·t·w³/12 · f/λ² with f = F₀/(EI)₀ of the file, the strain ε = (w/λ)·ε₀ with ε₀ per thickness, and lengths times λ (Lan, Wang &
//! Chen 2010, eq. (6)). At the allowed strain w ∝ λ, so that n·t ∝ F/λ: the larger, the thinner the plate. Of r rows and m layers forces are r
//! times, displacements m times as large. The strain is that at the inner face of a curved beam.

use forcewright_base::maths;

use super::catalogue::{self, Solved, Stop};
use super::room::{Copies, Room};
use crate::parts::Making;

/// What a design is sized for. SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Asked {
    /// Half width of the force band.
    pub band: f64,
    /// The level, N; `None` is any.
    pub nominal_n: Option<f64>,
    /// The stroke inside the band, m.
    pub stroke_m: f64,
    /// Young's modulus, Pa.
    pub young_pa: f64,
    /// The strain allowed: stress over Young's modulus.
    pub strain: f64,
    /// The stress allowed at the inner face of curved beams, Pa, where the file limits a stress.
    pub stress_pa: Option<f64>,
    /// Least and largest slope, N/m.
    pub stiffness_n_per_m: [f64; 2],
    /// Width and height of the whole in its plane, with pads and blocks; infinite where any will do, m.
    pub room_m: [f64; 2],
    /// Smallest depth of a plate, if one is asked for, m.
    pub depth_min_m: Option<f64>,
    /// Largest depth of a plate, m.
    pub depth_max_m: f64,
    /// Thinnest beam, m.
    pub thickness_min_m: f64,
    /// Most plates.
    pub plates: u32,
    /// Most rows.
    pub rows: u32,
    /// Most layers in series.
    pub layers: u32,
    /// How it is made: the size of its pads.
    pub making: Making,
    /// Least distance between the surfaces of beams, m.
    pub gap_min_m: f64,
}

/// A sized design. SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Size {
    /// Place of the shape in the catalogue.
    pub shape: usize,
    /// Place of the stop in the shape.
    pub stop: usize,
    /// Size over that of the file.
    pub scale: f64,
    /// Thickness of the beams, m.
    pub thickness_m: f64,
    /// Depth of a plate, m.
    pub depth_m: f64,
    /// Plates.
    pub plates: u32,
    /// Rows and layers.
    pub copies: Copies,
    /// Room that it takes over the travel, m³.
    pub cost_m3: f64,
}

/// What the closed form keeps in hand for stretching, shear and the thickness at the joints, which it does not see: of the stroke, the
/// allowed strain, the band, the least slope and the room.
const STROKE_KEPT: f64 = 1.01;
const STRAIN_KEPT: f64 = 0.97;
const BAND_KEPT: f64 = 0.95;
const SLOPE_KEPT: f64 = 0.95;
const ROOM_KEPT: f64 = 0.998;
/// A plate is at least so many times as deep as its beams are thick: else it bends out of its plane first.
const DEPTH_OVER_THICKNESS: f64 = 2.0;
/// Depth over thickness where the level of the force is free.
const FREE_DEPTH: f64 = 10.0;
/// A beam is at least so many times as long as thick.
const SLENDER: f64 = 4.0;
/// Distance of two axes over the thickness, at least.
const APART: f64 = 1.3;
/// Sizes tried between the smallest and the largest, and the largest over the smallest where there is room for any.
const SIZES: usize = 24;
const LARGEST: f64 = 20.0;
/// Lengths of the language, m.
const LARGEST_M: f64 = 4.0;

/// Windows of every stop of every shape for one band: length, m, and level, N.
pub(crate) struct Windows(Vec<Vec<Option<[f64; 2]>>>);

impl Windows {
    /// For a band.
    pub(super) fn of(band: f64) -> Self {
        let of = |stop: &Stop| stop.window(band * BAND_KEPT).map(|(window, level)| [window.length(), level]);
        Self(catalogue::all().map(|shape| shape.stops.iter().map(of).collect()).collect())
    }
}

/// Every size that keeps to what is asked for: of each shape, stop and scale, with as few copies in the plane as will do.
pub(crate) fn sizes(asked: &Asked, windows: &Windows) -> Vec<Size> {
    sizes_with(asked, windows, 0)
}

/// The same with more copies, the next few that will do: where a full analysis finds that the fewest are not enough.
pub(crate) fn sizes_of_more(asked: &Asked, windows: &Windows) -> Vec<Size> {
    sizes_with(asked, windows, 1)
}

/// Of each shape the sizes with the fewest copies that will do (0), or with the next (1).
fn sizes_with(asked: &Asked, windows: &Windows, place: usize) -> Vec<Size> {
    let all = Copies::all(asked.rows, asked.layers);
    let of_shape = |(shape, solved): (usize, &'static Solved)| {
        let tried = all.iter().map(|copies| with_copies(asked, windows, shape, solved, *copies));
        tried.filter(|found| !found.is_empty()).nth(place).unwrap_or_default()
    };
    catalogue::all().enumerate().flat_map(of_shape).collect()
}

/// Every size of a shape with so many copies.
fn with_copies(asked: &Asked, windows: &Windows, shape: usize, solved: &Solved, copies: Copies) -> Vec<Size> {
    let mut found = Vec::new();
    let room_m = asked.room_m.map(|side| ROOM_KEPT * side);
    for (stop, of) in solved.stops.iter().enumerate() {
        let window = windows.0.get(shape).and_then(|w| w.get(stop).copied().flatten());
        let Some([length_m, level_n]) = window.filter(|[length_m, level_n]| *length_m > 0.0 && *level_n > 0.0) else { continue };
        // Layers move alike only where the force of each rises.
        if copies.layers > 1 && of.stiffness_n_per_m <= 0.0 {
            continue;
        }
        let least = asked.stroke_m * STROKE_KEPT / (length_m * f64::from(copies.layers));
        let room = Room::of(asked, solved, of, copies);
        let own = of.room_m();
        let most = room.largest_scale(asked.thickness_min_m, room_m).min(least * LARGEST).min(LARGEST_M / own[0].max(own[1]));
        if most < least {
            continue;
        }
        let scale = |i: usize| least * maths::powf(most / least, i as f64 / (SIZES - 1) as f64);
        let size = |i: usize| fit(asked, solved, of, &room, level_n, scale(i));
        found.extend((0..SIZES).filter_map(size).map(|size| Size { shape, stop, ..size }));
    }
    found
}

/// Thickness, depth and plates at a scale, if there are any that keep to the limits.
fn fit(asked: &Asked, shape: &Solved, stop: &Stop, room: &Room, level_n: f64, scale: f64) -> Option<Size> {
    let copies = room.copies();
    let gap = scale * stop.gap_m;
    let by_room = room.thickest_m(scale, asked.room_m.map(|side| ROOM_KEPT * side));
    let limits = [stop.thickest(asked.strain * STRAIN_KEPT) * scale, by_room, gap / APART, gap - asked.gap_min_m];
    let thickest = limits.into_iter().fold(scale * shape.shortest_m / SLENDER, f64::min);
    let own = shape.slimness_m.map(|slimness_m| slimness_m * scale);
    if thickest.is_nan() || own.is_some_and(|own| own > thickest) || own.unwrap_or(thickest) < asked.thickness_min_m {
        return None;
    }
    let thickest = own.unwrap_or(thickest);
    let rows = f64::from(copies.rows);
    // n·t·w³ of a row, m⁴.
    let needed = |force_n| 12.0 * force_n * scale * scale * shape.bending_stiffness_n_m2 / (rows * level_n * asked.young_pa);
    let (thickness_m, depth_m, plates) = match asked.nominal_n.map(needed) {
        None => (thickest, (FREE_DEPTH * thickest).max(asked.depth_min_m.unwrap_or(0.0)).min(asked.depth_max_m), 1),
        Some(needed) => section(asked, thickest, needed)?,
    };
    let floor = asked.depth_min_m.unwrap_or(0.0).max(DEPTH_OVER_THICKNESS * thickness_m);
    let deep = (floor * (1.0 - 1e-9)..=asked.depth_max_m * (1.0 + 1e-9)).contains(&depth_m);
    let stiffer = rows / f64::from(copies.layers) * f64::from(plates) * asked.young_pa * depth_m * maths::powi(thickness_m, 3)
        / (12.0 * shape.bending_stiffness_n_m2 * maths::powi(scale, 3));
    let [least, most] = [stop.stiffness_n_per_m, stop.stiffness_max_n_per_m].map(|k| k * stiffer);
    let [lower, upper] = asked.stiffness_n_per_m;
    // A slope at a limit of zero is a matter of the full analysis.
    let least_kept = if lower < 0.0 { least >= SLOPE_KEPT * lower } else { least >= lower };
    // A shape that keeps its slimness cannot be made thinner where the plate would be too shallow.
    let slim = own.is_none_or(|own| own <= thickness_m);
    if !deep || !slim || !least_kept || most > SLOPE_KEPT * upper || !room.joins(scale, thickness_m) {
        return None;
    }
    let size = Size { shape: 0, stop: 0, scale, thickness_m, depth_m, plates, copies, cost_m3: 0.0 };
    Some(Size { cost_m3: size.cost_m3(room), ..size })
}

impl Size {
    /// Room that it takes over the travel, m³.
    pub(super) fn cost_m3(&self, room: &Room) -> f64 {
        let [width_m, height_m] = room.extent_m(self.scale, self.thickness_m);
        width_m * height_m * self.depth_m * f64::from(self.plates)
    }
}

/// Thickness, depth and plates of a bending stiffness, n·t·w³ in m⁴: as thick as may be, thinner where the plate would be too shallow.
fn section(asked: &Asked, thickest: f64, needed: f64) -> Option<(f64, f64, u32)> {
    let floor = |w: f64| asked.depth_min_m.unwrap_or(0.0).max(DEPTH_OVER_THICKNESS * w);
    let total = needed / maths::powi(thickest, 3);
    if total >= floor(thickest) {
        let count = (total / asked.depth_max_m * (1.0 - 1e-12)).ceil().max(1.0);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "compared with a small whole number")]
        return (count <= f64::from(asked.plates)).then(|| (thickest, total / count, count as u32));
    }
    let by_ratio = maths::powf(needed / DEPTH_OVER_THICKNESS, 0.25);
    let thickness_m = asked.depth_min_m.map_or(by_ratio, |depth| by_ratio.min(maths::cbrt(needed / depth)));
    (thickness_m >= asked.thickness_min_m).then(|| (thickness_m, needed / maths::powi(thickness_m, 3), 1))
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    pub(in crate::synthesis) const ASKED: Asked = Asked {
        band: 0.05,
        nominal_n: Some(10.0),
        stroke_m: 8e-3,
        young_pa: 2.85e9,
        strain: 0.015,
        stress_pa: None,
        stiffness_n_per_m: [0.0, f64::INFINITY],
        room_m: [0.15, 0.12],
        depth_min_m: None,
        depth_max_m: 0.05,
        thickness_min_m: 5e-4,
        plates: 4,
        rows: 1,
        layers: 1,
        making: Making { cutter_m: None, wall_min_m: None, gap_min_m: None, fillet_m: None, pad_m: None, hole_m: None },
        gap_min_m: 0.0,
    };

    /// All lengths times 2 and the force times 4 at the same strain; all stresses and the force times 3.
    #[test]
    fn sizes_scale_exactly() {
        let windows = Windows::of(ASKED.band);
        let all = sizes(&ASKED, &windows);
        assert!(all.len() > 100);
        let doubled =
            Asked { nominal_n: Some(40.0), stroke_m: 16e-3, room_m: [0.3, 0.24], depth_max_m: 0.1, thickness_min_m: 1e-3, ..ASKED };
        let stiff = Asked { nominal_n: Some(30.0), young_pa: 3.0 * ASKED.young_pa, ..ASKED };
        for (other, length) in [(doubled, 2.0), (stiff, 1.0)] {
            let others = sizes(&other, &windows);
            assert_eq!(all.len(), others.len());
            for (a, b) in all.iter().zip(&others) {
                assert_eq!((a.shape, a.stop, a.plates), (b.shape, b.stop, b.plates));
                let ratios = [b.scale / a.scale, b.thickness_m / a.thickness_m, b.depth_m / a.depth_m];
                assert!(ratios.iter().all(|r| (r / length - 1.0).abs() < 1e-9), "{ratios:?}");
            }
        }
    }

    /// Force, strain, stroke and room of every size are those of the laws, computed the other way round.
    #[test]
    fn every_size_does_what_is_asked() {
        let windows = Windows::of(ASKED.band);
        for size in sizes(&ASKED, &windows) {
            let shape = catalogue::solved(size.shape).unwrap();
            let stop = &shape.stops[size.stop];
            let (window, level) = stop.window(ASKED.band).unwrap();
            let stiffness = ASKED.young_pa * size.depth_m * size.thickness_m * size.thickness_m * size.thickness_m / 12.0;
            let force = f64::from(size.plates) * stiffness / shape.bending_stiffness_n_m2 * level / (size.scale * size.scale);
            // The level of the whole band, and not of its kept part.
            assert!((force / 10.0 - 1.0).abs() < 0.01, "{force}");
            assert!(window.length() * size.scale >= ASKED.stroke_m && window.end <= stop.travel_m);
            assert!(stop.strain(size.thickness_m / size.scale) <= ASKED.strain);
            let room = Room::of(&ASKED, shape, stop, size.copies).extent_m(size.scale, size.thickness_m);
            assert!(room[0] <= ASKED.room_m[0] && room[1] <= ASKED.room_m[1]);
            let beams = stop.room_m().map(|side| side * size.scale + size.thickness_m);
            assert!(room[0] >= beams[0] * (1.0 - 1e-12) && room[1] >= beams[1] * (1.0 - 1e-12));
            assert!(size.depth_m <= ASKED.depth_max_m && size.thickness_m >= ASKED.thickness_min_m);
            assert!(size.depth_m >= 2.0 * size.thickness_m * (1.0 - 1e-9));
        }
    }
}
