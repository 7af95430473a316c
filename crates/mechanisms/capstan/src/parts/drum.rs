//! From the geometry of a drive to the body of a drum.
//!
//! A drum stands as at the start of the travel: its x axis points from the input's axis to the output's, and its z is that of the drive
//! above the lower end face.

use std::f64::consts::TAU;

use forcewright_base::maths;
use forcewright_base::units::format_si;
use forcewright_curves::Segment;
use forcewright_elements::grooves::Groove as Friction;
use forcewright_model::{Drilling, Groove, GrooveError, Grooved, NoPart, Section, Turned};

use crate::design::Design;
use crate::geometry::{Band, Drive, Drum, GeometryError, Group, Layout, Surface};

/// Depth of a slot below its seat over the diameter of the cable: a worn cable must not reach its bottom.
pub(super) const SLOT_DEPTH: f64 = 0.25;
/// Depth of the relief between two groups below the bottom of the grooves, and its least width, over the diameter of the cable.
const RELIEF: [f64; 2] = [0.1, 1.0];
/// Groups whose grooves are nearer to each other, in line spacings, are one.
const SAME_LINES: f64 = 1e-9;

/// Both drums, input first.
pub(super) const DRUMS: [Drum; 2] = [Drum::Input, Drum::Output];

/// A drum as it is made.
pub(super) struct Made {
    pub drum: Drum,
    /// z of its lower end face in the drive, m.
    pub foot_m: f64,
    /// Its grooved stretches in the drive, from below, or the plain one of a flat drum.
    pub stretches: Vec<Stretch>,
    /// The section of its grooves; `None` of a flat drum.
    pub groove: Option<Groove>,
    pub body: Turned,
}

/// A stretch of a drum with grooves of one group.
#[derive(Clone, Copy)]
pub(super) struct Stretch {
    pub group: Group,
    pub band: Band,
}

/// `input` or `output`.
pub(super) fn name_of(drum: Drum) -> &'static str {
    match drum {
        Drum::Input => "input",
        Drum::Output => "output",
    }
}

/// Its place in pairs of values.
pub(super) fn index_of(drum: Drum) -> usize {
    match drum {
        Drum::Input => 0,
        Drum::Output => 1,
    }
}

impl Made {
    /// A drum whose grooves are wider by `clearance_m` on all sides.
    ///
    /// # Errors
    /// E0730 where the numbers make no drum, E0731 where two groups of grooves overlap.
    pub(super) fn new(design: &Design, geometry: &Drive, drum: Drum, clearance_m: f64) -> Result<Self, NoPart> {
        let built = &design.built;
        let cable_m = built.cable_m();
        let least_m = geometry.radius_m(drum) - 0.5 * cable_m;
        let spacing_m = spacing_m(geometry, drum);
        let groove = section(design, least_m, spacing_m, clearance_m).map_err(|error| no_groove(design, drum, &error))?;
        let stretches = stretches(design, geometry, drum)?;
        let foot_m = stretches.first().map_or(0.0, |s| s.band.from_m);
        let starts = starts(geometry, drum);
        let mut sections = Vec::new();
        let mut last_m: Option<f64> = None;
        for stretch in &stretches {
            let Band { from_m, to_m } = stretch.band;
            let Some(groove) = &groove else {
                sections.push(Section::Plain { length_m: to_m - from_m, radius_m: least_m });
                continue;
            };
            if let Some(last_m) = last_m {
                let radius_m = groove.radii_m()[0] - RELIEF[0] * cable_m;
                sections.push(Section::Plain { length_m: from_m - last_m, radius_m });
            }
            last_m = Some(to_m);
            sections.push(Section::Grooved(Grooved {
                length_m: to_m - from_m,
                lead_m: geometry.hand(drum).sign() * geometry.lead_m(drum),
                starts,
                phase_rad: phase_rad(geometry, drum, stretch.group, from_m),
                groove: groove.clone(),
            }));
        }
        let bore_diameter_m = design.making.bores_m[index_of(drum)].unwrap_or(0.0);
        let mut made = Self { drum, foot_m, stretches, groove, body: Turned { bore_diameter_m, sections, drillings: Vec::new() } };
        made.body.drillings = drillings(design, geometry, &made)?;
        made.body.check().map_err(|error| NoPart {
            code: "E0730",
            message: format!("the {} drum cannot be made: {error}", name_of(drum)),
            help: "change the number named: bore, margin, pitch, depth or diameter".to_owned(),
        })?;
        Ok(made)
    }

    /// Radius of the lands, or of a flat drum, m.
    pub(super) fn surface_m(&self) -> f64 {
        let grooved = self.groove.as_ref().map(|groove| groove.radii_m()[1]);
        grooved.unwrap_or_else(|| self.body.largest_radius_m())
    }

    /// Largest angle between the upper flanks of the grooves and the axis, rad: how far they hang over when the axis stands upright.
    /// The normal of a profile that leans by ψ is (cos ψ, sin ψ) in the half plane; on the helix its third component is sin ψ lead/(2πρ).
    pub(super) fn overhang_rad(&self) -> Option<f64> {
        let groove = self.groove.as_ref()?;
        let lead_m = self.body.sections.iter().find_map(Section::grooved)?.lead_m.abs();
        let mut most = 0.0_f64;
        for (from, segment) in groove.spans() {
            let to = segment.end_m();
            let leans = match segment {
                Segment::Arc { centre_m, .. } => {
                    let radius_m = maths::hypot(from[0] - centre_m[0], from[1] - centre_m[1]);
                    [from, to].map(|[x, y]| [((x - centre_m[0]) / radius_m).abs().min(1.0), y])
                }
                _ => [from, to].map(|[_, y]| [(to[1] - from[1]).abs() / maths::hypot(to[0] - from[0], to[1] - from[1]), y]),
            };
            for [sin, radius_m] in leans {
                let around = sin * lead_m / (TAU * radius_m);
                most = most.max(sin / maths::hypot(1.0, around));
            }
        }
        Some(maths::atan2(most, (1.0 - most * most).max(0.0).sqrt()))
    }
}

/// Grooves side by side.
fn starts(geometry: &Drive, drum: Drum) -> u32 {
    match drum {
        Drum::Input => 1,
        Drum::Output => geometry.layout().starts,
    }
}

/// From groove to groove along the axis, m; as the body counts it, so that its profile closes.
pub(super) fn spacing_m(geometry: &Drive, drum: Drum) -> f64 {
    geometry.lead_m(drum) / f64::from(starts(geometry, drum))
}

/// Angle at which line 0 of a group crosses a height of the drive, rad, in [0, 2π).
pub(super) fn phase_rad(geometry: &Drive, drum: Drum, group: Group, z_m: f64) -> f64 {
    let rad_per_m = geometry.hand(drum).sign() * TAU / geometry.lead_m(drum);
    let angle = ((z_m - geometry.groove_z_m(drum, group, 0.0, 0.0)) * rad_per_m).rem_euclid(TAU);
    // A hair below 0 rounds to a whole turn.
    if angle < TAU { angle } else { 0.0 }
}

/// The section of one groove, whose seat lies `least_m` from the axis.
fn section(design: &Design, least_m: f64, spacing_m: f64, clearance_m: f64) -> Result<Option<Groove>, GrooveError> {
    let built = &design.built;
    let (seat, cable_m) = (&built.seat, built.cable_m());
    let (seat_m, depth_m) = (seat.radius_for_m(cable_m), seat.depth_for_m(cable_m));
    let surface_m = least_m + depth_m;
    // Wider on all sides: arcs around the same middle, flanks parallel to themselves.
    let round_m = [seat_m + clearance_m, depth_m + clearance_m];
    Ok(Some(match &seat.groove {
        Friction::Flat => return Ok(None),
        Friction::Round { .. } => Groove::round(surface_m, spacing_m, round_m[0], round_m[1])?,
        Friction::Undercut { undercut_rad, .. } => {
            let width_m = 2.0 * (seat_m * maths::sin(0.5 * undercut_rad) + clearance_m);
            Groove::undercut(surface_m, spacing_m, round_m, [width_m, SLOT_DEPTH * cable_m])?
        }
        Friction::Vee { half_angle_rad } => {
            // The cable's lowest point lies r (1/sin − 1) above the tip.
            let below_m = 0.5 * cable_m * (1.0 / maths::sin(*half_angle_rad) - 1.0);
            Groove::vee(surface_m, spacing_m, 2.0 * half_angle_rad, clearance_m, depth_m + below_m + clearance_m)?
        }
    }))
}

fn no_groove(design: &Design, drum: Drum, error: &GrooveError) -> NoPart {
    let built = &design.built;
    let help = match error {
        GrooveError::NoLand { .. } => "a larger `pitch`, shallower grooves, or a smaller `parts.print_clearance`",
        _ => "change `radius`, `depth` or `pitch` of `design.groove`, or the diameter of the drum",
    };
    let width_mm = 1e3 * built.seat.width_for_m(built.cable_m());
    NoPart {
        code: "E0730",
        message: format!("the {} drum cannot be made: {error} (a groove is {width_mm:.4} mm wide at the surface)", name_of(drum)),
        help: help.to_owned(),
    }
}

/// The grooved stretches of a drum, from below.
fn stretches(design: &Design, geometry: &Drive, drum: Drum) -> Result<Vec<Stretch>, NoPart> {
    let margin_m = design.making.margin_m;
    let band = geometry.band(drum);
    let whole = Band { from_m: band.from_m - margin_m, to_m: band.to_m + margin_m };
    let lines = design.built.phase_rad * f64::from(design.built.starts) / TAU;
    let is_one = drum == Drum::Input || design.built.seat.groove == Friction::Flat || (lines - lines.round()).abs() < SAME_LINES;
    if is_one {
        return Ok(vec![Stretch { group: Group::First, band: whole }]);
    }
    let group_band = |end: usize| {
        let bands = (0..design.built.cables.len()).filter_map(|cable| geometry.output_bands(cable).ok()).map(|bands| bands[end]);
        bands.reduce(|a, b| Band { from_m: a.from_m.min(b.from_m), to_m: a.to_m.max(b.to_m) }).unwrap_or(band)
    };
    let mut groups = [(Group::First, group_band(0)), (Group::Second, group_band(1))];
    if groups[1].1.from_m < groups[0].1.from_m {
        groups.swap(0, 1);
    }
    let [(lower, below), (upper, above)] = groups;
    let cable_m = design.built.cable_m();
    let half_m = 0.5 * design.built.seat.width_for_m(cable_m).max(cable_m / maths::cos(geometry.helix_angle_rad()));
    let gap_m = above.from_m - below.to_m;
    let land_m = margin_m.min(0.5 * (gap_m - RELIEF[1] * cable_m));
    if land_m.is_nan() || land_m < half_m {
        return Err(overlap(design, gap_m, 2.0 * half_m + RELIEF[1] * cable_m));
    }
    Ok(vec![
        Stretch { group: lower, band: Band { from_m: whole.from_m, to_m: below.to_m + land_m } },
        Stretch { group: upper, band: Band { from_m: above.from_m - land_m, to_m: whole.to_m } },
    ])
}

/// E0731: two groups on one stretch.
fn overlap(design: &Design, gap_m: f64, needed_m: f64) -> NoPart {
    let built = &design.built;
    // A turn more on the input moves the second group on by a pitch.
    let turns = ((needed_m - gap_m) / built.pitch_m).ceil();
    let length = |m: f64| format_si(m, &design.units.length, 4);
    // Without the phase the second lines may be others: a flat drive asks for none.
    let unphased = Drive::new(Layout { second_phase_rad: 0.0, surface: Surface::Flat, ..built.layout() });
    let aligned = unphased.and_then(|drive| drive.aligned_distances(0.0, 2.0 * built.distance_m)).unwrap_or_default();
    let nearest =
        aligned.iter().map(|a| a.centre_distance_m).min_by(|a, b| (a - built.distance_m).abs().total_cmp(&(b - built.distance_m).abs()));
    let instead = nearest
        .map_or_else(|| ", or no `groove_phase`".to_owned(), |m| format!(", or no `groove_phase` and a centre distance of {}", length(m)));
    NoPart {
        code: "E0731",
        message: format!(
            "the two groups of output grooves cannot be cut: with a `groove_phase` of their own they need stretches of the drum of their own, {} apart, and have {}",
            length(needed_m),
            length(gap_m)
        ),
        help: format!("about {turns} more `extra_turns`, less travel or fewer cables{instead}"),
    }
}

/// Holes for the ends of the cables on the output, and for pins on an input to which they are fastened.
fn drillings(design: &Design, geometry: &Drive, made: &Made) -> Result<Vec<Drilling>, NoPart> {
    let (built, making) = (&design.built, &design.making);
    // Half of the wall stays.
    let depth_m = making.anchor_m.min(0.5 * (made.surface_m() - 0.5 * made.body.bore_diameter_m));
    let mut all = Vec::new();
    for cable in 0..built.cables.len() {
        let mut drill = |z_m: f64, angle_rad: f64, purpose: String| {
            all.push(Drilling {
                z_m: z_m - made.foot_m,
                angle_rad: angle_rad.rem_euclid(TAU),
                diameter_m: making.hole_m,
                depth_m,
                purpose,
            });
        };
        match made.drum {
            Drum::Output => {
                let anchors = geometry.anchors(cable).map_err(|error| no_drum(&error))?;
                for (end, anchor) in anchors.iter().enumerate() {
                    drill(anchor.z_m, anchor.angle_rad, format!("end {end} of cable {}", cable + 1));
                }
            }
            Drum::Input if built.fastened => {
                let (angle_rad, z_m) = pin(geometry, cable).map_err(|error| no_drum(&error))?;
                drill(z_m, angle_rad, format!("pin of cable {}", cable + 1));
            }
            Drum::Input => {}
        }
    }
    Ok(all)
}

/// Angle and z of the place on the input drum that lies in the middle of what is wrapped over the whole travel. On the drum the wrap runs
/// from γ + Rα to γ + Rα + Θ as the output turns by α.
fn pin(geometry: &Drive, cable: usize) -> Result<(f64, f64), GeometryError> {
    let band = geometry.input_band(cable)?;
    let turned = geometry.ratio() * geometry.layout().travel_rad;
    let angle = geometry.tangent_angle_rad() + 0.5 * (turned + geometry.input_wrap_rad());
    Ok((angle, 0.5 * (band.from_m + band.to_m)))
}

pub(super) fn no_drum(error: &GeometryError) -> NoPart {
    NoPart { code: "E0730", message: format!("the drums cannot be made: {error}"), help: "change the number named".to_owned() }
}
