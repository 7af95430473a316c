//! Where the return span lands, and what brings it into line with its groove.

use std::f64::consts::{PI, TAU};

use forcewright_base::maths::{atan2, sin};
use forcewright_base::roots::root;

use crate::whole::whole;

use super::{Belt, Drive, Drum, GeometryError, Setting, Surface, free_span_m, tangent_rad};

/// Most centre distances that are given at once.
const MOST_DISTANCES: usize = 10_000;
/// Stations on which a ratio is looked for.
const RATIO_STATIONS: usize = 400;

/// A centre distance at which both spans are in line with their grooves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aligned {
    /// Line of end 1 less that of end 0.
    pub lines_apart: i64,
    /// d, m.
    pub centre_distance_m: f64,
}

/// How one cable's spans stand to their grooves; index 0 is the outgoing span (end 0 to the input), 1 the return span.
///
/// A span that deviates by x climbs `L_f tan β + x`. It leaves the grooves at both of its ends by the same angle, as both have the angle β.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fleet {
    /// Axial deviation over the length of the span, m, signed in the sense of the climb.
    pub deviation_m: [f64; 2],
    /// The same in pitches.
    pub deviation_pitches: [f64; 2],
    /// Angle between span and groove, rad, signed alike; on flat drums the angle between the span and the planes across the axes, which is β.
    pub fleet_rad: [f64; 2],
}

impl Fleet {
    /// The larger of both angles without its sign, rad.
    pub fn largest_rad(&self) -> f64 {
        self.fleet_rad[0].abs().max(self.fleet_rad[1].abs())
    }
}

/// ε(d) = (`L_f` − a γ)/(π r1): what a cable lands beyond n + 1 pitches from the groove it left. Equal to (1 + σR)(tan γ − γ)/π, without
/// the division by cos γ, which is 0 for an open belt with R = 1. It grows with d by sin γ/(π r1).
fn landing(r1_m: f64, r2_m: f64, d_m: f64, belt: Belt) -> f64 {
    let a = r1_m + belt.sign() * r2_m;
    (free_span_m(r1_m, r2_m, d_m, belt) - a * tangent_rad(r1_m, r2_m, d_m, belt)) / (PI * r1_m)
}

impl Drive {
    /// ε, pitches: the return span of a cable without deviations lands n + 1 + ε pitches from the groove that the cable left.
    /// ε = (1 + σR)(tan γ − γ)/π.
    pub fn landing_pitches(&self) -> f64 {
        let l = &self.layout;
        landing(l.input_radius_m, l.output_radius_m, l.centre_distance_m, l.belt)
    }

    /// The alignment law of an output with R starts: ε − k with the nearest whole k, and that k. Both spans of any cable can be in line
    /// only where it is 0.
    pub fn law_residual(&self) -> (f64, f64) {
        let landing = self.landing_pitches();
        let k = landing.round();
        (landing - k, k)
    }

    /// How ε changes with the centre distance, pitches per m: sin γ/(π r1).
    pub fn landing_pitches_per_m(&self) -> f64 {
        sin(self.tangent_rad) / (PI * self.layout.input_radius_m)
    }

    /// From the groove line of end 1 to where the return span lands if the cable has no deviation, in pitches, in the sense of the climb:
    /// n + 1 + ε − (l1 − l0) R/S − R φ/2π with the phase φ of the second group. 0 on flat drums.
    ///
    /// # Errors
    /// [`GeometryError::NoSuchCable`].
    pub fn mismatch_pitches(&self, cable: usize) -> Result<f64, GeometryError> {
        let [first, second] = self.lines(cable)?;
        if self.layout.surface == Surface::Flat {
            return Ok(0.0);
        }
        Ok(self.landing_lines_m() / self.layout.pitch_m - (second - first) * self.line_spacing_m() / self.layout.pitch_m)
    }

    /// Where the return span lands, less the phase of the second group, m from line 0.
    fn landing_lines_m(&self) -> f64 {
        (self.turns() + self.landing_pitches()) * self.layout.pitch_m - self.lead_m_per_rad(Drum::Output) * self.layout.second_phase_rad
    }

    /// Groove line of end 1, counted from that of end 0, that is next to where the cable lands.
    pub fn nearest_lines_apart(&self) -> i64 {
        whole(self.landing_lines_m() / self.line_spacing_m())
    }

    /// How a cable's spans stand to their grooves, with the input set as [`Setting`] says.
    ///
    /// # Errors
    /// [`GeometryError::NoSuchCable`].
    pub fn fleet(&self, cable: usize) -> Result<Fleet, GeometryError> {
        let deviation_m = self.deviations_m(cable)?;
        let (span, slope) = (self.free_span_m, self.slope());
        // The angle between the directions (1, slope) and (L, L slope + x), without cancellation.
        let fleet = |x: f64| match self.layout.surface {
            Surface::Grooved => atan2(x, span * (1.0 + slope * slope) + x * slope),
            Surface::Flat => self.helix_angle_rad(),
        };
        Ok(Fleet { deviation_m, deviation_pitches: deviation_m.map(|x| x / self.layout.pitch_m), fleet_rad: deviation_m.map(fleet) })
    }

    /// Centre distances between `from_m` and `to_m` at which both spans are in line with their grooves, ascending, for every number of
    /// lines between the ends of a cable: n + 1 + ε(d) = j R/S + R φ/2π. With R starts and no phase that is (1 + σR)(tan γ − γ) = kπ, j = n
    /// + 1 + k. The present centre distance plays no part. Below r1 + r2 there are none.
    ///
    /// # Errors
    /// [`GeometryError::Number`] for ends that are not finite, [`GeometryError::TooMany`] for more than ten thousand.
    pub fn aligned_distances(&self, from_m: f64, to_m: f64) -> Result<Vec<Aligned>, GeometryError> {
        for (name, value) in [("least centre distance", from_m), ("largest centre distance", to_m)] {
            if !value.is_finite() {
                return Err(GeometryError::Number { name, value });
            }
        }
        let l = &self.layout;
        let from_m = from_m.max(l.input_radius_m + l.output_radius_m);
        if to_m < from_m {
            return Ok(Vec::new());
        }
        let phase = self.ratio() * l.second_phase_rad / TAU;
        let step = self.ratio() / f64::from(l.starts);
        let lines = |d_m: f64| (self.turns() + landing(l.input_radius_m, l.output_radius_m, d_m, l.belt) - phase) / step;
        let first = lines(from_m).ceil();
        let last = lines(to_m).floor();
        let count = last - first + 1.0;
        if count.is_nan() || count > MOST_DISTANCES as f64 {
            return Err(GeometryError::TooMany { count, limit: MOST_DISTANCES });
        }
        let mut found = Vec::new();
        for line in (0..whole(count)).map(|i| first + i as f64) {
            // Where the drums touch there is no span.
            if let Ok(centre_distance_m) = root(|d_m| lines(d_m) - line, from_m, to_m, 0.0)
                && centre_distance_m > l.input_radius_m + l.output_radius_m
            {
                found.push(Aligned { lines_apart: whole(line), centre_distance_m });
            }
        }
        Ok(found)
    }

    /// The ratio R next to S at which a cable with these lines between its ends is in line at the present centre distance, without a phase,
    /// by changing the output's radius: n + 1 + ε(R) = j R/S. For j = n + 1 on a crossed belt that is R = S (1 + ε/(n+1)).
    ///
    /// Only the cable on line 0 is then in line on the input: another one with first line l is l R/S pitches further, which is whole only
    /// by chance.
    ///
    /// # Errors
    /// [`GeometryError::NoRatio`] if there is none with a span.
    pub fn aligning_ratio(&self, lines_apart: i32) -> Result<f64, GeometryError> {
        let l = &self.layout;
        let (r1, d, starts) = (l.input_radius_m, l.centre_distance_m, f64::from(l.starts));
        let miss = |ratio: f64| self.turns() + landing(r1, ratio * r1, d, l.belt) - f64::from(lines_apart) * ratio / starts;
        let most = d / r1 - 1.0;
        let station = |i: usize| most * i as f64 / RATIO_STATIONS as f64;
        let mut best: Option<f64> = None;
        for i in 0..RATIO_STATIONS {
            if let Ok(ratio) = root(miss, station(i), station(i + 1), 0.0)
                && ratio > 0.0
                && ratio < most
                && best.is_none_or(|best| (ratio - starts).abs() < (best - starts).abs())
            {
                best = Some(ratio);
            }
        }
        best.ok_or(GeometryError::NoRatio)
    }

    /// Phase of the second group that brings a cable into line at the present centre distance and ratio, rad, in the sense of
    /// [`second_phase_rad`](super::Layout::second_phase_rad): 2π (n + 1 + ε − (l1 − l0) R/S)/R.
    ///
    /// # Errors
    /// [`GeometryError::NoSuchCable`].
    pub fn aligning_phase_rad(&self, cable: usize) -> Result<f64, GeometryError> {
        let [first, second] = self.lines(cable)?;
        let off = (self.turns() + self.landing_pitches()) * self.layout.pitch_m - (second - first) * self.line_spacing_m();
        Ok(off / self.lead_m_per_rad(Drum::Output))
    }

    /// What both spans of a cable deviate from their grooves if they share its mismatch, rad: the least fleet angle that one cable can have.
    ///
    /// # Errors
    /// [`GeometryError::NoSuchCable`].
    pub fn shared_fleet_rad(&self, cable: usize) -> Result<f64, GeometryError> {
        let x = -0.5 * self.mismatch_pitches(cable)? * self.layout.pitch_m;
        let slope = self.slope();
        Ok(atan2(x, self.free_span_m * (1.0 + slope * slope) + x * slope))
    }

    /// How far [`Setting`] moves the input along z, m, from the place where the outgoing span of a cable on line 0 is in line. Turning the input in its
    /// coupling by 2π/p per m, in the sense that moves its groove so, does the same.
    pub fn input_shift_m(&self) -> f64 {
        self.layout.hand.sign() * self.input_shift_m
    }

    /// Which turn of the input groove a cable's outgoing span runs to: the one next to where it lands.
    pub(super) fn input_turn(&self, first_line: f64) -> f64 {
        match self.layout.surface {
            Surface::Grooved => (first_line * self.line_spacing_m() / self.layout.pitch_m).round(),
            Surface::Flat => first_line * self.line_spacing_m() / self.layout.pitch_m,
        }
    }

    /// Axial deviations of a cable's outgoing and return span, m.
    pub(super) fn deviations_m(&self, cable: usize) -> Result<[f64; 2], GeometryError> {
        let [first, _] = self.lines(cable)?;
        let outgoing = self.input_turn(first) * self.layout.pitch_m - first * self.line_spacing_m() + self.input_shift_m;
        Ok([outgoing, -self.mismatch_pitches(cable)? * self.layout.pitch_m - outgoing])
    }

    /// The second line must be the one next to where the cable lands.
    pub(super) fn check_lines(&self) -> Result<(), GeometryError> {
        // Half-way between two lines both will do, in spite of rounding.
        const HALF: f64 = 0.5 + 1e-9;
        if self.layout.surface == Surface::Flat {
            return Ok(());
        }
        for cable in 0..self.layout.cables.len() {
            let off_lines = self.mismatch_pitches(cable)? * self.layout.pitch_m / self.line_spacing_m();
            if off_lines.is_nan() || off_lines.abs() > HALF {
                let nearest = i64::from(self.layout.cables[cable][0]).saturating_add(self.nearest_lines_apart());
                return Err(GeometryError::Lines { cable, off_lines, nearest });
            }
        }
        Ok(())
    }

    /// Shift of the input groove that [`Setting`] asks for, m. With the shift x the deviations are A + x and B − x: the largest is least in
    /// the middle of all −A and B.
    pub(super) fn setting_shift_m(&self) -> f64 {
        if self.layout.setting == Setting::Outgoing || self.layout.surface == Surface::Flat {
            return 0.0;
        }
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        for cable in 0..self.layout.cables.len() {
            if let Ok([outgoing, back]) = self.deviations_m(cable) {
                for wanted in [-outgoing, back] {
                    (least, most) = (least.min(wanted), most.max(wanted));
                }
            }
        }
        0.5 * (least + most)
    }
}
