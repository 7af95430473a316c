//! The force that a mechanism shall have over the travel of its slider.

/// Force over travel: straight pieces, the ends continued.
#[derive(Clone, Debug, PartialEq)]
pub struct ForceLaw {
    /// Places s, m, rising from 0; force F > 0, N; work W since s = 0, J.
    knots: Vec<[f64; 3]>,
}

/// Why a law cannot be cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LawError {
    /// There are no pieces.
    Empty,
    /// The place with this index does not lie beyond the one before it.
    NotRising(usize),
    /// The force with this index is not above zero: the spring can only be stretched further while the force does work.
    NotPositive(usize),
}

impl ForceLaw {
    /// The same force everywhere, N.
    pub fn constant(force_n: f64) -> Self {
        Self { knots: vec![[0.0, force_n, 0.0]] }
    }

    /// Straight pieces through points (s, F), m and N. The first one is taken as the start of the travel, wherever it lies.
    ///
    /// # Errors
    /// [`LawError`] names the point that is wrong.
    pub fn through(points: &[[f64; 2]]) -> Result<Self, LawError> {
        let &[start, _] = points.first().ok_or(LawError::Empty)?;
        let mut knots: Vec<[f64; 3]> = Vec::with_capacity(points.len());
        for (i, &[s, f]) in points.iter().enumerate() {
            if !(f > 0.0 && f.is_finite()) {
                return Err(LawError::NotPositive(i));
            }
            let work = match knots.last() {
                Some(&[before, force, work]) if s - start > before => work + f64::midpoint(force, f) * (s - start - before),
                Some(_) => return Err(LawError::NotRising(i)),
                None => 0.0,
            };
            knots.push([s - start, f, work]);
        }
        Ok(Self { knots })
    }

    /// Whether it is the same everywhere.
    pub fn is_constant(&self) -> bool {
        self.knots.windows(2).all(|k| k[0][1].to_bits() == k[1][1].to_bits())
    }

    /// Where its slope changes, m.
    pub fn kinks_m(&self) -> impl Iterator<Item = f64> + '_ {
        self.knots.iter().map(|k| k[0])
    }

    /// Force and its slope at a place, N and N/m; at a kink those of the piece beyond it.
    pub fn force_n(&self, s_m: f64) -> [f64; 2] {
        let (i, slope) = self.piece(s_m);
        [self.knots[i][1] + slope * (s_m - self.knots[i][0]), slope]
    }

    /// Work since the start, ∫F ds, J.
    pub fn work_j(&self, s_m: f64) -> f64 {
        let (i, slope) = self.piece(s_m);
        let [at, force, work] = self.knots[i];
        let over = s_m - at;
        work + over * (force + 0.5 * slope * over)
    }

    /// The place up to which a work ≥ 0 is done, m: the inverse of [`Self::work_j`].
    pub fn place_m(&self, work_j: f64) -> f64 {
        let i = self.knots.partition_point(|k| k[2] <= work_j).max(1) - 1;
        let [at, force, work] = self.knots[i];
        let (_, slope) = self.piece(at);
        // F·t + slope·t²/2 = work, the root without cancellation.
        let more = work_j - work;
        let discriminant = force * force + 2.0 * slope * more;
        at + 2.0 * more / (force + discriminant.max(0.0).sqrt())
    }

    /// The force at each kink, N.
    pub fn levels_n(&self) -> impl Iterator<Item = f64> + '_ {
        self.knots.iter().map(|k| k[1])
    }

    /// The piece that holds a place, and its slope.
    fn piece(&self, s_m: f64) -> (usize, f64) {
        let i = self.knots.partition_point(|k| k[0] <= s_m).max(1) - 1;
        let slope = match (self.knots[i], self.knots.get(i + 1)) {
            ([at, force, _], Some([next, beyond, _])) if s_m >= at => (beyond - force) / (next - at),
            _ => 0.0,
        };
        (i, slope)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[expect(clippy::float_cmp, reason = "exact in binary")]
    fn work_and_place_are_inverse() {
        let law = ForceLaw::through(&[[0.0, 40.0], [0.1, 60.0], [0.24, 20.0]]).expect("rising, above zero");
        assert!((law.work_j(0.1) - 5.0).abs() < 1e-15 && (law.work_j(0.24) - 10.6).abs() < 1e-14);
        for s in [0.0, 0.003, 0.1, 0.17, 0.24, 0.3] {
            assert!((law.place_m(law.work_j(s)) - s).abs() < 1e-15, "{s}");
        }
        assert_eq!(law.force_n(0.05), [50.0, 200.0]);
        assert_eq!(law.force_n(0.3), [20.0, 0.0], "continued");
    }

    #[test]
    fn what_cannot_be_cut_is_named() {
        assert_eq!(ForceLaw::through(&[]), Err(LawError::Empty));
        assert_eq!(ForceLaw::through(&[[0.0, 1.0], [0.0, 2.0]]), Err(LawError::NotRising(1)));
        assert_eq!(ForceLaw::through(&[[0.0, 1.0], [0.1, 0.0]]), Err(LawError::NotPositive(1)));
        assert_eq!(ForceLaw::through(&[[0.0, f64::NAN]]), Err(LawError::NotPositive(0)));
    }
}
