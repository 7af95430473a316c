//! Where the problem cannot be evaluated: half-spaces that keep steps away from rejected points for a while.
//!
//! Shortening a step is not enough where the step keeps pointing into such a region: the iterates creep towards its edge and jam there
//! although they could slide along it. So a rejected step leaves a wall across itself where it was rejected, and the next steps may go
//! along the wall, or half of the way to it. The true edge is not known, so walls are forgotten after some iterations.

use super::hessian::dot;

/// Most walls at a time.
pub(super) const COUNT: usize = 4;
/// Iterations for which a wall stands.
const LIFE: usize = 8;

/// The half-space `normal·z < edge`.
#[derive(Debug, Clone)]
struct Wall {
    normal: Vec<f64>,
    edge: f64,
    life: usize,
}

/// The walls that stand, each in a place of its own.
#[derive(Debug, Default)]
pub(super) struct Walls {
    places: [Option<Wall>; COUNT],
    next: usize,
}

impl Walls {
    /// Puts a wall across a step from `z` of which the part `rejected` was rejected.
    pub(super) fn raise(&mut self, z: &[f64], step: &[f64], rejected: f64) {
        let length = dot(step, step).sqrt();
        if length > 0.0 {
            let normal: Vec<f64> = step.iter().map(|d| d / length).collect();
            let edge = dot(&normal, z) + rejected * length;
            self.places[self.next] = Some(Wall { normal, edge, life: LIFE });
            self.next = (self.next + 1) % COUNT;
        }
    }

    /// Whether any stands.
    pub(super) fn stand(&self) -> bool {
        self.places.iter().any(Option::is_some)
    }

    /// An iteration passes.
    pub(super) fn age(&mut self) {
        for place in &mut self.places {
            *place = place.take().filter(|wall| wall.life > 1).map(|wall| Wall { life: wall.life - 1, ..wall });
        }
    }

    /// Appends a row and its upper bound, relative to `z`, for every place; empty places bound nothing.
    pub(super) fn append(&self, z: &[f64], rows: &mut Vec<f64>, upper: &mut Vec<f64>) {
        for place in &self.places {
            // A wall that was passed was in the wrong place.
            let standing = place.as_ref().map(|wall| (wall, wall.edge - dot(&wall.normal, z))).filter(|(_, distance)| *distance > 0.0);
            if let Some((wall, distance)) = standing {
                rows.extend_from_slice(&wall.normal);
                upper.push(0.5 * distance);
            } else {
                rows.extend(std::iter::repeat_n(0.0, z.len()));
                upper.push(f64::INFINITY);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(walls: &Walls, z: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let (mut rows, mut upper) = (Vec::new(), Vec::new());
        walls.append(z, &mut rows, &mut upper);
        (rows, upper)
    }

    #[test]
    fn allow_half_of_the_way_and_fall_in_time() {
        let mut walls = Walls::default();
        // Half of the step (3, 4) from the origin was rejected: the edge is at 2.5 along (0.6, 0.8).
        walls.raise(&[0.0, 0.0], &[3.0, 4.0], 0.5);
        let (normals, upper) = rows(&walls, &[0.0, 0.0]);
        assert!((normals[0] - 0.6).abs() < 1e-15 && (normals[1] - 0.8).abs() < 1e-15 && (upper[0] - 1.25).abs() < 1e-15);
        assert_eq!(upper[1..], [f64::INFINITY; COUNT - 1]);
        // Beside it, and beyond it.
        assert!((rows(&walls, &[0.6, 0.8]).1[0] - 0.75).abs() < 1e-15);
        assert_eq!(rows(&walls, &[3.0, 4.0]).1, [f64::INFINITY; COUNT]);
        for _ in 1..LIFE {
            walls.age();
        }
        assert!(rows(&walls, &[0.0, 0.0]).1[0].is_finite());
        assert!(walls.stand());
        walls.age();
        assert!(!walls.stand());
        assert_eq!(rows(&walls, &[0.0, 0.0]).1, [f64::INFINITY; COUNT]);
    }
}
