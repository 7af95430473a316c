//! Blocks: their borders as lines and arcs in a row, and the way along them from one strip to the next.

use std::f64::consts::PI;

use forcewright_base::maths;

use super::contact::{Arm, touch};
use super::node::{self, Turn};
use super::walk::Walk;
use super::{Block, Joint, OutlineError, Tag};
use crate::fit::Oriented;
use crate::piece::Piece;
use crate::profile::Profile;
use crate::vector::{along, angle, distance, left, right, sub, unit};

/// How far a side goes on straight beyond the end of its strip to meet the border, in half widths: it must where a strip leaves an edge
/// at a slant.
const BEYOND_HALF_WIDTHS: f64 = 6.0;

/// The border of a block, counterclockwise. A place on it is the index of a piece plus the parameter there.
pub(super) struct Border {
    pub(super) pieces: Vec<(Piece, Tag)>,
    /// The polygon without rounded corners.
    polygon: Profile,
    index: usize,
}

impl Border {
    pub(super) fn new(index: usize, block: &Block, exact_m: f64) -> Result<Self, OutlineError> {
        let wrong = OutlineError::Block { block: index };
        let mut corners: Vec<([f64; 2], usize)> = block.corners_m.iter().copied().zip(0..).collect();
        let mut polygon = Profile::polygon(&block.corners_m);
        if corners.len() < 3 || polygon.check(exact_m).is_err() {
            return Err(wrong);
        }
        let count = corners.len();
        let reversed = polygon.area_m2() < 0.0;
        if reversed {
            corners.reverse();
            polygon = polygon.reversed();
        }
        let corner = |k: usize| corners[k % count].0;
        // Where the rounding of each corner begins and ends, and its middle.
        let roundings: Vec<Rounding> =
            (0..count).map(|k| Rounding::new([corner(k + count - 1), corner(k), corner(k + 1)], block.corner_radius_m)).collect();
        let mut pieces = Vec::new();
        for k in 0..count {
            let (here, next) = (&roundings[k], &roundings[(k + 1) % count]);
            if here.cut_m + next.cut_m > distance(corner(k), corner(k + 1)) + exact_m {
                return Err(wrong);
            }
            let number = corners[k].1;
            if here.cut_m > 0.0 {
                let arc = Piece::arc(here.start, here.end, here.centre, here.convex);
                pieces.push((arc, Tag::Corner { block: index, corner: number }));
            }
            let edge = if reversed { (number + count - 1) % count } else { number };
            if distance(here.end, next.start) > exact_m {
                pieces.push((Piece::Line { from: here.end, to: next.start }, Tag::Edge { block: index, edge }));
            }
        }
        Ok(Self { pieces, polygon, index })
    }

    /// Where the axis of a walk that begins in this block leaves it; at its end if that is on the border to within the tolerance.
    pub(super) fn anchor(&self, walk: &Walk, tolerance_m: f64, exact_m: f64) -> Option<f64> {
        let end = walk.axis(0.0).point_m;
        for (k, (piece, _)) in self.pieces.iter().enumerate() {
            let t = piece.nearest(end);
            if distance(piece.point(t), end) <= tolerance_m {
                return Some(k as f64 + t);
            }
        }
        if !self.polygon.contains(end) {
            return None;
        }
        let axis = |x: f64| {
            let place = walk.axis(x.clamp(0.0, 1.0));
            Oriented { point_m: place.point_m, tangent: place.tangent }
        };
        let length_m = walk.strip.length_m;
        let arm = Arm { rim: &axis, range: [0.0, 1.0], speed_m: length_m };
        let mut first: Option<(f64, f64)> = None;
        for (k, (piece, _)) in self.pieces.iter().enumerate() {
            let rim = rim_of(piece);
            let border = Arm { rim: &rim, range: [-1e-9, 1.0 + 1e-9], speed_m: 0.0 };
            if let Some(contact) = touch([&arm, &border], 0.0, exact_m)
                && first.is_none_or(|(x, _)| contact.at[0] < x)
            {
                first = Some((contact.at[0], k as f64 + contact.at[1].clamp(0.0, 1.0 - 1e-12)));
            }
        }
        first.map(|(_, place)| place)
    }

    /// The direction out of the block at a place.
    pub(super) fn outward(&self, place: f64) -> [f64; 2] {
        let (k, t) = self.split(place);
        right(self.pieces[k].0.tangent(t))
    }

    /// From the walk that comes in at one place along the border to the one that goes out at another. `None` if the fillets do not fit.
    pub(super) fn turn(&self, walks: [&Walk; 2], places: [f64; 2], radius_m: f64, exact_m: f64) -> Option<Turn> {
        let [a, b] = walks;
        let beyond_m = BEYOND_HALF_WIDTHS * a.half_m(1.0).max(b.half_m(0.0));
        let onto = self.landing(&|x| a.side(1.0 - x), a.strip.length_m, places, false, radius_m, beyond_m, exact_m);
        let off = self.landing(&|x| b.side(x), b.strip.length_m, places, true, radius_m, beyond_m, exact_m);
        if let (Some(onto), Some(off)) = (onto, off)
            && onto.place <= off.place + 1e-9
        {
            let tag = Tag::Fillet { joint: Joint::Block(self.index) };
            let at = [1.0 - onto.at, off.at];
            let (first, last) = (self.point(onto.place), self.point(off.place));
            let mut path = vec![(Piece::arc(a.side(at[0]).point_m, first, onto.centre_m, false), tag)];
            path.extend(self.between(onto.place, off.place));
            path.push((Piece::arc(last, b.side(at[1]).point_m, off.centre_m, false), tag));
            path.retain(|(piece, _)| piece.length() > exact_m);
            return Some(Turn { at, path });
        }
        if a.index == b.index {
            return None;
        }
        // No border is left between the strips: they meet before it.
        let turn = node::fillet(walks, beyond_m, radius_m, Joint::Block(self.index), exact_m)?;
        let outside = |point: [f64; 2]| self.polygon.winding(point) == Some(0);
        (outside(a.side(turn.at[0]).point_m) && outside(b.side(turn.at[1]).point_m)).then_some(turn)
    }

    /// Where a fillet between a side and the border touches both: forward from the first place, or backward from the second.
    #[expect(clippy::too_many_arguments, reason = "one call for either direction")]
    fn landing(
        &self,
        side: &dyn Fn(f64) -> Oriented,
        length_m: f64,
        [from, to]: [f64; 2],
        backward: bool,
        radius_m: f64,
        beyond_m: f64,
        exact_m: f64,
    ) -> Option<Landing> {
        let arm = Arm { rim: side, range: [-beyond_m / length_m, 1.0], speed_m: length_m };
        let mut parts = Self::parts(from, to);
        if backward {
            parts.reverse();
        }
        parts.into_iter().find_map(|(whole, start, end)| {
            let (piece, _) = self.pieces[whole % self.pieces.len()];
            let hollow =
                matches!(piece, Piece::Arc { sweep_rad, from, centre, .. } if sweep_rad < 0.0 && distance(from, centre) <= radius_m);
            if hollow {
                return None;
            }
            let rim = rim_of(&piece);
            let place = |x: f64| if backward { end - x } else { start + x };
            let moved = |x: f64| rim(place(x));
            let slack = exact_m / piece.length();
            let border = Arm { rim: &moved, range: [-slack, end - start + slack], speed_m: piece.length() };
            let contact = touch([&arm, &border], radius_m, exact_m)?;
            let local = place(contact.at[1]).clamp(0.0, 1.0);
            Some(Landing { at: contact.at[0], place: whole as f64 + local, centre_m: contact.centre_m })
        })
    }

    /// The parts of pieces between two places: index (counted on beyond the last), start, end.
    fn parts(from: f64, to: f64) -> Vec<(usize, f64, f64)> {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small and not negative")]
        let (first, last) = (from.max(0.0) as usize, to.max(0.0) as usize);
        (first..=last).map(|k| (k, (from - k as f64).max(0.0), (to - k as f64).min(1.0))).filter(|(_, start, end)| end > start).collect()
    }

    fn between(&self, from: f64, to: f64) -> Vec<(Piece, Tag)> {
        let part = |(k, start, end): (usize, f64, f64)| {
            let (piece, tag) = &self.pieces[k % self.pieces.len()];
            (piece.part(start, end), *tag)
        };
        Self::parts(from, to).into_iter().map(part).collect()
    }

    fn split(&self, place: f64) -> (usize, f64) {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small and not negative")]
        let whole = place.max(0.0) as usize;
        (whole % self.pieces.len(), (place - whole as f64).clamp(0.0, 1.0))
    }

    fn point(&self, place: f64) -> [f64; 2] {
        let (k, t) = self.split(place);
        self.pieces[k].0.point(t)
    }
}

/// A fillet between a side and the border.
struct Landing {
    /// Where on the side.
    at: f64,
    /// Where on the border.
    place: f64,
    centre_m: [f64; 2],
}

/// A piece and its straight continuations.
fn rim_of(piece: &Piece) -> impl Fn(f64) -> Oriented {
    let piece = *piece;
    move |t| {
        let inside = if matches!(piece, Piece::Arc { .. }) { t } else { t.clamp(0.0, 1.0) };
        let tangent = piece.tangent(inside);
        let point_m = match piece {
            // `point` is exact at the end and goes no farther
            Piece::Arc { centre, from, sweep_rad, .. } if t > 1.0 => {
                crate::vector::add(centre, crate::vector::rotate(sub(from, centre), sweep_rad * t))
            }
            _ => along(piece.point(inside), tangent, (t - inside) * piece.length()),
        };
        Oriented { point_m, tangent }
    }
}

/// A rounded corner.
struct Rounding {
    start: [f64; 2],
    end: [f64; 2],
    centre: [f64; 2],
    convex: bool,
    /// Length taken from either edge, m.
    cut_m: f64,
}

impl Rounding {
    fn new([before, corner, after]: [[f64; 2]; 3], radius_m: f64) -> Self {
        let (coming, going) = (unit(sub(corner, before)), unit(sub(after, corner)));
        let turn = angle(coming, going);
        let cut_m = if turn.abs() < PI { radius_m * maths::tan(0.5 * turn.abs()) } else { f64::INFINITY };
        let start = along(corner, coming, -cut_m);
        let centre = along(start, left(coming), radius_m * turn.signum());
        Self { start, end: along(corner, going, cut_m), centre, convex: turn > 0.0, cut_m }
    }
}
