//! The hypervolume: how much of the space of goals a front dominates.

/// Volume dominated by some points, all goals small where they are good, up to a reference point. Points that are not below the reference
/// in every goal add nothing.
///
/// E. Zitzler, L. Thiele, "Multiobjective evolutionary algorithms: a comparative case study and the strength Pareto approach", IEEE
/// Transactions on Evolutionary Computation 3(4) (1999) 257–271. Computed by slices along the last goal, which is exact; the cost grows as
/// nᵐ⁻¹ log n with n points and m goals.
///
/// ```
/// use forcewright_study::pareto::hypervolume;
///
/// // Two rectangles of 2 × 1 and 1 × 2 that share a unit square.
/// let points = [vec![1.0, 2.0], vec![2.0, 1.0]];
/// assert!((hypervolume(&points, &[3.0, 3.0]) - 3.0).abs() < 1e-15);
/// ```
pub fn hypervolume(points: &[Vec<f64>], reference: &[f64]) -> f64 {
    let inside = |p: &&Vec<f64>| p.len() == reference.len() && p.iter().zip(reference).all(|(p, r)| p < r);
    let points: Vec<&[f64]> = points.iter().filter(inside).map(Vec::as_slice).collect();
    if reference.is_empty() { 0.0 } else { slices(points, reference) }
}

fn slices(mut points: Vec<&[f64]>, reference: &[f64]) -> f64 {
    let last = reference.len() - 1;
    points.sort_by(|a, b| a[last].total_cmp(&b[last]));
    if last == 0 {
        return points.first().map_or(0.0, |p| reference[0] - p[0]);
    }
    if last == 1 {
        // From the smallest second goal on: each point adds the strip of the first goal that those before it leave.
        let (mut area, mut edge) = (0.0, reference[0]);
        for p in points {
            if p[0] < edge {
                area += (edge - p[0]) * (reference[1] - p[1]);
                edge = p[0];
            }
        }
        return area;
    }
    let mut volume = 0.0;
    for count in 1..=points.len() {
        let top = points.get(count).map_or(reference[last], |p| p[last]);
        let thickness = top - points[count - 1][last];
        if thickness > 0.0 {
            volume += thickness * slices(points[..count].to_vec(), &reference[..last]);
        }
    }
    volume
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A staircase of n points on f₂ = 1 − f₁ below (1, 1): the area below the steps is 1/2 − 1/(2n).
    #[test]
    fn a_staircase_has_its_area() {
        for n in [1_u32, 2, 7, 100] {
            let points: Vec<Vec<f64>> = (0..=n).map(|i| vec![f64::from(i) / f64::from(n), 1.0 - f64::from(i) / f64::from(n)]).collect();
            let wanted = 0.5 - 0.5 / f64::from(n);
            assert!((hypervolume(&points, &[1.0, 1.0]) - wanted).abs() < 1e-14, "{n}");
        }
    }

    /// The volume of a union of boxes by inclusion and exclusion over all subsets.
    fn by_inclusion(points: &[Vec<f64>], reference: &[f64]) -> f64 {
        let box_of = |subset: u32| -> f64 {
            let chosen = |i: usize| subset >> i & 1 == 1;
            let corner = |goal: usize| points.iter().enumerate().filter(|(i, _)| chosen(*i)).map(|(_, p)| p[goal]).fold(f64::MIN, f64::max);
            reference.iter().enumerate().map(|(goal, r)| (r - corner(goal)).max(0.0)).product()
        };
        (1..1_u32 << points.len()).map(|subset| if subset.count_ones() % 2 == 1 { box_of(subset) } else { -box_of(subset) }).sum()
    }

    #[test]
    fn boxes_in_two_to_four_dimensions_are_united() {
        let mut random = crate::random::Random::new(1);
        for goals in 2..=4 {
            for count in 1..=8 {
                let points: Vec<Vec<f64>> = (0..count).map(|_| (0..goals).map(|_| random.below(6) as f64 / 5.0).collect()).collect();
                let reference = vec![1.1; goals];
                let (found, wanted) = (hypervolume(&points, &reference), by_inclusion(&points, &reference));
                assert!((found - wanted).abs() < 1e-12, "{goals} {count}: {found} {wanted}");
            }
        }
    }

    #[test]
    fn points_beyond_the_reference_add_nothing() {
        let points = [vec![0.0, 2.0], vec![0.5, 0.5], vec![f64::NAN, 0.0], vec![0.0]];
        assert!((hypervolume(&points, &[1.0, 1.0]) - 0.25).abs() < 1e-15);
        assert!(hypervolume(&[], &[1.0]).abs() < 1e-15 && hypervolume(&points, &[]).abs() < 1e-15);
    }
}
