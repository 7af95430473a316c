//! A strip as it is passed along a boundary: always on its right-hand side, outward from one end.

use super::{AxisPoint, HalfWidth, Joint, Side, Strip, Tag};
use crate::fit::{self, FitError, Oriented};
use crate::profile::Segment;
use crate::vector::{along, left, scale, unit};

impl HalfWidth {
    /// Half width and its slope by `u`; at a place where two slopes meet, that of the part before.
    pub(super) fn at(&self, u: f64) -> [f64; 2] {
        match self {
            Self::Constant(half_m) => [*half_m, 0.0],
            Self::Linear(table) => {
                let after = table.partition_point(|row| row[0] < u).clamp(1, table.len() - 1);
                let ([a, from], [b, to]) = (table[after - 1], table[after]);
                let slope = (to - from) / (b - a);
                [from + slope * (u - a), slope]
            }
        }
    }

    /// The places between which the slope is constant.
    fn kinks(&self) -> Vec<f64> {
        match self {
            Self::Constant(_) => Vec::new(),
            Self::Linear(table) => table[1..table.len() - 1].iter().map(|row| row[0]).collect(),
        }
    }
}

/// A strip passed in one direction; boundaries follow its right-hand side.
#[derive(Clone, Copy)]
pub(super) struct Walk<'a> {
    pub(super) strip: &'a Strip<'a>,
    pub(super) index: usize,
    pub(super) reversed: bool,
}

impl Walk<'_> {
    /// The joint at which it begins.
    pub(super) fn start(&self) -> Joint {
        self.strip.ends[usize::from(self.reversed)]
    }

    pub(super) fn tag(&self) -> Tag {
        Tag::Side { strip: self.index, side: if self.reversed { Side::Left } else { Side::Right } }
    }

    fn own(&self, v: f64) -> f64 {
        if self.reversed { 1.0 - v } else { v }
    }

    /// The axis in the direction of the walk, `v` from 0 to 1.
    pub(super) fn axis(&self, v: f64) -> AxisPoint {
        let place = (self.strip.axis)(self.own(v));
        if !self.reversed {
            return place;
        }
        AxisPoint { tangent: scale(place.tangent, -1.0), curvature_per_m: -place.curvature_per_m, ..place }
    }

    /// Half width at `v`, m.
    pub(super) fn half_m(&self, v: f64) -> f64 {
        self.strip.half_width.at(self.own(v))[0]
    }

    /// The side at `v`; beyond the ends the straight line in the direction of the end.
    pub(super) fn side(&self, v: f64) -> Oriented {
        self.side_on(v, v)
    }

    /// The side at `v`, with the slope of the width at another place: of the part on one or the other side of a kink.
    fn side_on(&self, v: f64, slope_at: f64) -> Oriented {
        let inside = v.clamp(0.0, 1.0);
        let axis = self.axis(inside);
        let normal = left(axis.tangent);
        let half = self.half_m(inside);
        let slope = self.strip.half_width.at(self.own(slope_at.clamp(0.0, 1.0)))[1] / self.strip.length_m;
        let slope = if self.reversed { -slope } else { slope };
        // d/ds (r − h n) = (1 + κ h) t − h' n
        let derivative = along(scale(axis.tangent, 1.0 + axis.curvature_per_m * half), normal, -slope);
        let tangent = unit(derivative);
        let on_side = along(axis.point_m, normal, -half);
        let point_m = along(on_side, tangent, (v - inside) * self.strip.length_m);
        Oriented { point_m, tangent }
    }

    /// The side from one place to another: lines and arcs where it is one to within `exact_m`, else splines. Also the largest measured
    /// error, m.
    pub(super) fn trimmed(&self, from: f64, to: f64, exact_m: f64, tolerance_m: f64) -> Result<(Vec<Segment>, f64), FitError> {
        let mut cuts: Vec<f64> = self.strip.half_width.kinks().into_iter().map(|u| self.own(u)).chain([0.0, 1.0]).collect();
        cuts.retain(|cut| *cut > from && *cut < to);
        cuts.push(to);
        cuts.sort_by(f64::total_cmp);
        let (mut segments, mut error_m, mut start): (_, f64, _) = (Vec::new(), 0.0, from);
        for end in cuts {
            if (end - start) * self.strip.length_m <= exact_m && end < to {
                continue;
            }
            if (end - start) * self.strip.length_m <= exact_m {
                segments.push(Segment::Line { to_m: self.side(end).point_m });
                break;
            }
            let middle = 0.5 * (start + end);
            let curve = |t: f64| self.side_on(start + t * (end - start), middle);
            if let Some(exact) = fit::line_or_arc(&curve, exact_m) {
                segments.extend(exact);
            } else {
                let fitted = fit::spline(&curve, tolerance_m)?;
                error_m = error_m.max(fitted.error_m);
                segments.push(Segment::Spline(fitted.spline));
            }
            start = end;
        }
        Ok((segments, error_m))
    }
}
