//! The height of a surface over the transverse position.

/// How points are joined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Join {
    /// By straight lines.
    Linear,
    /// By monotone cubics: F. N. Fritsch, J. Butland, "A method for constructing local monotone piecewise cubic interpolants", SIAM J. Sci.
    /// Stat. Comput. 5 (1984), with the weights of unequal distances.
    Smooth,
}

/// Heights over positions, SI: at least two points, of ascending position.
#[derive(Clone, Debug)]
pub struct Profile {
    x_m: Vec<f64>,
    z_m: Vec<f64>,
    /// Slopes at the points, where they are joined smoothly.
    slopes: Option<Vec<f64>>,
}

impl Profile {
    /// A surface through points of ascending position, at least two.
    pub fn new(x_m: Vec<f64>, z_m: Vec<f64>, join: Join) -> Self {
        let slopes = (join == Join::Smooth).then(|| slopes(&x_m, &z_m));
        Self { x_m, z_m, slopes }
    }

    /// Positions of the points, m.
    pub fn positions_m(&self) -> &[f64] {
        &self.x_m
    }

    /// Heights of the points, m.
    pub fn heights_m(&self) -> &[f64] {
        &self.z_m
    }

    /// Whether the points are joined by cubics.
    pub(super) fn is_smooth(&self) -> bool {
        self.slopes.is_some()
    }

    /// First and last position, m.
    pub fn extent_m(&self) -> [f64; 2] {
        [self.x_m[0], self.x_m[self.x_m.len() - 1]]
    }

    /// How many pieces lie between the points.
    pub(super) fn pieces(&self) -> usize {
        self.x_m.len() - 1
    }

    /// The positions at which a piece begins and ends.
    pub(super) fn ends_m(&self, piece: usize) -> [f64; 2] {
        [self.x_m[piece], self.x_m[piece + 1]]
    }

    /// The piece that a position lies in.
    pub(super) fn piece(&self, x: f64) -> usize {
        self.x_m.partition_point(|p| *p <= x).clamp(1, self.pieces()) - 1
    }

    /// The slope of a piece that is straight.
    pub(super) fn straight(&self, piece: usize) -> Option<f64> {
        let [x0, x1] = self.ends_m(piece);
        self.slopes.is_none().then(|| (self.z_m[piece + 1] - self.z_m[piece]) / (x1 - x0))
    }

    /// Height, m, and slope within a piece.
    pub(super) fn within(&self, piece: usize, x: f64) -> (f64, f64) {
        let [x0, x1] = self.ends_m(piece);
        let (z0, z1) = (self.z_m[piece], self.z_m[piece + 1]);
        let (h, chord) = (x1 - x0, (z1 - z0) / (x1 - x0));
        let u = ((x - x0) / h).clamp(0.0, 1.0);
        let Some(slopes) = &self.slopes else { return (z0 + u * (z1 - z0), chord) };
        // Hermite, from the height at the start.
        let (a, b) = (slopes[piece], slopes[piece + 1]);
        let (c, d) = (3.0 * chord - 2.0 * a - b, a + b - 2.0 * chord);
        (z0 + h * u * (a + u * (c + u * d)), a + u * (2.0 * c + 3.0 * u * d))
    }

    /// Height at a position, m.
    pub fn height_m(&self, x: f64) -> f64 {
        self.within(self.piece(x), x).0
    }
}

/// Slopes at the points: a weighted harmonic mean of the chords beside each, zero where they differ in sign.
fn slopes(x: &[f64], z: &[f64]) -> Vec<f64> {
    let h: Vec<f64> = x.windows(2).map(|p| p[1] - p[0]).collect();
    let chord: Vec<f64> = z.windows(2).zip(&h).map(|(p, h)| (p[1] - p[0]) / h).collect();
    let last = chord.len() - 1;
    if last == 0 {
        return vec![chord[0]; 2];
    }
    let inner = |i: usize| {
        if chord[i - 1] * chord[i] <= 0.0 {
            return 0.0;
        }
        let (before, after) = (2.0 * h[i] + h[i - 1], h[i] + 2.0 * h[i - 1]);
        (before + after) / (before / chord[i - 1] + after / chord[i])
    };
    let mut all = vec![end(h[0], h[1], chord[0], chord[1])];
    all.extend((1..=last).map(inner));
    all.push(end(h[last], h[last - 1], chord[last], chord[last - 1]));
    all
}

/// The slope at an end: that of the parabola through three points, as far as the piece stays monotone.
fn end(h: f64, next_h: f64, chord: f64, next: f64) -> f64 {
    let slope = ((2.0 * h + next_h) * chord - h * next) / (h + next_h);
    if slope * chord <= 0.0 {
        0.0
    } else if chord * next <= 0.0 && slope.abs() > 3.0 * chord.abs() {
        3.0 * chord
    } else {
        slope
    }
}
