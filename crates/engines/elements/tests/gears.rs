//! Meshes and interference of gears against printed examples, closed forms written out anew, cutting by brute force, and laws.

use std::f64::consts::PI;

use forcewright_base::maths;
use forcewright_elements::gears::interference::{self, Condition};
use forcewright_elements::gears::strength::{bending_stress_pa, flank_pressure, tooth_root};
use forcewright_elements::gears::{GearError, Kind, Mesh, Rack, Wheel, WheelSpec, inverse_involute, involute};
use forcewright_elements::hertz::Solid;
use proptest::prelude::*;

fn near(ours: f64, exact: f64, absolute: f64) {
    assert!((ours - exact).abs() <= absolute, "{ours} instead of {exact}");
}

fn spec(kind: Kind, teeth: u32, profile_shift: f64) -> WheelSpec {
    WheelSpec { kind, teeth, module_m: 1.0, rack: Rack::ISO_53_A, profile_shift, tip_shortening: 0.0, thinning_m: 0.0 }
}

fn wheel(kind: Kind, teeth: u32, profile_shift: f64) -> Wheel {
    Wheel::new(spec(kind, teeth, profile_shift)).expect("a gear of these numbers")
}

fn scaled(kind: Kind, teeth: u32, profile_shift: f64, module_m: f64) -> Wheel {
    Wheel::new(WheelSpec { module_m, ..spec(kind, teeth, profile_shift) }).expect("a gear of these numbers")
}

use Kind::{External, Internal};

/// KHK, "Gear technical reference", table 4.3 (also SDP/SI, "Elements of Metric Gear Technology"): m = 3, 12 and 24 teeth, shifts of 0.6 and
/// 0.36, tips shortened for the clearance of the rack; printed: α' = 26.0886°, a = 56.4999, tip diameters 44.840 and 79.400, contact
/// ratio 1.202.
#[test]
fn external_pair_of_a_handbook() {
    let free = Mesh::without_backlash(scaled(External, 12, 0.6, 3.0), scaled(External, 24, 0.36, 3.0)).unwrap();
    near(free.pressure_angle_rad.to_degrees(), 26.0886, 5e-5);
    near(free.centre_distance_m, 56.4999, 5e-5);
    let shortening = 0.96 - (free.centre_distance_m - 54.0) / 3.0;
    let short = |wheel: Wheel| Wheel::new(WheelSpec { tip_shortening: shortening, ..wheel.spec }).unwrap();
    let mesh = Mesh::new(short(free.pinion), short(free.wheel), free.centre_distance_m).unwrap();
    near(2.0 * mesh.pinion.tip_radius_m, 44.840, 5e-4);
    near(2.0 * mesh.wheel.tip_radius_m, 79.400, 5e-4);
    let path = mesh.path();
    near(path.contact_ratio(path.tips), 1.202, 5e-4);
    near(mesh.bottom_clearances_m()[0], 0.75, 1e-9);
    near(mesh.bottom_clearances_m()[1], 0.75, 1e-9);
    near(2.0 * mesh.pitch_radii_m()[0], 37.667, 5e-4);
    near(2.0 * mesh.pitch_radii_m()[1], 75.333, 5e-4);
}

/// KHK, table 4.6: m = 3, 16 teeth in a ring of 24 at 13.2: α' = 31.321258° and a shift of 0.516. And a worksheet of centre distances: a
/// ring of 96 teeth, an external pair (Scribd 92821234).
#[test]
fn internal_pairs_in_print() {
    let mesh = Mesh::new(scaled(External, 16, 0.0, 3.0), scaled(Internal, 24, 0.516, 3.0), 13.2).unwrap();
    near(mesh.pressure_angle_rad.to_degrees(), 31.321_258, 5e-7);
    near(mesh.shifts_without_backlash(), 0.516, 5e-4);
    let mesh = Mesh::without_backlash(scaled(External, 17, 0.2, 14.0), scaled(Internal, 96, 0.5, 14.0)).unwrap();
    near(mesh.pressure_angle_rad.to_degrees(), 21.1251, 5e-5);
    near(mesh.centre_distance_m, 557.0887, 5e-5);
    let pair = Mesh::without_backlash(scaled(External, 30, 0.0, 16.0), scaled(External, 78, 0.05, 16.0)).unwrap();
    near(pair.centre_distance_m, 864.7972, 5e-5);
    near(pair.pressure_angle_rad.to_degrees(), 20.1446, 5e-5);
}

/// The set of 12, 18 and 48 teeth without shift; values of an independent program in another language.
#[test]
fn unshifted_lavt() {
    // Its rack is straight to one module, which the 0.38 of ISO 53 rounds.
    let rack = Rack { root_radius: 0.25 / (1.0 - maths::sin(PI / 9.0)), ..Rack::ISO_53_A };
    let [sun, planet, ring] = [(External, 12), (External, 18), (Internal, 48)]
        .map(|(kind, teeth)| Wheel::new(WheelSpec { rack, ..spec(kind, teeth, 0.0) }).unwrap());
    near(interference::least_shift(&sun), 0.298_133_329_356_934, 1e-12);
    near(interference::least_shift(&planet), -0.052_800_005_964_599, 1e-12);
    let outer = Mesh::without_backlash(sun, planet).unwrap();
    let path = outer.path();
    near(outer.centre_distance_m, 15.0, 1e-12);
    near(path.contact_ratio(path.tips), 1.475_053_592_209_131, 1e-12);
    near(path.contact_ratio(path.between_interference_points()), 1.405_302_719_855_167_5, 1e-12);
    // The fillet of the undercut sun takes more.
    assert!(path.contact_ratio(path.usable) < 1.405);
    let inner = Mesh::without_backlash(planet, ring).unwrap();
    near(ring.reference_radius_m - interference::wheel_tip_limit_m(&inner), 0.871_212_747_587_030_4, 1e-12);
    near(interference::trochoid_rad(&inner).unwrap(), 0.016_424_442_255_430_716, 1e-12);
    near(interference::trimming_rad(&inner), 0.024_402_716_331_438_2, 1e-12);
    let failing: Vec<Condition> = interference::mesh_margins(&inner, 0.25 - 1e-12).filter(|m| !m.holds()).map(|m| m.condition).collect();
    assert_eq!(failing, [Condition::PinionInterference, Condition::PinionFillet, Condition::PinionCorner]);
    let undercut = interference::wheel_margins(&sun, 0.2).find(|m| m.condition == Condition::Undercut).unwrap();
    near(undercut.value, -0.298_133_329_356_934, 1e-12);
}

/// Largest angle from the middle of a space, at a radius, that the rack cuts away while it rolls: by trial.
fn cut_rad(spec: &WheelSpec, radius: f64) -> f64 {
    let rack = spec.rack;
    let (tan, cos, sin) = (maths::tan(rack.pressure_angle_rad), maths::cos(rack.pressure_angle_rad), maths::sin(rack.pressure_angle_rad));
    let r = f64::from(spec.teeth) / 2.0;
    let centre_depth = rack.dedendum - rack.root_radius;
    let centre_aside = PI / 4.0 + spec.thinning_m / 2.0 - centre_depth * tan - rack.root_radius / cos;
    let straight = centre_depth + rack.root_radius * sin;
    let inside = |across: f64, depth: f64| {
        if depth <= straight {
            across.abs() <= PI / 4.0 + spec.thinning_m / 2.0 - depth * tan
        } else {
            let over = depth - centre_depth;
            over <= rack.root_radius && across.abs() <= centre_aside + (rack.root_radius * rack.root_radius - over * over).sqrt()
        }
    };
    let removed = |angle: f64| {
        (-3000..=3000).any(|k| {
            let shift = f64::from(k) * 0.0015;
            let turned = angle + shift / r;
            inside(radius * maths::sin(turned) - shift, r - radius * maths::cos(turned) + spec.profile_shift)
        })
    };
    let (mut low, mut high) = (0.0, PI / f64::from(spec.teeth));
    assert!(removed(low) && !removed(high));
    for _ in 0..26 {
        let middle = 0.5 * (low + high);
        if removed(middle) { low = middle } else { high = middle }
    }
    low
}

/// Fillet and flank against a rack that is rolled over the gear step by step.
#[test]
fn cut_by_brute_force() {
    for (teeth, shift, rack) in [
        (12, 0.0, Rack::ISO_53_A),
        (9, -0.1, Rack::ISO_53_C),
        (12, 0.4, Rack::ISO_53_A),
        (24, 0.2, Rack::ISO_53_D),
        (17, 0.0, Rack { root_radius: 0.0, ..Rack::ISO_53_A }),
    ] {
        let spec = WheelSpec { rack, thinning_m: 0.03, ..spec(External, teeth, shift) };
        let gear = Wheel::new(spec).unwrap();
        let form = interference::form_radius_m(&gear);
        let involute_rad = |radius: f64| PI / f64::from(teeth) - gear.tooth_angle_rad(radius) / 2.0;
        let undercut = interference::least_shift(&gear) > shift;
        // Above, the flank is an involute; below, an undercutting fillet takes away what the involute would leave.
        for above in [0.005, 0.2, 0.8] {
            near(cut_rad(&spec, form + above), involute_rad(form + above), 2e-6);
        }
        if form - 0.02 > gear.base_radius_m {
            let (cut, flank) = (cut_rad(&spec, form - 0.02), involute_rad(form - 0.02));
            // Without undercut it leaves more.
            let sign = if undercut { 1.0 } else { -1.0 };
            assert!(sign * (cut - flank) > 1e-5, "{teeth} teeth: {cut} {flank}");
        }
        // The weakest section lies on what is left.
        let root = tooth_root(&gear).unwrap();
        let height = gear.base_radius_m / maths::cos(root.load_angle_rad) - root.height_m;
        let (radius, angle) = (maths::hypot(height, root.thickness_m / 2.0), maths::atan2(root.thickness_m / 2.0, height));
        near(PI / f64::from(teeth) - cut_rad(&spec, radius), angle, 1e-5);
    }
}

/// Corner of the pinion's tip against the flank of the ring while both roll: least angle between them beyond the ring's tip circle, rad.
fn fouling_rad(mesh: &Mesh) -> f64 {
    let (pinion, ring, a) = (&mesh.pinion, &mesh.wheel, mesh.centre_distance_m);
    let half_rad = pinion.tooth_angle_rad(pinion.tip_radius_m) / 2.0;
    let mut least = f64::INFINITY;
    for k in 0..40_000 {
        let turn = (f64::from(k) / 40_000.0 - 0.2) * 2.0;
        let (x, y) = (a + pinion.tip_radius_m * maths::cos(turn + half_rad), pinion.tip_radius_m * maths::sin(turn + half_rad));
        let radius = maths::hypot(x, y);
        if radius >= ring.tip_radius_m && y > 0.0 {
            let space_rad = PI / f64::from(ring.spec.teeth) - ring.tooth_angle_rad(radius) / 2.0;
            least = least.min(space_rad + turn / mesh.ratio() - maths::atan2(y, x));
        }
    }
    least
}

/// Tips of a pinion against those of a ring when the pinion moves radially: least distance across, m.
fn trimming_m(mesh: &Mesh) -> f64 {
    let (pinion, ring) = (&mesh.pinion, &mesh.wheel);
    let tooth_rad = pinion.tooth_angle_rad(pinion.tip_radius_m) / 2.0;
    let space_rad = PI / f64::from(ring.spec.teeth) - ring.tooth_angle_rad(ring.tip_radius_m) / 2.0;
    (0..20_000)
        .map(|k| f64::from(k) / 20_000.0 * PI / 2.0)
        .map(|turn| ring.tip_radius_m * maths::sin(turn / mesh.ratio() + space_rad) - pinion.tip_radius_m * maths::sin(turn + tooth_rad))
        .fold(f64::INFINITY, f64::min)
}

/// Where a space of a ring narrows, its corner arc touches flank and root circle, as large as the rack's or with its centre in the middle; the
/// weakest section is that of the arc.
fn check_corner(ring: &Wheel) {
    let (form, base, root) = (interference::form_radius_m(ring), ring.base_radius_m, ring.root_radius_m);
    let half_pitch = PI / f64::from(ring.spec.teeth);
    let flank = half_pitch - ring.tooth_angle_rad(form) / 2.0;
    let point = (form * maths::cos(flank), form * maths::sin(flank));
    // The normal of the flank touches the base circle where the involute unwinds from.
    let (tangent, towards) = (maths::acos(base / form), flank - maths::acos(base / form));
    let foot = (base * maths::cos(towards), base * maths::sin(towards));
    let long = form * maths::sin(tangent);
    let centre = |radius: f64| (point.0 + (foot.0 - point.0) * radius / long, point.1 + (foot.1 - point.1) * radius / long);
    let off_root = |radius: f64| maths::hypot(centre(radius).0, centre(radius).1) + radius - root;
    let wanted = ring.spec.rack.root_radius * ring.spec.module_m;
    let radius = forcewright_base::roots::root(off_root, 0.0, 1.5 * wanted, 1e-13).expect("an arc");
    let middle = centre(radius);
    assert!(radius <= wanted + 1e-9 && middle.1 > -1e-9, "{radius} {middle:?}");
    assert!(radius > wanted - 1e-9 || middle.1.abs() < 1e-8, "{radius} {middle:?}");
    let section = tooth_root(ring).expect("a root");
    let vertex = base / maths::cos(section.load_angle_rad);
    let least = (0..=2000)
        .map(|k| f64::from(k) / 2000.0)
        .map(|part| {
            let end = maths::atan2(point.1 - middle.1, point.0 - middle.0);
            let start = maths::atan2(middle.1, middle.0);
            let direction = start + part * (end - start);
            let (x, y) = (middle.0 + radius * maths::cos(direction), middle.1 + radius * maths::sin(direction));
            let (distance, angle) = (maths::hypot(x, y), half_pitch - maths::atan2(y, x));
            let thick = 2.0 * distance * maths::sin(angle);
            thick * thick / (distance * maths::cos(angle) - vertex)
        })
        .filter(|measure| *measure > 0.0)
        .fold(f64::INFINITY, f64::min);
    let ours = section.thickness_m * section.thickness_m / section.height_m;
    assert!((ours / least - 1.0).abs() < 1e-5, "{ours} {least}");
}

/// With the carrier of one pair standing, the pair rolls; contact at every instant on the line of action, shared equally.
fn loss_by_time(mesh: &Mesh) -> f64 {
    const STEPS: i32 = 20_000;
    let path = mesh.path();
    let mut sum = 0.0;
    for k in 0..STEPS {
        let offset = path.base_pitch_m * (f64::from(k) + 0.5) / f64::from(STEPS);
        let contacts: Vec<f64> = (-9..=9)
            .map(|n| path.pitch_m + offset + f64::from(n) * path.base_pitch_m)
            .filter(|xi| (path.usable.start_m..=path.usable.end_m).contains(xi))
            .collect();
        // Speeds of both flanks at unit speed of the pinion, at each contact.
        let sliding: f64 = contacts
            .iter()
            .map(|xi| {
                let [pinion_m, wheel_m] = mesh.curvature_radii_m(*xi);
                (pinion_m - wheel_m / mesh.ratio()).abs()
            })
            .sum();
        sum += sliding / contacts.len().max(1) as f64;
    }
    sum / f64::from(STEPS) / mesh.pinion.base_radius_m
}

/// `π (u ± 1)/(z₁ u)(1 − ε + ε₁² + ε₂²)`.
#[test]
fn loss_factor_of_the_books() {
    for (kind, sign) in [(External, 1.0), (Internal, -1.0)] {
        let mesh = Mesh::without_backlash(wheel(External, 21, 0.1), wheel(kind, 60, 0.15)).unwrap();
        let path = mesh.path();
        let [approach, recess] = path.approach_recess();
        let epsilon = approach + recess;
        assert!(epsilon > 1.0 && epsilon < 2.0 && approach > 0.0 && recess > 0.0);
        let u = mesh.ratio();
        let book = PI * (u + sign) / (21.0 * u) * (1.0 - epsilon + approach * approach + recess * recess);
        near(mesh.loss_factor() / book, 1.0, 1e-12);
        near(loss_by_time(&mesh) / book, 1.0, 1e-3);
    }
}

/// Lewis drew his teeth; the rack of his 20° system has sharp corners and a dedendum of 1.157. Budynas and Nisbett (2011), table 14–2.
#[test]
fn form_factors_of_lewis() {
    let rack = Rack { dedendum: 1.157, root_radius: 0.0, ..Rack::ISO_53_A };
    for (teeth, printed, within) in [
        (12, 0.245, 0.01),
        (13, 0.261, 0.01),
        (14, 0.277, 0.025),
        (15, 0.290, 0.031),
        (16, 0.296, 0.02),
        (17, 0.303, 0.015),
        (20, 0.322, 0.01),
        (24, 0.337, 0.015),
        (30, 0.359, 0.016),
        (43, 0.397, 0.011),
        (60, 0.422, 0.013),
        (100, 0.447, 0.015),
        (300, 0.472, 0.01),
        (1_000_000, 0.485, 0.003),
    ] {
        let gear = Wheel::new(WheelSpec { rack, ..spec(External, teeth, 0.0) }).unwrap();
        let factor = tooth_root(&gear).unwrap().form_factor;
        assert!((factor / printed - 1.0_f64).abs() <= within, "{teeth} teeth: {factor} instead of {printed}");
    }
    // A ring of ever more teeth becomes the same rack, with the fillets of its arcs.
    let [ring, gear] = [Internal, External].map(|kind| tooth_root(&wheel(kind, 400_000, 0.0)).unwrap().form_factor);
    near(ring / gear, 1.0, 1e-4);
}

/// `σ_H0 = Z_H Z_E √(F_t (u ± 1)/(b d₁ u))`, ISO 6336-2; stress goes with torque over the cube of size.
#[test]
fn stresses_of_the_standards() {
    let steel = Solid { young_modulus_pa: 206e9, poisson_ratio: 0.3 };
    for (kind, sign) in [(External, 1.0_f64), (Internal, -1.0)] {
        let mesh = Mesh::without_backlash(scaled(External, 20, 0.2, 1e-3), scaled(kind, 55, 0.5, 1e-3)).unwrap();
        let (torque_nm, width_m, alpha) = (2.0, 8e-3, 20f64.to_radians());
        let working = mesh.pressure_angle_rad;
        let zone = (2.0 * maths::cos(working) / (maths::cos(alpha) * maths::cos(alpha) * maths::sin(working))).sqrt();
        let elastic = (206e9_f64 / (2.0 * PI * (1.0 - 0.09))).sqrt();
        let u = 55.0 / 20.0;
        let force_n = torque_nm / 0.010;
        let book = zone * elastic * (force_n * (u + sign) / (width_m * 0.020 * u)).sqrt();
        let ours = flank_pressure(&mesh, torque_nm, width_m, [steel; 2]).unwrap();
        near(ours.pitch_pa / book, 1.0, 1e-12);
        assert!(ours.largest_pa >= ours.pitch_pa);
        let twice = Mesh::without_backlash(scaled(External, 20, 0.2, 2e-3), scaled(kind, 55, 0.5, 2e-3)).unwrap();
        near(flank_pressure(&twice, 8.0 * torque_nm, 2.0 * width_m, [steel; 2]).unwrap().largest_pa / ours.largest_pa, 1.0, 1e-12);
        let [small, large] = [&mesh, &twice].map(|mesh| mesh.wheel);
        let bending = bending_stress_pa(&small, torque_nm, width_m).unwrap();
        near(bending_stress_pa(&large, 8.0 * torque_nm, 2.0 * width_m).unwrap() / bending, 1.0, 1e-9);
        // The moment about the section, from the force along the normal at the tip.
        let root = tooth_root(&small).unwrap();
        let across_n = torque_nm / small.base_radius_m * maths::cos(root.load_angle_rad);
        near(6.0 * across_n * root.height_m / (width_m * root.thickness_m * root.thickness_m) / bending, 1.0, 1e-12);
    }
}

#[test]
fn faults_are_named() {
    let (gear, ring) = (wheel(External, 20, 0.0), wheel(Internal, 50, 0.0));
    assert!(matches!(Mesh::new(ring, gear, 15.0), Err(GearError::Mates { .. })));
    assert!(matches!(Mesh::new(gear, wheel(Internal, 20, 0.0), 1.0), Err(GearError::Mates { .. })));
    assert!(matches!(Mesh::new(gear, scaled(External, 30, 0.0, 2.0), 40.0), Err(GearError::Mates { .. })));
    assert!(matches!(Mesh::new(gear, gear, 18.0), Err(GearError::CentreDistance { .. })));
    assert!(matches!(Mesh::new(gear, gear, f64::NAN), Err(GearError::CentreDistance { .. })));
    let deep = wheel(External, 20, -0.5);
    assert!(matches!(Mesh::without_backlash(deep, deep), Err(GearError::CentreDistance { .. })));
    assert!(interference::check_tip(&gear).is_ok());
    let pointed = wheel(External, 8, 0.9);
    let Err(GearError::PointedTooth { radius_m }) = interference::check_tip(&pointed) else { panic!("it is pointed") };
    near(pointed.tooth_angle_rad(radius_m), 0.0, 1e-12);
    assert!(radius_m < pointed.tip_radius_m);
    // No stress in what is no tooth.
    for (kind, teeth, shift, addendum) in
        [(External, 8, 0.9, 1.0), (External, 8, 3.0, 1.0), (External, 12, 10.0, 1.0), (Internal, 200, 1.0, 2.4)]
    {
        let none = Wheel::new(WheelSpec { rack: Rack { addendum, ..Rack::ISO_53_A }, ..spec(kind, teeth, shift) }).unwrap();
        let Err(GearError::PointedTooth { radius_m }) = tooth_root(&none) else { panic!("{teeth} {shift}") };
        near(none.tooth_angle_rad(radius_m), 0.0, 1e-9);
        assert!(bending_stress_pa(&none, 1.0, 1.0).is_err());
    }
    let steel = Solid { young_modulus_pa: 206e9, poisson_ratio: 0.3 };
    let mesh = Mesh::without_backlash(gear, ring).unwrap();
    assert!(flank_pressure(&mesh, f64::NAN, 1.0, [steel; 2]).is_err());
    assert!(flank_pressure(&mesh, 1.0, 0.0, [steel; 2]).is_err());
    let apart = Mesh::new(gear, gear, 30.0).unwrap();
    assert!(matches!(flank_pressure(&apart, 1.0, 1.0, [steel; 2]), Err(GearError::Value { name: "contact_ratio", .. })));
    assert!(inverse_involute(-1.0).is_nan() && inverse_involute(f64::INFINITY).is_nan());
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(512) })]

    #[test]
    fn involutes_are_inverted(angle in 0.01..1.55_f64) {
        let found = inverse_involute(involute(angle));
        // The involute cancels near 0.
        prop_assert!((found / angle - 1.0).abs() < 1e-15 / (angle * angle) + 1e-14, "{found} {angle}");
    }

    #[test]
    fn involutes_of_any_size_are_inverted(exponent in -30.0..6.0_f64) {
        let value = maths::powf(10f64, exponent);
        let angle = inverse_involute(value);
        prop_assert!(angle > 0.0 && angle < PI / 2.0);
        if exponent > -6.0 && exponent < 2.0 {
            prop_assert!((involute(angle) / value - 1.0).abs() < 1e-9);
        }
    }

    /// At the distance of the shifts, teeth measured on the working circles fill the pitch; apart from it, by the backlash of the tangent.
    #[test]
    fn backlash_is_what_is_left(z1 in 8..60u32, more in 5..90u32, x1 in -0.3..0.9_f64, x2 in -0.3..0.9_f64, ring: bool, thin in 0.0..0.1_f64) {
        let kind = if ring { Internal } else { External };
        let (pinion, mate) = (wheel(External, z1, x1), wheel(kind, z1 + more, x2));
        let Ok(free) = Mesh::without_backlash(pinion, mate) else { return Ok(()) };
        prop_assert!(free.backlash().circumferential_m.abs() < 1e-9);
        let sign = if ring { -1.0 } else { 1.0 };
        prop_assert!((free.shifts_without_backlash() - (x2 + sign * x1)).abs() < 1e-9);
        let thinner = Wheel::new(WheelSpec { thinning_m: thin, ..pinion.spec }).unwrap();
        let mesh = Mesh::new(thinner, mate, free.centre_distance_m).unwrap();
        let expected = thin * maths::cos(20f64.to_radians()) / maths::cos(free.pressure_angle_rad);
        let play = mesh.backlash();
        prop_assert!((play.circumferential_m - expected).abs() < 1e-9);
        prop_assert!((play.pinion_rad * mesh.pinion.base_radius_m - play.normal_m).abs() < 1e-12);
        prop_assert!((play.wheel_rad * mesh.wheel.base_radius_m - play.normal_m).abs() < 1e-12);
        let step = 1e-6;
        let apart = Mesh::new(pinion, mate, free.centre_distance_m + sign * step).unwrap();
        // To first order 2 Δa tan α', outwards of an external mesh and inwards of a ring.
        let slope = 2.0 * maths::tan(free.pressure_angle_rad) * step;
        prop_assert!((apart.backlash().circumferential_m - slope).abs() < 1e-9 + 1e-3 * slope);
    }

    /// Points of contact lie on both gears at once; sliding vanishes at the pitch point; flanks roll by equal arcs.
    #[test]
    fn paths_obey_geometry(z1 in 12..40u32, more in 12..90u32, x1 in 0.0..0.6_f64, x2 in 0.0..0.8_f64, ring: bool, part in 0.01..0.99_f64) {
        let kind = if ring { Internal } else { External };
        let Ok(mesh) = Mesh::without_backlash(wheel(External, z1, x1), wheel(kind, z1 + more, x2)) else { return Ok(()) };
        let path = mesh.path();
        prop_assume!(path.usable.length_m() > 0.0);
        let xi = path.usable.start_m + part * path.usable.length_m();
        let [r1, r2] = mesh.radii_m(xi);
        let [pinion, mate] = mesh.active_radii_m();
        prop_assert!(pinion[0] < r1 && r1 < pinion[1] && (mate[0] - r2) * (r2 - mate[1]) > 0.0);
        // Centres at (0, 0) and (a, 0) of an external pair, the ring's at (−a, 0); the line of action passes the pitch point.
        let (sin, cos) = maths::sin_cos(mesh.pressure_angle_rad);
        let along = xi - path.pitch_m;
        let (x, y) = (mesh.pitch_radii_m()[0] + along * sin, along * cos);
        prop_assert!((maths::hypot(x, y) - r1).abs() < 1e-9);
        let centre = if ring { -mesh.centre_distance_m } else { mesh.centre_distance_m };
        prop_assert!((maths::hypot(x - centre, y) - r2).abs() < 1e-9);
        prop_assert!(r1 <= mesh.pinion.tip_radius_m + 1e-9);
        if ring { prop_assert!(r2 >= mesh.wheel.tip_radius_m - 1e-9) } else { prop_assert!(r2 <= mesh.wheel.tip_radius_m + 1e-9) }
        prop_assert!(mesh.specific_sliding(path.pitch_m).iter().all(|zeta| zeta.abs() < 1e-9));
        let (here, there) = (mesh.roll_angles_rad(xi), mesh.roll_angles_rad(path.usable.start_m));
        let arcs = [(here[0] - there[0]) * mesh.pinion.base_radius_m, (here[1] - there[1]) * mesh.wheel.base_radius_m];
        let sign = if ring { 1.0 } else { -1.0 };
        prop_assert!((arcs[0] - sign * arcs[1]).abs() < 1e-9);
        // Classical contact ratio between the tips.
        let tan = |wheel: &Wheel| maths::tan(maths::acos((wheel.base_radius_m / wheel.tip_radius_m).min(1.0)));
        let working = maths::tan(mesh.pressure_angle_rad);
        let (t1, t2) = (f64::from(z1) * (tan(&mesh.pinion) - working), f64::from(z1 + more) * (tan(&mesh.wheel) - working));
        let classical = (t1 + if ring { -t2 } else { t2 }) / (2.0 * PI);
        prop_assert!((path.tips.length_m() / path.base_pitch_m - classical).abs() < 1e-9);
        prop_assert!((mesh.loss_factor() - loss_by_time(&mesh)).abs() < 2e-3 * mesh.loss_factor() || path.contact_ratio(path.usable) < 1.0);
    }

    #[test]
    fn undercut_by_brute_force(teeth in 5..16u32, below in 0.01..0.5_f64, round in 0..3usize) {
        let rack = [Rack::ISO_53_A, Rack::ISO_53_C, Rack { root_radius: 0.0, ..Rack::ISO_53_A }][round];
        let least = interference::least_shift(&Wheel::new(WheelSpec { rack, ..spec(External, teeth, 0.0) }).unwrap());
        let spec = WheelSpec { rack, ..spec(External, teeth, least - below) };
        let gear = Wheel::new(spec).unwrap();
        let form = interference::form_radius_m(&gear);
        prop_assert!(form >= gear.base_radius_m);
        prop_assume!(form + 0.03 < gear.tip_radius_m);
        let flank = |radius: f64| PI / f64::from(teeth) - gear.tooth_angle_rad(radius) / 2.0;
        let above = form + 0.02;
        prop_assert!((cut_rad(&spec, above) - flank(above)).abs() < 1e-5);
        let under = form - 0.02;
        if under > gear.base_radius_m {
            prop_assert!(cut_rad(&spec, under) > flank(under) + 1e-5);
        }
    }

    /// Whatever the gear: a form factor above 0 or an error.
    #[test]
    fn form_factors_are_positive(teeth in 4..200u32, shift in -3.0..12.0_f64, short in 0.0..2.0_f64, ring: bool, radius in 0.0..0.4_f64) {
        let kind = if ring { Internal } else { External };
        let rack = Rack { root_radius: radius, ..Rack::ISO_53_A };
        let Ok(gear) = Wheel::new(WheelSpec { rack, tip_shortening: short, ..spec(kind, teeth, shift) }) else { return Ok(()) };
        match tooth_root(&gear) {
            Ok(root) => prop_assert!(root.form_factor > 0.0 && root.form_factor.is_finite() && interference::check_tip(&gear).is_ok()),
            Err(error) => {
                let named = matches!(error, GearError::PointedTooth { .. } | GearError::Value { .. });
                prop_assert!(named, "{error}");
            }
        }
    }

    /// Where the tip circles cut the line of action, against where the involutes end: in the plane.
    #[test]
    fn tips_and_fillets(z1 in 18..40u32, more in 15..90u32, x1 in 0.0..0.6_f64, x2 in 0.0..0.8_f64, ring: bool, longer in 0.0..0.4_f64) {
        let kind = if ring { Internal } else { External };
        let rack = Rack { addendum: 1.0 + longer, ..Rack::ISO_53_A };
        let [pinion, mate] = [(External, z1, x1), (kind, z1 + more, x2)]
            .map(|(kind, teeth, shift)| Wheel::new(WheelSpec { rack, ..spec(kind, teeth, shift) }).unwrap());
        let Ok(mesh) = Mesh::without_backlash(pinion, mate) else { return Ok(()) };
        prop_assume!(mate.tip_radius_m > mate.base_radius_m);
        let centre = if ring { -mesh.centre_distance_m } else { mesh.centre_distance_m };
        let (sin, cos) = maths::sin_cos(mesh.pressure_angle_rad);
        // Distance along the line, from the foot of the perpendicular through a centre, at which a circle about it cuts the line.
        let cut = |middle: f64, radius: f64| {
            let foot = (middle - mesh.pitch_radii_m()[0]) * sin;
            let off = (middle - mesh.pitch_radii_m()[0]) * cos;
            (foot, (radius * radius - off * off).max(0.0).sqrt())
        };
        let ahead = |(foot, half): (f64, f64), forwards: bool| if forwards { foot + half } else { foot - half };
        let form = [pinion, mate].map(|gear| interference::form_radius_m(&gear));
        let value = |condition| interference::mesh_margins(&mesh, 0.0).find(|m| m.condition == condition).map(|m| m.value);
        let wheel_tip = ahead(cut(centre, mate.tip_radius_m), ring);
        let expected = wheel_tip - ahead(cut(0.0, form[0]), true);
        prop_assert!((value(Condition::PinionFillet).unwrap() - expected).abs() < 1e-9);
        prop_assert!((value(Condition::PinionInterference).unwrap() - (wheel_tip - cut(0.0, 0.0).0)).abs() < 1e-9);
        let pinion_tip = ahead(cut(0.0, pinion.tip_radius_m), true);
        let expected = ahead(cut(centre, form[1]), ring) - pinion_tip;
        prop_assert!((value(Condition::WheelFillet).unwrap() - expected).abs() < 1e-9);
        let expected = (!ring).then(|| cut(centre, 0.0).0 - pinion_tip);
        prop_assert_eq!(value(Condition::WheelInterference).is_some(), expected.is_some());
        prop_assert!(expected.is_none_or(|expected| (value(Condition::WheelInterference).unwrap() - expected).abs() < 1e-9));
    }

    #[test]
    fn corners_of_rings(teeth in 24..150u32, shift in -0.5..1.2_f64, thin in 0.0..0.1_f64) {
        let ring = Wheel::new(WheelSpec { thinning_m: thin, ..spec(Internal, teeth, shift) }).unwrap();
        let space = interference::wheel_margins(&ring, 0.0).find(|margin| margin.condition == Condition::RingRoot).unwrap();
        prop_assume!(space.value > 0.02 && ring.tip_radius_m > ring.base_radius_m);
        check_corner(&ring);
    }

    /// Tips that foul by trial are those with a margin below 0, and by as much where they cross the tip circle.
    #[test]
    fn interference_with_a_ring_by_trial(z1 in 14..40u32, more in 4..20u32, x1 in 0.0..0.6_f64, dx in -0.1..0.5_f64, short in 0.0..0.4_f64) {
        let ring = Wheel::new(WheelSpec { tip_shortening: short, ..spec(Internal, z1 + more, x1 + dx) }).unwrap();
        let Ok(mesh) = Mesh::without_backlash(wheel(External, z1, x1), ring) else { return Ok(()) };
        let path = mesh.path();
        prop_assume!(ring.tip_radius_m > ring.base_radius_m && path.tips.start_m > 0.0 && path.tips.length_m() > 0.0);
        if let Some(margin) = interference::trochoid_rad(&mesh) {
            let least = fouling_rad(&mesh);
            // In contact the angle is 0: only what is below counts.
            if margin > 1e-4 { prop_assert!(least > -1e-6, "{margin} {least}") }
            if margin < -1e-3 { prop_assert!(least < -1e-5 && least < 0.5 * margin, "{margin} {least}") }
        }
        // As handbooks print it, there is no involute interference while z₁/z₂ ≥ 1 − tan α_a2 / tan α'.
        let at_tip = maths::tan(maths::acos(ring.base_radius_m / ring.tip_radius_m));
        let printed = 1.0 / mesh.ratio() - 1.0 + at_tip / maths::tan(mesh.pressure_angle_rad);
        prop_assert!((printed * ring.base_radius_m * maths::tan(mesh.pressure_angle_rad) - path.tips.start_m).abs() < 1e-9);
        let (margin, least) = (interference::trimming_rad(&mesh), trimming_m(&mesh));
        if margin.abs() > 1e-4 { prop_assert_eq!(margin > 0.0, least > 0.0, "{} {}", margin, least) }
    }
}
