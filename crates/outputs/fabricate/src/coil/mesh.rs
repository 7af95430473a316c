//! A spring as a closed mesh: rings of corners around the wire, joined by strips of triangles, and both ends.
//!
//! Corners lie on the surface S(φ, s). A flat triangle over Δφ and Δs is nowhere farther from it than
//! `⅛(max|S_φφ| Δφ² + 2 max|S_φs| Δφ Δs + max|S_ss| Δs²)`, the bound of linear interpolation in both parameters.

use std::cmp::Ordering;
use std::f64::consts::TAU;

use forcewright_base::maths;
use forcewright_model::WirePiece;

use super::{Wound, millimetres};
use crate::error::{Error, Place, Problem};
use crate::mesh::Mesh;
use crate::shape::MM_PER_M;

/// Most corners of a mesh.
const MOST: f64 = 1e7;
/// Fewest corners of a ring, and of a turn.
const FEWEST: f64 = 8.0;

/// Bounds of second derivatives of the surface, mm: along the wire (twice by its angle), and mixed.
struct Bounds {
    along: f64,
    mixed: f64,
}

impl Bounds {
    /// Of a piece of a wire of a radius, mm. Where the pitch is constant, the surface moves rigidly: every point on a circle of at most
    /// R + r about the axis. Where it changes by w = q′/R in a radian, the lead angle does so by at most that, and its change by 2w².
    fn of(piece: &WirePiece, radius: f64) -> Option<Self> {
        if !piece.radius_m().is_finite() {
            return None;
        }
        let around = piece.radius_m() * MM_PER_M;
        let change = piece.change_of_slope_m().abs() * MM_PER_M / around;
        Some(Self {
            along: around + radius + around * change + radius * (2.0 * change + 4.0 * change * change),
            mixed: radius * (1.0 + change),
        })
    }
}

/// Corners of all rings, and for each piece the number of strips.
fn division(wound: &Wound<'_>, chord: f64) -> (f64, Vec<f64>) {
    let radius = wound.radius;
    let of_ring = |bounds: &Bounds| (4.0 * chord / (1.0 + bounds.mixed / (radius * bounds.along).sqrt()) / radius).sqrt();
    let pieces = wound.line.pieces();
    let widest = TAU / FEWEST;
    let step = pieces.iter().filter_map(|piece| Bounds::of(piece, radius)).map(|bounds| of_ring(&bounds)).fold(widest, f64::min);
    let around = (TAU / step).ceil();
    let step = TAU / around;
    let strips = |piece: &WirePiece| {
        let Some(Bounds { along, mixed }) = Bounds::of(piece, radius) else { return 1.0 };
        let left = (8.0 * chord - radius * step * step).max(0.0);
        let most = (((mixed * step) * (mixed * step) + along * left).sqrt() - mixed * step) / along;
        (piece.turned_rad() / most.min(widest)).ceil().max(1.0)
    };
    (around, pieces.iter().map(strips).collect())
}

/// Cosines and sines of equal steps around; those of both halves are equal to the last bit.
fn circle(count: usize) -> Vec<[f64; 2]> {
    let at = |k: usize| {
        let (sin, cos) = maths::sin_cos(TAU * k as f64 / count as f64);
        [cos, sin]
    };
    let of = |k: usize| match (2 * k).cmp(&count) {
        Ordering::Less => at(k),
        Ordering::Equal => [-1.0, 0.0],
        Ordering::Greater => [at(count - k)[0], -at(count - k)[1]],
    };
    (0..count).map(of).collect()
}

/// The spring with facets within `chord` mm of its surface.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "rounding to single precision is meant; counts are limited")]
pub(crate) fn mesh(wound: &Wound<'_>, chord: f64) -> Result<Mesh, Error> {
    let (around, strips) = division(wound, chord);
    let corners = around * (strips.iter().sum::<f64>() + 1.0);
    if corners.is_nan() || corners > MOST {
        return Err(Error { place: Place::Part, problem: Problem::TooManyCorners { corners, most: MOST } });
    }
    let count = around as usize;
    let circle = circle(count);
    let mut mesh = Mesh { corners: Vec::new(), triangles: Vec::new() };
    let radius_m = wound.radius / MM_PER_M;
    for (index, (piece, strips)) in wound.line.pieces().iter().zip(&strips).enumerate() {
        let strips = *strips as usize;
        for k in usize::from(index > 0)..=strips {
            let station = piece.at(k as f64 / strips as f64);
            mesh.corners.extend(circle.iter().map(|&angle| millimetres(station.around_m(radius_m, angle)).map(|mm| mm as f32)));
        }
    }
    let rings = mesh.corners.len() / count;
    for ring in 1..rings {
        let (low, high) = ((ring - 1) * count, ring * count);
        for k in 0..count {
            let next = (k + 1) % count;
            mesh.triangles.extend([[low + k, low + next, high + next], [low + k, high + next, high + k]]);
        }
    }
    let last = (rings - 1) * count;
    for [a, b, c] in disc(count) {
        mesh.triangles.extend([[a, c, b], [last + a, last + b, last + c]]);
    }
    let is_folded = |triangle: &[usize; 3]| {
        let [a, b, c] = triangle.map(|corner| mesh.corners[corner].map(f32::to_bits));
        a == b || b == c || c == a
    };
    if mesh.triangles.iter().any(is_folded) {
        return Err(Error { place: Place::Part, problem: Problem::TooSmall });
    }
    Ok(mesh)
}

/// Triangles of a convex polygon, counterclockwise, from side to side.
fn disc(count: usize) -> Vec<[usize; 3]> {
    let (mut low, mut high) = (0, count - 1);
    let mut triangles = Vec::with_capacity(count - 2);
    while high - low > 1 {
        triangles.push([low, low + 1, high]);
        low += 1;
        if high - low > 1 {
            triangles.push([low, high - 1, high]);
            high -= 1;
        }
    }
    triangles
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    #[test]
    fn discs_are_filled_once() {
        for count in 3..12 {
            let circle = circle(count);
            let area = |[a, b, c]: [usize; 3]| {
                let ([ax, ay], [bx, by], [cx, cy]) = (circle[a], circle[b], circle[c]);
                0.5 * ((bx - ax) * (cy - ay) - (by - ay) * (cx - ax))
            };
            let areas: Vec<f64> = disc(count).into_iter().map(area).collect();
            let n = count as f64;
            assert_eq!(areas.len(), count - 2);
            assert!(areas.iter().all(|a| *a > 0.0));
            assert!((areas.iter().sum::<f64>() - 0.5 * n * maths::sin(2.0 * PI / n)).abs() < 1e-14);
        }
    }
}
