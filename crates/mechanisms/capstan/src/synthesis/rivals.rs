//! The duty of a cable drive done by a toothed belt and by a pair of spur gears: what they are stiff, lose and weigh on their shafts.
//!
//! Both have the drums of the drive as pitch circles, to the nearest tooth. A belt is preloaded by half of the force that it carries, so that
//! its slack strand is just not loose under the torque. Loads are those that maker and handbook allow. What no source tells is not assessed, and the last column says on what each rests.

use forcewright_base::maths;
use forcewright_base::units::{format_number, format_si};
use forcewright_elements::transmissions::{Belt, BeltSize, GearPair, LEAST_TEETH, MODULES_M, belts, steel};
use forcewright_model::{StudyColumn, StudyTable};

use super::sizing::{Asked, Frame, Merits};
use crate::design::DisplayUnits;
use crate::losses::shaft_load_n;
use crate::whole::{count, few};

/// cos 20°.
const COS_PRESSURE: f64 = 0.939_692_620_785_908_4;

/// What a drive must do, and the room in which it does it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Duty {
    pub torque_nm: f64,
    /// Against breaking.
    pub safety: f64,
    pub ratio: f64,
    /// Of the drums, m.
    pub radii_m: [f64; 2],
    pub distance_m: f64,
}

/// A rival that does it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Rival {
    pub name: String,
    pub stiffness_nm_per_rad: f64,
    /// Full width at the output, rad; `None` where no source tells.
    pub backlash_rad: Option<f64>,
    pub width_m: f64,
    pub shaft_load_n: f64,
    /// On what it rests.
    pub basis: String,
}

/// A belt on these pulleys: stiffness of both strands, `2 C r²/L` from the cords alone.
pub(super) fn belt(duty: &Duty, belt: &Belt) -> Option<Rival> {
    let per_rad_m = belt.pitch_m / std::f64::consts::TAU;
    let wanted = few(duty.radii_m[0] / per_rad_m);
    let small = wanted.max(few(belt.least_teeth.value));
    let large = few(duty.ratio * f64::from(small));
    let radii_m = [small, large].map(|z| per_rad_m * f64::from(z));
    // The pulleys do not touch, and belts have some thickness.
    let distance_m = duty.distance_m.max(radii_m[0] + radii_m[1] + belt.pitch_m);
    let apart_m = radii_m[1] - radii_m[0];
    let span_m = ((distance_m - apart_m) * (distance_m + apart_m)).sqrt();
    let force_n = duty.torque_nm / radii_m[1];
    // Wrap of the small pulley, π − 2 asin((r₂ − r₁)/d).
    let wrap_rad = std::f64::consts::PI - 2.0 * maths::atan2(apart_m, span_m);
    let meshing = (f64::from(small) * wrap_rad / std::f64::consts::TAU).floor().min(belt.teeth.value);
    let holds = |size: &&BeltSize| {
        let teeth_n = belt.tooth_n_per_m.value * meshing * size.width_m;
        teeth_n >= force_n && size.tension_n >= force_n && size.breaking_n >= duty.safety * force_n
    };
    let size = belt.sizes.iter().find(holds)?;
    let [sin, cos] = [span_m / distance_m, apart_m / distance_m];
    let at_rest_n = shaft_load_n(&[[0.5 * force_n; 2]], [sin, cos]);
    let larger = if small > wanted {
        let m = |m: f64| format!("{} mm", format_number(1e3 * m, 4));
        format!(
            "; pulleys larger than the drums, {} teeth are the fewest ({}), output of {}, {} apart",
            small,
            belt.least_teeth.source,
            m(2.0 * radii_m[1]),
            m(distance_m)
        )
    } else {
        String::new()
    };
    Some(Rival {
        name: format!("Toothed belt {}, {small}:{large} teeth", belt.name),
        stiffness_nm_per_rad: 2.0 * size.stiffness_n / span_m * radii_m[1] * radii_m[1],
        backlash_rad: None,
        width_m: size.width_m,
        shaft_load_n: at_rest_n.max(shaft_load_n(&[[force_n, 0.0]], [sin, cos])),
        basis: format!(
            "cords {} kN per mm of width, at most {} N a tooth and mm, {} teeth in mesh ({}); both strands taut; an upper bound: the give of the teeth, and the gap of the pulleys, are in no source at hand{larger}",
            format_number(1e-6 * size.stiffness_n / size.width_m, 3),
            format_number(1e-3 * belt.tooth_n_per_m.value, 3),
            count(meshing),
            belt.tooth_n_per_m.source,
        ),
    })
}

/// Spur gears with the largest module of the series whose pinion is not undercut.
pub(super) fn gears(duty: &Duty) -> Option<Rival> {
    let pair = MODULES_M.iter().rev().find_map(|module_m| {
        let small = few(2.0 * duty.radii_m[0] / module_m);
        (small >= LEAST_TEETH).then(|| GearPair { module_m: *module_m, teeth: [small, few(duty.ratio * f64::from(small))] })
    })?;
    let force_n = duty.torque_nm / pair.radii_m()[1];
    let width_m = pair.width_m(force_n);
    let base_m = pair.base_m()[1];
    let along_n = force_n / COS_PRESSURE;
    let mesh_pa = pair.mesh_pa(force_n / width_m);
    Some(Rival {
        name: format!("Spur gears, module {} mm, {}:{} teeth", format_number(1e3 * pair.module_m, 3), pair.teeth[0], pair.teeth[1]),
        stiffness_nm_per_rad: mesh_pa * width_m * base_m * base_m,
        backlash_rad: Some(pair.backlash_m() / base_m),
        width_m,
        shaft_load_n: along_n,
        basis: format!(
            "mesh stiffness {} N/(mm µm) (iso6336-1, method B); least backlash ⅔(0.06 + 0.0005 a + 0.03 m) mm = {} µm (iso-tr-10064-2); steel of 240 HB, bending {} MPa, contact {} MPa, face of 3 pitches or more ({})",
            format_number(1e-9 * mesh_pa, 3),
            format_number(1e6 * pair.backlash_m(), 3),
            format_number(1e-6 * steel().bending_pa.value, 3),
            format_number(1e-6 * steel().contact_pa.value, 3),
            steel().bending_pa.source,
        ),
    })
}

/// The drive beside them.
pub(super) fn table(asked: &Asked, frame: &Frame, merits: &Merits) -> StudyTable {
    let duty = Duty {
        torque_nm: asked.torque_nm,
        safety: asked.safety,
        ratio: asked.ratio,
        radii_m: [frame.input_m, asked.ratio * frame.input_m],
        distance_m: frame.distance_m,
    };
    let units = &asked.template.units;
    let ours = Rival {
        name: "The first design".to_owned(),
        stiffness_nm_per_rad: merits.stiffness_nm_per_rad,
        backlash_rad: merits.lost_motion_rad,
        width_m: merits.width_m,
        shaft_load_n: merits.shaft_load_n,
        basis: "as computed; hysteresis after the torque both ways in the place of a backlash".to_owned(),
    };
    let mut rows = vec![row(&ours, units)];
    let none = |name: String, why: &str| {
        let mut row = vec![name, "–".to_owned(), "–".to_owned(), "–".to_owned(), "–".to_owned()];
        row.push(why.to_owned());
        row
    };
    for profile in belts() {
        let rival = belt(&duty, profile);
        let why = "more force than the widest belt listed carries";
        rows.push(rival.map_or_else(|| none(format!("Toothed belt {}", profile.name), why), |r| row(&r, units)));
    }
    let why = "no module of the series leaves the pinion teeth enough";
    rows.push(gears(&duty).map_or_else(|| none("Spur gears".to_owned(), why), |r| row(&r, units)));
    let number = |title: &str| StudyColumn::Number(title.to_owned());
    let text = |title: &str| StudyColumn::Text(title.to_owned());
    StudyTable {
        caption: "The same duty by a belt and by gears: torque and ratio of the project, pitch circles of the drums; belts at their centre distance, gears at that of their circles; loads that maker and handbook allow, belts with the project's safety factor against breaking too. Keys are those of REFERENCES.bib"
            .to_owned(),
        columns: vec![
            text("Drive"),
            number("Stiffness at the output"),
            number("Backlash"),
            number("Width"),
            number("Shaft load"),
            text("On what it rests"),
        ],
        rows,
    }
}

fn row(rival: &Rival, units: &DisplayUnits) -> Vec<String> {
    vec![
        rival.name.clone(),
        format_si(rival.stiffness_nm_per_rad, &units.stiffness, 3),
        rival.backlash_rad.map_or_else(|| "not assessed".to_owned(), |rad| format_si(rad, &units.small_angle, 3)),
        format_si(rival.width_m, &units.length, 3),
        format_si(rival.shaft_load_n, &units.force, 3),
        rival.basis.clone(),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn duty() -> Duty {
        Duty { torque_nm: 10.0, safety: 2.0, ratio: 5.0, radii_m: [0.020, 0.100], distance_m: 0.150 }
    }

    /// Against numbers by hand: 10 N·m on a circle of 25·5 teeth of 5 mm.
    #[test]
    fn a_belt_is_two_springs() {
        let at5 = belts().iter().find(|b| b.name == "AT5").expect("listed");
        let rival = belt(&duty(), at5).expect("held");
        let (r2, r1) = (125.0 * 0.005 / std::f64::consts::TAU, 25.0 * 0.005 / std::f64::consts::TAU);
        let span = (0.150_f64 * 0.150 - (r2 - r1) * (r2 - r1)).sqrt();
        // 100.5 N: on 10 mm 8 teeth of 3.64 N/mm carry 291 N, and the cords, of 140 kN, 560 N.
        assert!((rival.width_m - 0.010).abs() < 1e-12);
        assert!((rival.stiffness_nm_per_rad / (2.0 * 140e3 / span * r2 * r2) - 1.0).abs() < 1e-12);
        assert_eq!(rival.backlash_rad, None);
        // Ten times the torque needs a wider one; so much that none holds it is said.
        let wider = belt(&Duty { torque_nm: 100.0, ..duty() }, at5).expect("held");
        assert!(wider.width_m > rival.width_m && wider.stiffness_nm_per_rad > rival.stiffness_nm_per_rad);
        assert_eq!(belt(&Duty { torque_nm: 1e5, ..duty() }, at5), None);
        // On small drums the smallest pulleys are larger, and may need more room.
        let small = belt(&Duty { radii_m: [0.005, 0.025], distance_m: 0.05, ..duty() }, at5).expect("held");
        assert!(small.name.contains("15:75") && small.basis.contains("larger than the drums"), "{small:?}");
    }

    /// The turn of the wheel under the torque, and within the backlash, is that of the line of action over the base circle.
    #[test]
    fn gears_turn_by_the_line_of_action() {
        let rival = gears(&duty()).expect("a module");
        // The largest module with 18 teeth or more on 40 mm is 2 mm: 20 and 100 teeth, 120 mm apart.
        assert!(rival.name.contains("module 2 mm, 20:100"), "{}", rival.name);
        let base = 0.1 * maths::cos(20.0_f64.to_radians());
        let backlash = 2.0 / 3.0 * (0.06e-3 + 0.0005 * 0.120 + 0.03 * 0.002);
        assert!((rival.backlash_rad.expect("sourced") / (backlash / base) - 1.0).abs() < 1e-12);
        assert!((rival.shaft_load_n - 10.0 / base).abs() < 1e-9);
        assert!((rival.width_m - 6e-3 * std::f64::consts::PI).abs() < 1e-12);
        assert_eq!(gears(&Duty { radii_m: [0.003, 0.015], ..duty() }), None);
    }
}
