//! Solutions of differential equations over the deformation λ of the springs, integrated once and tabulated.

use forcewright_base::roots;

/// A solution at rising λ: its first component is the travel, which rises.
#[derive(Debug)]
pub(crate) struct Table<const N: usize> {
    rows: Vec<Row<N>>,
}

/// λ, the solution there, and its slope.
#[derive(Clone, Copy, Debug)]
struct Row<const N: usize> {
    at: f64,
    value: [f64; N],
    slope: [f64; N],
}

/// How a table is made.
pub(crate) struct Way<'a> {
    /// Size of a step of λ, m.
    pub step: f64,
    /// The travel to be passed.
    pub end: f64,
    /// Travels at which the equation has a kink: each gets a row.
    pub kinks: &'a [f64],
}

impl<const N: usize> Table<N> {
    /// Integrates from a place until the first component has passed the end. `admit` is asked about each step: the number of rows so far,
    /// the solution before, and after it.
    pub(crate) fn integrate<E>(
        mut at: f64,
        mut state: [f64; N],
        way: &Way<'_>,
        slopes: &dyn Fn(f64, [f64; N]) -> [f64; N],
        admit: impl Fn(usize, &[f64; N], &[f64; N]) -> Result<(), E>,
    ) -> Result<Self, E> {
        let row = |at: f64, value: [f64; N]| Row { at, value, slope: slopes(at, value) };
        let mut rows = vec![row(at, state)];
        while state[0] < way.end {
            let mut next = stepped(at, state, way.step, slopes);
            let mut reached = at + way.step;
            if let Some(kink) = way.kinks.iter().find(|k| state[0] < **k - 1e-12 && next[0] > **k) {
                let part = |h: f64| stepped(at, state, h, slopes)[0] - kink;
                if let Ok(h) = roots::root(part, 0.0, way.step, 1e-16) {
                    next = stepped(at, state, h, slopes);
                    reached = at + h;
                }
            }
            admit(rows.len(), &state, &next)?;
            (at, state) = (reached, next);
            rows.push(row(at, state));
        }
        Ok(Self { rows })
    }

    /// λ of the first row that has reached a travel.
    pub(crate) fn first_at(&self, travel: f64) -> Option<f64> {
        self.rows.iter().find(|r| r.value[0] >= travel).map(|r| r.at)
    }

    fn row_before(&self, lambda_m: f64) -> usize {
        self.rows.partition_point(|r| r.at <= lambda_m).clamp(1, self.rows.len() - 1) - 1
    }

    /// Cubic between the rows: with a thousand of them as exact as the rows themselves.
    pub(crate) fn at(&self, lambda_m: f64) -> [f64; N] {
        let i = self.row_before(lambda_m);
        let (a, b) = (&self.rows[i], &self.rows[i + 1]);
        let h = b.at - a.at;
        let t = (lambda_m - a.at) / h;
        let (t2, u) = (t * t, 1.0 - t);
        std::array::from_fn(|c| {
            a.value[c] * (1.0 + 2.0 * t) * u * u + b.value[c] * t2 * (3.0 - 2.0 * t) + h * t * u * (a.slope[c] * u - b.slope[c] * t)
        })
    }

    /// λ at a travel, straight between the rows.
    pub(crate) fn inverse(&self, travel: f64) -> f64 {
        let i = self.rows.partition_point(|r| r.value[0] <= travel).clamp(1, self.rows.len() - 1) - 1;
        let (a, b) = (&self.rows[i], &self.rows[i + 1]);
        let part = (travel - a.value[0]) / (b.value[0] - a.value[0]);
        a.at + part.max(0.0) * (b.at - a.at)
    }
}

/// One step of Dormand and Prince's fifth order.
fn stepped<const N: usize>(at: f64, y: [f64; N], h: f64, slopes: &dyn Fn(f64, [f64; N]) -> [f64; N]) -> [f64; N] {
    const C: [f64; 6] = [0.0, 0.2, 0.3, 0.8, 8.0 / 9.0, 1.0];
    const A: [[f64; 5]; 6] = [
        [0.0; 5],
        [0.2, 0.0, 0.0, 0.0, 0.0],
        [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0],
        [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0],
        [19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0, 0.0],
        [9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0],
    ];
    const B: [f64; 6] = [35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0];
    let mut k = [[0.0; N]; 6];
    for i in 0..6 {
        let inner = std::array::from_fn(|c| y[c] + h * (0..i).map(|j| A[i][j] * k[j][c]).sum::<f64>());
        k[i] = slopes(at + C[i] * h, inner);
    }
    std::array::from_fn(|c| y[c] + h * (0..6).map(|i| B[i] * k[i][c]).sum::<f64>())
}

/// The least λ from which on a gear is above zero: where friction that is compensated no longer holds the rollers. `None` if there is none
/// up to the length of the springs.
pub(crate) fn start_without_locking(gear: impl Fn(f64) -> f64, length_m: f64) -> Option<f64> {
    let mut most = 1e-3 * length_m;
    while gear(most).is_nan() || gear(most) <= 0.0 {
        most *= 2.0;
        if most > length_m {
            return None;
        }
    }
    if gear(0.0) >= 0.0 {
        return Some(0.0);
    }
    let root = roots::root(gear, 0.0, most, 1e-15).ok()?;
    // A little beyond: at the root itself the roller would run along the travel without stretching the springs.
    Some(root * (1.0 + 1e-9))
}
